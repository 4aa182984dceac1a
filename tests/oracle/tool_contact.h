// Contact of a disc with the outer faces of a packing, written down plainly: every face, every
// step.
#pragma once

#include "particles/particle_force.h"

#include <cmath>
#include <map>

namespace ligament::tests
{
struct DiscContact
{
  double youngs_modulus, spacing, thickness, share, stable_step; // of the body
  Vector<2> centre;
  double radius;

  std::map<int, Vector<2>> force = {}; // N, on particles
  std::map<int, double> torque = {};   // N m
  double energy = 0;

  void press(const particles::ParticleForce<2> &law, const particles::Particles<2> &state)
  {
    std::map<int, std::array<double, 3>> outer; // xx, yy, xy of sum A n n
    law.for_each_face(state, [&](const particles::FaceView<2> &face) {
      if (face.j < 0)
        for (int c = 0; c < 3; ++c)
          outer[face.i][c] += face.area * face.normal[c == 1] * face.normal[c > 0];
    });
    law.for_each_face(state, [&](const particles::FaceView<2> &face) {
      if (face.j >= 0)
        return;
      const int i = face.i;
      const auto &[xx, yy, xy] = outer[i];
      const double largest = (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy);
      const double area = std::max(largest, thickness * std::sqrt(state.volume[i] / thickness));
      const double soft = share / 1.5 * 4 / (stable_step * stable_step) * state.mass[i] / area;
      const double k = std::min(youngs_modulus / (spacing / 2), soft);
      const double half = face.area / thickness / 2;
      const double angle = state.rotation[0][i];
      for (const double sign : {-1., 0., 1.}) {
        const double px = face.centroid[0] - sign * half * face.normal[1],
                     py = face.centroid[1] + sign * half * face.normal[0];
        const double rx = px - state.reference[0][i], ry = py - state.reference[1][i];
        const double ax = std::cos(angle) * rx - std::sin(angle) * ry,
                     ay = std::sin(angle) * rx + std::cos(angle) * ry;
        const double x = state.reference[0][i] + state.displacement[0][i] + ax - centre[0],
                     y = state.reference[1][i] + state.displacement[1][i] + ay - centre[1];
        const double r = std::hypot(x, y), g = radius - r;
        if (g <= 0)
          continue;
        const double f = k * face.area * (sign == 0 ? 4 : 1) / 6 * g;
        energy += f * g / 2;
        auto &sum = force.try_emplace(i, Vector<2>(0, 0)).first->second;
        sum += Vector<2>(f * x / r, f * y / r);
        torque[i] += ax * f * y / r - ay * f * x / r;
      }
    });
  }
};
} // namespace ligament::tests
