// Touching faces: a penalty without tension, Coulomb friction, and the joints of initial cuts.
#pragma once

#include "core/exact_sum.h"
#include "core/names.h"
#include "dem/bond.h"
#include "dem/contact_guests.h"
#include "dem/materials.h"
#include "dem/periodic_images.h"

#include <array>
#include <functional>
#include <map>
#include <optional>

namespace ligament::dem
{
/// Two particles that may touch (theory.md section 1.6). Distances are between the centres.
template <int dim>
struct Contact
{
  /// Ids of the two particles that it began with, the smaller one first; of a joint the number of
  /// its cut and 1.
  std::array<std::int64_t, 3> name;
  Bond<dim> face;       // reference geometry of the face, if it had one
  bool from_face;       // was a face of the packing; false: found by the search, or passed on
  double own_distance;  // m, of the face; its present one is another while it bears a bond's load
  double share_i;       // q_i / (q_i + q_j): the contact point lies at share_i r from i
  double shear_modulus; // Pa, of both sides in series
  double friction;      // Coulomb's coefficient
  // Smooth joint: the contact has the normal of the cut, not that of its face.
  int cut = -1;                             // number of the initial cut; -1: no joint
  Vector<dim> cut_normal = face.normal;     // unit, i -> j, reference
  Vector<dim> home = Vector<dim>::Zero();   // m, reference: centre of the partner of the packing
  Vector<dim> passed = Vector<dim>::Zero(); // m, reference: how far j had slid when it came to i
  // Friction: the elastic slip of j against i, and where both were when it was last updated.
  Vector<dim> slip = Vector<dim>::Zero(); // m
  Vector<dim> last_between = Vector<dim>::Zero(), last_lever = last_between,
              last_normal = last_between;
  Turn<dim> last_turn_i = {}, last_turn_j = {};
  double last_angle_i = 0, last_angle_j = 0; // 2D
  bool known = false;
  // Opening and closing: theory.md eq. (E10).
  std::optional<double> last_overlap = {}; // m
  double correction = 0;                   // N, added to the pressure in the step of the change
  bool is_bonded = false;                  // again: the bond bears, this waits

  bool is_joint() const { return cut >= 0; }
};

/// One that is closed, as small motions about a state see it.
template <int dim>
struct ClosedContact
{
  int i, j;
  Vector<dim> lever_i, lever_j, normal; // m, from the centres; unit, i -> j
  double stiffness;                     // N/m
  bool sticks;                          // faces don't slide along each other

  /// Of the motion of j's side against i's: what pulls at i, over the stiffness.
  Vector<dim> answer(const Vector<dim> &motion) const
  {
    return sticks ? motion : Vector<dim>(normal * normal.dot(motion));
  }
};

/// One that presses, as it could be bonded again.
template <int dim>
struct PressedContact
{
  Vector<dim> lever_i, lever_j, normal; // m, to the point where they touch; unit, i -> j
  Vector<dim> force;                    // N, on i
  double area, distance;                // m^2, m: of the bond
  double pressure, energy;              // Pa, J
  /// On i; the force's about its centre where the contact says so.
  Spin<dim> torque;
};

template <int dim>
class Contacts
{
public:
  using Particles = particles::Particles<dim>;

  /// `ids` of the particles; empty: their indices. Contacts are in the order of their names, but
  /// for those that add() and add_joint() put behind them until settle() is called.
  explicit Contacts(const Materials &materials, const std::vector<std::int64_t> &ids = {},
                    int n_particles = 0)
      : materials_(materials),
        ids_(ids.empty() ? particles::GlobalIds(n_particles) : particles::GlobalIds(ids))
  {
  }

  /// Becomes the last one, so that many at once cost no more than their number; valid until the
  /// next one comes.
  Contact<dim> &add(const Bond<dim> &face, bool from_face);
  /// Brings those that were added to their places. To be called before the next step, save() or
  /// find().
  void settle();

