// Ends of a crack by the atoms that lack neighbours: of a cut, of rows that have opened, in the
// heat, and beside slip.
#include "src/simulation/gauges/gauge_set.h"
#include "tests/support/atom_bodies.h"

#include <cmath>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
constexpr double nm = 1e-9;

/// From -4 to 5 nm, between two rows.
const std::string cut = R"(/specimen/cracks=[{"points": [["-4 nm", 0], ["5 nm", 0]]}])";
const std::string gauge = R"(/gauges=[{"name": "c", "kind": "open_crack", "points": [[0, 0]],
                                       "direction": [2, 0]}])";
/// Copper's: through the whole thickness.
const std::vector<std::string> copper = {
    R"(/specimen/cracks=[{"points": [["-1.5 nm", 0, -1e-8], ["2 nm", 0, -1e-8],
                                     ["2 nm", 0, 1e-8], ["-1.5 nm", 0, 1e-8]]}])",
    R"(/gauges=[{"name": "c", "kind": "open_crack", "points": [[0, 0, 0]],
                 "direction": [1, 0, 0]}])"};

template <int dim>
std::vector<double> read(const AtomsOfScene<dim> &unit)
{
  return GaugeSet<dim>(unit.scene, unit.body).read(unit.body, 0);
}

/// Both faces of the crack move apart by half of 2 opening sqrt(1 - (x/length)^2) each.
void open(AtomsOfScene<2> &unit, double opening, double length)
{
  unit.impose([&](const Vector<2> &x) {
    const double inside = std::max(0., 1 - std::pow(x[0] / length, 2));
    return Vector<2>(0, (x[1] > 0 ? 1 : -1) * opening * std::sqrt(inside));
  });
}

// The pairs across y = 0 are cut whose middle, a quarter of a spacing beside their atoms, lies in
// the crack: an atom that loses both is at its face.
void expect_ends_of_cut(const std::vector<std::string> &overrides)
{
  AtomsOfScene<2> unit(plane_of_atoms, overrides);
  const double d = unit.scene.zone.spacing;
  double ahead = 0, behind = 0;
  for (int i = 0; i < unit.atoms().size(); ++i) {
    const Vector<2> x = get(unit.atoms().reference, i);
    if (std::abs(x[1]) < 0.5 * d && x[0] + d / 4 < 5 * nm && x[0] - d / 4 > -4 * nm) {
      ahead = std::max(ahead, x[0]);
      behind = std::max(behind, -x[0]);
    }
  }
  EXPECT_GT(ahead, 5 * nm - 1.25 * d);
  EXPECT_GT(behind, 4 * nm - 1.25 * d);
  const auto ends = read(unit);
  EXPECT_NEAR(ends[0], ahead, 1e-12 * d);
  EXPECT_NEAR(ends[1], behind, 1e-12 * d);
}

TEST(OpenCrack, EndsWhereTheCutDoes)
{
  expect_ends_of_cut({cut, gauge});
  expect_ends_of_cut(in_a_mesh({cut, gauge}));
}

// Rows lie 0.866 d apart, their bonds go from 0 to d/2 sideways: midway to the next shell, 1.366 d,
// a gap of 0.405 d lets go of both bonds of an atom.
TEST(OpenCrack, FollowsRowsThatOpen)
{
  AtomsOfScene<2> unit(plane_of_atoms, {cut, gauge});
  const double d = unit.scene.zone.spacing;
  const double gap = std::sqrt(std::pow((1 + std::sqrt(3.)) / 2, 2) - 0.25) - std::sqrt(0.75);
  for (const double length : {6 * nm, 8 * nm, 6.5 * nm}) { // it may close again
    open(unit, d, length);
    const double end = length * std::sqrt(1 - std::pow(gap / 2, 2));
    const auto ends = read(unit);
    EXPECT_NEAR(ends[0], std::max(end, 5 * nm), d);
    EXPECT_NEAR(ends[1], end, d);
  }
  // Never seen open again: the cut is what is left.
  unit.impose([](const Vector<2> &) { return Vector<2>(0, 0); });
  EXPECT_NEAR(read(unit)[0], 5 * nm, 1.25 * d);
}

