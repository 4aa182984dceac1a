#include "coupling/operators/coarse_energy.h"

#include "coupling/operators/blended_cells.h"
#include "particles/orientation.h"

namespace ligament::coupling
{
namespace
{
/// force -= g; returns g.u.
template <int dim>
double subtract_load(const Nodal<dim> &load, const Nodal<dim> &u, Nodal<dim> &force)
{
  if (load.rows() == 0)
    return 0;
  force -= load;
  return load.cwiseProduct(u).sum();
}
} // namespace

template <int dim>
double LinearCoarseEnergy<dim>::subtract_forces(const Nodal<dim> &u, Nodal<dim> &force) const
{
  return 0.5 * stiffness_.subtract_product(u, force) + subtract_load<dim>(dead_load_, u, force);
}

template <int dim>
double CorotatedCoarseEnergy<dim>::subtract_forces(const Nodal<dim> &u, Nodal<dim> &force) const
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  Nodal<dim> turned(u.rows(), dim), f = Nodal<dim>::Zero(u.rows(), dim);
  const auto frames = parts_.frames(u);
  for (std::size_t p = 0; p < frames.size(); ++p) {
    const Matrix &r = frames[p].rotation.matrix();
    const Matrix change = r - Matrix::Identity();
    for (const int i : parts_.nodes[p])
      turned.row(i) =
          (u.row(i) - frames[p].translation.transpose()) * r + parts_.position.row(i) * change;
  }
  const double energy =
      0.5 * stiffness_.subtract_product(turned, f) + subtract_load<dim>(dead_load_, turned, f);
  for (std::size_t p = 0; p < frames.size(); ++p) {
    const auto &rotation = frames[p].rotation;
    Spin<dim> torque = Spin<dim>::Zero();
    for (const int i : parts_.nodes[p])
      torque += core::moment(Vector<dim>((parts_.position.row(i) + turned.row(i)).transpose()),
                             Vector<dim>(f.row(i).transpose()));
    const Spin<dim> y = rotation.conjugate(parts_.turning(torque));
    for (const int i : parts_.nodes[p])
      force.row(i) +=
          f.row(i) * rotation.matrix().transpose() -
          rotation.force(y, Vector<dim>(parts_.gradient.row(i).transpose())).transpose();
  }
  return energy;
}

template <int dim>
NonlinearCoarseEnergy<dim>::NonlinearCoarseEnergy(const Overlap<dim> &overlap,
                                                  const RigidFrames<dim> &parts,
                                                  const particles::Particles<dim> &particles,
                                                  const particles::ParticleForce<dim> &force,
                                                  const fem::Body<dim> &body,
                                                  const Eigen::SparseMatrix<double> &correction,
                                                  const Nodal<dim> &dead_load)
    : law_(force.finite_strain_law()), motions_(interpolate_motions(overlap, particles, force)),
      state_(std::make_unique<particles::Particles<dim>>())
{
  add_cells(overlap, body);
  add_parts(overlap, particles, force);
  Nodal<dim> load = dead_load;
  if (load.size() > 0) // the parts have forces at rest, too
    add_discrete(Nodal<dim>::Zero(overlap.n_nodes(), dim), load, false);
  if (correction.nonZeros() > 0 || load.size() > 0)
    correction_ = std::make_unique<CorotatedCoarseEnergy<dim>>(correction, parts, load);
}

template <int dim>
void NonlinearCoarseEnergy<dim>::add_cells(const Overlap<dim> &overlap, const fem::Body<dim> &body)
{
  std::vector<Vector<dim>> sizes;
  std::vector<typename fem::CondensedCell<dim>::Shares> shares;
  std::vector<int> whole; // stiffness of whole cells, by shape
  for (const auto &cell : overlap.cells) {
    const Vector<dim> &h = overlap.mesh.cell_size[cell.cell];
    int shape = 0;
    while (shape < int(sizes.size()) &&
           (shares[shape] != cell.shape.shares ||
            ((sizes[shape] - h).array().abs() > 1e-12 * h.array()).any()))
      ++shape;
    if (shape == int(sizes.size())) {
      sizes.push_back(h);
      shares.push_back(cell.shape.shares);
      shapes_.emplace_back(h);
      shapes_.back().corner = cell.shape.place.colwise() - h / 2;
      shapes_.back().gradient *= cell.shape.shares;
      whole.push_back(-1);
    }
    int &known = whole[shape];
    const int stiffness = cell.layer > 0 && known >= 0 ? known : int(stiffness_.size());
    if (stiffness == int(stiffness_.size())) {
      stiffness_.push_back(blended_cell_stiffness(overlap, cell, body));
      if (law_) {
        means_.push_back(blended_cell_mean(overlap, cell, body));
        stiffness_.back() = fem::deviation_stiffness(stiffness_.back(), means_.back(), body);
      }
    }
    if (cell.layer > 0)
      known = stiffness;
    cells_.push_back({cell.nodes, shape, stiffness});
  }
}

