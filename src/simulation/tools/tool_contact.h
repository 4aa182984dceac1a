// The layer between one tool and the body: pressure by depth, friction by tangential springs.
#pragma once

#include "src/simulation/tools/contact_surface.h"
#include "src/simulation/tools/rigid_tool.h"

#include <map>

namespace ligament::program
{
/// How often a tool looks for the points that it may touch.
struct SearchLimits
{
  double margin; // m, within which points are looked at in every step
  double speed;  // m/s, that may come on top of the present ones between two looks
};

/// Looks only at points near the tool. What they are decides nothing but the time it takes.
template <int dim>
class ToolContact
{
public:
  ToolContact(double friction, const SearchLimits &limits) : friction_(friction), limits_(limits) {}

  /// What the body does to the tool.
  struct Answer
  {
    Wrench<dim> zone, far;
    double stiffness = 0, far_stiffness = 0; // N/m, of all layers of either that are pressed
  };
  /// At the present places. With `pushes` the body gets its share. Points of the far field take
  /// part where it acts.
  Answer act(const RigidTool<dim> &tool, const ContactSurface<dim> &surface,
             coupling::Bodies<dim> &bodies, double dt, bool far_acts, bool pushes);
  /// What the last act() pushed, once more: for forces that are computed anew in the same step, in
  /// which the far field acts.
  void push_again(const ContactSurface<dim> &surface, coupling::Bodies<dim> &bodies) const;
  /// Surface that is there since the last step: points from this one on. Those inside the tool
  /// press only when they go deeper.
  void begin(int first, const RigidTool<dim> &tool, const ContactSurface<dim> &surface,
             const coupling::Bodies<dim> &bodies);

  /// In J at the last act(): stored, and heat so far.
  double energy() const { return zone_.energy + far_.energy; }
  double heat() const { return heat_; }
  /// m^2, of points that are pressed.
  double area() const { return zone_.area + far_.area; }
  /// Power in W of the tool on the body at the velocities of the last half step; far: of that part.
  double power(bool far) const { return far ? far_.power : zone_.power; }

  /// visit(point, depth in m, pressure in Pa) of all points that are pressed, in their order.
  template <typename Visit>
  void for_each_pressed(const RigidTool<dim> &tool, const ContactSurface<dim> &surface,
                        const coupling::Bodies<dim> &bodies, Visit &&visit) const;

  /// Rows called by the tool's number, the owner of the point and its number there.
  void save(int tool, const ContactSurface<dim> &surface,
            std::map<std::array<std::int64_t, 3>, std::vector<double>> &rows) const;
  void load(int tool, const ContactSurface<dim> &surface,
            const std::map<std::array<std::int64_t, 3>, std::vector<double>> &rows);
  void save_heat(core::State &state, const std::string &prefix) const;
  void load_heat(const core::State &state, const std::string &prefix);

private:
  /// Of a point with friction, in the tool's frame.
  struct Memory
  {
    bool is_touched = false;
    Vector<dim> last, stretch; // m: place at the last step, of the tangential spring
  };
  struct Sums
  {
    double energy = 0, area = 0, power = 0;
  };
  void look_around(const RigidTool<dim> &tool, const ContactSurface<dim> &surface,
                   const coupling::Bodies<dim> &bodies, double dt);
  double depth_of(int k, const Touch<dim> &touch);
  static double share_of(int k, const Touch<dim> &touch, const RigidTool<dim> &tool,
                         const ContactSurface<dim> &surface, const coupling::Bodies<dim> &bodies)
  {
    return facing_share<dim>(surface.normal(k, bodies), tool.rotation() * touch.normal);
  }
  Vector<dim> friction_force(Memory &memory, const Vector<dim> &y, const Touch<dim> &touch,
                             double depth, double stiffness, Sums &sums);

  double friction_;
  SearchLimits limits_;
  std::vector<int> near_; // points, ascending
  double way_left_ = -1;  // m, that the tool may go before the next look
  double farthest_ = 0;   // m, from its centre, of what it may come to until then
  int steps_left_ = 0;    // before the next look
  std::vector<Memory> memory_;
  std::map<int, double> offset_; // m, depth at which these points begin to press
  Sums zone_, far_;
  std::vector<std::pair<int, Vector<dim>>> pushed_; // points, N
  double heat_ = 0;
};

template <int dim>
template <typename Visit>
void ToolContact<dim>::for_each_pressed(const RigidTool<dim> &tool,
                                        const ContactSurface<dim> &surface,
                                        const coupling::Bodies<dim> &bodies, Visit &&visit) const
{
  for (const int k : near_) {
    const Vector<dim> y = tool.rotation().transpose() * (surface.place(k, bodies) - tool.centre());
    const auto offset = offset_.find(k);
    const Touch<dim> touch = tool.definition().shape.touch(y);
    const double depth = touch.depth - (offset == offset_.end() ? 0 : offset->second);
    const double share = depth > 0 ? share_of(k, touch, tool, surface, bodies) : 0;
    if (share > 0)
      visit(k, depth, share * surface[k].stiffness / surface[k].area * depth);
  }
}
} // namespace ligament::program
