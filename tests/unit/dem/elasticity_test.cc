// Elastic constants come out exactly on every lattice, boundary cells included.
#include "tests/unit/dem/cases.h"

namespace ligament::dem::testing
{
template <typename C>
struct Elasticity : ::testing::Test
{
};
TYPED_TEST_SUITE(Elasticity, Cases);

template <int dim>
Eigen::Matrix<double, dim, dim> tensor(const Strain<dim> &e)
{
  Eigen::Matrix<double, dim, dim> m;
  if constexpr (dim == 2)
    m << e[0], e[2] / 2, e[2] / 2, e[1];
  else
    m << e[0], e[5] / 2, e[4] / 2, e[5] / 2, e[1], e[3] / 2, e[4] / 2, e[3] / 2, e[2];
  return m;
}

const std::vector<double> poissons_ratios = {-0.2, 0., 0.3, 0.49};

TYPED_TEST(Elasticity, InnerCellsAnswerEveryUnitStrainByTheStiffness)
{
  constexpr int dim = TypeParam::dim;
  const auto lattice = box<TypeParam>(dim == 2 ? 9 : 7);
  const auto packing = packings::make_lattice_packing<dim>(lattice);
  // Surface particles and their neighbours see a strain that the free surface doesn't allow.
  std::vector<int> depth(packing.size(), 2);
  for (const auto &face : packing.boundary_faces)
    depth[face.i] = 0;
  for (const auto &face : packing.faces)
    for (const auto &[a, b] : {std::pair(face.i, face.j), std::pair(face.j, face.i)})
      if (depth[a] == 0)
        depth[b] = std::min(depth[b], 1);
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress})
    for (const double nu : poissons_ratios) {
      DemMaterial material{7e10, nu, 2500, plane, 0};
      ManyBodyForce<dim> force(packing, material, {});
      Particles<dim> p;
      packings::fill_particles(packing, material.density, p);
      const auto c = force.elastic_constants().stiffness;
      for (int k = 0; k < n_strains<dim>; ++k) {
        const Strain<dim> e = 1e-4 * Strain<dim>::Unit(k);
        for (int i = 0; i < p.size(); ++i)
          set(p.displacement, i, Vector<dim>(tensor<dim>(e) * get(p.reference, i)));
        force.compute(p, 0);
        Components<n_strains<dim>> stress;
        force.stresses(p, stress);
        const Strain<dim> expected = c * e;
        // nu near 1/2: phi enters lambda by 1/(3 - A phi), which amplifies its round-off.
        const double tolerance = 1e-12 * expected.norm() / (1 - 2 * std::max(nu, 0.));
        const double force_scale = expected.norm() * std::pow(lattice.spacing, dim - 1);
        int inner = 0;
        for (int i = 0; i < p.size(); ++i) {
          if (depth[i] == 2) {
            EXPECT_LT((get(stress, i) - expected).norm(), tolerance);
            EXPECT_LT(get(p.force, i).norm(), 1e-12 * force_scale / (1 - 2 * std::max(nu, 0.)));
            EXPECT_LT(get(p.torque, i).norm(),
                      1e-12 * force_scale * lattice.spacing / (1 - 2 * std::max(nu, 0.)));
            ++inner;
          }
        }
        EXPECT_GT(inner, 10);
        if (this->HasFailure())
          return;
      }
    }
}

