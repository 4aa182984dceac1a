// The face that softens, theory.md section 1.13: how far it opens under what the particles around
// it would make it bear.
#pragma once

#include "core/types.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
/// What a face still bears of its strength as it opens: straight lines from 1 over one corner to 0.
struct Softening
{
  /// Share of the strength at the corner, and the opening there in G_c/f_t; 1 and 0: no corner.
  double corner_share = 1, corner_opening = 0;

  /// The opening at which nothing is left, in G_c/f_t: the area below the lines is 1.
  double reach() const
  {
    return corner_opening + (2 - corner_opening * (1 + corner_share)) / corner_share;
  }
  /// Steepest fall of the share per G_c/f_t.
  double steepest() const
  {
    const double last = corner_share / (reach() - corner_opening);
    return corner_opening > 0 ? std::max(last, (1 - corner_share) / corner_opening) : last;
  }

  /// What is left of the area below the lines, from an opening in units of the reach on; 1/reach()
  /// from the start.
  double area_from(double opening) const
  {
    const double corner = corner_opening / reach();
    if (opening >= 1)
      return 0;
    if (opening >= corner)
      return at(opening).value * (1 - opening) / 2;
    return (at(opening).value + corner_share) * (corner - opening) / 2 +
           corner_share * (1 - corner) / 2;
  }

  /// At an opening in units of the reach, with its slope.
  struct Share
  {
    double value, slope;
  };
  Share at(double opening) const
  {
    const double corner = corner_opening / reach();
    if (opening >= 1)
      return {0, 0};
    if (opening < corner) {
      const double slope = (corner_share - 1) / corner;
      return {1 + slope * opening, slope};
    }
    const double slope = -corner_share / (1 - corner);
    return {slope * (opening - 1), slope};
  }
};

/// What a face remembers of its past.
template <int dim>
struct Opening
{
  Vector<dim> jump;   // w, m
  double largest = 0; // kappa: the largest effective opening so far, m
  double damage = 0;  // kappa in units of the reach, as it grew
};

/// Of one face. Forces are tractions times its area.
template <int dim>
struct CohesiveLaw
{
  using Matrix = Eigen::Matrix<double, dim, dim>;

  double strength; // N, in terms of the effective traction
  double reach;    // m, w_c, of what it opens from now on; infinite: opening takes nothing
  Softening shape;
  double mode_ratio; // beta
  double friction;
  double excess = 0;       // N, what it bore above the strength when it began
  double excess_reach = 0; // m, the opening at which that is gone

  /// Share of the strength that is left.
  double left(const Opening<dim> &o) const { return shape.at(o.damage).value; }

  /// Below the line of the excess, in J, from this largest opening on.
  double excess_energy_from(double largest) const
  {
    return excess_share(largest) > 0
               ? excess * excess_reach / 2 * std::pow(excess_share(largest), 2)
               : 0;
  }

  /// (t_n^2 + t_t^2/beta^2)^(1/2) of a traction times area.
  double effective(const Vector<dim> &force, const Vector<dim> &normal) const
  {
    const double n = force.dot(normal);
    return std::hypot(n, (force - n * normal).norm() / mode_ratio);
  }

  /// The opening that goes with the force F = force - stiffness w of the particles around it.
  Opening<dim> answer(const Opening<dim> &last, const Vector<dim> &force, const Matrix &stiffness,
                      const Vector<dim> &normal) const
  {
    const Matrix across = normal * normal.transpose(), along = Matrix::Identity() - across;
    const double beta2 = mode_ratio * mode_ratio;
    const auto open = softened(last, force, stiffness, across + beta2 * along);
    if (normal.dot(open.jump) >= 0)
      return open;
    // It is closed and slides, if at all.
    Opening<dim> closed = {along * last.jump, last.largest, last.damage};
    const Vector<dim> trial = force - stiffness * closed.jump;
    const Vector<dim> borne = along * trial - bond_stiffness(last) * beta2 * closed.jump;
    const double grip = friction * std::min(last.damage, 1.) * std::max(-normal.dot(trial), 0.),
                 size = borne.norm();
    if (grip > 0 && size <= grip)
      return closed;
    const Vector<dim> rubs = size > 0 ? Vector<dim>(grip / size * borne) : borne;
    return softened(last, along * force - rubs,
                    along * stiffness * along + stiffness.trace() * across, across + beta2 * along);
  }

  /// Whether the sides of a face are apart. Rounding alone opens nothing: what is closed slides in
  /// its plane to some last digits.
  static bool is_apart(const Vector<dim> &jump, const Vector<dim> &normal)
  {
    return normal.dot(jump) > 1e-9 * jump.norm();
  }

  /// Whether an open face would go back on its secant.
  bool unloads(const Opening<dim> &o, const Vector<dim> &normal) const
  {
    const double across = normal.dot(o.jump);
    return unloads(std::hypot(across, mode_ratio * (o.jump - across * normal).norm()), o);
  }

