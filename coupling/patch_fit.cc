#include "coupling/patch_fit.h"

#include "core/check.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <map>

namespace ligament::coupling
{
namespace
{
// Z_b = P_a S P_a^T + P_n H P_a^T + P_a H^T P_n^T on the nodes of one block of cells.
struct Block
{
  std::vector<int> nodes; // near nodes
  Eigen::MatrixXd place;  // m, one column per node, against the node in the middle
  Eigen::MatrixXd affine; // P_a, (dim nodes) x n_strains, 1/m
  Eigen::MatrixXd rest;   // P_n, orthonormal
  double volume;          // m^3
  int first_unknown;
};

template <int dim>
void make_bases(Block &block)
{
  constexpr int n_rigid = dim + n_spins<dim>;
  const int n = int(block.nodes.size());
  const Vector<dim> centre = block.place.rowwise().mean();
  Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(dim * n, n_rigid);
  Eigen::MatrixXd affine(dim * n, n_strains<dim>);
  for (int i = 0; i < n; ++i) {
    const Vector<dim> x = block.place.col(i) - centre;
    for (int c = 0; c < dim; ++c)
      rigid(i * dim + c, c) = 1;
    if constexpr (dim == 2)
      rigid.block(i * 2, 2, 2, 1) << -x[1], x[0];
    else
      rigid.block(i * 3, 3, 3, 3) << 0, x[2], -x[1], -x[2], 0, x[0], x[1], -x[0], 0;
    for (int k = 0; k < n_strains<dim>; ++k)
      affine.block(i * dim, k, dim, 1) = unit_strain<dim>(k) * x;
  }
  affine -= rigid * (rigid.transpose() * rigid).ldlt().solve(rigid.transpose() * affine);
  Eigen::MatrixXd both(dim * n, n_rigid + n_strains<dim>);
  both << rigid, affine;
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(both).householderQ();
  block.rest = q.rightCols(dim * n - both.cols());
  block.affine = affine * (affine.transpose() * affine).inverse();
}

// One block around every node that 2^dim overlap cells share.
template <int dim>
std::vector<Block> make_blocks(const Overlap<dim> &overlap, double thickness)
{
  constexpr int nc = fem::n_cell_nodes<dim>;
  std::vector<std::vector<int>> cells_of_node(overlap.n_nodes());
  for (std::size_t c = 0; c < overlap.cells.size(); ++c)
    if (overlap.cells[c].layer == 0)
      for (const int node : overlap.cells[c].nodes)
        cells_of_node[node].push_back(int(c));
  std::vector<Block> blocks;
  for (int middle = 0; middle < overlap.n_nodes(); ++middle)
    if (const auto &cells = cells_of_node[middle]; int(cells.size()) == nc) {
      Block block;
      block.volume = 0;
      block.place.resize(dim, nc * nc);
      for (const int c : cells) {
        const auto &nodes = overlap.cells[c].nodes;
        const Vector<dim> &size = overlap.mesh.cell_size[overlap.cells[c].cell];
        const int corner = int(std::find(nodes.begin(), nodes.end(), middle) - nodes.begin());
        block.volume += thickness * size.prod();
        for (int a = 0; a < nc; ++a)
          if (std::find(block.nodes.begin(), block.nodes.end(), nodes[a]) == block.nodes.end()) {
            block.place.col(block.nodes.size()) =
                fem::corner<dim>(size, a) - fem::corner<dim>(size, corner);
            block.nodes.push_back(nodes[a]);
          }
      }
      block.place.conservativeResize(dim, block.nodes.size());
      make_bases<dim>(block);
      blocks.push_back(std::move(block));
    }
  return blocks;
}

// Minimum-norm solution of g x = r: x = g^T (g g^T)^+ r. The rows are dependent (forces balance),
// so g g^T is shifted a little and the shift is iterated away; r lies in its range.
Eigen::VectorXd minimum_norm(const Eigen::SparseMatrix<double> &g, const Eigen::VectorXd &r)
{
  Eigen::SparseMatrix<double> normal = g * Eigen::SparseMatrix<double>(g.transpose());
  double largest = 0;
  for (int i = 0; i < normal.rows(); ++i)
    largest = std::max(largest, normal.coeff(i, i));
  Eigen::SparseMatrix<double> identity(normal.rows(), normal.rows());
  identity.setIdentity();
  normal += 1e-9 * largest * identity;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  core::require(solver.info() == Eigen::Success, "the patch fit's normal equations are singular");
  Eigen::VectorXd x = Eigen::VectorXd::Zero(g.cols());
  Eigen::VectorXd rest = r;
  for (int sweep = 0; sweep < 30 && rest.norm() > 1e-16 * r.norm(); ++sweep) {
    const Eigen::VectorXd next = x + g.transpose() * solver.solve(rest);
    const Eigen::VectorXd next_rest = r - g * next;
    if (sweep > 2 && next_rest.norm() > 0.5 * rest.norm())
      break; // round-off reached
    x = next;
    rest = next_rest;
  }
  return x;
}
} // namespace

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

template <int dim>
PatchFit fit_patch(const Overlap<dim> &overlap, const BlendedOperators<dim> &operators,
                   const fem::Body<dim> &body)
{
  constexpr int ns = n_strains<dim>, n_symmetric = ns * (ns + 1) / 2;
  const int n = overlap.n_nodes();
  const double force_scale =
      body.stiffness(0, 0) * body.thickness * std::pow(overlap.cell_size, dim - 1);

  // Equations: per overlap node, component and admissible strain.
  std::vector<Eigen::MatrixXd> states(n);
  std::vector<int> first_row(n, -1);
  int n_rows = 0;
  for (int node = 0; node < n; ++node)
    if (overlap.is_overlap_node[node]) {
      states[node] = admissible_strains<dim>(operators.free_normals[node], body.stiffness);
      first_row[node] = n_rows;
      n_rows += dim * int(states[node].cols());
    }
  Eigen::VectorXd right(n_rows);
  for (int node = 0; node < n; ++node)
    if (first_row[node] >= 0)
      for (int c = 0; c < dim; ++c)
        right.segment(first_row[node] + c * states[node].cols(), states[node].cols()) =
            (operators.residual.row(c * n + node) * states[node]).transpose();

  std::vector<Block> blocks = make_blocks(overlap, body.thickness);
  core::require(!blocks.empty(),
                "the overlap is less than two cells wide: the patch fit needs two; "
                "raise /coupling/overlap_cells");
  int n_unknowns = 0;
  std::vector<Eigen::Triplet<double>> entries;
  for (auto &block : blocks) {
    block.first_unknown = n_unknowns;
    const int n_rest = int(block.rest.cols());
    const double scale_h = block.volume / overlap.cell_size; // H = scale_h * unknown
    for (std::size_t i = 0; i < block.nodes.size(); ++i) {
      const int node = block.nodes[i];
      const int n_states = int(states[node].cols());
      for (int c = 0; c < dim; ++c)
        for (int s = 0; s < n_states; ++s) {
          const int row = first_row[node] + c * n_states + s;
          const auto strain = states[node].col(s);
          int unknown = n_unknowns;
          for (int k = 0; k < ns; ++k)
            for (int l = k; l < ns; ++l, ++unknown) {
              double value = block.affine(i * dim + c, k) * strain[l];
              if (k != l)
                value += block.affine(i * dim + c, l) * strain[k];
              entries.emplace_back(row, unknown, value * block.volume);
            }
          for (int k = 0; k < ns; ++k)
            for (int p = 0; p < n_rest; ++p, ++unknown)
              if (strain[k] != 0)
                entries.emplace_back(row, unknown,
                                     block.rest(i * dim + c, p) * strain[k] * scale_h);
        }
    }
    n_unknowns += n_symmetric + ns * n_rest;
  }
  Eigen::SparseMatrix<double> g(n_rows, n_unknowns);
  g.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd x = minimum_norm(g, right);

  PatchFit fit;
  fit.residual_before = right.cwiseAbs().maxCoeff() / force_scale;
  fit.residual = (right - g * x).cwiseAbs().maxCoeff() / force_scale;
  fit.largest_modulus = 0;
  std::vector<Eigen::Triplet<double>> triplets;
  for (const auto &block : blocks) {
    const int n_rest = int(block.rest.cols());
    Eigen::MatrixXd s(ns, ns), h(n_rest, ns);
    int unknown = block.first_unknown;
    for (int k = 0; k < ns; ++k)
      for (int l = k; l < ns; ++l)
        s(k, l) = s(l, k) = x[unknown++] * block.volume;
    for (int k = 0; k < ns; ++k)
      for (int p = 0; p < n_rest; ++p)
        h(p, k) = x[unknown++] * block.volume / overlap.cell_size;
    fit.largest_modulus = std::max(fit.largest_modulus,
                                   s.cwiseAbs().maxCoeff() / (body.stiffness(0, 0) * block.volume));
    const Eigen::MatrixXd mixed = block.rest * h * block.affine.transpose();
    const Eigen::MatrixXd z =
        block.affine * s * block.affine.transpose() + mixed + mixed.transpose();
    for (std::size_t i = 0; i < block.nodes.size(); ++i)
      for (std::size_t j = 0; j < block.nodes.size(); ++j)
        for (int a = 0; a < dim; ++a)
          for (int b = 0; b < dim; ++b)
            triplets.emplace_back(a * n + block.nodes[i], b * n + block.nodes[j],
                                  z(i * dim + a, j * dim + b));
  }
  fit.correction.resize(dim * n, dim * n);
  fit.correction.setFromTriplets(triplets.begin(), triplets.end());
  return fit;
}

template PatchFit fit_patch(const Overlap<2> &, const BlendedOperators<2> &, const fem::Body<2> &);
template PatchFit fit_patch(const Overlap<3> &, const BlendedOperators<3> &, const fem::Body<3> &);
template Eigen::MatrixXd admissible_strains<2>(const std::vector<Vector<2>> &,
                                               const Stiffness<2> &);
template Eigen::MatrixXd admissible_strains<3>(const std::vector<Vector<3>> &,
                                               const Stiffness<3> &);
} // namespace ligament::coupling
