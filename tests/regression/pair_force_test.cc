// A force that the program has never heard of goes through whole scenes: set-up, coupler, time
// loop, observers, report and comparison.
#include "src/analysis/compare.h"
#include "src/analysis/report.h"
#include "src/output/broken_bonds.h"
#include "src/simulation/simulation.h"
#include "tests/support/pair_force.h"
#include "tests/support/small_plate.h"

#include <filesystem>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// The word "strength" of the scene is Young's modulus times the stretch that breaks a spring.
std::unique_ptr<particles::ParticleForce<2>>
make_pair_force(const Scene &scene, packings::Packing<2> packing,
                const std::vector<core::BoundaryLoad<2>> &loads,
                std::map<std::string, Figure> &figures, core::Log &)
{
  const MaterialParameters &m = scene.material;
  const double stretch = m.fracture.strength.value_or(infinity) / m.youngs_modulus;
  if (std::isfinite(stretch))
    figures["largest_stretch"] = {stretch, ""};
  return std::make_unique<PairForce>(packing, loads, m.youngs_modulus, m.density, scene.plane,
                                     stretch);
}

const std::vector<std::string> cauchy = {"/material/poissons_ratio=0.25"};

/// A zone inside the specimen: no cell of the overlap is clipped, where springs alone are another
/// solid than the mesh. Sides are held across the axis.
const std::vector<std::string> ring = {
    "/specimen/size=[80, 120]", "/coupling/fine_damper=0", "/coupling/gap_filter=0",
    R"(/discrete_zone/region={"lower": [-19, -18], "upper": [18, 20]})"};
const std::string held_sides = R"(/loads=[{"boundary": "left", "displacement": [0, null]},
                                          {"boundary": "right", "displacement": [0, null]}])";

TEST(PairForceTest, OverlapPassesThePatchTest)
{
  const std::vector<std::string> stress = {"/plane=stress",
                                           "/material/poissons_ratio=0.33333333333333333"};
  for (const auto &solid : {cauchy, stress}) {
    const SmallBody small(small_scene(ring + solid), make_pair_force);
    const auto &body = small.body;
    ASSERT_TRUE(body.coupler->overlap());
    EXPECT_LT(body.figures.at("patch_residual").value, 1e-12);
    EXPECT_TRUE(body.zone->state.rotation[0].empty());
    EXPECT_TRUE(body.zone->state.spin[0].empty());
    const double nu = solid == cauchy ? 0.25 : 1 / 3.;
    const double c11 = solid == cauchy ? (1 - nu) / ((1 + nu) * (1 - 2 * nu)) : 1 / (1 - nu * nu);
    EXPECT_NEAR(body.force()->elastic_constants().wave_speed_p, std::sqrt(c11), 1e-12);
  }
}

TEST(PairForceTest, ASceneOfAnotherSolidIsRefused)
{
  EXPECT_THROW(SmallBody(small_scene({"/material/poissons_ratio=0.3"}), make_pair_force),
               core::InputError);
}

// The first mode of plane P waves between free ends goes through mesh, overlap and springs: it
// vanishes after a quarter of its period.
TEST(PairForceTest, WavesPassTheOverlapAtTheSpeedOfTheSolid)
{
  SmallBody small(small_scene(ring + cauchy + std::vector<std::string>{held_sides}),
                  make_pair_force);
  auto &body = small.body;
  auto &zone = body.zone->state;
  const double k = M_PI / 120, omega = k * std::sqrt(1.2); // c_P of E = 1, nu = 1/4
  for (int i = 0; i < zone.size(); ++i)
    zone.velocity[1][i] = 1e-6 * std::sin(k * zone.reference[1][i]);
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    body.far->velocity[1][i] = 1e-6 * std::sin(k * body.far->mesh().nodes[i][1]);
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
  const auto amplitude = [&] {
    double sum = 0;
    for (int i = 0; i < zone.size(); ++i)
      sum += zone.mass[i] * zone.velocity[1][i] * std::sin(k * zone.reference[1][i]);
    return sum;
  };
  coupling::StepTime step{0, 0, body.dt};
  body.coupler->compute_forces(bodies, step);
  const double first = read_ledger(body, step, 0).residual();
  double before = amplitude(), now = before;
  while (now > 0 && step.time < 100) {
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
    ++step.step;
    step.time = double(step.step) * step.dt;
    body.coupler->compute_forces(bodies, step);
    before = now;
    now = amplitude();
  }
  // Velocities stand half a step before the time of the positions.
  const double quarter = step.time - 0.5 * step.dt - step.dt * now / (now - before);
  EXPECT_NEAR(quarter * omega / (M_PI / 2), 1, 1e-3); // the mesh alone disperses by (k h)^2/24
  EXPECT_NEAR(read_ledger(body, step, 0).residual() / first, 1, 1e-5);
}

