// A body that is built anew again and again, and given the state of the one before, goes on to the
// last bit: motion, broken bonds, every energy.
#include "src/simulation/body_state.h"

#include "dem/many_body_force.h"
#include "src/scene/read_scene.h"
#include "src/simulation/damping.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/regime_control.h"
#include "tests/support/small_plate.h"

#include <cstring>

namespace ligament::program
{
namespace
{
using tests::operator+;
using tests::small_scene;

/// The steps of `run`, between which the body may be replaced by a new one with its state.
template <int dim>
class Course
{
public:
  Course(const Scene &scene, bool rests, const ForceMaker<dim> &make_force)
      : scene_(scene), make_force_(make_force),
        body_(make_body<dim>(scene_, log_, timers_, make_force_)), damping_(scene.damping),
        regime_(scene.coupling.regime, body_), rests_(rests)
  {
    now_.dt = body_.dt;
    compute();
    if (rests_)
      let_rest();
  }

  /// Up to the next action of the far field.
  void step(bool rebuild)
  {
    regime_.look(body_, now_, log_);
    for (int k = 0; k < body_.coupler->step_ratio(); ++k) {
      auto bodies = body_.bodies();
      damping_.before_kick(body_, now_);
      body_.coupler->kick(bodies, now_);
      damping_.after_kick(body_, now_);
      body_.coupler->drift(bodies, now_);
      ++now_.step;
      now_.time = double(now_.step) * now_.dt;
      if (k + 1 == body_.coupler->step_ratio() && rebuild)
        build_anew();
      compute();
    }
  }

  /// All energies and the state, bit by bit.
  std::vector<double> ledger() const
  {
    std::vector<double> values;
    for (const auto &[name, value] : read_ledger(body_, now_, damping_.energy()).channels())
      values.push_back(value);
    return values;
  }
  core::State state() const { return take_state(body_); }
  long n_broken() const { return body_.force() ? long(body_.force()->broken_bonds().size()) : 0; }
  const CoupledBody<dim> &body() const { return body_; }
  double time() const { return now_.time; }

private:
  void compute()
  {
    auto bodies = body_.bodies();
    body_.coupler->compute_forces(bodies, now_);
    if (body_.tools)
      body_.tools->act(bodies, now_, body_.coupler->step_ratio());
  }
  void let_rest()
  {
    const double strain = scene_.time.rest_threshold;
    body_.zone->let_rest(particles::RestLimits::of_strain(
        strain, body_.spacing, body_.force()->elastic_constants().wave_speed_p));
    if (body_.coupler->can_rest())
      body_.coupler->let_rest(body_.bodies(), strain);
  }
  void build_anew()
  {
    const core::State state = take_state(body_);
    body_ = make_body<dim>(scene_, log_, timers_, make_force_);
    if (rests_)
      let_rest();
    give_state(state, body_);
  }

