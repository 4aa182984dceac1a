// Touching faces: a penalty without tension, Coulomb friction, and the search for new contacts.
#pragma once

#include "dem/bond.h"
#include "dem/materials.h"

namespace ligament::dem
{
/// Two particles that may touch (theory.md section 1.6). Distances are between the centres.
template <int dim>
struct Contact
{
  Bond<dim> face;       // reference geometry of the face, if it had one
  bool from_face;       // was a face of the packing; false: found by the search
  double share_i;       // q_i / r0: the contact point lies at share_i r from i
  double shear_modulus; // Pa, of both sides in series
  double friction;      // Coulomb's coefficient
  // Friction: the elastic slip of j against i, and where both were when it was last updated.
  Vector<dim> slip = Vector<dim>::Zero(); // m
  Vector<dim> last_distance = Vector<dim>::Zero();
  Turn<dim> last_turn_i, last_turn_j;
  double last_angle_i = 0, last_angle_j = 0; // 2D
  bool known = false;
};

template <int dim>
class Contacts
{
public:
  using Particles = particles::Particles<dim>;

  explicit Contacts(const Materials &materials) : materials_(materials) {}

  void add(const Bond<dim> &face, bool from_face);

  /// Adds forces and torques; updates slips and books the work of friction. Calling it again in the
  /// same state changes neither.
  void add_forces(Particles &particles);

  /// Compression and elastic slip, in J.
  double energy(const Particles &particles) const;

  /// Energy of one contact's compression, in J.
  double compression_energy(const Contact<dim> &contact, const Particles &particles) const;

  double frictional_work() const { return frictional_work_; }

  /// Adds S a (x) t (N m, Voigt order) of the present normal and frictional forces.
  void add_moments(const Particles &particles, Components<n_strains<dim>> &moments) const;

  /// visit(i, a, f): lever (m) and force (N) on particle i of every contact that is closed.
  template <typename Visit>
  void for_each_moment(const Particles &particles, Visit &&visit) const;

  const std::vector<Contact<dim>> &all() const { return contacts_; }

  /// Whether a pair of faces slid so far along each other that it may meet others.
  bool has_slid(const Particles &particles, double distance) const;

  /// Drops the contacts that the search found and that are farther apart than `distance` (m).
  void drop_distant(const Particles &particles, double distance);

private:
  struct State
  {
    Vector<dim> normal;
    double distance, overlap, stiffness; // m, m, N/m
  };
  State state(const Contact<dim> &contact, const Particles &particles) const;
  void update_slip(Contact<dim> &contact, const State &state, const Particles &particles);

  Materials materials_;
  std::vector<Contact<dim>> contacts_;
  double frictional_work_ = 0;
};

template <int dim>
template <typename Visit>
void Contacts<dim>::for_each_moment(const Particles &p, Visit &&visit) const
{
  for (const auto &c : contacts_) {
    const State s = state(c, p);
    if (s.overlap <= 0)
      continue;
    const Vector<dim> f = s.stiffness * (c.slip - s.overlap * s.normal), x = s.distance * s.normal;
    visit(c.face.i, Vector<dim>(c.share_i * x), f);
    visit(c.face.j, Vector<dim>((c.share_i - 1) * x), Vector<dim>(-f));
  }
}
} // namespace ligament::dem
