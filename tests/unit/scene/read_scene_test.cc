#include "core/files.h"
#include "src/scene/read_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace ligament;
using namespace ligament::program;
using Extent = DiscreteZone::Extent;

namespace
{
const std::string plate = LIGAMENT_SOURCE_DIR "/tests/support/scenes/plate.json";
const std::string along_rows = "/discrete_zone/orientation=0"; // of the plate's crack
const std::string bar = LIGAMENT_SOURCE_DIR "/tests/support/scenes/bar.json";

std::string all(const ReadResult &result)
{
  std::string text;
  for (const core::Diagnostic &d : result.errors)
    text += to_string(d) + "\n";
  return text;
}

Scene good(const std::string &file, const std::vector<std::string> &overrides = {})
{
  const ReadResult result = read_scene(file, overrides);
  EXPECT_EQ(all(result), "");
  return result.scene.value_or(Scene());
}

// Regions that are not given are everything, and are so when they are read again.
TEST(ReadScene, PartsOfSidesSurviveTheirEcho)
{
  const std::string scene =
      core::read_file(LIGAMENT_SOURCE_DIR "/tests/support/scenes/moving_plate.json");
  const auto first = parse_scene(scene, "scene");
  ASSERT_TRUE(first.scene);
  const auto again = parse_scene(first.resolved.dump(), "echo");
  for (const auto &error : again.errors)
    ADD_FAILURE() << core::to_string(error);
  ASSERT_TRUE(again.scene);
  EXPECT_EQ(again.resolved, first.resolved);
  const LoadParameters &load = again.scene->loads[0];
  EXPECT_EQ(load.from, -0.009);
  EXPECT_TRUE(load.within.is_everything());
  EXPECT_EQ(again.scene->loads[1].kind, LoadKind::force);
  EXPECT_EQ(again.scene->loads[1].history.table.size(), 3u);
  EXPECT_EQ(again.scene->body_force.history.cycles->mean, 0.3);
  EXPECT_EQ(again.scene->initial_motion[0].spin[0], 3);
}
} // namespace

TEST(ReadScene, CoupledPlate)
{
  const Scene s = good(plate);
  EXPECT_EQ(s.dimension, 2);
  EXPECT_EQ(s.plane, PlaneMode::strain);
  EXPECT_EQ(s.specimen.size, (Point{0.08, 0.16, 0}));
  ASSERT_EQ(s.specimen.cracks.size(), 1u);
  EXPECT_EQ(s.specimen.cracks[0].points[1], (Point{0.008, 0, 0}));
  EXPECT_EQ(s.specimen.holes[0].radius, 0.002);
  EXPECT_EQ(s.specimen.notches[0].upper, (Point{-0.035, 0.001, 0}));
  EXPECT_EQ(s.material.youngs_modulus, 72e9);
  EXPECT_EQ(s.material.fracture.toughness.value(), 0.75e6);
  EXPECT_FALSE(s.material.fracture.strength);
  EXPECT_EQ(s.zone.extent, Extent::box);
  EXPECT_EQ(s.zone.lower[1], -0.03);
  EXPECT_LT(s.zone.lower[0], -0.04); // reaches beyond the side, and is finite
  EXPECT_TRUE(std::isfinite(s.zone.lower[0]) && std::isfinite(s.zone.upper[0]));
  EXPECT_GT(s.zone.upper[0], 0.04);
  EXPECT_DOUBLE_EQ(s.zone.orientation[0], std::acos(-1.0) / 12);
  EXPECT_EQ(s.far_field.value().levels, 2);
  EXPECT_EQ(s.coupling.step_ratio, 2);
  ASSERT_EQ(s.loads.size(), 2u);
  EXPECT_EQ(s.loads[1].kind, LoadKind::velocity);
  EXPECT_FALSE(s.loads[1].value[0]);
  EXPECT_EQ(s.loads[1].value[1].value(), -0.01);
  EXPECT_EQ(s.loads[1].ramp, 0.0002);
  EXPECT_EQ(s.time.stop_when, StopWhen::specimen_broken);
  EXPECT_EQ(s.output.field_interval, 1e-4);
}

TEST(ReadScene, CoupledBarIn3d)
{
  const Scene s = good(bar);
  EXPECT_EQ(s.dimension, 3);
  EXPECT_EQ(s.zone.packing, PackingKind::fcc);
  EXPECT_DOUBLE_EQ(s.zone.orientation[2], std::acos(-1.0) / 4);
  EXPECT_EQ(s.loads[1].kind, LoadKind::displacement);
  EXPECT_EQ(s.loads[1].value[2].value(), 0);
  EXPECT_EQ(s.coupling.gap_filter, 4); // a default
  EXPECT_TRUE(std::isinf(s.output.field_interval));
}

