// Small bodies of atoms as scenes, and what imposes motions on them.
#pragma once

#include "src/scene/atoms.h"
#include "src/scene/read_scene.h"
#include "src/simulation/coupled_body.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace ligament::tests
{
/// Lennard-Jones argon in the plane, alone, 24 x 20 nm: about 60 spacings; nothing acts.
inline const std::string plane_of_atoms = R"({
  "dimension": 2,
  "specimen": {"size": ["24 nm", "20 nm"], "thickness": "0.38 nm"},
  "atoms": {"potential": "lennard_jones", "energy": "0.0104 eV", "distance": "3.4 angstrom",
            "mass": "39.95 u"},
  "discrete_zone": {"extent": "all", "packing": "hexagonal"},
  "far_field": "none",
  "time": {"duration": "1 ps", "step_fraction": 0.2}
})";

/// What puts them into a mesh, and `further` overrides.
inline std::vector<std::string> in_a_mesh(const std::vector<std::string> &further)
{
  std::vector<std::string> all = {
      R"(/specimen/size=["60 nm", "60 nm"])",
      R"(/discrete_zone={"packing": "hexagonal", "region": {"lower": ["-17 nm", "-17 nm"],
                                                            "upper": ["17 nm", "17 nm"]}})",
      R"(/far_field={"cell_size": "1.5 nm"})", R"(/coupling={"overlap_cells": 6})"};
  all.insert(all.end(), further.begin(), further.end());
  return all;
}

/// Copper, alone, that repeats itself along z.
inline const std::string copper_bar = R"({
  "dimension": 3,
  "specimen": {"size": ["6.5 nm", "5.4 nm", "1.1 nm"], "periodic": ["z"]},
  "atoms": {"potential": "zhou", "species": "Cu"},
  "discrete_zone": {"extent": "all", "packing": "fcc"},
  "far_field": "none",
  "time": {"duration": "1 ps", "step_fraction": 0.2}
})";

inline program::Scene scene_of(const std::string &text,
                               const std::vector<std::string> &overrides = {})
{
  const auto result = program::parse_scene(text, "atoms", overrides);
  for (const auto &error : result.errors)
    ADD_FAILURE() << core::to_string(error);
  return result.scene.value();
}

template <int dim>
struct AtomsOfScene
{
  program::Scene scene;
  core::Log log;
  core::Timers timers;
  program::CoupledBody<dim> body;

  explicit AtomsOfScene(const std::string &text, const std::vector<std::string> &overrides = {})
      : scene(scene_of(text, overrides)), body(program::make_body<dim>(scene, log, timers))
  {
  }

  particles::Particles<dim> &atoms() { return body.zone->state; }

  /// u = field(X) of atoms and nodes.
  template <typename Field>
  void impose(const Field &field)
  {
    for (int i = 0; i < atoms().size(); ++i)
      set<dim>(atoms().displacement, i, Vector<dim>(field(get(atoms().reference, i))));
    if (body.far)
      for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
        set<dim>(body.far->displacement, i, Vector<dim>(field(body.far->mesh().nodes[i])));
  }

  /// Adds a normal number times `deviation` (m) to each component of all atoms.
  void shake(double deviation, unsigned seed)
  {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, deviation);
    for (auto &component : atoms().displacement)
      for (double &u : component)
        u += normal(random);
  }
};
} // namespace ligament::tests
