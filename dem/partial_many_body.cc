#include "dem/partial_many_body.h"

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
    const double s_r = b.area / b.distance;
    pressure_[b.i] += lambda_per_volume_[b.i] * s_r * m.a_i.dot(m.du);
    pressure_[b.j] -= lambda_per_volume_[b.j] * s_r * m.a_j.dot(m.du);
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
    const double s_r = b.area / b.distance;
    const Vector<dim> f =
        s_r * (2 * b.shear_i * share * m.du + pressure_[b.i] * m.a_i - pressure_[b.j] * m.a_j);
    const Spin<dim> bend = share * bending_torque(b, p);
    add(p.force, b.i, f);
    add(p.force, b.j, Vector<dim>(-f));
    add(p.torque, b.i, Spin<dim>(cross(m.a_i, f - s_r * pressure_[b.i] * m.du) + bend));
    add(p.torque, b.j, Spin<dim>(-cross(m.a_j, f - s_r * pressure_[b.j] * m.du) - bend));
    energy += share * (b.shear_i * s_r * m.du.squaredNorm() + bending_energy(b, p));
  }
  return energy;
}

template class PartialManyBody<2>;
template class PartialManyBody<3>;
} // namespace ligament::dem
