// Gauges of strain and stress, at a point or averaged over a box.
#pragma once

#include "src/simulation/gauges/gauge.h"
#include "src/simulation/gauges/motion_reading.h"

#include <optional>

namespace ligament::program
{
/// Strain U - 1 of F = R U, the deformation gradient of the motion at the point or of the one that
/// fits the box: what a gauge measures that is glued on and turns with the body, for small
/// rotations the small strain. Shears are those of the tensor. In the axes of the gauge.
template <int dim>
class StrainGauge : public Gauge<dim>
{
public:
  StrainGauge(const GaugeParameters &gauge, const GaugePlaces<dim> &places);

  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override { return description_; }

private:
  std::string name_, description_;
  double angle_; // rad
  std::optional<PointMotion<dim>> point_;
  MotionReading<dim> box_; // without a point
};

/// Stress: the mean over a box, each particle by its volume, cells by the strain of their nodes; at
/// a point that of the nearest particle, or of the mesh. In the axes of the gauge, which stay.
template <int dim>
class StressGauge : public Gauge<dim>
{
public:
  StressGauge(const GaugeParameters &gauge, const GaugePlaces<dim> &places);

  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override { return description_; }

private:
  struct Share
  {
    int item;
    double share; // of the volume
  };
  std::string name_, description_;
  double angle_; // rad
  std::vector<Share> particles_;
  std::size_t n_particles_ = 0; // on all ranks
  double mesh_share_ = 0;
  MotionReading<dim> mesh_; // whose gradient is the mean over the part of the mesh
};
} // namespace ligament::program
