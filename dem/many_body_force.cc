#include "dem/many_body_force.h"

#include "dem/bond_law.h"
#include "dem/laws/series_bond.h"

#include <algorithm>

namespace ligament::dem
{
namespace
{
/// Mean face of the whole cells, in m^2; of all cells where none is whole.
template <int dim>
double mean_face_area(const packings::Packing<dim> &packing)
{
  double sum = 0;
  if (!packing.directions.empty()) {
    for (const auto &d : packing.directions)
      sum += d.area;
    return sum / double(packing.directions.size());
  }
  for (const auto &face : packing.faces)
    sum += face.area;
  return packing.faces.empty() ? 0. : sum / double(packing.faces.size());
}
} // namespace

template <int dim>
ManyBodyForce<dim>::ManyBodyForce(packings::Packing<dim> packing, const Materials &materials,
                                  std::vector<core::BoundaryLoad<dim>> loads,
                                  const FractureLaw &fracture)
    : spacing_(packing.spacing), materials_(materials), fracture_(fracture),
      bonds_(packing, materials),
      kernel_(bonds_.directions(), bonds_.segments(), packing.size(),
              materials.base().shear_modulus(), !materials.has_no_dilatation()),
      slices_(bonds_, materials.base().shear_modulus(), false), interfaces_(bonds_),
      surface_(packing, materials, std::move(loads)), contacts_(materials, packing.global_id, packing.size()),
      search_(packing, mean_face_area(packing)), lambda_per_volume_(packing.size())
{
  materials_.base().check();
  for (const auto &wall : surface_.walls())
    wall_share_[wall.i] += wall.area * wall.lever.dot(wall.prescribed.cwiseProduct(wall.normal)) /
                           packing.volume[wall.i];
  if (bonds_.n_directions() == 0)
    volumes_ = packing.volume;
  lay_out_slices();
  for (int i = 0; i < packing.size(); ++i) {
    update_volumetric_stiffness(i, packing.volume[i]);
    double levers = 0;
    bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
      levers += b.area * (i == b.i ? b.lever_i : b.lever_j).norm();
    });
    largest_lever_share_ = std::max(largest_lever_share_, levers / packing.volume[i]);
  }
  for (const auto &face : packing.faces)
    if (face.cracked) {
      Bond<dim> b = BondNetwork<dim>::make_bond(face, materials_, packing.thickness);
      if (face.cut >= 0) {
        contacts_.add_joint(b, face.cut, packing.cuts[face.cut].normal(),
                            get(packing.centre, face.j));
        continue;
      }
      // Closed faces press with nothing, not even with rounding: that would be a load from the
      // start.
      const Vector<dim> between = get(packing.centre, b.j) - get(packing.centre, b.i);
      b.distance = std::min(b.distance, between.norm());
      contacts_.add(b, true);
    }
  boundary_faces_ = std::move(packing.boundary_faces);
  find_largest_size_factor();
}

template <int dim>
void ManyBodyForce<dim>::lay_out_slices()
{
  slices_ = BondSlices<dim>(bonds_, materials_.base().shear_modulus(), bonds_.n_directions() == 0);
  screen_.clear();
  if (!volumes_.empty())
    slices_.set_volumes(bonds_, volumes_, energy_weights_);
  records_ = {};
  find_other_particles();
}

template <int dim>
void ManyBodyForce<dim>::find_other_particles()
{
  other_particles_ = slices_.particles();
  const auto loaded = surface_.particles();
  other_particles_.insert(other_particles_.end(), loaded.begin(), loaded.end());
  const auto &joined = interfaces_.members();
  other_particles_.insert(other_particles_.end(), joined.begin(), joined.end());
  for_each_plastic([&](int i) { other_particles_.push_back(i); });
  std::sort(other_particles_.begin(), other_particles_.end());
  other_particles_.erase(std::unique(other_particles_.begin(), other_particles_.end()),
                         other_particles_.end());
}

template <int dim>
void ManyBodyForce<dim>::update_volumetric_stiffness(int i, double volume)
{
  const auto wall_share = wall_share_.find(i);
  double phi = wall_share == wall_share_.end() ? 0 : wall_share->second;
  bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
    const double q = i == b.i ? b.lever_i.dot(b.normal) : -b.lever_j.dot(b.normal);
    phi += b.area * q / volume;
  });
  lambda_per_volume_[i] =
      energy_weight(i) * materials_.of(i).volumetric_stiffness<dim>(phi) / volume;
}

template <int dim>
void ManyBodyForce<dim>::set_energy_weights(const std::vector<double> &weights)
{
  core::require(energy_weights_.empty() && int(weights.size()) == bonds_.n_particles() &&
                    broken_.empty() && !plastic_,
                "energy weights are set once, for every particle of an intact body");
  bonds_.for_each_interface([&](BondId, const Bond<dim> &b) {
    core::require(weights[b.i] == 1 && weights[b.j] == 1,
                  "the overlap sees a bond between two materials");
  });
  energy_weights_ = weights;
  bonds_.set_weights(weights);
  lay_out_slices();
  for (int i = 0; i < bonds_.n_particles(); ++i)
    lambda_per_volume_[i] *= weights[i];
}

