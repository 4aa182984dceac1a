#include "md/pair_table.h"

namespace ligament::md
{
std::vector<PairPiece> make_pair_table(const Potential &potential, int a, int b)
{
  const Spline &pair = potential.pair_spline(a, b);
  const std::size_t n = pair.pieces().size();
  std::vector<PairPiece> table(n + 1, PairPiece{});
  for (std::size_t k = 0; k < n; ++k) {
    const auto &phi = pair.pieces()[k];
    for (int c = 1; c < 4; ++c)
      table[k].pull[c - 1] = -c * phi[c] / pair.step();
    table[k].pull[3] = phi[0];
    for (int c = 0; c < 4 && potential.has_embedding(); ++c)
      table[k].density[c] = potential.density_spline(a, b).pieces()[k][c];
  }
  return table;
}
} // namespace ligament::md
