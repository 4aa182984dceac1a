// Shares of the energy of atoms: against the whole, against differences, against the tangent.
#include "tests/unit/md/bodies.h"

#include <Eigen/Dense>

namespace ligament::md::testing
{
template <int dim>
using Share = typename particles::ParticleForce<dim>::TermShare;

/// Some smooth share of the place, with something of how many atoms a term has.
template <int dim>
double some_share(const Body<dim> &body, const Vector<dim> &x, const std::vector<int> &members)
{
  return 0.5 + 0.4 * std::sin(3 * x[0] / body.top[0] + x[1] / body.top[1]) +
         0.01 * double(members.size());
}

template <int dim>
std::vector<int> everybody(const Body<dim> &body)
{
  std::vector<int> all(body.atoms.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = int(all.size() - 1 - i); // in another order
  return all;
}

/// The atoms in the order of the part.
template <int dim>
particles::Particles<dim> of_part(const particles::Particles<dim> &atoms,
                                  const std::vector<int> &members)
{
  particles::Particles<dim> p;
  p.drop_orientations();
  p.resize(int(members.size()));
  for (std::size_t m = 0; m < members.size(); ++m)
    for (int c = 0; c < dim; ++c) {
      p.reference[c][m] = atoms.reference[c][members[m]];
      p.displacement[c][m] = atoms.displacement[c][members[m]];
    }
  return p;
}

/// With the energy and without.
template <int dim>
void expect_same_forces(const Body<dim> &body, particles::PartialForce<dim> &part,
                        particles::Particles<dim> &atoms)
{
  part.compute(atoms);
  const auto plain = atoms.force;
  atoms.force[0].assign(atoms.size(), 1.);
  part.compute_forces(atoms);
  EXPECT_LT(difference(atoms.force, plain, body.stiffness() * body.crystal.spacing()), 1e-13);
}

// Also where a compression brings the next shell into range.
template <int dim>
void expect_whole(Body<dim> body, double stretch)
{
  auto force = body.force();
  const auto members = everybody(body);
  const auto part = force.part(body.atoms, members,
                               [](const Vector<dim> &, const std::vector<int> &) { return 1.; });
  body.disturb(0.02 * body.crystal.spacing());
  const bool is_periodic = body.packing.period.norm() > 0;
  for (int c = 0; c < dim && !is_periodic; ++c)
    for (int i = 0; i < body.atoms.size(); ++i)
      body.atoms.displacement[c][i] += (stretch - 1) * body.atoms.reference[c][i];
  auto p = of_part(body.atoms, members);
  p.force[0].assign(p.size(), 1.);
  const double energy = part->compute(p);
  force.compute(body.atoms, 0);
  Components<dim> expected;
  for (int c = 0; c < dim; ++c)
    for (const int i : members)
      expected[c].push_back(body.atoms.force[c][i]);
  EXPECT_LT(difference(p.force, expected, body.stiffness() * body.crystal.spacing()), 1e-12);
  EXPECT_NEAR(energy, force.potential_energy(body.atoms),
              1e-14 * body.atoms.size() * std::abs(body.crystal.cohesive_energy()));
  EXPECT_EQ(part->compute(p), energy);
  expect_same_forces(body, *part, p);
}

TEST(PartialAtomsTest, ShareOneEverywhereIsTheWhole)
{
  for (const double stretch : {1., 0.95, 1.03}) {
    for (const Body<3> &body : bodies())
      expect_whole(body, stretch);
    expect_whole(plane_body(), stretch);
  }
}

template <int dim>
void expect_slopes(Body<dim> body)
{
  const auto force = body.force();
  const auto members = everybody(body);
  const auto part =
      force.part(body.atoms, members, [&](const Vector<dim> &x, const std::vector<int> &of) {
        return some_share<dim>(body, x, of);
      });
  const double d = body.crystal.spacing(), h = 1e-5 * d;
  EXPECT_EQ(part->compute(body.atoms), 0); // the reference is where energies begin
  body.disturb(0.03 * d);
  auto p = of_part(body.atoms, members);
  expect_same_forces(body, *part, p);
  part->compute(p);
  const auto forces = p.force;
  for (int i = 0; i < p.size(); i += 7)
    for (int c = 0; c < dim; ++c) {
      const double at = p.displacement[c][i];
      p.displacement[c][i] = at + h;
      const double above = part->compute(p);
      p.displacement[c][i] = at - h;
      const double below = part->compute(p);
      p.displacement[c][i] = at;
      // As of the whole force: third derivatives of tables.
      EXPECT_NEAR(-(above - below) / (2 * h) / (body.stiffness() * d),
                  forces[c][i] / (body.stiffness() * d), 1e-7);
    }
}

TEST(PartialAtomsTest, ForcesAreSlopesOfTheEnergy)
{
  for (const Body<3> &body : bodies())
    if (body.crystal.parameters().kind != CrystalKind::bcc) // the iron table is too rough
      expect_slopes(body);
  expect_slopes(plane_body());
}

// At the reference the change of the forces is that of the terms, each times its share.
template <int dim>
void expect_shared_tangent(Body<dim> body)
{
  const auto force = body.force();
  std::vector<int> members;
  for (int i = 0; i < body.atoms.size(); ++i)
    members.push_back(i);
  const auto share = [&](const Vector<dim> &x, const std::vector<int> &of) {
    return some_share<dim>(body, x, of);
  };
  const auto part = force.part(body.atoms, members, share);
  const int n = dim * body.atoms.size();
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  force.add_tangent(body.atoms, [&](const particles::QuadraticTerm<dim> &term) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(term.rows.rows(), n);
    for (std::size_t m = 0; m < term.members.size(); ++m)
      rows.middleCols(dim * term.members[m], dim) += term.rows.middleCols(int(m) * dim, dim);
    k += share(term.location, term.members) * rows.transpose() * term.stiffness.asDiagonal() * rows;
  });
  const double h = 1e-5 * body.crystal.spacing();
  for (int column = 0; column < n; column += 41) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(n);
    for (const double sign : {1., -1.}) {
      body.atoms.displacement[column % dim][column / dim] = sign * h;
      part->compute(body.atoms);
      for (int i = 0; i < n; ++i)
        change[i] -= sign * body.atoms.force[i % dim][i / dim] / (2 * h);
    }
    body.atoms.displacement[column % dim][column / dim] = 0;
    EXPECT_LT((change - k.col(column)).norm() / body.stiffness(), 1e-5); // as of the whole
  }
}

