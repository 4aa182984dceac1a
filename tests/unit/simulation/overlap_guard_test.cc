// The guard of the overlap sees faces near their limit and broken ones, not those of pads.
#include "src/simulation/overlap_guard.h"
#include "tests/support/small_plate.h"

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
    return guard.look(small.body);
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
} // namespace
