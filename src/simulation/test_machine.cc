#include "src/simulation/test_machine.h"

#include "core/exact_sum.h"
#include "fem/part_shares.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace ligament::program
{
namespace
{
// Particles that tell the motion of a side lie so many spacings inside it at most.
constexpr double side_depth = 2.5;

/// A displacement component as an affine function of the place, from those of particles: exact for
/// homogeneous strain and rotation on any packing.
template <int dim>
class AffineFit
{
public:
  /// Adds a particle of this rank, in m, its place in spacings.
  void add(const Vector<dim> &place, double displacement)
  {
    Row row = Row::Ones();
    row.template head<dim>() = place;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b <= a; ++b)
        sums_[a * n + b].add(row[a] * row[b]);
      sums_[n * n + a].add(displacement * row[a]);
    }
  }

  /// Of all ranks; then no more are added.
  void solve(const core::Ranks &ranks)
  {
    sums_ = ranks.sum(sums_);
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b <= a; ++b)
        matrix_(a, b) = matrix_(b, a) = sums_[a * n + b].value();
      right_[a] = sums_[n * n + a].value();
    }
  }

  double n_particles() const { return matrix_(dim, dim); }
  /// With so few there is no fit to rely on.
  bool is_poor() const { return n_particles() < 2 * n; }
  Vector<dim> middle() const { return matrix_.col(dim).template head<dim>() / n_particles(); }
  double mean() const { return right_[dim] / n_particles(); } // m
  /// Standard deviation of the places, spacings.
  Vector<dim> spread() const { return covariance().diagonal().cwiseMax(0.).cwiseSqrt(); }
  /// In m; the same all along a direction in which the particles lie in one line.
  double at(const Vector<dim> &place) const
  {
    constexpr double least_variance = 1e-4;
    const Vector<dim> steps = place - middle(),
                      moved = right_.template head<dim>() / n_particles() - mean() * middle();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>> axes(covariance());
    double sum = mean();
    for (int k = 0; k < dim; ++k)
      if (const double variance = axes.eigenvalues()[k]; variance > least_variance)
        sum += axes.eigenvectors().col(k).dot(moved) * axes.eigenvectors().col(k).dot(steps) /
               variance;
    return sum;
  }

private:
  static constexpr int n = dim + 1;
  using Row = Eigen::Matrix<double, n, 1>; // a place and 1

  Eigen::Matrix<double, dim, dim> covariance() const
  {
    return matrix_.template topLeftCorner<dim, dim>() / n_particles() -
           middle() * middle().transpose();
  }

  std::vector<core::ExactSum> sums_ = std::vector<core::ExactSum>(n * n + n);
  Eigen::Matrix<double, n, n> matrix_;
  Row right_;
};

/// Of an end of the box, from the particles up to this depth (spacings) that the far field does not
/// move.
template <int dim>
AffineFit<dim> fit_near(const CoupledBody<dim> &body, int axis, double place, int component,
                        double most)
{
  AffineFit<dim> fit;
  const auto &state = body.zone->state;
  const Vector<dim> middle = (body.upper + body.lower) / 2;
  const auto *overlap = body.coupler->overlap();
  particles::for_each(state.part.owned, [&](int i) {
    const double depth = std::abs(state.reference[axis][i] - place) / body.spacing;
    if (depth > most || (overlap && overlap->member_of_particle[i] >= 0))
      return;
    Vector<dim> x = (get(state.reference, i) - middle) / body.spacing;
    x[axis] = depth;
    fit.add(x, state.displacement[component][i]);
  });
  fit.solve(body.ranks);
  return fit;
}

/// Whether its particles lie around the axis of the body.
template <int dim>
bool reaches_middle(const AffineFit<dim> &fit, int axis)
{
  Vector<dim> beyond = fit.middle().cwiseAbs() - 2 * fit.spread();
  beyond[axis] = 0;
  return beyond.maxCoeff() <= 0;
}

