#include "packings/packing_part.h"

#include "core/check.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_set>

namespace ligament::packings
{
namespace
{
constexpr int far = std::numeric_limits<int>::max();

/// Distances are 0 at some particles and far at the others: makes them the number of faces between,
/// as far as the rings reach.
template <int dim>
void grow_rings(const Packing<dim> &whole, int rings, std::vector<int> &distance)
{
  for (int ring = 1; ring <= rings; ++ring)
    for (const auto &face : whole.faces)
      for (const auto &[from, to] : {std::pair(face.i, face.j), std::pair(face.j, face.i)})
        if (distance[from] == ring - 1)
          distance[to] = std::min(distance[to], ring);
}

/// 0: stepped by whoever owns [begin, end); else far.
template <int dim>
std::vector<int> stepped_with(const Packing<dim> &whole, int begin, int end,
                              const Groups<dim> &groups)
{
  std::vector<int> distance(whole.size(), far);
  std::fill(distance.begin() + begin, distance.begin() + end, 0);
  if (!groups.of || begin == end)
    return distance;
  std::unordered_set<int> own;
  for (int i = begin; i < end; ++i)
    if (const int group = groups.of(get(whole.centre, i)); group >= 0)
      own.insert(group);
  for (int i = 0; i < whole.size(); ++i)
    if (distance[i] == far && own.count(groups.of(get(whole.centre, i))) > 0)
      distance[i] = 0;
  return distance;
}

std::vector<int> places_within_reach(const std::vector<int> &distance)
{
  std::vector<int> places;
  for (std::size_t i = 0; i < distance.size(); ++i)
    if (distance[i] != far)
      places.push_back(int(i));
  return places;
}

/// Gives memory back unless that takes more of it for a while than was wasted.
template <typename T>
void cut_off(std::size_t size, std::vector<T> &values)
{
  values.erase(values.begin() + std::ptrdiff_t(size), values.end());
  if (size < values.capacity() / 2)
    values.shrink_to_fit();
}

/// Empty stays empty.
template <typename T>
void thin(const std::vector<int> &places, std::vector<T> &values)
{
  if (values.empty())
    return;
  for (std::size_t k = 0; k < places.size(); ++k)
    values[k] = values[places[k]];
  cut_off(places.size(), values);
}

/// Keeps the faces for which rename() finds all their particles.
template <typename SomeFace, typename Rename>
void thin_faces(std::vector<SomeFace> &faces, Rename &&rename)
{
  std::size_t n = 0;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    if (!rename(faces[k]))
      continue;
    if (n < k)
      faces[n] = std::move(faces[k]);
    ++n;
  }
  cut_off(n, faces);
}

/// Runs of held particles that hang together in the whole, too.
template <int dim>
std::vector<int> rows_of(const Packing<dim> &whole, const std::vector<int> &places)
{
  std::vector<int> begin;
  if (whole.row_begin.empty())
    return begin;
  std::size_t row = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t before = row;
    while (whole.row_begin[row + 1] <= places[i])
      ++row;
    if (i == 0 || row != before || places[i] != places[i - 1] + 1)
      begin.push_back(int(i));
  }
  begin.push_back(int(places.size()));
  return begin;
}
} // namespace

template <int dim>
Packing<dim> those_at(const std::vector<int> &places, Packing<dim> whole)
{
  whole.whole = WholeSizes{mean_face_area(whole), largest_diameter(whole)};
  whole.row_begin = rows_of(whole, places);
  std::vector<int> here(whole.size(), -1); // where a particle is kept
  for (std::size_t k = 0; k < places.size(); ++k)
    here[places[k]] = int(k);
  for (auto &component : whole.centre)
    thin(places, component);
  thin(places, whole.volume);
  thin(places, whole.diameter);
  thin(places, whole.material);
  thin(places, whole.global_id);
  thin_faces(whole.faces, [&](Face<dim> &face) {
    face.i = here[face.i];
    face.j = here[face.j];
    return face.i >= 0 && face.j >= 0;
  });
  thin_faces(whole.boundary_faces, [&](BoundaryFace<dim> &face) {
    face.i = here[face.i];
    return face.i >= 0;
  });
  return whole;
}

