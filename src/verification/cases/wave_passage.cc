#include "src/verification/cases/wave_passage.h"

#include "core/check.h"
#include "core/extremes.h"
#include "dem/many_body_force.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
template <int dim>
BlochWaves<dim> make_bloch_waves(const dem::DemMaterial &material)
{
  const auto kind = dim == 2 ? packings::LatticeKind::hexagonal : packings::LatticeKind::fcc;
  constexpr int across = 3, layers = 9;
  auto packing = packings::make_periodic_packing<dim>(kind, across, layers, true);
  particles::Particles<dim> state;
  packings::fill_particles(packing, material.density, state);
  const dem::ManyBodyForce<dim> force(std::move(packing), material, {});
  return BlochWaves<dim>(state, force, layers / 2, dim - 1, across);
}

template <int dim>
void set_packet(particles::Particles<dim> &state, const Packet<dim> &packet, double amplitude)
{
  for (int i = 0; i < state.size(); ++i) {
    const auto [displacement, velocity] = packet.at(get(state.reference, i));
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

template <int dim>
std::vector<Site<dim>> particle_sites(const particles::Particles<dim> &state, double end)
{
  std::vector<Site<dim>> sites;
  for (int i = 0; i < state.size(); ++i) {
    if (state.reference[dim - 1][i] > end)
      continue;
    Site<dim> site{get(state.reference, i), Eigen::VectorXd(n_particle_dofs<dim>),
                   Eigen::VectorXd(n_particle_dofs<dim>)};
    for (int c = 0; c < dim; ++c) {
      site.displacement[c] = state.displacement[c][i];
      site.velocity[c] = state.velocity[c][i];
    }
    for (int c = 0; c < n_spins<dim>; ++c) {
      site.displacement[dim + c] =
          (dim == 2 ? 1 : 2) * state.rotation[dim == 2 ? 0 : c + 1][i]; // small angles
      site.velocity[dim + c] = state.spin[c][i];
    }
    sites.push_back(std::move(site));
  }
  return sites;
}

template <int dim>
std::vector<Site<dim>> node_sites(const fem::FemSolver<dim> &far, double begin)
{
  // Nodes at the end of the mesh have half the mass of the others; waves don't get there.
  double end = begin;
  for (const auto &x : far.mesh().nodes)
    end = std::max(end, x[dim - 1]);
  std::vector<Site<dim>> sites;
  for (int i = 0; i < far.mesh().n_nodes(); ++i) {
    const auto &x = far.mesh().nodes[i];
    if (x[dim - 1] > begin && x[dim - 1] < end * (1 - 1e-9))
      sites.push_back({x, get(far.displacement, i), get(far.velocity, i)});
  }
  return sites;
}

namespace
{
/// Whole waves on whole cells.
struct Fit
{
  int cells, waves;
};

/// Narrowest strip whose wave comes within 2 % of the tangential one; else the best.
Fit fit_strip(double cells_per_wave)
{
  Fit best{3, 0};
  if (!std::isfinite(cells_per_wave))
    return best;
  double error = std::numeric_limits<double>::max();
  for (int cells = 3; cells <= 40; ++cells) {
    const int waves = std::max(1, int(std::lround(cells / cells_per_wave)));
    const double e = std::abs(cells / (waves * cells_per_wave) - 1);
    if (e < error) {
      best = {cells, waves};
      error = e;
    }
    if (error < 0.02)
      break;
  }
  return best;
}

/// Speeds along the last axis of the waves that share a frequency and the tangential wave number.
struct Speeds
{
  double slowest = std::numeric_limits<double>::max(), fastest = 0;

  Speeds(double frequency, double tangential, double normal_speed,
         std::initializer_list<double> wave_speeds)
  {
    take(normal_speed);
    for (const double c : wave_speeds) {
      const double k2 = std::pow(frequency / c, 2) - tangential * tangential;
      if (tangential > 0 && k2 > 0)
        take(c * c * std::sqrt(k2) / frequency);
    }
  }
  void take(double speed)
  {
    keep_smallest(slowest, speed);
    keep_largest(fastest, speed);
  }
};

/// Measures the energy of both halves by kind of wave.
template <int dim>
class WaveMeter
{
public:
  WaveMeter(const Dispersion<dim> &packing, const Dispersion<dim> &mesh, double tangential,
            int cell_size, double mesh_from)
      : packing_(packing), mesh_(mesh), cell_size_(cell_size), mesh_from_(mesh_from)
  {
    // The mesh repeats itself after a cell: it scatters waves of the packing into these.
    for (int i = 0; i < (dim == 2 ? cell_size : cell_size * cell_size); ++i) {
      Vector<dim> k = Vector<dim>::Zero();
      for (int c = 0, rest = i; c < dim - 1; ++c, rest /= cell_size) {
        const int n = rest % cell_size;
        k[c] = 2 * M_PI / cell_size * (n > cell_size / 2 ? n - cell_size : n);
      }
      k[0] += tangential;
      lateral_.push_back(k);
    }
  }

  WaveEnergy particles(const Strip<dim> &strip) const
  {
    return measure_energy<dim>(packing_, particle_sites<dim>(strip.zone->state, strip.mesh_begin),
                               layer_height<dim>, lateral_, strip.dt);
  }
  WaveEnergy mesh(const Strip<dim> &strip) const
  {
    return measure_energy<dim>(mesh_, node_sites(*strip.far, mesh_from_), cell_size_, {lateral_[0]},
                               strip.dt);
  }

private:
  Dispersion<dim> packing_, mesh_;
  int cell_size_;
  double mesh_from_;
  std::vector<Vector<dim>> lateral_;
};

template <int dim>
void run(Strip<dim> &strip, long n_steps, coupling::StepTime &time)
{
  auto bodies = strip.bodies();
  for (; time.step < n_steps; ++time.step, time.time += time.dt) {
    strip.coupler->compute_forces(bodies, time);
    strip.coupler->kick(bodies, time);
    strip.coupler->drift(bodies, time);
  }
  strip.coupler->compute_forces(bodies, time);
}

WaveEnergy operator/(const WaveEnergy &e, double whole)
{
  return {e.p / whole, e.s / whole, e.rest / whole};
}
} // namespace

template <int dim>
StripWave<dim> fit_wave(double wave_length, double angle, double cell_size)
{
  const Fit fit = fit_strip(angle > 0 ? wave_length / std::sin(angle * M_PI / 180)
                                      : std::numeric_limits<double>::infinity());
  const double k = 2 * M_PI / (wave_length * cell_size);
  StripWave<dim> wave{fit.cells, Vector<dim>::Zero(), 0};
  wave.wave_vector[0] = 2 * M_PI * fit.waves / (fit.cells * cell_size);
  core::require(wave.wave_vector[0] < k, "no strip fits a wave of this length and angle");
  wave.wave_vector[dim - 1] = std::sqrt(k * k - std::pow(wave.wave_vector[0], 2));
  wave.angle = std::asin(wave.wave_vector[0] / k) * 180 / M_PI;
  return wave;
}

template <int dim>
PassageFigures measure_passage(const PassageParameters &p)
{
  StripParameters sp = p.strip;
  const double h = sp.cell_size, wave_length = p.wave_length * h, k = 2 * M_PI / wave_length;
  const StripWave<dim> wave = fit_wave<dim>(p.wave_length, p.angle, h);
  Vector<dim> wave_vector = wave.wave_vector;
  if (!p.outwards)
    wave_vector[dim - 1] *= -1;
  PassageFigures figures;
  figures.angle = wave.angle;

  const auto constants = sp.material.template elastic_constants<dim>();
  const auto waves = make_bloch_waves<dim>(sp.material);
  const Dispersion<dim> packing = [&](const Vector<dim> &q) { return waves.modes(q); };
  const Dispersion<dim> mesh = [&](const Vector<dim> &q) {
    return mesh_modes<dim>(q, constants.stiffness, constants.density, h);
  };
  const Dispersion<dim> &medium = p.outwards ? packing : mesh;
  const auto frequency = [&](double dk) {
    Vector<dim> q = wave_vector;
    q[dim - 1] += dk;
    return select_mode<dim>(medium(q), polarisation<dim>(p.kind, q)).frequency;
  };
  const double normal_speed = std::abs(frequency(1e-4 * k) - frequency(-1e-4 * k)) / (2e-4 * k);
  const Speeds speeds(frequency(0), wave_vector[0], normal_speed,
                      {constants.wave_speed_p, constants.wave_speed_s});

  // The envelope falls to 4e-5 within 4.5 widths; short packets spread.
  const double width = p.lengths / 4 * wave_length / std::cos(figures.angle * M_PI / 180);
  const double reach = std::max(4.5 * width, 20 * h);
  const double near = (sp.overlap_cells + sp.transition_cells + 2) * h;
  const double duration = 2 * reach / normal_speed + 3 * near / speeds.slowest;
  sp.cells_across = wave.cells_across;
  sp.zone_length = std::max(2 * reach, duration * speeds.fastest) + 20 * h;
  sp.far_length = sp.zone_length + near;
  Strip<dim> strip = make_strip<dim>(sp);

  const double mesh_from = strip.mesh_begin + near - h;
  const Packet<dim> packet(medium, wave_vector, p.kind, width,
                           p.outwards ? strip.mesh_begin - reach : mesh_from + reach, strip.dt);
  const double amplitude = 1e-8 * wave_length;
  if (p.outwards)
    set_packet(strip.zone->state, packet, amplitude);
  else
    for (int i = 0; i < strip.far->mesh().n_nodes(); ++i) {
      const auto [displacement, velocity] = packet.at(strip.far->mesh().nodes[i]);
      set<dim>(strip.far->displacement, i, Vector<dim>(amplitude * displacement));
      set<dim>(strip.far->velocity, i, Vector<dim>(amplitude * velocity));
    }
  auto bodies = strip.bodies();
  strip.coupler->take_velocities(bodies);

  const WaveMeter<dim> meter(packing, mesh, wave_vector[0], sp.cell_size, mesh_from);
  const double whole = (p.outwards ? meter.particles(strip) : meter.mesh(strip)).sum();
  coupling::StepTime time;
  time.dt = strip.dt;
  strip.coupler->compute_forces(bodies, time);
  const double before = mechanical_energy(strip.coupler->energy(bodies, time));
  run(strip, std::lround(duration / strip.dt), time);
  const auto below = meter.particles(strip) / whole, above = meter.mesh(strip) / whole;
  figures.reflected = p.outwards ? below : above;
  figures.transmitted = p.outwards ? above : below;
  figures.lost = 1 - mechanical_energy(strip.coupler->energy(bodies, time)) / before;
  return figures;
}

template BlochWaves<2> make_bloch_waves<2>(const dem::DemMaterial &);
template BlochWaves<3> make_bloch_waves<3>(const dem::DemMaterial &);
template void set_packet<2>(particles::Particles<2> &, const Packet<2> &, double);
template void set_packet<3>(particles::Particles<3> &, const Packet<3> &, double);
template std::vector<Site<2>> particle_sites<2>(const particles::Particles<2> &, double);
template std::vector<Site<3>> particle_sites<3>(const particles::Particles<3> &, double);
template std::vector<Site<2>> node_sites<2>(const fem::FemSolver<2> &, double);
template std::vector<Site<3>> node_sites<3>(const fem::FemSolver<3> &, double);
template StripWave<2> fit_wave<2>(double, double, double);
template StripWave<3> fit_wave<3>(double, double, double);
template PassageFigures measure_passage<2>(const PassageParameters &);
template PassageFigures measure_passage<3>(const PassageParameters &);
} // namespace ligament::program
