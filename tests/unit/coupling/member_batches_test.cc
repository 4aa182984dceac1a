// What the overlap's particles hand to the sums of the coupler belongs to their cells: it doesn't
// depend on which cells lie side by side in a vector.
#include "core/exact_sum.h"
#include "coupling/member_batches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace ligament::coupling
{
namespace
{
constexpr int n_cells = 37, most_members = 9;

int members_of(int cell)
{
  return 1 + cell * 5 % most_members;
}

template <int dim>
struct Members
{
  MemberBatches<dim> batches;
  std::vector<LaneArray> motion;
  std::vector<int> cells; // in the order of the lanes
};

/// Members of random mass, damping, shape functions and motion; those of a cell are the same
/// whatever the order of the cells. Within 8 the fullest come first.
template <int dim>
Members<dim> in_order(std::vector<int> cells)
{
  constexpr int nc = MemberBatches<dim>::nc;
  Members<dim> m;
  for (int first = 0; first < n_cells; first += lane_array_size) {
    const int n = std::min(lane_array_size, n_cells - first);
    const auto begin = cells.begin() + first;
    std::sort(begin, begin + n, [](int a, int b) {
      return std::pair(-members_of(a), a) < std::pair(-members_of(b), b);
    });
    typename MemberBatches<dim>::Batch batch{};
    batch.n_cells = n;
    batch.begin = int(m.batches.slots.size());
    for (int k = 0; k < members_of(*begin); ++k) {
      typename MemberBatches<dim>::Slot slot{};
      int n_members = 0;
      for (int c = 0; c < dim; ++c)
        m.motion.emplace_back();
      for (int l = 0; l < n && k < members_of(begin[l]); ++l) {
        n_members = l + 1;
        const int particle = begin[l] * most_members + k;
        std::mt19937_64 random(particle);
        std::uniform_real_distribution<double> number(0.1, 1);
        slot.particle[l] = particle;
        slot.mass.value[l] = number(random);
        slot.damping[l] = float(number(random));
        for (int a = 0; a < nc; ++a)
          slot.value[a].value[l] = number(random);
        for (int c = 0; c < dim; ++c)
          m.motion[m.motion.size() - dim + c].value[l] = std::ldexp(number(random), -k);
      }
      m.batches.slots.push_back(slot);
      m.batches.n_members.push_back(n_members);
    }
    batch.end = int(m.batches.slots.size());
    m.batches.batches.push_back(batch);
  }
  m.cells = cells;
  return m;
}

/// Of each cell.
template <int dim>
std::vector<double> losses(Members<dim> m)
{
  std::vector<double> force(n_cells * most_members);
  for (std::size_t i = 0; i < force.size(); ++i)
    force[i] = std::sin(double(i));
  std::array<const double *, dim> forces;
  forces.fill(force.data());
  std::vector<LaneArray> loss(m.batches.batches.size());
  std::vector<LaneArray> sums(m.batches.batches.size() * n_member_sums * dim *
                              MemberBatches<dim>::nc);
  kick_members<dim>(m.batches, {forces, 0.5, m.motion.data(), sums.data(), loss.data()});
  std::vector<double> of_cell(n_cells);
  for (int k = 0; k < n_cells; ++k)
    of_cell[m.cells[k]] = loss[k / lane_array_size].value[k % lane_array_size];
  return of_cell;
}

template <int dim>
void check_order_of_cells()
{
  std::vector<int> cells(n_cells);
  std::iota(cells.begin(), cells.end(), 0);
  const auto ascending = losses(in_order<dim>(cells));
  EXPECT_GT(*std::min_element(ascending.begin(), ascending.end()), 0);
  std::mt19937_64 random(3);
  for (int turn = 0; turn < 5; ++turn) {
    std::shuffle(cells.begin(), cells.end(), random);
    EXPECT_EQ(losses(in_order<dim>(cells)), ascending);
  }
}

TEST(MemberBatches, LossOfACellIsItsOwn)
{
  check_order_of_cells<2>();
  check_order_of_cells<3>();
}

// The definition, member by member.
TEST(MemberBatches, LossIsThatOfTheDamper)
{
  std::vector<int> cells(n_cells);
  std::iota(cells.begin(), cells.end(), 0);
  const auto m = in_order<2>(cells);
  const auto loss = losses(m);
  for (int k = 0; k < n_cells; ++k) {
    const auto &batch = m.batches.batches[k / lane_array_size];
    const int l = k % lane_array_size, cell = m.cells[k];
    double sum = 0;
    for (int s = batch.begin; s < batch.begin + members_of(cell); ++s)
      for (int c = 0; c < 2; ++c) {
        const auto &slot = m.batches.slots[s];
        const double mass = slot.mass.value[l], g = slot.damping[l],
                     w = m.motion[2 * s + c].value[l];
        const double kicked =
            (1 - g) * w + (1 - g / 2) * 0.5 * std::sin(double(slot.particle[l])) / mass;
        sum += g / (2 - g) * mass * (w + kicked) * (w + kicked);
      }
    EXPECT_NEAR(loss[cell], sum, 1e-13 * sum) << cell; // 18 terms, a dozen roundings each
  }
}
} // namespace
} // namespace ligament::coupling
