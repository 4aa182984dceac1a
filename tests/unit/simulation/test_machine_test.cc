// The test machine reads what a uniformly stretched body must answer, whatever the body is made of.
#include "core/extremes.h"
#include "src/simulation/test_machine.h"
#include "tests/support/small_plate.h"

#include <fmt/format.h>

#include <cmath>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string held_ends = R"(/loads=[{"boundary": "top", "displacement": [null, 0.006]},
                                         {"boundary": "bottom", "displacement": [null, -0.006]}])";
const std::string pulled_ends = R"(/loads=[{"boundary": "top", "traction": [null, 1e-4]},
                                           {"boundary": "bottom", "traction": [null, -1e-4]}])";

/// Uniaxial stress of a plate of E = 1, nu = 0.22 with free sides, plane strain.
Eigen::Matrix2d uniaxial(double strain)
{
  const double nu = 0.22;
  return Eigen::Vector2d(-nu / (1 - nu) * strain, strain).asDiagonal();
}

TEST(TestMachine, ReadsStressAndStrainOfEveryKindOfBody)
{
  const double strain = 2 * 0.006 / 120, stress = strain / (1 - 0.22 * 0.22);
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    SmallBody small(small_scene(kind.overrides + std::vector<std::string>{held_ends}));
    small.deform(uniaxial(strain));
    auto bodies = small.body.bodies();
    const coupling::StepTime step{0, 0, small.body.dt};
    small.body.coupler->compute_forces(bodies, step);
    const TestMachine<2> machine(small.body);
    const Reading r = machine.read(small.body, 0);
    // Exact for linear bodies up to rounding, which sums over a few hundred nodes or particles.
    EXPECT_NEAR(r.stress / stress, 1, 1e-10);
    EXPECT_NEAR(r.load / (24 * stress), 1, 1e-10);
    EXPECT_NEAR(r.strain / strain, 1, 1e-12);
    EXPECT_NEAR(r.displacement / 0.012, 1, 1e-12);
  }
}

TEST(TestMachine, ReadsAppliedTractionsAndTheMotionOfTheSides)
{
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    SmallBody small(small_scene(kind.overrides + std::vector<std::string>{pulled_ends}));
    small.deform(uniaxial(1e-4));
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, {0, 0, small.body.dt});
    const Reading r = TestMachine<2>(small.body).read(small.body, 0);
    EXPECT_NEAR(r.load / (24 * 1e-4), 1, 1e-10);
    EXPECT_NEAR(r.strain / 1e-4, 1, 1e-10);
  }
}

// Without a load that has components, a pressure on a side of the box.
TEST(TestMachine, ReadsAPressureAsCompression)
{
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    SmallBody small(
        small_scene(kind.overrides +
                    std::vector<std::string>{R"(/loads=[{"boundary": "top", "pressure": 1e-4}])"}));
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, {0, 0, small.body.dt});
    const Reading r = TestMachine<2>(small.body).read(small.body, 0);
    EXPECT_NEAR(r.load / (24 * 1e-4), -1, 1e-10);
    EXPECT_NEAR(r.stress / 1e-4, -1, 1e-10);
  }
}

