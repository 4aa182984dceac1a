// Bodies of several materials: layers against the exact laminate, the stable step, breaking.
#include "packings/random_packing.h"
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/softening_bodies.h"

namespace ligament::dem::testing
{
namespace
{
constexpr double spacing = 0.5;

/// A block of square or simple cubic cells.
template <int dim>
Packing<dim> block(int n)
{
  packings::LatticeParameters<dim> p;
  p.kind = dim == 2 ? Kind::square : Kind::simple_cubic;
  p.spacing = spacing;
  p.upper.setConstant(spacing * n / 2);
  p.lower = -p.upper;
  return packings::make_lattice_packing<dim>(p);
}

/// Strain of the layer across, at the lateral strain e: sigma_y is the same everywhere.
struct Layer
{
  double lambda, g; // of the plane mode
  double across(double stress, double lateral_sum) const
  {
    return (stress - lambda * lateral_sum) / (lambda + 2 * g);
  }
};

template <int dim>
Layer layer_of(const DemMaterial &m)
{
  const auto c = m.elastic_constants<dim>().stiffness;
  return {c(0, 1), (c(0, 0) - c(0, 1)) / 2};
}
} // namespace

template <typename D>
struct Laminate : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Laminate, Dimensions);

// Layers one and two particles thick, strained along and across at once, all sides held: every
// particle has the strain of its layer, the forces vanish, the supports carry the exact moduli.
TYPED_TEST(Laminate, IsExactAlongAndAcross)
{
  constexpr int dim = TypeParam::value, n = 6;
  auto packing = block<dim>(n);
  const double e = 1e-9, lateral = 0.4 * e, stress = 1.7 * e; // second order: 1e-18
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress})
    for (const auto &[nu_a, nu_b] : {std::pair(0.3, 0.1), std::pair(0., 0.45), std::pair(0.2, 0.2)})
      for (const double contrast : {5., 1000.}) {
        const std::vector<DemMaterial> all = {{1, nu_a, 1, plane, 0},
                                              {contrast, nu_b, 1, plane, 0}};
        const auto row = [&](int i) {
          return int(std::floor(packing.centre[1][i] / spacing + 0.5 * n));
        };
        const auto number = [](int k) { return k == 1 || k == 3 || k == 4 ? 1 : 0; };
        std::vector<double> bottom = {0}, strain; // of every row: displacement below it
        for (int k = 0; k < n; ++k) {
          strain.push_back(layer_of<dim>(all[number(k)]).across(stress, (dim - 1) * lateral));
          bottom.push_back(bottom.back() + strain.back() * spacing);
        }
        std::vector<core::BoundaryLoad<dim>> loads(2 * dim);
        for (int b = 0; b < 2 * dim; ++b) {
          loads[b].boundary = b;
          loads[b].kind = core::BoundaryLoad<dim>::Kind::displacement;
          loads[b].value[b / 2] = b == 2   ? 0
                                  : b == 3 ? bottom.back()
                                           : (b % 2 ? 1 : -1) * lateral * spacing * n / 2;
        }
        packing.material.clear();
        for (int i = 0; i < packing.size(); ++i)
          packing.material.push_back(number(row(i)));
        ManyBodyForce<dim> force(packing, Materials(all, packing.material), loads);
        auto p = at_rest(packing, all[0]);
        for (int i = 0; i < p.size(); ++i)
          for (int c = 0; c < dim; ++c)
            p.displacement[c][i] = c == 1 ? bottom[row(i)] + strain[row(i)] * spacing / 2
                                          : lateral * packing.centre[c][i];
        force.compute(p, 1);
        double largest = 0, along = 0;
        for (int i = 0; i < p.size(); ++i)
          largest = std::max({largest, get(p.force, i).norm(), get(p.torque, i).norm() / spacing});
        const double face = std::pow(spacing, dim - 1);
        EXPECT_LT(largest, 1e-13 * contrast * e * face);
        for (int k = 0; k < n; ++k) {
          const Layer l = layer_of<dim>(all[number(k)]);
          along += 2 * l.g * lateral + l.lambda * ((dim - 1) * lateral + strain[k]);
        }
        const double side = std::pow(n, dim - 1) * face;
        EXPECT_NEAR(force.reaction(3)[1] / side / stress, 1, 1e-12);
        EXPECT_NEAR(force.reaction(1)[0] / side / (along / n), 1, 1e-12);
      }
}

