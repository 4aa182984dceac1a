#include "dem/stressed_body.h"

#include "dem/bond_law.h"
#include "dem/laws/series_bond.h"
#include "dem/tensors.h"

#include <algorithm>

namespace ligament::dem
{
namespace
{
/// All turns at once, which takes less time than one by one.
std::vector<Turn<2>> turns_of(const particles::Particles<2> &p)
{
  const int n = p.size();
  std::vector<double> cosine_minus_1(n), sine(n);
  cosine_minus_1_and_sine(p.rotation[0].data(), cosine_minus_1.data(), sine.data(), n);
  std::vector<Turn<2>> turns;
  turns.reserve(n);
  for (int i = 0; i < n; ++i)
    turns.push_back({cosine_minus_1[i], sine[i]});
  return turns;
}

/// These need no arithmetic.
struct TurnsAtHand
{
  const particles::Particles<3> &p;
  Turn<3> operator[](int i) const { return Turn<3>::of(p, i); }
};
TurnsAtHand turns_of(const particles::Particles<3> &p)
{
  return {p};
}
} // namespace

template <int dim>
Vector<dim> StressedBody<dim>::force(const Bond<dim> &b, const BondMotion<dim> &m) const
{
  const auto &pressure = evaluation.pressure;
  if (b.joins_materials)
    return b.area * SeriesBond<dim>(b, m).traction(pressure[b.i], pressure[b.j]);
  return law_of(b).force(m.elastic, pressure[b.i], m.a_i, pressure[b.j], m.a_j);
}

template <int dim>
Wrench<dim> StressedBody<dim>::wrench_on(int i) const
{
  const auto &p = particles;
  Wrench<dim> sum;
  body().bonds().for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
    const bool first = b.i == i;
    const double sign = first ? 1 : -1;
    const double p_i = evaluation.pressure[b.i], p_j = evaluation.pressure[b.j];
    const BondMotion<dim> m = motion(b);
    const Spin<dim> bend = sign * bending_torque(b, p);
    if (b.joins_materials) {
      const SeriesBond<dim> series(b, m);
      const Vector<dim> t = series.traction(p_i, p_j);
      sum.force += sign * b.area * t;
      sum.torque += bend + (first ? series.torque_i(t, p_i) : series.torque_j(t, p_j));
      return;
    }
    const auto law = law_of(b);
    const Vector<dim> du = sign * m.du, f = sign * law.force(m.du, p_i, m.a_i, p_j, m.a_j);
    sum.force += f;
    sum.torque += law.add_torque(f, du, first ? p_i : p_j, first ? m.a_i : m.a_j, bend);
  });
  for (const auto *part : parts)
    part->add_force_on(i, p, evaluation, sum);
  return sum;
}

template <int dim>
void StressedBody<dim>::find_stresses(Components<n_strains<dim>> &stress) const
{
  for (auto &a : stress)
    a.assign(body().n_particles(), 0.);
  const auto turns = turns_of(particles);
  body().bonds().for_each_bond([&](BondId, const Bond<dim> &b) {
    const BondMotion<dim> m = motion(b, turns[b.i], turns[b.j]);
    const Vector<dim> f = force(b, m);
    add(stress, b.i, symmetric_product<dim>(m.a_i, f));
    add(stress, b.j, symmetric_product<dim>(m.a_j, -f));
  });
  for (const auto *part : parts)
    part->for_each_moment(particles, evaluation,
                          [&](int i, const Vector<dim> &lever, const Vector<dim> &f) {
                            add(stress, i, symmetric_product<dim>(lever, f));
                          });
  for (auto &a : stress)
    for (int i = 0; i < body().n_particles(); ++i)
      a[i] /= body().energy_weight(i) * particles.volume[i];
  body().edge().complete_stresses(particles, stress);
}

template <int dim>
std::vector<Strain<dim>> StressedBody<dim>::stresses_of(const std::vector<int> &few) const
{
  std::vector<Strain<dim>> stress(few.size(), Strain<dim>::Zero());
  // Most neighbours are among the few: a turn takes longer than the rest of a bond.
  std::vector<Turn<dim>> turns;
  for (const int i : few)
    turns.push_back(Turn<dim>::of(particles, i));
  const auto place_of = [&](int i) {
    const auto place = std::lower_bound(few.begin(), few.end(), i);
    return place != few.end() && *place == i ? int(place - few.begin()) : -1;
  };
  const auto turn_of = [&](int i) {
    const int k = place_of(i);
    return k >= 0 ? turns[k] : Turn<dim>::of(particles, i);
  };
  for (std::size_t k = 0; k < few.size(); ++k)
    body().bonds().for_each_bond_of(few[k], [&](BondId, const Bond<dim> &b) {
      const BondMotion<dim> m = motion(b, turn_of(b.i), turn_of(b.j));
      const Vector<dim> f = force(b, m);
      stress[k] += b.i == few[k] ? symmetric_product<dim>(m.a_i, f)
                                 : symmetric_product<dim>(m.a_j, Vector<dim>(-f));
    });
  for (const auto *part : parts)
    part->for_each_moment(particles, evaluation,
                          [&](int i, const Vector<dim> &lever, const Vector<dim> &f) {
                            if (const int k = place_of(i); k >= 0)
                              stress[k] += symmetric_product<dim>(lever, f);
                          });
  for (std::size_t k = 0; k < few.size(); ++k)
    stress[k] /= body().energy_weight(few[k]) * particles.volume[few[k]];
  return stress;
}

template <int dim>
double StressedBody<dim>::max_tension(const std::vector<int> &of) const
{
  double largest = 0;
  const auto turns = turns_of(particles);
  for (const int i : of)
    body().bonds().for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
      const Vector<dim> f = force(b, motion(b, turns[b.i], turns[b.j]));
      // No tension is larger than the force: its direction is looked at only where it could count.
      if (f.norm() > largest * b.weight * b.area)
        largest = std::max(largest,
                           f.dot(present_normal(b, turns[b.i], turns[b.j])) / (b.weight * b.area));
    });
  return largest;
}

template struct StressedBody<2>;
template struct StressedBody<3>;
} // namespace ligament::dem