TEST(ReadScene, FarFieldNoneIsThePureDiscreteTwin)
{
  for (const std::string &file : {plate, bar}) {
    const Scene s = good(file, {"/far_field=none"});
    EXPECT_EQ(s.zone.extent, Extent::all);
    EXPECT_FALSE(s.far_field);
    EXPECT_EQ(s.zone.spacing, good(file).zone.spacing);
    for (int c = 0; c < s.dimension; ++c) {
      EXPECT_LT(s.zone.lower[c], -s.specimen.size[c] / 2);
      EXPECT_GT(s.zone.upper[c], s.specimen.size[c] / 2);
    }
  }
}

// A word for the zone leaves its other keys: packing and spacing are needed by the twin.
TEST(ReadScene, ZoneAllIsTheSameTwin)
{
  const Scene s = good(plate, {"/discrete_zone=all"});
  EXPECT_EQ(s.zone.extent, Extent::all);
  EXPECT_EQ(s.zone.spacing, 0.0005);
  EXPECT_FALSE(s.far_field);
}

TEST(ReadScene, ZoneNoneIsPureFiniteElements)
{
  const std::string whole = "/specimen/cracks=[]";
  const ReadResult result =
      read_scene(plate, std::vector<std::string>{"/discrete_zone=none", whole});
  EXPECT_EQ(all(result), "");
  EXPECT_EQ(result.scene.value().zone.extent, Extent::none);
  EXPECT_EQ(result.scene.value().far_field.value().cell_size, 0.002);
  for (const core::Diagnostic &warning : result.warnings) // the mesh follows hole and notch
    EXPECT_TRUE(warning.key == "/material/fracture" || warning.key == "/material/friction")
        << core::to_string(warning);
  EXPECT_EQ(good(bar, {"/discrete_zone=none", whole, "/specimen/notches=[]"}).zone.extent,
            Extent::none);
  // No packing is needed where no particle is.
  EXPECT_EQ(good(plate, {R"(/discrete_zone={"extent": "none"})", whole}).zone.spacing, 0);
}

TEST(ReadScene, NoCheckOfTheOverlapWithoutOverlap)
{
  good(plate, {"/far_field=none", "/specimen/cracks/0/points/1/1=60 mm"});
  good(plate, {"/far_field=none", "/discrete_zone/spacing=1 mm",
               "/discrete_zone/region/upper/1=90 mm", "/discrete_zone/region/lower/1=-90 mm"});
  good(plate, {"/far_field=none", "/loads/0/boundary=left"});
}

// The overlap of a zone at a loaded side does not touch that side when it lies across it.
TEST(ReadScene, ZoneMayReachALoadedSideThatTheOverlapDoesNotTouch)
{
  const Scene s = good(plate, {"/discrete_zone/region/lower/1=null"});
  EXPECT_LT(s.zone.lower[1], -0.08);
}

TEST(ReadScene, ResolvedEchoReadsBackToItself)
{
  const std::vector<std::vector<std::string>> variants = {{},
                                                          {"/far_field=none"},
                                                          {"/discrete_zone=none"},
                                                          {"/discrete_zone=all"},
                                                          {R"(/discrete_zone={"extent": "none"})"},
                                                          {"/output/field_interval=never"}};
  for (const std::string &file : {plate, bar})
    for (const auto &overrides : variants) {
      std::vector<std::string> changes = overrides;
      if (overrides.size() == 1 && overrides[0].find("none") != std::string::npos &&
          overrides[0] != "/far_field=none")
      { // a mesh alone has no cracks, in 3D no notches
        changes.push_back("/specimen/cracks=[]");
        changes.push_back("/specimen/notches=[]");
      }
      const ReadResult first = read_scene(file, changes);
      ASSERT_TRUE(first.scene) << all(first);
      const ReadResult second = parse_scene(first.resolved.dump(2), "echo");
      ASSERT_TRUE(second.scene) << all(second);
      EXPECT_EQ(second.resolved.dump(), first.resolved.dump());
      EXPECT_EQ(second.scene->zone.lower, first.scene->zone.lower);
      EXPECT_EQ(second.scene->zone.upper, first.scene->zone.upper);
      EXPECT_EQ(second.scene->far_field.has_value(), first.scene->far_field.has_value());
    }
}

