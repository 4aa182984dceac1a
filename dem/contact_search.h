// Finds particles on surfaces that come near each other and were never neighbours.
#pragma once

#include "dem/bond_network.h"
#include "dem/contacts.h"

namespace ligament::dem
{
template <int dim>
class ContactSearch
{
public:
  using Particles = particles::Particles<dim>;

  /// New contacts have the distance d and the mean face of the lattice (m^2).
  ContactSearch(const particles::Packing<dim> &packing, double face_area);

  /// Particle i lies on a surface from now on; the next search is due at once.
  void add_surface_particle(int i);

  /// Adds contacts between surface particles nearer than d + 2 skin that share neither bond nor
  /// contact, once a surface particle has moved by the skin of d/4 since the last search; drops
  /// those found before that went apart. The order depends on global ids alone.
  void update(const Particles &particles, const BondNetwork<dim> &bonds, Contacts<dim> &contacts);

private:
  bool due(const Particles &particles) const;

  double spacing_, skin_, face_area_;
  std::vector<char> on_surface_;
  std::vector<int> surface_;             // particles on surfaces
  std::vector<Vector<dim>> searched_at_; // their displacements at the last search
};
} // namespace ligament::dem
