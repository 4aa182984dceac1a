// Softening faces in a state of their particles: what they bear and change, and how they open
// together.
#pragma once

#include "dem/parts/cohesive_faces.h"
#include "dem/parts/flow_trial.h"
#include "dem/parts/swept_face.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <vector>

namespace ligament::dem
{
/// A softening face in a state of its particles, in space.
template <int dim>
struct SofteningFace
{
  const CohesiveFace<dim> &face;
  OpenedBond law;
  Turn<dim> own;            // of the particle with which the opening turns
  BondMotion<dim> motion;   // as if nothing had opened
  Vector<dim> jump, normal; // w in m; of the face

  SofteningFace(const CohesiveFace<dim> &of, const particles::Particles<dim> &p,
                const InelasticStrains<dim> &strains)
      : SofteningFace(of, p, strains, Turn<dim>::of(p, of.bond.i), Turn<dim>::of(p, of.bond.j))
  {
  }

  Vector<dim> in_space(const Vector<dim> &v) const { return v + own.change(v); }
  Vector<dim> in_own_axes(const Vector<dim> &v) const { return v + own.inverse().change(v); }

  /// On i, in N, under the pressures of both.
  Vector<dim> force(double p_i, double p_j) const
  {
    return law.force<dim>(motion.elastic - jump, p_i, motion.a_i, p_j, motion.a_j);
  }
  /// What an opening adds to V theta of i and of j, in m^3.
  double volume_i(const Vector<dim> &opening) const
  {
    return law.volume_i<dim>(motion.a_i, opening);
  }
  double volume_j(const Vector<dim> &opening) const
  {
    return law.volume_j<dim>(motion.a_j, opening);
  }
  /// What it adds to X of i and of j, theory.md section 1.10, in m^dim and the axes of each.
  std::array<Eigen::Matrix<double, dim, dim>, 2>
  strains_of(const Vector<dim> &opening, const particles::Particles<dim> &p) const
  {
    const auto back = [&](int i) {
      return Vector<dim>(opening + Turn<dim>::of(p, i).inverse().change(opening));
    };
    return {-law.share_i * back(face.bond.i) * face.bond.lever_i.transpose(),
            law.share_j * back(face.bond.j) * face.bond.lever_j.transpose()};
  }
  /// How much of the force an opening takes, in N/m, through both volumes, too.
  Eigen::Matrix<double, dim, dim> stiffness(double lambda_i, double lambda_j) const
  {
    const double square_i = law.share_i * law.share_i, square_j = law.share_j * law.share_j;
    return law.shear * Eigen::Matrix<double, dim, dim>::Identity() +
           square_i * lambda_i * motion.a_i * motion.a_i.transpose() +
           square_j * lambda_j * motion.a_j * motion.a_j.transpose();
  }

  /// Share of bending and twist that is left: they fall as the face's stiffness does.
  double bending_share() const { return bending_share(face, law.shear, face.opening); }
  /// The same at an opening o, with k in N/m: the particles' state does not matter.
  static double bending_share(const CohesiveFace<dim> &face, double shear, const Opening<dim> &o)
  {
    const double left = face.law.left(o), force = face.law.strength * left;
    if (face.fall.is_on()) // what presses has no strength to lose, but time goes on
      return left > 0 ? left * force / (force + shear * o.largest) : 0;
    return force / (force + shear * o.largest);
  }

  /// At these strains of the particles, in the axes of each, in place of their own.
  void stretch(const particles::Particles<dim> &p, const Eigen::Matrix<double, dim, dim> &e_i,
               const Eigen::Matrix<double, dim, dim> &e_j)
  {
    const auto turned = [&](int i, const Vector<dim> &v) {
      return Vector<dim>(v + Turn<dim>::of(p, i).change(v));
    };
    motion.stretch(turned(face.bond.i, e_i * face.bond.lever_i),
                   turned(face.bond.j, e_j * face.bond.lever_j));
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
    i.torque = cross(motion.a_i, Vector<dim>(law.share_i * p_i * jump - lost)) - bend -
               cross(motion.stretch_i, lost);
    j.torque = cross(motion.a_j, Vector<dim>(lost - law.share_j * p_j * jump)) + bend +
               cross(motion.stretch_j, lost);
    (face.turns_with_i ? i : j).torque += cross(jump, force(p_i, p_j));
    return {i, j};
  }

