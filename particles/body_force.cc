#include "particles/body_force.h"

#include "core/check.h"
#include "particles/block_sum.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::particles
{
template <int dim>
BodyForce<dim>::BodyForce(const std::vector<core::BoundaryLoad<dim>> &loads)
{
  for (const auto &load : loads)
    if (load.kind == core::BoundaryLoad<dim>::Kind::acceleration)
      loads_.push_back(load);
}

template <int dim>
Vector<dim> BodyForce<dim>::acceleration(double time) const
{
  Vector<dim> sum = Vector<dim>::Zero();
  for (const auto &load : loads_)
    sum += load.traction(time);
  return sum;
}

template <int dim>
void BodyForce<dim>::add_forces(Particles<dim> &particles, double time) const
{
  const Vector<dim> a = acceleration(time);
  for (int c = 0; c < dim; ++c)
    if (a[c] != 0)
      for (const auto &[begin, end] : particles.part.stepped)
        for (int i = begin; i < end; ++i)
          if (std::isfinite(particles.mass[i])) // others are held
            particles.force[c][i] += particles.mass[i] * a[c];
}

template <int dim>
std::vector<int> BodyForce<dim>::blocks(const Particles<dim> &particles)
{
  std::vector<int> first;
  for (const auto &[begin, end] : particles.part.owned)
    for (int i = begin; i < end; i += sum_block)
      first.push_back(i);
  return first;
}

template <int dim>
void BodyForce<dim>::book_work(const Particles<dim> &p, double time)
{
  const Vector<dim> a = acceleration(time), mean = (a + old_acceleration_) / 2;
  std::vector<Vector<dim>> moments;
  for (const auto &[begin, end] : p.part.owned)
    for (int first = begin; first < end; first += sum_block) {
      Vector<dim> moment = Vector<dim>::Zero();
      for (int i = first; i < std::min(first + sum_block, end); ++i)
        if (std::isfinite(p.mass[i])) // others are held
          moment += p.mass[i] * get(p.displacement, i);
      moments.push_back(moment);
    }
  if (is_booked_)
    for (std::size_t b = 0; b < moments.size(); ++b)
      work_.add(mean.dot(moments[b] - old_moment_[b]));
  is_booked_ = true;
  old_acceleration_ = a;
  old_moment_ = std::move(moments);
}

template <int dim>
void BodyForce<dim>::save(core::State &state, const Particles<dim> &particles) const
{
  core::save_sum(state, "body_force_work", work_);
  core::save_value(state, "body_force", "booked", std::int64_t(is_booked_));
  for (int c = 0; c < dim; ++c)
    core::save_value(state, "body_force", "acceleration_" + std::to_string(c),
                     old_acceleration_[c]);
  std::map<std::int64_t, Vector<dim>> moments;
  const std::vector<int> first = blocks(particles);
  for (std::size_t b = 0; b < old_moment_.size(); ++b)
    moments[particles.global_id[first[b]]] = old_moment_[b];
  std::vector<std::int64_t> names;
  Components<dim> columns;
  for (const auto &[name, moment] : moments) {
    names.push_back(name);
    for (int c = 0; c < dim; ++c)
      columns[c].push_back(moment[c]);
  }
  core::Table table(std::move(names));
  for (int c = 0; c < dim; ++c)
    table.add("moment_" + std::to_string(c), columns[c]);
  state["body_force_blocks"] = std::move(table);
}

template <int dim>
void BodyForce<dim>::load(const core::State &state, const Particles<dim> &particles)
{
  work_ = core::load_sum(state, "body_force_work");
  is_booked_ = core::load_integer(state, "body_force", "booked") != 0;
  for (int c = 0; c < dim; ++c)
    old_acceleration_[c] =
        core::load_real(state, "body_force", "acceleration_" + std::to_string(c));
  old_moment_.clear();
  if (!is_booked_)
    return;
  const core::Table &table = core::table(state, "body_force_blocks");
  Components<dim> columns;
  for (int c = 0; c < dim; ++c)
    columns[c] = table.reals("moment_" + std::to_string(c));
  for (const int i : blocks(particles)) {
    const auto name =
        std::lower_bound(table.keys().begin(), table.keys().end(), particles.global_id[i]);
    core::require(name != table.keys().end() && *name == particles.global_id[i],
                  "the state is of a body with other blocks of particles");
    old_moment_.push_back(get(columns, int(name - table.keys().begin())));
  }
}

template class BodyForce<2>;
template class BodyForce<3>;
} // namespace ligament::particles
