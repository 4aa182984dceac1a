#include "packings/solid_piece.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

namespace ligament::packings
{
namespace
{
/// Where a cut ended an edge, or where what is left of one begins.
struct End
{
  int vertex, sign; // 1: ended, -1: begins
  double place;     // along the line on which all of them lie
};

/// Calls add(from, to) for edges on a line that lead from ends to beginnings, none where there is
/// nothing to close.
template <int dim, typename Add>
void close(const std::vector<Vector<dim>> &vertices, std::vector<End> &ends, Add &&add)
{
  if (ends.empty())
    return;
  const Vector<dim> &origin = vertices[ends[0].vertex];
  Vector<dim> along = Vector<dim>::Zero();
  for (const End &end : ends)
    if (const Vector<dim> way = vertices[end.vertex] - origin; way.norm() > along.norm())
      along = way;
  for (End &end : ends)
    end.place = along.dot(vertices[end.vertex] - origin);
  std::sort(ends.begin(), ends.end(), [](const End &a, const End &b) { return a.place < b.place; });
  int open = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    open += ends[k].sign;
    const int a = ends[k].vertex, b = ends[k + 1].vertex;
    for (int n = 0; n < std::abs(open) && a != b; ++n)
      open > 0 ? add(a, b) : add(b, a);
  }
}
} // namespace

template <int dim>
SolidPiece<dim>::SolidPiece(const core::Solid<dim> &solid, int first) : vertices_(solid.vertices())
{
  for (int f = 0; f < int(solid.facets().size()); ++f)
    faces_.push_back({first - f, solid.normal(f), solid.facets()[f].edges});
}

// One vertex per cut edge, whichever face asks first, and one verdict per vertex: so every face
// stays closed, and the edges that close the faces close the cap. In 2D the cap's edges close the
// outline itself.
template <int dim>
void SolidPiece<dim>::clip(const Vector<dim> &normal, double distance, int id, double tolerance)
{
  const int n = int(vertices_.size());
  std::vector<double> excess(n);
  std::vector<int> new_index(n);
  int n_inside = 0;
  for (int v = 0; v < n; ++v) {
    excess[v] = normal.dot(vertices_[v]) - distance;
    new_index[v] = excess[v] > tolerance ? -1 : n_inside++;
  }
  if (n_inside == n)
    return;
  std::vector<Vector<dim>> vertices(n_inside);
  for (int v = 0; v < n; ++v)
    if (new_index[v] >= 0)
      vertices[new_index[v]] = vertices_[v];

  std::map<Edge, int> cuts; // inside, outside
  const auto cut_vertex = [&](int inside, int outside) {
    const auto [cut, is_new] = cuts.insert({{inside, outside}, int(vertices.size())});
    if (is_new) {
      const double a = std::max(0., -excess[inside]), b = excess[outside];
      vertices.push_back((b * vertices_[inside] + a * vertices_[outside]) / (a + b));
    }
    return cut->second;
  };
  Bag cap{id, normal, {}};
  std::vector<Bag> faces;
  std::vector<End> ends;
  for (const Bag &old : faces_) {
    Bag bag{old.id, old.normal, {}};
    for (const auto &[a, b] : old.edges) {
      const int from = new_index[a], to = new_index[b];
      if (from < 0 && to < 0)
        continue;
      if (from >= 0 && to >= 0) {
        bag.edges.push_back({from, to});
        continue;
      }
      const int cut = from >= 0 ? cut_vertex(a, b) : cut_vertex(b, a);
      bag.edges.push_back(from >= 0 ? Edge{from, cut} : Edge{cut, to});
      ends.push_back({cut, from >= 0 ? 1 : -1, 0});
    }
    if constexpr (dim == 3) {
      close(vertices, ends, [&](int a, int b) {
        bag.edges.push_back({a, b});
        cap.edges.push_back({b, a});
      });
      ends.clear();
    }
    if (!bag.edges.empty())
      faces.push_back(std::move(bag));
  }
  if constexpr (dim == 2)
    close(vertices, ends, [&](int a, int b) { cap.edges.push_back({a, b}); });
  if (!cap.edges.empty())
    faces.push_back(std::move(cap));
  faces_ = std::move(faces);
  vertices_ = std::move(vertices);
}

template <int dim>
void SolidPiece<dim>::shift(const Vector<dim> &x)
{
  for (Vector<dim> &v : vertices_)
    v += x;
}