  /// The same in the energy, volumes aside, in J; what strains of the particles' own add to it is
  /// theirs.
  double energy_change(const particles::Particles<dim> &p) const
  {
    return energy_change(motion.du) - (1 - bending_share()) * bending_energy(face.bond, p);
  }
  /// Of what answers elastically alone.
  double elastic_energy_change(const particles::Particles<dim> &p) const
  {
    return energy_change(motion.elastic) - (1 - bending_share()) * bending_energy(face.bond, p);
  }

private:
  SofteningFace(const CohesiveFace<dim> &of, const particles::Particles<dim> &p,
                const InelasticStrains<dim> &strains, const Turn<dim> &of_i, const Turn<dim> &of_j)
      : face(of), law(OpenedBond::of(of.bond)), own(of.turns_with_i ? of_i : of_j),
        motion(strains.motion(of.bond, p, of_i, of_j)), jump(in_space(of.opening.jump)),
        normal(in_space(of.bond.normal))
  {
  }

  double energy_change(const Vector<dim> &whole) const
  {
    const Vector<dim> left = whole - jump;
    return (law.shear * left.dot(left) - law.shear * whole.dot(whole)) / 2;
  }
};

/// How j has turned against i; and the product of two such turns that is the energy of one.
inline Spin<2> relative_turn(const Bond<2> &b, const particles::Particles<2> &p)
{
  return Spin<2>(p.rotation[0][b.j] - p.rotation[0][b.i]);
}
inline Spin<3> relative_turn(const Bond<3> &b, const particles::Particles<3> &p)
{
  const auto i = Turn<3>::of(p, b.i), j = Turn<3>::of(p, b.j);
  return HWY_NAMESPACE::relative_turn(i.w, i.v, j.w, j.v);
}
inline double bending_product(const Bond<2> &b, const Spin<2> &u, const Spin<2> &v)
{
  return b.bending / 2 * u[0] * v[0];
}
inline double bending_product(const Bond<3> &b, const Spin<3> &u, const Spin<3> &v)
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
  if (!(cosine > 0) || face.fall.is_on()) // shut, or not open yet
    return;
  const Softening &shape = face.law.shape;
  const double energy = face.whole_energy * std::max(cosine, least),
               whole = shape.reach() * energy / face.law.strength,
               area = face.law.strength * shape.area_from(face.opening.damage);
  constexpr double shortest = 0.2, longest = 2; // of the whole reach
  if (area > 0)
    face.law.reach =
        std::clamp((energy - face.spent - face.law.excess_energy_from(face.opening.largest)) / area,
                   shortest * whole, longest * whole);
}

/// All of them in a state of their particles, which open together: they see each other through the
/// pressures of these, and through the strains that these answer where materials flow.
template <int dim>
class OpeningFaces
{
public:
  using Face = CohesiveFace<dim>;
  using Name = std::array<std::int64_t, 2>;
  using Particles = particles::Particles<dim>;
  using Matrix = Eigen::Matrix<double, dim, dim>;
  struct One
  {
    Face *face;
    SofteningFace<dim> now;
    int i, j; // of particles()
  };

  OpeningFaces(const BondedBody<dim> &body, const InelasticStrains<dim> &strains,
               const Particles &p, Evaluation<dim> &e, std::map<Name, Face> &faces)
      : body_(body), p_(p), e_(e)
  {
    for (const auto &[name, face] : faces)
      particle_.insert(particle_.end(), {face.bond.i, face.bond.j});
    std::sort(particle_.begin(), particle_.end());
    particle_.erase(std::unique(particle_.begin(), particle_.end()), particle_.end());
    all_.reserve(faces.size());
    for (auto &[name, face] : faces) {
      all_.push_back({&face, {face, p, strains}, place(face.bond.i), place(face.bond.j)});
      swept_.push_back(swept_face(name, all_.back()));
    }
  }

  /// Before they open, by the pressures of their particles.
  void find_pressures()
  {
    for (const int i : particle_)
      pressure_.push_back(whole_pressure(i, p_));
  }
  /// The same where materials flow: open cells hold what is no bond's within a material, these
  /// openings included.
  void find_strains(const InelasticStrains<dim> &strains)
  {
    flow_.emplace(body_, strains, *e_.inelastic, p_, particle_);
    pressure_.resize(particle_.size());
    for (SweptFace<dim> &s : swept_)
      s.stiffness += flow_->damping(s.i, s.bond.shear, s.bond.share_i, s.a_i) +
                     flow_->damping(s.j, s.bond.shear, s.bond.share_j, s.a_j);
  }