  /// Ranks that hold other parts of the body step some of the particles from now on (must outlive
  /// it). All call add_forces() together; contacts whose first particle is one's own are booked.
  /// Those that are not kept are dropped.
  void join(const ContactGuests<dim> &guests);
  /// Guests have come.
  void append(const std::vector<typename ContactGuests<dim>::Guest> &guests);
  /// Tells all ranks of these; those that keep contacts of their particles and lack them have them
  /// from now on. All ranks call it.
  void tell(const std::vector<std::size_t> &of);
  /// Tells of the joints that have gone on from particle to particle.
  void tell_passed_on();
  int material(int particle) const { return materials_.number(particle); }

  /// A face of initial cut number `cut`, whose unit normal is given (either sense); centre of j in
  /// the reference (m).
  void add_joint(const Bond<dim> &face, int cut, const Vector<dim> &cut_normal,
                 const Vector<dim> &centre_j);

  /// Adds forces and torques; updates slips and books the work of friction and the step error. The
  /// forces of everything else are there already; dt (s) is the step. Calling it again in the same
  /// state changes neither. What corrects a contact that opened or closed goes by the forces of all
  /// contacts without their corrections: it has no order.
  void add_forces(Particles &particles, double dt);
  /// A contact whose bond broke while `force` (N, on its first particle) pressed it together bears
  /// of it what friction can. It presses so until it opens for the first time.
  void take_over(std::size_t k, const Vector<dim> &force, const Particles &particles);
  /// The same as add_forces for one contact, by its place in all().
  void add_force(std::size_t k, Particles &particles, double dt);

  /// Of contact k, if it is closed and has been for a step.
  std::optional<PressedContact<dim>> pressed(std::size_t k, const Particles &particles) const;
  /// Place in all() of one of this name.
  std::size_t place(const std::array<std::int64_t, 3> &name) const;
  std::optional<std::size_t> find(const std::array<std::int64_t, 3> &name) const;
  void erase(std::size_t k) { contacts_.erase(contacts_.begin() + std::ptrdiff_t(k)); }
  /// It is a bond from now on; and a contact again, flow having drawn its particles apart by
  /// `grown` (m). It presses with nothing where it is shut, unless it takes over a force.
  void bond(std::size_t k);
  void part(std::size_t k, double grown, const Particles &particles);

  /// Adds forces and torques of a state that may not stay, after the slips of the last
  /// add_forces(); nothing is remembered. Returns those that are closed.
  std::vector<ClosedContact<dim>> add_trial_forces(Particles &particles) const;

  /// Openings and closings since the last step happened in equilibrium: they cost nothing. From
  /// now on faces grip as soon as they touch without pressure, lest the slip of a long way be lost.
  void forget_steps();

  /// Energy of one contact, in J: of its compression, of its elastic slip, and both.
  double compression_energy(const Contact<dim> &contact, const Particles &particles) const;
  double slip_energy(const Contact<dim> &contact, const Particles &particles) const;
  double energy(const Contact<dim> &contact, const Particles &particles) const;

  const core::ExactSum &frictional_work() const { return frictional_work_; }

  /// Energy in J that the leap-frog lost (above 0) where contacts opened and closed between two
  /// steps, after the correction: exactly what (E1) misses.
  const core::ExactSum &step_error() const { return step_error_; }

  /// visit(i, a, f): lever (m) and force (N) on particle i of every contact that is closed.
  template <typename Visit>
  void for_each_moment(const Particles &particles, Visit &&visit) const;

  const std::vector<Contact<dim>> &all() const { return contacts_; }

  /// visit(image, force on i in N) for every contact with an image.
  template <typename Visit>
  void for_each_across(const Particles &particles, Visit &&visit) const;

  /// Whether a pair of faces slid so far along each other that it may meet others.
  bool has_slid(const Particles &particles, double distance) const;

  /// Drops the contacts that the search found and that are farther apart than `distance` (m).
  void drop_distant(const Particles &particles, double distance);

