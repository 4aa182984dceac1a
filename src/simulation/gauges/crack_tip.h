// How far a crack has come: the farthest of the faces that hang together with its start.
#pragma once

#include "src/simulation/disjoint_sets.h"
#include "src/simulation/gauges/gauge.h"
#include "src/simulation/gauges/near_places.h"

namespace ligament::program
{
/// Broken faces, and those that initial cracks cut, belong to the crack when a chain of faces leads
/// to its start whose centres lie within two spacings of each other. Its position is that of the
/// farthest face in the direction, seen from the start, in m; its speed the mean one over the
/// smoothing time before, in m/s, by the times at which faces broke.
template <int dim>
class CrackTipGauge : public Gauge<dim>
{
public:
  /// `smoothing` in s.
  CrackTipGauge(const GaugeParameters &gauge, const CoupledBody<dim> &body, double smoothing);

  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override;

private:
  /// A further face joins those near it.
  void add(const Vector<dim> &centre, double time);
  double position_at(double time) const;

  std::string name_;
  Vector<dim> start_, direction_;
  double smoothing_;      // s
  NearPlaces<dim> faces_; // by their centres; the first one is the start
  DisjointSets sets_{0};
  std::vector<double> farthest_;                 // m, of the faces below a root
  std::vector<std::pair<double, double>> steps_; // time and position since then
  std::size_t n_broken_ = 0;
};
} // namespace ligament::program
