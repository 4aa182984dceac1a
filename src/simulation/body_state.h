// A body's state, taken and given back: what checkpoints hold, and what a rebuilt body goes on
// from.
#pragma once

#include "core/state.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Between drift and compute_forces of a step in which the far field acts: all forces follow from
/// it.
template <int dim>
core::State take_state(const CoupledBody<dim> &body);

/// Into a body of the same scene that no step has moved; particles and nodes without rows stay at
/// rest. Where blocks rest, let_rest comes before. Then compute_forces, and the loop goes on to the
/// last bit as if nothing had happened.
template <int dim>
void give_state(const core::State &state, CoupledBody<dim> &body);
} // namespace ligament::program
