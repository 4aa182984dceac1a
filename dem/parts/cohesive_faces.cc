#include "dem/parts/cohesive_faces.h"

#include "dem/bond_law.h"

#include <algorithm>

namespace ligament::dem
{
namespace
{
/// A softening face in a state of its particles, in space.
template <int dim>
struct SofteningFace
{
  const CohesiveFace<dim> &face;
  BondLaw<dim> law;
  Turn<dim> own;            // of the particle with which the opening turns
  BondMotion<dim> motion;   // as if nothing had opened
  Vector<dim> jump, normal; // w in m; of the face

  SofteningFace(const CohesiveFace<dim> &of, const particles::Particles<dim> &p)
      : face(of), law(law_of(of.bond)),
        own(Turn<dim>::of(p, of.turns_with_i ? of.bond.i : of.bond.j)),
        motion(of.bond, Turn<dim>::of(p, of.bond.i), Turn<dim>::of(p, of.bond.j),
               get(p.displacement, of.bond.i), get(p.displacement, of.bond.j)),
        jump(in_space(of.opening.jump)), normal(in_space(of.bond.normal))
  {
  }

  Vector<dim> in_space(const Vector<dim> &v) const { return v + own.change(v); }
  Vector<dim> in_own_axes(const Vector<dim> &v) const { return v + own.inverse().change(v); }

  /// On i, in N, under the pressures of both.
  Vector<dim> force(double p_i, double p_j) const
  {
    return law.force(Vector<dim>(motion.du - jump), p_i, motion.a_i, p_j, motion.a_j);
  }
  /// What an opening adds to V theta of i and of j, in m^3.
  double volume_i(const Vector<dim> &opening) const
  {
    return -law.add_dilatation(opening, motion.a_i, 0);
  }
  double volume_j(const Vector<dim> &opening) const
  {
    return law.add_dilatation(opening, motion.a_j, 0);
  }
  /// How much of the force an opening takes, in N/m, through both volumes, too.
  Eigen::Matrix<double, dim, dim> stiffness(double lambda_i, double lambda_j) const
  {
    const double square = law.area_r * law.area_r;
    return law.shear * Eigen::Matrix<double, dim, dim>::Identity() +
           square * lambda_i * motion.a_i * motion.a_i.transpose() +
           square * lambda_j * motion.a_j * motion.a_j.transpose();
  }

  /// Share of bending and twist that is left: they fall as the face's stiffness does.
  double bending_share() const { return bending_share(face.opening); }
  double bending_share(const Opening<dim> &o) const
  {
    const double force = face.law.strength * face.law.left(o);
    return force / (force + law.shear * o.largest);
  }

  /// What the opening changes in what acts on i and on j.
  std::array<Wrench<dim>, 2> change(const particles::Particles<dim> &p, double p_i,
                                    double p_j) const
  {
    const Vector<dim> lost = law.shear * jump;
    const Spin<dim> bend = (1 - bending_share()) * bending_torque(face.bond, p);
    Wrench<dim> i, j;
    i.force = -lost;
    j.force = lost;
    i.torque = cross(motion.a_i, Vector<dim>(law.area_r * p_i * jump - lost)) - bend;
    j.torque = cross(motion.a_j, Vector<dim>(lost - law.area_r * p_j * jump)) + bend;
    (face.turns_with_i ? i : j).torque += cross(jump, force(p_i, p_j));
    return {i, j};
  }

