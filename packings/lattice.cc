#include "packings/lattice.h"

#include "core/check.h"
#include "packings/voronoi_cell.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace ligament::packings
{
namespace
{
template <int dim>
struct UnitCell
{
  Eigen::Matrix<double, dim, dim> basis; // columns, for d = 1
  Vector<dim> shift;                     // of the point 0 from the centre, in basis vectors
  std::vector<LatticeIndex<dim>> forward;
  double volume, face_area;
};

UnitCell<2> unit_cell(LatticeKind kind, const LatticeParameters<2> &)
{
  UnitCell<2> cell;
  if (kind == LatticeKind::square) {
    cell.basis.setIdentity();
    cell.shift = {0.5, 0.5};
    cell.forward = {{1, 0}, {0, 1}};
    cell.volume = cell.face_area = 1;
  } else {
    core::require(kind == LatticeKind::hexagonal, "a packing in 2D is square or hexagonal");
    cell.basis << 1, 0.5, 0, std::sqrt(3.) / 2;
    cell.shift = {0, 0.5};
    cell.forward = {{1, 0}, {-1, 1}, {0, 1}};
    cell.volume = std::sqrt(3.) / 2;
    cell.face_area = 1 / std::sqrt(3.);
  }
  return cell;
}

UnitCell<3> unit_cell(LatticeKind kind, const LatticeParameters<3> &)
{
  UnitCell<3> cell;
  if (kind == LatticeKind::simple_cubic) {
    cell.basis.setIdentity();
    cell.shift = {0.5, 0.5, 0.5};
    cell.forward = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    cell.volume = cell.face_area = 1;
  } else {
    core::require(kind == LatticeKind::fcc, "a packing in 3D is simple_cubic or fcc");
    cell.basis << 1, 0, 0.5, 0, 1, 0.5, 0, 0, std::sqrt(0.5);
    cell.shift = {0, 0, 0.5};
    cell.forward = {{1, 0, 0}, {0, 1, 0}, {-1, -1, 1}, {0, -1, 1}, {-1, 0, 1}, {0, 0, 1}};
    cell.volume = std::sqrt(0.5);
    cell.face_area = std::sqrt(0.125);
  }
  return cell;
}

Eigen::Matrix2d rotation(const Vec<1> &angle)
{
  return Eigen::Rotation2Dd(angle[0]).toRotationMatrix();
}

Eigen::Matrix3d rotation(const Vec<3> &vector)
{
  const double angle = vector.norm();
  if (angle == 0)
    return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}
} // namespace

template <int dim>
Lattice<dim>::Lattice(const LatticeParameters<dim> &parameters)
    : spacing(parameters.spacing), centre_((parameters.lower + parameters.upper) / 2)
{
  const UnitCell<dim> cell = unit_cell(parameters.kind, parameters);
  core::require(parameters.orientation.allFinite(), "the orientation of a packing must be finite");
  basis_ = spacing * rotation(parameters.orientation) * cell.basis;
  inverse_ = basis_.inverse();
  shift_ = cell.shift;
  cell_volume = cell.volume * std::pow(spacing, dim);
  face_area = cell.face_area * std::pow(spacing, dim - 1);

  const auto neighbour = [&](const LatticeIndex<dim> &k) {
    const Vector<dim> r = basis_ * k.template cast<double>();
    return LatticeNeighbour<dim>{k, r.normalized(), r.norm()};
  };
  for (const LatticeIndex<dim> &k : cell.forward) {
    forward.push_back(neighbour(k));
    forward.back().distance = spacing;
  }

  // |k| <= 6 |reciprocal vector|, and those of the unit bases are no longer than sqrt(2).
  constexpr int reach = 9, width = 2 * reach + 1;
  for (int number = 0; number < (dim == 2 ? width * width : width * width * width); ++number) {
    LatticeIndex<dim> k;
    for (int a = 0, rest = number; a < dim; ++a, rest /= width)
      k[a] = rest % width - reach;
    const LatticeNeighbour<dim> candidate = neighbour(k);
    if (candidate.distance > 0 && candidate.distance < 6.001 * spacing)
      reachable.push_back(candidate);
  }
  std::stable_sort(reachable.begin(), reachable.end(),
                   [](const auto &a, const auto &b) { return a.distance < b.distance; });

  VoronoiCell<dim> whole(spacing, 0, 1e-13 * spacing);
  for (const LatticeNeighbour<dim> &n : forward)
    for (const double sign : {-1., 1.})
      whole.clip(sign * n.direction, spacing / 2, 0);
  cell_radius = whole.max_radius();
  extent.setZero();
  for (const Vector<dim> &x : whole.vertices())
    extent = extent.cwiseMax(x.cwiseAbs());
}

template <int dim>
std::int64_t Lattice<dim>::global_id(const LatticeIndex<dim> &k)
{
  // Below 2^53, so that they pass through tables of doubles unharmed.
  constexpr int bits = dim == 2 ? 26 : 17;
  constexpr std::int64_t half = std::int64_t(1) << (bits - 1);
  std::int64_t id = 0;
  for (int a = dim - 1; a >= 0; --a) {
    core::require(-half <= k[a] && k[a] < half,
                  "the lattice has too many particles in one direction: make the spacing larger");
    id = (id << bits) + k[a] + half;
  }
  return id;
}

template class Lattice<2>;
template class Lattice<3>;
} // namespace ligament::packings
