// Strains of the particles' own written down plainly, particle by particle with matrices of three
// axes: stress, return mapping, forces, energy. It shares only data types with the production code.
#pragma once

#include "dem/inelastic/plasticity.h"
#include "packings/packing.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <cmath>
#include <vector>

namespace ligament::oracle
{
template <int dim>
class InelasticOracle
{
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;

  std::vector<Eigen::Matrix3d> strain; // of each particle, in its own axes
  std::vector<double> history;
  std::vector<Eigen::Matrix3d> stress; // after the last flow(), Pa

  InelasticOracle(const packings::Packing<dim> &packing, double e, double nu,
                  dem::Plasticity law, PlaneMode plane = PlaneMode::strain)
      : strain(packing.size(), Eigen::Matrix3d::Zero()), history(packing.size(), 0.),
        stress(strain), packing_(packing), e_(e), nu_(nu), g_(e / (2 * (1 + nu))),
        k_(e / (3 * (1 - 2 * nu))), law_(std::move(law)), plane_(plane)
  {
  }

  /// Every particle yields once.
  void flow(const particles::Particles<dim> &p)
  {
    const State s(*this, p);
    for (int i = 0; i < packing_.size(); ++i) {
      stress[i] = own_stress(s, i);
      if (!is_held(i))
        continue;
      if (const auto *mises = std::get_if<dem::VonMisesFlow>(&law_))
        flow(*mises, i);
      if (const auto *prager = std::get_if<dem::DruckerPragerFlow>(&law_))
        flow(*prager, i);
      stress[i] = own_stress(s, i);
    }
  }

  /// Forces (and torques behind them) of the bonds without bending, at the present strains.
  std::vector<Eigen::VectorXd> forces(const particles::Particles<dim> &p) const
  {
    const State s(*this, p);
    std::vector<Eigen::VectorXd> all(packing_.size(),
                                     Eigen::VectorXd::Zero(dim + n_spins<dim>));
    for (const auto &f : packing_.faces) {
      if (f.cracked)
        continue;
      const double r = f.q_i + f.q_j;
      const Vector<dim> a_i = s.turn[f.i] * f.lever_i, a_j = s.turn[f.j] * f.lever_j;
      const Vector<dim> b_i = s.turn[f.i] * in_plane(f.i) * f.lever_i,
                        b_j = s.turn[f.j] * in_plane(f.j) * f.lever_j;
      const Vector<dim> du = relative(f, s.turn, p);
      const double p_i = pressure(s, f.i), p_j = pressure(s, f.j), k = 2 * g_ * f.area / r;
      const Vector<dim> force =
          k * (du - b_i + b_j) + f.area / r * (p_i * a_i - p_j * a_j);
      all[f.i].head(dim) += force;
      all[f.j].head(dim) -= force;
      all[f.i].tail(n_spins<dim>) +=
          cross(a_i, force - f.area / r * p_i * du) + cross(b_i, k * du);
      all[f.j].tail(n_spins<dim>) -=
          cross(a_j, force - f.area / r * p_j * du) + cross(b_j, k * du);
    }
    return all;
  }

private:
  using Face = packings::Face<dim>;

  struct State
  {
    std::vector<Matrix> turn, x, m; // rotation; sum of S/r R^T Du (x) A; V M
    std::vector<double> phi;

    State(const InelasticOracle &o, const particles::Particles<dim> &p)
        : x(p.size(), Matrix::Zero()), m(x),
          phi(p.size(), dim == 2 && o.plane_ == PlaneMode::strain ? 1. : 0.)
    {
      for (int i = 0; i < p.size(); ++i)
        turn.push_back(rotation(p, i));
      for (const auto &f : o.packing_.faces) {
        if (f.cracked)
          continue;
        const double s_r = f.area / (f.q_i + f.q_j);
        const Vector<dim> du = relative(f, turn, p);
        x[f.i] += s_r * turn[f.i].transpose() * du * f.lever_i.transpose();
        x[f.j] -= s_r * turn[f.j].transpose() * du * f.lever_j.transpose();
        const Matrix m_i = f.area * f.lever_i * f.normal.transpose(),
                     m_j = -f.area * f.lever_j * f.normal.transpose();
        m[f.i] += 0.5 * (m_i + m_i.transpose());
        m[f.j] += 0.5 * (m_j + m_j.transpose());
        phi[f.i] += f.area * f.q_i / o.packing_.volume[f.i];
        phi[f.j] += f.area * f.q_j / o.packing_.volume[f.j];
      }
    }
  };