  /// The same in the energy, volumes aside, in J.
  double energy_change(const particles::Particles<dim> &p) const
  {
    return (law.twice_energy(Vector<dim>(motion.du - jump)) - law.twice_energy(motion.du)) / 2 -
           (1 - bending_share()) * bending_energy(face.bond, p);
  }
};

/// How j has turned against i; and the product of two such turns that is the energy of one.
Spin<2> relative_turn(const Bond<2> &b, const particles::Particles<2> &p)
{
  return Spin<2>(p.rotation[0][b.j] - p.rotation[0][b.i]);
}
Spin<3> relative_turn(const Bond<3> &b, const particles::Particles<3> &p)
{
  const auto i = Turn<3>::of(p, b.i), j = Turn<3>::of(p, b.j);
  return HWY_NAMESPACE::relative_turn(i.w, i.v, j.w, j.v);
}
double bending_product(const Bond<2> &b, const Spin<2> &u, const Spin<2> &v)
{
  return b.bending / 2 * u[0] * v[0];
}
double bending_product(const Bond<3> &b, const Spin<3> &u, const Spin<3> &v)
{
  return 2 * (b.bending * u.dot(v) + (b.twist - b.bending) * b.normal.dot(u) * b.normal.dot(v));
}

/// The crack that a face is a part of lies across the way in which it opens: its share of the
/// energy is that of the area seen that way, eq. (D42), less what it has spent already.
template <int dim>
void take_direction(CohesiveFace<dim> &face, const Vector<dim> &way)
{
  constexpr double least = 0.3; // that of the criterion's cone
  const double cosine = face.bond.normal.dot(way) / way.norm();
  if (!(cosine > 0)) // shut, or not open yet
    return;
  const Softening &shape = face.law.shape;
  const double energy = face.whole_energy * std::max(cosine, least),
               whole = shape.reach() * energy / face.law.strength,
               area = face.law.strength * shape.area_from(face.opening.damage);
  constexpr double shortest = 0.2, longest = 2; // of the whole reach
  if (area > 0)
    face.law.reach = std::clamp((energy - face.spent) / area, shortest * whole, longest * whole);
}

/// visit(column, number) for all that a face remembers.
template <int dim, typename F, typename Visit>
void for_each_number(F &face, Visit &&visit)
{
  const auto vector = [&](const std::string &name, auto &v) {
    for (int k = 0; k < int(v.size()); ++k)
      visit(name + "_" + std::to_string(k), v[k]);
  };
  visit("strength", face.law.strength);
  visit("reach", face.law.reach);
  vector("opening", face.stayed.jump);
  visit("largest", face.stayed.largest);
  visit("damage", face.stayed.damage);
  vector("last_force", face.last_force);
  vector("last_turn", face.last_turn);
  visit("spent", face.spent);
  visit("whole_energy", face.whole_energy);
  visit("work", face.work);
}
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
auto CohesiveFaces<dim>::make(const BondId &id, const Bond<dim> &b, const Particles &p) const
    -> Face
{
  const double friction = body_.materials().friction(b.i, b.j);
  return {id,
          b,
          {0, 0, shape_, mode_ratio_, friction},
          p.global_id[b.i] == name_of(b, p)[0],
          {Vector<dim>::Zero()}};
}

// The strength is what the face bears now, so that nothing jumps; the reach gives the area below
// the curve.
template <int dim>
void CohesiveFaces<dim>::begin(const BondId &id, const Bond<dim> &b, const Particles &p,
                               const Vector<dim> &force, double energy)
{
  Face face = make(id, b, p);
  const SofteningFace<dim> now(face, p);
  face.law.strength = face.law.effective(force, now.normal);
  face.whole_energy = energy;
  face.force = face.last_force = now.in_own_axes(force);
  take_direction(face, face.last_force);
  face.last_turn = relative_turn(b, p);
  faces_.emplace(name_of(b, p), face);
}

template <int dim>
std::map<int, double> CohesiveFaces<dim>::whole_pressures(const Particles &p,
                                                          const Evaluation<dim> &e) const
{
  std::map<int, double> pressures;
  for (const int i : particles()) {
    double &sum = pressures[i] = e.pressure[i];
    if (body_.lambda_per_volume()[i] == 0)
      continue;
    body_.bonds().for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
      if (id.direction < 0)
        return;
      const BondMotion<dim> m(b, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j),
                              get(p.displacement, b.i), get(p.displacement, b.j));
      sum += body_.lambda_per_volume()[i] * (b.i == i ? law_of(b).add_dilatation(m.du, m.a_i, 0)
                                                      : -law_of(b).add_dilatation(m.du, m.a_j, 0));
    });
  }
  return pressures;
}

