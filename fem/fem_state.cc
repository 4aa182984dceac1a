// What the finite half remembers, called by names of nodes that do not depend on the zone.
#include "fem/fem_solver.h"

#include "core/check.h"
#include "fem/cell_kernel.h"
#include "fem/corotated_kernel.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::fem
{
namespace
{
/// Nodes of the flanks of a crack lie at one place: they are told apart by where their cells lie,
/// counted from a direction that no flank of a usual crack has.
template <int dim>
void tell_flanks_apart(const Mesh<dim> &mesh, int shift, std::vector<std::int64_t> &names)
{
  std::map<std::int64_t, std::vector<int>> at; // nodes of names that are not alone
  {
    std::vector<std::int64_t> sorted = names;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t k = 1; k < sorted.size(); ++k)
      if (sorted[k] == sorted[k - 1])
        at[sorted[k]];
  }
  if (at.empty())
    return;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (const auto found = at.find(names[i]); found != at.end())
      found->second.push_back(i);
  std::map<int, Vector<dim>> towards; // the cells of a node
  for (const auto &[name, nodes] : at)
    for (const int i : nodes)
      towards[i] = Vector<dim>::Zero();
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    for (const int i : mesh.cells[cell])
      if (const auto found = towards.find(i); found != towards.end())
        found->second += mesh.cell_lower[cell] + mesh.cell_size[cell] / 2 - mesh.nodes[i];
  const auto angle = [&](int i) {
    constexpr double first = -2.9; // rad
    const double a = std::atan2(towards.at(i)[1], towards.at(i)[0]);
    return a < first ? a + 2 * M_PI : a;
  };
  for (auto &[name, nodes] : at) {
    std::sort(nodes.begin(), nodes.end(), [&](int a, int b) { return angle(a) < angle(b); });
    for (std::size_t k = 1; k < nodes.size(); ++k)
      if (mesh.nodes[nodes[k]] == mesh.nodes[nodes[0]])
        names[nodes[k]] += std::int64_t(k) << shift;
  }
}
} // namespace

// A grid of 2^20 intervals per axis over the specimen: far finer than any mesh, the same for all.
template <int dim>
core::Names node_names(const Mesh<dim> &mesh, const Vector<dim> &lower, const Vector<dim> &upper)
{
  constexpr int bits = 20;
  std::vector<std::int64_t> names;
  for (const auto &x : mesh.nodes) {
    std::int64_t name = 0;
    for (int c = dim - 1; c >= 0; --c) {
      const double place = (x[c] - lower[c]) / (upper[c] - lower[c]);
      name = (name << (bits + 1)) + std::lround(place * (1 << bits));
    }
    names.push_back(name);
  }
  if constexpr (dim == 2) // in 3D nothing is left of the bits, and no mesh has cracks
    tell_flanks_apart(mesh, dim * (bits + 1), names);
  return core::Names(std::move(names));
}

template <int dim>
template <typename Solver, typename Visit>
void FemSolver<dim>::for_each_loaded(Solver &solver, const core::Names &names, Visit &&visit)
{
  using Key = std::array<std::int64_t, 3>;
  for (auto &h : solver.held_components_)
    visit(Key{names.name(h.node), h.component, 0}, h);
  for (auto &t : solver.traction_components_)
    visit(Key{names.name(t.node), t.component, 1 + t.load}, t);
}

template <int dim>
void FemSolver<dim>::save(core::State &state, const core::Names &names) const
{
  core::Table nodes(names.sorted());
  names.save(nodes, "displacement", displacement);
  names.save(nodes, "velocity", velocity);
  state["nodes"] = std::move(nodes);

  std::map<std::array<std::int64_t, 3>, std::pair<double, double>> rows;
  for_each_loaded(*this, names, [&](const auto &key, const LoadedComponent &c) {
    rows[key] = {c.old_force, c.old_displacement};
  });
  std::vector<std::int64_t> keys;
  std::vector<double> force, place;
  for (const auto &[key, old] : rows) {
    keys.insert(keys.end(), key.begin(), key.end());
    force.push_back(old.first);
    place.push_back(old.second);
  }
  core::Table loaded(std::move(keys), 3);
  loaded.add("force", force);
  loaded.add("displacement", place);
  state["loaded_nodes"] = std::move(loaded);

  dashpots_.save(state, "far_dashpots", names);
  jumps_.save(state);
  core::save_value(state, "far_field", "external_work", external_work_);
  core::save_value(state, "far_field", "damping_rate", damping_rate_);
  core::save_value(state, "far_field", "step", step_);
  core::save_value(state, "far_field", "support_step", support_step_);
  core::save_value(state, "far_field", "has_forces", std::int64_t(has_previous_forces_));
  core::save_value(state, "far_field", "corotated", std::int64_t(corotated_ != nullptr));
}

template <int dim>
void FemSolver<dim>::load(const core::State &state, const core::Names &names)
{
  const core::Table &nodes = core::table(state, "nodes");
  names.load(nodes, "displacement", displacement);
  names.load(nodes, "velocity", velocity);

  const core::Table &loaded = core::table(state, "loaded_nodes");
  const auto force = loaded.reals("force"), place = loaded.reals("displacement");
  std::map<std::array<std::int64_t, 3>, std::size_t> rows;
  for (std::size_t r = 0; r < loaded.n_rows(); ++r)
    rows[{loaded.keys()[3 * r], loaded.keys()[3 * r + 1], loaded.keys()[3 * r + 2]}] = r;
  for_each_loaded(*this, names, [&](const auto &key, LoadedComponent &c) {
    if (const auto row = rows.find(key); row != rows.end()) {
      c.old_force = force[row->second];
      c.old_displacement = place[row->second];
    }
  });

  dashpots_.load(state, "far_dashpots", names);
  jumps_.load(state);
  external_work_ = core::load_real(state, "far_field", "external_work");
  damping_rate_ = core::load_real(state, "far_field", "damping_rate");
  step_ = core::load_real(state, "far_field", "step");
  support_step_ = core::load_real(state, "far_field", "support_step");
  has_previous_forces_ = core::load_integer(state, "far_field", "has_forces") != 0;
  set_corotated(core::load_integer(state, "far_field", "corotated") != 0);
}

template core::Names node_names(const Mesh<2> &, const Vector<2> &, const Vector<2> &);
template core::Names node_names(const Mesh<3> &, const Vector<3> &, const Vector<3> &);
template void FemSolver<2>::save(core::State &, const core::Names &) const;
template void FemSolver<3>::save(core::State &, const core::Names &) const;
template void FemSolver<2>::load(const core::State &, const core::Names &);
template void FemSolver<3>::load(const core::State &, const core::Names &);
} // namespace ligament::fem
