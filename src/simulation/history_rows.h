// The rows of history.csv: reading of the test machine, energies, crack, gauges, servos.
#pragma once

#include "src/output/history.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/gauges/gauge_set.h"
#include "src/simulation/servo_target.h"
#include "src/simulation/test_machine.h"

#include <optional>

namespace ligament::program
{
/// What a row says besides the body itself.
struct HistoryRow
{
  Reading reading;
  EnergyLedger ledger;
  std::int64_t n_broken = 0;
  double crack_length = 0; // m, m^2 in 3D
  bool is_static = false;
};

/// Of history.csv: those of every run, then those of the gauges. Throws core::KeyedError where a
/// gauge has one that is there already.
template <int dim>
std::vector<Column> all_columns(const Scene &scene, const GaugeSet<dim> &gauges,
                                const std::vector<ServoTarget<dim>> &servos);

template <int dim>
class HistoryRows
{
public:
  /// With `goes_on` behind the rows that are there.
  HistoryRows(const Scene &scene, const RunFolder &folder, const CoupledBody<dim> &body,
              bool goes_on);

  /// The last row may have been written by the look before.
  void add(const CoupledBody<dim> &body, const coupling::StepTime &step, const HistoryRow &row,
           bool is_last = false);
  void flush()
  {
    if (writer_)
      writer_->flush();
  }
  /// All rows are on the disk.
  void sync()
  {
    if (writer_)
      writer_->sync();
  }

  GaugeSet<dim> &gauges() { return gauges_; }
  /// The body was built anew.
  void watch(const Scene &scene, const CoupledBody<dim> &body) { gauges_.watch(scene, body); }

private:
  bool has_phases_, has_tools_, has_flow_, has_viscosity_, has_rebonding_;
  double kelvin_; // k in J/K where atoms have a temperature
  GaugeSet<dim> gauges_;
  std::vector<ServoTarget<dim>> servos_;
  std::optional<HistoryWriter> writer_; // of the first rank
};
} // namespace ligament::program
