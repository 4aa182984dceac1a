// Contacts that become bonds again: nothing jumps, forces are a gradient, energies add up over many
// cycles, adhesion ends at its strength, states go on to the bit, numbering changes nothing.
#include "core/extremes.h"
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/force_slope.h"
#include "tests/unit/dem/run.h"
#include "tests/unit/dem/softening_bodies.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
namespace
{
template <typename D>
struct Rebonded : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Rebonded, Dimensions);

/// A block a third of whose faces are cracked, pressed, sheared and turned.
template <int dim>
struct Pressed
{
  Packing<dim> packing = ragged_lattice<dim>(4, 7);
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0.4};
  FractureLaw law;
  std::unique_ptr<ManyBodyForce<dim>> force;
  Particles<dim> p;

  /// `size` of the cracked faces.
  explicit Pressed(bool flows, double poissons_ratio = 0.3, double size = 1)
  {
    material.poissons_ratio = poissons_ratio;
    if (flows)
      material.plasticity = VonMisesFlow{{10., 0., 0., 0., {}, {}}}; // never reached
    law.rebonding = {{1e-3, 0, 0.05}};
    int n = 0;
    for (auto &face : packing.faces)
      if (face.cracked = n++ % 3 == 0; face.cracked)
        face.area *= size;
    force = make();
    p = at_rest(packing, material);
    if (flows)
      for (int i = 0; i < p.size(); ++i) {
        typename InelasticStrains<dim>::Tensor e;
        for (int c = 0; c < e.size(); ++c)
          e[c] = 2e-2 * std::sin(3. * i + c);
        force->strains().set_strain(i, e);
      }
    move(1);
  }
  std::unique_ptr<ManyBodyForce<dim>> make() const
  {
    return std::make_unique<ManyBodyForce<dim>>(packing, material,
                                                std::vector<core::BoundaryLoad<dim>>(), law);
  }
  /// Further and further from rest; at 1 pressed together.
  void move(double by)
  {
    for (int i = 0; i < p.size(); ++i) {
      const Vector<dim> x = get(p.reference, i);
      Vector<dim> u = -0.02 * x;
      u[0] += 4e-3 * packing.spacing * by * std::sin(7 * x[1] + 3 * x[0]);
      u[1] += 6e-3 * packing.spacing * by * std::cos(5 * x[0]);
      set(p.displacement, i, u);
      const double angle = 0.02 + 3e-3 * by * std::sin(3 * x[0] + 2 * x[1]);
      if constexpr (dim == 2)
        p.rotation[0][i] = angle;
      else {
        const Vector<3> axis = Vector<3>(std::sin(i), 1, 0.5).normalized();
        p.rotation[0][i] = std::cos(angle / 2);
        for (int c = 0; c < 3; ++c)
          p.rotation[c + 1][i] = std::sin(angle / 2) * axis[c];
      }
    }
  }
};

template <int dim>
double difference(const Particles<dim> &a, const Particles<dim> &b, double lever)
{
  double largest = 0, error = 0;
  for (int i = 0; i < a.size(); ++i) {
    keep_largest(largest, get(a.force, i).norm());
    error = std::max({error, (get(a.force, i) - get(b.force, i)).norm(),
                      (get(a.torque, i) - get(b.torque, i)).norm() / lever});
  }
  return error / largest;
}

