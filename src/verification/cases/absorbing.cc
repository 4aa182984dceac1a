// What a side that lets waves out reflects, of the mesh and of a packing.
#include "dem/many_body_force.h"
#include "packings/absorbing_sides.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/cases/wave_passage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr int cell_size = 4; // spacings; particles see waves of as many spacings as the mesh

struct AbsorbingParameters
{
  WaveKind kind = WaveKind::p;
  double wave_length = 8; // cells
  double angle = 0;       // degrees
  double layer = 0;       // cells
  double lengths = 8;     // of the packet, in wave lengths
};

dem::DemMaterial material()
{
  dem::DemMaterial m;
  m.poissons_ratio = 0.3;
  return m;
}

template <int dim>
std::vector<core::BoundaryLoad<dim>> absorbing_top(const AbsorbingParameters &p)
{
  core::BoundaryLoad<dim> load;
  load.boundary = 2 * dim - 1;
  load.kind = core::BoundaryLoad<dim>::Kind::traction;
  load.absorbing = true;
  load.absorbing_layer = p.layer * cell_size;
  return {load};
}

/// Length of the strip: the packet starts in its middle below the layer.
struct Course
{
  double width, reach, length;

  Course(const AbsorbingParameters &p, double angle)
      : width(p.lengths / 4 * p.wave_length * cell_size / std::cos(angle * M_PI / 180)),
        reach(std::max(4.5 * width, 20. * cell_size)), length(3 * reach + p.layer * cell_size)
  {
  }
  double centre() const { return 1.5 * reach; }
  /// To the side and back, behind the start.
  double way() const { return 2 * (length - centre()); }
};

/// Runs until the middle of the packet would be back where it started; energy then over energy
/// before. Waves of the other kind may have run further: the strip is long enough for them.
template <int dim, typename Energy>
double reflected(coupling::Bodies<dim> bodies, double dt, double duration, Energy energy)
{
  core::Timers timers;
  coupling::NullCoupler<dim> coupler(timers);
  const double before = energy();
  coupling::StepTime time;
  time.dt = dt;
  for (const long end = std::lround(duration / dt); time.step < end; ++time.step) {
    coupler.compute_forces(bodies, time);
    coupler.kick(bodies, time);
    coupler.drift(bodies, time);
    time.time += dt;
  }
  return energy() / before;
}

/// Plane waves vary along the first and the last axis alone.
template <int dim>
packings::Across<dim> thin(int across)
{
  packings::Across<dim> n = 3;
  n.n[0] = across;
  return n;
}

template <int dim>
double slowest(const Packet<dim> &, const Dispersion<dim> &medium, const Vector<dim> &k,
               WaveKind kind)
{
  const auto frequency = [&](double factor) {
    Vector<dim> q = k;
    q[dim - 1] *= factor;
    return select_mode<dim>(medium(q), polarisation<dim>(kind, q)).frequency;
  };
  return (frequency(1.001) - frequency(0.999)) / (0.002 * k[dim - 1]);
}

template <int dim>
double reflected_by_mesh(const AbsorbingParameters &p)
{
  const auto wave = fit_wave<dim>(p.wave_length, p.angle, cell_size);
  const Course course(p, wave.angle);
  const auto constants = material().template elastic_constants<dim>();
  fem::Body<dim> body;
  body.stiffness = constants.stiffness;
  body.density = constants.density;
  fem::FemSolver<dim> far(make_periodic_mesh<dim>(thin<dim>(wave.cells_across),
                                                  int(course.length / cell_size), cell_size, 0),
                          body, absorbing_top<dim>(p));
  // As in a coupled body: far below the mesh's own stable step.
  const double dt = 0.25 * far.stable_step();
  const Dispersion<dim> medium = [&](const Vector<dim> &k) {
    return mesh_modes<dim>(k, constants.stiffness, constants.density, cell_size);
  };
  const Packet<dim> packet(medium, wave.wave_vector, p.kind, course.width, course.centre(), dt);
  for (int i = 0; i < far.mesh().n_nodes(); ++i) {
    const auto [displacement, velocity] = packet.at(far.mesh().nodes[i]);
    set<dim>(far.displacement, i, Vector<dim>(displacement));
    set<dim>(far.velocity, i, Vector<dim>(velocity));
  }
  const double speed = slowest<dim>(packet, medium, wave.wave_vector, p.kind);
  return reflected<dim>({nullptr, &far}, dt, course.way() / speed,
                        [&] { return far.kinetic_energy(0) + far.potential_energy(); });
}