RunRecord run(const std::string &folder, const std::vector<std::string> &overrides,
              const ForceMaker<2> &make_force = make_pair_force)
{
  const RunFolder place{folder};
  std::filesystem::remove_all(folder);
  place.create();
  std::FILE *quiet = std::fopen("/dev/null", "w");
  const RunRecord record =
      Simulation<2>(small_scene(overrides), place, quiet, true, nullptr, make_force).run();
  std::fclose(quiet);
  return record;
}

// A pulse of ten cells' length.
TEST(PairForceTest, ACoupledRunIsComparedWithItsPureDiscreteTwin)
{
  const auto wave = ring + cauchy +
                    std::vector<std::string>{
                        R"(/loads=[{"boundary": "top", "velocity": [null, 1e-4], "ramp": 40}])",
                        "/time/duration=150", "/output/history_interval=0.5"};
  const RunRecord coupled = run("pair_coupled", wave);
  const RunRecord discrete =
      run("pair_discrete", wave + std::vector<std::string>{"/far_field=none"});
  EXPECT_EQ(coupled.kind, "coupled");
  EXPECT_EQ(discrete.kind, "pure_dem");
  for (const auto &record : {coupled, discrete}) {
    EXPECT_EQ(record.status, "done");
    EXPECT_LT(*record.energy_residual, 1e-4);
    EXPECT_EQ(record.figures.count("share_at_rest"), 0u); // the force wakes nothing
  }
  const CompareResult r = compare("pair_coupled", "pair_discrete");
  EXPECT_TRUE(r.complete);
  ASSERT_TRUE(r.displacement_error) << table(r);
  EXPECT_LT(*r.displacement_error, 0.01) << table(r);
  EXPECT_LT(r.velocity_error.value(), 0.05) << table(r);
  EXPECT_GT(r.kinetic_share.value(), 0.1);
  EXPECT_TRUE(std::filesystem::exists(write_report("pair_coupled")));
}

// The same plate of springs and of the many-body law: one solid.
TEST(PairForceTest, ACrackedPlateBreaks)
{
  const auto plate =
      std::vector<std::string>{
          "/far_field=none",
          R"(/specimen/cracks=[{"points": [[-8, 0], [8, 0]]}])",
          "/damping/mass=0.005",
          R"(/material/fracture={"criterion": "face_tension", "strength": 1e-3})",
          R"(/loads=[{"boundary": "top", "velocity": [null, 1.2e-5], "ramp": 1000},
                     {"boundary": "bottom", "velocity": [null, -1.2e-5], "ramp": 1000}])",
          "/time/duration=3000",
          "/output/history_interval=10"} +
      cauchy;
  const RunRecord springs = run("pair_broken", plate);
  const RunRecord many_body = run("many_body_broken", plate, make_many_body_force<2>);
  for (const auto &record : {springs, many_body}) {
    EXPECT_EQ(record.status, "done");
    EXPECT_TRUE(record.peak_load); // the load has fallen
    // At least two springs per spacing of the 8 left, less what the ends of the initial crack and
    // the sides take, at most a spacing each.
    EXPECT_GE(record.broken_bonds, 2 * (8 - 4));
    EXPECT_LT(*record.energy_residual, 0.02);
  }
  EXPECT_EQ(springs.figures.at("largest_stretch").value, 1e-3);
  EXPECT_EQ(many_body.figures.count("largest_stretch"), 0u);
  EXPECT_EQ(std::int64_t(read_broken_bonds(RunFolder{"pair_broken"}.broken_bonds()).size()),
            springs.broken_bonds);
  const CompareResult r = compare("pair_broken", "many_body_broken");
  EXPECT_TRUE(r.complete);
  // Springs at the two sides carry by the share of their face: at most half a spacing is lost.
  EXPECT_LT(std::abs(r.stiffness_error.value()), 1 / 24.) << table(r);
  EXPECT_TRUE(r.crack_distance_mean) << table(r); // springs have a path of their own
  EXPECT_TRUE(std::filesystem::exists(write_report("pair_broken")));
}
} // namespace
