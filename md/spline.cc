#include "md/spline.h"

#include "core/check.h"

#include <algorithm>
#include <cmath>

namespace ligament::md
{
namespace
{
double last_slope(double step, const std::vector<double> &y)
{
  const auto n = y.size();
  return -slope_at_first(step, y[n - 1], y[n - 2], y[n - 3], y[n - 4]);
}
const std::vector<double> &long_enough(const std::vector<double> &values)
{
  core::require(values.size() >= 4, "a spline needs four values at least");
  return values;
}
} // namespace

Spline::Spline(double step, const std::vector<double> &values)
    : Spline(step, values,
             slope_at_first(step, long_enough(values)[0], values[1], values[2], values[3]),
             last_slope(step, values))
{
}

// Slopes m at the knots, per interval: m[k-1] + 4 m[k] + m[k+1] = 3 (y[k+1] - y[k-1]).
Spline::Spline(double step, const std::vector<double> &y, double first_slope, double last_slope)
    : step_(step), pieces_(long_enough(y).size() - 1)
{
  const int n = int(pieces_.size());
  std::vector<double> m(n + 1), upper(n + 1, 0.);
  m[0] = first_slope * step;
  m[n] = last_slope * step;
  for (int k = 1; k < n; ++k) {
    upper[k] = 1 / (4 - upper[k - 1]);
    m[k] = (3 * (y[k + 1] - y[k - 1]) - m[k - 1]) * upper[k];
  }
  for (int k = n - 1; k > 0; --k)
    m[k] -= upper[k] * m[k + 1];
  for (int k = 0; k < n; ++k) {
    const double rise = y[k + 1] - y[k];
    pieces_[k] = {y[k], m[k], 3 * rise - 2 * m[k] - m[k + 1], m[k] + m[k + 1] - 2 * rise};
  }
}

int Spline::interval(double x) const
{
  const double place = x / step_;
  return place > 0 ? int(std::min(place, double(pieces_.size()) - 1)) : 0; // also of no number
}

Jet Spline::operator()(double x) const
{
  const int k = interval(x);
  const auto &[a, b, c, d] = pieces_[k];
  const double place = x / step_ - k, t = std::clamp(place, 0., 1.), inverse = 1 / step_;
  const double slope = b + t * (2 * c + 3 * t * d);
  Jet jet = {a + t * (b + t * (c + t * d)), slope * inverse,
             (2 * c + 6 * t * d) * inverse * inverse};
  if (t != place) { // outside
    jet.value += slope * (place - t);
    jet.curvature = 0;
  }
  return jet;
}

// From knot to knot, in each interval as a product with the way that is gone there. Over a long way
// the difference of the values has the digits.
double Spline::change(double x, double by) const
{
  if (std::abs(by) > 2 * step_)
    return (*this)(x + by).value - (*this)(x).value;
  const int direction = by < 0 ? -1 : 1, last = int(pieces_.size()) - 1;
  int k = interval(x);
  double from = x / step_ - k, left = by / step_, sum = 0;
  while (true) {
    const auto &[a, b, c, d] = pieces_[k];
    const bool stays = direction < 0 ? k == 0 || from + left >= 0 : k == last || from + left <= 1;
    const double way = stays ? left : (direction < 0 ? -from : 1 - from);
    if (from < 0 || from > 1 || from + way < 0 || from + way > 1)
      return sum + (*this)(x + by).value - (*this)(step_ * (k + from)).value; // outside
    const double to = from + way;
    sum += way * (b + c * (from + to) + d * (from * from + from * to + to * to));
    if (stays)
      return sum;
    left -= way;
    k += direction;
    from = direction < 0 ? 1 : 0;
  }
}

void Spline::add(double factor, const Spline &other)
{
  core::require(step_ == other.step_ && pieces_.size() == other.pieces_.size(),
                "splines on different grids cannot be added");
  for (std::size_t k = 0; k < pieces_.size(); ++k)
    for (int c = 0; c < 4; ++c)
      pieces_[k][c] += factor * other.pieces_[k][c];
}

void Spline::add_line(double slope)
{
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    pieces_[k][0] += slope * step_ * double(k);
    pieces_[k][1] += slope * step_;
  }
}
} // namespace ligament::md
