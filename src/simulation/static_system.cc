#include "src/simulation/static_system.h"

#include "particles/turn_orientations.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ligament::program
{
namespace
{
/// Of small motions, in spacings. Rotations enter forces squared: about the reference this squared
/// is round-off. Elsewhere displacements are round-off of their own, and differences of two sides
/// lack no more than the square.
constexpr double about_reference = 1e-14, elsewhere = 1e-4;

/// The body turned by the spins over a time; 2D angles add.
template <int dim>
void turn(particles::Particles<dim> &zone, double time)
{
  if constexpr (dim == 2)
    for (int i = 0; i < zone.size(); ++i)
      zone.rotation[0][i] += time * zone.spin[0][i];
  else {
    std::array<double *, 4> q;
    std::array<const double *, 3> w;
    for (int k = 0; k < 4; ++k)
      q[k] = zone.rotation[k].data();
    for (int k = 0; k < 3; ++k)
      w[k] = zone.spin[k].data();
    particles::turn_orientations(q, w, time, zone.size());
  }
}
} // namespace

template <int dim>
StaticSystem<dim>::StaticSystem(CoupledBody<dim> &body)
    : body_(body), n_particles_(body.zone ? body.zone->state.size() : 0),
      n_nodes_(body.far ? body.far->mesh().n_nodes() : 0)
{
  find_inert();
  find_node_masses();
  if (!body.zone)
    return;
  motion_ = body.zone->state;
  about_.zone = motion_.displacement;
  about_.rotation = motion_.rotation;
  linearise_at_reference();
}

template <int dim>
void StaticSystem<dim>::find_inert()
{
  is_inert_.assign(std::size_t(block) * (n_particles_ + n_nodes_), 0);
  const auto set = [&](int row, int first, int end) {
    for (int c = first; c < end; ++c)
      is_inert_[row * block + c] = 1;
  };
  for (int i = 0; i < n_particles_; ++i)
    if (!body_.zone->state.turns)
      set(i, dim, block);
  if (const auto *overlap = body_.coupler->overlap())
    for (const auto &m : overlap->members)
      if (m.pad)
        set(m.particle, 0, block);
  for (int i = 0; i < n_nodes_; ++i) {
    set(node_block(i), dim, block);
    for (int c = 0; c < dim; ++c)
      if (body_.far->is_held(i, c))
        set(node_block(i), c, c + 1);
  }
  if (body_.far)
    for (const auto &hanging : body_.far->mesh().hanging)
      set(node_block(hanging.node), 0, dim);
}

template <int dim>
long StaticSystem<dim>::n_unknowns() const
{
  return long(std::count(is_inert_.begin(), is_inert_.end(), 0));
}

template <int dim>
Components<dim> StaticSystem<dim>::nodal_zero() const
{
  Components<dim> nodal;
  for (auto &component : nodal)
    component.assign(n_nodes_, 0.);
  return nodal;
}

template <int dim>
void StaticSystem<dim>::take(const Eigen::VectorXd &y, particles::Particles<dim> &zone,
                             Components<dim> &nodal) const
{
  for (int i = 0; i < n_particles_; ++i) {
    const double *const of = y.data() + std::size_t(i) * block;
    for (int c = 0; c < dim; ++c)
      zone.velocity[c][i] = of[c];
    for (int c = 0; c < n_spins<dim> && zone.turns; ++c)
      zone.spin[c][i] = of[dim + c];
  }
  for (int i = 0; i < n_nodes_; ++i)
    for (int c = 0; c < dim; ++c)
      nodal[c][i] = y[std::size_t(node_block(i)) * block + c];
  if (body_.far)
    body_.far->follow_masters(nodal);
  body_.coupler->expand(zone, nodal);
}

template <int dim>
Eigen::VectorXd StaticSystem<dim>::give(const particles::Particles<dim> &zone,
                                        const Components<dim> &nodal, double factor) const
{
  Eigen::VectorXd f = Eigen::VectorXd::Zero(size());
  for (int i = 0; i < n_particles_; ++i) {
    double *const of = f.data() + std::size_t(i) * block;
    for (int c = 0; c < dim; ++c)
      of[c] = factor * zone.force[c][i];
    for (int c = 0; c < n_spins<dim> && zone.turns; ++c)
      of[dim + c] = factor * zone.torque[c][i];
  }
  for (int i = 0; i < n_nodes_; ++i)
    for (int c = 0; c < dim; ++c)
      f[std::size_t(node_block(i)) * block + c] = factor * nodal[c][i];
  drop_inert(f);
  return f;
}

template <int dim>
void StaticSystem<dim>::drop_inert(Eigen::VectorXd &y) const
{
  for (int k = 0; k < size(); ++k)
    if (is_inert_[k])
      y[k] = 0;
}

template <int dim>
Eigen::VectorXd StaticSystem<dim>::forces(double time, double noted_share)
{
  auto bodies = body_.bodies();
  Components<dim> nodal = nodal_zero();
  body_.coupler->compute_trial(bodies, time, noted_share, nodal);
  if (!body_.zone) {
    body_.coupler->restrict_forces(motion_, nodal);
    return give(motion_, nodal, 1);
  }
  body_.coupler->restrict_forces(body_.zone->state, nodal);
  return give(body_.zone->state, nodal, 1);
}

template <int dim>
double StaticSystem<dim>::whole_mass() const
{
  const auto sum = [](const std::vector<double> &masses) {
    return std::accumulate(masses.begin(), masses.end(), 0., [](double all, double mass) {
      return std::isfinite(mass) ? all + mass : all; // held ones have no end
    });
  };
  return sum(node_mass_) + (body_.zone ? sum(body_.zone->state.mass) : 0.);
}

template <int dim>
double StaticSystem<dim>::load_force(double time) const
{
  double sum = 0;
  for (int l = 0; l < int(body_.loads.size()); ++l) {
    ligament::Vector<dim> force = ligament::Vector<dim>::Zero();
    if (body_.zone)
      force += body_.force()->reaction(l);
    if (body_.far)
      force += body_.far->reaction(l);
    const auto &load = body_.loads[l];
    if (load.kind == core::BoundaryLoad<dim>::Kind::acceleration)
      force = whole_mass() * load.traction(time);
    sum += std::max(force.norm(), std::abs(load.pressure_at(time)) * body_.load_places[l].area);
  }
  return sum;
}

template <int dim>
double StaticSystem<dim>::round_off() const
{
  const double modulus = body_.far ? body_.far->body().stiffness(0, 0)
                                   : body_.force()->elastic_constants().stiffness(0, 0);
  const double length =
      body_.spacing > 0 ? body_.spacing : body_.far->mesh().cell_size[0].minCoeff();
  return 1e-15 * modulus * (dim == 2 ? length * body_.thickness : length * length);
}

template <int dim>
void StaticSystem<dim>::linearise_here()
{
  if (!body_.zone)
    return;
  about_.zone = body_.zone->state.displacement;
  about_.rotation = body_.zone->state.rotation;
  is_at_reference_ = false;
}

template <int dim>
void StaticSystem<dim>::linearise_at_reference()
{
  for (auto &values : about_.zone)
    std::fill(values.begin(), values.end(), 0.);
  for (std::size_t k = 0; k < about_.rotation.size(); ++k)
    std::fill(about_.rotation[k].begin(), about_.rotation[k].end(), dim == 3 && k == 0 ? 1. : 0.);
  is_at_reference_ = true;
}

template <int dim>
void StaticSystem<dim>::compute_bonds_near(double scale)
{
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < n_particles_; ++i)
      motion_.displacement[c][i] = about_.zone[c][i] + scale * motion_.velocity[c][i];
  if (motion_.turns) {
    motion_.rotation = about_.rotation;
    turn(motion_, scale);
  }
  body_.force()->compute_bonds(motion_, !is_at_reference_);
}

