// Runs whose body is built anew from the scene again and again, and given its own state: byte for
// byte what a run with one body writes. Through the program, with shortened examples.
#include "tests/support/run_results.h"

using namespace ligament::tests;
namespace fs = std::filesystem;

namespace
{
const std::string examples = LIGAMENT_SOURCE_DIR "/examples/";

/// Faces that had broken when a run with --rebuild-interval built its body for the last time.
long broken_at_rebuild(const std::string &run)
{
  const std::string log = file_text(run + "/run.log"), words = " times, the last time with ";
  const std::size_t place = log.rfind(words);
  return place == log.npos ? -1 : std::stol(log.substr(place + words.size()));
}

struct Example
{
  std::string name, scene, overrides; // overrides: sizes and what else makes it small
  double early, late;                 // s: durations, between them something breaks
  int interval;                       // of rebuilds from early to late
};

std::string with_duration(double seconds)
{
  return " --set /time/duration=" + std::to_string(1e9 * seconds) + "e-9 ";
}

/// To the end in one go; the same with a body built anew every 100 steps of the far field; to the
/// earlier time, and resumed from there with a new body every `interval` steps.
void expect_the_same_run(const Example &e)
{
  SCOPED_TRACE(e.name);
  const std::string command =
      "run " + e.scene + e.overrides +
      " --set /output/checkpoint_interval=1e-9 --set /time/stop_when=end --set "
      "/time/loading=dynamic"
      " --set /output/field_interval=never --set /output/history_interval=" +
      std::to_string(1e9 * e.late / 200) + "e-9 -o " + e.name;
  const auto done = [](const Outcome &outcome) {
    ASSERT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  };
  done(run_ligament(command + "_whole" + with_duration(e.late)));
  const std::string whole = e.name + "_whole";
  ASSERT_FALSE(newest_checkpoint(whole).empty());
  const long broken = file_json(whole + "/run.json")["broken_bonds"];

  done(run_ligament(command + "_seldom --rebuild-interval 100" + with_duration(e.late)));
  expect_same(e.name + "_seldom", whole);
  EXPECT_GE(broken_at_rebuild(e.name + "_seldom"), 1);

  done(run_ligament(command + "_often" + with_duration(e.early)));
  const long broken_early = file_json(e.name + "_often/run.json")["broken_bonds"];
  EXPECT_GE(broken_early, 3);
  EXPECT_GT(broken, broken_early); // between the rebuilds, too
  done(run_ligament("resume " + e.name + "_often --rebuild-interval " + std::to_string(e.interval) +
                    with_duration(e.late)));
  EXPECT_GE(broken_at_rebuild(e.name + "_often"), broken_early);
  expect_same(e.name + "_often", whole);
}

class Rebuild : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    fs::remove_all("rebuild");
    fs::create_directory("rebuild");
    fs::current_path("rebuild");
  }
  static void TearDownTestSuite() { fs::current_path(".."); }
};

std::string set(const std::string &key, const std::string &value)
{
  return " --set '" + key + "=" + value + "'";
}

/// Fewer and larger particles between the ends of a plate, which are torn apart faster.
std::string coarse(const std::string &spacing, const std::string &cell, const std::string &half)
{
  return set("/discrete_zone/spacing", spacing) + set("/far_field/cell_size", cell) +
         set("/far_field/levels", "0") + set("/coupling/overlap_cells", "2") +
         set("/discrete_zone/region",
             "{\"lower\": [null, \"-" + half + "\"], \"upper\": [null, \"" + half + "\"]}");
}

/// The top at this velocity in m/s, the bottom against it.
std::string pulled(double velocity, const std::string &ramp)
{
  std::string text;
  for (int load = 0; load < 2; ++load) {
    const std::string key = "/loads/" + std::to_string(load);
    text += set(key + "/velocity/1", std::to_string(load == 0 ? velocity : -velocity)) +
            set(key + "/ramp", ramp);
  }
  return text;
}

TEST_F(Rebuild, CrackedPlate)
{
  expect_the_same_run({"plate", examples + "cracked_plate/fast.json",
                       coarse("1.5 mm", "6.15 mm", "30 mm") + pulled(0.04, "0.4 ms"), 0.469e-3,
                       0.55e-3, 7});
}

