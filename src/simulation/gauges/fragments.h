// The pieces into which a body has broken.
#pragma once

#include "src/simulation/gauges/gauge.h"

namespace ligament::program
{
/// A piece of the body and its motion. Its particles inside the mesh count as mesh.
struct Fragment
{
  double mass = 0;                                                    // kg
  Vector<3> centre = Vector<3>::Zero(), velocity = Vector<3>::Zero(); // m, at present; m/s
  Vector<3> spin = Vector<3>::Zero(); // rad/s, of the rigid motion with its angular momentum
  std::int64_t particles = 0;
  bool has_mesh = false;
};

/// Pieces (find_pieces) are sought again when bonds have broken: that is a look at all faces.
template <int dim>
class FragmentGauge : public Gauge<dim>
{
public:
  FragmentGauge(const GaugeParameters &gauge, const Scene &scene, const CoupledBody<dim> &body);

  /// Number of pieces, mass and mean velocity of the heaviest.
  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override;
  /// fragments.csv, the heaviest first.
  void write(const CoupledBody<dim> &body, const RunFolder &folder) override;

  /// Those at least as heavy as the scene asks for, the heaviest first; of velocities before kick.
  /// All ranks ask.
  std::vector<Fragment> fragments(const CoupledBody<dim> &body);

private:
  /// A point that carries mass: a particle outside the mesh, or a node.
  struct Carrier
  {
    int item, piece;
    bool is_node;
    double mass;
  };
  /// Seeks the pieces where bonds have broken since the last look.
  void follow(const CoupledBody<dim> &body);
  Fragment motion(const CoupledBody<dim> &body, int piece) const;

  std::string name_;
  double least_mass_;              // kg
  bool rebonds_;
  std::vector<double> density_;    // kg/m^3, by material
  std::int64_t n_broken_ = -1;     // in the body, of which these are the pieces; -1: not sought yet
  std::vector<Carrier> carriers_;  // of this rank, by pieces
  std::vector<std::size_t> first_; // carrier of each piece, and the end
  std::vector<double> mass_;       // kg, of the pieces; the heaviest first
};
} // namespace ligament::program
