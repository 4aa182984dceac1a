// What a body is at one time, apart from what follows from its scene: tables whose rows are called
// by names that no numbering, partition or zone changes.
#pragma once

#include "core/exact_sum.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ligament::core
{
/// Rows of 64-bit words, doubles or integers, kept bit by bit. Rows have ascending names of
/// `n_keys` integers each: a particle or node (1), a loaded face (2), a contact or dashpot (3);
/// tables of single values have one row called 0.
class Table
{
public:
  Table() = default;
  /// `keys`: n_keys numbers per row, row after row, strictly ascending (lexicographically).
  explicit Table(std::vector<std::int64_t> keys, int n_keys = 1);

  int n_keys() const { return n_keys_; }
  std::size_t n_rows() const { return keys_.size() / n_keys_; }
  const std::vector<std::int64_t> &keys() const { return keys_; }
  const std::vector<std::string> &columns() const { return columns_; }
  /// Column by column, n_rows() words each.
  const std::vector<std::uint64_t> &words() const { return words_; }

  /// One value per row. Throws core::InputError for a wrong number of values, and for a name that
  /// is there already.
  void add(const std::string &column, const std::vector<double> &values);
  void add(const std::string &column, const std::vector<std::int64_t> &values);
  /// The same, from words.
  void add_words(const std::string &column, const std::uint64_t *values);

  bool has(const std::string &column) const;
  /// Throw core::InputError where there is no such column.
  std::vector<double> reals(const std::string &column) const;
  std::vector<std::int64_t> integers(const std::string &column) const;

  bool operator==(const Table &other) const;

private:
  const std::uint64_t *words_of(const std::string &column) const;

  int n_keys_ = 1;
  std::vector<std::int64_t> keys_;
  std::vector<std::string> columns_;
  std::vector<std::uint64_t> words_;
};

using State = std::map<std::string, Table>;

/// Throws core::InputError where the state has no such table.
const Table &table(const State &state, const std::string &name);

/// One-row table for values that belong to no particle or node; made where it is missing.
void save_value(State &state, const std::string &table, const std::string &column, double value);
void save_value(State &state, const std::string &table, const std::string &column,
                std::int64_t value);
/// A sum with all its digits, as a table of its own.
void save_sum(State &state, const std::string &table, const ExactSum &sum);
ExactSum load_sum(const State &state, const std::string &table);
double load_real(const State &state, const std::string &table, const std::string &column);
std::int64_t load_integer(const State &state, const std::string &table, const std::string &column);
} // namespace ligament::core
