// Plastic flow: a sweep over the blocks of particles whose bonds say that one of them could yield,
// theory.md section 1.10.
#include "dem/many_body_force.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
namespace
{
/// R of a turn.
template <int dim>
Eigen::Matrix<double, dim, dim> matrix_of(const Turn<dim> &turn)
{
  Eigen::Matrix<double, dim, dim> r;
  for (int c = 0; c < dim; ++c)
    r.col(c) = Vector<dim>::Unit(c) + turn.change(Vector<dim>::Unit(c));
  return r;
}

Tensor to_tensor(const Eigen::Matrix2d &m, double zz)
{
  Tensor t;
  t << m(0, 0), m(1, 1), zz, 0, 0, m(0, 1);
  return t;
}
Tensor to_tensor(const Eigen::Matrix3d &m, double)
{
  Tensor t;
  t << m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1);
  return t;
}
} // namespace

template <int dim>
void ManyBodyForce<dim>::set_yield(std::unique_ptr<const YieldLaw> law)
{
  core::require(interfaces_.empty() && energy_weights_.empty(),
                "plastic flow needs a body of one elastic material with its whole energy");
  std::vector<double> load(packing_.size(), 0.);
  bonds_.for_each_bond([&](BondId, const Bond<dim> &b) {
    load[b.i] += b.area * b.lever_i.norm() / packing_.volume[b.i];
    load[b.j] += b.area * b.lever_j.norm() / packing_.volume[b.j];
  });
  const double most = *std::max_element(load.begin(), load.end());
  pressure_share_ = is_plane_strain() ? 2 * std::abs(materials_.base().poissons_ratio) : 0;
  constexpr double round_off = 1e-9;
  yield_traction_ = (1 - round_off) * law->elastic_limit() / (most + pressure_share_);
  core::require(yield_traction_ > 0, "the elastic limit must be positive");
  flowed_at_.reset();
  plastic_ = std::make_unique<PlasticBlocks<dim>>(bonds_, std::move(law), surface_.particles());
}

template <int dim>
bool ManyBodyForce<dim>::is_plane_strain() const
{
  return dim == 2 && materials_.base().plane == PlaneMode::strain;
}

template <int dim>
std::array<Vector<dim>, 2> ManyBodyForce<dim>::plastic_stretch(const Bond<dim> &b,
                                                               const Turn<dim> &turn_i,
                                                               const Turn<dim> &turn_j) const
{
  const double q_i = b.lever_i.dot(b.normal), q_j = -b.lever_j.dot(b.normal);
  const Vector<dim> part_i = q_j * (plastic_->strain(b.i) * b.normal),
                    part_j = q_i * (plastic_->strain(b.j) * b.normal);
  return {Vector<dim>(part_i + turn_i.change(part_i)), Vector<dim>(part_j + turn_j.change(part_j))};
}

template <int dim>
void ManyBodyForce<dim>::add_plastic_forces(Particles &p) const
{
  for (const RowRange &range : plastic_->around_plastic())
    for (int i = range.begin; i < range.end; ++i) {
      Vector<dim> force = Vector<dim>::Zero();
      Spin<dim> torque = Spin<dim>::Zero();
      bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
        if (!plastic_->is_plastic(b.i) && !plastic_->is_plastic(b.j))
          return;
        const auto turn_i = Turn<dim>::of(p, b.i), turn_j = Turn<dim>::of(p, b.j);
        const BondMotion<dim> m(b, turn_i, turn_j, get(p.displacement, b.i),
                                get(p.displacement, b.j));
        const auto part = plastic_stretch(b, turn_i, turn_j);
        const double stiffness = 2 * b.shear_i * b.area / b.distance;
        const Vector<dim> f = stiffness * (part[0] + part[1]),
                          rest = stiffness * m.du - f; // without the pressures' part
        const bool first = b.i == i;
        force += first ? Vector<dim>(-f) : f;
        torque += first ? Spin<dim>(cross(part[0], rest) - cross(m.a_i, f))
                        : Spin<dim>(cross(part[1], rest) + cross(m.a_j, f));
      });
      add(p.force, i, force);
      add(p.torque, i, torque);
    }
}

template <int dim>
double ManyBodyForce<dim>::plastic_energy(const Particles &p) const
{
  double sum = 0;
  for (const RowRange &range : plastic_->around_plastic())
    for (int i = range.begin; i < range.end; ++i)
      bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
        if (b.i != i || (!plastic_->is_plastic(b.i) && !plastic_->is_plastic(b.j)))
          return;
        const BondMotion<dim> m = motion(b, p);
        sum += b.shear_i * b.area / b.distance * (m.elastic.squaredNorm() - m.du.squaredNorm());
      });
  return sum;
}

template <int dim>
double ManyBodyForce<dim>::flowing_energy(const Particles &p) const
{
  double sum = plastic_energy(p) + surface_.energy(p);
  for (int i = 0; i < packing_.size(); ++i)
    if (lambda_per_volume_[i] != 0)
      sum += 0.5 * work_.pressure[i] * work_.pressure[i] / lambda_per_volume_[i];
  return sum;
}

