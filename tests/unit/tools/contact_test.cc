// What tools do to a body that is held in place: forces against a plain twin, and against energies.
#include "core/extremes.h"
#include "core/keyed_error.h"
#include "src/simulation/tools/make_tools.h"
#include "tests/oracle/tool_contact.h"
#include "tests/support/tool_body.h"

#include <fmt/format.h>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// Adds the same to all places.
template <int dim>
void shift(CoupledBody<dim> &body, const Vector<dim> &by)
{
  for (int c = 0; c < dim; ++c) {
    if (body.zone)
      for (double &u : body.zone->state.displacement[c])
        u += by[c];
    if (body.far)
      for (double &u : body.far->displacement[c])
        u += by[c];
  }
}

template <int dim>
void clear_forces(CoupledBody<dim> &body)
{
  const auto clear = [](auto &components) {
    for (auto &component : components)
      std::fill(component.begin(), component.end(), 0.);
  };
  if (body.zone) {
    clear(body.zone->state.force);
    clear(body.zone->state.torque);
  }
  if (body.far)
    clear(body.far->force);
}

template <int dim>
Vector<dim> force_on(const CoupledBody<dim> &body)
{
  Vector<dim> sum = Vector<dim>::Zero();
  for (int c = 0; c < dim; ++c) {
    if (body.zone)
      for (const double f : body.zone->state.force[c])
        sum[c] += f;
    if (body.far)
      for (const double f : body.far->force[c])
        sum[c] += f;
  }
  return sum;
}

TEST(ToolContact, ADiscPressesLikeItsPlainTwin)
{
  ToolBody<2> b({"/far_field=none",
                 R"(/tools=[{"name": "a", "shape": "ball", "radius": 30, "place": [2, 90.05]}])"});
  auto &state = b.body.zone->state;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  for (int i = 0; i < state.size(); ++i) {
    state.displacement[0][i] = uniform(random);
    state.displacement[1][i] = 0.3 + uniform(random);
    state.rotation[0][i] = uniform(random);
  }
  clear_forces(b.body);
  b.body.tools->act(b.body.bodies(), b.now, 1);
  DiscContact twin{1, 1, 1, ContactStiffness().share, b.body.dt_zone, {2, 90.05}, 30};
  twin.press(*b.body.force(), state);
  EXPECT_GE(twin.force.size(), 6u);
  double largest = 0;
  for (const auto &[i, f] : twin.force)
    keep_largest(largest, f.norm());
  for (int i = 0; i < state.size(); ++i) {
    const Vector<2> f = twin.force.count(i) ? twin.force[i] : Vector<2>(0, 0);
    EXPECT_NEAR((get(state.force, i) - f).norm() / largest, 0, 1e-13);
    EXPECT_NEAR((state.torque[0][i] - (twin.torque.count(i) ? twin.torque[i] : 0)) / largest, 0,
                1e-13);
  }
  EXPECT_NEAR(b.body.tools->energy().contact / twin.energy, 1, 1e-13);
  EXPECT_NEAR((b.body.tools->read(0).force - force_on(b.body)).norm() / largest, 0, 1e-12);
}

// Minus the slope of the energy stored between a tool and a body that is shifted.
template <int dim>
void expect_gradient(const std::vector<std::string> &overrides, const Vector<dim> &into)
{
  ToolBody<dim> b(overrides);
  shift<dim>(b.body, into);
  clear_forces(b.body);
  b.body.tools->act(b.body.bodies(), b.now, 1);
  const Vector<dim> force = force_on(b.body);
  ASSERT_GT(force.norm(), 0);
  const double h = 1e-7;
  for (int c = 0; c < dim; ++c) {
    double energy[2];
    for (const int k : {0, 1}) {
      const Vector<dim> by = (k ? h : -h) * Vector<dim>::Unit(c);
      shift<dim>(b.body, by);
      b.body.tools->act(b.body.bodies(), b.now, 1);
      energy[k] = b.body.tools->energy().contact;
      shift<dim>(b.body, -by);
    }
    EXPECT_NEAR((force[c] + (energy[1] - energy[0]) / (2 * h)) / force.norm(), 0, 1e-6) << c;
  }
}

