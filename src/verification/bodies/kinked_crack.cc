#include "src/verification/bodies/kinked_crack.h"

#include "core/extremes.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <vector>

namespace ligament::program
{
namespace
{
using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

/// Numbers of elements; of twice as many the error is half as large.
struct Fineness
{
  int factor = 1;
  int wing() const { return 30 * factor; }
  int crack() const { return 100 * factor; }
  int side() const { return 30 * factor; }
};

struct Element
{
  Vec2 centre, tangent;
  double half; // m
  bool open;   // else closed: slides only
  Vec2 normal() const { return {-tangent[1], tangent[0]}; }
};

/// Stress of a unit slide and of a unit overlap of the element, over twice the shear modulus.
std::array<Mat2, 2> stresses(const Element &e, const Vec2 &at, double nu)
{
  const double x = (at - e.centre).dot(e.tangent), y = (at - e.centre).dot(e.normal());
  const double c = 1 / (4 * M_PI * (1 - nu)), left = x - e.half, right = x + e.half;
  const double r1 = left * left + y * y, r2 = right * right + y * y;
  const double fxy = c * (y / r1 - y / r2), fyy = -c * (left / r1 - right / r2);
  const double fxyy = c * ((left * left - y * y) / (r1 * r1) - (right * right - y * y) / (r2 * r2));
  const double fyyy = 2 * c * y * (left / (r1 * r1) - right / (r2 * r2));
  Mat2 axes, slide, overlap;
  axes << e.tangent, e.normal();
  slide << 2 * fxy + y * fxyy, fyy + y * fyyy, fyy + y * fyyy, -y * fxyy;
  overlap << fyy + y * fyyy, -y * fxyy, -y * fxyy, fyy - y * fyyy;
  return {axes * slide * axes.transpose(), axes * overlap * axes.transpose()};
}

/// Slides and overlaps of a rigid motion of what an outline holds, which stress nothing.
Eigen::MatrixXd rigid_motions(const std::vector<Element> &outline)
{
  Eigen::MatrixXd motions(2 * outline.size(), outline.empty() ? 0 : 3);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Element &e = outline[i];
    const Vec2 turn(-e.centre[1], e.centre[0]);
    for (int k = 0; k < (outline.empty() ? 0 : 3); ++k) {
      const Vec2 u = k < 2 ? Vec2(Vec2::Unit(k)) : Vec2(turn / outline[0].centre.norm());
      motions.block<2, 1>(2 * i, k) << u.dot(e.tangent), u.dot(e.normal());
    }
  }
  return motions;
}

/// The discontinuities (slide, overlap of each element, over 1/2G) that clear the tractions of the
/// cracks, and of the outline of the body if it has one.
Eigen::VectorXd solve(const std::vector<Element> &cracks, const std::vector<Element> &outline,
                      const Mat2 &remote, double friction, double nu)
{
  std::vector<Element> elements = outline;
  elements.insert(elements.end(), cracks.begin(), cracks.end());
  const Eigen::MatrixXd motions = rigid_motions(outline);
  const int n = int(elements.size()), n_motions = int(motions.cols());
  // What is left of the net force and torque by the elements' size goes into three more unknowns.
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n + n_motions, 2 * n + n_motions);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(2 * n + n_motions);
  a.topRightCorner(motions.rows(), n_motions) = motions;
  a.bottomLeftCorner(n_motions, motions.rows()) = motions.transpose();
  for (int i = 0; i < n; ++i) {
    const Element &e = elements[i];
    const Vec2 t = e.tangent, m = e.normal();
    // Sliding: shear = friction times pressure, against the remote shear.
    const double rubs = e.open ? 0 : std::copysign(friction, t.dot(remote * m));
    const Vec2 along = t + rubs * m;
    if (i >= int(outline.size())) { // an outline bears the tractions of the
                                    // remote stress
      b[2 * i] = -along.dot(remote * m);
      b[2 * i + 1] = e.open ? -m.dot(remote * m) : 0;
    }
    for (int j = 0; j < n; ++j) {
      const auto s = stresses(elements[j], e.centre, nu);
      for (int k = 0; k < 2; ++k) {
        a(2 * i, 2 * j + k) = along.dot(s[k] * m);
        if (e.open)
          a(2 * i + 1, 2 * j + k) = m.dot(s[k] * m);
      }
    }
    if (!e.open)
      a(2 * i + 1, 2 * i + 1) = 1;
  }
  return a.partialPivLu().solve(b).segment(2 * outline.size(), 2 * cracks.size());
}