// A crack from a side: atoms of the side, and of the corners, had these neighbours never.
TEST(OpenCrack, SidesOfTheBodyAreNoCrack)
{
  AtomsOfScene<2> unit(plane_of_atoms,
                       {R"(/specimen/cracks=[{"points": [["-12 nm", 0], ["-6 nm", 0]]}])",
                        R"(/gauges=[{"name": "c", "kind": "open_crack", "points": [["-12 nm", 0]],
                                     "direction": [1, 0]}])"});
  const auto ends = read(unit);
  EXPECT_NEAR(ends[0], 6 * nm, 1.25 * unit.scene.zone.spacing);
  EXPECT_LT(ends[1], unit.scene.zone.spacing);
}

// What parts elsewhere belongs to the crack when it has reached it.
TEST(OpenCrack, LooksAtWhatIsJoinedToTheStart)
{
  AtomsOfScene<2> unit(plane_of_atoms, {gauge});
  EXPECT_EQ(read(unit), std::vector<double>(2, 0.));
  const double d = unit.scene.zone.spacing;
  const auto part = [&](double from, double to) {
    unit.impose([&](const Vector<2> &x) {
      return Vector<2>(0, x[1] > 0 && x[0] > from && x[0] < to ? 0.6 * d : 0);
    });
  };
  part(5 * nm, 7 * nm);
  EXPECT_EQ(read(unit), std::vector<double>(2, 0.));
  part(-2 * nm, 7 * nm);
  const auto ends = read(unit);
  EXPECT_NEAR(ends[0], 7 * nm, 2 * d); // its flank lets go of the column beside it
  EXPECT_NEAR(ends[1], 2 * nm, 2 * d);
}

// Atoms of copper at 300 K move by 0.085 angstrom along each axis (B = 0.57 square angstrom of
// diffraction, B = 8 pi^2 u^2), here each for itself: pairs, which in a crystal go with each other,
// more than there.
TEST(OpenCrack, HeatMovesItsEndsByLessThanASpacing)
{
  AtomsOfScene<3> unit(copper_bar, copper);
  const double d = unit.scene.zone.spacing;
  const auto cold = read(unit);
  EXPECT_NEAR(cold[0], 2 * nm, 1.25 * d);
  EXPECT_NEAR(cold[1], 1.5 * nm, 1.25 * d);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    unit.impose([](const Vector<3> &) { return Vector<3>(0, 0, 0); });
    unit.shake(0.085e-10, seed);
    const auto hot = read(unit);
    EXPECT_NEAR(hot[0], cold[0], d) << seed;
    EXPECT_NEAR(hot[1], cold[1], d) << seed;
  }
}

// Lindemann's rule: a crystal melts at a deviation of a tenth of a spacing or so. At a third of its
// melting temperature there is some 0.058 of it over both axes.
TEST(OpenCrack, HeatMakesNoEndsInThePlane)
{
  AtomsOfScene<2> unit(plane_of_atoms, {cut, gauge});
  const double d = unit.scene.zone.spacing;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    open(unit, d, 7 * nm);
    const auto cold = read(unit);
    unit.shake(0.04 * d, seed);
    const auto hot = read(unit);
    EXPECT_NEAR(hot[0], cold[0], d) << seed;
    EXPECT_NEAR(hot[1], cold[1], d) << seed;
  }
}

// An edge dislocation on its way from the end of the crack: nearest neighbours have parted behind
// it, but nobody lacks a surface's number of them.
TEST(OpenCrack, SlipIsNoCrack)
{
  AtomsOfScene<2> unit(plane_of_atoms, {cut, gauge});
  const double d = unit.scene.zone.spacing;
  const auto before = read(unit);
  for (const double core : {7 * nm, 8.1 * nm, 9.3 * nm}) {
    unit.impose([&](const Vector<2> &x) {
      if (x[0] < 5 * nm)
        return Vector<2>(x[1] > 0 ? d / 2 : -d / 2, 0);
      const double slip = d * (0.5 - std::atan((x[0] - core) / (1.5 * d)) / M_PI);
      return Vector<2>((x[1] > 0 ? 1 : -1) * slip / 2, 0);
    });
    unit.body.force()->compute(unit.atoms(), 0);
    const auto after = read(unit);
    EXPECT_NEAR(after[0], before[0], 2 * d);
    EXPECT_NEAR(after[1], before[1], 2 * d);
  }
  EXPECT_GT(unit.body.force()->broken_bonds().size(), 5u);
}
} // namespace
