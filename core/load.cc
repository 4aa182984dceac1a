#include "core/load.h"

#include <cmath>

namespace ligament::core
{
double Ramp::value(double t) const
{
  if (t <= 0)
    return duration == 0 && t == 0 ? 1. : 0.;
  if (t >= duration)
    return 1;
  const double s = t / duration;
  return s - std::sin(2 * M_PI * s) / (2 * M_PI);
}

double Ramp::integral(double t) const
{
  if (t <= 0)
    return 0;
  if (t >= duration)
    return t - duration / 2;
  const double s = t / duration;
  return duration * (s * s / 2 + (std::cos(2 * M_PI * s) - 1) / (4 * M_PI * M_PI));
}

double Ramp::rate(double t) const
{
  if (t <= 0 || t >= duration)
    return 0;
  return (1 - std::cos(2 * M_PI * t / duration)) / duration;
}

template <int dim>
double BoundaryLoad<dim>::displacement(int c, double t) const
{
  return *value[c] * (kind == Kind::velocity ? ramp.integral(t) : ramp.value(t));
}

template <int dim>
double BoundaryLoad<dim>::velocity(int c, double t) const
{
  return *value[c] * (kind == Kind::velocity ? ramp.value(t) : ramp.rate(t));
}

template <int dim>
Vector<dim> BoundaryLoad<dim>::traction(double t) const
{
  Vector<dim> p = Vector<dim>::Zero();
  if (kind == Kind::traction)
    for (int c = 0; c < dim; ++c)
      if (value[c])
        p[c] = *value[c] * ramp.value(t);
  return p;
}

template struct BoundaryLoad<2>;
template struct BoundaryLoad<3>;
} // namespace ligament::core
