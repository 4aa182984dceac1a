// The kernel of irregular bonds agrees with the plain oracle on random packings, with every
// instruction set of the machine; a removed bond leaves no trace.
#include "core/dispatch.h"
#include "core/extremes.h"
#include "packings/random_packing.h"
#include "tests/oracle/many_body_oracle.h"
#include "tests/unit/dem/cases.h"

#include <hwy/highway.h>

namespace ligament::dem::testing
{
struct SliceKernel : ::testing::Test
{
  ~SliceKernel() override { hwy::SetSupportedTargetsForTest(0); }

  /// Numbers of particles that fill no slice, with faces cracked at random.
  template <int dim>
  static Packing<dim> packing(unsigned seed)
  {
    packings::RandomParameters<dim> random;
    random.spacing = 0.01;
    random.thickness = dim == 2 ? 0.7 : 1;
    random.size_ratio = 2;
    random.relaxation_sweeps = 2;
    random.upper = (dim == 2 ? 0.173 : 0.0617) * Vector<dim>::Ones();
    auto packing = packings::make_random_packing<dim>(random).packing;
    std::mt19937 numbers(seed);
    for (auto &face : packing.faces)
      face.cracked = numbers() % 20 == 0;
    return packing;
  }

  /// Turned, deformed at random, and swollen, so that nothing touches.
  template <int dim>
  static Particles<dim> state(const Packing<dim> &packing)
  {
    Particles<dim> p;
    packings::fill_particles(packing, 1., p);
    disturb<dim>(p, packing.spacing, 0.05, Spin<dim>::Constant(0.9), 5);
    for (int i = 0; i < p.size(); ++i)
      for (int c = 0; c < dim; ++c)
        p.displacement[c][i] = 1.5 * (p.displacement[c][i] + p.reference[c][i]) - p.reference[c][i];
    return p;
  }

  template <typename C>
  static void expect_close(const C &a, const C &b)
  {
    double scale = 0, error = 0;
    for (std::size_t c = 0; c < a.size(); ++c)
      for (std::size_t i = 0; i < a[c].size(); ++i) {
        keep_largest(scale, std::abs(b[c][i]));
        keep_largest(error, std::abs(a[c][i] - b[c][i]));
      }
    EXPECT_LT(error, 1e-13 * scale);
  }

  template <int dim>
  static void compare(double nu)
  {
    const auto packing = SliceKernel::packing<dim>(7);
    const DemMaterial material{3., nu, 1, PlaneMode::strain, 0};
    ManyBodyForce<dim> force(packing, material, {});
    auto p = state(packing);
    auto q = p;
    const double energy = oracle::ManyBodyOracle<dim>(packing, 3., nu).compute(q);
    for (const std::int64_t target : {HWY_EMU128, HWY_SCALAR, HWY_AVX2, HWY_AVX3}) {
      hwy::SetSupportedTargetsForTest(0);
      if (!(hwy::SupportedTargets() & target))
        continue;
      hwy::SetSupportedTargetsForTest(target);
      force.compute(p, 0);
      expect_close(p.force, q.force);
      expect_close(p.torque, q.torque);
      const auto first = p.force;
      force.compute(p, 0);
      EXPECT_EQ(p.force, first); // to the last bit
      EXPECT_NEAR(force.potential_energy(p), energy, 1e-13 * energy);
      EXPECT_EQ(force.potential_energy(p), force.potential_energy(p));
    }
  }

  /// Forces of the slices alone, at given pressures.
  template <int dim>
  static Particles<dim> forces(const BondSlices<dim> &slices, Particles<dim> p)
  {
    std::vector<double> lambda(p.size(), 2.), pressure(p.size(), 0.);
    LatticeArrays<dim> a{};
    for (int c = 0; c < dim; ++c) {
      a.displacement[c] = p.displacement[c].data();
      a.force[c] = p.force[c].data();
    }
    for (int c = 0; c < a.n_rotations; ++c)
      a.rotation[c] = p.rotation[c].data();
    for (int c = 0; c < n_spins<dim>; ++c)
      a.torque[c] = p.torque[c].data();
    a.lambda_per_volume = lambda.data();
    a.pressure = pressure.data();
    core::LargeArray records;
    std::vector<int> exceeded;
    slices.load(a, records);
    slices.add_pressures(a, records);
    slices.forces(a, {}, records, exceeded);
    return p;
  }

  template <int dim>
  static void remove_bonds()
  {
    const auto packing = SliceKernel::packing<dim>(3);
    BondNetwork<dim> bonds(packing, DemMaterial{});
    BondSlices<dim> slices(bonds, 1.7, true);
    std::vector<BondId> removed;
    bonds.for_each_bond([&](BondId id, const Bond<dim> &) {
      if (id.index % 7 == 0)
        removed.push_back(id);
    });
    for (const BondId &id : removed) {
      bonds.remove(id);
      slices.remove(id.index);
    }
    const auto p = forces(slices, state(packing));
    const auto q = forces(BondSlices<dim>(bonds, 1.7, true), state(packing));
    EXPECT_EQ(p.force, q.force); // what isn't there adds zeros: not a bit differs
    EXPECT_EQ(p.torque, q.torque);
  }
};

TEST_F(SliceKernel, AgreesWithTheOracle)
{
  for (const double nu : {-0.2, 0., 0.45}) {
    compare<2>(nu);
    compare<3>(nu);
  }
}

TEST_F(SliceKernel, RemovedBondsLeaveNoTrace)
{
  remove_bonds<2>();
  remove_bonds<3>();
}

/// Two halves pulled apart in steps: bonds across break at the strength, found by the slices.
TEST_F(SliceKernel, FindsTheTensionThatBreaks)
{
  auto packing = SliceKernel::packing<2>(1);
  for (auto &face : packing.faces)
    face.cracked = false;
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  ManyBodyForce<2> force(packing, material, {}, {FractureLaw::Criterion::face_tension, 1e300});
  auto p = state(packing);
  std::vector<int> all(p.size());
  for (int i = 0; i < p.size(); ++i)
    all[i] = i;
  const double largest = force.max_tension(p, all);
  ASSERT_GT(largest, 0);
  for (const auto &[share, breaks] : {std::pair(1 + 1e-12, false), std::pair(1 - 1e-12, true)}) {
    force.set_strength(share * largest);
    force.compute(p, 0);
    EXPECT_EQ(int(force.broken_bonds().size()), breaks ? 1 : 0);
  }
}
} // namespace ligament::dem::testing
