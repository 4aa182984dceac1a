#include "dem/many_body_force.h"

#include "particles/block_sum.h"
#include "particles/worse_face.h"

namespace ligament::dem
{
template <int dim>
ManyBodyForce<dim>::ManyBodyForce(const packings::Packing<dim> &packing, const Materials &materials,
                                  std::vector<core::BoundaryLoad<dim>> loads,
                                  const FractureLaw &fracture)
    : surface_(packing, materials, loads), body_(packing, materials, surface_.walls()),
      rows_(body_), slices_(body_),
      strains_(packing, body_, surface_.walls(), surface_.particles()),
      cohesive_(body_, strains_, fracture), interfaces_(body_, strains_),
      contacts_(packing, materials, body_.images()),
      rebonded_(body_, strains_, contacts_, fracture.rebonding, packing.thickness),
      jumps_(body_, loads),
      search_(fracture, body_, interfaces_.members(), packing.global_id, cohesive_),
      evaluation_(body_), trial_(body_), energy_evaluation_(body_), thickness_(packing.thickness)
{
  core::require(!fracture.softens() || fracture.can_soften(),
                "faces soften under maximum tension alone");
  for (const bool is_on : {fracture.falls(), rebonded_.is_on()}) {
    core::require(!is_on || interfaces_.empty(),
                  "faces fall or are bonded again in a body of one elastic material only");
    core::require(!is_on || !body_.images().is_any(),
                  "faces of a body with joined sides neither fall nor are bonded again");
    core::require(!is_on || !strains_.is_viscous(),
                  "faces of a viscous body neither fall nor are bonded again");
  }
  core::require(!fracture.falls() || !strains_.has_law(), "faces of a body that flows don't fall");
  evaluation_.reactions.assign(surface_.n_loads(), Vector<dim>::Zero());
  find_other_particles();
  core::require(interfaces_.empty() || strains_.longest_damping() == 0,
                "dashpots beside the springs need a body of one elastic material");
}

template <int dim>
void ManyBodyForce<dim>::find_other_particles()
{
  std::vector<int> all;
  for (const auto *part : parts_) {
    const auto of = part->particles();
    all.insert(all.end(), of.begin(), of.end());
  }
  body_.set_other_particles(std::move(all));
}

template <int dim>
void ManyBodyForce<dim>::set_energy_weights(const std::vector<double> &weights)
{
  core::require(broken_.all().empty() && !strains_.has_law(),
                "energy weights are set on an intact, elastic body");
  body_.set_energy_weights(weights);
  slices_ = SliceBonds<dim>(body_);
  evaluation_.nearness_version = energy_evaluation_.nearness_version = -1;
  search_.reset(body_);
  find_other_particles();
}

template <int dim>
void ManyBodyForce<dim>::set_coupled_edge(const Particles &p, particles::CoupledEdge<dim> edge)
{
  strains_.keep_elastic(edge.members);
  body_.set_edge(EdgeCells<dim>(std::move(edge), body_.boundary_faces(), body_.materials(), p,
                                body_.energy_weights()));
}

// The pressures at interfaces are solved for together: one that moves moves all, if by next to
// nothing.
template <int dim>
void ManyBodyForce<dim>::set_rest(particles::RestBlocks<dim> *rest)
{
  core::require(!rest || !strains_.has_law() || rest->is_exact(),
                "what is held at rest by a threshold could yield");
  rest_ = rest;
  evaluation_.rest = rest;
  evaluation_.nearness_version = -1;
  if (rest)
    rest->wake(interfaces_.members());
}

template <int dim>
void ManyBodyForce<dim>::begin_strains(const Particles &p, Evaluation<dim> &e) const
{
  e.inelastic = strains_.begin(e.may_flow, time_);
  e.inelastic->energy = e.own_energy;
  surface_.add_strains(p, e);
  rebonded_.add_strains(p, e);
}

// Slices come last: without a lattice they find what the particles answer.
template <int dim>
void ManyBodyForce<dim>::add_other_strains(const Particles &p, Evaluation<dim> &e) const
{
  cohesive_.add_strains(p, e);
  interfaces_.add_strains(p, e);
  slices_.add_strains(p, e);
}

template <int dim>
void ManyBodyForce<dim>::find_other_pressures(const Particles &p, Evaluation<dim> &e) const
{
  jumps_.show(e.has_loads);
  e.pressure.resize(body_.n_particles());
  if (strains_.has_law()) {
    begin_strains(p, e);
    add_other_strains(p, e);
    return;
  }
  if (body_.has_dilatation())
    for (const int i : body_.other_particles())
      e.pressure[i] = 0;
  for (const auto *part : parts_)
    part->add_pressures(p, e);
}

template <int dim>
void ManyBodyForce<dim>::find_pressures(const Particles &p, Evaluation<dim> &e) const
{
  find_other_pressures(p, e);
  rows_.add_pressures(p, e);
  interfaces_.follow_flow(p, e);
  if (body_.has_dilatation())
    body_.edge().complete_pressures(p, e.pressure);
}

template <int dim>
void ManyBodyForce<dim>::find_forces(Particles &p, Evaluation<dim> &e) const
{
  find_other_pressures(p, e);
  find_forces_under(p, e);
}

template <int dim>
void ManyBodyForce<dim>::find_forces_under(Particles &p, Evaluation<dim> &e) const
{
  rows_.set_forces(p, e);
  interfaces_.follow_flow(p, e);
  for (const auto *part : parts_)
    part->add_forces(p, e);
  jumps_.find_reactions(stressed(p, e), contacts_.contacts(), e);
  clear_forces_at_rest(p, e);
}

template <int dim>
void ManyBodyForce<dim>::find_forces_of_step(Particles &p)
{
  Evaluation<dim> &e = evaluation_;
  cohesive_.forget_trial();
  if (strains_.has_law()) {
    jumps_.show(e.has_loads);
    e.pressure.resize(body_.n_particles());
    begin_strains(p, e);
    open_in_flow(p);
    add_other_strains(p, e);
  } else {
    find_other_pressures(p, e);
    if (softens_at_interfaces())
      cohesive_.open_beside(p, time_, e, [&] { find_other_pressures(p, e); });
    else
      cohesive_.open(p, time_, e);
  }
  find_forces_under(p, e);
  cohesive_.book(p, e);
}

// Cells hold the openings as they were, and faces between materials divided by these, while faces
// open.
template <int dim>
void ManyBodyForce<dim>::open_in_flow(const Particles &p)
{
  if (cohesive_.all().empty())
    return;
  using Strains = InelasticStrains<dim>;
  Evaluation<dim> &e = evaluation_;
  std::vector<int> of = cohesive_.particles();
  const bool at_interfaces = softens_at_interfaces();
  if (at_interfaces)
    of.insert(of.end(), interfaces_.members().begin(), interfaces_.members().end());
  std::vector<typename Strains::Matrix> before;
  for (const int i : of)
    before.push_back(Strains::cell_strain(*e.inelastic, i));
  cohesive_.add_strains(p, e);
  if (at_interfaces)
    interfaces_.add_strains(p, e);
  cohesive_.open_in_flow(p, time_, e);
  for (std::size_t k = 0; k < of.size(); ++k)
    Strains::set_cell_strain(*e.inelastic, of[k], before[k]);
}

template <int dim>
bool ManyBodyForce<dim>::softens_at_interfaces() const
{
  if (interfaces_.empty())
    return false;
  const auto of = cohesive_.particles();
  return std::any_of(of.begin(), of.end(), [&](int i) { return interfaces_.is_member(i); });
}

template <int dim>
void ManyBodyForce<dim>::set_loads(double time)
{
  surface_.set_time(time);
  jumps_.set_time(time);
}

template <int dim>
void ManyBodyForce<dim>::find_reactions(const Particles &p, Evaluation<dim> &e) const
{
  surface_.find_reactions(p, e);
  jumps_.find_reactions(stressed(p, e), contacts_.contacts(), e);
}

template <int dim>
void ManyBodyForce<dim>::book_work(const Particles &p)
{
  surface_.book_work(p, evaluation_);
  jumps_.book_work(evaluation_);
}

template <int dim>
void ManyBodyForce<dim>::add_contacts(Particles &p)
{
  if (contacts_.none())
    return;
  contacts_.act(p, dt());
  jumps_.find_reactions(stressed(p, evaluation_), contacts_.contacts(), evaluation_);
  clear_forces_at_rest(p, evaluation_);
}

template <int dim>
void ManyBodyForce<dim>::clear_forces_at_rest(Particles &p, const Evaluation<dim> &e) const
{
  if (!e.rest || e.rest->is_exact() || e.rest->all_awake())
    return;
  const auto clear = [&](int i) {
    if (e.rest->is_awake(i))
      return;
    for (auto &f : p.force)
      f[i] = 0;
    for (auto &t : p.torque)
      t[i] = 0;
  };
  for (const int i : body_.other_particles())
    clear(i);
  for (const auto &contact : contacts_.all()) {
    clear(contact.face.i);
    clear(contact.face.j);
  }
}

template <int dim>
void ManyBodyForce<dim>::compute(Particles &p, double time)
{
  if (time != time_) {
    last_time_ = time_;
    time_ = time;
    broken_.end_step(p, dt());
    rebonded_.begin(p);
  }
  set_loads(time);
  surface_.wake(rest_);
  jumps_.wake(rest_);
  search_.ask(evaluation_, strains_);
  evaluation_.may_flow = true;
  find_forces_of_step(p);
  contacts_.follow_guests(p);
  contacts_.search(p, body_.bonds(), time, rest_);
  add_contacts(p);
  book_work(p);
  if (!broken_.have_broken_at(time) && began_at_ != time)
    look_for_breaks(p);
  rebonded_.look(p, evaluation_.pressure, time);
}

template <int dim>
void ManyBodyForce<dim>::look_for_breaks(Particles &p)
{
  const StressedBody<dim> state = stressed(p, evaluation_);
  search_.clear_by_stress(state, evaluation_);
  if (!ranks().is_one()) {
    look_for_breaks_in_parts(state, p);
    return;
  }
  std::vector<BondId> breaking = cohesive_.torn(), exceeding;
  if (auto found = search_.exceeding_bonds(state); !found.empty())
    for (const auto &bond : search_.breaking(std::move(found), body_))
      exceeding.push_back(bond.id);
  const auto at_once = begin_softening(p, exceeding);
  breaking.insert(breaking.end(), at_once.begin(), at_once.end());
  break_bonds(p, breaking, rebonded_.torn(p, evaluation_.pressure));
}

template <int dim>
double ManyBodyForce<dim>::potential_energy(const Particles &p) const
{
  Evaluation<dim> &e = energy_evaluation_;
  own_energy_.assign(strains_.has_law() ? body_.n_particles() : 0, 0.);
  e.own_energy = own_energy_.data();
  find_other_pressures(p, e);
  rows_.set_energies(p, e, energy_);
  interfaces_.follow_flow(p, e);
  for (const auto *part : parts_)
    part->add_energies(p, e, energy_);
  const core::ExactSum sum = particles::block_sum(p.part.owned, [&](int i) {
    return energy_[i] + body_.volume_energy(i, e.pressure[i]) +
           (own_energy_.empty() ? 0 : own_energy_[i]);
  });
  return ranks().sum(sum).value();
}

template <int dim>
void ManyBodyForce<dim>::stresses(const Particles &p, Components<n_strains<dim>> &stress) const
{
  Evaluation<dim> e(body_);
  find_pressures(p, e);
  stressed(p, e).find_stresses(stress);
}

template <int dim>
void ManyBodyForce<dim>::stresses_out_of_plane(const Particles &p,
                                               std::vector<double> &stress) const
{
  stress.clear();
  if (!body_.is_plane_strain())
    return;
  if (!strains_.has_law()) {
    if (materials().all().size() == 1)
      return; // the base material tells it
    Components<n_strains<dim>> in_plane;
    stresses(p, in_plane);
    stress.resize(p.size());
    for (int i = 0; i < body_.n_particles(); ++i)
      stress[i] = materials().of(i).poissons_ratio * (in_plane[0][i] + in_plane[1][i]);
    return;
  }
  Evaluation<dim> e(body_);
  find_pressures(p, e);
  stress.resize(p.size());
  for (int i = 0; i < body_.n_particles(); ++i) // no guest
    stress[i] = out_of_plane(i, e);
}

template <int dim>
double ManyBodyForce<dim>::out_of_plane(int i, const Evaluation<dim> &e) const
{
  if (!body_.is_plane_strain())
    return 0;
  return e.pressure[i] - 2 * materials().of(i).shear_modulus() * strains_.tensor(i)[2];
}

template <int dim>
std::array<double, 6> ManyBodyForce<dim>::inelastic_strain(const Particles &p, int i) const
{
  const auto turn = Turn<dim>::of(p, i);
  const Eigen::Matrix<double, dim, dim> own = strains_.strain(i);
  const auto turn_columns = [&](const Eigen::Matrix<double, dim, dim> &m) {
    Eigen::Matrix<double, dim, dim> turned = m;
    for (int c = 0; c < dim; ++c)
      turned.col(c) += turn.change(Vector<dim>(m.col(c)));
    return turned;
  };
  // R e R^T: e is symmetric.
  const Eigen::Matrix<double, dim, dim> e = turn_columns(turn_columns(own).transpose());
  if constexpr (dim == 2)
    return {e(0, 0), e(1, 1), strains_.tensor(i)[2], e(0, 1), 0, 0};
  else
    return {e(0, 0), e(1, 1), e(2, 2), e(0, 1), e(1, 2), e(0, 2)};
}

template <int dim>
double ManyBodyForce<dim>::max_tension(const Particles &p, const std::vector<int> &of) const
{
  Evaluation<dim> e(body_);
  find_pressures(p, e);
  return stressed(p, e).max_tension(of);
}

template <int dim>
BondTension<dim> ManyBodyForce<dim>::weakest_bond(const Particles &p,
                                                  const std::vector<int> &of) const
{
  Evaluation<dim> e(body_);
  find_pressures(p, e);
  return search_.weakest_bond(stressed(p, e), of);
}

template <int dim>
Utilisation<dim> ManyBodyForce<dim>::utilisation(const Particles &p,
                                                 const std::vector<Watch> &watch) const
{
  return search_.utilisation(stressed(p, evaluation_), watch);
}

template <int dim>
void ManyBodyForce<dim>::softening(const Particles &p, std::vector<double> &share,
                                   std::vector<double> &opening) const
{
  particles::ForceReport<dim>::softening(p, share, opening);
  for (const auto &bond : broken_.all())
    for (const int i : {bond.i, bond.j})
      share[i] = 1;
  for (const auto &[name, face] : cohesive_.all())
    for (const int i : {face.bond.i, face.bond.j}) {
      share[i] = std::max(share[i], std::min(face.opening.damage, 1.));
      opening[i] = std::max(opening[i], face.opening.jump.norm());
    }
}

template <int dim>
Utilisation<dim> ManyBodyForce<dim>::flow_utilisation(const Particles &p,
                                                      const std::vector<Watch> &watch) const
{
  Utilisation<dim> most;
  if (!can_flow())
    return most;
  std::vector<int> watched;
  for (int i = 0; i < body_.n_particles(); ++i)
    if (watch[i] == Watch::watched && p.part.owns(i))
      watched.push_back(i);
  const auto stress = stressed(p, evaluation_).stresses_of(watched);
  for (std::size_t k = 0; k < watched.size(); ++k) {
    const int i = watched[k];
    const double share =
        dem::flow_share<dim>(materials().of(i).plasticity, stress[k], out_of_plane(i, evaluation_));
    if (const Utilisation<dim> of_this = {share, get(p.reference, i)};
        particles::is_worse(of_this, most))
      most = of_this;
  }
  return most;
}

template <int dim>
particles::ElasticConstants<dim> ManyBodyForce<dim>::elastic_constants() const
{
  return materials().base().template elastic_constants<dim>();
}

template <int dim>
std::vector<core::SkippedPart> ManyBodyForce<dim>::skipped_parts() const
{
  std::vector<core::SkippedPart> skipped;
  if (!body_.has_dilatation())
    skipped.push_back({"dilatation sweep", "Poisson's ratio is 0"});
  if (!can_break())
    skipped.push_back({"bond checks", "no fracture criterion"});
  // A criterion that reads them asks for those of what is near its limit only.
  if (!strains_.has_law() && !search_.reads_stresses())
    skipped.push_back({"stress tensors in the loop",
                       can_break() ? "the criterion reads tractions; tensors are computed for "
                                     "output only"
                                   : "nothing reads them but the output"});
  if (!contacts_.may_touch())
    skipped.push_back(
        {"contacts until a bond breaks", "no initial crack, surfaces of a box alone"});
  return skipped;
}

template class ManyBodyForce<2>;
template class ManyBodyForce<3>;
} // namespace ligament::dem