  Scene scene_;
  core::Log log_;
  core::Timers timers_;
  ForceMaker<dim> make_force_;
  CoupledBody<dim> body_;
  BodyDamping<dim> damping_;
  RegimeControl<dim> regime_;
  bool rests_;
  coupling::StepTime now_;
};

bool same_bits(const std::vector<double> &a, const std::vector<double> &b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// Rebuilt every k far steps from `from` (s) on, until `to`; in every step for a while, from the
/// first broken bond on where something must have broken by then.
template <int dim>
void expect_same_course(const Scene &scene, double from, double to, long least_broken,
                        bool rests = false,
                        const ForceMaker<dim> &make_force = make_zone_force<dim>)
{
  Course<dim> plain(scene, rests, make_force);
  std::vector<std::vector<double>> ledgers; // after each far step
  for (; plain.time() < to; ledgers.push_back(plain.ledger()))
    plain.step(false);
  EXPECT_GE(plain.n_broken(), least_broken);
  const core::State last = plain.state();

  for (const int interval : {1, 7, 100}) {
    SCOPED_TRACE(interval);
    Course<dim> rebuilt(scene, rests, make_force);
    int steps = 0, n_rebuilt = 0;
    long n_broken = 0; // when the last new body was built
    const int most = interval == 1 ? 30 : 100;
    for (const auto &ledger : ledgers) {
      const bool begun =
          interval == 1 && least_broken > 0 ? rebuilt.n_broken() > 0 : rebuilt.time() >= from;
      const bool due = begun && ++steps % interval == 0 && n_rebuilt < most;
      n_rebuilt += due;
      if (due)
        n_broken = rebuilt.n_broken();
      rebuilt.step(due);
      ASSERT_TRUE(!due || same_bits(ledger, rebuilt.ledger())) << "at " << rebuilt.time();
    }
    EXPECT_GT(n_rebuilt, 0);
    EXPECT_TRUE(n_broken > 0 || least_broken == 0);
    const core::State state = rebuilt.state();
    ASSERT_EQ(state.size(), last.size());
    for (const auto &[name, table] : last)
      EXPECT_TRUE(state.count(name) && table == state.at(name)) << name;
  }
}

template <int dim>
void expect_same_course(const std::vector<std::string> &overrides, double from, double to,
                        long least_broken, bool rests = false)
{
  expect_same_course<dim>(small_scene(overrides), from, to, least_broken, rests);
}

// Bonds break at a strain of 1e-3 while the plate is torn apart.
const std::vector<std::string> torn = {
    R"(/material/fracture={"criterion": "maximum_tension", "strength": 1e-3})",
    R"(/specimen/cracks=[{"points": [[-4, 0], [4, 0]]}])",
    R"(/loads=[{"boundary": "top", "velocity": [null, 2e-4], "ramp": 100},
               {"boundary": "bottom", "velocity": [null, -2e-4], "ramp": 100}])",
    "/time/duration=6000"};

const std::string friction = "/material/friction=0.4";

TEST(BodyState, ABreakingCoupledPlateGoesOnToTheLastBit)
{
  expect_same_course<2>(torn, 60, 260, 10);
}

TEST(BodyState, APureDiscretePlateGoesOnToTheLastBit)
{
  expect_same_course<2>(torn + std::vector<std::string>{"/far_field=none", friction}, 60, 400, 30);
}

TEST(BodyState, APureMeshGoesOnToTheLastBit)
{
  expect_same_course<2>({"/discrete_zone=none", "/damping/mass=1e-3", torn[2],
                         R"(/loads/1={"boundary": "bottom", "absorbing": true})"},
                        20, 600, 0);
}

// With the inertia and drag of supports, dashpots and their layers, local damping.
TEST(BodyState, EveryDampingGoesOnToTheLastBit)
{
  for (const char *damping : {"/damping/mass=1e-3", "/damping/local=0.3", "/damping/kinetic=true"})
  {
    SCOPED_TRACE(damping);
    expect_same_course<2>(torn + std::vector<std::string>{damping}, 60, 320, 1);
  }
}

TEST(BodyState, FourStepsPerActionOfTheFarFieldGoOnToTheLastBit)
{
  expect_same_course<2>(
      torn + std::vector<std::string>{"/coupling/step_ratio=4", "/damping/mass=1e-3"}, 60, 260, 10);
}

// Pressed and sheared: the closed flanks of the crack slide, its joints go from particle to
// particle.
TEST(BodyState, ASlidingClosedCrackGoesOnToTheLastBit)
{
  expect_same_course<2>({R"(/specimen/cracks=[{"points": [[-7, -6.3], [7, 6.3]]}])",
                         "/far_field=none",
                         R"(/material/fracture={"criterion": "maximum_tension", "strength": 8e-3})",
                         R"(/loads=[{"boundary": "top", "velocity": [4e-3, -2e-3], "ramp": 50},
                  {"boundary": "bottom", "velocity": [-4e-3, 2e-3], "ramp": 50}])",
                         friction},
                        60, 500, 1);
}

// Faces break under pressure by strengths that scatter: contacts take over, keep their distances
// and slips.
TEST(BodyState, FacesThatFailUnderPressureGoOnToTheLastBit)
{
  for (const char *criterion : {R"("mohr_coulomb", "cohesion": 2e-3, "friction_angle": 0.5)",
                                R"("drucker_prager", "compressive_strength": 4e-3)"})
  {
    SCOPED_TRACE(criterion);
    expect_same_course<2>({"/far_field=none", friction,
                           std::string(R"(/material/fracture={"criterion": )") + criterion +
                               R"(, "strength": 2e-3, "weibull": {"modulus": 8, "seed": 3}})",
                           R"(/loads=[{"boundary": "top", "velocity": [2e-3, -2e-3], "ramp": 50},
                  {"boundary": "bottom", "velocity": [-2e-3, 2e-3], "ramp": 50}])"},
                          60, 260, 20);
  }
}

