// Faces that are next to nothing: they break like others, and nothing comes of it.
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/run.h"

#include <cmath>

namespace ligament::dem::testing
{
template <typename D>
struct Slivers : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Slivers, Dimensions);

// A small face at the edge of two particles lets them turn about it until their centres are nearer
// than they were. Where it breaks by tension, what touches from then on does not press yet.
TYPED_TEST(Slivers, OneThatWasAHingeLeavesNoForceAsItTears)
{
  constexpr int dim = TypeParam::value;
  const double d = 0.01, aside = 0.45 * d, angle = -0.5, opening = 0.02 * d;
  Packing<dim> packing;
  packing.spacing = d;
  packing.thickness = dim == 2 ? 0.3 : 1;
  packing.centre[0] = {0, d};
  for (int c = 1; c < dim; ++c)
    packing.centre[c] = {0, 0};
  packing.volume.assign(2, std::pow(d, dim) * packing.thickness);
  packing.global_id = {0, 1};
  const Vector<dim> n = Vector<dim>::Unit(0), to_side = aside * Vector<dim>::Unit(1);
  packing.faces.push_back({0, 1, n, 0.05 * std::pow(d, dim - 1) * packing.thickness, d / 2, d / 2,
                           d / 2 * n + to_side, -d / 2 * n + to_side, -1, false});
  const auto &face = packing.faces[0];
  DemMaterial material{7e10, 0.3, 2500, PlaneMode::strain, 0};
  Particles<dim> p;
  packings::fill_particles(packing, material.density, p);
  ManyBodyForce<dim> force(packing, material, {}, {FractureLaw::Criterion::maximum_tension, 1e6});
  force.compute(p, 0);
  ASSERT_EQ(force.n_broken(), 0);
  if constexpr (dim == 2)
    p.rotation[0][1] = angle;
  else {
    p.rotation[0][1] = std::cos(angle / 2);
    p.rotation[3][1] = std::sin(angle / 2);
  }
  Vector<dim> turned = face.lever_j;
  turned[0] = std::cos(angle) * face.lever_j[0] - std::sin(angle) * face.lever_j[1];
  turned[1] = std::sin(angle) * face.lever_j[0] + std::cos(angle) * face.lever_j[1];
  const Vector<dim> now = face.lever_i + opening * Vector<dim>::Unit(0) - turned;
  ASSERT_LT(now.norm(), 0.8 * d);
  set(p.displacement, 1, Vector<dim>(now - d * Vector<dim>::Unit(0)));
  force.compute(p, 1e-9);
  ASSERT_EQ(force.n_broken(), 1);
  ASSERT_EQ(force.n_contacts(), 1);
  const double stiffness = 2 * material.shear_modulus() * face.area / d;
  force.compute(p, 2e-9); // that of the step of the break is the mean of before and after
  for (int i = 0; i < 2; ++i)
    EXPECT_LT(get(p.force, i).norm(), 1e-9 * stiffness * d);
  EXPECT_GT(force.fracture_energy(), 0.5 * stiffness * opening * opening / 2);
  // And presses as soon as they come nearer still.
  set(p.displacement, 1, Vector<dim>(0.99 * now - d * Vector<dim>::Unit(0)));
  force.compute(p, 3e-9);
  EXPECT_NEAR(get(p.force, 1).norm(), stiffness * d / now.norm() * 0.01 * now.norm(),
              1e-9 * stiffness * d);
}
} // namespace ligament::dem::testing
