#include "dem/fracture/break_search.h"

#include "dem/fracture/places_apart.h"
#include "particles/worse_face.h"

#include <algorithm>
#include <set>

namespace ligament::dem
{
namespace
{
/// Ascending.
std::vector<int> noted_particles(const NotedBonds &noted)
{
  auto few = noted.table;
  std::sort(few.begin(), few.end());
  std::vector<int> all;
  auto next = few.begin();
  for (const RowRange &range : noted.rows) {
    while (next != few.end() && *next < range.begin)
      all.push_back(*next++);
    for (int i = range.begin; i < range.end; ++i)
      all.push_back(i);
    while (next != few.end() && *next < range.end)
      ++next;
  }
  all.insert(all.end(), next, few.end());
  return all;
}

/// Each once, in an order that no numbering changes.
template <int dim>
void sort_by_names(std::vector<ExceedingBond<dim>> &bonds)
{
  std::sort(bonds.begin(), bonds.end(),
            [](const auto &a, const auto &b) { return a.name < b.name; });
  bonds.erase(std::unique(bonds.begin(), bonds.end(),
                          [](const auto &a, const auto &b) { return a.name == b.name; }),
              bonds.end());
}
} // namespace

template <int dim>
BreakSearch<dim>::BreakSearch(const FractureLaw &law, const BondedBody<dim> &body,
                              std::vector<int> at_interfaces,
                              const std::vector<std::int64_t> &names,
                              const CohesiveFaces<dim> &softening)
    : criteria_(law, body, names), softening_(softening), at_interfaces_(std::move(at_interfaces))
{
  if (body.images().is_any())
    body.bonds().for_each_bond([&](BondId, const Bond<dim> &b) {
      if (b.image)
        at_images_.insert(at_images_.end(), {b.i, b.j});
    });
  std::sort(at_images_.begin(), at_images_.end());
  at_images_.erase(std::unique(at_images_.begin(), at_images_.end()), at_images_.end());
}

template <int dim>
void BreakSearch<dim>::set_strength(double strength, const BondedBody<dim> &body)
{
  criteria_.set_strength(strength, body);
  screen_.clear();
}

template <int dim>
void BreakSearch<dim>::set_noted_share(double share)
{
  core::require(share > 0 && share <= 1, "the noted share of the limit lies above 0, at most at 1");
  noted_share_ = share;
  screen_.clear();
}

template <int dim>
void BreakSearch<dim>::reset(const BondedBody<dim> &body)
{
  criteria_.reset(body);
  screen_.clear();
}

template <int dim>
BreakLook BreakSearch<dim>::look_at(const Materials &materials, double share,
                                    bool cleared_by_stress) const
{
  return {criteria_.screen(materials, share, false), criteria_.screen(materials, share, true),
          cleared_by_stress, share};
}

// The screen of stresses doesn't know strains of the particles' own.
template <int dim>
void BreakSearch<dim>::ask(Evaluation<dim> &e, const InelasticStrains<dim> &strains) const
{
  if (can_break())
    e.look = look_at(e.body.materials(), noted_share_,
                     criteria_.clear_by_stress() && !strains.has_begun());
}

template <int dim>
void BreakSearch<dim>::ask_trial(Evaluation<dim> &e, double share) const
{
  if (can_break())
    e.look = look_at(e.body.materials(), share, false);
}

template <int dim>
BondTension<dim> BreakSearch<dim>::bond_tension(const BondId &id, const Bond<dim> &b,
                                                const StressedBody<dim> &state) const
{
  const auto &p = state.particles;
  const Turn<dim> turn_i = Turn<dim>::of(p, b.i), turn_j = Turn<dim>::of(p, b.j);
  BondTension<dim> t{id, b, present_normal(b, turn_i, turn_j), {}, 0};
  t.traction = state.force(b, state.motion(b, turn_i, turn_j)) / (b.weight * b.area);
  const bool waits = softening_.is_at_front(b.i) || softening_.is_at_front(b.j);
  if (state.body().edge().may_break(b) && !softening_.has(b, p) && !waits)
    t.utilisation = criteria_.bound(b, t.normal, t.traction, state.body().materials());
  return t;
}

template <int dim>
void BreakSearch<dim>::clear_by_stress(const StressedBody<dim> &state, Evaluation<dim> &e)
{
  if (!e.look || !e.look->cleared_by_stress || state.strains.has_begun())
    return;
  const std::vector<int> noted = noted_particles(e.noted);
  if (int(noted.size()) < StressScreen<dim>::least) {
    screen_.pass();
    return;
  }
  const auto &p = state.particles;
  const BondedBody<dim> &body = e.body;
  constexpr double round_off = 1e-7;
  const auto limit = [&](const Bond<dim> &b) {
    return noted_share_ * criteria_.limit(b, body.materials()) / (2 * b.shear_i) * (1 - round_off);
  };
  const auto is_at_image = [&](int i) {
    return std::binary_search(at_images_.begin(), at_images_.end(), i);
  };
  const auto per_volume = [&](int i) {
    return std::binary_search(at_interfaces_.begin(), at_interfaces_.end(), i) || is_at_image(i)
               ? 0
               : 1 / (2 * body.materials().of(i).shear_modulus() * body.energy_weight(i) *
                      p.volume[i]);
  };
  const auto for_each_moment = [&](const typename ScreenedBody<dim>::AddMoment &add) {
    for (const auto *part : state.parts)
      part->for_each_moment(p, e, add);
  };
  const LatticeArrays<dim> a = e.arrays(p);
  std::vector<int> kept =
      screen_.keep(noted, e.noted.own_terms,
                   {body.bonds(), a, limit, per_volume, for_each_moment, criteria_.tangent(),
                    PrincipalTension<dim>::cone, criteria_.measure()});
  if (!at_images_.empty()) {
    std::vector<int> all;
    std::copy_if(noted.begin(), noted.end(), std::back_inserter(all), [&](int i) {
      return is_at_image(i) || std::binary_search(kept.begin(), kept.end(), i);
    });
    kept = std::move(all);
  }
  auto &rows = e.noted.rows;
  std::vector<RowRange> rows_left;
  auto range = rows.begin();
  for (const int i : kept) {
    while (range != rows.end() && range->end <= i)
      ++range;
    if (range != rows.end() && range->begin <= i)
      rows_left.push_back({i, i + 1});
  }
  rows = std::move(rows_left);
  auto &of_table = e.noted.table;
  of_table.erase(
      std::remove_if(of_table.begin(), of_table.end(),
                     [&](int i) { return !std::binary_search(kept.begin(), kept.end(), i); }),
      of_table.end());
}

template <int dim>
std::vector<BondTension<dim>>
BreakSearch<dim>::suspected_bonds(const StressedBody<dim> &state) const
{
  const BondNetwork<dim> &bonds = state.body().bonds();
  const NotedBonds &noted = state.evaluation.noted;
  std::vector<BondTension<dim>> found;
  const auto test = [&](const BondId &id, const Bond<dim> &b) {
    const auto t = bond_tension(id, b, state);
    if (t.utilisation >= state.evaluation.look->share)
      found.push_back(t);
  };
  // A bond of two noted particles is its first one's.
  const auto test_bonds_of = [&](int i, bool lattice, auto &&is_noted) {
    bonds.for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
      if (lattice == (id.direction >= 0) && !b.joins_materials && (b.i == i || !is_noted(b.i)))
        test(id, b);
    });
  };
  const auto &rows = noted.rows;
  const auto is_in_rows = [&](int i) {
    const auto after = std::upper_bound(rows.begin(), rows.end(), i,
                                        [](int k, const RowRange &r) { return k < r.begin; });
    return after != rows.begin() && i < (after - 1)->end;
  };
  for (const RowRange &range : rows)
    for (int i = range.begin; i < range.end; ++i)
      test_bonds_of(i, true, is_in_rows);
  auto few = noted.table;
  std::sort(few.begin(), few.end());
  for (const int i : few)
    test_bonds_of(i, false, [&](int k) { return std::binary_search(few.begin(), few.end(), k); });
  bonds.for_each_interface(test);
  if (noted.own_terms) // stresses of the kernels don't know openings
    for (const int i : softening_.particles())
      for (const bool lattice : {true, false})
        test_bonds_of(i, lattice, [](int) { return false; });
  return found;
}

