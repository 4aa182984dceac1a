// The manual names everything that a run writes.
#include "core/files.h"
#include "packings/packing_file.h"
#include "src/drawing/shown_field.h"
#include "src/output/broken_bonds.h"
#include "src/output/checkpoint_manifest.h"
#include "src/output/fields.h"
#include "src/output/history.h"
#include "src/output/run_record.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace ligament;
using namespace ligament::program;

namespace
{
/// From one heading of docs/manual/outputs.md to the next.
std::string section(const std::string &heading)
{
  const std::string text = core::read_file(LIGAMENT_SOURCE_DIR "/docs/manual/outputs.md");
  const std::size_t begin = text.find("\n## " + heading + "\n");
  EXPECT_NE(begin, std::string::npos) << heading;
  return text.substr(begin, text.find("\n## ", begin + 1) - begin);
}

void expect_named(const std::string &text, const std::string &name)
{
  EXPECT_NE(text.find('`' + name + '`'), std::string::npos)
      << "docs/manual/outputs.md does not explain " << name << text.substr(0, text.find('|'));
}

/// The unit stands in the line of the table that names it.
void expect_unit(const std::string &text, const std::string &name, const std::string &unit)
{
  const std::size_t line = text.find("| `" + name + "` |");
  ASSERT_NE(line, std::string::npos) << name;
  EXPECT_LT(text.find("| " + unit, line), text.find('\n', line)) << name << " in " << unit;
}

TEST(Manual, NamesTheColumnsOfTheHistory)
{
  const std::string text = section("history.csv");
  for (const int dimension : {2, 3})
    for (const Column &column : history_columns(dimension, true, true)) {
      expect_named(text, column.name);
      if (column.name != "crack_length")
        expect_unit(text, column.name, column.unit);
    }
}

TEST(Manual, NamesTheColumnsOfTheTables)
{
  write_broken_bonds("columns.csv", std::vector<BrokenBond>(1), 2);
  const std::string bonds = section("broken_bonds.csv"), seeds = section("packing.csv");
  const Table broken = read_csv("columns.csv");
  for (const Column &column : broken.columns())
    expect_named(bonds, column.name);
  packings::Seeds<2> seed;
  seed.add({0, 0}, 1, 0);
  packings::write_packing_file("columns.csv", seed);
  const Table packing = read_csv("columns.csv");
  for (const Column &column : packing.columns()) {
    expect_named(seeds, column.name);
    if (column.name == "r")
      expect_unit(seeds, column.name, column.unit);
  }
}

TEST(Manual, NamesTheFields)
{
  const std::string text = section("Fields"), pictures = section("Pictures");
  for (const FieldInfo &info : field_table()) {
    expect_named(text, info.name);
    expect_unit(text, info.name, info.unit);
  }
  for (const int dimension : {2, 3})
    for (const std::string &word : shown_field_words(dimension))
      if (shown_field(word, dimension).component >= 0)
        expect_named(pictures, word);
}

void expect_keys(const nlohmann::json &json, const std::string &text, bool names_are_keys = true)
{
  for (const auto &[key, value] : json.items()) {
    if (names_are_keys)
      expect_named(text, key);
    if (value.is_object())
      expect_keys(value, text, key != "figures");
    for (const auto &element : value)
      if (value.is_array() && element.is_object())
        expect_keys(element, text);
  }
}

TEST(Manual, NamesTheKeysOfTheRecord)
{
  RunRecord record;
  record.figures["any"] = {1, "Pa"};
  record.timing.resize(1);
  record.skipped.resize(1);
  record.states.resize(1);
  record.pictures.resize(1);
  record.phases.resize(1);
  write_run_record("keys.json", record);
  expect_keys(nlohmann::json::parse(core::read_file("keys.json")),
              section("Figures of the report, keys of run.json"));
}

TEST(Manual, NamesTheKeysOfAManifest)
{
  CheckpointManifest manifest;
  manifest.states["body"] = {};
  const std::string text = section("Checkpoints");
  const auto json = nlohmann::json::parse(manifest_text(manifest));
  for (const auto &[key, value] : json.items())
    expect_named(text, key);
}
} // namespace
