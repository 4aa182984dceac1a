#include "src/verification/instruments/covering_set.h"

#include <array>
#include <set>

namespace ligament::program
{
namespace
{
using Pair = std::array<int, 4>; // factor, level, later factor, level

Pair make_pair(int f, int a, int g, int b)
{
  return f < g ? Pair{f, a, g, b} : Pair{g, b, f, a};
}

std::set<Pair> all_pairs(const std::vector<int> &levels)
{
  std::set<Pair> pairs;
  for (int f = 0; f < int(levels.size()); ++f)
    for (int g = f + 1; g < int(levels.size()); ++g)
      for (int a = 0; a < levels[f]; ++a)
        for (int b = 0; b < levels[g]; ++b)
          pairs.insert({f, a, g, b});
  return pairs;
}

/// The level of factor f that meets most of the pairs still missing; -1 in a row: not chosen yet.
int best_level(int f, int n_levels, const std::vector<int> &row, const std::set<Pair> &missing,
               int shift)
{
  int best = 0, most = -1;
  for (int k = 0; k < n_levels; ++k) {
    const int level = (k + shift) % n_levels; // ties go round
    int count = 0;
    for (int g = 0; g < int(row.size()); ++g)
      if (g != f && row[g] >= 0)
        count += int(missing.count(make_pair(f, level, g, row[g])));
    if (count > most) {
      most = count;
      best = level;
    }
  }
  return best;
}

/// A row that holds the pair, its other levels those of `model`, or chosen for the missing pairs.
std::vector<int> make_row(const Pair &pair, const std::vector<int> &levels,
                          const std::set<Pair> &missing, int shift, const std::vector<int> *model)
{
  const int n = int(levels.size());
  std::vector<int> row(n, -1);
  if (model)
    row = *model;
  row[pair[0]] = pair[1];
  row[pair[2]] = pair[3];
  for (int f = 0; f < n; ++f)
    if (row[f] < 0)
      row[f] = best_level(f, levels[f], row, missing, shift);
  return row;
}
} // namespace

CoveringSet covering_set(const std::vector<int> &levels,
                         const std::function<bool(const std::vector<int> &)> &accepts, int n_tries)
{
  std::set<Pair> missing = all_pairs(levels);
  CoveringSet set;
  const int n = int(levels.size());
  for (int n_rows = 0; !missing.empty();) {
    const Pair pair = *missing.begin();
    for (int k = 0; k < n_tries && missing.count(pair) > 0; ++k) {
      const int n_accepted = int(set.rows.size());
      const auto *model = k > 0 && k <= n_accepted ? &set.rows[n_accepted - k] : nullptr;
      const auto row = make_row(pair, levels, missing, n_rows++, model);
      if (!accepts(row))
        continue;
      set.rows.push_back(row);
      for (int f = 0; f < n; ++f)
        for (int g = f + 1; g < n; ++g)
          missing.erase({f, row[f], g, row[g]});
    }
    if (missing.erase(pair) > 0)
      set.given_up.push_back(pair);
  }
  return set;
}
} // namespace ligament::program
