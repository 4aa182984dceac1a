#include "src/simulation/gauges/j_integral.h"

#include "src/simulation/gauges/mesh_share.h"
#include "src/simulation/gauges/small_strain.h"

#include "core/check.h"
#include "core/exact_sum.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>

#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
/// Falls from 1 to 0 on the way from `one` to `zero`, with two derivatives that vanish at both
/// ends, so that a sum over particles misses its integral by little.
double plateau(double x, double zero, double one)
{
  const double s = std::clamp((x - zero) / (one - zero), 0., 1.);
  return s * s * s * (10 + s * (6 * s - 15));
}

double plateau_slope(double x, double zero, double one)
{
  const double s = std::clamp((x - zero) / (one - zero), 0., 1.);
  return 30 * s * s * (1 - s) * (1 - s) / (one - zero);
}

template <int dim>
int axis_of(const Point &direction)
{
  int axis = 0;
  for (int c = 1; c < dim; ++c)
    if (direction[c] != 0)
      axis = c;
  return axis;
}

/// sigma n of a stress in Voigt order.
template <int dim>
Vector<dim> traction(const Strain<dim> &s, const Vector<dim> &n)
{
  if constexpr (dim == 2)
    return {s[0] * n[0] + s[2] * n[1], s[2] * n[0] + s[1] * n[1]};
  else
    return {s[0] * n[0] + s[5] * n[1] + s[4] * n[2], s[5] * n[0] + s[1] * n[1] + s[3] * n[2],
            s[4] * n[0] + s[3] * n[1] + s[2] * n[2]};
}
} // namespace

template <int dim>
JIntegral<dim>::JIntegral(const GaugeParameters &gauge, const GaugePlaces<dim> &places)
    : name_(gauge.name), along_(axis_of<dim>(gauge.direction)),
      across_(dim == 2 ? 1 - along_ : axis_of<dim>(gauge.normal)),
      sign_(gauge.direction[along_] > 0 ? 1 : -1), lower_(to_vector<dim>(gauge.lower)),
      upper_(to_vector<dim>(gauge.upper)), inner_lower_(to_vector<dim>(gauge.inner_lower)),
      inner_upper_(to_vector<dim>(gauge.inner_upper)), body_force_(places.body.loads)
{
  const CoupledBody<dim> &body = places.body;
  const auto constants = elastic_constants_of<dim>(places.scene);
  stiffness_ = constants.stiffness;
  const double e = places.scene.material.youngs_modulus, nu = places.scene.material.poissons_ratio;
  modulus_ = dim == 2 && body.plane == PlaneMode::stress ? e : e / (1 - nu * nu);
  depth_ = body.thickness;
  for (int c = 0; c < dim; ++c)
    if (c != along_ && c != across_) {
      depth_ = body.upper[c] - body.lower[c];
      lower_[c] = body.lower[c];
      upper_[c] = body.upper[c];
    }
  const auto *overlap = body.coupler->overlap();
  if (body.zone) {
    const auto &state = body.zone->state;
    particles::for_each(state.part.owned, [&](int i) {
      const Vector<dim> x = get(state.reference, i);
      const double share = overlap ? overlap->weight(x) : 1;
      if (share == 0 || !counts(x))
        return;
      const int material = body.force()->material(i);
      core::require(material == 0 || slope(x).isZero(0),
                    "an inclusion lies between its rectangles: J is no longer that of the tip "
                    "alone; move the rectangles");
      const MaterialParameters &m =
          material == 0 ? places.scene.material : places.scene.inclusions[material - 1].material;
      add_sample(x, share * state.volume[i], m.density, around(body, i), i);
    });
  }
  n_particles_ = samples_.size();
  n_of_body_ = body.ranks.sum(std::int64_t(n_particles_));
  if (body.far)
    add_cells(body, places.scene.material.density);
  core::require(n_of_body_ > 0 || !samples_.empty(),
                "nothing lies between its rectangles; move them apart");
}

template <int dim>
void JIntegral<dim>::add_cells(const CoupledBody<dim> &body, double density)
{
  const auto &mesh = body.far->mesh();
  const MeshShare<dim> share(body);
  for_each_cell_part<dim>(mesh, lower_, upper_, [&](int cell, const auto &, const auto &) {
    share.for_each_point(cell, [&](const Vector<dim> &x, double volume) {
      if (counts(x))
        add_sample(x, volume * body.thickness, density, interpolate(mesh, cell, x), -1);
    });
  });
}

template <int dim>
Vector<dim> JIntegral<dim>::slope(const Vector<dim> &x) const
{
  const auto factor = [&](int c) {
    return plateau(x[c], lower_[c], inner_lower_[c]) * plateau(x[c], upper_[c], inner_upper_[c]);
  };
  const auto rise = [&](int c) {
    return x[c] < inner_lower_[c] ? plateau_slope(x[c], lower_[c], inner_lower_[c])
                                  : plateau_slope(x[c], upper_[c], inner_upper_[c]);
  };
  Vector<dim> dq = Vector<dim>::Zero();
  dq[along_] = rise(along_) * factor(across_);
  dq[across_] = rise(across_) * factor(along_);
  return dq;
}

