#include "src/simulation/test_machine.h"

#include "core/exact_sum.h"
#include "fem/cell_map.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ligament::program
{
namespace
{
// Particles that tell the motion of a side lie so many spacings inside it at most.
constexpr double side_depth = 2.5;

/// Particles lie inside a side, so a motion that is affine in the place is fitted to those near it
/// that the far field does not move, which is exact for homogeneous strain and rotation on any
/// packing. Of the middle of the side, or of that of these particles; none where there are too few.
template <int dim>
std::optional<double> extrapolated_displacement(const CoupledBody<dim> &body, int axis,
                                                double place, int component, bool of_side)
{
  using Row = Eigen::Matrix<double, dim + 1, 1>; // place from the middle of the side, and 1
  constexpr int n = dim + 1;
  std::vector<core::ExactSum> sums(n * n + n); // of the matrix, then of the right side
  const auto &state = body.zone->state;
  const Vector<dim> middle = (body.upper + body.lower) / 2;
  const auto *overlap = body.coupler->overlap();
  particles::for_each(state.part.owned, [&](int i) {
    const double depth = std::abs(state.reference[axis][i] - place) / body.spacing;
    if (depth > side_depth || (overlap && overlap->member_of_particle[i] >= 0))
      return;
    Row row = Row::Ones();
    for (int c = 0; c < dim; ++c)
      row[c] = (state.reference[c][i] - middle[c]) / body.spacing;
    row[axis] = depth;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b <= a; ++b)
        sums[a * n + b].add(row[a] * row[b]);
      sums[n * n + a].add(state.displacement[component][i] * row[a]);
    }
  });
  sums = body.ranks.sum(sums);
  Eigen::Matrix<double, dim + 1, dim + 1> matrix;
  Row right;
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b <= a; ++b)
      matrix(a, b) = matrix(b, a) = sums[a * n + b].value();
    right[a] = sums[n * n + a].value();
  }
  if (body.far && matrix(dim, dim) < 2 * n)
    return std::nullopt;
  const Row fit = matrix.ldlt().solve(right);
  Row at = Row::Unit(dim);
  if (!of_side)
    at = matrix.col(dim) / matrix(dim, dim);
  at[axis] = 0;
  return fit.dot(at);
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
    return body.load_places[l][axis_] > (body.lower[axis_] + body.upper[axis_]) / 2;
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
  const auto side = core::side_corners<dim>(body.lower, body.upper, body.loads[load_].boundary);
  area_ = size.prod() / size_ * body.thickness;
  if (body.loads[load_].part.is_whole())
    return;
  const double part =
      core::face_area<dim>(body.loads[load_].part.clip(side)) * (dim == 2 ? body.thickness : 1);
  if (part > 1e-3 * area_) // else a point or a line, which has no stress of its own
    area_ = part;
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

template <int dim>
double TestMachine<dim>::side_displacement(const CoupledBody<dim> &body, int side,
                                           double time) const
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  const int boundary = 2 * axis_ + side;
  for (const auto &load : body.loads)
    if (load.boundary == boundary && load.value[component_] && load.kind != Kind::traction)
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
  return body.far ? mean_displacement(body, l.boundary, component_) : 0;
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
  r.displacement = is_named_
                       ? sign_ * (load_displacement(body, load_, time) -
                                  (opposite_ < 0 ? 0 : load_displacement(body, opposite_, time)))
                       : side_displacement(body, 1, time) - side_displacement(body, 0, time);
  r.strain = r.displacement / size_;
  return r;
}

template <int dim>
double mean_displacement(const CoupledBody<dim> &body, int boundary, int component)
{
  const auto of_particles = [&](bool of_side) {
    const int axis = boundary / 2;
    return extrapolated_displacement(body, axis, boundary % 2 ? body.upper[axis] : body.lower[axis],
                                     component, of_side);
  };
  if (!body.far)
    return of_particles(true).value_or(0);
  double sum = 0, area = 0;
  const auto &mesh = body.far->mesh();
  for (const auto &face : mesh.boundary_faces)
    if (face.boundary == boundary) {
      if (!mesh.is_box(face.cell)) {
        const auto shares = fem::face_shares<dim>(fem::cell_corners(mesh, face.cell), face.face);
        for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
          sum += shares[a] * body.far->displacement[component][mesh.cells[face.cell][a]];
        area += shares.sum();
        continue;
      }
      const int axis = face.face / 2;
      const Vector<dim> &h = mesh.cell_size[face.cell];
      const double share = h.prod() / h[axis];
      area += share;
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
        if (((a >> axis) & 1) == face.face % 2)
          sum += share / (fem::n_cell_nodes<dim> / 2) *
                 body.far->displacement[component][mesh.cells[face.cell][a]];
    }
  const double of_mesh = area > 0 ? sum / area : 0;
  if (!body.zone || boundary >= 2 * dim)
    return of_mesh;
  const Vector<dim> size = body.upper - body.lower;
  const double share = std::min(area * size[boundary / 2] / size.prod(), 1.);
  constexpr double round_off = 1e-9;
  if (share > 1 - round_off)
    return of_mesh;
  const auto of_others = of_particles(share == 0);
  return of_others ? share * of_mesh + (1 - share) * *of_others : of_mesh;
}

template class TestMachine<2>;
template class TestMachine<3>;
template double mean_displacement(const CoupledBody<2> &, int, int);
template double mean_displacement(const CoupledBody<3> &, int, int);
} // namespace ligament::program
