// Values against each other: speeds against that of sound, loads against stiffness, how many steps.
#include "core/time_function.h"
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// Speed of P waves in m/s, plane strain or 3D.
double wave_speed(const MaterialParameters &m)
{
  const double nu = m.poissons_ratio;
  return std::sqrt(m.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu) * m.density));
}

double largest(const PartialPoint &value)
{
  double largest = 0;
  for (const auto &component : value)
    largest = std::max(largest, std::abs(component.value_or(0)));
  return largest;
}

double length(const Point &p)
{
  return std::hypot(p[0], p[1], p[2]);
}

/// By what the course of a load or motion multiplies it at most, up to a time in s: the sign does
/// not count.
double largest_factor(const History &h, double end)
{
  if (h.cycles)
    return std::abs(h.cycles->mean) + std::abs(h.cycles->amplitude);
  if (h.table.empty()) // ramps and pulses rise to 1
    return 1;
  const core::TimeTable table(h.table);
  double factor = std::max(std::abs(table.value(0)), std::abs(table.value(end)));
  for (const auto &[time, value] : h.table)
    if (time <= end)
      factor = std::max(factor, std::abs(value));
  return factor;
}

/// Value, unit and name of a load as messages say them; its course in time may raise or lower it.
std::string value_text(const std::string &name, const std::string &key, double value,
                       const char *unit, double factor)
{
  return fmt::format("\"{}\" in {} is {:.3g} {}{}", name, key, value * factor, unit,
                     factor == 1 ? "" : " at the peak of its history");
}

/// What a scene says moves or turns.
struct GivenSpeed
{
  std::string section, name;
  double value;
  double factor = 1; // that its history raises it by
  const char *unit = "m/s";
  double arm = 1; // m from the axis, of a spin
};

/// What moves at this share of the speed of P waves (m/s) strains what stands still before it as
/// much.
void check_speed(const GivenSpeed &given, double wave_speed, Findings &f)
{
  const double share = given.factor * given.value * given.arm / wave_speed;
  const std::string message =
      value_text(given.name, given.section, given.value, given.unit, given.factor);
  const std::string reason =
      fmt::format("P waves of this material travel at {:.4g} m/s: the front strains it by {:.2g}",
                  wave_speed, share);
  const std::string remedy = "give a slower one, or check its unit and those of /material";
  const std::string key = given.section + "/" + given.name;
  if (share > 1)
    f.error(key, message + ", faster than sound", reason, remedy);
  else if (share > 0.1)
    f.warning(key, message + ", more than a tenth of the speed of sound", reason, remedy);
}

void check_traction(const LoadParameters &load, const std::string &key, double modulus,
                    double factor, Findings &f)
{
  const double stress = std::max(largest(load.traction), std::abs(load.pressure.value_or(0)));
  const std::string name = load.pressure ? "pressure" : "traction";
  const double share = factor * stress / modulus;
  const std::string message = value_text(name, key, stress, "Pa", factor);
  const std::string reason = fmt::format("\"youngs_modulus\" in /material is {:.3g} Pa", modulus);
  if (share > 1)
    f.error(key + "/" + name, message + ", more than Young's modulus", reason,
            "give a smaller one, or check both units");
  else if (share > 0.1)
    f.warning(key + "/" + name, message + ", a strain of more than a tenth", reason,
              "give a smaller one, or check both units");
}

void check_displacement(const Scene &scene, const LoadParameters &load, const std::string &key,
                        double factor, Findings &f)
{
  const auto &size = scene.specimen.size;
  const double extent = *std::max_element(size.begin(), size.end());
  if (extent > 0 && factor * largest(load.displacement) > extent / 2) // 0: its file was refused
    f.warning(key + "/displacement",
              value_text("displacement", key, largest(load.displacement), "m", factor) +
                  ", more than half of the specimen",
              fmt::format("the specimen is {:.3g} m long", extent),
              "give a smaller one, or check both units");
}

/// s; infinite where none is given.
double end_of(const Scene &scene, const Findings &f)
{
  return f.sound_and_given({"/time/duration"}) ? scene.time.duration : infinity;
}

bool has_wave_speed(const Scene &scene, const Findings &f)
{
  return f.sound({"/material", "/atoms"}) && scene.material.youngs_modulus > 0;
}

void check_load_scales(const Scene &scene, Findings &f)
{
  for (std::size_t k = 0; k < scene.loads.size(); ++k) {
    const std::string key = fmt::format("/loads/{}", k);
    if (!f.sound({key}))
      continue;
    const LoadParameters &load = scene.loads[k];
    const double factor = largest_factor(load.history, end_of(scene, f));
    if (has_wave_speed(scene, f)) {
      check_speed({key, "velocity", largest(load.velocity), factor}, wave_speed(scene.material), f);
      check_traction(load, key, scene.material.youngs_modulus, factor, f);
    }
    if (f.sound({"/specimen/size"}))
      check_displacement(scene, load, key, factor, f);
  }
}

