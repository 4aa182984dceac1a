// The row kernel agrees with the plain oracle on bodies of every shape that its window meets, with
// every instruction set of the machine.
#include "core/dispatch.h"
#include "core/extremes.h"
#include "tests/oracle/many_body_oracle.h"
#include "tests/unit/dem/cases.h"

#include <hwy/highway.h>

namespace ligament::dem::testing
{
struct RowKernel : ::testing::Test
{
  ~RowKernel() override { hwy::SetSupportedTargetsForTest(0); }

  static std::vector<std::int64_t> targets()
  {
    std::vector<std::int64_t> found;
    hwy::SetSupportedTargetsForTest(0);
    for (const std::int64_t target : {HWY_EMU128, HWY_AVX2, HWY_AVX3})
      if (hwy::SupportedTargets() & target)
        found.push_back(target);
    return found;
  }

  /// A box of so many spacings along the axes, in a random state, with faces cracked at random.
  template <int dim>
  static void compare(Kind kind, const Vector<dim> &size, bool may_renumber = false)
  {
    packings::LatticeParameters<dim> lattice;
    lattice.kind = kind;
    if (may_renumber)
      lattice.small_layer = 0;
    lattice.spacing = 0.01;
    lattice.upper = lattice.spacing * size;
    auto packing = packings::make_lattice_packing<dim>(lattice);
    std::mt19937 random(7);
    for (auto &face : packing.faces)
      face.cracked = random() % 50 == 0;
    const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
    ManyBodyForce<dim> force(packing, material, {});
    Particles<dim> p;
    packings::fill_particles(packing, 1., p);
    disturb<dim>(p, packing.spacing, 1e-3, Spin<dim>::Constant(0.4), 5);
    for (int i = 0; i < p.size(); ++i) // swollen: the oracle knows no contact
      for (int c = 0; c < dim; ++c)
        p.displacement[c][i] =
            1.02 * (p.displacement[c][i] + p.reference[c][i]) - p.reference[c][i];
    auto q = p;
    const double energy = oracle::ManyBodyOracle<dim>(packing, 3., 0.3).compute(q);
    for (const std::int64_t target : targets()) {
      hwy::SetSupportedTargetsForTest(target);
      force.compute(p, 0);
      expect_close(p.force, q.force);
      expect_close(p.torque, q.torque);
      const auto first_force = p.force;
      const auto first_torque = p.torque;
      force.compute(p, 0);
      EXPECT_EQ(p.force, first_force); // to the last bit
      EXPECT_EQ(p.torque, first_torque);
      // Squares of what forces are: round-off of positions as below.
      EXPECT_NEAR(force.potential_energy(p), energy, 1e-9 * energy);
      EXPECT_EQ(force.potential_energy(p), force.potential_energy(p));
    }
  }

  /// To round-off of the largest force on a face: positions are known to 1e-16 of the body's size,
  /// faces move by 1e-2 spacings.
  template <typename C>
  static void expect_close(const C &a, const C &b)
  {
    double scale = 0, error = 0;
    for (std::size_t c = 0; c < a.size(); ++c)
      for (std::size_t i = 0; i < a[c].size(); ++i) {
        keep_largest(scale, std::abs(b[c][i]));
        keep_largest(error, std::abs(a[c][i] - b[c][i]));
      }
    EXPECT_LT(error, 1e-9 * scale);
  }
};

TEST_F(RowKernel, WindowSlides)
{
  compare<2>(Kind::hexagonal, {11.3, 350.2});
  compare<2>(Kind::square, {40.3, 90.2});
  compare<3>(Kind::fcc, {6.3, 5.2, 120.4});
  compare<3>(Kind::simple_cubic, {5.3, 6.2, 110.4});
}

TEST_F(RowKernel, RowsShorterThanAVector)
{
  compare<2>(Kind::hexagonal, {2.3, 30.2});
  compare<3>(Kind::fcc, {2.3, 2.2, 20.4});
}

TEST_F(RowKernel, RowsTooLongForTheCloseWindow)
{
  compare<2>(Kind::square, {11500.3, 3.2});
}

// Rows along another direction, layers of other planes than the lattice's own.
TEST_F(RowKernel, OtherOrders)
{
  compare<2>(Kind::hexagonal, {350.3, 6.2}, true);
  compare<2>(Kind::square, {200.3, 5.2}, true);
  compare<3>(Kind::fcc, {80.3, 5.2, 6.3}, true);
  compare<3>(Kind::fcc, {6.3, 80.3, 5.2}, true);
  compare<3>(Kind::fcc, {40.3, 30.2, 4.3}, true);
  compare<3>(Kind::simple_cubic, {60.3, 5.2, 6.3}, true);
  compare<3>(Kind::simple_cubic, {30.3, 25.2, 4.3}, true);
}

/// A square lattice of rows of n particles, numbered along them: E = 1 without shear, unit spacing,
/// lambda/V = 1.
struct LongRows
{
  int n, rows = 3;
  DemMaterial material{1., 0.25, 1, PlaneMode::strain, 0};
  std::vector<DirectionData<2>> directions{{{1, 0}, 1, 1, 0.1, 0}, {{0, 1}, 1, 1, 0.1, 0}};
  std::vector<RowSegment> segments;
  std::vector<std::uint32_t> mask;

