// What the loop and the coupler know of a force between particles: not the law, only its answers.
#pragma once

#include "core/check.h"
#include "core/hyperelastic_law.h"
#include "particles/force_report.h"
#include "particles/halo.h"
#include "particles/rest_blocks.h"

#include <functional>
#include <limits>
#include <memory>

namespace ligament::particles
{
/// One quadratic term of the energy linearised about the reference:
///   1/2 sum_r stiffness[r] (row_r . q)^2,
/// q the degrees of freedom of `members` in turn, each displacement first, then rotation vector.
template <int dim>
struct QuadraticTerm
{
  enum class Kind
  {
    bond,      // between members 0 and 1: extension, shear, bending, twist
    wall,      // between member 0 and a prescribed boundary
    contact,   // between members 0 and 1, which touch
    softening, // between members 0 and 1: what a bond has lost that opens further
    volumetric // of member 0, which its neighbours (the other members) enter; embedding, too
  };
  Kind kind = Kind::bond;
  Vector<dim> location; // m: centroid of the face, middle of the bond, or centre of member 0
  std::vector<int> members;
  /// n_rows x (members.size() * n_particle_dofs<dim>); a force without rotations may leave their
  /// columns out, dim per member.
  Eigen::MatrixXd rows;
  Eigen::VectorXd stiffness; // n_rows, of either sign
};

/// j acts on i: across a face of their cells, or within the range of the force.
struct Neighbour
{
  int i, j;
  bool bonded; // else they only touch
};

/// A face of a particle's cell as the closure test sees it: j is the neighbour, or -1 on the
/// surface of the specimen.
template <int dim>
struct FaceView
{
  int i, j;
  Vector<dim> normal;   // unit, out of i
  double area;          // m^2
  Vector<dim> centroid; // m, in the reference
  bool bonded;
  bool is_rebonded = false; // bonded, after it had broken
};

/// Elastic constants that a continuum needs to be the same body.
template <int dim>
struct ElasticConstants
{
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  double youngs_modulus = none; // Pa, of an isotropic body
  double poissons_ratio = none; // -, of an isotropic body
  double density = 0;           // kg/m^3
  /// C in Pa, Voigt, of any symmetry, for the plane mode of the packing in 2D.
  Stiffness<dim> stiffness = Stiffness<dim>::Zero();
  double wave_speed_p = 0; // m/s, in the body (plane mode in 2D); of an anisotropic one the fastest
  double wave_speed_s = 0; // m/s, the slowest
  /// Stress of the reference in Pa, Voigt: a displacement gradient H has the energy
  /// 1/2 sym H : C : sym H + 1/2 (H stress) : H per volume (theory.md eq. (C23)).
  Strain<dim> stress = Strain<dim>::Zero();
};

/// Some terms of a force, each with a share of its energy, on particles of their own numbering.
template <int dim>
class PartialForce
{
public:
  virtual ~PartialForce() = default;

  /// Overwrites force and torque of all particles with those of the present state; returns the
  /// energy in J. Calling it again in the same state changes nothing more.
  virtual double compute(Particles<dim> &particles) = 0;
  /// The same but for the energy, which may cost more.
  virtual void compute_forces(Particles<dim> &particles) { compute(particles); }
};

/// Where a packing ends inside the body: what lies beyond is a mesh, which moves the outermost
/// particles; the cells of some of these lack faces towards neighbours that are not there.
template <int dim>
struct CoupledEdge
{
  std::vector<int> pads;    // particles whose faces never break
  std::vector<int> open;    // of them those whose cells lack faces
  std::vector<int> members; // particles where the models overlap: they stay elastic
  /// Gradient of the mesh's displacement at the centre of open[k], at present.
  std::function<Eigen::Matrix<double, dim, dim>(int k)> gradient;
};

/// Adds forces to all particles: one virtual call per step. What the loop and the coupler need is
/// pure, what observers ask has the neutral answers of ForceReport.
template <int dim>
class ParticleForce : public ForceReport<dim>
{
public:
  /// Without, particles have no orientation: their arrays of rotation, spin and torque are empty.
  virtual bool has_rotations() const { return true; }

  /// Overwrites force and torque of all particles that are stepped with those of the present state;
  /// time in s sets the prescribed boundaries.
  virtual void compute(Particles<dim> &particles, double time) = 0;

  /// From now on compute() may leave out what these blocks do not list, and wakes those on which
  /// anything else than bonds between particles acts. They must outlive it. Only called where
  /// can_rest() says so.
  virtual void set_rest(RestBlocks<dim> *) {}
  /// After load() of a state that doesn't say which blocks rest: wakes what contacts join.
  virtual void wake_touching() {}

  /// Elastic (and contact) energy of the present state, in J.
  virtual double potential_energy(const Particles<dim> &particles) const = 0;

  /// The particles are a part of a body from now on, the others are on other ranks: compute() tells
  /// these what breaks, energies and losses are those of the body. All ranks make the same calls.
  /// compute() may append particles of others that touch those at hand. Throws core::InputError
  /// where the force can't be parted: by default, always.
  virtual void join(const Owners &, const Particles<dim> &)
  {
    throw core::InputError("forces of this kind act in one process only; use one rank");
  }
  /// Of a part, before load(): appends the particles of others that the state of the whole body
  /// needs here.
  virtual void invite(const core::State &, Particles<dim> &) {}

  /// Largest stable leap-frog step of the intact body, in s.
  virtual double stable_step(const Particles<dim> &particles) const = 0;

