#include "src/verification/waves.h"

#include "dem/many_body_force.h"
#include "src/verification/bloch.h"
#include "src/verification/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// Plane packet exp(-(z - centre)^2/(2 width^2)) of Bloch modes that all travel upwards.
template <int dim>
class Packet
{
public:
  Packet(const BlochWaves<dim> &waves, const Vector<dim> &polarisation, double wave_number,
         double width, double centre, double dt)
      : centre_(centre)
  {
    // A sum over wave numbers repeats itself after 2 pi over their distance: 170 wave lengths.
    constexpr int half = 80;
    const double spread = 1 / width, step = 6 * spread / half;
    for (int i = -half; i <= half; ++i) {
      const double k = wave_number + i * step;
      if (k <= 0)
        continue;
      const auto mode = waves.mode(k, polarisation);
      // Discrete time: sin(omega dt/2) = frequency dt/2; velocities belong to -dt/2.
      const double omega = 2 / dt * std::asin(mode.frequency * dt / 2);
      const double weight = std::exp(-0.5 * std::pow((k - wave_number) / spread, 2)) * step *
                            width / std::sqrt(2 * M_PI);
      const std::complex<double> rate = (1. - std::polar(1., omega * dt)) / dt;
      waves_.push_back({k, weight * mode.amplitude, weight * rate * mode.amplitude});
    }
  }

  using Motion = Eigen::Matrix<double, n_particle_dofs<dim>, 1>;

  /// Displacement at time 0 and velocity at -dt/2, for amplitude 1.
  std::pair<Motion, Motion> at(double z) const
  {
    std::pair<Motion, Motion> sum{Motion::Zero(), Motion::Zero()};
    for (const auto &wave : waves_) {
      const auto phase = std::polar(1., wave.number * (z - centre_));
      sum.first += (wave.displacement * phase).real();
      sum.second += (wave.velocity * phase).real();
    }
    return sum;
  }

private:
  struct Wave
  {
    double number;
    Eigen::Matrix<std::complex<double>, n_particle_dofs<dim>, 1> displacement, velocity;
  };
  double centre_;
  std::vector<Wave> waves_;
};

template <int dim>
void set_packet(particles::Particles<dim> &state, const Packet<dim> &packet, double amplitude)
{
  for (int i = 0; i < state.n_owned; ++i) {
    const auto [displacement, velocity] = packet.at(state.reference[dim - 1][i]);
    for (int c = 0; c < dim; ++c) {
      state.displacement[c][i] = amplitude * displacement[c];
      state.velocity[c][i] = amplitude * velocity[c];
    }
    for (int c = 0; c < n_spins<dim>; ++c) {
      state.rotation[dim == 2 ? 0 : c + 1][i] =
          amplitude * (dim == 2 ? 1 : 0.5) * displacement[dim + c]; // small angles
      state.spin[c][i] = amplitude * velocity[dim + c];
    }
  }
}

/// Kinetic energy of the particles below the mesh, in the mean of a wave half of all its energy.
template <int dim>
double kinetic_energy(const Strip<dim> &strip)
{
  const auto &state = strip.zone->state;
  double sum = 0;
  for (int i = 0; i < state.n_owned; ++i)
    if (state.reference[dim - 1][i] < strip.mesh_begin)
      sum += state.mass[i] * get(state.velocity, i).squaredNorm() +
             state.inertia[i] * get(state.spin, i).squaredNorm();
  return sum / 2;
}

template <int dim>
BlochWaves<dim> make_bloch_waves(const dem::DemMaterial &material)
{
  const auto kind = dim == 2 ? particles::LatticeKind::hexagonal : particles::LatticeKind::fcc;
  constexpr int layers = 9;
  auto packing = make_periodic_packing<dim>(kind, 3, layers, true);
  particles::Particles<dim> state;
  particles::fill_particles(packing, material.density, state);
  const dem::ManyBodyForce<dim> force(std::move(packing), material, {});
  return BlochWaves<dim>(state, force, layers / 2, dim - 1);
}
} // namespace

