// Bounds of the kernels: no bond that exceeds the strength is missed, in random states of any
// packing.
#include "core/extremes.h"
#include "dem/principal_tension.h"
#include "packings/random_packing.h"
#include "tests/oracle/many_body_oracle.h"
#include "tests/unit/dem/cases.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace ligament::dem::testing
{
/// So many particles and more along each axis, `longer` times as many along the last.
template <int dim>
Packing<dim> lattice(Kind kind, double n, int longer)
{
  packings::LatticeParameters<dim> p;
  p.kind = kind;
  p.spacing = 0.01;
  p.upper.setConstant((n + 0.3) * p.spacing);
  p.upper[dim - 1] *= longer;
  return packings::make_lattice_packing<dim>(p);
}

template <int dim>
Packing<dim> random_packing(double n, int longer)
{
  packings::RandomParameters<dim> p;
  p.spacing = 0.01;
  p.size_ratio = 2;
  p.relaxation_sweeps = 2;
  p.upper.setConstant((n + 0.3) * p.spacing);
  p.upper[dim - 1] *= longer;
  return packings::make_random_packing<dim>(p).packing;
}

/// Noise and swelling that grow from the lower end to the upper one, in a turned body.
template <int dim>
Particles<dim> state(const Packing<dim> &packing, double swelling, unsigned seed)
{
  Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.01, 0.01);
  const auto noise = [&] { return uniform(random); };
  const Spin<dim> turn = Spin<dim>::Constant(0.7);
  const auto &height = p.reference[dim - 1];
  const double top = *std::max_element(height.begin(), height.end());
  for (int i = 0; i < p.size(); ++i) {
    const double share = std::pow(height[i] / top, 4);
    turn_by<dim>(p, i, turn);
    const Vector<dim> x = get(p.reference, i), rigid = Turn<dim>::of(p, i).change(x),
                      u = packing.spacing * Vector<dim>::NullaryExpr(noise);
    set(p.displacement, i, Vector<dim>(rigid + share * (u + swelling * (x + rigid))));
    turn_by<dim>(p, i, share * Spin<dim>::NullaryExpr(noise));
  }
  return p;
}

using BondPair = std::pair<int, int>;

/// Of all faces that the oracle sees above the strength: the largest first, none within 1.6 d of
/// another.
template <int dim>
std::vector<BondPair> breaking_faces(const Packing<dim> &packing,
                                     const std::vector<double> &tension, double strength)
{
  std::vector<int> order(tension.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return tension[a] > tension[b]; });
  std::vector<Vector<dim>> places;
  std::vector<BondPair> breaking;
  for (const int f : order) {
    const auto &face = packing.faces[f];
    const Vector<dim> place = get(packing.centre, face.i) + face.lever_i;
    if (tension[f] < strength || std::any_of(places.begin(), places.end(), [&](const auto &other) {
          return (place - other).norm() < 1.6 * packing.spacing;
        }))
      continue;
    places.push_back(place);
    breaking.push_back(std::minmax(face.i, face.j));
  }
  return breaking;
}

template <int dim>
std::vector<BondPair> broken_faces(const ManyBodyForce<dim> &force)
{
  std::vector<BondPair> broken;
  for (const auto &bond : force.broken_bonds())
    broken.push_back(std::minmax(bond.i, bond.j));
  return broken;
}

/// Faces that the law breaks in one step, in their order, against the oracle, which screens
/// nothing.
template <int dim>
void expect_all_breaking_found(const Packing<dim> &packing)
{
  using Criterion = FractureLaw::Criterion;
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  std::vector<int> all(packing.size());
  std::iota(all.begin(), all.end(), 0);
  for (const double swelling : {0.02, 0., -0.002})
    for (const double whole_face : {0., PrincipalTension<dim>::whole_face(packing.spacing)}) {
      auto p = state(packing, swelling, 1);
      oracle::ManyBodyOracle<dim> oracle(packing, 3., 0.3);
      auto q = p;
      oracle.compute(q);
      const auto tension = oracle.principal_tensions(p, whole_face);
      auto sorted = tension;
      std::sort(sorted.begin(), sorted.end());
      ASSERT_GT(sorted.back(), 0);
      for (const double share : {0.3, 0.9, 1.}) {
        const double strength = (1 - 1e-10) * share * sorted.back();
        ManyBodyForce<dim> force(packing, material, {},
                                 {Criterion::maximum_tension, strength, {}, whole_face});
        EXPECT_NEAR(force.weakest_bond(p, all).utilisation, sorted.back() / strength, 1e-9);
        force.compute(p, 0);
        EXPECT_EQ(broken_faces(force), breaking_faces(packing, tension, strength)) << share;
        const auto n = force.broken_bonds().size();
        force.compute(p, 0);
        EXPECT_EQ(force.broken_bonds().size(), n); // the rest is looked at in the next step
      }
    }
}

