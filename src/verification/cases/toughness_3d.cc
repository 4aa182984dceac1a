// Toughness in 3D: bars with an edge crack of six spacings against their plane-strain twins.
#include "core/extremes.h"
#include "dem/grips.h"
#include "dem/many_body_force.h"
#include "dem/principal_tension.h"
#include "dem/toughness_calibration.h"
#include "particles/particle_solver.h"
#include "src/verification/cases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace ligament::program
{
namespace
{
constexpr double spacing = 0.5e-3, width = 12e-3, height = 24e-3, crack = 3e-3, toughness = 4e6,
                 modulus = 370e9, density = 3900; // alumina
constexpr auto criterion = dem::FractureLaw::Criterion::maximum_tension;
const dem::DemMaterial alumina{modulus, 0.22, density, PlaneMode::strain, 0};

/// Thickness of bars in m: 0 for a twin.
struct Bar
{
  double depth = 0;
  bool walls = false; // smooth, at both side faces
};

template <int dim>
void lay_out(const Bar &bar, packings::SpecimenParameters<dim> &p)
{
  p.spacing = spacing;
  p.lower[0] = 0, p.upper[0] = width;
  p.lower[1] = -height / 2, p.upper[1] = height / 2;
  if constexpr (dim == 2)
    p.cracks = {{{-crack, 0}, {crack, 0}}};
  else {
    const double z = bar.depth;
    p.lower[2] = -z / 2, p.upper[2] = z / 2;
    p.cracks = {{{-crack, 0, -z}, {crack, 0, -z}, {crack, 0, z}, {-crack, 0, z}}};
  }
}

/// sigma sqrt(pi a sec(pi a/2W)) at the largest load, over K_Ic: no stress intensity factor of this
/// bar, but it grows with a as that does. a is what the cut breaks, seen along y.
template <int dim>
double relative_toughness(const Bar &bar, packings::Packing<dim> packing, double c)
{
  const double section = width * (dim == 2 ? 1 : bar.depth);
  double cut = 0;
  for (const auto &face : packing.faces)
    if (face.cracked)
      cut += face.area * std::abs(face.normal[1]);
  const double a = cut / section * width,
               shape = std::sqrt(M_PI * a / std::cos(M_PI * a / (2 * width)));

  const double crossing = height / std::sqrt(alumina.shear_modulus() / density),
               opening = 1.2 * toughness / shape / modulus * height,
               rate = opening / (50 * crossing);
  particles::Particles<dim> state;
  packings::fill_particles(packing, density, state);
  auto loads = dem::grips<dim>(rate, 5 * crossing);
  if (bar.walls)
    dem::add_smooth_walls(loads);
  auto owned = std::make_unique<dem::ManyBodyForce<dim>>(
      std::move(packing), alumina, std::move(loads),
      dem::FractureLaw{criterion,
                       c * toughness / std::sqrt(spacing),
                       {},
                       dem::PrincipalTension<dim>::whole_face(spacing)});
  const auto &force = *owned;
  const double dt = 0.9 * force.stable_step(state);
  particles::ParticleSolver<dim> body(std::move(state), std::move(owned));
  body.compute_forces(0);
  const double kept = std::exp(-M_PI / (2 * crossing) * dt);
  double peak = 0;
  for (double time = dt; time < 200 * crossing; time += dt) {
    body.kick(dt);
    body.scale_velocities(kept);
    body.drift(dt);
    body.compute_forces(time);
    const double load = (force.reaction(1)[1] - force.reaction(0)[1]) / 2;
    keep_largest(peak, load);
    if (load < 0.6 * peak && !force.broken_bonds().empty())
      return peak / section * shape / toughness;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

template <int dim>
double of_lattice(const Bar &bar, const std::string &kind, const Spin<dim> &orientation)
{
  packings::LatticeParameters<dim> p;
  lay_out<dim>(bar, p);
  p.kind = packings::lattice_kind(kind);
  p.orientation = orientation;
  return relative_toughness<dim>(
      bar, packings::make_lattice_packing<dim>(p),
      dem::calibrate_toughness<dim>(p.kind, orientation, alumina, criterion));
}

template <int dim>
double of_random(const Bar &bar, int seed)
{
  packings::RandomParameters<dim> p;
  lay_out<dim>(bar, p);
  p.seed = seed;
  return relative_toughness<dim>(bar, packings::make_random_packing<dim>(p).packing,
                                 dem::calibrate_toughness<dim>(p, alumina, criterion));
}

double degrees(double angle)
{
  return angle * M_PI / 180;
}

/// The mean of five plane packings.
double twin()
{
  const Bar plane;
  return (of_lattice<2>(plane, "hexagonal", Spin<2>(0.)) +
          of_lattice<2>(plane, "hexagonal", Spin<2>(degrees(15))) +
          of_lattice<2>(plane, "square", Spin<2>(0.)) + of_random<2>(plane, 301) +
          of_random<2>(plane, 302)) /
         5;
}

std::vector<Result> bars(const std::string &name, const Bar &bar)
{
  const double plane = twin();
  std::vector<Result> results;
  const auto add = [&](const std::string &packing, double k) {
    results.push_back({name + "/" + packing, k / plane, 0.95, 0.98, Result::Bound::at_least});
    results.push_back({name + "/" + packing + "/at_most", k / plane, 1.05, 1.02});
  };
  add("fcc", of_lattice<3>(bar, "fcc", Spin<3>::Zero()));
  add("fcc_z_20", of_lattice<3>(bar, "fcc", {0, 0, degrees(20)}));
  add("fcc_x_30", of_lattice<3>(bar, "fcc", {degrees(30), 0, 0}));
  double sum = 0;
  constexpr int n = 5;
  for (int seed = 301; seed < 301 + n; ++seed)
    sum += of_random<3>(bar, seed) / n;
  add("random", sum);
  return results;
}
} // namespace

std::vector<Case> toughness_3d_cases()
{
  return {{"toughness_3d",
           "strength of slabs 4 d thick between smooth walls, edge crack a/d = 6, over that of "
           "plane-strain twins",
           true,
           [] {
             return bars("toughness_3d", {4 * spacing, true});
           }},
          {"toughness_3d_free",
           "strength of bars 12 d thick, edge crack a/d = 6, over that of plane-strain twins", true,
           [] {
             return bars("toughness_3d_free", {12 * spacing, false});
           }}};
}
} // namespace ligament::program
