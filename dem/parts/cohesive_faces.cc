#include "dem/parts/cohesive_faces.h"

#include "dem/parts/opening_faces.h"

#include <limits>

namespace ligament::dem
{
namespace
{
/// Of the bond's stiffness: less than it, so that nothing snaps.
constexpr double excess_slope = 0.25;
/// n.e1 of faces that a straight crack across e1 needs at least; and of the criterion's cone. Those
/// between keep more of what they bear: else a crack along any row would cost the same.
constexpr double crack_cosine = 0.5, least_cosine = 0.3;
} // namespace

template <int dim>
auto CohesiveFaces<dim>::name_of(const Bond<dim> &b, const Particles &p) -> Name
{
  const auto [first, second] = std::minmax({p.global_id[b.i], p.global_id[b.j]});
  return {first, second};
}

template <int dim>
auto CohesiveFaces<dim>::find(const Bond<dim> &b, const Particles &p) const -> const Face *
{
  if (faces_.empty())
    return nullptr;
  const auto found = faces_.find(name_of(b, p));
  return found == faces_.end() ? nullptr : &found->second;
}

template <int dim>
auto CohesiveFaces<dim>::make(const BondId &id, const Bond<dim> &b, const Particles &p,
                              int material) const -> Face
{
  const double friction = body_.materials().friction(b.i, b.j);
  Face face = {id,
               b,
               {0, 0, law_.softening_of(material), law_.mode_ratio_of(material), friction},
               p.global_id[b.i] == name_of(b, p)[0],
               material,
               {Vector<dim>::Zero()},
               {Vector<dim>::Zero()}};
  face.is_own = p.part.owns(b.i);
  return face;
}

// The strength is the face's share of what a crack across `way` bears. What it bears now beyond
// that falls off as it opens, so that nothing jumps. The reach gives the area below the curve.
template <int dim>
void CohesiveFaces<dim>::begin(const BondId &id, const Bond<dim> &b, const Particles &p,
                               const Vector<dim> &force, const Vector<dim> &way, int material,
                               double energy)
{
  Face face = make(id, b, p, material);
  const SofteningFace<dim> now(face, p, strains_);
  const double bears = face.law.effective(force, now.normal),
               along = face.law.effective(Vector<dim>(force.dot(way) * way), now.normal),
               cosine = std::abs(now.normal.dot(way)),
               part = std::clamp((cosine - least_cosine) / (crack_cosine - least_cosine), 0., 1.);
  face.law.excess = part * std::max(bears - along, 0.);
  face.law.strength = bears - face.law.excess;
  face.law.excess_reach = face.law.excess / (excess_slope * now.law.shear);
  face.whole_energy = energy;
  face.force = face.last_force = now.in_own_axes(force);
  take_direction(face, face.last_force);
  face.last_turn = relative_turn(b, p);
  faces_.emplace(name_of(b, p), face);
}

// Opening takes nothing of its strength, only time does. What presses is not borne by strength.
template <int dim>
bool CohesiveFaces<dim>::begin_fall(const BondId &id, const Bond<dim> &b, const Particles &p,
                                    const Vector<dim> &force, int material, double now,
                                    double duration)
{
  Face face = make(id, b, p, material);
  const SofteningFace<dim> state(face, p, strains_);
  const double normal = force.dot(state.normal);
  const Vector<dim> pulls = normal > 0 ? force : Vector<dim>(force - normal * state.normal);
  if (!(pulls.norm() > 0))
    return false;
  face.law.strength = pulls.norm();
  face.law.reach = std::numeric_limits<double>::infinity();
  face.law.shape = {};
  face.law.mode_ratio = 1;
  face.fall = {now, duration};
  face.force = face.last_force = state.in_own_axes(force);
  face.last_turn = relative_turn(b, p);
  faces_.emplace(name_of(b, p), face);
  find_fronts();
  return true;
}

template <int dim>
void CohesiveFaces<dim>::find_fronts()
{
  at_front_.clear();
  for (const auto &[name, face] : faces_)
    if (face.fall.is_on() && face.stayed.damage < 1)
      at_front_.insert(at_front_.end(), {face.bond.i, face.bond.j});
  std::sort(at_front_.begin(), at_front_.end());
}

template <int dim>
double CohesiveFaces<dim>::try_to_open(const Particles &p, Evaluation<dim> &e)
{
  if (faces_.empty())
    return 0;
  OpeningFaces<dim> opening(body_, strains_, p, e, faces_);
  opening.find_pressures();
  return opening.follow_law(true);
}

template <int dim>
void CohesiveFaces<dim>::forget_trial()
{
  for (auto &[name, face] : faces_) {
    face.opening = face.stayed;
    face.force = face.last_force;
  }
}

template <int dim>
bool CohesiveFaces<dim>::begin_opening(double time)
{
  if (none()) {
    has_jumped_ = false;
    return false;
  }
  if (opened_at_ == time)
    return false;
  opened_at_ = time;
  is_booked_ = false;
  for (auto &[name, face] : faces_)
    if (face.fall.is_on())
      face.gone = face.fall.gone(time);
  return true;
}

template <int dim>
void CohesiveFaces<dim>::open(const Particles &p, double time, Evaluation<dim> &e)
{
  if (!begin_opening(time))
    return;
  OpeningFaces<dim> opening(body_, strains_, p, e, faces_);
  opening.find_pressures();
  if (is_in_parts())
    opening.hear_others(owners_->ranks, *names_, tells_);
  opening.follow_law(has_jumped_);
  has_jumped_ = false;
  book(p);
  opening.take_directions();
}

// One round in a step: what is left of it the next one makes up for.
template <int dim>
void CohesiveFaces<dim>::open_beside(const Particles &p, double time, Evaluation<dim> &e,
                                     const std::function<void()> &follow_others)
{
  if (!begin_opening(time))
    return;
  constexpr int most = 100;
  constexpr double round_off = 1e-14;
  double change = 1;
  for (int round = 0; round < (has_jumped_ ? most : 1) && change > round_off; ++round) {
    OpeningFaces<dim> opening(body_, strains_, p, e, faces_);
    opening.find_pressures();
    change = opening.follow_law(has_jumped_);
    follow_others();
  }
  has_jumped_ = false;
}

template <int dim>
void CohesiveFaces<dim>::open_in_flow(const Particles &p, double time, Evaluation<dim> &e)
{
  if (!begin_opening(time))
    return;
  OpeningFaces<dim> opening(body_, strains_, p, e, faces_);
  opening.find_strains(strains_);
  opening.follow_law(false);
}

template <int dim>
void CohesiveFaces<dim>::book(const Particles &p, Evaluation<dim> &e)
{
  if (is_booked_)
    return;
  for (auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p, strains_);
    face.force = now.in_own_axes(now.force(e.pressure[face.bond.i], e.pressure[face.bond.j]));
  }
  book(p);
  OpeningFaces<dim>(body_, strains_, p, e, faces_).take_directions();
}

