#include "packings/packing_part.h"

#include "core/check.h"

#include <algorithm>
#include <limits>

namespace ligament::packings
{
namespace
{
constexpr int far = std::numeric_limits<int>::max();

/// Faces from the particles of a rank to each of the whole, as far as the rings reach; else far.
template <int dim>
std::vector<int> faces_to(const Packing<dim> &whole, int begin, int end, int rings)
{
  std::vector<int> distance(whole.size(), far);
  std::fill(distance.begin() + begin, distance.begin() + end, 0);
  for (int ring = 1; ring <= rings; ++ring)
    for (const auto &face : whole.faces)
      for (const auto &[from, to] : {std::pair(face.i, face.j), std::pair(face.j, face.i)})
        if (distance[from] == ring - 1)
          distance[to] = std::min(distance[to], ring);
  return distance;
}

/// Empty stays empty.
template <typename T>
std::vector<T> those_at(const std::vector<int> &places, const std::vector<T> &values)
{
  std::vector<T> those;
  if (values.empty())
    return those;
  those.reserve(places.size());
  for (const int i : places)
    those.push_back(values[i]);
  return those;
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
PackingPart<dim> part_of(const Packing<dim> &whole, const particles::Partition &partition, int rank,
                         int rings, std::int64_t first)
{
  core::require(partition.end(rank) <= first + whole.size() &&
                    (first > 0 || partition.cuts.back() >= whole.size()),
                "the partition is one of another number of particles");
  core::require(rings >= 2, "a rank sees at least two rings around its particles");
  const std::vector<int> distance =
      faces_to(whole, int(partition.begin(rank) - first), int(partition.end(rank) - first), rings);
  PackingPart<dim> held;
  held.n_whole = partition.cuts.back();
  std::vector<int> here(whole.size(), -1), kept; // where a particle is held; which ones are
  for (int i = 0; i < whole.size(); ++i)
    if (distance[i] != far) {
      here[i] = int(kept.size());
      kept.push_back(i);
      held.place.push_back(int(first + i));
      held.owner.push_back(partition.owner(first + i));
    }
  const auto within = [&](int most) {
    particles::ParticleRanges ranges;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const int i = int(k);
      if (distance[kept[k]] > most)
        continue;
      if (!ranges.empty() && ranges.back().end == i)
        ++ranges.back().end;
      else
        ranges.push_back({i, i + 1});
    }
    return ranges;
  };
  held.part.owned = held.part.stepped = within(0);
  held.part.pressed = within(rings - 1);
  held.part.turned = within(rings);

  Packing<dim> &p = held.packing;
  p.spacing = whole.spacing;
  p.thickness = whole.thickness;
  p.period = whole.period;
  p.directions = whole.directions;
  p.cuts = whole.cuts;
  p.whole = WholeSizes{mean_face_area(whole), largest_diameter(whole)};
  for (int c = 0; c < dim; ++c)
    p.centre[c] = those_at(kept, whole.centre[c]);
  p.volume = those_at(kept, whole.volume);
  p.diameter = those_at(kept, whole.diameter);
  p.material = those_at(kept, whole.material);
  p.global_id = those_at(kept, whole.global_id);
  p.row_begin = rows_of(whole, kept);
  for (Face<dim> face : whole.faces) {
    face.i = here[face.i];
    face.j = here[face.j];
    if (face.i >= 0 && face.j >= 0)
      p.faces.push_back(face);
  }
  for (BoundaryFace<dim> face : whole.boundary_faces) {
    face.i = here[face.i];
    if (face.i >= 0)
      p.boundary_faces.push_back(face);
  }
  return held;
}

template PackingPart<2> part_of(const Packing<2> &, const particles::Partition &, int, int,
                                std::int64_t);
template PackingPart<3> part_of(const Packing<3> &, const particles::Partition &, int, int,
                                std::int64_t);
} // namespace ligament::packings
