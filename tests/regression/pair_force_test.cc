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
  figures["largest_stretch"] = {stretch, ""};
  return std::make_unique<PairForce>(packing, loads, m.youngs_modulus, m.density, scene.plane,
                                     stretch);
}

const std::vector<std::string> cauchy = {"/material/poissons_ratio=0.25"};

// A zone inside the specimen: no cell of the overlap is clipped.
TEST(PairForceTest, OverlapPassesThePatchTest)
{
  const std::vector<std::string> ring = {
      "/specimen/size=[80, 82]",
      R"(/discrete_zone/region={"lower": [-19, -18], "upper": [18, 20]})"};
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

// The first mode of a free bar, of which the particles are the middle third. Rows along the axis
// and sides midway between rows: springs of a free side carry nothing across it, as in the solid.
TEST(PairForceTest, WavesPassTheOverlapAtTheSpeedOfTheSolid)
{
  constexpr double width = 14 * 1.7320508075688772, length = 120, nu = 0.25;
  const auto bar = std::vector<std::string>{fmt::format("/specimen/size=[{}, {}]", width, length),
                                            "/discrete_zone/orientation=1.5707963267948966",
                                            "/coupling/fine_damper=0", "/coupling/gap_filter=0"} +
                   cauchy;
  SmallBody small(small_scene(bar), make_pair_force);
  auto &body = small.body;
  auto &zone = body.zone->state;
  // Plane strain: E' = E/(1 - nu^2), nu' = nu/(1 - nu); the mass moves sideways, too (Love).
  const double k = M_PI / length, across = nu / (1 - nu);
  const double omega =
      k * std::sqrt(1 / (1 - nu * nu)) / std::sqrt(1 + std::pow(across * k * width, 2) / 12);
  const auto start = [&](double x, double y, Components<2> &v, int i) {
    v[0][i] = -1e-6 * across * x * k * std::cos(k * y);
    v[1][i] = 1e-6 * std::sin(k * y);
  };
  for (int i = 0; i < zone.n_owned; ++i)
    start(zone.reference[0][i], zone.reference[1][i], zone.velocity, i);
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    start(body.far->mesh().nodes[i][0], body.far->mesh().nodes[i][1], body.far->velocity, i);
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
  const auto amplitude = [&] {
    double sum = 0;
    for (int i = 0; i < zone.n_owned; ++i)
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
  // Velocities stand half a step before the time of the positions, at the start as well.
  const double quarter = step.time - step.dt * now / (now - before);
  EXPECT_NEAR(quarter * omega / (M_PI / 2), 1, 2e-3); // the mesh alone disperses by (k h)^2/24
  EXPECT_NEAR(read_ledger(body, step, 0).residual() / first, 1, 1e-5);
}

RunRecord run(const std::string &folder, const std::vector<std::string> &overrides)
{
  const RunFolder place{folder};
  std::filesystem::remove_all(folder);
  place.create();
  std::FILE *quiet = std::fopen("/dev/null", "w");
  const RunRecord record =
      Simulation<2>(small_scene(overrides), place, quiet, true, make_pair_force).run();
  std::fclose(quiet);
  return record;
}

TEST(PairForceTest, ACrackedPlateBreaksLikeItsPureDiscreteTwin)
{
  const auto plate =
      std::vector<std::string>{
          R"(/specimen/cracks=[{"points": [[-4, 0], [4, 0]]}])",
          R"(/material/fracture={"criterion": "face_tension", "strength": 1e-3})",
          R"(/loads=[{"boundary": "top", "velocity": [null, 1.2e-5], "ramp": 1000},
                     {"boundary": "bottom", "velocity": [null, -1.2e-5], "ramp": 1000}])",
          R"(/time={"duration": 6000, "stop_when": "specimen_broken"})",
          "/output/history_interval=10"} +
      cauchy;
  const RunRecord coupled = run("pair_coupled", plate);
  const RunRecord discrete =
      run("pair_discrete", plate + std::vector<std::string>{"/far_field=none"});
  EXPECT_EQ(coupled.kind, "coupled");
  EXPECT_EQ(discrete.kind, "pure_dem");
  for (const auto &record : {coupled, discrete}) {
    EXPECT_EQ(record.status, "done");
    EXPECT_EQ(record.reason.substr(0, 15), "specimen broken");
    EXPECT_EQ(record.figures.at("largest_stretch").value, 1e-3);
    // A crack along one row: two springs per spacing of the 16 left, less what the ends of the
    // initial crack and the sides take, at most a spacing each.
    EXPECT_GE(record.broken_bonds, 2 * (16 - 4));
    EXPECT_LT(*record.energy_residual, 0.02);
    EXPECT_TRUE(record.skipped.size() <= 1) << record.skipped[0].what; // no part of another law
  }
  EXPECT_EQ(std::int64_t(read_broken_bonds(RunFolder{"pair_coupled"}.broken_bonds()).size()),
            coupled.broken_bonds);
  const CompareResult r = compare("pair_coupled", "pair_discrete");
  EXPECT_TRUE(r.complete);
  EXPECT_LT(std::abs(r.peak_load_error.value()), 0.01);
  EXPECT_LT(std::abs(r.stiffness_error.value()), 0.003);
  EXPECT_LT(r.crack_distance_mean.value(), 1);
  EXPECT_LT(r.displacement_error.value(), 0.01);
  EXPECT_TRUE(std::filesystem::exists(write_report("pair_coupled")));
}
} // namespace
