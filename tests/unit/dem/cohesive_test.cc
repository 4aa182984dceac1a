// Faces that soften: work per area, gradient at frozen openings, balance, numbering.
#include "core/extremes.h"
#include "dem/laws/cohesive.h"
#include "tests/oracle/cohesive_beam.h"
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/force_slope.h"
#include "tests/unit/dem/run.h"
#include "tests/unit/dem/softening_bodies.h"

#include <gtest/gtest.h>

#include <random>

namespace ligament::dem::testing
{
namespace
{
template <typename D>
struct Cohesive : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Cohesive, Dimensions);

constexpr double youngs_modulus = 3e10, strength = 3e6, density = 2500;

/// Softens with E G_c/f_t^2 of so many spacings.
FractureLaw softening(double lengths, double spacing, const Softening &shape = {})
{
  FractureLaw law{FractureLaw::Criterion::opening_tension, strength};
  law.energy = lengths * spacing * strength * strength / youngs_modulus;
  law.softening = shape;
  return law;
}

TYPED_TEST(Cohesive, ColumnTakesItsEnergyAndNoMore)
{
  constexpr int dim = TypeParam::value;
  const auto packing = column<dim>();
  ASSERT_EQ(packing.size(), 2);
  ASSERT_EQ(packing.faces.size(), 1u);
  for (const double nu : {0., 0.2, 0.45})
    for (const double lengths : {20., 60.})
      for (const bool has_corner : {false, true}) {
        const Softening shape = has_corner ? Softening{1 / 3., 0.8} : Softening{};
        const DemMaterial material{youngs_modulus, nu, density, PlaneMode::strain, 0};
        const FractureLaw law = softening(lengths, packing.spacing, shape);
        const double reach = shape.reach() * law.energy / strength, area = packing.faces[0].area,
                     period = packing.spacing / 3000;
        const double duration = 1000 * period;
        Run<dim> run(packing, material, draw_apart<dim>(1.2 * reach / duration, 10 * period), law);
        double largest = 0;
        while (run.force->broken_bonds().empty() && run.time < 2 * duration) {
          run.step(1 / period);
          keep_largest(largest, std::abs(run.residual()));
        }
        ASSERT_EQ(run.force->broken_bonds().size(), 1u);
        const double whole = law.energy * area;
        EXPECT_NEAR(run.force->cohesive_work() / whole, 1, 1e-3) << nu << ' ' << lengths;
        EXPECT_LT(std::abs(run.force->fracture_energy()) / whole, 1e-6) << nu << ' ' << lengths;
        EXPECT_LT(largest / whole, 1e-6);
      }
}

/// Pulled apart at one velocity per particle, so that many faces begin to open; then held there.
template <int dim>
struct Opened
{
  Packing<dim> packing;
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0.4};
  FractureLaw law{FractureLaw::Criterion::opening_tension, 0.02};
  std::unique_ptr<ManyBodyForce<dim>> force;
  Particles<dim> p;

  explicit Opened(const Packing<dim> &of) : packing(of)
  {
    law.energy = 20 * packing.spacing * law.strength.value * law.strength.value;
    force = make();
    p = at_rest(packing, material);
    p.global_id = packing.global_id.empty() ? p.global_id : particles::GlobalIds(packing.global_id);
    for (int step = 1; step <= 12; ++step)
      take(step);
  }
  std::unique_ptr<ManyBodyForce<dim>> make() const
  {
    return std::make_unique<ManyBodyForce<dim>>(packing, material,
                                                std::vector<core::BoundaryLoad<dim>>(), law);
  }
  void take(int step) { take(step, *force, p); }
  void take(int step, ManyBodyForce<dim> &of, Particles<dim> &q) const
  {
    for (int i = 0; i < q.size(); ++i) {
      // A stretch along y that stops, a wave on it, and turns.
      const Vector<dim> x = get(q.reference, i);
      Vector<dim> u = Vector<dim>::Zero();
      u[1] = 0.006 * std::min(step, 9) * x[1] +
             2e-3 * packing.spacing * step * std::sin(7 * x[0] + 5 * x[1]);
      u[0] = 1e-3 * packing.spacing * step * std::cos(4 * x[1]);
      set(q.displacement, i, u);
      if constexpr (dim == 2)
        q.rotation[0][i] = 1e-3 * step * std::sin(3 * x[0]);
      else {
        const double angle = 1e-3 * step * std::sin(3 * x[0]);
        q.rotation[0][i] = std::cos(angle / 2);
        q.rotation[2][i] = std::sin(angle / 2);
      }
    }
    of.compute(q, step);
  }
};

