#include "src/simulation/tools/rigid_tool.h"

#include <Eigen/Geometry>

#include <cmath>

namespace ligament::program
{
template <int dim>
RigidTool<dim>::RigidTool(ToolDefinition<dim> definition) : definition_(std::move(definition))
{
  const Vector<dim> zero = Vector<dim>::Zero();
  now_.centre = definition_.place;
  now_.velocity = definition_.velocity;
  now_.work = definition_.mass / 2 * definition_.velocity.squaredNorm();
  now_.zone_force = now_.far_force = now_.spring_force = zero;
  now_.zone_centre = now_.far_centre = now_.drive_place = last_centre_ = drive_place_ = now_.centre;
}

template <int dim>
Vector<dim> RigidTool<dim>::drive(double time) const
{
  Vector<dim> place = definition_.place;
  if (definition_.drive)
    for (int c = 0; c < dim; ++c)
      if (definition_.drive->value[c])
        place[c] += definition_.drive->displacement(c, time);
  return place;
}

template <int dim>
void RigidTool<dim>::advance(double time, double dt)
{
  last_centre_ = now_.centre;
  drive_place_ = drive(time);
  if (!is_free()) {
    now_.centre = drive_place_;
    if (definition_.drive)
      for (int c = 0; c < dim; ++c)
        if (definition_.drive->value[c])
          now_.velocity[c] = definition_.drive->velocity(c, time);
  } else if (now_.has_acted != 0) {
    now_.centre += dt * now_.velocity;
    if constexpr (dim == 2)
      now_.rotation = Eigen::Rotation2Dd(dt * now_.spin[0]) * now_.rotation;
    else if (now_.spin.norm() > 0)
      now_.rotation =
          Eigen::AngleAxisd(dt * now_.spin.norm(), now_.spin.normalized()) * now_.rotation;
  }
}

// The drive moves the tool against what the body does to it, or the far end of the spring: the mean
// of the forces before and now times the way between, as everywhere (theory.md eq. (T6)).
template <int dim>
void RigidTool<dim>::finish(double dt, const Wrench<dim> &zone, const Wrench<dim> *far, int ratio)
{
  const bool is_first = now_.has_acted == 0;
  stretch_ = definition_.machine_stiffness > 0 ? Vector<dim>(drive_place_ - now_.centre)
                                               : Vector<dim>::Zero();
  const Vector<dim> spring = definition_.machine_stiffness * stretch_;
  if (!is_free() && !is_first) {
    now_.work -= (zone.force + now_.zone_force).dot(now_.centre - now_.zone_centre) / 2;
    if (far)
      now_.work -= (far->force + now_.far_force).dot(now_.centre - now_.far_centre) / 2;
  }
  // In the first step too: a drive without a ramp is where it ends from the start.
  if (is_free())
    now_.work += (spring + now_.spring_force).dot(drive_place_ - now_.drive_place) / 2;
  now_.zone_force = zone.force;
  now_.zone_centre = now_.centre;
  now_.spring_force = spring;
  now_.drive_place = drive_place_;
  if (far) {
    now_.far_force = far->force;
    now_.far_centre = now_.centre;
  }
  now_.has_acted = 1;
  if (!is_free())
    return;
  Vector<dim> force = zone.force + spring;
  Spin<dim> torque = zone.torque;
  if (far) {
    force += ratio * far->force;
    torque += ratio * far->torque;
  }
  const double mass = definition_.mass, inertia = definition_.inertia;
  const Vector<dim> change = dt / mass * force;
  kinetic_ = mass / 2 * now_.velocity.dot(now_.velocity + change);
  now_.velocity += change;
  if (inertia > 0) {
    const Spin<dim> turn = dt / inertia * torque;
    kinetic_ += inertia / 2 * now_.spin.dot(now_.spin + turn);
    now_.spin += turn;
  }
}

template <int dim>
void RigidTool<dim>::leave(double energy)
{
  now_.work -= energy + kinetic_ + spring();
  kinetic_ = 0;
  stretch_.setZero();
  now_.zone_force.setZero();
  now_.far_force.setZero();
  now_.gone = 1;
}

template <int dim>
template <typename M, typename Visit>
void RigidTool<dim>::for_each_number(M &m, Visit &&visit)
{
  const auto vector = [&](const std::string &name, auto &v) {
    for (int c = 0; c < int(v.size()); ++c)
      visit(name + std::to_string(c), v.data()[c]);
  };
  vector("centre_", m.centre);
  vector("velocity_", m.velocity);
  vector("rotation_", m.rotation);
  vector("spin_", m.spin);
  visit("work", m.work);
  visit("gone", m.gone);
  visit("has_acted", m.has_acted);
  vector("zone_force_", m.zone_force);
  vector("far_force_", m.far_force);
  vector("spring_force_", m.spring_force);
  vector("zone_centre_", m.zone_centre);
  vector("far_centre_", m.far_centre);
  vector("drive_place_", m.drive_place);
}

template <int dim>
void RigidTool<dim>::save(core::State &state, const std::string &prefix) const
{
  for_each_number(now_, [&](const std::string &name, double value) {
    core::save_value(state, "tools", prefix + name, value);
  });
}

template <int dim>
void RigidTool<dim>::load(const core::State &state, const std::string &prefix)
{
  for_each_number(now_, [&](const std::string &name, double &value) {
    value = core::load_real(state, "tools", prefix + name);
  });
  last_centre_ = now_.centre;
}

template class RigidTool<2>;
template class RigidTool<3>;
} // namespace ligament::program
