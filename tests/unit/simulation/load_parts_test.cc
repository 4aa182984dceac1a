// Loads on parts of sides: both models get the whole load, and along its line of action.
#include "src/simulation/make_loads.h"
#include "src/simulation/test_machine.h"
#include "tests/support/small_plate.h"

#include <fmt/format.h>

#include <cmath>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
const std::vector<BodyKind> plain_bodies = {
    {"hexagonal", {"/far_field=none"}},
    {"turned", {"/far_field=none", "/discrete_zone/orientation=0.3"}},
    {"random", {"/far_field=none", "/discrete_zone/packing=random"}},
    {"mesh", {"/discrete_zone=none"}}};

struct Resultant
{
  Vector<2> force = Vector<2>::Zero();
  double moment = 0; // about the origin
};

double cross(const Vector<2> &a, const Vector<2> &b)
{
  return a[0] * b[1] - a[1] * b[0];
}

/// Of all that acts on a body at rest.
template <int dim>
void compute(CoupledBody<dim> &body, double time = 0)
{
  auto bodies = body.bodies();
  body.coupler->compute_forces(bodies, {0, time, body.dt});
}

Resultant resultant(CoupledBody<2> &body)
{
  compute(body);
  Resultant r;
  const auto add = [&](const Vector<2> &place, const Vector<2> &force) {
    r.force += force;
    r.moment += cross(place, force);
  };
  if (body.zone) {
    const auto &p = body.zone->state;
    for (int i = 0; i < p.size(); ++i) {
      add(get(p.reference, i), get(p.force, i));
      r.moment += p.torque[0][i];
    }
  }
  if (body.far)
    for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
      add(body.far->mesh().nodes[i], get(body.far->force, i));
  return r;
}

// The traction is small: the volumes of particles depend on it, and what their pressures do to
// levers is of its second order.
TEST(LoadParts, TractionOnAPartIsTractionTimesItsAreaInItsMiddle)
{
  const double size = 1e-9;
  struct Case
  {
    const char *load;
    double area;
    Vector<2> middle;
  };
  for (
      const Case &c :
      {Case{R"("boundary": "top", "from": -5.31, "to": 3.77)", 9.08, {-0.77, 60}},
       Case{R"("boundary": "top", "from": 8.23)", 3.77, {10.115, 60}},
       Case{R"("boundary": "left", "within": {"lower": [null, 3.2], "upper": [null, 3.5]})",
            0.3,
            {-12, 3.35}},
       Case{
           R"("boundary": "bottom", "within": {"centre": [1.5, -59], "radius": 1.4142135623730951})",
           2,
           {1.5, -60}}})
    for (const auto &kind : plain_bodies) {
      SCOPED_TRACE(std::string(kind.name) + ": " + c.load);
      SmallBody small(small_scene(kind.overrides +
                                  std::vector<std::string>{std::string("/loads=[{") + c.load +
                                                           R"(, "traction": [0.4e-9, 1e-9]}])"}));
      const Vector<2> force = c.area * Vector<2>(0.4 * size, size);
      const Resultant r = resultant(small.body);
      // Rounding of a few hundred faces whose places are known to 1e-14 of the specimen.
      EXPECT_NEAR((r.force - force).norm() / force.norm(), 0, 1e-11);
      EXPECT_NEAR(r.moment / cross(c.middle, force), 1, 1e-8);
      Vector<2> reaction = Vector<2>::Zero();
      if (small.body.far)
        reaction += small.body.far->reaction(0);
      if (small.body.force())
        reaction += small.body.force()->reaction(0);
      EXPECT_NEAR((reaction - force).norm() / force.norm(), 0, 1e-11);
      const double sign = small.body.loads[0].boundary % 2 ? 1 : -1; // tension on the upper side
      EXPECT_NEAR(TestMachine<2>(small.body).read(small.body, 0).stress, sign * size, 1e-11 * size);
    }
}

TEST(LoadParts, ForcesHaveTheirLineOfActionWhereverTheyAct)
{
  for (const auto &kind : plain_bodies)
    for (const double x : {-11.9, -3.3, 0.0, 2.05, 7.77}) {
      SCOPED_TRACE(kind.name + std::string(" at ") + std::to_string(x));
      SmallBody small(small_scene(
          kind.overrides + std::vector<std::string>{
                               R"(/loads=[{"boundary": "top", "force": [1e-9, -3e-9], "from": )" +
                               std::to_string(x) + R"(, "to": )" + std::to_string(x) + "}]"}));
      const Vector<2> force(1e-9, -3e-9);
      const Resultant r = resultant(small.body);
      EXPECT_NEAR((r.force - force).norm() / force.norm(), 0, 1e-10);
      EXPECT_NEAR(r.moment / cross({x, 60}, force), 1, 1e-7);
    }
}

