// What observers ask of a force between particles; one that has no answer keeps the neutral one.
#pragma once

#include "core/skipped_part.h"
#include "particles/particles.h"

#include <string>
#include <vector>

namespace ligament::particles
{
/// A bond that broke; place and normal in the reference configuration.
template <int dim>
struct BrokenBond
{
  int i, j;                        // particles
  std::int64_t global_i, global_j; // their global ids
  double time;                     // s
  Vector<dim> position;            // m, face point
  Vector<dim> normal;              // unit, from i to j
  double area;                     // m^2
  double energy;                   // J, released
};

/// How near the most loaded of some faces is to breaking.
template <int dim>
struct Utilisation
{
  double share = 0;                        // of the limit at which it breaks
  Vector<dim> place = Vector<dim>::Zero(); // m, face point in the reference
};

/// Whether the faces of a particle are watched: those with a watched particle and without an
/// exempt one.
enum class Watch : char
{
  none,
  watched,
  exempt
};

/// A number of each particle that only some forces know, by its name in the output's table.
struct OwnField
{
  std::string name;
  std::vector<double> values;
};

/// Energies in J that have left motion and potential so far.
struct ForceLosses
{
  double fracture = 0; // released by breaking bonds
  double friction = 0;
  double plastic = 0; // taken by flow
  /// By which the leap-frog's invariant fell because forces jumped, theory.md (E10).
  double breaking_step_error = 0;
  double cohesive = 0;  // opened faces that soften
  double hardening = 0; // the part of `plastic` that hardening stores; the rest is heat
  double viscous = 0;
  double rebonding = 0; // lost by faces as they were bonded again
};

template <int dim>
class ForceReport
{
public:
  virtual ~ForceReport() = default;

  virtual ForceLosses losses() const { return {}; }

  /// Force in N of load number `load` on the particles, at the last compute.
  virtual Vector<dim> reaction(int /*load*/) const { return Vector<dim>::Zero(); }
  /// Work in J of the loads.
  virtual double external_work() const { return 0; }

  /// Overwrites: stress tensors of all particles in Pa, Voigt order (in-plane in 2D).
  virtual void stresses(const Particles<dim> &particles, Components<n_strains<dim>> &stress) const
  {
    for (auto &component : stress)
      component.assign(particles.size(), 0.);
  }

  /// Overwrites: stress out of the plane of all particles in Pa where it is another one than
  /// elasticity gives in plane strain; empty: nowhere.
  virtual void stresses_out_of_plane(const Particles<dim> &, std::vector<double> &stress) const
  {
    stress.clear();
  }

  virtual long n_bonds() const { return 0; }
  virtual bool can_break() const { return false; }
  /// All so far of what is at hand, in the order of breaking.
  virtual const std::vector<BrokenBond<dim>> &broken_bonds() const
  {
    static const std::vector<BrokenBond<dim>> none;
    return none;
  }
  /// How many that are in the body, on every rank.
  virtual std::int64_t n_broken() const { return std::int64_t(broken_bonds().size()); }
  /// Those of the body, on every rank, which all call it. Of a body in parts the indices are -1.
  virtual std::vector<BrokenBond<dim>> broken_bonds_of_body(const Particles<dim> &) const
  {
    return broken_bonds();
  }

  /// Of all particles, whether they lie at the faces of a crack that stands open at present, initial
  /// ones among them: they lack neighbours that they would have in the body without cracks. Empty:
  /// the force does not count neighbours.
  virtual std::vector<char> at_crack_faces(const Particles<dim> &) const { return {}; }

  /// Whether faces soften before they break.
  virtual bool softens() const { return false; }
  /// When a face last began to do so, in s; below 0 when none has.
  virtual double last_softening() const { return -1; }
  /// Overwrites, of all particles: the largest share of a face of theirs that has softened, and the
  /// largest opening of one in m.
  virtual void softening(const Particles<dim> &particles, std::vector<double> &share,
                         std::vector<double> &opening) const
  {
    share.assign(particles.size(), 0.);
    opening.assign(particles.size(), 0.);
  }

  /// Faces that reach this share of their limit (above 0, at most 1) at a compute are kept in mind
  /// for utilisation().
  virtual void set_noted_share(double /*share*/) {}
  /// The watched face nearest to its limit at the last compute; one entry per particle. Its share
  /// is 0 where no face reached the noted share.
  virtual Utilisation<dim> utilisation(const Particles<dim> &, const std::vector<Watch> &) const
  {
    return {};
  }

  /// Whether a material may flow.
  virtual bool can_flow() const { return false; }
  /// Particles that would flow or creep but for too few bonds that hold their strains at rest.
  virtual std::vector<int> loose_particles() const { return {}; }
  /// The watched particle nearest to the stress under which its material would flow, whether it may
  /// itself or not.
  virtual Utilisation<dim> flow_utilisation(const Particles<dim> &,
                                            const std::vector<Watch> &) const
  {
    return {};
  }
  /// Share of the stress under which the material of the far field would flow, of a stress of its
  /// in Pa (Voigt order, in-plane in 2D) with this one out of the plane.
  virtual double flow_share(const Strain<dim> & /*stress*/, double /*out_of_plane*/) const
  {
    return 0;
  }
  /// Accumulated plastic strain of a particle, and the strain that no stress answers: xx, yy, zz,
  /// xy, yz, xz in the axes of space.
  virtual double plastic_strain(int /*particle*/) const { return 0; }
  virtual std::array<double, 6> inelastic_strain(const Particles<dim> &, int /*particle*/) const
  {
    return {};
  }

  /// Number of a particle's material; 0: the one that it shares with the far field.
  virtual int material(int /*particle*/) const { return 0; }

  /// Chemical symbols of the materials, by their numbers; empty: no atoms.
  virtual std::vector<std::string> symbols() const { return {}; }
  /// Of all particles in their present state.
  virtual std::vector<OwnField> own_fields(const Particles<dim> &) const { return {}; }

  /// It wakes what it acts on, see ParticleForce::set_rest: blocks of particles may rest.
  virtual bool can_rest() const { return false; }

  /// What the intact body has no need of.
  virtual std::vector<core::SkippedPart> skipped_parts() const { return {}; }
};
} // namespace ligament::particles
