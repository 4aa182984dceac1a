// J of the field of a crack tip, imposed on particles and mesh, is K^2/E'.
#include "src/simulation/gauges/gauge_set.h"
#include "tests/support/small_plate.h"

#include <Eigen/Geometry>

#include <cmath>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// Westergaard's field of a tip at the origin with its crack along -x, plane strain, G = mu.
struct TipField
{
  double k1, k2, nu = 0.22, modulus = 1;

  Vector<2> operator()(const Vector<2> &x) const
  {
    const double r = x.norm(), t = std::atan2(x[1], x[0]), mu = modulus / (2 * (1 + nu)),
                 kappa = 3 - 4 * nu, c = std::cos(t / 2), s = std::sin(t / 2);
    const double scale = std::sqrt(r / (2 * M_PI)) / (2 * mu);
    return scale * Vector<2>(k1 * c * (kappa - std::cos(t)) + k2 * s * (kappa + 2 + std::cos(t)),
                             k1 * s * (kappa - std::cos(t)) - k2 * c * (kappa - 2 + std::cos(t)));
  }
  double j() const { return (k1 * k1 + k2 * k2) * (1 - nu * nu) / modulus; }
};

const std::string crack = R"(/specimen/cracks=[{"points": [[-61, 0], [0, 0]]}])";
const std::string size = "/specimen/size=[120, 120]";

std::string ring(const char *name, double inner, double outer)
{
  return fmt::format(R"({{"name": "{0}", "kind": "j_integral", "direction": [1, 0],
    "lower": [-{2}, -{2}], "upper": [{2}, {2}], "inner_lower": [-{1}, -{1}], "inner_upper": [{1}, {1}]}})",
                     name, inner, outer);
}

template <typename Field>
void impose(SmallBody &small, const Field &field)
{
  if (small.body.zone) {
    auto &state = small.body.zone->state;
    for (int i = 0; i < state.size(); ++i)
      set<2>(state.displacement, i, field(get(state.reference, i)));
  }
  if (small.body.far)
    for (int i = 0; i < small.body.far->mesh().n_nodes(); ++i)
      set<2>(small.body.far->displacement, i, field(small.body.far->mesh().nodes[i]));
}

struct Body
{
  const char *name;
  std::vector<std::string> overrides;
};

/// The zone reaches to 45, so that its overlap lies between rectangles of 20 and 55; the crack
/// needs it up to the left side.
const std::string zone = R"(/discrete_zone/region={"lower": [null, -40], "upper": [40, 40]})";
const std::vector<Body> packings = {
    {"hexagonal", {"/far_field=none"}},
    {"turned", {"/far_field=none", "/discrete_zone/orientation=0.2"}},
    {"square", {"/far_field=none", "/discrete_zone/packing=square"}},
    {"random", {"/far_field=none", "/discrete_zone/packing=random"}},
    {"coupled", {zone}},
    {"coupled_random", {zone, "/discrete_zone/packing=random"}}};

/// Fits over a distance a of a field like sqrt(r) miss its gradient by about (a/r)^2/8 of it: with
/// neighbours at 1 d, cells of 4.1 d, from r = 20 d on. The wedges beside the crack, where fits
/// have neighbours on one side only, miss it by a/(2 r), on 2 rows of 40.
constexpr double expected_error = 0.01;

TEST(JIntegral, IsThatOfTheTipOnEveryPackingAndPath)
{
  const std::string rings = "/gauges=[" + ring("near", 12, 24) + "," + ring("wide", 20, 55) + "," +
                            ring("far", 42, 56) + "]";
  for (const Body &b : packings) {
    SCOPED_TRACE(b.name);
    const Scene scene = small_scene(std::vector<std::string>{size, crack, rings} + b.overrides);
    SmallBody small(scene);
    GaugeSet<2> gauges(scene, small.body);
    for (const TipField &field : {TipField{1e-4, 0}, TipField{0, 1e-4}, TipField{1e-4, 6e-5}}) {
      impose(small, field);
      const auto v = gauges.read(small.body, 0);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(v[2 * k] / field.j(), 1, expected_error) << gauges.columns()[2 * k].name;
        EXPECT_DOUBLE_EQ(v[2 * k + 1], std::sqrt(v[2 * k] / (1 - 0.22 * 0.22)));
      }
    }
  }
}

