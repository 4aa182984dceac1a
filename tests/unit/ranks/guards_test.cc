// Guards end a run on all ranks, whichever of them finds something: at the same step, with the same
// words and the same place as in one process; what they leave is a checkpoint of sound motion.
#include "dem/many_body_force.h"
#include "src/output/format.h"
#include "src/simulation/guards.h"
#include "src/simulation/regime_control.h"
#include "src/simulation/simulation.h"
#include "tests/support/ranks.h"
#include "tests/support/small_plate.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;
using ligament::test::ranks;

namespace
{
constexpr double step = 0.25; // s, /time/step of the scenes

/// What happens to one particle, behind the forces of a step.
struct Corruption
{
  std::int64_t particle;
  long step;
  std::function<void(particles::Particles<2> &, int)> corrupt;
};

class CorruptedForce : public dem::ManyBodyForce<2>
{
public:
  CorruptedForce(const packings::Packing<2> &packing,
                 const std::vector<core::BoundaryLoad<2>> &loads, const Corruption &corruption)
      : dem::ManyBodyForce<2>(packing, dem::DemMaterial{1, 0.22, 1}, loads), corruption_(corruption)
  {
  }
  void compute(Particles &p, double time) override
  {
    dem::ManyBodyForce<2>::compute(p, time);
    if (std::lround(time / step) != corruption_.step)
      return;
    const int i = p.names().index(corruption_.particle);
    if (i >= 0 && p.part.owns(i))
      corruption_.corrupt(p, i);
  }

private:
  Corruption corruption_;
};

ReadResult slab()
{
  return parse_scene(small_plate, "slab",
                     {"/far_field=none", "/specimen/size=[24, 40]",
                      R"(/discrete_zone={"extent": "all", "packing": "hexagonal", "spacing": 1})",
                      R"(/loads=[{"boundary": "top", "velocity": [null, 1e-5], "ramp": 10}])",
                      "/time/step=0.25", "/time/duration=35", "/output/checkpoint_interval=1e-9"});
}

/// A run by these ranks, which share the folder; from a checkpoint in it where that is given.
RunRecord run(const core::Ranks &by, const std::string &folder, const Corruption &corruption,
              Checkpoint *from = nullptr)
{
  const RunFolder place{folder};
  if (!from && by.is_first()) {
    std::filesystem::remove_all(folder);
    place.create();
  }
  by.any(false);
  const ReadResult input = slab();
  const auto maker = [&](const Scene &, packings::Packing<2> packing,
                         const std::vector<core::BoundaryLoad<2>> &loads,
                         std::map<std::string, Figure> &, core::Log &) {
    return std::make_unique<CorruptedForce>(packing, loads, corruption);
  };
  std::FILE *quiet = std::fopen("/dev/null", "w");
  Simulation<2> simulation(*input.scene, place, quiet, false, from, maker, by);
  simulation.keep_checkpoints(input.resolved);
  const RunRecord record = simulation.run();
  std::fclose(quiet);
  return record;
}

constexpr long never = -1;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// By all ranks and by each one alone; the particle that is corrupted is one of rank `part`.
void expect_one_end(const std::string &words, long at_step,
                    const std::function<void(particles::Particles<2> &, int)> &corrupt,
                    int part = ranks().size() - 1)
{
  const ReadResult input = slab();
  ASSERT_TRUE(input.scene) << core::to_string(input.errors.front());
  const auto names = SmallBody(*input.scene).body.zone->state.names();
  const auto name = names.name(names.size() * (2 * part + 1) / (2 * ranks().size()));
  const std::string together = "together_" + std::to_string(ranks().size()),
                    alone = "alone_" + std::to_string(ranks().rank());
  const Corruption corruption = {name, at_step, corrupt};
  const RunRecord record = run(ranks(), together, corruption), twin = run({}, alone, corruption);
  EXPECT_EQ(record.status, "stopped");
  EXPECT_NE(record.reason.find(words), std::string::npos) << record.reason;
  EXPECT_EQ(record.reason, twin.reason);
  EXPECT_EQ(record.steps, twin.steps);
  EXPECT_EQ(record.trusted_until, twin.trusted_until);
  EXPECT_EQ(record.ranks, ranks().size());
  EXPECT_LT(record.steps, 140);

  ranks().any(false); // the first one has written all of it
  auto found = Checkpoints(RunFolder{together}.checkpoints()).newest_good();
  ASSERT_TRUE(found.checkpoint);
  EXPECT_LE(found.checkpoint->manifest.step, at_step);
  const RunRecord more = run(ranks(), together, {name, never, corrupt}, &*found.checkpoint);
  EXPECT_EQ(more.status, "done") << more.reason;
  EXPECT_EQ(more.steps, 140);
}

// Two steps before guards look: hardly another particle knows of it yet, and who looked in each
// step would see it too early.
constexpr long later = 98;

TEST(Guards, MotionThatIsNotFinite)
{
  for (int part = 0; part < ranks().size(); ++part) {
    SCOPED_TRACE("corrupted on rank " + std::to_string(part));
    expect_one_end(
        "is no longer finite: the run is unstable", later,
        [](auto &p, int i) { p.velocity[1][i] = nan; }, part);
  }
}

TEST(Guards, SpinThatIsNotFinite)
{
  expect_one_end("is no longer finite: the run is unstable", later,
                 [](auto &p, int i) { p.spin[0][i] = nan; });
}

TEST(Guards, ParticlesThatAreFasterThanTheSearch)
{
  expect_one_end("spacings in one step, farther than the search for contacts sees ahead (0.25)",
                 later, [](auto &p, int i) { p.velocity[0][i] = 2 * 0.25 / step; });
}

TEST(Guards, ParticlesThatAreLost)
{
  expect_one_end("is lost: it has gone", later,
                 [](auto &p, int i) { p.displacement[0][i] = -1e8; });
}

TEST(Guards, EnergyFromNowhere)
{
  expect_one_end("came from nowhere: the run is unstable", later + 3,
                 [](auto &p, int i) { p.velocity[0][i] = 0.8 * 0.25 / step; });
}

TEST(Guards, MotionThatStepsBearIsNoFinding)
{
  const RunRecord record =
      run(ranks(), "sound", {7, later, [](auto &p, int i) { p.velocity[0][i] += 1e-6; }});
  EXPECT_EQ(record.status, "done") << record.reason;
}

// Of several places the first one, whoever owns it.
TEST(Guards, ThePlaceIsThatOfOneProcess)
{
  const ReadResult input = slab();
  core::Log log;
  core::Timers timers;
  Reference reference;
  auto parts = make_body<2>(*input.scene, log, timers, reference, make_many_body_force<2>, ranks());
  SmallBody whole(*input.scene);
  auto &p = parts.zone->state;
  auto &q = whole.body.zone->state;
  const auto names = q.names().sorted();
  for (std::size_t k = 1; k < 20; ++k) {
    const auto name = names[k * 7919 % names.size()];
    q.velocity[0][q.names().index(name)] = nan;
    if (const int i = p.names().index(name); i >= 0 && p.part.owns(i))
      p.velocity[0][i] = nan;
  }
  const auto found = find_broken_motion(parts);
  ASSERT_TRUE(found);
  EXPECT_EQ(found, find_broken_motion(whole.body));
}

/// Of cells alone, whole on every rank: each looks at a motion of its own.
struct OwnMesh
{
  SmallBody small{small_scene(body_kinds[2].overrides)};

