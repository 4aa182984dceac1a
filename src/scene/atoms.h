// A scene whose particles are atoms: the crystal that it means, and what follows from it.
#pragma once

#include "md/thermal_crystal.h"
#include "src/scene/findings.h"
#include "src/scene/scene.h"

namespace ligament::program
{
/// The crystal of a scene with "atoms". Throws core::KeyedError where there is none.
template <int dim>
md::Crystal<dim> crystal_of(const Scene &scene);

/// m: shortest way along an axis after which the crystal repeats itself; 0 where it is longer than
/// `most`.
template <int dim>
double period_along(const md::Crystal<dim> &crystal, int axis, double most);

/// Names of the species of its atoms, that of the crystal first.
std::vector<std::string> species_of(const Scene &scene);

/// kT in J of a scene with "atoms"; 0: no heat.
double thermal_energy_of(const Scene &scene);

/// What its crystal does at its temperature, from runs of a periodic one: once in a process.
template <int dim>
md::ThermalLattice thermal_lattice_of(const Scene &scene);
template <int dim>
md::CubicConstants thermal_constants_of(const Scene &scene);

/// Where the particles are atoms: checks the keys of the crystal and sets what follows from it, the
/// spacing, the constants of the material, and the lengths of periodic sides, which become whole
/// periods of the lattice. Without findings the scene is known to be right.
void resolve_atoms(Scene &scene, Findings *findings);

/// Whether atoms of other species have sites, and keep off the overlap.
void check_substitutions(const Scene &scene, Findings &findings);

/// What a scene of atoms can't have beside them.
void check_atoms(const Scene &scene, Findings &findings);
} // namespace ligament::program
