// Cells at the coupled edge of a packing answer the mesh's motion as whole cells do, and their
// faces never break.
#include "core/extremes.h"
#include "tests/unit/dem/cases.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
template <typename C>
struct EdgeCellsOf : ::testing::Test
{
  static constexpr int dim = C::dim;
  using Matrix = Eigen::Matrix<double, dim, dim>;

  /// A packing that is cut off inside the specimen: across its first axis, or all around.
  static packings::LatticeParameters<dim> zone(bool all_around)
  {
    auto lattice = box<C>(dim == 2 ? 14 : 11);
    for (int c = 0; c < (all_around ? dim : 1); ++c) {
      lattice.zone_lower[c] = lattice.lower[c] + 2.1 * lattice.spacing;
      lattice.zone_upper[c] = lattice.upper[c] - 2.3 * lattice.spacing;
    }
    return lattice;
  }

  /// Open cells, and with their neighbours the pads; F is the mesh's motion.
  static particles::CoupledEdge<dim> edge(const ManyBodyForce<dim> &force, const Particles<dim> &p,
                                          const Matrix &f)
  {
    std::vector<Vector<dim>> closure(p.size(), Vector<dim>::Zero());
    std::vector<double> surface(p.size(), 0.);
    force.for_each_face(p, [&](const particles::FaceView<dim> &face) {
      closure[face.i] += face.area * face.normal;
      surface[face.i] += face.area;
    });
    std::vector<char> pad(p.size(), 0);
    particles::CoupledEdge<dim> found;
    for (int i = 0; i < p.size(); ++i)
      if (closure[i].norm() > 1e-9 * surface[i]) {
        found.open.push_back(i);
        pad[i] = 1;
      }
    const std::vector<char> open = pad;
    force.for_each_face(p, [&](const particles::FaceView<dim> &face) {
      if (face.j >= 0 && open[face.i])
        pad[face.j] = 1;
    });
    for (int i = 0; i < p.size(); ++i)
      if (pad[i])
        found.pads.push_back(i);
    found.gradient = [f](int) { return Matrix(f - Matrix::Identity()); };
    return found;
  }

  /// Everything moves as F = R (I + strain).
  static void move(Particles<dim> &p, const Matrix &f, const Spin<dim> &turn)
  {
    for (int i = 0; i < p.size(); ++i) {
      set(p.displacement, i, Vector<dim>((f - Matrix::Identity()) * get(p.reference, i)));
      turn_by<dim>(p, i, turn);
    }
  }
  static Matrix rotation(const Spin<dim> &turn)
  {
    Particles<dim> one;
    one.resize(1);
    turn_by<dim>(one, 0, turn);
    Matrix r = Matrix::Identity();
    for (int c = 0; c < dim; ++c)
      r.col(c) += Turn<dim>::of(one, 0).change(Vector<dim>::Unit(c));
    return r;
  }
  static Strain<dim> voigt(const Matrix &m)
  {
    if constexpr (dim == 2)
      return {m(0, 0), m(1, 1), m(0, 1)};
    else
      return (Strain<3>() << m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1)).finished();
  }
  /// Stress along the first axis alone, which is parallel to the free sides.
  static Matrix uniaxial_strain(const DemMaterial &material, double stress)
  {
    const double e = material.youngs_modulus, nu = material.poissons_ratio;
    const bool plane_strain = dim == 2 && material.plane == PlaneMode::strain;
    const double along = plane_strain ? (1 - nu * nu) / e : 1 / e,
                 across = plane_strain ? -nu * (1 + nu) / e : -nu / e;
    Matrix strain = across * stress * Matrix::Identity();
    strain(0, 0) = along * stress;
    return strain;
  }
};
TYPED_TEST_SUITE(EdgeCellsOf, Cases);

TYPED_TEST(EdgeCellsOf, AnswerUniformStrainAtAnyRotation)
{
  constexpr int dim = TypeParam::dim;
  using Test = EdgeCellsOf<TypeParam>;
  const Spin<dim> turn = Spin<dim>::Constant(0.4);
  const auto r = Test::rotation(turn);
  for (const bool all_around : {false, true})
    for (const double nu : {0., 0.25, 0.45}) {
      const DemMaterial material{4e10, nu, 2600, PlaneMode::strain, 0};
      const auto packing = packings::make_lattice_packing<dim>(Test::zone(all_around));
      ManyBodyForce<dim> force(packing, material, {});
      Particles<dim> p;
      packings::fill_particles(packing, material.density, p);
      const double stress = -4e7;
      const typename Test::Matrix strain = Test::uniaxial_strain(material, stress);
      const typename Test::Matrix f = r * (Test::Matrix::Identity() + strain);
      Test::move(p, f, turn);
      std::vector<int> all(p.size());
      for (int i = 0; i < p.size(); ++i)
        all[i] = i;
      typename Test::Matrix sigma = Test::Matrix::Zero();
      sigma(0, 0) = stress;
      const Strain<dim> expected = Test::voigt(r * sigma * r.transpose());
      const auto error = [&] {
        Components<n_strains<dim>> stresses;
        force.stresses(p, stresses);
        double largest = 0;
        for (int i = 0; i < p.size(); ++i)
          keep_largest(largest, (get(stresses, i) - expected).norm());
        return largest;
      };
      EXPECT_GT(error(), 0.1 * std::abs(stress)); // as on a free surface
      const auto edge = Test::edge(force, p, f);
      ASSERT_GT(edge.open.size(), 4u);
      ASSERT_LT(edge.open.size(), edge.pads.size());
      force.set_coupled_edge(p, edge);
      // Displacements of 0.4 times the size, known to 1e-16 of it, stand against strains of 1e-3.
      const double tolerance = 1e-10 * std::abs(stress);
      EXPECT_LT(force.max_tension(p, all), tolerance);
      EXPECT_LT(error(), tolerance);
      if (this->HasFailure())
        return;
    }
}

TYPED_TEST(EdgeCellsOf, NeverBreak)
{
  constexpr int dim = TypeParam::dim;
  using Test = EdgeCellsOf<TypeParam>;
  const DemMaterial material{4e10, 0.25, 2600, PlaneMode::strain, 0};
  const auto packing = packings::make_lattice_packing<dim>(Test::zone(false));
  ManyBodyForce<dim> force(packing, material, {}, {FractureLaw::Criterion::maximum_tension, 3e6});
  Particles<dim> p;
  packings::fill_particles(packing, material.density, p);
  const typename Test::Matrix f = Test::Matrix::Identity() + Test::uniaxial_strain(material, 9e7);
  const auto edge = Test::edge(force, p, f);
  force.set_coupled_edge(p, edge);
  Test::move(p, f, Spin<dim>::Zero());
  force.compute(p, 0);
  EXPECT_GT(force.broken_bonds().size(), 10u);
  std::vector<char> pad(p.size(), 0);
  for (const int i : edge.pads)
    pad[i] = 1;
  for (const auto &bond : force.broken_bonds())
    EXPECT_FALSE(pad[bond.i] || pad[bond.j]);
}
} // namespace ligament::dem::testing
