// Other materials from scene and packing file to the body: who is of which one, where they may lie.
#include "core/check.h"
#include "core/files.h"
#include "src/simulation/energy_ledger.h"
#include "tests/support/small_plate.h"

#include <fmt/format.h>


using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string stiff = R"({"youngs_modulus": 10, "poissons_ratio": 0.3, "density": 3)",
                  ball = stiff + R"(, "balls": [{"centre": [2, 3], "radius": 2.5}]})",
                  box = stiff + R"(, "boxes": [{"lower": [1, -1], "upper": [5, 3]}]})";

TEST(Inclusions, TakeTheParticlesOfTheirRegionsLaterOnesFirst)
{
  SmallBody small(
      small_scene({"/inclusions=[" + ball + ", " + box + "]", "/far_field/cell_size=3"}));
  const auto &state = small.body.zone->state;
  const auto &force = *small.body.force();
  int n[3] = {};
  for (int i = 0; i < state.size(); ++i) {
    const double x = state.reference[0][i], y = state.reference[1][i];
    const bool in_box = x > 1 && x < 5 && y > -1 && y < 3, in_ball = std::hypot(x - 2, y - 3) < 2.5;
    ASSERT_EQ(force.material(i), in_box ? 2 : in_ball ? 1 : 0);
    EXPECT_DOUBLE_EQ(state.mass[i], (force.material(i) ? 3 : 1) * state.volume[i]);
    ++n[force.material(i)];
  }
  EXPECT_GT(n[1], 3);
  EXPECT_GT(n[2], 10);
}

// Under plane strain each material has the stress across the plane of its own nu.
TEST(Inclusions, HaveTheStressAcrossThePlaneOfTheirNu)
{
  SmallBody small(small_scene({"/inclusions=[" + box + "]", "/far_field/cell_size=3"}));
  small.deform(1e-4 * Eigen::Matrix2d::Identity());
  auto &state = small.body.zone->state;
  auto &force = *small.body.force();
  force.compute(state, 1);
  Components<3> stress;
  std::vector<double> across;
  force.stresses(state, stress);
  force.stresses_out_of_plane(state, across);
  ASSERT_EQ(across.size(), std::size_t(state.size()));
  for (int i = 0; i < state.size(); ++i)
    EXPECT_NEAR(across[i], (force.material(i) ? 0.3 : 0.22) * (stress[0][i] + stress[1][i]), 1e-18);
}

/// A packing file: rows of a square lattice in the plate's pure discrete twin, jittered, every
/// `stride`-th particle of material 1.
std::string write_packing(double half_height, int stride)
{
  std::string text = "x,y,r,material\nm,m,m,1\n";
  int n = 0;
  for (double y = -half_height + 0.5; y < half_height; ++y)
    for (double x = -11.5; x < 12; ++x, ++n)
      text += fmt::format("{},{},0.5,{}\n", x + 0.1 * std::sin(7 * n), y + 0.1 * std::cos(5 * n),
                          int(n % stride == 0));
  const std::string path = "inclusions_test.csv";
  core::write_file(path, text);
  return path;
}

std::vector<std::string> from_file(const std::string &path)
{
  return {"/discrete_zone/packing=file", "/discrete_zone/packing_file=" + path,
          "/discrete_zone/spacing=1.0746"}; // of cells of volume 1
}

TEST(Inclusions, ThePackingFileNamesThem)
{
  const auto file = from_file(write_packing(10, 7));
  const std::vector<std::string> discrete = {"/specimen/size=[24, 20]", "/far_field=none",
                                             "/discrete_zone/extent=all"};
  SmallBody small(
      small_scene(file + discrete + std::vector<std::string>{"/inclusions=[" + stiff + "}]"}));
  const auto &state = small.body.zone->state;
  for (int i = 0; i < state.size(); ++i)
    ASSERT_EQ(small.body.force()->material(i), state.global_id[i] % 7 == 0);
  ASSERT_EQ(small.body.seeds->material.size(), std::size_t(small.body.seeds->size()));
  for (int k = 0; k < small.body.seeds->size(); ++k)
    ASSERT_EQ(small.body.seeds->material[k], small.body.seeds->id[k] % 7 == 0);
  // Materials that no inclusion has, and those of a coupled body's overlap.
  EXPECT_THROW(SmallBody(small_scene(file + discrete)), core::InputError);
  const auto whole = from_file(write_packing(60, 7));
  try {
    SmallBody(small_scene(whole + std::vector<std::string>{"/inclusions=[" + stiff + "}]"}));
    FAIL() << "a second material in the overlap";
  } catch (const core::InputError &error) {
    EXPECT_NE(std::string(error.what()).find("lies in the overlap"), std::string::npos)
        << error.what();
  }
}

// A toughness is calibrated with size factors (D12b), a given strength is the one of each face: in
// one body, too, whichever of the two materials has which.
TEST(Inclusions, AGivenStrengthIsThatOfItsFaces)
{
  const std::string given = R"("fracture": {"criterion": "maximum_tension", "strength": 1e-3})",
                    tough = R"("fracture": {"criterion": "maximum_tension", "toughness": 1})",
                    body = R"("youngs_modulus": 1, "poissons_ratio": 0, "density": 1, )";
  const std::string boxes = R"(, "boxes": [{"lower": [-5, -5], "upper": [5, 5]}])";
  for (const bool is_inclusion : {true, false})
    for (const double share : {0.98, 1.02}) {
      SCOPED_TRACE(fmt::format("{} {}", is_inclusion, share));
      SmallBody small(small_scene(
          {"/material={" + body + (is_inclusion ? tough : given) + "}",
           "/inclusions=[{" + body + (is_inclusion ? given : tough) + boxes + "}]",
           R"(/discrete_zone/packing="square")", "/far_field=none", "/discrete_zone/extent=all"}));
      small.deform(Eigen::Vector2d(0, share * 1e-3).asDiagonal());
      auto &zone = *small.body.zone;
      zone.force->compute(zone.state, 1);
      EXPECT_EQ(zone.force->broken_bonds().size() > 0, share > 1);
      for (const auto &bond : zone.force->broken_bonds())
        EXPECT_TRUE((zone.force->material(bond.i) == 1) == is_inclusion ||
                    (zone.force->material(bond.j) == 1) == is_inclusion);
    }
}

// Coupled and undamped: the invariant of the whole body, interfaces included, is kept to round-off
// of a strain of 1e-6.
TEST(Inclusions, EnergyIsKept)
{
  SmallBody small(small_scene({"/inclusions=[" + ball + "]", "/far_field/cell_size=3",
                               "/coupling/fine_damper=0", "/coupling/gap_filter=0"}));
  small.deform(Eigen::Vector2d(0, 1e-6).asDiagonal());
  auto bodies = small.body.bodies();
  coupling::StepTime step{0, 0, small.body.dt};
  small.body.coupler->compute_forces(bodies, step);
  const auto first = read_ledger(small.body, step, 0);
  for (; step.step < 400; ++step.step, step.time = step.step * step.dt) {
    small.body.coupler->kick(bodies, step);
    small.body.coupler->drift(bodies, step);
    small.body.coupler->compute_forces(bodies, step);
  }
  const auto last = read_ledger(small.body, step, 0);
  EXPECT_NEAR((last.residual() - first.residual()) / first.potential(), 0, 5e-6);
  EXPECT_GT(last.kinetic(), 0.01 * first.potential());
}
} // namespace
