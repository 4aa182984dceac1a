// The many-body law of discrete elements: exact isotropic elasticity on any packing, walls,
// tractions, breaking bonds, contact (theory.md section 1).
#pragma once

#include "dem/bond_network.h"
#include "dem/bond_slices.h"
#include "dem/contact_search.h"
#include "dem/contacts.h"
#include "dem/edge_cells.h"
#include "dem/fracture_law.h"
#include "dem/interfaces.h"
#include "dem/lattice_kernel.h"
#include "dem/plastic_blocks.h"
#include "dem/plastic_rows.h"
#include "dem/stress_screen.h"
#include "dem/surface_loads.h"
#include "particles/particle_force.h"

#include <map>

namespace ligament::dem
{
using particles::BrokenBond, particles::Utilisation, particles::Watch;

/// A bond under tension as a criterion looks at it.
template <int dim>
struct BondTension
{
  BondId id;
  Bond<dim> bond;
  Vector<dim> normal, traction; // of the face at present; Pa
  double utilisation;           // tension over strength, or a bound of it; 0 without tension
};

template <int dim>
class ManyBodyForce : public particles::ParticleForce<dim>
{
public:
  using Particles = particles::Particles<dim>;

  /// Loads act on the outer faces of their boundary. Faces that a crack cuts touch from the start.
  ManyBodyForce(packings::Packing<dim> packing, const Materials &materials,
                std::vector<core::BoundaryLoad<dim>> loads, const FractureLaw &fracture = {});

  /// Also breaks the bonds that exceed the strength, once at every new time, and books work and
  /// energies; in such a step the force is the mean of those before and after, which closes the
  /// energy balance to second order. Calling it again in the same state changes nothing more.
  void compute(Particles &particles, double time) override;

  /// Loads wake the blocks that they act on when they begin, contacts theirs.
  void set_rest(particles::RestBlocks<dim> *rest) override;

  /// At the loads of the last compute; compression and elastic slip of contacts included.
  double potential_energy(const Particles &particles) const override;

  /// 2 / omega, omega the largest frequency by Lanczos iteration about the reference, raised by
  /// 1 %; deterministic. Held particles don't move.
  double stable_step(const Particles &particles) const override;

  particles::ElasticConstants<dim> elastic_constants() const override;

  /// Without the bonds between materials and the volumes that they enter.
  void
  add_tangent(const Particles &particles,
              const std::function<void(const particles::QuadraticTerm<dim> &)> &add) const override;

  void set_energy_weights(const std::vector<double> &weights) override;

  /// After set_energy_weights(). Stresses, tensions and the search for breaking bonds follow it.
  void set_coupled_edge(const Particles &particles, particles::CoupledEdge<dim> edge) override;
  /// Which faces never break, and the pressures of cells that lack faces.
  const EdgeCells<dim> &edge_cells() const { return edge_; }

  void
  for_each_face(const Particles &particles,
                const std::function<void(const particles::FaceView<dim> &)> &visit) const override;

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

  /// Largest tension on a face in Pa over the bonds of these particles; 0 when there is none.
  double max_tension(const Particles &particles, const std::vector<int> &of) const;

  /// Of the bonds of these particles the one that bears the largest share of its strength by the
  /// criterion; of utilisation 0 where none is under tension, and without a criterion.
  BondTension<dim> weakest_bond(const Particles &particles, const std::vector<int> &of) const;

  /// Every compute() notes the faces that reach this share of their limit (above 0, at most 1, the
  /// default) for utilisation().
  void set_noted_share(double share) override;

  /// The watched face nearest to its limit at the last compute(); one entry per particle. Its share
  /// is 0 where no face reached the noted share.
  Utilisation<dim> utilisation(const Particles &particles,
                               const std::vector<Watch> &watch) const override;

  /// Force in N of support or traction number `load` (constructor's order) on the body, at the
  /// last compute.
  Vector<dim> reaction(int load) const override { return surface_.reaction(load); }
  /// Work in J of supports and tractions since the last reset_work, booked by compute().
  double external_work() const override { return surface_.external_work(); }
  void reset_work() override { surface_.reset_work(); }

