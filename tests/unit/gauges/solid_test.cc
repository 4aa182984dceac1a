// Gauges of bodies in three dimensions.
#include "src/simulation/gauges/fragments.h"
#include "src/simulation/gauges/gauge_set.h"
#include "tests/support/static_body.h"

#include <Eigen/Geometry>

#include <cmath>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
struct Solid
{
  Scene scene;
  core::Log log;
  core::Timers timers;
  CoupledBody<3> body;

  explicit Solid(const std::vector<std::string> &overrides)
      : scene(static_scene<3>(overrides)), body(make_body<3>(scene, log, timers))
  {
  }

  template <typename Field>
  void impose(const Field &field)
  {
    if (body.zone) {
      auto &state = body.zone->state;
      for (int i = 0; i < state.size(); ++i)
        set<3>(state.displacement, i, Vector<3>(field(get(state.reference, i))));
    }
    if (body.far)
      for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
        set<3>(body.far->displacement, i, Vector<3>(field(body.far->mesh().nodes[i])));
  }
  std::vector<double> read() { return GaugeSet<3>(scene, body).read(body, 0); }
};

// 8 x 60 x 7 in spacings.
TEST(GaugesOfSolids, FollowAHomogeneousMotionOfAnySize)
{
  const std::string gauges = R"(/gauges=[
    {"name": "l", "kind": "distance", "points": [[-4, -20, 1], [2, 10, -3.5]]},
    {"name": "o", "kind": "opening", "points": [[4, -1, 0], [4, 1, 0]], "direction": [0, 0, 2]},
    {"name": "e", "kind": "strain", "lower": [null, -5, null], "upper": [3, 20, 3]},
    {"name": "p", "kind": "strain", "points": [[0.3, 2, 3.5]], "angle": "30 deg"}])";
  Eigen::Matrix3d u;
  u << 1.02, 0.01, -0.02, 0.01, 0.97, 0.03, -0.02, 0.03, 1.05;
  const Eigen::Matrix3d r =
      Eigen::AngleAxisd(0.8, Vector<3>(1, 2, -1).normalized()).toRotationMatrix();
  const Eigen::Matrix3d f = r * u, e = u - Eigen::Matrix3d::Identity(),
                        axes = Eigen::AngleAxisd(M_PI / 6, Vector<3>::UnitZ()).toRotationMatrix(),
                        turned = axes.transpose() * e * axes;
  for (const std::vector<std::string> &kind :
       {std::vector<std::string>{},
        {"/far_field=none"},
        {"/discrete_zone=none"},
        {"/far_field=none", "/discrete_zone/packing=random"}})
  {
    SCOPED_TRACE(kind.empty() ? "coupled" : kind.back());
    Solid solid(kind + std::vector<std::string>{gauges});
    solid.impose([&](const Vector<3> &x) -> Vector<3> { return f * x - x; });
    const auto v = solid.read();
    ASSERT_EQ(v.size(), 14u);
    const Vector<3> apart(6, 30, -4.5);
    EXPECT_NEAR(v[0], (f * apart).norm() - apart.norm(), 1e-12);
    EXPECT_NEAR(v[1], 2 * f(2, 1), 1e-12);
    const std::vector<std::pair<int, int>> voigt = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
    for (int k = 0; k < 6; ++k) {
      EXPECT_NEAR(v[2 + k], e(voigt[k].first, voigt[k].second), 1e-12) << k;
      EXPECT_NEAR(v[8 + k], turned(voigt[k].first, voigt[k].second), 1e-12) << k;
    }
  }
}

// Plane field of mode I along a straight front through the body; rectangles as in the plane, with
// fits to neighbours at 1 d and from 5 d on: (1/5)^2/8 of the gradient, twice that of J.
TEST(GaugesOfSolids, EnergyReleaseAlongAFront)
{
  const double k = 1e-4, nu = 0.22, mu = 1 / (2 * (1 + nu)), kappa = 3 - 4 * nu;
  const auto field = [&](const Vector<3> &x) -> Vector<3> {
    const double r = std::hypot(x[0], x[1]), t = std::atan2(x[1], x[0]);
    const double scale = k / (2 * mu) * std::sqrt(r / (2 * M_PI)) * (kappa - std::cos(t));
    return {scale * std::cos(t / 2), scale * std::sin(t / 2), 0};
  };
  for (const char *packing : {"fcc", "random"}) {
    SCOPED_TRACE(packing);
    Solid solid(
        {"/specimen/size=[40, 40, 6]", "/far_field=none",
         std::string("/discrete_zone/packing=") + packing,
         R"(/specimen/cracks=[{"points": [[-21, 0, -4], [0, 0, -4], [0, 0, 4], [-21, 0, 4]]}])",
         R"(/gauges=[{"name": "j", "kind": "j_integral", "direction": [1, 0, 0], "normal": [0, 1, 0],
                   "lower": [-18, -18, 0], "upper": [18, 18, 0], "inner_lower": [-6, -6, 0], "inner_upper": [6, 6, 0]}])"});
    solid.impose(field);
    EXPECT_NEAR(solid.read()[0] / (k * k * (1 - nu * nu)), 1, 0.02);
  }
}

TEST(GaugesOfSolids, SpinOfAFragmentIsThatOfItsRigidMotion)
{
  Solid solid({"/far_field=none",
               R"(/specimen/cracks=[{"points": [[-5, 0, -5], [5, 0, -5], [5, 0, 5], [-5, 0, 5]]}])",
               R"(/gauges=[{"name": "f", "kind": "fragments"}])"});
  const Vector<3> spin(0.1, -0.3, 0.2), drift(1, 2, 3);
  auto &state = solid.body.zone->state;
  for (int i = 0; i < state.size(); ++i) {
    const Vector<3> x = get(state.reference, i);
    set<3>(state.velocity, i, x[1] > 0 ? Vector<3>(drift + spin.cross(x)) : Vector<3>::Zero());
    set<3>(state.spin, i, x[1] > 0 ? spin : Vector<3>::Zero());
  }
  auto list =
      FragmentGauge<3>(solid.scene.gauges[0], solid.scene, solid.body).fragments(solid.body);
  ASSERT_EQ(list.size(), 2u);
  if (list[0].centre[1] < 0)
    std::swap(list[0], list[1]);
  EXPECT_NEAR((list[0].spin - spin).norm(), 0, 1e-12);
  EXPECT_NEAR((list[0].velocity - drift - spin.cross(list[0].centre)).norm(), 0, 1e-12);
  EXPECT_NEAR(list[1].spin.norm(), 0, 1e-12);
  EXPECT_NEAR(list[0].mass + list[1].mass, 8 * 60 * 7, 1e-9);
}
} // namespace
