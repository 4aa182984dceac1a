// Writes a packing for other programs, particles and bonds, and measures our own step on it.
// usage: bench_peer_packing hexagonal|fcc|random_2d|random_3d SPACING PARTICLES_FILE BONDS_FILE
// The packing fills a box of size 1. Prints particles, bonds and million particle-steps per second.
#include "bench/roofline.h"
#include "dem/many_body_force.h"
#include "packings/lattice_packing.h"
#include "packings/random_packing.h"
#include "particles/particle_solver.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <cmath>
#include <stdexcept>

namespace
{
using namespace ligament;

template <int dim>
packings::Packing<dim> make_packing(const std::string &kind, double spacing)
{
  const auto fill = [&](auto parameters) {
    parameters.spacing = spacing;
    parameters.lower.setConstant(-0.5);
    parameters.upper.setConstant(0.5);
    return parameters;
  };
  if (kind == "random_2d" || kind == "random_3d")
    return packings::make_random_packing<dim>(fill(packings::RandomParameters<dim>())).packing;
  auto lattice = fill(packings::LatticeParameters<dim>());
  lattice.kind = dim == 2 ? packings::LatticeKind::hexagonal : packings::LatticeKind::fcc;
  return packings::make_lattice_packing<dim>(lattice);
}

/// Whole steps with the check for broken bonds, in a smooth motion far below the strength.
template <int dim>
double particle_steps(const packings::Packing<dim> &packing)
{
  particles::Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  for (int i = 0; i < p.size(); ++i)
    for (int c = 0; c < dim; ++c)
      p.displacement[c][i] = 1e-4 * std::sin(3 * p.reference[(c + 1) % dim][i]);
  dem::DemMaterial material;
  material.poissons_ratio = 0.25;
  const dem::FractureLaw fracture{dem::FractureLaw::Criterion::maximum_tension, 1e3};
  particles::ParticleSolver<dim> solver(
      std::move(p), std::make_unique<dem::ManyBodyForce<dim>>(
                        packing, material, std::vector<core::BoundaryLoad<dim>>(), fracture));
  const double dt = 1e-4 * packing.spacing; // the motion stays as it is
  return packing.size() * bench::rate([&] {
           solver.drift(dt);
           solver.compute_forces(0);
           solver.kick(dt);
         });
}

template <int dim>
void run(const std::string &kind, double spacing, const char *particles_file,
         const char *bonds_file)
{
  const auto packing = make_packing<dim>(kind, spacing);
  auto particles = fmt::output_file(particles_file);
  for (int i = 0; i < packing.size(); ++i)
    particles.print("{:.15g} {:.15g} {:.15g}\n", packing.centre[0][i], packing.centre[1][i],
                    dim == 3 ? packing.centre[dim - 1][i] : 0);
  auto bonds = fmt::output_file(bonds_file);
  for (const auto &face : packing.faces)
    bonds.print("{} {}\n", face.i, face.j);
  fmt::print("{} {} {:.4g}\n", packing.size(), packing.faces.size(),
             1e-6 * particle_steps(packing));
}
} // namespace

int main(int n_arguments, char **arguments)
{
  if (n_arguments != 5) {
    fmt::print(stderr,
               "usage: {} hexagonal|fcc|random_2d|random_3d SPACING PARTICLES_FILE "
               "BONDS_FILE\n",
               arguments[0]);
    return 2;
  }
  const std::string kind = arguments[1];
  const bool flat = kind == "hexagonal" || kind == "random_2d";
  (flat ? run<2> : run<3>)(kind, std::stod(arguments[2]), arguments[3], arguments[4]);
}