// Faces of one particle see each other through its pressure; one after the other they converge as
// Gauss and Seidel's method does, and there and back the answers to small changes are symmetric.
template <int dim>
template <typename Answer>
void CohesiveFaces<dim>::sweep(const Particles &p, Evaluation<dim> &e,
                               std::map<int, double> &pressure, bool is_exact, Answer &&answer)
{
  const auto &lambda = body_.lambda_per_volume();
  const auto open = [&](Face &face) {
    const SofteningFace<dim> now(face, p);
    const int i = face.bond.i, j = face.bond.j;
    const auto stiffness = now.stiffness(lambda[i], lambda[j]);
    const Vector<dim> shut = now.force(pressure[i], pressure[j]) + stiffness * now.jump;
    const Opening<dim> next = answer(now, shut, stiffness);
    const Vector<dim> opened = next.jump - now.jump;
    const double to_i = lambda[i] * now.volume_i(opened), to_j = lambda[j] * now.volume_j(opened);
    pressure[i] += to_i, e.pressure[i] += to_i;
    pressure[j] += to_j, e.pressure[j] += to_j;
    face.opening = {now.in_own_axes(next.jump), next.largest, next.damage};
    return opened.norm() / face.law.reach;
  };
  constexpr int most = 100;
  constexpr double round_off = 1e-14;
  for (int round = 0; round < (is_exact ? most : 1); ++round) {
    double largest = 0;
    for (auto face = faces_.begin(); face != faces_.end(); ++face)
      largest = std::max(largest, open(face->second));
    for (auto face = faces_.rbegin(); face != faces_.rend(); ++face)
      largest = std::max(largest, open(face->second));
    if (largest < round_off)
      return;
  }
}

template <int dim>
void CohesiveFaces<dim>::try_to_open(const Particles &p, Evaluation<dim> &e, bool is_exact)
{
  std::map<int, double> pressure = whole_pressures(p, e);
  sweep(p, e, pressure, is_exact,
        [](const SofteningFace<dim> &now, const Vector<dim> &shut, const auto &stiffness) {
          const Opening<dim> &stayed = now.face.stayed;
          return now.face.law.answer({now.in_space(stayed.jump), stayed.largest, stayed.damage},
                                     shut, stiffness, now.normal);
        });
  for (auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p);
    face.force = now.in_own_axes(now.force(pressure[face.bond.i], pressure[face.bond.j]));
  }
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
void CohesiveFaces<dim>::open(const Particles &p, double time, Evaluation<dim> &e)
{
  if (faces_.empty() || opened_at_ == time)
    return;
  opened_at_ = time;
  try_to_open(p, e, has_jumped_);
  has_jumped_ = false;
  for (auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p);
    const Spin<dim> turn = relative_turn(face.bond, p);
    const Vector<dim> opened = face.opening.jump - face.stayed.jump;
    const double taken = 0.5 * (face.last_force + face.force).dot(opened) +
                         (now.bending_share(face.stayed) - now.bending_share()) *
                             bending_product(face.bond, face.last_turn, turn);
    face.spent += face.law.strength * face.law.reach *
                  (face.law.shape.area_from(face.stayed.damage) -
                   face.law.shape.area_from(face.opening.damage));
    work_.add(taken);
    face.work += taken;
    face.stayed = face.opening;
    face.last_force = face.force;
    face.last_turn = turn;
  }
  take_directions(p);
}

template <int dim>
void CohesiveFaces<dim>::take_directions(const Particles &p)
{
  struct Way
  {
    const Face *face;
    Vector<dim> jump, normal;
  };
  std::multimap<int, Way> at;
  for (const auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p);
    for (const int i : {face.bond.i, face.bond.j})
      at.insert({i, {&face, now.jump, now.normal}});
  }
  for (auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p);
    Vector<dim> way = now.jump;
    const Vector<dim> along = now.jump.norm() > 0 ? now.jump : now.in_space(face.force);
    for (const int i : {face.bond.i, face.bond.j})
      for (auto [k, last] = at.equal_range(i); k != last; ++k)
        if (k->second.face != &face)
          way += (k->second.jump.dot(along) < 0 ? -1 : 1) * k->second.jump;
    if (way.norm() > 0)
      take_direction(face, now.in_own_axes(way));
  }
}

