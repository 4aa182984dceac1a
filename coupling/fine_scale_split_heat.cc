// The default coupler at a temperature: its heat baths, and the load that thermal motion adds.
#include "coupling/fine_scale_split.h"
#include "coupling/operators/fine_damper.h"

#include <Eigen/QR>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::coupling
{
namespace
{
constexpr int n_blocks = 20; // whose means tell the error of the whole mean

/// Mean over time of nodal forces.
template <int dim>
class BlockMean
{
public:
  BlockMean(int n_nodes, long per_block)
      : per_block_(per_block), block_(Nodal<dim>::Zero(n_nodes, dim)), mean_(block_),
        square_(block_)
  {
  }
  void add(const Nodal<dim> &force)
  {
    block_ += force / double(per_block_);
    if (++n_ % per_block_ != 0)
      return;
    mean_ += block_ / n_blocks;
    square_ += block_.cwiseProduct(block_) / n_blocks;
    block_.setZero();
  }
  const Nodal<dim> &value() const { return mean_; }
  /// Standard error, root mean square over the loaded nodes.
  double error() const
  {
    const double variance =
        (square_ - mean_.cwiseProduct(mean_)).cwiseMax(0).sum() / (n_blocks - 1);
    const double n_loaded = (mean_.rowwise().norm().array() > 0).template cast<double>().sum();
    return n_loaded > 0 ? std::sqrt(variance / n_loaded) : 0;
  }

private:
  long per_block_, n_ = 0;
  Nodal<dim> block_, mean_, square_;
};
} // namespace

template <int dim>
void FineScaleSplit<dim>::join_bath(const Bodies<dim> &bodies, double dt)
{
  zone_bath_.emplace(overlap_, bodies.zone->state.size());
  if (parameters_.fine_damper == 0)
    return;
  const double speed = bodies.zone->force->elastic_constants().wave_speed_p;
  fine_.join_bath(overlap_, [&](double s) {
    return std::exp(-dt * fine_damper_rate(parameters_.fine_damper, speed, overlap_.cell_size, s));
  });
}

template <int dim>
void FineScaleSplit<dim>::exchange_heat(Bodies<dim> &bodies, const StepTime &step)
{
  auto &zone = bodies.zone->state;
  const core::ThermalNoise noise(parameters_.seed, step.step);
  fine_.exchange_heat(parameters_.thermal_energy, noise, step.dt, near_.velocity(), zone);
  if (parameters_.zone_friction > 0)
    zone_bath_->exchange_heat(std::exp(-parameters_.zone_friction * step.dt),
                              parameters_.thermal_energy, noise, step.dt, zone);
}

template <int dim>
double FineScaleSplit<dim>::thermal_energy_of_fine(const Bodies<dim> &bodies) const
{
  const long n = fine_.n_free();
  return n > 0 ? 2 * fine_.kinetic_sum(bodies.zone->state, 0).value() / double(n) : 0;
}

template <int dim>
double FineScaleSplit<dim>::thermal_energy_of_zone(const Bodies<dim> &bodies) const
{
  const long n = zone_bath_ ? zone_bath_->n_free() : 0;
  return n > 0 ? 2 * zone_bath_->kinetic_energy(bodies.zone->state) / double(n) : 0;
}

template <int dim>
std::array<double, 3> FineScaleSplit<dim>::thermal_energies(const Bodies<dim> &bodies) const
{
  const Nodal<dim> v = near_.velocity(), momentum = mass_ * v;
  return {thermal_energy_of_zone(bodies), thermal_energy_of_fine(bodies),
          v.cwiseProduct(momentum).sum() / double(dim * overlap_.n_nodes())};
}

// The steps before the first one have numbers below 0, and noise of their own.
template <int dim>
ThermalLoad<dim> FineScaleSplit<dim>::held_thermal_load(Bodies<dim> &bodies, const HeldRun &run,
                                                        double dt)
{
  const auto timing = this->timers_.scope(this->timers_.section("thermal load"));
  auto &zone = *bodies.zone;
  const double energy = parameters_.thermal_energy;
  const Nodal<dim> still = Nodal<dim>::Zero(overlap_.n_nodes(), dim);
  const long per_block = std::max(1l, std::lround(run.averaging / dt / n_blocks)),
             n_first = std::lround(run.equilibration / dt),
             n_steps = n_first + n_blocks * per_block;
  zone_bath_->draw(2 * energy, core::ThermalNoise(parameters_.seed, -n_steps - 1), zone.state);
  fine_.take_velocities(still, zone.state);

  BlockMean<dim> mean(overlap_.n_nodes(), per_block);
  Nodal<dim> force;
  for (long k = 0; k < n_steps; ++k) {
    zone.compute_forces(-dt); // no load acts before the run
    zone.kick(dt);
    force = still;
    fine_.begin_kick(zone.state, dt, force);
    fine_.finish_kick(still, zone.state);
    const core::ThermalNoise noise(parameters_.seed, k - n_steps);
    fine_.exchange_heat(energy, noise, dt, still, zone.state);
    zone_bath_->exchange_heat(std::exp(-run.friction * dt), energy, noise, dt, zone.state);
    zone.drift(dt);
    zone.update_ghosts();
    if (k >= n_first)
      mean.add(force);
  }
  // Nodes stand where they are at rest: half of what they move with becomes strain.
  draw_nodes(bodies, 2 * energy);
  fine_.reset_bath_energy();
  zone_bath_->taken = 0;
  return {balanced(mean.value(), bodies.far->mesh()), mean.error(), n_steps};
}

// Held nodes stay where they are at time 0: that is when every kick ends.
template <int dim>
ThermalLoad<dim> FineScaleSplit<dim>::free_thermal_load(Bodies<dim> &bodies, double averaging,
                                                        double dt)
{
  constexpr int interval = 4;                   // steps; the fastest vibration has thirty
  constexpr std::int64_t before = -(1ll << 40); // the steps of all other runs
  auto &zone = *bodies.zone;
  const long per_block = std::max(1l, std::lround(averaging / (interval * dt * n_blocks))),
             n_samples = n_blocks * per_block;
  BlockMean<dim> mean(overlap_.n_nodes(), per_block);
  Components<dim> mean_place, rest;
  for (auto *places : {&mean_place, &rest})
    for (auto &component : *places)
      component.assign(zone.state.size(), 0.);
  Nodal<dim> force;
  StepTime step{before * parameters_.step_ratio, -dt, dt};
  for (long k = 0; k < interval * n_samples; ++k, ++step.step) {
    compute_forces(bodies, step);
    if (k % interval == 0) {
      force.setZero(overlap_.n_nodes(), dim);
      fine_.add_forces(zone.state, force);
      mean.add(force);
      for (int c = 0; c < dim; ++c)
        for (int i = 0; i < zone.state.size(); ++i)
          mean_place[c][i] += zone.state.displacement[c][i] / double(n_samples);
    }
    kick(bodies, step);
    drift(bodies, step);
  }
  const Nodal<dim> strained = handed_forces(bodies, mean_place) - handed_forces(bodies, rest);
  return {balanced(mean.value() - strained, bodies.far->mesh()), mean.error(),
          interval * n_samples};
}

template <int dim>
Nodal<dim> FineScaleSplit<dim>::handed_forces(Bodies<dim> &bodies,
                                              const Components<dim> &displacement) const
{
  auto &zone = *bodies.zone;
  zone.state.displacement = displacement;
  zone.update_ghosts();
  zone.compute_forces(0);
  Nodal<dim> force = Nodal<dim>::Zero(overlap_.n_nodes(), dim);
  fine_.add_forces(zone.state, force);
  return force;
}

// Scaled to the very energy of so many: some hundreds of nodes that are hotter by chance stay so
// for long.
template <int dim>
void FineScaleSplit<dim>::draw_nodes(Bodies<dim> &bodies, double thermal_energy)
{
  auto &far = *bodies.far;
  const core::ThermalNoise noise(parameters_.seed, 0);
  constexpr int stream = 4; // of nodes
  std::vector<char> is_near(far.mesh().n_nodes(), 0);
  for (const int node : overlap_.near_nodes)
    is_near[node] = 1;
  double twice = 0, n_drawn = 0; // m v^2 in J, and of how many numbers
  for (auto &component : far.velocity)
    std::fill(component.begin(), component.end(), 0.);
  for (int node = 0; node < far.mesh().n_nodes(); ++node)
    for (int c = 0; c < dim; ++c)
      if (const double m = far.lumped_mass()[node];
          m > 0 && !is_near[node] && !far.is_held(node, c)) {
        const double number = noise(node, c, stream);
        far.velocity[c][node] = std::sqrt(thermal_energy / m) * number;
        twice += thermal_energy * number * number;
        ++n_drawn;
      }
  for (auto &component : far.velocity)
    for (double &v : component)
      v *= n_drawn > 0 ? std::sqrt(n_drawn * thermal_energy / twice) : 0;
  // Of the covariance kT M_c^-1: M_c is not diagonal.
  const int n = overlap_.n_nodes();
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor{
      Eigen::SparseMatrix<double>(mass_)};
  Nodal<dim> v(n, dim);
  for (int c = 0; c < dim; ++c) {
    Eigen::VectorXd numbers(n);
    for (int i = 0; i < n; ++i)
      numbers[i] = std::sqrt(thermal_energy) * noise(overlap_.near_nodes[i], c, stream);
    v.col(c) = factor.permutationPinv() * Eigen::VectorXd(factor.matrixU().solve(numbers));
  }
  const double found = v.cwiseProduct(Nodal<dim>(mass_ * v)).sum();
  near_.set_velocity(std::sqrt(dim * n * thermal_energy / found) * v);
  far.follow_masters(far.velocity);
  fine_.write_velocities(near_.velocity(), bodies.zone->state);
}

// Action and reaction leave no net force on the mean; what a finite time has left of it would move
// the body. Taken from all loaded nodes, with the smallest change of their loads.
template <int dim>
Nodal<dim> FineScaleSplit<dim>::balanced(Nodal<dim> load, const fem::Mesh<dim> &mesh) const
{
  std::vector<int> loaded;
  for (int i = 0; i < load.rows(); ++i)
    if (!load.row(i).isZero(0))
      loaded.push_back(i);
  if (loaded.empty())
    return load;
  const int n_spin = is_periodic_ ? 0 : n_spins<dim>, n = int(loaded.size());
  Vector<dim> centre = Vector<dim>::Zero();
  for (const int i : loaded)
    centre += mesh.nodes[overlap_.near_nodes[i]] / n;
  Eigen::MatrixXd rigid(dim * n, dim + n_spin);
  Eigen::VectorXd values(dim * n);
  for (int k = 0; k < n; ++k) {
    const Vector<dim> x =
        (mesh.nodes[overlap_.near_nodes[loaded[k]]] - centre) / overlap_.cell_size;
    values.segment<dim>(dim * k) = load.row(loaded[k]).transpose();
    rigid.block<dim, dim>(dim * k, 0).setIdentity();
    for (int s = 0; s < n_spin; ++s) {
      Vector<dim> turned = Vector<dim>::Zero();
      if constexpr (dim == 2)
        turned = Vector<2>(-x[1], x[0]);
      else
        turned = Vector<3>::Unit(s).cross(x);
      rigid.block<dim, 1>(dim * k, dim + s) = turned;
    }
  }
  const Eigen::VectorXd share = rigid.colPivHouseholderQr().solve(values);
  values -= rigid * share;
  for (int k = 0; k < n; ++k)
    load.row(loaded[k]) = values.segment<dim>(dim * k).transpose();
  return load;
}

template <int dim>
void FineScaleSplit<dim>::set_dead_load(const Nodal<dim> &load, const Bodies<dim> &bodies)
{
  dead_load_ = load;
  strained_.reset(); // it has the load of before
  if (regime_ == Regime::linear)
    coarse_ = std::make_unique<LinearCoarseEnergy<dim>>(stiffness_, dead_load_);
  else
    make_coarse_energy(regime_, bodies);
}

template <int dim>
void FineScaleSplit<dim>::save_bath(core::State &state) const
{
  core::save_value(state, "split", "zone_bath_energy", zone_bath_->taken);
  if (dead_load_.size() == 0)
    return;
  std::map<std::int64_t, int> rows;
  for (int i = 0; i < overlap_.n_nodes(); ++i)
    rows[overlap_.near_nodes[i]] = i;
  std::vector<std::int64_t> keys;
  Components<dim> force;
  for (const auto &[key, i] : rows) {
    keys.push_back(key);
    for (int c = 0; c < dim; ++c)
      force[c].push_back(dead_load_(i, c));
  }
  core::Table table(std::move(keys));
  for (int c = 0; c < dim; ++c)
    table.add("force_" + std::to_string(c), force[c]);
  state["dead_load"] = std::move(table);
}

template <int dim>
void FineScaleSplit<dim>::load_bath(const core::State &state, const Bodies<dim> &bodies)
{
  zone_bath_->taken = core::load_real(state, "split", "zone_bath_energy");
  if (dead_load_.size() == 0)
    return;
  const core::Table &table = core::table(state, "dead_load");
  std::map<std::int64_t, std::size_t> rows;
  for (std::size_t r = 0; r < table.n_rows(); ++r)
    rows[table.keys()[r]] = r;
  Nodal<dim> load = Nodal<dim>::Zero(overlap_.n_nodes(), dim);
  for (int c = 0; c < dim; ++c) {
    const auto force = table.reals("force_" + std::to_string(c));
    for (int i = 0; i < overlap_.n_nodes(); ++i)
      load(i, c) = force[rows.at(overlap_.near_nodes[i])];
  }
  set_dead_load(load, bodies);
}

template void FineScaleSplit<2>::join_bath(const Bodies<2> &, double);
template void FineScaleSplit<3>::join_bath(const Bodies<3> &, double);
template void FineScaleSplit<2>::exchange_heat(Bodies<2> &, const StepTime &);
template void FineScaleSplit<3>::exchange_heat(Bodies<3> &, const StepTime &);
template double FineScaleSplit<2>::thermal_energy_of_fine(const Bodies<2> &) const;
template double FineScaleSplit<3>::thermal_energy_of_fine(const Bodies<3> &) const;
template double FineScaleSplit<2>::thermal_energy_of_zone(const Bodies<2> &) const;
template double FineScaleSplit<3>::thermal_energy_of_zone(const Bodies<3> &) const;
template std::array<double, 3> FineScaleSplit<2>::thermal_energies(const Bodies<2> &) const;
template std::array<double, 3> FineScaleSplit<3>::thermal_energies(const Bodies<3> &) const;
template ThermalLoad<2> FineScaleSplit<2>::held_thermal_load(Bodies<2> &, const HeldRun &, double);
template ThermalLoad<3> FineScaleSplit<3>::held_thermal_load(Bodies<3> &, const HeldRun &, double);
template ThermalLoad<2> FineScaleSplit<2>::free_thermal_load(Bodies<2> &, double, double);
template ThermalLoad<3> FineScaleSplit<3>::free_thermal_load(Bodies<3> &, double, double);
template void FineScaleSplit<2>::set_dead_load(const Nodal<2> &, const Bodies<2> &);
template void FineScaleSplit<3>::set_dead_load(const Nodal<3> &, const Bodies<3> &);
template void FineScaleSplit<2>::draw_nodes(Bodies<2> &, double);
template void FineScaleSplit<3>::draw_nodes(Bodies<3> &, double);
template void FineScaleSplit<2>::save_bath(core::State &) const;
template void FineScaleSplit<3>::save_bath(core::State &) const;
template void FineScaleSplit<2>::load_bath(const core::State &, const Bodies<2> &);
template void FineScaleSplit<3>::load_bath(const core::State &, const Bodies<3> &);
} // namespace ligament::coupling
