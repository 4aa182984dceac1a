// Cuts the cells of seeds, all or some of them, and makes a packing of what it has cut.
#pragma once

#include "packings/clipped_cell.h"
#include "packings/packing.h"
#include "packings/power_diagram.h"

namespace ligament::packings
{
inline constexpr const char *no_whole_particle =
    "the discrete zone holds no whole particle: widen it or make the spacing smaller";

/// Cells are those among all seeds, whichever of them are cut: a part of a packing has the bits of
/// the whole.
template <int dim>
class SeedPacker
{
public:
  /// The seeds are sorted by their ids, and their radii healed: by all ranks, if there are several.
  SeedPacker(const SpecimenParameters<dim> &specimen, Seeds<dim> seeds,
             const core::Ranks &ranks = {});
  SeedPacker(const SeedPacker &) = delete; // the diagram refers to the seeds
  SeedPacker &operator=(const SeedPacker &) = delete;

  /// In the order of the particles, with the radii that cells have.
  const Seeds<dim> &seeds() const { return seeds_; }
  bool is_healed(int seed) const { return seeds_.radius[seed] < given_radius_[seed]; }

  /// Whether a seed has a particle: those whose cell reaches across a coupled side have none.
  enum class InZone
  {
    no,
    yes,
    maybe // its cell must be cut to know
  };
  InZone place_in_zone(int seed) const;
  bool has_particle(int seed) const;

  /// Cuts the cells of these seeds, in ascending order, none of which was cut before, and keeps
  /// those in the zone. Throws core::InputError where one is not closed.
  void cut(const std::vector<int> &seeds);
  /// Whether the cell of this seed was kept, or has a face with one that was.
  bool is_met(int seed) const { return is_met_[seed]; }
  /// Cells that were kept, and the seeds that these belong to, ascending.
  int n_kept() const { return int(kept_.size()); }
  int kept(int k) const { return kept_[k].seed; }

  /// Of the cells that were kept, in the order of the seeds, with the faces between them. Uses them
  /// up.
  Packing<dim> take_packing();

private:
  struct Kept
  {
    int seed;
    double volume;
  };

  ClippedCell<dim> cell_of(int seed) const;
  bool is_in_zone(const Vector<dim> &lower, const Vector<dim> &upper) const;
  void keep(int seed, const ClippedCell<dim> &cell);

  const SpecimenShape<dim> shape_;
  const double spacing_, thickness_;
  Vector<dim> zone_lower_, zone_upper_;     // infinite where the side is not coupled
  const core::BoxUnion<dim> parts_of_zone_; // empty: all of it
  Seeds<dim> seeds_;
  const std::vector<double> given_radius_; // before healing
  const PowerDiagram<dim> diagram_;

  std::vector<char> is_met_; // by seed
  // In the order of the seeds that make them; faces have numbers of seeds for i and j.
  std::vector<Kept> kept_;
  std::vector<Face<dim>> faces_;
  std::vector<BoundaryFace<dim>> boundary_faces_;
};
} // namespace ligament::packings
