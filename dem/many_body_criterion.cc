// Which bonds break: the criteria of theory.md section 1.6, looked at only where a bound of the
// kernels says that they could hold.
#include "dem/fracture/places_apart.h"
#include "dem/many_body_force.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
void ManyBodyForce<dim>::set_strength(double strength)
{
  core::require(strength > 0, "the strength must be positive");
  if (fracture_.criterion == FractureLaw::Criterion::none)
    fracture_.criterion = FractureLaw::Criterion::maximum_tension;
  fracture_.strength = strength;
  screen_.clear();
  find_largest_size_factor();
}

template <int dim>
void ManyBodyForce<dim>::set_noted_share(double share)
{
  core::require(share > 0 && share <= 1, "the noted share of the limit lies above 0, at most at 1");
  noted_share_ = share;
  screen_.clear();
}

template <int dim>
void ManyBodyForce<dim>::find_largest_size_factor()
{
  largest_size_factor_ = 1;
  if (fracture_.whole_face > 0)
    bonds_.for_each_bond([&](BondId, const Bond<dim> &b) {
      largest_size_factor_ = std::max(largest_size_factor_, size_factor(b));
    });
}

template <int dim>
double ManyBodyForce<dim>::size_factor(const Bond<dim> &b) const
{
  return fracture_.whole_face > 0 && fracture_.criterion != FractureLaw::Criterion::none
             ? criterion().size_factor(b.area / fracture_.whole_face)
             : 1;
}

template <int dim>
double ManyBodyForce<dim>::strength_of(const Bond<dim> &b) const
{
  const auto &of = fracture_.strengths;
  return of.empty() ? fracture_.strength
                    : std::min(of[materials_.number(b.i)], of[materials_.number(b.j)]);
}

template <int dim>
BreakScreen ManyBodyForce<dim>::breaking_screen(bool of_table) const
{
  if (fracture_.criterion == FractureLaw::Criterion::none)
    return {};
  double least = fracture_.strength;
  if (of_table) // in terms of the first material's bonds
    for (std::size_t m = 0; m < fracture_.strengths.size(); ++m)
      least = std::min(least, fracture_.strengths[m] * materials_.base().shear_modulus() /
                                  materials_.all()[m].shear_modulus());
  constexpr double round_off = 1e-7; // that of the kernels where the shear is small
  return {noted_share_ * least / largest_size_factor_ * (1 - round_off), criterion().tangent,
          criterion().clearing != Clearing::by_face};
}

template <int dim>
BondTension<dim> ManyBodyForce<dim>::bond_tension(const BondId &id, const Bond<dim> &b,
                                                  const Particles &p,
                                                  const std::vector<double> &pressure) const
{
  const Turn<dim> turn_i = Turn<dim>::of(p, b.i), turn_j = Turn<dim>::of(p, b.j);
  BondTension<dim> t{id, b, present_normal(b, turn_i, turn_j), {}, 0};
  t.traction = bond_force(b, motion(b, p, turn_i, turn_j), pressure) / (b.weight * b.area);
  const double normal = t.traction.dot(t.normal);
  if (normal <= 0 || !edge_.may_break(b))
    return t;
  const double shear = (t.traction - normal * t.normal).norm();
  t.utilisation = size_factor(b) * (normal + criterion().tangent * shear) / strength_of(b);
  return t;
}

// The screen doesn't know plastic strains.
template <int dim>
bool ManyBodyForce<dim>::is_cleared_by_stress() const
{
  return fracture_.criterion != FractureLaw::Criterion::none &&
         criterion().clearing == Clearing::by_stress && (!plastic_ || plastic_->plastic().empty());
}

template <int dim>
std::vector<int> ManyBodyForce<dim>::noted_particles() const
{
  const auto &rows = work_.exceeded_rows;
  auto few = work_.exceeded_particles;
  std::sort(few.begin(), few.end());
  std::vector<int> noted;
  auto next = few.begin();
  for (const RowRange &range : rows) {
    while (next != few.end() && *next < range.begin)
      noted.push_back(*next++);
    for (int i = range.begin; i < range.end; ++i)
      noted.push_back(i);
    while (next != few.end() && *next < range.end)
      ++next;
  }
  noted.insert(noted.end(), next, few.end());
  return noted;
}

