// The generated pages on studies must be those that the table gives now (target "manual").
#include "core/files.h"
#include "src/sweep/study.h"

#include <gtest/gtest.h>

using namespace ligament;
using namespace ligament::program;

TEST(Manual, StudyReferenceIsUpToDate)
{
  const std::string folder = LIGAMENT_SOURCE_DIR "/docs/manual/";
  EXPECT_TRUE(core::read_file(folder + "study.md") == study_markdown())
      << "build the target manual";
  EXPECT_TRUE(core::read_file(folder + "study.schema.json") == study_schema())
      << "build the target manual";
}
