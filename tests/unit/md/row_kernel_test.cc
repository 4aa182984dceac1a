// Forces along the rows of a crystal with fixed neighbours: against the plain oracle with every
// instruction set, and when they are allowed.
#include "core/dispatch.h"
#include "core/extremes.h"
#include "tests/unit/md/bodies.h"

#include "md/row_kernel.h"

#include <hwy/highway.h>

namespace ligament::md::testing
{
struct RowKernelTest : ::testing::Test
{
  ~RowKernelTest() override { hwy::SetSupportedTargetsForTest(0); }

  template <int dim>
  static void compare(Body<dim> body)
  {
    SCOPED_TRACE(body.crystal.potential().species(0).name);
    auto expected = body.atoms;
    body.oracle(body.crystal.potential()).compute(expected);
    const double scale = body.stiffness() * body.crystal.spacing();
    for (const std::int64_t target : {HWY_SCALAR, HWY_EMU128, HWY_AVX2, HWY_AVX3}) {
      hwy::SetSupportedTargetsForTest(0);
      if (!(hwy::SupportedTargets() & target))
        continue;
      hwy::SetSupportedTargetsForTest(target);
      auto force = body.force();
      ASSERT_TRUE(force.is_undisturbed(body.atoms));
      force.compute(body.atoms, 0);
      EXPECT_EQ(force.list().n_builds(), 1);
      EXPECT_LT(difference(body.atoms.force, expected.force, scale), 1e-12);
      const auto first = body.atoms.force;
      force.compute(body.atoms, 0);
      EXPECT_EQ(body.atoms.force, first); // to the last bit
    }
  }
};

/// A crystal with a hole and a crack: a layer of atoms that is left out.
template <int dim>
Body<dim> cut_body(const Potential &potential, CrystalKind kind, const Vector<dim> &size,
                   std::array<bool, dim> periodic = {},
                   const Matrix<dim> &orientation = Matrix<dim>::Identity())
{
  CrystalParameters<dim> parameters;
  parameters.kind = kind;
  parameters.orientation = orientation;
  const Crystal<dim> crystal(potential, parameters);
  auto shape = box<dim>(crystal, size, periodic);
  const Vector<dim> top = shape.upper;
  const double d = crystal.spacing();
  shape.keep = [top, d](const Vector<dim> &x) {
    const bool in_hole = (x - 0.7 * top).norm() < 1.2 * d,
               in_crack = x[0] < 0.5 * top[0] && std::abs(x[1] - 0.4 * top[1]) < 0.8 * d;
    return !in_hole && !in_crack;
  };
  return {potential, parameters, shape};
}

std::vector<Body<3>> cut_bodies()
{
  std::vector<Body<3>> all;
  all.push_back(cut_body<3>(foiles_copper(), CrystalKind::fcc, {5, 4, 3}));
  all.push_back(cut_body<3>(mishin_copper(), CrystalKind::fcc, {4, 4, 2}, {true, false, true}));
  all.push_back(cut_body<3>(mendelev_iron(), CrystalKind::bcc, {5, 4, 4}, {}, some_rotation<3>()));
  all.push_back(cut_body<3>(argon_pairs(), CrystalKind::fcc, {3, 4, 2}, {true, true, true}));
  return all;
}

TEST_F(RowKernelTest, AgreesWithTheOracleOnAllInstructionSets)
{
  // Of the spacing: one interval of the table for all lanes, a few, any; more shells at last.
  for (const double amplitude : {0., 1e-5, 4e-3, 0.05}) {
    auto all = cut_bodies();
    for (Body<3> &body : bodies())
      if (body.options.species.empty())
        all.push_back(body);
    for (Body<3> &body : all) {
      body.disturb(amplitude * body.crystal.spacing());
      compare<3>(body);
    }
    for (Body<2> body :
         {plane_body(), plane_body({9, 2}, {true, true}),
          cut_body<2>(plane_atoms(), CrystalKind::triangular, {14, 7}, {true, false})})
    {
      body.disturb(amplitude * body.crystal.spacing());
      compare<2>(body);
    }
  }
}

// Runs that are longer than a block and rows in several vectors, with a last one in part.
// Of reduced units: a spacing of about 1 m.
TEST_F(RowKernelTest, AgreesInAnyUnits)
{
  for (const double unit : {1., 1e3}) {
    Body<3> body = cut_body<3>(lennard_jones({"A", 1}, 1, unit), CrystalKind::fcc, {3, 4, 2},
                               {true, true, true});
    body.disturb(0.02 * unit);
    compare(body);
    Body<2> plane = cut_body<2>(lennard_jones({"A", 1}, 1, unit), CrystalKind::triangular, {9, 7});
    plane.disturb(0.02 * unit);
    compare(plane);
  }
}

TEST_F(RowKernelTest, AgreesAlongLongRows)
{
  auto body = make_body<2>(plane_atoms(), CrystalKind::triangular, {75, 2});
  body.disturb(0.01 * body.crystal.spacing());
  compare<2>(body);
}

// Rigid motion and homogeneous strain of any size are no disturbance.
TEST_F(RowKernelTest, RigidMotionAndStrainAreFree)
{
  for (Body<3> body : cut_bodies()) {
    if (body.packing.period.norm() > 0)
      continue;
    body.disturb(1e-3 * body.crystal.spacing());
    const auto start = body.atoms;
    auto force = body.force();
    force.compute(body.atoms, 0);
    const auto unturned = body.atoms.force;
    const Matrix<3> q = orientation_of({0, 1, 0.2}, {-1, 0, 0}) * some_rotation<3>();
    const Vector<3> far(3e-8, -5e-8, 1e-8);
    for (int i = 0; i < body.atoms.size(); ++i) {
      const Vector<3> x = get(start.reference, i), u = get(start.displacement, i);
      set(body.atoms.displacement, i, Vector<3>(q * (x + u) - x + far));
    }
    ASSERT_TRUE(force.is_undisturbed(body.atoms));
    force.compute(body.atoms, 0);
    EXPECT_EQ(force.list().n_builds(), 1);
    double largest = 0;
    for (int i = 0; i < body.atoms.size(); ++i)
      keep_largest(largest, (get(body.atoms.force, i) - q * get(unturned, i)).norm());
    // Displacements of 6e-8 m are rounded to 7e-24 m, 3e-14 spacings, and bonds pull with a few
    // times the stiffness.
    EXPECT_LT(largest, 1e-12 * body.stiffness() * body.crystal.spacing());
    Matrix<3> strain = 0.04 * Matrix<3>::Identity();
    strain(0, 1) = -0.05;
    for (int i = 0; i < body.atoms.size(); ++i)
      set(body.atoms.displacement, i,
          Vector<3>(strain * get(start.reference, i) + get(start.displacement, i)));
    compare<3>(body);
  }
}

// Where atoms come near that were not, the list takes over, and gives back.
TEST_F(RowKernelTest, FacesThatMeetAreNoticed)
{
  CrystalParameters<3> parameters;
  const Crystal<3> crystal(foiles_copper(), parameters);
  auto shape = box<3>(crystal, {4, 8, 3});
  const double a = crystal.lattice_parameter(), middle = 4 * a;
  // A gap of 6.4 angstrom between planes: nobody sees across it at first.
  shape.keep = [&](const Vector<3> &x) {
    return x[1] < middle - 0.1 * a || x[1] > middle + 1.4 * a;
  };
  Body<3> body(foiles_copper(), parameters, shape);
  auto force = body.force();
  int n_rows = 0;
  for (const double closed : {0., 0.01, 0.1, 0.2, 0.4, 0.9, 0.3, 0.}) {
    for (int i = 0; i < body.atoms.size(); ++i)
      body.atoms.displacement[1][i] = body.atoms.reference[1][i] > middle ? -closed * a : 0;
    auto expected = body.atoms;
    body.oracle(body.crystal.potential()).compute(expected);
    n_rows += force.is_undisturbed(body.atoms);
    force.compute(body.atoms, 0);
    EXPECT_LT(
        difference(body.atoms.force, expected.force, body.stiffness() * body.crystal.spacing()),
        1e-12)
        << closed;
    if (closed == 0) {
      EXPECT_TRUE(force.is_undisturbed(body.atoms));
    }
    if (closed == 0.9) {
      EXPECT_FALSE(force.is_undisturbed(body.atoms));
      EXPECT_GT(difference(expected.force, Components<3>(body.atoms.velocity),
                           body.stiffness() * body.crystal.spacing()),
                1e-3); // they do see each other
    }
  }
  EXPECT_GE(n_rows, 3);
}

// A yes means that all pairs in range are bonds, whatever the motion.
TEST_F(RowKernelTest, AYesIsAlwaysRight)
{
  const auto made = cut_body<3>(foiles_copper(), CrystalKind::fcc, {4, 4, 3}, {false, false, true});
  RowKernel<3> rows(made.crystal, made.packing, 0,
                    made.crystal.potential().cutoff() + 1 * angstrom);
  ASSERT_TRUE(rows.exists());
  int yes = 0, no = 0;
  for (unsigned seed = 1; seed < 60; ++seed) {
    Body<3> body = made;
    body.disturb(0.008 * (seed % 20) * body.crystal.spacing(), seed);
    Noise noise(seed);
    Matrix<3> gradient = 0.008 * (seed % 10) * noise.matrix<3, 3>();
    gradient.col(2).setZero();
    for (int i = 0; i < body.atoms.size(); ++i)
      add(body.atoms.displacement, i, Vector<3>(gradient * get(body.atoms.reference, i)));
    const bool answer = rows.holds(body.atoms.displacement);
    (answer ? yes : no) += 1;
    if (!answer)
      continue;
    auto expected = body.atoms;
    body.oracle(body.crystal.potential()).compute(expected);
    rows.compute(body.atoms.force);
    EXPECT_LT(
        difference(body.atoms.force, expected.force, body.stiffness() * body.crystal.spacing()),
        1e-12);
  }
  EXPECT_GT(yes, 10);
  EXPECT_GT(no, 10);
}

// How many shells are looked at is no matter of the result: where an island far away moves off, the
// bound on relative motion grows, and atoms that stay look at more shells for the same bits.
TEST_F(RowKernelTest, ShellsOutOfRangeDoNotChangeABit)
{
  const Crystal<3> crystal(foiles_copper(), {});
  auto shape = box<3>(crystal, {8, 3, 3});
  const double a = crystal.lattice_parameter();
  shape.keep = [a](const Vector<3> &x) { return x[0] < 2.9 * a || x[0] > 5.2 * a; };
  Body<3> body(foiles_copper(), {}, shape);
  body.disturb(1e-3 * crystal.spacing());
  RowKernel<3> rows(crystal, body.packing, 0, crystal.potential().cutoff() + 1 * angstrom);
  ASSERT_TRUE(rows.holds(body.atoms.displacement));
  const int few = rows.most_bonds();
  rows.compute(body.atoms.force);
  const auto first = body.atoms.force;
  for (int i = 0; i < body.atoms.size(); ++i)
    if (body.atoms.reference[0][i] > 4 * a)
      body.atoms.displacement[1][i] += 0.3 * angstrom * (body.atoms.reference[2][i] > a ? 1 : -1);
  ASSERT_TRUE(rows.holds(body.atoms.displacement));
  EXPECT_GT(rows.most_bonds(), few);
  rows.compute(body.atoms.force);
  int n = 0;
  for (int i = 0; i < body.atoms.size(); ++i)
    if (body.atoms.reference[0][i] < 4 * a) {
      ++n;
      EXPECT_EQ(get(body.atoms.force, i), get(first, i));
    }
  EXPECT_GT(n, 50);
}

// Atoms that are not those of the lattice, or a box that is not quite a period, have no rows.
TEST_F(RowKernelTest, OnlyTheLatticeHasRows)
{
  auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {3, 3, 3}, {true, true, true});
  const double reach = body.crystal.potential().cutoff();
  EXPECT_TRUE(RowKernel<3>(body.crystal, body.packing, 0, reach).exists());
  auto moved = body.packing;
  moved.centre[1][5] += 1e-6 * body.crystal.spacing();
  EXPECT_FALSE(RowKernel<3>(body.crystal, moved, 0, reach).exists());
  auto longer = body.packing;
  longer.period[2] *= 1 + 1e-8;
  EXPECT_FALSE(RowKernel<3>(body.crystal, longer, 0, reach).exists());
  auto twice = body.packing;
  for (int c = 0; c < 3; ++c)
    twice.centre[c][4] = twice.centre[c][3];
  EXPECT_FALSE(RowKernel<3>(body.crystal, twice, 0, reach).exists());
}

