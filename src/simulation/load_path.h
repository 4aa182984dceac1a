// What still joins the two sides of the specimen: the smallest section that a load has to pass.
#pragma once

#include "core/state.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Which faces carry.
enum class Carrying
{
  now,
  at_start // those that the run has broken, too; initial cracks stay open
};

/// Least area in m^2 of bonded faces whose removal leaves nothing between the two sides across the
/// axis: the maximum flow from side to side when each face lets its area pass. Cells of the mesh
/// don't break, nor what moves with them: infinite where they alone join the sides. The sides are
/// flat: of a disc, or along joined sides, none are found and the section is 0. The first of
/// several ranks finds it and tells the others.
template <int dim>
double smallest_section(const CoupledBody<dim> &body, int axis, Carrying carrying);

/// A bound on it from below that takes 12 bytes a particle in place of half a kilobyte; equal to it
/// in an intact prism. Infinite, too, where the mesh goes round the zone; otherwise the smallest
/// section may be infinite nevertheless.
template <int dim>
double section_at_least(const CoupledBody<dim> &body, int axis, Carrying carrying);

/// The smallest section of the body at the start, by the bound where that answers: infinite or 0
/// where a run cannot lose its load path.
template <int dim>
double section_at_start(const CoupledBody<dim> &body, int axis);

/// Asks for the smallest section only when enough has broken since the last answer; until as much
/// has broken as nearly parts an intact prism a bound does.
template <int dim>
class LoadPath
{
public:
  /// The path is lost when no more than this share of the section of the start is left.
  static constexpr double lost_share = 0.05;

  explicit LoadPath(int axis) : axis_(axis) {}

  /// The share of the section of the start that is left at present, once the path is lost; never
  /// where there was none at the start. Cheap while less has broken than would have to.
  std::optional<double> lost(const CoupledBody<dim> &body);

  void save(core::State &state) const;
  void load(const core::State &state);

private:
  void start(const CoupledBody<dim> &body);
  /// Takes what has broken since from the section.
  void count(const CoupledBody<dim> &body);
  bool has_enough() const { return at_least_ > lost_share * at_start_; }

  int axis_;
  double at_start_ = -1;    // m^2; unknown below 0
  bool is_bound_ = false;   // at_start_ is, from below
  double at_least_ = 0;     // m^2, now
  std::size_t counted_ = 0; // broken bonds that at_least_ knows of
};
} // namespace ligament::program
