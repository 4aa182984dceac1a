#include "src/verification/bodies/waves_twin.h"

#include "dem/many_body_force.h"
#include "packings/absorbing_sides.h"
#include "packings/periodic_random.h"
#include "src/verification/cases/wave_passage.h"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>

namespace ligament::program
{
namespace
{
/// The lower end of a bar: sends waves in and lets all out that come.
template <int dim>
class Port
{
public:
  Port(const particles::ParticleSolver<dim> &zone)
  {
    const auto constants = zone.force->elastic_constants();
    impedance_.fill(constants.density * constants.wave_speed_s);
    impedance_[dim - 1] = constants.density * constants.wave_speed_p;
    zone.force->for_each_face(zone.state, [&](const particles::FaceView<dim> &face) {
      if (face.j < 0 && face.normal[dim - 1] < 0)
        sites_.push_back({face.i, -face.area * face.normal[dim - 1],
                          face.centroid - get(zone.state.reference, face.i)});
    });
  }

  /// Power in W that a wave of this velocity brings through the end.
  double power(const Vector<dim> &velocity) const
  {
    double sum = 0;
    for (const Site &site : sites_)
      for (int c = 0; c < dim; ++c)
        sum += site.area * impedance_[c] * velocity[c] * velocity[c];
    return sum;
  }

  /// Power that leaves with the difference of two motions; the other bar's end is alike.
  double power(const particles::Particles<dim> &state, const Port &other,
               const particles::Particles<dim> &other_state) const
  {
    double sum = 0;
    for (std::size_t k = 0; k < sites_.size(); ++k) {
      const Vector<dim> v = sites_[k].velocity(state) - other.sites_[k].velocity(other_state);
      for (int c = 0; c < dim; ++c)
        sum += sites_[k].area * impedance_[c] * v[c] * v[c];
    }
    return sum;
  }

  /// Adds the tractions of a wave of the velocity `incident` that comes out of an endless bar: as
  /// on a clamped end, less what the motion takes.
  void act(particles::Particles<dim> &state, const Vector<dim> &incident) const
  {
    for (const Site &site : sites_) {
      Vector<dim> force = 2 * incident - site.velocity(state);
      for (int c = 0; c < dim; ++c)
        force[c] *= site.area * impedance_[c];
      add(state.force, site.particle, force);
      if constexpr (dim == 2)
        state.torque[0][site.particle] += site.lever[0] * force[1] - site.lever[1] * force[0];
      else
        add<dim>(state.torque, site.particle, site.lever.cross(force));
    }
  }

private:
  struct Site
  {
    int particle;
    double area; // m^2, across the bar
    Vector<dim> lever;

