// The normal form leaves energies as they are and takes the slope of the embedding energy away.
#include "core/check.h"
#include "tests/unit/md/potentials.h"

namespace ligament::md::testing
{
/// All pairs of atoms scattered in a box, of species in turn.
double energy(const Potential &p, const std::vector<Vector<3>> &x)
{
  double sum = 0;
  const int n = p.n_species();
  for (int i = 0; i < int(x.size()); ++i) {
    double density = 0;
    for (int j = 0; j < int(x.size()); ++j)
      if (i != j) {
        const BondJets jets = p.bond(i % n, j % n, (x[j] - x[i]).norm());
        sum += 0.5 * jets.pair.value;
        density += jets.density_at_i.value;
      }
    sum += p.embedding(i % n, density).value;
  }
  return sum;
}

/// No two nearer than `least`.
std::vector<Vector<3>> scattered(double box, double least, int n)
{
  Noise noise(3);
  std::vector<Vector<3>> x;
  while (int(x.size()) < n) {
    const Vector<3> place = box / 2 * noise.matrix<3, 1>();
    bool is_free = true;
    for (const auto &other : x)
      is_free = is_free && (place - other).norm() > least;
    if (is_free)
      x.push_back(place);
  }
  return x;
}

TEST(PotentialTest, NormalFormKeepsTheEnergyOfEveryConfiguration)
{
  const std::vector<Potential> potentials = {foiles_copper(),
                                             mishin_copper(),
                                             mendelev_iron(),
                                             zhou_johnson_wadley({"Cu", "Ni", "W"}),
                                             read_setfl_fs(table("AlFe_mm.eam.fs"), {"Al", "Fe"}),
                                             read_funcfl({table("Cu_u3.eam"), table("Ni_u3.eam")})};
  const auto x = scattered(14 * angstrom, 2 * angstrom, 60);
  for (const Potential &p : potentials) {
    std::vector<double> densities;
    for (int a = 0; a < p.n_species(); ++a) // some slope of F, far from 0
      densities.push_back(0.3 * p.embedding_spline(a).end());
    const Potential normal = p.normal_form(densities);
    const double e = energy(p, x);
    EXPECT_NEAR(energy(normal, x), e, 1e-13 * 60 * electron_volt) << e / electron_volt;
    for (int a = 0; a < p.n_species(); ++a) {
      EXPECT_GT(std::abs(p.embedding(a, densities[a]).slope) * densities[a], 0.01 * electron_volt);
      EXPECT_NEAR(normal.embedding(a, densities[a]).slope * densities[a] / electron_volt, 0, 1e-14);
      for (int b = 0; b < p.n_species(); ++b) // phi_ab is phi_ba
        EXPECT_NEAR(normal.bond(a, b, 2.6 * angstrom).pair.value,
                    normal.bond(b, a, 2.6 * angstrom).pair.value, 1e-15 * electron_volt);
    }
  }
}

// Slope and curvature are derivatives, and all ends at the cut-off.
TEST(PotentialTest, JetsAreDerivativesAndVanishAtTheCutOff)
{
  const Potential p = zhou_johnson_wadley({"Cu", "W"});
  const double h = 1e-4 * angstrom;
  for (double r = 2 * angstrom; r < p.cutoff() - h; r += 0.1737 * angstrom) {
    const auto below = p.bond(0, 1, r - h), at = p.bond(0, 1, r), above = p.bond(0, 1, r + h);
    for (const auto jet : {&BondJets::pair, &BondJets::density_at_i, &BondJets::density_at_j}) {
      const double size = std::abs((at.*jet).value) + angstrom * std::abs((at.*jet).slope);
      EXPECT_NEAR(((above.*jet).value - (below.*jet).value) / (2 * h), (at.*jet).slope,
                  1e-6 * size / angstrom);
      EXPECT_NEAR(((above.*jet).slope - (below.*jet).slope) / (2 * h), (at.*jet).curvature,
                  1e-3 * size / (angstrom * angstrom));
    }
  }
  const BondJets beyond = p.bond(0, 1, p.cutoff()), just = p.bond(0, 1, p.cutoff() - h);
  EXPECT_EQ(beyond.pair.value, 0);
  EXPECT_EQ(beyond.density_at_i.slope, 0);
  EXPECT_LT(std::abs(just.pair.slope) * angstrom, 1e-6 * electron_volt);
}

TEST(PotentialTest, WhatDoesNotFitIsRefused)
{
  const Potential p = foiles_copper();
  const Spline pair = p.pair_spline(0, 0), f = p.density_spline(0, 0), F = p.embedding_spline(0);
  EXPECT_THROW(Potential({{"Cu", 0}}, {pair}, {f}, {F}), core::InputError);
  EXPECT_THROW(Potential({{"Cu", 1}}, {pair, pair}, {f}, {F}), core::InputError);
  EXPECT_THROW(Potential({{"Cu", 1}}, {pair}, {}, {F}), core::InputError);
  EXPECT_THROW(Potential({{"Cu", 1}}, {pair}, {F}, {F}), core::InputError);
  EXPECT_THROW(p.find_species("Ni"), core::InputError);
  EXPECT_EQ(p.find_species("29"), 0);
}
} // namespace ligament::md::testing