template <int dim>
PackingPart<dim> part_of(Packing<dim> piece, const std::vector<int> &places,
                         const particles::Partition &partition, int rank, int rings,
                         const Groups<dim> &groups)
{
  core::require(rings >= 2, "a rank sees at least two rings around its particles");
  const auto number_of = [&](std::int64_t place) {
    return int(std::lower_bound(places.begin(), places.end(), place) - places.begin());
  };
  const int begin = number_of(partition.begin(rank)), end = number_of(partition.end(rank));
  core::require(int(places.size()) == piece.size() &&
                    end - begin == partition.end(rank) - partition.begin(rank),
                "the partition is one of another number of particles");
  std::vector<int> distance = stepped_with(piece, begin, end, groups);
  grow_rings(piece, rings, distance);
  const std::vector<int> kept = places_within_reach(distance);
  const auto where = [&](auto &&is_in) {
    particles::ParticleRanges ranges;
    for (int k = 0; k < int(kept.size()); ++k) {
      if (!is_in(kept[k]))
        continue;
      if (!ranges.empty() && ranges.back().end == k)
        ++ranges.back().end;
      else
        ranges.push_back({k, k + 1});
    }
    return ranges;
  };
  const auto within = [&](int most) { return where([&](int i) { return distance[i] <= most; }); };
  PackingPart<dim> held;
  held.n_whole = partition.cuts.back();
  held.part.owned = where([&](int i) { return begin <= i && i < end; });
  held.part.stepped = within(0);
  held.part.pressed = within(rings - 1);
  held.part.turned = within(rings);
  held.owner.reserve(kept.size());
  held.place.reserve(kept.size());
  for (const int i : kept) {
    held.place.push_back(places[i]);
    held.owner.push_back(partition.owner(places[i]));
  }
  held.packing = those_at(kept, std::move(piece));
  return held;
}

template <int dim>
PackingPart<dim> part_of(Packing<dim> whole, const particles::Partition &partition, int rank,
                         int rings, std::int64_t first, const Groups<dim> &groups)
{
  core::require(first > 0 || partition.cuts.back() >= whole.size(),
                "the partition is one of another number of particles");
  std::vector<int> places(whole.size());
  std::iota(places.begin(), places.end(), int(first));
  return part_of(std::move(whole), places, partition, rank, rings, groups);
}

template <int dim>
std::vector<int> grouped_places(const Packing<dim> &whole, const Groups<dim> &groups, int rings)
{
  core::require(rings >= 0, "rings around groups are not below 0");
  std::vector<int> distance(whole.size(), far);
  for (int i = 0; i < whole.size() && groups.of; ++i)
    if (groups.of(get(whole.centre, i)) >= 0)
      distance[i] = 0;
  grow_rings(whole, rings, distance);
  return places_within_reach(distance);
}

template <int dim>
Packing<dim> grouped_part(Packing<dim> whole, const Groups<dim> &groups, int rings)
{
  const std::vector<int> places = grouped_places(whole, groups, rings);
  return those_at(places, std::move(whole));
}

template PackingPart<2> part_of(Packing<2>, const std::vector<int> &, const particles::Partition &,
                                int, int, const Groups<2> &);
template PackingPart<3> part_of(Packing<3>, const std::vector<int> &, const particles::Partition &,
                                int, int, const Groups<3> &);
template PackingPart<2> part_of(Packing<2>, const particles::Partition &, int, int, std::int64_t,
                                const Groups<2> &);
template PackingPart<3> part_of(Packing<3>, const particles::Partition &, int, int, std::int64_t,
                                const Groups<3> &);
template Packing<2> grouped_part(Packing<2>, const Groups<2> &, int);
template Packing<3> grouped_part(Packing<3>, const Groups<3> &, int);
template std::vector<int> grouped_places(const Packing<2> &, const Groups<2> &, int);
template std::vector<int> grouped_places(const Packing<3> &, const Groups<3> &, int);
template Packing<2> those_at(const std::vector<int> &, Packing<2>);
template Packing<3> those_at(const std::vector<int> &, Packing<3>);
} // namespace ligament::packings
