// The nodes of the cells that a coupler took over, as it sees them: their motion is the far
// field's.
#pragma once

#include "coupling/overlap.h"
#include "fem/fem_solver.h"

namespace ligament::coupling
{
/// Near nodes in the order of Overlap::near_nodes. The far field owns displacement, velocity and
/// force of all its nodes; here they are read and written, and nothing is kept.
template <int dim>
class NearNodes
{
public:
  /// Both must outlive it.
  NearNodes(fem::FemSolver<dim> &far, const std::vector<int> &nodes)
      : far_(&far), nodes_(&nodes), displacement_(nodes.size(), dim), velocity_(nodes.size(), dim)
  {
  }

  /// Near nodes' values of a field of all nodes.
  Nodal<dim> of(const Components<dim> &field) const
  {
    Nodal<dim> values(nodes_->size(), dim);
    read(field, values);
    return values;
  }

  /// U in m, V in m/s at present; valid until the next call of the same.
  const Nodal<dim> &displacement() const { return read(far_->displacement, displacement_); }
  const Nodal<dim> &velocity() const { return read(far_->velocity, velocity_); }

  void set_velocity(const Nodal<dim> &v) { write(v, far_->velocity); }
  /// V += factor v
  void add_velocity(double factor, const Nodal<dim> &v)
  {
    for_each([&](int c, int i, int node) { far_->velocity[c][node] += factor * v(i, c); });
  }
  /// U += dt V
  void drift(double dt)
  {
    for_each(
        [&](int c, int, int node) { far_->displacement[c][node] += dt * far_->velocity[c][node]; });
  }
  /// force += factor times what the far field's own cells and loads exert, in N.
  void add_force(double factor, Nodal<dim> &force) const
  {
    for_each([&](int c, int i, int node) { force(i, c) += factor * far_->force[c][node]; });
  }

  /// Near nodes' values of a field of all nodes.
  void write(const Nodal<dim> &values, Components<dim> &field) const
  {
    for_each([&](int c, int i, int node) { field[c][node] = values(i, c); });
  }

private:
  template <typename Visit>
  void for_each(Visit &&visit) const
  {
    for (int c = 0; c < dim; ++c)
      for (std::size_t i = 0; i < nodes_->size(); ++i)
        visit(c, int(i), (*nodes_)[i]);
  }
  const Nodal<dim> &read(const Components<dim> &field, Nodal<dim> &values) const
  {
    for_each([&](int c, int i, int node) { values(i, c) = field[c][node]; });
    return values;
  }

  fem::FemSolver<dim> *far_;
  const std::vector<int> *nodes_;
  mutable Nodal<dim> displacement_, velocity_; // as read last
};
} // namespace ligament::coupling
