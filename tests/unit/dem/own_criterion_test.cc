// A criterion of one's own is one struct: its faces break at the load that its formula gives, and
// the screens of all kernels keep to the bounds that it states.
#include "packings/random_packing.h"
#include "tests/support/whole_traction.h"
#include "tests/unit/dem/cases.h"

#include <numeric>

namespace ligament::dem::testing
{
namespace
{
constexpr FractureLaw::Criterion whole_traction = criterion<tests::WholeTraction>();

/// A square or cubic body in the homogeneous stress s_xx, s_xy, s_yy at nu = 0, where every face
/// bears S n exactly, up to rotations of second order in `small`.
template <int dim>
struct ShearedBody
{
  static constexpr double small = 1e-9, s_xx = 0.2, s_xy = 1, s_yy = -2;
  const DemMaterial material{1., 0., 1, PlaneMode::strain, 0};
  Packing<dim> packing;
  Particles<dim> p;
  std::size_t faces_along_x = 0;

  explicit ShearedBody(Kind kind)
  {
    packings::LatticeParameters<dim> lattice;
    lattice.kind = kind;
    lattice.spacing = 1;
    lattice.upper.setConstant(dim == 2 ? 24 : 11);
    packing = packings::make_lattice_packing<dim>(lattice);
    packings::fill_particles(packing, 1., p);
    for (int i = 0; i < p.size(); ++i) {
      const double x = packing.centre[0][i], y = packing.centre[1][i];
      Vector<dim> u = Vector<dim>::Zero();
      u[0] = small * (s_xx * x + s_xy * y);
      u[1] = small * (s_xy * x + s_yy * y);
      set(p.displacement, i, u);
    }
    for (const auto &face : packing.faces)
      faces_along_x += std::abs(face.normal[0]) > 0.5;
  }
};

/// Those across x bear sqrt(s_xx^2 + s_xy^2), more than the largest principal stress; those across
/// y are under pressure.
template <int dim>
void expect_breaks_at_its_load(Kind kind)
{
  using Body = ShearedBody<dim>;
  const double load = Body::small * std::hypot(Body::s_xx, Body::s_xy);
  for (const auto &[share, breaks] : {std::pair(1 + 1e-6, false), std::pair(1 - 1e-6, true)}) {
    Body body(kind);
    const double strength = share * load;
    ManyBodyForce<dim> force(body.packing, body.material, {}, {whole_traction, strength});
    std::vector<int> all(body.packing.size());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_NEAR(force.weakest_bond(body.p, all).utilisation, 1 / share, 1e-7);
    force.compute(body.p, 0);
    EXPECT_EQ(force.broken_bonds().size(), breaks ? body.faces_along_x : 0);
    if (!breaks) {
      const std::vector<Watch> watch(all.size(), Watch::watched);
      EXPECT_EQ(force.utilisation(body.p, watch).share, 0); // below the noted share, which is 1
      force.set_noted_share(0.9);
      force.compute(body.p, 1);
      EXPECT_NEAR(force.utilisation(body.p, watch).share, 1 / share, 1e-7);
    }
  }
}

/// In a rough state the faces above the strength break, those below stay.
template <int dim>
void expect_all_found(const Packing<dim> &packing)
{
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Constant(0.4), 5);
  const ManyBodyForce<dim> intact(packing, material, {}, {whole_traction, 1});
  std::vector<double> tension;
  for (int i = 0; i < packing.size(); ++i)
    tension.push_back(intact.weakest_bond(p, {i}).utilisation);
  auto sorted = tension;
  std::sort(sorted.begin(), sorted.end());
  for (const double quantile : {0.3, 0.8, 1.}) {
    const double strength = (1 - 1e-10) * sorted[std::size_t(quantile * (sorted.size() - 1))];
    ASSERT_GT(strength, 0);
    ManyBodyForce<dim> force(packing, material, {}, {whole_traction, strength});
    auto moved = p;
    force.compute(moved, 0);
    std::vector<char> broken(packing.size(), 0);
    for (const auto &bond : force.broken_bonds())
      broken[bond.i] = broken[bond.j] = 1;
    for (int i = 0; i < packing.size(); ++i)
      ASSERT_EQ(bool(broken[i]), tension[i] >= strength) << i;
  }
}
} // namespace

TEST(OwnCriterion, BreaksAtTheLoadOfItsFormula)
{
  expect_breaks_at_its_load<2>(Kind::square);
  expect_breaks_at_its_load<3>(Kind::simple_cubic);
}

TEST(OwnCriterion, NoFaceAboveTheStrengthIsMissed)
{
  expect_all_found<2>(packings::make_lattice_packing<2>([] {
    packings::LatticeParameters<2> lattice;
    lattice.kind = Kind::hexagonal;
    lattice.spacing = 1;
    lattice.upper.setConstant(20);
    return lattice;
  }()));
  packings::RandomParameters<2> plane;
  plane.spacing = 1;
  plane.upper.setConstant(12);
  expect_all_found<2>(packings::make_random_packing<2>(plane).packing);
  packings::RandomParameters<3> space;
  space.spacing = 1;
  space.upper.setConstant(5);
  expect_all_found<3>(packings::make_random_packing<3>(space).packing);
}
} // namespace ligament::dem::testing
