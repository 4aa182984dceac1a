// What a testing machine would read: load, stress, displacement and strain of the specimen.
#pragma once

#include "src/simulation/coupled_body.h"

namespace ligament::program
{
struct Reading
{
  double load = 0;         // N
  double stress = 0;       // Pa, load over the area of the side, or of the loaded part of it
  double displacement = 0; // m, elongation between the two sides of the axis
  double strain = 0;       // elongation over the specimen's size
};

/// Reads the first load that has a component: its largest one is the axis of the test. Without such
/// a load it reads the first pressure on a side of the box, or else the first tool that is driven,
/// its force and its way.
/// On a side with a name of its own the axis is that of the component, the area that of the box
/// around the specimen across it, and the displacement is against the load in the other half, or
/// the end of the body there: of what the load acts on, a mean over the mesh, of particles that of
/// its middle. Displacements of sides of the box are prescribed ones, on whatever part of them,
/// that of the load before others, or else means of whole sides.
template <int dim>
class TestMachine
{
public:
  explicit TestMachine(const CoupledBody<dim> &body);

  Reading read(const CoupledBody<dim> &body, double time) const;

  bool has_load() const { return load_ >= 0 || tool_ >= 0; }
  /// The load answers a prescribed motion: it falls when nothing carries it any more.
  bool is_answer() const { return is_answer_; }
  /// Component of the measured force, 0 for x.
  int component() const { return component_; }
  /// Axis of the loaded side.
  int axis() const { return axis_; }

private:
  double side_displacement(const CoupledBody<dim> &body, int side, double time) const;
  double load_displacement(const CoupledBody<dim> &body, int load, double time) const;
  double opposite_displacement(const CoupledBody<dim> &body, double time) const;

  void look_for_tool(const CoupledBody<dim> &body);
  void look_for_jump(const CoupledBody<dim> &body);
  Reading read_jump(const CoupledBody<dim> &body, double time) const;

  int load_ = -1;      // index of the load that is read
  int tool_ = -1;      // likewise
  int jump_axis_ = -1; // the load is a jump across the sides that are joined along it
  int component_ = 0, axis_ = 0;
  bool is_named_ = false; // a side with a name of its own: the axis is that of its component
  int opposite_ = -1;     // then: the load in the other half of the body, -1: none
  bool is_answer_ = false;
  double sign_ = 1; // tension on the upper side is positive
  double area_ = 1, size_ = 1;
};

/// Displacement component of a side of the specimen, in m: the mean over its nodes, without a far
/// field that of its middle after an affine fit to the particles near it; of a side that the mesh
/// has a part of, both by their shares. A body that ends in a tip or an edge has the motion of what
/// reaches farthest: of the nodes there, or of particles further inside.
template <int dim>
double mean_displacement(const CoupledBody<dim> &body, int boundary, int component);
} // namespace ligament::program
