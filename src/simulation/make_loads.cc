#include "src/simulation/make_loads.h"

#include "src/scene/body_shape.h"
#include "src/scene/geometry.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
/// Wider than nothing along the side, so that a point has an area.
template <int dim>
core::Part<dim> widened(const Scene &scene, LoadParameters load)
{
  double width = infinity;
  if (scene.zone.spacing > 0)
    width = scene.zone.spacing;
  if (scene.far_field)
    width = std::min(width, scene.far_field->cell_size);
  // Atoms share the area of a side: a point has those within a spacing.
  width *= scene.atoms && !scene.far_field ? 2 : 1e-3;
  if (load.from && load.to && *load.from == *load.to) {
    *load.from -= width / 2;
    *load.to += width / 2;
  }
  for (int c = 0; c < dim; ++c)
    if (c != axis_across(load, dim) && load.within.lower[c] == load.within.upper[c]) {
      load.within.lower[c] -= width / 2;
      load.within.upper[c] += width / 2;
    }
  return part_of<dim>(load);
}
} // namespace

core::TimeFunction time_function_of(const History &history, double ramp)
{
  if (!history.table.empty())
    return core::TimeTable(history.table);
  if (history.pulse) {
    core::Pulse pulse;
    pulse.shape = history.pulse->shape == PulseShape::ricker ? core::Pulse::Shape::ricker
                                                             : core::Pulse::Shape::half_sine;
    pulse.start = history.pulse->start;
    pulse.duration = history.pulse->duration;
    return pulse;
  }
  if (history.cycles)
    return core::Cycles{core::Ramp{ramp}, history.cycles->mean, history.cycles->amplitude,
                        history.cycles->period};
  return core::Ramp{ramp};
}

template <int dim>
double loaded_area(const Scene &scene, const core::BoundaryLoad<dim> &load)
{
  double area = 0;
  for (const auto &face : faces_of<dim>(scene.specimen, load.boundary))
    area += core::face_area<dim>(load.part.clip(face));
  return area * (dim == 2 ? scene.specimen.thickness : 1);
}

template <int dim>
std::vector<core::BoundaryLoad<dim>> make_loads(const Scene &scene)
{
  std::vector<core::BoundaryLoad<dim>> loads;
  for (const auto &parameters : scene.loads) {
    core::BoundaryLoad<dim> load;
    using Kind = typename core::BoundaryLoad<dim>::Kind;
    load.boundary = parameters.boundary;
    load.kind = parameters.kind == LoadKind::velocity       ? Kind::velocity
                : parameters.kind == LoadKind::displacement ? Kind::displacement
                                                            : Kind::traction;
    const bool is_force = parameters.kind == LoadKind::force;
    if (load.jump_axis() < 0)
      load.part = is_force ? widened<dim>(scene, parameters) : part_of<dim>(parameters);
    for (int c = 0; c < dim; ++c)
      load.value[c] = parameters.value[c];
    if (is_force)
      for (auto &component : load.value)
        if (component)
          *component /= loaded_area<dim>(scene, load);
    load.pressure = parameters.pressure;
    load.history = parameters.servo ? core::TimeFunction(core::Steered())
                                    : time_function_of(parameters.history, parameters.ramp);
    load.absorbing = parameters.absorbing;
    load.absorbing_layer = parameters.absorbing_layer;
    loads.push_back(load);
  }
  if (scene.body_force.is_any()) {
    core::BoundaryLoad<dim> load;
    load.boundary = core::BoundaryLoad<dim>::whole_body;
    load.kind = core::BoundaryLoad<dim>::Kind::acceleration;
    for (int c = 0; c < dim; ++c)
      if (scene.body_force.acceleration[c] != 0)
        load.value[c] = scene.body_force.acceleration[c];
    load.history = time_function_of(scene.body_force.history, scene.body_force.ramp);
    loads.push_back(load);
  }
  return loads;
}

template <int dim>
std::vector<LoadPlace<dim>> load_places(const Scene &scene,
                                        const std::vector<core::BoundaryLoad<dim>> &loads)
{
  const double thickness = dim == 2 ? scene.specimen.thickness : 1;
  std::vector<LoadPlace<dim>> places(loads.size());
  const SurfaceFaces<dim> surface(scene.specimen);
  for (std::size_t l = 0; l < loads.size(); ++l) {
    if (loads[l].boundary < 0)
      continue;
    LoadPlace<dim> &place = places[l];
    for (const auto &face : surface.of(loads[l].boundary)) {
      place.side_area += thickness * core::face_area<dim>(face);
      const auto piece = loads[l].part.clip(face);
      if (const double area = thickness * core::face_area<dim>(piece); area > 0) {
        place.middle += area * core::face_centroid<dim>(piece);
        place.area += area;
      }
    }
    if (place.area > 0)
      place.middle /= place.area;
  }
  return places;
}

template std::vector<LoadPlace<2>> load_places(const Scene &,
                                               const std::vector<core::BoundaryLoad<2>> &);
template std::vector<LoadPlace<3>> load_places(const Scene &,
                                               const std::vector<core::BoundaryLoad<3>> &);
template double loaded_area(const Scene &, const core::BoundaryLoad<2> &);
template double loaded_area(const Scene &, const core::BoundaryLoad<3> &);
template std::vector<core::BoundaryLoad<2>> make_loads(const Scene &);
template std::vector<core::BoundaryLoad<3>> make_loads(const Scene &);
} // namespace ligament::program