/// Of tools, and of the body where it begins.
void check_motion_scales(const Scene &scene, Findings &f)
{
  if (!has_wave_speed(scene, f))
    return;
  const double speed = wave_speed(scene.material);
  for (std::size_t k = 0; k < scene.tools.size(); ++k) {
    const std::string key = fmt::format("/tools/{}", k);
    if (!f.sound({key}))
      continue;
    const ToolParameters &tool = scene.tools[k];
    check_speed(
        {key, "velocity", largest(tool.velocity), largest_factor(tool.history, end_of(scene, f))},
        speed, f);
    check_speed({key, "initial_velocity", length(tool.initial_velocity)}, speed, f);
  }
  for (std::size_t k = 0; k < scene.initial_motion.size(); ++k) {
    const std::string key = fmt::format("/initial_motion/{}", k);
    if (!f.sound({key}))
      continue;
    const InitialMotion &motion = scene.initial_motion[k];
    check_speed({key, "velocity", length(motion.velocity)}, speed, f);
    if (f.sound({"/specimen/size"})) // at half the body's diagonal from the centre
      check_speed({key, "spin", length(motion.spin), 1, "rad/s", length(scene.specimen.size) / 2},
                  speed, f);
  }
}

void check_strength(const Scene &scene, Findings &f)
{
  const std::string key = "/material/fracture/strength";
  if (!f.sound_and_given({key}) || !f.sound({"/material/youngs_modulus"}))
    return;
  const double strength = *scene.material.fracture.strength,
               modulus = scene.material.youngs_modulus;
  if (strength > modulus / 2)
    f.warning(
        key,
        fmt::format("\"strength\" in /material/fracture is {:.3g} Pa, more than half of "
                    "Young's modulus",
                    strength),
        fmt::format("\"youngs_modulus\" in /material is {:.3g} Pa: nothing will break", modulus),
        "check both units");
}

/// A wave needs about a step from one particle, or node, to the next; s.
double typical_step(const Scene &scene)
{
  const bool particles = scene.zone.extent != DiscreteZone::Extent::none;
  const double length = particles         ? scene.zone.spacing
                        : scene.far_field ? scene.far_field->cell_size
                                          : 0;
  return length / wave_speed(scene.material);
}

/// The least time in s in which the course of a load changes by more than a tenth of its largest
/// value, up to a time in s; 0: it is there at once.
double shortest_change(const LoadParameters &load, double end)
{
  const History &h = load.history;
  if (h.cycles) {
    const double swing = h.cycles->amplitude != 0 ? h.cycles->period / 4 : infinity;
    return h.cycles->mean != 0 ? std::min(load.ramp, swing) : swing;
  }
  if (h.pulse) // a wavelet goes from its trough to its peak in an eighth of it
    return h.pulse->duration / (h.pulse->shape == PulseShape::ricker ? 8 : 2);
  if (h.table.empty())
    return load.ramp;
  const double small = 0.1 * largest_factor(load.history, end);
  double shortest = std::abs(h.table.front()[1]) > small ? 0 : infinity;
  for (std::size_t k = 1; k < h.table.size(); ++k)
    if (h.table[k - 1][0] < end && std::abs(h.table[k][1] - h.table[k - 1][1]) > small)
      shortest = std::min(shortest, h.table[k][0] - h.table[k - 1][0]);
  return shortest;
}

/// Sides that jump, beside a mesh that takes larger steps than the particles.
void check_jumping_side(const Scene &scene, const LoadParameters &load, const std::string &key,
                        Findings &f)
{
  if (largest(load.displacement) == 0 || scene.coupling.step_ratio <= 1 ||
      scene.time.has_phases() || scene.zone.extent != DiscreteZone::Extent::box ||
      !f.sound({"/coupling/step_ratio", "/time"}))
    return;
  const bool has_step = f.sound({"/material", "/atoms", "/discrete_zone"});
  const double step = has_step ? scene.time.step.value_or(typical_step(scene)) : 0;
  const double far_step = std::isfinite(step) ? scene.coupling.step_ratio * step : 0;
  const double change = shortest_change(load, scene.time.duration);
  if (change > 0 && !(change < far_step))
    return;
  const std::string reason =
      "how a jump swings the overlap between two steps of the mesh is not in the energy "
      "ledger: its residual may be nearly as large as the work";
  const std::string beside =
      fmt::format("beside a \"step_ratio\" of {} in /coupling", scene.coupling.step_ratio);
  const bool has_history = load.history.is_given();
  if (change == 0)
    f.warning(has_history ? key + "/history" : key + "/displacement",
              fmt::format("\"displacement\" in {} is there at once{}, {}", key,
                          has_history ? " by its history" : "", beside),
              reason,
              load.history.cycles || !has_history
                  ? "give it a \"ramp\", or a step ratio of 1"
                  : "let the history begin at 0 and rise from there, or give a step ratio of 1");
  else
    f.warning(has_history ? key + "/history" : key + "/ramp",
              fmt::format("\"displacement\" in {} jumps within {:.2g} s, {}", key, change, beside),
              fmt::format("a step of the mesh takes about {:.2g} s, and {}", far_step, reason),
              "let it change over some steps of the mesh, or give a step ratio of 1");
}

