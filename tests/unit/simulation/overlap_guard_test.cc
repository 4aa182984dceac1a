// The guard of the overlap sees faces near their limit and broken ones, not those of pads.
#include "src/simulation/overlap_guard.h"
#include "tests/support/small_plate.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
constexpr double strength = 1e-3;

/// Without lateral contraction the tension on faces across the load is E times the strain.
struct GuardedPlate
{
  SmallBody small{
      small_scene({R"(/discrete_zone/packing="square")", "/material/poissons_ratio=0",
                   R"(/material/fracture={"criterion": "face_tension", "strength": 1e-3})"})};
  OverlapGuard<2> guard{small.body};
  double time = 0;

  auto &state() { return small.body.zone->state; }
  const auto &members() { return small.body.coupler->overlap()->members; }

  /// Opens the faces above the particles that `is_below` names by the share of their limit.
  template <typename IsBelow>
  std::optional<std::string> look(double share, IsBelow &&is_below)
  {
    for (int i = 0; i < state().size(); ++i)
      state().displacement[1][i] = is_below(i) ? -share * strength : 0;
    small.body.force()->compute(state(), ++time);
    return guard.look(small.body, time);
  }
  /// An overlap particle inside, pad or not.
  int member(bool pad)
  {
    for (const auto &m : members())
      if (m.pad == pad && (pad || m.position > 0.4) &&
          std::abs(state().reference[0][m.particle]) < 4)
        return m.particle;
    return -1;
  }
};

TEST(OverlapGuard, SpeaksOnceFromNineTenthsOn)
{
  GuardedPlate plate;
  const int i = plate.member(false);
  ASSERT_GE(i, 0);
  const auto only = [&](int k) { return k == i; };
  EXPECT_FALSE(plate.look(0.89, only));
  const auto finding = plate.look(0.91, only);
  ASSERT_TRUE(finding);
  EXPECT_NE(finding->find("91 %"), std::string::npos) << *finding;
  EXPECT_EQ(plate.guard.n_broken(), 0);
  EXPECT_FALSE(plate.look(0.92, only)) << "once is enough";
}

TEST(OverlapGuard, BreaksAreCountedWithTheirEnergy)
{
  GuardedPlate plate;
  const int i = plate.member(false);
  const auto finding = plate.look(1.01, [&](int k) { return k == i; });
  ASSERT_TRUE(finding);
  EXPECT_NE(finding->find("broke"), std::string::npos) << *finding;
  EXPECT_EQ(plate.guard.n_broken(), 1);
  EXPECT_NEAR(plate.guard.energy(), plate.small.body.force()->losses().fracture, 1e-20);
  EXPECT_GT(plate.guard.energy(), 0);
}

TEST(OverlapGuard, WhatIsFarFromTheOverlapIsNotItsMatter)
{
  GuardedPlate plate;
  EXPECT_FALSE(plate.look(2, [&](int k) {
    return std::abs(plate.state().reference[1][k]) < 5 && plate.state().reference[1][k] < 0;
  }));
  EXPECT_GT(plate.small.body.force()->broken_bonds().size(), 10u);
  EXPECT_EQ(plate.guard.n_broken(), 0);
}

TEST(OverlapGuard, PadsAreTheMeshs)
{
  GuardedPlate plate;
  const int i = plate.member(true);
  ASSERT_GE(i, 0);
  // Wholly among pads: its neighbour above is one, too.
  EXPECT_FALSE(plate.look(0.95, [&](int k) { return k == i; }));
}

/// Under a stress along y alone von Mises' stress is sqrt(1 - nu + nu^2) of it in plane strain.
struct YieldingPlate
{
  static constexpr double limit = 1e-3, nu = 0.22;
  SmallBody small{small_scene(
      {fmt::format(R"(/material/plasticity={{"law": "von_mises", "yield_stress": {:.17g}}})",
                   limit *std::sqrt(1 - nu + nu * nu) / (1 - nu * nu))})};
  OverlapGuard<2> guard{small.body};
  double time = 0;

  auto look()
  {
    small.body.force()->compute(small.body.zone->state, ++time);
    return guard.look_at_flow(small.body);
  }
  auto look(double share)
  {
    Eigen::Matrix2d gradient = Eigen::Matrix2d::Zero();
    gradient(1, 1) = share * limit;
    gradient(0, 0) = -nu / (1 - nu) * gradient(1, 1);
    small.deform(gradient);
    return look();
  }
};

TEST(FlowGuard, HasAWordNearFlowAndOneBeyondIt)
{
  YieldingPlate plate;
  EXPECT_FALSE(plate.look(0.78));
  const auto near = plate.look(0.82);
  ASSERT_TRUE(near);
  EXPECT_FALSE(near->is_excess);
  EXPECT_NE(near->text.find("82 %"), std::string::npos) << near->text;
  EXPECT_FALSE(plate.look(0.97)) << "once is enough";
  const auto beyond = plate.look(1.02);
  ASSERT_TRUE(beyond);
  EXPECT_TRUE(beyond->is_excess);
  EXPECT_FALSE(plate.look(1.1)) << "once is enough";
}

// Cells that no particle sees: the zone would have to reach them with the overlap around them.
TEST(FlowGuard, NamesTheBoxThatTheZoneWouldNeed)
{
  YieldingPlate plate;
  const auto &mesh = plate.small.body.far->mesh();
  for (int i = 0; i < mesh.n_nodes(); ++i)
    plate.small.body.far->displacement[1][i] =
        1.3 * plate.limit * std::max(0., mesh.nodes[i][1] - 45);
  const auto finding = plate.look();
  ASSERT_TRUE(finding);
  EXPECT_TRUE(finding->is_excess);
  EXPECT_EQ(finding->text.find("the far field would flow"), 0u) << finding->text;
  double x0, y0, x1, y1;
  const auto box = finding->text.find("box from (");
  ASSERT_NE(box, std::string::npos);
  ASSERT_EQ(std::sscanf(finding->text.c_str() + box, "box from (%lf m, %lf m) to (%lf m, %lf m)",
                        &x0, &y0, &x1, &y1),
            4)
      << finding->text;
  EXPECT_NEAR(x0, -12, 1e-9);
  EXPECT_NEAR(x1, 12, 1e-9);
  EXPECT_NEAR(y1, 60, 1e-9);
  // The first cell that flows lies within a cell of 45.
  EXPECT_NEAR(y0, 45 - plate.small.body.coupler->overlap()->parameters.length, 4.1);
}

TEST(FlowGuard, TurningIsNoStrain)
{
  YieldingPlate plate;
  constexpr double angle = 0.5;
  Eigen::Matrix2d gradient;
  gradient << std::cos(angle) - 1, -std::sin(angle), std::sin(angle), std::cos(angle) - 1;
  plate.small.deform(gradient);
  auto &rotation = plate.small.body.zone->state.rotation[0];
  std::fill(rotation.begin(), rotation.end(), angle);
  EXPECT_FALSE(plate.look());
}
} // namespace