template <int dim>
WaveFigures measure_wave(const WaveParameters &p)
{
  StripParameters strip_parameters;
  strip_parameters.material.poissons_ratio = 0.3;
  strip_parameters.overlap_cells = p.overlap_cells;
  strip_parameters.mesh_shift = p.mesh_shift;
  strip_parameters.split.fine_damper = p.fine_damper;
  strip_parameters.split.gap_filter = p.gap_filter;
  strip_parameters.scheme = p.scheme;
  strip_parameters.weight = p.weight;
  strip_parameters.bridging.fine_damper = p.fine_damper;
  strip_parameters.bridging.multiplier_cells = p.multiplier_cells;
  strip_parameters.step_fraction = p.step_fraction;
  const double h = strip_parameters.cell_size;
  const double wave_length = p.wave_length * h, width = 2 * wave_length;
  // The envelope falls to 4e-5 within 4.5 widths; short packets spread.
  const double reach = std::max(4.5 * width, 20 * h);
  strip_parameters.zone_length = 2 * reach;
  strip_parameters.far_length = reach + 20 * h;
  Strip<dim> strip = make_strip<dim>(strip_parameters);

  const auto waves = make_bloch_waves<dim>(strip_parameters.material);
  const Vector<dim> polarisation = Vector<dim>::Unit(p.kind == WaveKind::p ? dim - 1 : 0);
  const double wave_number = 2 * M_PI / wave_length;
  const Packet<dim> packet(waves, polarisation, wave_number, width, strip.mesh_begin - reach,
                           strip.dt);
  set_packet(strip.zone->state, packet, 1e-8 * wave_length);
  auto bodies = strip.bodies();
  strip.coupler->take_velocities(bodies);
  const double before = kinetic_energy(strip);

  // Until the packet has passed overlap and transition and what comes back has left them.
  const double way = 2 * reach + 3 * (p.overlap_cells + strip_parameters.transition_cells + 2) * h;
  const double speed = waves.group_velocity(wave_number, polarisation);
  coupling::StepTime time;
  time.dt = strip.dt;
  const auto mechanical = [](const coupling::CoupledEnergy &e) {
    return e.kinetic_discrete + e.kinetic_far + e.potential_discrete + e.potential_far + e.blended;
  };
  double whole = 0;
  for (const long end = std::lround(way / (speed * strip.dt)); time.step < end; ++time.step) {
    strip.coupler->compute_forces(bodies, time);
    if (time.step == 0)
      whole = mechanical(strip.coupler->energy(bodies, time));
    strip.coupler->kick(bodies, time);
    strip.coupler->drift(bodies, time);
    time.time += time.dt;
  }
  strip.coupler->compute_forces(bodies, time);
  const auto e = strip.coupler->energy(bodies, time);
  const double lost = e.fine_damper + e.gap_filter;
  double seconds = 0;
  for (const auto &row : strip.timers->rows())
    if (row.name == "coupling")
      seconds = row.seconds;
  return {kinetic_energy(strip) / before, lost / whole, 1 - (mechanical(e) + lost) / whole,
          seconds / double(time.step * strip.coupler->overlap()->members.size())};
}

