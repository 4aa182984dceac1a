// The law of the discrete zone from its scene: the only place where the program names one.
#pragma once

#include "core/load.h"
#include "core/log.h"
#include "packings/packing.h"
#include "particles/particle_force.h"
#include "src/output/run_record.h"
#include "src/scene/scene.h"

#include <functional>
#include <map>
#include <memory>

namespace ligament::program
{
/// Makes the force of a zone from its packing; adds what it finds on the way (a strength) to the
/// figures of the run, and takes a "toughness_factor" that is there as found. The solid that it
/// stands for is that of elastic_constants_of(). Throws core::InputError where the scene can't be
/// built.
template <int dim>
using ForceMaker = std::function<std::unique_ptr<particles::ParticleForce<dim>>(
    const Scene &, packings::Packing<dim>, const std::vector<core::BoundaryLoad<dim>> &loads,
    std::map<std::string, Figure> &figures, core::Log &)>;

/// The default: the law that the scene asks for.
template <int dim>
std::unique_ptr<particles::ParticleForce<dim>>
make_zone_force(const Scene &scene, packings::Packing<dim> packing,
                const std::vector<core::BoundaryLoad<dim>> &loads,
                std::map<std::string, Figure> &figures, core::Log &log);

/// The many-body law of discrete elements.
template <int dim>
std::unique_ptr<particles::ParticleForce<dim>>
make_many_body_force(const Scene &scene, packings::Packing<dim> packing,
                     const std::vector<core::BoundaryLoad<dim>> &loads,
                     std::map<std::string, Figure> &figures, core::Log &log);

/// The embedded-atom law of a crystal; prints what the crystal is.
template <int dim>
std::unique_ptr<particles::ParticleForce<dim>>
make_atom_force(const Scene &scene, packings::Packing<dim> packing,
                const std::vector<core::BoundaryLoad<dim>> &loads,
                std::map<std::string, Figure> &figures, core::Log &log);

/// The crystal of a scene with atoms, cut to its specimen and zone; the materials of its atoms are
/// species_of() (src/scene/atoms.h).
template <int dim>
packings::Packing<dim> make_crystal_packing(const Scene &scene, core::Log &log);

/// So many rings of ghosts does the law of discrete elements need around the particles of a rank.
template <int dim>
int ghost_rings(const Scene &scene);

/// Of the solid that particles and far field share: the scene's /material, or its crystal.
template <int dim>
particles::ElasticConstants<dim> elastic_constants_of(const Scene &scene);
/// Of one of the scene's materials.
template <int dim>
particles::ElasticConstants<dim> elastic_constants_of(const Scene &scene,
                                                      const MaterialParameters &material);
} // namespace ligament::program