template <int dim>
void ManyBodyForce<dim>::set_coupled_edge(const Particles &p, particles::CoupledEdge<dim> edge)
{
  edge_ = EdgeCells<dim>(std::move(edge), boundary_faces_, materials_, p, energy_weights_);
}

template <int dim>
LatticeArrays<dim> ManyBodyForce<dim>::arrays(const Particles &p, Workspace &work) const
{
  LatticeArrays<dim> a{};
  for (int c = 0; c < dim; ++c)
    a.displacement[c] = p.displacement[c].data();
  for (int c = 0; c < a.n_rotations; ++c)
    a.rotation[c] = p.rotation[c].data();
  a.mask = bonds_.mask().data();
  a.lambda_per_volume = lambda_per_volume_.data();
  a.other_particles = &other_particles_;
  a.pressure = work.pressure.data();
  return a;
}

template <int dim>
void ManyBodyForce<dim>::find_turns(const Particles &p, Workspace &work) const
{
  if constexpr (dim == 2) {
    work.cosine_minus_1.resize(bonds_.n_particles());
    work.sine.resize(bonds_.n_particles());
    cosine_minus_1_and_sine(p.rotation[0].data(), work.cosine_minus_1.data(), work.sine.data(),
                            bonds_.n_particles());
  }
}

template <int dim>
Turn<dim> ManyBodyForce<dim>::turn(const Particles &p, const Workspace &work, int i) const
{
  if constexpr (dim == 2)
    return {work.cosine_minus_1[i], work.sine[i]};
  else
    return Turn<3>::of(p, i);
}

template <int dim>
BondMotion<dim> ManyBodyForce<dim>::motion(const Bond<dim> &b, const Particles &p,
                                           const Workspace &work) const
{
  return motion(b, p, turn(p, work, b.i), turn(p, work, b.j));
}

template <int dim>
BondMotion<dim> ManyBodyForce<dim>::motion(const Bond<dim> &b, const Particles &p) const
{
  return motion(b, p, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j));
}

template <int dim>
BondMotion<dim> ManyBodyForce<dim>::motion(const Bond<dim> &b, const Particles &p,
                                           const Turn<dim> &turn_i, const Turn<dim> &turn_j) const
{
  BondMotion<dim> m(b, turn_i, turn_j, get(p.displacement, b.i), get(p.displacement, b.j));
  if (plastic_ && (plastic_->is_plastic(b.i) || plastic_->is_plastic(b.j))) {
    const auto part = plastic_stretch(b, turn_i, turn_j);
    m.elastic -= part[0] + part[1];
  }
  return m;
}

template <int dim>
Vector<dim> ManyBodyForce<dim>::bond_force(const Bond<dim> &b, const BondMotion<dim> &m,
                                           const std::vector<double> &pressure) const
{
  if (b.joins_materials)
    return b.area * SeriesBond<dim>(b, m).traction(pressure[b.i], pressure[b.j]);
  return law_of(b).force(m.elastic, pressure[b.i], m.a_i, pressure[b.j], m.a_j);
}

template <int dim>
void ManyBodyForce<dim>::find_other_pressure(const Particles &p, const SurfaceLoads<dim> &surface,
                                             Workspace &work) const
{
  work.pressure.resize(bonds_.n_particles());
  const LatticeArrays<dim> a = arrays(p, work);
  const SliceNearness *const slices = awake_slices(work);
  slices_.load(a, records_, slices);
  if (materials_.has_no_dilatation())
    return;
  for (const int i : other_particles_)
    work.pressure[i] = 0;
  slices_.add_pressures(a, records_, slices);
  surface.add_dilatation(p, lambda_per_volume_, work.pressure);
  if (!interfaces_.empty())
    interfaces_.add_own_part(p, lambda_per_volume_, work.pressure);
  for_each_plastic(
      [&](int i) { work.pressure[i] -= lambda_per_volume_[i] * plastic_->flowed_volume()[i]; });
}

template <int dim>
void ManyBodyForce<dim>::find_pressure(const Particles &p, Workspace &work) const
{
  find_turns(p, work);
  find_other_pressure(p, surface_, work);
  if (materials_.has_no_dilatation())
    return;
  kernel_.dilatation(arrays(p, work), bonds_.segments(), rows_);
  edge_.complete_pressures(p, work.pressure);
}