template <int dim>
void CohesiveFaces<dim>::book(const Particles &p)
{
  is_booked_ = true;
  for (auto &item : faces_) {
    auto &face = item.second;
    const double shear = OpenedBond::of(face.bond).shear;
    const auto bending_share = [&](const Opening<dim> &o) {
      return SofteningFace<dim>::bending_share(face, shear, o);
    };
    const Spin<dim> turn = relative_turn(face.bond, p);
    const Vector<dim> opened = face.opening.jump - face.stayed.jump;
    const double taken = 0.5 * (face.last_force + face.force).dot(opened) +
                         (bending_share(face.stayed) - bending_share(face.opening)) *
                             bending_product(face.bond, face.last_turn, turn);
    if (!face.fall.is_on())
      face.spent += face.law.strength * face.law.reach *
                        (face.law.shape.area_from(face.stayed.damage) -
                         face.law.shape.area_from(face.opening.damage)) +
                    face.law.excess_energy_from(face.stayed.largest) -
                    face.law.excess_energy_from(face.opening.largest);
    if (face.is_own)
      work_.add(taken);
    face.work += taken;
    face.stayed = face.opening;
    face.last_force = face.force;
    face.last_turn = turn;
  }
  find_fronts();
}

template <int dim>
double CohesiveFaces<dim>::open_to_first_order(const Particles &p, Evaluation<dim> &e)
{
  if (faces_.empty())
    return 0;
  OpeningFaces<dim> opening(body_, strains_, p, e, faces_);
  opening.find_pressures();
  return opening.follow_tangents();
}

