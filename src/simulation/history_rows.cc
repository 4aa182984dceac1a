#include "src/simulation/history_rows.h"

#include "core/check.h"
#include "core/keyed_error.h"
#include "src/scene/atoms.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
constexpr int rows_per_flush = 50;

/// Where a material is viscous.
const Column viscous = {"viscous", "J"};
/// Where faces may be bonded again.
const Column rebonding = {"rebonding", "J"};
/// Of atoms at a temperature.
const Column thermostat = {"thermostat", "J"};
const char *const temperatures[] = {"temperature_zone", "temperature_overlap", "temperature_nodes"};

int n_temperatures(const Scene &scene)
{
  return scene.zone.extent == DiscreteZone::Extent::box ? 3 : 1;
}
} // namespace

template <int dim>
std::vector<Column> all_columns(const Scene &scene, const GaugeSet<dim> &gauges,
                                const std::vector<ServoTarget<dim>> &servos)
{
  std::vector<Column> columns = history_columns(dim, scene.time.has_phases(), !scene.tools.empty());
  if (scene.flows())
    for (const auto &channel : EnergyLedger().flow_channels())
      columns.push_back({channel.first, "J"});
  if (scene.is_viscous())
    columns.push_back(viscous);
  if (scene.rebonds())
    columns.push_back(rebonding);
  if (scene.is_warm()) {
    columns.push_back(thermostat);
    for (int k = 0; k < n_temperatures(scene); ++k)
      columns.push_back({temperatures[k], "K"});
  }
  for (const auto &servo : servos)
    columns.push_back(servo.column());
  for (const Column &column : gauges.columns()) {
    const bool is_there = std::any_of(columns.begin(), columns.end(),
                                      [&](const Column &c) { return c.name == column.name; });
    if (is_there)
      throw core::KeyedError("/gauges", fmt::format("a gauge has the column \"{}\"", column.name),
                             "history.csv has a column of that name already", "name it otherwise");
    columns.push_back(column);
  }
  return columns;
}

template <int dim>
HistoryRows<dim>::HistoryRows(const Scene &scene, const RunFolder &folder,
                              const CoupledBody<dim> &body, bool goes_on)
    : has_phases_(scene.time.has_phases()), has_tools_(!scene.tools.empty()),
      has_flow_(scene.flows()), has_viscosity_(scene.is_viscous()), has_rebonding_(scene.rebonds()),
      kelvin_(scene.is_warm() ? thermal_energy_of(scene) / scene.atoms->temperature : 0),
      gauges_(scene, body), servos_(servo_targets(scene, body, gauges_))
{
  const auto columns = all_columns(scene, gauges_, servos_);
  if (body.ranks.is_first())
    writer_.emplace(folder.history(), columns, rows_per_flush, goes_on);
}

template <int dim>
void HistoryRows<dim>::add(const CoupledBody<dim> &body, const coupling::StepTime &step,
                           const HistoryRow &row, bool is_last)
{
  const std::vector<double> values = gauges_.read(body, step.time);
  std::vector<double> errors;
  for (const auto &servo : servos_)
    errors.push_back(servo.measured(body, values) - servo.wanted(step.time));
  if (!writer_) // all ranks have read by now
    return;
  writer_->set("time", step.time);
  writer_->set("step", double(step.step));
  writer_->set("load", row.reading.load);
  writer_->set("stress", row.reading.stress);
  writer_->set("displacement", row.reading.displacement);
  writer_->set("strain", row.reading.strain);
  for (const auto &[name, value] : row.ledger.channels())
    if ((name != "settled" || has_phases_) && (name.compare(0, 5, "tool_") != 0 || has_tools_))
      writer_->set(name, value);
  if (has_flow_)
    for (const auto &[name, value] : row.ledger.flow_channels())
      writer_->set(name, value);
  if (has_viscosity_)
    writer_->set(viscous.name, row.ledger.force.viscous);
  if (has_rebonding_)
    writer_->set(rebonding.name, row.ledger.force.rebonding);
  if (kelvin_ > 0) {
    writer_->set(thermostat.name, row.ledger.body.thermostat);
    const auto energies = body.coupler->thermal_energies(body.bodies());
    for (int k = 0; k < (body.far ? 3 : 1); ++k)
      writer_->set(temperatures[k], energies[k] / kelvin_);
  }
  if (has_phases_)
    writer_->set("static", row.is_static);
  writer_->set("broken_bonds", double(row.n_broken));
  writer_->set("crack_length", row.crack_length);
  for (std::size_t k = 0; k < values.size(); ++k)
    writer_->set(gauges_.columns()[k].name, values[k]);
  for (std::size_t k = 0; k < servos_.size(); ++k)
    writer_->set(servos_[k].column().name, errors[k]);
  if (is_last)
    writer_->end_last_row();
  else
    writer_->end_row();
}

template std::vector<Column> all_columns(const Scene &, const GaugeSet<2> &,
                                         const std::vector<ServoTarget<2>> &);
template std::vector<Column> all_columns(const Scene &, const GaugeSet<3> &,
                                         const std::vector<ServoTarget<3>> &);
template class HistoryRows<2>;
template class HistoryRows<3>;
} // namespace ligament::program
