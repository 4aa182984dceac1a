// What of a recorder outlives its process and its body.
#include "src/simulation/kept_tables.h"
#include "src/simulation/recorder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ligament::program
{
namespace
{
/// When an output is due that was due then: a run may go on with another interval.
double due_output(double then, double interval, double now)
{
  if (std::isinf(interval))
    return interval;
  return then > now + (1 + 1e-6) * interval ? now + interval : then;
}
} // namespace

template <int dim>
std::map<std::string, std::int64_t> Recorder<dim>::sync()
{
  if (!writes_)
    return {};
  history_.sync();
  std::map<std::string, std::int64_t> sizes;
  for (const std::string &file : {folder_.history(), folder_.log()}) {
    std::error_code none; // the log may have ended early
    const auto size = std::filesystem::file_size(file, none);
    sizes[std::filesystem::path(file).filename()] = none ? 0 : std::int64_t(size);
  }
  return sizes;
}

template <int dim>
void Recorder<dim>::save(core::State &state) const
{
  core::save_value(state, "recorder", "next_history", next_history_);
  core::save_value(state, "recorder", "next_fields", next_fields_);
  core::save_value(state, "recorder", "broken_in_rows", broken_in_rows_);
  core::save_value(state, "recorder", "quasi_static", std::int64_t(quasi_static_));
  core::save_value(state, "recorder", "in_static_phase", std::int64_t(in_static_phase_));
  core::save_value(state, "recorder", "fields_copied_at", fields_copied_at_);
  save_optional(state, "recorder", "broken_time", broken_time_);
  save_optional(state, "recorder", "trusted_until", trusted_until_);
  guard_.save(state);
  path_.save(state);
  curve_.save(state);
  snapshots_.save(state);
  core::save_value(state, "recorder", "largest_residual", extremes_.residual);
  core::save_value(state, "recorder", "largest_work", extremes_.work);
  core::save_value(state, "recorder", "largest_kinetic", extremes_.kinetic);
  save_optional(state, "recorder", "most_work", extremes_.most_work);
  core::Table outputs = numbered_rows(fields_.times().size());
  outputs.add("time", fields_.times());
  state.emplace("field_outputs", std::move(outputs));
  save_optional(state, "recorder", "peak",
                fields_copied_at_ != 0 ? std::optional(peak_state_.time) : std::nullopt);
  save_optional(state, "recorder", "broken",
                break_state_ ? std::optional(break_state_->time) : std::nullopt);
}

template <int dim>
std::vector<KeptState> Recorder<dim>::kept(const CoupledBody<dim> &body) const
{
  const auto names = BodyNames<dim>::at_first(body);
  std::vector<KeptState> states = snapshots_.kept(body, names);
  const auto add = [&](const char *kind, const BodyState &own) {
    states.push_back({kept_name(kind, own.time), [&body, &own, names] {
                        BodyState state = own;
                        gather_at_first(body, state);
                        return body.ranks.is_first() ? save_fields<dim>(state, *names)
                                                     : core::State();
                      }});
  };
  if (fields_copied_at_ != 0)
    add("peak", peak_state_);
  if (break_state_)
    add("broken", *break_state_);
  return states;
}

template <int dim>
void Recorder<dim>::load(const core::State &state, const std::map<std::string, core::State> &kept,
                         const CoupledBody<dim> &body, double now)
{
  next_history_ =
      due_output(core::load_real(state, "recorder", "next_history"), history_interval_, now);
  next_fields_ = due_output(core::load_real(state, "recorder", "next_fields"),
                            scene_.output.field_interval, now);
  broken_in_rows_ = core::load_integer(state, "recorder", "broken_in_rows");
  quasi_static_ = core::load_integer(state, "recorder", "quasi_static") != 0;
  in_static_phase_ = core::load_integer(state, "recorder", "in_static_phase") != 0;
  fields_copied_at_ = core::load_real(state, "recorder", "fields_copied_at");
  broken_time_ = load_optional(state, "recorder", "broken_time");
  trusted_until_ = load_optional(state, "recorder", "trusted_until");
  guard_.load(state);
  path_.load(state);
  curve_.load(state);
  extremes_.residual = core::load_real(state, "recorder", "largest_residual");
  extremes_.work = core::load_real(state, "recorder", "largest_work");
  extremes_.kinetic = core::load_real(state, "recorder", "largest_kinetic");
  extremes_.most_work = load_optional(state, "recorder", "most_work");
  load_copies(state, kept, body);
  const std::vector<double> written = core::table(state, "field_outputs").reals("time");
  if (!writes_)
    fields_.count_on(written);
  else if (fields_.times().empty()) // else they are its own
    fields_.go_on(written, body.zone != nullptr, body.far != nullptr);
}

template <int dim>
void Recorder<dim>::load_copies(const core::State &state,
                                const std::map<std::string, core::State> &kept,
                                const CoupledBody<dim> &body)
{
  BodyNames<dim> names(body);
  snapshots_.load(state, kept, names);
  const auto take = [&](const char *kind) -> std::optional<BodyState> {
    const auto time = load_optional(state, "recorder", kind);
    const auto found = time ? kept.find(kept_name(kind, *time)) : kept.end();
    if (found == kept.end())
      return {};
    BodyState taken = load_fields(found->second, names, present_state(body, 0));
    taken.time = *time;
    return taken;
  };
  if (auto peak = take("peak"))
    peak_state_ = std::move(*peak);
  else
    fields_copied_at_ = 0; // another copy is due
  break_state_ = take("broken");
}

template <int dim>
void Recorder<dim>::watch(const CoupledBody<dim> &body)
{
  core::State seen;
  guard_.save(seen);
  guard_ = OverlapGuard<dim>(body);
  guard_.load(seen);
  history_.watch(scene_, body);
  state_fields_ = StateFields<dim>();
}

template std::map<std::string, std::int64_t> Recorder<2>::sync();
template void Recorder<2>::save(core::State &) const;
template std::vector<KeptState> Recorder<2>::kept(const CoupledBody<2> &) const;
template void Recorder<2>::load(const core::State &, const std::map<std::string, core::State> &,
                                const CoupledBody<2> &, double);
template void Recorder<2>::load_copies(const core::State &,
                                       const std::map<std::string, core::State> &,
                                       const CoupledBody<2> &);
template void Recorder<2>::watch(const CoupledBody<2> &);
template std::map<std::string, std::int64_t> Recorder<3>::sync();
template void Recorder<3>::save(core::State &) const;
template std::vector<KeptState> Recorder<3>::kept(const CoupledBody<3> &) const;
template void Recorder<3>::load(const core::State &, const std::map<std::string, core::State> &,
                                const CoupledBody<3> &, double);
template void Recorder<3>::load_copies(const core::State &,
                                       const std::map<std::string, core::State> &,
                                       const CoupledBody<3> &);
template void Recorder<3>::watch(const CoupledBody<3> &);
} // namespace ligament::program
