// The present state of a body as the output sees it: fields, snapshots, broken faces. Of a body in
// parts all ranks ask for it at once; the first one gets the fields of all particles, the others
// empty ones.
#pragma once

#include "src/output/fields.h"
#include "src/output/snapshot.h"
#include "src/simulation/body_names.h"

namespace ligament::program
{
/// Displacement, velocity, stress of all particles, and what flow has left where a material flows;
/// empty without a zone. StateFields has the others.
template <int dim>
ParticleFields particle_fields(const CoupledBody<dim> &body);

/// The same on the nodes of the far field (stress: mean of the cells around); empty without one.
template <int dim>
CellFields cell_fields(const CoupledBody<dim> &body);

/// The tools that are not gone.
template <int dim>
std::vector<ToolOutline> tool_outlines(const CoupledBody<dim> &body);

/// Completes states of a body by the fields that never change or that follow from others:
/// equivalent stress, radius, id, material, zone, share of broken faces.
template <int dim>
class StateFields
{
public:
  void complete(const CoupledBody<dim> &body, BodyState &state);

private:
  void add_particle_fields(const CoupledBody<dim> &body, BodyState &state);
  void look_at_what_stays(const CoupledBody<dim> &body);

  bool has_looked_ = false;
  // Of the body's particles; found when first needed.
  std::vector<std::uint8_t> n_faces_; // shared with others
  std::vector<double> material_, zone_;
  std::vector<std::int64_t> names_;
};

/// The values of all fields as tables "particles" and "nodes" whose rows have names.
template <int dim>
core::State save_fields(const BodyState &kept, BodyNames<dim> &names);
/// `like`: the fields of the same body at another time, which receive the values.
template <int dim>
BodyState load_fields(const core::State &state, BodyNames<dim> &names, BodyState like);

/// Of the particles, without a motion.
template <int dim>
Snapshot empty_snapshot(const CoupledBody<dim> &body);

/// All faces broken so far, in the order of breaking.
template <int dim>
std::vector<BrokenBond> broken_bonds(const CoupledBody<dim> &body);

/// Area of the broken faces seen along the axis over the thickness: m in 2D, m^2 in 3D.
template <int dim>
double crack_length(const CoupledBody<dim> &body, int axis);
} // namespace ligament::program
