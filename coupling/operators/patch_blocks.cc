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
template <int dim>
std::shared_ptr<const PatchBasis<dim>> make_basis(const Eigen::MatrixXd &place)
{
  constexpr int n_rigid = dim + n_spins<dim>;
  const int n = int(place.cols());
  const Vector<dim> centre = place.rowwise().mean();
  Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(dim * n, n_rigid);
  Eigen::MatrixXd affine(dim * n, n_strains<dim>);
  for (int i = 0; i < n; ++i) {
    const Vector<dim> x = place.col(i) - centre;
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
  auto basis = std::make_shared<PatchBasis<dim>>();
  basis->place = place;
  basis->homogeneous = Eigen::HouseholderQR<Eigen::MatrixXd>(both).householderQ() *
                       Eigen::MatrixXd::Identity(dim * n, both.cols());
  basis->strain = basis->homogeneous.transpose() * affine * (affine.transpose() * affine).inverse();
  return basis;
}
} // namespace

template <int dim>
Eigen::MatrixXd PatchBlock<dim>::correction() const
{
  const Eigen::MatrixXd affine = basis->homogeneous * basis->strain;
  const Eigen::MatrixXd mixed = (affine * h).transpose();
  return affine * s * affine.transpose() + mixed + mixed.transpose();
}

template <int dim>
std::vector<PatchBlock<dim>> make_patch_blocks(const Overlap<dim> &overlap, double thickness)
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
  std::vector<std::shared_ptr<const PatchBasis<dim>>> shapes;
  std::vector<PatchBlock<dim>> blocks;
  for (int middle = 0; middle < overlap.n_nodes(); ++middle)
    if (!leaves[middle] && n_corners[middle] == nc) {
      PatchBlock<dim> block;
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
      block.basis = known == shapes.end() ? shapes.emplace_back(make_basis<dim>(place)) : *known;
      block.h = StrainForces<dim>::Zero(n_strains<dim>, place.size());
      blocks.push_back(std::move(block));
    }
  return blocks;
}

template struct PatchBlock<2>;
template struct PatchBlock<3>;
template std::vector<PatchBlock<2>> make_patch_blocks(const Overlap<2> &, double);
template std::vector<PatchBlock<3>> make_patch_blocks(const Overlap<3> &, double);
} // namespace ligament::coupling
