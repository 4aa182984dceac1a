// What the time loop, the ledger and the outputs ask of the rigid tools of a run.
#pragma once

#include "core/state.h"
#include "coupling/coupler.h"

#include <array>
#include <string>
#include <vector>

namespace ligament::program
{
/// Energies in J of all tools together (theory.md, section Tools).
struct ToolEnergy
{
  double kinetic = 0;
  double contact = 0;  // stored by the contact layers, tangential springs included
  double spring = 0;   // of testing machines
  double friction = 0; // heat so far
  double work = 0;     // of drives so far, with the motion that tools began with
};

template <int dim>
struct ToolReading
{
  Vector<dim> force;        // N, on the body
  Vector<dim> displacement; // m, of the tool
  Vector<dim> velocity;     // m/s, of a free tool half a step ago
  double area = 0;          // m^2 that the tool touches
  Eigen::Matrix<double, dim, dim> rotation; // about its centre
};

/// Rigid tools that touch the body. A body without tools has none of this.
template <int dim>
class ToolSet
{
public:
  virtual ~ToolSet() = default;

  /// Behind the forces of a step, before anybody looks: moves the tools to the present time, adds
  /// what they do to the forces of particles and nodes, and changes the velocities of those that
  /// are free. `ratio`: far-field steps of so many steps.
  virtual void act(coupling::Bodies<dim> bodies, const coupling::StepTime &step, int ratio) = 0;

  /// The forces of the last act() once more, where those of the body are computed anew in the same
  /// step, in which the far field acts.
  virtual void push_again(coupling::Bodies<dim> bodies) const = 0;

  /// At the last act().
  virtual ToolEnergy energy() const = 0;
  virtual int size() const = 0;
  virtual const std::string &name(int tool) const = 0;
  virtual ToolReading<dim> read(int tool) const = 0;
  /// The direction in which a tool is driven, of any length; 0: it isn't.
  virtual Vector<dim> drive(int tool) const = 0;
  /// Where a tool is when the run begins, m.
  virtual Vector<dim> place(int tool) const = 0;
  /// Its edges there, two points each, for pictures; empty when it is gone.
  virtual std::vector<std::array<Vector<dim>, 2>> edges(int tool) const = 0;

  /// Between drift and forces.
  virtual void save(core::State &state) const = 0;
  /// Into the tools of the same scene, when the body has its state.
  virtual void load(const core::State &state, const coupling::Bodies<dim> &bodies) = 0;
};
} // namespace ligament::program
