#include "src/simulation/gauges/motion_reading.h"

#include "core/check.h"
#include "core/exact_sum.h"
#include "src/output/format.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
// A point has its particle within so many spacings, else it lies where no material is.
constexpr double reach = 3;

// Or, beside a curved side, its cell within this share of the cell's size.
constexpr double rim_reach = 0.1;

// Steps from bond to bond around a point: one is enough inside a lattice, two are beside surfaces.
constexpr int n_rings = 2;

template <int dim>
Point to_point(const Vector<dim> &v)
{
  Point p = {0, 0, 0};
  for (int c = 0; c < dim; ++c)
    p[c] = v[c];
  return p;
}

/// Of all ranks.
template <std::size_t n>
void merge(std::array<core::ExactSum, n> &sums, const core::Ranks &ranks)
{
  const auto all = ranks.sum(std::vector<core::ExactSum>(sums.begin(), sums.end()));
  std::copy(all.begin(), all.end(), sums.begin());
}

template <int dim>
void add_interpolated(const fem::Mesh<dim> &mesh, int cell, const Vector<dim> &place, double value,
                      const Vector<dim> &gradient, std::vector<double> &values,
                      std::vector<Vector<dim>> &gradients)
{
  const auto shape = fem::shape_values(mesh, cell, place);
  for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
    values[mesh.cells[cell][a]] += shape[a] * value;
    gradients[mesh.cells[cell][a]] += shape[a] * gradient;
  }
}
} // namespace

template <int dim>
Vector<dim> MotionReading<dim>::displacement(const CoupledBody<dim> &body) const
{
  std::array<core::ExactSum, dim> sums;
  const auto add = [&](const std::vector<Term> &terms, const Components<dim> &u) {
    for (const Term &t : terms)
      for (int c = 0; c < dim; ++c)
        sums[c].add(t.value * u[c][t.item]);
  };
  if (body.zone)
    add(particles, body.zone->state.displacement);
  if (body.far && body.ranks.is_first())
    add(nodes, body.far->displacement);
  merge(sums, body.ranks);
  Vector<dim> u;
  for (int c = 0; c < dim; ++c)
    u[c] = sums[c].value();
  return u;
}

template <int dim>
Eigen::Matrix<double, dim, dim> MotionReading<dim>::gradient(const CoupledBody<dim> &body) const
{
  std::array<core::ExactSum, dim * dim> sums;
  const auto add = [&](const std::vector<Term> &terms, const Components<dim> &u) {
    for (const Term &t : terms)
      for (int c = 0; c < dim; ++c)
        for (int k = 0; k < dim; ++k)
          sums[c * dim + k].add(u[c][t.item] * t.gradient[k]);
  };
  if (body.zone)
    add(particles, body.zone->state.displacement);
  if (body.far && body.ranks.is_first())
    add(nodes, body.far->displacement);
  merge(sums, body.ranks);
  Eigen::Matrix<double, dim, dim> h;
  for (int c = 0; c < dim; ++c)
    for (int k = 0; k < dim; ++k)
      h(c, k) = sums[c * dim + k].value();
  return h;
}

template <int dim>
GaugePlaces<dim>::GaugePlaces(const Scene &the_scene, const CoupledBody<dim> &the_body)
    : scene(the_scene), body(the_body)
{
  if (body.far)
    cells.emplace(body.far->mesh());
}

// Of two as near as each other the one that comes first in the order of the body.
template <int dim>
auto GaugePlaces<dim>::nearest_particle(const Vector<dim> &place) const -> Nearest
{
  Nearest nearest;
  if (!body.zone)
    return nearest;
  const auto &state = body.zone->state;
  const double farthest = std::pow(reach * body.spacing, 2);
  double least = farthest;
  particles::for_each(state.part.owned, [&](int i) {
    const Vector<dim> centre = get(state.reference, i);
    const double distance = (centre - place).squaredNorm();
    if (distance >= least)
      return;
    const auto &cracks = scene.specimen.cracks;
    if (std::any_of(cracks.begin(), cracks.end(), [&](const Crack &crack) {
          return crosses(crack, to_point<dim>(place), to_point<dim>(centre), dim);
        }))
      return;
    nearest.particle = i;
    least = distance;
  });
  const std::vector<double> all = body.ranks.gather_all(std::vector<double>{least});
  const auto first = std::min_element(all.begin(), all.end());
  nearest.is_there = *first < farthest;
  if (first - all.begin() != body.ranks.rank())
    nearest.particle = -1;
  return nearest;
}

