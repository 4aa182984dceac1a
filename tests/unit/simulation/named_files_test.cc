// A run goes on only with the files that its scene named when it began.
#include "src/simulation/named_files.h"

#include "core/files.h"
#include "core/keyed_error.h"

#include <gtest/gtest.h>

#include <cstdio>

using namespace ligament;
using namespace ligament::program;

namespace
{
TEST(NamedFiles, AreThoseTheRunBeganWith)
{
  const char *body = "named_files_body.stl", *potential = "named_files.alloy";
  core::write_file(body, "solid\n");
  core::write_file(potential, "Cu\n");
  Scene scene;
  scene.specimen.file = body;
  scene.atoms.emplace().file = potential;
  Reference begun;
  keep_named_files(scene, begun);
  Reference goes_on(begun.tables());
  EXPECT_NO_THROW(keep_named_files(scene, goes_on));
  for (const auto &[file, key] :
       {std::pair(body, "/specimen/file"), std::pair(potential, "/atoms/file")}) {
    const std::string text = core::read_file(file);
    core::write_file(file, text + " ");
    Reference later(begun.tables());
    try {
      keep_named_files(scene, later);
      ADD_FAILURE() << "another file went on";
    } catch (const core::KeyedError &error) {
      EXPECT_EQ(error.key, key);
    }
    core::write_file(file, text);
  }
  std::remove(body);
  std::remove(potential);
}
} // namespace