/// The particles of the bonds that break at once are those with a tension above the strength.
template <int dim>
void expect_all_face_tension_found(const Packing<dim> &packing)
{
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  for (const unsigned seed : {1, 2}) {
    auto p = state(packing, 0.02, seed);
    const ManyBodyForce<dim> intact(packing, material, {});
    std::vector<double> tension(packing.size());
    for (int i = 0; i < packing.size(); ++i)
      tension[i] = intact.max_tension(p, {i});
    auto sorted = tension;
    std::sort(sorted.begin(), sorted.end());
    for (const double quantile : {0.5, 1.}) {
      const double strength =
          (1 - 1e-12) * sorted[std::size_t(quantile * double(sorted.size() - 1))];
      ManyBodyForce<dim> force(packing, material, {},
                               {FractureLaw::Criterion::face_tension, strength});
      force.compute(p, 0);
      std::vector<char> broken(packing.size(), 0);
      for (const auto &bond : force.broken_bonds())
        broken[bond.i] = broken[bond.j] = 1;
      for (int i = 0; i < packing.size(); ++i)
        ASSERT_EQ(bool(broken[i]), tension[i] >= strength) << i;
      ASSERT_FALSE(force.broken_bonds().empty());
    }
  }
}

template <int dim>
void expect_all_found(const Packing<dim> &packing)
{
  expect_all_breaking_found(packing);
  expect_all_face_tension_found(packing);
}

TEST(Screen, NoBondAboveTheStrengthIsMissed)
{
  expect_all_found<2>(lattice<2>(Kind::hexagonal, 20, 1));
  expect_all_found<2>(lattice<2>(Kind::square, 20, 1));
  expect_all_found<2>(random_packing<2>(15, 1));
  expect_all_found<3>(lattice<3>(Kind::fcc, 6, 1));
  expect_all_found<3>(lattice<3>(Kind::simple_cubic, 6, 1));
  expect_all_found<3>(random_packing<3>(5, 1));
}
/// Uniaxial tension with some noise in small motions, which stresses of the particles clear but for
/// few faces.
template <int dim>
Particles<dim> nearly_uniform_tension(const Packing<dim> &packing, double angle, double noise)
{
  Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> random(-1, 1);
  Vector<dim> e = Vector<dim>::Zero();
  e[0] = std::cos(angle);
  e[1] = std::sin(angle);
  constexpr double strain = 1e-3;
  for (int i = 0; i < packing.size(); ++i) {
    const Vector<dim> x = get(packing.centre, i);
    const Vector<dim> u = strain * (1.3 * x.dot(e) * e - 0.3 * x);
    for (int c = 0; c < dim; ++c)
      p.displacement[c][i] = u[c] + noise * strain * packing.spacing * random(generator);
    Spin<dim> turn;
    for (int c = 0; c < n_spins<dim>; ++c)
      turn[c] = noise * strain * random(generator);
    if constexpr (dim == 2)
      p.rotation[0][i] = turn[0];
    else {
      Eigen::Vector4d q(1, turn[0] / 2, turn[1] / 2, turn[2] / 2);
      q.normalize();
      for (int c = 0; c < 4; ++c)
        p.rotation[c][i] = q[c];
    }
  }
  return p;
}

