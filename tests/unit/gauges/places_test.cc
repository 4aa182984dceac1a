// Gauges of places read what a homogeneous motion, whatever its size, makes of them; flanks of cuts
// are not mixed up.
#include "src/simulation/gauges/gauge_set.h"
#include "tests/support/small_plate.h"

#include <Eigen/Geometry>

#include <cmath>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// Bodies of all kinds, and all packings of the pure discrete one.
const std::vector<BodyKind> bodies = {
    {"coupled", {}},
    {"coupled_random", {"/discrete_zone/packing=random"}},
    {"pure_fem", {"/discrete_zone=none"}},
    {"hexagonal", {"/far_field=none"}},
    {"turned", {"/far_field=none", "/discrete_zone/orientation=0.2"}},
    {"square", {"/far_field=none", "/discrete_zone/packing=square"}},
    {"random", {"/far_field=none", "/discrete_zone/packing=random"}}};

struct Measured
{
  explicit Measured(const std::string &gauges, const std::vector<std::string> &overrides = {})
      : scene(small_scene(overrides + std::vector<std::string>{"/gauges=" + gauges})), small(scene),
        gauges(scene, small.body)
  {
  }
  std::vector<double> read(double time = 0) { return gauges.read(small.body, time); }

  Scene scene;
  SmallBody small;
  GaugeSet<2> gauges;
};

/// A stretch of some per cent in axes of its own, then a turn by 40 degrees.
Eigen::Matrix2d stretch()
{
  Eigen::Matrix2d u;
  u << 1.03, 0.01, 0.01, 0.98;
  return u;
}
Eigen::Matrix2d turn()
{
  return Eigen::Rotation2Dd(0.7).toRotationMatrix();
}

TEST(Gauges, PointsFollowAHomogeneousMotionOfAnySize)
{
  // Inside the zone, across the overlap, in the far field, on sides and at a corner.
  const std::string gauges = R"([
    {"name": "inside", "kind": "distance", "points": [[-3.2, -1.1], [4.4, 2.3]]},
    {"name": "across", "kind": "distance", "points": [[2, 1], [-3, 55]]},
    {"name": "corner", "kind": "distance", "points": [[-12, -60], [12, 3.3]]},
    {"name": "mouth", "kind": "opening", "points": [[-12, -1], [-12, 1]]},
    {"name": "slip", "kind": "opening", "points": [[0, -14.5], [1, 20]], "direction": [3, 0]}])";
  const Eigen::Matrix2d f = turn() * stretch();
  const auto length = [&](double x, double y) {
    return (f * Vector<2>(x, y)).norm() - std::hypot(x, y);
  };
  const std::vector<double> expected = {length(7.6, 3.4), length(-5, 54), length(24, 63.3),
                                        2 * f(1, 1) - 2, f(0, 0) + 34.5 * f(0, 1) - 1};
  for (const BodyKind &kind : bodies) {
    SCOPED_TRACE(kind.name);
    Measured m(gauges, kind.overrides);
    m.small.deform(f - Eigen::Matrix2d::Identity());
    const auto values = m.read();
    // Round-off of displacements of 50 and of weights of the fit, of order 1.
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_NEAR(values[k], expected[k], 1e-12) << m.gauges.columns()[k].name;
  }
}

TEST(Gauges, StrainIsThatOfTheStretchInTheAxesOfTheGauge)
{
  const std::string gauges = R"([
    {"name": "zone", "kind": "strain", "lower": [-7, -6], "upper": [5.5, 7]},
    {"name": "across", "kind": "strain", "lower": [null, -30], "upper": [3, 35]},
    {"name": "point", "kind": "strain", "points": [[1.3, 2.2]]},
    {"name": "side", "kind": "strain", "points": [[12, 2.2]]},
    {"name": "rosette", "kind": "strain", "lower": [-7, -6], "upper": [5, 7], "angle": "30 deg"}])";
  const Eigen::Matrix2d e = stretch() - Eigen::Matrix2d::Identity(),
                        axes = Eigen::Rotation2Dd(M_PI / 6).toRotationMatrix();
  for (const BodyKind &kind : bodies) {
    SCOPED_TRACE(kind.name);
    Measured m(gauges, kind.overrides);
    m.small.deform(turn() * stretch() - Eigen::Matrix2d::Identity());
    const auto values = m.read();
    for (int k = 0; k < 5; ++k) {
      const Eigen::Matrix2d expected = k < 4 ? e : Eigen::Matrix2d(axes.transpose() * e * axes);
      EXPECT_NEAR(values[3 * k], expected(0, 0), 1e-12);
      EXPECT_NEAR(values[3 * k + 1], expected(1, 1), 1e-12);
      EXPECT_NEAR(values[3 * k + 2], expected(0, 1), 1e-12);
    }
  }
}

