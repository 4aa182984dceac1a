// Maximum tension is the largest principal stress on any packing, whatever the other stresses are.
#include "dem/tensors.h"
#include "packings/random_packing.h"
#include "tests/unit/dem/cases.h"

namespace ligament::dem::testing
{
/// A body in a homogeneous stress, and its particles that no side disturbs.
template <int dim>
struct StressedBody
{
  Packing<dim> packing;
  Particles<dim> p;
  std::vector<int> inside;

  StressedBody(Packing<dim> made, const DemMaterial &material, const Strain<dim> &stress)
      : packing(std::move(made))
  {
    packings::fill_particles(packing, 1., p);
    const Strain<dim> e = material.elastic_constants<dim>().stiffness.inverse() * stress;
    Eigen::Matrix<double, dim, dim> gradient = Vector<dim>(e.template head<dim>()).asDiagonal();
    for (int a = 0, k = n_strains<dim> - 1; a < dim; ++a)
      for (int b = a + 1; b < dim; ++b, --k)
        gradient(a, b) = gradient(b, a) = e[k] / 2;
    // A cell that is cut has another pressure, which three rows of neighbours see.
    std::vector<char> beside(packing.size(), 0);
    for (const auto &face : packing.boundary_faces)
      beside[face.i] = 1;
    for (int row = 0; row < 3; ++row) {
      const auto before = beside;
      for (const auto &face : packing.faces)
        beside[face.i] |= before[face.j], beside[face.j] |= before[face.i];
    }
    for (int i = 0; i < packing.size(); ++i) {
      set(p.displacement, i, Vector<dim>(gradient * get(packing.centre, i)));
      if (!beside[i])
        inside.push_back(i);
    }
  }
};

/// Principal stresses s1 above the others, in random axes; Voigt order.
template <int dim>
Strain<dim> stress_of(double s1, double others, std::mt19937 &random)
{
  std::normal_distribution<double> normal;
  const Vector<dim> e = Vector<dim>::NullaryExpr([&] { return normal(random); }).normalized();
  Strain<dim> identity = Strain<dim>::Zero();
  identity.template head<dim>().setOnes();
  return symmetric_product<dim>(e, Vector<dim>((s1 - others) * e)) + others * identity;
}

template <int dim>
void expect_principal_stress(const Packing<dim> &packing, double nu, unsigned seed)
{
  std::mt19937 random(seed);
  for (const double others : {0., -0.3, 0.7}) {
    constexpr double small = 1e-9; // of the modulus: rotations of second order vanish
    const DemMaterial material{1., nu, 1, PlaneMode::strain, 0};
    const StressedBody<dim> body(packing, material, small * stress_of<dim>(1., others, random));
    ASSERT_FALSE(body.inside.empty());
    const ManyBodyForce<dim> force(packing, material, {},
                                   {FractureLaw::Criterion::maximum_tension, small});
    EXPECT_NEAR(force.weakest_bond(body.p, body.inside).utilisation, 1., 1e-6) << others;
  }
}

template <typename C>
struct Criterion : ::testing::Test
{
};
TYPED_TEST_SUITE(Criterion, Cases);

TYPED_TEST(Criterion, IsTheLargestPrincipalStressOnLattices)
{
  constexpr int dim = TypeParam::dim;
  const auto packing = packings::make_lattice_packing<dim>(box<TypeParam>(dim == 2 ? 14 : 11));
  for (const double nu : {0., 0.3, 0.45})
    expect_principal_stress<dim>(packing, nu, 1);
}

TEST(Criterion, IsTheLargestPrincipalStressOnRandomPackings)
{
  packings::RandomParameters<2> plane;
  plane.spacing = 0.01, plane.upper.setConstant(0.16), plane.size_ratio = 3;
  expect_principal_stress<2>(packings::make_random_packing<2>(plane).packing, 0.3, 2);
  packings::RandomParameters<3> space;
  space.spacing = 0.01, space.upper.setConstant(0.09);
  expect_principal_stress<3>(packings::make_random_packing<3>(space).packing, 0.3, 2);
}
} // namespace ligament::dem::testing
