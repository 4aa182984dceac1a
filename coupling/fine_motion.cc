#include "coupling/fine_motion.h"

#include "core/exact_sum.h"
#include "core/polar_rotation.h"
#include "particles/orientation.h"

#include <algorithm>
#include <map>

namespace ligament::coupling
{
namespace
{
template <typename Field>
auto pointers(Field &field)
{
  std::array<decltype(field[0].data()), std::tuple_size_v<std::remove_const_t<Field>>> p;
  for (std::size_t c = 0; c < p.size(); ++c)
    p[c] = field[c].data();
  return p;
}
/// Phi^T M damping (1 - damping/2) Phi over the free members.
template <int dim>
ScalarMatrix<dim> loss_matrix(const Overlap<dim> &overlap,
                              const particles::Particles<dim> &particles,
                              const std::function<double(double)> &damping)
{
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto &m : overlap.members) {
    const double g = m.pad ? 0 : float(damping(m.position));
    if (g > 0)
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
        for (int b = 0; b < fem::n_cell_nodes<dim>; ++b)
          entries.emplace_back(m.nodes[a], m.nodes[b],
                               particles.mass[m.particle] * g * (1 - g / 2) * m.value[a] *
                                   m.value[b]);
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(overlap.n_nodes(), overlap.n_nodes());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return ScalarMatrix<dim>(matrix);
}
} // namespace

template <int dim>
FineMotion<dim>::FineMotion(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                            const std::function<double(double)> &damping, Solver solver)
    : carrier_(
          overlap,
          [&](const typename Overlap<dim>::Member &m) {
            return particles.mass[m.particle] * (1 - float(damping(m.position)) / 2.);
          },
          solver),
      carried_(overlap.n_nodes(), dim), lost_(overlap.n_nodes(), dim),
      loss_(loss_matrix(overlap, particles, damping))
{
  make_lanes(overlap, particles, damping);
  motion_.resize(dim * lanes_.slots.size());
  cell_loss_.resize(lanes_.batches.size());
  for (const auto &m : overlap.members)
    if (m.pad && particles.turns) { // what pads have of their own is how they turn
      Pad pad = {m.particle, m.nodes, m.gradient, {}};
      for (int a = 0; a < nc; ++a)
        pad.spin[a] = Overlap<dim>::spin_block(m, a);
      pads_.push_back(pad);
    }
}

template <int dim>
void FineMotion<dim>::make_lanes(const Overlap<dim> &overlap,
                                 const particles::Particles<dim> &particles,
                                 const std::function<double(double)> &damping)
{
  using Member = typename Overlap<dim>::Member;
  std::map<std::array<int, nc>, std::vector<const Member *>> members_of_cell;
  for (const Member &m : overlap.members)
    members_of_cell[m.nodes].push_back(&m);
  std::vector<const std::vector<const Member *> *> cells;
  for (const auto &[nodes, members] : members_of_cell)
    cells.push_back(&members);

  for (std::size_t first = 0; first < cells.size(); first += lane_array_size) {
    const auto begin = cells.begin() + first,
               end = cells.begin() + std::min(first + lane_array_size, cells.size());
    // Fullest first, so that idle lanes come last in every slot.
    std::stable_sort(begin, end, [](auto *a, auto *b) { return a->size() > b->size(); });
    typename MemberBatches<dim>::Batch batch{};
    batch.n_cells = int(end - begin);
    for (int l = 0; l < lane_array_size; ++l)
      for (int a = 0; a < nc; ++a)
        batch.node[a][l] = begin[l < batch.n_cells ? l : 0]->front()->nodes[a];
    batch.begin = int(lanes_.slots.size());
    for (std::size_t k = 0; k < (*begin)->size(); ++k) {
      Slot slot{};
      int n_members = 0;
      for (int l = 0; l < lane_array_size; ++l) {
        const bool idle = l >= batch.n_cells || k >= begin[l]->size();
        const Member &m = idle ? *(*begin)->at(k) : *begin[l]->at(k);
        slot.particle[l] = m.particle;
        if (idle)
          continue;
        n_members = l + 1;
        for (int a = 0; a < nc; ++a)
          slot.value[a].value[l] = m.value[a];
        if (m.pad)
          continue;
        slot.mass.value[l] = particles.mass[m.particle];
        slot.damping[l] = float(damping(m.position));
        ++n_free_members_;
      }
      lanes_.slots.push_back(slot);
      lanes_.n_members.push_back(n_members);
    }
    batch.end = int(lanes_.slots.size());
    lanes_.batches.push_back(batch);
  }
}

template <int dim>
void FineMotion<dim>::add_pad_torques(const particles::Particles<dim> &particles,
                                      Nodal<dim> &force) const
{
  for (const auto &pad : pads_) {
    const Spin<dim> torque = get(particles.torque, pad.particle);
    for (int a = 0; a < nc; ++a)
      force.row(pad.nodes[a]) += torque.transpose() * pad.spin[a];
  }
}

template <int dim>
void FineMotion<dim>::add_forces(const particles::Particles<dim> &particles,
                                 Nodal<dim> &force) const
{
  std::vector<LaneArray> motion(motion_.size()), loss(cell_loss_.size());
  Nodal<dim> other = Nodal<dim>::Zero(carried_.rows(), dim);
  kick_members<dim>(lanes_, {pointers(particles.force), 0, motion.data(), force.data(),
                             other.data(), other.data(), loss.data()});
  add_pad_torques(particles, force);
}

// The damper takes (C20) with w = w' - (1 - damping/2) Phi x: the parts of x are sums over nodes.
template <int dim>
void FineMotion<dim>::begin_kick(const particles::Particles<dim> &particles, double dt,
                                 Nodal<dim> &force)
{
  carried_.setZero();
  lost_.setZero();
  kick_members<dim>(lanes_, {pointers(particles.force), dt, motion_.data(), force.data(),
                             carried_.data(), lost_.data(), cell_loss_.data()});
  add_pad_torques(particles, force);
  carrier_.solve(carried_);
  if (loss_.is_empty())
    return;
  Nodal<dim> square;
  loss_.multiply(carried_, square);
  core::ExactSum sum;
  for (std::size_t b = 0; b < cell_loss_.size(); ++b)
    for (int l = 0; l < lanes_.batches[b].n_cells; ++l)
      sum.add(cell_loss_[b].value[l]);
  damper_energy_ += (sum.value() - carried_.cwiseProduct(lost_ - 0.5 * square).sum()) / 2;
}

template <int dim>
void FineMotion<dim>::finish_kick(const Nodal<dim> &coarse, particles::Particles<dim> &particles)
{
  split_members<dim>(
      lanes_, {carried_.data(), coarse.data(), motion_.data(), pointers(particles.velocity)});
  turn_with_mesh(coarse, particles);
}

template <int dim>
void FineMotion<dim>::turn_with_mesh(const Nodal<dim> &coarse,
                                     particles::Particles<dim> &particles) const
{
  for (const auto &pad : pads_) {
    Spin<dim> spin = Spin<dim>::Zero();
    for (int a = 0; a < nc; ++a)
      spin += pad.spin[a] * coarse.row(pad.nodes[a]).transpose();
    set(particles.spin, pad.particle, spin);
  }
}

template <int dim>
void FineMotion<dim>::take_velocities(const Nodal<dim> &coarse,
                                      particles::Particles<dim> &particles)
{
  carried_.setZero();
  for (const auto &batch : lanes_.batches)
    for (int k = batch.begin; k < batch.end; ++k) {
      const Slot &slot = lanes_.slots[k];
      for (int l = 0; l < lanes_.n_members[k]; ++l)
        for (int c = 0; c < dim; ++c) {
          double w = particles.velocity[c][slot.particle[l]];
          for (int a = 0; a < nc; ++a)
            w -= slot.value[a].value[l] * coarse(batch.node[a][l], c);
          if (slot.mass.value[l] == 0)
            w = 0;
          motion_[k * dim + c].value[l] = w;
          for (int a = 0; a < nc; ++a)
            carried_(batch.node[a][l], c) += slot.value[a].value[l] * slot.mass.value[l] * w;
        }
    }
  carrier_.solve(carried_);
  finish_kick(coarse, particles);
}

template <int dim>
void FineMotion<dim>::write_velocities(const Nodal<dim> &coarse,
                                       particles::Particles<dim> &particles)
{
  carried_.setZero();
  finish_kick(coarse, particles);
}

template <int dim>
void FineMotion<dim>::scale(double factor)
{
  for (LaneArray &w : motion_)
    for (double &v : w.value)
      v *= factor;
}

template <int dim>
double FineMotion<dim>::kinetic_energy(const particles::Particles<dim> &particles, double dt) const
{
  core::ExactSum sum;
  for (std::size_t k = 0; k < lanes_.slots.size(); ++k) {
    const Slot &slot = lanes_.slots[k];
    for (int l = 0; l < lanes_.n_members[k]; ++l) {
      double twice = 0;
      for (int c = 0; c < dim; ++c) {
        const double w = motion_[k * dim + c].value[l];
        twice += w * (slot.mass.value[l] * w + dt * particles.force[c][slot.particle[l]]);
      }
      sum.add(twice);
    }
  }
  return sum.value() / 2;
}

template <int dim>
void FineMotion<dim>::turn_pads(const Nodal<dim> &u, particles::Particles<dim> &particles)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  for (auto &pad : pads_) {
    Matrix f = Matrix::Identity();
    for (int a = 0; a < nc; ++a)
      f += u.row(pad.nodes[a]).transpose() * pad.gradient.col(a).transpose();
    const core::PolarRotation<dim> rotation(f);
    ligament::particles::set_orientation<dim>(particles, pad.particle, rotation.matrix());
    for (int a = 0; a < nc; ++a)
      pad.spin[a] = rotation.spin_block(pad.gradient.col(a));
  }
}

