// Forces, energies and stresses of atoms against the plain oracle, and what follows from the law.
#include "tests/unit/md/bodies.h"

#include "core/check.h"
#include "particles/particle_solver.h"

#include <algorithm>

namespace ligament::md::testing
{
// The oracle takes the raw form of the same potential: forces do not know the difference.
template <int dim>
void expect_agreement(Body<dim> body, double amplitude)
{
  auto force = body.force();
  auto expected = body.atoms;
  auto plain = body.oracle(body.crystal.potential());
  plain.compute(expected);
  const double at_rest = plain.energy;
  EXPECT_NEAR(force.potential_energy(body.atoms), 0, 0);
  body.disturb(amplitude);
  expected = body.atoms;
  plain.compute(expected);
  const double d = body.crystal.spacing(), scale = body.stiffness() * d,
               energy_scale = body.atoms.size() * std::abs(body.crystal.cohesive_energy());
  force.compute(body.atoms, 0);
  EXPECT_LT(difference(body.atoms.force, expected.force, scale), 1e-12);
  EXPECT_NEAR(force.potential_energy(body.atoms), plain.energy - at_rest, 1e-14 * energy_scale);
  Components<n_strains<dim>> stress;
  force.stresses(body.atoms, stress);
  for (int i = 0; i < body.atoms.size(); ++i)
    for (int k = 0; k < n_strains<dim>; ++k) {
      const int r = k < dim    ? k
                    : dim == 2 ? 0
                    : k == 3   ? 1
                               : 0,
                c = k < dim    ? k
                    : dim == 2 ? 1
                    : k == 5   ? 1
                               : 2;
      EXPECT_NEAR(stress[k][i] * body.atoms.volume[i], plain.virial[i](r, c), 1e-12 * scale * d);
    }
}

TEST(AtomForceTest, AgreesWithTheOracle)
{
  for (const double amplitude : {1e-4, 0.05, 0.15}) {
    for (const Body<3> &body : bodies()) {
      SCOPED_TRACE(body.crystal.potential().species(0).name);
      expect_agreement<3>(body, amplitude * body.crystal.spacing());
    }
    expect_agreement<2>(plane_body(), amplitude * 2.4 * angstrom);
    expect_agreement<2>(plane_body({5, 4}, {true, true}), amplitude * 2.4 * angstrom);
  }
}

// In raw form the same forces, energies to the rounding of what they are made of.
TEST(AtomForceTest, TheFormOfThePotentialDoesNotMatter)
{
  const Potential raw = foiles_copper();
  auto body = make_body<3>(raw, CrystalKind::fcc, {3, 3, 3});
  auto force = body.force();
  body.disturb(0.1 * body.crystal.spacing());
  auto expected = body.atoms;
  auto plain = body.oracle(raw);
  plain.compute(expected);
  force.compute(body.atoms, 0);
  EXPECT_LT(difference(body.atoms.force, expected.force, body.stiffness() * body.crystal.spacing()),
            1e-12);
}

// Forces are minus the slope of the energy, also with weights; 1e-6 d by central differences.
template <int dim>
void expect_gradient(Body<dim> body, const AtomForce<dim> &made)
{
  const AtomForce<dim> &force = made;
  const double d = body.crystal.spacing(), h = 1e-5 * d;
  auto &p = body.atoms;
  for (int i = 0; i < p.size(); i += 7)
    for (int c = 0; c < dim; ++c) {
      const double at = p.displacement[c][i];
      p.displacement[c][i] = at + h;
      const double above = force.potential_energy(p);
      p.displacement[c][i] = at - h;
      const double below = force.potential_energy(p);
      p.displacement[c][i] = at;
      // Third derivatives are some hundred times stiffness/d^2 where tables are rough.
      EXPECT_NEAR(-(above - below) / (2 * h) / (body.stiffness() * d),
                  p.force[c][i] / (body.stiffness() * d), 1e-7);
    }
}

TEST(AtomForceTest, ForcesAreSlopesOfTheEnergy)
{
  for (Body<3> body : bodies()) {
    if (body.crystal.parameters().kind == CrystalKind::bcc)
      continue; // the iron table's rounding spoils differences
    body.disturb(0.02 * body.crystal.spacing());
    auto force = body.force();
    force.compute(body.atoms, 0);
    expect_gradient(body, force);
  }
  Body<2> plane = plane_body();
  plane.disturb(0.02 * plane.crystal.spacing());
  auto force = plane.force();
  force.compute(plane.atoms, 0);
  expect_gradient(plane, force);
}

TEST(AtomForceTest, WeightsScaleTheEnergy)
{
  for (Body<3> body : bodies()) {
    if (body.crystal.parameters().kind == CrystalKind::bcc)
      continue;
    std::vector<double> weights;
    Noise noise(5);
    for (int i = 0; i < body.atoms.size(); ++i)
      weights.push_back(0.6 + 0.4 * noise());
    auto force = body.force(), plain = body.force(), halved = body.force();
    force.set_energy_weights(weights);
    halved.set_energy_weights(std::vector<double>(weights.size(), 0.5));
    EXPECT_THROW(halved.set_energy_weights(weights), core::InputError);
    body.disturb(0.02 * body.crystal.spacing());
    force.compute(body.atoms, 0);
    expect_gradient(body, force);
    EXPECT_NEAR(halved.potential_energy(body.atoms), 0.5 * plain.potential_energy(body.atoms),
                1e-13 * plain.potential_energy(body.atoms));
  }
}

// Every bond pulls both ends alike: nothing is left but the rounding of the sums.
TEST(AtomForceTest, KeepsMomentum)
{
  for (Body<3> body : bodies()) {
    body.disturb(0.1 * body.crystal.spacing());
    auto force = body.force();
    force.compute(body.atoms, 0);
    for (const auto &component : body.atoms.force) {
      double sum = 0, size = 0;
      for (const double f : component) {
        sum += f;
        size += std::abs(f);
      }
      EXPECT_LT(std::abs(sum), 1e-15 * size);
    }
  }
}

// No force inside the crystal at rest; a rigid motion costs nothing.
TEST(AtomForceTest, TheCrystalAtRestIsInEquilibrium)
{
  const auto crystal = Crystal<3>(mishin_copper(), {});
  Body<3> body(mishin_copper(), {}, box<3>(crystal, {8, 8, 8}));
  auto force = body.force();
  force.compute(body.atoms, 0);
  const double d = crystal.spacing(), scale = crystal.elastic_constants().stiffness(0, 0) * d * d;
  const Vector<3> middle = 4 * crystal.lattice_parameter() * Vector<3>::Ones();
  int n = 0;
  for (int i = 0; i < body.atoms.size(); ++i) {
    // Neither it nor a neighbour misses one: two cut-offs.
    if ((get(body.atoms.reference, i) - middle).cwiseAbs().maxCoeff() >
        4 * crystal.lattice_parameter() - 2 * crystal.potential().cutoff())
      continue;
    ++n;
    EXPECT_LT(get(body.atoms.force, i).norm(), 4e-15 * scale);
  }
  EXPECT_GE(n, 1);
  const Matrix<3> turn = some_rotation<3>() - Matrix<3>::Identity();
  for (int i = 0; i < body.atoms.size(); ++i)
    set(body.atoms.displacement, i,
        Vector<3>(turn * get(body.atoms.reference, i) + Vector<3>(1e-9, 0, 2e-9)));
  EXPECT_NEAR(force.potential_energy(body.atoms), 0,
              1e-14 * body.atoms.size() * std::abs(crystal.cohesive_energy()));
}

// A homogeneous strain: inside, Cauchy and Born's stress.
TEST(AtomForceTest, StressesAreThoseOfCauchyAndBorn)
{
  CrystalParameters<3> turned;
  turned.orientation = some_rotation<3>();
  auto shape = box<3>(Crystal<3>(foiles_copper(), turned), {7, 7, 7});
  shape.anchor = shape.upper / 2;
  Body<3> body(foiles_copper(), turned, shape);
  auto force = body.force();
  Noise noise(2);
  const Matrix<3> gradient = 0.01 * noise.matrix<3, 3>(), f = Matrix<3>::Identity() + gradient,
                  kirchhoff = body.crystal.stress(gradient) * f.transpose();
  for (int i = 0; i < body.atoms.size(); ++i)
    set(body.atoms.displacement, i, Vector<3>(gradient * get(body.atoms.reference, i)));
  Components<6> stress;
  force.stresses(body.atoms, stress);
  const Vector<3> middle = shape.anchor;
  const double c11 = body.crystal.elastic_constants().stiffness(0, 0);
  int n = 0;
  for (int i = 0; i < body.atoms.size(); ++i)
    if ((get(body.atoms.reference, i) - middle).cwiseAbs().maxCoeff() < 0.5 * angstrom) {
      ++n;
      EXPECT_NEAR(stress[0][i] / c11, kirchhoff(0, 0) / c11, 1e-13);
      EXPECT_NEAR(stress[3][i] / c11, kirchhoff(1, 2) / c11, 1e-13);
      EXPECT_NEAR(stress[4][i] / c11, kirchhoff(0, 2) / c11, 1e-13);
      EXPECT_NEAR(stress[5][i] / c11, kirchhoff(0, 1) / c11, 1e-13);
    }
  EXPECT_GE(n, 1);
}

// Energies of tiny motions have all their digits: they grow with the square of the amplitude.
TEST(AtomForceTest, EnergiesOfTinyMotionsKeepTheirDigits)
{
  auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {3, 3, 3}, {true, true, true});
  const auto force = body.force();
  const auto energy = [&](double amplitude) {
    body.disturb(amplitude * body.crystal.spacing());
    return force.potential_energy(body.atoms) / (amplitude * amplitude);
  };
  const double e = energy(1e-6);
  EXPECT_GT(e, 0);
  EXPECT_NEAR(energy(1e-8) / e, 1, 1e-4);
}

