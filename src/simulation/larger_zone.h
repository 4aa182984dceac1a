// The state of a body, given to one whose discrete zone is larger: particles appear in the motion
// of the mesh whose place they take.
#pragma once

#include "src/simulation/body_state.h"

namespace ligament::program
{
/// `larger`: a body of the same scene but for a zone that contains the old one, with the same step
/// and mesh lines, that no step has moved. What both have goes on as it was; a new particle takes
/// displacement, orientation, velocity and spin from the cell of `old_mesh` in which it lies.
/// Returns how many are new. Throws core::InputError with the reason where the bodies don't fit;
/// energy weights, blocks that may rest and new particles on loaded sides are refused, too.
template <int dim>
int give_state_to_larger(const core::State &state, const fem::Mesh<dim> &old_mesh, double old_dt,
                         CoupledBody<dim> &larger);

/// Between the forces and the kick of the step: what the energy of the motion changed by, from
/// that of the old body with its forces, is booked like a change of regime.
template <int dim>
void book_zone_change(double energy_before, CoupledBody<dim> &larger,
                      const coupling::StepTime &step);
} // namespace ligament::program