// What the zone answers is the difference of the forces on both sides of the state, about the
// reference those of one side.
template <int dim>
Eigen::VectorXd StaticSystem<dim>::stiffness_times(const Eigen::VectorXd &y)
{
  Components<dim> nodal = nodal_zero();
  take(y, motion_, nodal);
  if (body_.zone) {
    double largest = 0;
    for (const auto &v : motion_.velocity)
      for (const double value : v)
        largest = std::max(largest, std::abs(value));
    for (const auto &w : motion_.spin)
      for (const double value : w)
        largest = std::max(largest, body_.spacing * std::abs(value));
    const double amplitude = (is_at_reference_ ? about_reference : elsewhere) * body_.spacing;
    const double scale = largest > 0 ? amplitude / largest : 1;
    compute_bonds_near(scale);
    if (!is_at_reference_) {
      const auto force = motion_.force;
      const auto torque = motion_.torque;
      compute_bonds_near(-scale);
      const auto subtract = [](auto &from, const auto &ahead) {
        for (std::size_t c = 0; c < from.size(); ++c)
          for (std::size_t i = 0; i < from[c].size(); ++i)
            from[c][i] = (ahead[c][i] - from[c][i]) / 2;
      };
      subtract(motion_.force, force);
      subtract(motion_.torque, torque);
    }
    const auto undo = [&](auto &components) {
      for (auto &component : components)
        for (double &value : component)
          value /= scale;
    };
    undo(motion_.force);
    undo(motion_.torque);
    body_.force()->add_touching(motion_);
  }
  Components<dim> force = nodal_zero();
  if (body_.far) {
    body_.far->subtract_stiffness(nodal, force);
    body_.coupler->subtract_near_stiffness(nodal, force);
  }
  body_.coupler->restrict_forces(motion_, force);
  return give(motion_, force, -1);
}