TEST(ToolContact, ForcesAreSlopesOfTheEnergy)
{
  const std::string wedge = R"(/tools=[{"name": "a", "shape": "wedge", "place": [1.3, 60.05],
    "points": [[0, 0], [9, 6], [-5, 6]], "orientation": 0.2}])",
                    roller = R"(/tools=[{"name": "a", "shape": "roller", "radius": 7,
    "place": [19.05, 18]}])";
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    expect_gradient<2>(kind.overrides + std::vector<std::string>{wedge}, {0, 1.9});
    expect_gradient<2>(kind.overrides + std::vector<std::string>{roller}, {0.4, 0});
    expect_gradient<3>(
        kind.overrides +
            std::vector<std::string>{R"(/tools=[{"name": "a", "shape": "ball", "radius": 7,
              "place": [11.05, 14, 1]}])"},
        {0.4, 0, 0});
    expect_gradient<3>(
        kind.overrides +
            std::vector<std::string>{R"(/tools=[{"name": "a", "shape": "roller", "radius": 5,
              "place": [0, 35.05, 0], "orientation": [0, 0.3, 0], "length": 6}])"},
        {0, 0.4, 0});
  }
}

// The layer of the tool and the impedance of absorbing sides are those of the material that lies
// there: a body of one inclusion moves like the same body without any.
TEST(ToolContact, LayersAndAbsorbingSidesAreOfTheMaterialThatIsThere)
{
  const auto body_of = [](const std::string &materials, bool has_layer) {
    return std::vector<std::string>{
        "/far_field=none", materials,
        fmt::format(R"(/loads=[{{"boundary": "bottom", "absorbing": true{}}}])",
                    has_layer ? R"(, "absorbing_layer": 6)" : ""),
        R"(/tools=[{"name": "plate", "shape": "plate", "size": [30, 4], "place": [0, 62],
            "velocity": [null, -0.01]}])"};
  };
  const std::string hard = R"("youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1)";
  for (const bool has_layer : {false, true}) {
    ToolBody<2> plain(body_of("/material={" + hard + "}", has_layer));
    auto overrides = body_of(
        R"(/material={"youngs_modulus": 0.02, "poissons_ratio": 0.1, "density": 3})", has_layer);
    overrides.push_back("/inclusions=[{" + hard +
                        R"(, "boxes": [{"lower": [-99, -99], "upper": [99, 99]}]}])");
    ToolBody<2> included(overrides);
    ASSERT_EQ(included.body.zone->state.size(), plain.body.zone->state.size());
    EXPECT_NEAR(included.now.dt / plain.now.dt, 1, 1e-12);
    const double end = 150; // P waves have come down through 120 spacings
    while (plain.now.time < end)
      plain.step();
    while (included.now.time < end)
      included.step();
    const double pressed = plain.tools().read(0).force[1];
    EXPECT_LT(pressed, 0);
    EXPECT_NEAR(included.tools().read(0).force[1] / pressed, 1, 1e-9);
    const double absorbed = plain.body.zone->dashpots.energy();
    EXPECT_GT(absorbed, 0);
    EXPECT_NEAR(included.body.zone->dashpots.energy() / absorbed, 1, 1e-9);
  }
}

// p = k g on all of it: the corners of a mesh have half of what the others have.
TEST(ToolContact, APlatePressesEvenly)
{
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    ToolBody<2> b(kind.overrides + std::vector<std::string>{
                                       R"(/tools=[{"name": "a", "shape": "plate",
      "size": [40, 4], "place": [0, 62]}])"});
    shift<2>(b.body, {0, 0.1});
    clear_forces(b.body);
    b.body.tools->act(b.body.bodies(), b.now, 1);
    EXPECT_NEAR(b.body.tools->read(0).area, 24, 1e-9);
    if (!b.body.far)
      continue;
    const auto &mesh = b.body.far->mesh();
    double corner = 0, inner = 0;
    for (int i = 0; i < mesh.n_nodes(); ++i)
      if (mesh.nodes[i][1] > 59.9) {
        const double f = b.body.far->force[1][i];
        (std::abs(mesh.nodes[i][0]) > 11.9 ? corner : inner) = f;
      }
    EXPECT_LT(inner, 0);
    // Where (T3) limits the layer it does by the larger of two edges of the corner's cell.
    EXPECT_NEAR(corner / inner, 0.5, 0.04);
  }
}

