// What the particles of softening faces will answer in a step, before the kernels ask them: their
// faces open by it, theory.md section 1.13.
#pragma once

#include "dem/parts/inelastic_strains.h"

namespace ligament::dem
{
/// Of these particles, at the strains of all their faces; nothing of it stays.
template <int dim>
class FlowTrial
{
public:
  using Particles = particles::Particles<dim>;
  using Matrix = Eigen::Matrix<double, dim, dim>;

  /// Open cells hold what is no bond's within a material. `particles` ascend.
  FlowTrial(const BondedBody<dim> &body, const InelasticStrains<dim> &strains,
            const InelasticSweep<dim> &sweep, const Particles &state,
            const std::vector<int> &particles);

  /// More of X of a particle, m^dim.
  void add(int place, const Matrix &strain)
  {
    strain_[place] += strain;
    is_known_[place] = 0;
  }
  /// Pressure in Pa of a particle; its e follow.
  double answer(int place);
  /// In its own axes.
  const Matrix &inelastic(int place) const { return inelastic_[place]; }
  /// By how much its dashpots stiffen a face that has this share in its volume, as OpenedBond has
  /// it, and this lever: d(force) / d(opening) in N/m, beside what is elastic.
  Matrix damping(int place, double shear, double share, const Vector<dim> &lever) const;

private:
  const BondedBody<dim> &body_;
  const InelasticStrains<dim> &strains_;
  const InelasticSweep<dim> &sweep_;
  const std::vector<int> particle_;
  std::vector<Matrix> strain_, inelastic_; // X in m^dim; e
  std::vector<double> pressure_;           // Pa
  std::vector<char> is_known_;             // both, of this X
};
} // namespace ligament::dem
