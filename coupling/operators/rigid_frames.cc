#include "coupling/operators/rigid_frames.h"

#include <Eigen/LU>

#include <algorithm>
#include <numeric>

namespace ligament::coupling
{
template <int dim>
RigidFrames<dim>::RigidFrames(const Overlap<dim> &overlap)
    : position(overlap.n_nodes(), dim), gradient(overlap.n_nodes(), dim)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  for (int c = 0; c < dim; ++c)
    free_[c] = overlap.parameters.period[c] > 0 ? 0 : 1;
  if constexpr (dim == 2)
    free_spin_[0] = free_[0] * free_[1];
  else
    for (int c = 0; c < dim; ++c)
      free_spin_[c] = free_[(c + 1) % dim] * free_[(c + 2) % dim];
  std::vector<int> parent(overlap.n_nodes());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const auto &cell : overlap.cells)
    for (const int node : cell.nodes)
      parent[root(node)] = root(cell.nodes[0]);
  std::vector<int> part_of_root(overlap.n_nodes(), -1);
  for (int i = 0; i < overlap.n_nodes(); ++i) {
    int &part = part_of_root[root(i)];
    if (part < 0) {
      part = int(nodes.size());
      nodes.emplace_back();
    }
    nodes[part].push_back(i);
  }
  for (const auto &cell : overlap.cells) {
    const Vector<dim> &h = overlap.mesh.cell_size[cell.cell];
    Vector<dim> centre = Vector<dim>::Zero();
    for (const int node : overlap.mesh.cells[cell.cell])
      centre += overlap.mesh.nodes[node] / fem::n_cell_nodes<dim>;
    cells_.push_back({part_of_root[root(cell.nodes[0])], cell.nodes,
                      fem::shape_gradients<dim>(Vector<dim>::Zero(), h, h / 2) * cell.shape.shares,
                      centre});
  }
  for (const auto &part : nodes) {
    Vector<dim> centre = Vector<dim>::Zero();
    for (const int i : part)
      centre += overlap.mesh.nodes[overlap.near_nodes[i]] / double(part.size());
    Matrix moment = Matrix::Zero();
    for (const int i : part) {
      const Vector<dim> x = overlap.mesh.nodes[overlap.near_nodes[i]] - centre;
      position.row(i) = x.transpose();
      moment += x * x.transpose();
    }
    const Matrix inverse = moment.inverse();
    for (const int i : part)
      gradient.row(i) = position.row(i) * inverse * free_.asDiagonal();
  }
}

template <int dim>
std::vector<typename RigidFrames<dim>::Frame> RigidFrames<dim>::frames(const Nodal<dim> &u) const
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  std::vector<Frame> frames;
  for (const auto &part : nodes) {
    Matrix f = Matrix::Identity();
    Vector<dim> mean = Vector<dim>::Zero();
    for (const int i : part) {
      f += free_.cwiseProduct(u.row(i).transpose()) * gradient.row(i);
      mean += u.row(i).transpose() / double(part.size());
    }
    frames.push_back({core::PolarRotation<dim>(f), mean});
  }
  return frames;
}

template <int dim>
NearMotion<dim> RigidFrames<dim>::largest_motion(const Nodal<dim> &u) const
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const auto parts = frames(u);
  NearMotion<dim> largest;
  for (const Cell &cell : cells_) {
    Matrix f = Matrix::Identity();
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      f += u.row(cell.nodes[a]).transpose() * cell.gradient.col(a).transpose();
    const core::PolarRotation<dim> rotation(f);
    const Matrix &r = rotation.matrix();
    const core::PolarRotation<dim> relative(parts[cell.part].rotation.matrix().transpose() * r);
    largest.rotation.take(rotation.angle(), cell.centre);
    largest.bending.take(relative.angle(), cell.centre);
    largest.strain.take((r.transpose() * f - Matrix::Identity()).norm(), cell.centre);
  }
  return largest;
}

template class RigidFrames<2>;
template class RigidFrames<3>;
} // namespace ligament::coupling