TYPED_TEST(Cohesive, ForceIsMinusTheGradientAtFrozenOpenings)
{
  constexpr int dim = TypeParam::value;
  Opened<dim> body(ragged_lattice<dim>(4, 7));
  auto &force = *body.force;
  ASSERT_GT(force.cohesive().all().size(), 4u);
  double opening = 0;
  for (const auto &[name, face] : force.cohesive().all())
    keep_largest(opening, face.opening.damage);
  ASSERT_GT(opening, 0.05);
  auto p = body.p;
  const double time = 12;
  force.compute(p, time); // of the same time: nothing opens further
  expect_minus_slope<dim>(p, {1e-4, 1e-4}, 1e-8, 1, 2,
                          [&](const auto &q) { return force.potential_energy(q); });
}

TYPED_TEST(Cohesive, GoesOnFromItsStateToTheBit)
{
  constexpr int dim = TypeParam::value;
  Opened<dim> body(ragged_lattice<dim>(4, 7));
  const core::Names names(body.p.global_id.list());
  core::State state;
  body.p.save(state, names);
  body.force->save(state, names, body.p);
  const auto other = body.make();
  auto q = body.p;
  other->load(state, names, q);
  for (const int step : {13, 14, 12, 5, 13}) {
    body.take(step + 100 * (step < 13));
    body.take(step + 100 * (step < 13), *other, q);
    for (int i = 0; i < q.size(); ++i) {
      for (int c = 0; c < dim; ++c)
        ASSERT_EQ(body.p.force[c][i], q.force[c][i]);
      for (int c = 0; c < n_spins<dim>; ++c)
        ASSERT_EQ(body.p.torque[c][i], q.torque[c][i]);
    }
    EXPECT_EQ(body.force->cohesive_work(), other->cohesive_work());
  }
}

TYPED_TEST(Cohesive, LookingTwiceChangesNothing)
{
  constexpr int dim = TypeParam::value;
  Opened<dim> body(ragged_lattice<dim>(4, 7));
  const core::Names names(body.p.global_id.list());
  for (int step = 13; step < 16; ++step) {
    body.take(step);
    core::State once, twice;
    body.force->save(once, names, body.p);
    body.force->compute(body.p, step);
    body.force->save(twice, names, body.p);
    expect_same_numbers(once, twice);
  }
}

TYPED_TEST(Cohesive, NumberingChangesNothing)
{
  constexpr int dim = TypeParam::value;
  const auto packing = ragged_lattice<dim>(4, 7);
  std::vector<int> place(packing.size()), same(packing.size());
  for (int i = 0; i < packing.size(); ++i)
    same[i] = i, place[i] = (i * 7 + 3) % packing.size();
  Opened<dim> a(renumbered(packing, same)), b(renumbered(packing, place));
  ASSERT_GT(a.force->cohesive().all().size(), 4u);
  ASSERT_EQ(a.force->cohesive().all().size(), b.force->cohesive().all().size());
  const double work = a.force->cohesive_work();
  EXPECT_NEAR(b.force->cohesive_work(), work, 1e-10 * std::abs(work));
  auto other = b.force->cohesive().all().begin();
  for (const auto &[name, face] : a.force->cohesive().all()) {
    EXPECT_EQ(name, other->first);
    EXPECT_NEAR(face.opening.damage, other->second.opening.damage, 1e-9);
    ++other;
  }
}