TEST(LoadParts, ForceIsSpreadOverTheThickness)
{
  for (const auto &kind : plain_bodies) {
    SmallBody small(small_scene(
        kind.overrides + std::vector<std::string>{
                             "/specimen/thickness=3",
                             R"(/loads=[{"boundary": "top", "force": [0, -3e-9], "to": 1.7}])"}));
    EXPECT_NEAR(resultant(small.body).force[1] / -3e-9, 1, 1e-11) << kind.name;
    EXPECT_NEAR(*small.body.loads[0].value[1] / (-3e-9 / (13.7 * 3)), 1, 1e-14);
  }
}

// Parts that make the whole side, each moved as the whole one would be.
TEST(LoadParts, PartsOfAMovedSideHoldLikeTheWhole)
{
  for (const auto &kind : plain_bodies) {
    SCOPED_TRACE(kind.name);
    const auto reaction = [&](const std::string &loads) {
      SmallBody small(
          small_scene(kind.overrides + std::vector<std::string>{"/loads=[" + loads + "]"}));
      compute(small.body); // the load jumps to its displacement, the body is at rest
      Vector<2> sum = Vector<2>::Zero();
      for (std::size_t l = 0; l < small.body.loads.size(); ++l)
        sum += small.body.force() ? small.body.force()->reaction(int(l))
                                  : Vector<2>::Constant(small.body.far->n_held_nodes(int(l)));
      return sum;
    };
    const std::string moved = R"("boundary": "top", "displacement": [1e-3, 2e-3])";
    const Vector<2> whole = reaction("{" + moved + "}"),
                    parts =
                        reaction("{" + moved + R"(, "to": -1.37}, {)" + moved +
                                 R"(, "from": -1.37, "to": 4.9}, {)" + moved + R"(, "from": 4.9})");
    EXPECT_NEAR((parts - whole).norm() / whole.norm(), 0, 1e-12);
  }
}

TEST(LoadParts, NodesInsideAreHeldAndNoOthers)
{
  SmallBody small(small_scene(
      {"/discrete_zone=none",
       R"(/loads=[{"boundary": "top", "displacement": [null, 0.1], "from": -5, "to": 6}])"}));
  const auto &far = *small.body.far;
  int n = 0;
  for (int i = 0; i < far.mesh().n_nodes(); ++i) {
    const Vector<2> &x = far.mesh().nodes[i];
    const bool inside = x[1] == 60 && x[0] >= -5 && x[0] <= 6;
    EXPECT_EQ(far.is_held(i, 1), inside);
    n += inside;
  }
  EXPECT_GT(n, 1);
  EXPECT_EQ(far.n_held_nodes(0), n);
}

// One model carries each part alone; the coupled body adds nothing to it.
TEST(LoadParts, PartsBesideAnOverlapThatEndsAtTheSide)
{
  for (const auto &[range, area] :
       {std::pair(R"("from": -9.5, "to": 9.7)", 19.2), std::pair(R"("from": 37)", 23.)})
  {
    SmallBody small(
        small_scene({std::string(R"(/loads=[{"boundary": "left", "traction": [1e-6, null], )") +
                     range + "}]"}));
    compute(small.body);
    EXPECT_NEAR((small.body.force()->reaction(0) + small.body.far->reaction(0))[0] / (1e-6 * area),
                1, 1e-11)
        << range;
  }
  const auto refused = parse_scene(
      small_plate, "plate",
      {R"(/loads=[{"boundary": "left", "traction": [1e-6, null], "from": -9.5, "to": 10}])"});
  ASSERT_EQ(refused.errors.size(), 1u);
  // 20 - 2 cells of 4.1 - 2 spacings: 9.8
  EXPECT_NE(refused.errors[0].reason.find("0.2 m are missing"), std::string::npos)
      << core::to_string(refused.errors[0]);
}

TEST(LoadParts, PartWithoutNodesIsRefused)
{
  try {
    SmallBody small(small_scene(
        {"/discrete_zone=none",
         R"(/loads=[{"boundary": "top", "displacement": [null, 0.1], "from": 0.1, "to": 0.3}])"}));
    FAIL() << "nothing is held";
  } catch (const core::InputError &error) {
    EXPECT_NE(std::string(error.what()).find("no node"), std::string::npos) << error.what();
  }
}

