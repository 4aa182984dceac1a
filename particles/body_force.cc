#include "particles/body_force.h"

#include "particles/block_sum.h"

#include <cmath>

namespace ligament::particles
{
template <int dim>
BodyForce<dim>::BodyForce(const std::vector<core::BoundaryLoad<dim>> &loads)
{
  for (const auto &load : loads)
    if (load.kind == core::BoundaryLoad<dim>::Kind::acceleration)
      loads_.push_back(load);
}

template <int dim>
Vector<dim> BodyForce<dim>::acceleration(double time) const
{
  Vector<dim> sum = Vector<dim>::Zero();
  for (const auto &load : loads_)
    sum += load.traction(time);
  return sum;
}

template <int dim>
void BodyForce<dim>::add_forces(Particles<dim> &particles, double time) const
{
  const Vector<dim> a = acceleration(time);
  for (int c = 0; c < dim; ++c)
    if (a[c] != 0)
      for (const auto &[begin, end] : particles.part.stepped)
        for (int i = begin; i < end; ++i)
          if (std::isfinite(particles.mass[i])) // others are held
            particles.force[c][i] += particles.mass[i] * a[c];
}

template <int dim>
void BodyForce<dim>::book_work(const Particles<dim> &particles, double time)
{
  Vector<dim> moment;
  for (int c = 0; c < dim; ++c)
    moment[c] = block_sum(particles.part.owned, [&](int i) {
                  const double m = particles.mass[i];
                  return std::isfinite(m) ? m * particles.displacement[c][i] : 0.;
                }).value();
  const Vector<dim> a = acceleration(time);
  if (is_booked_)
    work_.add((a + old_acceleration_).dot(moment - old_moment_) / 2);
  is_booked_ = true;
  old_acceleration_ = a;
  old_moment_ = moment;
}

template <int dim>
void BodyForce<dim>::save(core::State &state) const
{
  core::save_sum(state, "body_force_work", work_);
  core::save_value(state, "body_force", "booked", std::int64_t(is_booked_));
  for (int c = 0; c < dim; ++c) {
    core::save_value(state, "body_force", "acceleration_" + std::to_string(c),
                     old_acceleration_[c]);
    core::save_value(state, "body_force", "moment_" + std::to_string(c), old_moment_[c]);
  }
}

template <int dim>
void BodyForce<dim>::load(const core::State &state)
{
  work_ = core::load_sum(state, "body_force_work");
  is_booked_ = core::load_integer(state, "body_force", "booked") != 0;
  for (int c = 0; c < dim; ++c) {
    old_acceleration_[c] =
        core::load_real(state, "body_force", "acceleration_" + std::to_string(c));
    old_moment_[c] = core::load_real(state, "body_force", "moment_" + std::to_string(c));
  }
}

template class BodyForce<2>;
template class BodyForce<3>;
} // namespace ligament::particles
