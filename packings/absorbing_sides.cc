#include "packings/absorbing_sides.h"

#include <cmath>
#include <optional>

namespace ligament::packings
{
namespace
{
/// Where a side lies along its axis, by its face of the last particle; none: no particle has one.
/// Whatever the number of ranks, which all ask, to the last bit.
template <int dim>
std::optional<double> place_of(const Packing<dim> &packing, int boundary,
                               const particles::Part &part, const core::Ranks &ranks)
{
  const int axis = boundary / 2;
  const BoundaryFace<dim> *last = nullptr;
  for (const auto &face : packing.boundary_faces)
    if (face.boundary == boundary && part.owns(face.i) && (!last || face.i >= last->i))
      last = &face;
  std::vector<double> place;
  if (last)
    place = {packing.centre[axis][last->i] + last->lever[axis]};
  place = ranks.gather_all(place); // ranks follow each other in the order of the particles
  return place.empty() ? std::nullopt : std::optional(place.back());
}
} // namespace

template <int dim>
core::Dashpots<dim>
absorbing_dashpots(const Packing<dim> &packing, const particles::Particles<dim> &particles,
                   const std::vector<core::BoundaryLoad<dim>> &loads,
                   const std::vector<SideMedium<dim>> &media, const core::Ranks &ranks)
{
  const auto medium = [&](int i) -> const SideMedium<dim> & {
    return media[media.size() > 1 && !packing.material.empty() ? packing.material[i] : 0];
  };
  const particles::Part &part = particles.part;
  typename core::Dashpots<dim>::Places dashpots;
  for (const auto &load : loads) {
    if (!load.absorbing)
      continue;
    const int axis = load.boundary / 2;
    const auto place = place_of(packing, load.boundary, part, ranks);
    if (!place)
      continue;
    for (const auto &face : packing.boundary_faces)
      if (face.boundary == load.boundary && particles::contains(part.stepped, face.i))
        for (int c = 0; c < dim; ++c) {
          const auto &[density, speeds] = medium(face.i);
          const double speed = speeds.across[axis][c];
          dashpots[{face.i, c}].push_back(
              {core::Dashpot::Kind::face, face.area * density * speed, face.q / speed});
        }
    particles::for_each(part.stepped, [&](int i) {
      const double depth = load.absorbing_layer - std::abs(packing.centre[axis][i] - *place);
      if (depth > 0)
        for (int c = 0; c < dim; ++c)
          dashpots[{i, c}].push_back(core::layer_dashpot(
              particles.mass[i], depth, load.absorbing_layer, medium(i).speeds.across[axis][axis]));
    });
  }
  return core::Dashpots<dim>(dashpots, [&](int i) { return part.owns(i); });
}

template core::Dashpots<2> absorbing_dashpots(const Packing<2> &, const particles::Particles<2> &,
                                              const std::vector<core::BoundaryLoad<2>> &,
                                              const std::vector<SideMedium<2>> &,
                                              const core::Ranks &);
template core::Dashpots<3> absorbing_dashpots(const Packing<3> &, const particles::Particles<3> &,
                                              const std::vector<core::BoundaryLoad<3>> &,
                                              const std::vector<SideMedium<3>> &,
                                              const core::Ranks &);
} // namespace ligament::packings
