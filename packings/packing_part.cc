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

template <typename T>
void keep(std::vector<T> &values, const std::vector<int> &places)
{
  if (values.empty())
    return;
  std::vector<T> kept;
  kept.reserve(places.size());
  for (const int i : places)
    kept.push_back(values[i]);
  values = std::move(kept);
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
                         int rings)
{
  core::require(partition.cuts.back() == whole.size(),
                "the partition is one of another number of particles");
  core::require(rings >= 2, "a rank sees at least two rings around its particles");
  const std::vector<int> distance =
      faces_to(whole, int(partition.begin(rank)), int(partition.end(rank)), rings);
  PackingPart<dim> held;
  std::vector<int> here(whole.size(), -1);
  for (int i = 0; i < whole.size(); ++i)
    if (distance[i] != far) {
      here[i] = int(held.place.size());
      held.place.push_back(i);
      held.owner.push_back(partition.owner(i));
    }
  const auto within = [&](int most) {
    particles::ParticleRanges ranges;
    for (std::size_t k = 0; k < held.place.size(); ++k) {
      const int i = int(k);
      if (distance[held.place[k]] > most)
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
  p = whole;
  p.whole = WholeSizes{mean_face_area(whole), largest_diameter(whole)};
  for (auto &component : p.centre)
    keep(component, held.place);
  keep(p.volume, held.place);
  keep(p.diameter, held.place);
  keep(p.material, held.place);
  keep(p.global_id, held.place);
  p.row_begin = rows_of(whole, held.place);
  p.faces.clear();
  for (Face<dim> face : whole.faces) {
    face.i = here[face.i];
    face.j = here[face.j];
    if (face.i >= 0 && face.j >= 0)
      p.faces.push_back(face);
  }
  p.boundary_faces.clear();
  for (BoundaryFace<dim> face : whole.boundary_faces) {
    face.i = here[face.i];
    if (face.i >= 0)
      p.boundary_faces.push_back(face);
  }
  return held;
}

template PackingPart<2> part_of(const Packing<2> &, const particles::Partition &, int, int);
template PackingPart<3> part_of(const Packing<3> &, const particles::Partition &, int, int);
} // namespace ligament::packings