// What a body remembers, it takes up again to the last bit: also the order of its neighbour list.
TEST(AtomForceTest, SavedStatesGoOnToTheLastBit)
{
  auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {3, 3, 3}, {true, false, true});
  auto force = body.force();
  body.disturb(0.1 * body.crystal.spacing(), 1);
  force.compute(body.atoms, 0); // no new list
  body.disturb(0.3 * body.crystal.spacing(), 2);
  force.compute(body.atoms, 0); // a new one
  EXPECT_EQ(force.list().n_builds(), 2);
  body.disturb(0.29 * body.crystal.spacing(), 2);
  force.compute(body.atoms, 0);
  EXPECT_EQ(force.list().n_builds(), 2);
  core::State state;
  const core::Names names = body.atoms.names();
  body.atoms.save(state, names);
  force.save(state, names, body.atoms);
  Body<3> again = body;
  again.atoms = make_atoms(again.crystal, again.packing);
  again.atoms.load(state, names);
  auto loaded = again.force();
  loaded.load(state, names, again.atoms);
  loaded.compute(again.atoms, 0);
  EXPECT_EQ(again.atoms.force, body.atoms.force);
  EXPECT_EQ(loaded.potential_energy(again.atoms), force.potential_energy(body.atoms));
}

// 300 K for 2 ps: neighbours are many times looked for anew, the energy stays.
// Lists last as long in any unit of length: atoms wander, and lists are built anew after many
// steps.
TEST(AtomForceTest, ListsLastInAnyUnits)
{
  const auto n_builds = [](double unit) {
    Body<3> body = make_body<3>(lennard_jones({"A", 1}, 1, unit), CrystalKind::fcc, {4, 4, 4});
    body.options.keeps_neighbours = false;
    auto force = body.force();
    for (int k = 0; k < 20; ++k) {
      body.disturb(0.008 * k * unit);
      force.compute(body.atoms, 0);
    }
    return force.list().n_builds();
  };
  EXPECT_LT(n_builds(3.4e-10), 6);
  for (const double unit : {1e-3, 1., 1e3})
    EXPECT_LE(n_builds(unit), n_builds(3.4e-10)) << unit;
}

