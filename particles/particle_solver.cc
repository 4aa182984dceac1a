#include "particles/particle_solver.h"

#include "core/ranks_state.h"
#include "particles/block_sum.h"
#include "particles/kick_velocities.h"
#include "particles/turn_orientations.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace ligament::particles
{
template <int dim>
ParticleSolver<dim>::ParticleSolver(Particles<dim> particles,
                                    std::unique_ptr<ParticleForce<dim>> force)
    : state(std::move(particles)), force(std::move(force))
{
  if (!this->force->has_rotations())
    state.drop_orientations();
}

template <int dim>
void ParticleSolver<dim>::join(const Owners &owners)
{
  core::require(!rest_, "parts are joined before anything rests");
  ranks_ = owners.ranks;
  halo_ = Halo<dim>(owners, state);
  force->join(owners, state);
}

template <int dim>
void ParticleSolver<dim>::update_ghosts()
{
  halo_.update(state);
  if (rest_ && halo_.n_ghosts() > 0)
    rest_->look_at_ghosts(state);
}

template <int dim>
void ParticleSolver<dim>::let_rest(const RestLimits &limits)
{
  const auto for_each_pair = [&](const typename RestBlocks<dim>::VisitPair &visit) {
    force->for_each_neighbour(state, [&](const Neighbour &n) { visit(n.i, n.j); });
  };
  rest_ = std::make_unique<RestBlocks<dim>>(state, for_each_pair, limits);
  force->set_rest(rest_.get());
}

namespace
{
/// Whose rows are of particles, by their first name.
bool names_particles(const std::string &table)
{
  static const std::set<std::string> all = {"body_force_blocks", "inelastic",         "jumps",
                                            "loaded_faces",      "particle_dashpots", "particles",
                                            "pressed_cells",     "searched",          "walls"};
  return all.count(table) > 0;
}

/// A table of a part without the rows of what another rank owns: bonds and contacts are those of
/// their particle "i". `own`: ascending names.
core::Table own_rows(const std::string &name, const core::Table &table,
                     const std::vector<std::int64_t> &own)
{
  std::vector<std::int64_t> particles;
  const int n_keys = table.n_keys();
  if (table.has("i"))
    particles = table.integers("i");
  else if (names_particles(name))
    for (std::size_t r = 0; r < table.n_rows(); ++r)
      particles.push_back(table.keys()[r * n_keys]);
  else
    return table;
  std::vector<std::int64_t> keys;
  std::vector<std::size_t> rows;
  for (std::size_t r = 0; r < table.n_rows(); ++r)
    if (std::binary_search(own.begin(), own.end(), particles[r])) {
      rows.push_back(r);
      for (int k = 0; k < n_keys; ++k)
        keys.push_back(table.keys()[r * n_keys + k]);
    }
  core::Table kept(std::move(keys), n_keys);
  std::vector<std::uint64_t> words(rows.size());
  for (std::size_t c = 0; c < table.columns().size(); ++c) {
    for (std::size_t k = 0; k < rows.size(); ++k)
      words[k] = table.words()[c * table.n_rows() + rows[k]];
    kept.add_words(table.columns()[c], words.data());
  }
  return kept;
}

/// Counts of the steps that particles took, without the blocks that took them.
core::State counts_of(double steps, double particle_steps)
{
  core::State counts;
  counts["blocks"].add("nearness", std::vector<std::int64_t>());
  core::save_value(counts, "rest", "steps", steps);
  core::save_value(counts, "rest", "particle_steps", particle_steps);
  return counts;
}

/// Ranks cut other blocks; what they tell of them is how often all of the body moved.
template <int dim>
void save_rest(const RestBlocks<dim> &rest, const Particles<dim> &particles,
               const core::Ranks &ranks, core::State &all)
{
  if (ranks.is_one()) {
    rest.save(all, particles.names());
    return;
  }
  core::State here;
  rest.save(here, particles.names());
  const double steps = core::load_real(here, "rest", "steps");
  core::ExactSum moved;
  moved.add((1 - rest.share_at_rest()) * steps * double(count(particles.part.owned)));
  all["rest"] = counts_of(steps, ranks.sum(moved).value())["rest"];
}

/// States of parts don't say which blocks rest.
template <int dim>
void load_rest(const core::State &all, const Particles<dim> &particles, const core::Ranks &ranks,
               ParticleForce<dim> &force, RestBlocks<dim> &rest)
{
  if (ranks.is_one() && all.count("blocks")) {
    rest.load(all, particles.names());
    return;
  }
  if (all.count("rest")) {
    const double share =
        double(particles.size()) / double(ranks.sum(std::int64_t(count(particles.part.owned))));
    rest.load(counts_of(core::load_real(all, "rest", "steps"),
                        share * core::load_real(all, "rest", "particle_steps")),
              particles.names());
  }
  rest.wake_what_moved(particles);
  force.wake_touching();
}
} // namespace

template <int dim>
void ParticleSolver<dim>::save(core::State &all) const
{
  const core::Names names = state.names();
  state.save(all, names);
  force->save(all, names, state);
  dashpots.save(all, "particle_dashpots", names);
  if (!body_force.is_empty())
    body_force.save(all, state);
  if (rest_)
    save_rest(*rest_, state, ranks_, all);
  if (ranks_.is_one())
    return;
  std::vector<std::int64_t> own;
  for_each(state.part.owned, [&](int i) { own.push_back(state.global_id[i]); });
  std::sort(own.begin(), own.end());
  for (auto &[name, table] : all)
    table = own_rows(name, table, own);
}

template <int dim>
void ParticleSolver<dim>::load(const core::State &all)
{
  if (!ranks_.is_one())
    force->invite(all, state);
  const core::Names names = state.names();
  const core::State of_part = ranks_.is_one() ? core::State() : core::share_of(all, ranks_);
  const core::State &share = ranks_.is_one() ? all : of_part;
  state.load(share, names);
  force->load(share, names, state);
  dashpots.load(share, "particle_dashpots", names);
  if (!body_force.is_empty())
    body_force.load(share, state);
  if (rest_)
    load_rest(share, state, ranks_, *force, *rest_);
}

template <int dim>
template <typename Visit>
void ParticleSolver<dim>::for_each_awake(Visit &&visit) const
{
  const bool all = !rest_ || rest_->all_awake();
  for (const auto &[begin, end] : all ? state.part.stepped : rest_->ranges().stepped)
    visit(begin, end);
}

template <int dim>
void ParticleSolver<dim>::kick(double dt)
{
  const auto kick = [&](auto &velocity, const auto &force, double by) {
    for (std::size_t c = 0; c < velocity.size(); ++c)
      for_each_awake([&](int begin, int end) {
        kick_velocities(velocity[c].data() + begin, force[c].data() + begin,
                        state.mass.data() + begin, by, end - begin);
      });
  };
  kick(state.velocity, state.force, dt);
  if (state.turns)
    kick(state.spin, state.torque, dt / state.gyration);
  dashpots.act(
      dt, [this](int i) { return state.inverse_mass(i); }, state.force, state.velocity);
}

template <int dim>
void ParticleSolver<dim>::drift(double dt)
{
  if (rest_)
    rest_->look(state);
  for (int c = 0; c < dim; ++c) {
    double *__restrict u = state.displacement[c].data();
    const double *__restrict v = state.velocity[c].data();
    for_each_awake([&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        u[i] += dt * v[i];
    });
  }
  if (!state.turns)
    return;
  if constexpr (dim == 2) {
    double *__restrict angle = state.rotation[0].data();
    const double *__restrict w = state.spin[0].data();
    for_each_awake([&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        angle[i] += dt * w[i];
    });
  } else {
    auto &q = state.rotation;
    const auto &w = state.spin;
    for_each_awake([&, dt](int begin, int end) {
      turn_orientations(
          {q[0].data() + begin, q[1].data() + begin, q[2].data() + begin, q[3].data() + begin},
          {w[0].data() + begin, w[1].data() + begin, w[2].data() + begin}, dt, end - begin);
    });
  }
}

template <int dim>
core::ExactSum ParticleSolver<dim>::kinetic_sum(double dt) const
{
  return block_sum(state.part.owned, [&](int i) {
    if (std::isinf(state.mass[i])) // held
      return 0.;
    double twice = 0;
    for (int c = 0; c < dim; ++c) {
      const double v = state.velocity[c][i];
      twice += v * (state.mass[i] * v + dt * state.force[c][i]);
    }
    for (int c = 0; c < n_spins<dim> && state.turns; ++c) {
      const double w = state.spin[c][i];
      twice += w * (state.inertia(i) * w + dt * state.torque[c][i]);
    }
    return twice / 2;
  });
}

template <int dim>
void ParticleSolver<dim>::scale_velocities(double factor)
{
  for (auto &array : state.velocity)
    for (double &v : array)
      v *= factor;
  for (auto &array : state.spin)
    for (double &w : array)
      w *= factor;
}

namespace
{
/// Of term(i), in strands, one for each entry of a vector: the compiler may not reorder one.
template <typename Term>
double sum_in_strands(int begin, int end, Term &&term)
{
  constexpr int n_strands = 8;
  double sum[n_strands] = {};
  int i = begin;
  for (; i + n_strands <= end; i += n_strands)
    for (int k = 0; k < n_strands; ++k)
      sum[k] += term(i + k);
  for (; i < end; ++i)
    sum[0] += term(i);
  return std::accumulate(sum, sum + n_strands, 0.);
}
} // namespace

template <int dim>
core::ExactSum ParticleSolver<dim>::damp_velocities(double factor, double dt)
{
  return sum_over_blocks(state.part.owned, [&](const auto &add) {
    const auto damp = [&](std::vector<double> &velocity, const std::vector<double> &force,
                          double gyration) {
      const double *const m = state.mass.data(), *const f = force.data();
      double *const v = velocity.data();
      const double loss = (1 - factor) / 2, squares = loss * (1 + factor) * gyration,
                   products = loss * dt;
      add([=](int begin, int end) {
        const double sum = sum_in_strands(begin, end, [=](int i) { // infinite mass: held
          return v[i] * (squares * (std::isinf(m[i]) ? 0 : m[i]) * v[i] + products * f[i]);
        });
        for (int i = begin; i < end; ++i)
          v[i] *= factor;
        return sum;
      });
    };
    for (int c = 0; c < dim; ++c)
      damp(state.velocity[c], state.force[c], 1);
    for (int c = 0; c < n_spins<dim> && state.turns; ++c)
      damp(state.spin[c], state.torque[c], state.gyration);
  });
}

template class ParticleSolver<2>;
template class ParticleSolver<3>;
} // namespace ligament::particles
