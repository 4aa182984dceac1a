// A row of point masses with springs and a row of linear finite elements that overlap: both
// couplers of theory.md section 3 in one dimension, in dense matrices. Shares nothing with them.
#pragma once

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::oracle
{
struct ChainParameters
{
  int n_particles = 0;          // of spacing 1, the first at 0; the last ones close the packing
  Eigen::VectorXd nodes;        // m, ascending; the first lies among the particles
  double edge = 0, length = 0;  // m, of the packing, and L of the overlap
  double modulus = 1, mass = 1; // E, and of a particle of volume 1
  double fine_damper = 0, gap_filter = 0, dt = 0;
  int transition_cells = 0;
  bool is_lumped = false; // the mass of all cells, (B5)
  bool fit_patch = true;
  bool has_pads = true; // the fine-scale split
  // Of the body of which this is one row: its dimension, bonded neighbours of a particle beside the
  // row, and nodes of a block of the patch fit side by side. All of them move as the row does.
  int dim = 2, beside = 2, columns = 3;
};

/// What both couplers start from: weights, interpolation, matrices of all cells and all nodes.
class Chain
{
public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  explicit Chain(const ChainParameters &parameters)
      : p(parameters), n(p.n_particles), n_nodes(int(p.nodes.size())),
        phi(Matrix::Zero(n, n_nodes)), stiffness(Matrix::Zero(n_nodes, n_nodes)),
        node_mass(stiffness), bound(Vector::Zero(n_nodes)), mass(Vector::Constant(n, p.mass)),
        spring(Vector::Constant(n - 1, p.modulus)), u(Vector::Zero(n)), v(u),
        nodal_u(Vector::Zero(n_nodes)), nodal_v(nodal_u)
  {
    while (first < n && first < p.nodes[0])
      ++first;
    n_free = p.has_pads ? n - 2 : n; // pads: the last particle, which is open, and its neighbour
    depth = p.has_pads ? p.edge - n_free : p.edge - (n - 1) - 0.5;
    for (int i = first; i < n; ++i)
      for (int k = 0; k + 1 < n_nodes; ++k)
        if (const double t = (i - p.nodes[k]) / h(k); t >= 0 && t < 1) {
          phi(i, k) = 1 - t;
          phi(i, k + 1) = t;
        }
    while (p.nodes[n_overlap] < p.edge - 1e-8)
      ++n_overlap;
    n_near = n_overlap + p.transition_cells;
    add_cells();
  }

  double h(int cell) const { return p.nodes[cell + 1] - p.nodes[cell]; }
  bool is_member(int i) const { return i >= first; }
  double position(double x) const // (C5)
  {
    return std::min(1., std::max(0., (p.edge - x - depth) / (p.length - 1 - depth)));
  }
  double weight(double x) const { return position(x) * position(x) * (3 - 2 * position(x)); }
  double damping(double x) const // (C11)
  {
    return 1 - std::exp(-p.fine_damper * std::sqrt(p.modulus / p.mass) / h(0) *
                        std::pow(1 - position(x), 1.5) * p.dt);
  }
  Vector particle_force() const
  {
    const Vector tension = spring.cwiseProduct(u.tail(n - 1) - u.head(n - 1));
    Vector f = Vector::Zero(n);
    f.head(n - 1) += tension;
    f.tail(n - 1) -= tension;
    return f;
  }
  /// Of velocities as given, once at the beginning.
  void start() {}
  /// Bound of what so many steps leave of exact arithmetic: each solve loses the condition of its
  /// matrix in machine epsilons, and no motion grows.
  double roundoff(int n_steps) const
  {
    const Vector eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix>(node_mass).eigenvalues();
    return n_steps * eigenvalues[n_nodes - 1] / eigenvalues[0] *
           std::numeric_limits<double>::epsilon();
  }
  /// a^-1 b where a may have dependent columns.
  static Matrix solve(const Matrix &a, const Matrix &b)
  {
    Eigen::CompleteOrthogonalDecomposition<Matrix> solver;
    solver.setThreshold(1e-10);
    return solver.compute(a).solve(b);
  }

  const ChainParameters p;
  const int n, n_nodes;
  int first = 0, n_free = 0, n_overlap = 0,
      n_near = 0; // member; not pad; cells of layer 0; and near
  double depth = 0;
  Matrix phi, stiffness, node_mass;
  Vector bound;        // below node_mass, section 3.4
  Vector mass, spring; // of the particles
  Vector u, v, nodal_u, nodal_v;

private:
  void add_cells() // (C3), (C6), (F2); four Gauss points in each cell
  {
    for (int k = 0; k + 1 < n_nodes; ++k) {
      const int layer = k < n_overlap ? 0 : k - n_overlap + 1;
      const double mu = p.is_lumped || k >= n_near ? 0
                        : layer == 0               ? 1
                                                   : 1 - (layer - 0.5) / p.transition_cells;
      for (const double sign : {-1., 1.})
        for (const double root : {-1., 1.}) {
          const double x = sign * std::sqrt(3. / 7 + root * 2. / 7 * std::sqrt(1.2)) / 2 + 0.5;
          const double w = (18 - root * std::sqrt(30.)) / 72 * h(k) *
                           (layer == 0 ? 1 - weight(p.nodes[k] + x * h(k)) : 1);
          const Eigen::Vector2d shape(1 - x, x), strain(-1 / h(k), 1 / h(k));
          const Eigen::Matrix2d lumped = shape.asDiagonal();
          stiffness.block(k, k, 2, 2) += w * p.modulus * strain * strain.transpose();
          node_mass.block(k, k, 2, 2) +=
              w * p.mass * (mu * shape * shape.transpose() + (1 - mu) * lumped);
          if (k < n_near)
            bound.segment(k, 2) += w * p.mass * (1 - mu + mu / std::pow(3, p.dim)) * shape;
        }
    }
  }
};
} // namespace ligament::oracle
