// The many-body law of discrete elements: exact isotropic elasticity on any packing, walls,
// tractions, breaking bonds, contact (theory.md section 1).
#pragma once

#include "dem/bonded_body.h"
#include "dem/fracture/break_search.h"
#include "dem/fracture/broken_bonds.h"
#include "dem/fracture_law.h"
#include "dem/interfaces.h"
#include "dem/parts/cohesive_faces.h"
#include "dem/parts/contact_forces.h"
#include "dem/parts/inelastic_strains.h"
#include "dem/parts/periodic_jumps.h"
#include "dem/parts/rebonded_faces.h"
#include "dem/parts/row_bonds.h"
#include "dem/parts/slice_bonds.h"
#include "dem/surface_loads.h"
#include "particles/particle_force.h"

namespace ligament::dem
{
/// Its parts one after the other: pressures, then forces; then what could break is looked at.
template <int dim>
class ManyBodyForce : public particles::ParticleForce<dim>
{
public:
  using Particles = particles::Particles<dim>;

  /// Loads act on the outer faces of their boundary. Faces that a crack cuts touch from the start.
  ManyBodyForce(const packings::Packing<dim> &packing, const Materials &materials,
                std::vector<core::BoundaryLoad<dim>> loads, const FractureLaw &fracture = {});
  ManyBodyForce(const ManyBodyForce &) = delete; // parts know the body
  ManyBodyForce &operator=(const ManyBodyForce &) = delete;

  /// Also breaks the bonds that exceed the strength, once at every new time, and books work and
  /// energies; in such a step the force is the mean of those before and after, which closes the
  /// energy balance to second order. Calling it again in the same state changes nothing more.
  void compute(Particles &particles, double time) override;

  /// Loads wake the blocks that they act on when they begin, contacts theirs.
  void set_rest(particles::RestBlocks<dim> *rest) override;
  void wake_touching() override { contacts_.wake(body_.bonds(), rest_); }

  /// At the loads of the last compute; compression and elastic slip of contacts included.
  double potential_energy(const Particles &particles) const override;

  /// Of a body whose ghosts are n_rings() deep. Refuses what is known in one process only: faces
  /// that soften or fall in what flows, faces that are bonded again, several materials whose faces
  /// meet, joined sides, pressures that follow the surface.
  void join(const particles::Owners &owners, const Particles &particles) override;
  void invite(const core::State &state, Particles &particles) override;
  /// Rings of ghosts around the particles of a rank: forces need two, criteria that read the stress
  /// of both particles of a bond one more.
  static int n_rings(const FractureLaw &law) { return law.reads_stresses() ? 3 : 2; }

  /// 2 / omega, omega the largest frequency by Lanczos iteration about the reference, raised by
  /// 1 %; deterministic. Held particles don't move.
  double stable_step(const Particles &particles) const override;

  particles::ElasticConstants<dim> elastic_constants() const override;

  /// Without the bonds between materials and the volumes that they enter.
  void add_tangent(const Particles &particles,
                   const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
                   const std::vector<int> *of = nullptr) const override;

  bool has_trials() const override { return true; }
  void compute_trial(Particles &particles, double time, double noted_share) override;
  double trial_share(const Particles &particles) const override;
  /// The law linearised: the motion must be so small that its square is round-off.
  void compute_bonds(Particles &particles, bool has_loads) override;
  void add_touching(Particles &particles) override;
  void add_other_tangent(
      const Particles &particles,
      const std::function<void(const particles::QuadraticTerm<dim> &)> &add) const override;
  void resume_at(double time) override;
  void break_one_by_one() override { search_.break_one_by_one(); }

  void set_energy_weights(const std::vector<double> &weights) override;

  /// After set_energy_weights(). Stresses, tensions and the search for breaking bonds follow it.
  void set_coupled_edge(const Particles &particles, particles::CoupledEdge<dim> edge) override;
  const EdgeCells<dim> &edge_cells() const { return body_.edge(); }

  void for_each_face(const Particles &particles,
                     const std::function<void(const particles::FaceView<dim> &)> &visit,
                     const std::vector<int> *of = nullptr) const override;

  /// Of the bonds that are intact now.
  std::unique_ptr<particles::PartialForce<dim>>
  part(const Particles &particles, const std::vector<int> &members,
       const typename particles::ParticleForce<dim>::TermShare &share) const override;

