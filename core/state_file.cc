#include "core/state_file.h"

#include "core/check.h"
#include "core/files.h"
#include "core/packed_keys.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <functional>

namespace ligament::core
{
namespace
{
// All numbers have 64 bits in the order of the machine:
//   magic, version, bytes of the file, bytes of the header
//   number of tables, and of each: name, keys per row, rows, columns, bytes of its packed keys,
//     names of the columns
//   checksum of the above
//   of each table: packed keys, words column by column
//   checksum of all of the above
constexpr char magic[] = "LGMSTATE";
constexpr std::uint64_t version = 1;
constexpr std::size_t word = sizeof(std::uint64_t), prelude = 4 * word;

std::uint64_t checksum(std::string_view bytes, std::uint64_t before = 0)
{
  if (bytes.empty()) // without an address zlib starts anew
    return before;
  return crc32_z(before, reinterpret_cast<const Bytef *>(bytes.data()), bytes.size());
}

std::string_view bytes_of(const std::uint64_t &number)
{
  return {reinterpret_cast<const char *>(&number), word};
}

std::string_view bytes_of(const std::vector<std::uint64_t> &words)
{
  return {reinterpret_cast<const char *>(words.data()), words.size() * word};
}

void put(std::string &text, std::uint64_t number)
{
  text += bytes_of(number);
}

void put(std::string &text, const std::string &name)
{
  put(text, name.size());
  text += name;
}

/// Bytes that are taken from the front.
class Cursor
{
public:
  explicit Cursor(std::string_view bytes) : left_(bytes) {}

