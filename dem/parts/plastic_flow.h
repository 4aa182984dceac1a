// Plastic strains as part of the force, theory.md section 1.10: what they change in it, and how
// they grow.
#pragma once

#include "core/exact_sum.h"
#include "dem/parts/force_part.h"
#include "dem/plastic_blocks.h"
#include "dem/plastic_rows.h"

#include <map>
#include <memory>
#include <optional>

namespace ligament::dem
{
/// A body flows by a law or, without one, not at all; then nothing here costs anything.
template <int dim>
class PlasticFlow : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;

  /// Of bodies of one elastic material with its whole energy; `loaded`: particles with loaded outer
  /// faces.
  void set_law(std::unique_ptr<const YieldLaw> law, const BondedBody<dim> &body,
               const LatticeConstants<dim> &rows, std::vector<int> loaded);
  bool has_law() const { return blocks_ != nullptr; }
  /// Null without a law.
  const PlasticBlocks<dim> *blocks() const { return blocks_.get(); }
  bool has_flowed() const { return blocks_ && blocks_->n_plastic_blocks() > 0; }

  /// Of a bond, its elastic part without what plastic strains take.
  BondMotion<dim> motion(const Bond<dim> &bond, const Particles &particles, const Turn<dim> &turn_i,
                         const Turn<dim> &turn_j) const;
  /// Share of a bond in what the dilatation of its particle i does not feel, in m^3.
  double flowed_volume(const Bond<dim> &bond, int i) const;

  /// In blocks that have flowed.
  std::vector<int> particles() const override;
  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_forces(Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_force_on(int i, const Particles &particles, const Evaluation<dim> &evaluation,
                    Wrench<dim> &wrench) const override;
  void add_energies(const Particles &particles, Evaluation<dim> &evaluation,
                    std::vector<double> &energy) const override;
  void remove(const BondId &id, const Bond<dim> &bond, const Particles &particles) override;

  /// The next evaluation marks where something could yield.
  void ask(Evaluation<dim> &evaluation) const;
  /// After it, once at every new time: increments of the plastic strains of the particles that
  /// yield, in their own axes; empty where none does. `surface` acts on the outer faces.
  using Increments = std::vector<std::pair<int, Tensor>>;
  Increments increments(const Particles &particles, double time, Evaluation<dim> &evaluation,
                        const ForcePart<dim> &surface);
  void add(const Increments &increments, const Particles &particles);

  /// Energy in J that left at fixed positions: that before an increment less that after it,
  /// particle by particle.
  void book(const core::ExactSum &taken) { dissipation_.merge(taken); }
  double dissipation() const { return dissipation_.value(); }

  void save(core::State &state, const core::Names &names) const override;
  /// The law comes before it.
  void load(const core::State &state, const core::Names &names,
            const Particles &particles) override;

private:
  /// What no traction answers of Du: the parts of both particles, in m.
  std::array<Vector<dim>, 2> stretch(const Bond<dim> &bond, const Turn<dim> &turn_i,
                                     const Turn<dim> &turn_j) const;
  /// Adds what plastic strains change in a bond of particle i; returns its half of the energy (J).
  double add_change(const Bond<dim> &bond, int i, const Particles &particles,
                    Wrench<dim> &wrench) const;
  PlasticRows<dim> rows(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// visit(i, force, torque, energy): what plastic strains change in those of a particle's bonds;
  /// of the energy (J) each particle has half.
  template <typename Visit>
  void for_each_force(const Particles &particles, Evaluation<dim> &evaluation, Visit &&visit) const;
  /// Sums of f (x) a in N m, of particles with loaded faces.
  using Moments = std::map<int, Eigen::Matrix<double, dim, dim>>;
  /// Averaged stresses of bonds and loaded faces in the axes of the particles.
  void find_stresses(const Particles &particles, const PlasticRows<dim> &rows,
                     const RowRange &range, const Evaluation<dim> &evaluation,
                     const Moments &moments, std::vector<Tensor> &stress) const;
  /// V M : ep of a particle.
  void update_flowed_volume(int i, double volume);

  const BondedBody<dim> *body_ = nullptr;
  LatticeConstants<dim> constants_;
  std::unique_ptr<PlasticBlocks<dim>> blocks_;
  double yield_traction_ = 0;       // Pa: no particle yields whose bonds all have less,
  double pressure_share_ = 0;       // and whose pressure (plane strain) is below this share of it
  std::optional<double> flowed_at_; // s
  core::ExactSum dissipation_;
};
} // namespace ligament::dem