template <int dim>
void ManyBodyForce<dim>::clear_by_stress(const Particles &p)
{
  if (!is_cleared_by_stress())
    return;
  const std::vector<int> noted = noted_particles();
  if (int(noted.size()) < StressScreen<dim>::least) {
    screen_.pass();
    return;
  }
  constexpr double round_off = 1e-7;
  const auto limit = [&](const Bond<dim> &b) {
    return noted_share_ * strength_of(b) / (size_factor(b) * 2 * b.shear_i) * (1 - round_off);
  };
  const auto per_volume = [&](int i) {
    return interfaces_.is_member(i)
               ? 0
               : 1 / (2 * materials_.of(i).shear_modulus() * energy_weight(i) * p.volume[i]);
  };
  const auto for_each_moment = [&](const typename ScreenedBody<dim>::AddMoment &add) {
    surface_.for_each_moment(p, work_.pressure, add);
    contacts_.for_each_moment(p, add);
  };
  const LatticeArrays<dim> a = arrays(p, work_);
  const std::vector<int> kept = screen_.keep(noted, work_.own_terms,
                                             {bonds_, a, limit, per_volume, for_each_moment,
                                              criterion().tangent, PrincipalTension<dim>::cone});
  auto &rows = work_.exceeded_rows;
  std::vector<RowRange> rows_left;
  auto range = rows.begin();
  for (const int i : kept) {
    while (range != rows.end() && range->end <= i)
      ++range;
    if (range != rows.end() && range->begin <= i)
      rows_left.push_back({i, i + 1});
  }
  rows = std::move(rows_left);
  auto &particles = work_.exceeded_particles;
  particles.erase(
      std::remove_if(particles.begin(), particles.end(),
                     [&](int i) { return !std::binary_search(kept.begin(), kept.end(), i); }),
      particles.end());
}

template <int dim>
std::vector<BondTension<dim>> ManyBodyForce<dim>::suspected_bonds(const Particles &p) const
{
  std::vector<BondTension<dim>> found;
  const auto test = [&](const BondId &id, const Bond<dim> &b) {
    const auto t = bond_tension(id, b, p, work_.pressure);
    if (t.utilisation >= noted_share_)
      found.push_back(t);
  };
  // A bond of two noted particles is its first one's.
  const auto test_bonds_of = [&](int i, bool lattice, auto &&is_noted) {
    bonds_.for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
      if (lattice == (id.direction >= 0) && !b.joins_materials && (b.i == i || !is_noted(b.i)))
        test(id, b);
    });
  };
  const auto &rows = work_.exceeded_rows;
  const auto is_in_rows = [&](int i) {
    const auto after = std::upper_bound(rows.begin(), rows.end(), i,
                                        [](int k, const RowRange &r) { return k < r.begin; });
    return after != rows.begin() && i < (after - 1)->end;
  };
  for (const RowRange &range : rows)
    for (int i = range.begin; i < range.end; ++i)
      test_bonds_of(i, true, is_in_rows);
  auto few = work_.exceeded_particles;
  std::sort(few.begin(), few.end());
  for (const int i : few)
    test_bonds_of(i, false, [&](int k) { return std::binary_search(few.begin(), few.end(), k); });
  bonds_.for_each_interface(test);
  const auto none = [](int) { return false; };
  if (plastic_) // the kernels don't know plastic strains
    for (const RowRange &range : plastic_->around_plastic())
      for (int i = range.begin; i < range.end; ++i) {
        test_bonds_of(i, true, none);
        test_bonds_of(i, false, none);
      }
  return found;
}

