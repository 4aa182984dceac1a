// What a heat bath does to the motion that the mesh cannot carry.
#include "core/exact_sum.h"
#include "coupling/fine_motion.h"

#include <cmath>
#include <map>

namespace ligament::coupling
{
template <int dim>
void FineMotion<dim>::join_bath(const Overlap<dim> &overlap,
                                const std::function<double(double)> &kept)
{
  std::map<int, double> kept_by; // particles
  for (const auto &m : overlap.members)
    kept_by[m.particle] = m.pad ? 1 : kept(m.position);
  kept_.assign(lanes_.slots.size(), {});
  for (std::size_t k = 0; k < lanes_.slots.size(); ++k)
    for (int l = 0; l < lanes_.n_members[k]; ++l)
      kept_[k].value[l] = kept_by.at(lanes_.slots[k].particle[l]);
}

template <int dim>
template <typename Visit>
void FineMotion<dim>::for_each_free(Visit &&visit) const
{
  for (const auto &batch : lanes_.batches)
    for (int k = batch.begin; k < batch.end; ++k)
      for (int l = 0; l < lanes_.n_members[k]; ++l)
        if (lanes_.slots[k].mass.value[l] > 0)
          visit(k, l, batch.node);
}

// Friction acts half-way through the kick: after a whole one, places would be hotter than motions by
// half of what it takes in a step. The mesh's part P n of white noise has the covariance
// kT P M^-1 P^T that w lacks before friction may act atom by atom: no factor of Phi^T M Phi is needed
// for it. The same solve takes the mesh's part of half a kick out of it; what is left of that after
// friction goes with the last projection.
template <int dim>
void FineMotion<dim>::exchange_heat(double thermal_energy, const core::ThermalNoise &noise,
                                    double dt, const Nodal<dim> &coarse,
                                    particles::Particles<dim> &particles)
{
  if (!has_bath())
    return;
  const auto &slots = lanes_.slots;
  carried_.setZero();
  for_each_free([&](int k, int l, const auto &node) {
    const Slot &slot = slots[k];
    const double m = slot.mass.value[l], root = std::sqrt(thermal_energy * m);
    for (int c = 0; c < dim; ++c) {
      const int i = slot.particle[l];
      const double p =
          root * noise(particles.global_id[i], c, 0) + 0.5 * dt * particles.force[c][i];
      for (int a = 0; a < nc; ++a)
        carried_(node[a][l], c) += slot.value[a].value[l] * p;
    }
  });
  carrier_.solve(carried_);

  const std::vector<LaneArray> before = motion_;
  Nodal<dim> momentum = Nodal<dim>::Zero(carried_.rows(), dim);
  for_each_free([&](int k, int l, const auto &node) {
    const Slot &slot = slots[k];
    const double m = slot.mass.value[l], g = kept_[k].value[l],
                 root = std::sqrt((1 - g * g) * thermal_energy / m);
    for (int c = 0; c < dim; ++c) {
      double &w = motion_[k * dim + c].value[l];
      double mesh = 0;
      for (int a = 0; a < nc; ++a)
        mesh += slot.value[a].value[l] * carried_(node[a][l], c);
      const int i = slot.particle[l];
      const double half = 0.5 * dt * particles.force[c][i] / m;
      w = g * (w - half + mesh) + half + root * noise(particles.global_id[i], c, 1);
      for (int a = 0; a < nc; ++a)
        momentum(node[a][l], c) += slot.value[a].value[l] * m * w;
    }
  });
  carried_ = momentum;
  carrier_.solve(carried_);
  finish_kick(coarse, particles);

  core::ExactSum taken;
  for_each_free([&](int k, int l, const auto &) {
    const Slot &slot = slots[k];
    double twice = 0;
    for (int c = 0; c < dim; ++c) {
      const double old = before[k * dim + c].value[l], w = motion_[k * dim + c].value[l];
      twice +=
          (old - w) * (slot.mass.value[l] * (old + w) - dt * particles.force[c][slot.particle[l]]);
    }
    taken.add(twice);
  });
  bath_energy_ += taken.value() / 2;
}

template void FineMotion<2>::join_bath(const Overlap<2> &, const std::function<double(double)> &);
template void FineMotion<3>::join_bath(const Overlap<3> &, const std::function<double(double)> &);
template void FineMotion<2>::exchange_heat(double, const core::ThermalNoise &, double,
                                           const Nodal<2> &, particles::Particles<2> &);
template void FineMotion<3>::exchange_heat(double, const core::ThermalNoise &, double,
                                           const Nodal<3> &, particles::Particles<3> &);
} // namespace ligament::coupling