template <int dim>
double JIntegral<dim>::q(const Vector<dim> &x) const
{
  double product = 1;
  for (const int c : {along_, across_})
    product *=
        plateau(x[c], lower_[c], inner_lower_[c]) * plateau(x[c], upper_[c], inner_upper_[c]);
  return product;
}

// Forces on masses take part up to the tip.
template <int dim>
bool JIntegral<dim>::counts(const Vector<dim> &x) const
{
  return !slope(x).isZero(0) || (!body_force_.is_empty() && q(x) > 0);
}

template <int dim>
void JIntegral<dim>::add_sample(const Vector<dim> &x, double volume, double density,
                                const MotionReading<dim> &reading, int particle)
{
  const auto &terms = particle >= 0 ? reading.particles : reading.nodes;
  const double mass = body_force_.is_empty() ? 0 : density * volume * q(x);
  samples_.push_back({particle, volume, slope(x), mass, int(terms_.size()), int(terms.size())});
  for (const auto &t : terms)
    terms_.push_back({t.item, t.gradient});
}

// One step from bond to bond; beside a surface, or in a splinter, where these don't tell all, two.
template <int dim>
MotionReading<dim> JIntegral<dim>::around(const CoupledBody<dim> &body, int particle) const
{
  int rank = 0;
  const Vector<dim> x = get(body.zone->state.reference, particle);
  const auto reading = fit_particles<dim>(body, bonded_around(body, particle, 1), x, &rank);
  return rank == dim ? reading : fit_particles<dim>(body, bonded_around(body, particle, 2), x);
}

template <int dim>
void JIntegral<dim>::follow(const CoupledBody<dim> &body)
{
  std::vector<int> changed;
  for_each_new_break(body, n_broken_, [&](const auto &bond) {
    for (const int centre : {bond.i, bond.j})
      for (const int i : bonded_around(body, centre, 1)) // those with a fit of two steps
        changed.push_back(i);
  });
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  for (const int i : changed) {
    const auto end = samples_.begin() + n_particles_;
    const auto found = std::lower_bound(samples_.begin(), end, i,
                                        [](const Sample &s, int k) { return s.particle < k; });
    if (found == end || found->particle != i)
      continue;
    const auto reading = around(body, i);
    found->first = int(terms_.size());
    found->size = int(reading.particles.size());
    for (const auto &t : reading.particles)
      terms_.push_back({t.item, t.gradient});
  }
}

template <int dim>
std::vector<Column> JIntegral<dim>::columns() const
{
  return {{name_ + "_j", "J/m^2"}, {name_ + "_k", "Pa*m^0.5"}};
}

template <int dim>
void JIntegral<dim>::read(GaugeLook<dim> &look, double *values)
{
  follow(look.body);
  const Vector<dim> acceleration = body_force_.acceleration(look.time);
  core::ExactSum sum;
  const auto end = look.body.ranks.is_first() ? samples_.size() : n_particles_;
  for (std::size_t n = 0; n < end; ++n) {
    const Sample &s = samples_[n];
    const auto &u =
        s.particle >= 0 ? look.body.zone->state.displacement : look.body.far->displacement;
    Eigen::Matrix<double, dim, dim> h = Eigen::Matrix<double, dim, dim>::Zero();
    for (int k = s.first; k < s.first + s.size; ++k)
      h += get(u, terms_[k].item) * terms_[k].gradient.transpose();
    const Strain<dim> strain = small_strain<dim>(h), stress = stiffness_ * strain;
    const Vector<dim> along = sign_ * h.col(along_);
    sum.add(s.volume * (traction<dim>(stress, s.dq).dot(along) -
                        stress.dot(strain) / 2 * sign_ * s.dq[along_]) -
            s.mass * acceleration.dot(along));
  }
  values[0] = look.body.ranks.sum(sum).value() / depth_;
  values[1] = std::copysign(std::sqrt(modulus_ * std::abs(values[0])), values[0]);
}

template <int dim>
std::string JIntegral<dim>::description() const
{
  return fmt::format("domain integral over {} particles and {} points of cells, without terms of "
                     "inertia; rectangles of other sizes tell its error",
                     n_of_body_, samples_.size() - n_particles_);
}

template <int dim>
double broken_between(const GaugeParameters &g,
                      const std::vector<particles::BrokenBond<dim>> &bonds)
{
  double first = std::numeric_limits<double>::infinity();
  for (const auto &bond : bonds) {
    bool in_outer = true, in_inner = true;
    for (int c = 0; c < dim; ++c)
      if (g.inner_lower[c] < g.inner_upper[c]) { // not along the front
        in_outer = in_outer && bond.position[c] > g.lower[c] && bond.position[c] < g.upper[c];
        in_inner =
            in_inner && bond.position[c] > g.inner_lower[c] && bond.position[c] < g.inner_upper[c];
      }
    if (in_outer && !in_inner)
      first = std::min(first, bond.time);
  }
  return first;
}

template class JIntegral<2>;
template class JIntegral<3>;
template double broken_between(const GaugeParameters &,
                               const std::vector<particles::BrokenBond<2>> &);
template double broken_between(const GaugeParameters &,
                               const std::vector<particles::BrokenBond<3>> &);
} // namespace ligament::program
