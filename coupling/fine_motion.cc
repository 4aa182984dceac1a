#include "coupling/fine_motion.h"

#include "core/check.h"
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
FineMotion<dim>::FineMotion(const OverlapView<dim> &whole, const OverlapView<dim> &here,
                            const std::function<double(double)> &damping, Solver solver,
                            const core::Ranks &ranks)
    : ranks_(ranks),
      carrier_(
          whole.overlap,
          [&](const Member &m) {
            return whole.particles.mass[m.particle] * (1 - float(damping(m.position)) / 2.);
          },
          solver),
      carried_(whole.overlap.n_nodes(), dim), lost_(whole.overlap.n_nodes(), dim),
      loss_(loss_matrix(whole.overlap, whole.particles, damping))
{
  for (const Member &m : whole.overlap.members)
    n_free_members_ += !m.pad;
  const auto held = held_cells(whole, here);
  std::vector<Cell> cells = find_cells(whole, here);
  make_lanes(here, held, damping, cells);
  make_pads(here, held, cells);
  note_own(here.particles, cells);
  nodal_ = NodalSums<dim>(cells, whole.overlap.n_nodes(), n_member_sums, ranks);
  motion_.resize(dim * lanes_.slots.size());
  cell_loss_.resize(lanes_.batches.size());
  sums_.resize(nodal_.n_sums(lanes_.batches.size()));
}

template <int dim>
auto FineMotion<dim>::held_cells(const OverlapView<dim> &whole, const OverlapView<dim> &here) const
    -> std::map<int, std::vector<const Member *>>
{
  std::map<int, std::size_t> n_members;
  for (const Member &m : whole.overlap.members)
    ++n_members[m.cell];
  std::map<int, std::vector<const Member *>> held;
  for (const Member &m : here.overlap.members)
    if (here.particles.part.owns(m.particle))
      held[m.cell];
  for (const Member &m : here.overlap.members)
    if (const auto cell = held.find(m.cell); cell != held.end())
      cell->second.push_back(&m);
  for (const auto &[cell, members] : held) {
    bool is_whole = members.size() == n_members[cell];
    for (const Member *m : members)
      is_whole = is_whole && particles::contains(here.particles.part.stepped, m->particle);
    core::require(is_whole, "a rank steps some particles of a cell of the overlap, but not all");
  }
  return held;
}

template <int dim>
auto FineMotion<dim>::find_cells(const OverlapView<dim> &whole, const OverlapView<dim> &here) const
    -> std::vector<Cell>
{
  std::map<int, std::int64_t> first; // members of the cells, by name
  for (const Member &m : whole.overlap.members)
    first.emplace(m.cell, whole.particles.global_id[m.particle]);
  const core::Names names = here.particles.names();
  std::vector<int> own;
  for (const auto &[cell, name] : first)
    if (const int i = names.index(name); i >= 0 && here.particles.part.owns(i))
      own.push_back(cell);
  std::map<int, int> rank_of;
  const auto of_ranks = ranks_.gather(own);
  for (std::size_t r = 0; r < of_ranks.size(); ++r)
    for (const int cell : of_ranks[r])
      rank_of[cell] = int(r);
  std::vector<Cell> cells;
  for (const auto &[cell, name] : first)
    cells.push_back({whole.overlap.cells[cell].nodes, rank_of.at(cell), -1, -1});
  return cells;
}

template <int dim>
void FineMotion<dim>::make_lanes(const OverlapView<dim> &here,
                                 const std::map<int, std::vector<const Member *>> &held,
                                 const std::function<double(double)> &damping,
                                 std::vector<Cell> &cells)
{
  using Members = std::vector<const Member *>;
  std::vector<const Members *> of_cells;
  for (const auto &[cell, members] : held)
    of_cells.push_back(&members);
  std::map<std::array<int, nc>, Cell *> cell_of;
  for (Cell &cell : cells)
    cell_of[cell.nodes] = &cell;

  for (std::size_t first = 0; first < of_cells.size(); first += lane_array_size) {
    const auto begin = of_cells.begin() + first,
               end = of_cells.begin() + std::min(first + lane_array_size, of_cells.size());
    // Fullest first, so that idle lanes come last in every slot.
    std::stable_sort(begin, end, [](auto *a, auto *b) { return a->size() > b->size(); });
    typename MemberBatches<dim>::Batch batch{};
    batch.n_cells = int(end - begin);
    for (int l = 0; l < lane_array_size; ++l) {
      const auto &nodes = begin[l < batch.n_cells ? l : 0]->front()->nodes;
      for (int a = 0; a < nc; ++a)
        batch.node[a][l] = nodes[a];
      if (l < batch.n_cells) {
        cell_of.at(nodes)->batch = int(lanes_.batches.size());
        cell_of.at(nodes)->lane = l;
      }
    }
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
        slot.mass.value[l] = here.particles.mass[m.particle];
        slot.damping[l] = float(damping(m.position));
      }
      lanes_.slots.push_back(slot);
      lanes_.n_members.push_back(n_members);
    }
    batch.end = int(lanes_.slots.size());
    lanes_.batches.push_back(batch);
  }
}