/// What set-up warns of where a part of the top of the mesh is moved.
std::vector<std::string> warnings_of_part(const std::string &part)
{
  const Scene scene =
      small_scene({"/discrete_zone=none", R"(/far_field={"cell_size": 4})",
                   R"(/loads=[{"boundary": "top", "displacement": [null, 0.1], )" + part + "}]"});
  core::Log log;
  core::Timers timers;
  make_body<2>(scene, log, timers);
  return log.warnings();
}

// Nodes at -12, -8 ... 12. Three of them stand for 10: found as the width of the stamp on a body of
// particles, 64 by 64, that meets the same force.
TEST(LoadParts, NodesThatAreNotNearlyThePartAreTold)
{
  for (const double width : {9.2, 10., 10.9})
    EXPECT_TRUE(
        warnings_of_part(fmt::format(R"("from": {}, "to": {})", -width / 2, width / 2)).empty())
        << width;
  for (const double width : {8.1, 11.9}) {
    const auto warnings =
        warnings_of_part(fmt::format(R"("from": {}, "to": {})", -width / 2, width / 2));
    ASSERT_EQ(warnings.size(), 1u) << width;
    for (const std::string &part :
         {std::string("/loads/0: the nodes of the far field that it holds (3)"),
          std::string("a part of 10 m would"), fmt::format("its part has {:.4g} m:", width),
          std::string("give smaller cells")})
      EXPECT_NE(warnings[0].find(part), std::string::npos) << part << "\n" << warnings[0];
  }
  EXPECT_EQ(warnings_of_part(R"("from": -4.1, "to": 0.1)").size(), 1u) << "6 are no 4.2";
  EXPECT_TRUE(warnings_of_part(R"("from": -0.5, "to": 0.5)").empty()) << "a knife edge";
  // No end where the side ends.
  EXPECT_TRUE(warnings_of_part(R"("from": -1)").empty());
  EXPECT_EQ(warnings_of_part(R"("from": 0.1)").size(), 1u) << "9 are no 11.9";
}

// Where the neighbour is held, too, its end is in the middle between nodes.
TEST(LoadParts, PartsThatMeetHaveNoEndBetweenThem)
{
  const std::string other =
      R"("to": 1}, {"boundary": "top", "displacement": [null, 0.2], "from": 1)";
  EXPECT_TRUE(warnings_of_part(other).empty()); // 14 are 13, and 10 are 11
  EXPECT_EQ(warnings_of_part(R"("from": 1)").size(), 1u) << "9 are no 11";
}

const std::string small_block = R"({
  "dimension": 3,
  "specimen": {"size": [9, 8, 14]},
  "material": {"youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1},
  "discrete_zone": {"extent": "all", "packing": "fcc", "spacing": 1},
  "far_field": {"cell_size": 2.9},
  "time": {"duration": 100}
})";

TEST(LoadParts, InSpaceTheAreaIsExactToo)
{
  const double pi = M_PI;
  struct Case
  {
    const char *load;
    double area;
  };
  for (const Case &c :
       {Case{R"("within": {"lower": [-2.1, -1.3, null], "upper": [3.3, null, null]})", 5.4 * 5.3},
        Case{R"("within": {"centre": [0.4, -0.3, 7.9], "radius": 2.2})", pi * (4.84 - 0.81)}})
    for (const std::vector<std::string> &kind :
         {std::vector<std::string>{"/far_field=none"},
          {"/far_field=none", "/discrete_zone/orientation=[0.3, 0.2, 0.1]"},
          {"/far_field=none", "/discrete_zone/packing=random"},
          {"/discrete_zone=none"}})
    {
      SCOPED_TRACE(std::string(c.load) + " " + kind.back());
      const auto scene = parse_scene(
          small_block, "block",
          kind + std::vector<std::string>{std::string(R"(/loads=[{"boundary": "front", )") +
                                          c.load + R"(, "traction": [null, null, 1e-6]}])"});
      for (const auto &error : scene.errors)
        ADD_FAILURE() << core::to_string(error);
      core::Log log;
      core::Timers timers;
      auto body = make_body<3>(*scene.scene, log, timers);
      compute(body);
      const double force = (body.force() ? body.force()->reaction(0) : body.far->reaction(0))[2];
      EXPECT_NEAR(force / (1e-6 * c.area), 1, 1e-10);
    }
}
} // namespace