template <int dim>
void NonlinearCoarseEnergy<dim>::add_parts(const Overlap<dim> &overlap,
                                           const particles::Particles<dim> &particles,
                                           const particles::ParticleForce<dim> &force)
{
  std::vector<int> members;
  for (const auto &m : overlap.members)
    members.push_back(m.particle);
  discrete_ =
      force.part(particles, members, [&](const Vector<dim> &location, const std::vector<int> &of) {
        return overlap.subtracted_share(location, of);
      });
  state_->turns = particles.turns;
  state_->resize(int(members.size()));
  for (std::size_t k = 0; k < members.size(); ++k) {
    set(state_->reference, int(k), get(particles.reference, members[k]));
    if (particles.turns)
      set(state_->rotation, int(k), get(particles.rotation, members[k]));
    state_->volume[k] = particles.volume[members[k]];
  }
  if (particles.turns)
    return;
  shares_begin_.push_back(0);
  for (const InterpolatedMotion<dim> &motion : motions_) {
    for (const NodeShare<dim> &s : motion) {
      share_node_.push_back(s.node);
      share_value_.push_back(s.value);
    }
    shares_begin_.push_back(int(share_node_.size()));
  }
  motions_.clear();
  motions_.shrink_to_fit();
}

template <int dim>
double NonlinearCoarseEnergy<dim>::subtract_cells(const Nodal<dim> &u, Nodal<dim> &force,
                                                  bool wants_energy) const
{
  double energy = 0;
  fem::CellVectors<dim> cell_u, cell_f;
  for (const Cell &cell : cells_) {
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      cell_u.col(a) = u.row(cell.nodes[a]);
    const auto &k = stiffness_[cell.stiffness];
    const auto &shape = shapes_[cell.shape];
    energy += law_ ? fem::strained_cell<dim>(*law_, means_[cell.stiffness], k, shape, cell_u,
                                             cell_f, wants_energy)
                   : fem::corotated_cell<dim>(k, shape, cell_u, cell_f);
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      force.row(cell.nodes[a]) += cell_f.col(a).transpose();
  }
  return energy;
}

template <int dim>
double NonlinearCoarseEnergy<dim>::compute_parts(bool wants_energy) const
{
  if (wants_energy)
    return discrete_->compute(*state_);
  discrete_->compute_forces(*state_);
  return 0;
}

// force += dE/dU of the interpolated motion; returns E where it is wanted.
template <int dim>
double NonlinearCoarseEnergy<dim>::add_discrete(const Nodal<dim> &u, Nodal<dim> &force,
                                                bool wants_energy) const
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  if (!state_->turns)
    return add_places(u, force, wants_energy);
  std::vector<core::PolarRotation<dim>> polars;
  polars.reserve(motions_.size());
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    Matrix gradient = Matrix::Identity();
    Vector<dim> translation = Vector<dim>::Zero();
    for (const NodeShare<dim> &s : motions_[k]) {
      translation += s.value * u.row(s.node).transpose();
      gradient += u.row(s.node).transpose() * s.gradient.transpose();
    }
    polars.emplace_back(gradient);
    set(state_->displacement, int(k), translation);
    particles::set_orientation<dim>(*state_, int(k), polars.back().matrix());
  }
  const double energy = compute_parts(wants_energy);
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const auto &polar = polars[k];
    const Vector<dim> f = get(state_->force, int(k));
    const Spin<dim> y = polar.conjugate(polar.to_body(get(state_->torque, int(k))));
    for (const NodeShare<dim> &s : motions_[k])
      force.row(s.node) -= (s.value * f + polar.force(y, s.gradient)).transpose();
  }
  return energy;
}

// The same of members that have a place alone.
template <int dim>
double NonlinearCoarseEnergy<dim>::add_places(const Nodal<dim> &u, Nodal<dim> &force,
                                              bool wants_energy) const
{
  const int n = state_->size();
  for (int k = 0; k < n; ++k) {
    Vector<dim> translation = Vector<dim>::Zero();
    for (int s = shares_begin_[k]; s < shares_begin_[k + 1]; ++s)
      translation += share_value_[s] * u.row(share_node_[s]).transpose();
    set(state_->displacement, k, translation);
  }
  const double energy = compute_parts(wants_energy);
  for (int k = 0; k < n; ++k) {
    const Vector<dim> f = get(state_->force, k);
    for (int s = shares_begin_[k]; s < shares_begin_[k + 1]; ++s)
      force.row(share_node_[s]) -= share_value_[s] * f.transpose();
  }
  return energy;
}

template <int dim>
double NonlinearCoarseEnergy<dim>::subtract(const Nodal<dim> &u, Nodal<dim> &force,
                                            bool wants_energy) const
{
  const double cells = subtract_cells(u, force, wants_energy);
  const double correction = correction_ ? correction_->subtract_forces(u, force) : 0;
  return cells + correction - add_discrete(u, force, wants_energy);
}

template class LinearCoarseEnergy<2>;
template class LinearCoarseEnergy<3>;
template class CorotatedCoarseEnergy<2>;
template class CorotatedCoarseEnergy<3>;
template class NonlinearCoarseEnergy<2>;
template class NonlinearCoarseEnergy<3>;
} // namespace ligament::coupling
