// What the fine-scale split costs per particle of the overlap, transition included, beside a
// particle of the lattice kernel in the same run; the solvers of its systems beside each other;
// what setting it up costs in a large body ("setup" alone, "regimes" alone: one argument). One JSON
// line each: {name, value, unit, reference, ratio}.
#include "bench/chebyshev.h"
#include "bench/roofline.h"
#include "tests/support/coupled_bodies.h"

#include <Eigen/SparseCholesky>
#include <fmt/format.h>

namespace
{
using namespace ligament;

void print(const std::string &name, double value, const std::string &unit, double reference)
{
  fmt::print("{{\"name\": \"{}\", \"value\": {:.4g}, \"unit\": \"{}\", \"reference\": {:.4g}, "
             "\"ratio\": {:.3f}}}\n",
             name, value, unit, reference, value / reference);
}

double nanoseconds(const std::function<void()> &call)
{
  return 1e9 / bench::rate(call);
}

template <int dim>
double step_time(particles::ParticleSolver<dim> &zone)
{
  return nanoseconds([&] {
    zone.compute_forces(0);
    zone.kick(1e-4); // a thousandth of the stable step: the motion stays as it is
    zone.drift(1e-4);
  });
}

/// Nanoseconds per particle of a whole step of a block of the lattice, cubic, about as in
/// bench/kernels.cc.
template <int dim>
double particle_time(const dem::DemMaterial &material)
{
  packings::LatticeParameters<dim> lattice;
  lattice.kind = dim == 2 ? packings::LatticeKind::hexagonal : packings::LatticeKind::fcc;
  lattice.spacing = 1;
  lattice.upper.setConstant(dim == 2 ? 85 : 14);
  lattice.lower = -lattice.upper;
  auto packing = packings::make_lattice_packing<dim>(lattice);
  particles::Particles<dim> state;
  packings::fill_particles(packing, material.density, state);
  const int n = state.size();
  particles::ParticleSolver<dim> solver(
      std::move(state), std::make_unique<dem::ManyBodyForce<dim>>(
                            std::move(packing), material, std::vector<core::BoundaryLoad<dim>>()));
  return step_time(solver) / n;
}

/// Seconds are per right-hand side of all components; the matrix is M_c.
template <int dim>
void compare_solvers(const std::string &name, const Eigen::SparseMatrix<double> &mass)
{
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, dim, Eigen::RowMajor>;
  const Rows right = Rows::Random(mass.rows(), dim);
  const std::string unit = "ns per node";
  const auto time_of = [&](const std::function<void(Rows &)> &solve) {
    Rows x;
    return nanoseconds([&] {
             x = right;
             solve(x);
           }) /
           double(mass.rows());
  };
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> cholesky(mass);
  const double plain = time_of([&](Rows &x) { x = cholesky.solve(x); });
  for (const auto library : {coupling::Solver::eigen, coupling::Solver::amesos}) {
    const auto solver = coupling::make_linear_solver(library);
    solver->factorise(mass);
    print(fmt::format("{}, M_c of {} nodes, solver {}; reference: SimplicialLLT of Eigen", name,
                      mass.rows(), coupling::solver_names[int(library)]),
          time_of([&](Rows &x) { solver->solve(x.data(), dim); }), unit, plain);
  }
  for (const double tolerance : {1e-3, 1e-12}) {
    const bench::Chebyshev<dim> polynomial(mass, tolerance);
    print(fmt::format("{}, M_c, Chebyshev polynomial of degree {}, error below {:.0e}; reference: "
                      "SimplicialLLT of Eigen",
                      name, polynomial.degree(), tolerance),
          time_of([&](Rows &x) { polynomial.solve(x); }), unit, plain);
  }
}

/// A band across the whole specimen, overlaps at both of its ends.
template <int dim>
void measure(const std::string &name, const Vector<dim> &size, double zone, double ratio,
             double reference)
{
  tests::CoupledBodiesParameters<dim> p;
  p.size = size;
  p.zone_size.setConstant(2 * size.maxCoeff());
  p.zone_size[dim - 1] = zone;
  p.cell_size = ratio;
  p.material.poissons_ratio = 0.25;
  for (const int step_ratio : {1, 4}) {
    p.split.step_ratio = step_ratio;
    auto body = tests::make_coupled_bodies<dim>(p);
    coupling::StepTime time;
    time.dt = body.dt;
    const double coupled = nanoseconds([&] {
                             for (int k = 0; k < step_ratio; ++k)
                               tests::advance(body, time);
                           }) /
                           step_ratio;
    const double particles = step_time(*body.zone);
    const double far = nanoseconds([&] {
                         body.far->compute_forces(0);
                         body.far->kick(1e-4, 0);
                         body.far->drift(1e-4);
                       }) /
                       step_ratio;
    const auto report = body.split->report();
    print(fmt::format("{}, r = {}, m = {}: {} overlap particles of {}, {} near nodes; reference: "
                      "particle of a lattice block",
                      name, ratio, step_ratio, report.overlap_particles, body.zone->state.size(),
                      report.near_nodes),
          (coupled - particles - far) / report.overlap_particles, "ns per overlap particle",
          reference);
    if (step_ratio == 1)
      compare_solvers<dim>(fmt::format("{}, r = {}", name, ratio), body.split->near_mass());
  }
}

/// Whole steps of a band in each regime over those in the linear one; what the regime adds, over
/// the discrete force of the overlap's particles, which the nonlinear one computes a second time.
template <int dim>
void compare_regimes(const std::string &name, const Vector<dim> &size, double zone)
{
  tests::CoupledBodiesParameters<dim> p;
  p.size = size;
  p.zone_size.setConstant(2 * size.maxCoeff());
  p.zone_size[dim - 1] = zone;
  p.cell_size = 4.1;
  p.material.poissons_ratio = 0.25;
  auto body = tests::make_coupled_bodies<dim>(p);
  auto bodies = body.bodies();
  const double share = double(body.split->report().overlap_particles) / body.zone->state.size();
  const double force = nanoseconds([&] { body.zone->compute_forces(0); }) * share;
  coupling::StepTime time;
  time.dt = body.dt;
  double linear = 0;
  for (const auto regime :
       {coupling::Regime::linear, coupling::Regime::corotated, coupling::Regime::nonlinear})
  {
    body.split->set_regime(regime, bodies);
    const double step = nanoseconds([&] { tests::advance(body, time); });
    if (regime == coupling::Regime::linear)
      linear = step;
    const std::string what = fmt::format("{}, {} regime, {:.0f} % of the particles in the overlap",
                                         name, name_of(regime), 100 * share);
    print(what + "; reference: step of the linear one", step / 1e3, "us per step", linear / 1e3);
    print(what + "; more than the linear one; reference: discrete force of the overlap",
          (step - linear) / 1e3, "us per step", force / 1e3);
  }
}
/// The same two overlaps at the ends of a bar of about a million particles and of a short one: the
/// set-up should cost what the overlaps cost. The patch fit knows only the overlaps.
void measure_setup()
{
  for (const bool fits : {false, true}) {
    const auto set_up = [&](double zone) {
      tests::CoupledBodiesParameters<3> p;
      p.size = {20, 20, zone + 100};
      p.zone_size = {100, 100, zone};
      p.material.poissons_ratio = 0.25;
      p.split.patch_fit = fits;
      return tests::make_coupled_bodies<3>(p);
    };
    const auto small = set_up(60);
    // Longer by whole cells of the lattice: the same layers lie in the overlap.
    const auto large = set_up(60 + 2 * 615 * std::sqrt(2));
    print(fmt::format("fcc, set-up {} patch fit of {} overlap particles of {}; reference: {} of {}",
                      fits ? "with" : "without", large.split->report().overlap_particles,
                      large.zone->state.size(), small.split->report().overlap_particles,
                      small.zone->state.size()),
          large.setup_time, "s", small.setup_time);
  }
}
} // namespace

int main(int argc, char **argv)
{
  if (argc > 1 && argv[1] == std::string("setup")) {
    measure_setup();
    return 0;
  }
  compare_regimes<2>("hexagonal", {200, 280}, 170);
  compare_regimes<3>("fcc", {30, 30, 190}, 120);
  if (argc > 1 && argv[1] == std::string("regimes"))
    return 0;
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  const double hexagonal = particle_time<2>(material), fcc = particle_time<3>(material);
  measure<2>("hexagonal", {200, 160}, 60, 4.1, hexagonal);
  measure<2>("hexagonal", {400, 320}, 120, 8.2, hexagonal);
  measure<3>("fcc", {30, 30, 110}, 40, 4.1, fcc);
  measure<3>("fcc", {30, 30, 200}, 60, 8.2, fcc);
  measure_setup();
}