// Parts of one side with a name, or two such sides: each moves as what lies there does.
TEST(TestMachine, ReadsTheMotionOfPartsOfSidesWithNames)
{
  const std::vector<std::string> disc = {
      R"(/specimen={"outline": [{"at": [20, 0], "centre": [0, 0], "side": "rim"}]})", R"(/loads=[
    {"boundary": "rim", "within": {"lower": [-4, 15], "upper": [4, null]}, "traction": [null, 1e-4]},
    {"boundary": "rim", "within": {"lower": [-4, null], "upper": [4, -15]}, "traction": [null, -1e-4]}
  ])"};
  const std::vector<std::string> bar = {
      R"(/specimen={"outline": [
    {"at": [-12, -60]}, {"at": [12, -60], "side": "foot"}, {"at": [12, 60]}, {"at": [-12, 60], "side": "head"}
  ]})",
      R"(/loads=[
    {"boundary": "head", "traction": [null, 1e-4]}, {"boundary": "foot", "traction": [null, -1e-4]}
  ])",
      R"(/discrete_zone/region={"lower": [null, null], "upper": [null, 0]})"};
  const std::vector<std::string> dem = {"/far_field=none"},
                                 fem = {"/discrete_zone=none", "/far_field/cell_size=2"};
  for (const auto &[name, overrides] :
       {std::pair("disc of particles", dem + disc), std::pair("disc of cells", fem + disc),
        std::pair("coupled bar, particles to its foot", bar)})
  {
    SCOPED_TRACE(name);
    SmallBody small(small_scene(overrides));
    Eigen::Matrix2d gradient;
    gradient << 1e-4, 3e-4, -2e-4, 5e-4;
    small.deform(gradient);
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, {0, 0, small.body.dt});
    const Reading r = TestMachine<2>(small.body).read(small.body, 0);
    const auto &places = small.body.load_places;
    const Vector<2> apart = places[0].middle - places[1].middle;
    EXPECT_GT(apart[1], 39);
    // Straight sides stand for an arc, of the mesh others than of the particles.
    EXPECT_NEAR(r.displacement / (gradient * apart)[1], 1, 5e-3);
  }
}

// The end of a body may be a tip, beside its middle, in which few particles or one node lie; and a
// load on a side with a name may have nothing to pull against.
TEST(TestMachine, ReadsTheMotionOfEndsThatAreTips)
{
  const auto house = [](const std::string &foot) {
    return R"(/specimen={"outline": [{"at": [-12, -60]}, {"at": [12, -60])" + foot +
           R"(}, {"at": [12, 40]}, {"at": [4, 59.8]}, {"at": [-12, 40]}]})";
  };
  const std::string of_box = R"(/loads=[{"boundary": "bottom", "displacement": [null, -0.006]}])",
                    of_name = R"(/loads=[{"boundary": "foot", "traction": [null, -1e-4]}])";
  for (const auto &kind : body_kinds)
    for (const std::string &loads : {of_box, of_name}) {
      SCOPED_TRACE(kind.name + loads);
      const std::string foot = loads == of_name ? R"(, "side": "foot")" : "";
      std::vector<std::string> overrides = kind.overrides;
      overrides.insert(overrides.end(), {house(foot), loads});
      if (kind.overrides.empty())
        overrides.push_back(R"(/discrete_zone/region={"lower": [null, -40], "upper": [null, 0]})");
      SmallBody small(small_scene(overrides));
      const Eigen::Matrix2d gradient = 1e-4 * Eigen::Vector2d(3, 1).asDiagonal();
      small.deform(gradient);
      auto bodies = small.body.bodies();
      small.body.coupler->compute_forces(bodies, {0, 0, small.body.dt});
      const Reading r = TestMachine<2>(small.body).read(small.body, 0);
      EXPECT_NEAR(r.displacement / (loads == of_box ? 59.8e-4 + 0.006 : 119.8e-4), 1, 1e-6);
    }
}

// A clamp is at rest, in whichever half the load lies: the other end of the body bends along.
TEST(TestMachine, ReadsAgainstAClampWhereverItLies)
{
  const std::string bar = R"(/specimen={"outline": [
    {"at": [-12, -60]}, {"at": [12, -60]}, {"at": [12, 60], "side": "end"}, {"at": [-12, 60]}]})";
  for (const auto &[from, to] : {std::pair(-50, -40), std::pair(-5, 5), std::pair(40, 50)}) {
    const std::string loads = fmt::format(
        R"(/loads=[{{"boundary": "left", "displacement": [0, 0]}}, {{"boundary": "end",
            "within": {{"lower": [null, {}], "upper": [null, {}]}}, "traction": [null, 1e-4]}}])",
        from, to);
    SmallBody small(small_scene({"/discrete_zone=none", "/far_field/cell_size=2", bar, loads}));
    Eigen::Matrix2d sheared;
    sheared << 0, 0, 1e-4, 1e-4;
    small.deform(sheared);
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, {0, 0, small.body.dt});
    const Reading r = TestMachine<2>(small.body).read(small.body, 0);
    EXPECT_NEAR(std::abs(r.displacement), std::abs(12 + from + 5) * 1e-4, 1e-8) << from;
  }
}

