#include "src/simulation/energy_ledger.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
std::vector<std::pair<std::string, double>> EnergyLedger::channels() const
{
  return {{"kinetic_discrete", body.kinetic_discrete},
          {"potential_discrete", body.potential_discrete},
          {"kinetic_far", body.kinetic_far},
          {"potential_far", body.potential_far},
          {"blended", body.blended},
          {"impulses", body.impulses},
          {"breaking", force.breaking_step_error},
          {"fracture", force.fracture},
          {"friction", force.friction},
          {"cohesive", force.cohesive},
          {"damper_fine", body.fine_damper},
          {"damper_gap", body.gap_filter},
          {"damping", damping},
          {"regime_change", regime_change},
          {"settled", settled},
          {"tool_kinetic", tools.kinetic},
          {"tool_contact", tools.contact},
          {"tool_spring", tools.spring},
          {"tool_friction", tools.friction},
          {"absorbed", absorbed},
          {"external_work", external_work},
          {"residual", residual()}};
}

std::vector<std::pair<std::string, double>> EnergyLedger::flow_channels() const
{
  return {{"plastic_heat", force.plastic - force.hardening}, {"plastic_stored", force.hardening}};
}

void LedgerExtremes::see(const EnergyLedger &ledger)
{
  const auto take = [](double value, double &largest) {
    if (std::isfinite(value))
      largest = std::max(largest, std::abs(value));
  };
  take(ledger.residual(), residual);
  take(ledger.external_work, work);
  take(ledger.kinetic(), kinetic);
  most_work = std::max(most_work.value_or(ledger.external_work), ledger.external_work);
}

std::optional<double> LedgerExtremes::relative_residual() const
{
  const double moved = std::max(work, kinetic);
  return moved > 0 ? std::optional(residual / moved) : std::nullopt;
}

template <int dim>
EnergyLedger read_ledger(const CoupledBody<dim> &body, const coupling::StepTime &step,
                         double damping)
{
  EnergyLedger ledger;
  ledger.body = body.coupler->energy(body.bodies(), step);
  ledger.damping = damping;
  ledger.regime_change = body.regime_change;
  ledger.settled = body.settled;
  ledger.external_work += body.started;
  if (body.tools) {
    ledger.tools = body.tools->energy();
    ledger.external_work += ledger.tools.work;
  }
  if (body.zone)
    ledger.absorbed += body.zone->absorbed_energy();
  if (body.zone)
    ledger.external_work += body.zone->body_force_work();
  if (body.far)
    ledger.absorbed += body.far->absorbed_energy();
  if (const auto *force = body.force()) {
    ledger.force = force->losses();
    ledger.external_work += force->external_work();
  }
  if (body.far)
    ledger.external_work += body.far->external_work();
  return ledger;
}

template <int dim>
double motion_energy(const CoupledBody<dim> &body, const coupling::StepTime &step)
{
  const auto e = body.coupler->energy(body.bodies(), step);
  return e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended +
         e.impulses;
}

template EnergyLedger read_ledger(const CoupledBody<2> &, const coupling::StepTime &, double);
template EnergyLedger read_ledger(const CoupledBody<3> &, const coupling::StepTime &, double);
template double motion_energy(const CoupledBody<2> &, const coupling::StepTime &);
template double motion_energy(const CoupledBody<3> &, const coupling::StepTime &);
} // namespace ligament::program
