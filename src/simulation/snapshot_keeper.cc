#include "src/simulation/snapshot_keeper.h"

#include "src/simulation/body_fields.h"
#include "src/simulation/kept_tables.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
template <int dim>
Motion<dim> motion(const CoupledBody<dim> &body, double time)
{
  return {time, body.zone->state.displacement, body.zone->state.velocity};
}

template <int dim>
void save_motion(core::State &state, const std::string &name, const std::optional<Motion<dim>> &m)
{
  if (!m)
    return;
  core::save_value(state, name + "_time", "time", m->time);
  core::Table rows = numbered_rows(m->displacement[0].size());
  for (int c = 0; c < dim; ++c) {
    rows.add("displacement_" + std::to_string(c), m->displacement[c]);
    rows.add("velocity_" + std::to_string(c), m->velocity[c]);
  }
  state.emplace(name, std::move(rows));
}

template <int dim>
std::optional<Motion<dim>> load_motion(const core::State &state, const std::string &name)
{
  if (!state.count(name))
    return {};
  Motion<dim> m;
  m.time = core::load_real(state, name + "_time", "time");
  const core::Table &rows = core::table(state, name);
  for (int c = 0; c < dim; ++c) {
    m.displacement[c] = rows.reals("displacement_" + std::to_string(c));
    m.velocity[c] = rows.reals("velocity_" + std::to_string(c));
  }
  return m;
}
} // namespace

// With tau from 0 to 1 between the looks and h the half step: u(0), u(1), u'(-h), u'(1 - h) are
// known of u = a + b tau + c tau^2 + e tau^3.
template <int dim>
Motion<dim> between(const Motion<dim> &before, const Motion<dim> &after, double dt, double time)
{
  const double interval = after.time - before.time, h = dt / (2 * interval),
               tau = (time - before.time) / interval;
  Motion<dim> m = before;
  m.time = time;
  for (int k = 0; k < dim; ++k)
    for (std::size_t i = 0; i < m.displacement[k].size(); ++i) {
      const double rise = after.displacement[k][i] - before.displacement[k][i],
                   v0 = interval * before.velocity[k][i],
                   change = interval * after.velocity[k][i] - v0;
      const double e = (v0 - rise + (0.5 + h) * change) / (0.5 - 3 * h * h),
                   c = 0.5 * change - 1.5 * e * (1 - 2 * h), b = rise - c - e;
      m.displacement[k][i] += tau * (b + tau * (c + tau * e));
      m.velocity[k][i] = (b + tau * (2 * c + 3 * tau * e)) / interval;
    }
  return m;
}

template <int dim>
void SnapshotKeeper<dim>::look(const CoupledBody<dim> &body, const coupling::StepTime &step,
                               double interval, bool wanted)
{
  if (!body.zone || step.step == 0)
    return;
  if (next_ == 0)
    next_ = common_time(common_time_index(step.time) + 1);
  if (before_) {
    std::rotate(kept_.begin(), kept_.end() - 1, kept_.end());
    kept_[0] = between(*before_, motion(body, step.time), step.dt, next_);
    before_.reset();
    next_ = common_time(common_time_index(step.time) + 1);
  }
  if (step.time + interval <= next_)
    return;
  if (wanted)
    before_ = motion(body, step.time);
  else
    next_ = common_time(common_time_index(step.time + interval) + 1);
}

template <int dim>
void SnapshotKeeper<dim>::write(const CoupledBody<dim> &body, const RunFolder &folder) const
{
  for (std::size_t i = 0; i < kept_.size(); ++i)
    if (kept_[i])
      write_snapshot(
          folder.snapshots()[i],
          snapshot<dim>(body, kept_[i]->time, kept_[i]->displacement, kept_[i]->velocity));
}

template <int dim>
void SnapshotKeeper<dim>::save(core::State &state) const
{
  for (std::size_t i = 0; i < kept_.size(); ++i)
    save_motion(state, "snapshot_" + std::to_string(i), kept_[i]);
  save_motion(state, "before_snapshot", before_);
  core::save_value(state, "recorder", "next_snapshot", next_);
}

template <int dim>
void SnapshotKeeper<dim>::load(const core::State &state)
{
  for (std::size_t i = 0; i < kept_.size(); ++i)
    kept_[i] = load_motion<dim>(state, "snapshot_" + std::to_string(i));
  before_ = load_motion<dim>(state, "before_snapshot");
  next_ = core::load_real(state, "recorder", "next_snapshot");
}

template Motion<2> between(const Motion<2> &, const Motion<2> &, double, double);
template Motion<3> between(const Motion<3> &, const Motion<3> &, double, double);
template class SnapshotKeeper<2>;
template class SnapshotKeeper<3>;
} // namespace ligament::program