// Fast enough that pieces fly and hit others.
TEST(BodyState, FragmentsThatHitAgainGoOnToTheLastBit)
{
  expect_same_course<2>({"/far_field=none", friction,
                         R"(/material/fracture={"criterion": "maximum_tension", "strength": 2e-3})",
                         R"(/loads=[{"boundary": "top", "velocity": [null, -0.05], "ramp": 10},
                  {"boundary": "bottom", "velocity": [null, 0.05], "ramp": 10}])"},
                        60, 160, 100);
}

TEST(BodyState, EveryRegimeGoesOnToTheLastBit)
{
  for (const char *regime : {"corotated", "nonlinear"}) {
    SCOPED_TRACE(regime);
    expect_same_course<2>({std::string("/coupling/regime=") + regime,
                           R"(/loads=[{"boundary": "top", "velocity": [3e-3, 1e-4], "ramp": 60},
                    {"boundary": "bottom", "velocity": [-3e-3, -1e-4], "ramp": 60}])"},
                          20, 120, 0);
  }
}

TEST(BodyState, EnergyWeightedCouplersGoOnToTheLastBit)
{
  for (const char *scheme : {"acceleration", "xiao_belytschko"}) {
    SCOPED_TRACE(scheme);
    expect_same_course<2>(
        torn + std::vector<std::string>{std::string("/coupling/scheme=") + scheme}, 60, 200, 1);
  }
}

TEST(BodyState, RegionsAtRestGoOnToTheLastBit)
{
  for (const char *threshold : {"/time/rest_threshold=0", "/time/rest_threshold=1e-6"}) {
    SCOPED_TRACE(threshold);
    expect_same_course<2>(torn + std::vector<std::string>{threshold}, 10, 200, 1, true);
    expect_same_course<2>(torn + std::vector<std::string>{threshold, "/far_field=none"}, 10, 200, 1,
                          true);
  }
}

// Flow at a third of the stress that breaks: the zones at the tips of the crack have yielded, and
// bonds break in them.
TEST(BodyState, PlasticFlowGoesOnToTheLastBit)
{
  const std::string flows =
      R"(/material/plasticity={"law": "von_mises", "yield_stress": 3e-4, "hardening": 0.3})";
  for (const char *far : {R"(/far_field={"cell_size": 4.1})", "/far_field=none"}) {
    SCOPED_TRACE(far);
    const Scene scene = small_scene(torn + std::vector<std::string>{far, friction, flows});
    expect_same_course<2>(scene, 120, 300, 5, false);
    Course<2> course(scene, false, make_many_body_force<2>);
    while (course.time() < 120)
      course.step(false);
    const auto &force = dynamic_cast<dem::ManyBodyForce<2> &>(*course.body().force());
    EXPECT_GT(force.plastic_dissipation(), 0); // before the first rebuild
  }
}

// Branches that relax and a dashpot, alone and before plastic flow; faces break beside them.
TEST(BodyState, ViscosityGoesOnToTheLastBit)
{
  const std::string viscous = R"(/material/viscosity={"branches": [
    {"share": 0.4, "relaxation_time": 30}, {"share": 0.2, "relaxation_time": 300}],
    "shear_viscosity": 0.1})",
                    flows = R"(/material/plasticity={"law": "von_mises", "yield_stress": 5e-4})";
  for (const bool is_coupled : {true, false}) {
    SCOPED_TRACE(is_coupled);
    std::vector<std::string> settings = {friction, viscous};
    if (is_coupled)
      settings.push_back(R"(/far_field={"cell_size": 4.1})");
    else
      settings.insert(settings.end(), {"/far_field=none", flows});
    const Scene scene = small_scene(torn + settings);
    expect_same_course<2>(scene, 120, 300, 5, false);
    Course<2> course(scene, false, make_many_body_force<2>);
    while (course.time() < 120)
      course.step(false);
    EXPECT_GT(course.body().force()->losses().viscous, 0);
  }
}