template <int dim>
void FineMotion<dim>::save(core::State &state, const particles::Particles<dim> &particles) const
{
  std::map<std::int64_t, std::array<double, dim>> rows;
  for (std::size_t k = 0; k < lanes_.slots.size(); ++k)
    for (int l = 0; l < lanes_.n_members[k]; ++l)
      for (int c = 0; c < dim; ++c)
        rows[particles.global_id[lanes_.slots[k].particle[l]]][c] = motion_[k * dim + c].value[l];
  std::vector<std::int64_t> keys;
  Components<dim> motion;
  for (const auto &[key, w] : rows) {
    keys.push_back(key);
    for (int c = 0; c < dim; ++c)
      motion[c].push_back(w[c]);
  }
  core::Table table(std::move(keys));
  for (int c = 0; c < dim; ++c)
    table.add("velocity_" + std::to_string(c), motion[c]);
  state["fluctuation"] = std::move(table);
  core::save_value(state, "fine_motion", "damper_energy", damper_energy_);
  if (has_bath())
    core::save_value(state, "fine_motion", "bath_energy", bath_energy_);
}

template <int dim>
void FineMotion<dim>::load(const core::State &state, const particles::Particles<dim> &particles)
{
  const core::Table &table = core::table(state, "fluctuation");
  std::map<std::int64_t, std::size_t> rows;
  for (std::size_t r = 0; r < table.n_rows(); ++r)
    rows[table.keys()[r]] = r;
  for (int c = 0; c < dim; ++c) {
    const auto motion = table.reals("velocity_" + std::to_string(c));
    for (std::size_t k = 0; k < lanes_.slots.size(); ++k)
      for (int l = 0; l < lanes_.n_members[k]; ++l) {
        const auto row = rows.find(particles.global_id[lanes_.slots[k].particle[l]]);
        motion_[k * dim + c].value[l] = row == rows.end() ? 0 : motion[row->second];
      }
  }
  damper_energy_ = core::load_real(state, "fine_motion", "damper_energy");
  if (has_bath())
    bath_energy_ = core::load_real(state, "fine_motion", "bath_energy");
}

