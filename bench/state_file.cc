// Size and time of a State on the disk, for the particles of a lattice in 3D: {name, value, unit}
// as JSON lines. bench_state_file [number of particles] [folder]
#include "core/state_file.h"
#include "packings/lattice_packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

namespace
{
using namespace ligament;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void print(const std::string &name, double value, const std::string &unit)
{
  fmt::print("{{\"name\": \"{}\", \"value\": {:.4g}, \"unit\": \"{}\"}}\n", name, value, unit);
}

core::State state_of(std::vector<std::int64_t> ids)
{
  std::sort(ids.begin(), ids.end());
  core::Table table(ids);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int c = 0; c < 13; ++c) { // u, v, spin, orientation: 3 + 3 + 3 + 4
    std::vector<double> column(ids.size());
    for (double &value : column)
      value = uniform(random);
    table.add(fmt::format("column_{}", c), column);
  }
  return {{"particles", std::move(table)}};
}
} // namespace

int main(int argc, char **argv)
{
  packings::LatticeParameters<3> lattice;
  // A cube, with sqrt(2) particles per spacing cubed.
  const double n_wanted = argc > 1 ? std::atof(argv[1]) : 1e6;
  lattice.spacing = std::cbrt(std::sqrt(2.) / n_wanted);
  lattice.lower.setZero();
  lattice.upper.setOnes();
  const core::State state = state_of(packings::make_lattice_packing<3>(lattice).global_id);
  const double n = double(state.at("particles").n_rows());
  print("particles", n, "1");

  const std::filesystem::path folder = argc > 2 ? argv[2] : ".";
  const std::string path = folder / "bench_state.bin";
  for (int k = 0; k < 5; ++k) {
    auto start = Clock::now();
    const core::StateFileSum sum = core::write_state_file(path, state);
    print("write_and_sync", seconds_since(start), "s");
    start = Clock::now();
    const core::State read = core::read_state_file(path, sum);
    print("read", seconds_since(start), "s");
    if (k == 0)
      print("size", double(sum.bytes) / n, "bytes per particle");
  }
  std::filesystem::remove(path);
}