  /// d force / d jump of a face that is open, where it follows a small change; `last_force` tells
  /// how one opens that is still shut.
  Matrix tangent(const Opening<dim> &o, const Vector<dim> &last_force,
                 const Vector<dim> &normal) const
  {
    const Matrix across = normal * normal.transpose();
    const double beta2 = mode_ratio * mode_ratio;
    const Matrix metric = across + beta2 * (Matrix::Identity() - across);
    if (o.damage >= 1)
      return Matrix::Zero();
    constexpr double shut = 1e-6; // of the reach
    const auto [value, slope] = borne(o);
    const double secant = value / std::max(o.largest, shut * reach),
                 size = std::sqrt(o.jump.dot(metric * o.jump));
    if (unloads(size, o))
      return secant * metric;
    const Vector<dim> way = size > 0 ? o.jump : Vector<dim>(metric.inverse() * last_force);
    const Vector<dim> pulled = metric * way / std::sqrt(way.dot(metric * way));
    return secant * metric + (slope - secant) * pulled * pulled.transpose();
  }

private:
  /// At this effective opening.
  static bool unloads(double size, const Opening<dim> &o)
  {
    constexpr double round_off = 1e-9;
    return size < (1 - round_off) * o.largest;
  }

  /// What is left of the excess.
  double excess_share(double largest) const
  {
    return largest < excess_reach ? 1 - largest / excess_reach : 0;
  }
  /// f in N at the largest opening, and its slope in N/m.
  struct Borne
  {
    double value, slope;
  };
  Borne borne(double largest, double damage) const
  {
    const auto [share, slope] = shape.at(damage);
    Borne b{strength * share, strength * slope / reach};
    if (const double rest = damage < 1 ? excess_share(largest) : 0; rest > 0) {
      b.value += excess * rest;
      b.slope -= excess / excess_reach;
    }
    return b;
  }
  Borne borne(const Opening<dim> &o) const { return borne(o.largest, o.damage); }

  /// f/kappa, N/m.
  double bond_stiffness(const Opening<dim> &o) const
  {
    return o.largest > 0 ? borne(o).value / o.largest : 0;
  }

  /// Without contact: F - C w = (f/kappa) B w and kappa = max(kappa, |w|), |w|^2 = w.Bw. With
  /// w = kappa y this is (kappa C + f B) y = F; 1/|y| - 1 is a straight line in kappa where C is a
  /// multiple of B, and Newton's method, kept between two bounds, starts at the last kappa.
  Opening<dim> softened(const Opening<dim> &last, const Vector<dim> &force, const Matrix &stiffness,
                        const Matrix &metric) const
  {
    const double end = last.largest + std::max(1 - last.damage, 0.) * reach; // nothing is left
    const auto size = [&](const Vector<dim> &y) { return std::sqrt(y.dot(metric * y)); };
    struct Trial
    {
      Matrix inverse;
      Vector<dim> y;
      double size, slope; // of f, N/m
    };
    const auto damage = [&](double kappa) { return last.damage + (kappa - last.largest) / reach; };
    const auto at = [&](double kappa) {
      const auto [value, slope] = borne(kappa, damage(kappa));
      Trial t{(kappa * stiffness + value * metric).inverse(), {}, 0, slope};
      t.y = t.inverse * force;
      t.size = size(t.y);
      return t;
    };
    double kappa = last.largest;
    if (last.damage < 1) {
      const Trial now = at(kappa);
      if (now.size <= 1) // shut, unloading or as before
        return {kappa * now.y, kappa, last.damage};
    }
    const Vector<dim> free = stiffness.inverse() * force;
    if (const double opened = size(free); last.damage >= 1 || opened >= end)
      return {free, std::max(opened, kappa), std::max(last.damage, 1.)};

    constexpr int most = 100;
    const bool is_level = std::isinf(reach);
    const double round_off = 1e-15 * (is_level ? size(free) : reach);
    double low = kappa, high = is_level ? 2 * size(free) : end;
    Trial now = at(kappa);
    for (int k = 0; k < most && high - low > round_off; ++k) {
      (now.size > 1 ? low : high) = kappa;
      const Vector<dim> pulled = metric * now.y;
      const Vector<dim> change = -now.inverse * (stiffness * now.y + now.slope * pulled);
      const double rate = -pulled.dot(change) / (now.size * now.size * now.size); // of 1/|y|
      double next = kappa - (1 / now.size - 1) / rate;
      if (!(next > low && next < high)) {
        if (std::abs(next - kappa) <= round_off)
          break;
        next = (low + high) / 2;
      }
      const bool is_there = std::abs(next - kappa) <= round_off;
      kappa = next;
      now = at(kappa);
      if (is_there)
        break;
    }
    return {kappa * now.y, kappa, damage(kappa)};
  }
};
} // namespace ligament::dem