// A face that is shut stays so.
template <int dim>
void CohesiveFaces<dim>::open_to_first_order(const Particles &p, Evaluation<dim> &e)
{
  std::map<int, double> pressure = whole_pressures(p, e);
  const std::vector<Opening<dim>> about = openings();
  std::map<const Face *, const Opening<dim> *> about_of;
  auto of = about.begin();
  for (const auto &[name, face] : faces_)
    about_of[&face] = &*of++;
  sweep(p, e, pressure, true,
        [&](const SofteningFace<dim> &now, const Vector<dim> &shut,
            const auto &stiffness) -> Opening<dim> {
          const Opening<dim> &there = *about_of.at(&now.face);
          const Vector<dim> jump = now.in_space(there.jump), force = now.in_space(now.face.force);
          if (there.damage < 1 ? force.dot(now.normal) <= 0 : jump.dot(now.normal) <= 0)
            return {jump, there.largest, there.damage};
          const auto tangent =
              now.face.law.tangent({jump, there.largest, there.damage}, force, now.normal);
          return {(stiffness + tangent).inverse() * (shut - force + tangent * jump), there.largest,
                  there.damage};
        });
}

template <int dim>
auto CohesiveFaces<dim>::softness(const Face &face, const Particles &p) const -> Softness
{
  const SofteningFace<dim> now(face, p);
  const double bond = now.law.shear;
  if (now.in_space(face.force).dot(now.normal) <= 0 && face.opening.damage < 1)
    return {false, 1, now.bending_share()};
  const auto tangent = face.law.tangent({now.jump, face.opening.largest, face.opening.damage},
                                        now.in_space(face.force), now.normal);
  const double left = std::max(tangent.trace() / dim, 0.);
  const bool opens = face.opening.damage < 1 && !face.law.unloads(face.opening, face.bond.normal);
  return {opens, left / (left + bond), now.bending_share()};
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
    const SofteningFace<dim> now(face, p);
    face.force = now.in_own_axes(now.force(e.pressure[face.bond.i], e.pressure[face.bond.j]));
    face.last_force = face.force;
  }
}

// A face that is closed goes on as it is, with its share of the volumes: without it forces would
// jump.
template <int dim>
std::vector<BondId> CohesiveFaces<dim>::torn() const
{
  std::vector<BondId> found;
  for (const auto &[name, face] : faces_) {
    const double open = face.bond.normal.dot(face.opening.jump);
    const bool has_left = face.opening.jump.norm() > body_.spacing() / 4;
    if (face.law.left(face.opening) == 0 && (open > 0 || has_left))
      found.push_back(face.id);
  }
  return found;
}

template <int dim>
Vector<dim> CohesiveFaces<dim>::opening(const Bond<dim> &b, const Particles &p) const
{
  const Face *const face = find(b, p);
  return face ? SofteningFace<dim>(*face, p).jump : Vector<dim>(Vector<dim>::Zero());
}

template <int dim>
double CohesiveFaces<dim>::lost_bending_energy(const Bond<dim> &b, const Particles &p) const
{
  const Face *const face = find(b, p);
  return face ? (1 - SofteningFace<dim>(*face, p).bending_share()) * bending_energy(b, p) : 0;
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
    const SofteningFace<dim> now(face, p);
    e.pressure[face.bond.i] += lambda[face.bond.i] * now.volume_i(now.jump);
    e.pressure[face.bond.j] += lambda[face.bond.j] * now.volume_j(now.jump);
  }
}

