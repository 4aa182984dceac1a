// What a side that lets waves out reflects, of the mesh and of a packing.
#include "dem/many_body_force.h"
#include "particles/absorbing_sides.h"
#include "src/verification/cases.h"
#include "src/verification/unit_bodies.h"
#include "src/verification/wave_passage.h"

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

/// Length of the strip: the packet of eight wave lengths starts in its middle below the layer.
struct Course
{
  double width, reach, length;

  Course(const AbsorbingParameters &p, double angle)
      : width(2 * p.wave_length * cell_size / std::cos(angle * M_PI / 180)),
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
  fem::FemSolver<dim> far(
      make_periodic_mesh<dim>(wave.cells_across, int(course.length / cell_size), cell_size, 0),
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
  const auto wave = fit_wave<dim>(p.wave_length, p.angle, cell_size);
  const Course course(p, wave.angle);
  const auto kind = dim == 2 ? particles::LatticeKind::hexagonal : particles::LatticeKind::fcc;
  auto packing = make_periodic_packing<dim>(kind, wave.cells_across * cell_size,
                                            int(course.length / layer_height<dim>), true);
  particles::Particles<dim> state;
  particles::fill_particles(packing, material().density, state);
  const auto constants = material().template elastic_constants<dim>();
  auto dashpots =
      particles::absorbing_dashpots<dim>(packing, state, absorbing_top<dim>(p), material().density,
                                         constants.wave_speed_p, constants.wave_speed_s);
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
double reflected_by_random_packing(const AbsorbingParameters &p)
{
  const Course course(p, 0);
  const bool is_p = p.kind == WaveKind::p;
  Scene scene = unit_scene(2, {12, course.length, 0}, material().poissons_ratio);
  scene.zone.packing = "random";
  scene.loads.resize(3);
  for (int side = 0; side < 2; ++side) {
    scene.loads[side].boundary = side_names[side];
    scene.loads[side].kind = "displacement";
    scene.loads[side].value[is_p ? 0 : 1] = 0;
  }
  scene.loads[2].boundary = "top";
  scene.loads[2].kind = "traction";
  scene.loads[2].absorbing = true;
  scene.loads[2].absorbing_layer = p.layer * cell_size;
  UnitBody<2> unit(scene);
  auto &zone = *unit.body.zone;
  const auto constants = unit.body.force->elastic_constants();
  const double speed = is_p ? constants.wave_speed_p : constants.wave_speed_s,
               k = 2 * M_PI / (p.wave_length * cell_size),
               start = course.centre() - course.length / 2;
  const int component = is_p ? 1 : 0;
  const auto wave = [&](double y) {
    const double x = (y - start) / course.width;
    return 1e-8 * std::exp(-x * x / 2) * std::cos(k * (y - start));
  };
  const double dt = unit.body.dt, h = 1e-3; // of the central differences
  for (int i = 0; i < zone.state.n_owned; ++i) {
    const double y = zone.state.reference[1][i];
    const auto slope = [&](double at) { return (wave(at + h) - wave(at - h)) / (2 * h); };
    zone.state.displacement[component][i] = wave(y);
    zone.state.velocity[component][i] = -speed * slope(y + speed * dt / 2);
    if (is_p)
      continue;
    zone.state.rotation[0][i] = -slope(y) / 2; // half the curl
    zone.state.spin[0][i] =
        speed * (slope(y + h + speed * dt / 2) - slope(y - h + speed * dt / 2)) / (4 * h);
  }
  return reflected<2>({&zone, nullptr}, dt, course.way() / speed, [&] {
    zone.compute_forces(0);
    return zone.kinetic_energy(0) + zone.potential_energy();
  });
}

/// P and S at normal incidence ("must") and at oblique ones (stated: only below 1).
template <typename Measure>
std::vector<Result> measure(const std::string &name, Measure reflect, double layer, double must,
                            const std::vector<double> &angles)
{
  std::vector<Result> results;
  for (const double angle : angles)
    for (const auto kind : {WaveKind::p, WaveKind::s}) {
      AbsorbingParameters p;
      p.kind = kind;
      p.angle = angle;
      p.layer = layer;
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
  return {{"absorbing_2d", text + "mesh, dashpots alone", false,
           [] {
             return measure("absorbing_2d", reflected_by_mesh<2>, 0, 1e-3, {0, 45});
           }},
          {"absorbing_2d_layer", text + "mesh, with a layer of 16 cells", false,
           [] {
             return measure("absorbing_2d_layer", reflected_by_mesh<2>, 16, 1e-3, {0, 45});
           }},
          {"absorbing_3d", text + "3D mesh, dashpots alone", false,
           [] { return measure("absorbing_3d", reflected_by_mesh<3>, 0, 1e-3, {0}); }},
          {"absorbing_random", text + "random packing, with a layer of 16 cells", true,
           [] { return measure("absorbing_random", reflected_by_random_packing, 16, 1e-3, {0}); }},
          {"absorbing_particles", text + "hexagonal packing, with a layer of 16 cells", true,
           [] { return measure("absorbing_particles", reflected_by_packing<2>, 16, 1e-3, {0}); }}};
}
} // namespace ligament::program