template <int dim>
std::vector<int> bonded_around(const CoupledBody<dim> &body, int centre, int rings)
{
  std::vector<int> found = {centre};
  for (int ring = 0; ring < rings; ++ring) {
    const std::vector<int> from = found;
    body.force()->for_each_face(
        body.zone->state,
        [&](const particles::FaceView<dim> &face) {
          if (face.j >= 0 && face.bonded && !face.is_rebonded)
            found.push_back(face.j);
        },
        &from);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }
  return found;
}

// About the centroid the constant part of the fit is the mean, and what the particles don't tell of
// the gradient takes nothing from it.
template <int dim>
MotionReading<dim> fit_particles(const CoupledBody<dim> &body, const std::vector<int> &particles,
                                 const Vector<dim> &place, int *rank)
{
  const auto &reference = body.zone->state.reference;
  const int n = int(particles.size());
  Vector<dim> centroid = Vector<dim>::Zero();
  for (const int i : particles)
    centroid += get(reference, i) / n;
  Eigen::Matrix<double, Eigen::Dynamic, dim> offsets(n, int(dim));
  for (int k = 0; k < n; ++k)
    offsets.row(k) = ((get(reference, particles[k]) - centroid) / body.spacing).transpose();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> fit;
  fit.setThreshold(1e-6);
  fit.compute(offsets);
  const Eigen::MatrixXd inverse = fit.pseudoInverse() / body.spacing; // dim x n
  if (rank)
    *rank = int(fit.rank());
  MotionReading<dim> reading;
  for (int k = 0; k < n; ++k) {
    const Vector<dim> gradient = inverse.col(k);
    reading.particles.push_back({particles[k], 1. / n + gradient.dot(place - centroid), gradient});
  }
  return reading;
}

template <int dim>
MotionReading<dim> interpolate(const fem::Mesh<dim> &mesh, int cell, const Vector<dim> &place)
{
  const auto shape = fem::shape_values(mesh, cell, place);
  const auto gradients = fem::shape_gradients(mesh, cell, place);
  MotionReading<dim> reading;
  for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
    reading.nodes.push_back({mesh.cells[cell][a], shape[a], gradients.col(a)});
  return reading;
}

template <int dim>
PointMotion<dim>::PointMotion(const GaugePlaces<dim> &places, const Vector<dim> &place)
    : place_(place)
{
  if (places.cells)
    cell_ = places.cells->find(place);
  const auto nearest =
      cell_ < 0 ? places.nearest_particle(place) : typename GaugePlaces<dim>::Nearest();
  if (places.cells && cell_ < 0 && !nearest.is_there)
    cell_ = places.cells->nearest(place, rim_reach);
  if (cell_ >= 0) {
    reading_ = interpolate(places.body.far->mesh(), cell_, place);
    return;
  }
  core::require(nearest.is_there,
                places.body.zone ? "no particle lies within three spacings of a point: it is "
                                   "outside the material; move it"
                                 : "no cell holds a point: it is outside the material; move it");
  particle_ = nearest.particle;
  if (particle_ >= 0)
    find_particles(places.body);
}

template <int dim>
void PointMotion<dim>::find_particles(const CoupledBody<dim> &body)
{
  around_ = bonded_around(body, particle_, n_rings);
  reading_ = fit_particles(body, around_, place_);
}

template <int dim>
const MotionReading<dim> &PointMotion<dim>::reading(const CoupledBody<dim> &body)
{
  if (particle_ < 0)
    return reading_;
  const auto is_around = [&](int i) {
    return std::binary_search(around_.begin(), around_.end(), i);
  };
  bool has_changed = false;
  for_each_new_break(body, n_broken_, [&](const auto &bond) {
    has_changed = has_changed || (is_around(bond.i) && is_around(bond.j));
  });
  if (has_changed)
    find_particles(body);
  return reading_;
}

template <int dim>
std::string PointMotion<dim>::source(const CoupledBody<dim> &body) const
{
  if (cell_ >= 0)
    return fmt::format("{} nodes of a cell of {}", fem::n_cell_nodes<dim>,
                       quantity(body.far->mesh().cell_size[cell_].maxCoeff(), "m"));
  double radius = 0;
  for (const int i : around_)
    radius = std::max(radius, (get(body.zone->state.reference, i) - place_).norm());
  const auto all = body.ranks.gather_all(std::vector<double>{double(around_.size()), radius});
  double n = 0;
  for (std::size_t k = 0; k < all.size(); k += 2) { // one rank has them
    n = std::max(n, all[k]);
    radius = std::max(radius, all[k + 1]);
  }
  return fmt::format("{} particles within {}", n, quantity(radius, "m"));
}

