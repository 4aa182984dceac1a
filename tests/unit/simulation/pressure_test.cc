// Pressures that follow the surface: a body pressed from all sides is in balance however it lies,
// and the work is that of the volume that the pressure gives way to.
#include "core/extremes.h"
#include "src/simulation/make_loads.h"
#include "tests/support/small_plate.h"

#include <Eigen/Geometry>

#include <cmath>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
// From 0 on nothing presses, from 1 on all does.
const std::string course = R"("history": {"table": [[0, 0], [1, 1]]})";
constexpr double pressure = 1e-3;

std::string pressed_sides()
{
  std::string loads = "/loads=[";
  for (const char *side : {"left", "right", "bottom", "top"})
    loads += std::string(loads.back() == '[' ? "" : ", ") + R"({"boundary": ")" + side +
             R"(", "pressure": 1e-3, )" + course + "}";
  return loads + "]";
}

const std::string square = "/specimen={\"size\": [90, 80]}";
const std::string middle =
    R"(/discrete_zone={"region": {"lower": [-20, -20], "upper": [20, 20]}, "packing": "hexagonal", "spacing": 1})";

const std::vector<BodyKind> bodies = {
    {"coupled", {square, middle}},
    {"hexagonal", {square, "/far_field=none", "/discrete_zone/orientation=0.3"}},
    {"random", {square, "/far_field=none", "/discrete_zone/packing=random"}},
    {"mesh", {square, "/discrete_zone=none"}}};

/// Turned as a whole about the origin, without strain.
void turn(SmallBody &small, double angle)
{
  small.deform(Eigen::Rotation2Dd(angle).toRotationMatrix() - Eigen::Matrix2d::Identity());
  if (small.body.zone)
    std::fill(small.body.zone->state.rotation[0].begin(), small.body.zone->state.rotation[0].end(),
              angle);
}

struct Resultant
{
  Vector<2> force = Vector<2>::Zero();
  double moment = 0, largest = 0; // about the origin; N, of one particle or node
};

/// Of what the pressures add to all other forces.
Resultant resultant(CoupledBody<2> &body)
{
  Resultant sum;
  for (const double time : {1., 0.}) {
    auto both = body.bodies();
    body.coupler->compute_forces(both, {0, time, body.dt});
    const double sign = time > 0 ? 1 : -1;
    const auto add = [&](const Vector<2> &place, const Vector<2> &force) {
      sum.force += sign * force;
      sum.moment += sign * (place[0] * force[1] - place[1] * force[0]);
      if (time > 0)
        keep_largest(sum.largest, force.norm());
    };
    if (body.zone) {
      const auto &p = body.zone->state;
      for (int i = 0; i < p.size(); ++i) {
        add(get(p.reference, i) + get(p.displacement, i), get(p.force, i));
        sum.moment += sign * p.torque[0][i];
      }
    }
    if (body.far)
      for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
        add(body.far->mesh().nodes[i] + get(body.far->displacement, i), get(body.far->force, i));
  }
  return sum;
}

// Sums of a few thousand forces of the size of pressure times spacing, of which those of the mesh
// under a rotation that its linear kinematics takes for strain are larger: 1e-12 of the largest.
TEST(Pressure, ABodyPressedFromAllSidesIsInBalanceHoweverItLies)
{
  for (const auto &kind : bodies) {
    SCOPED_TRACE(kind.name);
    SmallBody small(small_scene(kind.overrides + std::vector<std::string>{pressed_sides()}));
    for (const double angle : {0., 0.4, M_PI / 2}) {
      SCOPED_TRACE(angle);
      turn(small, angle);
      const Resultant sum = resultant(small.body);
      const double scale = 1e-12 * (pressure * 80 + 100 * sum.largest);
      EXPECT_NEAR(sum.force.norm(), 0, scale);
      EXPECT_NEAR(sum.moment, 0, 100 * scale);
    }
  }
}