TEST(PartialAtomsTest, HasTheSharesOfTheTangent)
{
  for (const Body<3> &body : bodies())
    if (body.crystal.parameters().kind != CrystalKind::bcc)
      expect_shared_tangent(body);
  expect_shared_tangent(plane_body());
}

// Energies of small displacements and of their opposites are squares in the sum, surfaces pull
// linearly: differences of whole energies would know that of 1e-7 d to a few per cent.
TEST(PartialAtomsTest, KeepsTheDigitsOfSmallDisplacements)
{
  for (const Body<3> &body : bodies()) {
    const auto part = body.force().part(
        body.atoms, everybody(body),
        [&](const Vector<3> &x, const std::vector<int> &of) { return some_share<3>(body, x, of); });
    const auto stiffness_at = [&](double amplitude) {
      double sum = 0;
      for (const double sign : {1., -1.}) {
        Body<3> moved = body;
        moved.disturb(sign * amplitude * body.crystal.spacing());
        auto p = of_part(moved.atoms, everybody(body));
        sum += part->compute(p);
      }
      return sum / (amplitude * amplitude);
    };
    // The quartic part is some hundred times the square of the strain.
    EXPECT_NEAR(stiffness_at(1e-7) / stiffness_at(1e-5), 1, 1e-3);
  }
}

// Members alone matter; a term that reaches others has the share 0.
TEST(PartialAtomsTest, APartOfTheAtomsIsEnough)
{
  Body<2> body = plane_body();
  const auto force = body.force();
  const Vector<2> middle = body.top / 2;
  const double radius = 2.2 * body.crystal.spacing();
  std::vector<int> members;
  for (int i = 0; i < body.atoms.size(); ++i)
    if ((get(body.atoms.reference, i) - middle).norm() < radius + body.crystal.potential().cutoff())
      members.push_back(i);
  ASSERT_LT(int(members.size()), body.atoms.size());
  const auto share = [&](const Vector<2> &x, const std::vector<int> &) {
    return std::max(0., 1 - (x - middle).norm() / radius);
  };
  const auto some = force.part(body.atoms, members, share),
             all = force.part(body.atoms, everybody(body), share);
  body.disturb(0.02 * body.crystal.spacing());
  auto few = of_part(body.atoms, members), many = of_part(body.atoms, everybody(body));
  const double energy = some->compute(few);
  EXPECT_NEAR(energy, all->compute(many), 1e-14 * std::abs(body.crystal.cohesive_energy()));
  for (std::size_t m = 0; m < members.size(); ++m)
    EXPECT_LT((get(few.force, int(m)) - get(many.force, many.size() - 1 - members[m])).norm(),
              1e-13 * body.stiffness() * body.crystal.spacing());
}
} // namespace ligament::md::testing
