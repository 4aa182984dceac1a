// Looks at states in which the body does not stay: for a solver that seeks its equilibrium.
#include "dem/bond_law.h"
#include "dem/linear_terms.h"
#include "dem/many_body_force.h"

namespace ligament::dem
{
template <int dim>
void ManyBodyForce<dim>::compute_trial(Particles &p, double time, double noted_share)
{
  core::require(!strains_.has_law(), "bodies that flow have no trial states");
  core::require(!fracture().falls(), "bodies whose faces fall in time have no trial states");
  core::require(!rebonded_.is_on(), "bodies whose faces are bonded again have no trial states");
  set_loads(time);
  search_.ask_trial(trial_, noted_share);
  trial_.has_loads = true;
  find_other_pressures(p, trial_);
  follow_openings(p, trial_, [&] { return cohesive_.try_to_open(p, trial_); });
  find_forces_under(p, trial_);
  touching_ = contacts_.add_trial_forces(p);
  evaluation_.reactions = trial_.reactions;
}

// Pressures at interfaces are solved for together, each face knows those of its own particles.
template <int dim>
void ManyBodyForce<dim>::follow_openings(const Particles &p, Evaluation<dim> &e,
                                         const std::function<double()> &open) const
{
  constexpr int most = 100;
  constexpr double round_off = 1e-14; // of the reach of a face
  for (int round = 0; round < most && open() > round_off && softens_at_interfaces(); ++round)
    find_other_pressures(p, e);
}

template <int dim>
double ManyBodyForce<dim>::trial_share(const Particles &p) const
{
  return search_.largest_share(stressed(p, trial_));
}

template <int dim>
void ManyBodyForce<dim>::compute_bonds(Particles &p, bool has_loads)
{
  Evaluation<dim> &e = energy_evaluation_;
  e.has_loads = has_loads;
  const auto openings = cohesive_.openings();
  if (!has_loads)
    cohesive_.put_back(std::vector<Opening<dim>>(openings.size(), {Vector<dim>::Zero()}));
  find_other_pressures(p, e);
  if (has_loads)
    follow_openings(p, e, [&] { return cohesive_.open_to_first_order(p, e); });
  find_forces_under(p, e);
  cohesive_.put_back(openings);
  e.has_loads = true;
  jumps_.show(true);
}

template <int dim>
void ManyBodyForce<dim>::add_touching(Particles &p)
{
  const auto moved = [&](int i, const Vector<dim> &lever) -> Vector<dim> {
    if constexpr (dim == 2)
      return get(p.velocity, i) + p.spin[0][i] * Vector<2>(-lever[1], lever[0]);
    else
      return get(p.velocity, i) + get(p.spin, i).cross(lever);
  };
  for (const auto &c : touching_) {
    const Vector<dim> f = c.stiffness * c.answer(moved(c.j, c.lever_j) - moved(c.i, c.lever_i));
    add(p.force, c.i, f);
    add(p.force, c.j, Vector<dim>(-f));
    add(p.torque, c.i, cross(c.lever_i, f));
    add(p.torque, c.j, cross(c.lever_j, Vector<dim>(-f)));
  }
}

// A bond between materials as one of its two sides in series, without the volumes; of one that
// softens what it has lost.
template <int dim>
void ManyBodyForce<dim>::add_other_tangent(
    const Particles &p, const std::function<void(const particles::QuadraticTerm<dim> &)> &add) const
{
  constexpr int dofs = n_particle_dofs<dim>;
  particles::QuadraticTerm<dim> term;
  body_.bonds().for_each_interface([&](BondId, const Bond<dim> &b) {
    set_bond_rows(b, p, term);
    const double compliance =
        b.lever_i.dot(b.normal) / (2 * b.shear_i) - b.lever_j.dot(b.normal) / (2 * b.shear_j);
    term.stiffness.head(dim).setConstant(b.weight * b.area / compliance);
    add(term);
  });
  for (const auto &[name, face] : cohesive_.all()) {
    constexpr double least = 0.01; // what holds its particles beside it counts, too
    const auto left = cohesive_.softness(face, p);
    set_bond_rows(face.bond, p, term);
    if (left.opens)
      term.kind = particles::QuadraticTerm<dim>::Kind::softening;
    term.stiffness.head(dim).setConstant(-left.shear * (1 - std::max(left.share, least)));
    term.stiffness.tail(n_spins<dim>) *= -(1 - std::max(left.bending_share, least));
    add(term);
  }
  term.kind = particles::QuadraticTerm<dim>::Kind::contact;
  for (const auto &c : touching_) {
    term.location = get(p.reference, c.i) + c.lever_i;
    term.members = {c.i, c.j};
    const Eigen::Matrix<double, dim, dim> answers =
        c.sticks ? Eigen::Matrix<double, dim, dim>(Eigen::Matrix<double, dim, dim>::Identity())
                 : Eigen::Matrix<double, dim, dim>(c.normal * c.normal.transpose());
    term.rows.setZero(dim, 2 * dofs);
    term.rows.template leftCols<dofs>() = answers * opening_rows<dim>(c.lever_i, -1);
    term.rows.template rightCols<dofs>() = answers * opening_rows<dim>(c.lever_j, 1);
    term.stiffness.setConstant(dim, c.stiffness);
    add(term);
  }
}

template <int dim>
void ManyBodyForce<dim>::resume_at(double time)
{
  core::require(ranks().is_one(), "equilibria are found in one process");
  broken_.forget_step();
  last_time_ = time_ = time;
  contacts_.forget_steps();
  cohesive_.expect_a_jump();
}

// The rest of the class is instantiated in its own file.
template void ManyBodyForce<2>::compute_trial(Particles &, double, double);
template void ManyBodyForce<3>::compute_trial(Particles &, double, double);
template double ManyBodyForce<2>::trial_share(const Particles &) const;
template double ManyBodyForce<3>::trial_share(const Particles &) const;
template void ManyBodyForce<2>::compute_bonds(Particles &, bool);
template void ManyBodyForce<3>::compute_bonds(Particles &, bool);
template void ManyBodyForce<2>::add_touching(Particles &);
template void ManyBodyForce<3>::add_touching(Particles &);
template void ManyBodyForce<2>::add_other_tangent(
    const Particles &, const std::function<void(const particles::QuadraticTerm<2> &)> &) const;
template void ManyBodyForce<3>::add_other_tangent(
    const Particles &, const std::function<void(const particles::QuadraticTerm<3> &)> &) const;
template void ManyBodyForce<2>::resume_at(double);
template void ManyBodyForce<3>::resume_at(double);
} // namespace ligament::dem