// A crystal that is torn apart: its list of neighbours is built again and again, bonds part,
// springs and tractions act on its sides.
TEST(BodyState, ACrystalGoesOnToTheLastBit)
{
  const std::string crystal = R"({
    "dimension": 2,
    "specimen": {"size": ["36 nm", "36 nm"], "thickness": "0.38 nm",
                 "cracks": [{"points": [["-2.5 nm", 0], ["2.5 nm", 0]]}]},
    "atoms": {"potential": "lennard_jones", "energy": "0.0104 eV", "distance": "3.4 angstrom",
              "mass": "39.95 u"},
    "discrete_zone": {"packing": "hexagonal",
                      "region": {"lower": ["-10 nm", "-10 nm"], "upper": ["10 nm", "10 nm"]}},
    "far_field": {"cell_size": "1 nm"},
    "coupling": {"overlap_cells": 5, "transition_cells": 3, "step_ratio": 2},
    "loads": [{"boundary": "top", "velocity": [null, "150 m/s"]},
              {"boundary": "bottom", "velocity": ["10 m/s", "-150 m/s"]},
              {"boundary": "left", "traction": ["-10 MPa", 0], "ramp": "5 ps"}],
    "time": {"duration": "20 ps", "step_fraction": 0.2}
  })";
  const auto scene = [&](const std::vector<std::string> &set) {
    const ReadResult read = parse_scene(crystal, "crystal.json", set);
    for (const auto &error : read.errors)
      ADD_FAILURE() << core::to_string(error);
    return *read.scene;
  };
  expect_same_course<2>(scene({"/far_field=none"}), 6e-12, 16e-12, 10);
  expect_same_course<2>(scene({}), 7e-12, 16e-12, 0);
}

// In three dimensions, with a turned lattice.
TEST(BodyState, ABreakingBarGoesOnToTheLastBit)
{
  const auto result = parse_scene(R"({
    "dimension": 3,
    "specimen": {"size": [8, 64, 6], "cracks": [
      {"points": [[-4, 0, -3], [-1, 0, -3], [-1, 0, 3], [-4, 0, 3]]}]},
    "material": {"youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1, "friction": 0.4,
      "fracture": {"criterion": "maximum_tension", "strength": 1e-3}},
    "discrete_zone": {"region": {"lower": [null, -12.1, null], "upper": [null, 12.1, null]},
      "packing": "fcc", "spacing": 1, "orientation": [0, "10 deg", 0]},
    "far_field": {"cell_size": 3},
    "coupling": {"overlap_cells": 2, "transition_cells": 2, "step_ratio": 2},
    "loads": [{"boundary": "top", "velocity": [null, 4e-4, null]},
              {"boundary": "bottom", "velocity": [null, -4e-4, null]}],
    "time": {"duration": 1000}
  })",
                                  "bar");
  for (const auto &error : result.errors)
    ADD_FAILURE() << core::to_string(error);
  expect_same_course<3>(result.scene.value(), 60, 200, 5);
}

// A wedge opens a crack, with friction; a ball at a spring presses from the side, another flies in.
const std::string three_tools = R"(/tools=[
  {"name": "wedge", "shape": "wedge", "points": [[0, 0], [-30, 6], [-30, -6]], "orientation": 3.14159265,
   "place": [12.1, 0.2], "velocity": [-0.03, 0], "friction": 0.3},
  {"name": "ball", "shape": "ball", "radius": 9, "place": [-21.1, 21], "mass": 60, "inertia": 2000,
   "machine_stiffness": 0.05, "displacement": [1.5, 0], "ramp": 100, "friction": 0.4},
  {"name": "shot", "shape": "plate", "size": [6, 3], "place": [3, 62], "mass": 20,
   "initial_velocity": [0.01, -0.03], "friction": 0.2, "release": 120}])";

TEST(BodyState, ToolsGoOnToTheLastBit)
{
  // The control of the regime is no part of the body: it changes nothing here.
  const std::vector<std::string> brittle = {
      R"(/material/fracture={"criterion": "maximum_tension", "strength": 4e-3})",
      "/material/friction=0.3",
      "/coupling/step_ratio=2",
      "/time/duration=300",
      "/coupling/regime=corotated",
      three_tools};
  for (const auto &kind : {std::vector<std::string>{}, std::vector<std::string>{"/far_field=none"}})
  {
    SCOPED_TRACE(kind.size());
    expect_same_course<2>(small_scene(brittle + kind), 40, 160, 5);
  }
  expect_same_course<2>(small_scene({"/discrete_zone=none", "/time/duration=700", three_tools}), 40,
                        600, 0);
}

TEST(BodyState, RandomPackingsOfTwoMaterialsGoOnToTheLastBit)
{
  expect_same_course<2>(
      torn +
          std::vector<std::string>{
              "/discrete_zone/packing=random", "/discrete_zone/relaxation_sweeps=4",
              "/discrete_zone/size_ratio=2", friction,
              R"(/inclusions=[{"balls": [{"centre": [6, 0], "radius": 3}], "youngs_modulus": 3,
                "poissons_ratio": 0.3, "density": 1,
                "fracture": {"criterion": "maximum_tension", "strength": 2e-3}}])"},
      60, 260, 10);
}
} // namespace
} // namespace ligament::program
