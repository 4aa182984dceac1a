#include "src/verification/instruments/bloch.h"

#include "core/check.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
template <int dim>
BlochWaves<dim>::BlochWaves(const particles::Particles<dim> &particles,
                            const particles::ParticleForce<dim> &force, int centre, int axis,
                            double period)
    : mass_(force.has_rotations() ? n_particle_dofs<dim> : dim), axis_(axis)
{
  using Kind = typename particles::QuadraticTerm<dim>::Kind;
  force.add_tangent(particles, [&](const particles::QuadraticTerm<dim> &term) {
    // Bonds belong to both ends, the volumetric energy to its particle.
    const bool is_bond = term.kind == Kind::bond;
    const int ends = is_bond ? 2 : 1;
    const auto own = std::count(term.members.begin(), term.members.begin() + ends, centre);
    if (own == 0)
      return;
    Term t{double(own) / ends, {}, term.rows, term.stiffness};
    for (const int i : term.members) {
      Vector<dim> offset = get(particles.reference, i) - get(particles.reference, term.members[0]);
      for (int c = 0; c < dim; ++c)
        if (c != axis && period > 0)
          offset[c] -= period * std::round(offset[c] / period);
      t.place.push_back(offset);
    }
    terms_.push_back(std::move(t));
  });
  core::require(!terms_.empty(), "no bonds around the centre of the waves");
  mass_.template head<dim>().setConstant(particles.mass[centre]);
  mass_.tail(mass_.size() - dim).setConstant(particles.inertia(centre));
}

template <int dim>
WaveModes BlochWaves<dim>::modes(const Vector<dim> &wave_vector) const
{
  const int dofs = int(mass_.size());
  Eigen::MatrixXcd stiffness = Eigen::MatrixXcd::Zero(dofs, dofs);
  for (const Term &t : terms_) {
    Eigen::MatrixXcd rows = Eigen::MatrixXcd::Zero(t.rows.rows(), dofs);
    for (std::size_t m = 0; m < t.place.size(); ++m)
      rows += std::polar(1., wave_vector.dot(t.place[m])) *
              t.rows.middleCols(m * dofs, dofs).template cast<std::complex<double>>();
    stiffness += t.share * rows.adjoint() * t.stiffness.asDiagonal() * rows;
  }
  return make_wave_modes(stiffness, mass_);
}

template <int dim>
BlochMode<dim> BlochWaves<dim>::mode(double wave_number, const Vector<dim> &polarisation) const
{
  const auto mode = select_mode<dim>(modes(wave_number * Vector<dim>::Unit(axis_)), polarisation);
  return {mode.frequency, mode.amplitude};
}

template <int dim>
double BlochWaves<dim>::group_velocity(double wave_number, const Vector<dim> &polarisation) const
{
  const double step = 1e-4 * wave_number;
  return (mode(wave_number + step, polarisation).frequency -
          mode(wave_number - step, polarisation).frequency) /
         (2 * step);
}

template class BlochWaves<2>;
template class BlochWaves<3>;
} // namespace ligament::program
