// A bar of lattice packing and mesh that repeats itself sideways: bodies in which plane waves stay
// plane.
#pragma once

#include "coupling/bridging_domain.h"
#include "coupling/fine_scale_split.h"
#include "dem/material.h"
#include "packings/periodic_lattice.h"

#include <array>
#include <limits>

namespace ligament::program
{
/// Cubes of edge `size` from `lower` on along the last axis, `across` of them and periodic
/// sideways; behind the layer `fine` each is higher by the factor `growth` than the one before, up
/// to twice the size.
template <int dim>
fem::Mesh<dim> make_periodic_mesh(const packings::Across<dim> &across, int layers, double size,
                                  double lower, int fine = 0, double growth = 1);

/// The same in 2D with cells of twice the size from the layer `fine` on, `coarse` layers of them;
/// `across` is even.
fem::Mesh<2> make_graded_mesh(int across, int fine, int coarse, double size, double lower);

struct StripParameters
{
  dem::DemMaterial material;
  int fine_layers = 0; // of cells, before they double (2D) or grow; 0: they never do
  double growth =
      1; // of their heights, each against the one before, up to twice the size; 1: they double
  int cells_across = 3; // the patch fit's blocks of two cells need three
  int cell_size = 4;    // r: whole, so that the period fits the packing sideways
  int overlap_cells = 3;
  int transition_cells = 6;
  double zone_length;    // without the overlap
  double far_length;     // without the overlap
  double mesh_shift = 0; // from where the mesh ends level with the edge of the packing; layers
  double step_fraction = 0.9;
  coupling::Scheme scheme = coupling::Scheme::fine_scale_split;
  coupling::WeightShape weight = coupling::WeightShape::cubic;
  coupling::FineScaleSplitParameters split;    // of that scheme
  coupling::BridgingDomainParameters bridging; // of the others; `scheme` holds
};

/// Hexagonal (2D) or FCC (3D) packing below, mesh above, in units of the particle spacing. The
/// mesh begins at `mesh_begin` on the last axis; layers of the packing lie at no fraction of a
/// cell.
template <int dim>
struct Strip
{
  std::unique_ptr<particles::ParticleSolver<dim>> zone;
  std::unique_ptr<fem::FemSolver<dim>> far;
  std::unique_ptr<core::Timers> timers;
  std::unique_ptr<coupling::Coupler<dim>> coupler;
  double dt = 0;        // step_fraction of the stable one or of dt_limit
  double dt_stable = 0; // of the discrete side, energy weights included
  double mesh_begin = 0;

  coupling::Bodies<dim> bodies() const { return {zone.get(), far.get()}; }
};

/// J, without what dampers took.
inline double mechanical_energy(const coupling::CoupledEnergy &e)
{
  return e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended;
}

template <int dim>
Strip<dim> make_strip(const StripParameters &parameters);

/// The packing of that bar.
template <int dim>
struct LatticeBar
{
  packings::LatticeKind kind =
      dim == 2 ? packings::LatticeKind::hexagonal : packings::LatticeKind::fcc;
  int layers;
  double edge;
};
template <int dim>
LatticeBar<dim> lattice_bar(const StripParameters &parameters);

/// The same of any packing of spacing 1, periodic sideways, whose edge lies at `edge` on the last
/// axis; its stable step is at most `dt_limit`.
template <int dim>
Strip<dim> make_strip(const StripParameters &parameters, packings::Packing<dim> packing,
                      double edge, double dt_limit = std::numeric_limits<double>::infinity());
} // namespace ligament::program
