// Rates of the discrete kernels for each instruction set, beside the machine's roofline measured in
// the same run: {name, value, unit, reference, ratio}, one JSON line each.
#include "bench/roofline.h"
#include "core/dispatch.h"
#include "dem/many_body_force.h"
#include "dem/principal_tension.h"
#include "packings/lattice_packing.h"
#include "packings/random_packing.h"
#include "particles/particle_solver.h"
#include "tests/oracle/many_body_oracle.h"

#include <fmt/format.h>
#include <hwy/highway.h>

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <numeric>

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

/// Floating-point operations per particle and step of lattices, counted in the source; a
/// multiply-add is two.
template <int dim>
double lattice_flops(int n_directions)
{
  const bool fcc = dim == 3 && n_directions == 6;
  const double dilatation = dim == 2 ? 46 : 48, forces = dim == 2 ? 60 : 168;
  const double combined_directions = fcc ? 84 : 0;
  const double turn_and_sums = dim == 2 ? 57 : 136, integration = dim == 2 ? 15 : 90;
  return n_directions * (dilatation + forces) + combined_directions + turn_and_sums + integration;
}

/// The same of random packings with so many neighbours.
template <int dim>
double random_flops(double n_neighbours)
{
  const double dilatation = dim == 2 ? 28 : 64, forces = dim == 2 ? 62 : 176;
  const double turn_and_sums = dim == 2 ? 50 : 60, integration = dim == 2 ? 15 : 90;
  return n_neighbours * (dilatation + forces) + turn_and_sums + integration;
}

/// Bytes per particle and step between memory and cache when each verb of the step passes over its
/// arrays once; a number that is written and not read counts twice.
template <int dim>
double lattice_bytes()
{
  constexpr int rotations = particles::Particles<dim>::n_rotations, dofs = n_particle_dofs<dim>;
  const double forces = dim + rotations + 0.5 + 2 + 2 * (2 + dofs);
  const double kick = 2 * dofs + dofs + 2, drift = dofs + 2 * (dim + rotations);
  return sizeof(double) * (forces + kick + drift);
}

/// With the constants of all bonds of a particle in both sweeps, and the records.
template <int dim>
double random_bytes(double n_neighbours)
{
  const double bond = sizeof(double) * (2 * dem::n_geometry<dim> + dem::n_stiffness<dim>)+2 * 4;
  return lattice_bytes<dim>() + n_neighbours * bond + 4 * sizeof(double) * dem::record_size;
}

/// Bytes of memory that this process holds now.
double resident_bytes()
{
  malloc_trim(0);
  std::ifstream file("/proc/self/statm");
  double size = 0, resident = 0;
  file >> size >> resident;
  return resident * double(sysconf(_SC_PAGESIZE));
}

/// The most that it held so far.
double peak_bytes()
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024. * double(usage.ru_maxrss);
}

/// A box of this size in m around the origin.
template <int dim>
packings::Packing<dim> make_block(packings::LatticeKind kind, double spacing,
                                  const Vector<dim> &size = Vector<dim>::Ones(),
                                  const Spin<dim> &orientation = Spin<dim>::Zero())
{
  packings::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.spacing = spacing;
  lattice.orientation = orientation;
  lattice.lower = -size / 2;
  lattice.upper = size / 2;
  return packings::make_lattice_packing<dim>(lattice);
}

/// Relaxed a little: whole relaxation takes long and changes nothing here.
template <int dim>
packings::Packing<dim> make_random(double spacing)
{
  packings::RandomParameters<dim> random;
  random.spacing = spacing;
  random.relaxation_sweeps = 2;
  random.lower.setConstant(-0.5);
  random.upper.setConstant(0.5);
  return packings::make_random_packing<dim>(random).packing;
}

/// A smooth motion with spins; far below the strength, so that nothing breaks.
template <int dim>
particles::Particles<dim> move(const packings::Packing<dim> &packing)
{
  particles::Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  for (int i = 0; i < p.size(); ++i)
    for (int c = 0; c < dim; ++c) {
      p.displacement[c][i] = 1e-4 * std::sin(3 * p.reference[(c + 1) % dim][i]);
      p.rotation[dim == 2 ? 0 : c + 1][i] = 1e-5 * std::cos(2 * p.reference[c][i]);
    }
  return p;
}

