// What contacts remember, and how it comes back to those of another object for the same body.
#include "dem/contact_numbers.h"

#include <algorithm>
#include <map>

namespace ligament::dem
{

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
    flags.push_back(ContactFlags::of(c));
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
  core::save_value(state, "contact_steps", "grip_at_touch", std::int64_t(grips_at_touch_));
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
    const bool is_told = known == of_faces.end() && name[2] > 0; // whoever has the face tells
    if (guests_ && (is_told || !guests_->keeps(here, there)))
      continue;
    Contact<dim> c = known != of_faces.end()
                         ? known->second
                         : make(make_face(here, there, numbers.at("distance")[r]), false);
    c.name = name;
    c.face.j = there;
    if (!image.empty())
      c.face.image = images.of(int(image[r]));
    ContactFlags::set(c, flags[r], overlap[r]);
    for_each_number<dim>(
        c, [&](const std::string &column, double &value) { value = numbers.at(column)[r]; });
    if (!c.is_joint()) // whose partners change, not their moduli
      c.shear_modulus = modulus(c);
    contacts_.push_back(std::move(c));
  }
  // Of particles that the state does not know: as they are in the reference.
  const core::Table &old = core::table(state, "particles");
  for (const auto &[name, c] : of_faces)
    if (!std::binary_search(old.keys().begin(), old.keys().end(), name[0]) ||
        !std::binary_search(old.keys().begin(), old.keys().end(), name[1]))
      contacts_.push_back(c);
  settle();
  frictional_work_ = core::load_sum(state, "frictional_work");
  step_error_ = core::load_sum(state, "contact_step_error");
  grips_at_touch_ = state.count("contact_steps") && // which older checkpoints don't have
                    core::load_integer(state, "contact_steps", "grip_at_touch") != 0;
}

template void Contacts<2>::save(core::State &, const core::Names &) const;
template void Contacts<3>::save(core::State &, const core::Names &) const;
template void Contacts<2>::load(const core::State &, const core::Names &, const PeriodicImages<2> &,
                                const std::function<Bond<2>(int, int, double)> &);
template void Contacts<3>::load(const core::State &, const core::Names &, const PeriodicImages<3> &,
                                const std::function<Bond<3>(int, int, double)> &);
} // namespace ligament::dem