template <int dim>
void ManyBodyForce<dim>::particle_stresses(const Particles &p, const RowRange &range,
                                           std::vector<Tensor> &stress) const
{
  stress.clear();
  for (int i = range.begin; i < range.end; ++i) {
    using Matrix = typename PlasticBlocks<dim>::Matrix;
    Matrix moment = Matrix::Zero();
    bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
      const BondMotion<dim> m = motion(b, p);
      const Vector<dim> f = bond_force(b, m, work_.pressure);
      moment += b.i == i ? Matrix(m.a_i * f.transpose()) : Matrix(-m.a_j * f.transpose());
    });
    if (std::binary_search(plastic_->always().begin(), plastic_->always().end(), i))
      surface_.for_each_moment(p, work_.pressure,
                               [&](int k, const Vector<dim> &a, const Vector<dim> &f) {
                                 if (k == i)
                                   moment += a * f.transpose();
                               });
    const Matrix r = matrix_of(Turn<dim>::of(p, i));
    const Matrix in_plane =
        r.transpose() * (moment + moment.transpose()) * r / (2 * packing_.volume[i]);
    const double zz =
        is_plane_strain()
            ? work_.pressure[i] - 2 * materials_.base().shear_modulus() * plastic_->tensor(i)[2]
            : 0;
    stress.push_back(to_tensor(in_plane, zz));
  }
}

template <int dim>
void ManyBodyForce<dim>::update_flowed_volume(int i)
{
  double sum = is_plane_strain() ? packing_.volume[i] * plastic_->strain_zz(i) : 0;
  bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) { sum += flowed_volume(b, i); });
  plastic_->flowed_volume(i) = sum;
}

template <int dim>
double ManyBodyForce<dim>::flowed_volume(const Bond<dim> &b, int i) const
{
  const Vector<dim> stretch = b.area * (plastic_->strain(i) * b.normal);
  return i == b.i ? b.lever_i.dot(stretch) : -b.lever_j.dot(stretch);
}

template <int dim>
void ManyBodyForce<dim>::flow(Particles &p)
{
  if (flowed_at_ && *flowed_at_ == time_)
    return;
  flowed_at_ = time_;
  if (pressure_share_ > 0)
    for (int i = 0; i < packing_.size(); ++i)
      if (std::abs(work_.pressure[i]) >= pressure_share_ * yield_traction_)
        work_.marks[i / TractionScreen::block] = 1;
  std::vector<std::pair<int, Tensor>> increments;
  std::vector<Tensor> stress, increment(TractionScreen::block);
  for (const RowRange &range : plastic_->suspects(work_.marks)) {
    particle_stresses(p, range, stress);
    plastic_->law().flow(range.end - range.begin, stress.data(), plastic_->history() + range.begin,
                         increment.data());
    for (int i = range.begin; i < range.end; ++i)
      if (!increment[i - range.begin].isZero(0))
        increments.push_back({i, increment[i - range.begin]});
  }
  if (increments.empty())
    return;

  // Energy that leaves at fixed positions; the leap-frog's invariant counts the kinetic energy with
  // the force in it, so that of the force's change belongs to the balance.
  const auto power = [&] {
    double sum = 0;
    for (int i = 0; i < packing_.size(); ++i)
      sum += get(p.velocity, i).dot(get(p.force, i)) + get(p.spin, i).dot(get(p.torque, i));
    return sum;
  };
  double taken = flowing_energy(p) + 0.5 * (time_ - last_time_) * power();
  for (const auto &[i, tensor] : increments)
    plastic_->add(i, tensor);
  for (const auto &[i, tensor] : increments)
    update_flowed_volume(i);
  surface_.set_plastic([&](int i) { return plastic_->strain(i); });
  elastic_forces(p, surface_, strength(), work_);
  taken -= flowing_energy(p) + 0.5 * (time_ - last_time_) * power();
  plastic_dissipation_ += taken;
}

template void ManyBodyForce<2>::set_yield(std::unique_ptr<const YieldLaw>);
template void ManyBodyForce<3>::set_yield(std::unique_ptr<const YieldLaw>);
template bool ManyBodyForce<2>::is_plane_strain() const;
template bool ManyBodyForce<3>::is_plane_strain() const;
template std::array<Vector<2>, 2>
ManyBodyForce<2>::plastic_stretch(const Bond<2> &, const Turn<2> &, const Turn<2> &) const;
template std::array<Vector<3>, 2>
ManyBodyForce<3>::plastic_stretch(const Bond<3> &, const Turn<3> &, const Turn<3> &) const;
template void ManyBodyForce<2>::add_plastic_forces(Particles &) const;
template void ManyBodyForce<3>::add_plastic_forces(Particles &) const;
template double ManyBodyForce<2>::plastic_energy(const Particles &) const;
template double ManyBodyForce<3>::plastic_energy(const Particles &) const;
template double ManyBodyForce<2>::flowed_volume(const Bond<2> &, int) const;
template double ManyBodyForce<3>::flowed_volume(const Bond<3> &, int) const;
template void ManyBodyForce<2>::update_flowed_volume(int);
template void ManyBodyForce<3>::update_flowed_volume(int);
template void ManyBodyForce<2>::flow(Particles &);
template void ManyBodyForce<3>::flow(Particles &);
} // namespace ligament::dem
