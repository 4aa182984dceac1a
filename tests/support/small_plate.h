// A small cracked plate as a scene, in units of d = 1, E = 1, rho = 1: for tests that go through
// the same set-up as the program.
#pragma once

#include "src/scene/read_scene.h"
#include "src/simulation/coupled_body.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace ligament::tests
{
/// 24 x 120, a band of particles in the middle, two cells of overlap; elastic, nothing acts.
inline const std::string small_plate = R"({
  "dimension": 2,
  "plane": "strain",
  "specimen": {"size": [24, 120]},
  "material": {"youngs_modulus": 1, "poissons_ratio": 0.22, "density": 1},
  "discrete_zone": {
    "region": {"lower": [null, -20], "upper": [null, 20]}, "packing": "hexagonal", "spacing": 1
  },
  "far_field": {"cell_size": 4.1},
  "coupling": {"overlap_cells": 2, "transition_cells": 3},
  "time": {"duration": 100},
  "output": {"history_interval": 1, "progress_interval": 1e9}
})";

/// The plate after `overrides` ("/path=value", or a whole section).
inline program::Scene small_scene(const std::vector<std::string> &overrides = {})
{
  const auto result = program::parse_scene(small_plate, "small_plate", overrides);
  for (const auto &error : result.errors)
    ADD_FAILURE() << core::to_string(error);
  return result.scene.value();
}

/// Names of the three kinds of body, with the override that makes them.
struct BodyKind
{
  const char *name;
  std::vector<std::string> overrides;
};
inline const std::vector<BodyKind> body_kinds = {
    {"coupled", {}}, {"pure_dem", {"/far_field=none"}}, {"pure_fem", {"/discrete_zone=none"}}};

inline std::vector<std::string> operator+(std::vector<std::string> a,
                                          const std::vector<std::string> &b)
{
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A body with what it needs to live.
struct SmallBody
{
  std::unique_ptr<core::Log> log = std::make_unique<core::Log>();
  std::unique_ptr<core::Timers> timers = std::make_unique<core::Timers>();
  program::CoupledBody<2> body;

  explicit SmallBody(const program::Scene &scene,
                     const program::ForceMaker<2> &make_force = program::make_many_body_force<2>)
      : body(program::make_body<2>(scene, *log, *timers, make_force))
  {
  }

  /// Displacement u = gradient x, of particles and nodes; nothing moves or turns.
  void deform(const Eigen::Matrix2d &gradient)
  {
    const auto place = [&](const Vector<2> &x, Components<2> &u, int i) {
      const Vector<2> value = gradient * x;
      for (int c = 0; c < 2; ++c)
        u[c][i] = value[c];
    };
    if (body.zone) {
      auto &state = body.zone->state;
      for (int i = 0; i < state.size(); ++i)
        place({state.reference[0][i], state.reference[1][i]}, state.displacement, i);
    }
    if (body.far)
      for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
        place(body.far->mesh().nodes[i], body.far->displacement, i);
    auto bodies = body.bodies();
    body.coupler->take_velocities(bodies);
  }
};
} // namespace ligament::tests