  void save(core::State &state, const core::Names &names,
            const Particles &particles) const override;
  /// Laws of flow come before it. Bonds of particles that this body lacks are passed over.
  void load(const core::State &state, const core::Names &names,
            const Particles &particles) override;

  /// Averaged stress tensors in Pa (Voigt order, in-plane components in 2D), theory.md eq. (D10);
  /// of the body before its energy was weighted.
  void stresses(const Particles &particles, Components<n_strains<dim>> &stress) const override;

  /// Of a body in plane strain with a material that flows.
  void stresses_out_of_plane(const Particles &particles,
                             std::vector<double> &stress) const override;

  /// Largest tension on a face in Pa over the bonds of these particles; 0 when there is none.
  double max_tension(const Particles &particles, const std::vector<int> &of) const;

  /// See BreakSearch::weakest_bond.
  BondTension<dim> weakest_bond(const Particles &particles, const std::vector<int> &of) const;

  /// Every compute() notes the faces that reach this share of their limit (above 0, at most 1, the
  /// default) for utilisation().
  void set_noted_share(double share) override { search_.set_noted_share(share); }
  Utilisation<dim> utilisation(const Particles &particles,
                               const std::vector<Watch> &watch) const override;

  /// Force in N of support or traction number `load` (constructor's order) on the body, at the
  /// last compute.
  Vector<dim> reaction(int load) const override;
  /// Work in J of supports and tractions, booked by compute().
  double external_work() const override
  {
    return ranks().sum(surface_.external_work()).value() + jumps_.external_work();
  }

  /// Energy in J that breaking bonds released.
  double fracture_energy() const { return ranks().sum(broken_.energy()).value(); }
  /// Energy in J that opened faces which soften.
  double cohesive_work() const { return ranks().sum(cohesive_.work()).value(); }
  const CohesiveFaces<dim> &cohesive() const { return cohesive_; }
  /// Energy in J that faces lost as they were bonded again; and those that are.
  double rebonding_energy() const { return rebonded_.energy(); }
  const RebondedFaces<dim> &rebonded() const { return rebonded_; }
  /// Energy in J by which the leap-frog's invariant fell because forces jumped, theory.md (E10):
  /// where bonds broke, and where contacts opened or closed. Belongs to the energy balance; second
  /// order in the step.
  double breaking_step_error() const;
  /// Energy in J that friction took.
  double frictional_work() const { return ranks().sum(contacts_.frictional_work()).value(); }
  particles::ForceLosses losses() const override
  {
    return {fracture_energy(), frictional_work(),  plastic_dissipation(), breaking_step_error(),
            cohesive_work(),   hardening_energy(), viscous_dissipation(), rebonding_energy()};
  }

  /// Those at hand.
  const std::vector<BrokenBond<dim>> &broken_bonds() const override { return broken_.all(); }
  std::int64_t n_broken() const override
  {
    return ranks().is_one() ? std::int64_t(broken_.all().size()) : n_broken_;
  }
  std::vector<BrokenBond<dim>> broken_bonds_of_body(const Particles &particles) const override;
  bool softens() const override { return fracture().softens(); }
  double last_softening() const override { return began_at_; }
  void softening(const Particles &particles, std::vector<double> &share,
                 std::vector<double> &opening) const override;
  bool can_break() const override { return search_.can_break(); }
  long n_bonds() const override { return body_.bonds().n_bonds() + rebonded_.n_bonds(); }
  const Contacts<dim> &contacts() const { return contacts_.contacts(); }
  int n_contacts() const { return int(contacts_.all().size()); }

  bool can_flow() const override { return strains_.has_plasticity(); }
  std::vector<int> loose_particles() const override { return strains_.loose(); }
  Utilisation<dim> flow_utilisation(const Particles &particles,
                                    const std::vector<Watch> &watch) const override;
  double flow_share(const Strain<dim> &stress, double out_of_plane) const override
  {
    return dem::flow_share<dim>(materials().base().plasticity, stress, out_of_plane);
  }
  double plastic_strain(int particle) const override { return strains_.history(particle); }
  std::array<double, 6> inelastic_strain(const Particles &particles, int particle) const override;
  /// Of materials that flow: once at every new time of compute(), whose forces are those after it.
  InelasticStrains<dim> &strains() { return strains_; }
  const InelasticStrains<dim> &strains() const { return strains_; }
  /// Energy in J that flow took: with it the leap-frog's balance is closed.
  double plastic_dissipation() const { return flow_sum(strains_.dissipation()); }
  /// And the part of it that hardening stores.
  double hardening_energy() const { return flow_sum(strains_.stored_energy()); }
  /// Energy in J that viscosity took: what branches keep is potential energy.
  double viscous_dissipation() const { return flow_sum(strains_.viscous_dissipation()); }

