#include "fem/fem_solver.h"

#include "core/check.h"
#include "fem/cell_kernel.h"
#include "fem/cell_map.h"
#include "fem/cell_quality.h"
#include "fem/corotated_kernel.h"
#include "fem/part_shares.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::fem
{
template <int dim>
FemSolver<dim>::FemSolver(Mesh<dim> mesh, const Body<dim> &body,
                          std::vector<core::BoundaryLoad<dim>> loads)
    : mesh_(std::move(mesh)), body_(body), loads_(std::move(loads)),
      is_own_cell_(mesh_.n_cells(), 1), released_node_(mesh_.n_nodes(), 0), jumps_(mesh_, loads_)
{
  core::require(body.density > 0 && body.thickness > 0,
                fmt::format("far field: density {} kg/m^3 and thickness {} m must be positive",
                            body.density, body.thickness));
  require_convex(mesh_);
  for (auto *field : {&displacement, &velocity, &force})
    for (auto &component : *field)
      component.assign(mesh_.n_nodes(), 0.);
  find_held_components();
  update_own_cells();
}

template <int dim>
FemSolver<dim>::~FemSolver() = default;
template <int dim>
FemSolver<dim>::FemSolver(FemSolver &&) noexcept = default;
template <int dim>
FemSolver<dim> &FemSolver<dim>::operator=(FemSolver &&) noexcept = default;

template <int dim>
void FemSolver<dim>::update_own_cells()
{
  kernel_ = std::make_unique<CellKernel<dim>>(mesh_, body_, is_own_cell_);
  set_corotated(corotated_ != nullptr);

  mass_.assign(mesh_.n_nodes(), 0.);
  for (int cell = 0; cell < mesh_.n_cells(); ++cell)
    if (is_own_cell_[cell]) {
      const auto shares = volume_shares(mesh_, cell);
      for (int a = 0; a < n_cell_nodes<dim>; ++a)
        mass_[mesh_.cells[cell][a]] += body_.density * body_.thickness * shares[a];
    }
  hand_to_masters(mass_);
  inverse_mass_.resize(mesh_.n_nodes());
  for (int i = 0; i < mesh_.n_nodes(); ++i)
    inverse_mass_[i] = mass_[i] > 0 && !released_node_[i] ? 1 / mass_[i] : 0;

  own_ranges_.clear();
  for (int i = 0; i < mesh_.n_nodes(); ++i)
    if (!released_node_[i]) {
      if (own_ranges_.empty() || own_ranges_.back().second != i)
        own_ranges_.emplace_back(i, i);
      ++own_ranges_.back().second;
    }

  traction_components_.clear();
  for (int l = 0; l < int(loads_.size()); ++l) {
    if (loads_[l].kind != core::BoundaryLoad<dim>::Kind::traction)
      continue;
    const std::vector<double> area = loaded_areas(loads_[l]);
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < mesh_.n_nodes(); ++i)
        if (loads_[l].value[c] && area[i] > 0)
          traction_components_.push_back({i, c, l, area[i], false});
  }
  add_body_forces();
  find_pressed_faces();
  has_previous_forces_ = false;
  find_dashpots();
}

// The components of a node come one after the other; their areas are those of the faces.
template <int dim>
void FemSolver<dim>::set_weights(const std::vector<int> &nodes, const std::vector<double> &masses)
{
  weights_.clear();
  for (std::size_t k = 0; k < nodes.size(); ++k)
    weights_.emplace_back(nodes[k], masses[k]);
  update_own_cells();
}

template <int dim>
void FemSolver<dim>::release_cells(const std::vector<int> &cells)
{
  for (const int cell : cells) {
    is_own_cell_[cell] = 0;
    for (const int node : mesh_.cells[cell])
      released_node_[node] = 1;
  }
  for (const HangingNode &h : mesh_.hanging)
    if (released_node_[h.node])
      for (const auto &master : h.masters)
        released_node_[master.first] = 1;
  for (const CellFace<dim> &face : mesh_.boundary_faces)
    for (const auto &load : loads_)
      core::require(is_own_cell_[face.cell] || face.boundary != load.boundary ||
                        load.kind != core::BoundaryLoad<dim>::Kind::traction ||
                        part_shares<dim>(load.part, mesh_, face).sum() <= 0 ||
                        (!load.pressure && std::none_of(load.value.begin(), load.value.end(),
                                                        [](const auto &v) { return bool(v); })),
                    "the overlap or its transition reaches a side of the specimen with a traction; "
                    "keep the zone away from it or lower /coupling/transition_cells");
  update_own_cells();
}

