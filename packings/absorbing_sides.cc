#include "packings/absorbing_sides.h"

#include <algorithm>
#include <cmath>

namespace ligament::packings
{
template <int dim>
core::Dashpots<dim> absorbing_dashpots(const Packing<dim> &packing,
                                       const particles::Particles<dim> &particles,
                                       const std::vector<core::BoundaryLoad<dim>> &loads,
                                       double density, double wave_speed_p, double wave_speed_s)
{
  typename core::Dashpots<dim>::Places dashpots;
  for (const auto &load : loads) {
    if (!load.absorbing)
      continue;
    const int axis = load.boundary / 2;
    bool is_reached = false;
    double place = 0;
    for (const auto &face : packing.boundary_faces)
      if (face.boundary == load.boundary) {
        is_reached = true;
        place = packing.centre[axis][face.i] + face.lever[axis];
        for (int c = 0; c < dim; ++c) {
          const double speed = c == axis ? wave_speed_p : wave_speed_s;
          dashpots[{face.i, c}].push_back(
              {core::Dashpot::Kind::face, face.area * density * speed, face.q / speed});
        }
      }
    if (!is_reached)
      continue;
    for (int i = 0; i < packing.size(); ++i) {
      const double depth = load.absorbing_layer - std::abs(packing.centre[axis][i] - place);
      if (depth > 0)
        for (int c = 0; c < dim; ++c)
          dashpots[{i, c}].push_back(
              core::layer_dashpot(particles.mass[i], depth, load.absorbing_layer, wave_speed_p));
    }
  }
  return core::Dashpots<dim>(dashpots);
}

template core::Dashpots<2> absorbing_dashpots(const Packing<2> &, const particles::Particles<2> &,
                                              const std::vector<core::BoundaryLoad<2>> &, double,
                                              double, double);
template core::Dashpots<3> absorbing_dashpots(const Packing<3> &, const particles::Particles<3> &,
                                              const std::vector<core::BoundaryLoad<3>> &, double,
                                              double, double);
} // namespace ligament::packings