template <int dim>
template <typename Visit>
void FineMotion<dim>::for_each_member(Visit &&visit) const
{
  for (const auto &batch : lanes_.batches)
    for (int k = batch.begin; k < batch.end; ++k)
      for (int l = 0; l < lanes_.n_members[k]; ++l) {
        const Slot &slot = lanes_.slots[k];
        std::array<int, nc> nodes;
        Vec<nc> value;
        for (int a = 0; a < nc; ++a) {
          nodes[a] = batch.node[a][l];
          value[a] = slot.value[a].value[l];
        }
        visit(slot.particle[l], slot.mass.value[l], 1 - slot.damping[l] / 2., nodes, value);
      }
}

// The carrier is that of the damped motion: what it takes is (1 - damping/2) Phi x.
template <int dim>
void FineMotion<dim>::expand(const Nodal<dim> &coarse, particles::Particles<dim> &particles) const
{
  Nodal<dim> carried = Nodal<dim>::Zero(coarse.rows(), dim);
  auto &v = particles.velocity;
  for_each_member([&](int i, double mass, double, const auto &nodes, const auto &value) {
    for (int c = 0; c < dim; ++c) {
      double mesh = 0;
      for (int a = 0; a < nc; ++a)
        mesh += value[a] * coarse(nodes[a], c);
      if (mass == 0)
        v[c][i] = mesh;
      for (int a = 0; a < nc; ++a)
        carried(nodes[a], c) += value[a] * mass * (v[c][i] - mesh);
    }
  });
  carrier_.solve(carried);
  for_each_member([&](int i, double mass, double left, const auto &nodes, const auto &value) {
    for (int c = 0; c < dim && mass > 0; ++c)
      for (int a = 0; a < nc; ++a)
        v[c][i] -= left * value[a] * carried(nodes[a], c);
  });
  turn_with_mesh(coarse, particles);
}

template <int dim>
void FineMotion<dim>::restrict_forces(particles::Particles<dim> &particles, Nodal<dim> &force) const
{
  Nodal<dim> carried = Nodal<dim>::Zero(force.rows(), dim);
  auto &f = particles.force;
  for_each_member([&](int i, double mass, double left, const auto &nodes, const auto &value) {
    for (int c = 0; c < dim && mass > 0; ++c)
      for (int a = 0; a < nc; ++a)
        carried(nodes[a], c) += value[a] * left * f[c][i];
  });
  carrier_.solve(carried);
  for_each_member([&](int i, double mass, double, const auto &nodes, const auto &value) {
    for (int c = 0; c < dim; ++c) {
      double taken = mass == 0 ? f[c][i] : 0;
      for (int a = 0; a < nc; ++a)
        taken += mass * value[a] * carried(nodes[a], c);
      f[c][i] -= taken;
      for (int a = 0; a < nc; ++a)
        force(nodes[a], c) += value[a] * taken;
    }
  });
  add_pad_torques(particles, force);
  for (const auto &pad : pads_)
    set(particles.torque, pad.particle, Spin<dim>(Spin<dim>::Zero()));
}

template class FineMotion<2>;
template class FineMotion<3>;
} // namespace ligament::coupling