template <int dim>
void FemSolver<dim>::set_corotated(bool corotated)
{
  corotated_.reset();
  if (corotated)
    corotated_ = std::make_unique<CorotatedKernel<dim>>(mesh_, body_, is_own_cell_, strain_law_);
}

template <int dim>
void FemSolver<dim>::set_strain_law(std::shared_ptr<const core::HyperelasticLaw<dim>> law)
{
  strain_law_ = std::move(law);
  set_corotated(true);
}

template <int dim>
typename FemSolver<dim>::Motion FemSolver<dim>::largest_motion() const
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  Motion largest;
  for (int cell = 0; cell < mesh_.n_cells(); ++cell) {
    if (!is_own_cell_[cell])
      continue;
    const CellVectors<dim> gradient = centre_gradients(mesh_, cell);
    Matrix f = Matrix::Identity();
    Vector<dim> centre = Vector<dim>::Zero();
    for (int a = 0; a < n_cell_nodes<dim>; ++a) {
      const int node = mesh_.cells[cell][a];
      f += get(displacement, node) * gradient.col(a).transpose();
      centre += mesh_.nodes[node] / n_cell_nodes<dim>;
    }
    const core::PolarRotation<dim> polar(f);
    largest.rotation.take(polar.angle(), centre);
    largest.strain.take((polar.matrix().transpose() * f - Matrix::Identity()).norm(), centre);
  }
  return largest;
}

template <int dim>
void FemSolver<dim>::hand_to_masters(std::vector<double> &values) const
{
  for (const HangingNode &h : mesh_.hanging) {
    for (const auto &[master, weight] : h.masters)
      values[master] += weight * values[h.node];
    values[h.node] = 0;
  }
}

template <int dim>
void FemSolver<dim>::scale_velocities(double factor)
{
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < mesh_.n_nodes(); ++i)
      if (!held_[c][i])
        velocity[c][i] *= factor;
}

template <int dim>
void FemSolver<dim>::set_mass_damping(double rate)
{
  damping_rate_ = rate;
}

template <int dim>
double FemSolver<dim>::damp_velocities(double dt)
{
  const double factor = std::exp(-damping_rate_ * std::abs(dt) / 2);
  double loss = dt < 0 ? held_drag(-dt) : 0;
  for (int c = 0; c < dim; ++c)
    for (const auto &[begin, end] : own_ranges_)
      for (int i = begin; i < end; ++i)
        if (!held_[c][i]) {
          double &v = velocity[c][i];
          const double momentum = mass_[i] * v;
          loss += (1 - factor) / 2 * v * ((1 + factor) * momentum + dt * force[c][i]);
          v *= factor;
        }
  return loss;
}

template <int dim>
double FemSolver<dim>::held_drag(double dt) const
{
  if (support_step_ == 0)
    return 0;
  const double growth = std::exp(damping_rate_ * support_step_ / 2);
  double loss = 0;
  for (const LoadedComponent &h : held_components_)
    if (!released_node_[h.node]) {
      const double mass = mass_[h.node], after = velocity[h.component][h.node];
      const double kick = dt * force[h.component][h.node] / mass;
      const double before = growth * (growth * after - kick);
      loss += mass / 2 * (before + kick - after) * (before + after);
    }
  return loss;
}

template <int dim>
void FemSolver<dim>::follow_masters(Components<dim> &field) const
{
  for (auto &values : field)
    for (const HangingNode &h : mesh_.hanging) {
      double sum = 0;
      for (const auto &[master, weight] : h.masters)
        sum += weight * values[master];
      values[h.node] = sum;
    }
}

template <int dim>
void FemSolver<dim>::distribute()
{
  follow_masters(displacement);
  follow_masters(velocity);
  jumps_.add_jumps(mesh_, displacement);
  jumps_.add_rates(mesh_, velocity);
}

template <int dim>
void FemSolver<dim>::add_up_forces(double time)
{
  jumps_.set_time(time);
  distribute();
  for (auto &f : force)
    std::fill(f.begin(), f.end(), 0.);
  if (corotated_)
    corotated_->subtract_forces(displacement, force, false);
  else
    kernel_->subtract_forces(displacement, force);
  jumps_.find_reactions(mesh_, force);
  for (auto &f : force)
    hand_to_masters(f);
  for (LoadedComponent &t : traction_components_) {
    t.force = t.area * loads_[t.load].traction(time)[t.component];
    force[t.component][t.node] += t.force;
  }
  add_pressures(time);
}

