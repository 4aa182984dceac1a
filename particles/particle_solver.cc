#include "particles/particle_solver.h"

#include <cmath>

namespace ligament::particles
{
template <int dim>
ParticleSolver<dim>::ParticleSolver(Particles<dim> particles,
                                    std::unique_ptr<ParticleForce<dim>> force)
    : state(std::move(particles)), force(std::move(force))
{
}

template <int dim>
void ParticleSolver<dim>::kick(double dt, int begin, int end)
{
  for (int c = 0; c < dim; ++c) {
    double *__restrict v = state.velocity[c].data();
    const double *__restrict f = state.force[c].data();
    const double *__restrict m = state.inverse_mass.data();
    for (int i = begin; i < end; ++i)
      v[i] += dt * f[i] * m[i];
  }
  for (int c = 0; c < n_spins<dim>; ++c) {
    double *__restrict w = state.spin[c].data();
    const double *__restrict t = state.torque[c].data();
    const double *__restrict j = state.inverse_inertia.data();
    for (int i = begin; i < end; ++i)
      w[i] += dt * t[i] * j[i];
  }
}

template <int dim>
void ParticleSolver<dim>::drift(double dt)
{
  const int n = state.n_owned;
  for (int c = 0; c < dim; ++c) {
    double *__restrict u = state.displacement[c].data();
    const double *__restrict v = state.velocity[c].data();
    for (int i = 0; i < n; ++i)
      u[i] += dt * v[i];
  }
  if constexpr (dim == 2) {
    double *__restrict angle = state.rotation[0].data();
    const double *__restrict w = state.spin[0].data();
    for (int i = 0; i < n; ++i)
      angle[i] += dt * w[i];
  } else {
    auto &[qw, qx, qy, qz] = state.rotation;
    const auto &[wx, wy, wz] = state.spin;
    for (int i = 0; i < n; ++i) {
      // q <- exp(dt w / 2) q; sin(x)/x by its series: half angles are far below one per step.
      const double h = dt / 2, bx = h * wx[i], by = h * wy[i], bz = h * wz[i];
      const double x2 = bx * bx + by * by + bz * bz;
      const double s =
          x2 < 1e-4 ? 1 - x2 / 6 * (1 - x2 / 20) : std::sin(std::sqrt(x2)) / std::sqrt(x2);
      const double c =
          x2 < 1e-4 ? 1 - x2 / 2 * (1 - x2 / 12 * (1 - x2 / 30)) : std::cos(std::sqrt(x2));
      const double ex = s * bx, ey = s * by, ez = s * bz;
      const double w0 = qw[i], x0 = qx[i], y0 = qy[i], z0 = qz[i];
      double w1 = c * w0 - ex * x0 - ey * y0 - ez * z0;
      double x1 = c * x0 + ex * w0 + ey * z0 - ez * y0;
      double y1 = c * y0 + ey * w0 + ez * x0 - ex * z0;
      double z1 = c * z0 + ez * w0 + ex * y0 - ey * x0;
      // First-order renormalisation keeps |q| = 1 against round-off.
      const double norm = 1.5 - 0.5 * (w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1);
      qw[i] = w1 * norm, qx[i] = x1 * norm, qy[i] = y1 * norm, qz[i] = z1 * norm;
    }
  }
}

template <int dim>
double ParticleSolver<dim>::kinetic_energy(double dt) const
{
  double sum = 0;
  for (int i = 0; i < state.n_owned; ++i) {
    for (int c = 0; c < dim; ++c) {
      const double v = state.velocity[c][i];
      sum += state.mass[i] * v * (v + dt * state.force[c][i] * state.inverse_mass[i]);
    }
    for (int c = 0; c < n_spins<dim>; ++c) {
      const double w = state.spin[c][i];
      sum += state.inertia[i] * w * (w + dt * state.torque[c][i] * state.inverse_inertia[i]);
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

template class ParticleSolver<2>;
template class ParticleSolver<3>;
} // namespace ligament::particles
