// How far the body has turned and stretched, and the kinematics of overlap and far field that this
// needs.
#pragma once

#include "core/state.h"
#include "src/simulation/coupled_body.h"

namespace ligament::program
{
/// Watches the motion of overlap and far field every 50 of its steps (theory.md, "Large rotation
/// and finite strain"). A scene's fixed regime acts from the start; "automatic" starts linear, or
/// corotated where the body begins with a spin, and changes where rotations are still so small that
/// the regimes hardly differ. Of a body of warm atoms it is the mean motion (C33): heat strains
/// single cells by per cents and deforms nothing.
template <int dim>
class RegimeControl
{
public:
  /// `turns`: the body begins with a spin.
  RegimeControl(RegimeChoice choice, CoupledBody<dim> &body, bool is_warm = false,
                bool turns = false);

  /// Between forces and kick of a step in which the far field acts: may change the regime and
  /// compute the forces again; what the energy changes by is booked in the body. Returns why the
  /// body leaves the range of its regime, once. Measures every 50 steps of the far field only,
  /// unless `each`: as of equilibria, which many steps lie between.
  std::optional<std::string> look(CoupledBody<dim> &body, const coupling::StepTime &step,
                                  core::Log &log, bool each = false);

  /// Which regime acted, and since when: "linear, corotated from 0.0012 s"; empty without mesh.
  std::string history() const;

  void save(core::State &state) const;
  /// The body has its motion, and the regime of its coupler, already.
  void load(const core::State &state, CoupledBody<dim> &body);

private:
  coupling::Regime needed() const;
  double largest_allowed_strain() const;
  std::optional<std::string> excess() const;
  void set(coupling::Regime regime, CoupledBody<dim> &body);
  void follow(const CoupledBody<dim> &body, double dt);
  void measure(CoupledBody<dim> &body);
  Largest<dim> rotation() const { return larger(near_.rotation, far_.rotation); } // rad
  Largest<dim> strain() const { return larger(near_.strain, far_.strain); }

  bool can_turn_;   // else the coupler is linear
  bool can_strain_; // else it is linear or turns
  bool has_law_;    // of finite strain, which the cells obey in the nonlinear regime
  bool automatic_;
  Components<dim> mean_; // m, displacements of all nodes; none, where they are taken as they are
  coupling::Regime regime_ = coupling::Regime::linear;
  coupling::NearMotion<dim> near_; // at the last look
  typename fem::FemSolver<dim>::Motion far_;
  bool warned_ = false;
  std::vector<std::pair<coupling::Regime, double>> history_; // and since when, s
};
} // namespace ligament::program
