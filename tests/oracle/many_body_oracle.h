// The many-body law written down plainly: a list of faces, rotation matrices, loops. It shares only
// the data types with the production code and serves to check it.
#pragma once

#include "packings/packing.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ligament::oracle
{
template <int dim>
class ManyBodyOracle
{
public:
  /// E in Pa, nu; plane mode for 2D.
  ManyBodyOracle(const packings::Packing<dim> &packing, double e, double nu,
                 PlaneMode plane = PlaneMode::strain)
      : packing_(packing), e_(e), nu_(nu), g_(e / (2 * (1 + nu))), plane_(plane),
        broken(packing.faces.size(), false), traction(packing.faces.size(), Vector<dim>::Zero())
  {
    for (std::size_t f = 0; f < broken.size(); ++f)
      broken[f] = packing.faces[f].cracked;
  }

  /// Overwrites force and torque of the bonded faces; returns the energy.
  double compute(particles::Particles<dim> &p) const
  {
    const int n = packing_.size();
    std::vector<double> phi(n, dim == 2 && plane_ == PlaneMode::strain ? 1. : 0.), theta(n, 0.),
        lambda(n);
    std::vector<Matrix> turn;
    for (int i = 0; i < n; ++i) {
      turn.push_back(rotation(p, i));
      for (auto &a : p.force)
        a[i] = 0;
      for (auto &a : p.torque)
        a[i] = 0;
    }
    const double share = 3 * nu_ / (1 + nu_);
    for_bonds([&](const Face &f) {
      const double s_r = f.area / (f.q_i + f.q_j);
      const Vector<dim> du = relative(f, turn, p);
      phi[f.i] += f.area * f.q_i / packing_.volume[f.i];
      phi[f.j] += f.area * f.q_j / packing_.volume[f.j];
      theta[f.i] += s_r * (turn[f.i] * f.lever_i).dot(du) / packing_.volume[f.i];
      theta[f.j] -= s_r * (turn[f.j] * f.lever_j).dot(du) / packing_.volume[f.j];
    });
    double energy = 0;
    for (int i = 0; i < n; ++i) {
      lambda[i] = 2 * g_ * share / (3 - share * phi[i]);
      energy += 0.5 * lambda[i] * packing_.volume[i] * theta[i] * theta[i];
    }
    for_bonds([&](const Face &f) {
      const double r = f.q_i + f.q_j;
      const Vector<dim> du = relative(f, turn, p);
      const Vector<dim> a_i = turn[f.i] * f.lever_i, a_j = turn[f.j] * f.lever_j;
      const double p_i = lambda[f.i] * theta[f.i], p_j = lambda[f.j] * theta[f.j];
      const Vector<dim> t = (2 * g_ * du + p_i * a_i - p_j * a_j) / r;
      traction[&f - packing_.faces.data()] = t;
      for (int c = 0; c < dim; ++c) {
        p.force[c][f.i] += f.area * t[c];
        p.force[c][f.j] -= f.area * t[c];
      }
      const auto bend = bending(f, p, turn, energy);
      const auto t_i = turning(a_i, f.area * t - f.area / r * p_i * du),
                 t_j = turning(a_j, f.area * t - f.area / r * p_j * du);
      for (int c = 0; c < n_spins<dim>; ++c) {
        p.torque[c][f.i] += t_i[c] + bend[c];
        p.torque[c][f.j] -= t_j[c] + bend[c];
      }
      energy += g_ * f.area / r * du.squaredNorm();
    });
    return energy;
  }

  /// s of theory.md eq. (D12) in Pa for every face, after compute() in this state; 0 where the face
  /// is not asked. Bonds alone stress the particles. whole_face in m^2; 0: sizes don't count.
  std::vector<double> principal_tensions(const particles::Particles<dim> &p,
                                         double whole_face) const
  {
    std::vector<double> s(packing_.faces.size(), 0.);
    for_each_stressed_face(p, [&](std::size_t index, const auto &stress, const Vector<dim> &own,
                                  const Vector<dim> &t) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>> solver(stress);
      Vector<dim> e = solver.eigenvectors().col(dim - 1);
      if (e.dot(own) < 0)
        e = -e;
      if (t.dot(own) <= 0 || own.dot(e) < (dim == 2 ? 0.577 : 0.4))
        return;
      const double ratio = whole_face > 0 ? packing_.faces[index].area / whole_face : 1;
      const double size =
          dim == 2 ? std::pow(std::max(ratio, 0.7), 0.3) : std::pow(std::max(ratio, 0.5), 0.15);
      s[index] = size * t.dot(e) / own.dot(e);
    });
    return s;
  }

  /// visit(index, mean stress of both particles, normal, traction) in Pa of every bonded face,
  /// after compute() in this state. Bonds alone stress the particles.
  template <typename Visit>
  void for_each_stressed_face(const particles::Particles<dim> &p, Visit &&visit) const
  {
    const int n = packing_.size();
    std::vector<Matrix> turn, stress(n, Matrix::Zero());
    for (int i = 0; i < n; ++i)
      turn.push_back(rotation(p, i));
    for_bonds([&](const Face &f) {
      const Vector<dim> &t = traction[&f - packing_.faces.data()];
      const Matrix m_i = f.area / packing_.volume[f.i] * turn[f.i] * f.lever_i * t.transpose(),
                   m_j = f.area / packing_.volume[f.j] * turn[f.j] * f.lever_j * t.transpose();
      stress[f.i] += (m_i + m_i.transpose()) / 2;
      stress[f.j] -= (m_j + m_j.transpose()) / 2;
    });
    for_bonds([&](const Face &f) {
      const std::size_t index = &f - packing_.faces.data();
      const Vector<dim> normal = ((turn[f.i] + turn[f.j]) * f.normal).normalized();
      visit(index, Matrix((stress[f.i] + stress[f.j]) / 2), normal, traction[index]);
    });
  }

private:
  using Face = packings::Face<dim>;
  using Matrix = Eigen::Matrix<double, dim, dim>;

  template <typename Do>
  void for_bonds(Do &&what) const
  {
    for (std::size_t f = 0; f < packing_.faces.size(); ++f)
      if (!broken[f])
        what(packing_.faces[f]);
  }

  static Matrix rotation(const particles::Particles<dim> &p, int i)
  {
    if constexpr (dim == 2)
      return Eigen::Rotation2Dd(p.rotation[0][i]).toRotationMatrix();
    else
      return quaternion(p, i).toRotationMatrix();
  }
  static Eigen::Quaterniond quaternion(const particles::Particles<dim> &p, int i)
  {
    return {p.rotation[0][i], p.rotation[1][i], p.rotation[2][i], p.rotation[3][i]};
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
  static Spin<dim> turning(const Vector<dim> &a, const Vector<dim> &f)
  {
    if constexpr (dim == 2)
      return Spin<2>(a[0] * f[1] - a[1] * f[0]);
    else
      return a.cross(f);
  }
  /// Torque on i; adds the energy.
  Spin<dim> bending(const Face &f, const particles::Particles<dim> &p,
                    const std::vector<Matrix> &turn, double &energy) const
  {
    const double r = f.q_i + f.q_j;
    if constexpr (dim == 2) {
      const double t = packing_.thickness, inertia = std::pow(f.area, 3) / (12 * t * t);
      const double modulus = plane_ == PlaneMode::strain ? e_ / (1 - nu_ * nu_) : e_;
      const double k = modulus * inertia / r, angle = p.rotation[0][f.j] - p.rotation[0][f.i];
      energy += 0.5 * k * angle * angle;
      return Spin<2>(k * angle);
    } else {
      const double inertia = f.area * f.area / (4 * M_PI);
      const Matrix nn = f.normal * f.normal.transpose();
      const Matrix k = e_ * inertia / r * (Matrix::Identity() - nn) + 2 * g_ * inertia / r * nn;
      const Eigen::Quaterniond q = quaternion(p, f.i).conjugate() * quaternion(p, f.j);
      const Vector<3> kv = k * q.vec();
      energy += 2 * q.vec().dot(kv);
      return turn[f.i] * (2 * (q.w() * kv + q.vec().cross(kv)));
    }
  }

  packings::Packing<dim> packing_;
  double e_, nu_, g_;
  PlaneMode plane_;

public:
  std::vector<bool> broken;                  // of each face; broken ones carry nothing
  mutable std::vector<Vector<dim>> traction; // Pa, of each face at the last compute()
};
} // namespace ligament::oracle
