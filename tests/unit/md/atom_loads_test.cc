// Loads on the sides of crystals, crystals that cracks part, bonds that part, and what couplers are
// told of all that.
#include "core/extremes.h"
#include "tests/unit/md/bodies.h"

#include "core/check.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace ligament::md::testing
{
namespace
{
using Load = core::BoundaryLoad<2>;
using Particles = particles::Particles<2>;

/// A plane crystal that is the whole specimen.
Body<2> specimen(const Vector<2> &size = {12, 6},
                 const std::vector<packings::CrackPoints<2>> &cracks = {})
{
  const Crystal<2> crystal(plane_atoms(), {});
  CrystalShape<2> shape = box<2>(crystal, size);
  shape.anchor = 0.25 * crystal.spacing() * Vector<2>::Ones(); // no row lies on the side
  shape.specimen_lower = shape.lower;
  shape.specimen_upper = shape.upper;
  Body<2> body(plane_atoms(), {}, shape);
  for (const auto &points : cracks)
    body.packing.cuts.emplace_back(points, 1e-9 * crystal.spacing());
  return body;
}

Load load(int side, Load::Kind kind, int component, double value)
{
  Load l;
  l.boundary = side;
  l.kind = kind;
  l.value[component] = value;
  l.history = core::Ramp{1};
  return l;
}
} // namespace

// A side's atoms share its area, whichever they are.
TEST(AtomLoadsTest, SidesKeepTheirArea)
{
  const Body<2> body = specimen({12.3, 5.7});
  std::array<double, 4> area = {};
  std::array<std::set<int>, 4> atoms;
  for (const auto &face : body.packing.boundary_faces) {
    area[face.boundary] += face.area;
    EXPECT_TRUE(atoms[face.boundary].insert(face.i).second);
    EXPECT_LT(face.q, body.crystal.potential().cutoff());
    EXPECT_NEAR((get(body.packing.centre, face.i) + face.lever)[face.boundary / 2],
                face.boundary % 2 ? body.top[face.boundary / 2] : 0, 1e-12 * body.top.norm());
  }
  for (int side = 0; side < 4; ++side)
    EXPECT_NEAR(area[side], body.top[1 - side / 2], 1e-12 * body.top.norm()) << side;
}

/// A traction beside a support of the same side acts on all of its part: the atom between them is
/// held by its one side and pulled by the other.
TEST(AtomLoadsTest, TractionsBesideSupportsKeepTheirArea)
{
  Body<2> body = specimen();
  const double end = 0.43 * body.top[0], width = 2.3 * body.crystal.spacing();
  const auto part = [&](double from, double to) { return core::Part<2>::box({from, -1}, {to, 1}); };
  Load support = load(3, Load::Kind::displacement, 1, 0),
       pull = load(3, Load::Kind::traction, 1, 1);
  support.part = part(-1, end);
  pull.part = part(end, end + width);
  AtomForce<2> force(body.crystal, body.packing, body.options, {support, pull});
  force.compute(body.atoms, 2);
  const double expected = width * body.packing.thickness;
  EXPECT_NEAR(force.reaction(1)[1] / expected, 1, 1e-9);
  // Where both are on the same part the support holds.
  pull.part = part(end - width, end);
  AtomForce<2> none(body.crystal, body.packing, body.options, {support, pull});
  none.compute(body.atoms, 2);
  EXPECT_NEAR(none.reaction(1)[1] / expected, 0, 1e-9);
}

// Inside a specimen there is no side to load.
TEST(AtomLoadsTest, ZonesInsideHaveNoSides)
{
  const Crystal<2> crystal(plane_atoms(), {});
  CrystalShape<2> shape = box<2>(crystal, {8, 5});
  EXPECT_TRUE(cut_crystal(crystal, shape).boundary_faces.empty());
  shape.specimen_upper = shape.upper;
  shape.specimen_lower = -shape.upper;
  for (const auto &face : cut_crystal(crystal, shape).boundary_faces)
    EXPECT_EQ(face.boundary % 2, 1);
}

TEST(AtomLoadsTest, ForcesReactionsAndWorkAreThoseOfSpringsAndTractions)
{
  Body<2> body = specimen();
  const double d = body.crystal.spacing(), pull = 0.01 * d,
               modulus = body.crystal.elastic_constants().stiffness(0, 0), t = 1e-3 * modulus;
  const auto make = [&](const std::vector<Load> &loads) {
    return AtomForce<2>(body.crystal, body.packing, body.options, loads);
  };
  auto plain = make({});
  auto force =
      make({load(1, Load::Kind::displacement, 0, pull), load(3, Load::Kind::traction, 1, t)});
  body.disturb(0.02 * d);
  Particles &p = body.atoms;
  plain.compute(p, 2);
  const auto free = p.force;
  force.compute(p, 2);
  Vector<2> on_right = Vector<2>::Zero(), on_top = Vector<2>::Zero();
  std::vector<double> springs(p.size(), 0.), area(p.size(), 0.);
  for (const auto &face : body.packing.boundary_faces) {
    springs[face.i] += face.boundary == 1 ? modulus / d * face.area : 0;
    area[face.i] += face.boundary == 3 ? face.area : 0;
  }
  double energy = 0;
  const double scale = modulus * d;
  for (int i = 0; i < p.size(); ++i) {
    const double stretch = pull - p.displacement[0][i];
    energy += 0.5 * springs[i] * stretch * stretch;
    EXPECT_NEAR(p.force[0][i] - free[0][i], springs[i] * stretch, 1e-14 * scale);
    EXPECT_NEAR(p.force[1][i] - free[1][i], area[i] * t, 1e-14 * scale);
    on_right[0] += springs[i] * stretch;
    on_top[1] += area[i] * t;
  }
  EXPECT_LT((force.reaction(0) - on_right).norm(), 1e-13 * scale);
  EXPECT_LT((force.reaction(1) - on_top).norm(), 1e-13 * scale);
  EXPECT_NEAR(on_top[1], t * body.top[0], 1e-13 * scale);
  EXPECT_NEAR(force.potential_energy(p) - plain.potential_energy(p), energy, 1e-14 * scale * d);

  // From the start of the loads on, on a body that does not move: what the springs take.
  auto held = make({load(1, Load::Kind::displacement, 0, pull)});
  for (const double time : {0., 0.2, 0.5, 0.9, 1.})
    held.compute(p, time);
  auto at_start = make({load(1, Load::Kind::displacement, 0, pull)});
  at_start.compute(p, 0);
  EXPECT_NEAR(held.external_work(), held.potential_energy(p) - at_start.potential_energy(p),
              1e-13 * scale * d);
  EXPECT_GT(held.external_work(), 1e-6 * scale * d);

  // A traction that is there in full does the work of the way of its atoms.
  auto pulled = make({load(3, Load::Kind::traction, 1, t)});
  pulled.compute(p, 2);
  const double before = pulled.external_work();
  double work = 0;
  Noise noise(9);
  for (int i = 0; i < p.size(); ++i) {
    const double way = 0.01 * d * noise();
    p.displacement[1][i] += way;
    work += area[i] * t * way;
  }
  pulled.compute(p, 3);
  EXPECT_NEAR(pulled.external_work() - before, work, 1e-14 * scale * d);
  EXPECT_GT(std::abs(work), 1e-8 * scale * d);
}

// A body in motion between springs that move: what the loads put in is there.
TEST(AtomLoadsTest, EnergyIsKept)
{
  Body<2> body = specimen();
  const double d = body.crystal.spacing();
  AtomForce<2> force(
      body.crystal, body.packing, body.options,
      {load(1, Load::Kind::displacement, 0, 0.02 * d), load(0, Load::Kind::displacement, 0, 0)});
  Particles &p = body.atoms;
  const double dt = 0.02 * force.stable_step(p);
  for (auto *values : {&p.velocity, &p.displacement})
    for (auto &component : *values)
      std::fill(component.begin(), component.end(), 0.);
  const double end = 200 * dt;
  auto loads = std::vector<Load>{load(1, Load::Kind::displacement, 0, 0.02 * d),
                                 load(0, Load::Kind::displacement, 0, 0)};
  for (auto &l : loads)
    l.history = core::Ramp{end};
  force = AtomForce<2>(body.crystal, body.packing, body.options, loads);
  double kinetic = 0;
  for (int step = 0; step <= 400; ++step) {
    force.compute(p, step * dt);
    kinetic = 0;
    for (int c = 0; c < 2; ++c)
      for (int i = 0; i < p.size(); ++i) {
        const double before = p.velocity[c][i];
        p.velocity[c][i] += dt * p.force[c][i] / p.mass[i];
        kinetic += 0.5 * p.mass[i] * before * p.velocity[c][i];
      }
    if (step < 400)
      for (int c = 0; c < 2; ++c)
        for (int i = 0; i < p.size(); ++i)
          p.displacement[c][i] += dt * p.velocity[c][i];
  }
  const double potential = force.potential_energy(p), work = force.external_work();
  EXPECT_GT(kinetic, 0.01 * work);
  // Verlet's error goes with the square of the step: (omega dt)^2/24 at the fastest.
  EXPECT_NEAR(kinetic + potential, work, 1e-4 * work);
}

TEST(AtomLoadsTest, TwoSupportsOfOneSideAreRefused)
{
  Body<2> body = specimen();
  const std::vector<Load> loads = {load(1, Load::Kind::displacement, 0, 1e-12),
                                   load(1, Load::Kind::velocity, 0, 1)};
  EXPECT_THROW(AtomForce<2>(body.crystal, body.packing, body.options, loads), core::InputError);
  Load pressed;
  pressed.boundary = 1;
  pressed.kind = Load::Kind::traction;
  pressed.pressure = 1e6;
  EXPECT_THROW(AtomForce<2>(body.crystal, body.packing, body.options, {pressed}), core::InputError);
}

TEST(AtomLoadsTest, GoesOnFromItsState)
{
  Body<2> body = specimen();
  const double d = body.crystal.spacing();
  const std::vector<Load> loads = {
      load(1, Load::Kind::displacement, 0, 0.05 * d),
      load(3, Load::Kind::traction, 1, 1e-3 * body.crystal.elastic_constants().stiffness(0, 0))};
  const auto make = [&] { return AtomForce<2>(body.crystal, body.packing, body.options, loads); };
  AtomForce<2> force = make();
  Particles &p = body.atoms;
  const auto step = [&](AtomForce<2> &f, Particles &atoms, unsigned seed) {
    Noise noise(seed);
    for (auto &component : atoms.displacement)
      for (double &u : component)
        u += 0.03 * d * noise();
    f.compute(atoms, 0.1 * seed);
  };
  for (unsigned s = 1; s < 6; ++s)
    step(force, p, s);
  const core::Names names(p.global_id.list());
  core::State state;
  p.save(state, names);
  force.save(state, names, p);
  Particles again = body.atoms;
  for (auto &component : again.displacement)
    std::fill(component.begin(), component.end(), 0.);
  again.load(state, names);
  AtomForce<2> loaded = make();
  loaded.load(state, names, again);
  for (unsigned s = 6; s < 9; ++s) {
    step(force, p, s);
    step(loaded, again, s);
  }
  EXPECT_EQ(loaded.external_work(), force.external_work());
  EXPECT_EQ(loaded.potential_energy(again), force.potential_energy(p));
  EXPECT_EQ(again.force, p.force);
}

// A crack through the whole body leaves two, which feel nothing of each other.
TEST(CrackScreenTest, PartsWhatItCuts)
{
  const Body<2> whole = specimen();
  const double height = 0.5 * whole.top[1], far = 2 * whole.top[0];
  Body<2> cut = specimen({12, 6}, {{{-far, height}, {far, height}}});
  cut.disturb(0.05 * cut.crystal.spacing());
  auto force = cut.force();
  force.compute(cut.atoms, 0);
  int n = 0;
  for (const bool upper : {false, true}) {
    CrystalShape<2> shape = box<2>(cut.crystal, {12, 6});
    shape.anchor = 0.25 * cut.crystal.spacing() * Vector<2>::Ones();
    shape.keep = [&](const Vector<2> &x) { return (x[1] > height) == upper; };
    Body<2> half(plane_atoms(), {}, shape);
    for (int i = 0, k = 0; i < cut.atoms.size(); ++i)
      if ((cut.atoms.reference[1][i] > height) == upper)
        set(half.atoms.displacement, k++, get(cut.atoms.displacement, i));
    auto alone = half.force();
    alone.compute(half.atoms, 0);
    for (int i = 0, k = 0; i < cut.atoms.size(); ++i)
      if ((cut.atoms.reference[1][i] > height) == upper) {
        ASSERT_EQ(get(cut.atoms.reference, i), get(half.atoms.reference, k));
        EXPECT_LT((get(cut.atoms.force, i) - get(half.atoms.force, k)).norm(),
                  1e-13 * cut.stiffness() * cut.crystal.spacing());
        ++k;
        ++n;
      }
  }
  EXPECT_EQ(n, cut.atoms.size());
}

// A short crack cuts the pairs whose vector crosses it, also in the terms that couplers ask for.
TEST(CrackScreenTest, CutsThePairsThatCrossIt)
{
  const Body<2> whole = specimen();
  const Vector<2> from(0.3 * whole.top[0], 0.5 * whole.top[1]),
      to(0.7 * whole.top[0], 0.5 * whole.top[1]);
  const Body<2> cut = specimen({12, 6}, {{from, to}});
  const auto pairs = [](const Body<2> &body) {
    std::set<std::pair<int, int>> found;
    body.force().for_each_neighbour(body.atoms, [&](const particles::Neighbour &n) {
      if (n.i < n.j)
        found.insert({n.i, n.j});
    });
    return found;
  };
  const auto all = pairs(whole), left = pairs(cut);
  std::set<std::pair<int, int>> expected;
  for (const auto &[i, j] : all) {
    const Vector<2> a = get(whole.atoms.reference, i), b = get(whole.atoms.reference, j);
    const double above = (a[1] - from[1]) / (a[1] - b[1]);
    const double x = a[0] + above * (b[0] - a[0]);
    if (!(above > 0 && above < 1 && x > from[0] && x < to[0]))
      expected.insert({i, j});
  }
  EXPECT_EQ(left, expected);
  EXPECT_LT(left.size() + 10, all.size());
  std::set<std::pair<int, int>> terms;
  cut.force().add_tangent(cut.atoms, [&](const particles::QuadraticTerm<2> &term) {
    if (term.kind == particles::QuadraticTerm<2>::Kind::bond)
      terms.insert(std::minmax(term.members[0], term.members[1]));
  });
  EXPECT_EQ(terms, left);
}

// Open are those that lack neighbours, and the reference is at rest but for atoms that see such.
TEST(CouplingTest, OpenAtomsLackNeighbours)
{
  const Body<2> body = specimen({14, 7});
  const auto force = body.force();
  std::vector<int> all(body.atoms.size());
  std::iota(all.begin(), all.end(), 0);
  const auto open = force.open_particles(body.atoms, all);
  const double range = force.range();
  std::set<int> edge(open.begin(), open.end());
  EXPECT_GT(open.size(), 10u);
  EXPECT_LT(open.size(), all.size());
  for (const int i : all) {
    const Vector<2> x = get(body.atoms.reference, i);
    const double depth = std::min(x.minCoeff(), (body.top - x).minCoeff());
    if (depth > range) {
      EXPECT_EQ(edge.count(i), 0u);
    } else if (depth < 0.5 * body.crystal.spacing()) {
      EXPECT_EQ(edge.count(i), 1u);
    }
  }
  force.for_each_neighbour(
      body.atoms, [&](const particles::Neighbour &n) { edge.insert(n.j); }, &open);
  Components<2> left;
  force.reference_forces(body.atoms, left);
  double largest = 0;
  for (const int i : all)
    if (edge.count(i) == 0)
      EXPECT_LT(get(left, i).norm(), 1e-13 * body.stiffness() * body.crystal.spacing());
    else
      keep_largest(largest, get(left, i).norm());
  EXPECT_GT(largest, 1e-4 * body.stiffness() * body.crystal.spacing());
  EXPECT_EQ(force.elastic_constants().stress.norm(), 0);
}

// Bonds of nearest neighbours part where a slit is drawn open, each once, and stay parted.
TEST(PartedBondsTest, AreSeenOnce)
{
  Body<2> body = specimen({12, 6});
  const double d = body.crystal.spacing(), middle = 0.5 * body.top[1];
  auto force = body.force();
  Particles &p = body.atoms;
  int n_crossing = 0;
  force.for_each_face(p, [&](const particles::FaceView<2> &face) {
    n_crossing += p.reference[1][face.i] < middle && p.reference[1][face.j] > middle;
    EXPECT_TRUE(face.bonded);
    EXPECT_NEAR(face.area, d / std::sqrt(3.), 1e-12 * d); // of a cell of thickness 1
  });
  const auto open = [&](double gap) {
    for (int i = 0; i < p.size(); ++i)
      p.displacement[1][i] = p.reference[1][i] > middle ? gap : 0;
    force.compute(p, gap / d);
  };
  open(0.2 * d);
  EXPECT_TRUE(force.broken_bonds().empty());
  open(1.2 * d);
  EXPECT_EQ(int(force.broken_bonds().size()), n_crossing);
  EXPECT_GT(n_crossing, 20);
  open(0);
  open(1.5 * d);
  EXPECT_EQ(int(force.broken_bonds().size()), n_crossing);
  double length = 0;
  for (const auto &bond : force.broken_bonds()) {
    EXPECT_NEAR(bond.time, 1.2, 1e-12);
    EXPECT_NEAR(bond.position[1], middle, d);
    length += bond.area * std::abs(bond.normal[1]);
  }
  // Two bonds per atom of the row, each seen as half a spacing.
  EXPECT_NEAR(length, n_crossing * d / 2, 1e-12 * d);
  int n_parted = 0;
  force.for_each_face(p, [&](const particles::FaceView<2> &face) { n_parted += !face.bonded; });
  EXPECT_EQ(n_parted, 2 * n_crossing);
}

// Heat stretches bonds for a moment: at a temperature they must stay longer for a time.
TEST(PartedBondsTest, OfWarmAtomsMustLast)
{
  Body<2> body = specimen({12, 6});
  body.options.is_warm = true;
  const double d = body.crystal.spacing(), middle = 0.5 * body.top[1],
               lasting = 10 * d / body.crystal.elastic_constants().wave_speed_p;
  auto force = body.force();
  Particles &p = body.atoms;
  const auto open = [&](double gap, double time) {
    for (int i = 0; i < p.size(); ++i)
      p.displacement[1][i] = p.reference[1][i] > middle ? gap : 0;
    force.compute(p, time * lasting);
  };
  open(1.2 * d, 0);
  open(0, 0.5); // back again
  open(1.2 * d, 1.2);
  EXPECT_TRUE(force.broken_bonds().empty());
  // They are looked at when their time has come, though no atom moves. Another force goes on as this
  // one does.
  const core::Names names(p.global_id.list());
  core::State state;
  force.save(state, names, p);
  auto other = body.force();
  other.load(state, names, p);
  for (auto *f : {&force, &other}) {
    f->compute(p, 2.1 * lasting);
    EXPECT_TRUE(f->broken_bonds().empty());
    f->compute(p, 2.3 * lasting);
    EXPECT_GT(f->broken_bonds().size(), 20u);
    for (const auto &bond : f->broken_bonds())
      EXPECT_NEAR(bond.time, 1.2 * lasting, 1e-12 * lasting);
  }
  EXPECT_EQ(force.broken_bonds().size(), other.broken_bonds().size());
}

// One look may see many that have been longer for a while: they are told in the order of time.
TEST(PartedBondsTest, OfWarmAtomsAreInTheOrderOfTime)
{
  Body<2> body = specimen({12, 6});
  body.options.is_warm = true;
  const double d = body.crystal.spacing(),
               lasting = 10 * d / body.crystal.elastic_constants().wave_speed_p;
  auto force = body.force();
  Particles &p = body.atoms;
  const auto open = [&](double lower, double upper, double time) {
    for (int i = 0; i < p.size(); ++i)
      p.displacement[1][i] = (p.reference[1][i] > 0.3 * body.top[1] ? lower : 0) +
                             (p.reference[1][i] > 0.7 * body.top[1] ? upper : 0);
    force.compute(p, time * lasting);
  };
  open(0, 1.2 * d, 0);
  open(1.2 * d, 1.2 * d, 0.5);
  EXPECT_TRUE(force.broken_bonds().empty());
  open(1.3 * d, 1.3 * d, 2);
  const auto &broken = force.broken_bonds();
  ASSERT_GT(broken.size(), 40u);
  EXPECT_EQ(broken.front().time, 0);
  EXPECT_NEAR(broken.back().time, 0.5 * lasting, 1e-12 * lasting);
  EXPECT_TRUE(std::is_sorted(broken.begin(), broken.end(),
                             [](const auto &a, const auto &b) { return a.time < b.time; }));
}

// A whole crystal that is strained or turns has lost no bond.
TEST(PartedBondsTest, StrainAndRotationPartNothing)
{
  Body<2> body = specimen({12, 6});
  Matrix<2> gradient;
  gradient << std::cos(0.8) * 1.15 - 1, -std::sin(0.8), std::sin(0.8) * 1.15, std::cos(0.8) - 1;
  for (int i = 0; i < body.atoms.size(); ++i)
    set(body.atoms.displacement, i, Vector<2>(gradient * get(body.atoms.reference, i)));
  auto force = body.force();
  force.compute(body.atoms, 1);
  EXPECT_TRUE(force.broken_bonds().empty());
}
} // namespace ligament::md::testing
