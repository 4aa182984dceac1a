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
  core::require(!rest_ || rest_->is_exact(), "what is held at rest by a threshold could yield");
  pressure_share_ = is_plane_strain() ? 2 * std::abs(materials_.base().poissons_ratio) : 0;
  constexpr double round_off = 1e-9;
  yield_traction_ =
      (1 - round_off) * law->elastic_limit() / (largest_lever_share_ + pressure_share_);
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
PlasticRows<dim> ManyBodyForce<dim>::plastic_rows(const Particles &p, Workspace &work) const
{
  return {arrays(p, work),     kernel_.constants(), &bonds_.segments(),
          plastic_->strains(), plastic_->turned(),  bonds_.n_particles()};
}

template <int dim>
template <typename Visit>
void ManyBodyForce<dim>::for_each_plastic_force(const Particles &p, Workspace &work,
                                                Visit &&visit) const
{
  using Rows = PlasticRows<dim>;
  Rows rows = plastic_rows(p, work);
  const auto ranges = plastic_->around_plastic();
  const bool has_rows = bonds_.n_directions() > 0;
  std::vector<double> sums(Rows::n_forces * TractionScreen::block, 0.);
  rows.sums = sums.data();
  if (has_rows)
    for (const RowRange &range : plastic_->and_neighbours(ranges))
      turn_plastic(rows, range);
  for (const RowRange &range : ranges) {
    if (has_rows)
      sum_plastic(rows, range, Rows::Sums::forces);
    for (int i = range.begin; i < range.end; ++i) {
      const double *const sum = sums.data() + (i - range.begin);
      Vector<dim> force;
      Spin<dim> torque;
      for (int c = 0; c < dim; ++c)
        force[c] = sum[c * TractionScreen::block];
      for (int c = 0; c < n_spins<dim>; ++c)
        torque[c] = sum[(dim + c) * TractionScreen::block];
      double energy = sum[n_particle_dofs<dim> * TractionScreen::block];
      bonds_.for_each_entry_of(i, [&](BondId, const Bond<dim> &b) {
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
        energy -= 0.25 * f.dot(2 * m.du - part[0] - part[1]);
      });
      visit(i, force, torque, energy);
    }
  }
}

template <int dim>
void ManyBodyForce<dim>::add_plastic_forces(Particles &p, Workspace &work) const
{
  work.plastic_energy = 0;
  for_each_plastic_force(
      p, work, [&](int i, const Vector<dim> &force, const Spin<dim> &torque, double energy) {
        add(p.force, i, force);
        add(p.torque, i, torque);
        work.plastic_energy += energy;
      });
}

template <int dim>
double ManyBodyForce<dim>::plastic_energy(const Particles &p, Workspace &work) const
{
  double sum = 0;
  for_each_plastic_force(
      p, work, [&](int, const Vector<dim> &, const Spin<dim> &, double energy) { sum += energy; });
  return sum;
}

template <int dim>
double ManyBodyForce<dim>::flowing_energy(const Particles &p) const
{
  double sum = work_.plastic_energy + surface_.energy(p);
  for (int i = 0; i < bonds_.n_particles(); ++i)
    if (lambda_per_volume_[i] != 0)
      sum += 0.5 * work_.pressure[i] * work_.pressure[i] / lambda_per_volume_[i];
  return sum;
}

