#include "src/simulation/load_curve.h"

#include "src/analysis/curve.h"

#include <cmath>

namespace ligament::program
{
void LoadCurve::add(double time, const Reading &reading, std::int64_t n_broken)
{
  if (has_ended())
    return;
  const double largest = largest_load();
  const double along = std::copysign(reading.load, reading.load * largest);
  if (n_broken > 0 && along < fallen_share * std::abs(largest)) {
    has_fallen_ = true;
    return;
  }
  n_broken_ = n_broken;
  time_.push_back(time);
  load_.push_back(reading.load);
  stress_.push_back(reading.stress);
  strain_.push_back(reading.strain);
  if (std::abs(reading.load) > std::abs(largest))
    largest_ = load_.size() - 1;
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
} // namespace ligament::program
