// The row kernel agrees with the plain oracle on bodies of every shape that its window meets, with
// every instruction set of the machine.
#include "core/dispatch.h"
#include "tests/oracle/many_body_oracle.h"
#include "tests/unit/dem/cases.h"

#include <hwy/highway.h>

namespace ligament::dem::testing
{
struct RowKernel : ::testing::Test
{
  ~RowKernel() override { hwy::SetSupportedTargetsForTest(0); }

  static std::vector<std::int64_t> targets()
  {
    std::vector<std::int64_t> found;
    hwy::SetSupportedTargetsForTest(0);
    for (const std::int64_t target : {HWY_EMU128, HWY_AVX2, HWY_AVX3})
      if (hwy::SupportedTargets() & target)
        found.push_back(target);
    return found;
  }

  /// A box of so many spacings along the axes, in a random state, with faces cracked at random.
  template <int dim>
  static void compare(Kind kind, const Vector<dim> &size)
  {
    particles::LatticeParameters<dim> lattice;
    lattice.kind = kind;
    lattice.spacing = 0.01;
    lattice.upper = lattice.spacing * size;
    auto packing = particles::make_lattice_packing<dim>(lattice);
    std::mt19937 random(7);
    for (auto &face : packing.faces)
      face.cracked = random() % 50 == 0;
    const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
    ManyBodyForce<dim> force(packing, material, {});
    Particles<dim> p;
    particles::fill_particles(packing, 1., p);
    disturb<dim>(p, packing.spacing, 1e-3, Spin<dim>::Constant(0.4), 5);
    for (int i = 0; i < p.size(); ++i) // swollen: the oracle knows no contact
      for (int c = 0; c < dim; ++c)
        p.displacement[c][i] =
            1.02 * (p.displacement[c][i] + p.reference[c][i]) - p.reference[c][i];
    auto q = p;
    const double energy = oracle::ManyBodyOracle<dim>(packing, 3., 0.3).compute(q);
    for (const std::int64_t target : targets()) {
      hwy::SetSupportedTargetsForTest(target);
      force.compute(p, 0);
      expect_close(p.force, q.force);
      expect_close(p.torque, q.torque);
      const auto first_force = p.force;
      const auto first_torque = p.torque;
      force.compute(p, 0);
      EXPECT_EQ(p.force, first_force); // to the last bit
      EXPECT_EQ(p.torque, first_torque);
      // Squares of what forces are: round-off of positions as below.
      EXPECT_NEAR(force.potential_energy(p), energy, 1e-9 * energy);
      EXPECT_EQ(force.potential_energy(p), force.potential_energy(p));
    }
  }

  /// To round-off of the largest force on a face: positions are known to 1e-16 of the body's size,
  /// faces move by 1e-2 spacings.
  template <typename C>
  static void expect_close(const C &a, const C &b)
  {
    double scale = 0, error = 0;
    for (std::size_t c = 0; c < a.size(); ++c)
      for (std::size_t i = 0; i < a[c].size(); ++i) {
        scale = std::max(scale, std::abs(b[c][i]));
        error = std::max(error, std::abs(a[c][i] - b[c][i]));
      }
    EXPECT_LT(error, 1e-9 * scale);
  }
};

TEST_F(RowKernel, WindowSlides)
{
  compare<2>(Kind::hexagonal, {11.3, 350.2});
  compare<2>(Kind::square, {40.3, 90.2});
  compare<3>(Kind::fcc, {6.3, 5.2, 120.4});
  compare<3>(Kind::simple_cubic, {5.3, 6.2, 110.4});
}

TEST_F(RowKernel, RowsShorterThanAVector)
{
  compare<2>(Kind::hexagonal, {2.3, 30.2});
  compare<3>(Kind::fcc, {2.3, 2.2, 20.4});
}

TEST_F(RowKernel, RowsTooLongForTheCloseWindow)
{
  compare<2>(Kind::square, {11500.3, 3.2});
}
} // namespace ligament::dem::testing
