#include "src/simulation/load_curve.h"

#include "src/analysis/curve.h"
#include "src/simulation/kept_tables.h"

#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double noise_share = 1e-6; // of a load that comes later
} // namespace

bool LoadCurve::takes(const Reading &reading, std::int64_t n_broken)
{
  if (has_ended())
    return false;
  const double largest = largest_load();
  const double along = largest < 0 ? -reading.load : reading.load;
  // Before the test begins there is noise alone.
  const bool is_noise = std::abs(largest) <= noise_share * std::abs(reading.load);
  has_fallen_ = n_broken > 0 && !is_noise && along < fallen_share * std::abs(largest) &&
                !is_let_go(reading.strain, strain_[largest_]);
  if (!has_fallen_)
    n_broken_ = n_broken;
  return !has_fallen_;
}

void LoadCurve::put(double time, const Reading &reading)
{
  const double largest = largest_load();
  time_.push_back(time);
  load_.push_back(reading.load);
  stress_.push_back(reading.stress);
  strain_.push_back(reading.strain);
  if (std::abs(reading.load) > std::abs(largest))
    largest_ = load_.size() - 1;
}

void LoadCurve::add(double time, const Reading &reading, std::int64_t n_broken)
{
  if (!takes(reading, n_broken))
    return;
  put(time, reading);
  ends_in_look_ = false;
}

void LoadCurve::look(double time, const Reading &reading, std::int64_t n_broken)
{
  if (!takes(reading, n_broken) || !(std::abs(reading.load) > std::abs(largest_load())))
    return;
  if (ends_in_look_)
    for (auto *column : {&time_, &load_, &stress_, &strain_})
      column->pop_back();
  largest_ = 0; // it may have been the last one
  put(time, reading);
  largest_ = load_.size() - 1;
  ends_in_look_ = true;
}

void LoadCurve::put_into(RunRecord &record) const
{
  if (largest_load() == 0)
    return;
  record.largest_load = load_[largest_];
  record.largest_stress = stress_[largest_];
  record.largest_time = time_[largest_];
  record.stiffness = fit_stiffness(strain_, stress_, largest_);
  if (n_broken_ == 0 && !has_fallen_)
    return;
  record.peak_load = record.largest_load;
  record.peak_stress = record.largest_stress;
  record.peak_time = record.largest_time;
}

void LoadCurve::save(core::State &state) const
{
  core::Table rows = numbered_rows(time_.size());
  rows.add("time", time_);
  rows.add("load", load_);
  rows.add("stress", stress_);
  rows.add("strain", strain_);
  state.emplace("load_curve", std::move(rows));
  core::save_value(state, "recorder", "largest_load_row", std::int64_t(largest_));
  core::save_value(state, "recorder", "curve_broken", n_broken_);
  core::save_value(state, "recorder", "curve_fallen", std::int64_t(has_fallen_));
  core::save_value(state, "recorder", "curve_ended", std::int64_t(has_ended_));
  core::save_value(state, "recorder", "curve_ends_in_look", std::int64_t(ends_in_look_));
}

void LoadCurve::load(const core::State &state)
{
  const core::Table &rows = core::table(state, "load_curve");
  time_ = rows.reals("time");
  load_ = rows.reals("load");
  stress_ = rows.reals("stress");
  strain_ = rows.reals("strain");
  largest_ = std::size_t(core::load_integer(state, "recorder", "largest_load_row"));
  n_broken_ = core::load_integer(state, "recorder", "curve_broken");
  has_fallen_ = core::load_integer(state, "recorder", "curve_fallen") != 0;
  has_ended_ = core::load_integer(state, "recorder", "curve_ended") != 0;
  ends_in_look_ = core::load_integer(state, "recorder", "curve_ends_in_look") != 0;
}
} // namespace ligament::program
