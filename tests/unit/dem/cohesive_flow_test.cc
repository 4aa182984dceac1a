// Faces that soften in bodies that flow, between materials, across joined sides, at strengths that
// scatter: gradient at frozen strains and openings, balance, work per area, numbering, turning,
// states.
#include "core/extremes.h"
#include "tests/unit/dem/force_slope.h"
#include "tests/unit/dem/free_flight.h"
#include "tests/unit/dem/inelastic_bodies.h"
#include "tests/unit/dem/run.h"
#include "tests/unit/dem/softening_bodies.h"

#include <fmt/format.h>

namespace ligament::dem::testing
{
namespace
{
template <typename D>
struct CohesiveFlow : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(CohesiveFlow, Dimensions);

VonMisesFlow mises(double yield, double hardening)
{
  YieldCurve curve;
  curve.initial = yield, curve.hardening = hardening;
  return {curve};
}

/// What a material does beside softening, at strains of this size and times of this.
struct Flow
{
  std::string name;
  Plasticity plasticity;
  Viscosity viscosity;
};
std::vector<Flow> flows(double strain, double time)
{
  const Viscosity branches = {{{0.5, 3 * time}, {0.3, 20 * time}}, 0};
  return {{"none", {}, {}},
          {"von Mises", mises(0.4 * strain, 0.3), {}},
          {"Drucker-Prager", DruckerPragerFlow{0.4 * strain, 0.1, 0.5, 0.3}, {}},
          {"Maxwell", {}, branches},
          {"Kelvin-Voigt", {}, {{}, time}},
          {"all", mises(0.4 * strain, 0.3), {branches.branches, 0.3 * time}}};
}
bool is_damped(const Flow &flow)
{
  return flow.viscosity.dashpot > 0;
}

/// One particle in three is of a material `contrast` times as stiff.
Materials mixed(int n, double contrast, const Flow &flow)
{
  std::mt19937 random(11);
  std::vector<int> of(n);
  for (int &m : of)
    m = random() % 3 == 0;
  std::vector<DemMaterial> all = {
      {1., 0.3, 1., PlaneMode::strain, 0.4},
      {contrast, contrast == 1 ? 0.3 : 0.15, 1., PlaneMode::strain, 0.4}};
  for (auto &m : all) {
    m.plasticity = flow.plasticity, m.viscosity = flow.viscosity;
    if (auto *mises = std::get_if<VonMisesFlow>(&m.plasticity))
      mises->yield.initial *= m.youngs_modulus, mises->yield.hardening *= m.youngs_modulus;
    if (auto *prager = std::get_if<DruckerPragerFlow>(&m.plasticity))
      prager->cohesion *= m.youngs_modulus, prager->hardening *= m.youngs_modulus;
  }
  return {all, of};
}

/// Begins at this strain, E G_c/f_t^2 is so many spacings; the second material takes twice as much.
FractureLaw softening(double strain, double lengths, double spacing)
{
  FractureLaw law{FractureLaw::Criterion::opening_tension, strain};
  law.energy = lengths * spacing * strain * strain;
  law.criteria = {law.criterion, law.criterion};
  law.strengths = {strain, 1.3 * strain};
  law.energies = {law.energy, 2 * law.energy};
  return law;
}

template <int dim>
std::vector<Packing<dim>> bodies()
{
  return {ragged_lattice<dim>(4, 7), random_body<dim>()};
}

/// A stretch that grows, a wave on it, and turns; then all of it is turned.
template <int dim>
void pull(Particles<dim> &p, double spacing, double strain, int step,
          const Spin<dim> &turn = Spin<dim>::Zero())
{
  Particles<dim> one;
  one.resize(1);
  turn_by<dim>(one, 0, turn);
  const auto whole = Turn<dim>::of(one, 0);
  for (int i = 0; i < p.size(); ++i) {
    for (auto &r : p.rotation)
      r[i] = 0;
    if constexpr (dim == 3)
      p.rotation[0][i] = 1;
    const Vector<dim> x = get(p.reference, i);
    Vector<dim> u = Vector<dim>::Zero();
    u[1] = 0.3 * strain * std::min(step, 9) * x[1] +
           0.1 * strain * spacing * step * std::sin(7 * x[0] + 5 * x[1]);
    u[0] = 0.05 * strain * spacing * step * std::cos(4 * x[1]);
    turn_by<dim>(p, i, Spin<dim>::Unit(0) * (0.05 * strain * step * std::sin(3 * x[0])));
    turn_by<dim>(p, i, turn);
    const Vector<dim> y = x + u;
    set(p.displacement, i, Vector<dim>(y + whole.change(y) - x));
  }
}

template <int dim>
struct Opened
{
  static constexpr double strain = 0.02;
  Packing<dim> packing;
  Materials materials;
  FractureLaw law;
  std::unique_ptr<ManyBodyForce<dim>> force;
  Particles<dim> p;