template <int dim>
void ManyBodyForce<dim>::sort_by_ids(std::vector<BondTension<dim>> &bonds, const Particles &p)
{
  const auto ids = [&](const BondTension<dim> &t) { return global_ids(t.bond, p); };
  std::sort(bonds.begin(), bonds.end(),
            [&](const auto &a, const auto &b) { return ids(a) < ids(b); });
  bonds.erase(std::unique(bonds.begin(), bonds.end(),
                          [&](const auto &a, const auto &b) { return ids(a) == ids(b); }),
              bonds.end());
}

template <int dim>
std::pair<std::int64_t, std::int64_t> ManyBodyForce<dim>::global_ids(const Bond<dim> &b,
                                                                     const Particles &p)
{
  return std::minmax({p.global_id[b.i], p.global_id[b.j]});
}

template <int dim>
std::vector<Strain<dim>> ManyBodyForce<dim>::stresses_of(const std::vector<int> &few,
                                                         const Particles &p,
                                                         const std::vector<double> &pressure) const
{
  std::vector<Strain<dim>> stress(few.size(), Strain<dim>::Zero());
  // Most neighbours are among the few: a turn takes longer than the rest of a bond.
  std::vector<Turn<dim>> turns;
  for (const int i : few)
    turns.push_back(Turn<dim>::of(p, i));
  const auto turn_of = [&](int i) {
    const auto place = std::lower_bound(few.begin(), few.end(), i);
    return place != few.end() && *place == i ? turns[place - few.begin()] : Turn<dim>::of(p, i);
  };
  for (std::size_t k = 0; k < few.size(); ++k)
    bonds_.for_each_bond_of(few[k], [&](BondId, const Bond<dim> &b) {
      const BondMotion<dim> m = motion(b, p, turn_of(b.i), turn_of(b.j));
      const Vector<dim> f = bond_force(b, m, pressure);
      stress[k] += b.i == few[k] ? symmetric_product<dim>(m.a_i, f)
                                 : symmetric_product<dim>(m.a_j, Vector<dim>(-f));
    });
  const auto add = [&](int i, const Vector<dim> &lever, const Vector<dim> &force) {
    const auto place = std::lower_bound(few.begin(), few.end(), i);
    if (place != few.end() && *place == i)
      stress[place - few.begin()] += symmetric_product<dim>(lever, force);
  };
  surface_.for_each_moment(p, pressure, add);
  contacts_.for_each_moment(p, add);
  for (std::size_t k = 0; k < few.size(); ++k)
    stress[k] /= energy_weight(few[k]) * p.volume[few[k]];
  return stress;
}

template <int dim>
void ManyBodyForce<dim>::find_tensions(std::vector<BondTension<dim>> &bonds, const Particles &p,
                                       const std::vector<double> &pressure, double least) const
{
  std::vector<int> few;
  if (criterion().needs_stress)
    for (const auto &t : bonds)
      few.insert(few.end(), {t.bond.i, t.bond.j});
  std::sort(few.begin(), few.end());
  few.erase(std::unique(few.begin(), few.end()), few.end());
  const auto stress = stresses_of(few, p, pressure);
  const auto of = [&](int i) -> const Strain<dim> & {
    return stress[std::lower_bound(few.begin(), few.end(), i) - few.begin()];
  };
  for (auto &t : bonds) {
    constexpr double round_off = 1e-12;
    const double size = size_factor(t.bond), strength = strength_of(t.bond);
    LoadedFace<dim> face{t.normal, t.traction, Strain<dim>::Zero()};
    if (criterion().needs_stress)
      face.stress = (of(t.bond.i) + of(t.bond.j)) / 2;
    t.utilisation = size * criterion().bound(face) / strength;
    if (t.utilisation >= least * (1 - round_off))
      t.utilisation = size * criterion().tension(face) / strength;
  }
}