/// Of an end of the box, from the particles near it, which lie inside it: of the middle of the side
/// where `has_all` and they reach so far, else of theirs. A body that ends in a tip has few there:
/// where the mesh has nothing of the end those further inside tell its motion. None where there are
/// too few.
template <int dim>
std::optional<double> extrapolated_displacement(const CoupledBody<dim> &body, int axis,
                                                double place, int component, bool has_all)
{
  const double most = has_all ? 8 * side_depth : side_depth;
  for (double depth = side_depth; depth <= most; depth *= 2) {
    const AffineFit<dim> fit = fit_near(body, axis, place, component, depth);
    const bool is_last = 2 * depth > most, is_all = !body.far && fit.n_particles() > 0;
    if (fit.is_poor() && !(is_last && is_all)) // a body of a few particles has no others
      continue;
    Vector<dim> at = fit.middle();
    if (has_all && depth == side_depth && reaches_middle(fit, axis))
      at.setZero();
    at[axis] = 0;
    return fit.at(at);
  }
  return std::nullopt;
}

/// Nodes of the mesh that reach farthest towards an end of the box.
struct FarthestNodes
{
  double distance = std::numeric_limits<double>::infinity(); // from there, m
  double displacement = 0;                                   // mean, m
};

template <int dim>
FarthestNodes farthest_nodes(const CoupledBody<dim> &body, int boundary, int component)
{
  FarthestNodes r;
  if (!body.far)
    return r;
  const int axis = boundary / 2;
  const double end = boundary % 2 ? body.upper[axis] : body.lower[axis],
               round_off = 1e-9 * (body.upper[axis] - body.lower[axis]);
  const auto &nodes = body.far->mesh().nodes;
  for (const auto &x : nodes)
    r.distance = std::min(r.distance, std::abs(x[axis] - end));
  int count = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (std::abs(nodes[i][axis] - end) < r.distance + round_off) {
      r.displacement += body.far->displacement[component][i];
      ++count;
    }
  r.displacement /= count;
  return r;
}

/// Of the middle of what a traction on a side with a name acts on, from particles on it and their
/// neighbours; none where the mesh has all of it.
template <int dim>
std::optional<double> layer_displacement(const CoupledBody<dim> &body, int load, int component)
{
  AffineFit<dim> fit;
  const auto &state = body.zone->state;
  const auto *overlap = body.coupler->overlap();
  for (const int i : body.load_layers[load])
    if (state.part.owns(i) && !(overlap && overlap->member_of_particle[i] >= 0))
      fit.add((get(state.reference, i) - body.load_places[load].middle) / body.spacing,
              state.displacement[component][i]);
  fit.solve(body.ranks);
  if (fit.n_particles() == 0)
    return std::nullopt;
  return fit.is_poor() ? fit.mean() : fit.at(Vector<dim>::Zero());
}

/// Area in m^2 (2D: m) that the mesh has of a part of a side, and its mean displacement there in m.
struct MeshReading
{
  double area = 0, displacement = 0;
};

template <int dim>
MeshReading mesh_displacement(const CoupledBody<dim> &body, int boundary,
                              const core::Part<dim> &part, int component)
{
  MeshReading r;
  if (!body.far)
    return r;
  const auto &mesh = body.far->mesh();
  double moment = 0;
  for (const auto &face : mesh.boundary_faces)
    if (face.boundary == boundary) {
      const auto shares = fem::part_shares<dim>(part, mesh, face);
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
        moment += shares[a] * body.far->displacement[component][mesh.cells[face.cell][a]];
      r.area += shares.sum();
    }
  if (r.area > 0)
    r.displacement = moment / r.area;
  return r;
}

/// Of both halves of a body, by what the mesh has of an area (m^2, 2D: m).
std::optional<double> joint_displacement(const MeshReading &mesh, double area,
                                         const std::function<std::optional<double>(bool)> &rest)
{
  const double share = area > 0 ? std::min(mesh.area / area, 1.) : mesh.area > 0;
  constexpr double round_off = 1e-9;
  if (share > 1 - round_off)
    return mesh.displacement;
  const auto of_rest = rest(share == 0);
  if (of_rest)
    return share * mesh.displacement + (1 - share) * *of_rest;
  return share > 0 ? std::optional(mesh.displacement) : std::nullopt;
}
} // namespace