TEST(Pressure, EachSideIsPressedAlongItsPresentNormal)
{
  for (const auto &kind : bodies) {
    SCOPED_TRACE(kind.name);
    SmallBody small(small_scene(kind.overrides + std::vector<std::string>{pressed_sides()}));
    turn(small, M_PI / 2);
    auto both = small.body.bodies();
    small.body.coupler->compute_forces(both, {0, 1, small.body.dt});
    const double length[] = {80, 80, 90, 90};
    const Vector<2> inward[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (int side = 0; side < 4; ++side) {
      Vector<2> force = Vector<2>::Zero();
      if (small.body.force())
        force += small.body.force()->reaction(side);
      if (small.body.far)
        force += small.body.far->reaction(side);
      const Vector<2> wanted = pressure * length[side] *
                               Vector<2>(-inward[side][1], inward[side][0]); // turned by 90 degrees
      EXPECT_NEAR((force - wanted).norm(), 0, 1e-10 * pressure * length[side]) << side;
    }
  }
}

/// What the pressures have done so far.
double work_of(const CoupledBody<2> &body)
{
  return (body.force() ? body.force()->external_work() : 0) +
         (body.far ? body.far->external_work() : 0);
}

void compute(CoupledBody<2> &body, double time)
{
  auto both = body.bodies();
  body.coupler->compute_forces(both, {0, time, body.dt});
}

TEST(Pressure, TurningTheBodyTakesNoWork)
{
  for (const auto &kind : bodies) {
    if (std::string(kind.name) == "coupled")
      continue; // its mesh, linear, does work in the overlap
    SCOPED_TRACE(kind.name);
    SmallBody small(small_scene(kind.overrides + std::vector<std::string>{pressed_sides()}));
    turn(small, 0);
    compute(small.body, 1);
    const double before = work_of(small.body);
    for (int k = 1; k <= 10; ++k) {
      turn(small, M_PI / 2 * k / 10);
      compute(small.body, 1 + k);
    }
    EXPECT_NEAR(work_of(small.body) - before, 0, 1e-11 * pressure * 90 * 80);
  }
}

// Sides of cells are followed exactly, with their area: the trapezoidal rule of areas that grow in
// proportion. Those of particles keep their area, first order in the strain, and their faces do not
// move against the centres, which stand up to a spacing behind the side: 1 of 40.
TEST(Pressure, WorkIsPressureTimesTheVolumeThatItGivesWayTo)
{
  const double strain = 1e-3;
  for (const auto &kind : bodies) {
    SCOPED_TRACE(kind.name);
    SmallBody small(small_scene(kind.overrides + std::vector<std::string>{pressed_sides()}));
    small.deform(Eigen::Matrix2d::Zero());
    compute(small.body, 1);
    const double before = work_of(small.body);
    small.deform(strain * Eigen::Matrix2d::Identity());
    compute(small.body, 2);
    const double exact = -pressure * 90 * 80 * (2 * strain + strain * strain);
    const double work = work_of(small.body) - before;
    if (small.body.far) // in the coupled body, too, the sides are those of cells
      EXPECT_NEAR(work / exact, 1, 1e-10);
    else
      EXPECT_NEAR(work / exact, 1, strain + 1. / 40);
  }
}

// Volumes of particles depend on the pressure at their faces: where it grows in a body that stands
// still, the energy of these volumes is its work.
TEST(Pressure, ThatGrowsInABodyAtRestBooksTheEnergyOfVolumes)
{
  for (const auto &kind : bodies) {
    if (std::string(kind.name) != "hexagonal" && std::string(kind.name) != "random")
      continue;
    SCOPED_TRACE(kind.name);
    SmallBody small(small_scene(kind.overrides + std::vector<std::string>{pressed_sides()}));
    small.deform(Eigen::Matrix2d::Identity() * 1e-3);
    const auto &particles = small.body.zone->state;
    compute(small.body, 0.25);
    const double work = work_of(small.body),
                 energy = small.body.force()->potential_energy(particles);
    compute(small.body, 0.75);
    const double gained = small.body.force()->potential_energy(particles) - energy;
    EXPECT_GT(std::abs(gained), 1e-6 * energy);
    EXPECT_NEAR(work_of(small.body) - work, gained, 1e-12 * energy);
  }
}

// The rim of a hole is closed: nothing of what presses it moves the body, however it is deformed.
TEST(Pressure, RimsOfHolesAreInBalanceInAnyState)
{
  const std::string hole =
      R"(/specimen={"size": [90, 80], "cutouts": [{"outline": [{"at": [9, 3], "centre": [3, 3]}], "side": "rim"}]})";
  const std::string load = R"(/loads=[{"boundary": "rim", "pressure": 1e-3, )" + course + "}]";
  SmallBody mesh(small_scene({hole, "/discrete_zone=none", load}));
  Eigen::Matrix2d gradient;
  gradient << 0.02, 0.05, -0.01, 0.03;
  mesh.deform(gradient);
  Resultant sum = resultant(mesh.body);
  const double scale = 1e-12 * (pressure * 40 + 100 * sum.largest);
  EXPECT_NEAR(sum.force.norm(), 0, scale);
  EXPECT_NEAR(sum.moment, 0, 100 * scale);
  // Straight sides stand for the circle, so the mesh's own area is what counts.
  SmallBody particles(small_scene({hole, "/far_field=none", load}));
  turn(particles, 0.7);
  sum = resultant(particles.body);
  EXPECT_NEAR(sum.force.norm(), 0, scale);
  EXPECT_NEAR(sum.moment, 0, 100 * scale);
}
} // namespace