TEST_F(Rebuild, InclinedCrack)
{
  expect_the_same_run(
      {"inclined", examples + "inclined_crack/scene.json",
       coarse("1.5 mm", "6.15 mm", "36 mm") + pulled(0.08, "0.2 ms") + set("/damping/mass", "0"),
       0.2015e-3, 0.3e-3, 7});
}

TEST_F(Rebuild, RandomPlate)
{
  expect_the_same_run({"random", examples + "random_plate/scene.json",
                       coarse("1.5 mm", "6.15 mm", "30 mm") + pulled(0.04, "0.2 ms"), 0.2372e-3,
                       0.3e-3, 7});
}

// In compression, with friction and mass damping.
TEST_F(Rebuild, ClosedCrack)
{
  expect_the_same_run(
      {"closed", examples + "closed_crack/scene.json",
       coarse("1.6 mm", "5 mm", "40 mm") + pulled(-0.4, "0.2 ms") + set("/coupling/guard", "warn"),
       0.227e-3, 0.26e-3, 7});
}

// Pulses, tables and cycles, parts of sides, forces on every mass, and motion from the start.
TEST_F(Rebuild, LoadsInTimeOnAMovingPlate)
{
  const std::string command =
      std::string("run " LIGAMENT_SOURCE_DIR "/tests/support/scenes/moving_plate.json") +
      set("/output/field_interval", "never") + set("/output/history_interval", "1e-7") +
      set("/output/checkpoint_interval", "1e-9") + " -o moving";
  const auto done = [](const Outcome &outcome) {
    ASSERT_EQ(outcome.code, 0) << outcome.output << outcome.errors;
  };
  done(run_ligament(command + "_whole"));
  done(run_ligament(command + "_seldom --rebuild-interval 11"));
  expect_same("moving_seldom", "moving_whole");
  // Behind the pulse, the table and a cycle: a run that ends before them warns of it.
  done(run_ligament(command + "_often" + with_duration(3.3e-5)));
  done(run_ligament("resume moving_often --rebuild-interval 7" + with_duration(5e-5)));
  expect_same("moving_often", "moving_whole");
}

// Torn, then pressed: contacts of faces between two materials have the moduli of the lengths at
// which they broke, which flow had stretched.
TEST_F(Rebuild, ContactsOfTwoMaterials)
{
  std::ofstream("layers.json") << R"({
    "title": "layers", "dimension": 2, "plane": "stress", "specimen": {"size": ["20 mm", "40 mm"]},
    "material": {"youngs_modulus": "10 GPa", "poissons_ratio": 0.3, "density": 2450, "friction": 0.3,
                 "fracture": {"criterion": "maximum_tension", "strength": "8 MPa"}},
    "inclusions": [{"youngs_modulus": "30 GPa", "poissons_ratio": 0.3, "density": 2450, "friction": 0.3,
      "boxes": [{"lower": ["-50 mm", 0], "upper": ["50 mm", "50 mm"]}],
      "plasticity": {"yield_stress": "6 MPa", "hardening": "300 MPa"},
      "fracture": {"criterion": "none"}}],
    "discrete_zone": {"extent": "all", "packing": "random", "spacing": "1 mm"},
    "loads": [{"boundary": "top", "displacement": [null, 2e-4],
               "history": {"table": [[0, 0], [1e-4, 1], [2.5e-4, -2], [4e-4, 1]]}},
              {"boundary": "bottom", "displacement": [0, 0]}],
    "damping": {"mass": 1e4}, "time": {"duration": 4e-4}, "output": {}})";
  expect_the_same_run({"layers", "layers.json", "", 1.3e-4, 3e-4, 50});
}

const std::string bar = examples + "notched_bar_3d/scene.json";

TEST_F(Rebuild, SmallNotchedBar)
{
  const std::string small =
      set("/far_field/cell_size", "2.25 mm") + set("/discrete_zone/spacing", "0.75 mm") +
      set("/coupling/transition_cells", "3") +
      set("/discrete_zone/region",
          "{\"lower\": [null, \"-12 mm\", null], \"upper\": [null, \"12 mm\", null]}");
  expect_the_same_run({"small_bar", bar, small + pulled(0.3, "0"), 1.03e-5, 1.35e-5, 7});
}

TEST_F(Rebuild, SlowNotchedBar)
{
  expect_the_same_run({"bar", bar, pulled(0.3, "0"), 1.03e-5, 1.4e-5, 7});
}
} // namespace
