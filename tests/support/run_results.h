// What a run of the program wrote, byte for byte beside that of another run. LIGAMENT_PROGRAM is
// the program.
#pragma once

#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

namespace ligament::tests
{
inline Outcome run_ligament(const std::string &arguments, const std::string &environment = "")
{
  return run_shell(environment + " exec " LIGAMENT_PROGRAM " " + arguments);
}

/// Of the newest checkpoint; empty: there is none.
inline std::string newest_checkpoint(const std::string &run)
{
  std::string newest;
  std::error_code none;
  for (const auto &entry : std::filesystem::directory_iterator(run + "/checkpoints", none))
    if (entry.is_directory() && entry.path().extension() != ".tmp")
      newest = std::max(newest, entry.path().string());
  return newest;
}

/// What a run computed: tables, fields, pictures, motion of the particles, its last state.
inline std::map<std::string, std::string> results(const std::string &run)
{
  namespace fs = std::filesystem;
  std::map<std::string, std::string> files;
  for (const char *name :
       {"history.csv", "broken_bonds.csv", "cut_faces.csv", "fragments.csv", "packing.csv",
        "fields.pvd", "snapshot_0.bin", "snapshot_1.bin", "snapshot_2.bin"})
    if (fs::exists(run + "/" + name))
      files[name] = file_text(run + "/" + name);
  for (const char *folder : {"fields", "pictures"})
    if (fs::exists(run + "/" + folder))
      for (const auto &entry : fs::directory_iterator(run + "/" + folder))
        files[folder + ("/" + entry.path().filename().string())] = file_text(entry.path());
  files["body.bin"] = file_text(newest_checkpoint(run) + "/body.bin");
  return files;
}

inline void expect_same(const std::string &run, const std::string &reference)
{
  const auto found = results(run), expected = results(reference);
  EXPECT_EQ(found.size(), expected.size());
  for (const auto &[name, content] : expected) {
    EXPECT_FALSE(content.empty()) << name;
    EXPECT_TRUE(found.count(name) && found.at(name) == content) << run << "/" << name;
  }
  const auto record = file_json(run + "/run.json"), wanted = file_json(reference + "/run.json");
  for (const char *key : {"status", "reason", "steps", "broken_bonds", "crack_length", "peak_load",
                          "external_work", "energy_residual", "regime", "states", "warnings",
                          "magnification", "stiffness", "broken_time", "figures"})
    EXPECT_EQ(record.value(key, nlohmann::json()), wanted.value(key, nlohmann::json())) << key;
}
} // namespace ligament::tests
