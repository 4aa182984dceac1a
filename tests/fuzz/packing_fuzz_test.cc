// Packing files that are right and wrong.
#include "core/check.h"
#include "packings/packing_file.h"
#include "tests/fuzz/fuzz_cases.h"
#include "tests/fuzz/text_faults.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace
{
using namespace ligament;
using namespace ligament::fuzz;
using namespace ligament::packings;

struct Column
{
  std::string name, unit;
};

std::string draw_value(Draw &draw, const Column &column, int dimension)
{
  if (column.name == "material")
    return std::to_string(draw.between(0, 3));
  if (column.name == "z" && dimension == 2)
    return draw.once_in(2) ? "0" : "0.0";
  const double x = draw.spread(1e-3, 1e3);
  return fmt::format("{}", column.name == "r" || draw.once_in(2) ? x : -x);
}

/// A file as any program may write it: columns in any order and unit, comments, blanks, CRLF.
std::string draw_file(Draw &draw, int dimension)
{
  static const std::vector<std::string> units = {"m", "mm", "um", "nm", "km", "angstrom"};
  std::vector<Column> columns = {{"x", ""}, {"y", ""}, {"r", ""}};
  if (dimension == 3 || draw.once_in(2))
    columns.push_back({"z", ""});
  for (Column &column : columns)
    column.unit = draw.of(units);
  if (draw.once_in(2))
    columns.push_back({"material", "1"});
  if (draw.once_in(3))
    columns.push_back({"colour", "no unit"});
  for (std::size_t k = columns.size(); k > 1; --k)
    std::swap(columns[k - 1], columns[draw.below(k)]);

  const std::string end = draw.once_in(4) ? " \r\n" : "\n";
  const std::string comma = draw.once_in(4) ? " ,\t" : ",";
  std::string text = draw.once_in(8) ? "\xEF\xBB\xBF" : "";
  const auto row = [&](const auto &field) {
    if (draw.once_in(10))
      text += "# a remark, with, commas" + end;
    for (std::size_t c = 0; c < columns.size(); ++c)
      text += (c > 0 ? comma : "") + field(columns[c]);
    text += end;
  };
  row([](const Column &column) { return column.name; });
  row([](const Column &column) { return column.unit; });
  for (int n = draw.between(1, 12); n > 0; --n)
    row([&](const Column &column) { return draw_value(draw, column, dimension); });
  return text;
}

template <int dim>
void expect_sound(const Seeds<dim> &seeds)
{
  ASSERT_GT(seeds.size(), 0);
  ASSERT_EQ(seeds.radius.size(), seeds.centre.size());
  ASSERT_EQ(seeds.id.size(), seeds.centre.size());
  EXPECT_TRUE(seeds.material.empty() || seeds.material.size() == seeds.centre.size());
  for (int i = 0; i < seeds.size(); ++i) {
    EXPECT_TRUE(seeds.centre[i].allFinite()) << "row " << i;
    EXPECT_TRUE(std::isfinite(seeds.radius[i]) && seeds.radius[i] > 0) << "row " << i;
  }
}

/// The seeds of any text at all, if it is accepted; else the message names file, line and finding.
template <int dim>
std::optional<Seeds<dim>> read_any(const std::string &text)
{
  note_document(text);
  const File file("fuzz_packing.csv", text);
  std::optional<Seeds<dim>> seeds;
  try {
    seeds = read_packing_file<dim>(file.name());
  } catch (const core::InputError &error) {
    const std::string message = error.what();
    const std::string start = file.name() + ":";
    EXPECT_EQ(message.compare(0, start.size(), start), 0) << message;
    const std::size_t end = message.find(": ", start.size());
    EXPECT_NE(end, message.npos) << message;
    EXPECT_GE(std::atoi(message.c_str() + start.size()), 1) << message;
    EXPECT_GT(message.size(), end + 2) << message;
    return {};
  }
  expect_sound(*seeds);
  write_packing_file<dim>("fuzz_echo.csv", *seeds);
  const Seeds<dim> again = read_packing_file<dim>("fuzz_echo.csv");
  EXPECT_EQ(again.centre, seeds->centre);
  EXPECT_EQ(again.radius, seeds->radius);
  EXPECT_EQ(again.id, seeds->id);
  EXPECT_TRUE(seeds->material.empty() || again.material == seeds->material);
  return seeds;
}

template <int dim>
void right_case(Draw &draw)
{
  EXPECT_TRUE(read_any<dim>(draw_file(draw, dim)));
}

template <int dim>
void wrong_case(Draw &draw)
{
  std::string text = draw_file(draw, dim);
  for (int n = draw.between(1, 4); n > 0; --n)
    text = draw.once_in(3) ? with_wrong_bytes(draw, text) : with_wrong_line(draw, text, ",");
  read_any<dim>(text);
}

void any_case(Draw &draw)
{
  const bool flat = draw.once_in(2);
  if (draw.once_in(5))
    flat ? right_case<2>(draw) : right_case<3>(draw);
  else
    flat ? wrong_case<2>(draw) : wrong_case<3>(draw);
}
} // namespace

TEST(PackingFuzz, RightFilesAreAccepted)
{
  run_cases(11, 300,
            [](Draw &draw) { draw.once_in(2) ? right_case<2>(draw) : right_case<3>(draw); });
}

TEST(PackingFuzz, WrongFilesAreToldWithTheirLine)
{
  run_cases(12, 10000,
            [](Draw &draw) { draw.once_in(2) ? wrong_case<2>(draw) : wrong_case<3>(draw); });
}

TEST(PackingFuzz, SlowManyFiles)
{
  run_cases_for(900, any_case);
}
