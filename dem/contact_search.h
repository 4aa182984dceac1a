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

  /// From now on other ranks hold other parts of the body; they call update() together. `owners`
  /// must outlive it.
  void join(const particles::Owners &owners) { owners_ = &owners; }
  bool is_due() const { return due_; }
  void set_due(bool due) { due_ = due; }

  /// Particle i lies on a surface from now on; the next search is due at once.
  void add_surface_particle(int i);

  /// Adds contacts between surface particles nearer than their distance + 2 skin that share neither
  /// bond nor contact, in the call after the one that saw a surface particle moved by the skin of
  /// d/4 since the last search; drops those found before that went apart. The order depends on
  /// global ids alone. Particles across the same initial cut meet in its joints only, which go on
  /// from particle to particle. Of a body in parts: core::GuardStop on all ranks where a particle
  /// comes near one that its rank doesn't see.
  void update(const Particles &particles, const BondNetwork<dim> &bonds, Contacts<dim> &contacts);

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

  bool has_moved(const Particles &particles) const;
  /// Of a body in parts: whether contacts need particles that are not at hand.
  void stop_at_strangers(const Particles &particles, const Contacts<dim> &contacts) const;
  bool meets_strangers(const Particles &particles) const;
  bool slides_to_strangers(const Particles &particles, const Contacts<dim> &contacts) const;
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
  std::vector<Vector<dim>> searched_at_; // of the first of them, displacements at the last search
  bool due_ = true;
  const particles::Owners *owners_ = nullptr; // null: all are one's own
};
} // namespace ligament::dem