template <int dim>
double reflected_by_packing(const AbsorbingParameters &p)
{
  const auto wave = fit_wave<dim>(2 * p.wave_length, p.angle, cell_size / 2.);
  const Course course(p, wave.angle);
  const auto kind = dim == 2 ? packings::LatticeKind::hexagonal : packings::LatticeKind::fcc;
  auto packing =
      packings::make_periodic_packing<dim>(kind, thin<dim>(wave.cells_across * cell_size / 2),
                                           int(course.length / layer_height<dim>), true);
  particles::Particles<dim> state;
  packings::fill_particles(packing, material().density, state);
  const auto constants = material().template elastic_constants<dim>();
  auto dashpots = packings::absorbing_dashpots<dim>(
      packing, state, absorbing_top<dim>(p),
      {{material().density,
        packings::isotropic_speeds<dim>(constants.wave_speed_p, constants.wave_speed_s)}});
  particles::ParticleSolver<dim> zone(
      std::move(state),
      std::make_unique<dem::ManyBodyForce<dim>>(std::move(packing), material(),
                                                std::vector<core::BoundaryLoad<dim>>()));
  zone.dashpots = std::move(dashpots);
  const double dt = 0.9 * zone.force->stable_step(zone.state);
  const auto waves = make_bloch_waves<dim>(material());
  const Dispersion<dim> medium = [&](const Vector<dim> &k) { return waves.modes(k); };
  const Packet<dim> packet(medium, wave.wave_vector, p.kind, course.width, course.centre(), dt);
  set_packet(zone.state, packet, 1e-8);
  const double speed = slowest<dim>(packet, medium, wave.wave_vector, p.kind);
  return reflected<dim>({&zone, nullptr}, dt, course.way() / speed, [&] {
    zone.compute_forces(0);
    return zone.kinetic_energy(0) + zone.potential_energy();
  });
}

/// A random packing is no wave guide of exact modes: the packet is that of the continuum, in a
/// strip whose sides slide on mirrors. What the packing scatters counts as reflected.
template <int dim>
double reflected_by_random_packing(const AbsorbingParameters &p)
{
  const Course course(p, 0);
  const bool is_p = p.kind == WaveKind::p;
  constexpr double across = dim == 2 ? 12 : 6;
  Point size{across, across, across};
  size[dim - 1] = course.length;
  Scene scene = unit_scene(dim, size, material().poissons_ratio);
  scene.zone.packing = PackingKind::random;
  // S waves move along the first axis.
  for (int side = 0; side < 2 * dim - 2; ++side) {
    auto &mirror = scene.loads.emplace_back();
    mirror.boundary = side;
    mirror.kind = LoadKind::displacement;
    mirror.value[is_p || side / 2 > 0 ? side / 2 : dim - 1] = 0;
  }
  auto &top = scene.loads.emplace_back();
  top.boundary = 2 * dim - 1;
  top.kind = LoadKind::traction;
  top.absorbing = true;
  top.absorbing_layer = p.layer * cell_size;
  UnitBody<dim> unit(scene);
  auto &zone = *unit.body.zone;
  const auto constants = unit.body.force()->elastic_constants();
  const double speed = is_p ? constants.wave_speed_p : constants.wave_speed_s,
               k = 2 * M_PI / (p.wave_length * cell_size),
               start = course.centre() - course.length / 2;
  const int component = is_p ? dim - 1 : 0;
  const auto wave = [&](double z) {
    const double x = (z - start) / course.width;
    return 1e-8 * std::exp(-x * x / 2) * std::cos(k * (z - start));
  };
  const double dt = unit.body.dt, h = 1e-3; // of the central differences
  // Half the curl of a motion along x: about -z in 2D, about +y in 3D.
  const double turn = dim == 2 ? -0.5 : 0.5;
  for (int i = 0; i < zone.state.size(); ++i) {
    const double z = zone.state.reference[dim - 1][i];
    const auto slope = [&](double at) { return (wave(at + h) - wave(at - h)) / (2 * h); };
    zone.state.displacement[component][i] = wave(z);
    zone.state.velocity[component][i] = -speed * slope(z + speed * dt / 2);
    if (is_p)
      continue;
    const double rate =
        -speed * (slope(z + h + speed * dt / 2) - slope(z - h + speed * dt / 2)) / (2 * h);
    zone.state.rotation[dim == 2 ? 0 : 2][i] = (dim == 2 ? 1 : 0.5) * turn * slope(z);
    zone.state.spin[dim == 2 ? 0 : 1][i] = turn * rate;
  }
  return reflected<dim>({&zone, nullptr}, dt, course.way() / speed, [&] {
    zone.compute_forces(0);
    return zone.kinetic_energy(0) + zone.potential_energy();
  });
}

