// What contacts remember, and how it comes back to those of another object for the same body.
#include "dem/contacts.h"

#include <algorithm>
#include <map>

namespace ligament::dem
{
namespace
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

constexpr std::int64_t is_known = 1, is_from_face = 2, has_overlap = 4, is_bonded = 8; // flags
} // namespace

template <int dim>
void Contacts<dim>::save(core::State &state, const core::Names &names) const
{
  std::vector<std::int64_t> keys, i, j, flags, image;
  std::vector<double> overlap;
  std::map<std::string, std::vector<double>> numbers;
  for (const Contact<dim> &c : contacts_) {
    keys.insert(keys.end(), c.name.begin(), c.name.end());
    i.push_back(names.name(c.face.i));
    j.push_back(names.name(c.face.j));
    flags.push_back((c.known ? is_known : std::int64_t(0)) |
                    (c.from_face ? is_from_face : std::int64_t(0)) |
                    (c.last_overlap ? has_overlap : std::int64_t(0)) |
                    (c.is_bonded ? is_bonded : std::int64_t(0)));
    overlap.push_back(c.last_overlap.value_or(0));
    image.push_back(PeriodicImages<dim>::number_of(c.face.image));
    for_each_number<dim>(
        c, [&](const std::string &column, double value) { numbers[column].push_back(value); });
  }
  core::Table table(std::move(keys), 3);
  table.add("i", i);
  table.add("j", j);
  table.add("flags", flags);
  table.add("last_overlap", overlap);
  if (std::any_of(contacts_.begin(), contacts_.end(),
                  [](const Contact<dim> &c) { return c.face.image; }))
    table.add("image", image);
  for (const auto &[column, values] : numbers)
    table.add(column, values);
  state["contacts"] = std::move(table);
  core::save_sum(state, "frictional_work", frictional_work_);
  core::save_sum(state, "contact_step_error", step_error_);
}

template <int dim>
void Contacts<dim>::load(const core::State &state, const core::Names &names,
                         const PeriodicImages<dim> &images,
                         const std::function<Bond<dim>(int, int, double)> &make_face)
{
  const core::Table &table = core::table(state, "contacts");
  const auto i = table.integers("i"), j = table.integers("j"), flags = table.integers("flags");
  const auto overlap = table.reals("last_overlap");
  const auto image = table.has("image") ? table.integers("image") : std::vector<std::int64_t>();
  std::map<std::string, std::vector<double>> numbers;
  for (const std::string &column : table.columns())
    numbers[column] = table.reals(column);

  std::map<std::array<std::int64_t, 3>, Contact<dim>> of_faces;
  for (Contact<dim> &c : contacts_)
    of_faces.emplace(c.name, c);
  contacts_.clear();
  for (std::size_t r = 0; r < table.n_rows(); ++r) {
    const std::array<std::int64_t, 3> name = {table.keys()[3 * r], table.keys()[3 * r + 1],
                                              table.keys()[3 * r + 2]};
    const int here = names.index(i[r]), there = names.index(j[r]);
    if (here < 0 || there < 0)
      continue;
    const auto known = of_faces.find(name);
    Contact<dim> c = known != of_faces.end()
                         ? known->second
                         : make(make_face(here, there, numbers.at("distance")[r]), false);
    c.name = name;
    c.face.j = there;
    if (!image.empty())
      c.face.image = images.of(int(image[r]));
    c.from_face = flags[r] & is_from_face;
    c.known = flags[r] & is_known;
    c.is_bonded = flags[r] & is_bonded;
    c.last_overlap = flags[r] & has_overlap ? std::optional(overlap[r]) : std::nullopt;
    for_each_number<dim>(
        c, [&](const std::string &column, double &value) { value = numbers.at(column)[r]; });
    contacts_.push_back(std::move(c));
  }
  // Of particles that the state does not know: as they are in the reference.
  const core::Table &old = core::table(state, "particles");
  for (const auto &[name, c] : of_faces)
    if (!std::binary_search(old.keys().begin(), old.keys().end(), name[0]) ||
        !std::binary_search(old.keys().begin(), old.keys().end(), name[1]))
      insert(c);
  frictional_work_ = core::load_sum(state, "frictional_work");
  step_error_ = core::load_sum(state, "contact_step_error");
}

template void Contacts<2>::save(core::State &, const core::Names &) const;
template void Contacts<3>::save(core::State &, const core::Names &) const;
template void Contacts<2>::load(const core::State &, const core::Names &, const PeriodicImages<2> &,
                                const std::function<Bond<2>(int, int, double)> &);
template void Contacts<3>::load(const core::State &, const core::Names &, const PeriodicImages<3> &,
                                const std::function<Bond<3>(int, int, double)> &);
} // namespace ligament::dem
