// Smooth curves through values on an even grid: what potentials are made of.
#pragma once

#include <array>
#include <vector>

namespace ligament::md
{
/// A function of one variable at one place.
struct Jet
{
  double value = 0, slope = 0, curvature = 0;
};

/// A cubic spline with continuous curvature over 0, step, 2 step, ..., end(). Outside it goes on
/// along its tangents.
class Spline
{
public:
  /// On interval k: c0 + t (c1 + t (c2 + t c3)), t = x/step - k. A kernel reads these.
  using Piece = std::array<double, 4>;

  Spline() = default;
  /// Through at least 4 values, with these slopes (per unit of x) at both ends.
  Spline(double step, const std::vector<double> &values, double first_slope, double last_slope);
  /// The same; slopes at the ends are those of cubics through the outermost four values.
  Spline(double step, const std::vector<double> &values);

  Jet operator()(double x) const;
  /// Value at x + by less that at x; keeps the digits of a small `by`.
  double change(double x, double by) const;

  double step() const { return step_; }
  double end() const { return step_ * double(pieces_.size()); }
  const std::vector<Piece> &pieces() const { return pieces_; }

  /// Adds factor times a spline on the same grid: exact.
  void add(double factor, const Spline &other);
  /// Adds slope x: exact.
  void add_line(double slope);

private:
  int interval(double x) const;

  double step_ = 1;
  std::vector<Piece> pieces_;
};

/// Slope at the first of four values on an even grid, of the cubic through them.
inline double slope_at_first(double step, double a, double b, double c, double d)
{
  return (-11 * a + 18 * b - 9 * c + 2 * d) / (6 * step);
}
} // namespace ligament::md