TYPED_TEST(Elasticity, SpecimenPulledByWallsWithFreeSidesIsExact)
{
  constexpr int dim = TypeParam::dim;
  const auto lattice = box<TypeParam>(dim == 2 ? 9 : 6);
  const auto packing = packings::make_lattice_packing<dim>(lattice);
  // At finite strain the law is not linear; the force works with displacements, so that nothing is
  // lost at this one, whose square vanishes.
  const double strain = 1e-14;
  std::vector<core::BoundaryLoad<dim>> loads(2);
  for (int end = 0; end < 2; ++end) {
    loads[end].boundary = 2 + end;
    loads[end].kind = core::BoundaryLoad<dim>::Kind::displacement;
    loads[end].value[1] = strain * (end ? lattice.upper : lattice.lower)[1];
  }
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress})
    for (const double nu : poissons_ratios) {
      DemMaterial material{7e10, nu, 2500, plane, 0};
      ManyBodyForce<dim> force(packing, material, loads);
      Particles<dim> p;
      packings::fill_particles(packing, material.density, p);
      const bool plane_strain = dim == 2 && plane == PlaneMode::strain;
      const double lateral = plane_strain ? nu / (1 - nu) : nu;
      const double modulus = plane_strain ? 7e10 / (1 - nu * nu) : 7e10;
      for (int i = 0; i < p.size(); ++i)
        for (int c = 0; c < dim; ++c)
          p.displacement[c][i] = strain * (c == 1 ? 1 : -lateral) * p.reference[c][i];
      force.compute(p, 0);
      double area = lattice.thickness;
      for (int c = 0; c < dim; ++c)
        if (c != 1)
          area *= lattice.upper[c] - lattice.lower[c];
      const double amplified = 1 / (1 - 2 * std::max(nu, 0.));
      const double stress = modulus * strain;
      EXPECT_NEAR(force.reaction(1)[1], stress * area, 1e-12 * stress * area * amplified);
      EXPECT_NEAR(force.reaction(0)[1], -stress * area, 1e-12 * stress * area * amplified);
      const double scale = stress * std::pow(lattice.spacing, dim - 1) * lattice.thickness;
      for (int i = 0; i < p.size(); ++i) {
        EXPECT_LT(get(p.force, i).norm(), 1e-12 * scale * amplified) << nu;
        EXPECT_LT(get(p.torque, i).norm(), 1e-12 * scale * lattice.spacing * amplified);
      }
      Components<n_strains<dim>> tensors;
      force.stresses(p, tensors);
      for (int i = 0; i < p.size(); ++i)
        EXPECT_LT((get(tensors, i) - stress * Strain<dim>::Unit(1)).norm(),
                  1e-12 * stress * amplified);
      if (this->HasFailure())
        return;
    }
}

TYPED_TEST(Elasticity, TractionOnTwoSidesGivesTheSameState)
{
  constexpr int dim = TypeParam::dim;
  const auto lattice = box<TypeParam>(dim == 2 ? 9 : 6);
  const auto packing = packings::make_lattice_packing<dim>(lattice);
  const double nu = 0.3, stress = 1e-3; // strains of 1e-14, see above
  std::vector<core::BoundaryLoad<dim>> loads(2);
  for (int end = 0; end < 2; ++end) {
    loads[end].boundary = 2 + end;
    loads[end].kind = core::BoundaryLoad<dim>::Kind::traction;
    loads[end].value[1] = end ? stress : -stress;
  }
  DemMaterial material{7e10, nu, 2500, PlaneMode::strain, 0};
  ManyBodyForce<dim> force(packing, material, loads);
  Particles<dim> p;
  packings::fill_particles(packing, material.density, p);
  const double strain = stress / (dim == 2 ? 7e10 / (1 - nu * nu) : 7e10),
               lateral = dim == 2 ? nu / (1 - nu) : nu;
  for (int i = 0; i < p.size(); ++i)
    for (int c = 0; c < dim; ++c)
      p.displacement[c][i] = strain * (c == 1 ? 1 : -lateral) * p.reference[c][i];
  force.compute(p, 0);
  const double scale = stress * std::pow(lattice.spacing, dim - 1) * lattice.thickness;
  for (int i = 0; i < p.size(); ++i) {
    EXPECT_LT(get(p.force, i).norm(), 1e-12 * scale);
    EXPECT_LT(get(p.torque, i).norm(), 1e-12 * scale * lattice.spacing);
  }
}
} // namespace ligament::dem::testing