/// Elements between places x(k/n) along a line, x growing from 0 to 1.
template <typename Place>
std::vector<Element> line(const Vec2 &from, const Vec2 &direction, double length, int n, bool open,
                          Place &&x)
{
  std::vector<Element> elements;
  for (int k = 0; k < n; ++k) {
    const double begin = length * x(double(k) / n), end = length * x(double(k + 1) / n);
    elements.push_back({from + direction * (begin + end) / 2, direction, (end - begin) / 2, open});
  }
  return elements;
}

/// Places that lie closer and closer towards both ends.
double closer_at_ends(double x)
{
  return (1 - std::cos(M_PI * x)) / 2;
}
/// And more so: the ends of the crack see the first elements of short wings.
double much_closer_at_ends(double x)
{
  return closer_at_ends(closer_at_ends(x));
}

/// From the crack's end on.
std::vector<Element> wing(const Vec2 &from, const Vec2 &direction, double length, Fineness n)
{
  return line(from, direction, length, n.wing(), true, closer_at_ends);
}

/// The sides of a plate of this size about the origin, anticlockwise; none of an infinite one.
std::vector<Element> sides(const Vec2 &size, Fineness n)
{
  std::vector<Element> elements;
  if (size[0] == 0)
    return elements;
  Vec2 corner = -size / 2, along = Vec2::UnitX();
  for (int side = 0; side < 4; ++side) {
    const double length = size[side % 2];
    for (const Element &e : line(corner, along, length, n.side(), true, [](double x) { return x; }))
      elements.push_back(e);
    corner += length * along;
    along = {-along[1], along[0]};
  }
  return elements;
}

/// Overlap of the element at the end of a straight crack along x under unit tension, over 1/2G.
double end_of_straight_crack(double half_length, double poissons_ratio, const Vec2 &plate,
                             Fineness n)
{
  const Vec2 x(1, 0);
  Mat2 tension = Mat2::Zero();
  tension(1, 1) = 1;
  auto crack = wing(Vec2::Zero(), -x, half_length, n);
  for (const Element &e : wing(Vec2::Zero(), x, half_length, n))
    crack.push_back(e);
  return solve(crack, sides(plate, n), tension, 0, poissons_ratio)[2 * crack.size() - 1];
}
double stress_intensity(const KinkedCrack &c, Fineness n)
{
  Mat2 pressure = Mat2::Zero();
  pressure(1, 1) = -1;
  const double end = -end_of_straight_crack(c.wing, c.poissons_ratio, Vec2::Zero(), n);

  const Vec2 t(std::cos(c.inclination), std::sin(c.inclination)),
      w(std::cos(c.inclination + c.kink), std::sin(c.inclination + c.kink));
  auto elements =
      line(-c.half_length * t, t, 2 * c.half_length, n.crack(), false, much_closer_at_ends);
  for (const double side : {-1., 1.})
    for (const Element &e : wing(side * c.half_length * t, side * w, c.wing, n))
      elements.push_back(e);
  const double opening = -solve(elements, sides(c.plate, n), pressure, c.friction,
                                c.poissons_ratio)[2 * elements.size() - 1];
  return opening / end * std::sqrt(M_PI * c.wing);
}

/// What values at two finenesses point to.
template <typename Value>
double limit(Value &&value)
{
  return 2 * value(Fineness{2}) - value(Fineness{1});
}
} // namespace

double straight_crack_in_plate(double half_length, const Eigen::Vector2d &plate)
{
  return limit([&](Fineness n) {
    return end_of_straight_crack(half_length, 0.3, plate, n) /
           end_of_straight_crack(half_length, 0.3, Vec2::Zero(), n);
  });
}

double stress_intensity(const KinkedCrack &crack)
{
  return limit([&](Fineness n) { return stress_intensity(crack, n); });
}

double largest_stress_intensity(KinkedCrack crack)
{
  double largest = 0;
  for (double degrees = 45; degrees <= 85; degrees += 5) {
    crack.kink = degrees * M_PI / 180;
    keep_largest(largest, stress_intensity(crack));
  }
  return largest;
}
} // namespace ligament::program
