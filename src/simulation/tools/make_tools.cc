#include "src/simulation/tools/make_tools.h"

#include "core/keyed_error.h"
#include "src/simulation/make_loads.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// Of the square of the largest frequency of a step: what a spring may give its tool.
constexpr double spring_share = 0.25;

// The search of contacts expects no point to become faster by more than this share of the wave
// speed between two looks.
constexpr double expected_speed = 0.01;

// A tool may lie so deep in the body where the run begins, in spacings or cells: round-off.
constexpr double smallest_overlap = 1e-6;

// Times at which the way of a tool is looked at.
constexpr int n_looks = 200;

template <int dim>
Vector<dim> vector_of(const Point &p)
{
  return Vector<dim>(p.data());
}

template <int dim>
Eigen::Matrix<double, dim, dim> rotation_of(const Point &orientation)
{
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(orientation[0]).toRotationMatrix();
  else {
    const Vector<3> axis(orientation.data());
    const double angle = axis.norm();
    return angle > 0 ? Eigen::AngleAxisd(angle, axis / angle).toRotationMatrix()
                     : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  }
}

/// Corners in the trigonometric sense.
std::vector<Vector<2>> corners_of(const ToolParameters &p)
{
  if (p.shape == ToolKind::plate) {
    const double x = p.size[0] / 2, y = p.size[1] / 2;
    return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
  }
  std::vector<Vector<2>> corners;
  for (const Point &point : p.points)
    corners.push_back({point[0], point[1]});
  double twice_area = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector<2> &a = corners[k], &b = corners[(k + 1) % corners.size()];
    twice_area += a[0] * b[1] - a[1] * b[0];
  }
  if (twice_area < 0)
    std::reverse(corners.begin(), corners.end());
  return corners;
}

template <int dim>
ToolShape<dim> shape_of(const ToolParameters &p)
{
  const auto rotation = rotation_of<dim>(p.orientation);
  const bool is_round = p.shape == ToolKind::roller || p.shape == ToolKind::ball;
  if constexpr (dim == 3)
    if (p.shape == ToolKind::roller)
      return CylinderTool<3>{p.radius, rotation.col(2), p.length / 2};
  if (is_round)
    return BallTool<dim>{p.radius};
  return make_prism<dim>(corners_of(p), p.shape == ToolKind::plate ? p.size[2] : p.length,
                         rotation);
}

/// Two bodies overlap where points of one's surface, or of its inside, lie in the other.
template <int dim>
void require_apart(const std::string &key, const ToolDefinition<dim> &tool,
                   const CoupledBody<dim> &body, const ContactSurface<dim> &surface, double length)
{
  RigidTool<dim> at_start(tool);
  at_start.advance(0, 0);
  double depth = 0;
  Vector<dim> place = Vector<dim>::Zero();
  const auto look = [&](const Vector<dim> &x) {
    const double here = tool.shape.touch(x - at_start.centre()).depth;
    if (here > depth) {
      depth = here;
      place = x;
    }
  };
  for (int k = 0; k < surface.size(); ++k)
    look(surface.place(k, body.bodies()));
  if (body.zone)
    for (int i = 0; i < body.zone->state.size(); ++i)
      look(get(body.zone->state.reference, i));
  if (body.far)
    for (const Vector<dim> &x : body.far->mesh().nodes)
      look(x);
  if (depth <= smallest_overlap * length)
    return;
  std::string text;
  for (int c = 0; c < dim; ++c)
    text += fmt::format("{}{:.6g}", c ? ", " : "", place[c]);
  throw core::KeyedError(
      key, fmt::format("the tool \"{}\" overlaps the body where the run begins", tool.name),
      fmt::format("the point ({}) m of the body lies {:.4g} m inside the tool", text, depth),
      "move the tool away by this much or more, or let it begin outside");
}

/// The smallest distance from the undeformed body on the way that the tool takes by itself.
template <int dim>
double distance_on_way(const ToolDefinition<dim> &tool, const CoupledBody<dim> &body,
                       const ContactSurface<dim> &surface, double duration)
{
  RigidTool<dim> moving(tool);
  double least = infinity;
  for (int n = 0; n <= n_looks; ++n) {
    const double time = std::min(duration, tool.release) * n / n_looks;
    moving.advance(time, 0);
    const Vector<dim> centre = tool.mass > 0 && tool.machine_stiffness == 0
                                   ? Vector<dim>(tool.place + time * tool.velocity)
                               : tool.mass > 0 ? moving.drive_place()
                                               : moving.centre();
    for (int k = 0; k < surface.size(); ++k)
      least = std::min(least, -tool.shape.touch(surface.place(k, body.bodies()) - centre).depth);
  }
  return least;
}
} // namespace