// In the cells that the coupler took over the mass is that of a body force.
template <int dim>
void StaticSystem<dim>::find_node_masses()
{
  if (!body_.far)
    return;
  node_mass_ = body_.far->lumped_mass();
  if (const auto *overlap = body_.coupler->overlap()) {
    const auto &members = body_.whole_overlap ? body_.whole_overlap->state : body_.zone->state;
    const auto weight = body_.coupler->near_weight(members);
    for (std::size_t k = 0; k < weight.size(); ++k)
      node_mass_[overlap->near_nodes[k]] = weight[k];
  }
}

// Pads included.
template <int dim>
Eigen::VectorXd StaticSystem<dim>::momentum_of(const Eigen::VectorXd &y)
{
  Components<dim> nodal = nodal_zero();
  take(y, motion_, nodal);
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < n_particles_; ++i)
      motion_.force[c][i] = motion_.mass[i] * motion_.velocity[c][i];
  for (int c = 0; c < n_spins<dim> && motion_.turns; ++c)
    for (int i = 0; i < n_particles_; ++i)
      motion_.torque[c][i] = motion_.inertia(i) * motion_.spin[c][i];
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < n_nodes_; ++i)
      nodal[c][i] *= node_mass_[i];
  body_.coupler->restrict_forces(motion_, nodal);
  return give(motion_, nodal, 1);
}

template <int dim>
Eigen::VectorXd StaticSystem<dim>::held_motion(double from, double to, double factor) const
{
  Eigen::VectorXd y = Eigen::VectorXd::Zero(size());
  if (!body_.far)
    return y;
  Components<dim> nodal = nodal_zero();
  body_.far->add_held_motion(from, to, factor, nodal);
  put_nodal(nodal, y);
  return y;
}

template <int dim>
Eigen::VectorXd StaticSystem<dim>::held_gap(double time) const
{
  Eigen::VectorXd y = Eigen::VectorXd::Zero(size());
  if (!body_.far)
    return y;
  Components<dim> nodal = nodal_zero();
  body_.far->add_held_gap(time, nodal);
  put_nodal(nodal, y);
  return y;
}

template <int dim>
void StaticSystem<dim>::put_nodal(const Components<dim> &nodal, Eigen::VectorXd &y) const
{
  for (int i = 0; i < n_nodes_; ++i)
    for (int c = 0; c < dim; ++c)
      y[std::size_t(node_block(i)) * block + c] = nodal[c][i];
}

template <int dim>
void StaticSystem<dim>::displace(const Eigen::VectorXd &y, double factor)
{
  Components<dim> nodal = nodal_zero();
  if (body_.zone) {
    auto &zone = body_.zone->state;
    take(y, zone, nodal);
    body_.zone->drift(factor);
  } else
    take(y, motion_, nodal);
  for (int c = 0; c < dim && body_.far; ++c)
    for (int i = 0; i < n_nodes_; ++i)
      body_.far->displacement[c][i] += factor * nodal[c][i];
  if (body_.far)
    body_.far->distribute();
  auto bodies = body_.bodies();
  body_.coupler->follow(bodies);
}