  std::string_view bytes(std::uint64_t n)
  {
    require(n <= left_.size(), "damaged: a part is longer than the whole");
    const std::string_view taken = left_.substr(0, n);
    left_.remove_prefix(n);
    return taken;
  }
  std::uint64_t number()
  {
    std::uint64_t value;
    std::memcpy(&value, bytes(word).data(), word);
    return value;
  }
  std::string name() { return std::string(bytes(number())); }
  bool empty() const { return left_.empty(); }

private:
  std::string_view left_;
};

std::string header_of(const State &state, const std::vector<std::string> &keys)
{
  std::string directory;
  put(directory, state.size());
  std::uint64_t content = 0;
  auto packed = keys.begin();
  for (const auto &[name, table] : state) {
    put(directory, name);
    for (const std::uint64_t number :
         {std::uint64_t(table.n_keys()), std::uint64_t(table.n_rows()),
          std::uint64_t(table.columns().size()), std::uint64_t(packed->size())})
      put(directory, number);
    for (const std::string &column : table.columns())
      put(directory, column);
    content += packed->size() + table.words().size() * word;
    ++packed;
  }
  std::string header(magic, word);
  const std::uint64_t header_bytes = prelude + directory.size() + word;
  for (const std::uint64_t number : {version, header_bytes + content + word, header_bytes})
    put(header, number);
  header += directory;
  put(header, checksum(header));
  return header;
}

/// Columns and packed keys of a table, as the header has them.
struct Entry
{
  std::string name;
  std::uint64_t n_keys, n_rows, n_columns, key_bytes;
  std::vector<std::string> columns;
};

Entry read_entry(Cursor &header)
{
  Entry entry;
  entry.name = header.name();
  for (std::uint64_t *number : {&entry.n_keys, &entry.n_rows, &entry.n_columns, &entry.key_bytes})
    *number = header.number();
  for (std::uint64_t c = 0; c < entry.n_columns; ++c)
    entry.columns.push_back(header.name());
  return entry;
}

Table read_table(const Entry &entry, Cursor &content)
{
  const std::string_view keys = content.bytes(entry.key_bytes);
  require(entry.n_keys >= 1 && entry.n_keys <= 16 && entry.n_rows < (std::uint64_t(1) << 56),
          "damaged: a table of impossible size");
  // The words are taken first: rows that are not there must not make room for their names.
  std::vector<std::string_view> columns;
  for (std::uint64_t c = 0; c < entry.n_columns; ++c)
    columns.push_back(content.bytes(entry.n_rows * word));
  Table table(unpack_keys(keys, int(entry.n_keys), std::int64_t(entry.n_rows)), int(entry.n_keys));
  std::vector<std::uint64_t> values(entry.n_rows);
  for (std::uint64_t c = 0; c < entry.n_columns; ++c) {
    if (!values.empty()) // memcpy takes no null pointer, not even for nothing
      std::memcpy(values.data(), columns[c].data(), columns[c].size());
    table.add_words(entry.columns[c], values.data());
  }
  return table;
}

/// The state in the bytes of a file, and their sum.
State parse(std::string_view file, StateFileSum &sum)
{
  require(file.size() >= prelude && std::memcmp(file.data(), magic, word) == 0,
          "not a file of states, or damaged at its beginning");
  Cursor all(file.substr(word));
  const std::uint64_t found_version = all.number(), bytes = all.number(),
                      header_bytes = all.number();
  require(found_version == version,
          fmt::format("of format {}, this program reads format {}", found_version, version));
  require(
      bytes == file.size(),
      fmt::format("cut or damaged: it has {} bytes and says that it has {}", file.size(), bytes));
  require(header_bytes >= prelude + 2 * word && header_bytes <= file.size() - word,
          "damaged: no header");
  const auto verify = [&](std::uint64_t end, const char *what) {
    const std::uint64_t found = checksum(file.substr(0, end));
    require(found == Cursor(file.substr(end)).number(),
            fmt::format("damaged: the checksum of {} is wrong", what));
    return std::int64_t(found);
  };
  verify(header_bytes - word, "the header");
  sum = {std::int64_t(bytes), verify(bytes - word, "the content")};

  Cursor header(file.substr(prelude, header_bytes - word - prelude)),
      content(file.substr(header_bytes, bytes - word - header_bytes));
  State state;
  for (std::uint64_t n = header.number(); n > 0; --n) {
    const Entry entry = read_entry(header);
    state.emplace(entry.name, read_table(entry, content));
  }
  require(header.empty() && content.empty(), "damaged: more bytes than its tables have");
  return state;
}
} // namespace

namespace
{
/// Hands over what a file of the state says, but for its sum, in slices; answers the file's sum.
StateFileSum for_each_slice(const State &state, const std::function<void(std::string_view)> &visit)
{
  std::vector<std::string> keys;
  for (const auto &[name, table] : state)
    keys.push_back(pack_keys(table.keys(), table.n_keys()));
  StateFileSum sum;
  // Slice by slice, which is in the cache still when its sum is formed.
  constexpr std::size_t slice = std::size_t(1) << 19;
  const auto add = [&](std::string_view bytes) {
    sum.bytes += std::int64_t(bytes.size());
    for (; !bytes.empty(); bytes.remove_prefix(std::min(slice, bytes.size()))) {
      const std::string_view part = bytes.substr(0, slice);
      visit(part);
      sum.checksum = std::int64_t(checksum(part, sum.checksum));
    }
  };
  add(header_of(state, keys));
  auto packed = keys.begin();
  for (const auto &[name, table] : state) {
    add(*packed++);
    add(bytes_of(table.words()));
  }
  sum.bytes += word;
  return sum;
}
} // namespace

StateFileSum write_state_file(const std::string &path, const State &state)
{
  OutputFile file(path);
  const StateFileSum sum = for_each_slice(state, [&](std::string_view part) { file.write(part); });
  file.write(bytes_of(std::uint64_t(sum.checksum)));
  file.commit();
  return sum;
}

StateFileSum state_file_sum(const State &state)
{
  return for_each_slice(state, [](std::string_view) {});
}

State read_state_file(const std::string &path, const std::optional<StateFileSum> &expected)
{
  try {
    StateFileSum sum;
    State state = parse(read_file(path), sum);
    require(!expected || sum == *expected, "not the file that was written here");
    return state;
  } catch (const EnvironmentError &error) {
    throw InputError(error.what());
  } catch (const InputError &error) {
    throw InputError(path + ": " + error.what());
  }
}
} // namespace ligament::core
