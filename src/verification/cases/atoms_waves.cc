// Waves that leave coupled atoms, and what the overlap costs.
#include "src/verification/bodies/atom_scene.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/atoms.h"
#include "src/verification/instruments/bloch.h"

#include <fmt/format.h>

namespace ligament::program
{
namespace
{
constexpr double cell = 4; // d
constexpr int overlap_cells = 6;

/// Copper along [100], the long axis z; three cells across, joined sideways. Undamped but for the
/// fine damper.
struct Bar
{
  Scene scene;
  double lower, upper; // m, of the part without overlap
  double end;          // m, of the zone
};

/// Lengths in spacings.
Bar copper_bar(double inner, double far, double fine_damper, int transition_cells)
{
  Bar bar;
  Scene &s = bar.scene;
  s = atom_scene({"copper", AtomPotential::zhou, "Cu", PackingKind::fcc}, 100, 40, cell,
                 overlap_cells);
  const double d = s.zone.spacing, overlap = overlap_cells * cell;
  s.coupling.fine_damper = fine_damper;
  s.coupling.transition_cells = transition_cells;
  s.specimen.periodic = {{Axis::x}, {Axis::y}};
  const double across = 3.2 * cell * d, before = 16 * cell;
  s.specimen.size = {across, across, (before + inner + 2 * overlap + far) * d};
  resolve_atoms(s, nullptr); // whole periods
  for (const int c : {0, 1}) {
    s.zone.upper[c] = s.specimen.size[c];
    s.zone.lower[c] = -s.zone.upper[c];
  }
  s.zone.lower[2] = -s.specimen.size[2] / 2 + before * d;
  s.zone.upper[2] = s.zone.lower[2] + (inner + 2 * overlap) * d;
  bar.lower = s.zone.lower[2] + overlap * d;
  bar.upper = s.zone.upper[2] - overlap * d;
  bar.end = s.zone.upper[2];
  return bar;
}

double kinetic_energy(const particles::Particles<3> &atoms, const Bar &bar)
{
  double sum = 0;
  for (int i = 0; i < atoms.size(); ++i)
    if (atoms.reference[2][i] > bar.lower && atoms.reference[2][i] < bar.upper)
      sum += atoms.mass[i] * get(atoms.velocity, i).squaredNorm() / 2;
  return sum;
}

void set_packet(particles::Particles<3> &atoms, const Packet<3> &packet, double amplitude)
{
  for (int i = 0; i < atoms.size(); ++i) {
    const auto motion = packet.at(get(atoms.reference, i));
    set<3>(atoms.displacement, i, Vector<3>(amplitude * motion.displacement));
    set<3>(atoms.velocity, i, Vector<3>(amplitude * motion.velocity));
  }
}

int inner_atom(const particles::Particles<3> &atoms, const Bar &bar)
{
  int nearest = 0;
  const Vector<3> middle(0, 0, (bar.lower + bar.upper) / 2);
  for (int i = 1; i < atoms.size(); ++i)
    if ((get(atoms.reference, i) - middle).norm() < (get(atoms.reference, nearest) - middle).norm())
      nearest = i;
  return nearest;
}

/// Energy that comes back of a packet of waves of so many cells, over its own.
double reflected(double cells, WaveKind kind, int transition_cells)
{
  const double width = 34, reach = 4.5 * width; // d: the envelope falls to 4e-5
  Bar bar = copper_bar(2 * reach, 1.25 * reach, 8, transition_cells);
  UnitBody<3> unit(bar.scene);
  auto &body = unit.body;
  auto &atoms = body.zone->state;
  const double d = body.spacing, wave_length = cells * cell * d;
  const BlochWaves<3> waves(atoms, *body.force(), inner_atom(atoms, bar), 2,
                            bar.scene.specimen.size[0]);
  const Vector<3> k = 2 * M_PI / wave_length * Vector<3>::UnitZ();
  const Packet<3> packet([&](const Vector<3> &q) { return waves.modes(q); }, k, kind, width * d,
                         bar.lower + reach * d, body.dt);
  set_packet(atoms, packet, 1e-6 * wave_length / (2 * M_PI)); // strain 1e-6
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
  const double first = kinetic_energy(atoms, bar);
  const Vector<3> along = polarisation<3>(kind, k);
  const double speed = waves.group_velocity(k.norm(), along);
  // Until all has left, and for one wave length more, over which kinetic energy is half of all.
  const double left = (bar.end - bar.lower) / speed, until = left + wave_length / speed;
  coupling::StepTime step{0, 0, body.dt};
  double sum = 0;
  long samples = 0;
  for (; step.time < until; ++step.step, step.time += body.dt) {
    body.coupler->compute_forces(bodies, step);
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
    if (step.time > left && step.step % 5 == 0) {
      sum += kinetic_energy(atoms, bar);
      ++samples;
    }
  }
  return sum / double(samples) / first;
}

/// Of waves of 8 cells the overlap itself sends back less than the transition of the mass behind
/// it, which is twelve cells wide here; with the six of the default the bound is that of elements.
std::vector<Result> reflection()
{
  struct Wave
  {
    double cells;
    WaveKind kind;
    const char *name;
    int transition_cells;
    double must;
    std::optional<double> aim;
  };
  std::vector<Result> results;
  for (const Wave &w :
       {Wave{8, WaveKind::p, "P_8h", 12, 1e-5, 5e-6}, Wave{8, WaveKind::s, "S_8h", 12, 1e-5, 5e-6},
        Wave{4, WaveKind::p, "P_4h", 12, 1e-3, 3e-4}, Wave{4, WaveKind::s, "S_4h", 12, 1e-3, 3e-4},
        Wave{8, WaveKind::p, "P_8h_six_cells", 6, 1e-4, {}}})
    results.push_back({fmt::format("atoms_reflection/{}", w.name),
                       reflected(w.cells, w.kind, w.transition_cells), w.must, w.aim});
  return results;
}

/// Seconds of the timers' row of this name.
double seconds(const core::Timers &timers, const std::string &name)
{
  for (const auto &row : timers.rows())
    if (row.name == name)
      return row.seconds;
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<Result> overlap_cost()
{
  const Bar bar = copper_bar(60, 100, 8, 6);
  UnitBody<3> unit(bar.scene);
  auto &body = unit.body;
  auto bodies = body.bodies();
  coupling::StepTime step{0, 0, body.dt};
  const double before = seconds(unit.timers, "coupling");
  const double forces_before = seconds(unit.timers, "discrete forces");
  for (; step.step < 200; ++step.step, step.time += body.dt) {
    body.coupler->compute_forces(bodies, step);
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  const double members = double(body.coupler->overlap()->members.size());
  const double extra = (seconds(unit.timers, "coupling") - before) / members,
               plain = (seconds(unit.timers, "discrete forces") - forces_before) /
                       body.zone->state.size();
  return {{"atoms_overlap_cost/share", extra / plain, 0.5, {}}};
}
} // namespace

std::vector<Case> atom_wave_cases()
{
  return {{"atoms_reflection", "energy that copper's overlap reflects, waves of 8 and 4 cells",
           true, reflection},
          {"atoms_overlap_cost", "extra time per overlap atom over that of the atoms' forces", true,
           overlap_cost}};
}
} // namespace ligament::program