/// P and S at normal incidence ("must") and at oblique ones (stated: only below 1).
template <typename Measure>
std::vector<Result> measure(const std::string &name, Measure reflect, double layer, double must,
                            const std::vector<double> &angles, double lengths = 8)
{
  std::vector<Result> results;
  for (const double angle : angles)
    for (const auto kind : {WaveKind::p, WaveKind::s}) {
      AbsorbingParameters p;
      p.kind = kind;
      p.angle = angle;
      p.layer = layer;
      p.lengths = lengths;
      results.push_back(
          {fmt::format("{}/{}_8h_{:g}deg", name, kind == WaveKind::p ? "P" : "S", angle),
           reflect(p),
           angle > 0 ? 1 : must,
           {}});
    }
  return results;
}
} // namespace

std::vector<Case> absorbing_cases()
{
  const std::string text = "energy that an absorbing side reflects, waves of 8 cells: ";
  return {
      {"absorbing_2d", text + "mesh, dashpots alone", false,
       [] {
         return measure("absorbing_2d", reflected_by_mesh<2>, 0, 1e-3, {0, 45});
       }},
      {"absorbing_2d_layer", text + "mesh, with a layer of 16 cells", false,
       [] {
         return measure("absorbing_2d_layer", reflected_by_mesh<2>, 16, 1e-3, {0, 45});
       }},
      {"absorbing_3d", text + "3D mesh, dashpots alone", false,
       [] { return measure("absorbing_3d", reflected_by_mesh<3>, 0, 1e-3, {0}); }},
      {"absorbing_3d_layer", text + "3D mesh, with a layer of 16 cells", true,
       [] {
         return measure("absorbing_3d_layer", reflected_by_mesh<3>, 16, 1e-3, {0, 45});
       }},
      {"absorbing_random", text + "random packing, with a layer of 16 cells", true,
       [] { return measure("absorbing_random", reflected_by_random_packing<2>, 16, 1e-3, {0}); }},
      {"absorbing_random_3d", text + "3D random packing, with a layer of 16 cells", true,
       [] {
         return measure("absorbing_random_3d", reflected_by_random_packing<3>, 16, 1e-3, {0});
       }},
      {"absorbing_particles", text + "hexagonal packing, with a layer of 16 cells", true,
       [] { return measure("absorbing_particles", reflected_by_packing<2>, 16, 1e-3, {0}); }},
      {"absorbing_particles_3d", text + "FCC packing, with a layer of 16 cells", true,
       [] { return measure("absorbing_particles_3d", reflected_by_packing<3>, 16, 1e-3, {0}); }},
      {"absorbing_particles_oblique", text + "hexagonal packing at 45 degrees, short packets", true,
       [] {
         return measure("absorbing_particles_oblique", reflected_by_packing<2>, 16, 1e-3, {45}, 4);
       }},
      {"absorbing_particles_3d_oblique", text + "FCC packing at 45 degrees, short packets", true,
       [] {
         return measure("absorbing_particles_3d_oblique", reflected_by_packing<3>, 16, 1e-3, {45},
                        4);
       }}};
}
} // namespace ligament::program
