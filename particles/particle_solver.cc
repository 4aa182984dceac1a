#include "particles/particle_solver.h"

#include "particles/kick_velocities.h"
#include "particles/turn_orientations.h"

#include <cmath>
#include <numeric>

namespace ligament::particles
{
template <int dim>
ParticleSolver<dim>::ParticleSolver(Particles<dim> particles,
                                    std::unique_ptr<ParticleForce<dim>> force)
    : state(std::move(particles)), force(std::move(force))
{
}

template <int dim>
void ParticleSolver<dim>::let_rest(const RestLimits &limits)
{
  const auto for_each_pair = [&](const typename RestBlocks<dim>::VisitPair &visit) {
    force->for_each_face(state, [&](const FaceView<dim> &face) {
      if (face.j >= 0)
        visit(face.i, face.j);
    });
  };
  rest_ = std::make_unique<RestBlocks<dim>>(state, for_each_pair, limits);
  force->set_rest(rest_.get());
}

template <int dim>
void ParticleSolver<dim>::save(core::State &all) const
{
  const core::Names names = state.names();
  state.save(all, names);
  force->save(all, names, state);
  dashpots.save(all, "particle_dashpots", names);
  if (rest_)
    rest_->save(all, names);
}

template <int dim>
void ParticleSolver<dim>::load(const core::State &all)
{
  const core::Names names = state.names();
  state.load(all, names);
  force->load(all, names, state);
  dashpots.load(all, "particle_dashpots", names);
  if (rest_ && all.count("blocks"))
    rest_->load(all, names);
}

template <int dim>
template <typename Visit>
void ParticleSolver<dim>::for_each_awake(Visit &&visit) const
{
  if (!rest_ || rest_->all_awake())
    visit(0, state.n_owned);
  else
    for (const auto &[begin, end] : rest_->ranges().stepped)
      visit(begin, end);
}

template <int dim>
void ParticleSolver<dim>::kick(double dt)
{
  const auto kick = [&](auto &velocity, const auto &force, double by) {
    for (std::size_t c = 0; c < velocity.size(); ++c)
      for_each_awake([&](int begin, int end) {
        kick_velocities(velocity[c].data() + begin, force[c].data() + begin,
                        state.mass.data() + begin, by, end - begin);
      });
  };
  kick(state.velocity, state.force, dt);
  kick(state.spin, state.torque, dt / state.gyration);
  dashpots.act(
      dt, [this](int i) { return state.inverse_mass(i); }, state.force, state.velocity);
}

template <int dim>
void ParticleSolver<dim>::drift(double dt)
{
  if (rest_)
    rest_->look(state);
  for (int c = 0; c < dim; ++c) {
    double *__restrict u = state.displacement[c].data();
    const double *__restrict v = state.velocity[c].data();
    for_each_awake([&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        u[i] += dt * v[i];
    });
  }
  if constexpr (dim == 2) {
    double *__restrict angle = state.rotation[0].data();
    const double *__restrict w = state.spin[0].data();
    for_each_awake([&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        angle[i] += dt * w[i];
    });
  } else {
    auto &[qw, qx, qy, qz] = state.rotation;
    const auto &[wx, wy, wz] = state.spin;
    for_each_awake([&, dt](int begin, int end) {
      turn_orientations(
          {qw.data() + begin, qx.data() + begin, qy.data() + begin, qz.data() + begin},
          {wx.data() + begin, wy.data() + begin, wz.data() + begin}, dt, end - begin);
    });
  }
}

template <int dim>
double ParticleSolver<dim>::kinetic_energy(double dt) const
{
  double sum = 0;
  for (int i = 0; i < state.n_owned; ++i) {
    if (std::isinf(state.mass[i])) // held
      continue;
    for (int c = 0; c < dim; ++c) {
      const double v = state.velocity[c][i];
      sum += v * (state.mass[i] * v + dt * state.force[c][i]);
    }
    for (int c = 0; c < n_spins<dim>; ++c) {
      const double w = state.spin[c][i];
      sum += w * (state.inertia(i) * w + dt * state.torque[c][i]);
    }
  }
  return sum / 2;
}

template <int dim>
void ParticleSolver<dim>::scale_velocities(double factor)
{
  for (auto &array : state.velocity)
    for (double &v : array)
      v *= factor;
  for (auto &array : state.spin)
    for (double &w : array)
      w *= factor;
}

namespace
{
/// v times factor; adds v.f of the former v to power, and returns v.M v. Sums run in `n_sums`
/// strands: the compiler may not reorder those of one.
double damp(std::vector<double> &velocity, const std::vector<double> &force,
            const std::vector<double> &mass, int n, double factor, double &power)
{
  constexpr int n_sums = 8;
  double twice_energy[n_sums] = {}, work[n_sums] = {};
  const auto damp_one = [&](int i, int k) {
    const double v = velocity[i];
    twice_energy[k] += (std::isinf(mass[i]) ? 0 : mass[i]) * v * v; // infinite: held
    work[k] += v * force[i];
    velocity[i] = factor * v;
  };
  int i = 0;
  for (; i + n_sums <= n; i += n_sums)
    for (int k = 0; k < n_sums; ++k)
      damp_one(i + k, k);
  for (; i < n; ++i)
    damp_one(i, 0);
  power = std::accumulate(work, work + n_sums, power);
  return std::accumulate(twice_energy, twice_energy + n_sums, 0.);
}
} // namespace

template <int dim>
double ParticleSolver<dim>::damp_velocities(double factor, double dt)
{
  double twice_energy = 0, power = 0;
  for (int c = 0; c < dim; ++c)
    twice_energy +=
        damp(state.velocity[c], state.force[c], state.mass, state.n_owned, factor, power);
  for (int c = 0; c < n_spins<dim>; ++c)
    twice_energy += state.gyration *
                    damp(state.spin[c], state.torque[c], state.mass, state.n_owned, factor, power);
  return (1 - factor) / 2 * ((1 + factor) * twice_energy + dt * power);
}

template class ParticleSolver<2>;
template class ParticleSolver<3>;
} // namespace ligament::particles
