// Which keys of two scenes differ, and with which of them a run may go on.
#include "src/scene/scene_difference.h"

#include <gtest/gtest.h>

using namespace ligament::program;
using Json = nlohmann::ordered_json;

namespace
{
std::vector<std::string> keys(const std::vector<KeyDifference> &differences)
{
  std::vector<std::string> keys;
  for (const KeyDifference &d : differences)
    keys.push_back(d.key);
  return keys;
}
using Keys = std::vector<std::string>;

const Json scene = Json::parse(R"({
  "specimen": {"size": [1, 2], "cracks": [{"points": [[0, 0], [1, 1]]}]},
  "loads": [{"boundary": "top", "ramp": 1.0}, {"boundary": "bottom"}],
  "time": {"duration": 4.0, "stop_when": "end"},
  "output": {"history_interval": 0.1, "pictures": []}
})");

TEST(SceneDifference, EqualScenesHaveNone)
{
  EXPECT_TRUE(differences(scene, scene).empty());
  EXPECT_TRUE(differences(scene, Json::parse(scene.dump())).empty());
}

TEST(SceneDifference, NamesEveryKeyOnce)
{
  Json other = scene;
  other["specimen"]["size"][0] = 3;
  other["specimen"]["cracks"][0]["points"][1][0] = 2;
  other["loads"][0]["ramp"] = 2.0;
  other["loads"][1]["ramp"] = 1.0;
  other["loads"].push_back({{"boundary", "left"}});
  other["time"].erase("stop_when");
  other["output"]["pictures"] = {{{"field", "velocity"}}};
  const auto found = differences(scene, other);
  EXPECT_EQ(keys(found),
            (Keys{"/specimen/size", "/specimen/cracks/0/points", "/loads/0/ramp", "/loads/1/ramp",
                  "/loads/2", "/time/stop_when", "/output/pictures"}));
  EXPECT_EQ(found[2].was, "1.0");
  EXPECT_EQ(found[2].is, "2.0");
  EXPECT_EQ(found[3].was, "nothing");
  EXPECT_EQ(found[5].is, "nothing");
}

TEST(SceneDifference, OnlyALongerDurationOutputsAndPathsDoNotMatter)
{
  Json read = scene, moved = scene;
  for (const auto &[section, key] :
       {std::pair("specimen", "file"), {"atoms", "file"}, {"discrete_zone", "packing_file"}})
  {
    read[section][key] = "here";
    moved[section][key] = "there";
  }
  EXPECT_TRUE(differences_that_matter(read, moved).empty());
  Json other = scene;
  other["time"]["duration"] = 5.0;
  other["output"] = Json::object();
  other["output"]["pictures"] = Json::array();
  EXPECT_TRUE(differences_that_matter(scene, other).empty());
  EXPECT_EQ(keys(differences_that_matter(other, scene)), (Keys{"/time/duration"}));
  other["time"]["stop_when"] = "specimen_broken";
  EXPECT_EQ(keys(differences_that_matter(scene, other)), (Keys{"/time/stop_when"}));
  Json phases = scene;
  phases["time"]["loading"] = "static";
  phases["time"]["calm"] = 4.0;
  phases["time"]["static_solver"] = "cholesky";
  EXPECT_EQ(keys(differences_that_matter(scene, phases)),
            (Keys{"/time/loading", "/time/calm", "/time/static_solver"}));
}
} // namespace
