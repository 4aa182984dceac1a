#include "src/simulation/snapshot_keeper.h"

#include "core/check.h"
#include "src/simulation/body_fields.h"
#include "src/simulation/kept_tables.h"
#include "src/simulation/whole_body.h"

#include <algorithm>
#include <exception>

namespace ligament::program
{
namespace
{
/// Into `m`, whose memory is used again.
template <int dim>
void copy_motion(const CoupledBody<dim> &body, double time, Motion<dim> &m)
{
  const auto &state = body.zone->state;
  m.time = time;
  for (int k = 0; k < dim; ++k) {
    copy_owned(*body.zone, state.displacement[k], m.displacement[k]);
    copy_owned(*body.zone, state.velocity[k], m.velocity[k]);
  }
}

/// All of it on the first rank.
template <int dim>
Motion<dim> at_first(const CoupledBody<dim> &body, Motion<dim> m)
{
  if (!body.ranks.is_one())
    for (auto *values : {&m.displacement, &m.velocity})
      for (auto &component : *values)
        component = body.ranks.gather_at_first(component);
  return m;
}

/// Names and slots of what is kept.
const std::array<std::string, 4> slots = {"snapshot_0", "snapshot_1", "snapshot_2",
                                          "before_snapshot"};

template <int dim>
core::State state_of(const Motion<dim> &m, BodyNames<dim> &names)
{
  core::Table rows(names.particles().sorted());
  names.particles().save(rows, "displacement", m.displacement);
  names.particles().save(rows, "velocity", m.velocity);
  return {{"particles", std::move(rows)}};
}

template <int dim>
Motion<dim> motion_of(const core::State &state, double time, BodyNames<dim> &names)
{
  Motion<dim> m;
  m.time = time;
  for (auto *values : {&m.displacement, &m.velocity})
    for (auto &component : *values)
      component.assign(names.particles().size(), 0.);
  const core::Table &rows = core::table(state, "particles");
  names.particles().load(rows, "displacement", m.displacement);
  names.particles().load(rows, "velocity", m.velocity);
  return m;
}
} // namespace

// With tau from 0 to 1 between the looks and h the half step: u(0), u(1), u'(-h), u'(1 - h) are
// known of u = a + b tau + c tau^2 + e tau^3.
template <int dim>
Motion<dim> between(Motion<dim> before, const Motion<dim> &after, double dt, double time)
{
  const double interval = after.time - before.time, h = dt / (2 * interval),
               tau = (time - before.time) / interval;
  Motion<dim> m = std::move(before); // large, and changed in place
  m.time = time;
  for (int k = 0; k < dim; ++k)
    for (std::size_t i = 0; i < m.displacement[k].size(); ++i) {
      const double rise = after.displacement[k][i] - m.displacement[k][i],
                   v0 = interval * m.velocity[k][i],
                   change = interval * after.velocity[k][i] - v0;
      const double e = (v0 - rise + (0.5 + h) * change) / (0.5 - 3 * h * h),
                   c = 0.5 * change - 1.5 * e * (1 - 2 * h), b = rise - c - e;
      m.displacement[k][i] += tau * (b + tau * (c + tau * e));
      m.velocity[k][i] = (b + tau * (2 * c + 3 * tau * e)) / interval;
    }
  return m;
}

template <int dim>
Motion<dim> in_proportion(const Motion<dim> &before, const Motion<dim> &after, double time)
{
  const double interval = after.time - before.time, share = (time - before.time) / interval;
  Motion<dim> m = before;
  m.time = time;
  for (int k = 0; k < dim; ++k)
    for (std::size_t i = 0; i < m.displacement[k].size(); ++i) {
      const double rise = after.displacement[k][i] - before.displacement[k][i];
      m.displacement[k][i] += share * rise;
      m.velocity[k][i] = rise / interval;
    }
  return m;
}

template <int dim>
void SnapshotKeeper<dim>::look(const CoupledBody<dim> &body, const coupling::StepTime &step,
                               double interval, bool wanted)
{
  if (!body.zone || step.step == 0)
    return;
  // After a jump in time: common times that were jumped over, a copy with which nothing is due.
  const double slack = 0.5 * interval;
  if (next_ == 0 || (!before_ && next_ < step.time - slack))
    next_ = common_time(common_time_index(step.time) + 1);
  if (before_ && (next_ > step.time + slack || step.time - before_->time < slack))
    drop_before();
  if (before_) {
    copy_motion(body, step.time, now_);
    keep(between(std::move(*before_), now_, step.dt, next_));
    before_.reset();
    next_ = common_time(common_time_index(step.time) + 1);
  }
  if (step.time + interval <= next_)
    return;
  if (wanted)
    take_before(body, step.time);
  else
    next_ = common_time(common_time_index(step.time + interval) + 1);
}

template <int dim>
void SnapshotKeeper<dim>::look_at_equilibrium(const CoupledBody<dim> &body,
                                              const coupling::StepTime &step, bool wanted)
{
  if (!body.zone)
    return;
  if (step.time == 0) { // no common time lies before it, and all do after
    take_before(body, 0);
    return;
  }
  const int last = common_time_index(step.time);
  if (before_ && before_->time < step.time) {
    copy_motion(body, step.time, now_);
    for (int k = last - int(kept_.size()) + 1; k <= last; ++k) // no more would be kept
      if (const double time = common_time(k); time > before_->time && time >= next_)
        keep(in_proportion(*before_, now_, time));
  }
  next_ = common_time(last + 1);
  drop_before();
  if (wanted)
    take_before(body, step.time);
}

template <int dim>
void SnapshotKeeper<dim>::take_before(const CoupledBody<dim> &body, double time)
{
  drop_before();
  before_ = std::move(spare_);
  copy_motion(body, time, *before_);
}

template <int dim>
void SnapshotKeeper<dim>::drop_before()
{
  if (before_)
    spare_ = std::move(*before_);
  before_.reset();
}

template <int dim>
void SnapshotKeeper<dim>::keep(Motion<dim> motion)
{
  std::rotate(kept_.begin(), kept_.end() - 1, kept_.end());
  if (kept_[0])
    spare_ = std::move(*kept_[0]);
  kept_[0] = std::move(motion);
}

template <int dim>
void SnapshotKeeper<dim>::write(const CoupledBody<dim> &body, const RunFolder &folder) const
{
  if (!kept_[0])
    return;
  Snapshot snapshot = empty_snapshot(body);
  std::exception_ptr
      refused; // by the disk of the first rank, while others go on to the next motion
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    if (!kept_[k])
      continue;
    const Motion<dim> all = at_first(body, *kept_[k]);
    if (!body.ranks.is_first())
      continue;
    const auto in_turn = [&](const Components<dim> &components) {
      std::vector<double> values;
      for (std::size_t i = 0; i < snapshot.size(); ++i)
        for (int c = 0; c < dim; ++c)
          values.push_back(components[c][i]);
      return values;
    };
    snapshot.time = all.time;
    snapshot.displacement = in_turn(all.displacement);
    snapshot.velocity = in_turn(all.velocity);
    try {
      write_snapshot(folder.snapshots()[k], snapshot);
    } catch (const core::EnvironmentError &) {
      refused = std::current_exception();
    }
  }
  if (refused)
    std::rethrow_exception(refused);
}

