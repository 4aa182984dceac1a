#include "packings/random_part.h"

#include "core/check.h"
#include "packings/periodic_sides.h"
#include "packings/rank_share.h"
#include "packings/seed_packer.h"

#include <algorithm>
#include <unordered_set>

namespace ligament::packings
{
namespace
{
template <int dim>
class PartMaker
{
public:
  PartMaker(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds, const core::Ranks &ranks,
            const Groups<dim> &groups)
      : ranks_(ranks), groups_(groups), packer_(specimen, std::move(seeds), ranks),
        seed_of_(seeds_with_particle())
  {
    core::require(!seed_of_.empty(), no_whole_particle);
  }

  RandomPart<dim> make(int rings, const std::vector<std::int64_t> &weights);

private:
  std::vector<int> seeds_with_particle() const;
  std::vector<int> stepped(const particles::Partition &partition) const;
  void cut_around(std::vector<int> ring, int rings);
  WholeSizes sizes_of_whole(const Packing<dim> &window, const std::vector<int> &places,
                            const particles::Partition &partition) const;
  Seeds<dim> met_seeds() const;

  int n_seeds() const { return packer_.seeds().size(); }
  bool is_particle(int seed) const
  {
    return std::binary_search(seed_of_.begin(), seed_of_.end(), seed);
  }

  const core::Ranks &ranks_;
  const Groups<dim> &groups_;
  SeedPacker<dim> packer_;
  const std::vector<int> seed_of_; // of the particles of the whole
};

/// Near the zone's sides this takes the cells: each rank cuts some of them.
template <int dim>
std::vector<int> PartMaker<dim>::seeds_with_particle() const
{
  using InZone = typename SeedPacker<dim>::InZone;
  std::vector<int> found, doubtful;
  for (int i = 0; i < n_seeds(); ++i) {
    const InZone place = packer_.place_in_zone(i);
    if (place == InZone::yes)
      found.push_back(i);
    else if (place == InZone::maybe)
      doubtful.push_back(i);
  }
  const auto [first, last] = share_of(doubtful.size(), ranks_);
  std::vector<int> have_one;
  for (std::size_t k = first; k < last; ++k)
    if (packer_.has_particle(doubtful[k]))
      have_one.push_back(doubtful[k]);
  have_one = ranks_.gather_all(have_one);
  const auto middle = std::ptrdiff_t(found.size());
  found.insert(found.end(), have_one.begin(), have_one.end());
  std::inplace_merge(found.begin(), found.begin() + middle, found.end());
  return found;
}

/// Seeds of the particles that this rank steps.
template <int dim>
std::vector<int> PartMaker<dim>::stepped(const particles::Partition &partition) const
{
  const auto begin = std::size_t(partition.begin(ranks_.rank())),
             end = std::size_t(partition.end(ranks_.rank()));
  const auto group_of = [&](std::size_t k) {
    return groups_.of(packer_.seeds().centre[seed_of_[k]]);
  };
  std::unordered_set<int> own;
  for (std::size_t k = begin; k < end && groups_.of; ++k)
    if (const int group = group_of(k); group >= 0)
      own.insert(group);
  std::vector<int> seeds;
  for (std::size_t k = 0; k < seed_of_.size(); ++k)
    if ((begin <= k && k < end) || (!own.empty() && own.count(group_of(k)) > 0))
      seeds.push_back(seed_of_[k]);
  return seeds;
}

// A neighbour before a cell makes the face between them, and by round-off might find a sliver that
// the cell itself does not have: such a one is a neighbour of its neighbours, so that one ring more
// has it.
template <int dim>
void PartMaker<dim>::cut_around(std::vector<int> ring, int rings)
{
  std::vector<char> is_cut(n_seeds(), 0);
  for (int k = 0; k <= rings + 1; ++k) {
    packer_.cut(ring);
    for (const int i : ring)
      is_cut[i] = 1;
    ring.clear();
    for (int i = 0; i < n_seeds(); ++i)
      if (packer_.is_met(i) && !is_cut[i] && is_particle(i))
        ring.push_back(i);
  }
}

/// All that a face is the first particle of are at hand with whoever owns it.
template <int dim>
WholeSizes PartMaker<dim>::sizes_of_whole(const Packing<dim> &window,
                                          const std::vector<int> &places,
                                          const particles::Partition &partition) const
{
  core::ExactSum area;
  std::int64_t n_faces = 0;
  for (const Face<dim> &face : window.faces)
    if (partition.owner(places[face.i]) == ranks_.rank()) {
      area.add(face.area);
      ++n_faces;
    }
  area = ranks_.sum(area);
  n_faces = ranks_.sum(n_faces);
  WholeSizes sizes;
  sizes.face_area = n_faces > 0 ? area.value() / double(n_faces) : 0.;
  sizes.diameter = window.spacing;
  for (const int i : seed_of_)
    sizes.diameter = std::max(sizes.diameter, 2 * packer_.seeds().radius[i]);
  return sizes;
}

/// Particles, and what beyond the zone's sides bounds their cells.
template <int dim>
Seeds<dim> PartMaker<dim>::met_seeds() const
{
  std::vector<int> beyond;
  for (int i = 0; i < n_seeds(); ++i)
    if (packer_.is_met(i) && !is_particle(i))
      beyond.push_back(i);
  std::vector<int> met = ranks_.gather_all(beyond);
  met.insert(met.end(), seed_of_.begin(), seed_of_.end());
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  Seeds<dim> kept;
  for (const int i : met)
    kept.add(packer_.seeds().centre[i], packer_.seeds().radius[i], packer_.seeds().id[i]);
  return kept;
}

template <int dim>
RandomPart<dim> PartMaker<dim>::make(int rings, const std::vector<std::int64_t> &weights)
{
  const auto partition =
      particles::make_partition(std::int64_t(seed_of_.size()), ranks_.size(), weights);
  cut_around(stepped(partition), rings);
  std::vector<int> places;
  for (int k = 0; k < packer_.n_kept(); ++k)
    places.push_back(int(std::lower_bound(seed_of_.begin(), seed_of_.end(), packer_.kept(k)) -
                         seed_of_.begin()));
  RandomPart<dim> part;
  for (const int i : seed_of_)
    part.n_healed += packer_.is_healed(i);
  Packing<dim> window = packer_.take_packing();
  window.whole = sizes_of_whole(window, places, partition);
  part.held = part_of(std::move(window), places, partition, ranks_.rank(), rings, groups_);
  part.seeds = met_seeds();
  return part;
}
} // namespace

template <int dim>
RandomPart<dim> make_random_part(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds,
                                 const core::Ranks &ranks, int rings, const Groups<dim> &groups,
                                 const std::vector<std::int64_t> &weights)
{
  core::require(!PeriodicBox<dim>(specimen).is_any(), "joined sides are packed in one process");
  return PartMaker<dim>(specimen, std::move(seeds), ranks, groups).make(rings, weights);
}

template RandomPart<2> make_random_part(const SpecimenParameters<2> &, Seeds<2>,
                                        const core::Ranks &, int, const Groups<2> &,
                                        const std::vector<std::int64_t> &);
template RandomPart<3> make_random_part(const SpecimenParameters<3> &, Seeds<3>,
                                        const core::Ranks &, int, const Groups<3> &,
                                        const std::vector<std::int64_t> &);
} // namespace ligament::packings
