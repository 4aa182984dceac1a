// The numbers of a contact, by name: those that its past decided, and those of its face.
#pragma once

#include "dem/contacts.h"

#include <string>

namespace ligament::dem
{
/// visit(column, number) for every number that a contact's past decided.
template <int dim, typename C, typename Visit>
void for_each_number(C &c, Visit &&visit)
{
  const auto vector = [&](const std::string &name, auto &v) {
    for (int k = 0; k < dim; ++k)
      visit(name + "_" + std::to_string(k), v[k]);
  };
  const auto turn = [&](const std::string &name, auto &t) {
    if constexpr (dim == 2) {
      visit(name + "_cosine_minus_1", t.cosine_minus_1);
      visit(name + "_sine", t.sine);
    } else {
      visit(name + "_w", t.w);
      vector(name + "_v", t.v);
    }
  };
  visit("distance", c.face.distance);
  visit("own_distance", c.own_distance);
  visit("share_i", c.share_i);
  vector("lever_j", c.face.lever_j);
  vector("passed", c.passed);
  vector("slip", c.slip);
  vector("last_between", c.last_between);
  vector("last_lever", c.last_lever);
  vector("last_normal", c.last_normal);
  turn("last_turn_i", c.last_turn_i);
  turn("last_turn_j", c.last_turn_j);
  visit("last_angle_i", c.last_angle_i);
  visit("last_angle_j", c.last_angle_j);
  visit("correction", c.correction);
}

/// Of its face and its materials, visit(number): what they were in the reference, and the modulus,
/// which follows from them and from share_i.
template <int dim, typename C, typename Visit>
void for_each_constant(C &c, Visit &&visit)
{
  for (auto *const v : {&c.face.normal, &c.face.lever_i, &c.cut_normal, &c.home})
    for (int k = 0; k < dim; ++k)
      visit((*v)[k]);
  visit(c.face.area);
  visit(c.shear_modulus);
  visit(c.friction);
}

/// Of a contact, in one number.
struct ContactFlags
{
  static constexpr std::int64_t is_known = 1, is_from_face = 2, has_overlap = 4, is_bonded = 8;

  template <int dim>
  static std::int64_t of(const Contact<dim> &c)
  {
    return (c.known ? is_known : std::int64_t(0)) | (c.from_face ? is_from_face : std::int64_t(0)) |
           (c.last_overlap ? has_overlap : std::int64_t(0)) |
           (c.is_bonded ? is_bonded : std::int64_t(0));
  }
  template <int dim>
  static void set(Contact<dim> &c, std::int64_t flags, double overlap)
  {
    c.from_face = flags & is_from_face;
    c.known = flags & is_known;
    c.is_bonded = flags & is_bonded;
    c.last_overlap = flags & has_overlap ? std::optional(overlap) : std::nullopt;
  }
};
} // namespace ligament::dem