template <int dim>
void BreakSearch<dim>::find_tensions(std::vector<BondTension<dim>> &bonds,
                                     const StressedBody<dim> &state, double least) const
{
  std::vector<int> few;
  if (criteria_.need_stress())
    for (const auto &t : bonds)
      few.insert(few.end(), {t.bond.i, t.bond.j});
  std::sort(few.begin(), few.end());
  few.erase(std::unique(few.begin(), few.end()), few.end());
  const auto stress = state.stresses_of(few);
  const auto of = [&](int i) -> const Strain<dim> & {
    return stress[std::lower_bound(few.begin(), few.end(), i) - few.begin()];
  };
  for (auto &t : bonds) {
    LoadedFace<dim> face{t.normal, t.traction, Strain<dim>::Zero()};
    if (criteria_.need_stress())
      face.stress = (of(t.bond.i) + of(t.bond.j)) / 2;
    t.utilisation = criteria_.utilisation(face, t.bond, state.body().materials(), least);
  }
}

template <int dim>
std::vector<ExceedingBond<dim>>
BreakSearch<dim>::exceeding_bonds(const StressedBody<dim> &state) const
{
  if (!can_break())
    return {};
  auto found = suspected_bonds(state);
  const auto &p = state.particles;
  const auto keep_exceeding = [&] { // what others step lacks faces
    found.erase(std::remove_if(found.begin(), found.end(),
                               [&](const auto &t) {
                                 return t.utilisation < 1 ||
                                        !(p.part.owns(t.bond.i) || p.part.owns(t.bond.j));
                               }),
                found.end());
  };
  keep_exceeding();
  find_tensions(found, state, 1);
  keep_exceeding();
  std::vector<ExceedingBond<dim>> exceeding;
  for (const auto &t : found) {
    const auto [first, second] = std::minmax({p.global_id[t.bond.i], p.global_id[t.bond.j]});
    ExceedingBond<dim> &e =
        exceeding.emplace_back(ExceedingBond<dim>{{first, second}, t.utilisation, {}, t.id});
    const Vector<dim> place = get(p.reference, t.bond.i) + t.bond.lever_i;
    std::copy(place.begin(), place.end(), e.place.begin());
  }
  return exceeding;
}