  /// Energy in J that breaking bonds released.
  double fracture_energy() const { return fracture_energy_; }
  /// Energy in J by which the leap-frog's invariant (kinetic energy 1/2 v(-) m v(+)) fell because
  /// forces jumped, theory.md (E10): where bonds broke, and where contacts opened or closed.
  /// Belongs to the energy balance; second order in the step.
  double breaking_step_error() const { return breaking_step_error_ + contacts_.step_error(); }
  /// Energy in J that friction took.
  double frictional_work() const { return contacts_.frictional_work(); }
  particles::ForceLosses losses() const override
  {
    return {fracture_energy(), frictional_work(), plastic_dissipation(), breaking_step_error()};
  }

  const std::vector<BrokenBond<dim>> &broken_bonds() const override { return broken_; }
  bool can_break() const override { return fracture_.criterion != FractureLaw::Criterion::none; }
  long n_bonds() const override { return bonds_.n_bonds(); }
  int n_contacts() const { return int(contacts_.all().size()); }

  /// Particles flow by this law from now on: once at every new time of compute(), whose forces are
  /// then those after the flow. Of bodies of one elastic material with its whole energy.
  void set_yield(std::unique_ptr<const YieldLaw> law);
  /// Null without a law.
  const PlasticBlocks<dim> *plastic() const { return plastic_.get(); }
  /// Energy in J that plastic flow took: with it the leap-frog's balance is closed.
  double plastic_dissipation() const { return plastic_dissipation_; }

  /// Bonds break at this tension from now on, in Pa; by maximum tension if there was no criterion.
  void set_strength(double strength);
  const FractureLaw &fracture() const { return fracture_; }
  /// How the next compute() looks for breaking bonds of the lattice; its result is the same.
  bool looks_by_particle() const { return work_.way.by_particle; }
  /// Whether the last compute() asked the stresses of many particles for bonds that break.
  bool looks_by_stress() const { return screen_.was_asked(); }
  const Materials &materials() const { return materials_; }
  int material(int particle) const override { return materials_.number(particle); }
  bool can_rest() const override { return true; }
  std::vector<core::SkippedPart> skipped_parts() const override;

private:
  /// Face by face costs nothing while few faces bear much, by particle a little always.
  struct WayToLook
  {
    bool by_particle = false;
    int since_face = 0, patience = 0; // steps by particle, and after how many faces are asked again
    /// After a step that looked at so many of n particles more closely.
    void choose(long n_looked, long n)
    {
      constexpr int many = 8, least = 64, most = 4096;
      if (by_particle) {
        by_particle = ++since_face < patience;
        return;
      }
      by_particle = many * n_looked > n;
      patience = by_particle ? std::clamp(2 * patience, least, most) : 0;
      since_face = 0;
    }
  };

  /// What one evaluation leaves behind.
  struct Workspace
  {
    std::vector<double> pressure;             // lambda_i theta_i, Pa
    std::vector<double> cosine_minus_1, sine; // 2D, after find_turns()
    std::vector<RowRange> exceeded_rows; // with bonds that may reach the noted share of the limit
    std::vector<int> exceeded_particles; // with bonds of the table that may
    /// Of every such bond a particle whose own stress says so, theory.md eq. (D12d), is noted.
    bool own_terms = false;
    std::vector<std::uint8_t> marks; // blocks with a traction from which particles could yield
    double plastic_energy = 0;       // J, what plastic strains change in the energy of bonds
    const particles::RestBlocks<dim> *rest = nullptr; // null: nothing is left out
    WayToLook way;
    SliceNearness nearness;
    long nearness_version = -1; // of rest
  };

  LatticeArrays<dim> arrays(const Particles &particles, Workspace &work) const;
  Turn<dim> turn(const Particles &particles, const Workspace &work, int i) const;
  /// Prepares turn().
  void find_turns(const Particles &particles, Workspace &work) const;
  BondMotion<dim> motion(const Bond<dim> &bond, const Particles &particles) const;
  BondMotion<dim> motion(const Bond<dim> &bond, const Particles &particles,
                         const Workspace &work) const;
  BondMotion<dim> motion(const Bond<dim> &bond, const Particles &particles, const Turn<dim> &turn_i,
                         const Turn<dim> &turn_j) const;
  Vector<dim> bond_force(const Bond<dim> &bond, const BondMotion<dim> &motion,
                         const std::vector<double> &pressure) const;

