#include "md/table_file.h"

#include "core/check.h"
#include "md/atomic_units.h"
#include "md/number_reader.h"
#include "md/sampled_spline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace ligament::md
{
namespace
{
/// hartree times bohr as these files were made with, eV angstrom.
constexpr double charge_squared = 27.2 * 0.529;

/// The grids of a file, in its units.
struct Grids
{
  int n_density, n_distance;
  double density_step, distance_step, cutoff;
};

Grids read_grids(NumberReader &file)
{
  Grids g;
  g.n_density = file.count("the number of densities", 4);
  g.density_step = file.number("the step of the density");
  file.require(g.density_step > 0, "the step of the density is not above 0: the grid must rise; "
                                   "mend the file");
  g.n_distance = file.count("the number of distances", 8);
  g.distance_step = file.number("the step of the distance");
  file.require(g.distance_step > 0, "the step of the distance is not above 0: the grid must rise; "
                                    "mend the file");
  g.cutoff = file.number("the cut-off");
  file.require(g.cutoff > 4 * g.distance_step,
               fmt::format("the cut-off {} is too short for the step {}; mend the file", g.cutoff,
                           g.distance_step));
  // Many tables stop one step before the cut-off, where they would be 0.
  file.require(g.cutoff <= (g.n_distance + 1e-6) * g.distance_step,
               fmt::format("the cut-off {} lies beyond the table, which ends at {}; mend the file",
                           g.cutoff, (g.n_distance - 1) * g.distance_step));
  return g;
}

Species read_species(NumberReader &file)
{
  Species s;
  s.name = std::string(file.word("an atomic number"));
  s.mass = file.number("the mass of an atom") * atomic_mass_unit;
  file.require(s.mass > 0, "the mass is not above 0: atoms could not be moved; mend the file");
  s.lattice_parameter = file.number("the lattice parameter") * angstrom;
  s.lattice = std::string(file.word("the kind of lattice"));
  std::transform(s.lattice.begin(), s.lattice.end(), s.lattice.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return s;
}

/// A function of the distance as the file has it, refused where it does not end at the cut-off.
class Column
{
public:
  Column(NumberReader &file, const std::string &what, const Grids &grids) : cutoff(grids.cutoff)
  {
    const int n = grids.n_distance;
    std::vector<double> values = file.numbers(what, n);
    // Of the outer half of its range: tables may go on behind their cut-off.
    const int end = std::clamp(int(std::ceil(cutoff / grids.distance_step)), 1, n);
    double size = 0;
    for (int k = end / 2; k < end; ++k)
      size = std::max(size, std::abs(values[k]));
    values.push_back(std::abs(values[n - 1]) < 1e-6 * size ? 0.
                                                           : 2 * values[n - 1] - values[n - 2]);
    spline_ = std::make_shared<Spline>(grids.distance_step, values);
    const double left = (*spline_)(cutoff).value;
    file.require(std::abs(left) <= 0.01 * size,
                 fmt::format("{} is still {:.3g} at the cut-off {}: forces would jump there; "
                             "choose a table that ends smoothly",
                             what, left, cutoff));
  }
  double operator()(double x) const { return (*spline_)(x).value; }
  double cutoff; // angstrom

private:
  std::shared_ptr<const Spline> spline_; // shared: it is copied into functions
};

Spline embedding_spline(NumberReader &file, const Grids &grids)
{
  std::vector<double> values = file.numbers("the embedding energy", grids.n_density);
  for (double &value : values)
    value *= electron_volt;
  return {grids.density_step, values};
}

/// Intervals of about `step` that end at the cut-off.
int n_intervals(double cutoff, double step)
{
  return std::max(8, int(std::ceil(cutoff / step - 1e-6)));
}

/// The functions of a potential that are left to sample, in units of the files.
struct Functions
{
  std::vector<Species> species;
  std::vector<Spline> embedding;
  std::vector<FunctionOfDistance> pair, density; // n x n, as in Potential
  std::vector<double> pair_end, density_end;     // where they end
  double step, cutoff;
};

Potential sampled(const Functions &f)
{
  const int n = n_intervals(f.cutoff, f.step);
  const auto spline = [&](const FunctionOfDistance &function, double end, double unit) {
    const auto in_metres = [&](double x) { return unit * function(x / angstrom); };
    return sample(in_metres, f.cutoff * angstrom, n, end * angstrom);
  };
  std::vector<Spline> pair, density;
  for (std::size_t k = 0; k < f.pair.size(); ++k) {
    pair.push_back(spline(f.pair[k], f.pair_end[k], electron_volt));
    density.push_back(spline(f.density[k], f.density_end[k], 1));
  }
  return {f.species, std::move(pair), std::move(density), f.embedding};
}

Potential read_setfl_file(const std::string &path, const std::vector<std::string> &names,
                          bool density_per_pair)
{
  NumberReader file(path);
  for (int line = 0; line < 3; ++line)
    file.skip_line();
  const int n = file.count("the number of species", 1);
  std::vector<std::string> known;
  for (int a = 0; a < n; ++a)
    known.emplace_back(file.word("the name of a species"));
  std::vector<int> chosen;
  for (const std::string &name : names) {
    const auto place = std::find(known.begin(), known.end(), name);
    file.require(place != known.end(), "there is no species \"" + name + "\": the file has " +
                                           list_of_names(known) + "; choose one of these");
    chosen.push_back(int(place - known.begin()));
  }
  const Grids grids = read_grids(file);
  std::vector<Species> species(n);
  std::vector<Spline> embedding(n);
  std::vector<std::vector<Column>> density(n); // of a species, at each or at all
  for (int a = 0; a < n; ++a) {
    species[a] = read_species(file);
    species[a].name = known[a];
    embedding[a] = embedding_spline(file, grids);
    for (int at = 0; at < (density_per_pair ? n : 1); ++at)
      density[a].emplace_back(file, "the density of " + known[a], grids);
  }
  std::vector<Column> pair; // r phi, lower triangle
  for (int a = 0; a < n; ++a)
    for (int b = 0; b <= a; ++b)
      pair.emplace_back(file, fmt::format("the pair energy of {} and {}", known[a], known[b]),
                        grids);
  file.expect_end();

  Functions f;
  f.step = grids.distance_step;
  f.cutoff = grids.cutoff;
  for (const int a : chosen) {
    f.species.push_back(species[a]);
    f.embedding.push_back(embedding[a]);
    for (const int b : chosen) {
      f.density.push_back(density[b][density_per_pair ? a : 0]);
      const Column &column = pair[std::max(a, b) * (std::max(a, b) + 1) / 2 + std::min(a, b)];
      f.pair.push_back([column](double x) { return column(x) / x; });
    }
  }
  f.pair_end.assign(f.pair.size(), grids.cutoff);
  f.density_end = f.pair_end;
  return sampled(f);
}
} // namespace

Potential read_funcfl(const std::vector<std::string> &paths)
{
  core::require(!paths.empty(), "no file of a potential is named");
  Functions f;
  std::vector<Column> charge, density;
  f.step = 1e300;
  f.cutoff = 0;
  for (const std::string &path : paths) {
    NumberReader file(path);
    file.skip_line();
    f.species.push_back(read_species(file));
    const Grids grids = read_grids(file);
    f.embedding.push_back(embedding_spline(file, grids));
    charge.emplace_back(file, "the effective charge", grids);
    density.emplace_back(file, "the density", grids);
    file.expect_end();
    f.step = std::min(f.step, grids.distance_step);
    f.cutoff = std::max(f.cutoff, grids.cutoff);
  }
  const int n = int(paths.size());
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      f.pair.push_back([za = charge[a], zb = charge[b]](double x) {
        return charge_squared * za(x) * zb(x) / x;
      });
      f.pair_end.push_back(std::min(charge[a].cutoff, charge[b].cutoff));
      f.density.push_back(density[b]);
      f.density_end.push_back(density[b].cutoff);
    }
  return sampled(f);
}

Potential read_setfl(const std::string &path, const std::vector<std::string> &species)
{
  return read_setfl_file(path, species, false);
}

Potential read_setfl_fs(const std::string &path, const std::vector<std::string> &species)
{
  return read_setfl_file(path, species, true);
}
} // namespace ligament::md