template <int dim>
std::vector<ExceedingBond<dim>> BreakSearch<dim>::breaking(std::vector<ExceedingBond<dim>> found,
                                                           const BondedBody<dim> &body) const
{
  sort_by_names(found); // few are left
  const bool all_at_once = criteria_.apart() == 0, falls = law().falls();
  if (!all_at_once || one_by_one_ || falls)
    std::stable_sort(found.begin(), found.end(),
                     [](const auto &a, const auto &b) { return a.utilisation > b.utilisation; });
  if (one_by_one_ && found.size() > 1)
    found.resize(1);
  if (all_at_once && !falls)
    return found;
  PlacesApart<dim> places(criteria_.apart() * body.spacing(), body.images().period());
  std::set<std::int64_t> at_front; // particles: of each one face falls at a time
  std::vector<ExceedingBond<dim>> kept;
  for (const auto &bond : found) {
    if (falls && (at_front.count(bond.name[0]) || at_front.count(bond.name[1])))
      continue;
    if (!all_at_once && !places.add(Eigen::Map<const Vector<dim>>(bond.place.data())))
      continue;
    kept.push_back(bond);
    at_front.insert(bond.name.begin(), bond.name.end());
  }
  return kept;
}

template <int dim>
int BreakSearch<dim>::failing_material(const BondId &id, const Bond<dim> &b,
                                       const StressedBody<dim> &state) const
{
  const Materials &materials = state.body().materials();
  const int of_i = materials.number(b.i), of_j = materials.number(b.j);
  if (of_i == of_j)
    return of_i;
  const auto t = bond_tension(id, b, state);
  LoadedFace<dim> face{t.normal, t.traction, Strain<dim>::Zero()};
  if (criteria_.need_stress()) {
    const auto [first, second] = std::minmax(b.i, b.j);
    const auto stress = state.stresses_of({first, second});
    face.stress = (stress[0] + stress[1]) / 2;
  }
  return criteria_.failing_material(face, b, materials);
}

