// Criteria of whole tensors: uniaxial and shear strengths of homogeneous bodies are those of the
// law on any packing, and the faces that break are those that a search without any bound finds.
#include "packings/random_packing.h"
#include "tests/oracle/many_body_oracle.h"
#include "tests/unit/dem/cases.h"
#include "tests/unit/dem/fracture_laws.h"

#include <hwy/highway.h>

#include <numeric>

namespace ligament::dem::testing
{
namespace
{
template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

template <int dim>
Packing<dim> lattice(Kind kind, double n, double degrees)
{
  packings::LatticeParameters<dim> p;
  p.kind = kind;
  p.spacing = 0.01;
  p.orientation[dim == 2 ? 0 : 2] = degrees * M_PI / 180;
  p.upper.setConstant(0.5 * (n + 0.3) * p.spacing);
  p.lower = -p.upper;
  return packings::make_lattice_packing<dim>(p);
}

template <int dim>
Packing<dim> random_packing(double n)
{
  packings::RandomParameters<dim> p;
  p.spacing = 0.01;
  p.size_ratio = 2;
  p.relaxation_sweeps = 2;
  p.upper.setConstant(0.5 * (n + 0.3) * p.spacing);
  p.lower = -p.upper;
  return packings::make_random_packing<dim>(p).packing;
}

/// Displacements of a homogeneous stress, those of `noise` times its strains on top of them.
template <int dim>
Particles<dim> state(const Packing<dim> &packing, const DemMaterial &material,
                     const Matrix<dim> &stress, double noise)
{
  Strain<dim> s;
  s.template head<dim>() = stress.diagonal();
  for (int a = 0, k = n_strains<dim> - 1; a < dim; ++a)
    for (int b = a + 1; b < dim; ++b, --k)
      s[k] = stress(a, b);
  const Strain<dim> e = material.elastic_constants<dim>().stiffness.inverse() * s;
  Matrix<dim> gradient = Vector<dim>(e.template head<dim>()).asDiagonal();
  for (int a = 0, k = n_strains<dim> - 1; a < dim; ++a)
    for (int b = a + 1; b < dim; ++b, --k)
      gradient(a, b) = gradient(b, a) = e[k] / 2;
  Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> random(-1, 1);
  const double size = noise * gradient.norm();
  for (int i = 0; i < p.size(); ++i) {
    set(p.displacement, i,
        Vector<dim>(gradient * get(packing.centre, i) +
                    size * packing.spacing *
                        Vector<dim>::NullaryExpr([&] { return random(generator); })));
    turn_by<dim>(p, i, size * Spin<dim>::NullaryExpr([&] { return random(generator); }));
  }
  return p;
}

/// Tension, compression and shear along axes that no lattice knows.
template <int dim>
std::vector<Matrix<dim>> loads()
{
  Matrix<dim> axes = Matrix<dim>::Identity();
  axes.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(0.2).toRotationMatrix();
  if constexpr (dim == 3)
    axes = Eigen::AngleAxisd(0.5, Vector<3>(1, -2, 0.5).normalized()).toRotationMatrix() * axes;
  Matrix<dim> tension = Matrix<dim>::Zero(), shear = tension;
  tension(0, 0) = 1;
  shear(0, 1) = shear(1, 0) = 1;
  const auto turned = [&](const Matrix<dim> &s) -> Matrix<dim> {
    return axes * s * axes.transpose();
  };
  return {turned(tension), turned(-tension), turned(shear)};
}

/// Particles that no side disturbs.
template <int dim>
std::vector<int> inside(const Packing<dim> &packing)
{
  std::vector<char> beside(packing.size(), 0);
  for (const auto &face : packing.boundary_faces)
    beside[face.i] = 1;
  for (int row = 0; row < 3; ++row) {
    const auto before = beside;
    for (const auto &face : packing.faces)
      beside[face.i] |= before[face.j], beside[face.j] |= before[face.i];
  }
  std::vector<int> list;
  for (int i = 0; i < packing.size(); ++i)
    if (!beside[i])
      list.push_back(i);
  return list;
}

template <int dim>
void expect_strengths(const Packing<dim> &packing, PlaneMode plane)
{
  constexpr double small = 1e-9; // of the modulus: rotations of second order vanish
  const DemMaterial material{1., 0.3, 1, plane, 0};
  const std::vector<int> of = inside(packing);
  ASSERT_FALSE(of.empty());
  for (const TensorLaw &law : tensor_laws())
    for (const Matrix<dim> &load : loads<dim>()) {
      const double expected = oracle::share_of<dim>(law.plain_of(material), load);
      const bool presses = load.trace() < -0.5;
      if (presses && (law.plain.criterion == "energy" || law.plain.criterion == "principal_stress"))
        continue; // nothing opens
      const auto p = state<dim>(packing, material, small * load, 0);
      const ManyBodyForce<dim> force(packing, material, {}, law.at(small));
      // Below 0 no pressure breaks it: a steep cone in plane strain, whose sides are held.
      EXPECT_NEAR(force.weakest_bond(p, of).utilisation, std::max(expected, 0.), 1e-6)
          << law.plain.criterion << "\n"
          << load;
    }
}

/// Of all faces that the oracle sees above the strength: the largest first, none within 1.6 d of
/// another.
template <int dim>
std::vector<std::pair<int, int>> breaking_faces(const Packing<dim> &packing,
                                                const std::vector<double> &share, double least)
{
  std::vector<int> order(share.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return share[a] > share[b]; });
  std::vector<Vector<dim>> places;
  std::vector<std::pair<int, int>> breaking;
  for (const int f : order) {
    const auto &face = packing.faces[f];
    const Vector<dim> place = get(packing.centre, face.i) + face.lever_i;
    if (share[f] < least || std::any_of(places.begin(), places.end(), [&](const auto &other) {
          return (place - other).norm() < 1.6 * packing.spacing;
        }))
      continue;
    places.push_back(place);
    breaking.push_back(std::minmax(face.i, face.j));
  }
  return breaking;
}

template <int dim>
std::vector<std::pair<int, int>> broken_faces(const ManyBodyForce<dim> &force)
{
  std::vector<std::pair<int, int>> broken;
  for (const auto &bond : force.broken_bonds())
    broken.push_back(std::minmax(bond.i, bond.j));
  return broken;
}

template <int dim>
void expect_all_found(const Packing<dim> &packing)
{
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  std::vector<int> all(packing.size());
  std::iota(all.begin(), all.end(), 0);
  for (const Matrix<dim> &load : loads<dim>())
    for (const double noise : {1e-3, 0.05, 0.5}) {
      const auto p = state<dim>(packing, material, 3e-3 * load, noise);
      oracle::ManyBodyOracle<dim> oracle(packing, 3., 0.3);
      auto q = p;
      oracle.compute(q);
      for (const TensorLaw &law : tensor_laws()) {
        const auto plain = law.plain_of(material);
        std::vector<double> share(packing.faces.size(), 0.);
        oracle.for_each_stressed_face(p, [&](std::size_t f, const Matrix<dim> &stress,
                                             const Vector<dim> &n, const Vector<dim> &t) {
          share[f] = oracle::share_of_face<dim>(plain, stress, n, t);
        });
        const double most = *std::max_element(share.begin(), share.end());
        if (most == 0) // nothing opens where all is pressed together
          continue;
        for (const double part : {0.5, 0.97, 0.9999}) {
          const auto expected = breaking_faces(packing, share, part * most);
          for (const bool seen_before : {false, true}) { // what was close before is looked for anew
            ManyBodyForce<dim> force(packing, material, {},
                                     law.at((seen_before ? 1.0001 : part) * most));
            auto moved = p;
            force.compute(moved, 0);
            if (seen_before) {
              ASSERT_TRUE(force.broken_bonds().empty());
              force.set_strength(part * most);
              force.compute(moved, 1);
            }
            EXPECT_EQ(broken_faces(force), expected)
                << plain.criterion << " " << noise << " " << part << " " << seen_before << "\n"
                << load;
          }
        }
        const ManyBodyForce<dim> force(packing, material, {}, law.at(1));
        EXPECT_NEAR(force.weakest_bond(p, all).utilisation, most, 1e-9 * most);
      }
    }
}

/// Two materials that differ in their criteria alone: bonds between them obey both.
template <int dim>
void expect_both_criteria(const Packing<dim> &packing)
{
  using Criterion = FractureLaw::Criterion;
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0};
  std::vector<int> number;
  for (const double x : packing.centre[0])
    number.push_back(x > 0);
  const auto laws = tensor_laws();
  for (const Matrix<dim> &load : loads<dim>()) {
    const auto p = state<dim>(packing, material, 3e-3 * load, 0.3);
    oracle::ManyBodyOracle<dim> oracle(packing, 3., 0.3);
    auto q = p;
    oracle.compute(q);
    for (std::size_t first = 0; first < laws.size(); ++first) {
      const TensorLaw &a = laws[first], &b = laws[(first + 1) % laws.size()];
      std::vector<double> share(packing.faces.size(), 0.);
      oracle.for_each_stressed_face(p, [&](std::size_t f, const Matrix<dim> &stress,
                                           const Vector<dim> &n, const Vector<dim> &t) {
        for (const int i : {packing.faces[f].i, packing.faces[f].j}) {
          if (first == 0 && number[i] == 1)
            continue; // that half has no criterion
          const auto of = (number[i] == 0 ? a : b).plain_of(material);
          share[f] = std::max(share[f], oracle::share_of_face<dim>(of, stress, n, t));
        }
      });
      const double most = *std::max_element(share.begin(), share.end());
      if (most == 0)
        continue;
      for (const double part : {0.6, 0.9999}) {
        FractureLaw law{a.criterion, a.at(part * most).strength};
        law.criteria = {a.criterion, first == 0 ? Criterion(Criterion::none) : b.criterion};
        law.strengths = {a.at(part * most).strength, b.at(part * most).strength};
        ManyBodyForce<dim> force(packing, Materials({material, material}, number), {}, law);
        auto moved = p;
        force.compute(moved, 0);
        EXPECT_EQ(broken_faces(force), breaking_faces(packing, share, part * most))
            << a.plain.criterion << " " << part << "\n"
            << load;
      }
    }
  }
}
} // namespace