  /// Faces that are few and eccentric don't hold a particle.
  bool is_held(int i) const
  {
    Matrix sum = Matrix::Zero();
    for (const auto &f : packing_.faces)
      if (!f.cracked && (f.i == i || f.j == i)) {
        const Vector<dim> a = f.i == i ? f.lever_i : f.lever_j,
                          b = f.i == i ? f.lever_j : f.lever_i; // (d a) . (d b) of any d
        const Matrix ab = a * b.transpose();
        sum -= f.area / (f.q_i + f.q_j) * 0.5 * (ab + ab.transpose());
      }
    return Eigen::SelfAdjointEigenSolver<Matrix>(sum).eigenvalues()[0] >= 0.05 * packing_.volume[i];
  }

  Matrix in_plane(int i) const { return strain[i].template topLeftCorner<dim, dim>(); }
  bool is_plane_strain() const { return dim == 2 && plane_ == PlaneMode::strain; }

  double pressure(const State &s, int i) const
  {
    const double share = 3 * nu_ / (1 + nu_), v = packing_.volume[i];
    const double lambda = 2 * g_ * share / (3 - share * s.phi[i]);
    double flowed = s.m[i].cwiseProduct(in_plane(i)).sum() / v;
    if (is_plane_strain())
      flowed += strain[i](2, 2);
    return lambda * (s.x[i].trace() / v - flowed);
  }

  Eigen::Matrix3d own_stress(const State &s, int i) const
  {
    const double v = packing_.volume[i], p = pressure(s, i);
    const Matrix e = in_plane(i), m = s.m[i] / v;
    const Matrix e_m = e * m;
    Eigen::Matrix3d t = Eigen::Matrix3d::Zero();
    t.template topLeftCorner<dim, dim>() = g_ / v * (s.x[i] + s.x[i].transpose()) -
                                           g_ * (e_m + e_m.transpose()) + p * m;
    if (is_plane_strain())
      t(2, 2) = p - 2 * g_ * strain[i](2, 2);
    return t;
  }

  void flow(const dem::VonMisesFlow &law, int i)
  {
    const Eigen::Matrix3d s =
        stress[i] - stress[i].trace() / 3 * Eigen::Matrix3d::Identity();
    const double equivalent = std::sqrt(1.5) * s.norm();
    if (equivalent <= law.yield.at(history[i]))
      return;
    double low = 0, high = equivalent / (3 * g_); // bisection: no derivative of the curve
    for (int k = 0; k < 200; ++k) {
      const double middle = (low + high) / 2;
      (equivalent - 3 * g_ * middle > law.yield.at(history[i] + middle) ? low : high) = middle;
    }
    strain[i] += 1.5 * low / equivalent * s;
    history[i] += low;
  }

  void flow(const dem::DruckerPragerFlow &law, int i)
  {
    const double mean = stress[i].trace() / 3;
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), s = stress[i] - mean * one;
    const double tau = s.norm() / std::sqrt(2.),
                 yield = law.cohesion + law.hardening * history[i],
                 excess = law.friction * mean + tau - yield;
    if (excess <= 0)
      return;
    const double shear =
        excess / (g_ + k_ * law.dilatancy * law.friction + law.hardening);
    if (g_ * shear <= tau) {
      strain[i] += shear * (s / (2 * tau) + law.dilatancy / 3 * one);
      history[i] += shear;
      return;
    }
    const double all = tau / g_;
    strain[i] += s / (2 * g_) +
                 (mean - (yield + law.hardening * all) / law.friction) / (3 * k_) * one;
    history[i] += all;
  }

  static Matrix rotation(const particles::Particles<dim> &p, int i)
  {
    if constexpr (dim == 2)
      return Eigen::Rotation2Dd(p.rotation[0][i]).toRotationMatrix();
    else
      return Eigen::Quaterniond(p.rotation[0][i], p.rotation[1][i], p.rotation[2][i],
                                p.rotation[3][i])
          .toRotationMatrix();
  }
  static Vector<dim> relative(const Face &f, const std::vector<Matrix> &turn,
                              const particles::Particles<dim> &p)
  {
    Vector<dim> du =
        (turn[f.j] - Matrix::Identity()) * f.lever_j - (turn[f.i] - Matrix::Identity()) * f.lever_i;
    for (int c = 0; c < dim; ++c)
      du[c] += p.displacement[c][f.j] - p.displacement[c][f.i];
    return du;
  }
  static Spin<dim> cross(const Vector<dim> &a, const Vector<dim> &f)
  {
    if constexpr (dim == 2)
      return Spin<2>(a[0] * f[1] - a[1] * f[0]);
    else
      return a.cross(f);
  }

  packings::Packing<dim> packing_;
  double e_, nu_, g_, k_;
  dem::Plasticity law_;
  PlaneMode plane_;
};
} // namespace ligament::oracle
