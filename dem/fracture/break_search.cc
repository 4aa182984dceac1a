#include "dem/fracture/break_search.h"

#include "dem/fracture/places_apart.h"

#include <algorithm>

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
void sort_by_ids(std::vector<BondTension<dim>> &bonds, const particles::Particles<dim> &p)
{
  const auto ids = [&](const BondTension<dim> &t) -> std::pair<std::int64_t, std::int64_t> {
    return std::minmax({p.global_id[t.bond.i], p.global_id[t.bond.j]});
  };
  std::sort(bonds.begin(), bonds.end(),
            [&](const auto &a, const auto &b) { return ids(a) < ids(b); });
  bonds.erase(std::unique(bonds.begin(), bonds.end(),
                          [&](const auto &a, const auto &b) { return ids(a) == ids(b); }),
              bonds.end());
}
} // namespace

template <int dim>
BreakSearch<dim>::BreakSearch(const FractureLaw &law, const BondedBody<dim> &body,
                              std::vector<int> at_interfaces,
                              const std::vector<std::int64_t> &names)
    : law_(law), at_interfaces_(std::move(at_interfaces))
{
  const auto &of = law_.strengths;
  if (law_.strength.scatter.modulus > 0 ||
      std::any_of(of.begin(), of.end(), [](const auto &s) { return s.scatter.modulus > 0; }))
    names_ = names.empty() ? particles::GlobalIds(body.n_particles()) : particles::GlobalIds(names);
  reset(body);
}

template <int dim>
void BreakSearch<dim>::set_strength(double strength, const BondedBody<dim> &body)
{
  core::require(strength > 0, "the strength must be positive");
  if (!can_break())
    law_.criterion = FractureLaw::Criterion::maximum_tension;
  law_.strength.value = strength;
  reset(body);
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
  screen_.clear();
  measures_.clear();
  most_weakened_ = 1;
  if (!can_break())
    return;
  const Materials &materials = body.materials();
  for (int m = 0; m < int(materials.all().size()); ++m)
    measures_.push_back(measure_of(strength_in(m), materials.all()[m]));
  one_measure_ = std::all_of(measures_.begin(), measures_.end(),
                             [&](const auto &m) { return m == measures_[0]; });
  if (law_.whole_face <= 0 && !names_)
    return;
  body.bonds().for_each_bond([&](BondId, const Bond<dim> &b) {
    double scatter = 1;
    if (names_)
      scatter =
          std::min(scatter_of(b, materials.number(b.i)), scatter_of(b, materials.number(b.j)));
    most_weakened_ = std::max(most_weakened_, size_factor(b) / scatter);
  });
}

template <int dim>
StressMeasure BreakSearch<dim>::measure_of(const FaceStrength &strength,
                                           const DemMaterial &material) const
{
  if (criterion().measure)
    return criterion().measure(strength, material);
  StressMeasure largest_principal;
  largest_principal.residual = BreakScreen::per_cosine(criterion().tangent);
  return largest_principal;
}

template <int dim>
double BreakSearch<dim>::scatter_of(const Bond<dim> &b, int material) const
{
  return strength_in(material).scatter.factor((*names_)[b.i], (*names_)[b.j], b.area);
}

template <int dim>
double BreakSearch<dim>::size_factor(const Bond<dim> &b) const
{
  return law_.whole_face > 0 && can_break() ? criterion().size_factor(b.area / law_.whole_face) : 1;
}

template <int dim>
double BreakSearch<dim>::strength_of(const Bond<dim> &b, int material) const
{
  const double value = strength_in(material).value;
  return names_ ? value * scatter_of(b, material) : value;
}

template <int dim>
double BreakSearch<dim>::strength_of(const Bond<dim> &b, const Materials &materials) const
{
  const int i = materials.number(b.i), j = materials.number(b.j);
  return i == j ? strength_of(b, i) : std::min(strength_of(b, i), strength_of(b, j));
}

template <int dim>
BreakScreen BreakSearch<dim>::screen(const BondedBody<dim> &body, double share, bool of_table) const
{
  double least = law_.strength.value;
  const Materials &materials = body.materials();
  if (of_table) // in terms of the first material's bonds
    for (std::size_t m = 0; m < materials.all().size(); ++m)
      least = std::min(least, strength_in(int(m)).value * materials.base().shear_modulus() /
                                  materials.all()[m].shear_modulus());
  constexpr double round_off = 1e-7; // that of the kernels where the shear is small
  return {share * least / most_weakened_ * criterion().least_share * (1 - round_off),
          criterion().tangent, criterion().clearing != Clearing::by_face && one_measure_,
          measures_[0].times(criterion().least_share)};
}

// The screen of stresses doesn't know plastic strains.
template <int dim>
void BreakSearch<dim>::ask(Evaluation<dim> &e, const PlasticFlow<dim> &flow) const
{
  if (can_break())
    e.look =
        BreakLook{screen(e.body, noted_share_, false), screen(e.body, noted_share_, true),
                  criterion().clearing == Clearing::by_stress && one_measure_ && !flow.has_flowed(),
                  noted_share_};
}

template <int dim>
void BreakSearch<dim>::ask_trial(Evaluation<dim> &e, double share) const
{
  if (can_break())
    e.look = BreakLook{screen(e.body, share, false), screen(e.body, share, true), false, share};
}