template <int dim>
void ManyBodyForce<dim>::elastic_forces(Particles &p, SurfaceLoads<dim> &surface, bool may_break,
                                        Workspace &work) const
{
  find_other_pressure(p, surface, work);
  LatticeArrays<dim> a = arrays(p, work);
  for (int c = 0; c < dim; ++c)
    a.force[c] = p.force[c].data();
  for (int c = 0; c < n_spins<dim>; ++c)
    a.torque[c] = p.torque[c].data();
  TractionScreen screen;
  if (plastic_) {
    work.marks.assign(plastic_->n_blocks(), 0);
    screen = {yield_traction_, work.marks.data()};
  }
  const BreakScreen none;
  const bool may_look_by_particle = may_break && !awake_ranges(work) && screen.traction == 0;
  const auto lattice_forces = [&](bool by_particle) {
    return kernel_.forces(a, bonds_.segments(), may_break ? breaking_screen(false) : none, screen,
                          rows_, work.exceeded_rows, awake_ranges(work), by_particle,
                          !is_cleared_by_stress());
  };
  bool by_particle = may_look_by_particle && work.way.by_particle;
  const long n_looked = lattice_forces(by_particle);
  if (may_break)
    work.way.choose(n_looked, p.n_owned);
  if (!by_particle && may_look_by_particle && work.way.by_particle) {
    // Once more is less than to look at all that was noted.
    by_particle = true;
    find_other_pressure(p, surface, work); // the kernel has added its own to them
    lattice_forces(true);
  }
  const bool has_lattice = bonds_.n_directions() > 0;
  work.own_terms = may_look_by_particle && (by_particle || !has_lattice);
  slices_.forces(a, may_break ? breaking_screen(true) : none, screen, records_,
                 work.exceeded_particles, awake_slices(work),
                 !(work.own_terms && has_lattice && is_cleared_by_stress()));
  interfaces_.add_forces(p, work.pressure);
  surface.add_forces(p, work.pressure);
  if (plastic_)
    add_plastic_forces(p, work);
  if (work.rest && !work.rest->is_exact() && !work.rest->all_awake())
    clear_forces_at_rest(p);
}

// What is seen in one step acts in the next: a body in parts can agree on it meanwhile.
template <int dim>
void ManyBodyForce<dim>::look_for_contacts(const Particles &p)
{
  if (looked_at_ == time_)
    return;
  looked_at_ = time_;
  searching_ = searching_ || has_slid_;
  if (searching_)
    search_.update(p, bonds_, contacts_);
  else
    has_slid_ = contacts_.has_slid(p, spacing_ / 4);
}

template <int dim>
void ManyBodyForce<dim>::compute(Particles &p, double time)
{
  if (time != time_) {
    last_time_ = time_;
    time_ = time;
    breaking_step_error_ += quarter_work_of_jumps(p);
    jumps_.clear();
  }
  surface_.set_time(time);
  if (rest_ && !rest_->all_awake())
    wake_loaded();
  elastic_forces(p, surface_, true, work_);
  if (plastic_) {
    surface_.book_work(p, work_.pressure); // with the reactions before the flow
    flow(p);
  }
  if (!contacts_.all().empty()) {
    look_for_contacts(p);
    if (searching_ && rest_ && !rest_->all_awake())
      wake_contacts();
    add_contact_forces(p);
  }
  surface_.book_work(p, work_.pressure);
  if (broken_at_ == time)
    return;
  clear_by_stress(p);
  const auto exceeding = exceeding_bonds(p);
  if (exceeding.empty())
    return;
  broken_at_ = time;
  break_bonds(p, exceeding, time);
}

template <int dim>
double ManyBodyForce<dim>::potential_energy(const Particles &p) const
{
  Workspace work;
  find_other_pressure(p, surface_, work);
  const LatticeArrays<dim> a = arrays(p, work);
  std::vector<double> energy(bonds_.n_particles(), 0.);
  kernel_.energies(a, bonds_.segments(), rows_, energy.data());
  slices_.add_energies(a, records_, energy.data());
  double sum = surface_.energy(p) + contacts_.energy(p) + interfaces_.energy(p, work.pressure);
  if (plastic_)
    sum += plastic_energy(p, work);
  for (int i = 0; i < bonds_.n_particles(); ++i) {
    sum += energy[i];
    if (lambda_per_volume_[i] != 0) // 1/2 lambda V theta^2 = 1/2 (lambda theta)^2 / (lambda / V)
      sum += 0.5 * work.pressure[i] * work.pressure[i] / lambda_per_volume_[i];
  }
  return sum;
}

template <int dim>
particles::ElasticConstants<dim> ManyBodyForce<dim>::elastic_constants() const
{
  return materials_.base().elastic_constants<dim>();
}

template <int dim>
std::vector<core::SkippedPart> ManyBodyForce<dim>::skipped_parts() const
{
  std::vector<core::SkippedPart> skipped;
  if (materials_.has_no_dilatation())
    skipped.push_back({"dilatation sweep", "Poisson's ratio is 0"});
  if (!can_break())
    skipped.push_back({"bond checks", "no fracture criterion"});
  skipped.push_back({"stress tensors in the loop", "the criterion reads tractions; tensors are "
                                                   "computed for output only"});
  if (contacts_.all().empty())
    skipped.push_back({"contacts until a bond breaks", "no initial crack"});
  return skipped;
}

template class ManyBodyForce<2>;
template class ManyBodyForce<3>;
} // namespace ligament::dem
