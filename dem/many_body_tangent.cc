// What the coupler asks of the many-body law: its energy linearised, its faces, and tensors.
#include "dem/laws/linear_bond.h"
#include "dem/many_body_force.h"
#include "dem/partial_many_body.h"
#include "dem/surface_law.h"

namespace ligament::dem
{
template <int dim>
void ManyBodyForce<dim>::add_tangent(
    const Particles &particles,
    const std::function<void(const particles::QuadraticTerm<dim> &)> &add) const
{
  using Term = particles::QuadraticTerm<dim>;
  constexpr int dofs = n_particle_dofs<dim>, spins = n_spins<dim>;
  const auto place = [&](int i, const Vector<dim> &lever) -> Vector<dim> {
    return get(particles.reference, i) + lever;
  };

  Term term;
  bonds_.for_each_bond([&](BondId, const Bond<dim> &b) {
    if (b.joins_materials)
      return;
    term.kind = Term::Kind::bond;
    term.location = place(b.i, b.lever_i);
    term.members = {b.i, b.j};
    term.rows.setZero(dim + spins, 2 * dofs);
    term.rows.template topLeftCorner<dim, dofs>() = opening_rows<dim>(b.lever_i, -1);
    term.rows.template topRightCorner<dim, dofs>() = opening_rows<dim>(b.lever_j, 1);
    term.rows.template block<spins, spins>(dim, dim) = -bending_rows(b);
    term.rows.template block<spins, spins>(dim, dofs + dim) = bending_rows(b);
    term.stiffness.resize(dim + spins);
    term.stiffness.head(dim).setConstant(law_of(b).shear);
    term.stiffness.tail(spins) = bending_stiffness(b);
    add(term);
  });

  for (const auto &wall : surface_.walls()) {
    term.kind = Term::Kind::wall;
    term.location = place(wall.i, wall.lever);
    term.members = {wall.i};
    term.rows = wall.prescribed.asDiagonal() * opening_rows<dim>(wall.lever, -1);
    term.stiffness.setConstant(dim, law_of(wall).shear);
    add(term);
  }

  if (materials_.has_no_dilatation())
    return;
  std::vector<std::vector<int>> walls_of(bonds_.n_particles());
  for (std::size_t w = 0; w < surface_.walls().size(); ++w)
    walls_of[surface_.walls()[w].i].push_back(int(w));
  for (int i = 0; i < bonds_.n_particles(); ++i) {
    if (interfaces_.is_member(i))
      continue;
    term.kind = Term::Kind::volumetric;
    term.location = place(i, Vector<dim>::Zero());
    term.members = {i};
    bonds_.for_each_bond_of(
        i, [&](BondId, const Bond<dim> &b) { term.members.push_back(b.i == i ? b.j : b.i); });
    term.rows.setZero(1, term.members.size() * dofs);
    int member = 1;
    bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
      const bool first = b.i == i;
      const Vector<dim> own = first ? b.lever_i : b.lever_j, other = first ? b.lever_j : b.lever_i;
      const auto weight = (law_of(b).area_r / particles.volume[i] * own.transpose()).eval();
      term.rows.template middleCols<dofs>(0) += weight * opening_rows<dim>(own, -1);
      term.rows.template middleCols<dofs>(member++ * dofs) += weight * opening_rows<dim>(other, 1);
    });
    for (const int w : walls_of[i]) {
      const auto &wall = surface_.walls()[w];
      const auto weight =
          (law_of(wall).area_r / particles.volume[i] * pressed_along(wall).transpose()).eval();
      term.rows.template middleCols<dofs>(0) += weight * opening_rows<dim>(wall.lever, -1);
    }
    term.stiffness.setConstant(1,
                               lambda_per_volume_[i] * particles.volume[i] * particles.volume[i]);
    add(term);
  }
}

template <int dim>
void ManyBodyForce<dim>::for_each_face(
    const Particles &particles,
    const std::function<void(const particles::FaceView<dim> &)> &visit) const
{
  const auto both_sides = [&](const Bond<dim> &b, bool bonded) {
    const Vector<dim> centroid = get(particles.reference, b.i) + b.lever_i;
    visit({b.i, b.j, b.normal, b.area, centroid, bonded});
    visit({b.j, b.i, -b.normal, b.area, centroid, bonded});
  };
  bonds_.for_each_bond([&](BondId, const Bond<dim> &b) { both_sides(b, true); });
  for (const auto &contact : contacts_.all())
    if (contact.from_face)
      both_sides(contact.face, false);
  for (const auto &face : boundary_faces_)
    visit({face.i, -1, face.normal, face.area,
           Vector<dim>(get(particles.reference, face.i) + face.lever), false});
}

