// Contacts that come many at once, as where a body falls to pieces.
#include "dem/contacts.h"

#include "tests/unit/dem/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>

namespace ligament::dem::testing
{
/// Of neighbours in a row, in metres their number apart.
template <int dim>
Bond<dim> face_of(int i)
{
  const Vector<dim> n = Vector<dim>::Unit(0);
  return {i, i + 1, n, 0.5 * n, -0.5 * n, 1, 1. + i, 0, 0};
}

template <int dim>
void check_order()
{
  const DemMaterial material;
  constexpr int n = 50000;
  std::vector<int> drawn(n);
  for (int i = 0; i < n; ++i)
    drawn[i] = i;
  std::shuffle(drawn.begin(), drawn.end(), std::mt19937(1));
  Contacts<dim> contacts(material, {}, n + 1);
  const auto start = std::chrono::steady_clock::now();
  for (const int first : {0, 10, n / 2}) { // few, many, and many among many
    const int last = first == 0 ? 10 : first == 10 ? n / 2 : n;
    for (int k = first; k < last; ++k) {
      const Contact<dim> &added = contacts.add(face_of<dim>(drawn[k]), true);
      ASSERT_EQ(&added, &contacts.all().back());
    }
    contacts.settle();
    ASSERT_EQ(contacts.all().size(), std::size_t(last));
    std::vector<int> expected(drawn.begin(), drawn.begin() + last);
    std::sort(expected.begin(), expected.end());
    for (int k = 0; k < last; ++k) {
      const Contact<dim> &c = contacts.all()[k];
      const int i = expected[k];
      const std::array<std::int64_t, 3> name = {i, i + 1, 0};
      ASSERT_EQ(c.name, name);
      ASSERT_EQ(c.face.distance, 1. + i) << "it came with another face";
      ASSERT_EQ(contacts.find(name), std::optional<std::size_t>(k));
    }
  }
  // In proportion to their number this takes a tenth of a second, to its square more than a minute.
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20);
}

/// What touches without overlap grips behind an equilibrium, also where the run goes on elsewhere.
TEST(Contacts, GripsAtTouchAreSaved)
{
  const core::Names names({0, 1});
  for (const bool is_behind_equilibrium : {false, true}) {
    Contacts<2> contacts(DemMaterial(), {}, 2), other(DemMaterial(), {}, 2);
    other.forget_steps();
    if (is_behind_equilibrium)
      contacts.forget_steps();
    core::State state, taken;
    state["particles"] = core::Table(std::vector<std::int64_t>{0, 1});
    contacts.save(state, names);
    other.load(state, names, PeriodicImages<2>(Vector<2>::Zero()),
               [](int i, int, double) { return face_of<2>(i); });
    other.save(taken, names);
    EXPECT_EQ(core::load_integer(taken, "contact_steps", "grip_at_touch"), is_behind_equilibrium);
    EXPECT_EQ(state["contact_steps"], taken["contact_steps"]);
  }
}

/// Contacts of a face that has softened and slid before it broke are told a shorter distance: the
/// point between them stays where the face divides it, whichever of the two comes first.
TEST(Contacts, ShortenedFacesKeepTheirPoint)
{
  const Vector<3> n = Vector<3>::Unit(0), across = Vector<3>::Unit(1);
  const Vector<3> lever_i = 0.6 * n + 0.1 * across, lever_j = lever_i - n;
  const DemMaterial material;
  Contacts<3> contacts(material, {}, 2), turned(material, {}, 2);
  const Bond<3> face{0, 1, n, lever_i, lever_j, 1, 0.9, 0, 0};
  EXPECT_DOUBLE_EQ(contacts.add(face, true).share_i, 0.6);
  EXPECT_DOUBLE_EQ(turned.add({1, 0, -n, lever_j, lever_i, 1, 0.9, 0, 0}, true).share_i, 0.4);
}

TEST(Contacts, ManyAtOnceAreInOrder)
{
  check_order<2>();
  check_order<3>();
}
/// A contact that friction holds, its two particles turned about its normal: the force turns, too.
TEST(Contacts, FrictionTurnsAboutTheNormal)
{
  Packing<3> packing;
  packing.spacing = 1;
  packing.volume = {1, 1};
  packing.global_id = {0, 1};
  for (auto &x : packing.centre)
    x.assign(2, 0.);
  packing.centre[0][1] = 1;
  DemMaterial material;
  material.friction = 1;
  Particles<3> p = at_rest(packing, material);
  Contacts<3> contacts(material, {}, 2);
  contacts.add(face_of<3>(0), true);
  const auto force = [&] {
    for (auto *values : {&p.force, &p.torque})
      for (auto &component : *values)
        component.assign(2, 0.);
    contacts.add_forces(p, 1);
    return get(p.force, 0);
  };
  const Vector<3> press(-0.01, 0, 0), slip(0, 0.003, 0);
  set(p.displacement, 1, press);
  force();
  set(p.displacement, 1, Vector<3>(press + slip));
  const Vector<3> before = force();
  ASSERT_GT(before[1], 0.1 * std::abs(before[0]));
  constexpr int n = 200;
  for (int k = 1; k <= n; ++k) {
    const double angle = M_PI / 2 * k / n;
    for (const int i : {0, 1}) {
      p.rotation[0][i] = std::cos(angle / 2);
      p.rotation[1][i] = std::sin(angle / 2);
    }
    set(p.displacement, 1,
        Vector<3>(press + slip[1] * Vector<3>(0, std::cos(angle), std::sin(angle))));
    force();
  }
  const Vector<3> after = force();
  EXPECT_NEAR(after[0], before[0], 1e-3 * before.norm()); // the slip leans as the normal does
  EXPECT_NEAR(after[1], 0, 1e-2 * before[1]);
  EXPECT_NEAR(after[2], before[1], 1e-2 * before[1]);
}

} // namespace ligament::dem::testing
