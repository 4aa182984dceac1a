// Pieces of cut bodies: how many, how heavy, how they move.
#include "src/output/table.h"
#include "src/simulation/gauges/fragments.h"
#include "src/simulation/gauges/gauge_set.h"
#include "tests/support/small_plate.h"

#include <filesystem>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
std::vector<std::string> cuts(const std::vector<double> &at_y)
{
  std::string list;
  for (const double y : at_y)
    list += fmt::format("{}{{\"points\": [[-12, {}], [12, {}]]}}", list.empty() ? "" : ", ", y, y);
  return {"/specimen/cracks=[" + list + "]", R"(/discrete_zone/packing="square")"};
}

const std::string counted = R"(/gauges=[{"name": "pieces", "kind": "fragments"}])";

struct Pieces
{
  explicit Pieces(const std::vector<std::string> &overrides)
      : scene(small_scene(overrides + std::vector<std::string>{counted})), small(scene),
        gauge(scene.gauges[0], scene, small.body)
  {
  }
  std::vector<Fragment> list() { return gauge.fragments(small.body); }

  Scene scene;
  SmallBody small;
  FragmentGauge<2> gauge;
};

// 24 x 120, density 1.
TEST(Fragments, PiecesOfACutPlate)
{
  Pieces whole(cuts({}) + std::vector<std::string>{"/far_field=none"});
  ASSERT_EQ(whole.list().size(), 1u);
  EXPECT_NEAR(whole.list()[0].mass, 24 * 120, 1e-9);

  Pieces two(cuts({10}) + std::vector<std::string>{"/far_field=none"});
  ASSERT_EQ(two.list().size(), 2u);
  EXPECT_NEAR(two.list()[0].mass, 24 * 70, 1e-9);
  EXPECT_NEAR(two.list()[0].centre[1], -25, 1e-9);
  EXPECT_NEAR(two.list()[1].mass, 24 * 50, 1e-9);

  // Both halves of the mesh are pieces of their own, with the particles that hang on them.
  Pieces coupled(cuts({3, -3}));
  ASSERT_EQ(coupled.list().size(), 3u);
  EXPECT_TRUE(coupled.list()[0].has_mesh);
  EXPECT_TRUE(coupled.list()[1].has_mesh);
  EXPECT_FALSE(coupled.list()[2].has_mesh);
  EXPECT_NEAR(coupled.list()[2].mass, 24 * 6, 1e-9);
  EXPECT_EQ(coupled.list()[2].particles, 24 * 6);
  // Mesh and particles share the overlap, whatever cells of particles its edge cuts.
  double sum = 0;
  for (const Fragment &f : coupled.list())
    sum += f.mass;
  EXPECT_NEAR(sum, 24 * 120, 1e-3 * 24 * 120);
}

// Each piece moves as a rigid body of its own, beginning and present places apart.
TEST(Fragments, MotionIsThatOfRigidPieces)
{
  for (const char *far : {"/coupling/overlap_cells=2", "/far_field=none"}) {
    SCOPED_TRACE(far);
    Pieces pieces(cuts({3}) + std::vector<std::string>{far});
    const auto velocity = [](const Vector<2> &x) -> Vector<2> {
      return x[1] > 3 ? Vector<2>(1 - 0.2 * x[1], 2 + 0.2 * x[0]) : Vector<2>(-3, 0.5);
    };
    auto &body = pieces.small.body;
    auto &state = body.zone->state;
    for (int i = 0; i < state.size(); ++i) {
      const Vector<2> x = get(state.reference, i);
      set<2>(state.velocity, i, velocity(x + Vector<2>(7, 0)));
      state.spin[0][i] = x[1] > 3 ? 0.2 : 0;
      set<2>(state.displacement, i, Vector<2>(7, 0));
    }
    if (body.far)
      for (int i = 0; i < body.far->mesh().n_nodes(); ++i) {
        const Vector<2> x = body.far->mesh().nodes[i];
        set<2>(body.far->velocity, i, velocity(x + Vector<2>(7, 0)));
        set<2>(body.far->displacement, i, Vector<2>(7, 0));
      }
    const auto list = pieces.list();
    ASSERT_EQ(list.size(), 2u);
    const Fragment &lower = list[0], &upper = list[1];
    EXPECT_NEAR((lower.velocity - Vector<3>(-3, 0.5, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR(lower.spin[2], 0, 1e-12);
    EXPECT_NEAR(upper.spin[2], 0.2, 1e-12);
    EXPECT_NEAR(upper.velocity[0], 1 - 0.2 * upper.centre[1], 1e-12);
    EXPECT_NEAR(upper.velocity[1], 2 + 0.2 * upper.centre[0], 1e-12);
    EXPECT_NEAR(upper.centre[0], 7, 0.5);
    const auto row = GaugeSet<2>(pieces.scene, body).read(body, 0);
    EXPECT_EQ(row[1], lower.mass);
    EXPECT_NEAR(row[2], -3, 1e-12);
    EXPECT_NEAR(row[3], 0.5, 1e-12);
  }
}

TEST(Fragments, LightPiecesAreNotCountedAndTheListIsWritten)
{
  const auto overrides = cuts({10, 12}) + std::vector<std::string>{"/far_field=none"};
  const Scene scene = small_scene(
      overrides + std::vector<std::string>{
                      R"(/gauges=[{"name": "pieces", "kind": "fragments", "mass": 100}])"});
  SmallBody small(scene);
  GaugeSet<2> gauges(scene, small.body);
  const auto values = gauges.read(small.body, 0);
  EXPECT_EQ(values[0], 2); // that between the cuts has 48
  EXPECT_NEAR(values[1], 24 * 70, 1e-9);
  RunFolder folder{"fragments"};
  std::filesystem::create_directories(folder.path);
  gauges.write(small.body, folder);
  const Table table = read_csv(folder.fragments());
  ASSERT_EQ(table.n_rows(), 2u);
  EXPECT_NEAR(table.column("mass", "kg")[1], 24 * 48, 1e-9);
}

TEST(Fragments, AreCountedAgainWhenSomethingHasBroken)
{
  const Scene scene = small_scene(std::vector<std::string>{
      R"(/discrete_zone/packing="square")", "/material/poissons_ratio=0", "/far_field=none",
      R"(/material/fracture={"criterion": "face_tension", "strength": 1e-3})", counted});
  SmallBody small(scene);
  GaugeSet<2> gauges(scene, small.body);
  EXPECT_EQ(gauges.read(small.body, 0)[0], 1);
  auto &state = small.body.zone->state;
  for (int i = 0; i < state.size(); ++i)
    if (state.reference[1][i] > 0)
      state.displacement[1][i] = 2e-3;
  small.body.force()->compute(state, 1);
  EXPECT_EQ(gauges.read(small.body, 1)[0], 2);
  EXPECT_NEAR(gauges.read(small.body, 1)[1], 24 * 60, 1e-9);
}
} // namespace
