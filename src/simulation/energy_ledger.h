// Where every joule is: all channels of the energy balance of a run.
#pragma once

#include "src/simulation/coupled_body.h"

#include <optional>
#include <string>
#include <utility>

namespace ligament::program
{
/// Energies in J at one time (theory.md, "Energy ledger"). The residual is what the channels do not
/// explain: zero to round-off for a linear body, of second order in the step otherwise.
struct EnergyLedger
{
  coupling::CoupledEnergy body;
  particles::ForceLosses force;
  double damping = 0;
  double absorbed = 0; // by absorbing sides and their layers
  double external_work = 0;
  double regime_change = 0; // taken where the coupler changed its regime
  double settled = 0;       // taken where the body settled into an equilibrium
  ToolEnergy tools;         // but their work, which is external

  double kinetic() const { return body.kinetic_discrete + body.kinetic_far; }
  double potential() const { return body.potential_discrete + body.potential_far + body.blended; }
  double residual() const
  {
    return kinetic() + potential() + body.impulses + body.fine_damper + body.gap_filter +
           body.thermostat + force.fracture + force.friction + force.breaking_step_error + damping +
           absorbed + regime_change + settled + force.plastic + force.viscous + force.cohesive +
           force.rebonding + tools.kinetic + tools.contact + tools.spring + tools.friction -
           external_work;
  }
  /// Name of the history column and value of every channel.
  std::vector<std::pair<std::string, double>> channels() const;
  /// The same of what flow took; only of bodies with a material that flows.
  std::vector<std::pair<std::string, double>> flow_channels() const;
};

/// The largest that the looks at a run's ledger have seen, in J.
struct LedgerExtremes
{
  double residual = 0, work = 0, kinetic = 0; // magnitudes
  std::optional<double> most_work;            // with its sign; none: nothing was seen

  void see(const EnergyLedger &ledger);
  /// Of the residual over that of the work or the kinetic energy, whichever is larger: bodies also
  /// begin in motion, or relax by themselves. None where both are 0.
  std::optional<double> relative_residual() const;
};

/// Valid between the forces and the kick of a step in which the far field acts. `damping` in J is
/// what the caller's damping has taken.
template <int dim>
EnergyLedger read_ledger(const CoupledBody<dim> &body, const coupling::StepTime &step,
                         double damping);

/// In J, of motion and deformation alone; valid at the same time. What it changes by where nothing
/// moves is to be booked.
template <int dim>
double motion_energy(const CoupledBody<dim> &body, const coupling::StepTime &step);
} // namespace ligament::program
