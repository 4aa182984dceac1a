// A body whose far field has no boxes: gauges, fields, machine, fragments and static matrices read
// it as they read boxes.
#include "src/simulation/body_fields.h"
#include "src/simulation/gauges/fragments.h"
#include "src/simulation/gauges/gauge_set.h"
#include "src/simulation/gauges/j_integral.h"
#include "src/simulation/gauges/small_strain.h"
#include "src/simulation/static_system.h"
#include "src/simulation/test_machine.h"
#include "tests/support/distorted_meshes.h"
#include "tests/support/small_plate.h"
#include "tests/unit/fem/meshes.h"

#include <Eigen/Geometry>

#include <cmath>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// The small plate as a mesh, 24 x 120, of cells moved out of shape.
struct Plate
{
  explicit Plate(const std::vector<std::string> &overrides = {}, bool is_distorted = true)
      : scene(small_scene(overrides + std::vector<std::string>{"/discrete_zone=none"})),
        small(scene)
  {
    auto &far = small.body.far;
    if (is_distorted)
      far = std::make_unique<fem::FemSolver<2>>(fem::distorted(far->mesh(), 0.2), far->body(),
                                                small.body.loads);
    EXPECT_EQ(far->mesh().general.empty(), !is_distorted);
  }
  template <typename Field>
  void impose(const Field &field)
  {
    auto &far = *small.body.far;
    for (int i = 0; i < far.mesh().n_nodes(); ++i)
      set<2>(far.displacement, i, field(far.mesh().nodes[i]));
  }

  Scene scene;
  SmallBody small;
};

Eigen::Matrix2d stretch()
{
  Eigen::Matrix2d u;
  u << 1.03, 0.01, 0.01, 0.98;
  return u;
}

TEST(GeneralCells, GaugesFollowAHomogeneousMotionOfAnySize)
{
  Plate plate({R"(/gauges=[
    {"name": "length", "kind": "distance", "points": [[-3.2, -1.1], [4.4, 22.3]]},
    {"name": "point", "kind": "strain", "points": [[1.3, 2.2]]},
    {"name": "box", "kind": "strain", "lower": [-7, -16], "upper": [5.5, 7]},
    {"name": "tiny", "kind": "strain", "lower": [1, 1], "upper": [2, 2.5]}])"});
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(0.7).toRotationMatrix(), f = turn * stretch();
  plate.small.deform(f - Eigen::Matrix2d::Identity());
  GaugeSet<2> gauges(plate.scene, plate.small.body);
  const auto v = gauges.read(plate.small.body, 0);
  EXPECT_NEAR(v[0], (f * Vector<2>(7.6, 23.4)).norm() - std::hypot(7.6, 23.4), 1e-12);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(v[1 + 3 * k], 0.03, 1e-12);
    EXPECT_NEAR(v[2 + 3 * k], -0.02, 1e-12);
    EXPECT_NEAR(v[3 + 3 * k], 0.01, 1e-12);
  }
}

// Against the mean over a fine grid of places, each in the cell that holds it. In a bending field
// cells that count beyond the box, or by another volume than theirs, shift it.
TEST(GeneralCells, AStressGaugeIsTheMeanOverItsBox)
{
  Plate plate({R"(/gauges=[
    {"name": "cut", "kind": "stress", "lower": [-7, -16], "upper": [5.5, 7]},
    {"name": "side", "kind": "stress", "lower": [3, -9], "upper": [13, 14]},
    {"name": "all", "kind": "stress", "lower": [-13, -61], "upper": [13, 61]}])"});
  plate.impose([](const Vector<2> &x) {
    return Vector<2>(1e-4 * x[0] * x[1], 2e-4 * (x[1] * x[1] / 20 + x[0] * x[0]));
  });
  const auto &body = plate.small.body;
  const auto v = GaugeSet<2>(plate.scene, body).read(body, 0);
  const GaugePlaces<2> places(plate.scene, body);
  const auto mean = [&](const Vector<2> &lower, const Vector<2> &upper) {
    constexpr int n = 200;
    Strain<2> sum = Strain<2>::Zero();
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Vector<2> place =
            lower + Vector<2>((i + 0.5) / n, (j + 0.5) / n).cwiseProduct(upper - lower);
        const auto reading = interpolate(body.far->mesh(), places.cells->find(place), place);
        sum += body.far->body().stiffness * small_strain<2>(reading.gradient(body));
      }
    return Strain<2>(sum / (n * n));
  };
  const Strain<2> exact[] = {mean({-7, -16}, {5.5, 7}), mean({3, -9}, {12, 14}),
                             mean({-12, -60}, {12, 60})};
  // Points of cut cells are an eighth of a cell apart: half of that is 3 % of nine metres.
  for (int k = 0; k < 3; ++k)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(v[3 * k + c], exact[k][c], 0.03 * exact[0].norm()) << k << " " << c;
}