/// Opened, shut, rubbed and opened again.
TYPED_TEST(Cohesive, BalanceOverManyOpeningsAndClosings)
{
  constexpr int dim = TypeParam::value;
  const auto packing = column<dim>();
  const DemMaterial material{youngs_modulus, 0.3, density, PlaneMode::strain, 0.5};
  FractureLaw law = softening(30, packing.spacing);
  // What is left goes with the strain: the law is exactly linear for none.
  law.strength.value *= 1e-4;
  law.energy *= 1e-8;
  const double reach = 2 * law.energy / law.strength.value, area = packing.faces[0].area,
               period = packing.spacing / 3000;
  auto loads = draw_apart<dim>(1, period);
  for (int end = 0; end < 2; ++end) {
    loads[end].kind = core::BoundaryLoad<dim>::Kind::displacement;
    for (int c = 0; c < dim; ++c)
      loads[end].value[c] = (end ? 1 : -1) * reach * (c == 1 ? 0.25 : 0.1);
    loads[end].history = core::Cycles{core::Ramp{50 * period}, 0.2, 1, 217 * period};
  }
  Run<dim> run(packing, material, loads, law);
  double largest = 0, deepest = 0, widest = 0;
  int closings = 0;
  bool was_open = false;
  for (int s = 0; s < 20000; ++s) {
    run.step(0.01 / period);
    keep_largest(largest, std::abs(run.residual()));
    ASSERT_TRUE(run.force->broken_bonds().empty());
    for (const auto &[name, face] : run.force->cohesive().all()) {
      const double open = face.bond.normal.dot(face.opening.jump);
      widest = std::max(widest, face.opening.damage);
      closings += was_open && open <= 0;
      was_open = open > 0;
    }
    keep_smallest(deepest, run.force->cohesive_work());
  }
  EXPECT_GT(closings, 5);
  EXPECT_GT(widest, 0.2);
  EXPECT_LT(widest, 1);
  const double whole = law.energy * area;
  EXPECT_GT(deepest, -1e-9 * whole); // a face gives back no more than it took
  EXPECT_LT(largest, 1e-8 * whole);
}

/// The law of a face written down once more: by bisection, for a stiffness that is the same in all
/// directions.
template <int dim>
Opening<dim> plain_answer(const CohesiveLaw<dim> &law, const Opening<dim> &last,
                          const Vector<dim> &force, double stiffness, const Vector<dim> &n)
{
  const double beta2 = law.mode_ratio * law.mode_ratio;
  const auto curve = [&](double kappa) {
    const double x = last.damage + (kappa - last.largest) / law.reach;
    const double corner = law.shape.corner_opening / law.shape.reach(), s = law.shape.corner_share;
    return law.strength * (x >= 1        ? 0
                           : x >= corner ? s * (1 - x) / (1 - corner)
                                         : 1 - (1 - s) * x / corner);
  };
  // F = (c + h) w across and F = (c + h beta^2) w along, h = f/kappa.
  const auto solve = [&](Vector<dim> f, bool shut) {
    const double across = shut ? 0 : f.dot(n);
    const Vector<dim> along = f - f.dot(n) * n;
    const auto at = [&](double kappa) {
      const double h = kappa > 0 ? curve(kappa) / kappa : 1e300;
      return Vector<dim>(across / (stiffness + h) * n + along / (stiffness + h * beta2));
    };
    const auto size = [&](const Vector<dim> &w) {
      const double wn = w.dot(n);
      return std::sqrt(wn * wn + beta2 * (w - wn * n).squaredNorm());
    };
    double low = last.largest, high = last.largest + 1e3 * law.reach;
    if (low > 0 ? size(at(low)) <= low
                : std::hypot(across, along.norm() / law.mode_ratio) <= curve(0))
      return Opening<dim>{at(low), low, last.damage};
    for (int k = 0; k < 200; ++k) {
      const double middle = (low + high) / 2;
      (size(at(middle)) > middle ? low : high) = middle;
    }
    return Opening<dim>{at(low), low,
                        std::min(last.damage + (low - last.largest) / law.reach, 1e3)};
  };
  const auto open = solve(force, false);
  if (open.jump.dot(n) >= 0)
    return open;
  const Vector<dim> before = last.jump - last.jump.dot(n) * n, shear = force - force.dot(n) * n;
  const double h = last.largest > 0 ? curve(last.largest) / last.largest : 0;
  const Vector<dim> rubbed = shear - (stiffness + h * beta2) * before;
  const double grip = law.friction * std::min(last.damage, 1.) * -force.dot(n);
  if (grip > 0 && rubbed.norm() <= grip)
    return {before, last.largest, last.damage};
  return solve(Vector<dim>(shear - (grip > 0 ? grip / rubbed.norm() : 0.) * rubbed), true);
}

