// Unknowns of a matrix that have no entries, which preconditioners pass by.
#pragma once

#include "algebra/block_matrix.h"

namespace ligament::algebra
{
class InertUnknowns
{
public:
  explicit InertUnknowns(const BlockMatrix &matrix)
  {
    const Eigen::VectorXd diagonal = matrix.diagonal();
    for (Eigen::Index k = 0; k < diagonal.size(); ++k)
      if (diagonal[k] == 0)
        unknowns_.push_back(k);
  }

  /// z = solve(r) of all others, z = r of these. Coarse functions may reach into them: they are
  /// passed by there and back.
  template <typename Solve>
  void pass_by(const Eigen::VectorXd &r, Eigen::VectorXd &z, Solve &&solve) const
  {
    const bool is_asked = (r(unknowns_).array() != 0).any();
    Eigen::VectorXd others;
    if (is_asked) {
      others = r;
      others(unknowns_).setZero();
    }
    z.resize(r.size());
    solve(is_asked ? others : r, z);
    z(unknowns_) = r(unknowns_);
  }

private:
  std::vector<Eigen::Index> unknowns_;
};
} // namespace ligament::algebra