  /// How far j has slid along the cut against i since the reference, in m, reference axes.
  static Vector<dim> slide(const Contact<dim> &joint, const Particles &particles);

  /// Joint number k goes on between i and `j`, or ends when j < 0. What that changes of the energy
  /// counts as frictional work.
  void pass_on(std::size_t k, int j, const Particles &particles);

  /// What contacts remember, as the table "contacts", and the energies that they took.
  void save(core::State &state, const core::Names &names) const;
  /// Those of faces are there already; `images` are those of the body; make_face(i, j, distance) is
  /// the face of one that a search found. Contacts of particles with rows that have none themselves
  /// have ended.
  void load(const core::State &state, const core::Names &names, const PeriodicImages<dim> &images,
            const std::function<Bond<dim>(int, int, double)> &make_face);

private:
  struct State
  {
    Vector<dim> between;       // m, centre i to centre j
    Vector<dim> normal;        // unit, i -> j
    Vector<dim> lever;         // m, centre i to the point where both touch
    double overlap, stiffness; // m, N/m
  };
  State state(const Contact<dim> &contact, const Particles &particles) const;
  /// Returns what friction took, in J.
  double update_slip(Contact<dim> &contact, const State &state, const Particles &particles) const;
  /// The same where there is friction, from when the faces touch.
  double follow_slip(Contact<dim> &contact, const State &state, const Particles &particles) const;
  void add_force(const Contact<dim> &contact, const State &state, const Vector<dim> &force,
                 Particles &particles) const;
  /// A contact that has opened or closed since the last step.
  struct Change
  {
    std::size_t contact;
    State state;
    double last; // m, its overlap then
  };
  /// What a particle is about to do.
  struct Motion
  {
    Vector<dim> velocity, force; // m/s, N
    Spin<dim> spin, torque;      // rad/s, N m
  };
  /// Adds the force of one without its correction; the last ones are looked at here.
  void press(std::size_t k, Particles &particles, std::vector<Change> &changed,
             std::vector<std::size_t> &corrected);
  /// Finds their corrections.
  void correct(const std::vector<Change> &changed, const Particles &particles, double dt);
  void add_corrections(const std::vector<std::size_t> &corrected, Particles &particles) const;
  /// Of the particles of these contacts that other ranks step.
  std::map<int, Motion> foreign_motions(const std::vector<Change> &changed,
                                        const Particles &particles) const;
  static Motion motion_of(const Particles &particles, int i);
  Contact<dim> make(const Bond<dim> &face, bool from_face) const;
  /// Pa, of both sides in series by their shares.
  double modulus(const Contact<dim> &c) const;

  Materials materials_;
  particles::GlobalIds ids_;
  std::vector<Contact<dim>> contacts_;
  bool grips_at_touch_ = false;
  core::ExactSum frictional_work_, step_error_;
  const ContactGuests<dim> *guests_ = nullptr; // null: all are one's own
};

template <int dim>
template <typename Visit>
void Contacts<dim>::for_each_across(const Particles &p, Visit &&visit) const
{
  for (const auto &c : contacts_) {
    if (!c.face.image || c.is_bonded)
      continue;
    const State s = state(c, p);
    Vector<dim> f = -c.correction * s.normal;
    if (s.overlap > 0)
      f += s.stiffness * (c.slip - s.overlap * s.normal);
    visit(*c.face.image, f);
  }
}

template <int dim>
template <typename Visit>
void Contacts<dim>::for_each_moment(const Particles &p, Visit &&visit) const
{
  for (const auto &c : contacts_) {
    const State s = state(c, p);
    if (s.overlap <= 0 || c.is_bonded)
      continue;
    const Vector<dim> f = s.stiffness * (c.slip - s.overlap * s.normal);
    visit(c.face.i, s.lever, f);
    visit(c.face.j, Vector<dim>(s.lever - s.between), Vector<dim>(-f));
  }
}
} // namespace ligament::dem