template <int dim>
void FemSolver<dim>::compute_trial(double time)
{
  add_up_forces(time);
  for (LoadedComponent &h : held_components_) {
    double &f = force[h.component][h.node];
    h.force = released_node_[h.node] ? 0 : -f;
    f = 0;
  }
}

template <int dim>
void FemSolver<dim>::subtract_stiffness(Components<dim> &u, Components<dim> &f) const
{
  follow_masters(u);
  kernel_->subtract_forces(u, f);
  for (auto &component : f)
    hand_to_masters(component);
}

template <int dim>
void FemSolver<dim>::compute_forces(double time)
{
  add_up_forces(time);
  support_step_ = step_;
  for (LoadedComponent &h : held_components_) {
    h.force = support_force(h, time);
    force[h.component][h.node] += h.force;
  }
  book_work();
}

// theory.md eq. (F9)
// The sum of forces on a held component stays what moves it as prescribed.
template <int dim>
void FemSolver<dim>::kick(double dt, double time)
{
  for (int c = 0; c < dim; ++c) {
    double *__restrict v = velocity[c].data();
    const double *__restrict f = force[c].data();
    const double *__restrict w = inverse_mass_.data(); // 0 for released and hanging nodes
    for (int i = 0; i < mesh_.n_nodes(); ++i)
      v[i] += dt * f[i] * w[i];
  }
  dashpots_.act(
      dt, [this](int i) { return inverse_mass_[i]; }, force, velocity);
  for (const LoadedComponent &h : held_components_)
    if (!released_node_[h.node]) {
      double &v = velocity[h.component][h.node];
      const double before = v - dt * force[h.component][h.node] * inverse_mass_[h.node];
      v = (prescribed(h, time + dt) - displacement[h.component][h.node]) / dt;
      if (step_ == 0)
        external_work_ += mass_[h.node] * (v - before) * (v + before) / 2;
    }
  step_ = dt;
}

template <int dim>
void FemSolver<dim>::drift(double dt)
{
  for (int c = 0; c < dim; ++c) {
    double *__restrict u = displacement[c].data();
    const double *__restrict v = velocity[c].data();
    for (const auto &[begin, end] : own_ranges_)
      for (int i = begin; i < end; ++i)
        u[i] += dt * v[i];
  }
  distribute();
}

template <int dim>
double FemSolver<dim>::potential_energy() const
{
  if (!corotated_)
    return quadratic_form(displacement);
  Components<dim> f;
  for (auto &component : f)
    component.assign(mesh_.n_nodes(), 0.);
  return corotated_->subtract_forces(displacement, f);
}

template <int dim>
double FemSolver<dim>::quadratic_form(const Components<dim> &u) const
{
  Components<dim> f;
  for (auto &component : f)
    component.assign(mesh_.n_nodes(), 0.);
  if (corotated_)
    corotated_->subtract_product(displacement, u, f);
  else
    kernel_->subtract_forces(u, f);
  double sum = 0;
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < mesh_.n_nodes(); ++i)
      sum -= u[c][i] * f[c][i];
  return sum / 2;
}

template <int dim>
Components<dim> FemSolver<dim>::halfway_velocity(double dt) const
{
  Components<dim> v = velocity;
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < mesh_.n_nodes(); ++i)
      v[c][i] += dt / 2 * force[c][i] * inverse_mass_[i];
  follow_masters(v);
  jumps_.add_rates(mesh_, v);
  return v;
}

template <int dim>
double FemSolver<dim>::squared_force() const
{
  double sum = 0;
  for (int c = 0; c < dim; ++c)
    for (int i = 0; i < mesh_.n_nodes(); ++i)
      sum += force[c][i] * force[c][i] * inverse_mass_[i];
  return sum;
}

template <int dim>
double FemSolver<dim>::kinetic_energy(double dt) const
{
  double sum = 0;
  for (int c = 0; c < dim; ++c)
    for (const auto &[begin, end] : own_ranges_)
      for (int i = begin; i < end; ++i)
        sum += velocity[c][i] * (mass_[i] * velocity[c][i] + dt * force[c][i]);
  return sum / 2;
}

template <int dim>
double FemSolver<dim>::stable_step() const
{
  return kernel_->stable_step(body_.density, body_.thickness);
}

template class FemSolver<2>;
template class FemSolver<3>;
} // namespace ligament::fem
