// Terms of a force without rotations, gathered on the members of the overlap before they reach the
// nodes: a term between many particles touches far fewer particles than pairs of nodes.
#pragma once

#include "coupling/algebra/nodal_matrix.h"
#include "coupling/operators/interpolated_motion.h"

namespace ligament::coupling
{
/// What such terms give to the residual and the subtracted stiffness of BlendedOperators. All that
/// is handed in must outlive it.
template <int dim>
class MemberTerms
{
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;

  /// `states`: displacement gradients, one per column of the residual.
  MemberTerms(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
              const std::vector<Matrix> &states,
              const std::vector<InterpolatedMotion<dim>> &motions);

  /// A term with dim columns per member, some of which lie in the overlap.
  void add(const particles::QuadraticTerm<dim> &term);

  /// Adds the forces of all terms under each unit state, less the share subtracted, in N; numbered
  /// like BlendedOperators::residual.
  void add_residual(Eigen::MatrixXd &residual) const;

  /// Takes the terms' shares on the interpolated motion away, in N/m; leaves the matrix symmetric
  /// to the last bit if it was.
  void subtract_stiffness(NodalMatrix<dim> &stiffness) const;

private:
  // Of each member under each state, N.
  using Forces = std::vector<Eigen::Matrix<double, dim, Eigen::Dynamic, 0, dim, dim * dim>>;
  struct Pair
  {
    int i, j; // members
    Matrix k; // of i by j, times the share
  };
  /// The rows of terms between more than two particles, as nodes move them.
  struct NodalRow
  {
    int begin, end;   // in node_ and value_; nodes ascend
    double stiffness; // times the share
  };
  /// A node in the motion of a member, from the node's side.
  struct Reach
  {
    int member;
    double value;
  };

  void add_forces(const particles::QuadraticTerm<dim> &term, double share);
  void add_pair(const particles::QuadraticTerm<dim> &term, double share);
  void add_rows(const particles::QuadraticTerm<dim> &term, double share);
  std::vector<std::vector<Reach>> reach_of_nodes() const;

  const Overlap<dim> &overlap_;
  const particles::Particles<dim> &particles_;
  const std::vector<Matrix> &states_;
  const std::vector<InterpolatedMotion<dim>> &motions_; // of the members
  Forces whole_, shared_;
  std::vector<Pair> pairs_;
  std::vector<Matrix> own_; // of each member by itself
  std::vector<NodalRow> rows_;
  std::vector<int> node_;
  std::vector<Vector<dim>> value_;
  std::vector<Vector<dim>> row_; // of all nodes, work space of one row
};
} // namespace ligament::coupling