TYPED_TEST(Rebonded, NothingJumps)
{
  constexpr int dim = TypeParam::value;
  for (const bool flows : {false, true})
    for (const double nu : {0., 0.3, 0.45}) {
      Pressed<dim> body(flows, nu);
      auto &force = *body.force;
      force.compute(body.p, 1);
      const auto before = body.p;
      const double energy = force.potential_energy(body.p), friction = force.frictional_work();
      ASSERT_EQ(force.rebonded().n_bonds(), 0);
      ASSERT_GT(force.rebonded().all().size(), 4u);
      Components<n_strains<dim>> stress, stress_after;
      force.stresses(body.p, stress);
      force.compute(body.p, 2);
      ASSERT_EQ(force.rebonded().n_bonds(), int(force.rebonded().all().size()));
      EXPECT_LT(difference(before, body.p, body.packing.spacing), 1e-13) << flows << ' ' << nu;
      EXPECT_EQ(force.frictional_work(), friction);
      EXPECT_NE(force.rebonding_energy(), 0);
      EXPECT_NEAR(force.potential_energy(body.p) + force.rebonding_energy(), energy, 1e-13 * energy)
          << flows << ' ' << nu;
      force.stresses(body.p, stress_after);
      for (int c = 0; c < n_strains<dim>; ++c)
        for (int i = 0; i < body.p.size(); ++i)
          EXPECT_NEAR(stress[c][i], stress_after[c][i], 1e-12);
    }
}

// Its bending falls with the square of a face's area: a sliver would turn by more than there is.
TYPED_TEST(Rebonded, SliversStayContacts)
{
  constexpr int dim = TypeParam::value;
  for (const double size : {1e-2, 1e-4, 1e-6}) {
    Pressed<dim> body(true, 0.3, size);
    auto &force = *body.force;
    for (int step = 1; step <= 3; ++step) {
      force.compute(body.p, step);
      for (int i = 0; i < body.p.size(); ++i)
        ASSERT_TRUE(get(body.p.force, i).allFinite() && get(body.p.torque, i).allFinite()) << size;
    }
    EXPECT_LT(std::abs(force.rebonding_energy()), force.potential_energy(body.p)) << size;
    if (size < 1e-3) {
      EXPECT_EQ(force.rebonded().n_bonds(), 0);
    }
  }
}

TYPED_TEST(Rebonded, ForceIsMinusTheGradient)
{
  constexpr int dim = TypeParam::value;
  for (const bool flows : {false, true}) {
    Pressed<dim> body(flows);
    auto &force = *body.force;
    force.compute(body.p, 1);
    force.compute(body.p, 2);
    ASSERT_GT(force.rebonded().n_bonds(), 4);
    body.move(2.5);
    auto p = body.p;
    force.compute(p, 3);
    force.compute(p, 3);
    double scale = 0;
    Vector<dim> net = Vector<dim>::Zero();
    for (int i = 0; i < p.size(); ++i) {
      keep_largest(scale, get(p.force, i).norm());
      net += get(p.force, i);
    }
    EXPECT_LT(net.norm(), 1e-13 * scale);
    const ::testing::ScopedTrace trace(__FILE__, __LINE__, flows ? "flows" : "elastic");
    expect_minus_slope<dim>(p, {1e-5, 1e-5}, 1e-8, 1, 1,
                            [&](const auto &q) { return force.potential_energy(q); });
  }
}

TYPED_TEST(Rebonded, GoesOnFromItsStateToTheBit)
{
  constexpr int dim = TypeParam::value;
  for (const bool flows : {false, true})
    for (const int saved_at : {1, 2, 4}) {
      Pressed<dim> body(flows);
      const core::Names names(body.p.global_id.list());
      for (int step = 1; step <= saved_at; ++step) {
        body.move(step);
        body.force->compute(body.p, step);
      }
      core::State state;
      body.p.save(state, names);
      body.force->save(state, names, body.p);
      const auto other = body.make();
      auto q = body.p;
      other->load(state, names, q);
      ASSERT_GT(body.force->rebonded().all().size(), 0u);
      for (int step = saved_at; step < saved_at + 8; ++step) {
        body.move(step * (step > saved_at + 4 ? -3. : 1.));
        q.displacement = body.p.displacement, q.rotation = body.p.rotation;
        body.force->compute(body.p, step);
        other->compute(q, step);
        for (int i = 0; i < q.size(); ++i) {
          for (int c = 0; c < dim; ++c)
            ASSERT_EQ(body.p.force[c][i], q.force[c][i]) << saved_at << ' ' << step;
          for (int c = 0; c < n_spins<dim>; ++c)
            ASSERT_EQ(body.p.torque[c][i], q.torque[c][i]);
        }
        ASSERT_EQ(body.force->rebonding_energy(), other->rebonding_energy());
        ASSERT_EQ(body.force->fracture_energy(), other->fracture_energy());
        ASSERT_EQ(body.force->potential_energy(body.p), other->potential_energy(q));
      }
      EXPECT_GT(body.force->fracture_energy(), 0); // some broke again
    }
}

