// A small bar as a scene, in units of d = 1, E = 1, rho = 1: for tests in three dimensions.
#pragma once

#include "tests/support/static_body.h"

namespace ligament::tests
{
/// 8 x 60 x 7, coupled, of particles or of elements alone.
struct Bar
{
  core::Log log;
  core::Timers timers;
  program::CoupledBody<3> body;

  explicit Bar(const std::vector<std::string> &overrides)
      : body(program::make_body<3>(static_scene<3>(overrides), log, timers))
  {
  }

  /// Displacement gradient x, of particles and nodes; forces follow.
  void deform(const Eigen::Matrix3d &gradient)
  {
    const auto move = [&](const auto &place, Components<3> &u, int n) {
      for (int i = 0; i < n; ++i)
        set(u, i, Vector<3>(gradient * place(i)));
    };
    if (body.zone) {
      auto &state = body.zone->state;
      move([&](int i) { return get(state.reference, i); }, state.displacement, state.size());
    }
    if (body.far)
      move([&](int i) { return body.far->mesh().nodes[i]; }, body.far->displacement,
           body.far->mesh().n_nodes());
    auto bodies = body.bodies();
    body.coupler->take_velocities(bodies);
    body.coupler->compute_forces(bodies, {0, 0, body.dt});
  }
};
} // namespace ligament::tests
