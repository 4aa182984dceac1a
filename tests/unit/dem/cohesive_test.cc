// Faces that soften: work per area, gradient at frozen openings, balance, numbering.
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/run.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
namespace
{
template <typename D>
struct Cohesive : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Cohesive, Dimensions);

constexpr double youngs_modulus = 3e10, strength = 3e6, density = 2500;

/// Softens with E G_c/f_t^2 of so many spacings.
FractureLaw softening(double lengths, double spacing, const Softening &shape = {})
{
  FractureLaw law{FractureLaw::Criterion::opening_tension, strength};
  law.energy = lengths * spacing * strength * strength / youngs_modulus;
  law.softening = shape;
  return law;
}

/// The ends of the second axis move apart by so many m/s in all, after a smooth start.
template <int dim>
std::vector<core::BoundaryLoad<dim>> draw_apart(double speed, double start)
{
  std::vector<core::BoundaryLoad<dim>> loads(2);
  for (int end = 0; end < 2; ++end) {
    loads[end].boundary = 2 + end;
    loads[end].value[1] = (end ? 0.5 : -0.5) * speed;
    loads[end].history = core::Ramp{start};
  }
  return loads;
}

/// Two cubes or squares, one above the other, held across at their ends only.
template <int dim>
packings::Packing<dim> column()
{
  Packing<dim> p;
  const double d = p.spacing = 0.01;
  p.thickness = dim == 2 ? 0.3 : 1;
  for (int c = 0; c < dim; ++c)
    p.centre[c] = {0, c == 1 ? d : 0};
  p.volume.assign(2, std::pow(d, dim) * p.thickness);
  p.global_id = {0, 1};
  const double area = std::pow(d, dim - 1) * p.thickness;
  const Vector<dim> up = d / 2 * Vector<dim>::Unit(1);
  p.faces.push_back({0, 1, Vector<dim>::Unit(1), area, d / 2, d / 2, up, -up, -1, false});
  for (int i = 0; i < 2; ++i)
    for (int c = 0; c < dim; ++c)
      for (int end = 0; end < 2; ++end)
        if (const Vector<dim> n = (end ? 1 : -1) * Vector<dim>::Unit(c); c != 1 || end == i)
          p.boundary_faces.push_back({i, n, area, d / 2, d / 2 * n, 2 * c + end});
  return p;
}

TYPED_TEST(Cohesive, ColumnTakesItsEnergyAndNoMore)
{
  constexpr int dim = TypeParam::value;
  const auto packing = column<dim>();
  ASSERT_EQ(packing.size(), 2);
  ASSERT_EQ(packing.faces.size(), 1u);
  for (const double nu : {0., 0.2, 0.45})
    for (const double lengths : {20., 60.})
      for (const bool has_corner : {false, true}) {
        const Softening shape = has_corner ? Softening{1 / 3., 0.8} : Softening{};
        const DemMaterial material{youngs_modulus, nu, density, PlaneMode::strain, 0};
        const FractureLaw law = softening(lengths, packing.spacing, shape);
        const double reach = shape.reach() * law.energy / strength, area = packing.faces[0].area,
                     period = packing.spacing / 3000;
        const double duration = 1000 * period;
        Run<dim> run(packing, material, draw_apart<dim>(1.2 * reach / duration, 10 * period), law);
        double largest = 0;
        while (run.force->broken_bonds().empty() && run.time < 2 * duration) {
          run.step(1 / period);
          largest = std::max(largest, std::abs(run.residual()));
        }
        ASSERT_EQ(run.force->broken_bonds().size(), 1u);
        const double whole = law.energy * area;
        EXPECT_NEAR(run.force->cohesive_work() / whole, 1, 1e-3) << nu << ' ' << lengths;
        EXPECT_LT(std::abs(run.force->fracture_energy()) / whole, 1e-6) << nu << ' ' << lengths;
        EXPECT_LT(largest / whole, 1e-6);
        std::printf("%d nu %.2f lengths %.0f corner %d: work %.6f jump %.2e residual %.2e\n", dim,
                    nu, lengths, has_corner, run.force->cohesive_work() / whole,
                    run.force->fracture_energy() / whole, largest / whole);
      }
}
} // namespace
} // namespace ligament::dem::testing