TYPED_TEST(Cohesive, FaceFollowsThePlainLaw)
{
  constexpr int dim = TypeParam::value;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto any = [&] {
    return Vector<dim>(Vector<dim>::NullaryExpr([&] { return normal(random); }));
  };
  int grown = 0, unloaded = 0, stuck = 0, slid = 0, torn = 0;
  for (int k = 0; k < 2000; ++k) {
    const Softening shape = k % 2 ? Softening{1 / 3., 0.8} : Softening{};
    const CohesiveLaw<dim> law{1 + uniform(random), 1 + uniform(random), shape,
                               0.5 + uniform(random), k % 3 ? 0.6 : 0.};
    // More than the steepest fall of the curve, along the face, too.
    const double stiffness = 4 * law.strength * shape.reach() * shape.steepest() / law.reach;
    const Vector<dim> n = any().normalized();
    Opening<dim> last{Vector<dim>::Zero(), 0, 0};
    Opening<dim> plain = last;
    for (int step = 0; step < 12; ++step) {
      const Vector<dim> force = law.strength * (0.5 + 2 * step * uniform(random)) * any();
      const auto next =
          law.answer(last, force, stiffness * Eigen::Matrix<double, dim, dim>::Identity(), n);
      plain = plain_answer(law, last, force, stiffness, n);
      ASSERT_LT((next.jump - plain.jump).norm(), 1e-9 * (law.reach + plain.jump.norm()))
          << k << ' ' << step;
      if (next.damage < 1)
        ASSERT_NEAR(next.damage, plain.damage, 1e-9);
      else
        ASSERT_GE(plain.damage, 1 - 1e-9);
      const bool open = next.jump.dot(n) > 1e-12;
      // As it is kept, in axes that turn.
      const Eigen::Matrix<double, dim, dim> axes =
          Eigen::Matrix<double, dim, dim>::NullaryExpr([&] { return normal(random); })
              .householderQr()
              .householderQ();
      ASSERT_EQ(law.is_apart(axes * next.jump, axes * n), open) << k << ' ' << step;
      grown += open && next.damage > last.damage && next.damage < 1;
      unloaded += open && next.damage == last.damage;
      stuck += !open && next.jump == last.jump - last.jump.dot(n) * n && last.damage > 0;
      slid += !open && next.jump != last.jump && next.jump.norm() > 0;
      torn += next.damage >= 1;
      if (next.damage >= 1)
        break;
      last = next;
    }
  }
  for (const int n : {grown, unloaded, stuck, slid, torn})
    EXPECT_GT(n, 3);
}

