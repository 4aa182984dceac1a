// Blocks of overlap cells and the motions of their nodes.
#include "coupling/operators/blended_operators.h"
#include "coupling/operators/patch_equations.h"

#include <Eigen/Dense>

#include <algorithm>
#include <limits>

namespace ligament::coupling
{
namespace
{
template <int dim, int ns>
std::shared_ptr<const PatchBasis> make_basis(const Eigen::MatrixXd &place)
{
  constexpr int n_rigid = dim + n_spins<dim> + n_strains<dim> - ns;
  const int n = int(place.cols());
  const Vector<dim> centre = place.rowwise().mean();
  Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(dim * n, n_rigid);
  Eigen::MatrixXd affine(dim * n, ns);
  for (int i = 0; i < n; ++i) {
    const Vector<dim> x = place.col(i) - centre;
    for (int c = 0; c < dim; ++c)
      rigid(i * dim + c, c) = 1;
    if constexpr (n_rigid == 3 && dim == 2)
      rigid.block(i * 2, 2, 2, 1) << -x[1], x[0];
    else if constexpr (n_rigid == 6)
      rigid.block(i * 3, 3, 3, 3) << 0, x[2], -x[1], -x[2], 0, x[0], x[1], -x[0], 0;
    for (int k = 0; k < ns; ++k)
      affine.block(i * dim, k, dim, 1) = unit_gradient<dim>(k, ns) * x;
  }
  affine -= rigid * (rigid.transpose() * rigid).ldlt().solve(rigid.transpose() * affine);
  Eigen::MatrixXd both(dim * n, n_rigid + ns);
  both << rigid, affine;
  auto basis = std::make_shared<PatchBasis>();
  basis->place = place;
  basis->homogeneous = Eigen::HouseholderQR<Eigen::MatrixXd>(both).householderQ() *
                       Eigen::MatrixXd::Identity(dim * n, both.cols());
  basis->strain = basis->homogeneous.transpose() * affine * (affine.transpose() * affine).inverse();
  return basis;
}
} // namespace

template <int dim, int ns>
Eigen::MatrixXd PatchBlock<dim, ns>::correction() const
{
  const Eigen::MatrixXd affine = basis->homogeneous * basis->strain;
  const Eigen::MatrixXd mixed = (affine * h).transpose();
  return affine * s * affine.transpose() + mixed + mixed.transpose();
}

template <int dim, int ns>
std::vector<PatchBlock<dim, ns>> make_patch_blocks(const Overlap<dim> &overlap, double thickness)
{
  constexpr int nc = fem::n_cell_nodes<dim>;
  // A node is inside the overlap when it is corner of cells all around and only overlap cells
  // follow it. Cells that follow it by a hanging corner belong to its star, too.
  std::vector<std::vector<int>> star(overlap.n_nodes());
  std::vector<int> n_corners(overlap.n_nodes(), 0);
  std::vector<char> leaves(overlap.n_nodes(), 0);
  for (std::size_t c = 0; c < overlap.cells.size(); ++c) {
    const auto &cell = overlap.cells[c];
    for (int a = 0; a < nc; ++a) {
      star[cell.nodes[a]].push_back(int(c));
      n_corners[cell.nodes[a]] += cell.shape.is_free_corner(a);
      leaves[cell.nodes[a]] |= cell.layer > 0;
    }
  }
  std::vector<std::shared_ptr<const PatchBasis>> shapes;
  std::vector<PatchBlock<dim, ns>> blocks;
  for (int middle = 0; middle < overlap.n_nodes(); ++middle)
    if (!leaves[middle] && n_corners[middle] == nc) {
      PatchBlock<dim, ns> block;
      block.volume = 0;
      block.length = std::numeric_limits<double>::max();
      Eigen::MatrixXd place(dim, nc * int(star[middle].size()));
      for (const int c : star[middle]) {
        const auto &cell = overlap.cells[c];
        const auto &nodes = cell.nodes;
        const int own = int(std::find(nodes.begin(), nodes.end(), middle) - nodes.begin());
        block.volume += thickness * overlap.mesh.cell_size[cell.cell].prod();
        block.length = std::min(block.length, cell.size);
        for (int a = 0; a < nc; ++a)
          if (std::find(block.nodes.begin(), block.nodes.end(), nodes[a]) == block.nodes.end()) {
            place.col(block.nodes.size()) = cell.shape.place.col(a) - cell.shape.place.col(own);
            block.nodes.push_back(nodes[a]);
          }
      }
      place.conservativeResize(dim, block.nodes.size());
      const auto known = std::find_if(shapes.begin(), shapes.end(), [&](const auto &shape) {
        return shape->place.cols() == place.cols() && shape->place == place;
      });
      block.basis =
          known == shapes.end() ? shapes.emplace_back(make_basis<dim, ns>(place)) : *known;
      block.h = StateForces<ns>::Zero(ns, place.size());
      blocks.push_back(std::move(block));
    }
  return blocks;
}

#define LIGAMENT_INSTANTIATE(dim, ns)                                                              \
  template struct PatchBlock<dim, ns>;                                                             \
  template std::vector<PatchBlock<dim, ns>> make_patch_blocks(const Overlap<dim> &, double);
LIGAMENT_INSTANTIATE(2, 3)
LIGAMENT_INSTANTIATE(2, 4)
LIGAMENT_INSTANTIATE(3, 6)
LIGAMENT_INSTANTIATE(3, 9)
#undef LIGAMENT_INSTANTIATE
} // namespace ligament::coupling