template <int dim>
BondTension<dim> BreakSearch<dim>::bond_tension(const BondId &id, const Bond<dim> &b,
                                                const StressedBody<dim> &state) const
{
  const auto &p = state.particles;
  const Turn<dim> turn_i = Turn<dim>::of(p, b.i), turn_j = Turn<dim>::of(p, b.j);
  BondTension<dim> t{id, b, present_normal(b, turn_i, turn_j), {}, 0};
  t.traction = state.force(b, state.motion(b, turn_i, turn_j)) / (b.weight * b.area);
  const double normal = t.traction.dot(t.normal);
  const bool presses = normal <= 0;
  if ((presses && !criterion().breaks_under_pressure()) || !state.body().edge().may_break(b))
    return t;
  const double shear = (t.traction - normal * t.normal).norm();
  const double bound = criterion().breaks_under_pressure()
                           ? (presses ? shear : t.traction.norm()) / criterion().least_share
                           : normal + criterion().tangent * shear;
  t.utilisation = size_factor(b) * bound / strength_of(b, state.body().materials());
  return t;
}

template <int dim>
void BreakSearch<dim>::clear_by_stress(const StressedBody<dim> &state, Evaluation<dim> &e)
{
  if (!e.look || !e.look->cleared_by_stress)
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
    return noted_share_ * strength_of(b, body.materials()) / (size_factor(b) * 2 * b.shear_i) *
           criterion().least_share * (1 - round_off);
  };
  const auto per_volume = [&](int i) {
    return std::binary_search(at_interfaces_.begin(), at_interfaces_.end(), i)
               ? 0
               : 1 / (2 * body.materials().of(i).shear_modulus() * body.energy_weight(i) *
                      p.volume[i]);
  };
  const auto for_each_moment = [&](const typename ScreenedBody<dim>::AddMoment &add) {
    for (const auto *part : state.parts)
      part->for_each_moment(p, e, add);
  };
  const LatticeArrays<dim> a = e.arrays(p);
  const std::vector<int> kept =
      screen_.keep(noted, e.noted.own_terms,
                   {body.bonds(), a, limit, per_volume, for_each_moment, criterion().tangent,
                    PrincipalTension<dim>::cone, measures_[0].times(criterion().least_share)});
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
  const auto none = [](int) { return false; };
  if (state.flow.has_flowed()) // the kernels don't know plastic strains
    for (const RowRange &range : state.flow.blocks()->around_plastic())
      for (int i = range.begin; i < range.end; ++i) {
        test_bonds_of(i, true, none);
        test_bonds_of(i, false, none);
      }
  return found;
}

template <int dim>
void BreakSearch<dim>::find_tensions(std::vector<BondTension<dim>> &bonds,
                                     const StressedBody<dim> &state, double least) const
{
  std::vector<int> few;
  if (criterion().needs_stress)
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
    if (criterion().needs_stress)
      face.stress = (of(t.bond.i) + of(t.bond.j)) / 2;
    const Materials &materials = state.body().materials();
    if (one_measure_) {
      face.measure = measures_[0];
      t.utilisation = utilisation(face, t.bond, strength_of(t.bond, materials), least);
      continue;
    }
    t.utilisation = 0;
    for (const int i : {t.bond.i, t.bond.j}) {
      const int m = materials.number(i);
      face.measure = measures_[m];
      t.utilisation =
          std::max(t.utilisation, utilisation(face, t.bond, strength_of(t.bond, m), least));
    }
  }
}

template <int dim>
double BreakSearch<dim>::utilisation(const LoadedFace<dim> &face, const Bond<dim> &b,
                                     double strength, double least) const
{
  constexpr double round_off = 1e-12;
  const double size = size_factor(b), bound = size * criterion().bound(face) / strength;
  return bound >= least * (1 - round_off) ? size * criterion().tension(face) / strength : bound;
}

template <int dim>
std::vector<BondId> BreakSearch<dim>::exceeding_bonds(const StressedBody<dim> &state) const
{
  if (!can_break())
    return {};
  auto found = suspected_bonds(state);
  const auto keep_exceeding = [&] {
    found.erase(
        std::remove_if(found.begin(), found.end(), [](const auto &t) { return t.utilisation < 1; }),
        found.end());
  };
  keep_exceeding();
  find_tensions(found, state, 1);
  keep_exceeding();
  sort_by_ids(found, state.particles); // few are left
  const bool all_at_once = criterion().apart == 0;
  if (!all_at_once || one_by_one_)
    std::stable_sort(found.begin(), found.end(),
                     [](const auto &a, const auto &b) { return a.utilisation > b.utilisation; });
  if (one_by_one_ && found.size() > 1)
    found.resize(1);
  std::vector<BondId> exceeding;
  PlacesApart<dim> places(criterion().apart * state.body().spacing());
  for (const auto &t : found)
    if (all_at_once || places.add(get(state.particles.reference, t.bond.i) + t.bond.lever_i))
      exceeding.push_back(t.id);
  return exceeding;
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
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const auto &t) {
                               return std::max(watch[t.bond.i], watch[t.bond.j]) != Watch::watched;
                             }),
              found.end());
  find_tensions(found, state, noted_share_);
  for (const auto &t : found)
    if (t.utilisation >= noted_share_ && t.utilisation > most.share)
      most = {t.utilisation,
              Vector<dim>(get(state.particles.reference, t.bond.i) + t.bond.lever_i)};
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
