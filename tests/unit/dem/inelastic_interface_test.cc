// Flow and relaxation at faces between materials of different elastic constants: forces are the
// gradient, own stresses that of the energy by the strains; uniform strains cost nothing; stresses
// come down to the yield surface; balances close, breaking included; layers in closed form.
#include "core/extremes.h"
#include "tests/unit/dem/force_slope.h"
#include "tests/unit/dem/free_flight.h"
#include "tests/unit/dem/inelastic_bodies.h"

namespace ligament::dem::testing
{
template <typename D>
struct InelasticInterface : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(InelasticInterface, Dimensions);

/// The same in units of `modulus`.
Plasticity in_units(Plasticity law, double modulus)
{
  if (auto *mises = std::get_if<VonMisesFlow>(&law))
    mises->yield.initial *= modulus, mises->yield.hardening *= modulus;
  if (auto *prager = std::get_if<DruckerPragerFlow>(&law))
    prager->cohesion *= modulus, prager->hardening *= modulus;
  return law;
}

/// One particle in three is `contrast` times as stiff and as strong; all have these laws.
Materials mixed(int n, double contrast, PlaneMode plane, const Plasticity &law,
                const Viscosity &viscosity = {})
{
  std::mt19937 random(11);
  std::vector<int> of(n);
  for (int &m : of)
    m = random() % 3 == 0;
  std::vector<DemMaterial> all = {{1., 0.3, 1., plane, 0}, {contrast, 0.15, 1., plane, 0}};
  for (auto &m : all)
    m.plasticity = in_units(law, m.youngs_modulus), m.viscosity = viscosity;
  return {all, of};
}

VonMisesFlow mises(double yield, double hardening)
{
  YieldCurve curve;
  curve.initial = yield, curve.hardening = hardening;
  return {curve};
}

/// Laws under which bodies flow at strains of this size.
std::vector<Plasticity> flowing(double strain)
{
  return {mises(0.4 * strain, 0.3), DruckerPragerFlow{0.4 * strain, 0.1, 0.5, 0.3}};
}

Viscosity relaxing(double time)
{
  return {{{0.5, 3 * time}, {0.3, 20 * time}}, 0};
}

template <int dim>
std::vector<Packing<dim>> bodies()
{
  return {lattice_body<dim>(), random_body<dim>()};
}

template <int dim>
std::vector<PlaneMode> planes()
{
  if (dim == 3)
    return {PlaneMode::strain};
  return {PlaneMode::strain, PlaneMode::stress};
}

TYPED_TEST(InelasticInterface, ForcesAreTheGradientAtFrozenStrains)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : {ragged_lattice<dim>(4, 7), random_body<dim>()})
    for (const PlaneMode plane : planes<dim>()) {
      const auto materials = mixed(packing.size(), 4, plane, mises(1e9, 0));
      ManyBodyForce<dim> force(packing, materials, {});
      set_random_strains(force, packing.size(), 0.1);
      auto p = at_rest(packing, materials.base());
      disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Constant(0.3), 3);
      force.compute(p, 1.);
      expect_minus_slope<dim>(p, {1e-3 * packing.spacing, 1e-3}, 1e-9, packing.spacing,
                              1 + p.size() / 20,
                              [&](const auto &q) { return force.potential_energy(q); });
    }
}