  /// Of a body in parts, after find_pressures(): what faces near the seams hang together with is
  /// told to all ranks, which sweep it all; `are_some` says whether there is any. `names`: of the
  /// particles at hand.
  void hear_others(const core::Ranks &ranks, const core::Names &names, bool are_some)
  {
    ranks_ = ranks;
    if (!are_some)
      return;
    std::vector<ToldFace<dim>> told;
    std::map<Name, int> at_hand;
    std::vector<SweptFace<dim>> own;
    for (const SweptFace<dim> &s : swept_) {
      const Face &face = *all_[s.one].face;
      at_hand[s.name] = s.one;
      if (face.is_told)
        told.push_back(told_face(s, names.name(face.bond.i), names.name(face.bond.j),
                                 pressure_[s.i], pressure_[s.j]));
      else if (face.is_own)
        own.push_back(s);
    }
    swept_ = std::move(own);
    std::map<std::int64_t, int> elsewhere;
    for (const ToldFace<dim> &t : ranks.gather_all(told)) {
      double p_i = 0, p_j = 0;
      SweptFace<dim> &s = swept_.emplace_back(heard_face(t, p_i, p_j));
      if (const auto here = at_hand.find(s.name); here != at_hand.end())
        s.one = here->second;
      s.i = heard_particle(t.i, p_i, names, elsewhere);
      s.j = heard_particle(t.j, p_j, names, elsewhere);
    }
    std::sort(swept_.begin(), swept_.end(),
              [](const auto &a, const auto &b) { return a.name < b.name; });
  }

  /// From where the last step left them; to the last digit if `is_exact`, in a step the next one
  /// makes up for what is left. Returns the largest change in one sweep, in units of the reach.
  double follow_law(bool is_exact)
  {
    const double change = sweep(is_exact, [](const SweptFace<dim> &s, const Vector<dim> &shut) {
      return s.law.answer(s.last, shut, s.stiffness, s.normal);
    });
    for (One &one : all_)
      one.face->force = one.now.in_own_axes(one.now.force(pressure_[one.i], pressure_[one.j]));
    return change;
  }
  /// A face that is shut stays so.
  double follow_tangents()
  {
    std::vector<Opening<dim>> about;
    for (const One &one : all_)
      about.push_back(one.face->opening);
    return sweep(true, [&](const SweptFace<dim> &s, const Vector<dim> &shut) -> Opening<dim> {
      const One &one = all_[s.one];
      const Opening<dim> &there = about[s.one];
      const Vector<dim> jump = one.now.in_space(there.jump),
                        force = one.now.in_space(one.face->force);
      if ((there.damage < 1 ? force : jump).dot(one.now.normal) <= 0)
        return {jump, there.largest, there.damage};
      const Matrix tangent =
          one.face->law.tangent({jump, there.largest, there.damage}, force, one.now.normal);
      return {(s.stiffness + tangent).inverse() * (shut - force + tangent * jump), there.largest,
              there.damage};
    });
  }

  /// Each by the way in which the faces around it open, eq. (D42).
  void take_directions()
  {
    std::vector<std::vector<const One *>> around(particle_.size());
    for (const One &one : all_)
      for (const int k : {one.i, one.j})
        around[k].push_back(&one);
    for (One &one : all_) {
      if (!one.face->is_own)
        continue;
      const Vector<dim> &jump = one.now.jump;
      const Vector<dim> along = jump.norm() > 0 ? jump : one.now.in_space(one.face->force);
      Vector<dim> way = jump;
      for (const int k : {one.i, one.j})
        for (const One *other : around[k])
          if (other != &one)
            way += (other->now.jump.dot(along) < 0 ? -1 : 1) * other->now.jump;
      if (way.norm() > 0)
        take_direction(*one.face, one.now.in_own_axes(way));
    }
  }

private:
  int place(int i) const
  {
    return int(std::lower_bound(particle_.begin(), particle_.end(), i) - particle_.begin());
  }
  /// Of the last one of all_.
  SweptFace<dim> swept_face(const Name &name, const One &one) const
  {
    const auto &[face, now, i, j] = one;
    const double lambda_i = body_.lambda_per_volume()[face->bond.i],
                 lambda_j = body_.lambda_per_volume()[face->bond.j];
    return {name,
            int(all_.size()) - 1,
            i,
            j,
            face->fall.is_on() ? face->bond.distance : face->law.reach,
            face->law,
            now.law,
            lambda_i,
            lambda_j,
            now.motion.elastic,
            now.motion.a_i,
            now.motion.a_j,
            now.normal,
            {now.in_space(face->stayed.jump), face->stayed.largest, face->damage_before()},
            now.stiffness(lambda_i, lambda_j),
            {now.jump, face->opening.largest, face->opening.damage}};
  }
  /// Place in the sweep of a particle, which has so many Pa; `elsewhere`: of those that no face at
  /// hand has.
  int heard_particle(std::int64_t name, double pressure, const core::Names &names,
                     std::map<std::int64_t, int> &elsewhere)
  {
    const int i = names.index(name);
    int k = i < 0 ? int(particle_.size()) : place(i);
    if (k == int(particle_.size()) || particle_[k] != i) {
      const auto [found, is_new] = elsewhere.emplace(name, int(pressure_.size()));
      k = found->second;
      if (is_new)
        pressure_.emplace_back();
    }
    pressure_[k] = pressure;
    return k;
  }

