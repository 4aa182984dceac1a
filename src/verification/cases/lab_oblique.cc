// Packets of waves that leave a zone inside the far field at any angle: what stays in the zone.
#include "src/verification/bodies/outlines.h"
#include "src/verification/cases/lab.h"
#include "src/verification/cases/wave_passage.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.3, cell_size = 4, wave_length = 8 * cell_size, width = 1.5 * wave_length;
constexpr double reach = 4 * width; // there the packet has fallen to 3e-4

/// Of a packet exp(-x^2/2 width^2) about the origin, per wave vector of its spectrum.
struct Wave
{
  Vector<2> vector; // rad/m
  std::array<std::complex<double>, 3> displacement, velocity;
};

Vector<2> turned(const Vector<2> &x, double angle)
{
  return {std::cos(angle) * x[0] - std::sin(angle) * x[1],
          std::sin(angle) * x[0] + std::cos(angle) * x[1]};
}

/// Modes of the hexagonal packing turned by `orientation`, travelling near `direction` (rad). As
/// the leap-frog has them: displacements at time 0, velocities half a step before.
std::vector<Wave> spectrum(const dem::DemMaterial &material, WaveKind kind, double direction,
                           double orientation, double dt)
{
  const auto bloch = make_bloch_waves<2>(material);
  const Vector<2> middle = turned(Vector<2>(2 * M_PI / wave_length, 0), direction);
  // Repeats itself behind three times the reach; the spectrum has fallen as far as the packet.
  const double step = 2 * M_PI / (3 * reach);
  const int n = int(std::ceil(4 / width / step));
  std::vector<Wave> waves;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j) {
      const Vector<2> off = step * Vector<2>(i, j), k = middle + off;
      const Vector<2> own = turned(k, -orientation), along = own.normalized();
      const auto mode = select_mode<2>(
          bloch.modes(own), kind == WaveKind::p ? along : Vector<2>(-along[1], along[0]));
      const double share = std::exp(-off.squaredNorm() * width * width / 2);
      const std::complex<double> rate =
          std::complex<double>(0, -mode.frequency) *
          std::exp(std::complex<double>(0, std::asin(mode.frequency * dt / 2)));
      Wave wave{k, {}, {}};
      const double c = std::cos(orientation), s = std::sin(orientation);
      const auto &a = mode.amplitude;
      wave.displacement = {share * (c * a[0] - s * a[1]), share * (s * a[0] + c * a[1]),
                           share * a[2]};
      for (int d = 0; d < 3; ++d)
        wave.velocity[d] = rate * wave.displacement[d];
      waves.push_back(wave);
    }
  return waves;
}

/// Particles of the zone follow the packet, its middle at `from`; those of the overlap and the mesh
/// are at rest.
void start(const std::vector<Wave> &waves, const Vector<2> &from, CoupledBody<2> &body)
{
  const auto &overlap = *body.coupler->overlap();
  auto &state = body.zone->state;
  constexpr double amplitude = 1e-8 * wave_length;
  for (int i = 0; i < state.size(); ++i) {
    const Vector<2> x = get(state.reference, i) - from;
    if (overlap.member_of_particle[i] >= 0 || x.norm() > 1.2 * reach)
      continue;
    std::array<double, 3> u = {}, v = {};
    for (const Wave &wave : waves) {
      const double phase = wave.vector.dot(x);
      const std::complex<double> turn(std::cos(phase), std::sin(phase));
      for (int d = 0; d < 3; ++d) {
        u[d] += (wave.displacement[d] * turn).real();
        v[d] += (wave.velocity[d] * turn).real();
      }
    }
    const double scale = amplitude / double(waves.size());
    set(state.displacement, i, scale * Vector<2>(u[0], u[1]));
    set(state.velocity, i, scale * Vector<2>(v[0], v[1]));
    state.rotation[0][i] = scale * u[2];
    state.spin[0][i] = scale * v[2];
  }
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
}

/// Of the particles inside the overlap; half of a packet's energy.
double kinetic_energy(const CoupledBody<2> &body)
{
  const auto &state = body.zone->state;
  double sum = 0;
  for (int i = 0; i < state.size(); ++i)
    if (body.coupler->overlap()->member_of_particle[i] < 0)
      sum += state.mass[i] * get(state.velocity, i).squaredNorm() +
             state.inertia(i) * get(state.spin, i).squaredNorm();
  return sum / 2;
}

/// Share of the energy that is in the zone when the end of the packet has left overlap and
/// transition. The zone is so long that the packet meets the middle of one side, and what that
/// throws back as the same kind of wave is still inside.
double energy_left(WaveKind kind, double direction)
{
  const double orientation = 11 * M_PI / 180, far_width = 7.6 * width;
  const int normal = std::abs(std::cos(direction)) >= std::abs(std::sin(direction)) ? 0 : 1;
  const Vector<2> along = turned(Vector<2>(1, 0), direction);
  Scene scene = unit_scene(2, {0, 0, 0}, nu);
  const double beyond =
      (scene.coupling.overlap_cells + scene.coupling.transition_cells) * cell_size;
  const double way = (2 * reach + beyond) / along[normal];
  Vector<2> half, from = Vector<2>::Zero();
  from[1 - normal] = -along[1 - normal] * way / 2;
  half[normal] = reach;
  half[1 - normal] = reach - from[1 - normal];
  for (int c = 0; c < 2; ++c)
    scene.specimen.size[c] = 2 * (half[c] + far_width);
  add_far_field(scene, {2 * half[0], 2 * half[1], 0}, cell_size);
  scene.zone.orientation[0] = orientation;
  scene.coupling.fine_damper = 4;
  UnitBody<2> unit(scene);
  auto &body = unit.body;
  dem::DemMaterial material;
  material.poissons_ratio = nu;
  start(spectrum(material, kind, direction, orientation, body.dt), from, body);
  const double before = kinetic_energy(body);

  const auto constants = body.force()->elastic_constants();
  const double speed = kind == WaveKind::p ? constants.wave_speed_p : constants.wave_speed_s;
  const double end = way / speed;
  // The outer sides are heard then, by the faster waves.
  const double answer = far_width / speed + far_width / constants.wave_speed_p;
  auto bodies = body.bodies();
  coupling::StepTime step{0, 0, body.dt};
  for (; step.time < std::min(end, answer);
       step = {step.step + 1, double(step.step + 1) * step.dt, step.dt})
  {
    body.coupler->compute_forces(bodies, step);
    body.coupler->kick(bodies, step);
    body.coupler->drift(bodies, step);
  }
  return step.time < end ? NAN : kinetic_energy(body) / before;
}

std::vector<Result> measure(const std::string &name, const std::vector<double> &degrees)
{
  // At normal incidence 1e-4 (docs/verification_waves.md).
  constexpr double must = 2e-4;
  std::vector<Result> results;
  for (const double angle : degrees)
    for (const auto kind : {WaveKind::p, WaveKind::s})
      results.push_back({fmt::format("{}/{}_{:g}", name, kind == WaveKind::p ? "P" : "S", angle),
                         energy_left(kind, angle * M_PI / 180),
                         must,
                         {}});
  return results;
}
} // namespace

std::vector<Case> lab_oblique_cases()
{
  return {
      {"lab_oblique", "packets of 8 cells leave a closed zone at 0, 17 and 53 degrees", true, [] {
         return measure("lab_oblique", {0, 17, 53});
       }}};
}
} // namespace ligament::program
