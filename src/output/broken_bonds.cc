#include "src/output/broken_bonds.h"

#include "core/files.h"
#include "src/output/table.h"

#include <fmt/core.h>

namespace ligament::program
{
void write_broken_bonds(const std::string &path, const std::vector<BrokenBond> &bonds,
                        int dimension)
{
  core::OutputFile file(path);
  file.write("i,j,time,x,y,z,nx,ny,nz,size,energy\n");
  file.write(fmt::format("1,1,s,m,m,m,1,1,1,{},J\n", dimension == 2 ? "m" : "m^2"));
  for (const auto &b : bonds)
    file.write(fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", b.i, b.j, b.time, b.centroid[0],
                           b.centroid[1], b.centroid[2], b.normal[0], b.normal[1], b.normal[2],
                           b.size, b.energy));
  file.commit();
}

std::vector<BrokenBond> read_broken_bonds(const std::string &path)
{
  const Table table = read_csv(path);
  std::vector<BrokenBond> bonds(table.n_rows());
  const auto fill = [&](const char *name, auto &&target) {
    const auto &values = table.raw(name);
    for (std::size_t b = 0; b < bonds.size(); ++b)
      target(bonds[b]) = values[b];
  };
  const auto id = [&](const char *name, std::int64_t BrokenBond::*member) {
    const auto &values = table.raw(name);
    for (std::size_t b = 0; b < bonds.size(); ++b)
      bonds[b].*member = std::int64_t(values[b]);
  };
  id("i", &BrokenBond::i);
  id("j", &BrokenBond::j);
  fill("time", [](BrokenBond &b) -> double & { return b.time; });
  for (int c = 0; c < 3; ++c) {
    static constexpr const char *centroid[] = {"x", "y", "z"}, *normal[] = {"nx", "ny", "nz"};
    fill(centroid[c], [c](BrokenBond &b) -> double & { return b.centroid[c]; });
    fill(normal[c], [c](BrokenBond &b) -> double & { return b.normal[c]; });
  }
  fill("size", [](BrokenBond &b) -> double & { return b.size; });
  fill("energy", [](BrokenBond &b) -> double & { return b.energy; });
  return bonds;
}
} // namespace ligament::program
