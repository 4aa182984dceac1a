// What a sweep says of cases that could not be computed, from what the solver left behind.
#include "src/sweep/sweep.h"

#include "core/files.h"

#include <gtest/gtest.h>

#include <filesystem>

using namespace ligament;
using namespace ligament::program;

namespace
{
/// The end of the only case of a sweep whose solver is this script.
CaseEnd end_with(const std::string &script)
{
  namespace fs = std::filesystem;
  core::write_file("solver.sh", "#!/bin/sh\n" + script + "\n");
  fs::permissions("solver.sh", fs::perms::owner_all);
  fs::remove_all("reasons");
  StudyFolder folder("reasons");
  CaseList list;
  list.cases.resize(1);
  list.cases[0].id = "only";
  list.cases[0].scene = {{"dimension", 2}};
  return Sweep(list, folder, fs::absolute("solver.sh"), 1, nullptr).run().at("only");
}

const std::string refusal = R"(echo "scene.json:3:4: error: the crack leaves the zone" >&2
echo "scene.json: 2 errors, nothing was computed" >&2
echo 'the body is built'
echo '{"status": "wrong input", "errors": [{"message": "the crack leaves the zone", "reason": "REASON"},
  {"message": "another"}]}' | tr -d '\n'
exit 2)";

TEST(SweepReasons, AreTheFirstErrorOfARefusedScene)
{
  std::string script = refusal;
  script.replace(script.find("REASON"), 6, "");
  CaseEnd end = end_with(script);
  EXPECT_EQ(end.status, CaseEnd::Status::refused);
  EXPECT_EQ(end.reason, "the crack leaves the zone");

  script = refusal;
  script.replace(script.find("REASON"), 6, "it is 3 mm too long");
  EXPECT_EQ(end_with(script).reason, "the crack leaves the zone: it is 3 mm too long");
}

TEST(SweepReasons, OfARunThatCheckAccepted)
{
  const CaseEnd end =
      end_with("if [ $1 = check ]; then echo '{\"predicted_seconds\": 1}'; exit 0; fi\n" + refusal);
  EXPECT_EQ(end.status, CaseEnd::Status::failed);
  EXPECT_EQ(end.reason, "the crack leaves the zone: REASON");
}

// What ends before it can write an object has at least a line of text, or a code.
TEST(SweepReasons, WithoutObjectAreWhatStandardErrorSays)
{
  EXPECT_EQ(end_with("echo 'a: error: no disk' >&2; exit 4").reason, "no disk");
  EXPECT_EQ(end_with("echo '{\"errors\": [' ; echo 'error: no disk' >&2; exit 4").reason,
            "no disk");
  EXPECT_EQ(end_with("echo '{\"errors\": []}' ; exit 4").reason, "exit code 4");
  EXPECT_EQ(end_with("exit 5").reason, "exit code 5");
}
} // namespace
