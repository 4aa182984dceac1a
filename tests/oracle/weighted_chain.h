// The energy-weighted bridging domain of theory.md section 3.9 in one dimension.
#pragma once

#include "tests/oracle/coupled_chain.h"

namespace ligament::oracle
{
enum class Correction
{
  acceleration,
  whole_steps,
  whole_steps_lumped,
  pointwise
};

class WeightedChain : public Chain
{
public:
  WeightedChain(const ChainParameters &parameters, Correction correction)
      : Chain(parameters), correction_(correction), share_(Vector::Ones(n)),
        members_(Vector::Zero(n)), plain_(mass)
  {
    members_.tail(n - first).setOnes();
    // Mean over the four triangles of a square cell, by their centroids.
    for (int i = first; i < n; ++i)
      share_[i] = (weight(i - 1. / 3) + 2 * weight(i) + weight(i + 1. / 3)) / 4;
    mass = mass.cwiseProduct(share_);                                          // (B2)
    spring = spring.cwiseProduct(share_.head(n - 1) + share_.tail(n - 1)) / 2; // (B1)
  }

  void step()
  {
    const Vector push = p.dt / 2 * particle_force().cwiseQuotient(mass);
    const Vector nodal_push = -p.dt / 2 * node_mass.ldlt().solve(stiffness * nodal_u);
    const auto half_kick = [&] {
      v += push;
      nodal_v += nodal_push;
    };
    const bool whole =
        correction_ == Correction::whole_steps || correction_ == Correction::whole_steps_lumped;
    half_kick();
    if (!whole)
      project(); // (B8)
    damp();
    if (whole)
      project();
    half_kick();
    if (!whole)
      project();
    u += p.dt * v;
    nodal_u += p.dt * nodal_v;
  }

  void project() // (B4), (B5)
  {
    const Vector gap = members_.cwiseProduct(v - phi * nodal_v);
    if (correction_ == Correction::pointwise) {
      const Matrix momentum = phi.transpose() * mass.asDiagonal();
      nodal_v += (node_mass + momentum * phi).ldlt().solve(momentum * gap);
      v.tail(n - first) = (phi * nodal_v).tail(n - first);
      return;
    }
    const Matrix test = phi.transpose() * plain_.asDiagonal(), g = test * phi;
    const Matrix a =
        test * mass.cwiseInverse().asDiagonal() * test.transpose() + g * node_mass.ldlt().solve(g);
    Matrix inverse_row_sums = Matrix::Zero(n_nodes, n_nodes);
    for (int i = 0; i <= n_overlap; ++i)
      inverse_row_sums(i, i) = 1 / a.row(i).sum();
    const Vector momentum = test * gap;
    const Vector lambda = correction_ == Correction::whole_steps_lumped
                              ? Vector(-inverse_row_sums * momentum)
                              : Vector(-solve(a, momentum));
    nodal_v -= node_mass.ldlt().solve(g * lambda);
    v += mass.cwiseInverse().cwiseProduct(test.transpose() * lambda);
  }

private:
  void damp() // (B7)
  {
    const Matrix momentum = phi.transpose() * mass.asDiagonal();
    const auto fluctuation = [&](const Vector &x) -> Vector {
      return (x - phi * solve(momentum * phi, momentum * x)).cwiseProduct(members_);
    };
    Vector g = Vector::Zero(n);
    for (int i = first; i < n; ++i)
      g[i] = damping(i);
    v -= fluctuation(g.cwiseProduct(fluctuation(v)));
  }

  const Correction correction_;
  Vector share_, members_;
  const Vector plain_; // masses without weights
};
} // namespace ligament::oracle
