#include "src/output/snapshot.h"

#include "core/check.h"
#include "core/files.h"

#include <zlib.h>

#include <cmath>
#include <cstring>

namespace ligament::program
{
namespace
{
constexpr char magic[8] = {'L', 'G', 'M', 'S', 'N', 'A', 'P', '1'};

struct Header
{
  char magic[8];
  std::int64_t dimension;
  std::int64_t n_particles;
  double time;
  double spacing;
};

unsigned long checksum(const std::string &text)
{
  return crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef *>(text.data()), text.size());
}

template <typename T>
void append(std::string &text, const T *values, std::size_t n)
{
  text.append(reinterpret_cast<const char *>(values), n * sizeof(T));
}
} // namespace

int common_time_index(double time)
{
  return int(std::floor(std::log(time) / std::log(1.02)));
}

double common_time(int index)
{
  return std::pow(1.02, index);
}

void write_snapshot(const std::string &path, const Snapshot &s)
{
  Header header{{}, s.dimension, std::int64_t(s.size()), s.time, s.spacing};
  std::memcpy(header.magic, magic, sizeof(magic));
  std::string text;
  append(text, &header, 1);
  append(text, s.global_id.data(), s.global_id.size());
  for (const auto *values : {&s.reference, &s.displacement, &s.velocity}) {
    core::require(values->size() == s.size() * s.dimension,
                  "snapshot: wrong number of values per particle");
    append(text, values->data(), values->size());
  }
  const std::uint64_t sum = checksum(text);
  append(text, &sum, 1);
  core::write_file(path, text);
}

Snapshot read_snapshot(const std::string &path)
{
  std::string text;
  try {
    text = core::read_file(path);
  } catch (const core::EnvironmentError &error) {
    throw core::InputError(error.what());
  }
  const auto check = [&](bool good) { core::require(good, path + ": damaged snapshot"); };
  Header header;
  std::uint64_t sum;
  check(text.size() >= sizeof(header) + sizeof(sum));
  std::memcpy(&header, text.data(), sizeof(header));
  std::memcpy(&sum, text.data() + text.size() - sizeof(sum), sizeof(sum));
  text.resize(text.size() - sizeof(sum));
  check(std::memcmp(header.magic, magic, sizeof(magic)) == 0 && checksum(text) == sum);

  Snapshot s;
  s.dimension = int(header.dimension);
  s.time = header.time;
  s.spacing = header.spacing;
  s.global_id.resize(header.n_particles);
  const char *next = text.data() + sizeof(header);
  const auto take = [&](auto &values, std::size_t n) {
    values.resize(n);
    std::memcpy(values.data(), next, n * sizeof(values[0]));
    next += n * sizeof(values[0]);
  };
  check(text.size() == sizeof(header) + s.size() * (1 + 3 * s.dimension) * sizeof(double));
  take(s.global_id, s.size());
  for (auto *values : {&s.reference, &s.displacement, &s.velocity})
    take(*values, s.size() * s.dimension);
  return s;
}
} // namespace ligament::program
