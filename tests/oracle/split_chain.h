// The fine-scale split of theory.md sections 3.1 to 3.4 in one dimension.
#pragma once

#include "tests/oracle/coupled_chain.h"

namespace ligament::oracle
{
class SplitChain : public Chain
{
public:
  explicit SplitChain(const ChainParameters &parameters) : Chain(parameters)
  {
    for (int i = first; i < n; ++i) {
      node_mass += weight(i) * mass[i] * phi.row(i).transpose() * phi.row(i); // (C6)
      bound += weight(i) * mass[i] / std::pow(3, p.dim) * phi.row(i).transpose();
    }
    subtract_bonds();
    if (p.fit_patch)
      stiffness += patch_fit();
    make_filter();
  }

  /// Velocities as given are split, (C1); they must fulfil Phi^T M w = 0.
  void start() { w = free_part(v - phi * nodal_v); }

  void step() // section 4
  {
    const Vector f = particle_force();
    const Vector change =
        p.dt * node_mass.ldlt().solve(phi.transpose() * f - stiffness * nodal_u); // (C4)
    nodal_v += change - node_mass.ldlt().solve(filter * (nodal_v + change / 2));
    Vector delta(n);
    for (int i = 0; i < n; ++i)
      delta[i] = is_member(i) ? float(damping(i)) : 0;
    const Vector share = Vector::Ones(n) - delta / 2;
    w = free_part((Vector::Ones(n) - delta).cwiseProduct(w) +
                  p.dt * share.cwiseProduct(f.cwiseQuotient(mass)));
    const Matrix free_phi = free_part(phi), momentum = free_phi.transpose() * mass.asDiagonal();
    w -= share.asDiagonal() * free_phi *
         solve(momentum * share.asDiagonal() * free_phi, momentum * w); // (C19)
    v += p.dt * f.cwiseQuotient(mass);
    v.tail(n - first) = (phi * nodal_v + w).tail(n - first);
    u += p.dt * v;
    nodal_u += p.dt * nodal_v;
  }

  Vector w;
  Matrix filter;

private:
  /// Rows of members that are no pads, the others 0.
  Matrix free_part(Matrix rows) const
  {
    rows.topRows(first).setZero();
    rows.bottomRows(n - n_free).setZero();
    return rows;
  }

  void subtract_bonds() // (C3) with the motion (C17)
  {
    Matrix motion = phi;
    for (int i = first + 1; i < n_free; ++i) // on a straight line where one neighbour is missing
      motion.row(i) += 0.25 / (2 + p.beside) * (phi.row(i - 1) + phi.row(i + 1) - 2 * phi.row(i));
    for (int i = first; i + 1 < n; ++i) {
      const Vector stretch = (motion.row(i + 1) - motion.row(i)).transpose();
      const double share = i + 1 < n_free ? 1 - weight(i + 0.5) : 1;
      stiffness -= share * spring[i] * stretch * stretch.transpose();
    }
  }

  Matrix patch_fit() const // (C7) to (C9)
  {
    Vector straight = Vector::Zero(n);
    straight[0] = spring[0]; // forces of the particles under unit strain
    straight[n - 1] = -spring[n - 2];
    Vector residual = phi.transpose() * straight - stiffness * p.nodes;
    residual.tail(n_nodes - n_overlap - 1).setZero();
    const int n_blocks = n_overlap - 1;
    Matrix forces = Matrix::Zero(n_nodes, 2 * n_blocks), affine(3, n_blocks), normal(3, n_blocks);
    for (int b = 0; b < n_blocks; ++b) {
      const Eigen::Vector3d x = p.nodes.segment(b, 3).array() - p.nodes.segment(b, 3).mean();
      const Eigen::Vector3d one = Eigen::Vector3d::Ones();
      affine.col(b) = x / x.squaredNorm();
      normal.col(b) = x.cross(one).normalized();
      // Unknowns S/V_b and H/(V_b/h_b); H is spread over the block's columns of nodes.
      const double volume = p.nodes[b + 2] - p.nodes[b], size = std::min(h(b), h(b + 1));
      forces.col(2 * b).segment(b, 3) = volume * affine.col(b);
      forces.col(2 * b + 1).segment(b, 3) = volume / size * std::sqrt(p.columns) * normal.col(b);
    }
    const Vector unknowns = solve(forces, residual);
    Matrix correction = Matrix::Zero(n_nodes, n_nodes);
    for (int b = 0; b < n_blocks; ++b) {
      const Vector a = affine.col(b);
      const Vector s = unknowns[2 * b] * forces.col(2 * b).segment(b, 3);
      const Vector t = unknowns[2 * b + 1] * forces.col(2 * b + 1).segment(b, 3);
      correction.block(b, b, 3, 3) += s * a.transpose() + t * a.transpose() + a * t.transpose();
    }
    return correction;
  }

  void make_filter() // (C12)
  {
    Matrix l = Matrix::Zero(n_nodes, n_nodes);
    for (int i = 1; i < n_near; ++i) {
      const double below = h(i - 1), above = h(i);
      l.block(i, i - 1, 1, 3) =
          Eigen::RowVector3d(-above, below + above, -below) / 2 / (below + above);
    }
    l = (l * l * l).eval();
    const Vector taken = (l.cwiseAbs().transpose() * bound).cwiseQuotient(bound.cwiseMax(1e-300));
    Vector m = Vector::Zero(n_nodes);
    for (int i = 0; i < n_near; ++i) {
      double most = 1;
      for (int j = 0; j < n_nodes; ++j)
        most = l(i, j) != 0 ? std::max(most, taken[j] / 2) : most;
      const double rate = p.dim * p.gap_filter * std::sqrt(p.modulus / p.mass) /
                          std::min(h(std::max(i - 1, 0)), h(i));
      m[i] = (1 - std::exp(-rate * p.dt)) / p.dim * bound[i] / most;
    }
    filter = l.transpose() * m.asDiagonal() * l;
  }
};
} // namespace ligament::oracle
