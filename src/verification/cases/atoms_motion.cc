// Coupled atoms in motion: turned as a whole, at their critical step, and as noise.
#include "coupling/fine_scale_split.h"
#include "src/verification/bodies/atom_scene.h"
#include "src/verification/bodies/linear_atoms.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/atoms.h"
#include "src/verification/instruments/linear_motion.h"
#include "src/verification/instruments/noise_run.h"

#include <Eigen/Geometry>

#include <random>

namespace ligament::program
{
namespace
{
const AtomBody plane_crystal = {"plane_crystal", AtomPotential::plane_crystal, "",
                                PackingKind::hexagonal, 0.3};
const AtomBody lennard_jones = {"lennard_jones", AtomPotential::lennard_jones, "",
                                PackingKind::hexagonal, 0.2};
const AtomBody copper = {"copper", AtomPotential::zhou, "Cu", PackingKind::fcc};
const AtomBody iron = {"iron_turned", AtomPotential::zhou, "Fe", PackingKind::bcc, 0,
                       {1, 1, 0},     {-1, 1, 0}};
const AtomBody argon = {"argon", AtomPotential::lennard_jones, "", PackingKind::fcc};

template <int dim>
struct AtomsUnderTest
{
  explicit AtomsUnderTest(const Scene &scene, const ForceMaker<dim> &maker = make_zone_force<dim>)
      : body(make_body<dim>(scene, log, timers, maker))
  {
  }

  core::Log log;
  core::Timers timers;
  CoupledBody<dim> body;

  double c11() const { return body.far->body().stiffness(0, 0); }
  /// N: C11 h^(dim-1).
  double cell_force() const
  {
    const double h = body.coupler->overlap()->cell_size;
    return c11() * std::pow(h, dim - 1) * (dim == 2 ? body.thickness : 1);
  }
};

template <int dim>
Eigen::Matrix<double, dim, dim> right_angle()
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(M_PI / 2).toRotationMatrix();
  else {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return Eigen::AngleAxisd(M_PI / 2, Vector<3>(x, y, z).normalized()).toRotationMatrix();
  }
}

/// Forces are what a kick from rest gives: momentum over dt, of nodes by the coarse mass.
template <int dim>
std::vector<Result> turned(const std::string &name, const Scene &scene)
{
  AtomsUnderTest<dim> unit(scene);
  auto &body = unit.body;
  auto bodies = body.bodies();
  auto &split = dynamic_cast<coupling::FineScaleSplit<dim> &>(*body.coupler);
  split.set_regime(coupling::Regime::corotated, bodies);
  const Eigen::Matrix<double, dim, dim> g =
      right_angle<dim>() - Eigen::Matrix<double, dim, dim>::Identity();
  auto &zone = body.zone->state;
  for (int i = 0; i < zone.size(); ++i)
    set(zone.displacement, i, Vector<dim>(g * get(zone.reference, i)));
  const auto &mesh = body.far->mesh();
  for (int i = 0; i < mesh.n_nodes(); ++i)
    set<dim>(body.far->displacement, i, Vector<dim>(g * mesh.nodes[i]));
  split.take_velocities(bodies);
  const coupling::StepTime step{0, 0, body.dt};
  split.compute_forces(bodies, step);
  const auto e = split.energy(bodies, step);
  split.kick(bodies, step);

  const auto &overlap = *split.overlap();
  const Eigen::SparseMatrix<double> mass = split.near_mass();
  Eigen::MatrixXd velocity(overlap.n_nodes(), dim);
  for (int i = 0; i < overlap.n_nodes(); ++i)
    velocity.row(i) = get(body.far->velocity, overlap.near_nodes[i]).transpose();
  const Eigen::MatrixXd momentum = mass * velocity;
  double nodes = momentum.rowwise().norm().maxCoeff() / body.dt, atoms = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (!body.far->is_released_node(i))
      keep_largest(nodes, get(body.far->velocity, i).norm() * body.far->lumped_mass()[i] / body.dt);
  for (int i = 0; i < zone.size(); ++i)
    if (const int m = overlap.member_of_particle[i]; m < 0 || !overlap.members[m].pad)
      keep_largest(atoms, get(zone.velocity, i).norm() * zone.mass[i] / body.dt);
  double volume = 0;
  for (int i = 0; i < zone.size(); ++i)
    volume += zone.volume[i];
  const double energy = std::abs(e.potential_discrete + e.potential_far + e.blended);
  return {{name + "/nodes", nodes / unit.cell_force(), 1e-12, {}},
          {name + "/atoms", atoms / unit.cell_force(), 1e-12, {}},
          {name + "/energy", energy / (unit.c11() * volume), 1e-12, {}}};
}

/// The same crystal all over the specimen.
Scene alone(Scene scene)
{
  scene.zone.extent = DiscreteZone::Extent::all;
  scene.far_field.reset();
  return scene;
}

template <int dim>
void critical_step(const std::string &name, const Scene &scene, std::vector<Result> &results)
{
  AtomsUnderTest<dim> coupled(scene, make_linear_atoms<dim>),
      plain(alone(scene), make_linear_atoms<dim>);
  LinearMotion<dim> motion(coupled.body), plain_motion(plain.body);
  const auto [least, most] = motion.squared_frequencies();
  const double frequency = std::sqrt(most);
  results.push_back({name + "/ratio", plain_motion.largest_frequency() / frequency, 0.999, 1,
                     Result::Bound::at_least});
  results.push_back(
      {name + "/margin", 2 / frequency / coupled.body.dt_zone, 1, {}, Result::Bound::at_least});
  results.push_back({name + "/least_eigenvalue", least / most, -1e-9, {}, Result::Bound::at_least});
}

std::vector<Result> critical_steps()
{
  std::vector<Result> results;
  for (const AtomBody &b : {plane_crystal, lennard_jones})
    critical_step<2>("atoms_step/" + b.name, atom_scene(b, 60, 21, 4.1, 6), results);
  for (const AtomBody &b : {copper, argon, iron})
    critical_step<3>("atoms_step/" + b.name, atom_scene(b, 37, 12, 2.6, 5), results);
  return results;
}

Scene noisy_scene()
{
  return atom_scene(plane_crystal, 46, 18, 4.1, 5);
}

/// m/s at which strains are about this large.
template <int dim>
double speed_of(const AtomsUnderTest<dim> &unit, double strain)
{
  return strain * unit.body.force()->elastic_constants().wave_speed_p;
}

std::vector<Result> harmonic_drift(const std::string &name, long n_steps)
{
  AtomsUnderTest<2> unit(noisy_scene(), make_linear_atoms<2>);
  const int interval = int(std::max(1l, n_steps / 2000));
  const auto series = run_noise(unit.body, speed_of(unit, 1e-3), n_steps, interval, 0).leap_frog;
  // In the mean over the run. Its largest distance from the mean would be of rounding, which grows
  // with the free body's way.
  const Course c = course_of(series, interval);
  return {{name + "/drift", c.drift * std::max(1., double(n_steps) / 1e5), 1e-9, {}}};
}

/// Strains of 1e-6: the leap-frog's invariant wanders by what the crystal is not harmonic, with a
/// mesh and without. Atoms alone repeat themselves: a free edge would relax by far more.
std::vector<Result> drift_beside_plain(const std::string &name, long n_steps)
{
  AtomBody b = plane_crystal;
  b.angle = 0;
  const Scene coupled_scene = atom_scene(b, 46, 18, 4.1, 5);
  Scene plain_scene = alone(coupled_scene);
  plain_scene.specimen.periodic = {{Axis::x}, {Axis::y}};
  for (int c = 0; c < 2; ++c)
    plain_scene.specimen.size[c] = coupled_scene.zone.upper[c] - coupled_scene.zone.lower[c];
  resolve_atoms(plain_scene, nullptr); // whole periods
  const int interval = int(std::max(1l, n_steps / 2000));
  const auto course = [&](const Scene &scene) {
    AtomsUnderTest<2> unit(scene);
    return course_of(run_noise(unit.body, speed_of(unit, 1e-6), n_steps, interval, 0).leap_frog,
                     interval);
  };
  const Course coupled = course(coupled_scene), plain = course(plain_scene);
  return {
      {name + "/fluctuation", coupled.fluctuation, 1e-4, {}},
      {name + "/over_plain", coupled.fluctuation / plain.fluctuation, 2, {}},
      {name + "/drift_over_plain", coupled.drift / std::max(plain.drift, 2 * plain.error), 2, {}}};
}
} // namespace

