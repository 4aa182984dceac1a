// What the coupler asks of the many-body law: its energy linearised, its faces, and tensors.
#include "dem/linear_terms.h"
#include "dem/many_body_force.h"
#include "dem/partial_many_body.h"
#include "dem/surface_law.h"

#include <algorithm>
#include <map>

namespace ligament::dem
{
namespace
{
/// Whether a particle is among some, or all.
class Asked
{
public:
  Asked(const std::vector<int> *of, int n_particles)
  {
    if (!of)
      return;
    is_asked_.assign(n_particles, 0);
    for (const int i : *of)
      is_asked_[i] = 1;
  }
  bool has(int i) const { return is_asked_.empty() || is_asked_[i]; }

private:
  std::vector<char> is_asked_; // empty: all
};
} // namespace

template <int dim>
void ManyBodyForce<dim>::add_tangent(
    const Particles &particles,
    const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
    const std::vector<int> *of) const
{
  const Asked asked(of, body_.n_particles());
  using Term = particles::QuadraticTerm<dim>;
  constexpr int dofs = n_particle_dofs<dim>;
  const auto place = [&](int i, const Vector<dim> &lever) -> Vector<dim> {
    return get(particles.reference, i) + lever;
  };

  Term term;
  body_.bonds().for_each_bond_of_some(of, [&](BondId, const Bond<dim> &b) {
    if (b.joins_materials)
      return;
    set_bond_rows(b, particles, term);
    term.stiffness.head(dim).setConstant(law_of(b).shear);
    add(term);
  });

  for (const auto &wall : surface_.walls()) {
    if (!asked.has(wall.i))
      continue;
    term.kind = Term::Kind::wall;
    term.location = place(wall.i, wall.lever);
    term.members = {wall.i};
    term.rows = wall.prescribed.asDiagonal() * opening_rows<dim>(wall.lever, -1);
    term.stiffness.setConstant(dim, law_of(wall).shear);
    add(term);
  }

  if (!body_.has_dilatation())
    return;
  std::multimap<int, const WallFace<dim> *> walls_of;
  for (const auto &wall : surface_.walls())
    walls_of.insert({wall.i, &wall});
  const auto add_volume = [&](int i) {
    if (interfaces_.is_member(i))
      return;
    term.kind = Term::Kind::volumetric;
    term.location = place(i, Vector<dim>::Zero());
    term.members = {i};
    body_.bonds().for_each_bond_of(
        i, [&](BondId, const Bond<dim> &b) { term.members.push_back(b.i == i ? b.j : b.i); });
    term.rows.setZero(1, term.members.size() * dofs);
    int member = 1;
    body_.bonds().for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
      const bool first = b.i == i;
      const Vector<dim> own = first ? b.lever_i : b.lever_j, other = first ? b.lever_j : b.lever_i;
      const auto weight = (law_of(b).area_r / particles.volume[i] * own.transpose()).eval();
      term.rows.template middleCols<dofs>(0) += weight * opening_rows<dim>(own, -1);
      term.rows.template middleCols<dofs>(member++ * dofs) += weight * opening_rows<dim>(other, 1);
    });
    const auto [first, last] = walls_of.equal_range(i);
    for (auto w = first; w != last; ++w) {
      const WallFace<dim> &wall = *w->second;
      const auto weight =
          (law_of(wall).area_r / particles.volume[i] * pressed_along(wall).transpose()).eval();
      term.rows.template middleCols<dofs>(0) += weight * opening_rows<dim>(wall.lever, -1);
    }
    term.stiffness.setConstant(1, body_.lambda_per_volume()[i] * particles.volume[i] *
                                      particles.volume[i]);
    add(term);
  };
  if (!of) {
    for (int i = 0; i < body_.n_particles(); ++i)
      add_volume(i);
    return;
  }
  std::vector<int> entered = *of; // neighbours are in the volumes of each other
  body_.bonds().for_each_bond_of_some(of, [&](BondId, const Bond<dim> &b) {
    entered.insert(entered.end(), {b.i, b.j});
  });
  std::sort(entered.begin(), entered.end());
  entered.erase(std::unique(entered.begin(), entered.end()), entered.end());
  for (const int i : entered)
    add_volume(i);
}