template <int dim>
TestMachine<dim>::TestMachine(const CoupledBody<dim> &body)
{
  double largest = 0;
  look_for_jump(body);
  if (jump_axis_ >= 0)
    return;
  for (std::size_t l = 0; l < body.loads.size() && load_ < 0; ++l)
    for (int c = 0; c < dim && body.loads[l].boundary >= 0; ++c)
      if (body.loads[l].value[c] && std::abs(*body.loads[l].value[c]) > largest) {
        largest = std::abs(*body.loads[l].value[c]);
        load_ = int(l);
        component_ = c;
      }
  for (std::size_t l = 0; l < body.loads.size() && load_ < 0; ++l)
    if (body.loads[l].pressure && body.loads[l].boundary < 2 * dim) {
      load_ = int(l);
      component_ = body.loads[l].boundary / 2;
    }
  if (load_ < 0) {
    look_for_tool(body);
    return;
  }
  is_answer_ = body.loads[load_].kind != core::BoundaryLoad<dim>::Kind::traction;
  const int boundary = body.loads[load_].boundary;
  is_named_ = boundary > inner_surface<dim>;
  axis_ = is_named_ ? component_ : boundary / 2;
  const auto is_upper = [&](std::size_t l) {
    return body.load_places[l].middle[axis_] > (body.lower[axis_] + body.upper[axis_]) / 2;
  };
  sign_ = (is_named_ ? is_upper(load_) : boundary % 2 == 1) ? 1 : -1;
  const Vector<dim> size = body.upper - body.lower;
  size_ = size[axis_];
  if (is_named_) {
    area_ = size.prod() / size_ * body.thickness;
    for (std::size_t l = 0; l < body.loads.size() && opposite_ < 0; ++l)
      if (body.loads[l].boundary >= 0 && is_upper(l) != is_upper(load_) &&
          body.loads[l].value[component_])
        opposite_ = int(l);
    return;
  }
  const auto &place = body.load_places[load_];
  // A point or a line has no stress of its own.
  area_ = place.area > 1e-3 * place.side_area ? place.area : place.side_area;
}

// The first one that is not zero, before tractions.
template <int dim>
void TestMachine<dim>::look_for_jump(const CoupledBody<dim> &body)
{
  double largest = 0;
  for (std::size_t l = 0; l < body.loads.size() && load_ < 0; ++l) {
    const auto &load = body.loads[l];
    for (int c = 0; c < dim; ++c) {
      const double value = std::abs(load.value[c].value_or(0));
      if (load.boundary >= 0 && load.kind != core::BoundaryLoad<dim>::Kind::traction && value > 0)
        return; // a side moves
      if (load.jump_axis() >= 0 && value > largest) {
        largest = value;
        jump_axis_ = load.jump_axis();
        load_ = int(l);
        component_ = c;
      }
    }
  }
  if (load_ < 0)
    return;
  is_answer_ = true;
  const Vector<dim> size = body.upper - body.lower;
  axis_ = component_;
  size_ = size[jump_axis_];
  area_ = size.prod() / size_ * body.thickness;
}

// As if the tool were the side that it is nearer to.
template <int dim>
void TestMachine<dim>::look_for_tool(const CoupledBody<dim> &body)
{
  const int n = body.tools ? body.tools->size() : 0;
  for (int k = 0; k < n && tool_ < 0; ++k)
    if (const Vector<dim> way = body.tools->drive(k); way.cwiseAbs().maxCoeff() > 0) {
      tool_ = k;
      way.cwiseAbs().maxCoeff(&component_);
      axis_ = component_;
      is_answer_ = true;
      const double middle = (body.upper + body.lower)[axis_] / 2;
      sign_ = body.tools->place(k)[axis_] < middle ? -1 : 1;
      const Vector<dim> size = body.upper - body.lower;
      size_ = size[axis_];
      area_ = size.prod() / size_ * body.thickness;
    }
}

