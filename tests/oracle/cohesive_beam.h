// A plain oracle for the peak load of a notched beam whose faces soften: by symmetry its crack is
// straight, so half the beam in finite elements and a law of softening on its section are enough.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <cmath>
#include <utility>
#include <vector>

namespace ligament::oracle
{
/// Three-point bending of a beam of depth 1 over a span of 2.5, plane stress, E = 1, nu = 0.2, held
/// and loaded on 0.08 each; the faces soften along two straight lines as those of concrete do.
class CohesiveBeam
{
public:
  /// So many square cells over the depth; the notch and E G_c/f_t^2 in depths.
  CohesiveBeam(int cells, double notch, double length) : n_(cells), notch_(notch), length_(length)
  {
    group_.assign(2 * (nx() + 1) * (n_ + 1), -1);
    const double h = 1. / n_;
    for (int j = 0; j <= n_; ++j)
      if (const double above = j - notch_ * n_; above >= -1e-9) {
        group_[2 * node(0, j)] = n_groups_++;
        width_.push_back(above < 1e-9 || j == n_ ? h / 2 : h);
      }
    load_ = n_groups_++;
    const int support = n_groups_++;
    for (int i = 0; i <= nx(); ++i) {
      if (i * h <= 0.04 + 1e-9)
        group_[2 * node(i, n_) + 1] = load_;
      if (std::abs(i * h - span / 2) <= 0.04 + 1e-9)
        group_[2 * node(i, 0) + 1] = support;
    }
    condense();
  }

  /// Largest 3 P S/(2 (D-a)^2) over the strength, the load point moving down.
  double strength_of_section() const
  {
    constexpr int n_steps = 400;
    const int m = int(width_.size());
    const double stroke = 0.6 * strength * (1.5 * span * span / 6 + 4 * length_);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(m); // half of the openings
    double peak = 0;
    for (int step = 1; step <= n_steps; ++step) {
      const double down = -stroke * step / n_steps;
      for (int round = 0; round < 100; ++round) {
        Eigen::MatrixXd tangent = stiffness_.topLeftCorner(m, m);
        Eigen::VectorXd residual = tangent * u + stiffness_.col(load_).head(m) * down;
        for (int a = 0; a < m; ++a) {
          const auto [traction, slope] = softening(2 * u[a]);
          residual[a] += width_[a] * traction;
          tangent(a, a) += 2 * width_[a] * slope;
        }
        const Eigen::VectorXd change = tangent.partialPivLu().solve(-residual);
        u += change;
        if (change.norm() < 1e-10 * strength)
          break;
      }
      const double force =
          -2 * (stiffness_.row(load_).head(m) * u + stiffness_(load_, load_) * down);
      peak = std::max(peak, force);
      if (force < 0.8 * peak)
        break;
    }
    return 1.5 * peak * span / std::pow(1 - notch_, 2) / strength;
  }

private:
  using CellMatrix = Eigen::Matrix<double, 8, 8>;
  static constexpr double nu = 0.2, strength = 1e-3, span = 2.5;

  int nx() const { return int(1.45 * n_ + 0.5); }
  int node(int i, int j) const { return j * (nx() + 1) + i; }

  /// Square cell with Wilson's incompatible modes, of any size.
  static CellMatrix cell_stiffness()
  {
    Eigen::Matrix3d c;
    c << 1, nu, 0, nu, 1, 0, 0, 0, (1 - nu) / 2;
    c /= 1 - nu * nu;
    CellMatrix k = CellMatrix::Zero();
    Eigen::Matrix<double, 8, 4> to_modes = Eigen::Matrix<double, 8, 4>::Zero();
    Eigen::Matrix4d of_modes = Eigen::Matrix4d::Zero();
    const double gauss = 1 / std::sqrt(3.), sx[] = {-1, 1, 1, -1}, sy[] = {-1, -1, 1, 1};
    for (const double y : {-gauss, gauss})
      for (const double x : {-gauss, gauss}) {
        Eigen::Matrix<double, 3, 8> b = Eigen::Matrix<double, 3, 8>::Zero();
        for (int a = 0; a < 4; ++a) {
          b(0, 2 * a) = b(2, 2 * a + 1) = sx[a] * (1 + sy[a] * y) / 2;
          b(1, 2 * a + 1) = b(2, 2 * a) = sy[a] * (1 + sx[a] * x) / 2;
        }
        Eigen::Matrix<double, 3, 4> modes;
        modes << x, 0, 0, 0, 0, y, 0, 0, 0, 0, x, y;
        k += b.transpose() * c * b / 4;
        to_modes += b.transpose() * c * modes / 4;
        of_modes += modes.transpose() * c * modes / 4;
      }
    return k - to_modes * of_modes.inverse() * to_modes.transpose();
  }

  /// Traction and its slope at an opening, stiff until the strength.
  std::pair<double, double> softening(double w) const
  {
    const double energy = length_ * strength * strength, corner = 0.8 * energy / strength,
                 end = 3.6 * energy / strength, stiff = 200. * n_;
    if (w < strength / stiff)
      return {stiff * w, stiff};
    w -= strength / stiff;
    if (w < corner)
      return {strength * (1 - 2 * w / (3 * corner)), -2 * strength / (3 * corner)};
    if (w < end)
      return {strength / 3 * (end - w) / (end - corner), -strength / (3 * (end - corner))};
    return {0, 0};
  }

  /// Onto the nodes of the section, the load and the support.
  void condense()
  {
    std::vector<int> free(group_.size(), -1);
    int n_free = 0;
    for (std::size_t k = 0; k < group_.size(); ++k)
      if (group_[k] < 0)
        free[k] = n_free++;
    const CellMatrix cell = cell_stiffness();
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(n_free, n_groups_),
                    own = Eigen::MatrixXd::Zero(n_groups_, n_groups_);
    for (int j = 0; j < n_; ++j)
      for (int i = 0; i < nx(); ++i) {
        const int c[] = {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
        for (int p = 0; p < 8; ++p)
          for (int q = 0; q < 8; ++q) {
            const int a = 2 * c[p / 2] + p % 2, b = 2 * c[q / 2] + q % 2;
            if (group_[a] < 0 && group_[b] < 0)
              entries.emplace_back(free[a], free[b], cell(p, q));
            else if (group_[a] < 0)
              mixed(free[a], group_[b]) += cell(p, q);
            else if (group_[b] >= 0)
              own(group_[a], group_[b]) += cell(p, q);
          }
      }
    Eigen::SparseMatrix<double> inner(n_free, n_free);
    inner.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(inner);
    stiffness_ = own - mixed.transpose() * solver.solve(mixed);
  }

  int n_;
  double notch_, length_;
  std::vector<int> group_;    // of each unknown: condensed unknown, -1 inside
  std::vector<double> width_; // of the section's nodes
  int n_groups_ = 0, load_ = 0;
  Eigen::MatrixXd stiffness_; // of groups
};
} // namespace ligament::oracle