template <int dim>
auto CohesiveFaces<dim>::softness(const Face &face, const Particles &p) const -> Softness
{
  const SofteningFace<dim> now(face, p, strains_);
  const double bond = now.law.shear;
  if (now.in_space(face.force).dot(now.normal) <= 0 && face.opening.damage < 1)
    return {false, 1, now.bending_share(), bond};
  const auto tangent = face.law.tangent({now.jump, face.opening.largest, face.opening.damage},
                                        now.in_space(face.force), now.normal);
  const double left = std::max(tangent.trace() / dim, 0.);
  const bool opens = face.opening.damage < 1 && !face.law.unloads(face.opening, face.bond.normal);
  return {opens, left / (left + bond), now.bending_share(), bond};
}

template <int dim>
std::vector<Opening<dim>> CohesiveFaces<dim>::openings() const
{
  std::vector<Opening<dim>> all;
  for (const auto &[name, face] : faces_)
    all.push_back(face.opening);
  return all;
}

template <int dim>
void CohesiveFaces<dim>::put_back(const std::vector<Opening<dim>> &openings)
{
  auto of = openings.begin();
  for (auto &[name, face] : faces_)
    face.opening = *of++;
}

template <int dim>
void CohesiveFaces<dim>::take_up(const Particles &p, const Evaluation<dim> &e)
{
  for (auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p, strains_);
    face.force = now.in_own_axes(now.force(e.pressure[face.bond.i], e.pressure[face.bond.j]));
    face.last_force = face.force;
  }
}

// A face that is closed goes on as it is, with its share of the volumes: without it forces would
// jump.
template <int dim>
template <typename Visit>
void CohesiveFaces<dim>::for_each_torn(Visit &&visit) const
{
  for (const auto &[name, face] : faces_) {
    const bool is_apart = face.law.is_apart(face.opening.jump, face.bond.normal),
               has_left = face.opening.jump.norm() > body_.spacing() / 4;
    if (face.law.left(face.opening) == 0 && (is_apart || has_left))
      visit(name, face);
  }
}

template <int dim>
std::vector<BondId> CohesiveFaces<dim>::torn() const
{
  std::vector<BondId> found;
  for_each_torn([&](const Name &, const Face &face) { found.push_back(face.id); });
  return found;
}

template <int dim>
auto CohesiveFaces<dim>::own_torn() const -> std::vector<Name>
{
  std::vector<Name> found;
  for_each_torn([&](const Name &name, const Face &face) {
    if (face.is_own)
      found.push_back(name);
  });
  return found;
}

template <int dim>
Vector<dim> CohesiveFaces<dim>::opening(const Bond<dim> &b, const Particles &p) const
{
  const Face *const face = find(b, p);
  return face ? SofteningFace<dim>(*face, p, strains_).jump : Vector<dim>(Vector<dim>::Zero());
}

template <int dim>
double CohesiveFaces<dim>::lost_bending_energy(const Bond<dim> &b, const Particles &p) const
{
  const Face *const face = find(b, p);
  return face ? (1 - SofteningFace<dim>(*face, p, strains_).bending_share()) * bending_energy(b, p)
              : 0;
}

template <int dim>
std::array<double, 2> CohesiveFaces<dim>::opened_volumes(const Bond<dim> &b,
                                                         const Particles &p) const
{
  const Face *const face = find(b, p);
  if (!face)
    return {0, 0};
  const SofteningFace<dim> now(*face, p, strains_);
  return {now.volume_i(now.jump), now.volume_j(now.jump)};
}

template <int dim>
double CohesiveFaces<dim>::energy_between_materials(const Particles &p) const
{
  core::ExactSum sum;
  for (const auto &[name, face] : faces_)
    if (face.bond.joins_materials)
      sum.add(SofteningFace<dim>(face, p, strains_).elastic_energy_change(p));
  return sum.value();
}

