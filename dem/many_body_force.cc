#include "dem/many_body_force.h"

namespace ligament::dem
{
template <int dim>
ManyBodyForce<dim>::ManyBodyForce(particles::Packing<dim> packing, const DemMaterial &material,
                                  std::vector<core::BoundaryLoad<dim>> loads,
                                  const FractureLaw &fracture)
    : packing_(std::move(packing)), material_(material), fracture_(fracture),
      bonds_(packing_, material), surface_(packing_, material, std::move(loads)),
      wall_share_(packing_.size(), 0.), lambda_per_volume_(packing_.size()),
      pressure_(packing_.size(), 0.)
{
  material_.check();
  for (const auto &wall : surface_.walls())
    wall_share_[wall.i] += wall.area * wall.lever.dot(wall.prescribed.cwiseProduct(wall.normal)) /
                           packing_.volume[wall.i];
  for (int i = 0; i < packing_.size(); ++i)
    update_volumetric_stiffness(i);
}

template <int dim>
void ManyBodyForce<dim>::update_volumetric_stiffness(int i)
{
  double phi = wall_share_[i];
  bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
    const double q = i == b.i ? b.lever_i.dot(b.normal) : -b.lever_j.dot(b.normal);
    phi += b.area * q / packing_.volume[i];
  });
  lambda_per_volume_[i] = material_.volumetric_stiffness<dim>(phi) / packing_.volume[i];
}

template <int dim>
void ManyBodyForce<dim>::dilatation(const Particles &particles, const SurfaceLoads<dim> &surface,
                                    std::vector<double> &pressure) const
{
  pressure.assign(packing_.size(), 0.);
  if (material_.poissons_ratio == 0)
    return;
  bonds_.for_each_bond([&](BondId, const Bond<dim> &b) {
    const BondMotion<dim> m(b, Turn<dim>::of(particles, b.i), Turn<dim>::of(particles, b.j),
                            get(particles.displacement, b.i), get(particles.displacement, b.j));
    const double s_r = b.area / b.distance;
    pressure[b.i] += lambda_per_volume_[b.i] * s_r * m.a_i.dot(m.du);
    pressure[b.j] -= lambda_per_volume_[b.j] * s_r * m.a_j.dot(m.du);
  });
  surface.add_dilatation(particles, lambda_per_volume_, pressure);
}

template <int dim>
void ManyBodyForce<dim>::elastic_forces(Particles &particles, SurfaceLoads<dim> &surface,
                                        std::vector<double> &pressure) const
{
  dilatation(particles, surface, pressure);
  for (auto *arrays : {&particles.force})
    for (auto &a : *arrays)
      std::fill(a.begin(), a.end(), 0.);
  for (auto &a : particles.torque)
    std::fill(a.begin(), a.end(), 0.);
  const double two_g = 2 * material_.shear_modulus();
  bonds_.for_each_bond([&](BondId, const Bond<dim> &b) {
    const BondMotion<dim> m(b, Turn<dim>::of(particles, b.i), Turn<dim>::of(particles, b.j),
                            get(particles.displacement, b.i), get(particles.displacement, b.j));
    const double s_r = b.area / b.distance;
    const Vector<dim> f = s_r * (two_g * m.du + pressure[b.i] * m.a_i - pressure[b.j] * m.a_j);
    const Spin<dim> bend = bending_torque(b, particles);
    add(particles.force, b.i, f);
    add(particles.force, b.j, Vector<dim>(-f));
    add(particles.torque, b.i,
        Spin<dim>(cross(m.a_i, f) - s_r * pressure[b.i] * cross(m.a_i, m.du) + bend));
    add(particles.torque, b.j,
        Spin<dim>(-cross(m.a_j, f) + s_r * pressure[b.j] * cross(m.a_j, m.du) - bend));
  });
  surface.add_forces(particles, pressure);
}

template <int dim>
void ManyBodyForce<dim>::compute(Particles &particles, double time)
{
  surface_.set_time(time);
  elastic_forces(particles, surface_, pressure_);
  surface_.book_work(particles, pressure_);
}

template <int dim>
double ManyBodyForce<dim>::potential_energy(const Particles &particles) const
{
  double sum = surface_.energy(particles);
  bonds_.for_each_bond([&](BondId, const Bond<dim> &b) {
    const BondMotion<dim> m(b, Turn<dim>::of(particles, b.i), Turn<dim>::of(particles, b.j),
                            get(particles.displacement, b.i), get(particles.displacement, b.j));
    sum += material_.shear_modulus() * b.area / b.distance * m.du.squaredNorm() +
           bending_energy(b, particles);
  });
  std::vector<double> pressure;
  dilatation(particles, surface_, pressure);
  for (int i = 0; i < packing_.size(); ++i)
    if (lambda_per_volume_[i] != 0) // 1/2 lambda V theta^2 = 1/2 (lambda theta)^2 / (lambda / V)
      sum += 0.5 * pressure[i] * pressure[i] / lambda_per_volume_[i];
  return sum;
}

template <int dim>
particles::ElasticConstants<dim> ManyBodyForce<dim>::elastic_constants() const
{
  return material_.elastic_constants<dim>();
}

template class ManyBodyForce<2>;
template class ManyBodyForce<3>;
} // namespace ligament::dem
