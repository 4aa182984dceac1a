// Contacts that the search finds: their distance and face follow the sizes of the particles.
#include "core/extremes.h"
#include "dem/contact_search.h"

#include "tests/unit/dem/body.h"
#include "tests/unit/dem/run.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
template <int dim>
struct TwoParticles
{
  Packing<dim> packing;
  DemMaterial material;
  Particles<dim> state;
  Contacts<dim> contacts{material};

  /// Of diameters 1 and 5, d = 2, on a surface, with these distances along the last axis in the
  /// reference and now; no bond between them.
  TwoParticles(double reference, double now)
  {
    packing.spacing = 2;
    packing.diameter = {1, 5};
    packing.volume = {1, 1};
    packing.global_id = {0, 1};
    for (auto &x : packing.centre)
      x.assign(2, 0.);
    packing.centre[dim - 1][1] = reference;
    const Vector<dim> n = Vector<dim>::Unit(dim - 1);
    packing.boundary_faces = {{0, n, 1, 0.5, 0.5 * n, 0}, {1, -n, 1, 2.5, -2.5 * n, 0}};
    state = at_rest(packing, material);
    state.displacement[dim - 1][1] = now - reference;
    const BondNetwork<dim> bonds(packing, material);
    ContactSearch<dim> search(packing, 5.);
    search.update(state, bonds, contacts);
  }
};

template <int dim>
void check_sizes()
{
  const TwoParticles<dim> met(7, 3.2);
  ASSERT_EQ(met.contacts.all().size(), 1u);
  const auto &face = met.contacts.all()[0].face;
  // Half the sum of the diameters, which the contact point divides as the sizes do; the face is in
  // proportion to the mean size to the power of dim - 1, and 5 for d = 2.
  EXPECT_DOUBLE_EQ(face.distance, 3);
  EXPECT_DOUBLE_EQ(face.area, 5 * std::pow(1.5, dim - 1));
  EXPECT_DOUBLE_EQ(face.lever_i.norm(), 0.5);
  EXPECT_DOUBLE_EQ(face.lever_j.norm(), 2.5);

  // Found late they touch at the distance that they have: no energy comes from nowhere.
  EXPECT_DOUBLE_EQ(TwoParticles<dim>(7, 2.9).contacts.all()[0].face.distance, 2.9);

  // Those nearer than that in the reference touch at that distance: no force appears at rest.
  const TwoParticles<dim> near(1.6, 1.6);
  ASSERT_EQ(near.contacts.all().size(), 1u);
  EXPECT_DOUBLE_EQ(near.contacts.all()[0].face.distance, 1.6);
  EXPECT_DOUBLE_EQ(near.contacts.all()[0].face.lever_i.norm(), 1.6 / 6);

  // The reach is that distance and two skins of d/4: 4.
  EXPECT_EQ(TwoParticles<dim>(7, 3.999).contacts.all().size(), 1u);
  EXPECT_EQ(TwoParticles<dim>(7, 4.001).contacts.all().size(), 0u);
}

TEST(ContactSearch, DistancesFollowTheSizes)
{
  check_sizes<2>();
  check_sizes<3>();
}
/// Two blocks a spacing apart, one thrown at the other: nothing can break.
template <int dim>
void check_blocks_meet(packings::LatticeKind kind)
{
  constexpr double d = 0.1, speed = 0.01;
  packings::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.spacing = d;
  lattice.upper = Vector<dim>::Constant(0.6);
  lattice.upper[1] = 1.6;
  packings::BoxNotch<dim> gap;
  gap.lower = Vector<dim>::Constant(-1);
  gap.upper = Vector<dim>::Constant(2);
  gap.lower[1] = 0.75;
  gap.upper[1] = 0.9;
  lattice.notches = {gap};
  DemMaterial material;
  Run<dim> run(packings::make_lattice_packing(lattice), material, {});
  auto &p = run.solver->state;
  double mass = 0, other = 0;
  for (int i = 0; i < p.size(); ++i) {
    const bool is_upper = p.reference[1][i] > 0.82;
    p.velocity[1][i] = is_upper ? -speed : 0;
    (is_upper ? mass : other) += p.mass[i];
  }
  const double before = run.mechanical();
  while (run.time < (0.15 + d) / speed) // by then all centres of one would have met the other's
    run.step();
  double momentum = 0, lowest = 1e300, highest = -1e300;
  for (int i = 0; i < p.size(); ++i) {
    const double y = p.reference[1][i] + p.displacement[1][i];
    if (p.reference[1][i] > 0.82) {
      momentum += p.mass[i] * p.velocity[1][i];
      keep_smallest(lowest, y);
    } else
      keep_largest(highest, y);
  }
  // Else the one would have all of its momentum still.
  EXPECT_GT(momentum, -0.6 * mass * speed);
  EXPECT_GT(lowest, highest + 0.5 * d);
  EXPECT_NEAR(run.residual() / before, 1, 1e-3);
}

TEST(ContactSearch, BlocksMeetThoughNothingBreaks)
{
  check_blocks_meet<2>(packings::LatticeKind::hexagonal);
  check_blocks_meet<2>(packings::LatticeKind::square);
  check_blocks_meet<3>(packings::LatticeKind::simple_cubic);
}

} // namespace ligament::dem::testing
