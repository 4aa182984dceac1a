#include "core/ranks_state.h"

#include "core/check.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

namespace ligament::core
{
namespace
{
/// The same on all ranks? Empty lines of those that have nothing to say don't count.
std::vector<std::string> different_texts(const std::string &mine, const Ranks &ranks)
{
  std::vector<std::string> texts;
  for (const auto &of : ranks.gather(std::vector<char>(mine.begin(), mine.end())))
    if (!of.empty() &&
        std::find(texts.begin(), texts.end(), std::string(of.begin(), of.end())) == texts.end())
      texts.emplace_back(of.begin(), of.end());
  return texts;
}

/// The columns that a table has where it has rows, on some rank; those without have none to agree
/// with. Throws on all ranks where two have different ones.
std::vector<std::string> columns_of(const std::string &name, const Table &mine, const Ranks &ranks)
{
  constexpr char end = '\n'; // of a column's name
  std::string text;
  if (mine.n_rows() > 0)
    for (const std::string &column : mine.columns())
      text += column + end;
  const auto texts = different_texts(text, ranks);
  require(texts.size() <= 1, "state: the ranks save different columns of the table '" + name + "'");
  if (texts.empty())
    return mine.columns();
  std::vector<std::string> columns;
  for (std::size_t begin = 0; begin < texts[0].size();) {
    const std::size_t next = texts[0].find(end, begin);
    columns.push_back(texts[0].substr(begin, next - begin));
    begin = next + 1;
  }
  return columns;
}

/// What some ranks have together, or one of them.
template <typename T>
std::vector<T> gathered(const std::vector<T> &here, const Ranks &ranks, bool at_first)
{
  return at_first ? ranks.gather_at_first(here) : ranks.gather_all(here);
}

/// Rows of several ranks, one behind the other.
struct Rows
{
  std::size_t n_keys, n_columns;
  std::vector<std::int64_t> keys;
  std::vector<std::uint64_t> words; // row by row

  const std::int64_t *key(std::size_t row) const { return keys.data() + row * n_keys; }
  const std::uint64_t *row(std::size_t row) const { return words.data() + row * n_columns; }
  bool is_before(std::size_t a, std::size_t b) const
  {
    return std::lexicographical_compare(key(a), key(a) + n_keys, key(b), key(b) + n_keys);
  }
};

Rows rows_of(const Table &mine, std::size_t n_columns, const Ranks &ranks, bool at_first)
{
  const std::size_t n = mine.n_rows();
  // Row by row, whatever the number of rows of each.
  std::vector<std::uint64_t> words(n * n_columns);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c < n_columns; ++c)
      words[r * n_columns + c] = mine.words()[c * n + r];
  return {std::size_t(mine.n_keys()), n_columns, gathered(mine.keys(), ranks, at_first),
          gathered(words, ranks, at_first)};
}

/// The rows in the order of their keys, one for each; nothing where two say different things under
/// one key.
std::optional<std::vector<std::size_t>> order_of(const Rows &rows)
{
  std::vector<std::size_t> order(rows.keys.size() / rows.n_keys), one_each;
  std::iota(order.begin(), order.end(), 0);
  const auto is_before = [&](std::size_t a, std::size_t b) { return rows.is_before(a, b); };
  // Parts of a body follow each other: of most tables nothing is to be sorted.
  if (!std::is_sorted(order.begin(), order.end(), is_before))
    std::stable_sort(order.begin(), order.end(), is_before);
  one_each.reserve(order.size());
  for (const std::size_t r : order) {
    if (one_each.empty() || rows.is_before(one_each.back(), r))
      one_each.push_back(r);
    else if (!std::equal(rows.row(r), rows.row(r) + rows.n_columns, rows.row(one_each.back())))
      return {};
  }
  return one_each;
}

Table table_of(const Rows &rows, const std::vector<std::size_t> &order,
               const std::vector<std::string> &columns)
{
  std::vector<std::int64_t> keys;
  keys.reserve(order.size() * rows.n_keys);
  for (const std::size_t r : order)
    keys.insert(keys.end(), rows.key(r), rows.key(r) + rows.n_keys);
  Table table(std::move(keys), int(rows.n_keys));
  std::vector<std::uint64_t> words(order.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (std::size_t k = 0; k < order.size(); ++k)
      words[k] = rows.row(order[k])[c];
    table.add_words(columns[c], words.data());
  }
  return table;
}
} // namespace

