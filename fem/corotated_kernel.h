// Internal forces of cells that may turn: the far field at large rotation.
#pragma once

#include "fem/strained_cell.h"

#include <memory>

namespace ligament::fem
{
template <int dim>
class CorotatedKernel
{
public:
  /// `is_own[cell]` says which cells take part. With a law they are under finite strain, too.
  CorotatedKernel(const Mesh<dim> &mesh, const Body<dim> &body, const std::vector<char> &is_own,
                  std::shared_ptr<const core::HyperelasticLaw<dim>> law = {});

  /// force -= dE/du, hanging nodes not yet condensed, in N; returns E in J where it is wanted.
  double subtract_forces(const Components<dim> &displacement, Components<dim> &force,
                         bool wants_energy = true) const;

  /// force -= K v, K the stiffness in the state `displacement`, by central differences: exact to
  /// about 1e-8 of it.
  void subtract_product(const Components<dim> &displacement, const Components<dim> &v,
                        Components<dim> &force) const;

private:
  struct Group // cells of one shape
  {
    Vector<dim> size; // m, of the bounding box
    CellShape<dim> shape;
    CellMatrix<dim> stiffness; // with a law: of deviations from the mean
    CellMean<dim> mean;        // only with a law
    std::vector<std::array<int, n_cell_nodes<dim>>> cells; // nodes
  };
  std::shared_ptr<const core::HyperelasticLaw<dim>> law_;
  std::vector<Group> groups_;
};
} // namespace ligament::fem