/// Work that the broken faces of a crack took, over G_c times their area across its way; the arms
/// of a notched plate are drawn apart on one side. Of 20 spacings per E G_c/f_t^2.
double work_per_area(double degrees)
{
  const double length = 0.2, d = length / 20, width = 2.5 * length, height = 3 * length;
  packings::LatticeParameters<2> lattice;
  lattice.spacing = d;
  lattice.thickness = 1;
  lattice.lower.setZero();
  lattice.upper = {width, height};
  lattice.orientation[0] = degrees * M_PI / 180;
  auto packing = packings::make_lattice_packing<2>(lattice);
  const double y = height / 2 + 0.23 * d, notch = 0.45 * width;
  packings::cut_faces<2>(packing, {packings::CrackPlane<2>({{-d, y}, {notch, y}}, 1e-9 * d)});
  const FractureLaw law = softening(20, d);
  const double speed_p = 3600, duration = 100 * height / speed_p,
               stroke = 4 * (2.2 * law.energy / strength + height * strength / youngs_modulus);
  std::vector<core::BoundaryLoad<2>> loads(2);
  for (int arm = 0; arm < 2; ++arm) {
    Vector<2> lower(-1, -1), upper(1, 1);
    (arm ? lower : upper)[1] = (arm ? 0.6 : 0.4) * height;
    loads[arm].boundary = 0;
    loads[arm].part = core::Part<2>::box(lower, upper);
    loads[arm].value[1] = (arm ? 0.5 : -0.5) * stroke / duration;
    loads[arm].history = core::Ramp{0.05 * duration};
  }
  Run<2> run(packing, DemMaterial{youngs_modulus, 0.2, density, PlaneMode::strain, 0}, loads, law);
  double area = 0, taken = 0, largest = 0;
  for (std::size_t seen = 0; area < 0.6 * (width - notch) && run.time < duration;) {
    run.step(0.5 * speed_p / height);
    for (; seen < run.force->broken_bonds().size(); ++seen) {
      const auto &bond = run.force->broken_bonds()[seen];
      area += bond.area * std::abs(bond.normal[1]);
      taken += bond.energy;
      keep_largest(largest, std::abs(run.residual()));
    }
  }
  EXPECT_GT(area, 0.6 * (width - notch));
  EXPECT_LT(largest, 1e-8 * taken);
  return taken / (area * law.energy);
}

TEST(CohesiveCrack, TakesItsEnergyPerProjectedArea)
{
  for (const double degrees : {0., 10.})
    EXPECT_NEAR(work_per_area(degrees), 1, 0.05) << degrees;
}
/// Largest 3 P S/(2 (D-a)^2) over the strength of the oracle's beam, of one E G_c/f_t^2 and so many
/// rows of a hexagonal packing along it; a is what the cut breaks, seen along the beam.
double strength_of_section(double depth)
{
  const double span = 2.5 * depth, part = 0.04 * depth, beside = 0.01, strength = 1e-3;
  packings::LatticeParameters<2> lattice;
  lattice.spacing = lattice.thickness = 1;
  lattice.lower = {-span / 2 - 0.2 * depth, 0};
  lattice.upper = {span / 2 + 0.2 * depth, depth};
  lattice.cracks = {{{beside, -1}, {beside, 0.3 * depth}}};
  auto packing = packings::make_lattice_packing<2>(lattice);
  double notch = 0;
  for (const auto &face : packing.faces)
    if (face.cracked)
      notch += face.area * std::abs(face.normal[0]);
  FractureLaw law{FractureLaw::Criterion::opening_tension, strength};
  law.energy = depth * strength * strength;
  law.softening = {1 / 3., 0.8};
  const double duration = 120 * depth,
               stroke = 1.5 * strength * span * span / (6 * depth) + 4 * depth * strength;
  std::vector<core::BoundaryLoad<2>> loads(3);
  for (int k = 0; k < 3; ++k) {
    const double middle = (k - 1) * span / 2;
    loads[k].boundary = k == 1 ? 3 : 2;
    loads[k].part =
        core::Part<2>::box(Vector<2>(middle - part, -1), Vector<2>(middle + part, depth + 1));
    loads[k].value[1] = k == 1 ? -stroke / duration : 0;
    loads[k].history = core::Ramp{0.1 * duration};
  }
  Run<2> run(packing, DemMaterial{1, 0.2, 1, PlaneMode::stress, 0}, loads, law);
  run.dt *= 0.9;
  double peak = 0, load = 0;
  while (run.time < duration && (peak == 0 || load > 0.8 * peak || run.time < 0.2 * duration)) {
    run.step(0.3 / depth);
    load = run.force->reaction(0)[1] + run.force->reaction(2)[1];
    keep_largest(peak, load);
  }
  return 1.5 * peak * span / std::pow(depth - notch, 2) / strength;
}

// The notch's front is drawn along the beam, too: faces that are inclined must not bear more than
// their share of a straight crack.
TEST(CohesiveCrack, BeamBearsWhatAStraightCrackThroughItDoes)
{
  const double line = oracle::CohesiveBeam(100, 0.3, 1).strength_of_section();
  EXPECT_NEAR(strength_of_section(20) / line, 1, 0.03);
}
} // namespace
} // namespace ligament::dem::testing
