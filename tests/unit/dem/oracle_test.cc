// The production kernel agrees with the plain oracle in random states with broken faces.
#include "core/extremes.h"
#include "tests/oracle/many_body_oracle.h"
#include "tests/unit/dem/cases.h"

namespace ligament::dem::testing
{
template <typename C>
struct AgainstOracle : ::testing::Test
{
};
TYPED_TEST_SUITE(AgainstOracle, Cases);

TYPED_TEST(AgainstOracle, SameForcesAndEnergyInRandomStatesWithBrokenFaces)
{
  constexpr int dim = TypeParam::dim;
  auto packing = packings::make_lattice_packing<dim>(box<TypeParam>(dim == 2 ? 24 : 9));
  std::mt19937 random(3);
  for (auto &face : packing.faces) // leaves rows with every bond, and some with few
    face.cracked = packing.centre[1][face.i] > 0 && random() % 5 == 0;
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress})
    for (const double nu : {-0.2, 0., 0.3, 0.45}) {
      DemMaterial material{3., nu, 1, plane, 0};
      ManyBodyForce<dim> force(packing, material, {});
      const oracle::ManyBodyOracle<dim> oracle(packing, 3., nu, plane);
      Particles<dim> p;
      packings::fill_particles(packing, 1., p);
      Spin<dim> turn = Spin<dim>::Constant(1.3);
      disturb<dim>(p, packing.spacing, 0.1, turn, 5);
      // Swollen, so that broken faces stay apart: the oracle knows no contact.
      for (int i = 0; i < p.size(); ++i)
        for (int c = 0; c < dim; ++c)
          p.displacement[c][i] =
              1.4 * (p.displacement[c][i] + p.reference[c][i]) - p.reference[c][i];
      auto q = p;
      force.compute(p, 0);
      const double energy = oracle.compute(q);
      EXPECT_NEAR(force.potential_energy(p), energy, 1e-12 * energy);
      double scale = 0, torque_scale = 0;
      for (int i = 0; i < p.size(); ++i) {
        keep_largest(scale, get(q.force, i).norm());
        keep_largest(torque_scale, get(q.torque, i).norm());
      }
      for (int i = 0; i < p.size(); ++i) {
        ASSERT_LT((get(p.force, i) - get(q.force, i)).norm(), 1e-12 * scale);
        ASSERT_LT((get(p.torque, i) - get(q.torque, i)).norm(), 1e-12 * torque_scale);
      }
    }
}

TEST(Sine, RoundOffForAnyAngle)
{
  std::vector<double> angle;
  for (int i = -40000; i <= 40000; ++i)
    angle.push_back(i * 2.5e-4 * (1 + 1e-3 * std::abs(i)));
  angle.push_back(1e-9);
  std::vector<double> c(angle.size()), s(angle.size());
  cosine_minus_1_and_sine(angle.data(), c.data(), s.data(), int(angle.size()));
  for (std::size_t i = 0; i < angle.size(); ++i) {
    const double half = std::sin(angle[i] / 2);
    EXPECT_NEAR(s[i], std::sin(angle[i]), 4e-16) << angle[i];
    EXPECT_NEAR(c[i], -2 * half * half, 4e-16 + 4e-16 * half * half);
  }
  EXPECT_NEAR(c.back(), -5e-19, 5e-34); // no cancellation at small angles
}
} // namespace ligament::dem::testing
