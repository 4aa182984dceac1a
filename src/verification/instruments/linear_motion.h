// The body that `run` steps, seen as one linear operator: displacements in, accelerations out.
#pragma once

#include "src/simulation/coupled_body.h"

#include <cmath>
#include <functional>
#include <utility>

namespace ligament::program
{
/// Small motions x = (particle displacements, rotation vectors, nodal displacements) of an undamped
/// body with step ratio 1. Accelerations are the velocities after one unmodified kick of the
/// program from rest over a unit step, so what is measured is the scheme as it runs. In exact
/// arithmetic x -> -accelerations(x) is self-adjoint and not negative in `inner`.
template <int dim>
class LinearMotion
{
public:
  explicit LinearMotion(CoupledBody<dim> &body);

  int size() const { return n_particle_values_ + dim * n_nodes_; }

  /// Accelerations at displacement x; with loads at full size (t = 1) or, without the
  /// coupler's dead loads either, zero (t = 0).
  Eigen::VectorXd accelerations(const Eigen::VectorXd &x, bool loaded);

  /// The inner product that makes 1/2 inner(v, v) the kinetic energy (theory.md eqs. (C1), (C6),
  /// (B2)).
  double inner(const Eigen::VectorXd &x, const Eigen::VectorXd &y) const;

  /// Equilibrium under the loads of t = 1, until forces are round-off. Leaves the body in that
  /// state.
  Eigen::VectorXd solve();

  /// Largest eigenfrequency in rad/s by Lanczos iteration without loads.
  double largest_frequency() { return std::sqrt(squared_frequencies().second); }

  /// Least and largest eigenvalue of x -> -accelerations(x) that Lanczos iteration finds, in
  /// rad^2/s^2.
  std::pair<double, double> squared_frequencies(int iterations = 200);

  /// Some admissible motion of unit norm: smooth in no way.
  Eigen::VectorXd noise();

  /// Motion u = G X + t of everything; rotations are the skew part.
  Eigen::VectorXd affine(const Eigen::Matrix<double, dim, dim> &gradient,
                         const Vector<dim> &translation = Vector<dim>::Zero()) const;

  using Place = std::function<bool(const Vector<dim> &)>;

  /// Largest |relative displacement| of neighbours (bonded particles, ends of cell edges) over
  /// their distance, after the best rigid motion is taken out of x; where `counts` is given only of
  /// those whose middle it accepts.
  double largest_strain(const Eigen::VectorXd &x, const Place &counts = {}) const;

  /// The body's present velocities and spins.
  Eigen::VectorXd velocities() const;

  /// Puts the body at rest in its reference state.
  void rest() { set_state(Eigen::VectorXd::Zero(size())); }

private:
  void set_state(const Eigen::VectorXd &x);
  Vector<dim> particle(const Eigen::VectorXd &x, int i) const;
  Vector<dim> node(const Eigen::VectorXd &x, int i) const;

  CoupledBody<dim> &body_;
  int n_particles_, n_particle_values_, n_nodes_ = 0;
  Eigen::SparseMatrix<double> near_mass_;
  Eigen::VectorXd rest_; // accelerations by dead loads of the coupler
};
} // namespace ligament::program
