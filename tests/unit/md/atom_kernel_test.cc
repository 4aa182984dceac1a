// The vector kernel against the plain oracle with every instruction set of the machine.
#include "core/dispatch.h"
#include "core/extremes.h"
#include "tests/unit/md/bodies.h"

#include <hwy/highway.h>

namespace ligament::md::testing
{
struct AtomKernelTest : ::testing::Test
{
  ~AtomKernelTest() override { hwy::SetSupportedTargetsForTest(0); }

  template <int dim>
  static void compare(Body<dim> body, double amplitude)
  {
    SCOPED_TRACE(body.crystal.potential().species(0).name + std::to_string(amplitude));
    body.disturb(amplitude * body.crystal.spacing());
    auto expected = body.atoms, rest = body.atoms;
    for (auto &component : rest.displacement)
      std::fill(component.begin(), component.end(), 0.);
    auto plain = body.oracle(body.crystal.potential());
    plain.compute(rest);
    const double at_rest = plain.energy;
    plain.compute(expected);
    const double energy_scale = std::max(
        std::abs(plain.energy), body.atoms.size() * std::abs(body.crystal.cohesive_energy()));
    double scale = body.stiffness() * body.crystal.spacing();
    for (const auto &component : expected.force) // atoms on top of each other push hard
      for (const double f : component)
        keep_largest(scale, std::abs(f));
    for (const std::int64_t target : {HWY_SCALAR, HWY_EMU128, HWY_AVX2, HWY_AVX3}) {
      hwy::SetSupportedTargetsForTest(0);
      if (!(hwy::SupportedTargets() & target))
        continue;
      hwy::SetSupportedTargetsForTest(target);
      body.options.keeps_neighbours = false;
      auto force = body.force();
      force.compute(body.atoms, 0);
      EXPECT_LT(difference(body.atoms.force, expected.force, scale), 1e-12);
      const auto first = body.atoms.force;
      force.compute(body.atoms, 0);
      EXPECT_EQ(body.atoms.force, first); // to the last bit
      EXPECT_NEAR(force.potential_energy(body.atoms), plain.energy - at_rest, 1e-13 * energy_scale);
    }
  }
};

TEST_F(AtomKernelTest, AgreesWithTheOracleOnAllInstructionSets)
{
  for (const double amplitude : {0.02, 0.15, 0.6}) { // a new list, atoms on top of each other
    for (const Body<3> &body : bodies())
      compare<3>(body, amplitude);
    compare<2>(plane_body(), amplitude);
    compare<2>(plane_body({9, 2}, {true, true}), amplitude);
  }
  // Many blocks of slots, of which the last one is not full.
  compare<3>(make_body<3>(foiles_copper(), CrystalKind::fcc, {5, 4, 5.5}, {}, some_rotation<3>()),
             0.05);
}

TEST_F(AtomKernelTest, AgreesForAlloysOfTables)
{
  for (const Potential &p : {nickel_aluminium(), copper_zirconium()}) {
    auto body = make_body<3>(p, CrystalKind::fcc, {4, 3, 3}, {true, false, false});
    for (int i = 0; i < body.atoms.size(); ++i)
      body.options.species.push_back(i % 5 < 2);
    for (const double amplitude : {0.02, 0.15, 0.6})
      compare<3>(body, amplitude);
    // The other species alone: tables are those of species that there are.
    std::fill(body.options.species.begin(), body.options.species.end(), 1);
    compare<3>(body, 0.15);
  }
}

TEST_F(AtomKernelTest, BearsAtomsAtTheSamePlace)
{
  auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {2, 2, 2});
  set(body.atoms.displacement, 1,
      Vector<3>(get(body.atoms.reference, 0) - get(body.atoms.reference, 1)));
  auto force = body.force();
  force.compute(body.atoms, 0);
  for (const auto &component : body.atoms.force)
    for (const double f : component)
      EXPECT_TRUE(std::isfinite(f));
}

// Atoms far from each other, a pair, a single one.
TEST_F(AtomKernelTest, HandlesLonelyAtoms)
{
  for (const int n : {1, 2, 3}) {
    auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {0.9, 0.9, 0.9});
    ASSERT_EQ(body.atoms.size(), 4);
    for (int i = n; i < 4; ++i)
      for (int c = 0; c < 3; ++c)
        body.atoms.displacement[c][i] = 1e-8 * i * (c + 1);
    auto force = body.force();
    auto expected = body.atoms;
    body.oracle(body.crystal.potential()).compute(expected);
    force.compute(body.atoms, 0);
    EXPECT_LT(
        difference(body.atoms.force, expected.force, body.stiffness() * body.crystal.spacing()),
        1e-12);
  }
}
} // namespace ligament::md::testing