// The stiff grains rule the step: it is never below that of a body which is stiff everywhere, whose
// energy is larger in every motion, and a grain of several spacings comes near to it.
TYPED_TEST(Laminate, StableStepIsThatOfTheStiffGrains)
{
  constexpr int dim = TypeParam::value, n = dim == 2 ? 12 : 7;
  auto packing = block<dim>(n);
  const DemMaterial soft{1, 0.3, 1}, stiff{1000, 0.3, 1};
  for (int i = 0; i < packing.size(); ++i)
    packing.material.push_back(get(packing.centre, i).norm() < 2.1 * spacing);
  const auto p = at_rest(packing, soft);
  const double all_stiff = ManyBodyForce<dim>(packing, stiff, {}).stable_step(p),
               mixed = ManyBodyForce<dim>(packing, Materials({soft, stiff}, packing.material), {})
                           .stable_step(p);
  EXPECT_GT(mixed, 0.999 * all_stiff);
  EXPECT_LT(mixed, 1.25 * all_stiff);
}

// At fixed positions the energy that a bond gives up is what the body has less afterwards; the bond
// between two materials breaks at the smaller strength, and so do those beside it.
TYPED_TEST(Laminate, BreakingBooksTheEnergyOfTheInterface)
{
  constexpr int dim = TypeParam::value;
  auto packing = block<dim>(4);
  for (int i = 0; i < packing.size(); ++i)
    packing.material.push_back(packing.centre[1][i] > 0);
  const DemMaterial a{1, 0.3, 1}, b{5, 0.2, 1};
  for (const auto &[strength_a, strength_b] : {std::pair(1e3, 2e-3), std::pair(2e-3, 1e3)}) {
    FractureLaw law{FractureLaw::Criterion::face_tension, strength_a, {strength_a, strength_b}};
    ManyBodyForce<dim> force(packing, Materials({a, b}, packing.material), {}, law);
    auto p = at_rest(packing, a);
    disturb<dim>(p, spacing, 1e-3, Spin<dim>::Zero(), 5);
    for (int i = 0; i < p.size(); ++i)
      p.displacement[1][i] += 1e-3 * packing.centre[1][i];
    const double before = force.potential_energy(p);
    force.compute(p, 1);
    const auto &broken = force.broken_bonds();
    ASSERT_GT(broken.size(), 2u);
    int between = 0;
    for (const auto &bond : broken) {
      const int i = packing.material[bond.i], j = packing.material[bond.j];
      between += i != j;
      EXPECT_FALSE(i == j && (i ? strength_b : strength_a) > 1) << "broke in the strong material";
    }
    EXPECT_GT(between, 1);
    EXPECT_NEAR((before - force.potential_energy(p)) / force.fracture_energy(), 1, 1e-10);
  }
}

// Of the two materials of a pressed face one is broken by tension alone, and would soften; the
// other by Coulomb's law, and does not. It is the latter that fails, though the former bears more
// of its strength.
TYPED_TEST(Laminate, APressedFaceFailsByACriterionThatAsksForIt)
{
  constexpr int dim = TypeParam::value;
  for (const int first : {0, 1}) {
    auto packing = column<dim>();
    packing.material = {first, 1 - first};
    const double d = packing.spacing, cohesion = 1e-3, angle = M_PI / 6;
    FaceStrength coulomb(2 * cohesion * std::cos(angle) / (1 + std::sin(angle)));
    coulomb.cohesion = cohesion / coulomb.value;
    coulomb.friction_angle = angle;
    coulomb.cut_off = 1e3;
    FractureLaw law;
    law.criteria = {FractureLaw::Criterion::mohr_coulomb, FractureLaw::Criterion::maximum_tension};
    law.strengths = {coulomb, FaceStrength(3e-4)};
    law.energies = {0, 1e-6};
    const DemMaterial material{1, 0.3, 1, PlaneMode::strain, 0.3};
    ManyBodyForce<dim> force(packing, Materials({material, material}, packing.material), {}, law);
    auto p = at_rest(packing, material);
    p.displacement[1][1] = -1e-3 * d;
    for (int step = 1; force.broken_bonds().empty() && step < 400; ++step) {
      p.displacement[0][1] = 1e-5 * step * d;
      force.compute(p, step);
      ASSERT_TRUE(force.cohesive().all().empty()) << step;
    }
    EXPECT_EQ(force.broken_bonds().size(), 1u);
  }
}
} // namespace ligament::dem::testing