template <int dim>
void SnapshotKeeper<dim>::save(core::State &state) const
{
  for (std::size_t s = 0; s < slots.size(); ++s) {
    const auto &m = s < kept_.size() ? kept_[s] : before_;
    save_optional(state, "recorder", slots[s], m ? std::optional(m->time) : std::nullopt);
  }
  core::save_value(state, "recorder", "next_snapshot", next_);
}

template <int dim>
std::vector<KeptState> SnapshotKeeper<dim>::kept(const CoupledBody<dim> &body,
                                                 const std::shared_ptr<BodyNames<dim>> &names) const
{
  std::vector<KeptState> states;
  const auto add = [&](const char *kind, const std::optional<Motion<dim>> &m) {
    if (m)
      states.push_back({kept_name(kind, m->time), [&body, &m, names] {
                          const Motion<dim> all = at_first(body, *m);
                          return body.ranks.is_first() ? state_of(all, *names) : core::State();
                        }});
  };
  for (const auto &m : kept_)
    add("snapshot", m);
  add("before", before_);
  return states;
}

template <int dim>
void SnapshotKeeper<dim>::load(const core::State &state,
                               const std::map<std::string, core::State> &kept,
                               BodyNames<dim> &names)
{
  for (std::size_t s = 0; s < slots.size(); ++s) {
    auto &m = s < kept_.size() ? kept_[s] : before_;
    m.reset();
    const auto time = load_optional(state, "recorder", slots[s]);
    if (!time)
      continue;
    const auto found = kept.find(kept_name(s < kept_.size() ? "snapshot" : "before", *time));
    if (found != kept.end())
      m = motion_of(found->second, *time, names);
  }
  next_ = core::load_real(state, "recorder", "next_snapshot");
}

template Motion<2> between(Motion<2>, const Motion<2> &, double, double);
template Motion<3> between(Motion<3>, const Motion<3> &, double, double);
template Motion<2> in_proportion(const Motion<2> &, const Motion<2> &, double);
template Motion<3> in_proportion(const Motion<3> &, const Motion<3> &, double);
template class SnapshotKeeper<2>;
template class SnapshotKeeper<3>;
} // namespace ligament::program
