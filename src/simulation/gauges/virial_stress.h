// Mean virial stress of the atoms that are their own masters.
#pragma once

#include "src/simulation/gauges/gauge.h"
#include "src/simulation/gauges/motion_reading.h"

namespace ligament::program
{
/// Cauchy's stress of the atoms outside the overlap, all or those that lay in a box, theory.md
/// (G3): half of what each bond bears, and at a temperature the flux of momentum about their mean
/// motion, over their present volume; tension above 0. In the axes of the gauge, which stay.
template <int dim>
class VirialStressGauge : public Gauge<dim>
{
public:
  /// core::InputError where no atoms lie that span all directions.
  VirialStressGauge(const GaugeParameters &gauge, const GaugePlaces<dim> &places);

  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override { return description_; }

private:
  using Matrix = Eigen::Matrix<double, dim, dim>;
  /// Sum of m w (x) w in J, w the velocity beyond that of the affine motion that fits best.
  Matrix momentum_flux(const particles::Particles<dim> &atoms) const;

  std::string name_, description_;
  double angle_; // rad
  bool is_warm_;
  Vector<dim> middle_ = Vector<dim>::Zero(); // m
  double volume_ = 0;                        // m^3, in the reference
  MotionReading<dim> motion_;                // of the atoms, at their middle
};
} // namespace ligament::program
