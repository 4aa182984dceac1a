// Strains of the particles' own written down plainly, particle by particle with matrices of three
// axes: stress, return mapping, forces, energy. It shares only data types with the production code.
#pragma once

#include "dem/inelastic/plasticity.h"
#include "dem/inelastic/viscosity.h"
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
                  dem::Plasticity law, PlaneMode plane = PlaneMode::strain,
                  dem::Viscosity viscosity = {})
      : strain(packing.size(), Eigen::Matrix3d::Zero()), history(packing.size(), 0.),
        stress(strain), packing_(packing), e_(e), nu_(nu), g_(e / (2 * (1 + nu))),
        k_(e / (3 * (1 - 2 * nu))), law_(std::move(law)), plane_(plane),
        viscosity_(std::move(viscosity))
  {
    Creep none;
    none.slid.resize(viscosity_.branches.size(), Eigen::Matrix3d::Zero());
    creep_.assign(packing.size(), none);
  }

  /// Every particle yields once, `dt` after it did so last.
  void flow(const particles::Particles<dim> &p, double dt = 0)
  {
    const State s(*this, p);
    for (int i = 0; i < packing_.size(); ++i) {
      stress[i] = own_stress(s, i);
      if (!is_held(i))
        continue;
      Eigen::Matrix3d viscous = creep_[i].all;
      if (dem::is_viscous(viscosity_))
        creep(s, i, dt, viscous);
      stress[i] = own_stress(s, i);
      const double shear = g_ * (1 - answer(dt));
      if (const auto *mises = std::get_if<dem::VonMisesFlow>(&law_))
        flow(*mises, i, shear);
      if (const auto *prager = std::get_if<dem::DruckerPragerFlow>(&law_))
        flow(*prager, i, shear);
      if (dem::is_viscous(viscosity_)) {
        creep(s, i, dt, viscous);
        creep_[i] = after(creep_[i], driving(s, i, viscous, dt), seen(s, i, viscous), dt);
      }
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

  /// The viscous part of a particle's strain: strains of the dashpots of its branches, what
  /// drives it, all of it.
  struct Creep
  {
    std::vector<Eigen::Matrix3d> slid;
    Eigen::Matrix3d driving = Eigen::Matrix3d::Zero(), rated = driving, all = driving;
    Eigen::Matrix3d damped = driving; // by the dashpot beside the branches
  };

  /// Each dashpot follows (d - slid)/T, d straight in time.
  Creep after(Creep c, const Eigen::Matrix3d &now, const Eigen::Matrix3d &rated, double dt) const
  {
    c.all.setZero();
    for (std::size_t k = 0; k < c.slid.size(); ++k) {
      const auto &[share, time] = viscosity_.branches[k];
      if (dt > 0) {
        const Eigen::Matrix3d slope = (now - c.driving) / dt;
        const Eigen::Matrix3d late = c.driving - time * slope - c.slid[k];
        c.slid[k] = now - time * slope - std::exp(-dt / time) * late;
      }
      c.all += share * c.slid[k];
    }
    c.damped.setZero();
    if (dt > 0)
      c.damped = -viscosity_.dashpot / g_ / dt * (rated - c.rated);
    c.all += c.damped;
    c.driving = now;
    c.rated = rated;
    return c;
  }

  /// What a unit of d adds to the viscous strain.
  double answer(double dt) const
  {
    Creep none;
    none.slid.resize(viscosity_.branches.size(), Eigen::Matrix3d::Zero());
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    return after(none, one, one, dt).all(0, 0);
  }

  bool is_whole(const State &s, int i) const
  {
    return (s.m[i] / packing_.volume[i] - Matrix::Identity()).norm() < 1e-9;
  }

  static Eigen::Matrix3d deviator(const Eigen::Matrix3d &t)
  {
    return t - t.trace() / 3 * Eigen::Matrix3d::Identity();
  }

  /// What drives the branches: in open cells as if the dashpot beside them were not there.
  Eigen::Matrix3d driving(const State &s, int i, const Eigen::Matrix3d &viscous, double dt)
  {
    if (is_whole(s, i))
      return viscous + deviator(own_stress(s, i)) / (2 * g_);
    Eigen::Matrix3d damped = Eigen::Matrix3d::Zero();
    if (dt > 0)
      damped = -viscosity_.dashpot / g_ / dt * (seen(s, i, viscous) - creep_[i].rated);
    const Eigen::Matrix3d all = strain[i];
    strain[i] -= damped;
    const Eigen::Matrix3d t = own_stress(s, i);
    strain[i] = all;
    return viscous - damped + deviator(t) / (2 * g_);
  }

  /// What the dashpot resists: d in whole cells, in others the part of E - e M, of what is not
  /// viscous in e, that is across M.
  Eigen::Matrix3d seen(const State &s, int i, const Eigen::Matrix3d &viscous) const
  {
    if (is_whole(s, i))
      return viscous + deviator(own_stress(s, i)) / (2 * g_);
    const double v = packing_.volume[i];
    const Matrix m = s.m[i] / v;
    const Eigen::Matrix3d other = strain[i] - viscous;
    const Matrix e = other.template topLeftCorner<dim, dim>(),
                 found = (s.x[i] + s.x[i].transpose()) / (2 * v) - 0.5 * (e * m + m * e);
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero(), y = moment;
    moment.template topLeftCorner<dim, dim>() = m;
    y.template topLeftCorner<dim, dim>() = found;
    if (is_plane_strain()) {
      moment(2, 2) = 1;
      y(2, 2) = -other(2, 2);
    }
    return y - y.cwiseProduct(moment).sum() / moment.squaredNorm() * moment;
  }

  /// Solves viscous = after(driving(viscous)), which is linear; its part of the strain follows.
  void creep(const State &s, int i, double dt, Eigen::Matrix3d &viscous)
  {
    const Eigen::Matrix3d other = strain[i] - viscous;
    const auto excess = [&](const Eigen::Matrix3d &v) -> Eigen::Matrix3d {
      strain[i] = other + v;
      return v - after(creep_[i], driving(s, i, v, dt), seen(s, i, v), dt).all;
    };
    const Eigen::Matrix3d zero = Eigen::Matrix3d::Zero(), start = excess(zero);
    Eigen::Matrix<double, 9, 9> slope;
    for (int c = 0; c < 9; ++c) {
      Eigen::Matrix3d unit = zero;
      unit(c) = 0.5;
      unit = (unit + unit.transpose()).eval();
      const Eigen::Matrix3d change = excess(unit) - start;
      slope.col(c) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(change.data());
    }
    const Eigen::Matrix<double, 9, 1> x = slope.completeOrthogonalDecomposition().solve(
        -Eigen::Map<const Eigen::Matrix<double, 9, 1>>(start.data()));
    const Eigen::Matrix3d found = Eigen::Map<const Eigen::Matrix3d>(x.data());
    viscous = 0.5 * (found + found.transpose());
    strain[i] = other + viscous;
  }

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
  bool in_plane_stress() const { return dim == 2 && plane_ == PlaneMode::stress; }

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

  void flow(const dem::VonMisesFlow &law, int i, double shear_modulus)
  {
    const Eigen::Matrix3d s =
        stress[i] - stress[i].trace() / 3 * Eigen::Matrix3d::Identity();
    const double equivalent = std::sqrt(1.5) * s.norm();
    if (equivalent <= law.yield.at(history[i]))
      return;
    double low = 0, high = equivalent / (3 * shear_modulus); // bisection: no derivative of the curve
    for (int k = 0; k < 200; ++k) {
      const double middle = (low + high) / 2;
      (equivalent - 3 * shear_modulus * middle > law.yield.at(history[i] + middle) ? low : high) = middle;
    }
    strain[i] += 1.5 * low / equivalent * s;
    history[i] += low;
  }

  void flow(const dem::DruckerPragerFlow &law, int i, double g)
  {
    const double mean = stress[i].trace() / 3;
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), s = stress[i] - mean * one;
    const double tau = s.norm() / std::sqrt(2.),
                 yield = std::max(law.cohesion + law.hardening * history[i], 0.),
                 excess = law.friction * mean + tau - yield;
    if (excess <= 0)
      return;
    const double stiffness = unloading(law, s / (2 * tau), g);
    double shear = excess / (stiffness + law.hardening);
    if (law.cohesion + law.hardening * (history[i] + shear) < 0)
      shear = (excess + yield) / stiffness; // what is left is friction
    if (in_plane_stress() || g * shear <= tau) {
      strain[i] += shear * (s / (2 * tau) + law.dilatancy / 3 * one);
      history[i] += shear;
      return;
    }
    const double all = tau / g;
    strain[i] += s / (2 * g) +
                 (mean - std::max(law.cohesion + law.hardening * (history[i] + all), 0.) /
                             law.friction) / (3 * k_) * one;
    history[i] += all;
  }

  /// How far b sigma_m + tau falls for each unit of plastic shear strain, in the direction
  /// `sheared`: what the strain of its own takes of the stress of a body that does not move.
  double unloading(const dem::DruckerPragerFlow &law, const Eigen::Matrix3d &sheared,
                   double g) const
  {
    if (!in_plane_stress())
      return g + k_ * law.dilatancy * law.friction;
    const Eigen::Matrix2d flow =
        (sheared + law.dilatancy / 3 * Eigen::Matrix3d::Identity()).topLeftCorner<2, 2>();
    const double e = 9 * k_ * g / (3 * k_ + g), nu = e / (2 * g) - 1;
    const Eigen::Matrix2d taken =
        e / (1 - nu * nu) * ((1 - nu) * flow + nu * flow.trace() * Eigen::Matrix2d::Identity());
    const double fall = law.friction / 3 * taken.trace() +
                        (sheared.topLeftCorner<2, 2>().array() * taken.array()).sum();
    return std::max({fall, 0.1 * g, -1.25 * law.hardening});
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
  dem::Viscosity viscosity_;
  std::vector<Creep> creep_;
};
} // namespace ligament::oracle
