#include "packings/voronoi_cell.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace ligament::packings
{
template <int dim>
VoronoiCell<dim>::VoronoiCell(double half_width, int id, double tolerance) : tolerance_(tolerance)
{
  const int n_corners = 1 << dim;
  for (int corner = 0; corner < n_corners; ++corner) {
    Vector<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = (corner >> a & 1) ? half_width : -half_width;
    vertices_.push_back(x);
  }
  for (int a = 0; a < dim; ++a)
    for (int side = 0; side < 2; ++side) {
      Vector<dim> normal = Vector<dim>::Zero();
      normal[a] = side ? 1 : -1;
      // The other axes in cyclic order turn counter-clockwise about +a.
      const int b = 1 << (a + 1) % dim, c = dim == 3 ? 1 << (a + 2) % dim : 0;
      const int base = side << a;
      std::vector<int> loop = dim == 3 ? std::vector<int>{base, base | b, base | b | c, base | c}
                                       : std::vector<int>{base, base | b};
      if ((side == 0) != (dim == 2 && a == 1))
        std::reverse(loop.begin(), loop.end());
      planes_.push_back({id, normal, half_width, loop});
    }
  update_radius();
}

template <int dim>
void VoronoiCell<dim>::update_radius()
{
  double square = 0;
  for (const Vector<dim> &x : vertices_)
    square = std::max(square, x.squaredNorm());
  max_radius_ = std::sqrt(square);
}

template <int dim>
bool VoronoiCell<dim>::is_cut_by(const Vector<dim> &normal, double distance) const
{
  for (const Vector<dim> &x : vertices_)
    if (normal.dot(x) > distance + tolerance_)
      return true;
  return false;
}

template <int dim>
void VoronoiCell<dim>::clip(const Vector<dim> &normal, double distance, int id)
{
  const int n = int(vertices_.size());
  excess_.resize(n);
  new_index_.resize(n);
  int n_inside = 0;
  for (int v = 0; v < n; ++v) {
    excess_[v] = normal.dot(vertices_[v]) - distance;
    new_index_[v] = excess_[v] > tolerance_ ? -1 : n_inside++;
  }
  if (n_inside == n)
    return;
  if (n_inside == 0) {
    vertices_.clear();
    planes_.clear();
    max_radius_ = 0;
    return;
  }

  // One new vertex per cut edge, whichever face asks first: both faces share it, and the surface
  // stays closed whatever the round-off.
  cuts_.clear();
  const auto cut_vertex = [&](int inside, int outside) {
    for (const Cut &cut : cuts_)
      if (cut.inside == inside && cut.outside == outside)
        return cut.vertex;
    const int vertex = n_inside + int(cuts_.size());
    cuts_.push_back({inside, outside, vertex});
    return vertex;
  };

  // Every face that loses a part gains an edge exit -> entry; the new face runs it backwards.
  next_on_cap_.clear();
  const auto link_on_cap = [&](int from, int to) {
    const int k = from - n_inside;
    if (k >= int(next_on_cap_.size()))
      next_on_cap_.resize(k + 1, -1);
    next_on_cap_[k] = to;
  };
  std::size_t n_planes = 0;
  int cap_start = -1, cap_end = -1; // 2D
  for (std::size_t p = 0; p < planes_.size(); ++p) {
    std::vector<int> loop;
    const std::vector<int> &old = planes_[p].loop;
    if constexpr (dim == 2) {
      const int a = old[0], b = old[1], na = new_index_[a], nb = new_index_[b];
      if (na < 0 && nb < 0)
        continue;
      if (nb < 0)
        loop = {na, cap_start = cut_vertex(a, b)};
      else if (na < 0)
        loop = {cap_end = cut_vertex(b, a), nb};
      else
        loop = {na, nb};
    } else {
      const std::size_t m = old.size();
      int exit = -1, first_entry = -1;
      for (std::size_t k = 0; k < m; ++k) {
        const int a = old[k], b = old[k + 1 == m ? 0 : k + 1];
        const int na = new_index_[a], nb = new_index_[b];
        if (na >= 0)
          loop.push_back(na);
        if (na >= 0 && nb < 0)
          loop.push_back(exit = cut_vertex(a, b));
        else if (na < 0 && nb >= 0) {
          const int entry = cut_vertex(b, a);
          loop.push_back(entry);
          if (exit >= 0)
            link_on_cap(entry, exit);
          else
            first_entry = entry;
          exit = -1;
        }
      }
      if (first_entry >= 0)
        link_on_cap(first_entry, exit);
      if (loop.empty())
        continue;
    }
    planes_[p].loop = std::move(loop);
    if (n_planes != p)
      planes_[n_planes] = std::move(planes_[p]);
    ++n_planes;
  }
  planes_.resize(n_planes);

  if constexpr (dim == 2)
    planes_.push_back({id, normal, distance, {cap_start, cap_end}});
  else
    for (std::size_t start = 0; start < next_on_cap_.size(); ++start)
      if (next_on_cap_[start] >= 0) {
        std::vector<int> loop;
        for (int k = int(start); next_on_cap_[k] >= 0;) {
          loop.push_back(n_inside + k);
          k = std::exchange(next_on_cap_[k], -1) - n_inside;
        }
        planes_.push_back({id, normal, distance, std::move(loop)});
      }

  std::vector<Vector<dim>> vertices(n_inside + cuts_.size());
  for (int v = 0; v < n; ++v)
    if (new_index_[v] >= 0)
      vertices[new_index_[v]] = vertices_[v];
  for (const Cut &cut : cuts_) {
    const double a = std::max(0., -excess_[cut.inside]), b = excess_[cut.outside];
    vertices[cut.vertex] = (b * vertices_[cut.inside] + a * vertices_[cut.outside]) / (a + b);
  }
  vertices_ = std::move(vertices);
  update_radius();
}

template <int dim>
auto VoronoiCell<dim>::faces() const -> std::vector<Face>
{
  std::vector<Face> faces;
  faces.reserve(planes_.size());
  for (const Plane &plane : planes_) {
    Face face{plane.id, plane.normal, plane.distance, 0, vertices_[plane.loop[0]]};
    const Vector<dim> &origin = vertices_[plane.loop[0]];
    if constexpr (dim == 2) {
      const Vector<dim> edge = vertices_[plane.loop[1]] - origin;
      face.area = edge.norm();
      face.centroid = origin + edge / 2;
    } else {
      Vector<dim> moment = Vector<dim>::Zero();
      for (std::size_t k = 2; k < plane.loop.size(); ++k) {
        const Vector<dim> a = vertices_[plane.loop[k - 1]] - origin;
        const Vector<dim> b = vertices_[plane.loop[k]] - origin;
        const double area = plane.normal.dot(a.cross(b)) / 2;
        face.area += area;
        moment += area * (a + b) / 3;
      }
      if (face.area > 0)
        face.centroid += moment / face.area;
    }
    faces.push_back(face);
  }
  return faces;
}

template <int dim>
std::vector<Vector<dim>> VoronoiCell<dim>::corners(std::size_t k) const
{
  std::vector<Vector<dim>> corners;
  for (const int v : planes_[k].loop)
    corners.push_back(vertices_[v]);
  return corners;
}

template <int dim>
double VoronoiCell<dim>::volume() const
{
  double sum = 0;
  for (const Face &face : faces())
    sum += face.area * face.distance;
  return sum / dim;
}

template <int dim>
Vector<dim> VoronoiCell<dim>::moment() const
{
  // Pyramids from the origin over the faces.
  Vector<dim> sum = Vector<dim>::Zero();
  for (const Face &face : faces())
    sum += face.area * face.distance / (dim + 1) * face.centroid;
  return sum;
}

template class VoronoiCell<2>;
template class VoronoiCell<3>;
} // namespace ligament::packings
