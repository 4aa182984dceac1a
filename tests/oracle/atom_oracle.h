// Atoms written down plainly: all pairs and all images, no list. It shares only the data types with
// the production code and serves to check it.
#pragma once

#include "particles/particles.h"

#include <cmath>
#include <functional>

namespace ligament::oracle
{
/// A function of one variable and its derivative.
struct Curve
{
  double value, slope;
};

template <int dim>
struct AtomOracle
{
  using Matrix = Eigen::Matrix<double, dim, dim>;

  std::function<Curve(int a, int b, double r)> pair;    // J
  std::function<Curve(int a, int b, double r)> density; // what b adds at a
  std::function<Curve(int a, double rho)> embedding;    // J
  double cutoff;                                        // m
  std::vector<int> species;
  Vector<dim> period = Vector<dim>::Zero(); // m; 0: none

  double energy = 0;          // J
  std::vector<Matrix> virial; // J, half of each bond's, of each atom

  /// Overwrites forces, energy and virial.
  void compute(particles::Particles<dim> &p)
  {
    const int n = p.size();
    std::vector<double> rho(n, 0.);
    energy = 0;
    virial.assign(n, Matrix::Zero());
    for (auto &component : p.force)
      component.assign(n, 0.);
    for_each_neighbour(p, [&](int i, int j, const Vector<dim> &x) {
      rho[i] += density(species[i], species[j], x.norm()).value;
      energy += 0.5 * pair(species[i], species[j], x.norm()).value;
    });
    for (int i = 0; i < n; ++i)
      energy += embedding(species[i], rho[i]).value;
    for_each_neighbour(p, [&](int i, int j, const Vector<dim> &x) {
      const double r = x.norm();
      const double slope =
          pair(species[i], species[j], r).slope +
          embedding(species[i], rho[i]).slope * density(species[i], species[j], r).slope +
          embedding(species[j], rho[j]).slope * density(species[j], species[i], r).slope;
      add(p.force, i, Vector<dim>(slope / r * x));
      virial[i] += 0.5 * slope / r * x * x.transpose();
    });
  }

  /// visit(i, j, x): all neighbours j of all atoms i, x from i to the image of j.
  template <typename Visit>
  void for_each_neighbour(const particles::Particles<dim> &p, Visit &&visit) const
  {
    Eigen::Matrix<int, dim, 1> most, k;
    for (int c = 0; c < dim; ++c)
      most[c] = period[c] > 0 ? int(std::ceil(cutoff / period[c])) + 2 : 0;
    for (int i = 0; i < p.size(); ++i)
      for (int j = 0; j < p.size(); ++j) {
        const Vector<dim> straight = get(p.reference, j) + get(p.displacement, j) -
                                     get(p.reference, i) - get(p.displacement, i);
        k = -most;
        for (bool more = true; more;) {
          const Vector<dim> x = straight + k.template cast<double>().cwiseProduct(period);
          if (x.norm() < cutoff && (i != j || !k.isZero()))
            visit(i, j, x);
          more = false;
          for (int c = 0; c < dim && !more; ++c) {
            more = k[c] < most[c];
            k[c] = more ? k[c] + 1 : -most[c];
          }
        }
      }
  }
};
} // namespace ligament::oracle