// E = 1, nu = 0.22, plane strain: sides free, so stress is uniaxial.
TEST(Gauges, StressAndForcesOfAStretchedPlate)
{
  const double nu = 0.22, strain = 1e-4, stress = strain / (1 - nu * nu);
  const std::string gauges = R"([
    {"name": "zone", "kind": "stress", "lower": [-7, -6], "upper": [5.5, 7]},
    {"name": "across", "kind": "stress", "lower": [-8, -30], "upper": [3, 35]},
    {"name": "point", "kind": "stress", "points": [[1.3, 2.2]]},
    {"name": "turned", "kind": "stress", "points": [[1.3, 2.2]], "angle": "90 deg"},
    {"name": "top", "kind": "force", "side": "top"},
    {"name": "second", "kind": "force", "load": 1}])";
  const std::string loads = R"(/loads=[{"boundary": "top", "displacement": [null, 0.006]},
                                       {"boundary": "bottom", "displacement": [null, -0.006]}])";
  for (const BodyKind &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    Measured m(gauges, kind.overrides + std::vector<std::string>{loads});
    m.small.deform(Eigen::Vector2d(-nu / (1 - nu) * strain, strain).asDiagonal());
    auto halves = m.small.body.bodies();
    m.small.body.coupler->compute_forces(halves, {0, 0, m.small.body.dt});
    const auto v = m.read();
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(v[3 * k] / stress, 0, 1e-10);
      EXPECT_NEAR(v[3 * k + 1] / stress, 1, 1e-10);
      EXPECT_NEAR(v[3 * k + 2] / stress, 0, 1e-10);
    }
    EXPECT_NEAR(v[9] / stress, 1, 1e-10);
    EXPECT_NEAR(v[10] / stress, 0, 1e-10);
    EXPECT_NEAR(v[13] / (24 * stress), 1, 1e-10);  // top, y
    EXPECT_NEAR(v[15] / (24 * stress), -1, 1e-10); // bottom
    EXPECT_NEAR(v[12] / (24 * stress), 0, 1e-10);
  }
}

/// Each half of the plate, above and below y = 0, moves as a body of its own.
void part_halves(SmallBody &small, double opening, double angle)
{
  auto &state = small.body.zone->state;
  const Eigen::Matrix2d turned =
      Eigen::Rotation2Dd(angle).toRotationMatrix() - Eigen::Matrix2d::Identity();
  for (int i = 0; i < state.size(); ++i) {
    const Vector<2> x = get(state.reference, i);
    if (x[1] > 0)
      set<2>(state.displacement, i, Vector<2>(turned * x + Vector<2>(0, opening)));
  }
}

// The upper flank moves by `opening` and turns about the origin.
TEST(Gauges, OpeningOfCutsIsThatOfTheirFlanks)
{
  const double opening = 0.4, angle = 0.1;
  const auto expected = [&](double x, double y) { // of the upper point
    return opening + std::sin(angle) * x + (std::cos(angle) - 1) * y;
  };
  const std::string gauges = R"([
    {"name": "mouth", "kind": "opening", "points": [[-12, -0.6], [-12, 0.6]]},
    {"name": "near", "kind": "opening", "points": [[-6, -0.6], [-6, 0.6]]}])";
  for (const char *packing : {"hexagonal", "square", "random"})
    for (const char *cut : {R"(/specimen/cracks=[{"points": [[-12, 0], [12, 0]]}])",
                            R"(/specimen/notches=[{"lower": [-13, -0.5], "upper": [11, 0.5]}])"})
    {
      SCOPED_TRACE(std::string(packing) + cut);
      Measured m(gauges,
                 {"/far_field=none", cut, std::string("/discrete_zone/packing=") + packing});
      part_halves(m.small, opening, angle);
      const auto values = m.read();
      EXPECT_NEAR(values[0], expected(-12, 0.6), 1e-12);
      EXPECT_NEAR(values[1], expected(-6, 0.6), 1e-12);
    }
}

// Just beside a crack the nearest particle may be one of the other flank.
TEST(Gauges, APointBelongsToItsSideOfACrackHoweverNear)
{
  for (const char *packing : {"hexagonal", "square", "random"}) {
    SCOPED_TRACE(packing);
    std::string gauges;
    for (int k = 0; k < 20; ++k)
      gauges += fmt::format(
          R"({}{{"name": "g{}", "kind": "opening", "points": [[{}, -1e-3], [{}, 1e-3]], "direction": [0, 1]}})",
          k == 0 ? "" : ",", k, -11 + k, -11 + k);
    Measured m("[" + gauges + "]",
               {"/far_field=none", R"(/specimen/cracks=[{"points": [[-12, 0], [12, 0]]}])",
                std::string("/discrete_zone/packing=") + packing});
    part_halves(m.small, 0.4, 0);
    for (const double value : m.read())
      EXPECT_NEAR(value, 0.4, 1e-12);
  }
}

