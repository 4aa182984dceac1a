#include "src/verification/instruments/linear_motion.h"

#include "core/check.h"
#include "core/extremes.h"
#include "coupling/fine_scale_split.h"
#include "src/simulation/equilibrium_solver.h"
#include "src/verification/bodies/body_state.h"

#include <Eigen/Dense>

#include <cmath>
#include <random>

namespace ligament::program
{
namespace
{
/// Amplitude of motions, in d: rotations enter forces squared, and this squared is round-off.
constexpr double amplitude = 1e-14;

/// Rows: rigid translations and linearised rotations about the origin, as displacements of X.
template <int dim>
Eigen::Matrix<double, dim, dim + n_spins<dim>> rigid_motions(const Vector<dim> &x)
{
  Eigen::Matrix<double, dim, dim + n_spins<dim>> m;
  m.template leftCols<dim>().setIdentity();
  if constexpr (dim == 2)
    m.col(2) << -x[1], x[0];
  else
    for (int k = 0; k < 3; ++k)
      m.col(3 + k) = Vector<3>::Unit(k).cross(x);
  return m;
}
} // namespace

template <int dim>
LinearMotion<dim>::LinearMotion(CoupledBody<dim> &body)
    : body_(body), n_particles_(body.zone ? body.zone->state.size() : 0),
      n_particle_values_(
          (body.zone && !body.zone->state.turns ? dim : n_particle_dofs<dim>)*n_particles_)
{
  core::require(body.coupler->step_ratio() == 1, "linear motion needs the step ratio 1");
  if (body.far)
    n_nodes_ = body.far->mesh().n_nodes();
  near_mass_ = body.coupler->near_mass();
  rest_ = Eigen::VectorXd::Zero(size());
  rest_ = accelerations(rest_, false);
}

// Values stand component by component: displacements, rotations, then nodes.
template <int dim>
Vector<dim> LinearMotion<dim>::particle(const Eigen::VectorXd &x, int i) const
{
  Vector<dim> u;
  for (int c = 0; c < dim; ++c)
    u[c] = x[c * n_particles_ + i];
  return u;
}

template <int dim>
Vector<dim> LinearMotion<dim>::node(const Eigen::VectorXd &x, int i) const
{
  Vector<dim> u;
  for (int c = 0; c < dim; ++c)
    u[c] = x[n_particle_values_ + c * n_nodes_ + i];
  return u;
}

template <int dim>
void LinearMotion<dim>::set_state(const Eigen::VectorXd &x)
{
  set_displacement(body_, x);
  admissible<dim>(body_, Eigen::VectorXd::Zero(size()));
}

template <int dim>
Eigen::VectorXd LinearMotion<dim>::accelerations(const Eigen::VectorXd &x, bool loaded)
{
  set_state(x);
  auto bodies = body_.bodies();
  coupling::StepTime step;
  step.dt = 1;
  step.time = loaded ? 1 : 0;
  body_.coupler->compute_forces(bodies, step);
  body_.coupler->kick(bodies, step);
  if (body_.far)
    body_.far->distribute();
  return loaded ? velocities() : Eigen::VectorXd(velocities() - rest_);
}

template <int dim>
Eigen::VectorXd LinearMotion<dim>::velocities() const
{
  return velocity(body_);
}

template <int dim>
double LinearMotion<dim>::inner(const Eigen::VectorXd &x, const Eigen::VectorXd &y) const
{
  const auto *overlap = body_.coupler->overlap();
  Eigen::MatrixXd near_x, near_y;
  if (overlap) {
    near_x.resize(overlap->n_nodes(), dim);
    near_y.resize(overlap->n_nodes(), dim);
    for (int i = 0; i < overlap->n_nodes(); ++i) {
      near_x.row(i) = node(x, overlap->near_nodes[i]).transpose();
      near_y.row(i) = node(y, overlap->near_nodes[i]).transpose();
    }
  }
  const bool splits = dynamic_cast<const coupling::FineScaleSplit<dim> *>(body_.coupler.get());
  double sum = 0;
  for (int i = 0; i < n_particles_; ++i) {
    const int index = splits ? overlap->member_of_particle[i] : -1;
    Vector<dim> u = particle(x, i), v = particle(y, i);
    if (index >= 0) {
      const auto &member = overlap->members[index];
      if (member.pad)
        continue;
      for (std::size_t a = 0; a < member.nodes.size(); ++a) {
        u -= member.value[a] * near_x.row(member.nodes[a]).transpose();
        v -= member.value[a] * near_y.row(member.nodes[a]).transpose();
      }
    }
    const auto &zone = body_.zone->state;
    sum += zone.mass[i] * u.dot(v);
    for (int c = 0; c < n_spins<dim> && zone.turns; ++c) {
      const int k = (dim + c) * n_particles_ + i;
      sum += zone.inertia(i) * x[k] * y[k];
    }
  }
  if (overlap)
    sum += near_x.cwiseProduct(near_mass_ * near_y).sum();
  for (int i = 0; i < n_nodes_; ++i)
    if (!body_.far->is_released_node(i))
      sum += body_.far->lumped_mass()[i] * node(x, i).dot(node(y, i));
  return sum;
}

template <int dim>
Eigen::VectorXd LinearMotion<dim>::solve()
{
  rest();
  EquilibriumSolver<dim> solver(body_, algebra::Preconditioning::automatic);
  solver.settle_linear(1);
  const Eigen::VectorXd x = displacement(body_);
  accelerations(x, true);
  return x;
}

template <int dim>
Eigen::VectorXd LinearMotion<dim>::noise()
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  Eigen::VectorXd x(size());
  for (double &v : x)
    v = uniform(random);
  x = admissible(body_, x);
  return x / std::sqrt(inner(x, x));
}

