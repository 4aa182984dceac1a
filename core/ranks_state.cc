#include "core/ranks_state.h"

#include "core/check.h"

#include <algorithm>
#include <map>

namespace ligament::core
{
namespace
{
using Key = std::vector<std::int64_t>;
using Row = std::vector<std::uint64_t>;

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

/// Of all ranks; false where two say different things under one name.
bool merge_rows(const Table &mine, std::size_t n_columns, const Ranks &ranks,
                std::map<Key, Row> &rows)
{
  const std::size_t n_keys = mine.n_keys(), n = mine.n_rows();
  const auto keys = ranks.gather(mine.keys());
  // Row by row, whatever the number of rows of each.
  std::vector<std::uint64_t> words(n * n_columns);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c < n_columns; ++c)
      words[r * n_columns + c] = mine.words()[c * n + r];
  const auto all = ranks.gather(words);
  bool agree = true;
  for (std::size_t rank = 0; rank < keys.size(); ++rank)
    for (std::size_t r = 0; r * n_keys < keys[rank].size(); ++r) {
      const auto key = keys[rank].begin() + std::ptrdiff_t(r * n_keys);
      const auto first = all[rank].begin() + std::ptrdiff_t(r * n_columns);
      Row row(first, first + std::ptrdiff_t(n_columns));
      const auto [place, is_new] = rows.emplace(Key(key, key + std::ptrdiff_t(n_keys)), row);
      agree = agree && (is_new || place->second == row);
    }
  return agree;
}

Table table_of(const std::map<Key, Row> &rows, int n_keys, const std::vector<std::string> &columns)
{
  std::vector<std::int64_t> keys;
  for (const auto &[key, row] : rows)
    keys.insert(keys.end(), key.begin(), key.end());
  Table table(std::move(keys), n_keys);
  std::vector<std::uint64_t> words(rows.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::size_t r = 0;
    for (const auto &[key, row] : rows)
      words[r++] = row[c];
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

State merged(const State &part, const Ranks &ranks)
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
    std::map<Key, Row> rows;
    require(merge_rows(table, columns.size(), ranks, rows),
            "state: the ranks have come apart in the table '" + name + "'");
    whole[name] = table_of(rows, table.n_keys(), columns);
  }
  return whole;
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
