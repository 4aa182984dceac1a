// Small bodies for verification, built from scenes by the set-up of `run`; units of the spacing d,
// Young's modulus and the density.
#pragma once

#include "core/extremes.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// A discrete specimen of this size, centred at the origin: hexagonal (2D) or FCC (3D), d = 1.
Scene unit_scene(int dimension, const Point &size, double poissons_ratio);

/// Far field around a zone of this size (0: through the specimen), undamped overlap of three cells.
void add_far_field(Scene &scene, const Point &zone_size, double cell_size);

/// Traction sigma n, sigma in Voigt order, on these sides of the specimen (2 * axis + upper),
/// growing from 0 to full between t = 0 and 1.
template <int dim>
void add_tractions(Scene &scene, const std::vector<int> &sides, const Strain<dim> &stress);

/// A body with the log and the clocks that it needs.
template <int dim>
struct UnitBody
{
  explicit UnitBody(const Scene &scene) : body(make_body<dim>(scene, log, timers)) {}

  core::Log log;
  core::Timers timers;
  CoupledBody<dim> body;

  double c11() const { return body.force()->elastic_constants().stiffness(0, 0); }
};
} // namespace ligament::program
