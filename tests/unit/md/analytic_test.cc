// Built-in potentials are what their formulas say; metals have the constants that were measured.
#include "core/check.h"
#include "tests/unit/md/potentials.h"

namespace ligament::md::testing
{
TEST(AnalyticTest, LennardJonesAndMorseFollowTheirFormulas)
{
  const double depth = 0.0104 * electron_volt, size = 3.4 * angstrom;
  const Potential p = argon_pairs();
  for (double r = 0.7 * size; r < 2.2 * size; r += 0.0371 * size) {
    const double s6 = std::pow(size / r, 6);
    EXPECT_NEAR(p.bond(0, 0, r).pair.value, 4 * depth * s6 * (s6 - 1),
                1e-8 * depth * (1 + s6 * s6));
  }
  EXPECT_NEAR(p.cutoff(), 2.5 * size, 1e-24);
  EXPECT_FALSE(p.has_embedding());

  const double distance = 2.5 * angstrom, decay = 1.5 / angstrom;
  const Potential m = morse(argon(), depth, distance, decay, {5 * angstrom, 6 * angstrom});
  for (double r = 1.5 * angstrom; r < 5 * angstrom; r += 0.07 * angstrom) {
    const double e = std::exp(-decay * (r - distance));
    EXPECT_NEAR(m.bond(0, 0, r).pair.value, depth * e * (e - 2), 1e-9 * depth * (1 + e * e));
  }
  EXPECT_THROW(lennard_jones(argon(), -1, size), core::InputError);
  EXPECT_THROW(lennard_jones(argon(), depth, size, {2 * size, size}), core::InputError);
  EXPECT_THROW(morse(argon(), depth, distance, 0, {5 * angstrom, 6 * angstrom}), core::InputError);
}

/// Measured: a in angstrom, cohesive energy in eV (C. Kittel, Introduction to Solid State Physics),
/// C11, C12, C44 in GPa at room temperature (G. Simmons, H. Wang, Single Crystal Elastic Constants,
/// 1971), to which the potentials were fitted.
struct Measured
{
  const char *name;
  double a, energy, c11, c12, c44;
};

class ZhouMetal : public ::testing::TestWithParam<Measured>
{
};

TEST_P(ZhouMetal, HasTheMeasuredConstantsWithinOnePercent)
{
  const Measured m = GetParam();
  const Potential p = zhou_johnson_wadley({m.name});
  const Crystal<3> crystal(p, {crystal_kind(p.species(0).lattice)});
  const auto c = crystal.elastic_constants().stiffness;
  EXPECT_NEAR(crystal.lattice_parameter() / (m.a * angstrom), 1, 0.01);
  EXPECT_NEAR(-crystal.cohesive_energy() / (m.energy * electron_volt), 1, 0.01);
  EXPECT_NEAR(c(0, 0) / (m.c11 * 1e9), 1, 0.01);
  EXPECT_NEAR(c(0, 1) / (m.c12 * 1e9), 1, 0.01);
  EXPECT_NEAR(c(3, 3) / (m.c44 * 1e9), 1, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Metals, ZhouMetal,
                         ::testing::Values(Measured{"Cu", 3.615, 3.54, 170, 122.5, 75.8},
                                           Measured{"Ag", 4.09, 2.85, 124, 93.4, 46.1},
                                           Measured{"Au", 4.08, 3.93, 186, 157, 42},
                                           Measured{"Ni", 3.52, 4.45, 246.5, 147.3, 124.7},
                                           Measured{"Pb", 4.95, 2.02, 49.5, 42.3, 14.9},
                                           Measured{"Fe", 2.8665, 4.29, 230, 135, 117},
                                           Measured{"W", 3.165, 8.76, 522.4, 204.4, 160.6}),
                         [](const auto &info) { return std::string(info.param.name); });

TEST(AnalyticTest, AllMetalsAreTested)
{
  EXPECT_EQ(zhou_metals(), (std::vector<std::string>{"Cu", "Ag", "Au", "Ni", "Pb", "Fe", "W"}));
  EXPECT_THROW(zhou_johnson_wadley({"Cu", "Xx"}), core::InputError);
}

// Copper as others tabulated it after the same paper, in single precision.
TEST(AnalyticTest, CopperAgreesWithATable)
{
  const Potential ours = zhou_johnson_wadley({"Cu"}),
                  theirs = read_setfl(table("CuTa.eam.alloy"), {"Cu"});
  for (double r = 1.8 * angstrom; r < 5 * angstrom; r += 0.0437 * angstrom) {
    const BondJets a = ours.bond(0, 0, r), b = theirs.bond(0, 0, r);
    EXPECT_NEAR(a.pair.value / electron_volt, b.pair.value / electron_volt, 2e-6) << r;
    EXPECT_NEAR(a.density_at_i.value, b.density_at_i.value, 2e-5) << r;
  }
  for (double rho = 1; rho < 60; rho += 1.37)
    EXPECT_NEAR(ours.embedding(0, rho).value / electron_volt,
                theirs.embedding(0, rho).value / electron_volt, 2e-6)
        << rho;
}
} // namespace ligament::md::testing
