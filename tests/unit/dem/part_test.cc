// A body in parts: each steps its own particles and sees those within two bonds; forces, motion and
// sums have the bits of the whole body.
#include "packings/random_packing.h"
#include "particles/block_sum.h"
#include "particles/particle_solver.h"
#include "tests/unit/dem/cases.h"

namespace ligament::dem::testing
{
namespace
{
using particles::Part, particles::ParticleRanges, particles::ParticleSolver;

/// The ranges of a part that owns [begin, end), and of what is within one and two bonds of it.
template <int dim>
Part part_of(const ManyBodyForce<dim> &force, const Particles<dim> &p, int begin, int end)
{
  std::vector<int> distance(p.size(), 3);
  std::fill(distance.begin() + begin, distance.begin() + end, 0);
  for (int step = 0; step < 2; ++step) {
    const auto before = distance;
    force.for_each_face(p, [&](const particles::FaceView<dim> &face) {
      if (face.j >= 0)
        distance[face.i] = std::min(distance[face.i], before[face.j] + 1);
    });
  }
  const auto within = [&](int most) {
    ParticleRanges ranges;
    for (int i = 0; i < p.size(); ++i)
      if (distance[i] <= most) {
        if (!ranges.empty() && ranges.back().end == i)
          ++ranges.back().end;
        else
          ranges.push_back({i, i + 1});
      }
    return ranges;
  };
  Part part;
  part.owned = part.stepped = within(0);
  part.pressed = within(1);
  part.turned = within(2);
  return part;
}

template <int dim>
void expect_parts_to_be_the_whole(const Packing<dim> &packing, unsigned seed)
{
  const DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0};
  const auto make = [&] {
    auto p = at_rest(packing, material);
    disturb<dim>(p, packing.spacing, 1e-2, Spin<dim>::Constant(0.2), seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (auto &v : p.velocity)
      for (double &value : v)
        value = uniform(random);
    return ParticleSolver<dim>(
        std::move(p), std::make_unique<ManyBodyForce<dim>>(packing, material,
                                                           std::vector<core::BoundaryLoad<dim>>{}));
  };
  auto whole = make();
  const int n = whole.state.size();
  const double dt = 1e-3 * packing.spacing;
  whole.compute_forces(0);
  const auto energy = whole.potential_energy();
  const core::ExactSum kinetic = whole.kinetic_sum(dt);
  whole.kick(dt);
  whole.drift(dt);

  core::ExactSum kinetic_of_parts;
  double energy_of_parts = 0;
  const int block = particles::sum_block;
  ASSERT_GT(n, 5 * block);
  const std::vector<int> cuts = {0, block, (n / block - 1) * block, n};
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    auto own = make();
    const auto before = own.state;
    const auto &force = static_cast<const ManyBodyForce<dim> &>(*own.force);
    own.state.part = part_of(force, own.state, cuts[k], cuts[k + 1]);
    ASSERT_LT(particles::count(own.state.part.stepped), n);
    own.compute_forces(0);
    energy_of_parts += own.potential_energy();
    kinetic_of_parts.merge(own.kinetic_sum(dt));
    own.kick(dt);
    own.drift(dt);
    for (int i = 0; i < n; ++i) {
      const bool mine = i >= cuts[k] && i < cuts[k + 1];
      const auto &expected = mine ? whole.state : before;
      for (int c = 0; c < dim; ++c) {
        ASSERT_EQ(own.state.displacement[c][i], expected.displacement[c][i]) << i;
        ASSERT_EQ(own.state.velocity[c][i], expected.velocity[c][i]) << i;
      }
      for (int c = 0; c < n_spins<dim>; ++c)
        ASSERT_EQ(own.state.spin[c][i], expected.spin[c][i]) << i;
      for (int c = 0; c < Particles<dim>::n_rotations; ++c)
        ASSERT_EQ(own.state.rotation[c][i], expected.rotation[c][i]) << i;
    }
  }
  EXPECT_EQ(kinetic_of_parts.value(), kinetic.value());
  EXPECT_GT(kinetic.value(), 0);
  EXPECT_NEAR(energy_of_parts, energy, 4e-16 * energy); // three are rounded, and added
  EXPECT_GT(energy, 0);
}

template <typename C>
struct Parts : ::testing::Test
{
};
TYPED_TEST_SUITE(Parts, Cases);

TYPED_TEST(Parts, StepLikeTheWholeLattice)
{
  expect_parts_to_be_the_whole<TypeParam::dim>(
      packings::make_lattice_packing(box<TypeParam>(TypeParam::dim == 2 ? 24 : 8)), 11);
}

template <int dim>
void expect_random_parts_to_be_the_whole(double n)
{
  packings::RandomParameters<dim> random;
  random.spacing = 1;
  for (int c = 0; c < dim; ++c)
    random.upper[c] = n;
  expect_parts_to_be_the_whole<dim>(packings::make_random_packing(random).packing, 13);
}

TEST(RandomParts, StepLikeTheWhole2D)
{
  expect_random_parts_to_be_the_whole<2>(24);
}
TEST(RandomParts, StepLikeTheWhole3D)
{
  expect_random_parts_to_be_the_whole<3>(8);
}
} // namespace
} // namespace ligament::dem::testing
