// The present state of a body as the output sees it: fields, snapshots, broken faces. Of a body in
// parts each rank has the fields of the particles that it owns, until gather_at_first().
#pragma once

#include "src/output/fields.h"
#include "src/output/snapshot.h"
#include "src/simulation/body_names.h"

namespace ligament::program
{
/// Displacement, velocity, stress of the particles, and what flow has left where a material flows;
/// empty without a zone. StateFields has the others.
template <int dim>
ParticleFields particle_fields(const CoupledBody<dim> &body);

/// The same on the nodes of the far field (stress: mean of the cells around); empty without one.
template <int dim>
CellFields cell_fields(const CoupledBody<dim> &body);

/// The tools that are not gone.
template <int dim>
std::vector<ToolOutline> tool_outlines(const CoupledBody<dim> &body);

/// All ranks call it: of the particles the first one has all then, the others none.
template <int dim>
void gather_at_first(const CoupledBody<dim> &body, BodyState &state);

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
  // Of the particles that the rank owns; found when first needed.
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

/// Of the particles, without a motion; all on the first of several ranks, which all call it.
template <int dim>
Snapshot empty_snapshot(const CoupledBody<dim> &body);

/// All faces broken so far, in the order of breaking. On all ranks at once, which all have them.
template <int dim>
std::vector<BrokenBond> broken_bonds(const CoupledBody<dim> &body);

/// Area of the broken faces seen along that axis along which it is largest, over the thickness: m
/// in 2D, m^2 in 3D.
template <int dim>
double crack_length(const CoupledBody<dim> &body);
} // namespace ligament::program
