// The generated pages of the manual must be those that the table gives now (target "manual").
#include "src/scene/read_scene.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

using namespace ligament::program;

namespace
{
std::string committed(const std::string &name)
{
  std::ifstream file(LIGAMENT_SOURCE_DIR "/docs/manual/" + name);
  EXPECT_TRUE(file) << name;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}
} // namespace

TEST(Manual, ParameterReferenceIsUpToDate)
{
  EXPECT_TRUE(committed("parameters.md") == reference_markdown()) << "build the target manual";
}

TEST(Manual, SchemaIsUpToDate)
{
  EXPECT_TRUE(committed("scene.schema.json") == json_schema().dump(2) + "\n")
      << "build the target manual";
}

TEST(Manual, EveryKeyHasAMeaning)
{
  for (const auto &key : explain_json(""))
    EXPECT_FALSE(key["text"].get<std::string>().empty()) << key["key"];
}
