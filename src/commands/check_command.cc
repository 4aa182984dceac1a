#include "src/commands/commands.h"

#include "particles/packing_file.h"
#include "src/commands/check_volumes.h"
#include "src/commands/peak_memory.h"
#include "src/launcher/program.h"
#include "src/output/picture.h"
#include "src/output/run_folder.h"
#include "src/scene/geometry.h"
#include "src/simulation/damping.h"
#include "src/simulation/make_zone.h"
#include "src/simulation/recorder.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>

namespace ligament::program
{
namespace
{
struct Prediction
{
  double seconds_per_step = 0; // of the whole body
  double discrete_share = 0;   // of it, particles alone
};

/// Steps the body at rest for a moment: the same work per step as in the run.
template <int dim>
Prediction time_steps(const Scene &scene, CoupledBody<dim> &body, core::Timers &timers)
{
  using Clock = std::chrono::steady_clock;
  auto bodies = body.bodies();
  BodyDamping<dim> damping(scene.damping);
  coupling::StepTime step;
  step.dt = body.dt;
  const auto advance = [&](int n) {
    for (int i = 0; i < n; ++i, ++step.step) {
      body.coupler->compute_forces(bodies, step);
      damping.before_kick(body, step);
      body.coupler->kick(bodies, step);
      damping.after_kick(body, step);
      body.coupler->drift(bodies, step);
    }
  };
  const auto discrete_seconds = [&] {
    double sum = 0;
    for (const auto &row : timers.rows())
      if (row.name == "discrete forces" || row.name == "discrete motion")
        sum += row.seconds;
    return sum;
  };
  const int block = 4 * body.coupler->step_ratio();
  advance(block); // caches
  const double discrete_before = discrete_seconds();
  const auto start = Clock::now();
  long n = 0;
  double seconds = 0;
  while (seconds < 0.5) {
    advance(block);
    n += block;
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
  }
  return {seconds / n, (discrete_seconds() - discrete_before) / seconds};
}

std::string duration_text(double seconds)
{
  if (seconds < 120)
    return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200)
    return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// An absorbing side as a thick line, its layer's border dashed; in 3D along two edges.
template <int dim>
std::vector<Segments> absorbing_lines(const LoadParameters &load, int boundary,
                                      const Vector<dim> &lower, const Vector<dim> &upper)
{
  const int axis = boundary / 2;
  std::vector<Segments> lines;
  for (const double depth : {0., load.absorbing_layer}) {
    if (depth == 0 && !lines.empty())
      break;
    Segments s;
    s.color = {20, 110, 200};
    s.width = depth == 0 ? 6 : 2;
    s.dashed = depth > 0;
    for (int c = 0; c < dim; ++c)
      if (c != axis)
        for (const double end : {lower[c], upper[c]}) {
          std::array<double, 3> point = {};
          for (int k = 0; k < dim; ++k)
            point[k] = upper[k];
          point[axis] = boundary % 2 ? upper[axis] - depth : lower[axis] + depth;
          point[c] = end;
          s.points.insert(s.points.end(), point.begin(), point.end());
        }
    lines.push_back(s);
  }
  return lines;
}

template <int dim>
void draw(const CoupledBody<dim> &body, const Scene &scene, const std::string &file)
{
  FieldView view;
  view.field = "displacement";
  view.magnify = 0;
  view.title = scene.title;
  if (scene.zone.extent == DiscreteZone::Extent::box) {
    for (const auto &part : zone_shape<dim>(scene).boxes) {
      std::array<double, 6> box = {};
      for (int c = 0; c < dim; ++c) {
        box[c] = std::max(part.lower[c], body.lower[c]);
        box[3 + c] = std::min(part.upper[c], body.upper[c]);
      }
      view.boxes.push_back(box);
    }
  }
  auto picture =
      picture_of(particle_fields(body), cell_fields(body), {}, dim, body.spacing / 2, view);
  picture.value_label.clear();
  for (auto &scatter : picture.scatters)
    scatter.values.clear();
  for (auto &quads : picture.quads)
    quads.values.clear();
  for (const auto &load : scene.loads) {
    Label label;
    const std::array<const char *, 6> names = {"left", "right", "bottom", "top", "back", "front"};
    const int boundary = int(std::find(names.begin(), names.end(), load.boundary) - names.begin());
    label.position = {0, 0, 0};
    label.position[boundary / 2] =
        (boundary % 2 ? 0.94 : -0.94) * scene.specimen.size[boundary / 2] / 2;
    label.text = load.boundary + ": " + (load.absorbing ? "absorbing" : load.kind);
    picture.labels.push_back(label);
    if (load.absorbing) {
      auto segments = absorbing_lines(load, boundary, body.lower, body.upper);
      picture.segments.insert(picture.segments.end(), segments.begin(), segments.end());
    }
  }
  for (const auto &crack : scene.specimen.cracks)
    if (dim == 2) {
      Segments segments;
      for (const auto &point : crack.points)
        segments.points.insert(segments.points.end(), {point[0], point[1], 0.});
      picture.segments.push_back(segments);
    }
  write_picture(file, picture);
}

template <int dim>
int check(const CommandLine &line, const ReadResult &input)
{
  const Scene &scene = *input.scene;
  core::Log log;
  core::Timers timers;
  auto body = make_body<dim>(scene, log, timers);
  const double setup_seconds = timers.total();
  if (line.draw) {
    const std::string folder = output_folder(line);
    std::filesystem::create_directories(folder);
    const std::string file = folder + "/check.png";
    draw(body, scene, file);
    fmt::print("picture: {}\n", file);
    if (body.seeds) {
      const std::string packing = RunFolder{folder}.packing();
      particles::write_packing_file(packing, *body.seeds);
      fmt::print("packing: {}\n", packing);
    }
  }
  const auto prediction = time_steps(scene, body, timers);
  const double memory = peak_memory();
  const long steps = std::lround(std::ceil(scene.time.duration / body.dt));
  const double output = output_seconds(scene, body, steps);
  const double seconds = setup_seconds + steps * prediction.seconds_per_step + output;
  const int particles = body.zone ? body.zone->state.n_owned : 0;
  const int cells = body.far ? body.far->mesh().n_cells() : 0;
  const auto *joined = body.coupler->overlap();
  const int overlap = joined ? int(joined->members.size()) : 0;
  const double critical = body.zone ? body.dt_zone : body.dt_far;

  fmt::print("{}\n", scene.title);
  fmt::print("  particles            {:>12}\n", particles);
  fmt::print("  cells                {:>12}\n", cells);
  fmt::print("  overlap particles    {:>12}\n", overlap);
  fmt::print("  pure discrete model  {:>12} particles\n", body.equivalent_particles);
  fmt::print("  step                 {:>12.4g} s ({:.2f} of the stable one)\n", body.dt,
             body.dt / critical);
  if (joined)
    fmt::print("  far field            {:>12} steps of the zone per step; {:.4g} s is stable\n",
               body.coupler->step_ratio(), body.dt_far);
  fmt::print("  steps                {:>12}\n", steps);
  fmt::print("  memory               {:>12.0f} MiB\n", memory / 1048576);
  fmt::print("  predicted time       {:>12}{}\n", duration_text(seconds),
             scene.time.stop_when == "end" ? "" : ", less if it breaks earlier");
  double saving = 0;
  if (joined) {
    saving = prediction.discrete_share * double(body.equivalent_particles) / particles;
    fmt::print("  predicted saving     {:>11.1f}x against pure discrete elements\n", saving);
  }
  if (body.split)
    fmt::print("  patch residual       {:>12.1e} of C11 h^(dim-1)\n",
               body.split->report().patch_residual);
  for (const auto &part : body.skipped)
    fmt::print("  not needed: {} ({})\n", part.what, part.why);
  if (line.json) {
    nlohmann::ordered_json json = {{"particles", particles},
                                   {"cells", cells},
                                   {"overlap_particles", overlap},
                                   {"equivalent_particles", body.equivalent_particles},
                                   {"dt", body.dt},
                                   {"dt_critical", critical},
                                   {"steps", steps},
                                   {"memory_bytes", memory},
                                   {"available_memory_bytes", available_memory()},
                                   {"predicted_seconds", seconds},
                                   {"seconds_per_step", prediction.seconds_per_step},
                                   {"output_seconds", output},
                                   {"setup_seconds", setup_seconds},
                                   {"predicted_saving", saving},
                                   {"built", true},
                                   {"not_checked", nlohmann::json::array()},
                                   {"errors", nlohmann::json::array()}};
    fmt::print("{}\n", json_text(json));
  }
  return int(ExitCode::done);
}
} // namespace

int check_command(const CommandLine &line, const ReadResult &input)
{
  const bool particles = input.scene->zone.extent != DiscreteZone::Extent::none;
  const SizeEstimate size =
      estimate_size(*input.scene, particles ? mean_cell_volume(*input.scene) : 1);
  if (!line.full && std::max(size.particles, size.cells) > largest_built) {
    print_volumes(line, input, size);
    return int(ExitCode::done);
  }
  return input.scene->dimension == 2 ? check<2>(line, input) : check<3>(line, input);
}
} // namespace ligament::program
