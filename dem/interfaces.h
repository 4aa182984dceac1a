// Bonds between particles of different materials: both sides of the face carry the same traction.
#pragma once

#include "dem/laws/series_bond.h"
#include "dem/parts/inelastic_strains.h"

namespace ligament::dem
{
/// Every such bond splits Du = d_i + d_j so that both sides have the traction
///   t = 2G_i d_i / q_i + p_i a_i / q_i = 2G_j d_j / q_j - p_j a_j / q_j,   p = lambda theta,
/// and theta_i gets S a_i . d_i / (q_i V_i) (theory.md eqs. (D18), (D19)). This joins the pressures
/// of the particles at interfaces: they solve one sparse, symmetric positive definite system, to
/// round-off, by conjugate gradients. All other bonds of these particles must be in the table.
///
/// Where materials flow d_i is the rest of Du that the strains of i leave, theory.md section 1.10:
/// particles answer to Du as the strains before divide it, then it is divided anew.
template <int dim>
class Interfaces : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;

  Interfaces(const BondedBody<dim> &body, const InelasticStrains<dim> &strains);

  bool empty() const { return bonds_.empty(); }
  /// Particles that have or had a bond to another material, ascending.
  const std::vector<int> &members() const { return members_; }
  /// Whether a particle has or had a bond to another material.
  bool is_member(int i) const { return !member_.empty() && member_[i] >= 0; }

  std::vector<int> particles() const override { return members_; }
  /// From those of the members' other bonds and loads to those of all: after all other parts.
  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const override;
  /// In place of it where materials flow: strains of the members, at the e of all as they are.
  void add_strains(const Particles &particles, Evaluation<dim> &evaluation) const override;
  /// After all have answered: pressures and stresses of the members at their new e.
  void follow_flow(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// Own stresses of the members, theory.md eq. (D21), by their faces alone: without what loads and
  /// walls add, Pa; none where nothing flows.
  /// `for_each_strain` visits what openings add to X of particles, m^dim.
  using VisitStrain = std::function<void(int, const Eigen::Matrix<double, dim, dim> &)>;
  std::vector<typename InelasticStrains<dim>::Tensor>
  own_stresses(const Particles &particles, const Evaluation<dim> &evaluation,
               const std::function<void(const VisitStrain &)> &for_each_strain) const;
  /// The way back.
  void take_pressures(const Particles &particles, Evaluation<dim> &evaluation) const;
  void add_forces(Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_energies(const Particles &particles, Evaluation<dim> &evaluation,
                    std::vector<double> &energy) const override;
  void remove(const BondId &id, const Bond<dim> &bond, const Particles &particles) override;

  /// Of the bonds, bending included, and the volumes of the members, in J.
  double energy(const Particles &particles, const Evaluation<dim> &evaluation) const;

private:
  using Tensor = typename InelasticStrains<dim>::Tensor;
  using Matrix = typename InelasticStrains<dim>::Matrix;
  struct IndexedBond
  {
    Bond<dim> bond;
    int index; // in the network's table
  };

  SeriesBond<dim> series_of(const Bond<dim> &bond, const Particles &particles) const;
  /// `volume`: V theta of the members without these bonds, m^3.
  void solve(const std::vector<double> &volume, const Particles &particles,
             Evaluation<dim> &evaluation) const;
  /// At the strains as they are: pressures, and what Du is on both sides.
  void divide(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// What Du of a face is on either side under the pressures of both, m.
  std::array<Vector<dim>, 2> whole(const Bond<dim> &bond, const Particles &particles,
                                   const Evaluation<dim> &evaluation) const;
  /// S/q R^T D (x) A of both sides of a face, m^dim, where Du is divided so.
  std::array<Matrix, 2> strain_of(const Bond<dim> &bond, const Particles &particles,
                                  const std::array<Vector<dim>, 2> &whole) const;

  const BondedBody<dim> &body_;
  const InelasticStrains<dim> &strains_;
  std::vector<IndexedBond> bonds_;
  std::vector<IndexedBond> others_; // of members, within a material; where particles flow
  std::vector<int> members_;        // particles
  std::vector<int> member_; // by particle: place among the members or -1; empty: there are none
};
} // namespace ligament::dem
