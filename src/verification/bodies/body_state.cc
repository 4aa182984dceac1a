#include "src/verification/bodies/body_state.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
template <typename Components>
const double *write(const double *value, Components &components)
{
  for (auto &component : components) {
    std::copy(value, value + component.size(), component.begin());
    value += component.size();
  }
  return value;
}

template <typename Components>
double *read(const Components &components, double *value)
{
  for (const auto &component : components)
    value = std::copy(component.begin(), component.end(), value);
  return value;
}

template <int dim>
const double *set_displacement(particles::Particles<dim> &zone, const double *value)
{
  value = write(value, zone.displacement);
  for (int c = 0; c < n_spins<dim> && zone.turns; ++c)
    for (int i = 0; i < zone.size(); ++i, ++value) {
      if constexpr (dim == 2)
        zone.rotation[0][i] = *value;
      else {
        zone.rotation[0][i] = 1; // quaternion of a rotation whose square is round-off
        zone.rotation[1 + c][i] = *value / 2;
      }
    }
  return value;
}
} // namespace

template <int dim>
int state_size(const CoupledBody<dim> &body)
{
  const int dofs = !body.zone ? 0 : body.zone->state.turns ? n_particle_dofs<dim> : dim;
  return (body.zone ? dofs * body.zone->state.size() : 0) +
         (body.far ? dim * body.far->mesh().n_nodes() : 0);
}

template <int dim>
void set_displacement(CoupledBody<dim> &body, const Eigen::VectorXd &u)
{
  const double *value = u.data();
  if (body.zone)
    value = set_displacement(body.zone->state, value);
  if (body.far)
    write(value, body.far->displacement);
}

template <int dim>
Eigen::VectorXd displacement(const CoupledBody<dim> &body)
{
  Eigen::VectorXd u(state_size(body));
  double *value = u.data();
  if (body.zone) {
    const auto &zone = body.zone->state;
    value = read(zone.displacement, value);
    for (int c = 0; c < n_spins<dim> && zone.turns; ++c)
      for (int i = 0; i < zone.size(); ++i)
        *value++ = dim == 2 ? zone.rotation[0][i] : 2 * zone.rotation[dim == 2 ? 0 : 1 + c][i];
  }
  if (body.far)
    read(body.far->displacement, value);
  return u;
}

template <int dim>
void set_velocity(CoupledBody<dim> &body, const Eigen::VectorXd &v)
{
  const double *value = v.data();
  if (body.zone) {
    value = write(value, body.zone->state.velocity);
    value = write(value, body.zone->state.spin);
  }
  if (!body.far)
    return;
  write(value, body.far->velocity);
  body.far->distribute();
}

template <int dim>
Eigen::VectorXd velocity(const CoupledBody<dim> &body)
{
  Eigen::VectorXd v(state_size(body));
  double *value = v.data();
  if (body.zone) {
    value = read(body.zone->state.velocity, value);
    value = read(body.zone->state.spin, value);
  }
  if (body.far)
    read(body.far->velocity, value);
  return v;
}

template <int dim>
Eigen::VectorXd admissible(CoupledBody<dim> &body, const Eigen::VectorXd &v)
{
  set_velocity(body, v);
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
  return velocity(body);
}

template int state_size(const CoupledBody<2> &);
template int state_size(const CoupledBody<3> &);
template void set_displacement(CoupledBody<2> &, const Eigen::VectorXd &);
template void set_displacement(CoupledBody<3> &, const Eigen::VectorXd &);
template Eigen::VectorXd displacement(const CoupledBody<2> &);
template Eigen::VectorXd displacement(const CoupledBody<3> &);
template void set_velocity(CoupledBody<2> &, const Eigen::VectorXd &);
template void set_velocity(CoupledBody<3> &, const Eigen::VectorXd &);
template Eigen::VectorXd velocity(const CoupledBody<2> &);
template Eigen::VectorXd velocity(const CoupledBody<3> &);
template Eigen::VectorXd admissible(CoupledBody<2> &, const Eigen::VectorXd &);
template Eigen::VectorXd admissible(CoupledBody<3> &, const Eigen::VectorXd &);
} // namespace ligament::program
