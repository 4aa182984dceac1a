// The surface of the body as tools feel it: points of quadrature on outer faces of particles and
// cells.
#pragma once

#include "coupling/coupler.h"
#include "packings/packing.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace ligament::program
{
/// How stiff the layer between tool and body is, where nothing else limits it.
struct ContactStiffness
{
  std::vector<double> youngs_modulus; // Pa, of each material of the packing; cells have the first
  /// A share of the square of the largest frequency that the layer of an outer face alone may give
  /// its particle or node: the stable step stays what it is, nearly (theory.md eq. (T3)).
  double share = 0.25;
};

/// Which share of a face presses against a tool whose way out is `out`: faces that look along the
/// surface of the tool have points at their edges that lie in it, and touch nothing.
template <int dim>
double facing_share(const Vector<dim> &face_normal, const Vector<dim> &out)
{
  constexpr double all = 0.2; // from here on, the cosine
  return std::min(1., std::max(0., -face_normal.dot(out) / all));
}

/// A point of quadrature. It moves with one particle, or between the nodes of a cell's face.
template <int dim>
struct SurfacePoint
{
  static constexpr int n_nodes = fem::n_cell_nodes<dim> / 2;

  std::int64_t owner; // name of its particle; of a cell's face -1 - the name of its first node
  int number;         // among those of the owner
  int particle = -1;  // -1: it lies on a cell
  Vector<dim> arm = Vector<dim>::Zero();    // m, from the particle's centre in the reference
  Vector<dim> normal = Vector<dim>::Zero(); // unit, out of the body in the reference
  std::array<int, n_nodes> nodes = {};
  Vec<n_nodes> shares = Vec<n_nodes>::Zero(); // of the nodes
  double area = 0;                            // m^2
  double stiffness = 0;                       // N/m, of the layer on this area

  bool is_far() const { return particle < 0; }
};

/// Points of all outer faces, in an order that only the body decides: those of particles, of cells,
/// and behind them those of bonds as they break.
template <int dim>
class ContactSurface
{
public:
  /// Of the zone. `stable_step` in s is that of the zone without tools.
  void add_particles(const packings::Packing<dim> &packing,
                     const particles::Particles<dim> &particles, const ContactStiffness &stiffness,
                     double stable_step);
  /// Of the cells of the far field, whatever their shape, but where an overlap has particles (null:
  /// there is none). `names` of nodes.
  void add_cells(const fem::FemSolver<dim> &far, const coupling::Overlap<dim> *overlap,
                 const core::Names &names, const ContactStiffness &stiffness, double stable_step);
  /// Both flanks of the bonds that broke since the last call. Returns how many points there were
  /// before.
  int add_broken(const particles::ParticleSolver<dim> &zone);

  int size() const { return int(points_.size()); }
  const SurfacePoint<dim> &operator[](int k) const { return points_[k]; }

  Vector<dim> place(int k, const coupling::Bodies<dim> &bodies) const;
  /// Unit, out of the body.
  Vector<dim> normal(int k, const coupling::Bodies<dim> &bodies) const;
  Vector<dim> velocity(int k, const coupling::Bodies<dim> &bodies) const;
  /// To the forces of the body, in N; what acts on supports is not the body's.
  void push(int k, const Vector<dim> &force, coupling::Bodies<dim> &bodies) const;
  /// Largest speed of all in m/s.
  double largest_speed(const coupling::Bodies<dim> &bodies) const;

  /// Bound of what the layers add to the square of any frequency, in 1/s^2.
  double largest_rate() const { return largest_rate_; }

private:
  struct Flank
  {
    int particle;
    Vector<dim> arm, normal;
    double area;
  };
  void add_flank(const Flank &flank, std::int64_t owner);
  Vector<dim> arm(int k, const particles::Particles<dim> &particles) const
  {
    return turned(points_[k].arm, points_[k].particle, particles);
  }
  static Vector<dim> turned(const Vector<dim> &arm, int particle,
                            const particles::Particles<dim> &particles);

  std::vector<SurfacePoint<dim>> points_;
  std::vector<int> n_of_particle_; // points that each particle has
  std::vector<double> per_area_;   // Pa/m, stiffness of each particle's faces
  std::vector<int> hanging_;       // of each node, number in the mesh's list, or -1
  double thickness_ = 1;           // m, 2D
  double largest_rate_ = 0;
  std::size_t n_broken_ = 0; // bonds whose flanks are here
};
} // namespace ligament::program
