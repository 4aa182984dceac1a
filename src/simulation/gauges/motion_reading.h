// Displacement and its gradient, at a point or averaged over a box, as sums over particles and
// nodes: exact for every motion that is affine in the place.
#pragma once

#include "fem/cell_map.h"
#include "src/scene/geometry.h"
#include "src/simulation/coupled_body.h"

#include <Eigen/LU>

#include <optional>

namespace ligament::program
{
/// u = sum value u_k and du_i/dx_j = sum u_k,i gradient_j over particles and nodes. Of several
/// ranks, which all read, each has the terms of some particles, and all have those of the nodes.
template <int dim>
struct MotionReading
{
  struct Term
  {
    int item;
    double value;
    Vector<dim> gradient; // 1/m
  };
  std::vector<Term> particles, nodes;

  Vector<dim> displacement(const CoupledBody<dim> &body) const;
  Eigen::Matrix<double, dim, dim> gradient(const CoupledBody<dim> &body) const;
};

/// Where gauges look for what carries them, while they are made.
template <int dim>
struct GaugePlaces
{
  GaugePlaces(const Scene &the_scene, const CoupledBody<dim> &the_body);

  /// The particle nearest to a point without a crack in between; none within three spacings. Of
  /// several ranks, which all ask, one has it.
  struct Nearest
  {
    bool is_there = false;
    int particle = -1; // here; -1: another rank has it
  };
  Nearest nearest_particle(const Vector<dim> &place) const;

  const Scene &scene;
  const CoupledBody<dim> &body;
  std::optional<fem::CellLocator<dim>> cells;
};

/// Particles that bonds join to `centre` in at most so many steps, itself first, then ascending.
template <int dim>
std::vector<int> bonded_around(const CoupledBody<dim> &body, int centre, int n_rings);

/// Of the motion that is affine in the place and fits these particles best; what they don't tell of
/// its gradient, as too few or in one line, is 0. `rank`: how many directions they do tell of.
template <int dim>
MotionReading<dim> fit_particles(const CoupledBody<dim> &body, const std::vector<int> &particles,
                                 const Vector<dim> &place, int *rank = nullptr);

/// Of a point of a mesh's cell.
template <int dim>
MotionReading<dim> interpolate(const fem::Mesh<dim> &mesh, int cell, const Vector<dim> &place);

/// A point that goes with the body: with the mesh where there is one, else with the particles that
/// two steps from bond to bond reach from the nearest one, so that the flanks of a crack or notch
/// stay apart.
template <int dim>
class PointMotion
{
public:
  /// core::InputError where there is neither mesh nor particle.
  PointMotion(const GaugePlaces<dim> &places, const Vector<dim> &place);

  /// Knows what has broken since.
  const MotionReading<dim> &reading(const CoupledBody<dim> &body);

  int cell() const { return cell_; }
  /// -1: a cell carries it, or another rank has the particle.
  int particle() const { return particle_; }
  const Vector<dim> &place() const { return place_; }
  /// "4 nodes of a cell of 2 mm" or "19 particles within 1 mm"; all ranks ask.
  std::string source(const CoupledBody<dim> &body) const;

private:
  void find_particles(const CoupledBody<dim> &body);

  Vector<dim> place_;             // m
  int cell_ = -1, particle_ = -1; // of the mesh; else the nearest one
  std::vector<int> around_;       // particles of the fit, ascending
  std::size_t n_broken_ = 0;      // bonds that it knows of
  MotionReading<dim> reading_;
};

/// Of the motion that is affine in the place and fits a box best, each part of the material with
/// its volume: cells of the mesh as far as they lie in the box, particles outside the mesh by their
/// centres. What breaks in the box counts as a strain. Its `value` terms are those of the middle of
/// this material. core::InputError where the box holds too little.
template <int dim>
MotionReading<dim> fit_box(const GaugePlaces<dim> &places, const Vector<dim> &lower,
                           const Vector<dim> &upper);

/// visit(cell, part_lower, part_upper) for the cells of the mesh that reach into the box, general
/// cells by their own bounding boxes.
template <int dim, typename Visit>
void for_each_cell_part(const fem::Mesh<dim> &mesh, const Vector<dim> &lower,
                        const Vector<dim> &upper, Visit &&visit)
{
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    const Vector<dim> from = mesh.cell_lower[cell].cwiseMax(lower),
                      to = (mesh.cell_lower[cell] + mesh.cell_size[cell]).cwiseMin(upper);
    if ((to.array() > from.array()).all())
      visit(cell, from, to);
  }
}

/// visit(place, volume) for the points of Gauss' rule of two points per axis in a box, the volume
/// in m^dim.
template <int dim, typename Visit>
void for_each_gauss_point(const Vector<dim> &lower, const Vector<dim> &upper, Visit &&visit)
{
  const Vector<dim> middle = (lower + upper) / 2, half = (upper - lower) / 2;
  for (int k = 0; k < 1 << dim; ++k) {
    Vector<dim> place = middle;
    for (int c = 0; c < dim; ++c)
      place[c] += (k >> c & 1 ? 1 : -1) * half[c] / std::sqrt(3.);
    visit(place, half.prod());
  }
}

/// The same for a cell of a mesh, cut into so many parts per axis of its own.
template <int dim, typename Visit>
void for_each_gauss_point(const fem::Mesh<dim> &mesh, int cell, int parts, Visit &&visit)
{
  const auto corners = fem::cell_corners(mesh, cell);
  const Vector<dim> size = Vector<dim>::Constant(1. / parts);
  for (int part = 0; part < std::lround(std::pow(parts, dim)); ++part) {
    Vector<dim> from;
    for (int c = 0, rest = part; c < dim; ++c, rest /= parts)
      from[c] = rest % parts * size[c];
    for_each_gauss_point<dim>(from, from + size, [&](const Vector<dim> &s, double share) {
      visit(fem::cell_point<dim>(corners, s),
            share * fem::cell_jacobian<dim>(corners, s).determinant());
    });
  }
}

/// visit(cell, place, volume) for points of the mesh in the box that stand for its volume there
/// (m^dim). Of a general cell that the box cuts those of its points count that lie inside.
template <int dim, typename Visit>
void for_each_mesh_point(const fem::Mesh<dim> &mesh, const Vector<dim> &lower,
                         const Vector<dim> &upper, Visit &&visit)
{
  for_each_cell_part<dim>(mesh, lower, upper, [&](int cell, const auto &from, const auto &to) {
    if (mesh.is_box(cell)) {
      for_each_gauss_point<dim>(
          from, to, [&](const Vector<dim> &place, double volume) { visit(cell, place, volume); });
      return;
    }
    const bool is_cut =
        (from.array() != mesh.cell_lower[cell].array()).any() ||
        (to.array() != (mesh.cell_lower[cell] + mesh.cell_size[cell]).array()).any();
    for_each_gauss_point(mesh, cell, is_cut ? 4 : 1, [&](const Vector<dim> &place, double volume) {
      if ((place.array() >= lower.array()).all() && (place.array() <= upper.array()).all())
        visit(cell, place, volume);
    });
  });
}

/// The bonds at hand broken since number `known`, which is brought up to date.
template <int dim, typename Visit>
void for_each_new_break(const CoupledBody<dim> &body, std::size_t &known, Visit &&visit)
{
  if (!body.force())
    return;
  const auto &broken = body.force()->broken_bonds();
  for (; known < broken.size(); ++known)
    visit(broken[known]);
}
} // namespace ligament::program
