// Joints of initial cuts: they press along the cut's normal, slide without interlocking, rub.
#include "core/extremes.h"
#include "packings/random_packing.h"
#include "tests/unit/dem/cases.h"

namespace ligament::dem::testing
{
/// A box of n spacings, random or on a lattice turned against it, cut through at a height where no
/// row lies: the cut runs across all cells it meets.
template <typename C>
Packing<C::dim> cut_box(double n, bool random)
{
  constexpr int dim = C::dim;
  auto lattice = box<C>(n);
  const double y = 0.13 * lattice.spacing;
  const Vector<dim> lower = 2 * lattice.lower, upper = 2 * lattice.upper;
  if constexpr (dim == 2)
    lattice.cracks = {{{lower[0], y}, {upper[0], y}}};
  else
    lattice.cracks = {{{lower[0], y, lower[2]},
                       {lower[0], y, upper[2]},
                       {upper[0], y, upper[2]},
                       {upper[0], y, lower[2]}}};
  if (!random)
    return packings::make_lattice_packing<dim>(lattice);
  packings::RandomParameters<dim> seeds;
  static_cast<packings::SpecimenParameters<dim> &>(seeds) = lattice;
  seeds.size_ratio = 2;
  return packings::make_random_packing<dim>(seeds).packing;
}

template <typename C>
struct CutBody
{
  static constexpr int dim = C::dim;

  CutBody(bool random, double friction, double n = dim == 2 ? 9 : 5)
      : packing(cut_box<C>(n, random)), material{7e10, 0.3, 2500, PlaneMode::strain, friction},
        force(packing, material, {})
  {
    packings::fill_particles(packing, material.density, p);
    for (const auto &face : packing.faces)
      if (face.cracked)
        stiffness += 2 * material.shear_modulus() * face.area / (face.q_i + face.q_j);
  }
  bool is_above(int i) const { return packing.centre[1][i] > 0.13 * packing.spacing; }
  /// Moves the upper part, in spacings, and computes.
  void place(const Vector<dim> &u)
  {
    for (int i = 0; i < p.size(); ++i)
      for (int c = 0; c < dim; ++c)
        p.displacement[c][i] = is_above(i) ? u[c] * packing.spacing : 0;
    force.compute(p, time += 1e-9);
  }
  /// Turns the whole about the origin, as it lies, and computes.
  void turn_rigidly(const Spin<dim> &w)
  {
    Particles<dim> one;
    one.resize(1);
    turn_by<dim>(one, 0, w);
    const Turn<dim> turn = Turn<dim>::of(one, 0);
    for (int i = 0; i < p.size(); ++i) {
      const Vector<dim> x = get(p.reference, i) + get(p.displacement, i);
      set(p.displacement, i, Vector<dim>(get(p.displacement, i) + turn.change(x)));
      turn_by<dim>(p, i, w);
    }
    force.compute(p, time += 1e-9);
  }
  /// Turns the upper part about the axis out of the plane and its own middle, to this angle (rad)
  /// in all, lifts it by this many spacings, and computes until a search has seen it.
  void place_turned(double angle, double lift)
  {
    Vector<dim> middle = Vector<dim>::Zero();
    int n = 0;
    for (int i = 0; i < p.size(); ++i)
      if (is_above(i))
        middle += get(p.reference, i), ++n;
    middle /= n;
    for (int i = 0; i < p.size(); ++i)
      if (is_above(i)) {
        turn_by<dim>(p, i, Spin<dim>((angle - angle_) * Spin<dim>::Unit(n_spins<dim> - 1)));
        const Vector<dim> x = get(p.reference, i) - middle;
        set(p.displacement, i,
            Vector<dim>(Turn<dim>::of(p, i).change(x) +
                        lift * packing.spacing * Vector<dim>::Unit(1)));
      }
    angle_ = angle;
    for (int k = 0; k < 3; ++k)
      force.compute(p, time += 1e-9);
  }
  /// Small motions and rotations of every particle for itself.
  void disturb_each(double amplitude)
  {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
    for (int i = 0; i < p.size(); ++i) {
      for (auto &u : p.displacement)
        u[i] += packing.spacing * uniform(random);
      turn_by<dim>(p, i, Spin<dim>::NullaryExpr([&] { return uniform(random); }));
    }
    force.compute(p, time += 1e-9);
  }
  void expect_no_net_force_and_torque() const
  {
    Vector<dim> net = Vector<dim>::Zero();
    Spin<dim> moment = Spin<dim>::Zero();
    double scale = 0;
    for (int i = 0; i < p.size(); ++i) {
      const Vector<dim> f = get(p.force, i);
      keep_largest(scale, f.norm());
      net += f;
      moment +=
          get(p.torque, i) + cross(Vector<dim>(get(p.reference, i) + get(p.displacement, i)), f);
    }
    EXPECT_LT(net.norm(), 1e-10 * scale);
    EXPECT_LT(moment.norm(), 1e-9 * scale * packing.spacing);
  }
  Vector<dim> force_above() const
  {
    Vector<dim> sum = Vector<dim>::Zero();
    for (int i = 0; i < p.size(); ++i)
      if (is_above(i))
        sum += get(p.force, i);
    return sum;
  }

