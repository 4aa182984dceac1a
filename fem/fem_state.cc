// What the finite half remembers, called by names of nodes that do not depend on the zone.
#include "fem/fem_solver.h"

#include "core/check.h"
#include "fem/cell_kernel.h"
#include "fem/corotated_kernel.h"

#include <cmath>
#include <map>

namespace ligament::fem
{
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
