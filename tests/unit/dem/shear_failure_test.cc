// Faces that break under pressure go on as contacts: pressure and what friction carries stay, the
// energy is balanced, and strengths that scatter belong to faces, not to numbers.
#include "packings/random_packing.h"
#include "particles/particle_solver.h"
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/fracture_laws.h"

#include <numeric>

namespace ligament::dem::testing
{
namespace
{
/// Two particles with one face.
template <int dim>
Packing<dim> pair()
{
  Packing<dim> p;
  p.spacing = 1;
  p.volume = {1, 1};
  p.global_id = {0, 1};
  for (auto &c : p.centre)
    c = {0, 0};
  p.centre[0] = {-0.5, 0.5};
  const Vector<dim> n = Vector<dim>::Unit(0);
  p.faces.push_back({0, 1, n, 1, 0.5, 0.5, Vector<dim>(0.5 * n), Vector<dim>(-0.5 * n), -1, false});
  return p;
}

template <int dim>
Vector<dim> force_on_first(const Particles<dim> &p)
{
  return get(p.force, 0);
}

/// Pressed and sheared. With nu > 0 the bond presses with its volumes, too: so does the contact.
template <int dim>
void expect_friction_takes_over(double nu, double friction)
{
  constexpr double pressed = 1e-6, sheared = 2e-6, small = 1e-5 * sheared;
  const DemMaterial material{2 * (1 + nu), nu, 1, PlaneMode::stress, friction}; // G = 1
  const auto packing = pair<dim>();
  Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  p.displacement[0][1] = -pressed;
  p.displacement[1][1] = sheared;
  auto before = p;
  ManyBodyForce<dim> intact(packing, material, {});
  intact.compute(before, 0);
  const Vector<dim> bonded = get(before.force, 0);
  if (nu == 0) {
    EXPECT_NEAR(bonded[0], -2 * pressed, small); // 2G S/r = 2
  } else {
    EXPECT_LT(bonded[0], -2.1 * pressed);
  }
  EXPECT_NEAR(bonded[1], 2 * sheared, small);

  ManyBodyForce<dim> force(packing, material, {}, {FractureLaw::Criterion::von_mises, 1e-7});
  force.compute(p, 0);
  ASSERT_EQ(force.broken_bonds().size(), 1u);
  force.compute(p, 1); // the step of the break has the mean of both
  const double carried = std::min(bonded[1], -friction * bonded[0]);
  EXPECT_NEAR(get(p.force, 0)[0], bonded[0], small);
  EXPECT_NEAR(get(p.force, 0)[1], carried, small);
  // What is gone is what the contact does not have.
  EXPECT_NEAR(force.potential_energy(p) + force.fracture_energy(), intact.potential_energy(before),
              1e-4 * sheared * sheared);
  EXPECT_NEAR(force.potential_energy(p), (bonded[0] * bonded[0] + carried * carried) / 4,
              1e-4 * sheared * sheared);

  // Open for once, and closed again it presses as any contact.
  auto open = p;
  open.displacement[0][1] = 10 * pressed;
  force.compute(open, 2);
  EXPECT_EQ(get(open.force, 0).norm(), 0);
  force.compute(open, 3);
  force.resume_at(4); // jumps are no steps
  force.compute(p, 5);
  EXPECT_NEAR(get(p.force, 0)[0], -2 * pressed, 10 * small);
}
} // namespace

TEST(ShearFailure, FrictionCarriesWhatItCan)
{
  for (const double friction : {0., 0.5, 1., 5.}) {
    for (const double nu : {0., 0.3}) {
      expect_friction_takes_over<2>(nu, friction);
      expect_friction_takes_over<3>(nu, friction);
    }
  }
}

/// A block that is pressed down and drawn along: what its faces lose is booked. What the leap-frog
/// doesn't see of opening, closing and sliding falls with the step.
TEST(ShearFailure, EnergyIsBalancedWhileABlockFailsInShear)
{
  packings::LatticeParameters<2> lattice;
  lattice.kind = Kind::hexagonal;
  lattice.spacing = 1;
  lattice.upper = {20, 20};
  const auto packing = packings::make_lattice_packing<2>(lattice);
  using Load = core::BoundaryLoad<2>;
  std::vector<Load> loads(2);
  loads[0].boundary = 2;
  loads[0].kind = Load::Kind::displacement;
  loads[0].value[0] = loads[0].value[1] = 0;
  loads[1].boundary = 3;
  loads[1].kind = Load::Kind::velocity;
  loads[1].value[0] = 4e-4;
  loads[1].value[1] = -2e-4;
  loads[1].history = core::Ramp{10};
  const DemMaterial material{1., 0.3, 1, PlaneMode::strain, 0.3};
  FaceStrength rock = 6e-4;
  rock.compressive = 4;
  auto made = std::make_unique<ManyBodyForce<2>>(
      packing, material, loads, FractureLaw{FractureLaw::Criterion::drucker_prager, rock});
  const auto &force = *made;
  Particles<2> state;
  packings::fill_particles(packing, 1., state);
  particles::ParticleSolver<2> solver(std::move(state), std::move(made));
  const double dt = 0.3 * solver.force->stable_step(solver.state);
  solver.compute_forces(0);
  for (int step = 1; step * dt < 200; ++step) {
    solver.kick(dt);
    solver.drift(dt);
    solver.compute_forces(step * dt);
  }
  EXPECT_GT(force.broken_bonds().size(), 50u);
  int pressed = 0; // contacts that never opened
  for (const auto &b : force.broken_bonds()) {
    const Vector<2> u = get(solver.state.displacement, b.j) - get(solver.state.displacement, b.i);
    pressed += u.dot(b.normal) < 0;
  }
  EXPECT_GT(pressed, 10);
  // The leap-frog's invariant has 1/2 v(-) m v(+).
  const auto &p = solver.state;
  double energy = force.potential_energy(p);
  for (int i = 0; i < p.size(); ++i) {
    const Vector<2> v = get(p.velocity, i);
    const double w = p.spin[0][i];
    energy += 0.5 * v.dot(v / p.inverse_mass(i) + dt * get(p.force, i)) +
              0.5 * w * (w / p.inverse_inertia(i) + dt * p.torque[0][i]);
  }
  const particles::ForceLosses losses = force.losses();
  energy += losses.fracture + losses.friction + losses.breaking_step_error;
  EXPECT_GT(losses.friction, 0);
  EXPECT_NEAR(energy / force.external_work(), 1, 1e-3);
  RecordProperty("residual", std::to_string(energy / force.external_work() - 1));
}

TEST(Weibull, MeanAndScatterAreThoseOfTheDistribution)
{
  for (const double modulus : {3., 10.}) {
    WeibullScatter scatter{modulus, 0, 5};
    constexpr int n = 200000;
    double sum = 0, squares = 0;
    for (int k = 0; k < n; ++k) {
      const double f = scatter.factor(k, k + 7 * (k % 11) + 1, 2.);
      sum += f;
      squares += f * f;
    }
    const double mean = sum / n, variance = squares / n - mean * mean;
    const double g1 = std::tgamma(1 + 1 / modulus), g2 = std::tgamma(1 + 2 / modulus);
    const double expected = g2 / (g1 * g1) - 1;
    EXPECT_NEAR(mean, 1, 5 * std::sqrt(expected / n));
    EXPECT_NEAR(variance / expected, 1, 0.03); // five standard errors of a variance
    // Weakest-link scaling: eight times the area, eight links.
    scatter.reference_area = 1;
    EXPECT_NEAR(scatter.factor(3, 4, 8) / scatter.factor(3, 4, 1), std::pow(8, -1 / modulus),
                1e-14);
    EXPECT_EQ(scatter.factor(3, 4, 8), scatter.factor(4, 3, 8));
    EXPECT_NE(scatter.factor(3, 4, 8), scatter.factor(3, 5, 8));
  }
}

/// What the criteria take for the area of a face is its own.
TEST(Weibull, StrengthOfABodysFaceFollowsItsArea)
{
  constexpr double modulus = 4;
  const auto packing = pair<2>();
  Particles<2> p;
  packings::fill_particles(packing, 1., p);
  p.displacement[0][1] = 1e-6;
  const auto utilisation = [&](double reference_area) {
    FaceStrength strength = 1.;
    strength.scatter = {modulus, reference_area, 3};
    const DemMaterial material{1., 0, 1, PlaneMode::strain, 0};
    const ManyBodyForce<2> force(packing, material, {},
                                 {FractureLaw::Criterion::face_tension, strength});
    return force.weakest_bond(p, {0, 1}).utilisation;
  };
  const double area = packing.faces[0].area, mean = utilisation(0);
  EXPECT_NEAR(utilisation(area), mean, 1e-12 * mean);
  EXPECT_NEAR(utilisation(8 * area), mean * std::pow(8, -1 / modulus), 1e-12 * mean);
  EXPECT_NEAR(utilisation(area / 8), mean * std::pow(8, 1 / modulus), 1e-12 * mean);
}

/// The same body with its particles counted the other way round.
template <int dim>
Packing<dim> renumbered(Packing<dim> p)
{
  const int n = p.size();
  std::vector<std::int64_t> ids(n);
  for (int i = 0; i < n; ++i)
    ids[i] = p.global_id.empty() ? i : p.global_id[i];
  std::reverse(ids.begin(), ids.end());
  p.global_id = ids;
  for (auto &c : p.centre)
    std::reverse(c.begin(), c.end());
  std::reverse(p.volume.begin(), p.volume.end());
  std::reverse(p.diameter.begin(), p.diameter.end());
  std::reverse(p.faces.begin(), p.faces.end());
  for (auto &face : p.faces)
    face.i = n - 1 - face.i, face.j = n - 1 - face.j;
  for (auto &face : p.boundary_faces)
    face.i = n - 1 - face.i;
  return p;
}

/// Names of the faces that break under tension, strengths scattered or not.
std::vector<std::pair<std::int64_t, std::int64_t>> broken_names(const Packing<2> &packing,
                                                                double modulus)
{
  const DemMaterial material{1., 0.3, 1, PlaneMode::strain, 0};
  FaceStrength strength = 1e-4;
  strength.scatter = {modulus, 1e-3, 3};
  ManyBodyForce<2> force(packing, material, {}, {FractureLaw::Criterion::von_mises, strength});
  Particles<2> p;
  packings::fill_particles(packing, 1., p);
  for (int i = 0; i < p.size(); ++i)
    p.displacement[0][i] = 0.8e-4 * packing.centre[0][i];
  force.compute(p, 0);
  std::vector<std::pair<std::int64_t, std::int64_t>> names;
  for (const auto &b : force.broken_bonds())
    names.push_back(std::minmax(b.global_i, b.global_j));
  return names;
}

TEST(Weibull, StrengthsBelongToFacesUnderAnyNumbering)
{
  packings::RandomParameters<2> random;
  random.spacing = 0.01;
  random.upper.setConstant(0.2);
  const auto packing = packings::make_random_packing<2>(random).packing;
  EXPECT_TRUE(broken_names(packing, 0).empty());
  const auto names = broken_names(packing, 6);
  EXPECT_GT(names.size(), 5u);
  EXPECT_EQ(names, broken_names(renumbered(packing), 6));
}
} // namespace ligament::dem::testing
