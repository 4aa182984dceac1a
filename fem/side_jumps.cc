#include "fem/side_jumps.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::fem
{
template <int dim>
SideJumps<dim>::SideJumps(const Mesh<dim> &mesh, std::vector<core::BoundaryLoad<dim>> loads)
    : loads_(std::move(loads))
{
  for (auto *all : {&jump_, &rate_, &pull_, &old_jump_, &old_pull_})
    all->fill(Vector<dim>::Zero());
  for (std::size_t h = 0; h < mesh.hanging.size(); ++h) {
    const auto &periods = mesh.hanging[h].periods;
    if (std::any_of(periods.begin(), periods.end(), [](double n) { return n != 0; }))
      beyond_.push_back(int(h));
  }
  for (std::size_t l = 0; l < loads_.size(); ++l)
    if (const int axis = loads_[l].jump_axis(); axis >= 0)
      jumps_.push_back({int(l), axis});
  core::require(jumps_.empty() || !beyond_.empty(),
                "a jump is prescribed across sides of the mesh that are not joined");
}

template <int dim>
void SideJumps<dim>::set_time(double t)
{
  if (jumps_.empty())
    return;
  jump_.fill(Vector<dim>::Zero());
  rate_.fill(Vector<dim>::Zero());
  for (const auto &[l, axis] : jumps_)
    for (int c = 0; c < dim; ++c)
      if (loads_[l].value[c]) {
        jump_[axis][c] += loads_[l].displacement(c, t);
        rate_[axis][c] += loads_[l].velocity(c, t);
      }
}

template <int dim>
void SideJumps<dim>::add(const Mesh<dim> &mesh, const PerAxis &jump, Components<dim> &field) const
{
  if (jumps_.empty())
    return;
  for (const int row : beyond_) {
    const HangingNode &h = mesh.hanging[row];
    for (int a = 0; a < dim; ++a)
      for (int c = 0; c < dim; ++c)
        field[c][h.node] += h.periods[a] * jump[a][c];
  }
}

template <int dim>
void SideJumps<dim>::add_jumps(const Mesh<dim> &mesh, Components<dim> &displacement) const
{
  add(mesh, jump_, displacement);
}

template <int dim>
void SideJumps<dim>::add_rates(const Mesh<dim> &mesh, Components<dim> &velocity) const
{
  add(mesh, rate_, velocity);
}

template <int dim>
void SideJumps<dim>::find_reactions(const Mesh<dim> &mesh, const Components<dim> &force)
{
  if (jumps_.empty())
    return;
  pull_.fill(Vector<dim>::Zero());
  for (const int row : beyond_) {
    const HangingNode &h = mesh.hanging[row];
    for (int a = 0; a < dim; ++a)
      for (int c = 0; c < dim; ++c)
        pull_[a][c] -= h.periods[a] * force[c][h.node];
  }
}

// The first load of an axis also has the components that none of its loads names.
template <int dim>
Vector<dim> SideJumps<dim>::reaction(int load) const
{
  Vector<dim> pull = Vector<dim>::Zero();
  const int axis = loads_[load].jump_axis();
  if (axis < 0)
    return pull;
  bool is_first = true;
  std::array<bool, dim> named{};
  for (const auto &[l, of] : jumps_)
    if (of == axis) {
      is_first = is_first && l >= load;
      for (int c = 0; c < dim; ++c)
        named[c] = named[c] || loads_[l].value[c];
    }
  for (int c = 0; c < dim; ++c)
    if (loads_[load].value[c] || (is_first && !named[c]))
      pull[c] = pull_[axis][c];
  return pull;
}

template <int dim>
double SideJumps<dim>::book_work()
{
  double work = 0;
  for (int a = 0; a < dim; ++a)
    work += (pull_[a] + old_pull_[a]).dot(jump_[a] - old_jump_[a]) / 2;
  old_jump_ = jump_;
  old_pull_ = pull_;
  return work;
}

template <int dim>
void SideJumps<dim>::save(core::State &state) const
{
  if (jumps_.empty())
    return;
  for (int a = 0; a < dim; ++a)
    for (int c = 0; c < dim; ++c) {
      const std::string name = std::to_string(a) + "_" + std::to_string(c);
      core::save_value(state, "far_jumps", "displacement_" + name, old_jump_[a][c]);
      core::save_value(state, "far_jumps", "reaction_" + name, old_pull_[a][c]);
      core::save_value(state, "far_jumps", "present_" + name, jump_[a][c]);
    }
}

template <int dim>
void SideJumps<dim>::load(const core::State &state)
{
  if (jumps_.empty())
    return;
  for (int a = 0; a < dim; ++a)
    for (int c = 0; c < dim; ++c) {
      const std::string name = std::to_string(a) + "_" + std::to_string(c);
      old_jump_[a][c] = core::load_real(state, "far_jumps", "displacement_" + name);
      old_pull_[a][c] = core::load_real(state, "far_jumps", "reaction_" + name);
      jump_[a][c] = core::load_real(state, "far_jumps", "present_" + name);
    }
}

template class SideJumps<2>;
template class SideJumps<3>;
} // namespace ligament::fem
