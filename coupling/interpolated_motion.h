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

/// The motion of every member of the overlap (theory.md eq. (C3)): its translation is that of its
/// cell; pads also turn with their cell, the others with the gradient that they and their bonded
/// neighbours see. Exact in affine motion.
template <int dim>
std::vector<InterpolatedMotion<dim>>
interpolate_motions(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                    const particles::ParticleForce<dim> &force);
} // namespace ligament::coupling
