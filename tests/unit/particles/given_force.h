// A force for tests of what is done with forces.
#pragma once

#include "particles/particle_force.h"

namespace ligament::particles
{
/// Given by the test: compute() leaves it as it is.
template <int dim>
struct GivenForce : ParticleForce<dim>
{
  void compute(Particles<dim> &, double) override {}
  double potential_energy(const Particles<dim> &) const override { return 0; }
  double stable_step(const Particles<dim> &) const override { return 1; }
  ElasticConstants<dim> elastic_constants() const override { return {}; }
  void set_energy_weights(const std::vector<double> &) override {}
  void add_tangent(const Particles<dim> &, const std::function<void(const QuadraticTerm<dim> &)> &,
                   const std::vector<int> *) const override
  {
  }
  void for_each_face(const Particles<dim> &, const std::function<void(const FaceView<dim> &)> &,
                     const std::vector<int> *) const override
  {
  }
};
} // namespace ligament::particles