template <int dim>
void ManyBodyForce<dim>::for_each_face(
    const Particles &particles, const std::function<void(const particles::FaceView<dim> &)> &visit,
    const std::vector<int> *of) const
{
  const Asked asked(of, body_.n_particles());
  const auto both_sides = [&](const Bond<dim> &b, bool bonded, bool again) {
    const Vector<dim> centroid = get(particles.reference, b.i) + b.lever_i;
    if (asked.has(b.i))
      visit({b.i, b.j, b.normal, b.area, centroid, bonded, again});
    if (asked.has(b.j))
      visit({b.j, b.i, -b.normal, b.area, centroid, bonded, again});
  };
  body_.bonds().for_each_bond_of_some(
      of, [&](BondId, const Bond<dim> &b) { both_sides(b, true, false); });
  for (const auto &contact : contacts_.all())
    if (contact.from_face || contact.is_bonded)
      both_sides(contact.face, contact.is_bonded, contact.is_bonded);
  for (const auto &face : body_.boundary_faces())
    if (asked.has(face.i))
      visit({face.i, -1, face.normal, face.area,
             Vector<dim>(get(particles.reference, face.i) + face.lever), false});
}

template <int dim>
std::unique_ptr<particles::PartialForce<dim>>
ManyBodyForce<dim>::part(const Particles &particles, const std::vector<int> &members,
                         const typename particles::ParticleForce<dim>::TermShare &share) const
{
  std::vector<int> index(body_.n_particles(), -1);
  for (std::size_t k = 0; k < members.size(); ++k)
    index[members[k]] = int(k);
  std::vector<double> volume_share(members.size(), 0.), lambda_per_volume(members.size(), 0.);
  if (body_.has_dilatation())
    for (std::size_t k = 0; k < members.size(); ++k) {
      const int i = members[k];
      std::vector<int> of = {i};
      body_.bonds().for_each_bond_of(
          i, [&](BondId, const Bond<dim> &b) { of.push_back(b.i == i ? b.j : b.i); });
      volume_share[k] = share(get(particles.reference, i), of);
      lambda_per_volume[k] = body_.lambda_per_volume()[i];
    }
  std::vector<typename PartialManyBody<dim>::SharedBond> bonds;
  std::vector<int> ascending = members;
  std::sort(ascending.begin(), ascending.end());
  body_.bonds().for_each_bond_of_some(&ascending, [&](BondId, const Bond<dim> &b) {
    if (index[b.i] < 0 || index[b.j] < 0)
      return;
    Bond<dim> renumbered = b;
    renumbered.i = index[b.i];
    renumbered.j = index[b.j];
    const double s = share(Vector<dim>(get(particles.reference, b.i) + b.lever_i), {b.i, b.j});
    if (s != 0 || volume_share[renumbered.i] != 0 || volume_share[renumbered.j] != 0)
      bonds.push_back({renumbered, s});
  });
  return std::make_unique<PartialManyBody<dim>>(std::move(bonds), std::move(volume_share),
                                                std::move(lambda_per_volume));
}

// The virtual members are instantiated here, the rest of the class in its own file.
template void
ManyBodyForce<2>::add_tangent(const Particles &,
                              const std::function<void(const particles::QuadraticTerm<2> &)> &,
                              const std::vector<int> *) const;
template void
ManyBodyForce<3>::add_tangent(const Particles &,
                              const std::function<void(const particles::QuadraticTerm<3> &)> &,
                              const std::vector<int> *) const;
template void
ManyBodyForce<2>::for_each_face(const Particles &,
                                const std::function<void(const particles::FaceView<2> &)> &,
                                const std::vector<int> *) const;
template void
ManyBodyForce<3>::for_each_face(const Particles &,
                                const std::function<void(const particles::FaceView<3> &)> &,
                                const std::vector<int> *) const;
template std::unique_ptr<particles::PartialForce<2>>
ManyBodyForce<2>::part(const Particles &, const std::vector<int> &,
                       const particles::ParticleForce<2>::TermShare &) const;
template std::unique_ptr<particles::PartialForce<3>>
ManyBodyForce<3>::part(const Particles &, const std::vector<int> &,
                       const particles::ParticleForce<3>::TermShare &) const;
} // namespace ligament::dem
