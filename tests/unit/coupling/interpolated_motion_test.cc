// The motion on which the subtracted energy is evaluated: exact where uniform, relaxed elsewhere,
// and the same in the energy as in the forces.
#include "coupling/operators/interpolated_motion.h"

#include "coupling/operators/blended_operators.h"
#include "tests/support/coupled_bodies.h"

#include <Eigen/QR>
#include <gtest/gtest.h>

namespace ligament
{
namespace
{
using namespace tests;
using coupling::Overlap;

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

template <int dim>
struct Body
{
  CoupledBodies<dim> bodies;
  const Overlap<dim> &overlap;
  const particles::Particles<dim> &state;
  const particles::ParticleForce<dim> &force;
  std::vector<coupling::InterpolatedMotion<dim>> motions;

  explicit Body(CoupledBodies<dim> made)
      : bodies(std::move(made)), overlap(*bodies.split->overlap()), state(bodies.zone->state),
        force(*bodies.zone->force), motions(interpolate_motions(overlap, state, force))
  {
  }

  Vector<dim> node(int i) const { return overlap.mesh.nodes[overlap.near_nodes[i]]; }
  Vector<dim> centre(int member) const
  {
    return get(state.reference, overlap.members[member].particle);
  }
};

/// A band with free edges, the mesh at no fraction of the packing.
template <int dim>
Body<dim> make_body()
{
  CoupledBodiesParameters<dim> p;
  p.material.poissons_ratio = 0.3;
  p.transition_cells = 2;
  if constexpr (dim == 2) {
    p.size = {24.3, 80};
    p.zone_size = {100, 40};
  } else {
    p.size = {9.3, 8.7, 50};
    p.zone_size = {100, 100, 25};
    p.cell_size = 3.1;
    p.overlap_cells = 2;
  }
  return Body<dim>(make_coupled_bodies<dim>(p));
}

/// Column n: displacement of near node n.
template <int dim, typename Motion>
Eigen::MatrixXd nodal(const Body<dim> &body, Motion motion)
{
  Eigen::MatrixXd u(dim, body.overlap.n_nodes());
  for (int n = 0; n < u.cols(); ++n)
    u.col(n) = motion(body.node(n));
  return u;
}

/// Motion with kinks at every row of nodes.
template <int dim>
Eigen::MatrixXd noise(const Body<dim> &body)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Eigen::MatrixXd::NullaryExpr(dim, body.overlap.n_nodes(), [&] { return uniform(random); });
}

template <int dim>
Vector<dim> displacement(const coupling::InterpolatedMotion<dim> &motion, const Eigen::MatrixXd &u)
{
  Vector<dim> sum = Vector<dim>::Zero();
  for (const auto &share : motion)
    sum += share.value * u.col(share.node);
  return sum;
}

template <int dim>
Matrix<dim> gradient(const coupling::InterpolatedMotion<dim> &motion, const Eigen::MatrixXd &u)
{
  Matrix<dim> sum = Matrix<dim>::Zero();
  for (const auto &share : motion)
    sum += u.col(share.node) * share.gradient.transpose();
  return sum;
}

/// Phi U of a member.
template <int dim>
Vector<dim> carried(const Body<dim> &body, int member, const Eigen::MatrixXd &u)
{
  const auto &m = body.overlap.members[member];
  Vector<dim> sum = Vector<dim>::Zero();
  for (int a = 0; a < Overlap<dim>::n_cell_nodes; ++a)
    sum += m.value[a] * u.col(m.nodes[a]);
  return sum;
}

template <int dim>
std::vector<std::vector<int>> bonded_members(const Body<dim> &body)
{
  std::vector<std::vector<int>> neighbours(body.overlap.members.size());
  body.force.for_each_face(body.state, [&](const particles::FaceView<dim> &face) {
    if (face.j < 0)
      return;
    const int i = body.overlap.member_of_particle[face.i],
              j = body.overlap.member_of_particle[face.j];
    if (i >= 0 && j >= 0)
      neighbours[i].push_back(j);
  });
  return neighbours;
}

// Sums of some twenty products of numbers up to 50, gradients of at most 1 per length.
constexpr double round_off = 2e-13;

template <int dim>
void test_affine_motion()
{
  const auto body = make_body<dim>();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Matrix<dim> g = Matrix<dim>::NullaryExpr([&] { return uniform(random); });
  const Vector<dim> shift = Vector<dim>::Constant(0.7);
  const auto affine = [&](const Vector<dim> &x) { return Vector<dim>(g * x + shift); };
  const auto u = nodal(body, affine);
  for (std::size_t i = 0; i < body.motions.size(); ++i) {
    EXPECT_LT((displacement<dim>(body.motions[i], u) - affine(body.centre(int(i)))).norm(),
              round_off);
    EXPECT_LT((gradient<dim>(body.motions[i], u) - g).norm(), round_off);
  }
}

TEST(InterpolatedMotion, AffineMotionsStayAsTheyAre)
{
  test_affine_motion<2>();
  test_affine_motion<3>();
}

// theory.md eq. (C17) as it is written, with a least-squares fit by another way.
template <int dim>
void test_relaxation()
{
  const auto body = make_body<dim>();
  const auto neighbours = bonded_members(body);
  const auto u = noise(body);
  int n_relaxed = 0;
  for (std::size_t i = 0; i < body.motions.size(); ++i) {
    const Vector<dim> own = carried(body, int(i), u);
    if (body.overlap.members[i].pad) {
      EXPECT_LT((displacement<dim>(body.motions[i], u) - own).norm(), round_off);
      continue;
    }
    const int n = int(neighbours[i].size());
    Eigen::MatrixXd way(n, dim), change(n, dim);
    for (int k = 0; k < n; ++k) {
      const int j = neighbours[i][k];
      const Vector<dim> r = body.centre(j) - body.centre(int(i));
      way.row(k) = r / r.norm();
      change.row(k) = (carried(body, j, u) - own) / r.norm();
    }
    const Matrix<dim> g = way.colPivHouseholderQr().solve(change).transpose();
    Vector<dim> pull = Vector<dim>::Zero();
    for (const int j : neighbours[i])
      pull += carried(body, j, u) - own - g * (body.centre(j) - body.centre(int(i)));
    EXPECT_LT((displacement<dim>(body.motions[i], u) - own - pull / (4 * n)).norm(), round_off);
    EXPECT_LT((gradient<dim>(body.motions[i], u) - g).norm(), round_off);
    n_relaxed += pull.norm() > 0.1;
  }
  EXPECT_GT(n_relaxed, int(body.motions.size()) / 4); // noise bends the motion nearly everywhere
}

TEST(InterpolatedMotion, ParticlesGoAQuarterOfTheWayToTheirNeighbours)
{
  test_relaxation<2>();
  test_relaxation<3>();
}

// The stiffness that hands forces to the nodes is that of one energy: the cells' share less that of
// every term of the law on this motion, both ways with the same matrix.
template <int dim>
void test_energy()
{
  const auto body = make_body<dim>();
  const auto &overlap = body.overlap;
  const auto &far = body.bodies.far->body();
  const Eigen::SparseMatrix<double>
      whole = coupling::make_blended_operators(overlap, body.state, body.force, far).stiffness,
      cells = coupling::make_cell_operators(overlap, body.state, body.force, far).stiffness;
  EXPECT_LT((whole - Eigen::SparseMatrix<double>(whole.transpose())).norm(), 1e-14 * whole.norm());

  const auto u = noise(body);
  double subtracted = 0;
  body.force.add_tangent(body.state, [&](const particles::QuadraticTerm<dim> &term) {
    const double share = overlap.subtracted_share(term.location, term.members);
    if (share == 0)
      return;
    constexpr int dofs = n_particle_dofs<dim>;
    Eigen::VectorXd q(int(term.members.size()) * dofs);
    for (std::size_t k = 0; k < term.members.size(); ++k) {
      const auto &motion = body.motions[overlap.member_of_particle[term.members[k]]];
      Spin<dim> turn = Spin<dim>::Zero();
      for (const auto &s : motion)
        turn += coupling::half_curl<dim>(s.gradient) * u.col(s.node);
      q.segment<dim>(int(k) * dofs) = displacement<dim>(motion, u);
      q.segment<n_spins<dim>>(int(k) * dofs + dim) = turn;
    }
    subtracted += 0.5 * share * (term.rows * q).cwiseAbs2().dot(term.stiffness);
  });
  const Eigen::MatrixXd columns = u.transpose(); // component by component
  const Eigen::Map<const Eigen::VectorXd> x(columns.data(), columns.size());
  const double of_cells = 0.5 * x.dot(cells * x);
  ASSERT_GT(subtracted, 0.1 * of_cells);
  EXPECT_NEAR(0.5 * x.dot(whole * x), of_cells - subtracted, 1e-12 * of_cells);
}

TEST(InterpolatedMotion, ForcesAndEnergyShareIt)
{
  test_energy<2>();
  test_energy<3>();
}
} // namespace
} // namespace ligament