TEST(AtomForceTest, EnergyIsKeptInMotion)
{
  auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {3, 3, 3}, {true, true, true});
  body.options.skin = 0.2 * angstrom;
  body.options.keeps_neighbours = false;
  auto made = std::make_unique<AtomForce<3>>(body.crystal, body.packing, body.options);
  const AtomForce<3> &force = *made;
  Noise noise(4);
  // Uniform velocities of variance 2 kT/m: half of it goes into the potential.
  for (int i = 0; i < body.atoms.size(); ++i)
    for (auto &component : body.atoms.velocity)
      component[i] = std::sqrt(6 * boltzmann * 300 / body.atoms.mass[i]) * noise();
  particles::ParticleSolver<3> solver(body.atoms, std::move(made));
  const double dt = 1e-15;
  solver.compute_forces(0);
  const double first = solver.potential_energy() + solver.kinetic_energy(dt), kinetic = first;
  double last = first;
  for (int step = 1; step <= 500; ++step) {
    solver.kick(dt);
    solver.drift(dt);
    solver.compute_forces(step * dt);
    last = solver.potential_energy() + solver.kinetic_energy(dt);
  }
  EXPECT_NEAR(last / kinetic, 1, 1e-4);
  EXPECT_GT(force.list().n_builds(), 3);
}
} // namespace ligament::md::testing
