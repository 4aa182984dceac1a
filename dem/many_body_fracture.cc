// Breaking of bonds: criterion, energy released, contact in place of the bond.
#include "dem/many_body_force.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
void ManyBodyForce<dim>::set_strength(double strength)
{
  core::require(strength > 0, "the strength must be positive");
  fracture_ = {FractureLaw::Criterion::maximum_tension, strength};
}

template <int dim>
double ManyBodyForce<dim>::strength() const
{
  return fracture_.criterion == FractureLaw::Criterion::none ? 0. : fracture_.strength;
}

template <int dim>
std::vector<BondId> ManyBodyForce<dim>::exceeding_bonds(const Particles &p) const
{
  std::vector<BondId> found;
  const auto test = [&](int i, bool lattice) {
    bonds_.for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
      if (lattice == (id.direction >= 0) && b.i == i && tension(b, p, work_.pressure) >= strength())
        found.push_back(id);
    });
  };
  for (const RowRange &range : work_.exceeded_rows)
    for (int i = range.begin; i < range.end; ++i)
      test(i, true);
  for (const int i : work_.exceeded_particles)
    test(i, false);
  const auto ids = [&](const BondId &id) {
    const Bond<dim> b = bonds_.bond(id);
    const auto i = p.global_id[b.i], j = p.global_id[b.j];
    return std::pair(std::min(i, j), std::max(i, j));
  };
  std::sort(found.begin(), found.end(),
            [&](const BondId &a, const BondId &b) { return ids(a) < ids(b); });
  return found;
}

template <int dim>
double ManyBodyForce<dim>::local_energy(const Bond<dim> &b, const Particles &p) const
{
  double sum =
      b.weight * material_.shear_modulus() * b.area / b.distance * motion(b, p).du.squaredNorm() +
      bending_energy(b, p);
  for (const int i : {b.i, b.j})
    if (lambda_per_volume_[i] != 0)
      sum += 0.5 * work_.pressure[i] * work_.pressure[i] / lambda_per_volume_[i];
  return sum;
}

template <int dim>
void ManyBodyForce<dim>::break_bonds(Particles &p, const std::vector<BondId> &bonds, double time)
{
  const auto force_before = p.force;
  const auto torque_before = p.torque;
  std::vector<double> &pressure = work_.pressure;
  for (const BondId &id : bonds) {
    const Bond<dim> b = bonds_.bond(id);
    const auto m = motion(b, p);
    double released = local_energy(b, p);
    // The volumes lose the share of this face; the other faces keep theirs.
    const double s_r = b.area / b.distance;
    const std::array<std::pair<int, double>, 2> shares = {std::pair(b.i, s_r * m.a_i.dot(m.du)),
                                                          std::pair(b.j, -s_r * m.a_j.dot(m.du))};
    bonds_.remove(id);
    if (id.direction < 0)
      slices_.remove(id.index);
    for (const auto &[i, share] : shares)
      if (lambda_per_volume_[i] != 0) {
        const double rest = pressure[i] / lambda_per_volume_[i] - share;
        update_volumetric_stiffness(i);
        pressure[i] = lambda_per_volume_[i] * rest;
        released -= 0.5 * lambda_per_volume_[i] * rest * rest;
      }
    contacts_.add(b, true);
    released -= contacts_.compression_energy(contacts_.all().back(), p);
    search_.add_surface_particle(b.i);
    search_.add_surface_particle(b.j);
    fracture_energy_ += released;
    broken_.push_back({b.i, b.j, p.global_id[b.i], p.global_id[b.j], time,
                       Vector<dim>(get(packing_.centre, b.i) + b.lever_i), b.normal, b.area,
                       released});
  }
  searching_ = true;
  elastic_forces(p, surface_, 0., work_);
  contacts_.add_forces(p);
  surface_.book_work(p, work_.pressure); // the supports' reactions changed, nothing moved
  // Kinetic energy 1/2 v(-) m v(+) holds -dt^2/8 F^2/m against that of the mean velocity, which
  // the mean force leaves as it is.
  const double dt = time_ - last_time_;
  const auto mean = [&](auto &now, const auto &before, const std::vector<double> &inverse) {
    for (std::size_t c = 0; c < now.size(); ++c)
      for (std::size_t i = 0; i < now[c].size(); ++i) {
        breaking_step_error_ +=
            dt * dt / 8 * inverse[i] * (now[c][i] - before[c][i]) * (now[c][i] + before[c][i]);
        now[c][i] = 0.5 * (now[c][i] + before[c][i]);
      }
  };
  mean(p.force, force_before, p.inverse_mass);
  mean(p.torque, torque_before, p.inverse_inertia);
}

template void ManyBodyForce<2>::set_strength(double);
template void ManyBodyForce<3>::set_strength(double);
template double ManyBodyForce<2>::strength() const;
template double ManyBodyForce<3>::strength() const;
template std::vector<BondId> ManyBodyForce<2>::exceeding_bonds(const Particles &) const;
template std::vector<BondId> ManyBodyForce<3>::exceeding_bonds(const Particles &) const;
template void ManyBodyForce<2>::break_bonds(Particles &, const std::vector<BondId> &, double);
template void ManyBodyForce<3>::break_bonds(Particles &, const std::vector<BondId> &, double);
template double ManyBodyForce<2>::local_energy(const Bond<2> &, const Particles &) const;
template double ManyBodyForce<3>::local_energy(const Bond<3> &, const Particles &) const;
} // namespace ligament::dem