/// Million particle-steps per second of the row kernel alone, without irregular bonds.
template <int dim>
double rate_of_rows(const packings::Packing<dim> &packing, const dem::DemMaterial &material)
{
  const int n = packing.size();
  auto p = move(packing);
  const dem::BondNetwork<dim> bonds(packing, material);
  const dem::LatticeKernel<dim> kernel(bonds.directions(), bonds.segments(), n,
                                       material.shear_modulus(), true);
  const std::vector<double> lambda(n, 1.);
  const std::vector<int> none;
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
  a.other_particles = &none;
  a.pressure = pressure.data();
  dem::RowWindow window;
  std::vector<dem::RowRange> exceeded;
  return 1e-6 * n * bench::rate([&] {
           kernel.forces(a, bonds.segments(), {1e3, dem::PrincipalTension<dim>::tangent}, window,
                         exceeded);
         });
}

template <int dim>
void measure(const std::string &name, const packings::Packing<dim> &packing, bool all_targets)
{
  const int n = packing.size(), n_directions = int(packing.directions.size());
  const double n_neighbours = 2. * double(packing.faces.size()) / n;
  const double flops =
      n_directions > 0 ? lattice_flops<dim>(n_directions) : random_flops<dim>(n_neighbours);
  const double bytes = n_directions > 0 ? lattice_bytes<dim>() : random_bytes<dim>(n_neighbours);
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  const auto rate = [&](const std::function<void()> &step) { return 1e-6 * n * bench::rate(step); };
  const std::pair<std::int64_t, const char *> targets[] = {
      {HWY_AVX3, "AVX-512"}, {HWY_AVX2, "AVX2"}, {HWY_EMU128 | HWY_SCALAR, "SSE2"}};
  for (const auto &[target, target_name] : targets) {
    hwy::SetSupportedTargetsForTest(0);
    if (!(hwy::SupportedTargets() & target))
      continue;
    hwy::SetSupportedTargetsForTest(target);
    const Roofline roof = bench::measure_roofline();
    const double most = 1e-6 / std::max(flops / roof.flops, bytes / roof.bytes);
    const std::string label = fmt::format("{}, {} particles, {}", name, n, target_name);
    const std::string unit = "1e6 particle-steps/s";

    const double before = resident_bytes();
    dem::FractureLaw fracture{dem::FractureLaw::Criterion::maximum_tension, 1e3};
    particles::ParticleSolver<dim> solver(
        move(packing), std::make_unique<dem::ManyBodyForce<dim>>(
                           packing, material, std::vector<core::BoundaryLoad<dim>>(), fracture));
    const double dt = 1e-4 * packing.spacing; // a thousandth of the stable one: the motion stays
    const auto whole_step = [&] {
      solver.drift(dt);
      solver.compute_forces(0);
      solver.kick(dt);
    };
    const double step = rate(whole_step);
    print(label + ", whole step with fracture check; reference: roofline", step, unit, most);
    print(label + ", bytes of memory per particle; reference: 250 of elastic lattices",
          (resident_bytes() - before) / n, "B", 250);
    print(label + ", arithmetic; reference: multiply-add loop", 1e-3 * step * flops, "GFLOP/s",
          1e-9 * roof.flops);
    print(label + ", traffic; reference: triad", 1e-3 * step * bytes, "GB/s", 1e-9 * roof.bytes);
    if (n_directions > 0)
      print(label + ", rows of the lattice alone; reference: arithmetic roofline",
            rate_of_rows<dim>(packing, material), unit, 1e-6 * roof.flops / flops);
    if (!all_targets)
      break;
    solver.let_rest(); // all are in motion
    print(label + ", whole step when regions at rest are looked for; reference: whole step",
          rate(whole_step), unit, step);
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

/// Whole steps of boxes of about as many particles, in turns: what a shape costs. The first box,
/// all of whose sides are alike, is the reference.
template <int dim>
void measure_shapes(const std::string &name, packings::LatticeKind kind,
                    const std::vector<std::pair<std::string, Vector<dim>>> &shapes,
                    const Spin<dim> &orientation = Spin<dim>::Zero())
{
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  struct Body
  {
    std::unique_ptr<particles::ParticleSolver<dim>> solver;
    double rate_of_rows, irregular_bonds; // 1e6 particle-steps/s; per particle
    std::vector<double> rates;
  };
  std::vector<Body> bodies;
  for (const auto &[shape, size] : shapes) {
    const auto packing = make_block<dim>(kind, 1., size, orientation);
    dem::FractureLaw fracture{dem::FractureLaw::Criterion::maximum_tension, 1e3};
    double n_irregular = 0;
    dem::BondNetwork<dim>(packing, material)
        .for_each_irregular([&](dem::BondId, const dem::Bond<dim> &) { ++n_irregular; });
    bodies.push_back({std::make_unique<particles::ParticleSolver<dim>>(
                          move(packing),
                          std::make_unique<dem::ManyBodyForce<dim>>(
                              packing, material, std::vector<core::BoundaryLoad<dim>>(), fracture)),
                      rate_of_rows<dim>(packing, material),
                      n_irregular / packing.size(),
                      {}});
  }
  constexpr int turns = 5;
  for (int turn = 0; turn < turns; ++turn)
    for (Body &body : bodies) {
      auto &solver = *body.solver;
      body.rates.push_back(1e-6 * solver.state.size() * bench::rate([&] {
                             solver.drift(1e-4);
                             solver.compute_forces(0);
                             solver.kick(1e-4);
                           }));
    }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::vector<double> ratios;
    for (int turn = 0; turn < turns; ++turn)
      ratios.push_back(bodies[b].rates[turn] / bodies[0].rates[turn]);
    std::sort(bodies[b].rates.begin(), bodies[b].rates.end());
    std::sort(ratios.begin(), ratios.end());
    const double rate = bodies[b].rates[turns / 2];
    const std::string label = fmt::format("{}, {}, {} particles, ", name, shapes[b].first,
                                          bodies[b].solver->state.size());
    const std::string reference = "; reference: " + shapes[0].first;
    print(label + "whole step with fracture check" + reference, rate, "1e6 particle-steps/s",
          rate / ratios[turns / 2]);
    print(label + "rows of the lattice alone" + reference, bodies[b].rate_of_rows,
          "1e6 particle-steps/s", bodies[0].rate_of_rows);
    print(label + "bonds off the rows per particle" + reference, bodies[b].irregular_bonds, "-",
          bodies[0].irregular_bonds);
  }
}

void measure_all_shapes()
{
  using packings::LatticeKind;
  const std::vector<std::pair<std::string, Vector<3>>> boxes = {
      {"cube", {85.3, 85.3, 85.3}},
      {"plate thin in z", {256.3, 150.3, 16.3}},
      {"plate thin in y", {256.3, 16.3, 150.3}},
      {"plate thin in x", {16.3, 256.3, 150.3}},
      {"bar along x", {1550.3, 20.3, 20.3}},
      {"bar along y", {20.3, 1550.3, 20.3}},
      {"bar along z", {20.3, 20.3, 1550.3}},
      {"short bar along x, in the cache", {60.3, 20.3, 20.3}},
      {"short bar along z, in the cache", {20.3, 20.3, 60.3}}};
  measure_shapes<3>("fcc", LatticeKind::fcc, boxes);
  measure_shapes<3>("fcc, turned by (0.3, 0.5, 0.2)", LatticeKind::fcc, boxes, {0.3, 0.5, 0.2});
  measure_shapes<3>("simple cubic", LatticeKind::simple_cubic, boxes);
  const std::vector<std::pair<std::string, Vector<2>>> plates = {{"square plate", {875.3, 875.3}},
                                                                 {"strip along x", {9570.3, 80.3}},
                                                                 {"strip along y", {80.3, 9570.3}}};
  measure_shapes<2>("hexagonal", LatticeKind::hexagonal, plates);
  measure_shapes<2>("hexagonal, turned by 0.2", LatticeKind::hexagonal, plates, Spin<2>(0.2));
  measure_shapes<2>("square", LatticeKind::square, plates);
}

/// One body of 1e7 particles: memory and the seconds of a step.
template <int dim>
void measure_largest(const std::string &name, packings::LatticeKind kind, double spacing)
{
  auto packing = make_block<dim>(kind, spacing);
  const int n = packing.size();
  const double packed = peak_bytes();
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  auto state = move(packing);
  particles::ParticleSolver<dim> solver(
      std::move(state), std::make_unique<dem::ManyBodyForce<dim>>(
                            std::move(packing), material, std::vector<core::BoundaryLoad<dim>>()));
  const double set_up = peak_bytes();
  const int steps = 5;
  const auto step = [&] {
    solver.drift(1e-4 * spacing);
    solver.compute_forces(0);
    solver.kick(1e-4 * spacing);
  };
  step();
  const double start = bench::seconds_now();
  for (int s = 0; s < steps; ++s)
    step();
  const std::string label = fmt::format("{}, {} particles", name, n);
  print(label + ", seconds per step", (bench::seconds_now() - start) / steps, "s", 1);
  print(label + ", peak memory of packing; reference: 24 GiB", packed, "B", 24. * (1 << 30));
  print(label + ", peak memory of set-up; reference: 24 GiB", set_up, "B", 24. * (1 << 30));
  print(label + ", memory while it runs; reference: 24 GiB", resident_bytes(), "B",
        24. * (1 << 30));
}
/// Forces of a body with a law of plastic flow: far from it, after it, and with all particles
/// flowing in every step; and what the search for breaking bonds costs. Medians of calls in turns.
template <int dim>
void measure_plastic(const std::string &name, const packings::Packing<dim> &packing)
{
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  auto p = move(packing);
  const auto make = [&](double yield_stress, double strength) {
    material.plasticity = {};
    if (yield_stress > 0) {
      dem::YieldCurve curve;
      curve.initial = yield_stress, curve.hardening = 0.1;
      material.plasticity = dem::VonMisesFlow{curve};
    }
    dem::FractureLaw fracture;
    if (strength > 0)
      fracture = {dem::FractureLaw::Criterion::maximum_tension, strength};
    return std::make_unique<dem::ManyBodyForce<dim>>(
        packing, material, std::vector<core::BoundaryLoad<dim>>(), fracture);
  };
  const auto elastic = make(0, 0), breaking = make(0, 1e3), far = make(1e3, 0),
             plastic = make(1e-9, 0);
  double time = 0, growth = 1;
  const auto seconds = [&](dem::ManyBodyForce<dim> &force) {
    for (auto &array : p.displacement)
      for (double &u : array)
        u *= growth;
    const double start = bench::seconds_now();
    force.compute(p, time += 1);
    return bench::seconds_now() - start;
  };
  const std::string label = fmt::format("{}, {} particles, forces", name, packing.size());
  const auto compare = [&](const std::string &what, dem::ManyBodyForce<dim> &force, int turns) {
    std::vector<double> rates, ratios;
    seconds(force);
    for (int k = 0; k < turns; ++k) {
      const double reference = seconds(*elastic), now = seconds(force);
      rates.push_back(1e-6 * packing.size() / now);
      ratios.push_back(reference / now);
    }
    std::sort(rates.begin(), rates.end());
    std::sort(ratios.begin(), ratios.end());
    const double value = rates[turns / 2];
    print(label + ", " + what + "; reference: elastic, in turns", value, "1e6 particle-steps/s",
          value / ratios[turns / 2]);
  };
  compare("search for breaking bonds", *breaking, 301);
  compare("law of plastic flow, far from yielding", *far, 301);
  growth = 1 + 1e-4;
  compare("all particles flow in every step", *plastic, 101);
  growth = 1 - 1e-6; // unloads
  compare("all particles plastic, none flows", *plastic, 101);
}

/// A homogeneous uniaxial tension of `strain` E along an oblique axis, at nu = 1/4.
template <int dim>
particles::Particles<dim> pull(const packings::Packing<dim> &packing, double strain = 1e-4)
{
  particles::Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  constexpr double angle = 0.6, nu = 0.25;
  const double along = strain * (dim == 2 ? 1 - nu * nu : 1),
               across = -strain * nu * (dim == 2 ? 1 + nu : 1);
  Vector<dim> e = Vector<dim>::Zero();
  e[0] = std::cos(angle);
  e[1] = std::sin(angle);
  for (int i = 0; i < p.size(); ++i) {
    const Vector<dim> x = get(p.reference, i), u = across * x + (along - across) * x.dot(e) * e;
    for (int c = 0; c < dim; ++c)
      p.displacement[c][i] = u[c];
  }
  return p;
}

/// Median of the seconds of `first` over those of `second`.
double ratio_in_turns(const std::function<void()> &first, const std::function<void()> &second)
{
  const auto seconds = [](const std::function<void()> &call) {
    const double start = bench::seconds_now();
    call();
    return bench::seconds_now() - start;
  };
  std::vector<double> ratios;
  seconds(first);
  // Strictly in turns: what is called twice finds its arrays in the cache.
  double before = seconds(second);
  for (double spent = 0; ratios.size() < 21 || (spent < 1 && ratios.size() < 1001);) {
    const double now = seconds(first), after = seconds(second);
    spent += now + after;
    ratios.push_back(2 * now / (before + after));
    before = after;
  }
  std::sort(ratios.begin(), ratios.end());
  return ratios[ratios.size() / 2];
}

/// What a fracture criterion costs: forces with it over forces without, call by call in turns; far
/// from breaking, and where the whole body bears some share of its strength. Value: what it costs,
/// median of the pairs; reference: what it may.
template <int dim>
void measure_criterion(const std::string &name, const packings::Packing<dim> &packing)
{
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  auto uniform = pull(packing);
  const auto compare = [&](const std::string &what, particles::Particles<dim> &p, double strength) {
    const auto make = [&](const dem::FractureLaw &fracture) {
      return std::make_unique<dem::ManyBodyForce<dim>>(
          packing, material, std::vector<core::BoundaryLoad<dim>>(), fracture);
    };
    const auto without = make({}),
               with = make({dem::FractureLaw::Criterion::maximum_tension, strength});
    double time = 0;
    const double ratio = ratio_in_turns([&] { with->compute(p, time += 1); },
                                        [&] { without->compute(p, time += 1); });
    print(fmt::format("{}, {} particles, forces with a criterion over forces without, {}", name,
                      packing.size(), what),
          ratio, "-", 1.05);
    if (!with->broken_bonds().empty())
      throw core::InputError("bonds broke in a body below its strength");
  };
  auto moved = move(packing);
  compare("far from breaking", moved, 1e3);
  std::vector<int> all(packing.size());
  std::iota(all.begin(), all.end(), 0);
  const double most = dem::ManyBodyForce<dim>(packing, material, {},
                                              {dem::FractureLaw::Criterion::maximum_tension, 1})
                          .weakest_bond(uniform, all)
                          .utilisation; // of packings that are not relaxed above 1e-4
  for (const double share : {0.5, 0.7, 0.95})
    compare(fmt::format("uniform tension of {} of the strength", share), uniform, most / share);
}

/// The same for criteria of tensors: forces with them over those with maximum tension far from
/// breaking, under uniform tension over the forces without a criterion.
template <int dim>
void measure_tensor_criteria(const std::string &name, const packings::Packing<dim> &packing)
{
  using Law = dem::FractureLaw::Criterion;
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  dem::FaceStrength shape = 1.;
  shape.compressive = 5;
  shape.cohesion = 1.2;
  shape.friction_angle = 0.6;
  auto moved = move(packing), pulled = pull(packing), pressed = pull(packing, -1e-4);
  std::vector<int> all(packing.size());
  std::iota(all.begin(), all.end(), 0);
  const auto make = [&](const dem::FractureLaw &fracture) {
    return std::make_unique<dem::ManyBodyForce<dim>>(
        packing, material, std::vector<core::BoundaryLoad<dim>>(), fracture);
  };
  const auto without = make({}), tension = make({Law::maximum_tension, 1e3});
  for (const auto &named :
       {std::pair("principal_stress", Law::principal_stress),
        std::pair("von_mises", Law::von_mises), std::pair("drucker_prager", Law::drucker_prager),
        std::pair("mohr_coulomb", Law::mohr_coulomb), std::pair("energy", Law::energy)})
  {
    const char *const word = named.first;
    const auto criterion = named.second; // lambdas take no names of a structured binding
    const auto compare = [&](const std::string &what, particles::Particles<dim> &p, double strength,
                             dem::ManyBodyForce<dim> &reference) {
      shape.value = strength;
      const auto with = make({criterion, shape});
      double time = 0;
      const double ratio = ratio_in_turns([&] { with->compute(p, time += 1); },
                                          [&] { reference.compute(p, time += 1); });
      print(fmt::format("{}, {} particles, {}: forces {}", name, packing.size(), word, what), ratio,
            "-", 1.05);
      if (!with->broken_bonds().empty())
        throw core::InputError("bonds broke in a body below its strength");
    };
    compare("over those with maximum_tension, far from breaking", moved, 1e3, *tension);
    shape.value = 1;
    const auto utilisation = [&](const particles::Particles<dim> &p) {
      return make({criterion, shape})->weakest_bond(p, all).utilisation;
    };
    for (const double share : {0.2, 0.7}) {
      shape.value = 1;
      const double under_tension = utilisation(pulled);
      compare(fmt::format("without, uniform tension of {} of the strength", share), pulled,
              under_tension / share, *without);
      shape.value = 1;
      const double under_pressure = utilisation(pressed);
      if (under_pressure > 0.05 * under_tension && criterion != Law::principal_stress)
        compare(fmt::format("without, uniform compression of {} of the strength", share), pressed,
                under_pressure / share, *without);
    }
  }
}

/// What the sums over all particles cost: a row of the history, and mass damping in every step.
template <int dim>
void measure_sums(const std::string &name, const packings::Packing<dim> &packing)
{
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  core::BoundaryLoad<dim> lower, upper; // held and pulled, so that there are reactions and work
  lower.boundary = 2;
  upper.boundary = 3;
  lower.value[1] = 0;
  upper.value[1] = 1e-3;
  const std::vector<core::BoundaryLoad<dim>> loads = {lower, upper};
  particles::ParticleSolver<dim> solver(
      move(packing), std::make_unique<dem::ManyBodyForce<dim>>(
                         packing, material, loads,
                         dem::FractureLaw{dem::FractureLaw::Criterion::maximum_tension, 1e9}));
  const double dt = 1e-4 * packing.spacing;
  double time = 0, read = 0; // what is read keeps the compiler from leaving it out
  const auto forces = [&] { solver.compute_forces(time += dt); };
  const auto row = [&] {
    const auto losses = solver.force->losses();
    read += solver.potential_energy() + solver.kinetic_energy(dt) + losses.fracture +
            losses.friction + losses.plastic + losses.breaking_step_error +
            solver.force->external_work();
    for (int l = 0; l < int(loads.size()); ++l)
      read += solver.force->reaction(l)[1];
    for (const auto &broken : solver.force->broken_bonds())
      read += broken.area;
  };
  const std::string label = fmt::format("{}, {} particles, ", name, packing.size());
  print(label + "history row over force evaluation; reference: must", ratio_in_turns(row, forces),
        "-", 1.5);
  const auto potential = [&] { read += solver.potential_energy(); };
  print(label + "potential energy over force evaluation", ratio_in_turns(potential, forces), "-",
        1);
  const auto kinetic = [&] { read += solver.kinetic_energy(dt); };
  print(label + "kinetic energy over force evaluation", ratio_in_turns(kinetic, forces), "-", 1);
  const auto step = [&] {
    solver.drift(dt);
    forces();
    solver.kick(dt);
  };
  const auto damped_step = [&] {
    solver.drift(dt);
    forces();
    read += solver.damp_velocities(1 - 1e-9, dt).value();
    solver.kick(dt);
    read += solver.damp_velocities(1 - 1e-9, -dt).value();
  };
  print(label + "step with mass damping over step without", ratio_in_turns(damped_step, step), "-",
        1);
  print(label + "rate with mass damping", 1e-6 * packing.size() * bench::rate(damped_step),
        "1e6 particle-steps/s", 1);
  if (!std::isfinite(read))
    throw core::InputError("energies are no longer finite");
}
} // namespace