/// A plate of a square packing that breaks where faces open, as in load_path_test.
const std::vector<std::string> weak = {
    R"(/discrete_zone/packing="square")", "/material/poissons_ratio=0", "/far_field=none",
    R"(/material/fracture={"criterion": "face_tension", "strength": 1e-3})"};

/// Opens the faces on y = 0 between these places.
void open_faces(SmallBody &small, double from, double to, double time)
{
  auto &state = small.body.zone->state;
  for (int i = 0; i < state.size(); ++i)
    if (state.reference[1][i] > 0 && state.reference[0][i] > from && state.reference[0][i] < to)
      state.displacement[1][i] = 2e-3;
  small.body.force()->compute(state, time);
}

TEST(Gauges, PointsLetGoOfWhatHasBroken)
{
  const std::string gauges =
      R"([{"name": "gap", "kind": "opening", "points": [[2, -0.4], [2, 0.4]]}])";
  Measured m(gauges, weak);
  open_faces(m.small, -12, 12, 1);
  ASSERT_EQ(m.small.body.force()->broken_bonds().size(), 24u);
  EXPECT_NEAR(m.read()[0], 2e-3, 1e-15); // not a mean over both sides
  GaugeSet<2> anew(m.scene, m.small.body);
  EXPECT_EQ(anew.read(m.small.body, 0), m.read());
}

TEST(Gauges, CrackTipIsTheFarthestFaceOfTheCrack)
{
  const std::string gauges = R"([
    {"name": "tip", "kind": "crack_tip", "points": [[-12, 0]], "direction": [1, 0], "smoothing": 2},
    {"name": "back", "kind": "crack_tip", "points": [[5, 0]], "direction": [-2, 0], "smoothing": 2}])";
  Measured m(gauges, weak + std::vector<std::string>{
                                R"(/specimen/cracks=[{"points": [[-12, 0], [-4, 0]]}])"});
  // Centres of faces lie at halves.
  const auto expect = [&](double time, double tip, double speed, double back) {
    const auto v = m.read(time);
    EXPECT_NEAR(v[0], tip, 1e-9) << time;
    EXPECT_NEAR(v[1], speed, 1e-9) << time;
    EXPECT_NEAR(v[2], back, 1e-9) << time;
  };
  expect(0, 7.5, 0, 0);
  open_faces(m.small, 4, 6, 1); // far ahead of the crack; joined to the other gauge's start
  expect(1, 7.5, 0, 0.5);
  open_faces(m.small, -4, -1, 2);
  expect(2, 10.5, 1.5, 0.5);
  expect(3, 10.5, 1.5, 0.5);
  expect(4, 10.5, 0, 0.5); // the mean over the two seconds before
  open_faces(m.small, -1, 4, 5);
  expect(5, 17.5, 3.5, 16.5);
  GaugeSet<2> anew(m.scene, m.small.body);
  EXPECT_EQ(anew.read(m.small.body, 6), m.read(6));
}

TEST(Gauges, OtherColumnsOfTheSameNameAreRefused)
{
  const auto scene =
      small_scene({R"(/gauges=[{"name": "a_x", "kind": "distance", "points": [[0, 1], [0, 2]]},
    {"name": "a", "kind": "stress", "points": [[0, 0]]}])"});
  EXPECT_EQ(scene.gauges.size(), 2u); // a_xx is another column than a_x
}

// Straight edges of cells cut off a little of a round side: what lies there moves with its cell.
TEST(Gauges, PointsOnACurvedSideOfAMeshMoveWithIt)
{
  Measured m(R"([
    {"name": "rim", "kind": "distance", "points": [[-1, 0], [0, 12]]},
    {"name": "aslant", "kind": "distance", "points": [[0, -12], [7.2, 9.6]]}])",
             {R"(/specimen={"outline": [{"at": [-12, 0], "centre": [0, 0], "side": "low"},
                                        {"at": [12, 0], "centre": [0, 0], "side": "high"}]})",
              "/discrete_zone=none"});
  const Eigen::Matrix2d f = turn() * stretch();
  m.small.deform(f - Eigen::Matrix2d::Identity());
  const auto v = m.read();
  EXPECT_NEAR(v[0], (f * Vector<2>(1, 12)).norm() - std::hypot(1, 12), 1e-12);
  EXPECT_NEAR(v[1], (f * Vector<2>(7.2, 21.6)).norm() - std::hypot(7.2, 21.6), 1e-12);
}
} // namespace
