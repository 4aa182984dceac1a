#include "coupling/operators/patch_fit.h"

#include "core/check.h"
#include "coupling/algebra/nodal_matrix.h"
#include "coupling/operators/patch_equations.h"

#include <Eigen/SVD>

namespace ligament::coupling
{
template <int dim>
Eigen::MatrixXd admissible_strains(const std::vector<Vector<dim>> &normals,
                                   const Stiffness<dim> &stiffness)
{
  constexpr int ns = n_strains<dim>;
  if (normals.empty())
    return Eigen::MatrixXd::Identity(ns, ns);
  // Traction on a surface: N^T C e with N the Voigt matrix of its normal.
  Eigen::MatrixXd traction(dim * normals.size(), ns);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    Eigen::Matrix<double, dim, ns> n = Eigen::Matrix<double, dim, ns>::Zero();
    for (int k = 0; k < ns; ++k) {
      // stress(k) as a tensor: the unit strain's tensor with whole off-diagonals.
      Eigen::Matrix<double, dim, dim> tensor = unit_strain<dim>(k);
      if (k >= dim)
        tensor *= 2;
      n.col(k) = tensor * normals[i];
    }
    traction.middleRows(dim * i, dim) = n * stiffness / stiffness(0, 0);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(traction, Eigen::ComputeFullV);
  int rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-9)
    ++rank;
  return svd.matrixV().rightCols(ns - rank);
}

namespace
{
template <int dim, int ns>
PatchFit fit_states(const Overlap<dim> &overlap, const BlendedOperators<dim> &operators,
                    const fem::Body<dim> &body)
{
  const int n = overlap.n_nodes();
  const double force_scale =
      body.stiffness(0, 0) * body.thickness * std::pow(overlap.cell_size, dim - 1);

  std::vector<Eigen::MatrixXd> states(n);
  StateForces<ns> right(ns, dim * n);
  for (int node = 0; node < n; ++node) {
    const auto &normals = operators.free_normals[node];
    if (overlap.is_overlap_node[node]) {
      if constexpr (ns == n_strains<dim>)
        states[node] = admissible_strains<dim>(normals, body.stiffness);
      else {
        core::require(normals.empty(), "the overlap ends at a free surface, where a force whose "
                                       "bonds bear forces in the reference can't end yet; keep "
                                       "coupled sides of the zone inside the specimen");
        states[node].setIdentity(ns, ns);
      }
    }
    for (int c = 0; c < dim; ++c)
      right.col(node * dim + c) = operators.residual.row(c * n + node).transpose();
  }
  auto blocks = make_patch_blocks<dim, ns>(overlap, body.thickness);
  core::require(!blocks.empty(),
                "the overlap is less than two cells wide: the patch fit needs two; "
                "raise /coupling/overlap_cells");
  PatchEquations<dim, ns> equations(blocks, states, overlap);
  equations.restrict_to_states(right);

  PatchFit fit;
  fit.residual_before = right.cwiseAbs().maxCoeff() / force_scale;
  fit.residual = equations.solve(right).cwiseAbs().maxCoeff() / force_scale;
  fit.largest_modulus = 0;
  NodalMatrix<dim> correction(n);
  for (const auto &block : blocks) {
    fit.largest_modulus = std::max(fit.largest_modulus, block.s.cwiseAbs().maxCoeff() /
                                                            (body.stiffness(0, 0) * block.volume));
    correction.add(block.nodes, block.correction());
  }
  fit.correction = correction.to_sparse();
  return fit;
}
} // namespace

template <int dim>
PatchFit fit_patch(const Overlap<dim> &overlap, const BlendedOperators<dim> &operators,
                   const fem::Body<dim> &body)
{
  if (operators.residual.cols() == n_strains<dim>)
    return fit_states<dim, n_strains<dim>>(overlap, operators, body);
  return fit_states<dim, dim * dim>(overlap, operators, body);
}

template PatchFit fit_patch(const Overlap<2> &, const BlendedOperators<2> &, const fem::Body<2> &);
template PatchFit fit_patch(const Overlap<3> &, const BlendedOperators<3> &, const fem::Body<3> &);
template Eigen::MatrixXd admissible_strains<2>(const std::vector<Vector<2>> &,
                                               const Stiffness<2> &);
template Eigen::MatrixXd admissible_strains<3>(const std::vector<Vector<3>> &,
                                               const Stiffness<3> &);
} // namespace ligament::coupling
