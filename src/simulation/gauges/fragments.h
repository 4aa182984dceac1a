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

/// Particles that bonds join are one piece; the mesh does not break, and holds the particles in it.
/// Pieces are sought again when bonds have broken: that is a look at all faces.
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
  std::vector<Fragment> fragments(const CoupledBody<dim> &body);

private:
  /// A point that carries mass: a particle outside the mesh, or a node.
  struct Carrier
  {
    int item, piece;
    bool is_node;
    double mass;
  };
  void find_pieces(const CoupledBody<dim> &body);
  Fragment motion(const CoupledBody<dim> &body, int piece) const;

  std::string name_;
  double least_mass_;           // kg
  std::vector<double> density_; // kg/m^3, by material
  std::size_t n_broken_ = 0;
  bool is_known_ = false;
  std::vector<Carrier> carriers_;  // by pieces
  std::vector<std::size_t> first_; // carrier of each piece, and the end
  std::vector<double> mass_;       // kg, of the pieces; the heaviest first
};
} // namespace ligament::program
