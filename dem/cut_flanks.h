// The two flanks of every initial cut: who lies on them, and who meets whom when they slide.
#pragma once

#include "dem/contact_guests.h"
#include "dem/contacts.h"
#include "packings/packing.h"

#include <map>
#include <set>

namespace ligament::dem
{
template <int dim>
class CutFlanks
{
public:
  using Particles = particles::Particles<dim>;

  explicit CutFlanks(const packings::Packing<dim> &packing);

  /// The particles are a part of a body from now on: all ranks tell each other who lies on a flank.
  /// `guests` must outlive it.
  void join(const ContactGuests<dim> &guests, const Particles &particles);
  /// Particle i has come, of this name.
  void append(int i, std::int64_t name);

  /// Whether both lie within 1.5 particles of the same cut, on opposite sides of it, neither has
  /// left it, and one of them still has a joint: they never interlock.
  bool face_each_other(int i, int j) const;

  /// Looks who still has joints: flanks that have slid off each other meet like all else when they
  /// come back. All ranks call it, when joints have gone on or ended.
  void find_joined(const Particles &particles, const Contacts<dim> &contacts);

  /// The particles of joints whose flanks have turned against each other by more than 25 degrees
  /// leave the cut for good: there is no plane any more that both would lie on. All ranks call it.
  void leave_where_turned(const Particles &particles, const Contacts<dim> &contacts);

  /// Joints whose flanks have slid by more than half a spacing since go on to the particle of the
  /// same flank that has come nearest to where the partner was; those that slid off its end end, as
  /// do those of particles that have left.
  void pass_on_joints(const Particles &particles, Contacts<dim> &contacts) const;

  /// Such a joint of a body in parts: particle i keeps it.
  struct Passing
  {
    std::array<std::int64_t, 3> joint;
    std::int64_t i, to; // names of particles
    bool ends;          // there is none that it could go on to
  };
  /// Of the joints whose particle i is one's own.
  std::vector<Passing> passings(const Particles &particles, const Contacts<dim> &contacts) const;

  /// Who has left, as the table "left_flanks"; nothing where there are no cuts.
  void save(core::State &state) const;
  void load(const core::State &state, const core::Names &names);

private:
  /// A particle with faces of a cut; it may be another rank's.
  struct Facing
  {
    std::int64_t name;
    int particle;      // -1: not at hand
    Vector<dim> place; // m, reference
  };
  /// Where a joint goes on at present.
  struct Next
  {
    bool stays;
    const Facing *to; // null: it ends
  };
  Next next(const Contact<dim> &c, const Particles &particles) const;
  bool has_left(std::int64_t name) const { return left_.count(name) > 0; }
  /// `i` is below 0 where the particle is not at hand.
  void leave(int i, std::int64_t name);

  struct Flanks
  {
    std::map<int, bool> positive;              // particles near the cut: on its positive side?
    std::array<std::vector<Facing>, 2> facing; // those with its faces: negative, positive side
  };
  /// A particle near a cut, as ranks tell each other of it.
  struct Told
  {
    std::int64_t name;
    int cut;
    bool is_positive, faces;
    std::array<double, dim> place; // m, reference
  };
  std::vector<Told> own_flanks(const Particles &particles) const;

  double spacing_, largest_; // m, of particles
  std::vector<Flanks> cuts_;
  std::set<std::int64_t> left_;                // names of particles, on all ranks
  std::set<std::int64_t> joined_, own_joined_; // with a joint: on all ranks; one's own
  std::vector<char> is_joined_;                // particles at hand
  const ContactGuests<dim> *guests_ = nullptr; // null: all are one's own
  std::multimap<std::int64_t, Told> told_;     // by names, of all ranks
};
} // namespace ligament::dem
