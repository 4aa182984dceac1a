// Rates of the discrete kernels, each beside the plain oracle on the same packing in the same run.
#include "dem/many_body_force.h"
#include "particles/lattice_packing.h"
#include "tests/oracle/many_body_oracle.h"

#include <fmt/format.h>

#include <ctime>
#include <functional>

namespace
{
using namespace ligament;

/// Seconds of processor time of this thread: other work on the machine doesn't count.
double seconds_now()
{
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

/// Million particle-steps per second: the best of several runs of at least a tenth of a second.
double rate(int particles, const std::function<void()> &step)
{
  double best = 0;
  step();
  for (int run = 0; run < 7; ++run) {
    const double start = seconds_now();
    int steps = 0;
    double seconds = 0;
    while (seconds < 0.1) {
      step();
      ++steps;
      seconds = seconds_now() - start;
    }
    best = std::max(best, 1e-6 * particles * steps / seconds);
  }
  return best;
}

template <int dim>
void measure(const std::string &name, particles::LatticeKind kind, double spacing)
{
  particles::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.spacing = spacing;
  lattice.lower.setConstant(-0.5);
  lattice.upper.setConstant(0.5);
  const auto packing = particles::make_lattice_packing<dim>(lattice);
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  particles::Particles<dim> p;
  particles::fill_particles(packing, material.density, p);
  const int n = p.size();
  // A smooth motion with spins; far below the strength, so that nothing breaks.
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < dim; ++c) {
      p.displacement[c][i] = 1e-4 * std::sin(3 * p.reference[(c + 1) % dim][i]);
      p.rotation[dim == 2 ? 0 : c + 1][i] = 1e-5 * std::cos(2 * p.reference[c][i]);
    }
  const oracle::ManyBodyOracle<dim> oracle(packing, 1, 0.25);
  const double reference = rate(n, [&] { oracle.compute(p); });
  const auto print = [&](const std::string &what, double value) {
    fmt::print("{{\"name\": \"{} {}, {} particles\", \"value\": {:.2f}, \"unit\": \"1e6 "
               "particle-steps/s\", \"reference\": {:.3f}, \"ratio\": {:.1f}}}\n",
               name, what, n, value, reference, value / reference);
  };
  {
    dem::ManyBodyForce<dim> force(packing, material, {});
    print("elastic", rate(n, [&] { force.compute(p, 0); }));
  }
  {
    dem::ManyBodyForce<dim> force(packing, material, {},
                                  {dem::FractureLaw::Criterion::maximum_tension, 1e3});
    print("elastic with fracture check", rate(n, [&] { force.compute(p, 0); }));
  }
  {
    auto without = material;
    without.poissons_ratio = 0;
    dem::ManyBodyForce<dim> force(packing, without, {});
    print("elastic, nu = 0", rate(n, [&] { force.compute(p, 0); }));
  }
}
} // namespace

int main()
{
  using particles::LatticeKind;
  measure<2>("hexagonal", LatticeKind::hexagonal, 1 / 294.);
  measure<2>("square", LatticeKind::square, 1 / 316.);
  measure<3>("fcc", LatticeKind::fcc, 1 / 41.);
  measure<3>("simple cubic", LatticeKind::simple_cubic, 1 / 46.);
}
