#include "core/load.h"

namespace ligament::core
{
template <int dim>
double BoundaryLoad<dim>::displacement(int c, double t) const
{
  return *value[c] * (kind == Kind::velocity ? history.integral(t) : history.value(t));
}

template <int dim>
double BoundaryLoad<dim>::velocity(int c, double t) const
{
  return *value[c] * (kind == Kind::velocity ? history.value(t) : history.rate(t));
}

template <int dim>
Vector<dim> BoundaryLoad<dim>::traction(double t) const
{
  Vector<dim> p = Vector<dim>::Zero();
  if (kind == Kind::traction || kind == Kind::acceleration)
    for (int c = 0; c < dim; ++c)
      if (value[c])
        p[c] = *value[c] * history.value(t);
  return p;
}

template struct BoundaryLoad<2>;
template struct BoundaryLoad<3>;
} // namespace ligament::core