namespace
{
constexpr char end_of_name = '\n';

/// Names and numbers as text, keys and words beside it.
struct Told
{
  std::string text;
  std::vector<std::uint64_t> words;

  void say(const std::string &line) { text += line + end_of_name; }
  void say(std::size_t number) { say(std::to_string(number)); }
};

Told told(const std::map<std::string, State> &states)
{
  Told all;
  all.say(states.size());
  for (const auto &[name, state] : states) {
    all.say(name);
    all.say(state.size());
    for (const auto &[table_name, table] : state) {
      all.say(table_name);
      all.say(std::size_t(table.n_keys()));
      all.say(table.n_rows());
      all.say(table.columns().size());
      for (const std::string &column : table.columns())
        all.say(column);
      for (const std::int64_t key : table.keys())
        all.words.push_back(std::uint64_t(key));
      all.words.insert(all.words.end(), table.words().begin(), table.words().end());
    }
  }
  return all;
}

std::map<std::string, State> heard(const std::string &text, const std::vector<std::uint64_t> &words)
{
  std::size_t at = 0;
  auto word = words.begin();
  const auto line = [&] {
    const std::size_t begin = at;
    at = text.find(end_of_name, begin) + 1;
    return text.substr(begin, at - 1 - begin);
  };
  const auto number = [&] { return std::size_t(std::stoull(line())); };
  std::map<std::string, State> states;
  for (std::size_t n = number(); n > 0; --n) {
    State &state = states[line()];
    for (std::size_t n_tables = number(); n_tables > 0; --n_tables) {
      const std::string name = line();
      const std::size_t n_keys = number(), n_rows = number(), n_columns = number();
      std::vector<std::int64_t> keys(n_keys * n_rows);
      for (std::int64_t &key : keys)
        key = std::int64_t(*word++);
      Table table(std::move(keys), int(n_keys));
      for (std::size_t c = 0; c < n_columns; ++c) {
        const std::vector<std::uint64_t> column(word, word + std::ptrdiff_t(n_rows));
        table.add_words(line(), column.data());
        word += std::ptrdiff_t(n_rows);
      }
      state[name] = std::move(table);
    }
  }
  return states;
}
} // namespace

std::map<std::string, State> from_first(const std::map<std::string, State> &states,
                                        const Ranks &ranks)
{
  if (ranks.is_one())
    return states;
  const Told mine = ranks.is_first() ? told(states) : Told();
  const auto text = ranks.gather_all(std::vector<char>(mine.text.begin(), mine.text.end()));
  return heard({text.begin(), text.end()}, ranks.gather_all(mine.words));
}

bool is_sum(const Table &table)
{
  return table.n_keys() == 1 && table.n_rows() == std::size_t(ExactSum::n_words) &&
         table.columns() == std::vector<std::string>{"word"};
}

namespace
{
State merged(const State &part, const Ranks &ranks, bool at_first)
{
  if (ranks.is_one())
    return part;
  std::string names;
  for (const auto &[name, table] : part)
    names += name + ' ' + std::to_string(table.n_keys()) + '\n';
  require(different_texts(names, ranks).size() <= 1, "state: the ranks save different tables");
  State whole;
  for (const auto &[name, table] : part) {
    if (is_sum(table)) {
      save_sum(whole, name, ranks.sum(load_sum(part, name)));
      continue;
    }
    const auto columns = columns_of(name, table, ranks);
    const Rows rows = rows_of(table, columns.size(), ranks, at_first);
    const auto order = order_of(rows);
    require(order.has_value(), "state: the ranks have come apart in the table '" + name + "'");
    whole[name] = table_of(rows, *order, columns);
  }
  return whole;
}
} // namespace

State merged(const State &part, const Ranks &ranks)
{
  return merged(part, ranks, false);
}

State merged_at_first(const State &part, const Ranks &ranks)
{
  State whole = merged(part, ranks, true);
  return ranks.is_first() ? whole : State();
}

State share_of(const State &whole, const Ranks &ranks)
{
  State share = whole;
  for (auto &[name, table] : share)
    if (is_sum(table) && ranks.rank() > 0)
      save_sum(share, name, ExactSum());
  return share;
}
} // namespace ligament::core