template <int dim>
void CohesiveFaces<dim>::for_each_strain(
    const Particles &p,
    const std::function<void(int, const Eigen::Matrix<double, dim, dim> &)> &visit) const
{
  for (const auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p, strains_);
    const auto [of_i, of_j] = now.strains_of(now.jump, p);
    visit(face.bond.i, of_i);
    visit(face.bond.j, of_j);
  }
}

template <int dim>
void CohesiveFaces<dim>::add_force_of(const Bond<dim> &b, const Particles &p,
                                      Vector<dim> &force) const
{
  if (const Face *const face = find(b, p)) {
    const SofteningFace<dim> now(*face, p, strains_);
    force -= now.law.shear * now.jump;
  }
}

template <int dim>
std::vector<int> CohesiveFaces<dim>::particles() const
{
  std::vector<int> found;
  for (const auto &[name, face] : faces_)
    found.insert(found.end(), {face.bond.i, face.bond.j});
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

template <int dim>
void CohesiveFaces<dim>::add_pressures(const Particles &p, Evaluation<dim> &e) const
{
  if (!body_.has_dilatation())
    return;
  const auto &lambda = body_.lambda_per_volume();
  for (const auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p, strains_);
    e.pressure[face.bond.i] += lambda[face.bond.i] * now.volume_i(now.jump);
    e.pressure[face.bond.j] += lambda[face.bond.j] * now.volume_j(now.jump);
  }
}

template <int dim>
void CohesiveFaces<dim>::add_strains(const Particles &p, Evaluation<dim> &e) const
{
  for_each_strain(p, [&](int i, const Eigen::Matrix<double, dim, dim> &strain) {
    InelasticStrains<dim>::add_strain(*e.inelastic, i, strain);
  });
}

template <int dim>
void CohesiveFaces<dim>::add_forces(Particles &p, Evaluation<dim> &e) const
{
  for (const auto &[name, face] : faces_) {
    const auto change = SofteningFace<dim>(face, p, strains_)
                            .change(p, e.pressure[face.bond.i], e.pressure[face.bond.j]);
    for (const int side : {0, 1}) {
      const int i = side == 0 ? face.bond.i : face.bond.j;
      ligament::add(p.force, i, change[side].force);
      ligament::add(p.torque, i, change[side].torque);
    }
  }
}

template <int dim>
void CohesiveFaces<dim>::add_force_on(int i, const Particles &p, const Evaluation<dim> &e,
                                      Wrench<dim> &wrench) const
{
  if (faces_.empty())
    return;
  body_.bonds().for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
    const Face *const face = find(b, p);
    if (!face)
      return;
    const auto change = SofteningFace<dim>(*face, p, strains_)
                            .change(p, e.pressure[face->bond.i], e.pressure[face->bond.j]);
    const Wrench<dim> &own = change[face->bond.i == i ? 0 : 1];
    wrench.force += own.force;
    wrench.torque += own.torque;
  });
}

template <int dim>
void CohesiveFaces<dim>::add_energies(const Particles &p, Evaluation<dim> &,
                                      std::vector<double> &energy) const
{
  for (const auto &[name, face] : faces_)
    energy[face.bond.i] += SofteningFace<dim>(face, p, strains_).energy_change(p);
}

template <int dim>
void CohesiveFaces<dim>::for_each_moment(const Particles &p, const Evaluation<dim> &,
                                         const VisitMoment<dim> &visit) const
{
  for (const auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p, strains_);
    const Vector<dim> lost = now.law.shear * now.jump;
    visit(face.bond.i, now.motion.a_i, Vector<dim>(-lost));
    visit(face.bond.j, now.motion.a_j, lost);
  }
}

template <int dim>
void CohesiveFaces<dim>::remove(const BondId &, const Bond<dim> &b, const Particles &p)
{
  if (faces_.empty())
    return;
  faces_.erase(name_of(b, p));
  find_fronts();
}

template class CohesiveFaces<2>;
template class CohesiveFaces<3>;
} // namespace ligament::dem