template <int dim>
double BreakSearch<dim>::largest_share(const StressedBody<dim> &state) const
{
  if (!can_break())
    return 0;
  const double asked = state.evaluation.look->share;
  auto found = suspected_bonds(state);
  // A bound of the utilisation that is below another bond's utilisation needs no closer look.
  std::sort(found.begin(), found.end(),
            [](const auto &a, const auto &b) { return a.utilisation > b.utilisation; });
  double largest = 0;
  constexpr std::size_t some = 32;
  for (std::size_t k = 0; k < found.size() && found[k].utilisation > largest; k += some) {
    std::vector<BondTension<dim>> now(found.begin() + k,
                                      found.begin() + std::min(k + some, found.size()));
    find_tensions(now, state, asked);
    for (const auto &t : now)
      largest = std::max(largest, t.utilisation);
  }
  return largest >= asked ? largest : 0;
}

template <int dim>
Utilisation<dim> BreakSearch<dim>::utilisation(const StressedBody<dim> &state,
                                               const std::vector<Watch> &watch) const
{
  Utilisation<dim> most;
  if (!can_break())
    return most;
  auto found = suspected_bonds(state);
  const auto &part = state.particles.part;
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const auto &t) { // what others step lacks faces
                               return std::max(watch[t.bond.i], watch[t.bond.j]) !=
                                          Watch::watched ||
                                      !(part.owns(t.bond.i) || part.owns(t.bond.j));
                             }),
              found.end());
  find_tensions(found, state, noted_share_);
  for (const auto &t : found) {
    const Utilisation<dim> face = {
        t.utilisation, Vector<dim>(get(state.particles.reference, t.bond.i) + t.bond.lever_i)};
    if (t.utilisation >= noted_share_ && particles::is_worse(face, most))
      most = face;
  }
  return most;
}

template <int dim>
BondTension<dim> BreakSearch<dim>::weakest_bond(const StressedBody<dim> &state,
                                                const std::vector<int> &of) const
{
  const Vector<dim> zero = Vector<dim>::Zero();
  BondTension<dim> weakest{{-1, -1}, {-1, -1, zero, zero, zero, 0, 0, 0, 0}, zero, zero, 0};
  if (!can_break())
    return weakest;
  std::vector<BondTension<dim>> bonds;
  for (const int i : of)
    state.body().bonds().for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
      const auto t = bond_tension(id, b, state);
      if (t.utilisation > 0)
        bonds.push_back(t);
    });
  std::sort(bonds.begin(), bonds.end(),
            [](const auto &a, const auto &b) { return a.utilisation > b.utilisation; });
  // Those with the largest bounds first, some at a time, until no bound is above what was found.
  constexpr std::size_t some = 32;
  for (std::size_t k = 0; k < bonds.size() && bonds[k].utilisation > weakest.utilisation; k += some)
  {
    std::vector<BondTension<dim>> now(bonds.begin() + k,
                                      bonds.begin() + std::min(k + some, bonds.size()));
    find_tensions(now, state, 0);
    for (const auto &t : now)
      if (t.utilisation > weakest.utilisation)
        weakest = t;
  }
  return weakest;
}

template class BreakSearch<2>;
template class BreakSearch<3>;
} // namespace ligament::dem
