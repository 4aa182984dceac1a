#include "packings/packing_file.h"

#include "core/check.h"
#include "core/files.h"
#include "core/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>

namespace ligament::packings
{
namespace
{
std::string_view trimmed(std::string_view text)
{
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back()))
    text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> split(std::string_view line)
{
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

/// Rows of a table with names and units; knows in which line it is.
class Table
{
public:
  explicit Table(const std::string &path) : path_(path), text_(core::read_file(path)), rest_(text_)
  {
    if (text_.compare(0, 3, "\xEF\xBB\xBF") == 0) // byte order mark
      rest_.remove_prefix(3);
    require(next(), "the file is empty: the first line names the columns x, y, z, r, material");
    for (std::size_t c = 0; c < fields_.size(); ++c)
      require(column_.emplace(fields_[c], c).second,
              fmt::format("two columns are called \"{}\"", fields_[c]));
    require(next(), "the row with the units is missing: the second line, such as m,m,m,m,1");
    require(fields_.size() == column_.size(), "units and names of the columns differ in number");
    units_.assign(fields_.begin(), fields_.end());
  }

  /// Goes to the next row; false at the end.
  bool next()
  {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      const std::string_view line = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_;
      if (line.empty() || line.front() == '#')
        continue;
      fields_ = split(line);
      return true;
    }
    return false;
  }

  bool has(const std::string &column) const { return column_.count(column) > 0; }

  /// How many metres the unit of the column is.
  double length_unit(const std::string &column) const
  {
    require(has(column), fmt::format("there is no column \"{}\"", column));
    const std::string &unit = units_[column_.at(column)];
    try {
      const core::Quantity quantity = core::parse_unit(unit);
      if (core::same_dimension(quantity.exponents, {0, 1, 0, 0}))
        return quantity.value;
    } catch (const std::invalid_argument &) {
    }
    throw core::InputError(
        place() +
        fmt::format("the unit \"{}\" of \"{}\" is no length, such as m or mm", unit, column));
  }

  /// In m; `unit` is how many of them the unit of the column is.
  double length(const std::string &column, double unit) const
  {
    const double value = unit * number(column);
    require(std::isfinite(value), fmt::format("the value in column \"{}\" is too large", column));
    return value;
  }

  double number(const std::string &column) const
  {
    require(fields_.size() == column_.size(),
            fmt::format("{} values for {} columns", fields_.size(), column_.size()));
    const std::string_view field = fields_[column_.at(column)];
    double value = 0;
    require(core::read_number(field, value),
            fmt::format("\"{}\" in column \"{}\" is no number", field, column));
    return value;
  }

  void require(bool condition, const std::string &message) const
  {
    if (!condition)
      throw core::InputError(place() + message);
  }

private:
  std::string place() const { return fmt::format("{}:{}: ", path_, std::max(line_, 1)); }

  std::string path_, text_;
  std::string_view rest_;
  int line_ = 0;
  std::map<std::string, std::size_t, std::less<>> column_;
  std::vector<std::string> units_;
  std::vector<std::string_view> fields_;
};
} // namespace

template <int dim>
void write_packing_file(const std::string &path, const Seeds<dim> &seeds)
{
  std::string text = "x,y,z,r,material\nm,m,m,m,1\n";
  for (int i = 0; i < seeds.size(); ++i) {
    for (int a = 0; a < 3; ++a)
      text += fmt::format("{},", a < dim ? seeds.centre[i][std::min(a, dim - 1)] : 0.);
    text += fmt::format("{},{}\n", seeds.radius[i], seeds.material.empty() ? 0 : seeds.material[i]);
  }
  core::write_file(path, text);
}

template <int dim>
Seeds<dim> read_packing_file(const std::string &path)
{
  Table table(path);
  const std::array<const char *, 4> names = {"x", "y", dim == 3 ? "z" : "r", "r"};
  std::array<double, dim + 1> unit;
  for (int a = 0; a <= dim; ++a)
    unit[a] = table.length_unit(names[a]);
  Seeds<dim> seeds;
  while (table.next()) {
    Vector<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = table.length(names[a], unit[a]);
    const double radius = table.length("r", unit[dim]);
    table.require(radius > 0, "the radius must be positive");
    if (dim == 2 && table.has("z"))
      table.require(table.number("z") == 0, "z must be 0 in a 2D scene");
    if (table.has("material")) {
      const double number = table.number("material");
      table.require(number >= 0 && number < 1e6 && number == std::floor(number),
                    "the material must be 0 or the number of an inclusion");
      seeds.material.push_back(int(number));
    }
    seeds.add(x, radius, seeds.size());
  }
  table.require(seeds.size() > 0, "the file holds no particles");
  return seeds;
}

template void write_packing_file(const std::string &, const Seeds<2> &);
template void write_packing_file(const std::string &, const Seeds<3> &);
template Seeds<2> read_packing_file<2>(const std::string &);
template Seeds<3> read_packing_file<3>(const std::string &);
} // namespace ligament::packings
