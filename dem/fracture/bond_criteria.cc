#include "dem/fracture/bond_criteria.h"

#include <algorithm>
#include <limits>

namespace ligament::dem
{
template <int dim>
BondCriteria<dim>::BondCriteria(const FractureLaw &law, const BondedBody<dim> &body,
                                const std::vector<std::int64_t> &names)
    : law_(law)
{
  const auto &of = law_.strengths;
  if (law_.strength.scatter.modulus > 0 ||
      std::any_of(of.begin(), of.end(), [](const auto &s) { return s.scatter.modulus > 0; }))
    names_ = names.empty() ? particles::GlobalIds(body.n_particles()) : particles::GlobalIds(names);
  reset(body);
}

template <int dim>
void BondCriteria<dim>::set_strength(double strength, const BondedBody<dim> &body)
{
  core::require(strength > 0, "the strength must be positive");
  if (!can_break())
    law_.criterion = FractureLaw::Criterion::maximum_tension;
  law_.strength.value = strength;
  reset(body);
}

template <int dim>
void BondCriteria<dim>::reset(const BondedBody<dim> &body)
{
  const Materials &materials = body.materials();
  of_.clear();
  for (std::size_t m = 0; m < materials.all().size(); ++m) {
    const auto chosen = law_.criteria.empty() ? law_.criterion : law_.criteria[m];
    OfMaterial of{nullptr,
                  law_.strengths.empty() ? law_.strength : law_.strengths[m],
                  {},
                  law_.whole_faces.empty() ? law_.whole_face : law_.whole_faces[m]};
    if (chosen != FractureLaw::Criterion::none) {
      of.criterion = &chosen.template in<dim>();
      of.measure.residual = BreakScreen::per_cosine(of.criterion->tangent);
      if (of.criterion->measure)
        of.measure = of.criterion->measure(of.strength, materials.all()[m]);
    }
    of_.push_back(of);
  }
  const auto all = [&](auto &&same) { return std::all_of(of_.begin(), of_.end(), same); };
  one_criterion_ = all([&](const auto &o) { return o.criterion == of_[0].criterion; });
  one_measure_ = one_criterion_ && all([&](const auto &o) { return o.measure == of_[0].measure; });
  most_weakened_ = 1;
  const bool size_matters =
      std::any_of(of_.begin(), of_.end(), [](const auto &of) { return of.whole_face > 0; });
  if (can_break() && (size_matters || names_))
    body.bonds().for_each_bond([&](BondId, const Bond<dim> &b) {
      for_each_of(b, materials, [&](const OfMaterial &of) {
        most_weakened_ = std::max(most_weakened_, size_factor(b, of) / scatter_of(b, of));
      });
    });
}

template <int dim>
bool BondCriteria<dim>::can_break() const
{
  return std::any_of(of_.begin(), of_.end(), [](const auto &of) { return of.criterion; });
}

template <int dim>
bool BondCriteria<dim>::break_under_pressure() const
{
  return std::any_of(of_.begin(), of_.end(), [](const auto &of) {
    return of.criterion && of.criterion->breaks_under_pressure();
  });
}

template <int dim>
bool BondCriteria<dim>::need_stress() const
{
  return std::any_of(of_.begin(), of_.end(),
                     [](const auto &of) { return of.criterion && of.criterion->needs_stress; });
}

template <int dim>
double BondCriteria<dim>::apart() const
{
  double largest = 0;
  for (const auto &of : of_)
    if (of.criterion)
      largest = std::max(largest, of.criterion->apart);
  return largest;
}

template <int dim>
template <typename Visit>
void BondCriteria<dim>::for_each_of(const Bond<dim> &b, const Materials &materials,
                                    Visit &&visit) const
{
  const int i = materials.number(b.i), j = materials.number(b.j);
  if (of_[i].criterion)
    visit(of_[i]);
  if (j != i && of_[j].criterion)
    visit(of_[j]);
}

template <int dim>
double BondCriteria<dim>::scatter_of(const Bond<dim> &b, const OfMaterial &of) const
{
  return names_ ? of.strength.scatter.factor((*names_)[b.i], (*names_)[b.j], b.area) : 1;
}

template <int dim>
double BondCriteria<dim>::strength_of(const Bond<dim> &b, const OfMaterial &of) const
{
  return of.strength.value * scatter_of(b, of);
}

template <int dim>
double BondCriteria<dim>::size_factor(const Bond<dim> &b, const OfMaterial &of) const
{
  return of.whole_face > 0 ? of.criterion->size_factor(b.area / of.whole_face) : 1;
}

// With several criteria the table's bonds are those that bear what one of them asks at least, in
// any direction.
template <int dim>
BreakScreen BondCriteria<dim>::screen(const Materials &materials, double share, bool of_table) const
{
  double least = std::numeric_limits<double>::infinity();
  const bool any_direction = of_table && !one_criterion_;
  for (std::size_t m = 0; m < (of_table ? of_.size() : 1); ++m)
    if (const auto *criterion = of_[m].criterion) {
      const double stiffness =
          materials.base().shear_modulus() / materials.all()[m].shear_modulus();
      const double strength = of_[m].strength.value * (m == 0 ? 1 : stiffness);
      least = std::min(least, any_direction ? strength * criterion->least_share /
                                                  BreakScreen::per_cosine(criterion->tangent)
                                            : strength);
    }
  BreakScreen screen;
  screen.by_particle = false;
  if (least == std::numeric_limits<double>::infinity())
    return screen;
  constexpr double round_off = 1e-7; // that of the kernels where the shear is small
  screen.strength = share * least / most_weakened_ * (1 - round_off);
  screen.tangent = either_side;
  if (any_direction)
    return screen;
  screen.strength *= of_[0].criterion->least_share;
  screen.tangent = tangent();
  screen.by_particle = one_measure_ && of_[0].criterion->clearing != Clearing::by_face;
  screen.measure = measure();
  return screen;
}

template <int dim>
bool BondCriteria<dim>::clear_by_stress() const
{
  return one_measure_ && of_[0].criterion && of_[0].criterion->clearing == Clearing::by_stress;
}

template <int dim>
double BondCriteria<dim>::limit(const Bond<dim> &b, const Materials &materials) const
{
  double least = std::numeric_limits<double>::infinity();
  for_each_of(b, materials, [&](const OfMaterial &of) {
    least = std::min(least, strength_of(b, of) / size_factor(b, of) * of.criterion->least_share);
  });
  return least;
}

template <int dim>
double BondCriteria<dim>::bound(const Bond<dim> &b, const Vector<dim> &normal,
                                const Vector<dim> &traction, const Materials &materials) const
{
  const double along = traction.dot(normal);
  double largest = 0;
  for_each_of(b, materials, [&](const OfMaterial &of) {
    const auto &criterion = *of.criterion;
    if (along <= 0 && !criterion.breaks_under_pressure())
      return;
    const double across = (traction - along * normal).norm();
    const double bound = criterion.breaks_under_pressure()
                             ? (along > 0 ? traction.norm() : across) / criterion.least_share
                             : along + criterion.tangent * across;
    largest = std::max(largest, size_factor(b, of) * bound / strength_of(b, of));
  });
  return largest;
}

template <int dim>
double BondCriteria<dim>::utilisation(LoadedFace<dim> face, const Bond<dim> &b,
                                      const Materials &materials, double least) const
{
  constexpr double round_off = 1e-12;
  const bool presses = face.traction.dot(face.normal) <= 0;
  double largest = 0;
  for_each_of(b, materials, [&](const OfMaterial &of) {
    if (presses && !of.criterion->breaks_under_pressure())
      return;
    face.measure = of.measure;
    const double size = size_factor(b, of), strength = strength_of(b, of);
    double share = size * of.criterion->bound(face) / strength;
    if (share >= least * (1 - round_off))
      share = size * of.criterion->tension(face) / strength;
    largest = std::max(largest, share);
  });
  return largest;
}

template <int dim>
int BondCriteria<dim>::failing_material(LoadedFace<dim> face, const Bond<dim> &b,
                                        const Materials &materials) const
{
  const bool presses = face.traction.dot(face.normal) <= 0;
  const auto share = [&](int m) {
    const OfMaterial &of = of_[m];
    if (!of.criterion || (presses && !of.criterion->breaks_under_pressure()))
      return -1.;
    face.measure = of.measure;
    return size_factor(b, of) * of.criterion->tension(face) / strength_of(b, of);
  };
  const int i = materials.number(b.i), j = materials.number(b.j);
  const double of_i = share(i), of_j = share(j);
  if (of_i != of_j)
    return of_i > of_j ? i : j;
  if (law_.energy_of(i) != law_.energy_of(j))
    return law_.energy_of(i) < law_.energy_of(j) ? i : j;
  return std::min(i, j); // whichever particle the face begins with
}

template class BondCriteria<2>;
template class BondCriteria<3>;
} // namespace ligament::dem
