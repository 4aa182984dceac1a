// The shape of a specimen for a packing: a box or a solid, the voids cut out of it, and cracks.
#pragma once

#include "packings/solid_piece.h"
#include "packings/specimen.h"

#include <array>

namespace ligament::packings
{
/// The half-space normal . x <= offset.
template <int dim>
struct HalfSpace
{
  Vector<dim> normal; // unit
  double offset;      // m
};

/// A convex void: a notch, or a hole as a polygon of equal area.
template <int dim>
class Void
{
public:
  /// A polygon of about equal area to the disc with sides of about `side`, symmetric about both
  /// axes.
  static Void disc(const DiscHole<dim> &hole, double side);
  static Void box(const BoxNotch<dim> &notch);

  /// From x to the void (for a disc the true circle); negative inside.
  double distance(const Vector<dim> &x) const;
  /// Inside the polygon or box by more than the tolerance.
  bool contains(const Vector<dim> &x, double tolerance) const;
  /// Does the segment a - b run through it deeper than `depth`?
  bool hides(const Vector<dim> &a, const Vector<dim> &b, double depth) const;

  /// Of a box around it, its polygon included.
  const Vector<dim> &centre() const { return centre_; }
  Vector<dim> half_size() const { return half_size_ + Vector<dim>::Constant(1.1 * radius_); }

  std::vector<HalfSpace<dim>> sides; // outward normals; the void is their intersection

private:
  Vector<dim> centre_ = Vector<dim>::Zero(), half_size_ = Vector<dim>::Zero();
  double radius_ = 0;
};

/// Which of many voids are near a place, by bins.
template <int dim>
class VoidGrid
{
public:
  VoidGrid() = default;
  /// Of places in the box, in m.
  VoidGrid(const std::vector<Void<dim>> &voids, const Vector<dim> &lower, const Vector<dim> &upper,
           double reach);

  /// Numbers in order of those within so far (m) of x, perhaps with others.
  const std::vector<int> &within(const Vector<dim> &x, double distance) const;

private:
  std::vector<int> all_;
  Vector<dim> lower_ = Vector<dim>::Zero();
  double bin_ = 1, reach_ = 0; // m
  std::array<int, dim> n_bins_{};
  std::vector<std::vector<int>> near_; // of a bin: what is within reach of it
};

/// A cut without width.
template <int dim>
class CrackPlane
{
public:
  /// Lengths below the tolerance don't count. Throws core::InputError for points that span no
  /// segment or no convex plane polygon.
  CrackPlane(const CrackPoints<dim> &points, double tolerance);

  /// Does the segment a - b cross the crack? Its rim belongs to it; points on its plane lie on its
  /// positive side.
  bool is_crossed_by(const Vector<dim> &a, const Vector<dim> &b) const;

  /// Height above the plane in m, positive on the positive side.
  double height(const Vector<dim> &x) const { return plane_.normal.dot(x) - plane_.offset; }
  /// Does the foot of x on the plane lie on the crack?
  bool is_beside(const Vector<dim> &x) const;
  /// Unit, to the positive side.
  const Vector<dim> &normal() const { return plane_.normal; }

private:
  double tolerance_;
  HalfSpace<dim> plane_; // its normal points to the positive side
  std::vector<HalfSpace<dim>> rim_;
};

/// Number of the first of these cracks that the segment a - b crosses; -1: of none.
template <int dim>
int first_crossed(const std::vector<CrackPlane<dim>> &cracks, const Vector<dim> &a,
                  const Vector<dim> &b);

/// The k-th facet of the solid has the number first_facet - k among the planes that bound a cell.
inline constexpr int first_facet = -1000000;

template <int dim>
struct SpecimenShape
{
  /// Checks the parameters; throws core::InputError with reason and remedy.
  explicit SpecimenShape(const SpecimenParameters<dim> &parameters);

  /// From x to the nearest surface; negative outside the material. Surfaces of voids and of a solid
  /// count up to four spacings away.
  double distance(const Vector<dim> &x) const;
  /// Does the segment a - b leave the solid by more than `depth`?
  bool leaves_solid(const Vector<dim> &a, const Vector<dim> &b, double depth) const;

  Vector<dim> lower, upper;
  double spacing;
  std::shared_ptr<const core::Solid<dim>> solid;  // null: the box
  std::shared_ptr<const SolidPieces<dim>> pieces; // of it
  std::vector<Void<dim>> voids;
  std::vector<int> n_sides_before; // of the voids in front of each
  VoidGrid<dim> grid;              // of them
  std::vector<CrackPlane<dim>> cracks;
};
} // namespace ligament::packings
