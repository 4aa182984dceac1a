// Lattices that ranks pack by part are those that one process packs and cuts.
#include "packings/lattice_packing.h"
#include "tests/support/ranks.h"

#include "core/check.h"

#include <gtest/gtest.h>

namespace ligament::packings::testing
{
namespace
{
using test::ranks;

template <int dim>
void expect_same_faces(const Packing<dim> &a, const Packing<dim> &b)
{
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t k = 0; k < a.faces.size(); ++k) {
    const Face<dim> &f = a.faces[k], &g = b.faces[k];
    EXPECT_TRUE(f.i == g.i && f.j == g.j && f.direction == g.direction && f.cracked == g.cracked &&
                f.cut == g.cut && f.area == g.area && f.q_i == g.q_i && f.normal == g.normal &&
                f.lever_i == g.lever_i && f.lever_j == g.lever_j)
        << k;
  }
  ASSERT_EQ(a.boundary_faces.size(), b.boundary_faces.size());
  for (std::size_t k = 0; k < a.boundary_faces.size(); ++k) {
    const BoundaryFace<dim> &f = a.boundary_faces[k], &g = b.boundary_faces[k];
    EXPECT_TRUE(f.i == g.i && f.boundary == g.boundary && f.area == g.area && f.lever == g.lever &&
                f.corners == g.corners)
        << k;
  }
}

template <int dim>
void expect_same_ranges(const particles::ParticleRanges &a, const particles::ParticleRanges &b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    EXPECT_TRUE(a[k].begin == b[k].begin && a[k].end == b[k].end);
}

template <int dim>
void expect_the_part(const LatticeParameters<dim> &lattice)
{
  const Packing<dim> whole = make_lattice_packing(lattice);
  for (const int rings : {2, 3}) {
    const auto partition = particles::make_partition(whole.size(), ranks().size());
    const PackingPart<dim> expected = part_of(whole, partition, ranks().rank(), rings),
                           found = make_lattice_part(lattice, ranks(), rings);
    EXPECT_EQ(found.n_whole, whole.size());
    EXPECT_EQ(found.place, expected.place);
    EXPECT_EQ(found.owner, expected.owner);
    expect_same_ranges<dim>(found.part.owned, expected.part.owned);
    expect_same_ranges<dim>(found.part.stepped, expected.part.stepped);
    expect_same_ranges<dim>(found.part.pressed, expected.part.pressed);
    expect_same_ranges<dim>(found.part.turned, expected.part.turned);
    const Packing<dim> &a = found.packing, &b = expected.packing;
    EXPECT_EQ(a.centre, b.centre);
    EXPECT_EQ(a.volume, b.volume);
    EXPECT_EQ(a.global_id, b.global_id);
    EXPECT_EQ(a.row_begin, b.row_begin);
    EXPECT_EQ(a.directions.size(), b.directions.size());
    EXPECT_EQ(a.cuts.size(), b.cuts.size());
    EXPECT_EQ(mean_face_area(a), mean_face_area(b));
    EXPECT_EQ(largest_diameter(a), largest_diameter(b));
    expect_same_faces(a, b);
  }
}

TEST(LatticePart, IsThatOfTheWholeInThePlane)
{
  for (const LatticeKind kind : {LatticeKind::hexagonal, LatticeKind::square})
    for (const double angle : {0., 0.4}) {
      LatticeParameters<2> lattice;
      lattice.kind = kind;
      lattice.spacing = 1;
      lattice.upper = {30.2, 170.7};
      lattice.orientation[0] = angle;
      lattice.cracks = {{{5, 60}, {22, 90}}};
      lattice.holes = {{{15, 130}, 6}};
      expect_the_part(lattice);
    }
}

TEST(LatticePart, IsThatOfTheWholeInSpace)
{
  for (const LatticeKind kind : {LatticeKind::fcc, LatticeKind::simple_cubic})
    for (const double angle : {0., 0.4}) {
      LatticeParameters<3> lattice;
      lattice.kind = kind;
      lattice.spacing = 1;
      lattice.upper = {7.3, 8.1, 70.4};
      lattice.orientation = {angle, -angle / 2, angle};
      expect_the_part(lattice);
    }
}

// The rows lie another way than the lattice has them.
TEST(LatticePart, IsThatOfTheWholeWhereLayersAreTurned)
{
  LatticeParameters<2> lattice;
  lattice.spacing = 1;
  lattice.upper = {200.2, 20.7};
  lattice.small_layer = 0;
  expect_the_part(lattice);
}

TEST(LatticePart, RefusesJoinedSides)
{
  LatticeParameters<2> lattice;
  lattice.spacing = 1;
  lattice.upper = {20, 40};
  lattice.periodic[0] = true;
  EXPECT_THROW(make_lattice_part(lattice, ranks(), 2), core::InputError);
}
} // namespace
} // namespace ligament::packings::testing
