// The two flanks of every initial cut: who lies on them, and who meets whom when they slide.
#pragma once

#include "dem/contacts.h"
#include "packings/packing.h"

#include <map>

namespace ligament::dem
{
template <int dim>
class CutFlanks
{
public:
  using Particles = particles::Particles<dim>;

  explicit CutFlanks(const packings::Packing<dim> &packing);

  /// Whether both lie within 1.5 particles of the same cut, on opposite sides of it: they never
  /// interlock.
  bool face_each_other(int i, int j) const;

  /// The same of particles that may not be at hand, by their places in the reference (m).
  bool lie_beside(const Vector<dim> &a, const Vector<dim> &b) const;

  /// Joints whose flanks have slid by more than half a spacing since go on to the particle of the
  /// same flank that has come nearest to where the partner was; those that slid off its end end.
  void pass_on_joints(const Particles &particles, Contacts<dim> &contacts) const;

private:
  /// The partner that contact c would have at present; c's own: nobody is nearer; -1: none.
  int partner(const Contact<dim> &c, const Particles &particles) const;

  struct Flanks
  {
    std::map<int, bool> positive;           // particles near the cut: on its positive side?
    std::array<std::vector<int>, 2> facing; // those with faces of the cut: negative, positive side
  };
  /// Of a place: 1 or -1 beside cut number c, above or below it; 0: not beside it.
  int side(std::size_t c, const Vector<dim> &place) const;

  double spacing_, largest_; // m, of particles
  std::vector<packings::CrackPlane<dim>> planes_;
  std::vector<Flanks> cuts_;
};
} // namespace ligament::dem
