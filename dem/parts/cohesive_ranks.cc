// Faces that soften of a body in parts: what ranks tell each other of them.
#include "dem/parts/cohesive_numbers.h"

#include <algorithm>

namespace ligament::dem
{
// Whoever has a particle that is another's has all rings up to it, so both know that they share it.
template <int dim>
void CohesiveFaces<dim>::join(std::shared_ptr<particles::Owners> owners, const core::Names &names,
                              const Particles &p)
{
  owners_ = std::move(owners);
  names_ = &names;
  seen_.assign(p.size(), 0);
  std::vector<std::vector<std::int64_t>> held(owners_->ranks.size());
  for (int i = 0; i < p.size(); ++i)
    if (!owners_->is_own(i)) {
      seen_[i] = 1;
      held[owners_->of[i]].push_back(names.name(i));
    }
  for (const auto &of : owners_->ranks.deal(held))
    for (const std::int64_t name : of)
      seen_[names.index(name)] = 1;
}

namespace
{
/// A face that began, as ranks tell each other of it.
template <int dim>
struct BegunFace
{
  static constexpr int n_numbers = 11 + 2 * dim + n_spins<dim>;

  std::array<std::int64_t, 2> name;
  std::int64_t material;
  std::array<double, n_numbers> numbers;
};
} // namespace

template <int dim>
auto CohesiveFaces<dim>::tell_begun(const std::vector<Name> &here, const Particles &p)
    -> std::vector<Name>
{
  std::vector<BegunFace<dim>> told;
  for (const Name &name : here) {
    const Face &face = faces_.at(name);
    BegunFace<dim> &t = told.emplace_back(BegunFace<dim>{name, face.material, {}});
    auto place = t.numbers.begin();
    for_each_face_number<dim>(face, [&](const std::string &, double number) { *place++ = number; });
    core::require(place == t.numbers.end(), "numbers of a face that began were not counted");
  }
  std::vector<Name> all;
  for (const BegunFace<dim> &t : owners_->ranks.gather_all(told)) {
    all.push_back(t.name);
    const int i = names_->index(t.name[0]), j = names_->index(t.name[1]);
    if (i < 0 || j < 0 || faces_.count(t.name))
      continue;
    const std::optional<BondId> id = bond_between(i, j);
    core::require(id.has_value(), "a face begins that this rank has lost");
    Face face = make(*id, body_.bonds().bond(*id), p, int(t.material));
    auto place = t.numbers.begin();
    for_each_face_number<dim>(face,
                              [&](const std::string &, double &number) { number = *place++; });
    go_on(face);
    faces_.emplace(t.name, face);
  }
  std::sort(all.begin(), all.end());
  n_all_ += std::int64_t(all.size());
  find_fronts();
  find_told();
  return all;
}

template <int dim>
auto CohesiveFaces<dim>::torn_of_body() const -> std::vector<Name>
{
  auto all = owners_->ranks.gather_all(own_torn());
  std::sort(all.begin(), all.end());
  return all;
}

// Faces see each other through the particles that they share: whatever hangs together with one
// that another rank sees is swept by all.
template <int dim>
void CohesiveFaces<dim>::find_told()
{
  if (!is_in_parts())
    return;
  std::map<int, std::vector<Face *>> around;
  std::vector<Face *> next;
  const auto tell = [&](Face &face) {
    if (!face.is_told)
      next.push_back(&face);
    face.is_told = true;
  };
  for (auto &[name, face] : faces_) {
    face.is_told = false;
    if (!face.is_own)
      continue;
    for (const int i : {face.bond.i, face.bond.j})
      around[i].push_back(&face);
    if (seen_[face.bond.i] || seen_[face.bond.j])
      tell(face);
  }
  tells_ = owners_->ranks.any(!next.empty());
  while (!next.empty()) {
    const Face &face = *next.back();
    next.pop_back();
    for (const int i : {face.bond.i, face.bond.j})
      for (Face *other : around[i])
        tell(*other);
  }
}

template void CohesiveFaces<2>::join(std::shared_ptr<particles::Owners>, const core::Names &,
                                     const Particles &);
template void CohesiveFaces<3>::join(std::shared_ptr<particles::Owners>, const core::Names &,
                                     const Particles &);
template std::vector<CohesiveFaces<2>::Name> CohesiveFaces<2>::tell_begun(const std::vector<Name> &,
                                                                          const Particles &);
template std::vector<CohesiveFaces<3>::Name> CohesiveFaces<3>::tell_begun(const std::vector<Name> &,
                                                                          const Particles &);
template std::vector<CohesiveFaces<2>::Name> CohesiveFaces<2>::torn_of_body() const;
template std::vector<CohesiveFaces<3>::Name> CohesiveFaces<3>::torn_of_body() const;
template void CohesiveFaces<2>::find_told();
template void CohesiveFaces<3>::find_told();
} // namespace ligament::dem