namespace
{
struct Bound
{
  double wave_length;     // cells
  double reflected, lost; // "must"; aims are a tenth and a seventh of them; 0: not bounded
};

/// Figures of P and S waves of these lengths.
template <int dim>
std::vector<Result> measure(const std::string &name, WaveParameters parameters,
                            const std::vector<Bound> &bounds)
{
  std::vector<Result> results;
  for (const Bound &bound : bounds)
    for (const auto kind : {WaveKind::p, WaveKind::s}) {
      parameters.kind = kind;
      parameters.wave_length = bound.wave_length;
      const WaveFigures figures = measure_wave<dim>(parameters);
      const auto figure = [&](const char *what) {
        return fmt::format("{}/{}_{}_{:g}h", name, what, kind == WaveKind::p ? "P" : "S",
                           bound.wave_length);
      };
      results.push_back(
          {figure("reflected"), figures.reflected, bound.reflected, bound.reflected / 10});
      if (bound.lost > 0)
        results.push_back({figure("lost"), figures.lost, bound.lost, bound.lost / 7});
    }
  return results;
}

/// Phase velocity of P waves across the layers of the hexagonal packing against the table of
/// theory.md (nu 0.3, plane strain; 10, 20 and 40 particles per wave length).
std::vector<Result> measure_dispersion()
{
  dem::DemMaterial material;
  material.poissons_ratio = 0.3;
  const auto waves = make_bloch_waves<2>(material);
  double worst = 0;
  for (const auto &[per_wave, slower] :
       {std::pair{10., 0.0277}, std::pair{20., 0.0070}, std::pair{40., 0.0018}})
  {
    const double k = 2 * M_PI / per_wave;
    const double speed = waves.mode(k, Vector<2>(0, 1)).frequency / k;
    const double exact = material.elastic_constants<2>().wave_speed_p;
    worst = std::max(worst, std::abs(1 - speed / exact - slower));
  }
  return {{"dispersion/phase_velocity", worst, 1e-4, 5e-5}};
}

template <int dim>
Case wave_case(const std::string &name, const std::string &text, bool slow,
               const WaveParameters &parameters, const std::vector<Bound> &bounds)
{
  return {name, text, slow, [=] { return measure<dim>(name, parameters, bounds); }};
}
} // namespace

std::vector<Case> wave_cases()
{
  WaveParameters elastic, fracture, weak;
  fracture.fine_damper = 8, fracture.gap_filter = 4;
  weak.overlap_cells = 4, weak.gap_filter = 4;
  const std::string text = "energy that the overlap reflects: ";
  return {{"dispersion", "phase velocity of P waves in the hexagonal packing against the table",
           false, measure_dispersion},
          wave_case<2>("waves_2d", text + "2D, waves of 8 and 4 cells, cf 4, cg 0", false, elastic,
                       {{8, 1e-4, 7e-3}, {4, 6e-3, 0}}),
          wave_case<2>("waves_2d_long", text + "2D, waves of 16 and 6 cells, cf 4, cg 0", true,
                       elastic, {{16, 5e-6, 0}, {6, 6e-4, 0}}),
          wave_case<2>("waves_2d_short", text + "2D, waves of one cell and less, cf 4, cg 0", false,
                       elastic, {{1, 1e-2, 0}, {0.75, 1e-2, 0}}),
          wave_case<2>("waves_2d_fracture", text + "2D, dampers for fracture, cf 8, cg 4", true,
                       fracture, {{16, 5e-6, 0}, {8, 1e-4, 0}, {6, 6e-4, 0}, {4, 6e-3, 0}}),
          wave_case<2>("waves_2d_weak_band", text + "2D, overlap of 4 cells, cf 4, cg 4", true,
                       weak, {{3, 0.35, 0}, {2.5, 0.35, 0}, {2, 0.35, 0}, {1.6, 0.35, 0}}),
          wave_case<3>("waves_3d", text + "FCC, waves of 16 to 4 cells, cf 4, cg 0", true, elastic,
                       {{16, 1e-5, 0}, {8, 3e-4, 7e-3}, {6, 1.5e-3, 0}, {4, 1.5e-2, 0}}),
          wave_case<3>("waves_3d_fracture", text + "FCC, dampers for fracture, cf 8, cg 4", true,
                       fracture, {{16, 1e-5, 0}, {8, 3e-4, 0}, {6, 1.5e-3, 0}, {4, 1.5e-2, 0}})};
}

template WaveFigures measure_wave<2>(const WaveParameters &);
template WaveFigures measure_wave<3>(const WaveParameters &);
} // namespace ligament::program