template <int dim>
std::vector<BondId> ManyBodyForce<dim>::exceeding_bonds(const Particles &p) const
{
  if (fracture_.criterion == FractureLaw::Criterion::none)
    return {};
  auto found = suspected_bonds(p);
  const auto keep_exceeding = [&] {
    found.erase(
        std::remove_if(found.begin(), found.end(), [](const auto &t) { return t.utilisation < 1; }),
        found.end());
  };
  keep_exceeding();
  find_tensions(found, p, work_.pressure, 1);
  keep_exceeding();
  sort_by_ids(found, p); // few are left
  const bool all_at_once = criterion().apart == 0;
  if (!all_at_once)
    std::stable_sort(found.begin(), found.end(),
                     [](const auto &a, const auto &b) { return a.utilisation > b.utilisation; });
  std::vector<BondId> exceeding;
  PlacesApart<dim> places(criterion().apart * spacing_);
  for (const auto &t : found)
    if (all_at_once || places.add(get(p.reference, t.bond.i) + t.bond.lever_i))
      exceeding.push_back(t.id);
  return exceeding;
}

template <int dim>
Utilisation<dim> ManyBodyForce<dim>::utilisation(const Particles &p,
                                                 const std::vector<Watch> &watch) const
{
  Utilisation<dim> most;
  if (fracture_.criterion == FractureLaw::Criterion::none)
    return most;
  auto found = suspected_bonds(p);
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const auto &t) {
                               return std::max(watch[t.bond.i], watch[t.bond.j]) != Watch::watched;
                             }),
              found.end());
  find_tensions(found, p, work_.pressure, noted_share_);
  for (const auto &t : found)
    if (t.utilisation >= noted_share_ && t.utilisation > most.share)
      most = {t.utilisation, Vector<dim>(get(p.reference, t.bond.i) + t.bond.lever_i)};
  return most;
}

template <int dim>
BondTension<dim> ManyBodyForce<dim>::weakest_bond(const Particles &p,
                                                  const std::vector<int> &of) const
{
  const Vector<dim> zero = Vector<dim>::Zero();
  BondTension<dim> weakest{{-1, -1}, {-1, -1, zero, zero, zero, 0, 0, 0, 0}, zero, zero, 0};
  if (fracture_.criterion == FractureLaw::Criterion::none)
    return weakest;
  Workspace work;
  find_pressure(p, work);
  std::vector<BondTension<dim>> bonds;
  for (const int i : of)
    bonds_.for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
      const auto t = bond_tension(id, b, p, work.pressure);
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
    find_tensions(now, p, work.pressure, 0);
    for (const auto &t : now)
      if (t.utilisation > weakest.utilisation)
        weakest = t;
  }
  return weakest;
}

template void ManyBodyForce<2>::set_strength(double);
template void ManyBodyForce<2>::set_noted_share(double);
template Utilisation<2> ManyBodyForce<2>::utilisation(const Particles &,
                                                      const std::vector<Watch> &) const;
template void ManyBodyForce<2>::find_largest_size_factor();
template bool ManyBodyForce<2>::is_cleared_by_stress() const;
template void ManyBodyForce<2>::clear_by_stress(const Particles &);
template BreakScreen ManyBodyForce<2>::breaking_screen(bool) const;
template std::vector<BondId> ManyBodyForce<2>::exceeding_bonds(const Particles &) const;
template BondTension<2> ManyBodyForce<2>::weakest_bond(const Particles &,
                                                       const std::vector<int> &) const;
template void ManyBodyForce<3>::set_strength(double);
template void ManyBodyForce<3>::set_noted_share(double);
template Utilisation<3> ManyBodyForce<3>::utilisation(const Particles &,
                                                      const std::vector<Watch> &) const;
template void ManyBodyForce<3>::find_largest_size_factor();
template bool ManyBodyForce<3>::is_cleared_by_stress() const;
template void ManyBodyForce<3>::clear_by_stress(const Particles &);
template BreakScreen ManyBodyForce<3>::breaking_screen(bool) const;
template std::vector<BondId> ManyBodyForce<3>::exceeding_bonds(const Particles &) const;
template BondTension<3> ManyBodyForce<3>::weakest_bond(const Particles &,
                                                       const std::vector<int> &) const;
} // namespace ligament::dem