TEST(GeneralCells, SidesAndFieldsShowAHomogeneousMotion)
{
  const double nu = 0.22;
  Plate plate({R"(/loads=[{"boundary": "top", "displacement": [null, 0.006]},
                          {"boundary": "bottom", "displacement": [null, -0.006]}])"});
  plate.small.deform(Eigen::Vector2d(-nu / (1 - nu) * 1e-4, 1e-4).asDiagonal());
  auto &body = plate.small.body;
  EXPECT_NEAR(mean_displacement(body, 1, 0), -12 * nu / (1 - nu) * 1e-4, 1e-16);
  auto halves = body.bodies();
  body.coupler->compute_forces(halves, {0, 0, body.dt});
  const double stress = 1e-4 / (1 - nu * nu);
  const auto reading = TestMachine<2>(body).read(body, 0);
  EXPECT_NEAR(reading.load / (24 * stress), 1, 1e-11);
  const auto fields = cell_fields(body);
  for (const Field &field : fields.node_fields)
    if (field.name == "stress")
      for (std::size_t k = 0; k < field.values.size(); k += 6) {
        EXPECT_NEAR(field.values[k], 0, 1e-11 * stress);
        EXPECT_NEAR(field.values[k + 1], stress, 1e-11 * stress);
        EXPECT_NEAR(field.values[k + 3], 0, 1e-11 * stress);
      }
}

/// Without a tip J = -int q div(sigma) . du/dx. For u = (a x + b y^2, 0) that is -2 G a b int q,
/// and int q is the square of the sum of both half widths of the rectangles.
TEST(GeneralCells, JIntegralIsADomainIntegralOverThem)
{
  GaugeParameters gauge;
  gauge.name = "j";
  gauge.direction = {1, 0, 0};
  gauge.lower = {-48, -48, 0};
  gauge.upper = {48, 48, 0};
  gauge.inner_lower = {-12, -12, 0};
  gauge.inner_upper = {12, 12, 0};
  const double a = 2e-3, b = 3e-4, shear = 1 / (2 * 1.22), expected = -2 * shear * a * b * 60 * 60;
  for (const bool is_distorted : {false, true}) {
    Plate plate({"/specimen/size=[120, 120]"}, is_distorted);
    plate.impose([&](const Vector<2> &x) -> Vector<2> { return {a * x[0] + b * x[1] * x[1], 0}; });
    JIntegral<2> j(gauge, GaugePlaces<2>(plate.scene, plate.small.body));
    GaugeLook<2> look(plate.small.body, 0);
    double values[2];
    j.read(look, values);
    EXPECT_NEAR(values[0] / expected, 1, std::pow(4.1 / 36, 2)) << is_distorted; // (h/width)^2
  }
}

TEST(GeneralCells, FragmentsHaveTheirMass)
{
  Plate plate;
  GaugeParameters gauge;
  gauge.name = "pieces";
  FragmentGauge<2> pieces(gauge, plate.scene, plate.small.body);
  auto &velocity = plate.small.body.far->velocity;
  std::fill(velocity[0].begin(), velocity[0].end(), 0.3);
  const auto fragments = pieces.fragments(plate.small.body);
  ASSERT_EQ(fragments.size(), 1u);
  EXPECT_NEAR(fragments[0].mass, 24 * 120, 1e-9);
  EXPECT_NEAR(fragments[0].centre.norm(), 0, 1e-12);
  EXPECT_NEAR(fragments[0].velocity[0], 0.3, 1e-14);
}

TEST(GeneralCells, PreconditionerIsTheirStiffness)
{
  Plate plate;
  auto &far = plate.small.body.far;
  const fem::Mesh<2> graded = fem::distorted(fem::make_mesh(fem::ring<2>()), 0.2);
  ASSERT_FALSE(graded.hanging.empty());
  far = std::make_unique<fem::FemSolver<2>>(graded, far->body(),
                                            std::vector<core::BoundaryLoad<2>>());
  StaticSystem<2> system(plate.small.body);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::VectorXd y(system.size()), py;
  for (auto &value : y)
    value = uniform(random);
  system.drop_inert(y);
  const Eigen::VectorXd ky = system.stiffness_times(y);
  system.near_stiffness(1).multiply(y, py);
  EXPECT_LT((py - ky).norm(), 1e-13 * ky.norm());
  EXPECT_GT(ky.norm(), 1);
}
} // namespace
