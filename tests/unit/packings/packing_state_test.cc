// A random packing as tables is the same packing again, bit by bit.
#include "packings/packing_state.h"

#include <gtest/gtest.h>

namespace ligament::packings
{
namespace
{
template <typename Rows, typename Get>
void expect_same(const Rows &a, const Rows &b, const Get &get)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    ASSERT_EQ(get(a[k]), get(b[k])) << k;
}

template <int dim>
void expect_the_same_packing()
{
  RandomParameters<dim> p;
  p.spacing = 0.01;
  p.thickness = 0.3;
  p.size_ratio = 3;
  p.relaxation_sweeps = 2;
  p.lower = Vector<dim>::Zero();
  p.upper = Vector<dim>::Constant(0.1);
  p.zone_upper[0] = 0.07; // a coupled side: seeds beyond it are kept
  if constexpr (dim == 2)
    p.cracks = {{{0.02, 0.05}, {0.06, 0.05}}};
  else
    p.cracks = {{{0.02, 0.05, 0}, {0.06, 0.05, 0}, {0.06, 0.05, 0.1}, {0.02, 0.05, 0.1}}};
  RandomPacking<dim> made = make_random_packing(p);
  made.packing.material.assign(made.packing.size(), 0);
  made.packing.material[3] = 1;
  core::State state;
  save_packing(state, made);
  const RandomPacking<dim> read = load_packing<dim>(state, p);
  const Packing<dim> &a = made.packing, &b = read.packing;

  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.thickness, b.thickness);
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.diameter, b.diameter);
  EXPECT_EQ(a.global_id, b.global_id);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.cuts.size(), b.cuts.size());
  int n_cracked = 0;
  using F = Face<dim>;
  for (const F &f : a.faces)
    n_cracked += f.cracked;
  EXPECT_GT(n_cracked, 0);
  expect_same(a.faces, b.faces, [](const F &f) {
    return std::tuple(f.i, f.j, f.area, f.q_i, f.q_j, f.direction, f.cracked, f.cut);
  });
  expect_same(a.faces, b.faces, [](const F &f) { return f.normal; });
  expect_same(a.faces, b.faces, [](const F &f) { return f.lever_i; });
  expect_same(a.faces, b.faces, [](const F &f) { return f.lever_j; });
  using B = BoundaryFace<dim>;
  expect_same(a.boundary_faces, b.boundary_faces,
              [](const B &f) { return std::tuple(f.i, f.area, f.q, f.boundary); });
  expect_same(a.boundary_faces, b.boundary_faces, [](const B &f) { return f.normal; });
  expect_same(a.boundary_faces, b.boundary_faces, [](const B &f) { return f.lever; });
  EXPECT_EQ(made.seeds.centre, read.seeds.centre);
  EXPECT_EQ(made.seeds.radius, read.seeds.radius);
  EXPECT_EQ(made.seeds.id, read.seeds.id);
}

TEST(PackingState, IsTheSamePackingAgain)
{
  expect_the_same_packing<2>();
  expect_the_same_packing<3>();
}
} // namespace
} // namespace ligament::packings