  Packing<dim> packing;
  DemMaterial material;
  ManyBodyForce<dim> force;
  Particles<dim> p;
  double stiffness = 0, time = 0; // N/m of the whole cut; s

private:
  double angle_ = 0; // of the upper part
};

/// A direction in the cut.
template <int dim>
Vector<dim> along()
{
  Vector<dim> t = Vector<dim>::Unit(0);
  if (dim == 3)
    t[2] = 0.4;
  return t.normalized();
}

template <typename C>
struct Joint : ::testing::Test
{
};
TYPED_TEST_SUITE(Joint, Cases);

TYPED_TEST(Joint, FlanksSlideWithoutInterlocking)
{
  constexpr int dim = TypeParam::dim;
  for (const bool random : {false, true}) {
    CutBody<TypeParam> body(random, 0.);
    for (int s = 1; s <= 40; ++s) {
      body.place(0.05 * s * along<dim>());
      for (int i = 0; i < body.p.size(); ++i)
        ASSERT_LT(get(body.p.force, i).norm(), 1e-12 * body.stiffness * body.packing.spacing) << s;
    }
  }
}

TYPED_TEST(Joint, ClosedCutPressesAlongItsNormalWithTheStiffnessOfItsFaces)
{
  constexpr int dim = TypeParam::dim;
  for (const bool random : {false, true}) {
    CutBody<TypeParam> body(random, 0.);
    const double closed = 1e-4;
    for (const double slide : {0., 0.2, 0.6, 0.9}) { // from 0.5 on to the neighbours
      body.place(slide * along<dim>() - closed * Vector<dim>::Unit(1));
      const Vector<dim> f = body.force_above(),
                        expected =
                            body.stiffness * closed * body.packing.spacing * Vector<dim>::Unit(1);
      EXPECT_LT((f - expected).norm(), 1e-9 * expected.norm()) << slide;
    }
  }
}

TYPED_TEST(Joint, SlidingRubsWithTheCoefficientAndBooksIt)
{
  constexpr int dim = TypeParam::dim;
  const double closed = 1e-4, mu = 0.4;
  for (const bool random : {false, true}) {
    CutBody<TypeParam> body(random, mu);
    const double d = body.packing.spacing;
    const int steps = 900;
    double work = 0, before = 0;
    body.place(-closed * Vector<dim>::Unit(1));
    const double pressed = body.force.potential_energy(body.p);
    for (int s = 1; s <= steps; ++s) {
      body.place(0.9 * s / steps * along<dim>() - closed * Vector<dim>::Unit(1));
      const double drag = -body.force_above().dot(along<dim>());
      work += 0.5 * (drag + before) * 0.9 / steps * d;
      before = drag;
    }
    const double limit = mu * body.stiffness * closed * d;
    EXPECT_NEAR(before, limit, 1e-9 * limit);
    const double stored = body.force.potential_energy(body.p) - pressed;
    EXPECT_NEAR(body.force.frictional_work() + stored, work, 1e-6 * work);
    EXPECT_NEAR(body.force.frictional_work(), limit * 0.9 * d, 1e-3 * limit * d);
  }
}

TYPED_TEST(Joint, ForceIsMinusTheGradientOfTheEnergy)
{
  constexpr int dim = TypeParam::dim;
  CutBody<TypeParam> body(true, 0., dim == 2 ? 6 : 4);
  auto &p = body.p;
  const double d = body.packing.spacing, h = 1e-6;
  body.place(0.2 * along<dim>() - 0.01 * Vector<dim>::Unit(1));
  body.disturb_each(1e-3);
  const auto force = p.force;
  const auto torque = p.torque;
  double scale = 0;
  for (int i = 0; i < p.size(); ++i)
    keep_largest(scale, get(force, i).norm());
  int n_tested = 0;
  for (const auto &face : body.packing.faces) {
    if (!face.cracked || ++n_tested > 5)
      continue;
    const int i = face.i;
    for (int c = 0; c < dim; ++c) {
      const double at = p.displacement[c][i];
      p.displacement[c][i] = at + h * d;
      const double more = body.force.potential_energy(p);
      p.displacement[c][i] = at - h * d;
      const double less = body.force.potential_energy(p);
      p.displacement[c][i] = at;
      EXPECT_NEAR(force[c][i], (less - more) / (2 * h * d), 1e-4 * scale);
    }
    for (int c = 0; c < n_spins<dim>; ++c) {
      const Spin<dim> turn = h * Spin<dim>::Unit(c);
      turn_by<dim>(p, i, turn);
      const double more = body.force.potential_energy(p);
      turn_by<dim>(p, i, Spin<dim>(-2 * turn));
      const double less = body.force.potential_energy(p);
      turn_by<dim>(p, i, turn);
      EXPECT_NEAR(torque[c][i], (less - more) / (2 * h), 1e-3 * scale * d);
    }
  }
}

// Slides of several spacings: every joint has been passed on several times, some have slid off.
// A wrong memory of how far shows only when the body turns: the gap is measured across a normal
// that turns with it.
TYPED_TEST(Joint, SlidFarTurnsFreelyAndBalances)
{
  constexpr int dim = TypeParam::dim;
  for (const bool random : {false, true}) {
    CutBody<TypeParam> body(random, 0.);
    for (int s = 1; s <= 47; ++s)
      body.place(0.05 * s * along<dim>() - 1e-3 * Vector<dim>::Unit(1));
    Spin<dim> w = 0.3 * Spin<dim>::Unit(n_spins<dim> - 1);
    if constexpr (dim == 3)
      w[0] = -0.2;
    body.turn_rigidly(w);                 // far enough for a look at the joints,
    body.turn_rigidly(Spin<dim>::Zero()); // which acts in the next step
    Particles<dim> one;
    one.resize(1);
    turn_by<dim>(one, 0, w);
    const Turn<dim> turn = Turn<dim>::of(one, 0);
    const double stored = body.force.potential_energy(body.p);
    const auto force = body.p.force;
    const auto torque = body.p.torque;
    double scale = 0;
    for (int i = 0; i < body.p.size(); ++i)
      keep_largest(scale, get(force, i).norm());
    ASSERT_GT(stored, 0);
    body.turn_rigidly(w);
    EXPECT_NEAR(body.force.potential_energy(body.p), stored, 1e-9 * stored);
    double worst = 0, worst_torque = 0;
    for (int i = 0; i < body.p.size(); ++i) {
      const Vector<dim> f = get(force, i);
      keep_largest(worst, (get(body.p.force, i) - f - turn.change(f)).norm());
      Spin<dim> t = get(torque, i);
      if constexpr (dim == 3)
        t += turn.change(t);
      keep_largest(worst_torque, (get(body.p.torque, i) - t).norm());
    }
    EXPECT_LT(worst, 1e-9 * scale);
    EXPECT_LT(worst_torque, 1e-9 * scale * body.packing.spacing);
    body.disturb_each(1e-3);
    body.expect_no_net_force_and_torque();
  }
}

// The work that moves the flank is what friction took and what is stored, over three spacings. A
// joint that slides off drops its drag at once: the trapezoidal rule is half a step times the drags
// of all joints wrong at most.
TYPED_TEST(Joint, WorkOfALongSlideIsFrictionAndEnergy)
{
  constexpr int dim = TypeParam::dim;
  const double closed = 1e-4, mu = 0.4, way = 3;
  for (const bool random : {false, true}) {
    CutBody<TypeParam> body(random, mu, dim == 2 ? 9 : 4);
    const double d = body.packing.spacing;
    const int steps = 1500;
    double work = 0, before = 0;
    body.place(-closed * Vector<dim>::Unit(1));
    const double pressed = body.force.potential_energy(body.p);
    for (int s = 1; s <= steps; ++s) {
      body.place(way * s / steps * along<dim>() - closed * Vector<dim>::Unit(1));
      const double drag = -body.force_above().dot(along<dim>());
      work += 0.5 * (drag + before) * way / steps * d;
      before = drag;
    }
    const double limit = mu * body.stiffness * closed * d;
    EXPECT_GT(work, 0.3 * limit * way * d);
    // The compression of joints that slid off was stored at the start.
    const double taken =
        body.force.frictional_work() + body.force.potential_energy(body.p) - pressed;
    EXPECT_NEAR(taken, work, 0.5 * way / steps * d * limit);
    body.disturb_each(closed / 10);
    body.expect_no_net_force_and_torque();
  }
}

// A loose piece above a cut that turns over: joints are half planes, which would push it from where
// nothing is. Once it has turned away it meets the flank as any two surfaces do, and still does
// when it comes back as it was.
// Slid off its flank, lowered and pushed back, the upper piece meets the side of the lower one with
// the rows that were its flank, too: joints that have ended keep nobody apart from anything.
TYPED_TEST(Joint, PiecesThatSlidApartMeetAgain)
{
  constexpr int dim = TypeParam::dim;
  for (const bool random : {false, true}) {
    CutBody<TypeParam> b(random, 0);
    const auto &x = b.packing.centre[0];
    const auto [low, high] = std::minmax_element(x.begin(), x.end());
    const double width = (*high - *low) / b.packing.spacing + 1, step = 0.1;
    Vector<dim> u = Vector<dim>::Zero();
    const auto go = [&](int axis, double to) {
      const int steps = int(std::ceil(std::abs(to - u[axis]) / step));
      const double from = u[axis];
      for (int s = 1; s <= steps; ++s) {
        u[axis] = from + (to - from) * s / steps;
        for (int k = 0; k < 2; ++k) // a search is due in the step after
          b.place(u);
      }
    };
    const auto push = [&] {
      double sum = 0;
      for (int i = 0; i < b.p.size(); ++i)
        if (b.is_above(i))
          sum += get(b.p.force, i).norm();
      return sum / (b.material.youngs_modulus * std::pow(b.packing.spacing, dim - 1));
    };
    go(1, 0.1);
    go(0, width + 2);
    go(1, -0.9); // by its flank row alone
    EXPECT_EQ(push(), 0);
    go(0, width - 1.2);
    EXPECT_GT(push(), 0.01);
  }
}

TYPED_TEST(Joint, PieceThatTurnsMeetsTheFlankByItsSurfaceFromThenOn)
{
  for (const bool random : {false, true}) {
    CutBody<TypeParam> body(random, 0.);
    const double touch = 1e-3 * body.stiffness * body.packing.spacing;
    const auto largest = [&] {
      double most = 0;
      for (int i = 0; i < body.p.size(); ++i)
        keep_largest(most, get(body.p.force, i).norm());
      return most;
    };
    body.place_turned(0, 8);
    ASSERT_LT(largest(), 1e-12 * touch);
    const double angle = 2;
    double lift = 8;
    body.place_turned(angle, lift);
    const auto gap = [&] { // between the centres that are nearest, in spacings
      double least = 1e30;
      for (int i = 0; i < body.p.size(); ++i)
        for (int j = 0; j < body.p.size(); ++j)
          if (body.is_above(i) && !body.is_above(j))
            keep_smallest(least, (get(body.p.reference, i) + get(body.p.displacement, i) -
                                  get(body.p.reference, j) - get(body.p.displacement, j))
                                     .norm());
      return least / body.packing.spacing;
    };
    while (gap() > 2) {
      lift -= 0.1;
      body.place_turned(angle, lift);
      ASSERT_LT(largest(), 1e-12 * touch) << "at " << lift << " without a touch";
    }
    while (gap() > 0.6) {
      lift -= 0.05;
      body.place_turned(angle, lift);
    }
    EXPECT_GT(body.force_above()[1], touch);
    body.expect_no_net_force_and_torque();

    body.place_turned(angle, 8);
    body.place_turned(0, 8);
    for (lift = 1.5; lift > -0.4; lift -= 0.05)
      body.place_turned(0, lift);
    EXPECT_GT(body.force_above()[1], touch);
  }
}
} // namespace ligament::dem::testing
