#include "core/state.h"

#include "core/check.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace ligament::core
{
namespace
{
template <typename T>
std::vector<T> from_words(const std::uint64_t *words, std::size_t n)
{
  std::vector<T> values(n);
  if (n > 0)
    std::memcpy(values.data(), words, n * sizeof(T));
  return values;
}

Table &values_of(State &state, const std::string &name)
{
  return state.try_emplace(name, std::vector<std::int64_t>{0}).first->second;
}
} // namespace

Table::Table(std::vector<std::int64_t> keys, int n_keys) : n_keys_(n_keys), keys_(std::move(keys))
{
  require(n_keys >= 1 && keys_.size() % n_keys == 0, "state: rows with a part of a name");
  for (std::size_t k = n_keys; k < keys_.size(); k += n_keys)
    require(std::lexicographical_compare(keys_.begin() + (k - n_keys), keys_.begin() + k,
                                         keys_.begin() + k, keys_.begin() + (k + n_keys)),
            "state: names of rows must ascend");
}

void Table::add_words(const std::string &column, const std::uint64_t *values)
{
  require(!has(column), "state: column '" + column + "' twice");
  if (columns_.empty()) // most tables have fewer columns, and memory that nobody touches is free
    words_.reserve(16 * n_rows());
  columns_.push_back(column);
  words_.insert(words_.end(), values, values + n_rows());
}

void Table::add(const std::string &column, const std::vector<double> &values)
{
  require(values.size() == n_rows(), "state: wrong number of values of '" + column + "'");
  add_words(column, reinterpret_cast<const std::uint64_t *>(values.data()));
}

void Table::add(const std::string &column, const std::vector<std::int64_t> &values)
{
  require(values.size() == n_rows(), "state: wrong number of values of '" + column + "'");
  add_words(column, reinterpret_cast<const std::uint64_t *>(values.data()));
}

bool Table::has(const std::string &column) const
{
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

const std::uint64_t *Table::words_of(const std::string &column) const
{
  const auto place = std::find(columns_.begin(), columns_.end(), column);
  require(place != columns_.end(), "state: no column '" + column + "'");
  return words_.data() + (place - columns_.begin()) * n_rows();
}

std::vector<double> Table::reals(const std::string &column) const
{
  return from_words<double>(words_of(column), n_rows());
}

std::vector<std::int64_t> Table::integers(const std::string &column) const
{
  return from_words<std::int64_t>(words_of(column), n_rows());
}

bool Table::operator==(const Table &other) const
{
  return n_keys_ == other.n_keys_ && keys_ == other.keys_ && columns_ == other.columns_ &&
         words_ == other.words_;
}

const Table &table(const State &state, const std::string &name)
{
  const auto found = state.find(name);
  require(found != state.end(), "state: no table '" + name + "'");
  return found->second;
}

void save_value(State &state, const std::string &table, const std::string &column, double value)
{
  values_of(state, table).add(column, std::vector<double>{value});
}

void save_value(State &state, const std::string &table, const std::string &column,
                std::int64_t value)
{
  values_of(state, table).add(column, std::vector<std::int64_t>{value});
}

void save_sum(State &state, const std::string &name, const ExactSum &sum)
{
  std::vector<std::int64_t> digits(ExactSum::n_words);
  std::iota(digits.begin(), digits.end(), 0);
  Table table(std::move(digits));
  table.add("word", sum.words());
  state[name] = std::move(table);
}

ExactSum load_sum(const State &state, const std::string &name)
{
  return ExactSum::from_words(table(state, name).integers("word"));
}

double load_real(const State &state, const std::string &name, const std::string &column)
{
  return table(state, name).reals(column).at(0);
}

std::int64_t load_integer(const State &state, const std::string &name, const std::string &column)
{
  return table(state, name).integers(column).at(0);
}
} // namespace ligament::core
