// Particles of other ranks that contacts alone see.
#pragma once

#include "particles/halo.h"

#include <functional>
#include <memory>

namespace ligament::dem
{
/// They lie behind all that a part of a body holds from the start, come when they are asked for,
/// stay, and move as their owners say.
template <int dim>
class ContactGuests
{
public:
  using Particles = particles::Particles<dim>;

  /// What a guest brings besides its place.
  struct Guest
  {
    std::int64_t name;
    int owner, material;
    double volume, mass, diameter;     // m^3, kg, m
    std::array<double, dim> reference; // m
  };
  /// What only contacts know of a particle: sets material and diameter of particle i.
  using Describe = std::function<void(int i, Guest &guest)>;

  /// Of the particles that a part holds; those that are `kept` are the ones whose contacts, all of
  /// them, are known here. The owners of guests are added to `owners`.
  ContactGuests(std::shared_ptr<particles::Owners> owners, const Particles &particles,
                std::vector<char> kept);

  const core::Ranks &ranks() const { return owners_->ranks; }
  bool is_own(int i) const { return owners_->is_own(i); }
  /// Whether contacts of particle i are known here.
  bool keeps(int i) const { return i >= 0 && i < first() && kept_[i]; }
  bool keeps(int i, int j) const { return keeps(i) || keeps(j); }
  /// Of the guests.
  int first() const { return int(kept_.size()); }
  /// Of a particle at hand; -1: it is not.
  int index(std::int64_t name) const { return names_.index(name); }

  /// Those of these names that are not at hand come behind the particles, with their present
  /// motion; returns them, in their order. All ranks call it.
  std::vector<Guest> invite(std::vector<std::int64_t> names, Particles &particles,
                            const Describe &describe);

  /// After each drift: where the guests are.
  void update(Particles &particles);

private:
  std::shared_ptr<particles::Owners> owners_;
  std::vector<char> kept_; // of what a part holds from the start
  core::Names names_;      // of all
  particles::Halo<dim> halo_;
};
} // namespace ligament::dem