// A run that is taken up goes the way of the one that was left: with rows, with the list, and with
// rows again, to the last bit; whether somebody looked at its energy in between or not.
TEST_F(RowKernelTest, SavedStatesGoOnToTheLastBit)
{
  for (const bool is_watched : {false, true}) {
    auto body = make_body<3>(foiles_copper(), CrystalKind::fcc, {3, 3, 3}, {true, false, true});
    auto force = body.force();
    std::vector<bool> ways;
    for (const double amplitude : {0.02, 0.35, 0.34, 0.02, 0.021, 0.36}) {
      core::State state;
      const core::Names names = body.atoms.names();
      force.save(state, names, body.atoms);
      auto loaded = body.force();
      loaded.load(state, names, body.atoms);
      body.disturb(amplitude * body.crystal.spacing(), 2);
      force.compute(body.atoms, 0);
      const auto expected = body.atoms.force;
      if (is_watched)
        force.potential_energy(body.atoms);
      ways.push_back(force.is_undisturbed(body.atoms));
      loaded.compute(body.atoms, 0);
      EXPECT_EQ(body.atoms.force, expected) << amplitude;
      EXPECT_EQ(loaded.potential_energy(body.atoms), force.potential_energy(body.atoms));
    }
    EXPECT_EQ(ways, (std::vector<bool>{true, false, false, true, true, false}));
  }
}
} // namespace ligament::md::testing
