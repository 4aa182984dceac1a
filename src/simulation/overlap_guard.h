// Watches that nothing breaks where the models overlap, and that nothing flows there or beyond: the
// mesh stands for intact bonds and for an elastic body.
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

  /// Of the stress under which the far field's material flows: from the first on there is a word of
  /// it, from the second on it is beyond its range.
  static constexpr double near_flow_limit = 0.8, flow_limit = 1;
  /// Looks at flow are worth this many steps of the far field: they see all its cells.
  static constexpr long flow_interval = 16;

  /// Sets the noted share of the body's force when there is an overlap and something can break.
  explicit OverlapGuard(const CoupledBody<dim> &body);

  /// After the forces of a step at this time (s); what it found, with its place, when that happens
  /// first: a face beyond the limit, or broken ones. On several ranks, which all call it, they find
  /// the same.
  std::optional<std::string> look(const CoupledBody<dim> &body, double time);

  /// What it says of flow in overlap and far field.
  struct FlowFinding
  {
    std::string text;
    bool is_excess; // beyond the range, not just near its end
  };
  /// After the forces of a step: each of the two words once, the second one only while look() has
  /// found nothing.
  std::optional<FlowFinding> look_at_flow(const CoupledBody<dim> &body);

  long n_broken() const { return n_broken_; }
  double energy() const { return energy_.value(); } // J, released by those faces

  void save(core::State &state) const;
  void load(const core::State &state);

private:
  /// What is nearest to flow, and a box around all that is near it.
  struct Flow
  {
    particles::Utilisation<dim> most;
    bool in_mesh = false;
    Vector<dim> lower, upper; // m
  };
  bool is_watched(const particles::BrokenBond<dim> &bond) const;
  /// Counts what has broken since the last look, at this time (s).
  void count_broken(const CoupledBody<dim> &body, double time);
  /// Of the first broken face that counts, m.
  Vector<dim> first_broken(const CoupledBody<dim> &body) const;
  /// The face of the body that is nearest to its limit, where one is beyond it.
  std::optional<particles::Utilisation<dim>> worst_face(const CoupledBody<dim> &body) const;
  Flow find_flow(const CoupledBody<dim> &body) const;
  void look_at_cells(const CoupledBody<dim> &body, Flow &flow) const;

  bool watches_ = false;
  std::vector<particles::Watch> watch_;      // of the particles at hand
  std::vector<char> is_blended_;             // of the cells: particles carry it, too
  std::size_t seen_ = 0;                     // of the body's broken bonds
  std::optional<std::size_t> seen_here_ = 0; // of those at hand; unknown after load()
  double seen_until_ = -1;                   // s
  long n_broken_ = 0;
  core::ExactSum energy_;
  bool found_ = false, found_near_flow_ = false;
};
} // namespace ligament::program