    /// Of the face: with that of the particle alone, forces at the face would pump energy.
    Vector<dim> velocity(const particles::Particles<dim> &state) const
    {
      Vector<dim> v = get(state.velocity, particle);
      if constexpr (dim == 2)
        v += state.spin[0][particle] * Vector<2>(-lever[1], lever[0]);
      else
        v += get(state.spin, particle).cross(lever);
      return v;
    }
  };
  std::vector<Site> sites_;
  std::array<double, dim> impedance_; // kg/(m^2 s)
};

/// A bar of particles alone; its upper end lets waves out.
template <int dim>
std::unique_ptr<particles::ParticleSolver<dim>> make_twin(packings::Packing<dim> packing,
                                                          const dem::DemMaterial &material)
{
  particles::Particles<dim> state;
  packings::fill_particles(packing, material.density, state);
  core::BoundaryLoad<dim> top;
  top.boundary = 2 * dim - 1;
  top.kind = core::BoundaryLoad<dim>::Kind::traction;
  top.absorbing = true;
  const auto constants = material.template elastic_constants<dim>();
  auto dashpots = packings::absorbing_dashpots<dim>(
      packing, state, {top},
      {{material.density,
        packings::isotropic_speeds<dim>(constants.wave_speed_p, constants.wave_speed_s)}});
  auto zone = std::make_unique<particles::ParticleSolver<dim>>(
      std::move(state), std::make_unique<dem::ManyBodyForce<dim>>(
                            std::move(packing), material, std::vector<core::BoundaryLoad<dim>>()));
  zone->dashpots = std::move(dashpots);
  return zone;
}

/// The particles of a coupled bar and of what it is compared with; the second twin's packing
/// differs from the first one's behind the zone.
template <int dim>
struct Packings
{
  double edge; // of the zone
  packings::Packing<dim> zone;
  std::vector<packings::Packing<dim>> twins;
};

template <int dim>
Packings<dim> lattice_packings(const StripParameters &p, double length)
{
  const auto bar = lattice_bar<dim>(p);
  const int across = p.cells_across * p.cell_size, layers = int(length / layer_height<dim>);
  return {bar.edge,
          packings::make_periodic_packing<dim>(bar.kind, across, bar.layers, false),
          {packings::make_periodic_packing<dim>(bar.kind, across, layers, true)}};
}

template <int dim>
Packings<dim> random_packings(const TwinParameters &p, const StripParameters &sp, double length)
{
  const double width = sp.cells_across * sp.cell_size;
  const double edge = sp.zone_length + double(sp.overlap_cells * sp.cell_size);
  const double all = 2 * length;
  const auto seeds = packings::make_periodic_seeds<dim>(width, length, p.seed);
  Packings<dim> packings{edge,
                         packings::pack_periodic<dim>(seeds, width, length, edge),
                         {packings::pack_periodic<dim>(seeds, width, length, all)}};
  // Two spacings behind the edge all cells of the zone have ended.
  if (p.disorder)
    packings.twins.push_back(packings::pack_periodic<dim>(
        packings::make_other_end<dim>(seeds, width, length, edge + 2, p.seed + 1), width, length,
        all));
  return packings;
}

template <int dim>
struct Bars
{
  Strip<dim> strip;
  std::vector<std::unique_ptr<particles::ParticleSolver<dim>>> twins;
};

template <int dim>
Bars<dim> make_bars(const StripParameters &p, const Packings<dim> &packings)
{
  Bars<dim> bars;
  double dt = std::numeric_limits<double>::infinity();
  for (const auto &packing : packings.twins) {
    bars.twins.push_back(make_twin<dim>(packing, p.material));
    dt = std::min(dt, bars.twins.back()->force->stable_step(bars.twins.back()->state));
  }
  bars.strip = make_strip<dim>(p, packings.zone, packings.edge, dt);
  return bars;
}

/// Energy of the difference of two motions below `end`: twice its kinetic part.
template <int dim>
double difference_energy(const particles::Particles<dim> &a, const particles::Particles<dim> &b,
                         double end)
{
  std::unordered_map<std::int64_t, int> of_id;
  for (int j = 0; j < b.size(); ++j)
    of_id[b.global_id[j]] = j;
  double sum = 0;
  for (int i = 0; i < a.size(); ++i) {
    if (a.reference[dim - 1][i] > end)
      continue;
    const int j = of_id.at(a.global_id[i]);
    sum += a.mass[i] * (get(a.velocity, i) - get(b.velocity, j)).squaredNorm() +
           a.inertia(i) * (get(a.spin, i) - get(b.spin, j)).squaredNorm();
  }
  return sum;
}

/// Incident velocity at the lower end: twelve wave lengths under cos^2, nine of them between the
/// points where it has fallen to e^-2.
struct Signal
{
  double frequency, duration; // rad/s, s