template <int dim>
std::pair<double, double> LinearMotion<dim>::squared_frequencies(int iterations)
{
  // Three-term recurrence; lost orthogonality repeats eigenvalues but adds none.
  Eigen::VectorXd q = noise(), before = Eigen::VectorXd::Zero(size());
  Eigen::VectorXd diagonal(iterations), off_diagonal(iterations);
  double beta = 0;
  for (int k = 0; k < iterations; ++k) {
    Eigen::VectorXd r = -accelerations(amplitude * q, false) / amplitude - beta * before;
    diagonal[k] = inner(q, r);
    r -= diagonal[k] * q;
    beta = std::sqrt(inner(r, r));
    off_diagonal[k] = beta;
    before = q;
    q = r / beta;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal.head(iterations - 1),
                                Eigen::EigenvaluesOnly);
  return {solver.eigenvalues().minCoeff(), solver.eigenvalues().maxCoeff()};
}

template <int dim>
Eigen::VectorXd LinearMotion<dim>::affine(const Eigen::Matrix<double, dim, dim> &gradient,
                                          const Vector<dim> &translation) const
{
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
  const auto &g = gradient;
  Spin<dim> rotation;
  if constexpr (dim == 2)
    rotation << (g(1, 0) - g(0, 1)) / 2;
  else
    rotation << (g(2, 1) - g(1, 2)) / 2, (g(0, 2) - g(2, 0)) / 2, (g(1, 0) - g(0, 1)) / 2;
  for (int i = 0; i < n_particles_; ++i) {
    const Vector<dim> u = g * get(body_.zone->state.reference, i) + translation;
    for (int c = 0; c < dim; ++c)
      x[c * n_particles_ + i] = u[c];
    for (int c = 0; c < n_spins<dim>; ++c)
      x[(dim + c) * n_particles_ + i] = rotation[c];
  }
  for (int i = 0; i < n_nodes_; ++i) {
    const Vector<dim> u = g * body_.far->mesh().nodes[i] + translation;
    for (int c = 0; c < dim; ++c)
      x[n_particle_values_ + c * n_nodes_ + i] = u[c];
  }
  return x;
}

template <int dim>
double LinearMotion<dim>::largest_strain(const Eigen::VectorXd &x, const Place &counts) const
{
  constexpr int n_rigid = dim + n_spins<dim>;
  Eigen::Matrix<double, n_rigid, n_rigid> matrix;
  Vec<n_rigid> right;
  matrix.setZero();
  right.setZero();
  const auto place = [&](int i) { return get(body_.zone->state.reference, i); };
  const auto fit = [&](const Vector<dim> &at, const Vector<dim> &u) {
    const auto rigid = rigid_motions<dim>(at);
    matrix += rigid.transpose() * rigid;
    right += rigid.transpose() * u;
  };
  for (int i = 0; i < n_particles_; ++i)
    fit(place(i), particle(x, i));
  for (int i = 0; i < n_nodes_; ++i)
    fit(body_.far->mesh().nodes[i], node(x, i));
  const Vec<n_rigid> motion = matrix.ldlt().solve(right);

  double largest = 0;
  const auto compare = [&](const Vector<dim> &from, const Vector<dim> &to,
                           const Vector<dim> &relative) {
    if (counts && !counts((from + to) / 2))
      return;
    const Vector<dim> rest =
        relative - (rigid_motions<dim>(to) - rigid_motions<dim>(from)) * motion;
    keep_largest(largest, rest.norm() / (to - from).norm());
  };
  if (body_.zone)
    body_.force()->for_each_face(body_.zone->state, [&](const particles::FaceView<dim> &face) {
      if (face.j > face.i && face.bonded)
        compare(place(face.i), place(face.j), particle(x, face.j) - particle(x, face.i));
    });
  if (body_.far)
    for (const auto &cell : body_.far->mesh().cells)
      for (unsigned a = 0; a < cell.size(); ++a)
        for (int c = 0; c < dim; ++c)
          if (const unsigned b = a | (1u << c); b != a)
            compare(body_.far->mesh().nodes[cell[a]], body_.far->mesh().nodes[cell[b]],
                    node(x, cell[b]) - node(x, cell[a]));
  return largest;
}

template class LinearMotion<2>;
template class LinearMotion<3>;
} // namespace ligament::program
