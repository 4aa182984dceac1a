#include "packings/gathered_part.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::packings
{
namespace
{
template <int n>
std::array<double, n> numbers(const Eigen::Matrix<double, n, 1> &v)
{
  std::array<double, n> values;
  std::copy(v.data(), v.data() + n, values.begin());
  return values;
}

template <std::size_t n>
Eigen::Matrix<double, int(n), 1> vector_of(const std::array<double, n> &values)
{
  return Eigen::Map<const Eigen::Matrix<double, int(n), 1>>(values.data());
}

/// As messages bear it.
template <int dim>
struct ToldFace
{
  int i, j, direction, cut;
  std::array<double, dim> normal, lever_i, lever_j;
  double area, q_i, q_j;
  std::array<int, dim> image;
  bool cracked;
};

template <int dim>
struct ToldBoundary
{
  int i, boundary;
  std::int64_t n_corners;
  std::array<double, dim> normal, lever;
  double area, q;
};

/// Gathers a list that not all packings have.
template <typename T>
std::vector<T> gathered(const std::vector<T> &values, const std::vector<int> &kept,
                        const core::Ranks &ranks)
{
  std::vector<T> own;
  for (const int i : kept)
    if (!values.empty())
      own.push_back(values[i]);
  return ranks.gather_all(own);
}

template <int dim, typename NumberOf>
void gather_faces(const Packing<dim> &from, NumberOf &&number_of, const core::Ranks &ranks,
                  Packing<dim> &to)
{
  std::vector<ToldFace<dim>> told;
  for (const Face<dim> &f : from.faces)
    if (const auto [i, j] = std::pair(number_of(f.i, true), number_of(f.j, false));
        i >= 0 && j >= 0)
      told.push_back({i, j, f.direction, f.cut, numbers<dim>(f.normal), numbers<dim>(f.lever_i),
                      numbers<dim>(f.lever_j), f.area, f.q_i, f.q_j, f.image, f.cracked});
  for (const ToldFace<dim> &f : ranks.gather_all(told))
    to.faces.push_back({f.i, f.j, vector_of(f.normal), f.area, f.q_i, f.q_j, vector_of(f.lever_i),
                        vector_of(f.lever_j), f.direction, f.cracked, f.cut, f.image});
}

template <int dim, typename NumberOf>
void gather_boundary(const Packing<dim> &from, NumberOf &&number_of, const core::Ranks &ranks,
                     Packing<dim> &to)
{
  std::vector<ToldBoundary<dim>> told;
  std::vector<std::array<double, dim>> corners;
  for (const BoundaryFace<dim> &f : from.boundary_faces)
    if (const int i = number_of(f.i, true); i >= 0) {
      told.push_back({i, f.boundary, std::int64_t(f.corners.size()), numbers<dim>(f.normal),
                      numbers<dim>(f.lever), f.area, f.q});
      for (const Vector<dim> &corner : f.corners)
        corners.push_back(numbers<dim>(corner));
    }
  corners = ranks.gather_all(corners);
  auto corner = corners.begin();
  for (const ToldBoundary<dim> &f : ranks.gather_all(told)) {
    to.boundary_faces.push_back(
        {f.i, vector_of(f.normal), f.area, f.q, vector_of(f.lever), f.boundary});
    for (std::int64_t k = 0; k < f.n_corners; ++k)
      to.boundary_faces.back().corners.push_back(vector_of(*corner++));
  }
}
} // namespace

// A way over `rings` faces from what a rank owns stays in what it holds; what a ghost is near, its
// owner says.
template <int dim>
Packing<dim> gather_grouped(const PackingPart<dim> &held, const Groups<dim> &groups, int rings,
                            const core::Ranks &ranks)
{
  const Packing<dim> &from = held.packing;
  core::require(from.row_begin.empty(), "rows are packed by windows");
  std::vector<int> kept, places;
  for (const int i : grouped_places(from, groups, rings))
    if (held.part.owns(i)) {
      kept.push_back(i);
      places.push_back(held.place[i]);
    }
  places = ranks.gather_all(places);
  Packing<dim> to;
  to.spacing = from.spacing;
  to.thickness = from.thickness;
  to.period = from.period;
  to.cuts = from.cuts;
  to.whole = WholeSizes{mean_face_area(from), largest_diameter(from)};
  for (int a = 0; a < dim; ++a)
    to.centre[a] = gathered(from.centre[a], kept, ranks);
  to.volume = gathered(from.volume, kept, ranks);
  to.diameter = gathered(from.diameter, kept, ranks);
  to.material = gathered(from.material, kept, ranks);
  to.global_id = gathered(from.global_id, kept, ranks);
  const auto number_of = [&](int i, bool must_be_own) {
    if (must_be_own && !held.part.owns(i))
      return -1;
    const auto found = std::lower_bound(places.begin(), places.end(), held.place[i]);
    return found != places.end() && *found == held.place[i] ? int(found - places.begin()) : -1;
  };
  gather_faces(from, number_of, ranks, to);
  gather_boundary(from, number_of, ranks, to);
  return to;
}

template Packing<2> gather_grouped(const PackingPart<2> &, const Groups<2> &, int,
                                   const core::Ranks &);
template Packing<3> gather_grouped(const PackingPart<3> &, const Groups<3> &, int,
                                   const core::Ranks &);
} // namespace ligament::packings
