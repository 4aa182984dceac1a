// The search for breaking bonds by the stresses of many particles at once: bodies with surfaces,
// loads, contacts, several materials, plastic strains and regions at rest break face by face as by
// a search that clears nothing.
#include "dem/principal_tension.h"
#include "packings/random_packing.h"
#include "particles/particle_solver.h"
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/fracture_laws.h"

#include <numeric>
#include <random>

namespace ligament::dem::testing
{
namespace
{
constexpr double spacing = 0.01;
/// With so little noted every face under tension is looked at by itself.
constexpr double all_faces = 1e-12;

template <int dim>
using Loads = std::vector<core::BoundaryLoad<dim>>;

template <int dim>
struct Body
{
  Packing<dim> packing;
  DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  Loads<dim> loads = {};
  double second_modulus = 0; // of the upper half; 0: one material
  double whole_face = 0;     // share of that of the lattice
  double yield_stress = 0;
  std::optional<TensorLaw> tensor = {}; // in place of maximum tension
  double second_poissons_ratio = 0.3;

  std::unique_ptr<ManyBodyForce<dim>> force(double strength) const
  {
    std::vector<DemMaterial> all = {material};
    std::vector<int> number;
    FractureLaw law{FractureLaw::Criterion::maximum_tension, strength, {}, whole_face};
    if (tensor)
      law = tensor->at(strength);
    if (second_modulus > 0) {
      all.push_back(material);
      all[1].youngs_modulus = second_modulus;
      all[1].poissons_ratio = second_poissons_ratio;
      law.strengths = {law.strength, law.strength};
      law.strengths[1].value *= 0.8 * second_modulus / material.youngs_modulus;
      for (const double y : packing.centre[1])
        number.push_back(y > 0.2 * spacing);
    }
    if (yield_stress > 0) {
      YieldCurve curve;
      curve.initial = yield_stress, curve.hardening = 0.1;
      all[0].plasticity = VonMisesFlow{curve};
    }
    return std::make_unique<ManyBodyForce<dim>>(packing, Materials(all, number), loads, law);
  }