template <int dim>
void StaticSystem<dim>::set_velocities(const Eigen::VectorXd &y, const coupling::StepTime &step)
{
  Components<dim> nodal = nodal_zero();
  take(y, body_.zone ? body_.zone->state : motion_, nodal);
  if (body_.far)
    body_.far->velocity = nodal;
  auto bodies = body_.bodies();
  body_.coupler->start_velocities(bodies, step);
}

template <int dim>
std::vector<std::array<int, 3>> StaticSystem<dim>::touching() const
{
  std::vector<std::array<int, 3>> faces;
  if (!body_.zone)
    return faces;
  using Term = particles::QuadraticTerm<dim>;
  body_.force()->add_other_tangent(body_.zone->state, [&](const Term &term) {
    if (term.kind == Term::Kind::softening)
      faces.push_back({term.members[0], term.members[1], 2});
    if (term.kind == Term::Kind::contact)
      faces.push_back({term.members[0], term.members[1],
                       term.rows.template block<dim, dim>(0, block).isIdentity()});
  });
  std::sort(faces.begin(), faces.end());
  return faces;
}

template <int dim>
double StaticSystem<dim>::motion_energy(const coupling::StepTime &step)
{
  auto bodies = body_.bodies();
  Components<dim> nodal = nodal_zero();
  body_.coupler->compute_trial(bodies, step.time, 1, nodal);
  const auto e = body_.coupler->energy(bodies, step);
  return e.kinetic_discrete + e.kinetic_far + e.impulses;
}

template <int dim>
typename StaticSystem<dim>::Place StaticSystem<dim>::place() const
{
  Place place;
  if (body_.zone) {
    place.zone = body_.zone->state.displacement;
    place.rotation = body_.zone->state.rotation;
  }
  if (body_.far)
    place.far = body_.far->displacement;
  return place;
}

template <int dim>
void StaticSystem<dim>::put_back(const Place &place)
{
  if (body_.zone) {
    body_.zone->state.displacement = place.zone;
    body_.zone->state.rotation = place.rotation;
  }
  if (body_.far)
    body_.far->displacement = place.far;
  auto bodies = body_.bodies();
  body_.coupler->follow(bodies);
}

template <int dim>
typename StaticSystem<dim>::Velocities StaticSystem<dim>::velocities() const
{
  Velocities v;
  if (body_.zone) {
    v.zone = body_.zone->state.velocity;
    v.spin = body_.zone->state.spin;
  }
  if (body_.far)
    v.far = body_.far->velocity;
  return v;
}

template <int dim>
void StaticSystem<dim>::put_back(const Velocities &v)
{
  if (body_.zone) {
    body_.zone->state.velocity = v.zone;
    body_.zone->state.spin = v.spin;
  }
  if (body_.far)
    body_.far->velocity = v.far;
  auto bodies = body_.bodies();
  body_.coupler->take_velocities(bodies);
}

template <int dim>
Eigen::MatrixXd StaticSystem<dim>::rigid_motions() const
{
  constexpr int n_motions = dim + n_spins<dim>;
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(size(), n_motions);
  const auto put = [&](int row, const ligament::Vector<dim> &x, bool turns) {
    for (int c = 0; c < dim; ++c)
      motions(row * block + c, c) = 1;
    if constexpr (dim == 2) {
      motions(row * block, 2) = -x[1];
      motions(row * block + 1, 2) = x[0];
    } else
      for (int k = 0; k < 3; ++k)
        motions.template block<3, 1>(row * block, 3 + k) = ligament::Vector<3>::Unit(k).cross(x);
    for (int k = 0; k < n_spins<dim> && turns; ++k)
      motions(row * block + dim + k, dim + k) = 1;
  };
  for (int i = 0; i < n_particles_; ++i)
    put(i, get(body_.zone->state.reference, i) + get(body_.zone->state.displacement, i),
        body_.zone->state.turns);
  for (int i = 0; i < n_nodes_; ++i)
    put(node_block(i), body_.far->mesh().nodes[i] + get(body_.far->displacement, i), false);
  for (int k = 0; k < size(); ++k)
    if (is_inert_[k])
      motions.row(k).setZero();
  return motions;
}

template class StaticSystem<2>;
template class StaticSystem<3>;
} // namespace ligament::program
