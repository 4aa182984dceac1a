// The neighbour list against all pairs, while atoms wander through and out of their box.
#include "md/neighbour_list.h"

#include "core/check.h"
#include "md/cell_grid.h"
#include "tests/unit/md/potentials.h"

#include <algorithm>
#include <set>

namespace ligament::md::testing
{
using Pair = std::array<int, 5>; // atoms, the first below the second, and periods

/// Pairs within a distance by looking at all, and at all images that may be as near.
template <int dim>
std::multiset<Pair> all_pairs(const Components<dim> &x, double reach, const Vector<dim> &period)
{
  std::multiset<Pair> pairs;
  const int n = int(x[0].size());
  std::array<int, 3> most = {};
  for (int c = 0; c < dim; ++c)
    most[c] = period[c] > 0 ? int(reach / period[c]) + 2 : 0;
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
      for (int a = -most[0]; a <= most[0]; ++a)
        for (int b = -most[1]; b <= most[1]; ++b)
          for (int e = -most[2]; e <= most[2]; ++e) {
            const std::array<int, 3> k = {a, b, e};
            if (i == j && k <= std::array<int, 3>{0, 0, 0}) // each image of itself once
              continue;
            double r2 = 0;
            for (int c = 0; c < dim; ++c)
              r2 += std::pow(x[c][j] - x[c][i] + k[c] * period[c], 2);
            if (r2 < reach * reach)
              pairs.insert({i, j, a, b, e});
          }
  return pairs;
}

template <int dim>
std::multiset<Pair> listed_pairs(const NeighbourList &list, const Components<dim> &x, double reach,
                                 const Vector<dim> &period)
{
  std::multiset<Pair> pairs;
  list.for_each_pair([&](int i, int j, std::array<int, 3> k) {
    double r2 = 0;
    for (int c = 0; c < dim; ++c)
      r2 += std::pow(x[c][j] - x[c][i] + k[c] * period[c], 2);
    if (i > j || (i == j && k < std::array<int, 3>{0, 0, 0})) {
      std::swap(i, j);
      for (int &periods : k)
        periods = -periods;
    }
    if (r2 < reach * reach)
      pairs.insert({i, j, k[0], k[1], k[2]});
  });
  return pairs;
}

/// Atoms at random in a box that go random ways; at every step all pairs within the cut-off are
/// there once, and right after building all within the skin, too.
template <int dim>
void expect_all_pairs(const Vector<dim> &box, const Vector<dim> &period, int n)
{
  const double cutoff = 1, skin = 0.3, step = 0.03;
  Noise noise(9);
  Components<dim> reference, u;
  for (int c = 0; c < dim; ++c) {
    for (int i = 0; i < n; ++i)
      reference[c].push_back(box[c] * (0.5 + 0.5 * noise()));
    u[c].assign(n, 0.);
  }
  NeighbourList list(cutoff, skin, period);
  for (int k = 0; k < 30; ++k) {
    const bool is_new = list.update<dim>(reference, u);
    Components<dim> x = reference;
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < n; ++i)
        x[c][i] += u[c][i];
    const double reach = is_new ? cutoff + skin : cutoff;
    EXPECT_EQ(listed_pairs<dim>(list, x, reach, period), all_pairs<dim>(x, reach, period)) << k;
    for (auto &component : u)
      for (double &value : component)
        value += step * noise();
  }
  EXPECT_GT(list.n_builds(), 3);
  EXPECT_LT(list.n_builds(), 20);
}

TEST(NeighbourListTest, HasAllPairsWhileAtomsWander)
{
  expect_all_pairs<3>({3, 4, 2}, {0, 0, 0}, 150);
  expect_all_pairs<3>({3, 4, 2}, {3, 4, 2}, 100);
  expect_all_pairs<3>({5, 0.6, 3}, {0, 0.6, 3}, 60);  // a box that is smaller than the cut-off
  expect_all_pairs<3>({40, 40, 40}, {0, 0, 40}, 100); // thinly spread
  expect_all_pairs<2>({6, 5}, {0, 0}, 100);
  expect_all_pairs<2>({6, 5}, {6, 0}, 100);
}

// With a single atom there are its own images alone.
TEST(NeighbourListTest, OneAtomSeesItsImages)
{
  Components<3> x, u;
  for (int c = 0; c < 3; ++c) {
    x[c] = {0.3};
    u[c] = {0};
  }
  NeighbourList list(1, 0.1, Vector<3>(0.8, 5, 5));
  list.update<3>(x, u);
  EXPECT_EQ(list.n_pairs(), 1);
  NeighbourList alone(1, 0.1, Vector<3>(0, 0, 0));
  alone.update<3>(x, u);
  EXPECT_EQ(alone.n_pairs(), 0);
}

// A few that have flown away do not make the search one through all pairs, and see each other.
TEST(NeighbourListTest, AtomsFarAwayLeaveTheOthersTheirCells)
{
  const double far = 3e6;
  Components<3> x;
  Noise noise(4);
  const auto add = [&](double a, double b, double c) {
    x[0].push_back(a);
    x[1].push_back(b);
    x[2].push_back(c);
  };
  for (int i = 0; i < 3000; ++i)
    add(6 * noise(), 6 * noise(), 6 * noise());
  for (int i = 0; i < 40; ++i)
    add(far + noise(), 2 * far + noise(), -far + noise());
  for (int i = 0; i < 5; ++i)
    add(noise(), 100 + 50 * noise(), 1e12 * noise());
  NeighbourList list(1, 0.3, Vector<3>(Vector<3>::Zero()));
  Components<3> u;
  for (auto &component : u)
    component.assign(x[0].size(), 0.);
  list.build<3>(x, u);
  const auto expected = all_pairs<3>(x, 1.3, Vector<3>::Zero());
  EXPECT_GT(
      std::count_if(expected.begin(), expected.end(), [](const Pair &p) { return p[0] >= 3000; }),
      100);
  EXPECT_EQ(listed_pairs<3>(list, x, 1.3, Vector<3>::Zero()), expected);

  std::vector<AtomRecord> places(x[0].size());
  for (std::size_t i = 0; i < places.size(); ++i)
    for (int c = 0; c < 3; ++c)
      component(places[i])[c] = x[c][i];
  const CellGrid grid(places, 1.3);
  std::vector<int> n_in(grid.n_cells(), 0);
  for (const AtomRecord &place : places)
    ++n_in[grid.number(grid.cell_of(place))];
  EXPECT_LT(*std::max_element(n_in.begin(), n_in.end()), 100);
}

TEST(NeighbourListTest, PlacesThatAreNoNumbersStopTheRun)
{
  Components<2> x, u;
  for (int c = 0; c < 2; ++c) {
    x[c] = {0, 1};
    u[c] = {0, std::nan("")};
  }
  NeighbourList list(1, 0.1, Vector<2>(0, 0));
  EXPECT_THROW(list.update<2>(x, u), core::GuardStop);
  u[0][1] = u[1][1] = 0;
  list.build<2>(x, u);
  u[1][0] = std::nan("");
  EXPECT_THROW(list.update<2>(x, u), core::GuardStop);
}
} // namespace ligament::md::testing
