// Crystals at a temperature, against the free energy of the same atoms' small vibrations.
#include "md/analytic.h"
#include "md/atom_force.h"
#include "md/atomic_units.h"
#include "md/crystal_packing.h"
#include "md/thermal_crystal.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace ligament::md
{
namespace
{
constexpr double boltzmann = 1.380649e-23;

Potential plane()
{
  return plane_crystal({"A", 1e-25}, 1e-19, 3e-10);
}

/// N static energies and kT/2 sum ln k of the vibrations of a periodic crystal, in J.
double free_energy(const Potential &potential, double a, double kt)
{
  CrystalParameters<2> p;
  p.lattice_parameter = a;
  const Crystal<2> crystal(potential, p);
  CrystalShape<2> shape;
  shape.upper = a * Vector<2>(7, 4 * std::sqrt(3.));
  shape.periodic.fill(true);
  const auto packing = cut_crystal(crystal, shape);
  const auto atoms = make_atoms(crystal, packing);
  const AtomForce<2> force(crystal, packing);
  const int n = atoms.size();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  force.add_tangent(atoms, [&](const particles::QuadraticTerm<2> &term) {
    const auto m = term.members.size();
    const Eigen::MatrixXd rows = term.rows;
    const Eigen::MatrixXd own = rows.transpose() * term.stiffness.asDiagonal() * rows;
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j)
        k.block<2, 2>(2 * term.members[i], 2 * term.members[j]) += own.block<2, 2>(2 * i, 2 * j);
  });
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k, Eigen::EigenvaluesOnly).eigenvalues();
  double sum = 0;
  for (int i = 2; i < 2 * n; ++i) // without translations
    sum += std::log(values[i]);
  return n * crystal.cohesive_energy() + kt / 2 * sum;
}

TEST(ThermalCrystal, ExpandsAsTheFreeEnergySays)
{
  const double kt = 1e-19 * 2e-3; // of what binds an atom
  const double a0 = Crystal<2>(plane(), {}).lattice_parameter(), h = 2e-3 * a0;
  ThermalRun run;
  run.thermal_energy = kt;
  run.n_atoms = 110; // the box of the sum
  run.lattice_steps = 100000;
  const auto lattice = thermal_lattice<2>(plane(), {}, run);
  // Newton's method on the slope of the free energy.
  double a = a0;
  for (int k = 0; k < 6; ++k) {
    const double e[] = {free_energy(plane(), a - h, kt), free_energy(plane(), a, kt),
                        free_energy(plane(), a + h, kt)};
    a -= (e[2] - e[0]) / 2 * h / (e[2] - 2 * e[1] + e[0]);
  }
  std::printf("expansion %.5f +- %.5f, small vibrations %.5f\n", lattice.parameter / a0 - 1,
              lattice.error / a0, a / a0 - 1);
  // The next order is smaller by kT over what binds an atom, times a number of the order of 10.
  const double expansion = a / a0 - 1;
  EXPECT_GT(expansion, 1e-4);
  EXPECT_LT(lattice.error / a0, 1e-4);
  EXPECT_NEAR(lattice.parameter / a0 - 1, expansion,
              5 * lattice.error / a0 + 10 * 2e-3 * expansion);
}

// In the limit of no heat the constants are those of the lattice.
TEST(ThermalCrystal, HasTheStaticConstantsWhereItIsCold)
{
  ThermalRun run;
  run.thermal_energy = 1e-26;
  run.n_atoms = 300;
  run.stiffness_steps = 400;
  const Crystal<3> crystal(zhou_johnson_wadley({"Cu"}), {});
  CrystalParameters<3> p;
  p.lattice_parameter = crystal.lattice_parameter();
  const auto c = thermal_constants<3>(zhou_johnson_wadley({"Cu"}), p, run);
  const auto expected = crystal.elastic_constants().stiffness;
  // Central differences over 1 %: some 1e-3 by the fourth order of the energy.
  const Stiffness<3> found = stiffness_of<3>(c, Matrix<3>::Identity());
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 4e-3 * expected(0, 0));
  // And turned as the crystal is.
  p.orientation = orientation_of(Vector<3>(1, 1, 0), Vector<3>(-1, 1, 0));
  p.lattice_parameter = 0;
  const Stiffness<3> turned =
      Crystal<3>(zhou_johnson_wadley({"Cu"}), p).elastic_constants().stiffness;
  EXPECT_LT((stiffness_of<3>(c, p.orientation) - turned).cwiseAbs().maxCoeff(),
            4e-3 * expected(0, 0));
}

// The stress of a lattice that was given, and C and stress against differences of P.
TEST(ThermalCrystal, AStretchedLatticeKnowsItsStress)
{
  CrystalParameters<3> p;
  p.orientation = orientation_of(Vector<3>(1, 1, 0), Vector<3>(-1, 1, 1));
  p.lattice_parameter = 1.005 * Crystal<3>(zhou_johnson_wadley({"Cu"}), p).lattice_parameter();
  const Crystal<3> crystal(zhou_johnson_wadley({"Cu"}), p);
  const auto constants = crystal.elastic_constants();
  const Matrix<3> stress = crystal.stress(Matrix<3>::Zero());
  EXPECT_GT(stress(0, 0), 1e9);
  EXPECT_NEAR(constants.stress[0], stress(0, 0), 1e-9 * stress(0, 0));
  const auto a = crystal.moduli(Matrix<3>::Zero());
  // Minor symmetry of what is left when the stress is taken out of A: (C23).
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          EXPECT_NEAR(a(3 * i + j, 3 * k + l) - (i == k) * stress(j, l),
                      a(3 * j + i, 3 * k + l) - (j == k) * stress(i, l), 1e-12 * a(0, 0));
}

TEST(SlowThermalCrystal, CopperAt300Kelvin)
{
  ThermalRun run;
  run.thermal_energy = boltzmann * 300;
  const double a0 = Crystal<3>(zhou_johnson_wadley({"Cu"}), {}).lattice_parameter();
  CrystalParameters<3> p;
  const auto lattice = thermal_lattice<3>(zhou_johnson_wadley({"Cu"}), p, run);
  p.lattice_parameter = lattice.parameter;
  std::printf("copper: a(0) %.5f, a(300 K) %.5f +- %.5f angstrom, u %.4f d\n", a0 / angstrom,
              lattice.parameter / angstrom, lattice.error / angstrom,
              std::sqrt(lattice.squared_displacement) / (a0 / std::sqrt(2.)));
  EXPECT_LT(lattice.error / a0, 5e-5);
  const auto c = thermal_constants<3>(zhou_johnson_wadley({"Cu"}), p, run);
  std::printf("C11, C12, C44 %.1f %.1f %.1f +- %.1f GPa\n", c.c11 / 1e9, c.c12 / 1e9, c.c44 / 1e9,
              c.error / 1e9);
}
} // namespace
} // namespace ligament::md