// Values that stand in the echo as defaults must not contradict those that were given: a run goes
// on from its echo.
TEST(ReadScene, EchoOfAlternativesReadsBackToItself)
{
  const std::vector<std::string> variants = {
      R"(/material/plasticity={"law": "drucker_prager", "cohesion": "8 MPa",
                                "friction_angle": "35 deg"})",
      R"(/material/plasticity={"law": "drucker_prager", "cohesion": "80 MPa",
                                "friction_angle": "35 deg", "softening_energy": "1 MJ/m^2"})",
      R"(/material/plasticity={"yield_stress": "200 MPa"})",
      R"(/material/plasticity={"curve": [{"strain": 0, "stress": "200 MPa"}]})",
      R"(/time={"duration": "1 ms", "step": "1 ns"})",
      "/material/poissons_ratio=0"};
  for (const std::string &change : variants) {
    const ReadResult first = read_scene(plate, {change});
    ASSERT_TRUE(first.scene) << change << all(first);
    const ReadResult second = parse_scene(first.resolved.dump(), "echo");
    ASSERT_TRUE(second.scene) << change << all(second);
    EXPECT_EQ(second.resolved.dump(), first.resolved.dump()) << change;
  }
}

// In plane strain flow changes the stress out of the plane, which these criteria don't see.
TEST(ReadScene, CriteriaOfAllStressesAreDoubtedInWhatFlows)
{
  const auto is_doubted = [&](const std::string &criterion, const std::string &of) {
    const ReadResult result = read_scene(
        plate, {R"(/material/fracture={"strength": "5 MPa", "compressive_strength": "50 MPa",
                                       "criterion": ")" +
                    criterion + "\"}",
                of});
    return std::any_of(
        result.warnings.begin(), result.warnings.end(),
        [](const core::Diagnostic &d) { return d.key == "/material/fracture/criterion"; });
  };
  const std::string flow = R"(/material/plasticity={"yield_stress": "200 MPa"})",
                    creep = R"(/material/viscosity={"branches": [{"share": 0.5,
                                                                 "relaxation_time": "1 ms"}]})";
  EXPECT_TRUE(is_doubted("von_mises", flow));
  EXPECT_TRUE(is_doubted("drucker_prager", flow));
  EXPECT_TRUE(is_doubted("energy", creep));
  EXPECT_FALSE(is_doubted("von_mises", "/plane=strain"));
  EXPECT_FALSE(is_doubted("maximum_tension", flow));
}

TEST(ReadScene, BoxesTakeThePlaceOfARegionOfNulls)
{
  const ReadResult first =
      read_scene(plate, {"/discrete_zone/region/lower=[null, null]",
                         "/discrete_zone/region/upper=[null, null]",
                         R"(/discrete_zone/boxes=[{"lower": [null, "-30 mm"], "upper": [null, 0]},
                                                  {"lower": [null, 0], "upper": [null, "30 mm"]}])"});
  ASSERT_TRUE(first.scene) << all(first);
  EXPECT_EQ(first.scene->zone.lower[1], -0.03);
  EXPECT_EQ(first.scene->zone.upper[1], 0.03);
  const ReadResult second = parse_scene(first.resolved.dump(2), "echo");
  ASSERT_TRUE(second.scene) << all(second);
  EXPECT_EQ(second.resolved.dump(), first.resolved.dump());
}

// Where boxes go through the specimen no overlap takes of it, however thin it is.
TEST(ReadScene, BoxesGoThroughThinSpecimens)
{
  const std::string boxes =
      R"(/discrete_zone/boxes=[{"lower": [null, "-30 mm"], "upper": [null, 0]},
                                                     {"lower": [null, 0], "upper": [null, "30 mm"]}])";
  const ReadResult thin = read_scene(
      plate, {"/specimen/cracks=[]", "/specimen/holes=[]", "/specimen/notches=[]",
              R"(/specimen/size/0="3 mm")", R"(/discrete_zone/spacing="0.5 mm")",
              R"(/far_field/cell_size="2 mm")", "/discrete_zone/region/lower=[null, null]",
              "/discrete_zone/region/upper=[null, null]", boxes});
  EXPECT_TRUE(thin.scene) << all(thin);
}

TEST(ReadScene, ErrorsStandInTheOrderOfTheFileAndOverridesLast)
{
  const ReadResult result =
      parse_scene("{\"time\": {},\n\"title\": 1,\n\"speciman\": {}}", "s.json", {"/dimension=5"});
  ASSERT_GE(result.errors.size(), 5u);
  for (std::size_t k = 1; k + 1 < result.errors.size(); ++k)
    EXPECT_LE(result.errors[k - 1].place.line, result.errors[k].place.line);
  EXPECT_EQ(to_string(result.errors.back().place), "--set /dimension");
  EXPECT_FALSE(result.scene);
  EXPECT_TRUE(result.resolved.is_null());
}

TEST(ReadScene, RatioBeyondTheRecommendedIsAWarning)
{
  const ReadResult result = read_scene(plate, {along_rows, "/far_field/cell_size=1.1 mm"});
  EXPECT_EQ(all(result), "");
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_EQ(result.warnings[0].key, "/far_field/cell_size");
}

