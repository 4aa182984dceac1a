// A break changes forces near it only: they are the mean of those of the whole body before it and
// after it, whatever acts beside bonds.
#include "core/extremes.h"
#include "tests/unit/dem/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace ligament::dem::testing
{
namespace
{
template <typename D>
struct Breaking : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Breaking, Dimensions);

/// With a second support, at the other end.
template <int dim>
std::vector<core::BoundaryLoad<dim>> pull_and_press_and_hold()
{
  auto loads = pull_and_press<dim>();
  loads.resize(3);
  loads[2].boundary = 0, loads[2].value[0] = -0.02;
  loads[2].kind = core::BoundaryLoad<dim>::Kind::displacement;
  return loads;
}

template <int dim>
struct Forces
{
  Components<dim> force;
  Components<n_spins<dim>> torque;
  Vec<2 * dim> reaction; // of both supports
};

template <int dim>
struct Body
{
  Packing<dim> packing = ragged_lattice<dim>(4, 7);
  Materials materials = DemMaterial{1., 0.3, 1., PlaneMode::strain, 0.4};
  std::vector<double> weights;
  bool flows = false;

  std::unique_ptr<ManyBodyForce<dim>> make(const FractureLaw &law = {}) const
  {
    auto all = materials;
    if (flows) {
      YieldCurve curve;
      curve.initial = 0.02, curve.hardening = 0.1;
      DemMaterial material = materials.base();
      material.plasticity = VonMisesFlow{curve};
      all = material;
    }
    auto force =
        std::make_unique<ManyBodyForce<dim>>(packing, all, pull_and_press_and_hold<dim>(), law);
    if (!weights.empty())
      force->set_energy_weights(weights);
    return force;
  }

  Forces<dim> at(ManyBodyForce<dim> &force, Particles<dim> &p) const
  {
    force.compute(p, 1.);
    Forces<dim> forces{p.force, p.torque, {}};
    forces.reaction << force.reaction(0), force.reaction(2);
    return forces;
  }

  void expect_mean() const
  {
    auto p = at_rest(packing, materials.base());
    disturb<dim>(p, packing.spacing, 0.05, Spin<dim>::Constant(0.3), 3);
    for (int i = 0; i < p.size(); ++i)
      p.velocity[0][i] = 1e-3 * (i % 5);
    const auto intact = make();
    const Forces<dim> before = at(*intact, p);
    std::vector<int> all(packing.size());
    std::iota(all.begin(), all.end(), 0);
    // Up to a share of 0.4 of the largest tension, more than one bond breaks.
    const auto breaking =
        make({FractureLaw::Criterion::face_tension, 0.4 * intact->max_tension(p, all)});
    const Forces<dim> mean = at(*breaking, p);
    ASSERT_GT(breaking->broken_bonds().size(), 1u);
    if (flows) {
      ASSERT_GT(breaking->plastic_dissipation(), 0);
    }
    ASSERT_LT(long(breaking->broken_bonds().size()), intact->n_bonds() / 2);

    // Nothing moved before it; over the next step, half as long, its half is half as large.
    const double booked = breaking->breaking_step_error();
    ASSERT_NE(booked, 0);

    std::vector<std::int64_t> ids(all.begin(), all.end());
    const core::Names names(ids);
    core::State state;
    p.save(state, names);
    breaking->save(state, names, p);
    const auto broken = make();
    broken->load(state, names, p);
    const Forces<dim> after = at(*broken, p);
    double largest = 0, change = 0;
    const auto compare = [&](double m, double b, double a) {
      largest = std::max({largest, std::abs(a), std::abs(b)});
      keep_largest(change, std::abs(a - b));
      return std::abs(m - (a + b) / 2);
    };
    double worst = 0;
    for (int i = 0; i < packing.size(); ++i) {
      for (int c = 0; c < dim; ++c)
        keep_largest(worst, compare(mean.force[c][i], before.force[c][i], after.force[c][i]));
      for (int c = 0; c < n_spins<dim>; ++c)
        worst =
            std::max(worst, compare(mean.torque[c][i], before.torque[c][i], after.torque[c][i]));
    }
    ASSERT_GT(change, 0.01 * largest);
    constexpr double round_off = 1e-12; // some hundred operations
    EXPECT_LT(worst, round_off * largest);
    breaking->compute(p, 1.5);
    EXPECT_NEAR(breaking->breaking_step_error(), booked / 2, 1e-3 * std::abs(booked));

    // What the supports feel is what they feel after it.
    EXPECT_LT((mean.reaction - after.reaction).norm(), round_off * largest);
    EXPECT_GT((before.reaction - after.reaction).norm(), 1e-4 * largest);
  }
};

TYPED_TEST(Breaking, ForcesAreTheMeanOfBeforeAndAfter)
{
  Body<TypeParam::value>().expect_mean();
}

TYPED_TEST(Breaking, AlsoWithEnergyWeights)
{
  Body<TypeParam::value> body;
  for (int i = 0; i < body.packing.size(); ++i)
    body.weights.push_back(0.4 + 0.6 * (i % 3) / 2.);
  body.expect_mean();
}

TYPED_TEST(Breaking, AlsoBetweenMaterials)
{
  Body<TypeParam::value> body;
  std::vector<int> of;
  for (int i = 0; i < body.packing.size(); ++i)
    of.push_back(i % 4 < 2);
  body.materials =
      Materials({{1., 0.3, 1., PlaneMode::strain, 0.4}, {3., 0.2, 1., PlaneMode::strain, 0.4}}, of);
  body.expect_mean();
}

TYPED_TEST(Breaking, AlsoAmongPlasticStrains)
{
  Body<TypeParam::value> body;
  body.flows = true;
  body.expect_mean();
}

// Ranks, and those who go on from a state, rely on it at the end of each step.
TYPED_TEST(Breaking, ContactsOfBrokenFacesAreAmongTheOthersByName)
{
  constexpr int dim = TypeParam::value;
  Body<dim> body;
  for (std::size_t k = 0; k < body.packing.faces.size(); k += 7)
    body.packing.faces[k].cracked = true;
  auto p = at_rest(body.packing, body.materials.base());
  disturb<dim>(p, body.packing.spacing, 0.05, Spin<dim>::Constant(0.3), 3);
  std::vector<int> all(body.packing.size());
  std::iota(all.begin(), all.end(), 0);
  const auto intact = body.make();
  body.at(*intact, p);
  const auto breaking =
      body.make({FractureLaw::Criterion::face_tension, 0.4 * intact->max_tension(p, all)});
  body.at(*breaking, p);
  const auto names = [](const ManyBodyForce<dim> &force) {
    std::vector<std::array<std::int64_t, 3>> found;
    for (const auto &contact : force.contacts().all())
      found.push_back(contact.name);
    return found;
  };
  const auto cracked = names(*intact), now = names(*breaking);
  ASSERT_EQ(now.size(), cracked.size() + breaking->broken_bonds().size());
  std::int64_t first = body.packing.size();
  for (const auto &b : breaking->broken_bonds())
    first = std::min<std::int64_t>({first, b.i, b.j});
  ASSERT_LT(first, cracked.back()[0]) << "none came before others";
  EXPECT_TRUE(std::is_sorted(now.begin(), now.end()));

  std::vector<std::int64_t> ids(all.begin(), all.end());
  core::State state;
  p.save(state, core::Names(ids));
  breaking->save(state, core::Names(ids), p);
  const auto resumed = body.make();
  resumed->load(state, core::Names(ids), p);
  EXPECT_EQ(names(*resumed), now);
}
} // namespace
} // namespace ligament::dem::testing
