// One rigid tool: where it is, what drives it, and the energies of both.
#pragma once

#include "core/load.h"
#include "core/state.h"
#include "src/simulation/tools/tool_set.h"
#include "src/simulation/tools/tool_shape.h"

#include <limits>
#include <optional>

namespace ligament::program
{
/// Without drive, mass and spring it stands still.
template <int dim>
struct ToolDefinition
{
  std::string name;
  ToolShape<dim> shape;
  Vector<dim> place; // m, at time 0
  /// Prescribed motion: of the tool, or with a spring of the far end of that.
  std::optional<core::BoundaryLoad<dim>> drive = {};
  double mass = 0;                            // kg; 0: it moves as driven
  double inertia = 0;                         // kg m^2, about every axis; 0: it doesn't turn
  double machine_stiffness = 0;               // N/m, of a spring in every direction; 0: none
  double friction = 0;                        // Coulomb's coefficient
  Vector<dim> velocity = Vector<dim>::Zero(); // m/s, at time 0
  double release = std::numeric_limits<double>::infinity(); // s, from which on it is gone
};

/// What a body does to a tool at one time.
template <int dim>
struct Wrench
{
  Vector<dim> force = Vector<dim>::Zero(); // N
  Spin<dim> torque = Spin<dim>::Zero();    // N m, about its centre
};

template <int dim>
class RigidTool
{
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;

  explicit RigidTool(ToolDefinition<dim> definition);

  const ToolDefinition<dim> &definition() const { return definition_; }
  bool is_free() const { return definition_.mass > 0; }
  const Vector<dim> &centre() const { return now_.centre; }
  const Matrix &rotation() const { return now_.rotation; }
  /// Of the step that led here, m.
  double way() const { return (now_.centre - last_centre_).norm(); }
  const Spin<dim> &spin() const { return now_.spin; } // rad/s
  Vector<dim> displacement() const { return now_.centre - definition_.place; }
  Vector<dim> velocity() const { return now_.velocity; }
  const Vector<dim> &drive_place() const { return drive_place_; }

  /// To a time in s, dt behind the last one.
  void advance(double time, double dt);
  /// Force and torque there: books the work of the drive and changes the velocity of a free tool.
  /// Those of the far field come with every `ratio`-th step alone, for all of these: else null.
  void finish(double dt, const Wrench<dim> &zone, const Wrench<dim> *far, int ratio);

  /// In J, at the last finish().
  double kinetic() const { return kinetic_; }
  double spring() const { return definition_.machine_stiffness / 2 * stretch_.squaredNorm(); }
  double work() const { return now_.work; }
  /// The tool leaves, and takes this with it, in J.
  void leave(double energy);
  bool is_gone() const { return now_.gone != 0; }

  void save(core::State &state, const std::string &prefix) const;
  void load(const core::State &state, const std::string &prefix);

private:
  /// All that the next step needs.
  struct Moment
  {
    Vector<dim> centre, velocity; // m, m/s
    Matrix rotation = Matrix::Identity();
    Spin<dim> spin = Spin<dim>::Zero(); // rad/s
    double work = 0;                    // J
    double gone = 0, has_acted = 0;     // 0 or 1
    // What the next work is booked against.
    Vector<dim> zone_force, far_force, spring_force;  // N
    Vector<dim> zone_centre, far_centre, drive_place; // m
  };
  /// visit(name, value) of all numbers of a moment.
  template <typename M, typename Visit>
  static void for_each_number(M &moment, Visit &&visit);
  Vector<dim> drive(double time) const;

  ToolDefinition<dim> definition_;
  Moment now_;
  Vector<dim> last_centre_, stretch_ = Vector<dim>::Zero(), drive_place_;
  double kinetic_ = 0;
};
} // namespace ligament::program