TYPED_TEST(Rebonded, LookingTwiceChangesNothing)
{
  constexpr int dim = TypeParam::value;
  Pressed<dim> body(false);
  const core::Names names(body.p.global_id.list());
  for (int step = 1; step < 5; ++step) {
    body.move(step);
    body.force->compute(body.p, step);
    core::State once, twice;
    body.force->save(once, names, body.p);
    const auto p = body.p;
    body.force->compute(body.p, step);
    body.force->save(twice, names, body.p);
    EXPECT_EQ(difference(p, body.p, 1.), 0);
    expect_same_numbers(once, twice);
  }
}

TYPED_TEST(Rebonded, NumberingChangesNothing)
{
  constexpr int dim = TypeParam::value;
  Pressed<dim> a(false), b(false);
  const int n = a.packing.size();
  const auto place = [&](int i) { return (i * 7 + 3) % n; };
  auto &q = b.packing;
  q.global_id.resize(n);
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < dim; ++c)
      q.centre[c][place(i)] = a.packing.centre[c][i];
    q.volume[place(i)] = a.packing.volume[i];
    q.global_id[place(i)] = i;
  }
  for (auto &f : q.faces) {
    f.i = place(f.i), f.j = place(f.j);
    f.direction = -1;
  }
  q.directions.clear();
  q.boundary_faces = a.packing.boundary_faces;
  for (auto &f : q.boundary_faces)
    f.i = place(f.i);
  a.packing.directions.clear();
  for (auto &f : a.packing.faces)
    f.direction = -1;
  a.force = a.make(), b.force = b.make();
  b.p = at_rest(q, b.material);
  b.p.global_id = particles::GlobalIds(q.global_id);
  for (int step = 1; step < 7; ++step) {
    a.move(step < 5 ? step : -3. * step);
    for (int i = 0; i < n; ++i) {
      for (int c = 0; c < dim; ++c)
        b.p.displacement[c][place(i)] = a.p.displacement[c][i];
      for (std::size_t c = 0; c < a.p.rotation.size(); ++c)
        b.p.rotation[c][place(i)] = a.p.rotation[c][i];
    }
    a.force->compute(a.p, step);
    b.force->compute(b.p, step);
    ASSERT_EQ(a.force->rebonded().all().size(), b.force->rebonded().all().size());
    auto other = b.force->rebonded().all().begin();
    for (const auto &[name, face] : a.force->rebonded().all())
      EXPECT_EQ(name, (other++)->first);
    double scale = 0;
    for (int i = 0; i < n; ++i)
      keep_largest(scale, get(a.p.force, i).norm());
    for (int i = 0; i < n; ++i)
      EXPECT_LT((get(a.p.force, i) - get(b.p.force, place(i))).norm(), 1e-11 * scale);
    EXPECT_NEAR(a.force->rebonding_energy(), b.force->rebonding_energy(),
                1e-11 * std::abs(a.force->rebonding_energy()));
    EXPECT_NEAR(a.force->fracture_energy(), b.force->fracture_energy(),
                1e-10 * std::abs(a.force->fracture_energy()));
  }
  EXPECT_GT(a.force->fracture_energy(), 0);
}

/// Two cubes or squares whose faces touch, held by smooth plates at their ends.
template <int dim>
packings::Packing<dim> touching()
{
  auto p = column<dim>();
  p.faces[0].cracked = true;
  return p;
}

