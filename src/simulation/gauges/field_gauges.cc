#include "src/simulation/gauges/field_gauges.h"

#include "src/simulation/far_stress.h"
#include "src/simulation/gauges/small_strain.h"
#include "src/simulation/gauges/tensor_columns.h"

#include "core/check.h"
#include "core/exact_sum.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <map>

namespace ligament::program
{
namespace
{
template <int dim>
using Tensor = Eigen::Matrix<double, dim, dim>;

/// U - 1 from H = F - 1 without losing digits of small strains: C - 1 = H + H^T + H^T H has the
/// eigenvalues c = (1 + e)^2 - 1.
template <int dim>
Tensor<dim> stretch(const Tensor<dim> &h)
{
  const Tensor<dim> c = h + h.transpose() + h.transpose() * h;
  const Eigen::SelfAdjointEigenSolver<Tensor<dim>> axes(c);
  Vector<dim> e;
  for (int k = 0; k < dim; ++k)
    e[k] = axes.eigenvalues()[k] / (std::sqrt(std::max(1 + axes.eigenvalues()[k], 0.)) + 1);
  return axes.eigenvectors() * e.asDiagonal() * axes.eigenvectors().transpose();
}
} // namespace

template <int dim>
StrainGauge<dim>::StrainGauge(const GaugeParameters &gauge, const GaugePlaces<dim> &places)
    : name_(gauge.name), angle_(gauge.angle)
{
  if (!gauge.points.empty()) {
    point_.emplace(places, to_vector<dim>(gauge.points[0]));
    description_ = "at a point, from " + point_->source(places.body);
    return;
  }
  box_ = fit_box(places, to_vector<dim>(gauge.lower), to_vector<dim>(gauge.upper));
  description_ =
      fmt::format("over a box, from {} particles and {} nodes; what breaks in it counts "
                  "as strain",
                  places.body.ranks.sum(std::int64_t(box_.particles.size())), box_.nodes.size());
}

template <int dim>
std::vector<Column> StrainGauge<dim>::columns() const
{
  return tensor_columns<dim>(name_, "1");
}

template <int dim>
void StrainGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  const MotionReading<dim> &reading = point_ ? point_->reading(look.body) : box_;
  put_turned<dim>(stretch<dim>(reading.gradient(look.body)), angle_, values);
}

template <int dim>
StressGauge<dim>::StressGauge(const GaugeParameters &gauge, const GaugePlaces<dim> &places)
    : name_(gauge.name), angle_(gauge.angle)
{
  const CoupledBody<dim> &body = places.body;
  if (!gauge.points.empty()) {
    PointMotion<dim> point(places, to_vector<dim>(gauge.points[0]));
    if (point.cell() >= 0) {
      mesh_share_ = 1;
      mesh_ = point.reading(body);
      description_ = "of the mesh at a point";
    } else {
      n_particles_ = 1;
      if (point.particle() >= 0)
        particles_.push_back({point.particle(), 1});
      description_ = "of the particle nearest to a point";
    }
    return;
  }
  const Vector<dim> lower = to_vector<dim>(gauge.lower), upper = to_vector<dim>(gauge.upper);
  double mesh_volume = 0, volume = 0;
  std::map<int, Vector<dim>> gradients;
  if (body.far)
    for_each_mesh_point(body.far->mesh(), lower, upper,
                        [&](int cell, const Vector<dim> &place, double part) {
                          mesh_volume += part * body.thickness;
                          for (const auto &term : interpolate(body.far->mesh(), cell, place).nodes)
                            gradients.try_emplace(term.item, Vector<dim>::Zero()).first->second +=
                                part * body.thickness * term.gradient;
                        });
  volume = mesh_volume;
  if (body.zone) {
    const auto &state = body.zone->state;
    const auto *overlap = body.coupler->overlap();
    std::vector<double> volumes;
    particles::for_each(state.part.owned, [&](int i) {
      const Vector<dim> x = get(state.reference, i);
      const bool inside = (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
      if (!inside || (overlap && overlap->member_of_particle[i] >= 0))
        return;
      particles_.push_back({i, state.volume[i]});
      volumes.push_back(state.volume[i]);
    });
    volumes = body.ranks.gather_all(volumes);
    n_particles_ = volumes.size();
    for (const double part : volumes)
      volume += part;
  }
  core::require(volume > 0, "its box holds no material; move it");
  for (Share &s : particles_)
    s.share /= volume;
  mesh_share_ = mesh_volume / volume;
  for (const auto &[node, gradient] : gradients)
    mesh_.nodes.push_back({node, 0, gradient / mesh_volume});
  description_ =
      fmt::format("over a box, from {} particles and {} nodes; costs a look at all bonds "
                  "for each row",
                  n_particles_, mesh_.nodes.size());
}

template <int dim>
std::vector<Column> StressGauge<dim>::columns() const
{
  return tensor_columns<dim>(name_, "Pa");
}

template <int dim>
void StressGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  Strain<dim> stress = Strain<dim>::Zero();
  if (n_particles_ > 0) {
    std::vector<core::ExactSum> sums(n_strains<dim>);
    if (!particles_.empty()) {
      const auto &of = look.stresses();
      for (int c = 0; c < n_strains<dim>; ++c)
        for (const Share &s : particles_)
          sums[c].add(s.share * of[c][s.item]);
    }
    sums = look.body.ranks.sum(sums);
    for (int c = 0; c < n_strains<dim>; ++c)
      stress[c] = sums[c].value();
  }
  if (mesh_share_ > 0)
    stress += mesh_share_ * FarStress<dim>(look.body)(mesh_.gradient(look.body));
  put_turned<dim>(tensor_of<dim>(stress), angle_, values);
}

template class StrainGauge<2>;
template class StrainGauge<3>;
template class StressGauge<2>;
template class StressGauge<3>;
} // namespace ligament::program
