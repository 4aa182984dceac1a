// What cells sum comes to the nodes with the bits of one process, whichever ranks have summed.
#include "coupling/nodal_sums.h"
#include "tests/support/ranks.h"

#include <gtest/gtest.h>

#include <random>

namespace ligament::coupling
{
namespace
{
using test::ranks;

constexpr int n_nodes = 60, n_cells = 80, n_quantities = 3;

/// Cells between random nodes, handed on by random ranks; those of one rank lie in its lanes in a
/// random order.
template <int dim>
struct Cells
{
  using Cell = typename NodalSums<dim>::Cell;

  explicit Cells(int n_ranks, unsigned seed)
  {
    std::mt19937 random(seed);
    std::vector<int> n_of_rank(n_ranks, 0), order(n_cells);
    for (int c = 0; c < n_cells; ++c) {
      Cell cell;
      for (int &node : cell.nodes)
        node = int(random() % n_nodes);
      cell.rank = int(random() % n_ranks);
      cells.push_back(cell);
      order[c] = c;
    }
    std::shuffle(order.begin(), order.end(), random);
    for (const int c : order) {
      const int k = n_of_rank[cells[c].rank]++;
      cells[c].batch = k / lane_array_size;
      cells[c].lane = k % lane_array_size;
    }
  }
  std::vector<Cell> cells;
};

/// Of a cell: of many sizes, so that sums in another order are other numbers.
double term(int cell, int quantity, int component, int corner)
{
  std::mt19937_64 random(((cell * 7 + quantity) * 5 + component) * 11 + corner);
  return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random), int(random() % 40));
}

template <int dim>
std::vector<Nodal<dim>> sums_of(const Cells<dim> &cells, const core::Ranks &of, int first)
{
  const NodalSums<dim> nodal(cells.cells, n_nodes, n_quantities, of);
  std::vector<LaneArray> sums(nodal.n_sums(n_cells));
  for (int c = 0; c < n_cells; ++c) {
    const auto &cell = cells.cells[c];
    if (cell.rank != of.rank())
      continue;
    for (int q = 0; q < n_quantities; ++q)
      for (int i = 0; i < dim; ++i)
        for (int a = 0; a < NodalSums<dim>::nc; ++a)
          sums[nodal.index(cell.batch, q, i, a)].value[cell.lane] = term(c, q, i, a);
  }
  std::vector<Nodal<dim>> found(n_quantities - first, Nodal<dim>::Constant(n_nodes, dim, 0.5));
  std::vector<Nodal<dim> *> to;
  for (auto &field : found)
    to.push_back(&field);
  nodal.add(sums, first, to);
  return found;
}

template <int dim>
void expect_the_bits_of_one()
{
  for (const unsigned seed : {1u, 2u, 3u})
    for (const int first : {0, 1}) {
      Cells<dim> shared(ranks().size(), seed), one(ranks().size(), seed);
      for (int c = 0; c < n_cells; ++c)
        one.cells[c].rank = 0, one.cells[c].batch = c / lane_array_size,
        one.cells[c].lane = c % lane_array_size;
      const auto found = sums_of(shared, ranks(), first), expected = sums_of(one, {}, first);
      for (std::size_t q = 0; q < found.size(); ++q)
        EXPECT_EQ(found[q], expected[q]) << "seed " << seed << ", quantity " << first + q;
      // The definition: cell by cell, in their order, and then to what is there.
      for (int node = 0; node < n_nodes; ++node)
        for (int i = 0; i < dim; ++i) {
          double sum = 0;
          for (int c = 0; c < n_cells; ++c)
            for (int a = 0; a < NodalSums<dim>::nc; ++a)
              if (shared.cells[c].nodes[a] == node)
                sum += term(c, first, i, a);
          EXPECT_EQ(found[0](node, i), 0.5 + sum) << node;
        }
    }
}

TEST(NodalSums, HaveTheBitsOfOneProcess)
{
  expect_the_bits_of_one<2>();
  expect_the_bits_of_one<3>();
}
} // namespace
} // namespace ligament::coupling