template <int dim>
void ManyBodyForce<dim>::particle_stresses(const Particles &p, const PlasticRows<dim> &rows,
                                           const RowRange &range, std::vector<Tensor> &stress) const
{
  using Matrix = typename PlasticBlocks<dim>::Matrix;
  stress.clear();
  if (bonds_.n_directions() > 0)
    sum_plastic(rows, range, PlasticRows<dim>::Sums::stresses);
  const double twice_shear = 2 * materials_.base().shear_modulus();
  for (int i = range.begin; i < range.end; ++i) {
    Matrix moment;
    for (int c = 0; c < dim * dim; ++c)
      moment(c / dim, c % dim) = rows.sums[c * TractionScreen::block + (i - range.begin)];
    bonds_.for_each_entry_of(i, [&](BondId, const Bond<dim> &b) {
      const BondMotion<dim> m = motion(b, p);
      const Vector<dim> f = bond_force(b, m, work_.pressure);
      moment += b.i == i ? Matrix(f * m.a_i.transpose()) : Matrix(-f * m.a_j.transpose());
    });
    if (std::binary_search(plastic_->always().begin(), plastic_->always().end(), i))
      surface_.for_each_moment(p, work_.pressure,
                               [&](int k, const Vector<dim> &a, const Vector<dim> &f) {
                                 if (k == i)
                                   moment += f * a.transpose();
                               });
    const Matrix r = matrix_of(Turn<dim>::of(p, i));
    const Matrix in_plane = r.transpose() * (moment + moment.transpose()) * r / (2 * p.volume[i]);
    const double zz =
        is_plane_strain() ? work_.pressure[i] - twice_shear * plastic_->tensor(i)[2] : 0;
    stress.push_back(to_tensor(in_plane, zz));
  }
}

template <int dim>
void ManyBodyForce<dim>::update_flowed_volume(int i, double volume)
{
  double sum = is_plane_strain() ? volume * plastic_->strain_zz(i) : 0;
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
    for (int b = 0; b < plastic_->n_blocks(); ++b) {
      const int begin = b * TractionScreen::block,
                end = std::min(begin + TractionScreen::block, bonds_.n_particles());
      int found = 0; // without a branch, so that it is done in vectors
      for (int i = begin; i < end; ++i)
        found |= std::abs(work_.pressure[i]) >= pressure_share_ * yield_traction_;
      work_.marks[b] |= std::uint8_t(found);
    }
  std::vector<std::pair<int, Tensor>> increments;
  std::vector<Tensor> stress, increment(TractionScreen::block);
  const auto suspects = plastic_->suspects(work_.marks);
  PlasticRows<dim> rows = plastic_rows(p, work_);
  std::vector<double> sums(PlasticRows<dim>::n_stresses * TractionScreen::block, 0.);
  rows.sums = sums.data();
  if (bonds_.n_directions() > 0)
    for (const RowRange &range : plastic_->and_neighbours(suspects))
      turn_plastic(rows, range);
  for (const RowRange &range : suspects) {
    particle_stresses(p, rows, range, stress);
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
    for (int i = 0; i < bonds_.n_particles(); ++i)
      sum += get(p.velocity, i).dot(get(p.force, i)) + get(p.spin, i).dot(get(p.torque, i));
    return sum;
  };
  double taken = flowing_energy(p) + 0.5 * (time_ - last_time_) * power();
  const int n_before = plastic_->n_plastic_blocks();
  for (const auto &[i, tensor] : increments)
    plastic_->add(i, tensor);
  if (plastic_->n_plastic_blocks() > n_before)
    find_other_particles();
  for (const auto &[i, tensor] : increments)
    update_flowed_volume(i, p.volume[i]);
  surface_.set_plastic([&](int i) { return plastic_->strain(i); });
  elastic_forces(p, surface_, true, work_);
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
template void ManyBodyForce<2>::add_plastic_forces(Particles &, Workspace &) const;
template void ManyBodyForce<3>::add_plastic_forces(Particles &, Workspace &) const;
template double ManyBodyForce<2>::plastic_energy(const Particles &, Workspace &) const;
template double ManyBodyForce<3>::plastic_energy(const Particles &, Workspace &) const;
template double ManyBodyForce<2>::flowed_volume(const Bond<2> &, int) const;
template double ManyBodyForce<3>::flowed_volume(const Bond<3> &, int) const;
template void ManyBodyForce<2>::update_flowed_volume(int, double);
template void ManyBodyForce<3>::update_flowed_volume(int, double);
template void ManyBodyForce<2>::flow(Particles &);
template void ManyBodyForce<3>::flow(Particles &);
} // namespace ligament::dem