template <int dim>
std::vector<core::BoundaryLoad<dim>> plates(double closing, const core::TimeFunction &course)
{
  std::vector<core::BoundaryLoad<dim>> loads(2);
  for (int end = 0; end < 2; ++end) {
    loads[end].boundary = 2 + end;
    loads[end].kind = core::BoundaryLoad<dim>::Kind::displacement;
    loads[end].value[1] = (end ? -0.5 : 0.5) * closing;
    loads[end].history = course;
  }
  return loads;
}

constexpr double youngs_modulus = 3e10, density = 2500;

/// Pressed together, bonded, drawn apart: it bears the strength of adhesion and not more.
TYPED_TEST(Rebonded, AdhesionEndsAtItsStrength)
{
  constexpr int dim = TypeParam::value;
  const auto packing = touching<dim>();
  const double d = packing.spacing, area = packing.faces[0].area;
  for (const double nu : {0., 0.3}) {
    const DemMaterial material{youngs_modulus, nu, density, PlaneMode::strain, 0.3};
    FractureLaw law;
    law.rebonding = {{4e6, 0, 2e6}};
    const double period = d / 3000, ramp = 4000 * period, strain = 3e-4, damping = 2 / period;
    const core::TimeTable course({{0, 0}, {ramp, 1}, {3 * ramp, -1}});
    Run<dim> run(packing, material, plates<dim>(strain * 2 * d, course), law);
    double pressed = 0, most = 0, when_bonded = 0, residual = 0;
    while (run.time < 3 * ramp && run.force->fracture_energy() == 0) {
      const int before = run.force->rebonded().n_bonds();
      run.step(damping);
      const double stress = run.force->reaction(1)[1] / area;
      keep_smallest(pressed, stress), keep_largest(most, stress);
      if (run.force->rebonded().n_bonds() > before)
        when_bonded = stress;
      keep_largest(residual, std::abs(run.residual()));
    }
    EXPECT_GT(run.force->fracture_energy(), 0);
    // What the damping holds of two particles, and a step changes.
    const double rate = 2 * strain / ramp, tolerance = 2 * density * d * damping * rate * d +
                                                       1.2 * youngs_modulus * rate * run.dt;
    EXPECT_NEAR(when_bonded, -4e6, tolerance);
    EXPECT_LT(pressed, -5e6);
    EXPECT_NEAR(most, 2e6, tolerance);
    EXPECT_LT(tolerance, 0.02 * 2e6);
    const double whole = 0.5 * pressed * pressed / youngs_modulus * area * 2 * d;
    EXPECT_LT(residual, 1e-3 * whole); // the strain
  }
}

/// Shaken without damping: bonded and torn over and over.
template <int dim>
void expect_balance(int n_cycles, const std::vector<double> &poissons_ratios)
{
  const auto packing = touching<dim>();
  const double d = packing.spacing, area = packing.faces[0].area;
  for (const double nu : poissons_ratios) {
    const DemMaterial material{youngs_modulus, nu, density, PlaneMode::strain, 0.3};
    // The law is exactly linear for no strain.
    constexpr double small = 1e-7; // and overlaps are known to 1e-16 of the distance
    const double stress = youngs_modulus * small, period = d / 3000;
    FractureLaw law;
    law.rebonding = {{0.4 * stress, 0, 0.3 * stress}};
    const core::Cycles course{core::Ramp{0}, 0, 1, 33 * period};
    Run<dim> run(packing, material, plates<dim>(small * 2 * d, course), law);
    run.dt = 0.2 * period; // the force's step knows of no bond between the two
    const double whole = 0.5 * stress * stress / youngs_modulus * area * 2 * d;
    int n_bonded = 0, n_torn = 0, last = 0;
    double worst = 0, early = 0, thrown = 0;
    while (n_torn < n_cycles && run.time < 400. * n_cycles * period) {
      run.step();
      const int now = run.force->rebonded().n_bonds();
      n_bonded += now > last, n_torn += now < last;
      last = now;
      keep_largest(worst, std::abs(run.residual()));
      keep_largest(thrown, run.mechanical());
      if (n_torn <= n_cycles / 10)
        early = worst;
    }
    EXPECT_EQ(n_torn, n_cycles) << n_bonded;
    EXPECT_LT(worst, 1e-6 * whole)
        << dim << ' ' << nu << " early " << early / whole << " thrown " << thrown / whole;
  }
}
TYPED_TEST(Rebonded, BalanceOverCycles)
{
  expect_balance<TypeParam::value>(200, {0, 0.3});
}
TEST(SlowRebonded, HundredThousandCycles2D)
{
  expect_balance<2>(100000, {0.3});
}
TEST(SlowRebonded, HundredThousandCycles3D)
{
  expect_balance<3>(100000, {0.3});
}