void check_jumping_sides(const Scene &scene, Findings &f)
{
  for (std::size_t k = 0; k < scene.loads.size(); ++k)
    if (const auto key = fmt::format("/loads/{}", k); f.sound({key}) && !scene.loads[k].periodic)
      check_jumping_side(scene, scene.loads[k], key, f);
}

void check_duration(const Scene &scene, Findings &f)
{
  const bool particles = scene.zone.extent != DiscreteZone::Extent::none;
  if (!f.sound_and_given({"/time/duration"}) ||
      !f.sound({"/material", "/discrete_zone", "/far_field"}) ||
      (particles ? !f.given("/discrete_zone/spacing") : !scene.far_field))
    return;
  const double step = scene.time.step.value_or(typical_step(scene));
  if (!(step > 0)) // the material is not known
    return;
  const double steps = scene.time.duration / step;
  // Equilibria skip most steps, but the clock counts them all: it must be able to tell two apart.
  if (scene.time.has_phases() ? steps <= 1e14 : steps <= 1e12)
    return;
  if (scene.time.has_phases())
    f.error("/time/duration",
            fmt::format("\"duration\" in /time is {} s, about {:.1e} steps", scene.time.duration,
                        steps),
            fmt::format("a step takes about {:.2g} s of it, and a clock of 16 digits tells no more "
                        "than 1e14 of them well apart",
                        step),
            "load faster, or check the unit and those of /material");
  else
    f.error("/time/duration",
            fmt::format("\"duration\" in /time is {} s, about {:.1e} steps", scene.time.duration,
                        steps),
            fmt::format("a step takes about {:.2g} s of it, and more than 1e12 are beyond any "
                        "machine",
                        step),
            "give a shorter one, or check its unit and those of /material");
}

/// A clock in the scene that does not strike within the run.
void check_interval(const Scene &scene, const std::string &key, const std::string &name,
                    double interval, Findings &f)
{
  if (std::isfinite(interval) && interval > scene.time.duration &&
      f.sound_and_given({key, "/time/duration"}))
    f.warning(key, fmt::format("{} is {} s, longer than the duration", name, interval),
              fmt::format("\"duration\" in /time is {} s", scene.time.duration),
              "give a shorter one, or check both units");
}

void check_intervals(const Scene &scene, Findings &f)
{
  check_interval(scene, "/output/history_interval", "\"history_interval\" in /output",
                 scene.output.history_interval, f);
  check_interval(scene, "/output/field_interval", "\"field_interval\" in /output",
                 scene.output.field_interval, f);
  for (std::size_t k = 0; k < scene.gauges.size(); ++k) {
    const std::string key = fmt::format("/gauges/{}", k);
    check_interval(scene, key + "/smoothing", fmt::format("\"smoothing\" in {}", key),
                   scene.gauges[k].smoothing, f);
  }
}

/// There is at most one row of the history per step.
void check_rows(const Scene &scene, Findings &f)
{
  const std::string key = "/output/history_interval";
  const double step = scene.time.step.value_or(typical_step(scene)),
               interval = scene.output.history_interval;
  if (scene.time.has_phases() || interval == 0 || !(interval <= 0.1 * step) ||
      !f.sound_and_given({key}) || !f.sound({"/material", "/discrete_zone", "/far_field", "/time"}))
    return;
  f.warning(key,
            fmt::format("\"history_interval\" in /output is {} s, far less than a step", interval),
            fmt::format("a step takes about {:.2g} s, and has one row at most", step),
            "give a longer one, or check its unit");
}

void check_output(const Scene &scene, Findings &f)
{
  const std::string key = "/output/field_interval";
  if (!f.sound_and_given({key, "/time/duration"}))
    return;
  const double outputs = scene.time.duration / scene.output.field_interval;
  if (outputs > 1e4)
    f.warning(key,
              fmt::format("\"field_interval\" in /output is {} s, {:.1e} outputs of all fields",
                          scene.output.field_interval, outputs),
              fmt::format("\"duration\" in /time is {} s", scene.time.duration),
              "give a longer one, or check both units");
}
} // namespace

void check_scales(const Scene &scene, Findings &f)
{
  check_load_scales(scene, f);
  check_motion_scales(scene, f);
  check_jumping_sides(scene, f);
  check_strength(scene, f);
  check_duration(scene, f);
  check_intervals(scene, f);
  check_rows(scene, f);
  check_output(scene, f);
}
} // namespace ligament::program
