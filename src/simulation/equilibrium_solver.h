// Equilibrium of the body at given loads, and how it answers when they grow.
#pragma once

#include "algebra/conjugate_gradients.h"
#include "algebra/preconditioner.h"
#include "src/simulation/static_system.h"

#include <memory>

namespace ligament::program
{
/// What a scene's word says.
algebra::Preconditioning preconditioning(StaticSolver solver);

/// Newton's method, each step by preconditioned conjugate gradients on y (theory.md section 6).
/// What the stiffness doesn't know, faces that slide and cells that turn, is learnt from the last
/// steps (Anderson's acceleration).
template <int dim>
class EquilibriumSolver
{
public:
  enum class End
  {
    converged,
    stalled,   // forces stay out of balance
    indefinite // nothing resists a motion, or it helps it: the body no longer carries
  };

  /// The body must outlive it and have trials. helpers: see algebra::make_preconditioner().
  EquilibriumSolver(CoupledBody<dim> &body, algebra::Preconditioning kind,
                    core::Ranks helpers = {});

  /// What may stay out of balance, of the largest load: work and energy lack the square of it.
  static constexpr double exact = 1e-9;

  /// What is out of balance in the present place at the loads of `time` (s), over the load there,
  /// or a thousandth of the largest so far.
  double imbalance(double time)
  {
    double norm = 0;
    balance(time, norm);
    const double load = std::max(system_.load_force(time), 1e-3 * largest_load_);
    return load > 0 ? norm / load : 0;
  }
  /// From the present place to equilibrium at the loads of `time` (s), held components being where
  /// these have them. `moved`: by how much, y; the body is put back where it was when that fails.
  End find_equilibrium(double time, Eigen::VectorXd &moved, double tolerance = exact);

  /// To equilibrium as near as round-off lets it come: motions so small that their squares are
  /// none.
  void settle_linear(double time);

  /// How far the body moves from its place, where it is in equilibrium at the loads of `from`, when
  /// they become those of `to`, to first order: y with held components.
  End find_response(double from, double to, Eigen::VectorXd &y);

  /// Bonds have broken, and the body has moved: the next solve makes a new preconditioner.
  void renew();

  StaticSystem<dim> &system() { return system_; }

  /// So far.
  int n_solves() const { return n_solves_; }
  int n_iterations() const { return n_iterations_; }
  /// The largest load so far, in N, which forces out of balance are measured by.
  double largest_load() const { return largest_load_; }
  void set_largest_load(double force) { largest_load_ = force; }
  const char *preconditioner() const { return preconditioner_ ? preconditioner_->name() : "none"; }
  /// Motions that no support resists.
  int n_free_motions() const { return int(free_motions_.cols()); }
  /// The largest share of a load, of those in equilibria so far, that moves the body as a whole
  /// along these: it is taken out, and equilibria are those of the body that it accelerates.
  double unresisted_share() const { return unresisted_share_; }

  /// What they are made of, for a solver of the same body that is to go on with the same ones;
  /// empty as long as they are not known.
  struct FreeShares
  {
    int n = -1;                 // of motions; below 0: not known
    std::vector<double> shares; // of the rigid motions, one column behind another
  };
  FreeShares free_shares() const;
  void set_free_shares(const FreeShares &free);

private:
  using Faces = std::vector<std::array<int, 3>>;

  void prepare();
  void find_free_motions();
  void make_free_motions(const Eigen::MatrixXd &rigid, const Eigen::MatrixXd &shares);
  void project_force(Eigen::VectorXd &r) const;
  void project_motion(Eigen::VectorXd &y) const;
  algebra::CgResult solve(const Eigen::VectorXd &right, double tolerance, Eigen::VectorXd &y);
  Eigen::VectorXd balance(double time, double &norm);

  CoupledBody<dim> &body_;
  algebra::Preconditioning kind_;
  core::Ranks helpers_;
  StaticSystem<dim> system_;
  Eigen::MatrixXd free_motions_, free_forces_; // columns; each force works on its own motion alone
  Eigen::MatrixXd free_shares_;                // of the rigid motions that the first are made of
  bool knows_free_motions_ = false;
  std::unique_ptr<algebra::Preconditioner> preconditioner_;
  Faces touching_; // that it knows
  int n_solves_ = 0, n_iterations_ = 0;
  double largest_load_ = 0;
  double unresisted_share_ = 0;
};
} // namespace ligament::program