  /// Uniaxial tension about the origin at this strain, and noise of every particle.
  Particles<dim> state(double angle, double strain, double noise, unsigned seed) const
  {
    Particles<dim> p;
    packings::fill_particles(packing, 1., p);
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> random(-1, 1);
    Vector<dim> e = Vector<dim>::Zero();
    e[0] = std::cos(angle);
    e[1] = std::sin(angle);
    for (int i = 0; i < p.size(); ++i) {
      const Vector<dim> x = get(packing.centre, i);
      set(p.displacement, i,
          Vector<dim>(strain * (1.3 * x.dot(e) * e - 0.3 * x) +
                      noise * spacing *
                          Vector<dim>::NullaryExpr([&] { return random(generator); })));
      turn_by<dim>(p, i, noise * Spin<dim>::NullaryExpr([&] { return random(generator); }));
    }
    return p;
  }
};

template <int dim>
std::vector<std::pair<int, int>> broken(const ManyBodyForce<dim> &force)
{
  std::vector<std::pair<int, int>> faces;
  for (const auto &b : force.broken_bonds())
    faces.push_back({b.i, b.j});
  return faces;
}

/// In states that follow one another, some of which break several faces: pulled along changing
/// axes, then pressed together so that broken faces touch; at last the strength is another one.
template <int dim>
void expect_same_faces(const Body<dim> &body, double noise, bool by_stress = true,
                       double share = 0.93)
{
  constexpr double strain = 1e-3;
  std::vector<int> all(body.packing.size());
  std::iota(all.begin(), all.end(), 0);
  auto probe = body.force(1e3);
  auto p = body.state(0.3, strain, noise * strain, 1);
  probe->compute(p, 0.5);
  const double strength = share * 1e3 * probe->weakest_bond(p, all).utilisation;
  ASSERT_GT(strength, 0);
  const auto screened = body.force(strength), full = body.force(strength);
  full->set_noted_share(all_faces);
  int looked = 0;
  std::size_t n_before = 0, n_breaking = 0;
  for (int step = 0; step < 7; ++step) {
    if (step == 5)
      for (auto *force : {screened.get(), full.get()})
        force->set_strength(0.95 * strength);
    const double angle = 0.3 + 0.15 * step, sign = step == 4 ? -1 : 1;
    auto a = body.state(angle, sign * strain, noise * strain, 1 + step / 2), b = a;
    const double time = 1 + 0.1 * step;
    screened->compute(a, time);
    full->compute(b, time);
    EXPECT_EQ(broken(*screened), broken(*full)) << step;
    EXPECT_EQ(a.force, b.force);
    EXPECT_EQ(screened->fracture_energy(), full->fracture_energy());
    looked += screened->looks_by_stress();
    n_breaking += screened->broken_bonds().size() > n_before;
    n_before = screened->broken_bonds().size();
  }
  EXPECT_GT(n_breaking, 1u);
  EXPECT_EQ(looked > 2, by_stress);
}

/// Sides held along x and y, or under tractions.
template <int dim>
Loads<dim> loaded_sides(double extent)
{
  using Load = core::BoundaryLoad<dim>;
  Loads<dim> loads(3);
  for (int side = 0; side < 2; ++side) {
    loads[side].boundary = side;
    loads[side].kind = Load::Kind::displacement;
    loads[side].value[0] = (side ? 1 : -1) * 1.2e-3 * extent;
  }
  loads[2].boundary = 3;
  loads[2].kind = Load::Kind::traction;
  loads[2].value[0] = 1e-3;
  loads[2].value[1] = 2e-3;
  return loads;
}

template <int dim>
packings::LatticeParameters<dim> box_of(Kind kind, bool turned, double n)
{
  packings::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.spacing = spacing;
  if (turned)
    turn_lattice(lattice.orientation);
  for (int c = 0; c < dim; ++c) {
    lattice.upper[c] = 0.5 * spacing * (n + 0.37 * c);
    lattice.lower[c] = -lattice.upper[c];
  }
  return lattice;
}

template <int dim>
packings::RandomParameters<dim> random_box(double n)
{
  packings::RandomParameters<dim> random;
  random.spacing = spacing;
  random.size_ratio = 2;
  random.relaxation_sweeps = 2;
  random.upper.setConstant(0.5 * spacing * n);
  random.lower = -random.upper;
  return random;
}

/// From inside to one side.
template <int dim>
void add_crack(packings::SpecimenParameters<dim> &specimen)
{
  const double x = 2 * specimen.upper[0], y = 0.13 * spacing, end = 0.2 * specimen.upper[0];
  if constexpr (dim == 2)
    specimen.cracks = {{{-x, y}, {-end, 1.7 * y}}};
  else
    specimen.cracks = {{{-x, y, -x}, {-x, y, x}, {-end, 1.7 * y, x}, {-end, 1.7 * y, -x}}};
}

template <int dim>
std::vector<Packing<dim>> packings(bool cracked)
{
  std::vector<Packing<dim>> made;
  const auto kinds = dim == 2 ? std::vector{Kind::hexagonal, Kind::square}
                              : std::vector{Kind::fcc, Kind::simple_cubic};
  for (const Kind kind : kinds)
    for (const bool turned : {false, true}) {
      auto lattice = box_of<dim>(kind, turned, dim == 2 ? 40 : 8);
      if (cracked)
        add_crack<dim>(lattice);
      made.push_back(packings::make_lattice_packing<dim>(lattice));
    }
  auto random = random_box<dim>(dim == 2 ? 36 : 7);
  if (cracked)
    add_crack<dim>(random);
  made.push_back(packings::make_random_packing<dim>(random).packing);
  return made;
}
} // namespace

template <typename D>
struct ScreenByStress : ::testing::Test
{
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ScreenByStress, Dimensions);

TYPED_TEST(ScreenByStress, FreeSurfacesAndBreakingFaces)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : packings<dim>(false))
    for (const double noise : {1e-3, 0.05, 0.3}) {
      expect_same_faces<dim>({packing}, noise);
      Body<dim> sized{packing};
      sized.whole_face = PrincipalTension<dim>::whole_face(spacing);
      expect_same_faces<dim>(sized, noise);
    }
}

TYPED_TEST(ScreenByStress, HeldAndLoadedSides)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : packings<dim>(false))
    for (const double noise : {1e-3, 0.05}) {
      Body<dim> body{packing};
      body.loads = loaded_sides<dim>(0.5 * spacing * (dim == 2 ? 40 : 8));
      expect_same_faces<dim>(body, noise);
    }
}

TYPED_TEST(ScreenByStress, CracksInContact)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : packings<dim>(true))
    for (const double friction : {0., 0.4}) {
      Body<dim> body{packing};
      body.material.friction = friction;
      expect_same_faces<dim>(body, 0.05);
    }
}

TYPED_TEST(ScreenByStress, TwoMaterials)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : packings<dim>(false))
    for (const double modulus : {0.6, 9.}) {
      Body<dim> body{packing};
      body.second_modulus = modulus;
      expect_same_faces<dim>(body, 0.05, true, 0.6); // most where the two meet
    }
}