// Two loads on one side: the one that is read tells its motion, whichever comes first.
TEST(TestMachine, ReadsTheMotionOfItsOwnLoad)
{
  const std::string
      held = R"({"boundary": "left", "from": 0, "to": 60, "displacement": [0, null]})",
      moved = R"({"boundary": "left", "from": -60, "to": 0, "displacement": [-0.006, null]})",
      rest = R"({"boundary": "right", "displacement": [0, null]})";
  for (const std::string &loads :
       {held + "," + moved + "," + rest, moved + "," + held + "," + rest}) {
    SmallBody small(small_scene({"/far_field=none", "/loads=[" + loads + "]"}));
    EXPECT_NEAR(TestMachine<2>(small.body).read(small.body, 0).displacement, 0.006, 1e-15);
  }
}

// The box around a body is wider than its side.
TEST(TestMachine, StressIsOverTheSideAsItIs)
{
  for (const auto &kind : body_kinds) {
    if (kind.name == std::string("coupled"))
      continue; // the band ends at sides of a box
    SCOPED_TRACE(kind.name);
    SmallBody small(small_scene(
        kind.overrides +
        std::vector<std::string>{
            R"(/specimen={"outline": [{"at": [-12, 0]}, {"at": [12, 0]}, {"at": [6, 30]}, {"at": [-6, 30]}]})",
            R"(/loads=[{"boundary": "top", "traction": [null, 1e-4]}, {"boundary": "bottom", "displacement": [null, 0]}])",
            "/far_field=" + std::string(kind.name == std::string("pure_dem")
                                            ? "none"
                                            : R"({"cell_size": 2})")}));
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, {0, 0, small.body.dt});
    const Reading r = TestMachine<2>(small.body).read(small.body, 0);
    EXPECT_NEAR(r.load, 12e-4, 1e-9);
    EXPECT_NEAR(r.stress, 1e-4, 1e-10);
  }
}

// Particles lie inside the sides; a rotation moves those of different depths differently.
TEST(TestMachine, ParticlesTellTheMotionOfTheSideItself)
{
  for (const char *packing : {"hexagonal", "square", "random"}) {
    SCOPED_TRACE(packing);
    std::vector<std::string> overrides = {
        "/far_field=none", std::string("/discrete_zone/packing=") + packing, pulled_ends};
    if (packing != std::string("random"))
      overrides.push_back("/discrete_zone/orientation=0.3");
    SmallBody small(small_scene(overrides));
    Eigen::Matrix2d gradient;
    gradient << 1e-4, 3e-4, -2e-4, 5e-4;
    small.deform(gradient);
    for (int component = 0; component < 2; ++component) {
      EXPECT_NEAR(mean_displacement(small.body, 3, component), 60 * gradient(component, 1), 1e-12);
      EXPECT_NEAR(mean_displacement(small.body, 0, component), -12 * gradient(component, 0), 1e-12);
    }
  }
}

// A side that the mesh has nothing of, and two that it has a half of.
TEST(TestMachine, ReadsSidesOfTheZoneOfACoupledBody)
{
  SmallBody small(small_scene(
      {R"(/discrete_zone/region={"lower": [null, null], "upper": [null, 0]})", pulled_ends}));
  Eigen::Matrix2d gradient;
  gradient << 1e-4, 3e-4, -2e-4, 5e-4;
  small.deform(gradient);
  for (int component = 0; component < 2; ++component) {
    EXPECT_NEAR(mean_displacement(small.body, 2, component), -60 * gradient(component, 1), 1e-12);
    EXPECT_NEAR(mean_displacement(small.body, 3, component), 60 * gradient(component, 1), 1e-12);
    const double off = 4 * small.body.far->mesh().cell_size[0].maxCoeff(); // the overlap's height
    EXPECT_NEAR(mean_displacement(small.body, 0, component), -12 * gradient(component, 0),
                off * std::abs(gradient(component, 1)));
  }
}