  explicit LongRows(int n) : n(n), mask(long(n) * rows)
  {
    for (int row = 0; row < rows; ++row) {
      RowSegment s{row * n, (row + 1) * n, {}, {}};
      s.forward[0] = s.backward[0] = 0;
      if (row + 1 < rows)
        s.forward[1] = n;
      if (row > 0)
        s.backward[1] = -n;
      segments.push_back(s);
      for (int k = 0; k < n; ++k)
        mask[row * n + k] = (row + 1 < rows ? 2u : 0u) | (row > 0 ? 8u : 0u);
    }
  }
  int size() const { return n * rows; }
};

// Rows as long as the layers of large bodies. Bonds across the rows alone: each column is a chain
// whose forces are known.
TEST_F(RowKernel, RowsOf360000)
{
  const LongRows body(360000);
  const int n = body.size();
  const LatticeKernel<2> kernel(body.directions, body.segments, n, body.material.shear_modulus(),
                                true);
  std::vector<double> u(n), v(n), zero(n, 0.), lambda(n, 1.), pressure(n), fx(n), fy(n), torque(n);
  const auto value = [](long k) { return 1e-6 * double((k * 7919) % 1009); };
  for (int i = 0; i < n; ++i)
    v[i] = value(i);
  const std::vector<int> none;
  LatticeArrays<2> a{{u.data(), v.data()},   {zero.data()},  body.mask.data(),
                     lambda.data(),          &none,          pressure.data(),
                     {fx.data(), fy.data()}, {torque.data()}};
  RowWindow window;
  std::vector<RowRange> exceeded;
  kernel.forces(a, body.segments, {}, window, exceeded);
  const double shear = 2 * body.material.shear_modulus();
  double error = 0;
  for (int k = 0; k < body.n; ++k) {
    double p[3], strain[2];
    for (int row = 0; row < 2; ++row)
      strain[row] = value(long(row + 1) * body.n + k) - value(long(row) * body.n + k);
    for (int row = 0; row < 3; ++row)
      p[row] = 0.5 * ((row < 2 ? strain[row] : 0) + (row > 0 ? strain[row - 1] : 0));
    const auto traction = [&](int row) {
      return shear * strain[row] + 0.5 * (p[row] + p[row + 1]);
    };
    for (int row = 0; row < 3; ++row)
      keep_largest(error, std::abs(fy[row * body.n + k] - (row < 2 ? traction(row) : 0) +
                                   (row > 0 ? traction(row - 1) : 0)));
  }
  EXPECT_LT(error, 1e-17); // strains of 1e-3
}

TEST_F(RowKernel, RefusesLayersThatNoWindowHolds)
{
  const LongRows body(10);
  auto segments = body.segments;
  const int n = std::numeric_limits<int>::max(); // nothing of that size is made
  const auto kernel = [&](long reach) {
    segments[0].forward[1] = int(reach);
    LatticeKernel<2>(body.directions, segments, n, 1., true);
  };
  EXPECT_NO_THROW(kernel(largest_reach));
  EXPECT_THROW(kernel(largest_reach + 1), core::InputError);

  RowWindow window;
  const long stride = RowWindow::close;
  EXPECT_NO_THROW(window.reset(1, stride, stride, n));
  EXPECT_THROW(window.reset(1, stride, stride + 1, n), core::InputError);
  EXPECT_NO_THROW(window.reset(1, stride, stride + 1, 100)); // the whole body fits
  window.reset(1, 1000, 500, 10000);
  EXPECT_NO_THROW(window.slide(500, 1500));
  EXPECT_THROW(window.slide(600, 1601), core::InputError);
}

/// Uniform strain of a plate of simple cubic cells, with layers along its faces: no force on inner
/// particles.
void strain_plate(int width, int height, long small_layer)
{
  packings::LatticeParameters<3> lattice;
  lattice.kind = Kind::simple_cubic;
  lattice.spacing = 1;
  lattice.lower.setZero();
  lattice.upper = Vector<3>(width, width, height);
  lattice.small_layer = small_layer;
  auto packing = packings::make_lattice_packing<3>(lattice);
  Particles<3> p;
  packings::fill_particles(packing, 1., p);
  ManyBodyForce<3> force(std::move(packing), DemMaterial{1., 0.3, 1, PlaneMode::strain, 0}, {});
  for (int i = 0; i < p.size(); ++i)
    p.displacement[0][i] = 1e-3 * p.reference[0][i];
  force.compute(p, 0);
  double largest = 0;
  for (int i = 0; i < p.size(); ++i) {
    const Vector<3> x = get(p.reference, i);
    if ((x.array() > 2).all() && ((lattice.upper - x).array() > 2).all())
      keep_largest(largest, get(p.force, i).norm());
  }
  EXPECT_LT(largest, 1e-12); // of displacements up to 1, known to 1e-16
}

TEST_F(RowKernel, PlatesOfAnyOrder)
{
  strain_plate(20, 6, std::numeric_limits<long>::max());
  strain_plate(20, 6, 0);
}

TEST(SlowRowKernel, PlateOf592By592By6)
{
  strain_plate(592, 6, std::numeric_limits<long>::max()); // layers of 350 000
  strain_plate(592, 6, 0);
}
} // namespace ligament::dem::testing
