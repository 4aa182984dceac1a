// Which way the cracks of a scene point, and that a lattice's toughness turns with the body.
#include "dem/toughness_calibration.h"
#include "src/scene/crack_axes.h"
#include "tests/support/small_plate.h"

#include <gtest/gtest.h>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
Specimen box(double x, double y, double z = 0)
{
  Specimen s;
  s.size = {x, y, z};
  return s;
}

template <int dim>
void expect_axes(const Specimen &s, const Vector<dim> &growth, const Vector<dim> &normal)
{
  const auto axes = crack_axes<dim>(s);
  EXPECT_NEAR((axes.growth - growth.normalized()).norm(), 0, 1e-14) << axes.growth.transpose();
  EXPECT_NEAR((axes.normal - normal.normalized()).norm(), 0, 1e-14) << axes.normal.transpose();
}

TEST(CrackAxes, OfLinesAreThoseOfTheEndInTheBody)
{
  Specimen s = box(10, 10);
  expect_axes<2>(s, {1, 0}, {0, 1}); // nothing is cut
  s.cracks = {{{{-6, 0, 0}, {-5, 0, 0}, {-2, 3, 0}}}};
  expect_axes<2>(s, {1, 1}, {1, -1});
  s.cracks[0].points = {{-2, 3, 0}, {-2, 0, 0}, {-6, 0, 0}}; // ends at the side; begins upwards
  expect_axes<2>(s, {0, 1}, {1, 0});
  s.cracks[0].points = {{-6, 0, 0}, {6, 0, 0}}; // through the body
  expect_axes<2>(s, {1, 0}, {0, 1});
  s.cracks.push_back({{{2, 0, 0}, {0, 4, 0}}});
  expect_axes<2>(s, {1, -2}, {2, 1});
}

TEST(CrackAxes, OfPolygonsAreThoseOfTheirLongestFront)
{
  Specimen s = box(10, 8, 6);
  // Across z, from the side at the back up to y = 1: the front runs along x.
  s.cracks = {{{{-6, -5, 1}, {6, -5, 1}, {6, 1, 1}, {-6, 1, 1}}}};
  expect_axes<3>(s, {0, 1, 0}, {0, 0, 1});
  // Inclined, with its front along z.
  s.cracks = {{{{-6, -6, -4}, {1, 1, -4}, {1, 1, 4}, {-6, -6, 4}}}};
  expect_axes<3>(s, {1, 1, 0}, {1, -1, 0});
  s.cracks = {{{{-6, 0, -4}, {6, 0, -4}, {6, 0, 4}, {-6, 0, 4}}}}; // through the body
  expect_axes<3>(s, {1, 0, 0}, {0, 1, 0});
}

TEST(CrackAxes, OfSlotsAndNotches)
{
  Specimen s = box(10, 8, 6);
  s.notches = {{{-0.2, -4, -3}, {0.2, 1, 3}}}; // up from the bottom, through z
  expect_axes<3>(s, {0, 1, 0}, {1, 0, 0});
  expect_axes<2>(s, {0, 1}, {1, 0});
  Slot &slot = s.slots.emplace_back();
  slot.from = {-5, 0, 0}, slot.to = {-2, 1, 0};
  expect_axes<2>(s, {3, 1}, {1, -3});
  expect_axes<3>(s, {3, 1, 0}, {1, -3, 0});
}

// A square lattice is 10 % tougher along its diagonals than along its rows: what a plate holds
// follows its own crack, whichever way it is turned.
TEST(CrackAxes, ToughnessTurnsWithTheBody)
{
  dem::DemMaterial m;
  m.youngs_modulus = 1, m.poissons_ratio = 0.2, m.density = 1;
  const auto factor = [&](const Specimen &s, double orientation) {
    const auto crack = crack_axes<2>(s);
    return dem::calibrate_toughness<2>(packings::LatticeKind::square, Spin<2>(orientation), m,
                                       dem::FractureLaw::Criterion::principal_stress,
                                       {crack.growth, crack.normal});
  };
  Specimen level = box(10, 10), inclined = box(10, 10);
  level.cracks = {{{{-2, 0, 0}, {2, 0, 0}}}};
  inclined.cracks = {{{{-2, -2, 0}, {2, 2, 0}}}};
  const double along_rows = factor(level, 0), along_diagonals = factor(inclined, 0);
  EXPECT_NEAR(factor(inclined, M_PI / 4), along_rows, 1e-9);
  EXPECT_NEAR(factor(level, M_PI / 4), along_diagonals, 1e-9);
  EXPECT_GT(std::abs(along_diagonals / along_rows - 1), 0.05);
}

TEST(CrackAxes, OfTheSceneGoIntoItsStrength)
{
  const auto factor = [](const std::string &crack) {
    SmallBody small(small_scene(
        {R"(/material/fracture={"criterion": "principal_stress", "toughness": 1e-3})", crack,
         R"(/discrete_zone/packing="square")", "/far_field=none", "/discrete_zone/extent=all"}));
    return small.body.figures.at("toughness_factor").value;
  };
  const double level = factor(R"(/specimen/cracks=[{"points": [[-3, 0.4], [3, 0.4]]}])"),
               inclined = factor(R"(/specimen/cracks=[{"points": [[-3, -3], [3, 3]]}])");
  EXPECT_GT(std::abs(inclined / level - 1), 0.05);
}
} // namespace
