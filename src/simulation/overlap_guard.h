// Watches that nothing breaks where the models overlap: the mesh there stands for intact bonds.
#pragma once

#include "core/exact_sum.h"
#include "core/state.h"
#include "src/simulation/coupled_body.h"

#include <optional>
#include <string>

namespace ligament::program
{
/// Faces of overlap particles count; those of pads, which are the mesh's, don't. A look costs
/// nothing that depends on the size of the overlap while no face anywhere comes near its limit: the
/// kernels say where one does.
template <int dim>
class OverlapGuard
{
public:
  /// Share of the limit at which a run leaves its range.
  static constexpr double limit = 0.9;

  /// Sets the noted share of the body's force when there is an overlap and something can break.
  explicit OverlapGuard(const CoupledBody<dim> &body);

  /// After the forces of a step; what it found, with its place, when that happens first: a face
  /// beyond the limit, or broken ones.
  std::optional<std::string> look(const CoupledBody<dim> &body);

  long n_broken() const { return n_broken_; }
  double energy() const { return energy_.value(); } // J, released by those faces

  void save(core::State &state) const;
  void load(const core::State &state);

private:
  bool is_watched(const particles::BrokenBond<dim> &bond) const;

  std::vector<particles::Watch> watch_; // of the particles; empty: nothing to watch
  std::size_t seen_ = 0;                // of the body's broken bonds
  long n_broken_ = 0;
  core::ExactSum energy_;
  bool found_ = false;
};
} // namespace ligament::program
