#include "src/simulation/tools/contact_surface.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::program
{
namespace
{
// Thickness of the layer between tool and body in spacings or cells: what lies between the centre
// of a particle, which is rigid, and its face.
constexpr double layer_thickness = 0.5;

// By which a particle that the layer also turns answers faster than by its mass alone: the largest
// eigenvalue of the layer at a distance of d/2, friction included, for discs and balls.
constexpr double with_turns = 1.5;

/// Places from 0 to 1 and weights of a quadrature along an edge.
using Rule = std::vector<std::array<double, 2>>;

// Lobatto's points on the face of a cell: a contact may be narrower than the cell.
const Rule whole = {{0, 1. / 12},
                    {(1 - std::sqrt(0.2)) / 2, 5. / 12},
                    {(1 + std::sqrt(0.2)) / 2, 5. / 12},
                    {1, 1. / 12}};

/// Many points where particles may take over somewhere on the face.
Rule even_rule(int n)
{
  Rule rule;
  for (int k = 0; k < n; ++k)
    rule.push_back({(k + 0.5) / n, 1. / n});
  return rule;
}
constexpr int n_cut = 12;

template <int dim>
using Tensor = Eigen::Matrix<double, dim, dim>;

/// Of sum A n n^T: the area that a push in the worst direction meets.
template <int dim>
double largest_eigenvalue(const Tensor<dim> &symmetric)
{
  if (symmetric.isZero(0))
    return 0;
  return Eigen::SelfAdjointEigenSolver<Tensor<dim>>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues()[dim - 1];
}

template <int dim>
struct Piece
{
  Vector<dim> arm;
  double area;
};

// All rules have points at edges and corners: what is sharp is touched there first.

/// Simpson's rule on a segment, m and m^2.
std::vector<Piece<2>> pieces_of_segment(const Vector<2> &middle, const Vector<2> &normal,
                                        double area, double thickness)
{
  const Vector<2> half = area / thickness / 2 * Vector<2>(-normal[1], normal[0]);
  return {{middle - half, area / 6}, {middle, area * 2 / 3}, {middle + half, area / 6}};
}

template <int dim>
std::vector<Piece<dim>> pieces_of(const packings::BoundaryFace<dim> &face, double thickness)
{
  if constexpr (dim == 2)
    return pieces_of_segment(face.lever, face.normal, face.area, thickness);
  else {
    std::vector<Piece<3>> pieces;
    const std::size_t n = face.corners.size();
    double sum = 0;
    for (const Vector<3> &corner : face.corners)
      pieces.push_back({corner, 0});
    pieces.push_back({face.lever, 0});
    // Of each triangle between the centroid and an edge: 3/4 in its middle and 1/12 at its corners
    // are exact for quadratic functions.
    for (std::size_t k = 0; k < n; ++k) {
      const Vector<3> a = face.corners[k] - face.lever, b = face.corners[(k + 1) % n] - face.lever;
      const double area = a.cross(b).norm() / 2;
      pieces.push_back({face.lever + (a + b) / 3, area * 3 / 4});
      for (const std::size_t at : {k, (k + 1) % n, n})
        pieces[at].area += area / 12;
      sum += area;
    }
    if (sum <= 0)
      return {{face.lever, face.area}};
    for (Piece<3> &piece : pieces)
      piece.area *= face.area / sum;
    return pieces;
  }
}
} // namespace

template <int dim>
void ContactSurface<dim>::add_flank(const Flank &flank, std::int64_t owner)
{
  std::vector<Piece<dim>> pieces = {{flank.arm, flank.area}};
  if constexpr (dim == 2)
    pieces = pieces_of_segment(flank.arm, flank.normal, flank.area, thickness_);
  for (const Piece<dim> &piece : pieces) {
    SurfacePoint<dim> point;
    point.owner = owner;
    point.number = n_of_particle_[flank.particle]++;
    point.particle = flank.particle;
    point.arm = piece.arm;
    point.normal = flank.normal;
    point.area = piece.area;
    point.stiffness = per_area_[flank.particle] * piece.area;
    points_.push_back(point);
  }
}

template <int dim>
void ContactSurface<dim>::add_particles(const packings::Packing<dim> &packing,
                                        const particles::Particles<dim> &particles,
                                        const ContactStiffness &stiffness, double stable_step)
{
  thickness_ = dim == 2 ? packing.thickness : 1;
  const auto plain = [&](int i) {
    const int material = packing.material.empty() ? 0 : packing.material[i];
    return stiffness.youngs_modulus[material] / (layer_thickness * packing.spacing);
  };
  n_of_particle_.assign(packing.size(), 0);
  const double most = stiffness.share * std::pow(2 / stable_step, 2) / with_turns;
  std::vector<Tensor<dim>> outer(packing.size(), Tensor<dim>::Zero());
  for (const auto &face : packing.boundary_faces)
    outer[face.i] += face.area * face.normal * face.normal.transpose();
  per_area_.resize(packing.size());
  for (int i = 0; i < packing.size(); ++i) {
    per_area_[i] = plain(i);
    if (std::isfinite(particles.mass[i])) {
      // What of it may be pressed at once: its outer faces, or from any side when it breaks off.
      const double across =
          std::pow(packing.volume[i] / thickness_, double(dim - 1) / dim) * thickness_;
      const double area = largest_eigenvalue<dim>(outer[i]);
      per_area_[i] = std::min(plain(i), most * particles.mass[i] / std::max(area, across));
      largest_rate_ = std::max(largest_rate_, with_turns * per_area_[i] * area / particles.mass[i]);
    }
  }
  for (const auto &face : packing.boundary_faces)
    for (const auto &piece : pieces_of<dim>(face, thickness_)) {
      SurfacePoint<dim> point;
      point.owner = packing.global_id[face.i];
      point.number = n_of_particle_[face.i]++;
      point.particle = face.i;
      point.arm = piece.arm;
      point.normal = face.normal;
      point.area = piece.area;
      point.stiffness = per_area_[face.i] * piece.area;
      points_.push_back(point);
    }
  for (const auto &face : packing.faces)
    if (face.cracked) {
      add_flank({face.i, face.lever_i, face.normal, face.area}, packing.global_id[face.i]);
      add_flank({face.j, face.lever_j, -face.normal, face.area}, packing.global_id[face.j]);
    }
}

template <int dim>
void ContactSurface<dim>::add_cells(const fem::FemSolver<dim> &far,
                                    const coupling::Overlap<dim> *overlap, const core::Names &names,
                                    const ContactStiffness &stiffness, double stable_step)
{
  const auto &mesh = far.mesh();
  hanging_.assign(mesh.n_nodes(), -1);
  for (std::size_t k = 0; k < mesh.hanging.size(); ++k)
    hanging_[mesh.hanging[k].node] = int(k);
  const double thickness = dim == 2 ? far.body().thickness : 1;
  const std::size_t first = points_.size();
  std::vector<Tensor<dim>> share(mesh.n_nodes(), Tensor<dim>::Zero()); // N/m
  std::map<std::int64_t, int> n_of_node;
  std::vector<char> has_particles(mesh.n_cells(), 0);
  if (overlap)
    for (const auto &cell : overlap->cells)
      has_particles[cell.cell] = cell.layer == 0;
  const Rule cut = even_rule(n_cut);
  for (const auto &face : mesh.boundary_faces) {
    SurfacePoint<dim> point;
    int n = 0;
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      if ((a >> (face.face / 2) & 1) == face.face % 2)
        point.nodes[n++] = mesh.cells[face.cell][a];
    point.owner = -1 - names.name(point.nodes[0]);
    Vector<dim> outward = Vector<dim>::Zero(); // more or less
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      outward += ((a >> (face.face / 2) & 1) == face.face % 2 ? 1 : -1) *
                 mesh.nodes[mesh.cells[face.cell][a]];
    const double width = mesh.cell_size[face.cell][face.face / 2];
    const auto &x = mesh.nodes;
    const Rule &rule = has_particles[face.cell] ? cut : whole;
    const int n_along = int(rule.size());
    for (int k = 0; k < (dim == 2 ? n_along : n_along * n_along); ++k) {
      const double s = rule[k % n_along][0], r = rule[k / n_along][0];
      double weight = rule[k % n_along][1];
      Vector<dim> normal;
      if constexpr (dim == 2) {
        point.shares << 1 - s, s;
        const Vector<2> along = x[point.nodes[1]] - x[point.nodes[0]];
        weight *= along.norm() * thickness;
        normal = Vector<2>(-along[1], along[0]).normalized();
      } else {
        point.shares << (1 - s) * (1 - r), s * (1 - r), (1 - s) * r, s * r;
        const Vector<3> along = (1 - r) * (x[point.nodes[1]] - x[point.nodes[0]]) +
                                r * (x[point.nodes[3]] - x[point.nodes[2]]),
                        across = (1 - s) * (x[point.nodes[2]] - x[point.nodes[0]]) +
                                 s * (x[point.nodes[3]] - x[point.nodes[1]]);
        weight *= rule[k / n_along][1] * along.cross(across).norm();
        normal = along.cross(across).normalized();
      }
      if (has_particles[face.cell]) {
        Vector<dim> place = Vector<dim>::Zero();
        for (int a = 0; a < SurfacePoint<dim>::n_nodes; ++a)
          place += point.shares[a] * x[point.nodes[a]];
        if (overlap->distance_to_edge(place) > 0)
          continue;
      }
      point.number = n_of_node[point.owner]++;
      point.normal = normal.dot(outward) < 0 ? Vector<dim>(-normal) : normal;
      point.area = weight;
      point.stiffness = stiffness.youngs_modulus.front() / (layer_thickness * width) * weight;
      points_.push_back(point);
      for (int a = 0; a < SurfacePoint<dim>::n_nodes; ++a)
        share[point.nodes[a]] += point.shares[a] * point.stiffness * normal * normal.transpose();
    }
  }
  // A node's row of the layer's stiffness adds up to its share of it.
  const double most = stiffness.share * std::pow(2 / stable_step, 2);
  for (std::size_t k = first; k < points_.size(); ++k) {
    double factor = 1;
    for (const int node : points_[k].nodes)
      if (far.lumped_mass()[node] > 0 && !far.is_released_node(node)) {
        const double rate = largest_eigenvalue<dim>(share[node]) / far.lumped_mass()[node];
        factor = std::min(factor, most / rate);
        largest_rate_ = std::max(largest_rate_, std::min(rate, most));
      }
    points_[k].stiffness *= factor;
  }
}

template <int dim>
int ContactSurface<dim>::add_broken(const particles::ParticleSolver<dim> &zone)
{
  const int before = size();
  const auto &broken = zone.force->broken_bonds();
  for (; n_broken_ < broken.size(); ++n_broken_) {
    const auto &bond = broken[n_broken_];
    for (const int i : {bond.i, bond.j})
      add_flank({i, bond.position - get(zone.state.reference, i),
                 i == bond.i ? bond.normal : Vector<dim>(-bond.normal), bond.area},
                zone.state.global_id[i]);
  }
  return before;
}

template <int dim>
Vector<dim> ContactSurface<dim>::turned(const Vector<dim> &arm, int particle,
                                        const particles::Particles<dim> &particles)
{
  if (!particles.turns)
    return arm;
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(particles.rotation[0][particle]) * arm;
  else {
    const Vec<4> q = get(particles.rotation, particle);
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * arm;
  }
}

/// Of a straight edge, or the mean one of a quadrilateral; which of the two ways is left open.
Vector<2> normal_of(const std::array<Vector<2>, 2> &x)
{
  return Vector<2>(x[0][1] - x[1][1], x[1][0] - x[0][0]).normalized();
}
Vector<3> normal_of(const std::array<Vector<3>, 4> &x)
{
  return (x[3] - x[0]).cross(x[2] - x[1]).normalized();
}

template <int dim>
Vector<dim> ContactSurface<dim>::normal(int k, const coupling::Bodies<dim> &bodies) const
{
  const SurfacePoint<dim> &point = points_[k];
  if (!point.is_far())
    return turned(point.normal, point.particle, bodies.zone->state);
  std::array<Vector<dim>, SurfacePoint<dim>::n_nodes> then, now;
  for (int a = 0; a < SurfacePoint<dim>::n_nodes; ++a) {
    then[a] = bodies.far->mesh().nodes[point.nodes[a]];
    now[a] = then[a] + get(bodies.far->displacement, point.nodes[a]);
  }
  const Vector<dim> n = normal_of(now);
  return normal_of(then).dot(point.normal) < 0 ? Vector<dim>(-n) : n;
}

template <int dim>
Vector<dim> ContactSurface<dim>::place(int k, const coupling::Bodies<dim> &bodies) const
{
  const SurfacePoint<dim> &point = points_[k];
  if (!point.is_far()) {
    const auto &state = bodies.zone->state;
    return get(state.reference, point.particle) + get(state.displacement, point.particle) +
           arm(k, state);
  }
  Vector<dim> x = Vector<dim>::Zero();
  for (int a = 0; a < SurfacePoint<dim>::n_nodes; ++a)
    x += point.shares[a] *
         (bodies.far->mesh().nodes[point.nodes[a]] + get(bodies.far->displacement, point.nodes[a]));
  return x;
}

template <int dim>
Vector<dim> ContactSurface<dim>::velocity(int k, const coupling::Bodies<dim> &bodies) const
{
  const SurfacePoint<dim> &point = points_[k];
  Vector<dim> v = Vector<dim>::Zero();
  if (point.is_far()) {
    for (int a = 0; a < SurfacePoint<dim>::n_nodes; ++a)
      v += point.shares[a] * get(bodies.far->velocity, point.nodes[a]);
    return v;
  }
  const auto &state = bodies.zone->state;
  v = get(state.velocity, point.particle);
  if (!state.turns)
    return v;
  const Vector<dim> r = arm(k, state);
  const Spin<dim> w = get(state.spin, point.particle);
  if constexpr (dim == 2)
    return v + w[0] * Vector<2>(-r[1], r[0]);
  else
    return v + w.cross(r);
}

template <int dim>
void ContactSurface<dim>::push(int k, const Vector<dim> &force, coupling::Bodies<dim> &bodies) const
{
  const SurfacePoint<dim> &point = points_[k];
  if (point.is_far()) {
    for (int a = 0; a < SurfacePoint<dim>::n_nodes; ++a) {
      const int node = point.nodes[a], h = hanging_[node];
      const Vector<dim> f = point.shares[a] * force;
      if (h < 0)
        bodies.far->push(node, f);
      else
        for (const auto &[master, weight] : bodies.far->mesh().hanging[h].masters)
          bodies.far->push(master, weight * f);
    }
    return;
  }
  auto &state = bodies.zone->state;
  add(state.force, point.particle, force);
  if (!state.turns)
    return;
  const Vector<dim> r = arm(k, state);
  if constexpr (dim == 2)
    state.torque[0][point.particle] += r[0] * force[1] - r[1] * force[0];
  else
    add(state.torque, point.particle, Vector<3>(r.cross(force)));
}

template <int dim>
double ContactSurface<dim>::largest_speed(const coupling::Bodies<dim> &bodies) const
{
  double largest = 0;
  for (int k = 0; k < size(); ++k)
    largest = std::max(largest, velocity(k, bodies).squaredNorm());
  return std::sqrt(largest);
}

template struct SurfacePoint<2>;
template struct SurfacePoint<3>;
template class ContactSurface<2>;
template class ContactSurface<3>;
} // namespace ligament::program