TEST(ReadScene, CracksOffTheRowsOfALatticeAreAWarning)
{
  const auto warned = [&](const std::string &scene, const std::vector<std::string> &overrides) {
    const ReadResult result = read_scene(scene, overrides);
    EXPECT_EQ(all(result), "");
    return std::any_of(
        result.warnings.begin(), result.warnings.end(),
        [](const core::Diagnostic &d) { return d.key == "/specimen/cracks/0/points"; });
  };
  EXPECT_TRUE(warned(plate, {}));
  EXPECT_TRUE(warned(plate, {"/discrete_zone/orientation=30 deg"}));
  EXPECT_FALSE(warned(plate, {"/discrete_zone/orientation=60.5 deg"}));
  EXPECT_FALSE(warned(plate, {"/discrete_zone/orientation=0", "/discrete_zone/packing=square"}));
  EXPECT_FALSE(
      warned(plate, {R"(/material/fracture={"criterion": "none"})", "/time/stop_when=end"}));
  // The bar's crack lies in a cube plane; turned about x by the angle between {100} and {111} in
  // one of these.
  EXPECT_FALSE(warned(bar, {}));
  EXPECT_FALSE(warned(bar, {R"(/discrete_zone/orientation=["54.7356 deg", 0, 0])"}));
  EXPECT_TRUE(warned(bar, {R"(/discrete_zone/orientation=["20 deg", 0, 0])"}));
}

TEST(ReadScene, SizeStepsInAnOpenFarFieldAreAWarning)
{
  const std::string open = R"(/loads=[{"boundary": "top", "absorbing": true}])";
  const auto warned = [&](std::vector<std::string> overrides) {
    overrides.push_back(open);
    overrides.push_back(along_rows);
    const ReadResult result = read_scene(plate, overrides);
    EXPECT_EQ(all(result), "");
    return !result.warnings.empty() && result.warnings[0].key == "/far_field/levels";
  };
  EXPECT_TRUE(warned({}));
  EXPECT_TRUE(warned({"/far_field/fine_cells=9"})); // overlap of 3, transition of 6
  EXPECT_FALSE(warned({"/far_field/fine_cells=8"}));
  EXPECT_FALSE(warned({"/far_field/growth=1.2"}));
  EXPECT_FALSE(warned({"/far_field/levels=0"}));
}

TEST(ReadScene, KeysOfLargerCellsWithoutThemAreAWarning)
{
  const ReadResult result = read_scene(plate, {along_rows, "/far_field/levels=0",
                                               "/far_field/growth=1.2", "/far_field/fine_cells=2"});
  EXPECT_EQ(all(result), "");
  EXPECT_EQ(result.warnings.size(), 2u);
}

// Columns of one gauge may begin with the whole name of another.
TEST(ReadScene, ServosFollowTheGaugeWithTheLongestName)
{
  const Scene scene = good(
      plate,
      {along_rows,
       R"(/gauges=[{"name": "ct", "kind": "crack_tip", "points": [[0.008, 0]], "direction": [1, 0]},
                   {"name": "ct_x", "kind": "strain", "points": [[0, 0.02]]}])",
       R"(/loads=[{"boundary": "bottom", "displacement": [0, 0]},
                  {"boundary": "top", "velocity": [null, 1],
                   "servo": {"gauge": "ct_x_yy", "value": 1e-4, "ramp": 1e-3, "gain": 6}}])",
       R"(/time={"duration": 2e-3})"});
  EXPECT_EQ(scene.gauges.size(), 2u);
}

TEST(ReadScene, FileThatIsNotThere)
{
  const ReadResult result = read_scene("no_such_scene.json");
  ASSERT_EQ(result.errors.size(), 1u);
  EXPECT_EQ(to_string(result.errors[0].place), "no_such_scene.json");
}

TEST(ReadScene, NoBeginningOfASceneDoesHarm)
{
  const std::string text =
      R"({"dimension": 3, "specimen": {"size": ["1 m", 2, null]}, "loads": [{}],
    "discrete_zone": {"region": {"lower": [null]}}, "far_field": {"levels": 1e9}, "time": [1]})";
  for (std::size_t n = 0; n <= text.size(); ++n)
    EXPECT_FALSE(parse_scene(text.substr(0, n), "t").errors.empty());
}

TEST(Explain, KnowsTheKeysOfTheScene)
{
  EXPECT_NE(explain("/coupling/overlap_cells").find("default  3"), std::string::npos);
  EXPECT_NE(explain("toughness").find("Pa*m^0.5"), std::string::npos);
  EXPECT_NE(explain("").find("/loads/*/ramp"), std::string::npos);
}
