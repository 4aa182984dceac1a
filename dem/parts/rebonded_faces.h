// Faces that touched and are bonded again, as part of the force: whole bonds beside those of the
// packing.
#pragma once

#include "core/exact_sum.h"
#include "dem/fracture/rebonding.h"
#include "dem/parts/contact_forces.h"
#include "dem/parts/inelastic_strains.h"
#include "dem/parts/rebonded_face.h"

#include <map>
#include <optional>

namespace ligament::dem
{
/// What presses hard enough in one step is a bond from the next one on. Neither forces nor torques,
/// pressures nor stresses jump then; what the energy does is booked.
template <int dim>
class RebondedFaces : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;
  using Face = RebondedFace<dim>;
  /// That of the contact.
  using Name = std::array<std::int64_t, 3>;

  /// `rules` of each material; empty: nothing is bonded again. Bonds enter the volumes of the body
  /// and the cells of the strains; contacts wait meanwhile.
  RebondedFaces(BondedBody<dim> &body, InelasticStrains<dim> &strains, ContactForces<dim> &contacts,
                std::vector<Rebonding> rules, double thickness)
      : body_(body), strains_(strains), contacts_(contacts), rules_(std::move(rules)),
        thickness_(thickness)
  {
  }

  bool is_on() const { return !rules_.empty(); }
  /// In an order that no numbering changes; also those that act from the next step on.
  const std::map<Name, Face> &all() const { return faces_; }
  /// That act.
  int n_bonds() const;

  /// At a new time, before anything else: what was found at the last one acts from now on.
  void begin(const Particles &particles);
  /// Once at every time, after anything else, with the pressures of the body.
  void look(const Particles &particles, const std::vector<double> &pressure, double time);

  /// Those whose adhesion ends under these pressures.
  std::vector<Name> torn(const Particles &particles, const std::vector<double> &pressure) const;
  /// Of one and the volumes of its particles, in J.
  double local_energy(const Name &name, const Particles &particles,
                      const std::vector<double> &pressure) const;
  /// It is a contact again, pressures follow and forces are the contact's. Returns the energy after
  /// it in J, as local_energy counts it, that of the contact included.
  double part(const Name &name, Particles &particles, std::vector<double> &pressure,
              bool takes_over, double dt);
  /// Adds the partners of a particle.
  void add_neighbours(int particle, std::vector<int> &to) const;

  /// Energy in J that faces have lost as they became bonds.
  double energy() const { return energy_.value(); }

  std::vector<int> particles() const override { return {}; }
  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_strains(const Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_forces(Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_force_on(int i, const Particles &particles, const Evaluation<dim> &evaluation,
                    Wrench<dim> &wrench) const override;
  void add_energies(const Particles &particles, Evaluation<dim> &evaluation,
                    std::vector<double> &energy) const override;
  void for_each_moment(const Particles &particles, const Evaluation<dim> &evaluation,
                       const VisitMoment<dim> &visit) const override;

  void save(core::State &state, const core::Names &names) const override;
  void load(const core::State &state, const core::Names &names,
            const Particles &particles) override;

private:
  using Matrix = Eigen::Matrix<double, dim, dim>;
  RebondedState<dim> state(const Face &face, const Particles &particles) const
  {
    return {face, particles, strains_.strain(face.i), strains_.strain(face.j)};
  }
  std::optional<Rebonding> rule(int i, int j) const;
  /// None of a face too small for the contact's torque.
  std::optional<Face> make(const Contact<dim> &contact, const PressedContact<dim> &pressed,
                           const Particles &particles, const std::vector<double> &pressure,
                           double strength) const;
  /// One side, whose lambda / V changes so; returns by how much the energy of the volume grows.
  double settle(Face &face, bool of_i, double before, double after) const;
  /// What acts enters the volumes and the cells of its particles.
  void take_part(const Particles &particles);
  /// In J, of the face beside the volumes.
  double own_energy(const RebondedState<dim> &state, const Particles &particles) const;
  /// 2G e:X of one side, and G e:(e m) of it.
  double strained_energy(const RebondedState<dim> &state, bool of_i) const;

  BondedBody<dim> &body_;
  InelasticStrains<dim> &strains_;
  ContactForces<dim> &contacts_;
  std::vector<Rebonding> rules_;
  double thickness_; // m, 2D
  std::map<Name, Face> faces_;
  std::optional<double> looked_at_; // s
  bool has_new_ = false;            // faces that do not act yet
  core::ExactSum energy_;
};
} // namespace ligament::dem
