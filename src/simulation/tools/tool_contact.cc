#include "src/simulation/tools/tool_contact.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// Of the normal stiffness of the layer: particles turn under what acts along their surface, and
// with this they do so no faster than they move under what presses on it.
constexpr double tangential_share = 0.3;

constexpr int longest_wait = 50; // steps
} // namespace

template <int dim>
void ToolContact<dim>::look_around(const RigidTool<dim> &tool, const ContactSurface<dim> &surface,
                                   const coupling::Bodies<dim> &bodies, double dt)
{
  way_left_ -= tool.way() + dt * tool.spin().norm() * farthest_;
  if (steps_left_-- > 0 && way_left_ > 0)
    return;
  near_.clear();
  farthest_ = 0;
  for (int k = 0; k < surface.size(); ++k) {
    const Vector<dim> y = tool.rotation().transpose() * (surface.place(k, bodies) - tool.centre());
    const double depth = tool.definition().shape.touch(y).depth;
    if (depth > -2 * limits_.margin)
      farthest_ = std::max(farthest_, y.norm()); // of what a turn may bring near
    if (depth > -limits_.margin)
      near_.push_back(k);
  }
  if (friction_ > 0)
    memory_.resize(surface.size());
  way_left_ = limits_.margin / 3;
  const double speed = 2 * surface.largest_speed(bodies) + limits_.speed;
  steps_left_ = int(std::min<double>(longest_wait, limits_.margin / 3 / (speed * dt)));
}

/// A point that was inside when it came into being presses when it is deeper than ever since.
template <int dim>
double ToolContact<dim>::depth_of(int k, const Touch<dim> &touch)
{
  if (offset_.empty())
    return touch.depth;
  const auto offset = offset_.find(k);
  if (offset == offset_.end())
    return touch.depth;
  offset->second = std::min(offset->second, std::max(touch.depth, 0.));
  const double depth = touch.depth - offset->second;
  if (offset->second == 0)
    offset_.erase(offset);
  return depth;
}

// theory.md eqs. (T4), (T5): what the spring gives back less than it took is heat.
template <int dim>
Vector<dim> ToolContact<dim>::friction_force(Memory &memory, const Vector<dim> &y,
                                             const Touch<dim> &touch, double depth,
                                             double stiffness, Sums &sums)
{
  const double k = tangential_share * stiffness;
  const auto along = [&](const Vector<dim> &v) {
    return Vector<dim>(v - v.dot(touch.normal) * touch.normal);
  };
  if (!memory.is_touched) {
    memory.is_touched = true;
    memory.last = y;
    memory.stretch.setZero();
  }
  const Vector<dim> old = along(memory.stretch), trial = old + along(y - memory.last);
  const double length = trial.norm(), most = friction_ * depth / tangential_share;
  memory.stretch = length > most ? Vector<dim>(most / length * trial) : trial;
  memory.last = y;
  heat_ += k / 2 * (old + memory.stretch).dot(trial - memory.stretch);
  sums.energy += k / 2 * memory.stretch.squaredNorm();
  return -k * memory.stretch;
}

template <int dim>
void ToolContact<dim>::push_again(const ContactSurface<dim> &surface,
                                  coupling::Bodies<dim> &bodies) const
{
  for (const auto &[point, force] : pushed_)
    surface.push(point, force, bodies);
}

