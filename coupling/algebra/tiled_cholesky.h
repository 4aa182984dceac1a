// Cholesky by Eigen, its triangular solves over dense tiles: the overlap's solver in the time loop.
#pragma once

#include "coupling/algebra/linear_solver.h"
#include "coupling/algebra/tile_sweep.h"

namespace ligament::coupling
{
/// P A P^T = L S L^T with S = +-1; the unknowns in the order that leaves fewer tiles of L, along
/// the overlap or by minimum degree. An overlap is long and thin: its L is a band of tiles.
class TiledCholesky : public LinearSolver
{
public:
  void factorise(const Eigen::SparseMatrix<double> &matrix) override;
  void factorise_constrained(const Eigen::SparseMatrix<double> &matrix) override;
  void solve(double *x, int n_columns) const override;

private:
  template <int columns>
  void solve_columns(double *x) const;
  void take(const Eigen::SparseMatrix<double> &lower, const std::vector<int> &order);

  std::vector<int> place_; // of an unknown in the order of elimination
  TileSweep forward_, backward_;
  std::vector<int> negative_; // places where S is -1
  mutable std::vector<LaneArray> work_;
};

/// Unknowns of a symmetric matrix so that neighbours stand close together (reverse
/// Cuthill-McKee), connected part by connected part.
std::vector<int> narrow_order(const Eigen::SparseMatrix<double> &matrix);
} // namespace ligament::coupling
