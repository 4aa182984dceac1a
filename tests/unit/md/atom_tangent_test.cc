// The quadratic terms against differences of forces, and what is found from them.
#include "tests/unit/md/bodies.h"

#include <Eigen/Dense>

#include <algorithm>

namespace ligament::md::testing
{
/// K by summing terms, which have no columns of rotations.
template <int dim>
Eigen::MatrixXd stiffness_of_terms(const Body<dim> &body, const AtomForce<dim> &force)
{
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(dim * body.atoms.size(), dim * body.atoms.size());
  force.add_tangent(body.atoms, [&](const particles::QuadraticTerm<dim> &term) {
    const int n = int(term.members.size());
    EXPECT_EQ(term.rows.cols(), n * dim);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(term.rows.rows(), k.cols());
    for (int m = 0; m < n; ++m)
      rows.middleCols(dim * term.members[m], dim) += term.rows.middleCols(m * dim, dim);
    k += rows.transpose() * term.stiffness.asDiagonal() * rows;
  });
  return k;
}

/// minus the change of the forces per displacement of one atom, by central differences.
template <int dim>
Eigen::VectorXd column_by_differences(Body<dim> body, AtomForce<dim> &force, int column)
{
  const double h = 1e-5 * body.crystal.spacing();
  Eigen::VectorXd k(dim * body.atoms.size());
  k.setZero();
  for (const double sign : {1., -1.}) {
    body.atoms.displacement[column % dim][column / dim] = sign * h;
    force.compute(body.atoms, 0);
    for (int i = 0; i < k.size(); ++i)
      k[i] -= sign * body.atoms.force[i % dim][i / dim] / (2 * h);
  }
  return k;
}

template <int dim>
void expect_tangent(const Body<dim> &body, const AtomForce<dim> &made)
{
  AtomForce<dim> force = made;
  const Eigen::MatrixXd k = stiffness_of_terms(body, force);
  for (int column = 0; column < k.cols(); column += 41)
    EXPECT_LT((column_by_differences<dim>(body, force, column) - k.col(column)).norm() /
                  body.stiffness(),
              1e-5); // third derivatives of splines jump
  // Translations cost nothing, nor do they push.
  for (int c = 0; c < dim; ++c) {
    Eigen::VectorXd u(k.cols());
    for (int i = 0; i < u.size(); ++i)
      u[i] = i % dim == c;
    EXPECT_LT((k * u).norm() / body.stiffness(), 1e-12);
  }
}

TEST(AtomTangentTest, IsTheDerivativeOfTheForces)
{
  for (const Body<3> &body : bodies())
    if (body.crystal.parameters().kind != CrystalKind::bcc) // the iron table is too rough
      expect_tangent<3>(body, body.force());
  expect_tangent<2>(plane_body(), plane_body().force());
  const Body<2> periodic = plane_body({5, 4}, {true, true});
  expect_tangent<2>(periodic, periodic.force());
}

TEST(AtomTangentTest, HasTheWeightsOfTheEnergy)
{
  const Body<2> body = plane_body();
  AtomForce<2> force = body.force();
  std::vector<double> weights;
  Noise noise(6);
  for (int i = 0; i < body.atoms.size(); ++i)
    weights.push_back(0.6 + 0.4 * noise());
  force.set_energy_weights(weights);
  expect_tangent<2>(body, force);
}

// A homogeneous gradient costs what the moduli of the crystal say.
TEST(AtomTangentTest, HomogeneousGradientsCostTheModuli)
{
  const auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {3, 3, 3}, {true, true, true},
                                 Matrix<3>::Identity());
  Noise noise(7);
  const Matrix<3> g = noise.matrix<3, 3>();
  const Moduli<3> a = body.crystal.moduli(Matrix<3>::Zero());
  double expected = 0;
  for (int p = 0; p < 9; ++p)
    for (int q = 0; q < 9; ++q)
      expected += 0.5 * a(p, q) * g(p / 3, p % 3) * g(q / 3, q % 3);
  // Term by term with the vector between the members, which periodic atoms do not have.
  double energy = 0;
  const AtomBody<3> parts{body.crystal.potential(),
                          std::vector<int>(body.atoms.size(), 0),
                          body.packing.period,
                          {},
                          {}};
  const AtomTangent<3> tangent(parts, body.atoms);
  std::vector<double> growth(body.atoms.size(), 0.);
  ReferenceBonds<3>(parts, body.atoms).for_each([&](const Bond<3> &b) {
    const BondJets jets = parts.potential.bond(0, 0, b.length);
    const Vector<3> n = b.reference / b.length, du = g * b.reference;
    energy += 0.5 * (jets.pair.slope / b.length * (du.squaredNorm() - std::pow(du.dot(n), 2)) +
                     jets.pair.curvature * std::pow(du.dot(n), 2));
    growth[b.i] += jets.density_at_i.slope * du.dot(n);
    growth[b.j] += jets.density_at_j.slope * du.dot(n);
  });
  for (int i = 0; i < body.atoms.size(); ++i)
    energy +=
        0.5 * std::pow(growth[i], 2) * parts.potential.embedding(0, tangent.density(i)).curvature;
  EXPECT_NEAR(energy / (body.atoms.size() * body.crystal.volume()) / expected, 1, 1e-12);
}