  virtual ElasticConstants<dim> elastic_constants() const = 0;
  /// The body inside, under finite homogeneous strain. Null: as far as the law knows, linear in
  /// axes that turn with the material.
  virtual std::shared_ptr<const core::HyperelasticLaw<dim>> finite_strain_law() const { return {}; }

  /// m: particles farther apart than this don't enter each other's terms. 0: those do whose cells
  /// share a face.
  virtual double range() const { return 0; }

  /// Bonds bear forces in the reference, which cancel inside the body: terms feel rotations one by
  /// one, and what is left where the packing ends are reference_forces().
  virtual bool is_prestressed() const { return false; }
  /// Overwrites: forces on all particles in the reference, in N. Only asked where bonds bear any.
  virtual void reference_forces(const Particles<dim> &particles, Components<dim> &force) const;

  /// Scales the energy from now on: each particle's volumetric part by its weight (one per owned
  /// particle, above 0, at most 1), each pair by the mean of its two. Masses are the caller's.
  /// For couplers that blend the energies of two models; to be called once, on the intact body.
  virtual void set_energy_weights(const std::vector<double> &weights) = 0;

  /// What the law says of stress and fracture there goes by the mesh's motion from now on; forces
  /// and energy stay as they are.
  virtual void set_coupled_edge(const Particles<dim> &, CoupledEdge<dim>) {}

  /// Every quadratic term of the linearised energy of the present bonds that one of these particles
  /// (ascending; null: all) enters, once, in an order that does not depend on who is asked for.
  virtual void add_tangent(const Particles<dim> &particles,
                           const std::function<void(const QuadraticTerm<dim> &)> &add,
                           const std::vector<int> *of = nullptr) const = 0;

  /// Whether it has the looks below, which a body in equilibrium needs.
  virtual bool has_trials() const { return false; }

  /// The forces of a state that the body may not stay in, as compute() would find them at the loads
  /// of that time, in s; but nothing breaks or flows, and nothing is booked or remembered. Faces
  /// that reach this share of their limit are kept in mind for trial_share().
  virtual void compute_trial(Particles<dim> &, double /*time*/, double /*noted_share*/) {}
  /// Largest share of its limit that a face bears in the state of the last trial; 0 where none
  /// reaches the noted one.
  virtual double trial_share(const Particles<dim> &) const { return 0; }

  /// Overwrites forces and torques by those of the bonds and outer faces, at the loads of the last
  /// trial, or where supports stand where they were at first and nothing pulls.
  virtual void compute_bonds(Particles<dim> &, bool /*has_loads*/) {}
  /// Adds what faces that touched in the last trial answer to the motion that the velocities and
  /// spins are, over 1 s; to first order.
  virtual void add_touching(Particles<dim> &) {}
  /// Terms near to what add_tangent() lacks of it: of these faces, between materials, and of bonds
  /// that soften, below 0.
  virtual void add_other_tangent(const Particles<dim> &,
                                 const std::function<void(const QuadraticTerm<dim> &)> &) const
  {
  }

  /// The body is where no step led it: the next compute() is that of a step that began at `time`,
  /// in s.
  virtual void resume_at(double /*time*/) {}

  /// Of several bonds that exceed their strength only the most loaded one breaks from now on.
  virtual void break_one_by_one() {}

  /// What the force remembers beyond the particles' motion, at the time of the present positions
  /// and before compute(). load() follows the construction of the same body and the load of the
  /// particles; then compute() gives the same bits.
  virtual void save(core::State &, const core::Names &, const Particles<dim> &) const {}
  virtual void load(const core::State &, const core::Names &, const Particles<dim> &) {}

  /// Share of the energy of a term at `location` (m, reference) that `particles` enter.
  using TermShare =
      std::function<double(const Vector<dim> &location, const std::vector<int> &particles)>;

  /// The intact law with each term's energy times its share, on the particles `members` alone, in
  /// this order; a history starts anew. Terms that reach other particles must have the share 0.
  /// Throws core::InputError from a force that has no such part.
  virtual std::unique_ptr<PartialForce<dim>> part(const Particles<dim> &particles,
                                                  const std::vector<int> &members,
                                                  const TermShare &share) const;

  /// Every face of the cells of these particles (ascending; null: all), once per side (i, j), then
  /// those on the surface (j = -1); in an order that does not depend on who is asked for. None
  /// where particles have no cells.
  virtual void for_each_face(const Particles<dim> & /*particles*/,
                             const std::function<void(const FaceView<dim> &)> & /*visit*/,
                             const std::vector<int> * /*of*/ = nullptr) const
  {
  }

  /// Every neighbour j of these particles i (ascending; null: all); in an order that does not
  /// depend on who is asked for. By default those across faces.
  virtual void for_each_neighbour(const Particles<dim> &particles,
                                  const std::function<void(const Neighbour &)> &visit,
                                  const std::vector<int> *of = nullptr) const;

  /// Those of these particles (ascending) that lack neighbours which the material beyond the
  /// packing would give them. By default those whose cells the faces, those on the surface among
  /// them, do not close.
  virtual std::vector<int> open_particles(const Particles<dim> &particles,
                                          const std::vector<int> &of) const;
};

template <int dim>
std::unique_ptr<PartialForce<dim>>
ParticleForce<dim>::part(const Particles<dim> &, const std::vector<int> &, const TermShare &) const
{
  throw core::InputError("/coupling/regime: this force cannot be evaluated on the motion of the "
                         "mesh; choose \"linear\" or \"corotated\"");
}
} // namespace ligament::particles
