// Softening faces in a state of their particles: what they bear and change, and how they open
// together.
#pragma once

#include "dem/bond_law.h"
#include "dem/parts/cohesive_faces.h"

#include <algorithm>
#include <vector>

namespace ligament::dem
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
  if (!(cosine > 0)) // shut, or not open yet
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
/// pressures of these.
template <int dim>
class OpeningFaces
{
public:
  using Face = CohesiveFace<dim>;
  using Particles = particles::Particles<dim>;
  using Matrix = Eigen::Matrix<double, dim, dim>;
  struct One
  {
    Face *face;
    SofteningFace<dim> now;
    Matrix stiffness; // how much of the force an opening takes, N/m
    int i, j;         // of particles()
  };

  template <typename Faces>
  OpeningFaces(const BondedBody<dim> &body, const Particles &p, Evaluation<dim> &e, Faces &faces)
      : body_(body), e_(e)
  {
    for (const auto &[name, face] : faces)
      particle_.insert(particle_.end(), {face.bond.i, face.bond.j});
    std::sort(particle_.begin(), particle_.end());
    particle_.erase(std::unique(particle_.begin(), particle_.end()), particle_.end());
    const auto place = [&](int i) {
      return int(std::lower_bound(particle_.begin(), particle_.end(), i) - particle_.begin());
    };
    const auto &lambda = body.lambda_per_volume();
    all_.reserve(faces.size());
    for (auto &[name, face] : faces) {
      const SofteningFace<dim> now(face, p);
      all_.push_back({&face, now, now.stiffness(lambda[face.bond.i], lambda[face.bond.j]),
                      place(face.bond.i), place(face.bond.j)});
    }
    for (const int i : particle_)
      pressure_.push_back(whole_pressure(i, p));
  }

  std::vector<One> &all() { return all_; }

  /// From where the last step left them; to the last digit if `is_exact`, in a step the next one
  /// makes up for what is left.
  void follow_law(bool is_exact)
  {
    sweep(is_exact, [](const One &one, const Vector<dim> &shut) {
      const Opening<dim> &stayed = one.face->stayed;
      return one.face->law.answer({one.now.in_space(stayed.jump), stayed.largest, stayed.damage},
                                  shut, one.stiffness, one.now.normal);
    });
    for (One &one : all_)
      one.face->force = one.now.in_own_axes(one.now.force(pressure_[one.i], pressure_[one.j]));
  }

  /// A face that is shut stays so.
  void follow_tangents()
  {
    std::vector<Opening<dim>> about;
    for (const One &one : all_)
      about.push_back(one.face->opening);
    sweep(true, [&](const One &one, const Vector<dim> &shut) -> Opening<dim> {
      const Opening<dim> &there = about[&one - all_.data()];
      const Vector<dim> jump = one.now.in_space(there.jump),
                        force = one.now.in_space(one.face->force);
      if ((there.damage < 1 ? force : jump).dot(one.now.normal) <= 0)
        return {jump, there.largest, there.damage};
      const Matrix tangent =
          one.face->law.tangent({jump, there.largest, there.damage}, force, one.now.normal);
      return {(one.stiffness + tangent).inverse() * (shut - force + tangent * jump), there.largest,
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

  /// One after the other they converge as Gauss and Seidel's method does, and there and back the
  /// answers to small changes are symmetric. answer(one, force if it were shut) is the opening in
  /// space.
  template <typename Answer>
  void sweep(bool is_exact, Answer &&answer)
  {
    const auto &lambda = body_.lambda_per_volume();
    const auto open = [&](One &one) {
      SofteningFace<dim> &now = one.now;
      const int i = one.face->bond.i, j = one.face->bond.j;
      const Vector<dim> shut =
          now.force(pressure_[one.i], pressure_[one.j]) + one.stiffness * now.jump;
      const Opening<dim> next = answer(one, shut);
      const Vector<dim> opened = next.jump - now.jump;
      const double to_i = lambda[i] * now.volume_i(opened), to_j = lambda[j] * now.volume_j(opened);
      pressure_[one.i] += to_i, e_.pressure[i] += to_i;
      pressure_[one.j] += to_j, e_.pressure[j] += to_j;
      now.jump = next.jump;
      one.face->opening = {now.in_own_axes(next.jump), next.largest, next.damage};
      return opened.norm() / one.face->law.reach;
    };
    constexpr int most = 100;
    constexpr double round_off = 1e-14;
    for (int round = 0; round < (is_exact ? most : 1); ++round) {
      double largest = 0;
      for (One &one : all_)
        largest = std::max(largest, open(one));
      for (auto one = all_.rbegin(); one != all_.rend(); ++one)
        largest = std::max(largest, open(*one));
      if (largest < round_off)
        return;
    }
  }

  const BondedBody<dim> &body_;
  Evaluation<dim> &e_;
  std::vector<int> particle_;    // ascending
  std::vector<double> pressure_; // Pa, of these
  std::vector<One> all_;
};
} // namespace ligament::dem
