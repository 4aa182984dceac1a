// A body of atoms at a temperature: what is found out before its first step.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// C of the crystal at its temperature, in the axes of space; what is not known yet is found by
/// runs of a periodic crystal (make_atoms.cc).
template <int dim>
Stiffness<dim> thermal_stiffness(const Scene &scene, Reference &reference, core::Log &log);

/// The load of thermal motion, and velocities and places of atoms at their temperature at time 0
/// (theory.md eq. (C30)).
template <int dim>
void start_heat(const Scene &scene, CoupledBody<dim> &body, core::Log &log);

/// Puts into the figures of the body what is known of its heat, also where a run goes on: the error
/// of the thermal load, and C at its temperature in place of that of the crystal at rest.
template <int dim>
void tell_heat(Reference &reference, CoupledBody<dim> &body);
} // namespace ligament::program