ContactStiffness contact_stiffness_of(const Scene &scene)
{
  ContactStiffness stiffness;
  stiffness.youngs_modulus = {scene.material.youngs_modulus};
  for (const Inclusion &inclusion : scene.inclusions)
    stiffness.youngs_modulus.push_back(inclusion.material.youngs_modulus);
  return stiffness;
}

template <int dim>
void add_cells(const Scene &scene, const CoupledBody<dim> &body, ContactSurface<dim> &surface)
{
  surface.add_cells(*body.far, body.coupler->overlap(),
                    fem::node_names<dim>(body.far->mesh(), body.lower, body.upper),
                    contact_stiffness_of(scene), body.dt_far);
}

template <int dim>
ToolDefinition<dim> make_tool(const ToolParameters &p)
{
  ToolDefinition<dim> tool{p.name, shape_of<dim>(p), vector_of<dim>(p.place)};
  if (p.is_driven()) {
    auto &drive = tool.drive.emplace();
    using Kind = typename core::BoundaryLoad<dim>::Kind;
    const bool is_velocity = p.velocity[0] || p.velocity[1] || p.velocity[2];
    drive.kind = is_velocity ? Kind::velocity : Kind::displacement;
    for (int c = 0; c < dim; ++c)
      drive.value[c] = is_velocity ? p.velocity[c] : p.displacement[c];
    drive.history = time_function_of(p.history, p.ramp);
  }
  tool.mass = p.mass.value_or(0);
  tool.inertia = p.inertia;
  tool.machine_stiffness = p.machine_stiffness;
  tool.friction = p.friction;
  tool.velocity = vector_of<dim>(p.initial_velocity);
  tool.release = p.release;
  return tool;
}

template <int dim>
std::unique_ptr<ToolSet<dim>> make_tools(const Scene &scene, const CoupledBody<dim> &body,
                                         ContactSurface<dim> surface, core::Log &log)
{
  const double length = body.zone ? body.spacing : scene.far_field->cell_size;
  const bool body_moves = scene.tools.size() > 1 || !scene.loads.empty() ||
                          !scene.initial_motion.empty() || scene.body_force.is_any();
  std::vector<ToolDefinition<dim>> tools;
  for (std::size_t k = 0; k < scene.tools.size(); ++k) {
    const std::string key = fmt::format("/tools/{}", k);
    tools.push_back(make_tool<dim>(scene.tools[k]));
    const ToolDefinition<dim> &tool = tools.back();
    require_apart(key, tool, body, surface, length);
    const double least = tool.machine_stiffness / (spring_share * std::pow(2 / body.dt, 2));
    if (tool.mass < least)
      throw core::KeyedError(
          key + "/machine_stiffness",
          fmt::format("the spring of the tool \"{}\" is too stiff for its mass", tool.name),
          fmt::format("in steps of {:.4g} s it needs a mass of {:.4g} kg", body.dt, least),
          "give more \"mass\", or a softer spring");
    const double distance = distance_on_way(tool, body, surface, scene.time.duration);
    if (distance > length && !body_moves)
      log.warning("the tool \"{}\" comes no nearer than {:.4g} m to the body: it touches nothing",
                  tool.name, distance);
  }
  SearchLimits limits;
  limits.margin = body.far ? std::max(length, scene.far_field->cell_size / 2) : length;
  limits.speed = expected_speed * std::sqrt(scene.material.youngs_modulus / scene.material.density);
  log.info("{} tools; {} points of the body's surface", tools.size(), surface.size());
  return std::make_unique<RigidTools<dim>>(std::move(tools), std::move(surface), limits,
                                           (body.upper - body.lower).norm());
}

template void add_cells(const Scene &, const CoupledBody<2> &, ContactSurface<2> &);
template void add_cells(const Scene &, const CoupledBody<3> &, ContactSurface<3> &);
template ToolDefinition<2> make_tool(const ToolParameters &);
template ToolDefinition<3> make_tool(const ToolParameters &);
template std::unique_ptr<ToolSet<2>> make_tools(const Scene &, const CoupledBody<2> &,
                                                ContactSurface<2>, core::Log &);
template std::unique_ptr<ToolSet<3>> make_tools(const Scene &, const CoupledBody<3> &,
                                                ContactSurface<3>, core::Log &);
} // namespace ligament::program
