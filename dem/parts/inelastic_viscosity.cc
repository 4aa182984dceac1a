// What the viscous part of strains needs beside the kernels: the numbers of a step, and what a face
// takes along when it breaks.
#include "dem/parts/inelastic_strains.h"

#include <cmath>

namespace ligament::dem
{
ViscousNumbers::ViscousNumbers(const Viscosity &material, double shear_modulus)
    : material_(material), time_(material.dashpot / shear_modulus),
      branches_(material.branches.size())
{
  material.check();
  step_.n_branches = int(branches_.size());
  step_.branches = branches_.data();
  step_.has_dashpot = material.dashpot > 0;
  set_step(0);
}

void ViscousNumbers::set_step(double dt)
{
  step_.follows = dt > 0;
  step_.rate = dt > 0 ? time_ / dt : 0;
  step_.of_branches = 0;
  for (std::size_t k = 0; k < branches_.size(); ++k) {
    const auto &[share, time] = material_.branches[k];
    const double x = dt / time;
    branches_[k] = {share, std::exp(-x), x > 0 ? -std::expm1(-x) / x : 1};
    step_.of_branches += share * (1 - branches_[k].lead);
  }
}

template <int dim>
double InelasticStrains<dim>::longest_damping() const
{
  double longest = 0;
  for (const ViscousNumbers &v : viscous_)
    longest = std::max(longest, v.damping_time());
  return longest;
}

template <int dim>
void InelasticStrains<dim>::set_viscous_step(double time) const
{
  if (!is_viscous())
    return;
  for (std::size_t k = 0; k < parameters_.size(); ++k)
    viscous_[k].set_step(flowed_at_ ? time - *flowed_at_ : 0);
  if (flowed_at_)
    return;
  for (int i = 0; i < body_->n_particles(); ++i)
    if (laws_[law_number(i)].viscous)
      begun_[i / inelastic_block] = 1;
}

template <int dim>
auto InelasticStrains<dim>::viscous_tensor(int i, int stream) const -> Tensor
{
  Tensor t;
  for (int c = 0; c < n_tensor<dim>; ++c)
    t[c] = streams_.stream(stream + c)[i];
  return t;
}

template <int dim>
auto InelasticStrains<dim>::viscous_strain(int i) const -> Tensor
{
  return is_viscous() && is_strained(i) ? viscous_tensor(i, Streams::viscous) : Tensor::Zero();
}

template <int dim>
auto InelasticStrains<dim>::damped_strain(int i) const -> Tensor
{
  const ViscousStep &step = *laws_[law_number(i)].viscous;
  const Tensor driving = viscous_tensor(i, Streams::driving);
  Tensor damped = viscous_tensor(i, Streams::viscous);
  for (int k = 0; k < step.n_branches; ++k)
    damped -= step.branches[k].share *
              (driving - viscous_tensor(i, Streams::branches + k * n_tensor<dim>));
  return damped;
}

// The springs of the branches stretch with the whole, their dashpots don't follow at once; what the
// dashpot beside them resists begins anew, lest it takes the face that is missing for a rate.
template <int dim>
double InelasticStrains<dim>::lose_face(int i, double volume, const Tensor &jump,
                                        const Matrix &lost, double pressure)
{
  const FlowLaw &law = laws_[law_number(i)];
  Tensor deviator = jump;
  deviator.template head<3>().array() -= jump.template head<3>().mean();
  const Tensor viscous = viscous_tensor(i, Streams::viscous), damped = damped_strain(i);
  Matrix in_plane;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      in_plane(a, b) = damped[tensor_place<dim>(a, b)];
  const double grown =
      volume * (dot(damped, jump) - law.shear * (in_plane * in_plane).cwiseProduct(lost).sum());
  const Tensor moment = pressed(i);
  Tensor seen = (viscous_tensor(i, Streams::stress) - pressure * moment) / (2 * law.shear) +
                moved(i, viscous);
  if (dim == 2 && !body_->is_plane_strain())
    seen[2] = 0;
  if (const double square = dot(moment, moment); square > 0) // 0: that was its last face
    seen -= dot(seen, moment) / square * moment;
  for (int c = 0; c < n_tensor<dim>; ++c) {
    for (int k = 0; k < law.viscous->n_branches; ++k)
      streams_.stream(Streams::branches + k * n_tensor<dim> + c)[i] +=
          deviator[c] / (2 * law.shear);
    streams_.stream(Streams::driving + c)[i] += deviator[c] / (2 * law.shear);
    streams_.stream(Streams::rated + c)[i] = seen[c];
  }
  return grown;
}

// Its branches hold on to what has slid, the dashpot beside them lets go with the next step, which
// books both: a law of its own behind those of elastic particles.
template <int dim>
void InelasticStrains<dim>::forget_viscosity(int i)
{
  const int n = int(parameters_.size());
  if (!laws_[law_number(i)].viscous || law_number(i) >= n)
    return;
  keep_elastic({i});
  if (int(laws_.size()) == 2 * n)
    for (int k = 0; k < n; ++k) {
      laws_.push_back(laws_[n + k]);
      laws_.back().viscous = &viscous_[n + k].step();
    }
  law_of_[i] = std::uint8_t(law_of_[i] + n);
}

template class InelasticStrains<2>;
template class InelasticStrains<3>;
} // namespace ligament::dem
