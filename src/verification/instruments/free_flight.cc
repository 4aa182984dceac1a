#include "src/verification/instruments/free_flight.h"

#include "core/polar_rotation.h"

namespace ligament::program
{
namespace
{
template <int dim>
Vector<dim> place_of(const fem::FemSolver<dim> &far, int node)
{
  return far.mesh().nodes[node] + get(far.displacement, node);
}

/// Of the nodes: those that the coupler moves by its mass, the others by their own.
template <int dim>
Spin<dim> of_mesh(const CoupledBody<dim> &body)
{
  const auto &far = *body.far;
  Spin<dim> sum = Spin<dim>::Zero();
  for (int i = 0; i < far.mesh().n_nodes(); ++i)
    if (!far.is_released_node(i))
      sum += far.lumped_mass()[i] * core::moment(place_of(far, i), get(far.velocity, i));
  const auto *overlap = body.coupler->overlap();
  if (!overlap)
    return sum;
  Eigen::MatrixXd v(overlap->n_nodes(), dim);
  for (int i = 0; i < overlap->n_nodes(); ++i)
    v.row(i) = get(far.velocity, overlap->near_nodes[i]).transpose();
  const Eigen::MatrixXd momentum = body.coupler->near_mass() * v;
  for (int i = 0; i < overlap->n_nodes(); ++i)
    sum += core::moment(place_of(far, overlap->near_nodes[i]),
                        Vector<dim>(momentum.row(i).transpose()));
  return sum;
}

/// Of the particles; in the overlap of what the mesh does not carry.
template <int dim>
Spin<dim> of_particles(const CoupledBody<dim> &body)
{
  const auto *overlap = body.coupler->overlap();
  const auto &zone = body.zone->state;
  Spin<dim> sum = Spin<dim>::Zero();
  for (int i = 0; i < zone.size(); ++i) {
    Vector<dim> x = get(zone.reference, i) + get(zone.displacement, i), w = get(zone.velocity, i);
    const int index = overlap ? overlap->member_of_particle[i] : -1;
    if (index >= 0)
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
        const auto &m = overlap->members[index];
        const int node = overlap->near_nodes[m.nodes[a]];
        x -= m.value[a] * place_of(*body.far, node);
        w -= m.value[a] * get(body.far->velocity, node);
      }
    if (index >= 0 && overlap->members[index].pad)
      continue;
    sum += zone.mass[i] * core::moment(x, w) + zone.inertia(i) * get(zone.spin, i);
  }
  return sum;
}
} // namespace

template <int dim>
Spin<dim> angular_momentum(const CoupledBody<dim> &body)
{
  Spin<dim> sum = Spin<dim>::Zero();
  if (body.far)
    sum += of_mesh(body);
  if (body.zone)
    sum += of_particles(body);
  return sum;
}

template <int dim>
double energy_change(CoupledBody<dim> &body, long n_steps)
{
  auto bodies = body.bodies();
  double sum[2] = {}, number[2] = {}; // first, last
  coupling::StepTime step;
  step.dt = body.dt;
  for (; step.step < n_steps; ++step.step, step.time = double(step.step) * step.dt) {
    body.coupler->compute_forces(bodies, step);
    const bool begins = step.step < n_steps / 10, ends = step.step >= n_steps - n_steps / 10;
    if ((begins || ends) && step.step % 5 == 0) {
      const auto e = body.coupler->energy(bodies, step);
      sum[ends] +=
          e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended;
      number[ends] += 1;
    }
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  return std::abs(sum[1] / number[1] / (sum[0] / number[0]) - 1);
}

template Spin<2> angular_momentum(const CoupledBody<2> &);
template Spin<3> angular_momentum(const CoupledBody<3> &);
template double energy_change(CoupledBody<2> &, long);
template double energy_change(CoupledBody<3> &, long);
} // namespace ligament::program