  Signal(double speed, double wave_length)
      : frequency(2 * M_PI * speed / wave_length), duration(12 * wave_length / speed)
  {
  }
  double operator()(double time) const
  {
    const double t = time - duration / 2;
    return time > duration
               ? 0
               : 1e-8 * std::pow(std::cos(M_PI * t / duration), 2) * std::cos(frequency * t);
  }
};

/// Sends the signal through the lower ends of all bars.
template <int dim>
TwinFigures run(Bars<dim> &bars, const Signal &signal, const Vector<dim> &direction,
                double duration)
{
  auto &strip = bars.strip;
  auto &twins = bars.twins;
  auto bodies = strip.bodies();
  const Port<dim> port(*strip.zone);
  std::vector<Port<dim>> twin_ports;
  for (const auto &twin : twins)
    twin_ports.emplace_back(*twin);
  const auto &first = twins.front()->state, &last = twins.back()->state;
  double sent = 0;
  TwinFigures figures{};
  coupling::StepTime time;
  time.dt = strip.dt;
  for (const long end = std::lround(duration / time.dt); time.step < end; ++time.step) {
    const Vector<dim> incident = signal(time.time) * direction;
    strip.coupler->compute_forces(bodies, time);
    port.act(strip.zone->state, incident);
    for (std::size_t k = 0; k < twins.size(); ++k) {
      twins[k]->compute_forces(time.time);
      twin_ports[k].act(twins[k]->state, incident);
    }
    sent += time.dt * port.power(incident);
    figures.reflected += time.dt * port.power(strip.zone->state, twin_ports.front(), first);
    figures.disorder += time.dt * twin_ports.back().power(last, twin_ports.front(), first);
    strip.coupler->kick(bodies, time);
    strip.coupler->drift(bodies, time);
    for (auto &twin : twins) {
      twin->kick(time.dt);
      twin->drift(time.dt);
    }
    time.time += time.dt;
  }
  figures.reflected += difference_energy(strip.zone->state, first, strip.mesh_begin);
  figures.disorder += difference_energy(last, first, strip.mesh_begin);
  strip.coupler->compute_forces(bodies, time);
  const auto e = strip.coupler->energy(bodies, time);
  return {figures.reflected / sent, figures.disorder / sent, (e.fine_damper + e.gap_filter) / sent};
}
} // namespace

template <int dim>
std::array<TwinFigures, 2> measure_twins(const TwinParameters &p)
{
  StripParameters sp = p.strip;
  const double wave_length = p.wave_length * sp.cell_size;
  sp.zone_length = 6 * sp.cell_size;
  // Until the packet has passed overlap and transition and what comes back has left the zone.
  const double near = (sp.overlap_cells + sp.transition_cells + 2) * sp.cell_size;
  const double way = 12 * wave_length + 2 * sp.zone_length + 3 * near;
  // Nothing of it may come back from the other ends by then.
  const double length = sp.zone_length + way / 2;
  sp.far_length = length;
  const auto packings =
      p.random ? random_packings<dim>(p, sp, length) : lattice_packings<dim>(sp, length);
  const auto constants = sp.material.template elastic_constants<dim>();
  const auto measure = [&](double speed, int axis) {
    Bars<dim> bars = make_bars<dim>(sp, packings);
    return run<dim>(bars, Signal(speed, wave_length), Vector<dim>::Unit(axis), way / speed);
  };
  return {measure(constants.wave_speed_p, dim - 1), measure(constants.wave_speed_s, 0)};
}

namespace
{
struct Bound
{
  double wave_length; // cells
  double reflected;   // "must"; the aim is a tenth
  bool disorder;      // in 3D that takes long
};

template <int dim>
Case twin_case(const std::string &name, const std::string &text, const std::vector<Bound> &bounds)
{
  return {name, "energy that the overlap reflects: " + text, true, [=] {
            std::vector<Result> results;
            for (const Bound &bound : bounds) {
              TwinParameters p;
              p.wave_length = bound.wave_length;
              p.disorder = bound.disorder;
              p.strip.material.poissons_ratio = 0.3;
              p.strip.split.fine_damper = 4;
              p.strip.split.gap_filter = 0;
              const auto figures = measure_twins<dim>(p);
              for (const int kind : {0, 1}) {
                const TwinFigures &f = figures[kind];
                const auto add = [&](const char *what, double value, double must,
                                     std::optional<double> aim) {
                  results.push_back({fmt::format("{}/{}_{}_{:g}h", name, what,
                                                 kind == 0 ? "P" : "S", bound.wave_length),
                                     value, must, aim});
                };
                add("reflected", f.reflected, bound.reflected, bound.reflected / 10);
                if (bound.disorder)
                  add("disorder", f.disorder, bound.reflected, {});
                if (bound.wave_length == 8)
                  add("lost", f.lost, 7e-3, 1e-3);
              }
            }
            return results;
          }};
}
} // namespace

std::vector<Case> waves_twin_cases()
{
  return {
      twin_case<2>("waves_2d_random", "2D random packing, cf 4, cg 0",
                   {{16, 5e-6, true}, {8, 1e-4, true}, {6, 6e-4, true}, {4, 6e-3, true}}),
      twin_case<3>("waves_3d_random", "3D random packing, cf 4, cg 0",
                   {{16, 1e-5, false}, {8, 3e-4, false}, {6, 1.5e-3, false}, {4, 1.5e-2, true}})};
}

template std::array<TwinFigures, 2> measure_twins<2>(const TwinParameters &);
template std::array<TwinFigures, 2> measure_twins<3>(const TwinParameters &);
} // namespace ligament::program
