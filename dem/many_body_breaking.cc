// Breaking of bonds: energy released, contact in place of the bond.
#include "dem/bond_law.h"
#include "dem/many_body_force.h"
#include "dem/parts/opening_faces.h"

#include <algorithm>

namespace ligament::dem
{
namespace
{
/// Of the two particles at present, in m.
template <int dim>
double centre_distance(const Bond<dim> &b, const particles::Particles<dim> &p)
{
  Vector<dim> now = b.distance * b.normal + get(p.displacement, b.j) - get(p.displacement, b.i);
  if (b.image)
    now += b.image->jump;
  return now.norm();
}
} // namespace

template <int dim>
double ManyBodyForce<dim>::bond_energy(const Bond<dim> &b, const Particles &p) const
{
  if (b.joins_materials)
    return 0;
  const auto m = stressed(p, evaluation_).motion(b);
  const Vector<dim> opening = cohesive_.opening(b, p), du = m.du - opening;
  return law_of(b).twice_energy(du) / 2 + bending_energy(b, p) -
         cohesive_.lost_bending_energy(b, p) + strains_.bond_energy(b, p, opening);
}

template <int dim>
double ManyBodyForce<dim>::local_energy(const Bond<dim> &b, const Particles &p) const
{
  double sum = bond_energy(b, p);
  for (const int i : {b.i, b.j})
    if (!interfaces_.is_member(i))
      sum += body_.volume_energy(i, evaluation_.pressure[i]);
  if (is_at_interface(b))
    sum += interfaces_.energy(p, evaluation_) + cohesive_.energy_between_materials(p);
  return sum;
}

template <int dim>
void ManyBodyForce<dim>::drop_bond(const BondId &id, const Bond<dim> &b, const Particles &p)
{
  body_.remove(id, b, p);
  search_.remove(b);
  for (auto *part : parts_)
    part->remove(id, b, p);
}

template <int dim>
auto ManyBodyForce<dim>::stresses_at_interfaces(const Particles &p) const
    -> std::vector<typename InelasticStrains<dim>::Tensor>
{
  return interfaces_.own_stresses(p, evaluation_,
                                  [&](const auto &visit) { cohesive_.for_each_strain(p, visit); });
}

template <int dim>
double
ManyBodyForce<dim>::follow_jump(const std::vector<typename InelasticStrains<dim>::Tensor> &before,
                                const Particles &p)
{
  const auto after = stresses_at_interfaces(p);
  double kept = 0;
  for (std::size_t k = 0; k < after.size(); ++k) {
    const int i = interfaces_.members()[k];
    kept += strains_.jump(i, after[k] - before[k], evaluation_.pressure[i]);
  }
  return kept;
}

// Half of the fall of the curve that the bond alone would bear.
template <int dim>
double ManyBodyForce<dim>::least_energy(const Bond<dim> &b, const Vector<dim> &force,
                                        const Softening &shape) const
{
  constexpr double share = 0.5;
  return force.squaredNorm() * shape.steepest() / (share * OpenedBond::of(b).shear);
}

// The volumes lose the share of this face; the other faces keep theirs.
template <int dim>
double ManyBodyForce<dim>::remove_bond(const BondId &id, const Bond<dim> &b, const Particles &p)
{
  std::vector<double> &pressure = evaluation_.pressure;
  const std::vector<double> &stiffness = body_.lambda_per_volume();
  const bool at_interface = is_at_interface(b);
  std::vector<typename InelasticStrains<dim>::Tensor> stresses;
  if (at_interface) {
    stresses = stresses_at_interfaces(p);
    interfaces_.take_pressures(p, evaluation_);
  }
  const auto m = stressed(p, evaluation_).motion(b);
  const Vector<dim> opening = cohesive_.opening(b, p), du = m.du - opening;
  const auto of_opening = cohesive_.opened_volumes(b, p);
  const auto share = [&](int i, const Vector<dim> &du, const Vector<dim> &lever) {
    return b.joins_materials
               ? of_opening[i == b.i ? 0 : 1]
               : law_of(b).add_dilatation(du, lever, 0) - strains_.flowed_volume(b, i);
  };
  const std::array<std::pair<int, double>, 2> shares = {std::pair(b.i, share(b.i, du, m.a_i)),
                                                        std::pair(b.j, share(b.j, -du, m.a_j))};
  const std::array<double, 2> before = {pressure[b.i], pressure[b.j]};
  for (const auto &[i, share] : shares)
    if (stiffness[i] != 0)
      pressure[i] = pressure[i] / stiffness[i] - share; // theta_i V_i for a moment
  drop_bond(id, b, p);
  for (const auto &[i, share] : shares)
    if (stiffness[i] != 0)
      pressure[i] *= stiffness[i];
  double kept = 0;
  for (const auto &[i, old] : {std::pair(b.i, before[0]), std::pair(b.j, before[1])})
    if (!interfaces_.is_member(i))
      kept += strains_.forget_face(b, i, p, opening, old, pressure[i]);
  if (at_interface) {
    interfaces_.add_pressures(p, evaluation_);
    kept += follow_jump(stresses, p);
  }
  return local_energy(b, p) - bond_energy(b, p) + kept;
}

template <int dim>
std::vector<int>
ManyBodyForce<dim>::near(const std::vector<BondId> &bonds,
                         const std::vector<typename RebondedFaces<dim>::Name> &rebonded) const
{
  std::vector<int> of;
  for (const auto &name : rebonded) {
    const auto &face = rebonded_.all().at(name);
    of.insert(of.end(), {face.i, face.j});
  }
  for (const BondId &id : bonds) {
    const Bond<dim> b = body_.bonds().bond(id);
    of.insert(of.end(), {b.i, b.j});
    if (is_at_interface(b)) // one system for all their pressures
      of.insert(of.end(), interfaces_.members().begin(), interfaces_.members().end());
  }
  const auto make_unique = [](std::vector<int> &list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  make_unique(of);
  std::vector<int> found = of;
  for (const int i : of) {
    body_.bonds().for_each_bond_of(
        i, [&](BondId, const Bond<dim> &b) { found.push_back(b.i == i ? b.j : b.i); });
    rebonded_.add_neighbours(i, found);
  }
  make_unique(found);
  if (rest_ && !rest_->is_exact())
    found.erase(
        std::remove_if(found.begin(), found.end(), [&](int i) { return !rest_->is_awake(i); }),
        found.end());
  return found;
}

template <int dim>
std::vector<BondId> ManyBodyForce<dim>::begin_softening(const Particles &p,
                                                        const std::vector<BondId> &bonds)
{
  if (bonds.empty() || !fracture().faces_open())
    return bonds;
  const StressedBody<dim> state = stressed(p, evaluation_);
  // Stresses are found at once: each look goes through all faces that soften. One that begins has
  // no opening yet and changes nothing for the others.
  std::vector<int> materials_of, ends;
  for (const BondId &id : bonds) {
    const Bond<dim> b = body_.bonds().bond(id);
    materials_of.push_back(search_.failing_material(id, b, state));
    if (fracture().energy_of(materials_of.back()) > 0)
      ends.insert(ends.end(), {b.i, b.j});
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  const auto stress = state.stresses_of(ends);
  const auto stress_of = [&](int i) -> const Strain<dim> & {
    return stress[std::lower_bound(ends.begin(), ends.end(), i) - ends.begin()];
  };
  std::vector<BondId> at_once;
  for (std::size_t k = 0; k < bonds.size(); ++k) {
    const BondId &id = bonds[k];
    const Bond<dim> b = body_.bonds().bond(id);
    const int material = materials_of[k];
    const double energy = fracture().energy_of(material);
    const Vector<dim> force = state.force(b, state.motion(b));
    if (energy == 0) {
      const double velocity = search_.crack_velocity_of(b, materials());
      if (velocity == 0 || !cohesive_.begin_fall(id, b, p, force, material, time_,
                                                 crossing_time<dim>(b.area, thickness_, velocity)))
      {
        at_once.push_back(id);
        continue;
      }
    } else {
      double whole = b.weight * energy * b.area;
      if (search_.strengths_scatter())
        whole = std::max(whole, least_energy(b, force, fracture().softening_of(material)));
      const Strain<dim> mean = (stress_of(b.i) + stress_of(b.j)) / 2;
      const Vector<dim> way = PrincipalTension<dim>::direction(mean);
      cohesive_.begin(id, b, p, force, way, material, whole);
    }
    follow_softening(b, p);
    began_at_ = time_;
  }
  return at_once;
}

template <int dim>
void ManyBodyForce<dim>::follow_softening(const Bond<dim> &b, const Particles &p)
{
  for (const int i : {b.i, b.j}) {
    body_.add_other_particle(i);
    strains_.open_cell(i, p.volume[i]);
  }
}

template <int dim>
Vector<dim> ManyBodyForce<dim>::pressing_force(const Bond<dim> &b, const Particles &p) const
{
  const Vector<dim> force = stressed(p, evaluation_).whole_force(b);
  const Vector<dim> normal = present_normal(b, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j));
  return force.dot(normal) < 0 ? force : Vector<dim>(Vector<dim>::Zero());
}

// Only the neighbours of the bonds feel the break: what acts on them is summed bond by bond before
// it and after it.
template <int dim>
void ManyBodyForce<dim>::break_bonds(Particles &p, const std::vector<BondId> &bonds,
                                     const std::vector<typename RebondedFaces<dim>::Name> &rebonded)
{
  if (bonds.empty() && rebonded.empty())
    return;
  const StressedBody<dim> state = stressed(p, evaluation_);
  const std::vector<int> near = this->near(bonds, rebonded);
  std::vector<Wrench<dim>> before, bonded;
  for (const int i : near) {
    before.push_back({get(p.force, i), get(p.torque, i)});
    bonded.push_back(state.wrench_on(i));
  }
  for (const BondId &id : bonds) {
    Bond<dim> b = body_.bonds().bond(id);
    const auto *const face = cohesive_.find(b, p);
    const bool softened = face != nullptr;
    const Vector<dim> pressing = search_.breaks_under_pressure() && !softened
                                     ? pressing_force(b, p)
                                     : Vector<dim>(Vector<dim>::Zero());
    const double of_opening = softened ? face->work : 0;
    const double energy_before = local_energy(b, p), energy = remove_bond(id, b, p);
    Bond<dim> touching = strains_.stretched(b);
    // A face that does not press leaves a contact that does not: after a slide, or a turn about the
    // last small face between two, centres may be nearer than where they were bonded.
    if (pressing.isZero(0))
      touching.distance = std::min(touching.distance, centre_distance(b, p));
    broken_.add(b, p, time_,
                energy_before - energy - contacts_.act_broken(touching, pressing, p, dt()),
                of_opening);
  }
  contacts_.settle();
  for (const auto &name : rebonded) {
    const double energy_before = rebonded_.local_energy(name, p, evaluation_.pressure);
    broken_.add_again(time_,
                      energy_before - rebonded_.part(name, p, evaluation_.pressure, true, dt()));
  }
  for (std::size_t k = 0; k < near.size(); ++k) {
    const Wrench<dim> after = state.wrench_on(near[k]);
    add(p.force, near[k], Vector<dim>(after.force - bonded[k].force));
    add(p.torque, near[k], Spin<dim>(after.torque - bonded[k].torque));
  }
  find_reactions(p, evaluation_);
  book_work(p); // nothing moved
  broken_.take_mean(p, near, before, dt());
  cohesive_.take_up(p, evaluation_);
  clear_forces_at_rest(p, evaluation_);
}

template std::vector<BondId> ManyBodyForce<2>::begin_softening(const Particles &,
                                                               const std::vector<BondId> &);
template std::vector<BondId> ManyBodyForce<3>::begin_softening(const Particles &,
                                                               const std::vector<BondId> &);
template void ManyBodyForce<2>::follow_softening(const Bond<2> &, const Particles &);
template void ManyBodyForce<3>::follow_softening(const Bond<3> &, const Particles &);
template void ManyBodyForce<2>::drop_bond(const BondId &, const Bond<2> &, const Particles &);
template void ManyBodyForce<3>::drop_bond(const BondId &, const Bond<3> &, const Particles &);
template void ManyBodyForce<2>::break_bonds(Particles &, const std::vector<BondId> &,
                                            const std::vector<RebondedFaces<2>::Name> &);
template void ManyBodyForce<3>::break_bonds(Particles &, const std::vector<BondId> &,
                                            const std::vector<RebondedFaces<3>::Name> &);
} // namespace ligament::dem
