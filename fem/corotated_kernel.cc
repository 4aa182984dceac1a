#include "fem/corotated_kernel.h"

#include "fem/cell_classes.h"

#include <algorithm>
#include <cmath>

namespace ligament::fem
{
template <int dim>
CorotatedKernel<dim>::CorotatedKernel(const Mesh<dim> &mesh, const Body<dim> &body,
                                      const std::vector<char> &is_own,
                                      std::shared_ptr<const core::HyperelasticLaw<dim>> law)
    : law_(std::move(law))
{
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    if (!is_own[cell] || !mesh.is_box(cell))
      continue;
    const Vector<dim> &h = mesh.cell_size[cell];
    auto group = std::find_if(groups_.begin(), groups_.end(), [&](const Group &g) {
      return ((g.size - h).array().abs() <= 1e-12 * h.array()).all();
    });
    if (group == groups_.end())
      group = groups_.insert(groups_.end(),
                             {h, CellShape<dim>(h), cell_stiffness<dim>(h, body), {}, {}});
    group->cells.push_back(mesh.cells[cell]);
  }
  const int n_box_groups = int(groups_.size());
  CellClasses<dim> classes;
  for (int cell = 0; cell < mesh.n_cells() && !mesh.general.empty(); ++cell) {
    if (!is_own[cell] || mesh.is_box(cell))
      continue;
    const CellVectors<dim> corners = cell_corners(mesh, cell);
    const int group = n_box_groups + classes.number(corners);
    if (group == int(groups_.size()))
      groups_.push_back({mesh.cell_size[cell],
                         CellShape<dim>(corners),
                         cell_stiffness<dim>(corners, body),
                         {},
                         {}});
    groups_[group].cells.push_back(mesh.cells[cell]);
  }
  for (Group &group : groups_)
    if (law_) {
      group.mean = CellMean<dim>(group.shape.corner, body.thickness);
      group.stiffness = deviation_stiffness(group.stiffness, group.mean, body);
    }
}

template <int dim>
double CorotatedKernel<dim>::subtract_forces(const Components<dim> &displacement,
                                             Components<dim> &force, bool wants_energy) const
{
  double energy = 0;
  CellVectors<dim> u, f;
  for (const Group &group : groups_)
    for (const auto &nodes : group.cells) {
      for (int a = 0; a < n_cell_nodes<dim>; ++a)
        for (int c = 0; c < dim; ++c)
          u(c, a) = displacement[c][nodes[a]];
      energy += law_ ? strained_cell<dim>(*law_, group.mean, group.stiffness, group.shape, u, f,
                                          wants_energy)
                     : corotated_cell<dim>(group.stiffness, group.shape, u, f);
      for (int a = 0; a < n_cell_nodes<dim>; ++a)
        for (int c = 0; c < dim; ++c)
          force[c][nodes[a]] += f(c, a);
    }
  return energy;
}

template <int dim>
void CorotatedKernel<dim>::subtract_product(const Components<dim> &displacement,
                                            const Components<dim> &v, Components<dim> &force) const
{
  if (groups_.empty())
    return;
  double largest = 0;
  for (const auto &component : v)
    for (const double x : component)
      largest = std::max(largest, std::abs(x));
  if (largest == 0)
    return;
  const double step = 1e-5 * groups_.front().size.minCoeff() / largest;
  for (const double sign : {1., -1.}) {
    Components<dim> u = displacement, f;
    for (int c = 0; c < dim; ++c) {
      f[c].assign(u[c].size(), 0.);
      for (std::size_t i = 0; i < u[c].size(); ++i)
        u[c][i] += sign * step * v[c][i];
    }
    subtract_forces(u, f, false);
    for (int c = 0; c < dim; ++c)
      for (std::size_t i = 0; i < u[c].size(); ++i)
        force[c][i] += sign / (2 * step) * f[c][i];
  }
}

template class CorotatedKernel<2>;
template class CorotatedKernel<3>;
} // namespace ligament::fem
