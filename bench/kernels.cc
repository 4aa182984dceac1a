// Rates of the discrete kernels for each instruction set, beside the machine's roofline measured in
// the same run: {name, value, unit, reference, ratio}, one JSON line each.
#include "bench/roofline.h"
#include "core/dispatch.h"
#include "dem/many_body_force.h"
#include "particles/lattice_packing.h"
#include "particles/particle_solver.h"
#include "tests/oracle/many_body_oracle.h"

#include <fmt/format.h>
#include <hwy/highway.h>

#include <algorithm>

namespace
{
using namespace ligament;
using bench::Roofline;

void print(const std::string &name, double value, const std::string &unit, double reference)
{
  fmt::print("{{\"name\": \"{}\", \"value\": {:.4g}, \"unit\": \"{}\", \"reference\": {:.4g}, "
             "\"ratio\": {:.3f}}}\n",
             name, value, unit, reference, value / reference);
}

/// Floating-point operations per particle and step, counted in the source; a multiply-add is two.
template <int dim>
double flops_of_step(int n_directions)
{
  const bool fcc = dim == 3 && n_directions == 6;
  const double dilatation = dim == 2 ? 46 : 48, forces = dim == 2 ? 60 : 168;
  const double combined_directions = fcc ? 84 : 0;
  const double turn_and_sums = dim == 2 ? 57 : 136, integration = dim == 2 ? 15 : 90;
  return n_directions * (dilatation + forces) + combined_directions + turn_and_sums + integration;
}

/// Bytes per particle and step between memory and cache when each verb of the step passes over its
/// arrays once; a number that is written and not read counts twice.
template <int dim>
double bytes_of_step()
{
  constexpr int rotations = particles::Particles<dim>::n_rotations, dofs = n_particle_dofs<dim>;
  const double forces = dim + rotations + 0.5 + 2 + 2 * (2 + dofs);
  const double kick = 2 * dofs + dofs + 2, drift = dofs + 2 * (dim + rotations);
  return sizeof(double) * (forces + kick + drift);
}

template <int dim>
particles::Packing<dim> make_block(particles::LatticeKind kind, double spacing)
{
  particles::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.spacing = spacing;
  lattice.lower.setConstant(-0.5);
  lattice.upper.setConstant(0.5);
  return particles::make_lattice_packing<dim>(lattice);
}

/// A smooth motion with spins; far below the strength, so that nothing breaks.
template <int dim>
particles::Particles<dim> move(const particles::Packing<dim> &packing)
{
  particles::Particles<dim> p;
  particles::fill_particles(packing, 1., p);
  for (int i = 0; i < p.size(); ++i)
    for (int c = 0; c < dim; ++c) {
      p.displacement[c][i] = 1e-4 * std::sin(3 * p.reference[(c + 1) % dim][i]);
      p.rotation[dim == 2 ? 0 : c + 1][i] = 1e-5 * std::cos(2 * p.reference[c][i]);
    }
  return p;
}

/// Million particle-steps per second of the row kernel alone, without irregular bonds.
template <int dim>
double rate_of_rows(const particles::Packing<dim> &packing, const dem::DemMaterial &material)
{
  const int n = packing.size();
  auto p = move(packing);
  const dem::BondNetwork<dim> bonds(packing, material);
  const dem::LatticeKernel<dim> kernel(bonds.directions(), bonds.segments(), n,
                                       material.shear_modulus(), true);
  const std::vector<double> lambda(n, 1.), other(n, 0.);
  std::vector<double> pressure(n);
  dem::LatticeArrays<dim> a{};
  for (int c = 0; c < dim; ++c) {
    a.displacement[c] = p.displacement[c].data();
    a.force[c] = p.force[c].data();
  }
  for (int c = 0; c < a.n_rotations; ++c)
    a.rotation[c] = p.rotation[c].data();
  for (int c = 0; c < n_spins<dim>; ++c)
    a.torque[c] = p.torque[c].data();
  a.mask = bonds.mask().data();
  a.lambda_per_volume = lambda.data();
  a.other_pressure = other.data();
  a.pressure = pressure.data();
  dem::RowWindow window;
  std::vector<dem::RowRange> exceeded;
  return 1e-6 * n * bench::rate([&] { kernel.forces(a, bonds.segments(), 1e3, window, exceeded); });
}

template <int dim>
void measure(const std::string &name, particles::LatticeKind kind, double spacing, bool all_targets)
{
  const auto packing = make_block<dim>(kind, spacing);
  const int n = packing.size(), n_directions = int(packing.directions.size());
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  const auto rate = [&](const std::function<void()> &step) { return 1e-6 * n * bench::rate(step); };
  const std::pair<std::int64_t, const char *> targets[] = {
      {HWY_AVX3, "AVX-512"}, {HWY_AVX2, "AVX2"}, {HWY_EMU128, "SSE2"}};
  for (const auto &[target, target_name] : targets) {
    hwy::SetSupportedTargetsForTest(0);
    if (!(hwy::SupportedTargets() & target))
      continue;
    hwy::SetSupportedTargetsForTest(target);
    const Roofline roof = bench::measure_roofline();
    const double flops = flops_of_step<dim>(n_directions), bytes = bytes_of_step<dim>();
    const double most = 1e-6 / std::max(flops / roof.flops, bytes / roof.bytes);
    const std::string label = fmt::format("{}, {} particles, {}", name, n, target_name);
    const std::string unit = "1e6 particle-steps/s";

    dem::FractureLaw fracture{dem::FractureLaw::Criterion::maximum_tension, 1e3};
    particles::ParticleSolver<dim> solver(
        move(packing), std::make_unique<dem::ManyBodyForce<dim>>(
                           packing, material, std::vector<core::BoundaryLoad<dim>>(), fracture));
    const double dt = 1e-4 * spacing; // a thousandth of the stable one: the motion stays as it is
    const double step = rate([&] {
      solver.drift(dt);
      solver.compute_forces(0);
      solver.kick(dt);
    });
    print(label + ", whole step with fracture check; reference: roofline", step, unit, most);
    print(label + ", arithmetic; reference: multiply-add loop", 1e-3 * step * flops, "GFLOP/s",
          1e-9 * roof.flops);
    print(label + ", traffic; reference: triad", 1e-3 * step * bytes, "GB/s", 1e-9 * roof.bytes);
    print(label + ", rows of the lattice alone; reference: arithmetic roofline",
          rate_of_rows<dim>(packing, material), unit, 1e-6 * roof.flops / flops);
    if (!all_targets)
      break;
    const double forces = rate([&] { solver.compute_forces(0); });
    print(label + ", forces alone; reference: whole step", forces, unit, step);
    if (target == targets[0].first) {
      const oracle::ManyBodyOracle<dim> oracle(packing, 1, 0.25);
      auto p = move(packing);
      print(label + ", forces alone; reference: plain code", forces, unit,
            rate([&] { oracle.compute(p); }));
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}
} // namespace

int main()
{
  using particles::LatticeKind;
  measure<3>("fcc", LatticeKind::fcc, 1 / 28.5, true);
  measure<3>("simple cubic", LatticeKind::simple_cubic, 1 / 32., true);
  measure<2>("hexagonal", LatticeKind::hexagonal, 1 / 169., true);
  measure<2>("square", LatticeKind::square, 1 / 182., true);
  measure<3>("fcc", LatticeKind::fcc, 1 / 85.5, false);
  measure<2>("hexagonal", LatticeKind::hexagonal, 1 / 875., false);
}
