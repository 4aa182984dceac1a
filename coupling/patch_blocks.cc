// Blocks of overlap cells and the motions of their nodes.
#include "coupling/blended_operators.h"
#include "coupling/patch_equations.h"

#include <Eigen/Dense>

#include <algorithm>

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
  std::vector<std::vector<int>> cells_of_node(overlap.n_nodes());
  for (std::size_t c = 0; c < overlap.cells.size(); ++c)
    if (overlap.cells[c].layer == 0)
      for (const int node : overlap.cells[c].nodes)
        cells_of_node[node].push_back(int(c));
  std::vector<std::shared_ptr<const PatchBasis<dim>>> shapes;
  std::vector<PatchBlock<dim>> blocks;
  for (int middle = 0; middle < overlap.n_nodes(); ++middle)
    if (const auto &cells = cells_of_node[middle]; int(cells.size()) == nc) {
      PatchBlock<dim> block;
      block.volume = 0;
      Eigen::MatrixXd place(dim, nc * nc);
      for (const int c : cells) {
        const auto &nodes = overlap.cells[c].nodes;
        const Vector<dim> &size = overlap.mesh.cell_size[overlap.cells[c].cell];
        const int corner = int(std::find(nodes.begin(), nodes.end(), middle) - nodes.begin());
        block.volume += thickness * size.prod();
        for (int a = 0; a < nc; ++a)
          if (std::find(block.nodes.begin(), block.nodes.end(), nodes[a]) == block.nodes.end()) {
            place.col(block.nodes.size()) =
                fem::corner<dim>(size, a) - fem::corner<dim>(size, corner);
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