// The load that is read comes before others on its side.
template <int dim>
double TestMachine<dim>::side_displacement(const CoupledBody<dim> &body, int side,
                                           double time) const
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  const int boundary = 2 * axis_ + side;
  const auto moves = [&](const auto &load) {
    return load.boundary == boundary && load.value[component_] && load.kind != Kind::traction;
  };
  if (moves(body.loads[load_]))
    return body.loads[load_].displacement(component_, time);
  for (const auto &load : body.loads)
    if (moves(load))
      return load.displacement(component_, time);
  return mean_displacement(body, boundary, component_);
}

template <int dim>
double TestMachine<dim>::load_displacement(const CoupledBody<dim> &body, int load,
                                           double time) const
{
  const auto &l = body.loads[load];
  if (l.kind != core::BoundaryLoad<dim>::Kind::traction)
    return l.displacement(component_, time);
  const MeshReading mesh = mesh_displacement(body, l.boundary, l.part, component_);
  if (!body.zone)
    return mesh.displacement;
  return joint_displacement(mesh, body.load_places[load].area / body.thickness,
                            [&](bool) { return layer_displacement(body, load, component_); })
      .value_or(0);
}

/// Of the load on the other half. Where there is none the body is held elsewhere, at rest, or free:
/// then of its end there.
template <int dim>
double TestMachine<dim>::opposite_displacement(const CoupledBody<dim> &body, double time) const
{
  if (opposite_ >= 0)
    return load_displacement(body, opposite_, time);
  for (std::size_t l = 0; l < body.loads.size(); ++l) {
    const auto &load = body.loads[l];
    if (int(l) != load_ && load.boundary >= 0 && load.value[component_] &&
        load.kind != core::BoundaryLoad<dim>::Kind::traction)
      return load.displacement(component_, time);
  }
  return mean_displacement(body, 2 * axis_ + (sign_ < 0), component_);
}

template <int dim>
Reading TestMachine<dim>::read_jump(const CoupledBody<dim> &body, double time) const
{
  Reading r;
  if (body.force())
    r.load += body.force()->reaction(load_)[component_];
  if (body.far)
    r.load += body.far->reaction(load_)[component_];
  r.stress = r.load / area_;
  r.displacement = body.loads[load_].displacement(component_, time);
  r.strain = r.displacement / size_;
  return r;
}

template <int dim>
Reading TestMachine<dim>::read(const CoupledBody<dim> &body, double time) const
{
  Reading r;
  if (tool_ >= 0) {
    const ToolReading<dim> tool = body.tools->read(tool_);
    r.load = sign_ * tool.force[component_];
    r.stress = r.load / area_;
    r.displacement = sign_ * tool.displacement[component_];
    r.strain = r.displacement / size_;
  }
  if (load_ < 0)
    return r;
  if (jump_axis_ >= 0)
    return read_jump(body, time);
  if (body.force())
    r.load += sign_ * body.force()->reaction(load_)[component_];
  if (body.far)
    r.load += sign_ * body.far->reaction(load_)[component_];
  r.stress = r.load / area_;
  r.displacement =
      is_named_ ? sign_ * (load_displacement(body, load_, time) - opposite_displacement(body, time))
                : side_displacement(body, 1, time) - side_displacement(body, 0, time);
  r.strain = r.displacement / size_;
  return r;
}

template <int dim>
double mean_displacement(const CoupledBody<dim> &body, int boundary, int component)
{
  const MeshReading mesh = mesh_displacement(body, boundary, core::Part<dim>(), component);
  FarthestNodes nodes;
  if (mesh.area == 0) { // a tip or an edge, or particles have all of the side
    nodes = farthest_nodes(body, boundary, component);
    if (!body.zone || nodes.distance < side_depth * body.spacing)
      return nodes.displacement;
  }
  if (!body.zone)
    return mesh.displacement;
  const int axis = boundary / 2;
  return joint_displacement(mesh, body.side_areas[boundary] / body.thickness,
                            [&](bool has_all) {
                              return extrapolated_displacement(
                                  body, axis, boundary % 2 ? body.upper[axis] : body.lower[axis],
                                  component, has_all);
                            })
      .value_or(nodes.displacement);
}

template class TestMachine<2>;
template class TestMachine<3>;
template double mean_displacement(const CoupledBody<2> &, int, int);
template double mean_displacement(const CoupledBody<3> &, int, int);
} // namespace ligament::program
