// How the members of an overlap follow the mesh: what the subtracted part of the energy sees.
#pragma once

#include "coupling/overlap.h"

namespace ligament::coupling
{
/// What one node's displacement u does to a member: translation value * u, displacement gradient
/// u (x) gradient.
template <int dim>
struct NodeShare
{
  int node; // near node
  double value;
  Vector<dim> gradient; // 1/m
};

template <int dim>
using InterpolatedMotion = std::vector<NodeShare<dim>>;

/// The motion of every member of the overlap that the subtracted energy sees (theory.md eq. (C3)).
/// Pads move and turn with their cell, as they do in the step. The others turn with the gradient
/// that they and their bonded neighbours see, and move with their cell but for a part of the way to
/// the middle of those neighbours (eq. (C17)). Exact in affine motion, and turns with the mesh.
template <int dim>
std::vector<InterpolatedMotion<dim>>
interpolate_motions(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                    const particles::ParticleForce<dim> &force);
} // namespace ligament::coupling