// A point has no area: the side's stands for it. A part of a side has its own.
TEST(TestMachine, StressOfAPointIsThatOverTheSide)
{
  for (const auto &[part, area] :
       {std::pair(R"("from": 0, "to": 0)", 24.), std::pair(R"("from": -3, "to": 3)", 6.)})
  {
    SmallBody small(
        small_scene({"/discrete_zone=none", "/far_field/cell_size=4",
                     fmt::format(R"(/loads=[{{"boundary": "top", {}, "force": [null, -0.5]}},
                                                {{"boundary": "bottom", "displacement": [0, 0]}}])",
                                 part)}));
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, {0, 0, small.body.dt});
    const Reading r = TestMachine<2>(small.body).read(small.body, 0);
    EXPECT_NEAR(r.load, -0.5, 1e-12) << part;
    EXPECT_NEAR(r.stress, -0.5 / area, 1e-12) << part;
  }
}

// The mean over the side, whatever its cells: that of x^2 is W^2/12 but for the chords of the
// cells.
TEST(TestMachine, MeansOverTheAreaOfTheSide)
{
  SmallBody small(small_scene({"/discrete_zone=none", pulled_ends}));
  auto &far = *small.body.far;
  double largest = 0; // cell, along x
  for (const auto &h : far.mesh().cell_size)
    keep_largest(largest, h[0]);
  for (int i = 0; i < far.mesh().n_nodes(); ++i)
    far.displacement[1][i] = std::pow(far.mesh().nodes[i][0], 2);
  EXPECT_NEAR(mean_displacement(small.body, 3, 1), 24 * 24 / 12.,
              largest * largest / 6 * (1 + 1e-12));
  EXPECT_GE(mean_displacement(small.body, 3, 1), 24 * 24 / 12.);
}

// Particles nearer than d/4 to a side are left out: the outermost row may lie more than d inside.
TEST(TestMachine, FindsTheSideBeyondARowThatWasLeftOut)
{
  const double row = std::sqrt(0.75), half = 69.5 * row + 0.24;
  SmallBody small(small_scene(
      {"/far_field=none", "/specimen/size=[24, " + std::to_string(2 * half) + "]", pulled_ends}));
  small.deform(uniaxial(1e-4));
  EXPECT_NEAR(mean_displacement(small.body, 3, 1) / (1e-4 * half), 1, 1e-6);
}

TEST(TestMachine, FollowsTheFirstLoadAndItsLargestComponent)
{
  const auto machine = [](const std::string &loads) {
    SmallBody small(small_scene({"/discrete_zone=none", "/loads=" + loads}));
    return TestMachine<2>(small.body);
  };
  const auto shear = machine(R"([{"boundary": "top", "velocity": [1, 0.1]},
                                 {"boundary": "left", "velocity": [0.005, null]}])");
  EXPECT_EQ(shear.axis(), 1);
  EXPECT_EQ(shear.component(), 0);
  const auto side = machine(R"([{"boundary": "left", "traction": [0.1, null]}])");
  EXPECT_EQ(side.axis(), 0);
  EXPECT_EQ(side.component(), 0);
  EXPECT_FALSE(machine("[]").has_load());
}

TEST(TestMachine, TensionIsPositiveOnBothSides)
{
  for (const char *boundary : {"top", "bottom"}) {
    const std::string value = boundary == std::string("top") ? "0.006" : "-0.006";
    SmallBody small(
        small_scene({"/discrete_zone=none", "/loads=[{\"boundary\": \"" + std::string(boundary) +
                                                "\", \"displacement\": [null, " + value + "]}]"}));
    small.deform(uniaxial(1e-4));
    auto bodies = small.body.bodies();
    small.body.coupler->compute_forces(bodies, {0, 0, small.body.dt});
    EXPECT_GT(TestMachine<2>(small.body).read(small.body, 0).load, 0) << boundary;
  }
}
} // namespace
