// From a scene to the objects that move: the one set-up that run, check and verify share.
#pragma once

#include "core/log.h"
#include "coupling/coupler.h"
#include "src/output/fields.h"
#include "src/output/run_record.h"
#include "src/scene/scene.h"
#include "src/simulation/make_force.h"
#include "src/simulation/make_loads.h"
#include "src/simulation/make_packing.h"
#include "src/simulation/tools/tool_set.h"

namespace ligament::program
{
/// The two halves, what joins them, and the figures of the set-up. Missing halves are null.
template <int dim>
struct CoupledBody
{
  core::Ranks ranks; // of whose parts of it this is one

  std::unique_ptr<particles::ParticleSolver<dim>> zone;
  std::unique_ptr<fem::FemSolver<dim>> far; // whole on all ranks
  /// Of several ranks: all particles of the overlap and those that their forces see, as they are in
  /// the reference.
  std::unique_ptr<particles::ParticleSolver<dim>> whole_overlap;
  std::unique_ptr<coupling::Coupler<dim>> coupler;
  std::unique_ptr<ToolSet<dim>> tools; // null: nothing rigid touches it
  std::vector<core::BoundaryLoad<dim>> loads;
  std::vector<double> loaded_faces;          // m^2, on which each load acts in the zone
  std::vector<LoadPlace<dim>> load_places;   // of each load
  /// Of tractions on sides with names: particles on what each acts on and their neighbours, in
  /// which the motion of that place is read.
  std::vector<std::vector<int>> load_layers;
  /// m^2, of the sides of the box that surface lies on, in the order of boundaries.
  std::array<double, 2 * dim> side_areas{};
  std::optional<packings::Seeds<dim>> seeds; // of an irregular packing

  Vector<dim> lower, upper;            // m, specimen
  double thickness = 1;                // m, 2D
  PlaneMode plane = PlaneMode::strain; // 2D
  double poissons_ratio = 0;
  double spacing = 0;                    // m, d
  double dt = 0;                         // s
  double dt_zone = 0;                    // s, stable step of the discrete side
  double dt_far = 0;                     // s, of the far field's own cells
  double regime_change = 0;              // J, taken by changes of regime so far
  double started = 0;                    // J, kinetic energy that the body began with
  double settled = 0;                    // J, taken by settling into equilibria so far
  std::int64_t n_particles = 0;          // of the zone, on all ranks
  std::int64_t equivalent_particles = 0; // of the pure discrete model
  std::int64_t n_cracked_faces = 0;      // cut by initial cracks
  std::vector<BrokenBond> cut_faces;     // these, as the output lists broken ones
  std::map<std::string, Figure> figures;
  std::vector<SkippedPart> skipped;

  /// Of the zone; null without one.
  particles::ParticleForce<dim> *force() const { return zone ? zone->force.get() : nullptr; }
  coupling::Bodies<dim> bodies() const { return {zone.get(), far.get()}; }
};

/// Throws core::InputError where the scene can't be built: reason and remedy in the message. What
/// `reference` knows is not sought again, the rest is added to it; `timers` must outlive the body.
/// Of several ranks, which all call it, each has its part of the particles: pieces of about equal
/// weight, by weights of the blocks (particles::make_partition), or by their number of particles.
template <int dim>
CoupledBody<dim>
make_body(const Scene &scene, core::Log &log, core::Timers &timers, Reference &reference,
          const ForceMaker<dim> &make_force = make_zone_force<dim>, const core::Ranks &ranks = {},
          const std::vector<std::int64_t> &weights = {});

/// Where nothing is known.
template <int dim>
CoupledBody<dim> make_body(const Scene &scene, core::Log &log, core::Timers &timers,
                           const ForceMaker<dim> &make_force = make_zone_force<dim>)
{
  Reference reference;
  return make_body(scene, log, timers, reference, make_force);
}
} // namespace ligament::program