  /// Bonds break at this tension from now on, in Pa; by maximum tension if there was no criterion.
  void set_strength(double strength) { search_.set_strength(strength, body_); }
  const FractureLaw &fracture() const { return search_.law(); }
  /// How the next compute() looks for breaking bonds of the lattice; its result is the same.
  bool looks_by_particle() const { return evaluation_.way.by_particle; }
  /// Whether the last compute() asked the stresses of many particles for bonds that break.
  bool looks_by_stress() const { return search_.looks_by_stress(); }
  const Materials &materials() const { return body_.materials(); }
  int material(int particle) const override { return materials().number(particle); }
  bool can_rest() const override { return true; }
  std::vector<core::SkippedPart> skipped_parts() const override;

private:
  const core::Ranks &ranks() const { return owners_->ranks; }
  /// Of all ranks.
  double flow_sum(const core::ExactSum &own) const
  {
    return strains_.has_law() ? ranks().sum(own).value() : 0;
  }
  using BondName = std::array<std::int64_t, 2>;
  /// look_for_breaks() of a body in parts. All ranks call it.
  void look_for_breaks_in_parts(const StressedBody<dim> &state, Particles &particles);
  /// Of the bonds that exceed in the body those that break at once; the others soften from now on.
  std::vector<BondName> begin_softening_in_parts(const Particles &particles,
                                                 const std::vector<ExceedingBond<dim>> &exceeding);
  /// On every rank, where bonds broke on some; `places` of those at hand among all these.
  void follow_break(const Particles &particles, const std::vector<std::int64_t> &places,
                    std::size_t n_all);
  /// Of bonds of the body those at hand, and their places among all.
  std::vector<BondId> bonds_here(const std::vector<BondName> &names,
                                 std::vector<std::int64_t> &places) const;
  std::optional<BondId> bond_between(const BondName &name) const;
  /// Whose contacts are needed here, all of them: 1.
  std::vector<char> kept_particles(const Particles &p) const;
  StressedBody<dim> stressed(const Particles &particles, const Evaluation<dim> &evaluation) const
  {
    return {particles, evaluation, strains_, parts_};
  }
  /// Where materials flow, first what is neither a bond's nor an opening's.
  void begin_strains(const Particles &particles, Evaluation<dim> &evaluation) const;
  void add_other_strains(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// In the order of the parts; one that sees others' comes after them.
  void find_other_pressures(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// Pressures of all particles; of open cells at a coupled edge those of whole ones.
  void find_pressures(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// Pressures; overwrites forces and torques by those of all parts but contacts.
  void find_forces(Particles &particles, Evaluation<dim> &evaluation) const;
  /// Forces and torques alone, after the pressures of the parts.
  void find_forces_under(Particles &particles, Evaluation<dim> &evaluation) const;
  /// find_forces() of the step's own evaluation: faces that soften open first.
  void find_forces_of_step(Particles &particles);
  void open_in_flow(const Particles &particles);
  /// open() tells how far a face opens until pressures follow.
  void follow_openings(const Particles &particles, Evaluation<dim> &evaluation,
                       const std::function<double()> &open) const;
  /// Whether faces of particles at interfaces soften.
  bool softens_at_interfaces() const;
  /// Forces of contacts, which remember, on top of all others.
  void add_contacts(Particles &particles);
  void find_other_particles();
  /// Stress of a particle out of the plane in Pa, 2D.
  double out_of_plane(int particle, const Evaluation<dim> &evaluation) const;
  /// What the loads are at a time, what they pull with, and what they did.
  void set_loads(double time);
  void find_reactions(const Particles &particles, Evaluation<dim> &evaluation) const;
  void book_work(const Particles &particles);
  /// Of particles that a threshold holds at rest but that awake ones have pulled.
  void clear_forces_at_rest(Particles &particles, const Evaluation<dim> &evaluation) const;
  double dt() const { return time_ - last_time_; }

  /// What is too much for bonds and for adhesion breaks.
  void look_for_breaks(Particles &particles);
  /// Returns those that break at once; the others soften from now on.
  std::vector<BondId> begin_softening(const Particles &particles, const std::vector<BondId> &bonds);
  /// What all parts but the softening ones need to know of a bond that has begun to soften.
  void follow_softening(const Bond<dim> &bond, const Particles &particles);
  /// In J, of a face so strong that with less it would lose more than its neighbourhood gives back.
  double least_energy(const Bond<dim> &bond, const Vector<dim> &force,
                      const Softening &shape) const;
  /// And contacts that are bonded again.
  void break_bonds(Particles &particles, const std::vector<BondId> &bonds,
                   const std::vector<typename RebondedFaces<dim>::Name> &rebonded);
  /// Of a bond on its first particle, in N, where it presses; else 0.
  Vector<dim> pressing_force(const Bond<dim> &bond, const Particles &particles) const;
  /// Particles whose forces these bonds enter, by the pressures of others, too; ascending. Without
  /// those that a threshold holds at rest.
  std::vector<int> near(const std::vector<BondId> &bonds,
                        const std::vector<typename RebondedFaces<dim>::Name> &rebonded) const;
  /// Elastic energy of one bond and of the volumes of its two particles, in J; all interfaces
  /// count where one of the two is at one, since they share their pressures.
  double local_energy(const Bond<dim> &bond, const Particles &particles) const;
  /// In J; 0 for those between materials.
  double bond_energy(const Bond<dim> &bond, const Particles &particles) const;
  bool is_at_interface(const Bond<dim> &bond) const
  {
    return interfaces_.is_member(bond.i) || interfaces_.is_member(bond.j);
  }
  /// The bond no longer carries: what follows from which are left.
  void drop_bond(const BondId &id, const Bond<dim> &bond, const Particles &particles);
  /// The same, and pressures follow. Returns the energy after in J, as local_energy counts it.
  double remove_bond(const BondId &id, const Bond<dim> &bond, const Particles &particles);
  /// Own stresses of the particles at interfaces as Interfaces::own_stresses has them, openings
  /// known.
  std::vector<typename InelasticStrains<dim>::Tensor>
  stresses_at_interfaces(const Particles &particles) const;
  /// Of particles at interfaces, whose own stresses were these. Returns what InelasticStrains::jump
  /// does.
  double follow_jump(const std::vector<typename InelasticStrains<dim>::Tensor> &before,
                     const Particles &particles);
  void replay_broken(const core::State &state, const core::Names &names,
                     const Particles &particles);

  SurfaceLoads<dim> surface_;
  BondedBody<dim> body_;
  RowBonds<dim> rows_;
  SliceBonds<dim> slices_;
  InelasticStrains<dim> strains_;
  CohesiveFaces<dim> cohesive_;
  Interfaces<dim> interfaces_;
  ContactForces<dim> contacts_;
  RebondedFaces<dim> rebonded_;
  PeriodicJumps<dim> jumps_;
  /// In the order in which they act; rows_ adds its pressures after theirs, its forces before.
  std::vector<ForcePart<dim> *> parts_ = {&slices_,   &surface_,    &strains_,  &cohesive_,
                                          &rebonded_, &interfaces_, &contacts_, &jumps_};
  BreakSearch<dim> search_;
  BrokenBonds<dim> broken_;
  Evaluation<dim> evaluation_;               // of the last compute()
  Evaluation<dim> trial_;                    // of the last compute_trial()
  std::vector<ClosedContact<dim>> touching_; // in it
  // Scratch of sums of energies: fresh memory would take longer than the sweep.
  mutable Evaluation<dim> energy_evaluation_;
  mutable std::vector<double> energy_, own_energy_;
  particles::RestBlocks<dim> *rest_ = nullptr;
  std::shared_ptr<particles::Owners> owners_ = std::make_shared<particles::Owners>();
  // Of a body in parts.
  core::Names names_;               // of what is held from the start
  std::int64_t n_broken_ = 0;       // in all of them
  double thickness_;                // m, 2D
  double time_ = 0, last_time_ = 0; // s
  double began_at_ = -1;            // s, softening of faces, last
};
} // namespace ligament::dem