template <int dim>
void CohesiveFaces<dim>::add_forces(Particles &p, Evaluation<dim> &e) const
{
  for (const auto &[name, face] : faces_) {
    const auto change =
        SofteningFace<dim>(face, p).change(p, e.pressure[face.bond.i], e.pressure[face.bond.j]);
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
  for (const auto &[name, face] : faces_) {
    if (face.bond.i != i && face.bond.j != i)
      continue;
    const auto change =
        SofteningFace<dim>(face, p).change(p, e.pressure[face.bond.i], e.pressure[face.bond.j]);
    const Wrench<dim> &own = change[face.bond.i == i ? 0 : 1];
    wrench.force += own.force;
    wrench.torque += own.torque;
  }
}

template <int dim>
void CohesiveFaces<dim>::add_energies(const Particles &p, Evaluation<dim> &,
                                      std::vector<double> &energy) const
{
  for (const auto &[name, face] : faces_)
    energy[face.bond.i] += SofteningFace<dim>(face, p).energy_change(p);
}

template <int dim>
void CohesiveFaces<dim>::for_each_moment(const Particles &p, const Evaluation<dim> &,
                                         const VisitMoment<dim> &visit) const
{
  for (const auto &[name, face] : faces_) {
    const SofteningFace<dim> now(face, p);
    const Vector<dim> lost = now.law.shear * now.jump;
    visit(face.bond.i, now.motion.a_i, Vector<dim>(-lost));
    visit(face.bond.j, now.motion.a_j, lost);
  }
}

template <int dim>
void CohesiveFaces<dim>::remove(const BondId &, const Bond<dim> &b, const Particles &p)
{
  if (!faces_.empty())
    faces_.erase(name_of(b, p));
}

template <int dim>
void CohesiveFaces<dim>::save(core::State &state, const core::Names &) const
{
  if (faces_.empty() && !opened_at_)
    return;
  std::vector<std::int64_t> keys;
  std::map<std::string, std::vector<double>> columns;
  for (const auto &[name, face] : faces_) {
    keys.insert(keys.end(), name.begin(), name.end());
    for_each_number<dim>(
        face, [&](const std::string &column, double value) { columns[column].push_back(value); });
  }
  core::Table table(std::move(keys), 2);
  for (const auto &[column, values] : columns)
    table.add(column, values);
  state["cohesive"] = std::move(table);
  core::save_value(state, "cohesive_clock", "opened_at", opened_at_.value_or(std::nan("")));
  core::save_sum(state, "cohesive_work", work_);
}

template <int dim>
void CohesiveFaces<dim>::load(const core::State &state, const core::Names &names,
                              const Particles &p)
{
  const auto found = state.find("cohesive");
  if (found == state.end())
    return;
  const core::Table &table = found->second;
  std::map<std::string, std::vector<double>> columns;
  for (const std::string &column : table.columns())
    columns[column] = table.reals(column);
  for (std::size_t r = 0; r < table.n_rows(); ++r) {
    const int here = names.index(table.keys()[2 * r]), there = names.index(table.keys()[2 * r + 1]);
    if (here < 0 || there < 0)
      continue;
    std::optional<BondId> id;
    body_.bonds().for_each_bond_of(here, [&](BondId of, const Bond<dim> &b) {
      if (b.i == there || b.j == there)
        id = of;
    });
    core::require(id.has_value(), "the state opens a bond that this body doesn't have");
    const Bond<dim> b = body_.bonds().bond(*id);
    Face face = make(*id, b, p);
    for_each_number<dim>(
        face, [&](const std::string &column, double &value) { value = columns.at(column)[r]; });
    face.opening = face.stayed;
    face.force = face.last_force;
    faces_.emplace(name_of(b, p), face);
  }
  const double time = core::load_real(state, "cohesive_clock", "opened_at");
  opened_at_ = std::isnan(time) ? std::nullopt : std::optional(time);
  work_ = core::load_sum(state, "cohesive_work");
}

template class CohesiveFaces<2>;
template class CohesiveFaces<3>;
} // namespace ligament::dem