// What pads have of their own is how they turn.
template <int dim>
void FineMotion<dim>::make_pads(const OverlapView<dim> &here,
                                const std::map<int, std::vector<const Member *>> &held,
                                const std::vector<Cell> &cells)
{
  std::map<std::array<int, nc>, const Cell *> cell_of;
  for (const Cell &cell : cells)
    cell_of[cell.nodes] = &cell;
  for (const Member &m : here.overlap.members)
    if (m.pad && here.particles.turns && held.count(m.cell)) {
      const Cell &cell = *cell_of.at(m.nodes);
      Pad pad = {m.particle, cell.batch, cell.lane, m.nodes, m.gradient, {}};
      for (int a = 0; a < nc; ++a)
        pad.spin[a] = Overlap<dim>::spin_block(m, a);
      pads_.push_back(pad);
    }
}

template <int dim>
void FineMotion<dim>::note_own(const particles::Particles<dim> &particles,
                               const std::vector<Cell> &cells)
{
  own_.assign(lanes_.slots.size(), 0);
  for (std::size_t k = 0; k < lanes_.slots.size(); ++k)
    for (int l = 0; l < lanes_.n_members[k]; ++l)
      if (particles.part.owns(lanes_.slots[k].particle[l]))
        own_[k] |= std::uint8_t(1u << l);
  for (const Cell &cell : cells)
    if (cell.rank == ranks_.rank())
      own_cells_.push_back({cell.batch, cell.lane});
}

template <int dim>
template <typename Visit>
void FineMotion<dim>::for_each_pad_force(const particles::Particles<dim> &particles,
                                         Visit &&visit) const
{
  for (const auto &pad : pads_) {
    const Spin<dim> torque = get(particles.torque, pad.particle);
    for (int a = 0; a < nc; ++a)
      visit(pad, a, Vector<dim>(pad.spin[a].transpose() * torque));
  }
}

template <int dim>
void FineMotion<dim>::add_pad_torques(const particles::Particles<dim> &particles,
                                      std::vector<LaneArray> &sums) const
{
  for_each_pad_force(particles, [&](const Pad &pad, int a, const Vector<dim> &force) {
    for (int c = 0; c < dim; ++c)
      sums[nodal_.index(pad.batch, force_sum, c, a)].value[pad.lane] += force[c];
  });
}

template <int dim>
void FineMotion<dim>::add_forces(const particles::Particles<dim> &particles,
                                 Nodal<dim> &force) const
{
  std::vector<LaneArray> motion(motion_.size()), loss(cell_loss_.size()), sums(sums_.size());
  kick_members<dim>(lanes_,
                    {pointers(particles.force), 0, motion.data(), sums.data(), loss.data()});
  add_pad_torques(particles, sums);
  nodal_.add(sums, force_sum, {&force});
}

// The damper takes (C20) with w = w' - (1 - damping/2) Phi x: the parts of x are sums over nodes.
template <int dim>
void FineMotion<dim>::begin_kick(const particles::Particles<dim> &particles, double dt,
                                 Nodal<dim> &force)
{
  carried_.setZero();
  lost_.setZero();
  kick_members<dim>(
      lanes_, {pointers(particles.force), dt, motion_.data(), sums_.data(), cell_loss_.data()});
  add_pad_torques(particles, sums_);
  if (loss_.is_empty())
    nodal_.add(sums_, force_sum, {&force, &carried_});
  else
    nodal_.add(sums_, force_sum, {&force, &carried_, &lost_});
  carrier_.solve(carried_);
  if (loss_.is_empty())
    return;
  for (const auto &[batch, lane] : own_cells_)
    damper_energy_.add(cell_loss_[batch].value[lane]);
  if (!ranks_.is_first())
    return;
  Nodal<dim> square;
  loss_.multiply(carried_, square);
  damper_energy_.add(-carried_.cwiseProduct(lost_ - 0.5 * square).sum());
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
  std::fill(sums_.begin(), sums_.end(), LaneArray());
  for (std::size_t b = 0; b < lanes_.batches.size(); ++b) {
    const auto &batch = lanes_.batches[b];
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
            sums_[nodal_.index(int(b), momentum_sum, c, a)].value[l] +=
                slot.value[a].value[l] * slot.mass.value[l] * w;
        }
    }
  }
  carried_.setZero();
  nodal_.add(sums_, momentum_sum, {&carried_});
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
core::ExactSum FineMotion<dim>::kinetic_sum(const particles::Particles<dim> &particles,
                                            double dt) const
{
  core::ExactSum sum;
  for (std::size_t k = 0; k < lanes_.slots.size(); ++k) {
    const Slot &slot = lanes_.slots[k];
    for (int l = 0; l < lanes_.n_members[k]; ++l) {
      if (!(own_[k] >> l & 1u))
        continue;
      double twice = 0;
      for (int c = 0; c < dim; ++c) {
        const double w = motion_[k * dim + c].value[l];
        twice += w * (slot.mass.value[l] * w + dt * particles.force[c][slot.particle[l]]);
      }
      sum.add(twice / 2);
    }
  }
  return sum;
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
  core::save_sum(state, "fine_damper", damper_energy_);
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
  damper_energy_ = ranks_.is_first() ? core::load_sum(state, "fine_damper") : core::ExactSum();
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
  for_each_pad_force(particles, [&](const Pad &pad, int a, const Vector<dim> &f) {
    force.row(pad.nodes[a]) += f.transpose();
  });
  for (const auto &pad : pads_)
    set(particles.torque, pad.particle, Spin<dim>(Spin<dim>::Zero()));
}

template class FineMotion<2>;
template class FineMotion<3>;
} // namespace ligament::coupling
