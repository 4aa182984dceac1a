// The energy of bodies in free flight that flow: what the leap-frog's balance misses.
#include "src/verification/cases/flow.h"

#include "dem/many_body_force.h"
#include "packings/lattice_packing.h"
#include "packings/random_packing.h"
#include "particles/particle_solver.h"
#include "src/verification/bodies/unit_bodies.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace ligament::program
{
namespace
{
constexpr double strain = 1e-8;
constexpr int n_steps = 10000;

/// In units of the strain times Young's modulus.
std::vector<std::pair<std::string, dem::Plasticity>> laws()
{
  dem::YieldCurve voce;
  voce.initial = 0.3 * strain;
  voce.hardening = 0.05;
  voce.saturation = 0.2 * strain;
  voce.rate = 1 / strain;
  return {{"von_mises", dem::VonMisesFlow{voce}},
          {"drucker_prager", dem::DruckerPragerFlow{0.2 * strain, 0.02, 0.5, 0.3}}};
}

/// A body that stretches along x and turns here and there: what is missing of the energy that it
/// began with, at worst, over it; not a number where hardly anything flowed.
template <int dim>
double missing(const packings::Packing<dim> &packing, const dem::Plasticity &law, double length)
{
  dem::DemMaterial material{1, 0.3, 1, PlaneMode::strain, 0};
  material.plasticity = law;
  particles::Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  auto owned = std::make_unique<dem::ManyBodyForce<dim>>(packing, material,
                                                         std::vector<core::BoundaryLoad<dim>>());
  const auto &force = *owned;
  particles::ParticleSolver<dim> body(std::move(p), std::move(owned));
  const double dt = 0.9 * force.stable_step(body.state);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.05, 0.05);
  // The lowest mode takes a quarter of its period to stretch that far.
  const double rate = strain * M_PI / length;
  for (int i = 0; i < body.state.size(); ++i) {
    body.state.velocity[0][i] = rate * (body.state.reference[0][i] + noise(random));
    body.state.velocity[1][i] = rate * noise(random);
    for (auto &spin : body.state.spin)
      spin[i] = rate * noise(random);
  }
  double time = 0, worst = 0;
  body.compute_forces(time);
  const double start = body.kinetic_energy(dt);
  for (int step = 1; step <= n_steps; ++step) {
    body.kick(dt);
    body.drift(dt);
    body.compute_forces(time += dt);
    if (step % 100 == 0)
      keep_largest(worst, std::abs(body.kinetic_energy(dt) + body.potential_energy() +
                                   force.plastic_dissipation() - start) /
                              start);
  }
  // A body that keeps to elasticity says nothing.
  const double taken = force.plastic_dissipation() / start;
  return taken > 0.02 ? worst : std::nan("");
}

/// A bar of these lengths along x and across.
template <int dim, typename Parameters>
Parameters bar(double along, double across)
{
  Parameters p;
  p.spacing = 1;
  p.upper.setConstant(across / 2);
  p.upper[0] = along / 2;
  p.lower = -p.upper;
  return p;
}

std::vector<Result> balance()
{
  constexpr double length = 40, space_length = 30;
  auto hexagonal = bar<2, packings::LatticeParameters<2>>(length, 8.3);
  hexagonal.kind = packings::LatticeKind::hexagonal;
  auto fcc = bar<3, packings::LatticeParameters<3>>(space_length, 3.3);
  fcc.kind = packings::LatticeKind::fcc;
  const auto plane =
      packings::make_random_packing<2>(bar<2, packings::RandomParameters<2>>(length, 8));
  const auto space =
      packings::make_random_packing<3>(bar<3, packings::RandomParameters<3>>(space_length, 4));
  std::vector<Result> results;
  for (const auto &[name, flow] : laws()) {
    const std::string law = name;
    const auto add = [&](const std::string &packing, double value) {
      results.push_back({"law_flow_balance/" + packing + "_" + law, value, 1e-8, 1e-10});
    };
    add("hexagonal", missing<2>(packings::make_lattice_packing<2>(hexagonal), flow, length));
    add("random", missing<2>(plane.packing, flow, length));
    add("fcc", missing<3>(packings::make_lattice_packing<3>(fcc), flow, space_length));
    add("random_3d", missing<3>(space.packing, flow, space_length));
  }
  return results;
}
} // namespace

std::vector<Case> flow_balance_cases()
{
  return {{"law_flow_balance", "free flight of bodies that flow, 1e4 steps at 0.9 of the critical",
           false, balance}};
}
} // namespace ligament::program