  /// The pressures of other_particles_ from irregular bonds and loaded faces, and the slices'
  /// records.
  void find_other_pressure(const Particles &particles, const SurfaceLoads<dim> &surface,
                           Workspace &work) const;
  /// What a step with this workspace passes over; null: everything.
  const particles::AwakeRanges *awake_ranges(const Workspace &work) const;
  const SliceNearness *awake_slices(Workspace &work) const;
  void wake_loaded();
  void wake_contacts();
  /// Of particles that are not awake but that bonds or contacts of awake ones have pulled.
  void clear_forces_at_rest(Particles &particles) const;
  /// Once at every new time.
  void look_for_contacts(const Particles &particles);
  /// Of contacts; what a threshold holds at rest stays without forces.
  void add_contact_forces(Particles &particles);

  /// Turns and pressures of all particles; of open cells at a coupled edge those of whole ones.
  void find_pressure(const Particles &particles, Workspace &work) const;
  /// Overwrites forces and torques by those of bonds and loaded faces; notes what could break when
  /// something `may_break`.
  void elastic_forces(Particles &particles, SurfaceLoads<dim> &surface, bool may_break,
                      Workspace &work) const;

  /// visit(i) for the particles of blocks with plastic strains.
  template <typename Visit>
  void for_each_plastic(Visit &&visit) const
  {
    if (plastic_)
      for (const RowRange &range : plastic_->plastic())
        for (int i = range.begin; i < range.end; ++i)
          visit(i);
  }
  bool is_plane_strain() const;
  /// What no traction answers of Du: the parts of both particles, in m.
  std::array<Vector<dim>, 2> plastic_stretch(const Bond<dim> &bond, const Turn<dim> &turn_i,
                                             const Turn<dim> &turn_j) const;
  PlasticRows<dim> plastic_rows(const Particles &particles, Workspace &work) const;
  /// visit(i, force, torque, energy): what plastic strains change in those of a particle's bonds;
  /// of the energy (J) each particle has half.
  template <typename Visit>
  void for_each_plastic_force(const Particles &particles, Workspace &work, Visit &&visit) const;
  void add_plastic_forces(Particles &particles, Workspace &work) const;
  double plastic_energy(const Particles &particles, Workspace &work) const;
  /// The energy that changes when plastic strains do, in J, after elastic_forces().
  double flowing_energy(const Particles &particles) const;
  /// Averaged stresses of bonds and loaded faces in the axes of the particles.
  void particle_stresses(const Particles &particles, const PlasticRows<dim> &rows,
                         const RowRange &range, std::vector<Tensor> &stress) const;
  /// V M : ep of a particle, and the share of one of its bonds, in m^3.
  void update_flowed_volume(int i, double volume);
  double flowed_volume(const Bond<dim> &bond, int i) const;
  /// Yields where the stress asks for it; forces and pressures follow.
  void flow(Particles &particles);