TYPED_TEST(ScreenByStress, CriteriaOfTensors)
{
  constexpr int dim = TypeParam::value;
  for (const bool cracked : {false, true})
    for (const auto &packing : packings<dim>(cracked))
      for (const TensorLaw &law : tensor_laws())
        for (const double noise : {1e-3, 0.05, 0.3}) {
          Body<dim> body{packing};
          body.material.friction = cracked ? 0.4 : 0;
          body.tensor = law;
          expect_same_faces<dim>(body, noise);
        }
}

TYPED_TEST(ScreenByStress, CriteriaOfTensorsInTwoMaterials)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : packings<dim>(false))
    for (const TensorLaw &law : tensor_laws())
      for (const double nu : {0.3, 0.1}) { // 0.1: another measure, every noted face is looked at
        Body<dim> body{packing};
        body.second_modulus = 0.6;
        body.second_poissons_ratio = nu;
        body.tensor = law;
        const bool one_measure = nu == 0.3 || law.plain.criterion == "principal_stress" ||
                                 law.plain.criterion == "mohr_coulomb" ||
                                 (dim == 3 && law.plain.criterion != "energy");
        expect_same_faces<dim>(body, 0.05, one_measure, 0.6);
      }
}

TYPED_TEST(ScreenByStress, PlasticStrains)
{
  constexpr int dim = TypeParam::value;
  for (const auto &packing : packings<dim>(false))
    for (const double yield_stress : {1e3, 2.5e-3}) {
      Body<dim> body{packing};
      body.yield_stress = yield_stress;
      expect_same_faces<dim>(body, 0.05, yield_stress > 1);
    }
}

/// A bar that is pulled at one end until it breaks, particles at rest before the wave, against one
/// whose every face is looked at: the same motion to the last bit. Returns the steps in which
/// stresses were asked.
template <int dim>
int expect_same_motion(const Packing<dim> &packing, bool rests, int steps)
{
  using Solver = particles::ParticleSolver<dim>;
  Loads<dim> loads(1);
  loads[0].boundary = 0;
  loads[0].kind = core::BoundaryLoad<dim>::Kind::velocity;
  loads[0].value[0] = -0.02;
  loads[0].history = core::Ramp{0.4}; // 40 spacings of the wave
  const auto make = [&](double noted_share) {
    const DemMaterial material{1., 0.3, 1, PlaneMode::strain, 0};
    auto force = std::make_unique<ManyBodyForce<dim>>(
        packing, material, loads, FractureLaw{FractureLaw::Criterion::maximum_tension, 0.018});
    force->set_noted_share(noted_share);
    Particles<dim> state;
    packings::fill_particles(packing, 1., state);
    return Solver(std::move(state), std::move(force));
  };
  Solver screened = make(1), full = make(all_faces);
  const auto law = [](const Solver &s) -> const ManyBodyForce<dim> & {
    return dynamic_cast<const ManyBodyForce<dim> &>(*s.force);
  };
  const double dt = 0.9 * full.force->stable_step(full.state);
  for (Solver *s : {&screened, &full})
    s->compute_forces(0);
  if (rests)
    screened.let_rest();
  int looked = 0;
  for (int step = 1; step <= steps; ++step) {
    for (Solver *s : {&screened, &full}) {
      s->kick(dt);
      s->drift(dt);
      s->compute_forces(step * dt);
    }
    looked += law(screened).looks_by_stress();
    EXPECT_EQ(broken(law(screened)), broken(law(full))) << step;
  }
  EXPECT_EQ(screened.state.displacement, full.state.displacement);
  EXPECT_EQ(screened.state.force, full.state.force);
  EXPECT_GT(law(screened).broken_bonds().size(), 10u);
  if (rests) {
    EXPECT_GT(screened.rest()->share_at_rest(), 0.);
  }
  return looked;
}

TEST(ScreenOfBars, BreakingBarsWithRegionsAtRest)
{
  for (const bool rests : {false, true}) {
    auto flat = box_of<2>(Kind::hexagonal, false, 36);
    flat.upper[0] = spacing * 160;
    int looked = expect_same_motion<2>(packings::make_lattice_packing<2>(flat), rests, 150);
    auto solid = box_of<3>(Kind::fcc, true, 5);
    solid.upper[0] = spacing * 120;
    looked += expect_same_motion<3>(packings::make_lattice_packing<3>(solid), rests, 160);
    auto random = random_box<2>(26);
    random.upper[0] = spacing * 160;
    looked += expect_same_motion<2>(packings::make_random_packing<2>(random).packing, rests, 150);
    EXPECT_GT(looked, 20);
  }
}
} // namespace ligament::dem::testing