  Opened(const Packing<dim> &of, double contrast, const Flow &flow,
         const Spin<dim> &turn = Spin<dim>::Zero())
      : packing(of), materials(mixed(of.size(), contrast, flow)),
        law(softening(strain, 20, of.spacing))
  {
    start();
    for (int step = 1; step <= 12; ++step)
      take(step, Spin<dim>(turn * (step / 12.)));
  }
  Opened(const Packing<dim> &of, const Materials &all, const FractureLaw &fracture)
      : packing(of), materials(all), law(fracture)
  {
    start();
    for (int step = 1; step <= 12; ++step)
      take(step);
  }
  void start()
  {
    force = make();
    p = at_rest(packing, materials.base());
    if (!packing.global_id.empty())
      p.global_id = particles::GlobalIds(packing.global_id);
  }
  std::unique_ptr<ManyBodyForce<dim>> make() const
  {
    return std::make_unique<ManyBodyForce<dim>>(packing, materials,
                                                std::vector<core::BoundaryLoad<dim>>(), law);
  }
  void take(int step, const Spin<dim> &turn = Spin<dim>::Zero()) { take(step, *force, p, turn); }
  void take(int step, ManyBodyForce<dim> &of, Particles<dim> &q,
            const Spin<dim> &turn = Spin<dim>::Zero()) const
  {
    pull<dim>(q, packing.spacing, strain, step, turn);
    of.compute(q, step);
  }
};

template <int dim>
void for_each_case(const std::function<void(const Packing<dim> &, double, const Flow &)> &visit)
{
  for (const auto &packing : bodies<dim>())
    for (const double contrast : {1., 4.})
      for (const Flow &flow : flows(0.02, 1)) {
        if (contrast != 1 && is_damped(flow))
          continue;
        SCOPED_TRACE(fmt::format("{} contrast {} of {}", flow.name, contrast, packing.size()));
        visit(packing, contrast, flow);
      }
}

TYPED_TEST(CohesiveFlow, ForceIsMinusTheGradientAtFrozenStrainsAndOpenings)
{
  constexpr int dim = TypeParam::value;
  for_each_case<dim>([](const Packing<dim> &packing, double contrast, const Flow &flow) {
    Opened<dim> body(packing, contrast, flow);
    auto &force = *body.force;
    ASSERT_GT(force.cohesive().all().size(), 4u);
    double opening = 0;
    bool between = false;
    for (const auto &[name, face] : force.cohesive().all()) {
      keep_largest(opening, face.opening.damage);
      between = between || face.bond.joins_materials;
    }
    ASSERT_GT(opening, 0.03);
    ASSERT_EQ(between, contrast != 1);
    auto p = body.p;
    force.compute(p, 12); // of the same time: nothing opens further
    expect_minus_slope<dim>(p, {1e-3 * packing.spacing, 1e-3}, 1e-8, packing.spacing,
                            1 + p.size() / 12,
                            [&](const auto &q) { return force.potential_energy(q); });
  });
}

TYPED_TEST(CohesiveFlow, GoesOnFromItsStateToTheBitAndLooksChangeNothing)
{
  constexpr int dim = TypeParam::value;
  for_each_case<dim>([](const Packing<dim> &packing, double contrast, const Flow &flow) {
    Opened<dim> body(packing, contrast, flow);
    const core::Names names(body.p.global_id.list());
    core::State state;
    body.p.save(state, names);
    body.force->save(state, names, body.p);
    const auto other = body.make();
    auto q = body.p;
    other->load(state, names, q);
    for (int step = 13; step < 17; ++step) {
      body.take(step);
      body.take(step, *other, q);
      for (int i = 0; i < q.size(); ++i) {
        for (int c = 0; c < dim; ++c)
          ASSERT_EQ(body.p.force[c][i], q.force[c][i]);
        for (int c = 0; c < n_spins<dim>; ++c)
          ASSERT_EQ(body.p.torque[c][i], q.torque[c][i]);
      }
      EXPECT_EQ(body.force->cohesive_work(), other->cohesive_work());
      core::State once, twice;
      body.force->save(once, names, body.p);
      body.force->potential_energy(body.p);
      body.force->compute(body.p, step);
      body.force->save(twice, names, body.p);
      expect_same_numbers(once, twice);
    }
  });
}

TYPED_TEST(CohesiveFlow, TurnsWithTheBody)
{
  constexpr int dim = TypeParam::value;
  const Spin<dim> quarter = M_PI / 2 * Spin<dim>::Ones() / std::sqrt(double(n_spins<dim>));
  for_each_case<dim>([&](const Packing<dim> &packing, double contrast, const Flow &flow) {
    Opened<dim> fixed(packing, contrast, flow), turned(packing, contrast, flow, quarter);
    const double work = fixed.force->cohesive_work();
    ASSERT_GT(work, 0);
    EXPECT_NEAR(turned.force->cohesive_work() / work, 1, 1e-9);
    ASSERT_EQ(fixed.force->cohesive().all().size(), turned.force->cohesive().all().size());
    auto other = turned.force->cohesive().all().begin();
    for (const auto &[name, face] : fixed.force->cohesive().all()) {
      EXPECT_NEAR(face.opening.damage, other->second.opening.damage, 1e-9);
      ++other;
    }
  });
}

// Exact for forces that are linear in the motion: what is left is of the order of the strain. Faces
// of all kinds begin to open, shut, and tear.
TYPED_TEST(CohesiveFlow, BalanceInFreeFlight)
{
  constexpr int dim = TypeParam::value;
  constexpr double scale = 1e-8;
  const auto lattice = lattice_body<dim>(), random = random_body<dim>();
  for (const auto &packing : {lattice, random})
    for (const double contrast : {1., 5.})
      for (const Flow &flow : flows(15 * scale, 0.01)) {
        if (contrast != 1 && (is_damped(flow) || packing.size() == lattice.size()))
          continue;
        SCOPED_TRACE(fmt::format("{} contrast {} of {}", flow.name, contrast, packing.size()));
        std::size_t broken = 0, opening = 0;
        const auto [start, missing, losses] = fly<dim>(
            packing, mixed(packing.size(), contrast, flow), scale, is_damped(flow) ? 140 : 60, 0.8,
            softening(4 * scale, 3, packing.spacing), [&](const ManyBodyForce<dim> &force) {
              broken = force.broken_bonds().size();
              opening = force.cohesive().all().size();
            });
        EXPECT_GT(losses.cohesive, 1e-3 * start);
        if (dim == 2 || !is_damped(flow)) { // in space dashpots hold faces for longer
          EXPECT_GT(broken, 0u);
        }
        EXPECT_GT(opening, 10u);
        EXPECT_LT(losses.cohesive, start);
        EXPECT_NEAR(missing / start, 0, 30 * scale);
      }
}

TYPED_TEST(CohesiveFlow, NumberingChangesNothing)
{
  constexpr int dim = TypeParam::value;
  const auto packing = ragged_lattice<dim>(4, 7);
  std::vector<int> place(packing.size()), same(packing.size());
  for (int i = 0; i < packing.size(); ++i)
    same[i] = i, place[i] = (i * 7 + 3) % packing.size();
  for (const double contrast : {1., 4.})
    for (const Flow &flow : flows(0.02, 1)) {
      if (contrast != 1 && is_damped(flow))
        continue;
      SCOPED_TRACE(fmt::format("{} contrast {}", flow.name, contrast));
      const Materials materials = mixed(packing.size(), contrast, flow);
      std::vector<int> moved(packing.size()), kept(packing.size());
      for (int i = 0; i < packing.size(); ++i)
        kept[i] = moved[place[i]] = materials.number(i);
      FractureLaw law = softening(0.02, 20, packing.spacing);
      for (auto &strength : law.strengths)
        strength.scatter = {12, 0, 3};
      Opened<dim> a(renumbered(packing, same), {materials.all(), kept}, law),
          b(renumbered(packing, place), {materials.all(), moved}, law);
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
}

/// Work that a column of two cells takes until it is torn, in J, and what of the balance is missing
/// at most.
template <int dim>
std::array<double, 3> tear_column(const Materials &materials, const FractureLaw &law, double reach)
{
  const auto packing = column<dim>();
  const double period = packing.spacing / 3000, duration = 1000 * period;
  Run<dim> run(packing, materials, draw_apart<dim>(1.5 * reach / duration, 10 * period), law);
  const auto residual = [&] {
    return run.residual() + run.force->plastic_dissipation() + run.force->viscous_dissipation();
  };
  double largest = 0;
  while (run.force->broken_bonds().empty() && run.time < 2 * duration) {
    run.step(1 / period);
    keep_largest(largest, std::abs(residual()));
  }
  EXPECT_EQ(run.force->broken_bonds().size(), 1u);
  const double area = packing.faces[0].area;
  return {run.force->cohesive_work() / area, run.force->fracture_energy() / area, largest / area};
}

constexpr double youngs_modulus = 3e10, strength = 3e6, density = 2500;

TYPED_TEST(CohesiveFlow, ColumnTakesItsEnergyAndNoMore)
{
  constexpr int dim = TypeParam::value;
  const double spacing = 0.01, energy = 20 * spacing * strength * strength / youngs_modulus,
               reach = 2 * energy / strength, time = 300 * spacing / 3000;
  for (const Flow &flow : flows(strength / youngs_modulus, time)) {
    SCOPED_TRACE(flow.name);
    DemMaterial material{youngs_modulus, 0.3, density, PlaneMode::strain, 0};
    material.plasticity = flow.plasticity, material.viscosity = flow.viscosity;
    if (auto *mises = std::get_if<VonMisesFlow>(&material.plasticity))
      mises->yield.initial *= youngs_modulus, mises->yield.hardening *= youngs_modulus;
    if (auto *prager = std::get_if<DruckerPragerFlow>(&material.plasticity))
      prager->cohesion *= youngs_modulus, prager->hardening *= youngs_modulus;
    material.viscosity.dashpot *= 2e-3 * youngs_modulus;
    FractureLaw law{FractureLaw::Criterion::opening_tension, strength};
    law.energy = energy;
    const auto [work, released, missing] = tear_column<dim>(material, law, reach);
    EXPECT_NEAR(work / energy, 1, 1e-3);
    EXPECT_LT(std::abs(released) / energy, 1e-5);
    EXPECT_LT(missing / energy, 1e-5);
  }
}

// A face between two materials softens as the weaker one.
TYPED_TEST(CohesiveFlow, FaceBetweenMaterialsTakesTheEnergyOfTheWeakerOne)
{
  constexpr int dim = TypeParam::value;
  const double spacing = 0.01, energy = 30 * spacing * strength * strength / youngs_modulus;
  for (const int weaker : {0, 1})
    for (const double contrast : {1., 3.}) {
      std::vector<DemMaterial> all(2,
                                   DemMaterial{youngs_modulus, 0.3, density, PlaneMode::strain, 0});
      all[1].youngs_modulus *= contrast;
      FractureLaw law{FractureLaw::Criterion::opening_tension, strength};
      law.criteria = {law.criterion, law.criterion};
      law.energies = {3 * energy, 3 * energy};
      law.strengths = {2 * strength, 2 * strength};
      law.softenings = {Softening{}, Softening{}};
      law.mode_ratios = {1, 1};
      law.energies[weaker] = energy;
      law.strengths[weaker] = strength;
      law.softenings[weaker] = {1 / 3., 0.8};
      const auto [work, released, missing] =
          tear_column<dim>({all, {0, 1}}, law, 3.6 * energy / strength);
      EXPECT_NEAR(work / energy, 1, 1e-3) << weaker << ' ' << contrast;
      EXPECT_LT(std::abs(released) / energy, 1e-5);
      EXPECT_LT(missing / energy, 1e-5);
      // The other one would break at once: it is the stronger one and isn't asked.
      law.energies[1 - weaker] = 0;
      law.criteria[1 - weaker] = FractureLaw::Criterion::von_mises;
      EXPECT_NEAR(tear_column<dim>({all, {0, 1}}, law, 3.6 * energy / strength)[0] / energy, 1,
                  1e-3);
      // The weaker one does.
      std::swap(law.energies[0], law.energies[1]);
      std::swap(law.criteria[0], law.criteria[1]);
      EXPECT_EQ(tear_column<dim>({all, {0, 1}}, law, 3.6 * energy / strength)[0], 0);
    }
}

// However strong a face is, it takes G_c; one that is too strong for that takes what it must.
TYPED_TEST(CohesiveFlow, ScatterOfStrengthsLeavesTheEnergy)
{
  constexpr int dim = TypeParam::value;
  const double spacing = 0.01, energy = 20 * spacing * strength * strength / youngs_modulus;
  const DemMaterial material{youngs_modulus, 0.3, density, PlaneMode::strain, 0};
  double weakest = 1, strongest = 1;
  for (int seed = 1; seed <= 4; ++seed) {
    FractureLaw law{FractureLaw::Criterion::opening_tension, strength};
    law.strength.scatter = {3, 0, seed};
    law.energy = energy;
    const double factor = law.strength.scatter.factor(0, 1, 1);
    keep_smallest(weakest, factor), strongest = std::max(strongest, factor);
    const auto [work, released, missing] =
        tear_column<dim>(material, law, 2 * energy / (factor * strength));
    EXPECT_NEAR(work / energy, 1, 2e-3) << factor;
    EXPECT_LT(missing / energy, 1e-5);
  }
  EXPECT_LT(weakest, 0.8);
  EXPECT_GT(strongest, 1.2);
  FractureLaw law{FractureLaw::Criterion::opening_tension, strength};
  law.strength.scatter = {3, 0, 1};
  law.energy = 1e-3 * energy;
  const auto [work, released, missing] =
      tear_column<dim>(material, law, 4 * spacing * strength / youngs_modulus);
  EXPECT_GT(work, 10 * law.energy);
  EXPECT_LT(missing / work, 1e-5);
}

TYPED_TEST(CohesiveFlow, BalanceAcrossJoinedSides)
{
  constexpr int dim = TypeParam::value;
  constexpr double scale = 1e-8;
  packings::RandomParameters<dim> parameters;
  parameters.spacing = 0.01;
  parameters.size_ratio = 1.5;
  parameters.relaxation_sweeps = 5;
  parameters.upper.setConstant((dim == 2 ? 14 : 6) * parameters.spacing);
  parameters.periodic[1] = true; // along x it is free to stretch
  const auto packing = packings::make_random_packing<dim>(parameters).packing;
  for (const double contrast : {1., 5.})
    for (const Flow &flow : flows(15 * scale, 0.01)) {
      if (contrast != 1 && is_damped(flow))
        continue;
      SCOPED_TRACE(fmt::format("{} contrast {}", flow.name, contrast));
      std::size_t across = 0, broken = 0;
      const auto [start, missing, losses] =
          fly<dim>(packing, mixed(packing.size(), contrast, flow), scale, 60, 0.8,
                   softening(1 * scale, 3, packing.spacing), [&](const ManyBodyForce<dim> &force) {
                     for (const auto &[name, face] : force.cohesive().all())
                       across += face.bond.image != nullptr;
                     broken = force.broken_bonds().size();
                   });
      EXPECT_GT(across + broken, 3u);
      EXPECT_GT(losses.cohesive, 1e-3 * start);
      EXPECT_NEAR(missing / start, 0, 30 * scale);
    }
}
} // namespace
} // namespace ligament::dem::testing
