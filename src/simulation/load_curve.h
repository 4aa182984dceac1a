// The load of a run over time, as far as it counts: its peak and the stiffness.
#pragma once

#include "core/state.h"
#include "src/output/run_record.h"
#include "src/simulation/test_machine.h"

#include <vector>

namespace ligament::program
{
/// Takes readings until the load has fallen: when something has broken and it is below 10 % of its
/// maximum, while the specimen is at least half as long or short as it was there. What comes later
/// are rebounds (theory.md eq. (E12)).
class LoadCurve
{
public:
  void add(double time, const Reading &reading, std::int64_t n_broken);
  /// A reading between two that are added: the last one counts that is larger than all before.
  void look(double time, const Reading &reading, std::int64_t n_broken);
  /// Later readings don't count.
  void end() { has_ended_ = true; }

  bool has_fallen() const { return has_fallen_; }
  bool has_ended() const { return has_ended_ || has_fallen_; }
  /// N, so far; with its sign.
  double largest_load() const { return load_.empty() ? 0 : load_[largest_]; }

  /// Largest load and its time, the peak when something broke before the end, the stiffness.
  void put_into(RunRecord &record) const;

  void save(core::State &state) const;
  void load(const core::State &state);

private:
  /// Whether it still counts.
  bool takes(const Reading &reading, std::int64_t n_broken);
  void put(double time, const Reading &reading);

  std::vector<double> time_, load_, stress_, strain_;
  std::size_t largest_ = 0; // row
  std::int64_t n_broken_ = 0;
  bool has_fallen_ = false, has_ended_ = false, ends_in_look_ = false;
};
} // namespace ligament::program