/// Of the faces of a cut those are bonded whose pressure and whose particles' strains suffice.
TYPED_TEST(Rebonded, AsksForTheStrainOfBothSides)
{
  constexpr int dim = TypeParam::value;
  auto lattice = box<Case<dim, dim == 2 ? Kind::hexagonal : Kind::fcc, true>>(dim == 2 ? 12 : 6);
  const Vector<dim> lower = 2 * lattice.lower, upper = 2 * lattice.upper;
  const double y = 0.13 * lattice.spacing;
  if constexpr (dim == 2)
    lattice.cracks = {{{lower[0], y}, {upper[0], y}}};
  else
    lattice.cracks = {{{lower[0], y, lower[2]},
                       {lower[0], y, upper[2]},
                       {upper[0], y, upper[2]},
                       {upper[0], y, lower[2]}}};
  const auto packing = packings::make_lattice_packing<dim>(lattice);
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0.3};
  material.plasticity = VonMisesFlow{{2e-3, 0.1, 0., 0., {}, {}}};
  FractureLaw law;
  int n_some = 0;
  for (const double strain : {0., 1e-3, 6e-3, 0.1}) {
    law.rebonding = {{1e-3, strain, 1}};
    ManyBodyForce<dim> force(packing, material, {}, law);
    Particles<dim> p = at_rest(packing, material);
    for (int step = 1; step < 20; ++step) {
      for (int i = 0; i < p.size(); ++i) {
        const Vector<dim> x = get(packing.centre, i);
        set(p.displacement, i,
            Vector<dim>(-5e-4 * step * x[1] * (1 + 8 * x[0]) * Vector<dim>::Unit(1)));
      }
      force.compute(p, step);
    }
    int n_expected = 0, n_faces = 0;
    const double sliver = 0.02 * std::pow(packing.spacing, dim - 1) * packing.thickness;
    for (const auto &face : packing.faces)
      if (face.cracked && face.area > sliver) { // those may stay contacts
        const double least = std::min(force.plastic_strain(face.i), force.plastic_strain(face.j));
        n_expected += least >= strain, ++n_faces;
        const auto [first, second] =
            std::minmax({packing.global_id[face.i], packing.global_id[face.j]});
        EXPECT_EQ(force.rebonded().all().count({first, second, face.cut + 1}) > 0, least >= strain)
            << strain << ", of " << face.area;
      }
    n_some += n_expected > 0 && n_expected < n_faces;
    if (strain == 0) {
      EXPECT_EQ(n_expected, n_faces);
    }
    if (strain == 0.1) {
      EXPECT_EQ(n_expected, 0);
    }
  }
  EXPECT_GT(n_some, 0);
  law.rebonding = {{0.5, 0, 1}}; // more than presses
  ManyBodyForce<dim> force(packing, material, {}, law);
  Particles<dim> p = at_rest(packing, material);
  for (int i = 0; i < p.size(); ++i)
    p.displacement[1][i] = -0.01 * packing.centre[1][i];
  force.compute(p, 1);
  force.compute(p, 2);
  EXPECT_TRUE(force.rebonded().all().empty());
}