template <int dim>
std::unique_ptr<particles::PartialForce<dim>>
ManyBodyForce<dim>::part(const Particles &particles, const std::vector<int> &members,
                         const typename particles::ParticleForce<dim>::TermShare &share) const
{
  std::vector<int> index(bonds_.n_particles(), -1);
  for (std::size_t k = 0; k < members.size(); ++k)
    index[members[k]] = int(k);
  std::vector<double> volume_share(members.size(), 0.), lambda_per_volume(members.size(), 0.);
  if (!materials_.has_no_dilatation())
    for (std::size_t k = 0; k < members.size(); ++k) {
      const int i = members[k];
      std::vector<int> of = {i};
      bonds_.for_each_bond_of(
          i, [&](BondId, const Bond<dim> &b) { of.push_back(b.i == i ? b.j : b.i); });
      volume_share[k] = share(get(particles.reference, i), of);
      lambda_per_volume[k] = lambda_per_volume_[i];
    }
  std::vector<typename PartialManyBody<dim>::SharedBond> bonds;
  bonds_.for_each_bond([&](BondId, const Bond<dim> &b) {
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

template <int dim>
void ManyBodyForce<dim>::stresses(const Particles &particles,
                                  Components<n_strains<dim>> &stress) const
{
  Workspace work;
  find_pressure(particles, work);
  for (auto &a : stress)
    a.assign(bonds_.n_particles(), 0.);
  bonds_.for_each_bond([&](BondId, const Bond<dim> &b) {
    const BondMotion<dim> m = motion(b, particles, work);
    const Vector<dim> f = bond_force(b, m, work.pressure);
    add(stress, b.i, symmetric_product<dim>(m.a_i, f));
    add(stress, b.j, symmetric_product<dim>(m.a_j, -f));
  });
  surface_.add_moments(particles, work.pressure, stress);
  contacts_.add_moments(particles, stress);
  for (auto &a : stress)
    for (int i = 0; i < bonds_.n_particles(); ++i)
      a[i] /= energy_weight(i) * particles.volume[i];
  edge_.complete_stresses(particles, stress);
}

template <int dim>
double ManyBodyForce<dim>::max_tension(const Particles &particles, const std::vector<int> &of) const
{
  Workspace work;
  find_pressure(particles, work);
  double largest = 0;
  for (const int i : of)
    bonds_.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
      const Vector<dim> f = bond_force(b, motion(b, particles, work), work.pressure);
      // No tension is larger than the force: its direction is looked at only where it could count.
      if (f.norm() > largest * b.weight * b.area) {
        const Vector<dim> n =
            present_normal(b, turn(particles, work, b.i), turn(particles, work, b.j));
        largest = std::max(largest, f.dot(n) / (b.weight * b.area));
      }
    });
  return largest;
}

// The virtual members are instantiated here, the rest of the class in its own file.
template void ManyBodyForce<2>::add_tangent(
    const Particles &, const std::function<void(const particles::QuadraticTerm<2> &)> &) const;
template void ManyBodyForce<3>::add_tangent(
    const Particles &, const std::function<void(const particles::QuadraticTerm<3> &)> &) const;
template void
ManyBodyForce<2>::for_each_face(const Particles &,
                                const std::function<void(const particles::FaceView<2> &)> &) const;
template void
ManyBodyForce<3>::for_each_face(const Particles &,
                                const std::function<void(const particles::FaceView<3> &)> &) const;
template std::unique_ptr<particles::PartialForce<2>>
ManyBodyForce<2>::part(const Particles &, const std::vector<int> &,
                       const particles::ParticleForce<2>::TermShare &) const;
template std::unique_ptr<particles::PartialForce<3>>
ManyBodyForce<3>::part(const Particles &, const std::vector<int> &,
                       const particles::ParticleForce<3>::TermShare &) const;
template void ManyBodyForce<2>::stresses(const Particles &, Components<3> &) const;
template void ManyBodyForce<3>::stresses(const Particles &, Components<6> &) const;
template double ManyBodyForce<2>::max_tension(const Particles &, const std::vector<int> &) const;
template double ManyBodyForce<3>::max_tension(const Particles &, const std::vector<int> &) const;
} // namespace ligament::dem
