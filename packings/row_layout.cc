#include "packings/row_layout.h"

#include "core/check.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace ligament::packings
{
namespace
{
/// Whether rows and layers make k come after the point 0.
template <int dim>
bool comes_after(const LatticeIndex<dim> &k)
{
  for (int a = dim - 1; a >= 0; --a)
    if (k[a] != 0)
      return k[a] > 0;
  return false;
}

template <int dim>
Eigen::Matrix<int, dim, dim> inverse_of(const Eigen::Matrix<int, dim, dim> &axes)
{
  return axes.template cast<double>().inverse().array().round().template cast<int>();
}

double determinant(const Eigen::Matrix2i &m)
{
  return m.cast<double>().determinant();
}
double determinant(const Eigen::Matrix3i &m)
{
  return m.cast<double>().determinant();
}
} // namespace

// One for each row direction and each plane of nearest neighbours through it: other steps from row
// to row or from layer to layer number the same rows and layers.
template <int dim>
auto RowLayout<dim>::candidates(const Lattice<dim> &lattice) -> std::vector<Axes>
{
  std::vector<Axes> found = {Axes::Identity()};
  const auto is_new = [&](const Axes &axes) {
    for (const Axes &other : found) {
      const Axes steps = inverse_of<dim>(other) * axes;
      // The same rows, in the same layers.
      if (steps.col(0).tail(dim - 1).isZero() && steps.col(1)[dim - 1] * (dim - 2) == 0)
        return false;
    }
    return true;
  };
  const auto &steps = lattice.forward;
  Axes axes;
  const auto take = [&](auto &&self, int column) -> void {
    for (const auto &step : steps) {
      axes.col(column) = step.offset;
      if (column + 1 < dim)
        self(self, column + 1);
      else if (std::abs(determinant(axes)) == 1 && is_new(axes))
        found.push_back(axes);
    }
  };
  take(take, 0);
  return found;
}

template <int dim>
RowLayout<dim>::RowLayout(const Lattice<dim> &lattice, const Vector<dim> &lower,
                          const Vector<dim> &upper, const Axes &axes)
    : axes_(axes), inverse_(inverse_of<dim>(axes))
{
  const Eigen::Matrix<double, dim, dim> inverse = inverse_.template cast<double>();
  Vector<dim> least = Vector<dim>::Constant(1e300), most = -least;
  for (int corner = 0; corner < 1 << dim; ++corner) {
    Vector<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = (corner >> a & 1) ? upper[a] : lower[a];
    const Vector<dim> own = lattice.coordinates(x), k = inverse * own;
    // Beyond this the numbers of lattice points don't fit their bits.
    core::require(own.cwiseAbs().maxCoeff() < (dim == 2 ? 1 << 29 : 1 << 19),
                  "the specimen has too many particles in one direction: make the spacing larger");
    least = least.cwiseMin(k);
    most = most.cwiseMax(k);
  }
  for (int a = 0; a < dim; ++a) {
    first_row_[a] = int(std::floor(least[a])) - 1;
    n_rows_[a] = int(std::ceil(most[a])) + 2 - first_row_[a];
  }
  const double tolerance = 1e-9 * lattice.spacing;
  const Vector<dim> along = lattice.step(step());
  for (int c = 0; c < (dim == 3 ? n_rows_[dim - 1] : 1); ++c) {
    long in_layer = 0;
    for (int b = 0; b < n_rows_[1]; ++b) {
      Index k = first_row_;
      k[0] = 0;
      k[1] += b;
      if (dim == 3)
        k[dim - 1] += c;
      const Index start = axes_ * k;
      const Vector<dim> x = lattice.position(start);
      double begin = -1e9, end = 1e9;
      for (int a = 0; a < dim; ++a) {
        double s = lower[a] - x[a], t = upper[a] - x[a];
        if (std::abs(along[a]) < tolerance) {
          if (s > tolerance || t < -tolerance)
            end = begin - 1;
          continue;
        }
        s /= along[a], t /= along[a];
        begin = std::max(begin, std::min(s, t));
        end = std::min(end, std::max(s, t));
      }
      Row row{start, 0, 0};
      if (begin <= end) {
        const int first = int(std::floor(begin)) - 1;
        row = {start + first * step(), first, int(std::ceil(end)) + 2 - first};
        const long inside = std::lround(std::floor(end) - std::ceil(begin)) + 1;
        n_filled_rows_ += inside > 0;
        n_points_ += inside;
        in_layer = dim == 2 ? inside : in_layer + inside;
        largest_layer_ = std::max(largest_layer_, in_layer);
      }
      rows_.push_back(row);
    }
  }
  for (const LatticeNeighbour<dim> &n : lattice.forward)
    forward_.push_back(comes_after<dim>(inverse_ * n.offset)
                           ? n
                           : LatticeNeighbour<dim>{-n.offset, -n.direction, n.distance});
  std::sort(forward_.begin(), forward_.end(), [&](const auto &a, const auto &b) {
    return comes_after<dim>(inverse_ * (b.offset - a.offset));
  });
}

template <int dim>
std::pair<int, int> RowLayout<dim>::place(const Index &k) const
{
  const Index number = inverse_ * k;
  int row = 0;
  for (int a = dim - 1; a >= 1; --a) {
    const int r = number[a] - first_row_[a];
    if (r < 0 || r >= n_rows_[a])
      return {-1, -1};
    row = row * n_rows_[a] + r;
  }
  const int n = number[0] - rows_[row].first;
  return n < 0 || n >= rows_[row].n_points ? std::pair(-1, -1) : std::pair(row, n);
}

// What a kernel keeps at hand of three layers goes out of the processor's caches by and by, and the
// ends of rows leave parts of vectors idle: per particle 1 + layer / 40000 (2D: 130000) + 2 / row,
// measured on boxes of a million particles; here times the small layer.
template <int dim>
double RowLayout<dim>::cost(long small_layer) const
{
  constexpr double layers = dim == 2 ? 65 : 20, row_end = 2;
  const double rows_per_point = double(n_filled_rows_) / double(std::max(n_points_, 1L));
  return double(small_layer) * (1 + row_end * rows_per_point) + double(largest_layer_) / layers;
}

template <int dim>
RowLayout<dim>::RowLayout(const Lattice<dim> &lattice, const Vector<dim> &lower,
                          const Vector<dim> &upper, long small_layer)
    : RowLayout(lattice, lower, upper, Axes(Axes::Identity()))
{
  if (largest_layer_ <= small_layer)
    return;
  constexpr double worth_it = 0.95; // the lattice's own order is easier to follow
  double least = worth_it * cost(small_layer);
  for (const Axes &axes : candidates(lattice)) {
    RowLayout other(lattice, lower, upper, axes);
    if (const double cost = other.cost(small_layer); cost < least) {
      least = cost;
      *this = std::move(other);
    }
  }
}

template class RowLayout<2>;
template class RowLayout<3>;
} // namespace ligament::packings
