// The points of a body's surface: all of it, and what breaks adds to it.
#include "tests/support/tool_body.h"

#include <Eigen/Geometry>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::string far_tool =
    R"(/tools=[{"name": "a", "shape": "ball", "radius": 1, "place": [500, 0]}])";

template <int dim>
double area(const ContactSurface<dim> &surface)
{
  double sum = 0;
  for (int k = 0; k < surface.size(); ++k)
    sum += surface[k].area;
  return sum;
}

// In a coupled body the cells of the overlap are the particles' affair: no part counts twice, and
// none is missed but what lies between the last particle and the first cell.
TEST(ContactSurface, HasTheAreaOfTheBody)
{
  const std::string far_ball =
      R"(/tools=[{"name": "a", "shape": "ball", "radius": 1, "place": [500, 0, 0]}])";
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    const bool coupled = kind.overrides.empty();
    ToolBody<2> plate(kind.overrides + std::vector<std::string>{far_tool});
    EXPECT_NEAR(area(plate.tools().surface()) / (2 * (24 + 120)), 1, coupled ? 4. / 288 : 1e-9);
    ToolBody<3> bar(kind.overrides + std::vector<std::string>{far_ball});
    EXPECT_NEAR(area(bar.tools().surface()) / (2 * (8 * 60 + 60 * 7 + 8 * 7)), 1,
                coupled ? 60. / 1912 : 1e-9);
  }
}

TEST(ContactSurface, PointsMoveWithTheirParticlesAndCells)
{
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    ToolBody<2> b(kind.overrides + std::vector<std::string>{far_tool});
    const auto &surface = b.tools().surface();
    std::vector<Vector<2>> before;
    std::vector<Vector<2>> normals;
    for (int k = 0; k < surface.size(); ++k) {
      const Vector<2> n = surface.normal(k, b.body.bodies()), x = surface.place(k, b.body.bodies());
      normals.push_back(n);
      EXPECT_NEAR(n.dot(x), std::abs(n[0]) > 0.5 ? 12 : 60, 1e-9);
    }
    for (int k = 0; k < surface.size(); ++k)
      before.push_back(surface.place(k, b.body.bodies()));
    // A rigid turn, which particles and cells follow exactly.
    const double angle = 0.3;
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
    const auto move = [&](const Vector<2> &x, Components<2> &u, int i) {
      set(u, i, Vector<2>(turn * x - x));
    };
    if (b.body.zone)
      for (int i = 0; i < b.body.zone->state.size(); ++i) {
        move(get(b.body.zone->state.reference, i), b.body.zone->state.displacement, i);
        b.body.zone->state.rotation[0][i] = angle;
      }
    if (b.body.far)
      for (int i = 0; i < b.body.far->mesh().n_nodes(); ++i)
        move(b.body.far->mesh().nodes[i], b.body.far->displacement, i);
    for (int k = 0; k < surface.size(); ++k)
      EXPECT_NEAR((surface.place(k, b.body.bodies()) - turn * before[k]).norm(), 0, 1e-11);
    for (int k = 0; k < surface.size(); ++k)
      EXPECT_NEAR((surface.normal(k, b.body.bodies()) - turn * normals[k]).norm(), 0, 1e-11);
  }
}

// The flanks of a crack are surface; those of bonds that break become it.
TEST(ContactSurface, GrowsWithWhatBreaks)
{
  const std::vector<std::string> intact = {"/far_field=none", far_tool};
  const double whole = area(ToolBody<2>(intact).tools().surface());
  ToolBody<2> cut(intact +
                  std::vector<std::string>{R"(/specimen/cracks=[{"points": [[-5, 0], [5, 0]]}])"});
  double flanks = 0;
  for (const BrokenBond &face : cut.body.cut_faces)
    flanks += 2 * face.size;
  EXPECT_GT(flanks, 15);
  EXPECT_NEAR(area(cut.tools().surface()), whole + flanks, 1e-9);

  ToolBody<2> torn(intact +
                   std::vector<std::string>{
                       R"(/material/fracture={"criterion": "maximum_tension", "strength": 1e-3})",
                       R"(/loads=[{"boundary": "top", "velocity": [null, 1e-3]},
                         {"boundary": "bottom", "velocity": [null, -1e-3]}])"});
  while (torn.body.force()->broken_bonds().size() < 10 && torn.now.time < 1000)
    torn.step();
  double broken = 0;
  for (const auto &bond : torn.body.force()->broken_bonds())
    broken += 2 * bond.area;
  EXPECT_GT(broken, 5);
  EXPECT_NEAR(area(torn.tools().surface()), whole + broken, 1e-9);
}

// The layer may add so much to the square of a frequency that the usual step stays.
TEST(ContactSurface, LeavesTheStepNearlyAsItIs)
{
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    const Scene plain = static_scene<2>(kind.overrides);
    core::Log log;
    core::Timers timers;
    const double dt = make_body<2>(plain, log, timers).dt;
    ToolBody<2> b(kind.overrides + std::vector<std::string>{far_tool});
    EXPECT_GT(b.body.dt / dt, 0.96);
    EXPECT_LE(b.body.dt / dt, 1);
  }
}
} // namespace
