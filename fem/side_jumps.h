// Jumps of the displacement across joined sides of a mesh: what they add to nodes, what they pull
// with, and their work.
#pragma once

#include "core/load.h"
#include "core/state.h"
#include "fem/mesh.h"

namespace ligament::fem
{
template <int dim>
class SideJumps
{
public:
  /// Of all loads those that are jumps.
  SideJumps(const Mesh<dim> &mesh, std::vector<core::BoundaryLoad<dim>> loads);

  /// Jumps and their rates at time t (s).
  void set_time(double t);
  /// What hanging nodes have beyond their masters.
  void add_jumps(const Mesh<dim> &mesh, Components<dim> &displacement) const;
  void add_rates(const Mesh<dim> &mesh, Components<dim> &velocity) const;

  /// Of the forces of cells on nodes (N), before hanging ones hand theirs on.
  void find_reactions(const Mesh<dim> &mesh, const Components<dim> &force);
  /// Of a load, in N; zero of one that is no jump.
  Vector<dim> reaction(int load) const;

  /// Work in J since the last call, trapezoidal rule; with the first one as if a jump that is there
  /// at once had come in proportion.
  double book_work();

  void save(core::State &state) const;
  void load(const core::State &state);

private:
  using PerAxis = std::array<Vector<dim>, dim>;

  void add(const Mesh<dim> &mesh, const PerAxis &jump, Components<dim> &field) const;

  std::vector<core::BoundaryLoad<dim>> loads_;
  std::vector<std::array<int, 2>> jumps_; // load and its axis
  std::vector<int> beyond_;               // rows of hanging nodes that lie beyond a side
  PerAxis jump_, rate_, pull_, old_jump_, old_pull_;
};
} // namespace ligament::fem
