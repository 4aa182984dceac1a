// When overlap and far field wait for a wave, and what wakes them (theory.md section 1.11); what
// else a run leaves out.
#include "coupling/fine_scale_split.h"

#include <algorithm>
#include <cmath>

namespace ligament::coupling
{
template <int dim>
void FineScaleSplit<dim>::let_rest(const Bodies<dim> &bodies, double strain)
{
  const auto &far = *bodies.far;
  const auto is_zero = [](const std::vector<double> &values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
  };
  const auto &body = far.body();
  waking_force_ = strain * body.stiffness(0, 0) * std::pow(overlap_.cell_size, dim - 1) *
                  (dim == 2 ? body.thickness : 1);
  rests_ = near_.displacement().isZero(0) && near_.velocity().isZero(0);
  far_rests_ = rests_;
  for (int c = 0; c < dim; ++c)
    far_rests_ = far_rests_ && is_zero(far.displacement[c]) && is_zero(far.velocity[c]);
}

template <int dim>
bool FineScaleSplit<dim>::far_rests(const Bodies<dim> &bodies, const StepTime &step)
{
  far_rests_ =
      far_rests_ && rests_ && !bodies.far->is_loaded(step.time + parameters_.step_ratio * step.dt);
  return far_rests_;
}

template <int dim>
void FineScaleSplit<dim>::look(Bodies<dim> &bodies, const StepTime &step)
{
  if (!rests_)
    return;
  if (is_far_step(step))
    far_rests(bodies, step); // in the first step no force has asked
  const auto *const rest = bodies.zone->rest();
  bool wakes = bodies.zone->ranks().any(
      std::any_of(here().members.begin(), here().members.end(),
                  [&](const auto &m) { return rest->is_awake(m.particle); }));
  if (is_far_step(step) && !far_rests_)
    for (const auto &force : bodies.far->force)
      for (const int node : overlap_.near_nodes)
        wakes = wakes || std::abs(force[node]) > waking_force_;
  if (!wakes)
    return;
  rests_ = far_rests_ = false;
  wake_members(bodies);
}

template <int dim>
void FineScaleSplit<dim>::wake_members(Bodies<dim> &bodies)
{
  std::vector<int> particles;
  for (const auto &m : here().members)
    particles.push_back(m.particle);
  bodies.zone->wake(particles);
}

template <int dim>
std::vector<RestShare> FineScaleSplit<dim>::shares_at_rest() const
{
  return {{"overlap_at_rest", "overlap's steps", share_at_rest()},
          {"far_field_at_rest", "far field's steps", far_share_at_rest()}};
}

template <int dim>
std::vector<core::SkippedPart> FineScaleSplit<dim>::skipped_parts() const
{
  std::vector<core::SkippedPart> skipped;
  if (parameters_.gap_filter == 0)
    skipped.push_back({"gap-band filter", "/coupling/gap_filter is 0"});
  if (parameters_.fine_damper == 0)
    skipped.push_back({"fluctuation damper", "/coupling/fine_damper is 0"});
  return skipped;
}

template std::vector<RestShare> FineScaleSplit<2>::shares_at_rest() const;
template std::vector<RestShare> FineScaleSplit<3>::shares_at_rest() const;
template std::vector<core::SkippedPart> FineScaleSplit<2>::skipped_parts() const;
template std::vector<core::SkippedPart> FineScaleSplit<3>::skipped_parts() const;
template void FineScaleSplit<2>::let_rest(const Bodies<2> &, double);
template void FineScaleSplit<3>::let_rest(const Bodies<3> &, double);
template bool FineScaleSplit<2>::far_rests(const Bodies<2> &, const StepTime &);
template bool FineScaleSplit<3>::far_rests(const Bodies<3> &, const StepTime &);
template void FineScaleSplit<2>::look(Bodies<2> &, const StepTime &);
template void FineScaleSplit<3>::look(Bodies<3> &, const StepTime &);
template void FineScaleSplit<2>::wake_members(Bodies<2> &);
template void FineScaleSplit<3>::wake_members(Bodies<3> &);
} // namespace ligament::coupling
