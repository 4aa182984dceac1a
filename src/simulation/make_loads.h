// From the loads of a scene to those that both models read.
#pragma once

#include "core/load.h"
#include "src/scene/scene.h"

namespace ligament::program
{
core::TimeFunction time_function_of(const History &history, double ramp);

/// Where a load acts on the surface of the specimen; zeros for those that act on no side.
template <int dim>
struct LoadPlace
{
  Vector<dim> middle = Vector<dim>::Zero(); // m, of the part of the side
  double area = 0, side_area = 0;           // m^2, of the part and of all of the side
};

template <int dim>
std::vector<LoadPlace<dim>> load_places(const Scene &scene,
                                        const std::vector<core::BoundaryLoad<dim>> &loads);

/// Those of the scene's list in its order, and behind them the body force if there is one. A force
/// is spread over its part of the side; one at a point over a thousandth of a cell there.
template <int dim>
std::vector<core::BoundaryLoad<dim>> make_loads(const Scene &scene);

/// Area in m^2 of the part of its side on which the load acts.
template <int dim>
double loaded_area(const Scene &scene, const core::BoundaryLoad<dim> &load);
} // namespace ligament::program