template <int dim>
auto SolidPiece<dim>::faces() const -> std::vector<Face>
{
  std::vector<Face> faces;
  for (const Bag &bag : faces_) {
    const Vector<dim> &origin = vertices_[bag.edges[0][0]], &n = bag.normal;
    Face face{bag.id, n, n.dot(origin), 0, Vector<dim>::Zero()};
    for (const auto &[from, to] : bag.edges) {
      const Vector<dim> a = vertices_[from] - origin, b = vertices_[to] - origin;
      if constexpr (dim == 2) {
        const double length = n[0] * (b - a)[1] - n[1] * (b - a)[0];
        face.area += length;
        face.moment += length / 2 * (a + b);
      } else {
        const double area = n.dot(a.cross(b)) / 2;
        face.area += area;
        face.moment += area / 3 * (a + b);
      }
    }
    face.moment += face.area * origin;
    faces.push_back(face);
  }
  return faces;
}

template <int dim>
std::vector<Vector<dim>> SolidPiece<dim>::corners(std::size_t k) const
{
  const std::vector<Edge> &edges = faces_[k].edges;
  std::map<int, int> next;
  for (const auto &[from, to] : edges)
    if (!next.emplace(from, to).second)
      return {};
  std::vector<Vector<dim>> corners;
  int at = edges[0][0];
  do {
    corners.push_back(vertices_[at]);
    const auto found = next.find(at);
    if (found == next.end())
      return {};
    at = found->second;
  } while (at != edges[0][0] && corners.size() < edges.size());
  return at == edges[0][0] && corners.size() == edges.size() ? corners : std::vector<Vector<dim>>();
}

template <int dim>
SolidPieces<dim>::SolidPieces(const core::Solid<dim> &solid, int first_id, double reach)
    : bin_(reach), lower_(solid.lower())
{
  const Vector<dim> size = solid.upper() - solid.lower();
  bin_ = std::max(bin_, size.maxCoeff() / (dim == 2 ? 1000 : 60));
  std::size_t n = 1;
  for (int a = 0; a < dim; ++a) {
    n_bins_[a] = std::max(1, int(std::ceil(size[a] / bin_)));
    n *= n_bins_[a];
  }
  piece_.resize(n);
  const Vector<dim> margin = Vector<dim>::Constant(reach);
  const double tolerance = 1e-13 * reach;
  // Slabs first, then what of them is needed: a facet is cut few times.
  const auto cut = [&](SolidPiece<dim> piece, int axis, int k) {
    const Vector<dim> n = Vector<dim>::Unit(axis);
    const double from = lower_[axis] + bin_ * k - reach, to = from + bin_ + 2 * reach;
    piece.clip(n, to, border_of_piece, tolerance);
    piece.clip(-n, -from, border_of_piece, tolerance);
    return piece;
  };
  const SolidPiece<dim> whole(solid, first_id);
  std::size_t bin = 0;
  for (int z = 0; z < (dim == 3 ? n_bins_[dim - 1] : 1); ++z) {
    const SolidPiece<dim> slab = dim == 3 ? cut(whole, dim - 1, z) : whole;
    for (int y = 0; y < n_bins_[1]; ++y) {
      const SolidPiece<dim> bar = cut(slab, 1, y);
      for (int x = 0; x < n_bins_[0]; ++x, ++bin) {
        Vector<dim> corner = lower_ + bin_ * Vector<dim>::Unit(0) * x;
        corner[1] += bin_ * y;
        if (dim == 3)
          corner[dim - 1] += bin_ * z;
        bool is_near = false;
        solid.for_each_near(corner - margin, corner + Vector<dim>::Constant(bin_) + margin,
                            [&](int) { is_near = true; });
        if (is_near)
          piece_[bin] = cut(bar, 0, x);
      }
    }
  }
}

template <int dim>
auto SolidPieces<dim>::bin_of(const Vector<dim> &x) const -> Index
{
  Index k;
  for (int a = 0; a < dim; ++a)
    k[a] = int(std::clamp(std::floor((x[a] - lower_[a]) / bin_), 0., n_bins_[a] - 1.));
  return k;
}

template <int dim>
SolidPiece<dim> SolidPieces<dim>::around(const Vector<dim> &x) const
{
  const Index k = bin_of(x);
  std::size_t bin = dim == 3 ? k[dim - 1] : 0;
  bin = (bin * n_bins_[1] + k[1]) * n_bins_[0] + k[0];
  SolidPiece<dim> piece = piece_[bin];
  piece.shift(-x);
  return piece;
}

template class SolidPiece<2>;
template class SolidPiece<3>;
template class SolidPieces<2>;
template class SolidPieces<3>;
} // namespace ligament::packings