// Also of those that have flowed in the step, and of their neighbours, whose motion is another then.
TYPED_TEST(InelasticInterface, OwnStressesAreThoseOfTheEnergy)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : bodies<dim>())
    for (const PlaneMode plane : planes<dim>())
      for (const Plasticity &law : flowing(0.02)) {
        const auto materials = mixed(packing.size(), 4, plane, law);
        ManyBodyForce<dim> force(packing, materials, {});
        auto p = at_rest(packing, materials.base());
        for (const int step : {1, 2}) {
          disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Constant(0.2 * step), step);
          force.compute(p, step);
        }
        ASSERT_GT(force.plastic_dissipation(), 0);
        double largest = 0, error = 0;
        int n_asked = 0;
        for (int i = 0; i < p.size(); i += 1 + p.size() / 60) {
          const auto e = force.strains().tensor(i), stress = force.strains().stress(i);
          if (stress.isZero(0)) // at a corner: never flows
            continue;
          ++n_asked;
          for (int c = 0; c < e.size(); ++c) {
            const double sides = c < 3 ? 1 : 2; // of a symmetric tensor
            const double expected = -slope(1e-2, [&](double s) {
              auto changed = e;
              changed[c] += s;
              force.strains().set_strain(i, changed);
              return force.potential_energy(p);
            }) / (sides * p.volume[i]);
            keep_largest(error, std::abs(stress[c] - expected));
            keep_largest(largest, std::abs(stress[c]));
          }
          force.strains().set_strain(i, e);
        }
        EXPECT_GT(n_asked, 30);
        EXPECT_LT(error, 1e-9 * largest);
      }
}

// The shape that it gives to the body is free of forces, of whatever stiffness its parts are.
TYPED_TEST(InelasticInterface, UniformStrainsCostNothing)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : {lattice_body<dim>(0), random_body<dim>(0)}) {
    const auto materials = mixed(packing.size(), 20, PlaneMode::strain, mises(1e9, 0));
    ManyBodyForce<dim> force(packing, materials, {});
    auto p = at_rest(packing, materials.base());
    typename InelasticStrains<dim>::Tensor e;
    for (int c = 0; c < e.size(); ++c)
      e[c] = 0.01 * (c + 1) * (c % 2 ? -1 : 1);
    if (dim == 2)
      e[2] = 0;
    for (int i = 0; i < p.size(); ++i) {
      force.strains().set_strain(i, e);
      turn_by<dim>(p, i, Spin<dim>::Constant(0.7));
      const Vector<dim> x = get(p.reference, i), y = x + force.strains().strain(i) * x;
      set(p.displacement, i, Vector<dim>(y + Turn<dim>::of(p, i).change(y) - x));
    }
    force.compute(p, 1.);
    const double unit = 0.05 * 20 * std::pow(packing.spacing, dim - 1);
    for (int i = 0; i < p.size(); ++i)
      EXPECT_LT(get(p.force, i).norm(), 1e-12 * unit);
    EXPECT_LT(std::abs(force.potential_energy(p)), 1e-12 * unit * packing.spacing * p.size());
  }
}

// A particle answers to its motion as its faces divided it before; as they follow, some of the
// excess comes back, a share of it of k/(1 + k), k the largest stiffness of one side over the other.
TYPED_TEST(InelasticInterface, ComesDownToTheYieldSurface)
{
  constexpr int dim = TypeParam::value;
  constexpr double contrast = 5;
  for (const auto &packing : bodies<dim>()) {
    const auto materials = mixed(packing.size(), contrast, PlaneMode::strain, mises(0.008, 0.3));
    ManyBodyForce<dim> force(packing, materials, {});
    auto p = at_rest(packing, materials.base());
    disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Zero(), 3);
    const auto excess = [&] {
      double most = 0;
      for (int i = 0; i < p.size(); ++i) {
        const double h = force.strains().history(i);
        if (h == 0)
          continue;
        auto s = force.strains().stress(i);
        s.template head<3>().array() -= s.template head<3>().mean();
        const auto &yield =
            std::get<VonMisesFlow>(materials.of(i).plasticity).yield;
        const double size = std::sqrt(1.5 * (s.template head<3>().squaredNorm() +
                                             2 * s.tail(s.size() - 3).squaredNorm()));
        keep_largest(most, size / yield.at(h) - 1);
      }
      return most;
    };
    double k = 1;
    for (const auto &face : packing.faces) {
      const double ratio = face.q_i / face.q_j * materials.of(face.j).shear_modulus() /
                           materials.of(face.i).shear_modulus();
      k = std::max({k, ratio, 1 / ratio});
    }
    int time = 1;
    for (; time <= 3; ++time)
      force.compute(p, time);
    ASSERT_GT(force.plastic_dissipation(), 0);
    const double first = excess();
    EXPECT_GT(first, 1e-6); // else this asks nothing
    constexpr int n = 100;
    for (; time <= 3 + n; ++time)
      force.compute(p, time);
    EXPECT_LT(excess(), std::max(first * std::pow(k / (1 + k), n), 1e-12));
  }
}