/// The faces that break are the oracle's, however the lattice's were looked for before.
template <int dim>
void expect_all_found_by_particle(const Packing<dim> &packing)
{
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  for (const double angle : {0., 0.3, 0.6})
    for (const double noise : {1e-3, 0.02, 0.1}) {
      auto p = nearly_uniform_tension(packing, angle, noise);
      oracle::ManyBodyOracle<dim> oracle(packing, 3., 0.3);
      auto q = p;
      oracle.compute(q);
      const auto tension = oracle.principal_tensions(p, 0);
      const double most = *std::max_element(tension.begin(), tension.end());
      for (const double share : {0.97, 0.999}) {
        const double strength = share * most;
        ManyBodyForce<dim> force(packing, material, {},
                                 {FractureLaw::Criterion::maximum_tension, 1.0001 * most});
        force.compute(p, 0);
        ASSERT_TRUE(force.broken_bonds().empty());
        ASSERT_EQ(force.looks_by_particle(), !packing.directions.empty());
        force.set_strength(strength);
        force.compute(p, 1);
        EXPECT_EQ(broken_faces(force), breaking_faces(packing, tension, strength))
            << angle << ' ' << noise;
        EXPECT_FALSE(force.broken_bonds().empty());
      }
    }
}

TEST(Screen, ParticlesClearNoBondAboveTheStrength)
{
  expect_all_found_by_particle<2>(lattice<2>(Kind::hexagonal, 24, 1));
  expect_all_found_by_particle<2>(lattice<2>(Kind::square, 20, 1));
  expect_all_found_by_particle<2>(random_packing<2>(15, 1));
  expect_all_found_by_particle<3>(lattice<3>(Kind::fcc, 7, 1));
  expect_all_found_by_particle<3>(lattice<3>(Kind::simple_cubic, 7, 1));
  expect_all_found_by_particle<3>(random_packing<3>(6, 1));
}

/// Against the weakest bonds of an intact twin: of the watched particles, of one pair, of none.
template <int dim>
void expect_utilisation_of_watched_faces(const Packing<dim> &packing,
                                         FractureLaw::Criterion criterion)
{
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  const auto p = state(packing, 0.02, 3);
  const ManyBodyForce<dim> intact(packing, material, {}, {criterion, 1});
  std::vector<double> tension(packing.size());
  for (int i = 0; i < packing.size(); ++i)
    tension[i] = intact.weakest_bond(p, {i}).utilisation;
  const double strength = 1.1 * *std::max_element(tension.begin(), tension.end());
  ManyBodyForce<dim> force(packing, material, {}, {criterion, strength});
  constexpr double noted = 0.3;
  force.set_noted_share(noted);
  auto moved = p;
  force.compute(moved, 0);
  ASSERT_TRUE(force.broken_bonds().empty());

  std::vector<Watch> watch(packing.size(), Watch::none);
  EXPECT_EQ(force.utilisation(p, watch).share, 0);
  double most = 0;
  for (int i = 0; i < packing.size(); i += 3) {
    watch[i] = Watch::watched;
    keep_largest(most, tension[i] / strength);
    const auto found = force.utilisation(p, watch);
    ASSERT_NEAR(found.share, most >= noted ? most : 0, 1e-12) << i;
  }
  EXPECT_GT(most, noted);

  // The most loaded face of a particle is one of those to its neighbours, the others exempt.
  const int i = int(std::max_element(tension.begin(), tension.end()) - tension.begin());
  double over_neighbours = 0;
  force.for_each_face(p, [&](const particles::FaceView<dim> &face) {
    if (face.i != i || face.j < 0)
      return;
    std::vector<Watch> pair(packing.size(), Watch::exempt);
    pair[i] = Watch::watched;
    EXPECT_EQ(force.utilisation(p, pair).share, 0);
    pair[face.j] = Watch::none;
    const auto found = force.utilisation(p, pair);
    if (found.share > 0) {
      EXPECT_LT((found.place - face.centroid).norm(), 1e-12);
    }
    over_neighbours = std::max(over_neighbours, found.share);
  });
  EXPECT_NEAR(over_neighbours, tension[i] / strength, 1e-12);
}

TEST(Screen, UtilisationIsThatOfTheMostLoadedWatchedFace)
{
  for (const auto criterion :
       {FractureLaw::Criterion::maximum_tension, FractureLaw::Criterion::face_tension})
  {
    expect_utilisation_of_watched_faces<2>(lattice<2>(Kind::hexagonal, 20, 1), criterion);
    expect_utilisation_of_watched_faces<2>(random_packing<2>(10, 2), criterion);
    expect_utilisation_of_watched_faces<3>(lattice<3>(Kind::fcc, 5, 1), criterion);
    expect_utilisation_of_watched_faces<3>(random_packing<3>(5, 1), criterion);
  }
}
} // namespace ligament::dem::testing
