// Hertz: a cylinder and a ball on a block that is large against the contact.
#include "src/simulation/damping.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/tools/rigid_tools.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/lab.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.25;

/// A block with its lower side held; `radius` of a roller or ball above it, which goes down by
/// `depth`.
Scene block(int dim, const Point &size, double radius, double depth)
{
  Scene scene = unit_scene(dim, size, nu);
  const double height = size[1];
  LoadParameters &floor = scene.loads.emplace_back();
  floor.boundary = 2;
  floor.kind = LoadKind::displacement;
  for (int c = 0; c < dim; ++c)
    floor.value[c] = 0;
  floor.displacement = floor.value;
  ToolParameters &tool = scene.tools.emplace_back();
  tool.name = "tool";
  tool.shape = ToolKind::ball;
  tool.radius = radius;
  tool.place = {0, height / 2 + radius, 0};
  tool.displacement[1] = -depth;
  // The slowest standing wave across the height is damped critically, more or less.
  tool.ramp = 6 * height;
  scene.time.duration = 10 * height;
  scene.damping.mass = M_PI / height;
  return scene;
}

struct Contact
{
  double force = 0;    // N, over the thickness 1 m
  double width = 0;    // m, b or a by the moments of the pressure
  double pressure = 0; // Pa, mean over the middle third of the width, in 3D of the radius
  double residual = 0; // of the work
};

template <int dim>
Contact press(const Scene &scene)
{
  UnitBody<dim> unit(scene);
  CoupledBody<dim> &body = unit.body;
  BodyDamping<dim> damping(scene.damping);
  auto bodies = body.bodies();
  const int ratio = body.coupler->step_ratio();
  coupling::StepTime now{0, 0, body.dt};
  const auto compute = [&] {
    body.coupler->compute_forces(bodies, now);
    body.tools->act(bodies, now, ratio);
  };
  compute();
  while (now.time < scene.time.duration || now.step % ratio != 0) {
    damping.before_kick(body, now);
    body.coupler->kick(bodies, now);
    damping.after_kick(body, now);
    body.coupler->drift(bodies, now);
    now = {now.step + 1, double(now.step + 1) * now.dt, now.dt};
    compute();
  }
  const auto &tools = dynamic_cast<const RigidTools<dim> &>(*body.tools);
  double whole = 0, moment = 0;
  std::vector<std::array<double, 3>> pressed; // distance, pressure, area
  Contact contact;
  tools.contact(0).for_each_pressed(tools.tool(0), tools.surface(), bodies,
                                    [&](int k, double, double pressure) {
                                      Vector<dim> x = tools.surface().place(k, bodies);
                                      x[1] = 0;
                                      const double area = tools.surface()[k].area;
                                      pressed.push_back({x.norm(), pressure, area});
                                    });
  for (const auto &[distance, pressure, area] : pressed) {
    whole += pressure * area;
    moment += pressure * area * distance * distance;
  }
  contact.force = -body.tools->read(0).force[1];
  contact.width = std::sqrt((dim == 2 ? 4 : 2.5) * moment / whole);
  double inner = 0;
  for (const auto &[distance, pressure, area] : pressed)
    if (distance < contact.width / 3) {
      contact.pressure += pressure * area;
      inner += area;
    }
  contact.pressure /= inner;
  const auto ledger = read_ledger(body, now, damping.energy());
  contact.residual = std::abs(ledger.residual()) / ledger.external_work;
  return contact;
}

template <int dim>
void add_results(const std::string &start, const Scene &scene, std::vector<Result> &results)
{
  const Contact c = press<dim>(scene);
  const double radius = scene.tools[0].radius, softness = 1 - nu * nu; // over E = 1
  const double width = dim == 2 ? std::sqrt(4 * c.force * radius * softness / M_PI)
                                : std::cbrt(3 * c.force * radius * softness / 4);
  // Means of p0 sqrt(1 - x^2/b^2) over the third.
  const double t = 1. / 3;
  const double pressure =
      dim == 2 ? 2 * c.force / (M_PI * width) * (std::sqrt(1 - t * t) + std::asin(t) / t) / 2
               : 3 * c.force / (2 * M_PI * width * width) * 2 / (3 * t * t) *
                     (1 - std::pow(1 - t * t, 1.5));
  // The force that belongs to the width that was measured.
  const double force = std::pow(c.width / width, dim);
  results.push_back({start + "width", std::abs(c.width / width - 1), 0.03, 0.01});
  results.push_back({start + "force", std::abs(1 / force - 1), 0.03, 0.01});
  results.push_back({start + "pressure", std::abs(c.pressure / pressure - 1), 0.05, 0.02});
  results.push_back({start + "energy", c.residual, 1e-4, 1e-6});
}

std::vector<Result> cylinder(const std::string &name)
{
  std::vector<Result> results;
  for (const PackingKind packing : {PackingKind::hexagonal, PackingKind::random}) {
    Scene scene = block(2, {240, 120, 0}, 1000, 0.5);
    scene.zone.packing = packing;
    add_results<2>(fmt::format("{}/{}_", name, word_of(packing)), scene, results);
  }
  Scene scene = block(2, {240, 120, 0}, 1000, 0.5);
  add_far_field(scene, {120, 0, 0}, 4);
  scene.zone.lower[1] = 0;
  add_results<2>(name + "/coupled_", scene, results);
  return results;
}

std::vector<Result> ball_and_sizes(const std::string &name)
{
  std::vector<Result> results;
  // The cylinder with half the spacing, and in a block of twice the size: what each of them does.
  add_results<2>(name + "/fine_", block(2, {480, 240, 0}, 2000, 1), results);
  add_results<2>(name + "/large_", block(2, {480, 240, 0}, 1000, 0.5), results);
  add_results<3>(name + "/fcc_", block(3, {64, 44, 64}, 400, 0.5), results);
  return results;
}
} // namespace

std::vector<Case> lab_hertz_cases()
{
  return {{"lab_hertz", "width of the contact with a cylinder against Hertz", false,
           [] { return cylinder("lab_hertz"); }},
          {"lab_hertz_long",
           "radius of the contact with a ball against Hertz; a cylinder on finer and larger blocks",
           true, [] { return ball_and_sizes("lab_hertz_long"); }}};
}
} // namespace ligament::program
