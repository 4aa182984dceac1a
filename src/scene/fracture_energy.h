// G_c of faces that soften, from the keys of a scene.
#pragma once

#include "src/scene/scene.h"

namespace ligament::program
{
/// E' of a crack in this body, in Pa.
inline double crack_modulus(const Scene &scene, const MaterialParameters &m)
{
  const bool is_plane_stress = scene.dimension == 2 && scene.plane == PlaneMode::stress;
  return m.youngs_modulus / (is_plane_stress ? 1 : 1 - m.poissons_ratio * m.poissons_ratio);
}

/// In J/m^2; none where bonds break at once: "energy", or what a toughness beside a strength says.
inline std::optional<double> fracture_energy(const Scene &scene, const MaterialParameters &m)
{
  const FractureParameters &f = m.fracture;
  if (f.energy || !f.strength || !f.toughness)
    return f.energy;
  return *f.toughness * *f.toughness / crack_modulus(scene, m);
}
} // namespace ligament::program
