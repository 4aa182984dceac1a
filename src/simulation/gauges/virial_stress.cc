#include "src/simulation/gauges/virial_stress.h"

#include "src/simulation/gauges/tensor_columns.h"

#include "core/check.h"
#include "core/exact_sum.h"

#include <Eigen/Dense>
#include <fmt/format.h>

namespace ligament::program
{
namespace
{
/// Of dim x dim numbers.
template <int dim>
struct MatrixSum
{
  std::array<core::ExactSum, dim * dim> sums;

  void add(const Eigen::Matrix<double, dim, dim> &m)
  {
    for (int k = 0; k < dim * dim; ++k)
      sums[k].add(m(k / dim, k % dim));
  }
  Eigen::Matrix<double, dim, dim> value() const
  {
    Eigen::Matrix<double, dim, dim> m;
    for (int k = 0; k < dim * dim; ++k)
      m(k / dim, k % dim) = sums[k].value();
    return m;
  }
};
} // namespace

template <int dim>
VirialStressGauge<dim>::VirialStressGauge(const GaugeParameters &gauge,
                                          const GaugePlaces<dim> &places)
    : name_(gauge.name), angle_(gauge.angle), is_warm_(places.scene.is_warm())
{
  const auto &atoms = places.body.zone->state;
  const auto *overlap = places.body.coupler->overlap();
  const Vector<dim> lower = to_vector<dim>(gauge.lower), upper = to_vector<dim>(gauge.upper);
  for (int i = 0; i < atoms.size(); ++i) {
    const Vector<dim> x = get(atoms.reference, i);
    const bool inside = (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
    if (!inside || (overlap && overlap->member_of_particle[i] >= 0))
      continue;
    motion_.particles.push_back({i, 0, x});
    middle_ += x;
    volume_ += atoms.volume[i];
  }
  const std::size_t n = motion_.particles.size();
  core::require(n > 2 * dim, fmt::format("{} atoms outside the overlap lie in its box, too few for "
                                         "a mean; move or enlarge it",
                                         n));
  middle_ /= double(n);
  Matrix moment = Matrix::Zero();
  for (auto &term : motion_.particles) {
    term.value = 1. / double(n);
    term.gradient -= middle_;
    moment += term.gradient * term.gradient.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(moment);
  core::require(axes.eigenvalues()[0] > 1e-9 * axes.eigenvalues()[dim - 1],
                "the atoms in its box lie in one line or plane, which has no volume; enlarge it");
  const Matrix inverse = moment.inverse();
  for (auto &term : motion_.particles)
    term.gradient = inverse * term.gradient;
  description_ = fmt::format("of {} atoms outside the overlap, {}; costs a look at all bonds for "
                             "each row",
                             n, is_warm_ ? "with the momentum of their heat" : "without motion");
}

template <int dim>
std::vector<Column> VirialStressGauge<dim>::columns() const
{
  return tensor_columns<dim>(name_, "Pa");
}

// By M7 and the volumes of the reference; then over what these have become.
template <int dim>
void VirialStressGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  const auto &atoms = look.body.zone->state;
  const auto &stresses = look.stresses();
  MatrixSum<dim> bonds;
  for (const auto &term : motion_.particles)
    bonds.add(atoms.volume[term.item] * tensor_of<dim>(get(stresses, term.item)));
  Matrix sum = bonds.value();
  if (is_warm_)
    sum -= momentum_flux(atoms);
  const double growth = (Matrix::Identity() + motion_.gradient(look.body)).determinant();
  put_turned<dim>(sum / (growth * volume_), angle_, values);
}

// Of n atoms 1 + dim numbers per component are fitted, which takes as many of their n degrees of
// freedom.
template <int dim>
typename VirialStressGauge<dim>::Matrix
VirialStressGauge<dim>::momentum_flux(const particles::Particles<dim> &atoms) const
{
  MatrixSum<dim> gradients;
  std::array<core::ExactSum, dim> means;
  for (const auto &term : motion_.particles) {
    const Vector<dim> v = get(atoms.velocity, term.item);
    gradients.add(v * term.gradient.transpose());
    for (int c = 0; c < dim; ++c)
      means[c].add(term.value * v[c]);
  }
  const Matrix gradient = gradients.value();
  Vector<dim> mean;
  for (int c = 0; c < dim; ++c)
    mean[c] = means[c].value();
  MatrixSum<dim> flux;
  for (const auto &term : motion_.particles) {
    const Vector<dim> w = get(atoms.velocity, term.item) - mean -
                          gradient * (get(atoms.reference, term.item) - middle_);
    flux.add(atoms.mass[term.item] * w * w.transpose());
  }
  const double n = double(motion_.particles.size());
  return n / (n - 1 - dim) * flux.value();
}

template class VirialStressGauge<2>;
template class VirialStressGauge<3>;
} // namespace ligament::program