  /// Of all parts, those of the rows included.
  double whole_pressure(int i, const Particles &p) const
  {
    double sum = e_.pressure[i];
    const double lambda = body_.lambda_per_volume()[i];
    if (lambda == 0 || body_.bonds().n_directions() == 0)
      return sum;
    body_.bonds().for_each_bond_of(i, [&](BondId id, const Bond<dim> &b) {
      if (id.direction < 0)
        return;
      const BondMotion<dim> m(b, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j),
                              get(p.displacement, b.i), get(p.displacement, b.j));
      sum += lambda * (b.i == i ? law_of(b).add_dilatation(m.du, m.a_i, 0)
                                : -law_of(b).add_dilatation(m.du, m.a_j, 0));
    });
    return sum;
  }

  /// What a particle of the sweep has now, wherever it is.
  void add_pressure(int k, double by)
  {
    pressure_[k] += by;
    if (k < int(particle_.size()))
      e_.pressure[particle_[k]] += by;
  }

  /// One after the other they converge as Gauss and Seidel's method does, and there and back the
  /// answers to small changes are symmetric. answer(face, force if it were shut) is the opening in
  /// space.
  template <typename Answer>
  double sweep(bool is_exact, Answer &&answer)
  {
    const auto open = [&](SweptFace<dim> &s) {
      if (flow_) {
        pressure_[s.i] = flow_->answer(s.i);
        pressure_[s.j] = flow_->answer(s.j);
        SofteningFace<dim> &now = all_[s.one].now;
        now.stretch(p_, flow_->inelastic(s.i), flow_->inelastic(s.j));
        s.elastic = now.motion.elastic;
      }
      const Vector<dim> shut =
          s.force(pressure_[s.i], pressure_[s.j]) + s.stiffness * s.opening.jump;
      const Opening<dim> next = answer(s, shut);
      const Vector<dim> opened = next.jump - s.opening.jump;
      if (flow_) {
        const auto [of_i, of_j] = all_[s.one].now.strains_of(opened, p_);
        flow_->add(s.i, of_i);
        flow_->add(s.j, of_j);
      } else {
        const double to_i = s.lambda_i * s.bond.template volume_i<dim>(s.a_i, opened),
                     to_j = s.lambda_j * s.bond.template volume_j<dim>(s.a_j, opened);
        add_pressure(s.i, to_i);
        add_pressure(s.j, to_j);
      }
      s.opening = next;
      return opened.norm() / s.unit;
    };
    constexpr int most = 100;
    constexpr double round_off = 1e-14;
    double first = 0;
    for (int round = 0; round < (is_exact ? most : 1); ++round) {
      double largest = 0;
      for (SweptFace<dim> &s : swept_)
        largest = std::max(largest, open(s));
      for (auto s = swept_.rbegin(); s != swept_.rend(); ++s)
        largest = std::max(largest, open(*s));
      if (is_exact)
        largest = largest_of_all(largest);
      if (round == 0)
        first = largest;
      if (largest < round_off)
        break;
    }
    take_openings();
    return first;
  }
  /// Not below 0.
  double largest_of_all(double here) const
  {
    if (ranks_.is_one())
      return here;
    std::int64_t bits; // in the order of such numbers
    std::memcpy(&bits, &here, sizeof(bits));
    bits = ranks_.max(bits);
    std::memcpy(&here, &bits, sizeof(bits));
    return here;
  }
  /// Those of the sweep, by the faces at hand.
  void take_openings()
  {
    for (const SweptFace<dim> &s : swept_) {
      if (s.one < 0)
        continue;
      One &one = all_[s.one];
      one.now.jump = s.opening.jump;
      one.face->opening = {one.now.in_own_axes(s.opening.jump), s.opening.largest,
                           s.opening.damage};
    }
  }

  const BondedBody<dim> &body_;
  const Particles &p_;
  Evaluation<dim> &e_;
  std::vector<int> particle_;    // of the faces at hand, ascending
  std::vector<double> pressure_; // Pa, of these and of others behind them
  std::vector<One> all_;
  std::vector<SweptFace<dim>> swept_; // in the order of their names
  std::optional<FlowTrial<dim>> flow_;
  core::Ranks ranks_; // of a body in parts
};
} // namespace ligament::dem