/// Particles that were never neighbours: nothing jumps, a turn of the whole turns the forces.
TYPED_TEST(Rebonded, BondsWhatASearchFound)
{
  constexpr int dim = TypeParam::value;
  auto packing = touching<dim>(); // its face lets contacts be looked for
  const double d = packing.spacing;
  for (int c = 0; c < dim; ++c)
    packing.centre[c].push_back(c == 0 ? 2.2 * d : c == 1 ? 0.9 * d : 0.1 * d);
  packing.volume.push_back(packing.volume[0]);
  packing.global_id.push_back(2);
  for (int c = 0; c < dim; ++c)
    for (const int end : {-1, 1})
      packing.boundary_faces.push_back(
          {2, Vector<dim>(end * Vector<dim>::Unit(c)), packing.faces[0].area, d / 2,
           Vector<dim>(end * d / 2 * Vector<dim>::Unit(c)), 2 * c + (end > 0)});
  DemMaterial material{1., 0.3, 1., PlaneMode::strain, 0.3};
  FractureLaw law;
  law.rebonding = {{1e-4, 0, 0.5}};
  for (const bool flows : {false, true}) {
    if (flows)
      material.plasticity = VonMisesFlow{{10., 0., 0., 0., {}, {}}}; // never reached
    ManyBodyForce<dim> force(packing, material, {}, law);
    Particles<dim> p = at_rest(packing, material);
    int step = 0;
    p.displacement[1][0] = -0.4 * d; // it slides: others are looked for
    const auto place = [&](double x) {
      p.displacement[0][2] = -x * d;
      turn_by<dim>(p, 2, Spin<dim>::Constant(1e-3));
      force.compute(p, ++step);
    };
    for (double x = 0; x < 1.21; x += 0.1)
      place(x);
    ASSERT_TRUE(force.rebonded().all().empty());
    auto before = p;
    double energy = 0;
    while (force.rebonded().all().empty() && step < 40) {
      place(1.21 + 2e-3 * (step - 12));
      before = p;
      energy = force.potential_energy(p);
    }
    ASSERT_EQ(force.rebonded().all().size(), 1u);
    EXPECT_EQ(force.rebonded().all().begin()->first[1], 2);
    force.compute(p, ++step);
    EXPECT_EQ(force.rebonded().n_bonds(), 1);
    EXPECT_LT(difference(before, p, d), 1e-13);
    EXPECT_NEAR(force.potential_energy(p) + force.rebonding_energy(), energy, 1e-12 * energy);

    p.displacement[1][2] += 0.02 * d;
    force.compute(p, ++step);
    const auto still = p;
    Particles<dim> one;
    one.resize(1);
    turn_by<dim>(one, 0, Spin<dim>::Constant(0.8));
    const Turn<dim> turn = Turn<dim>::of(one, 0);
    for (int i = 0; i < p.size(); ++i) {
      const Vector<dim> x = get(p.reference, i) + get(p.displacement, i);
      set(p.displacement, i, Vector<dim>(get(p.displacement, i) + turn.change(x)));
      turn_by<dim>(p, i, Spin<dim>::Constant(0.8));
    }
    force.compute(p, ++step);
    double scale = 0;
    for (int i = 0; i < p.size(); ++i)
      keep_largest(scale, get(still.force, i).norm());
    ASSERT_GT(scale, 0);
    for (int i = 0; i < p.size(); ++i) {
      const Vector<dim> f = get(still.force, i);
      EXPECT_LT((get(p.force, i) - f - turn.change(f)).norm(), 1e-11 * scale);
    }
    EXPECT_EQ(force.rebonded().n_bonds(), 1);
  }
}
} // namespace
} // namespace ligament::dem::testing