// A tip that looks the other way, and one across y.
TEST(JIntegral, KnowsTheDirectionOfTheCrack)
{
  const TipField field{1e-4, 3e-5};
  const auto measure = [&](const std::string &cracks, const std::string &direction, auto turned) {
    std::string gauge = ring("j", 12, 40);
    gauge.replace(gauge.find("[1, 0]"), 6, direction);
    const Scene scene =
        small_scene({size, "/far_field=none", "/specimen/cracks=[{\"points\": " + cracks + "}]",
                     "/gauges=[" + gauge + "]"});
    SmallBody small(scene);
    GaugeSet<2> gauges(scene, small.body);
    impose(small, turned);
    return gauges.read(small.body, 0)[0] / field.j();
  };
  const auto turned_by = [&](double angle) {
    return [=](const Vector<2> &x) -> Vector<2> {
      const Eigen::Rotation2Dd r(angle);
      return r * field(r.inverse() * x);
    };
  };
  EXPECT_NEAR(measure("[[0, 0], [61, 0]]", "[-1, 0]", turned_by(M_PI - 1e-9)), 1, expected_error);
  EXPECT_NEAR(measure("[[0, -61], [0, 0]]", "[0, 2]", turned_by(M_PI / 2)), 1, expected_error);
}

// Nothing is released by a crack whose faces a homogeneous strain does not open. q is smooth over
// 12 particles: sums over lattices miss its integral by (d/w)^4, over random packings by the
// scatter of centres about their cells' centroids, a tenth of d, along a seam of 100 cells.
TEST(JIntegral, IsNoneOfAHomogeneousStrain)
{
  const std::string rings = "/gauges=[" + ring("near", 12, 24) + "," + ring("wide", 20, 55) + "]";
  for (const Body &b : packings) {
    SCOPED_TRACE(b.name);
    const Scene scene = small_scene(std::vector<std::string>{size, crack, rings} + b.overrides);
    SmallBody small(scene);
    GaugeSet<2> gauges(scene, small.body);
    const double strain = 1e-4;
    impose(small,
           [&](const Vector<2> &x) { return Vector<2>(0.3 * strain * x[0], strain * x[1]); });
    const auto v = gauges.read(small.body, 0);
    const double density = strain * strain / 2;
    EXPECT_NEAR(v[0] / (density * 24), 0, 0.01);
    EXPECT_NEAR(v[2] / (density * 55), 0, 0.01);
  }
}

// The energy release rate does not see a motion without strain, as long as it is small.
TEST(JIntegral, DoesNotSeeShiftsAndSmallTurns)
{
  const TipField field{1e-4, 0};
  const Scene scene =
      small_scene({size, crack, "/far_field=none", "/gauges=[" + ring("j", 12, 40) + "]"});
  SmallBody small(scene);
  GaugeSet<2> gauges(scene, small.body);
  impose(small, field);
  const double still = gauges.read(small.body, 0)[0];
  impose(small, [&](const Vector<2> &x) -> Vector<2> {
    return field(x) + Vector<2>(3, 5) + 1e-6 * Vector<2>(-x[1], x[0]);
  });
  // A turn w adds w sigma, which has no resultant, to the flux: what is left is the error of the
  // sum.
  EXPECT_NEAR(gauges.read(small.body, 0)[0] / still, 1, 1e-3);
}

// Stresses that a force on all masses holds in balance, without a crack's: along x a bar whose end
// is pulled, along y one that hangs, turned by a small angle. Without the force's own part J would
// be a modulus of the force times that strain or angle.
TEST(JIntegral, KnowsForcesOnMasses)
{
  const std::string rings = "/gauges=[" + ring("near", 12, 24) + "," + ring("wide", 20, 55) + "]";
  for (const Body &b : packings)
    for (const int axis : {0, 1}) {
      SCOPED_TRACE(fmt::format("{}, {}", b.name, "xy"[axis]));
      const double g = 1e-6, pull = 1e-4;
      const Scene scene = small_scene(
          std::vector<std::string>{size, crack, rings,
                                   fmt::format("/body_force={{\"acceleration\": [{}, {}]}}",
                                               axis == 0 ? g : 0, axis == 1 ? g : 0)} +
          b.overrides);
      SmallBody small(scene);
      GaugeSet<2> gauges(scene, small.body);
      const MaterialParameters &m = scene.material;
      const double nu = m.poissons_ratio, e = m.youngs_modulus / (1 - nu * nu), v = nu / (1 - nu),
                   k = m.density * g / e;
      impose(small, [&](const Vector<2> &x) -> Vector<2> {
        if (axis == 0)
          return {-k * (x[0] * x[0] + v * x[1] * x[1]) / 2 + pull / e * x[0],
                  v * k * x[0] * x[1] - v * pull / e * x[1]};
        return {v * k * x[0] * x[1] - pull * x[1],
                -k * (x[1] * x[1] + v * x[0] * x[0]) / 2 + pull * x[0]};
      });
      const auto values = gauges.read(small.body, 0);
      const double part = m.density * g * (axis == 0 ? pull / e : pull);
      EXPECT_NEAR(values[0] / (part * 36 * 36), 0, 0.01);
      EXPECT_NEAR(values[2] / (part * 75 * 75), 0, 0.01);
    }
}
} // namespace
