// Small bodies for the tests of the many-body law, in random states.
#pragma once

#include "dem/many_body_force.h"

#include <random>

namespace ligament::dem::testing
{
using packings::Packing;
using particles::Particles;

/// A hexagonal (2D) or simple cubic (3D) block of n particles along each axis, six in ten faces as
/// on the lattice, the others and all volumes irregular; not closed, so good for all that holds
/// on any geometry.
template <int dim>
Packing<dim> ragged_lattice(int n, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Packing<dim> p;
  p.spacing = 0.5;
  p.thickness = dim == 2 ? 0.7 : 1;
  const double d = p.spacing;
  std::vector<Vector<dim>> step(dim);
  for (int c = 0; c < dim; ++c)
    step[c] = d * Vector<dim>::Unit(c);
  if (dim == 2)
    step[1] = d / 2 * Vector<dim>::Unit(0) + std::sqrt(3.) / 2 * d * Vector<dim>::Unit(1);
  std::vector<std::array<int, dim>> offsets;
  for (int c = 0; c < dim; ++c) {
    std::array<int, dim> o{};
    o[c] = 1;
    offsets.push_back(o);
  }
  if constexpr (dim == 2)
    offsets.push_back({-1, 1});
  for (const auto &o : offsets) {
    Vector<dim> x = Vector<dim>::Zero();
    for (int c = 0; c < dim; ++c)
      x += o[c] * step[c];
    p.directions.push_back({x.normalized(), d, dim == 2 ? d / std::sqrt(3.) * p.thickness : d * d});
  }
  int total = 1;
  for (int c = 0; c < dim; ++c)
    total *= n;
  const auto coordinates = [&](int i) {
    std::array<int, dim> k;
    for (int c = 0; c < dim; ++c, i /= n)
      k[c] = i % n;
    return k;
  };
  for (int i = 0; i < total; ++i) {
    Vector<dim> x = Vector<dim>::Zero();
    const auto k = coordinates(i);
    for (int c = 0; c < dim; ++c)
      x += k[c] * step[c];
    for (int c = 0; c < dim; ++c)
      p.centre[c].push_back(x[c]);
    p.volume.push_back(std::pow(d, dim) * p.thickness * (1 + 0.1 * uniform(random)));
    for (std::size_t o = 0; o < offsets.size(); ++o) {
      int j = 0, stride = 1;
      bool inside = true;
      for (int c = 0; c < dim; ++c, stride *= n) {
        const int m = k[c] + offsets[o][c];
        inside = inside && m >= 0 && m < n;
        j += stride * m;
      }
      if (!inside)
        continue;
      const auto &dir = p.directions[o];
      packings::Face<dim> face{i,      j,     dir.normal,         dir.area,
                               d / 2,  d / 2, d / 2 * dir.normal, -d / 2 * dir.normal,
                               int(o), false};
      if (uniform(random) > 0.4) // an irregular one: other area, other point on the face plane
      {
        face.direction = -1;
        face.area *= 1 + 0.3 * uniform(random);
        face.q_i *= 1 + 0.2 * uniform(random);
        face.q_j = d - face.q_i;
        Vector<dim> side = 0.2 * d * Vector<dim>::NullaryExpr([&] { return uniform(random); });
        side -= dir.normal * dir.normal.dot(side);
        face.lever_i = face.q_i * dir.normal + side;
        face.lever_j = -face.q_j * dir.normal + side;
      }
      p.faces.push_back(face);
    }
    for (int c = 0; c < dim; ++c)
      for (int end = 0; end < 2; ++end)
        if (k[c] == (end ? n - 1 : 0)) {
          const Vector<dim> normal = (end ? 1 : -1) * Vector<dim>::Unit(c);
          Vector<dim> side = 0.1 * d * Vector<dim>::NullaryExpr([&] { return uniform(random); });
          side -= normal * normal.dot(side);
          p.boundary_faces.push_back({i, normal, p.directions[0].area, 0.4 * d,
                                      Vector<dim>(0.4 * d * normal + side), 2 * c + end});
        }
  }
  return p;
}

template <int dim>
Particles<dim> at_rest(const Packing<dim> &packing, const DemMaterial &material)
{
  Particles<dim> p;
  const int n = packing.size();
  p.resize(n);
  p.reference = packing.centre;
  p.volume = packing.volume;
  p.gyration = packing.spacing * packing.spacing / (dim == 2 ? 8 : 10);
  for (int i = 0; i < n; ++i)
    p.mass[i] = material.density * packing.volume[i];
  return p;
}

/// Multiplies the orientation from the left by the rotation vector w.
template <int dim>
void turn_by(Particles<dim> &p, int i, const Spin<dim> &w)
{
  if constexpr (dim == 2)
    p.rotation[0][i] += w[0];
  else {
    const double angle = w.norm(), c = std::cos(angle / 2),
                 s = angle == 0 ? 0.5 : std::sin(angle / 2) / angle;
    const Turn<3> e{c, s * w}, q = Turn<3>::of(p, i);
    p.rotation[0][i] = e.w * q.w - e.v.dot(q.v);
    const Vector<3> v = e.w * q.v + q.w * e.v + e.v.cross(q.v);
    for (int k = 0; k < 3; ++k)
      p.rotation[k + 1][i] = v[k];
  }
}

/// Random displacements of `amplitude` d and rotations of `amplitude` on top of a rigid turn of the
/// whole body by `turn` about the origin.
template <int dim>
void disturb(Particles<dim> &p, double spacing, double amplitude, const Spin<dim> &turn,
             unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Particles<dim> one;
  one.resize(1);
  turn_by<dim>(one, 0, turn);
  for (int i = 0; i < p.size(); ++i) {
    turn_by<dim>(p, i, turn);
    Vector<dim> u = Turn<dim>::of(one, 0).change(get(p.reference, i));
    for (int c = 0; c < dim; ++c)
      u[c] += amplitude * spacing * uniform(random);
    set(p.displacement, i, u);
    turn_by<dim>(p, i, Spin<dim>::NullaryExpr([&] { return amplitude * uniform(random); }));
  }
}
/// A support moves and a side is drawn along.
template <int dim>
std::vector<core::BoundaryLoad<dim>> pull_and_press()
{
  std::vector<core::BoundaryLoad<dim>> loads(2);
  loads[0].boundary = 3, loads[0].value[1] = 0.03;
  loads[0].kind = core::BoundaryLoad<dim>::Kind::displacement;
  loads[1].boundary = 1, loads[1].kind = core::BoundaryLoad<dim>::Kind::traction;
  loads[1].value[0] = 0.02, loads[1].value[1] = -0.01;
  return loads;
}
} // namespace ligament::dem::testing