/// Without arguments the bodies of 33 000 particles and lattices of 880 000; "random": random
/// packings of 880 000, which take minutes to make; "2d" or "3d": 1e7 particles; "shapes": plates
/// and bars of lattices beside cubes; "plastic": what breaking and yielding cost; "criterion": what
/// a fracture criterion does; "sums": what sums over all particles cost.
int main(int argc, char **argv)
{
  using packings::LatticeKind;
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "2d")
    measure_largest<2>("hexagonal", LatticeKind::hexagonal, 1 / 2943.);
  else if (what == "3d")
    measure_largest<3>("fcc", LatticeKind::fcc, 1 / 192.);
  else if (what == "shapes")
    measure_all_shapes();
  else if (what == "plastic") {
    measure_plastic<3>("fcc", make_block<3>(LatticeKind::fcc, 1 / 28.5));
    measure_plastic<2>("hexagonal", make_block<2>(LatticeKind::hexagonal, 1 / 169.));
    measure_plastic<3>("random 3D", make_random<3>(1 / 28.5));
    measure_plastic<2>("random 2D", make_random<2>(1 / 169.));
    measure_plastic<3>("fcc", make_block<3>(LatticeKind::fcc, 1 / 85.5));
    measure_plastic<2>("hexagonal", make_block<2>(LatticeKind::hexagonal, 1 / 875.));
  } else if (what == "criterion") {
    measure_criterion<2>("hexagonal", make_block<2>(LatticeKind::hexagonal, 1 / 169.));
    measure_criterion<3>("fcc", make_block<3>(LatticeKind::fcc, 1 / 28.5));
    measure_criterion<2>("random 2D", make_random<2>(1 / 169.));
    measure_criterion<3>("random 3D", make_random<3>(1 / 28.5));
    measure_criterion<2>("hexagonal", make_block<2>(LatticeKind::hexagonal, 1 / 875.));
    measure_criterion<3>("fcc", make_block<3>(LatticeKind::fcc, 1 / 85.5));
  } else if (what == "tensor_criteria") {
    measure_tensor_criteria<2>("hexagonal", make_block<2>(LatticeKind::hexagonal, 1 / 169.));
    measure_tensor_criteria<3>("fcc", make_block<3>(LatticeKind::fcc, 1 / 28.5));
    measure_tensor_criteria<2>("random 2D", make_random<2>(1 / 169.));
    measure_tensor_criteria<3>("random 3D", make_random<3>(1 / 28.5));
  } else if (what == "sums") {
    measure_sums<2>("hexagonal", make_block<2>(LatticeKind::hexagonal, 1 / 933.));
    measure_sums<3>("fcc", make_block<3>(LatticeKind::fcc, 1 / 89.2));
    measure_sums<2>("random 2D", make_random<2>(1 / 169.));
  } else if (what == "random") {
    measure<2>("random 2D", make_random<2>(1 / 875.), false);
    measure<3>("random 3D", make_random<3>(1 / 85.5), false);
  } else {
    measure<3>("fcc", make_block<3>(LatticeKind::fcc, 1 / 28.5), true);
    measure<3>("simple cubic", make_block<3>(LatticeKind::simple_cubic, 1 / 32.), true);
    measure<2>("hexagonal", make_block<2>(LatticeKind::hexagonal, 1 / 169.), true);
    measure<2>("square", make_block<2>(LatticeKind::square, 1 / 182.), true);
    measure<3>("random 3D", make_random<3>(1 / 28.5), true);
    measure<2>("random 2D", make_random<2>(1 / 169.), true);
    measure<3>("fcc", make_block<3>(LatticeKind::fcc, 1 / 85.5), false);
    measure<2>("hexagonal", make_block<2>(LatticeKind::hexagonal, 1 / 875.), false);
  }
}
