#include "dem/partial_many_body.h"

#include "dem/bond_law.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
PartialManyBody<dim>::PartialManyBody(std::vector<SharedBond> bonds,
                                      std::vector<double> share_of_volume,
                                      std::vector<double> lambda_per_volume)
    : bonds_(std::move(bonds)), share_(std::move(share_of_volume)),
      lambda_per_volume_(std::move(lambda_per_volume))
{
}

template <int dim>
double PartialManyBody<dim>::compute(particles::Particles<dim> &p)
{
  const int n = int(share_.size());
  pressure_.assign(n, 0.);
  turns_.resize(n);
  for (int i = 0; i < n; ++i)
    turns_[i] = Turn<dim>::of(p, i);
  const auto motion = [&](const Bond<dim> &b) {
    return BondMotion<dim>(b, turns_[b.i], turns_[b.j], get(p.displacement, b.i),
                           get(p.displacement, b.j));
  };
  for (const auto &[b, share] : bonds_) {
    const BondMotion<dim> m = motion(b);
    const BondLaw<dim> law = law_of(b, share);
    pressure_[b.i] += lambda_per_volume_[b.i] * law.add_dilatation(m.du, m.a_i, 0);
    pressure_[b.j] -= lambda_per_volume_[b.j] * law.add_dilatation(m.du, m.a_j, 0);
  }
  double energy = 0;
  for (int i = 0; i < n; ++i) {
    if (share_[i] != 0 && lambda_per_volume_[i] != 0)
      energy += share_[i] * 0.5 * pressure_[i] * pressure_[i] / lambda_per_volume_[i];
    pressure_[i] *= share_[i];
  }
  for (auto &a : p.force)
    std::fill(a.begin(), a.end(), 0.);
  for (auto &a : p.torque)
    std::fill(a.begin(), a.end(), 0.);
  for (const auto &[b, share] : bonds_) {
    const BondMotion<dim> m = motion(b);
    const BondLaw<dim> law = law_of(b, share);
    const double p_i = pressure_[b.i], p_j = pressure_[b.j];
    const Vector<dim> f = law.force(m.du, p_i, m.a_i, p_j, m.a_j);
    const Spin<dim> bend = share * bending_torque(b, p);
    add(p.force, b.i, f);
    add(p.force, b.j, Vector<dim>(-f));
    add(p.torque, b.i, law.add_torque(f, m.du, p_i, m.a_i, bend));
    add(p.torque, b.j,
        law.add_torque(Vector<dim>(-f), Vector<dim>(-m.du), p_j, m.a_j, Spin<dim>(-bend)));
    energy += law.twice_energy(m.du) / 2 + share * bending_energy(b, p);
  }
  return energy;
}

template class PartialManyBody<2>;
template class PartialManyBody<3>;
} // namespace ligament::dem