// Exact for forces that are linear in the motion: what is left is of the order of the strain.
TYPED_TEST(InelasticInterface, DissipationClosesTheBalance)
{
  constexpr int dim = TypeParam::value;
  constexpr double scale = 1e-6;
  for (const auto &packing : bodies<dim>())
    for (const PlaneMode plane : planes<dim>())
      for (const double contrast : {5., 50.})
        for (const Plasticity &law : flowing(15 * scale))
          for (const Viscosity &viscosity : {Viscosity{}, relaxing(0.01)}) {
            const auto materials = mixed(packing.size(), contrast, plane, law, viscosity);
            const auto [start, missing, losses] = fly<dim>(packing, materials, scale, 100);
            EXPECT_GT(losses.plastic + losses.viscous, 0.002 * start);
            EXPECT_LT(losses.plastic + losses.viscous, start);
            EXPECT_NEAR(missing / start, 0, 30 * scale)
                << contrast << " " << law.index() << " " << viscosity.branches.size();
          }
}

// Faces of all kinds break: those between materials, those beside them and others.
TYPED_TEST(InelasticInterface, FacesBreakInBalance)
{
  constexpr int dim = TypeParam::value;
  constexpr double scale = 1e-8;
  const FractureLaw fracture = {FractureLaw::Criterion::face_tension, 10 * scale};
  for (const auto &packing : bodies<dim>())
    for (const Plasticity &law : flowing(15 * scale))
      for (const Viscosity &viscosity : {Viscosity{}, relaxing(0.01)}) {
        const auto materials = mixed(packing.size(), 5, PlaneMode::strain, law, viscosity);
        const auto [start, missing, losses] =
            fly<dim>(packing, materials, scale, 100, 0.8, fracture);
        EXPECT_GT(losses.plastic + losses.viscous, 1e-3 * start);
        EXPECT_GT(losses.fracture, 1e-3 * start);
        EXPECT_NEAR(missing / start, 0, 30 * scale) << law.index() << " "
                                                    << viscosity.branches.size();
      }
}

// However often a time is looked at, particles flow once, and looks leave nothing behind.
TYPED_TEST(InelasticInterface, LooksChangeNoBit)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : bodies<dim>()) {
    const auto materials =
        mixed(packing.size(), 5, PlaneMode::strain, flowing(0.02)[0], relaxing(1));
    ManyBodyForce<dim> force(packing, materials, {});
    auto p = at_rest(packing, materials.base());
    for (const int time : {1, 2, 3}) {
      disturb<dim>(p, packing.spacing, 0.02, Spin<dim>::Zero(), time);
      force.compute(p, time);
      const auto first = p;
      const auto losses = force.losses();
      const double energy = force.potential_energy(p);
      const auto stress = force.strains().stress(0);
      Components<n_strains<dim>> stresses;
      force.stresses(p, stresses);
      force.compute(p, time);
      EXPECT_EQ(p.force, first.force);
      EXPECT_EQ(p.torque, first.torque);
      EXPECT_EQ(force.losses().plastic, losses.plastic);
      EXPECT_EQ(force.losses().viscous, losses.viscous);
      EXPECT_EQ(force.strains().stress(0), stress);
      EXPECT_EQ(force.potential_energy(p), energy);
    }
    EXPECT_GT(force.losses().plastic, 0);
  }
}
} // namespace ligament::dem::testing