template <int dim>
auto ToolContact<dim>::act(const RigidTool<dim> &tool, const ContactSurface<dim> &surface,
                           coupling::Bodies<dim> &bodies, double dt, bool far_acts, bool pushes)
    -> Answer
{
  look_around(tool, surface, bodies, dt);
  Answer answer;
  zone_ = {};
  pushed_.clear();
  if (far_acts)
    far_ = {};
  for (const int k : near_) {
    const SurfacePoint<dim> &point = surface[k];
    if (point.is_far() && !far_acts)
      continue;
    const Vector<dim> arm = surface.place(k, bodies) - tool.centre();
    const Vector<dim> y = tool.rotation().transpose() * arm;
    const Touch<dim> touch = tool.definition().shape.touch(y);
    const double depth = depth_of(k, touch);
    const double share = depth > 0 ? share_of(k, touch, tool, surface, bodies) : 0;
    if (share == 0) {
      if (friction_ > 0 && memory_[k].is_touched) { // the last of the spring is heat
        friction_force(memory_[k], y, touch, 0, point.stiffness, zone_);
        memory_[k].is_touched = false;
      }
      continue;
    }
    Sums &sums = point.is_far() ? far_ : zone_;
    const double stiffness = share * point.stiffness;
    Vector<dim> force = stiffness * depth * touch.normal;
    sums.energy += stiffness / 2 * depth * depth;
    sums.area += share * point.area;
    if (friction_ > 0)
      force += friction_force(memory_[k], y, touch, depth, stiffness, sums);
    force = tool.rotation() * force;
    (point.is_far() ? answer.far_stiffness : answer.stiffness) += stiffness;
    Wrench<dim> &wrench = point.is_far() ? answer.far : answer.zone;
    wrench.force -= force;
    if constexpr (dim == 2)
      wrench.torque[0] -= arm[0] * force[1] - arm[1] * force[0];
    else
      wrench.torque -= arm.cross(force);
    if (pushes) {
      surface.push(k, force, bodies);
      pushed_.emplace_back(k, force);
    } else
      sums.power += force.dot(surface.velocity(k, bodies));
  }
  return answer;
}

template <int dim>
void ToolContact<dim>::begin(int first, const RigidTool<dim> &tool,
                             const ContactSurface<dim> &surface,
                             const coupling::Bodies<dim> &bodies)
{
  steps_left_ = 0;
  for (int k = first; k < surface.size(); ++k) {
    const Vector<dim> y = tool.rotation().transpose() * (surface.place(k, bodies) - tool.centre());
    const double depth = tool.definition().shape.touch(y).depth;
    if (depth > 0)
      offset_[k] = depth;
  }
}

template <int dim>
void ToolContact<dim>::save(int tool, const ContactSurface<dim> &surface,
                            std::map<std::array<std::int64_t, 3>, std::vector<double>> &rows) const
{
  const auto row = [&](int k) -> std::vector<double> & {
    auto &values = rows[{tool, surface[k].owner, surface[k].number}];
    values.resize(2 + 2 * dim);
    return values;
  };
  for (int k = 0; k < int(memory_.size()); ++k)
    if (memory_[k].is_touched) {
      auto &values = row(k);
      values[0] = 1;
      for (int c = 0; c < dim; ++c) {
        values[2 + c] = memory_[k].last[c];
        values[2 + dim + c] = memory_[k].stretch[c];
      }
    }
  for (const auto &[k, offset] : offset_)
    row(k)[1] = offset;
}

template <int dim>
void ToolContact<dim>::load(int tool, const ContactSurface<dim> &surface,
                            const std::map<std::array<std::int64_t, 3>, std::vector<double>> &rows)
{
  memory_.assign(friction_ > 0 ? surface.size() : 0, {});
  offset_.clear();
  steps_left_ = 0;
  if (rows.empty())
    return;
  for (int k = 0; k < surface.size(); ++k) {
    const auto row = rows.find({tool, surface[k].owner, surface[k].number});
    if (row == rows.end())
      continue;
    const auto &values = row->second;
    if (values[1] > 0)
      offset_[k] = values[1];
    if (values[0] == 0 || friction_ == 0)
      continue;
    memory_[k].is_touched = true;
    for (int c = 0; c < dim; ++c) {
      memory_[k].last[c] = values[2 + c];
      memory_[k].stretch[c] = values[2 + dim + c];
    }
  }
}

template <int dim>
void ToolContact<dim>::save_heat(core::State &state, const std::string &prefix) const
{
  core::save_value(state, "tools", prefix + "heat", heat_);
  // The far field's part stays as it is between two of its steps.
  core::save_value(state, "tools", prefix + "far_energy", far_.energy);
  core::save_value(state, "tools", prefix + "far_area", far_.area);
}

template <int dim>
void ToolContact<dim>::load_heat(const core::State &state, const std::string &prefix)
{
  heat_ = core::load_real(state, "tools", prefix + "heat");
  far_.energy = core::load_real(state, "tools", prefix + "far_energy");
  far_.area = core::load_real(state, "tools", prefix + "far_area");
}

template class ToolContact<2>;
template class ToolContact<3>;
} // namespace ligament::program