std::vector<Case> atom_motion_cases()
{
  const std::string noise = "noise of coupled atoms at 0.9 of the critical step, ";
  return {{"atoms_turn", "atoms and mesh turned by 90 degrees, 2D", false,
           [] { return turned<2>("atoms_turn", atom_scene(plane_crystal, 60, 21, 4.1, 6)); }},
          {"atoms_turn_3d", "the same about an axis at random, copper", true,
           [] {
             Scene scene = atom_scene(copper, 36, 10, 2.6, 5);
             scene.specimen.periodic.clear();
             scene.specimen.size[1] = scene.specimen.size[2] = scene.specimen.size[0];
             for (const int c : {1, 2}) {
               scene.zone.lower[c] = scene.zone.lower[0];
               scene.zone.upper[c] = scene.zone.upper[0];
             }
             return turned<3>("atoms_turn_3d", scene);
           }},
          {"atoms_step", "critical step of coupled atoms over that of atoms alone", false,
           critical_steps},
          {"atoms_drift", noise + "harmonic, 5e3 steps", false,
           [] { return harmonic_drift("atoms_drift", 5000); }},
          {"atoms_drift_long", noise + "harmonic, 1e6 steps", true,
           [] { return harmonic_drift("atoms_drift_long", 1000000); }},
          {"atoms_drift_beside_plain", noise + "strain 1e-6, against atoms alone, 1e4 steps", false,
           [] { return drift_beside_plain("atoms_drift_beside_plain", 10000); }}};
}
} // namespace ligament::program
