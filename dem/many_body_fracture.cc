// Breaking of bonds: energy released, contact in place of the bond.
#include "dem/bond_law.h"
#include "dem/many_body_force.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
double ManyBodyForce<dim>::bond_energy(const Bond<dim> &b, const BondMotion<dim> &m,
                                       const Particles &p) const
{
  return law_of(b).twice_energy(m.elastic) / 2 + bending_energy(b, p);
}

template <int dim>
double ManyBodyForce<dim>::local_energy(const Bond<dim> &b, const Particles &p) const
{
  double sum = b.joins_materials ? 0 : bond_energy(b, motion(b, p), p);
  for (const int i : {b.i, b.j})
    if (lambda_per_volume_[i] != 0 && !interfaces_.is_member(i))
      sum += 0.5 * work_.pressure[i] * work_.pressure[i] / lambda_per_volume_[i];
  if (is_at_interface(b))
    sum += interfaces_.energy(p, work_.pressure) +
           interfaces_.volume_energy(lambda_per_volume_, work_.pressure);
  return sum;
}

template <int dim>
void ManyBodyForce<dim>::drop_bond(const BondId &id, const Bond<dim> &b, const Particles &p)
{
  bonds_.remove(id);
  screen_.remove(b);
  if (b.joins_materials)
    interfaces_.remove(id.index);
  else if (id.direction < 0)
    slices_.remove(id.index);
  for (const int i : {b.i, b.j}) {
    if (plastic_ && plastic_->is_plastic(i))
      update_flowed_volume(i, p.volume[i]);
    if (lambda_per_volume_[i] != 0)
      update_volumetric_stiffness(i, p.volume[i]);
  }
}

template <int dim>
Contact<dim> &ManyBodyForce<dim>::note_broken(const Bond<dim> &b, const Particles &p, double time,
                                              double energy)
{
  search_.add_surface_particle(b.i);
  search_.add_surface_particle(b.j);
  broken_.push_back({b.i, b.j, p.global_id[b.i], p.global_id[b.j], time,
                     Vector<dim>(get(p.reference, b.i) + b.lever_i), b.normal, b.area, energy});
  return contacts_.add(b, true);
}

// The volumes lose the share of this face; the other faces keep theirs.
template <int dim>
double ManyBodyForce<dim>::remove_bond(const BondId &id, const Bond<dim> &b, const Particles &p)
{
  std::vector<double> &pressure = work_.pressure;
  const bool at_interface = is_at_interface(b);
  if (at_interface)
    interfaces_.take_own_part(p, lambda_per_volume_, pressure);
  const auto m = motion(b, p);
  const auto share = [&](const Vector<dim> &du, const Vector<dim> &lever) {
    return b.joins_materials ? 0 : law_of(b).add_dilatation(du, lever, 0);
  };
  std::array<std::pair<int, double>, 2> shares = {std::pair(b.i, share(m.du, m.a_i)),
                                                  std::pair(b.j, share(-m.du, m.a_j))};
  if (plastic_)
    for (auto &[i, share] : shares)
      share -= flowed_volume(b, i);
  for (const auto &[i, share] : shares)
    if (lambda_per_volume_[i] != 0)
      pressure[i] = pressure[i] / lambda_per_volume_[i] - share; // theta_i V_i for a moment
  drop_bond(id, b, p);
  for (const auto &[i, share] : shares)
    if (lambda_per_volume_[i] != 0)
      pressure[i] *= lambda_per_volume_[i];
  if (at_interface)
    interfaces_.add_own_part(p, lambda_per_volume_, pressure);
  return local_energy(b, p) - (b.joins_materials ? 0 : bond_energy(b, motion(b, p), p));
}

template <int dim>
void ManyBodyForce<dim>::break_bonds(Particles &p, const std::vector<BondId> &bonds, double time)
{
  const auto force_before = p.force;
  const auto torque_before = p.torque;
  for (const BondId &id : bonds) {
    const Bond<dim> b = bonds_.bond(id);
    double released = local_energy(b, p);
    released -= remove_bond(id, b, p);
    released -= contacts_.compression_energy(note_broken(b, p, time, 0), p);
    broken_.back().energy = released;
    fracture_energy_ += released;
  }
  searching_ = true;
  const auto noted_rows = work_.exceeded_rows; // what utilisation() looks at
  const auto noted_particles = work_.exceeded_particles;
  elastic_forces(p, surface_, false, work_);
  work_.exceeded_rows = noted_rows;
  work_.exceeded_particles = noted_particles;
  add_contact_forces(p);
  surface_.book_work(p, work_.pressure); // the supports' reactions changed, nothing moved
  // The mean of both forces acts. Over the step before, the force before would have made the work
  // exact, over the next one that after: (E10).
  jumps_.clear();
  for (int i = 0; i < p.n_owned; ++i) {
    const Jump jump = {i, get(p.force, i) - get(force_before, i),
                       get(p.torque, i) - get(torque_before, i)};
    if (jump.force.isZero(0) && jump.torque.isZero(0))
      continue;
    add(p.force, i, Vector<dim>(-0.5 * jump.force));
    add(p.torque, i, Spin<dim>(-0.5 * jump.torque));
    jumps_.push_back(jump);
  }
  breaking_step_error_ -= quarter_work_of_jumps(p);
}

template <int dim>
double ManyBodyForce<dim>::quarter_work_of_jumps(const Particles &p) const
{
  double power = 0;
  for (const Jump &jump : jumps_)
    power += jump.force.dot(get(p.velocity, jump.i)) + jump.torque.dot(get(p.spin, jump.i));
  return 0.25 * (time_ - last_time_) * power;
}

template void ManyBodyForce<2>::drop_bond(const BondId &, const Bond<2> &, const Particles &);
template void ManyBodyForce<3>::drop_bond(const BondId &, const Bond<3> &, const Particles &);
template Contact<2> &ManyBodyForce<2>::note_broken(const Bond<2> &, const Particles &, double,
                                                   double);
template Contact<3> &ManyBodyForce<3>::note_broken(const Bond<3> &, const Particles &, double,
                                                   double);
template double ManyBodyForce<2>::bond_energy(const Bond<2> &, const BondMotion<2> &,
                                              const Particles &) const;
template double ManyBodyForce<3>::bond_energy(const Bond<3> &, const BondMotion<3> &,
                                              const Particles &) const;
template double ManyBodyForce<2>::quarter_work_of_jumps(const Particles &) const;
template double ManyBodyForce<3>::quarter_work_of_jumps(const Particles &) const;
template void ManyBodyForce<2>::break_bonds(Particles &, const std::vector<BondId> &, double);
template void ManyBodyForce<3>::break_bonds(Particles &, const std::vector<BondId> &, double);
template double ManyBodyForce<2>::local_energy(const Bond<2> &, const Particles &) const;
template double ManyBodyForce<3>::local_energy(const Bond<3> &, const Particles &) const;
} // namespace ligament::dem
