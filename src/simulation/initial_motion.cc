#include "src/simulation/initial_motion.h"

#include "src/scene/geometry.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace ligament::program
{
namespace
{
template <int dim>
struct Motion
{
  Vector<dim> velocity;
  Spin<dim> spin;
};

template <int dim>
bool holds(const Region &region, const Vector<dim> &x)
{
  double distance = 0;
  for (int c = 0; c < dim; ++c) {
    if (region.is_ball())
      distance += std::pow(x[c] - region.centre[c].value_or(0), 2);
    else if (x[c] < region.lower[c] || x[c] > region.upper[c])
      return false;
  }
  return distance <= region.radius * region.radius || !region.is_ball();
}

template <int dim>
Motion<dim> motion_at(const Scene &scene, const Vector<dim> &x)
{
  Motion<dim> motion{Vector<dim>::Zero(), Spin<dim>::Zero()};
  for (const InitialMotion &m : scene.initial_motion) {
    if (!holds<dim>(m.within, x))
      continue;
    const Vector<dim> arm = x - Vector<dim>(m.centre.data());
    const Spin<dim> spin(m.spin.data());
    motion.velocity += Vector<dim>(m.velocity.data());
    if constexpr (dim == 2)
      motion.velocity += spin[0] * Vector<2>(-arm[1], arm[0]);
    else
      motion.velocity += spin.cross(arm);
    motion.spin += spin;
  }
  return motion;
}

/// Of all particles, whatever the overlap makes of them.
template <int dim>
void move_particles(const Scene &scene, particles::Particles<dim> &zone)
{
  for (int i = 0; i < zone.size(); ++i) {
    const Motion<dim> motion = motion_at<dim>(scene, get(zone.reference, i));
    set(zone.velocity, i, motion.velocity);
    if (zone.turns)
      set(zone.spin, i, motion.spin);
  }
}

template <int dim>
void move_members(const coupling::Overlap<dim> &overlap, CoupledBody<dim> &body)
{
  auto &zone = body.zone->state;
  for (const auto &member : overlap.members) {
    Motion<dim> motion{Vector<dim>::Zero(), Spin<dim>::Zero()};
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
      const Vector<dim> v = get(body.far->velocity, overlap.near_nodes[member.nodes[a]]);
      motion.velocity += member.value[a] * v;
      motion.spin += overlap.spin_block(member, a) * v;
    }
    set(zone.velocity, member.particle, motion.velocity);
    if (zone.turns)
      set(zone.spin, member.particle, motion.spin);
  }
}
} // namespace

bool begins_with_spin(const Scene &scene)
{
  return std::any_of(scene.initial_motion.begin(), scene.initial_motion.end(),
                     [](const InitialMotion &m) {
                       return m.spin != Point{0, 0, 0};
                     });
}

template <int dim>
void start_motion(const Scene &scene, CoupledBody<dim> &body)
{
  if (scene.initial_motion.empty())
    return;
  if (body.far) {
    auto &far = *body.far;
    for (int i = 0; i < far.mesh().n_nodes(); ++i)
      set(far.velocity, i, motion_at<dim>(scene, far.mesh().nodes[i]).velocity);
    far.distribute();
  }
  if (body.zone)
    move_particles<dim>(scene, body.zone->state);
  if (const auto *overlap = body.coupler->overlap())
    move_members<dim>(*overlap, body);
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
  const auto e = body.coupler->energy(bodies, {0, 0, body.dt}); // no force acts yet
  body.started = e.kinetic_discrete + e.kinetic_far;
}

template <int dim>
bool moves_any(const Region &region, const CoupledBody<dim> &body)
{
  bool any = false;
  for (int i = 0; body.far && i < body.far->mesh().n_nodes() && !any; ++i)
    any = holds<dim>(region, body.far->mesh().nodes[i]);
  for (int i = 0; body.zone && i < body.zone->state.size() && !any; ++i)
    any = holds<dim>(region, get(body.zone->state.reference, i));
  return body.ranks.any(any);
}

template bool moves_any(const Region &, const CoupledBody<2> &);
template bool moves_any(const Region &, const CoupledBody<3> &);
template void start_motion(const Scene &, CoupledBody<2> &);
template void start_motion(const Scene &, CoupledBody<3> &);
} // namespace ligament::program
