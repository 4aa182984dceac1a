// Finds particles on surfaces that come near each other and were never neighbours.
#pragma once

#include "dem/bond_network.h"
#include "dem/contacts.h"
#include "dem/cut_flanks.h"

namespace ligament::dem
{
template <int dim>
class ContactSearch
{
public:
  using Particles = particles::Particles<dim>;

  /// New contacts have the mean diameter of their particles as distance (d on lattices), or the
  /// distance in the reference or at present where that is less, and a face in proportion to
  /// `face_area` (m^2), which belongs to d. They press with nothing when they are found.
  /// `images` (null: none) must outlive it.
  ContactSearch(const packings::Packing<dim> &packing, double face_area,
                const PeriodicImages<dim> *images = nullptr);

  /// From now on other ranks hold other parts of the body; they call update() together. `guests`
  /// must outlive it.
  void join(ContactGuests<dim> &guests, const Particles &particles);
  /// Particles of these names come where they are not at hand, also into the contacts. All ranks
  /// call it.
  void invite(const std::vector<std::int64_t> &names, Particles &particles,
              Contacts<dim> &contacts);
  bool is_due() const { return due_; }
  void set_due(bool due) { due_ = due; }

  /// Particle i lies on a surface from now on; the next search is due at once.
  void add_surface_particle(int i);

  /// Adds contacts between surface particles nearer than their distance + 2 skin that share neither
  /// bond nor contact, in the call after the one that saw a surface particle moved by the skin of
  /// d/4 since the last search; drops those found before that went apart. The order depends on
  /// global ids alone. Particles across the same initial cut meet in its joints only, which go on
  /// from particle to particle. Of a body in parts: those of other ranks that come near come first.
  void update(Particles &particles, const BondNetwork<dim> &bonds, Contacts<dim> &contacts);

  /// Whether free surfaces may meet before anything breaks: those of a box never do. Of what is at
  /// hand of the body.
  bool may_meet() const { return may_meet_; }
  /// has_moved() counts from the reference until the first search; else it says no until then.
  void watch_from_reference() { searched_at_.assign(surface_.size(), Vector<dim>::Zero()); }
  /// Whether a surface particle has moved by the skin since the last search, or the reference, or
  /// two images have come nearer by twice the skin.
  bool has_moved(const Particles &particles) const;

  /// The face of a contact that a search found when the two were `distance` m apart, or touched: in
  /// proportion to the diameters; its normal is not known.
  Bond<dim> face_between(int i, int j, double distance,
                         const PeriodicImage<dim> *image = nullptr) const;

  /// Where the surface particles were at the last search, as the table "searched".
  void save(core::State &state, const core::Names &names) const;
  /// The surface particles are there already.
  void load(const core::State &state, const core::Names &names);

private:
  /// A particle, or an image of it.
  struct Partner
  {
    int particle;
    const PeriodicImage<dim> *image;
  };

  bool is_own(int i) const { return !guests_ || guests_->is_own(i); }
  /// Of a body in parts: particles of other ranks that come near those whose contacts are kept.
  void meet_others(Particles &particles, Contacts<dim> &contacts);
  /// The same as CutFlanks does in one process.
  void pass_on_joints(Particles &particles, Contacts<dim> &contacts);
  void add_seen(int i); // on a surface, whoever found it
  std::array<Vector<dim>, dim> jumps() const;
  double diameter(int i) const { return diameter_.empty() ? spacing_ : diameter_[i]; }
  /// Centre distance at which two particles touch.
  double rest_distance(const Particles &particles, int i, const Partner &partner) const;
  /// At present, of the image.
  static Vector<dim> place_of(const Particles &particles, const Partner &partner);

  const PeriodicImages<dim> *images_;
  CutFlanks<dim> flanks_;
  double spacing_, skin_, face_area_, largest_;
  std::vector<double> diameter_;
  std::vector<bool> on_surface_;
  std::vector<int> surface_;             // particles on surfaces
  // Of the first of them, displacements at the last search; before it none.
  std::vector<Vector<dim>> searched_at_;
  std::array<Vector<dim>, dim> searched_jumps_; // of the images then
  bool due_ = true, may_meet_ = false;
  ContactGuests<dim> *guests_ = nullptr; // null: all are one's own
};
} // namespace ligament::dem
