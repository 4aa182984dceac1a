// All gauges of a run.
#pragma once

#include "src/output/run_record.h"
#include "src/simulation/gauges/gauge.h"

#include <memory>

namespace ligament::program
{
/// Time over which the speed of a crack is a mean where a scene of this duration does not say it.
double default_smoothing(double duration);

template <int dim>
class GaugeSet
{
public:
  /// core::KeyedError where a gauge has nothing to measure.
  GaugeSet(const Scene &scene, const CoupledBody<dim> &body);

  /// Of all gauges.
  const std::vector<Column> &columns() const { return columns_; }
  /// Their values, between forces and kick.
  std::vector<double> read(const CoupledBody<dim> &body, double time);
  /// Names, kinds, columns, and from what they read.
  const std::vector<GaugeEntry> &entries() const { return entries_; }
  /// From now on of a body built anew; what they read is said of the one before any bond broke.
  void watch(const Scene &scene, const CoupledBody<dim> &body);
  /// What they leave behind besides columns.
  void write(const CoupledBody<dim> &body, const RunFolder &folder);

private:
  void add(const std::string &name, const std::string &kind, std::unique_ptr<Gauge<dim>> gauge);

  std::vector<std::unique_ptr<Gauge<dim>>> gauges_;
  std::vector<Column> columns_;
  std::vector<GaugeEntry> entries_;
};
} // namespace ligament::program