TEST(TensorCriteria, TwoInOneBody)
{
  expect_both_criteria<2>(lattice<2>(Kind::hexagonal, 18, 0));
  expect_both_criteria<2>(random_packing<2>(13));
  expect_both_criteria<3>(lattice<3>(Kind::fcc, 6, 0));
  expect_both_criteria<3>(random_packing<3>(5));
}

TEST(TensorCriteria, StrengthsOfHomogeneousBodiesAreTheLawsOnAnyPacking)
{
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
    for (const double degrees : {0., 15., 30.})
      expect_strengths<2>(lattice<2>(Kind::hexagonal, 14, degrees), plane);
    expect_strengths<2>(random_packing<2>(16), plane);
  }
  for (const double degrees : {0., 20.})
    expect_strengths<3>(lattice<3>(Kind::fcc, 10, degrees), PlaneMode::strain);
  expect_strengths<3>(random_packing<3>(9), PlaneMode::strain);
}

class TensorSearch : public ::testing::TestWithParam<std::int64_t>
{
protected:
  ~TensorSearch() override { hwy::SetSupportedTargetsForTest(0); }
  bool use()
  {
    hwy::SetSupportedTargetsForTest(0);
    if (!(hwy::SupportedTargets() & GetParam()))
      return false;
    hwy::SetSupportedTargetsForTest(GetParam());
    return true;
  }
};

TEST_P(TensorSearch, FindsWhatTheOracleFinds)
{
  if (!use())
    GTEST_SKIP() << "this machine has no such instructions";
  expect_all_found<2>(lattice<2>(Kind::hexagonal, 18, 0));
  expect_all_found<2>(lattice<2>(Kind::square, 16, 20));
  expect_all_found<2>(random_packing<2>(13));
  expect_all_found<3>(lattice<3>(Kind::fcc, 6, 0));
  expect_all_found<3>(lattice<3>(Kind::simple_cubic, 5, 0));
  expect_all_found<3>(random_packing<3>(5));
}
INSTANTIATE_TEST_SUITE_P(Instructions, TensorSearch,
                         ::testing::Values(HWY_EMU128, HWY_AVX2, HWY_AVX3));
} // namespace ligament::dem::testing