  OwnMesh() { small.body.ranks = ranks(); }
  bool is_chosen(int part) const { return ranks().rank() == part; }
};

TEST(Guards, CellsThatAreTurnedInsideOut)
{
  for (int part = 0; part < ranks().size(); ++part) {
    OwnMesh mesh;
    EXPECT_FALSE(find_broken_motion(mesh.small.body));
    if (mesh.is_chosen(part))
      mesh.small.deform(Eigen::Vector2d(0, -1.5).asDiagonal());
    const auto found = find_broken_motion(mesh.small.body);
    ASSERT_TRUE(found);
    EXPECT_NE(found->find("the cell of the far field at (-"), std::string::npos) << *found;
    EXPECT_NE(found->find("is turned inside out"), std::string::npos) << *found;
    if (mesh.is_chosen(part))
      mesh.small.body.far->displacement[0][0] = nan;
    EXPECT_NE(find_broken_motion(mesh.small.body).value_or("").find("no longer finite"),
              std::string::npos);
  }
}

TEST(Guards, StrainsBeyondTheLawOfTheFarField)
{
  for (int part = 0; part < ranks().size(); ++part) {
    OwnMesh mesh;
    RegimeControl<2> control(RegimeChoice::automatic, mesh.small.body);
    if (mesh.is_chosen(part))
      mesh.small.deform(Eigen::Vector2d(0, 0.2).asDiagonal());
    const auto found = control.look(mesh.small.body, {0, 0, mesh.small.body.dt}, *mesh.small.log);
    EXPECT_NE(found.value_or("").find("strained by 20.0 %"), std::string::npos);
  }
}

TEST(Guards, TheLargestStrainHasAPlace)
{
  for (int part = 0; part < ranks().size(); ++part) {
    OwnMesh mesh;
    auto &far = *mesh.small.body.far;
    const auto &cells = far.mesh().cells;
    std::vector<int> n_cells(far.mesh().n_nodes());
    for (const auto &cell : cells)
      for (const int node : cell)
        ++n_cells[node];
    const int corner = int(std::find(n_cells.begin(), n_cells.end(), 1) - n_cells.begin());
    const auto cell = std::find_if(cells.begin(), cells.end(), [&](const auto &of) {
      return std::find(of.begin(), of.end(), corner) != of.end();
    });
    ASSERT_NE(cell, cells.end());
    Vector<2> middle = Vector<2>::Zero();
    for (const int node : *cell)
      middle += far.mesh().nodes[node] / double(cell->size());
    if (mesh.is_chosen(part))
      far.displacement[1][corner] = far.mesh().nodes[corner][1] - middle[1];
    RegimeControl<2> control(RegimeChoice::automatic, mesh.small.body);
    const auto found = control.look(mesh.small.body, {0, 0, mesh.small.body.dt}, *mesh.small.log);
    EXPECT_NE(found.value_or("").find(" % at " + place(middle)), std::string::npos)
        << found.value_or("nothing") << ", " << place(middle);
  }
}
} // namespace
