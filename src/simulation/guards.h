// Ends runs whose state is no longer that of a body: what no other guard says, and no warning
// mends.
#pragma once

#include "src/simulation/energy_ledger.h"

#include <optional>
#include <string>

namespace ligament::program
{
/// Looks at the motion are so far apart, in steps of the far field, on one rank, too: where a run
/// ends must not depend on their number.
constexpr long guard_interval = 50;

/// Between drift and forces: why the motion is that of no body, with the place in the reference.
/// Of several findings the worst one, of several places the first by x, then y, then z. That is
///   - a particle or a cell whose motion is not finite,
///   - a cell of the far field that is turned inside out,
///   - a particle so far away that rounding spoils its strains,
///   - a particle that moves farther in one step than the search for contacts sees ahead.
/// All ranks call it, each looks at what it owns, and all get the same words. Empty: nothing.
template <int dim>
std::optional<std::string> find_broken_motion(const CoupledBody<dim> &body);

/// Why the energies are those of a run that has become unstable: they are not finite, or most of
/// what the body has came from nowhere. `most_work` in J is the largest external work of the run.
/// The same on all ranks, whose ledgers are. Empty: nothing.
template <int dim>
std::optional<std::string> find_broken_balance(const EnergyLedger &ledger, double most_work,
                                               const CoupledBody<dim> &body);
} // namespace ligament::program
