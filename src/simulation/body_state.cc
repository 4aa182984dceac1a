#include "src/simulation/body_state.h"

#include "core/ranks_state.h"

namespace ligament::program
{
namespace
{
template <int dim>
core::Names node_names(const CoupledBody<dim> &body)
{
  return fem::node_names<dim>(body.far->mesh(), body.lower, body.upper);
}

/// Every rank has the whole mesh; one of them gives its sums, which are merged.
template <int dim>
void save_far(const CoupledBody<dim> &body, core::State &state)
{
  core::State far;
  body.far->save(far, node_names(body));
  for (auto &[name, table] : far)
    if (core::is_sum(table) && !body.ranks.is_first())
      core::save_sum(far, name, core::ExactSum());
  state.merge(far);
}
} // namespace

template <int dim>
core::State take_state(const CoupledBody<dim> &body)
{
  core::State state;
  if (body.zone)
    body.zone->save(state);
  if (body.far)
    save_far(body, state);
  body.coupler->save(state, body.bodies());
  if (body.tools)
    body.tools->save(state);
  core::save_value(state, "body", "regime_change", body.regime_change);
  core::save_value(state, "body", "settled", body.settled);
  core::save_value(state, "body", "started", body.started);
  return state;
}

template <int dim>
void give_state(const core::State &state, CoupledBody<dim> &body)
{
  if (body.zone)
    body.zone->load(state);
  if (body.far)
    body.far->load(state, node_names(body));
  auto bodies = body.bodies();
  body.coupler->load(state, bodies);
  if (body.tools)
    body.tools->load(state, bodies);
  body.regime_change = core::load_real(state, "body", "regime_change");
  body.settled = core::load_real(state, "body", "settled");
  body.started = core::load_real(state, "body", "started");
}

template core::State take_state(const CoupledBody<2> &);
template core::State take_state(const CoupledBody<3> &);
template void give_state(const core::State &, CoupledBody<2> &);
template void give_state(const core::State &, CoupledBody<3> &);
} // namespace ligament::program