TEST(AtomTangentTest, TermsThatAreAskedForAreThoseOfTheWhole)
{
  const Body<2> body = plane_body();
  const AtomForce<2> force = body.force();
  const std::vector<int> asked = {3, 17, 18, 40};
  using Members = std::vector<std::vector<int>>;
  Members all, some;
  const auto collect = [&](Members &members, bool filter) {
    return [&members, &asked, filter](const particles::QuadraticTerm<2> &term) {
      bool enters = !filter;
      for (const int i : term.members)
        enters = enters || std::count(asked.begin(), asked.end(), i);
      if (enters)
        members.push_back(term.members);
    };
  };
  force.add_tangent(body.atoms, collect(all, true));
  force.add_tangent(body.atoms, collect(some, false), &asked);
  EXPECT_EQ(some, all);
  EXPECT_FALSE(some.empty());
}

// The shortest wave along a close-packed row of a triangular crystal with springs between nearest
// neighbours alone: the largest frequency of the crystal is known, omega^2 = 6 k/m.
TEST(AtomTangentTest, StableStepIsThatOfTheShortestWave)
{
  const double d = 2.5 * angstrom, depth = 0.3 * electron_volt, decay = 3 / angstrom;
  const Potential p = morse(argon(), depth, d, decay, {1.1 * d, 1.3 * d});
  const auto body = make_body<2>(p, CrystalKind::triangular, {12, 6}, {true, true});
  const double stiffness = 2 * depth * decay * decay,
               step = 2 / std::sqrt(6 * stiffness / body.atoms.mass[0]);
  const double found = body.force().stable_step(body.atoms);
  EXPECT_LE(found, step);
  EXPECT_GT(found, 0.985 * step); // 1 % by intention
  // Held atoms do not count; of the free ones the heaviest frequency decides.
  auto held = body.atoms;
  for (int i = 1; i < held.size(); ++i)
    held.mass[i] = std::numeric_limits<double>::infinity();
  // One free atom on six springs: 3 k in each direction.
  EXPECT_NEAR(body.force().stable_step(held),
              2 / (1.01 * std::sqrt(3 * stiffness / body.atoms.mass[0])), 1e-3 * step);
}

// Faces of an inner atom close, and their pyramids fill its volume.
TEST(AtomTangentTest, FacesOfInnerAtomsClose)
{
  const auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {5, 5, 5});
  const Vector<3> middle = 2.5 * body.crystal.lattice_parameter() * Vector<3>::Ones();
  int inner = 0;
  for (int i = 0; i < body.atoms.size(); ++i)
    if ((get(body.atoms.reference, i) - middle).norm() <
        (get(body.atoms.reference, inner) - middle).norm())
      inner = i;
  Vector<3> normals = Vector<3>::Zero();
  Matrix<3> volume = Matrix<3>::Zero();
  int n = 0;
  const std::vector<int> asked = {inner};
  body.force().for_each_face(
      body.atoms,
      [&](const particles::FaceView<3> &face) {
        EXPECT_EQ(face.i, inner);
        ++n;
        normals += face.area * face.normal;
        volume += face.area * (face.centroid - get(body.atoms.reference, inner)) *
                  face.normal.transpose();
      },
      &asked);
  EXPECT_EQ(n, 12);
  const double area = std::pow(body.crystal.spacing(), 2);
  EXPECT_LT(normals.norm(), 1e-14 * area);
  EXPECT_LT((volume - body.crystal.volume() * Matrix<3>::Identity()).norm(),
            1e-13 * body.crystal.volume());
}
} // namespace ligament::md::testing