  /// What the kernels look for; of the table's bonds in terms of the first material's.
  BreakScreen breaking_screen(bool of_table) const;
  /// Of a bond in Pa.
  double strength_of(const Bond<dim> &bond) const;
  double size_factor(const Bond<dim> &bond) const;
  void find_largest_size_factor();
  /// With the utilisation by face_tension, or a bound of that by maximum_tension, eq. (D12c).
  BondTension<dim> bond_tension(const BondId &id, const Bond<dim> &bond, const Particles &particles,
                                const std::vector<double> &pressure) const;
  /// Whether clear_by_stress() follows the kernels.
  bool is_cleared_by_stress() const;
  /// Ascending.
  std::vector<int> noted_particles() const;
  /// Leaves out what the stresses clear of the particles that elastic_forces() noted.
  void clear_by_stress(const Particles &particles);
  /// The bonds whose bound reaches the noted share, some of them twice, after elastic_forces().
  std::vector<BondTension<dim>> suspected_bonds(const Particles &particles) const;
  /// Each once.
  static void sort_by_ids(std::vector<BondTension<dim>> &bonds, const Particles &particles);
  static std::pair<std::int64_t, std::int64_t> global_ids(const Bond<dim> &bond,
                                                          const Particles &particles);
  /// Averaged stresses (D10) in Pa of these particles, ascending.
  std::vector<Strain<dim>> stresses_of(const std::vector<int> &few, const Particles &particles,
                                       const std::vector<double> &pressure) const;
  /// Utilisations by eq. (D12) in place of their bounds; where they stay below `least`, something
  /// not smaller and below it may stand instead.
  void find_principal_tension(std::vector<BondTension<dim>> &bonds, const Particles &particles,
                              const std::vector<double> &pressure, double least) const;
  /// The bonds that break now, in this order.
  std::vector<BondId> exceeding_bonds(const Particles &particles) const;
  void break_bonds(Particles &particles, const std::vector<BondId> &bonds, double time);
  /// A quarter of the work in J that the jumps of the last break do over this step's motion.
  double quarter_work_of_jumps(const Particles &particles) const;
  /// Elastic energy of one bond and of the volumes of its two particles, in J; all interfaces
  /// count where one of the two is at one, since they share their pressures.
  double local_energy(const Bond<dim> &bond, const Particles &particles) const;
  double bond_energy(const Bond<dim> &bond, const BondMotion<dim> &motion,
                     const Particles &particles) const;
  bool is_at_interface(const Bond<dim> &bond) const
  {
    return interfaces_.is_member(bond.i) || interfaces_.is_member(bond.j);
  }
  /// The bond no longer carries, nor does it enter the volumes: what follows from which are left.
  void drop_bond(const BondId &id, const Bond<dim> &bond, const Particles &particles);
  /// Lists it, with a contact in its place.
  Contact<dim> &note_broken(const Bond<dim> &bond, const Particles &particles, double time,
                            double energy);
  void save_broken(core::State &state) const;
  void replay_broken(const core::State &state, const core::Names &names,
                     const Particles &particles);
  void save_jumps(core::State &state, const core::Names &names) const;
  void load_jumps(const core::State &state, const core::Names &names);
  /// The bond no longer carries; pressures follow. Returns the energy after in J, as local_energy
  /// counts it.
  double remove_bond(const BondId &id, const Bond<dim> &bond, const Particles &particles);
  void lay_out_slices();
  void find_other_particles();
  /// For a cell of so many m^3.
  void update_volumetric_stiffness(int i, double volume);
  double energy_weight(int i) const { return energy_weights_.empty() ? 1 : energy_weights_[i]; }

  double spacing_; // m
  std::vector<packings::BoundaryFace<dim>> boundary_faces_;
  Materials materials_;
  FractureLaw fracture_;
  double noted_share_ = 1; // of the limit, see set_noted_share
  BondNetwork<dim> bonds_;
  LatticeKernel<dim> kernel_;
  BondSlices<dim> slices_; // the irregular bonds, but those between materials
  StressScreen<dim> screen_;
  Interfaces<dim> interfaces_;
  SurfaceLoads<dim> surface_;
  Contacts<dim> contacts_;
  ContactSearch<dim> search_;
  EdgeCells<dim> edge_;
  bool searching_ = false, has_slid_ = false; // the second is seen in one step, acts in the next
  double largest_lever_share_ = 0;            // of all particles: sum of S |a| / V over the bonds
  // Particles whose pressure has parts beside the lattice's, ascending.
  std::vector<int> other_particles_;
  std::map<int, double> wall_share_;      // sum of S q / V over faces held along their normal
  std::vector<double> lambda_per_volume_; // lambda_i / V_i, Pa/m^3, energy weight included
  std::vector<double> energy_weights_;    // of the particles; empty: all 1
  std::vector<double> volumes_;           // m^3, of packings without a lattice
  particles::RestBlocks<dim> *rest_ = nullptr;
  Workspace work_;
  mutable RowWindow rows_; // scratch: nothing in it outlives a call
  mutable core::LargeArray records_;
  std::vector<BrokenBond<dim>> broken_;
  struct Jump
  {
    int i;
    Vector<dim> force; // N, after less before
    Spin<dim> torque;  // N m
  };
  std::vector<Jump> jumps_; // where bonds broke in the last step
  std::unique_ptr<PlasticBlocks<dim>> plastic_;
  double yield_traction_ = 0;       // Pa: no particle yields whose bonds all have less,
  double pressure_share_ = 0;       // and whose pressure (plane strain) is below this share of it
  std::optional<double> flowed_at_; // s
  double plastic_dissipation_ = 0;
  double largest_size_factor_ = 1;              // of the bonds
  std::optional<double> broken_at_, looked_at_; // s
  double fracture_energy_ = 0, breaking_step_error_ = 0;
  double time_ = 0, last_time_ = 0;
};
} // namespace ligament::dem