// Whether all points are looked at in every step, or few in most: the same bits.
TEST(ToolContact, TheSearchChangesNothing)
{
  const Scene scene = static_scene<2>({"/far_field=none",
                                       R"(/tools=[{"name": "a", "shape": "ball", "radius": 6,
    "place": [2, 67], "mass": 40, "friction": 0.3, "initial_velocity": [0.02, -0.1]}])"});
  std::array<std::vector<double>, 2> courses;
  for (const int k : {0, 1}) {
    ToolBody<2> b(scene);
    if (k == 1) {
      ContactSurface<2> surface = b.tools().surface();
      b.body.tools = std::make_unique<RigidTools<2>>(
          std::vector<ToolDefinition<2>>{make_tool<2>(scene.tools[0])}, std::move(surface),
          SearchLimits{100, 1e9}, 1);
      b.compute();
    }
    for (int n = 0; n < 400; ++n) {
      b.step();
      courses[k].push_back(b.body.tools->read(0).force[1]);
      courses[k].push_back(b.body.tools->energy().friction);
    }
  }
  EXPECT_GT(*std::max_element(courses[0].begin(), courses[0].end()), -1e9);
  EXPECT_LT(*std::min_element(courses[0].begin(), courses[0].end()), -1e-3);
  EXPECT_EQ(courses[0], courses[1]);
}

TEST(ToolContact, AToolInTheBodyIsRefused)
{
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    for (const char *place : {"[0, 64.9]", "[0, 0]"}) // on the surface, and inside
      try {
        ToolBody<2> b(kind.overrides +
                      std::vector<std::string>{
                          R"(/tools=[{"name": "a", "shape": "ball", "radius": 5, "place": )" +
                          std::string(place) + "}]"});
        ADD_FAILURE() << place;
      } catch (const core::KeyedError &error) {
        EXPECT_EQ(error.key, "/tools/0");
        EXPECT_NE(error.message.find("overlaps the body"), std::string::npos);
        EXPECT_NE(error.reason.find("m inside the tool"), std::string::npos);
      }
  }
}

// Standing still beside a body that nothing moves, or on a way that leads past it.
TEST(ToolContact, AToolThatTouchesNothingIsWarnedOf)
{
  const auto warnings = [](const std::string &tool) {
    ToolBody<2> b({"/far_field=none",
                   R"(/tools=[{"name": "a", "shape": "ball", "radius": 5, )" + tool + "}]"});
    return b.log.warnings();
  };
  const auto still = warnings(R"("place": [0, 70])");
  ASSERT_EQ(still.size(), 1u);
  EXPECT_NE(still[0].find("comes no nearer than 5.00"), std::string::npos) << still[0];
  EXPECT_EQ(warnings(R"("place": [30, 70], "velocity": [0, -1])").size(), 1u);
  EXPECT_EQ(warnings(R"("place": [0, 70], "velocity": [0, -0.1])").size(), 0u);
  EXPECT_EQ(warnings(R"("place": [0, 70], "mass": 50, "initial_velocity": [0, -0.1])").size(), 0u);
}

TEST(ToolContact, ASpringNeedsItsMass)
{
  try {
    ToolBody<2> b({"/far_field=none", R"(/tools=[{"name": "a", "shape": "ball", "radius": 5,
      "place": [0, 66], "mass": 1, "machine_stiffness": 50}])"});
    ADD_FAILURE();
  } catch (const core::KeyedError &error) {
    EXPECT_EQ(error.key, "/tools/0/machine_stiffness");
    EXPECT_NE(error.reason.find("it needs a mass of"), std::string::npos) << error.reason;
  }
}

// Forces that are computed anew in a step, as where the regime changes, keep those of the tools.
TEST(ToolContact, PushesAgainWhatItPushed)
{
  for (const auto &far : {"/far_field=none", "/discrete_zone=none"}) {
    ToolBody<2> b({far, R"(/tools=[{"name": "a", "shape": "plate", "size": [20, 2],
      "place": [0, 61], "friction": 0.3, "velocity": [0, 0]}])"});
    shift<2>(b.body, {0, 0.1});
    b.compute();
    const Vector<2> pushed = force_on(b.body);
    EXPECT_LT(pushed[1], -1e-6) << far;
    auto bodies = b.body.bodies();
    b.body.coupler->compute_forces(bodies, b.now);
    EXPECT_GT(force_on(b.body)[1], 0.1 * pushed[1]) << far;
    b.tools().push_again(bodies);
    EXPECT_NEAR((force_on(b.body) - pushed).norm(), 0, 1e-12 * pushed.norm()) << far;
  }
}

// A tool lighter than the layer that it presses on would swing faster than the step.
TEST(ToolContact, AToolThatIsTooLightStopsTheRun)
{
  ToolBody<2> b({"/far_field=none", R"(/tools=[{"name": "a", "shape": "plate", "size": [20, 2],
    "place": [0, 61.1], "mass": 0.5, "initial_velocity": [0, -0.1]}])"});
  EXPECT_THROW(
      {
        for (int n = 0; n < 50; ++n)
          b.step();
      },
      core::GuardStop);
}
} // namespace
