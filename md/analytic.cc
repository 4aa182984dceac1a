#include "md/analytic.h"

#include "core/check.h"
#include "md/sampled_spline.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::md
{
namespace
{
/// So fine that splines are as good as the functions to 1e-11 of their size.
constexpr int n_knots = 4000;

Spline cut(const FunctionOfDistance &function, const CutOff &cut)
{
  core::require(0 < cut.taper_begin && cut.taper_begin < cut.cutoff,
                "a potential's taper must begin above 0 and below its cut-off");
  return sample([&](double r) { return function(r) * taper(r, cut.taper_begin, cut.cutoff); },
                cut.cutoff, n_knots);
}
} // namespace

Potential lennard_jones(const Species &species, double depth, double size, const CutOff &cut_off)
{
  core::require(depth > 0 && size > 0, "a Lennard-Jones potential needs depth and size above 0");
  const auto energy = [&](double r) {
    const double s6 = std::pow(size / r, 6);
    return 4 * depth * s6 * (s6 - 1);
  };
  const double least = size / 2, slope = -4 * depth / least * 64 * (12 * 64. - 6);
  return {
      {species},
      {cut([&](double r) { return r > least ? energy(r) : energy(least) + slope * (r - least); },
           cut_off)},
      {},
      {}};
}

Potential lennard_jones(const Species &species, double depth, double size)
{
  return lennard_jones(species, depth, size, {2.2 * size, 2.5 * size});
}

Potential morse(const Species &species, double depth, double distance, double decay,
                const CutOff &cut_off)
{
  core::require(depth > 0 && distance > 0 && decay > 0,
                "a Morse potential needs depth, distance and decay above 0");
  const auto energy = [&](double r) {
    const double e = std::exp(-decay * (r - distance));
    return depth * e * (e - 2);
  };
  return {{species}, {cut(energy, cut_off)}, {}, {}};
}

Potential plane_crystal(const Species &species, double energy, double distance)
{
  core::require(energy > 0 && distance > 0, "a crystal needs energy and distance above 0");
  const CutOff cut_off = {1.6 * distance, 2.0 * distance};
  const double decay = 5 / distance;
  Spline density = cut([&](double r) { return std::exp(-decay * (r - distance)); }, cut_off);
  std::vector<double> embedding(n_knots + 1);
  constexpr double largest_density = 40;
  for (int k = 0; k <= n_knots; ++k)
    embedding[k] = -energy / 2 * std::sqrt(largest_density * k / n_knots / 6);
  const Potential pairs = morse(species, energy / 6, distance, decay, cut_off);
  return {{species},
          {pairs.pair_spline(0, 0)},
          {std::move(density)},
          {Spline(largest_density / n_knots, embedding)}};
}
} // namespace ligament::md