template <int dim>
MotionReading<dim> fit_box(const GaugePlaces<dim> &places, const Vector<dim> &lower,
                           const Vector<dim> &upper)
{
  struct Sample
  {
    int particle, cell; // at least one of them is -1; both: a particle of another rank
    Vector<dim> place;
    double volume;
  };
  const auto &body = places.body;
  std::vector<Sample> samples;
  if (body.far)
    for_each_mesh_point(body.far->mesh(), lower, upper,
                        [&](int cell, const Vector<dim> &place, double volume) {
                          samples.push_back({-1, cell, place, volume * body.thickness});
                        });
  if (body.zone) {
    const auto &state = body.zone->state;
    const auto *overlap = body.coupler->overlap();
    struct Inside
    {
      int particle;
      double volume;
      std::array<double, dim> place;
    };
    std::vector<Inside> own;
    particles::for_each(state.part.owned, [&](int i) {
      const Vector<dim> x = get(state.reference, i);
      const bool inside = (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
      if (!inside || (overlap && overlap->member_of_particle[i] >= 0))
        return;
      own.push_back({i, state.volume[i], {}});
      std::copy(x.begin(), x.end(), own.back().place.begin());
    });
    const auto of_ranks = body.ranks.gather(own);
    for (std::size_t r = 0; r < of_ranks.size(); ++r)
      for (const Inside &p : of_ranks[r])
        samples.push_back({int(r) == body.ranks.rank() ? p.particle : -1, -1,
                           Eigen::Map<const Vector<dim>>(p.place.data()), p.volume});
  }
  double volume = 0;
  Vector<dim> centroid = Vector<dim>::Zero();
  for (const Sample &s : samples) {
    volume += s.volume;
    centroid += s.volume * s.place;
  }
  core::require(volume > 0, "its box holds no material; move it");
  centroid /= volume;
  Eigen::Matrix<double, dim, dim> moments = Eigen::Matrix<double, dim, dim>::Zero();
  for (const Sample &s : samples)
    moments += s.volume * (s.place - centroid) * (s.place - centroid).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>> axes(moments);
  core::require(axes.eigenvalues()[0] > 1e-9 * axes.eigenvalues()[dim - 1],
                "its box holds too few particles: they lie in one line or plane; make it wider");
  const Eigen::Matrix<double, dim, dim> inverse = moments.inverse();

  MotionReading<dim> reading;
  const int n_nodes = body.far ? body.far->mesh().n_nodes() : 0;
  std::vector<double> values(n_nodes, 0.);
  std::vector<Vector<dim>> gradients(n_nodes, Vector<dim>::Zero());
  for (const Sample &s : samples) {
    const Vector<dim> gradient = s.volume * inverse * (s.place - centroid);
    if (s.cell >= 0)
      add_interpolated<dim>(body.far->mesh(), s.cell, s.place, s.volume / volume, gradient, values,
                            gradients);
    else if (s.particle >= 0)
      reading.particles.push_back({s.particle, s.volume / volume, gradient});
  }
  for (int i = 0; i < n_nodes; ++i)
    if (values[i] != 0)
      reading.nodes.push_back({i, values[i], gradients[i]});
  return reading;
}

template struct MotionReading<2>;
template struct GaugePlaces<2>;
template class PointMotion<2>;
template std::vector<int> bonded_around(const CoupledBody<2> &, int, int);
template MotionReading<2> fit_particles(const CoupledBody<2> &, const std::vector<int> &,
                                        const Vector<2> &, int *);
template MotionReading<2> interpolate(const fem::Mesh<2> &, int, const Vector<2> &);
template MotionReading<2> fit_box(const GaugePlaces<2> &, const Vector<2> &, const Vector<2> &);
template struct MotionReading<3>;
template struct GaugePlaces<3>;
template class PointMotion<3>;
template std::vector<int> bonded_around(const CoupledBody<3> &, int, int);
template MotionReading<3> fit_particles(const CoupledBody<3> &, const std::vector<int> &,
                                        const Vector<3> &, int *);
template MotionReading<3> interpolate(const fem::Mesh<3> &, int, const Vector<3> &);
template MotionReading<3> fit_box(const GaugePlaces<3> &, const Vector<3> &, const Vector<3> &);
} // namespace ligament::program
