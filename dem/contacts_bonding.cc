// Contacts that become bonds again, and bonds that become contacts.
#include "dem/contacts.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
auto Contacts<dim>::pressed(std::size_t k, const Particles &p) const
    -> std::optional<PressedContact<dim>>
{
  const Contact<dim> &c = contacts_[k];
  if (c.is_bonded || c.correction != 0 || !c.last_overlap)
    return std::nullopt;
  const State s = state(c, p);
  if (s.overlap <= 0)
    return std::nullopt;
  // Of a joint as it is seen across the cut.
  const double cosine = c.is_joint() ? c.face.normal.dot(c.cut_normal) : 1;
  PressedContact<dim> now{s.lever,
                          s.lever - s.between,
                          s.normal,
                          s.stiffness * (c.slip - s.overlap * s.normal),
                          c.face.area * cosine,
                          c.face.distance * cosine,
                          s.stiffness * s.overlap / (c.face.area * cosine),
                          energy(c, p),
                          Spin<dim>::Zero()};
  if (c.friction > 0 || c.is_joint())
    now.torque = cross(s.lever, now.force);
  return now;
}

template <int dim>
std::size_t Contacts<dim>::place(const std::array<std::int64_t, 3> &name) const
{
  const auto found = find(name);
  core::require(found.has_value(), "a face that is bonded again is a contact");
  return *found;
}

template <int dim>
void Contacts<dim>::bond(std::size_t k)
{
  Contact<dim> &c = contacts_[k];
  c.is_bonded = true;
  c.known = false;
  c.slip.setZero();
  c.last_overlap.reset();
  c.correction = 0;
}

template <int dim>
void Contacts<dim>::part(std::size_t k, double grown, const Particles &p)
{
  Contact<dim> &c = contacts_[k];
  c.is_bonded = false;
  if (c.is_joint()) {
    c.passed += grown * state(c, p).normal;
    return;
  }
  c.own_distance += grown;
  c.face.distance = std::min(c.own_distance, state(c, p).between.norm());
}

template std::optional<PressedContact<2>> Contacts<2>::pressed(std::size_t,
                                                               const Particles &) const;
template std::optional<PressedContact<3>> Contacts<3>::pressed(std::size_t,
                                                               const Particles &) const;
template std::size_t Contacts<2>::place(const std::array<std::int64_t, 3> &) const;
template std::size_t Contacts<3>::place(const std::array<std::int64_t, 3> &) const;
template void Contacts<2>::bond(std::size_t);
template void Contacts<3>::bond(std::size_t);
template void Contacts<2>::part(std::size_t, double, const Particles &);
template void Contacts<3>::part(std::size_t, double, const Particles &);
} // namespace ligament::dem
