#include "coupling/overlap.h"

#include "core/check.h"
#include "fem/cell_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::coupling
{
namespace
{
// Cells hardly larger than particles are as fast as these; less of their mass is consistent, which
// slows them down (theory.md eq. (C6)).
constexpr double fine_cell = 2.5; // h/d
constexpr double fine_cell_share = 0.75;

/// Last layer of consistent mass, 0 as a rule. A step to larger cells inside the transition
/// reflects least where the mass is consistent on both its sides, one cell beyond included. Where
/// that would leave less than half of the transition to pass to lumped mass, the step is left as it
/// is.
template <int dim>
int last_consistent_layer(const fem::Mesh<dim> &mesh, const std::vector<int> &layer,
                          int transition_cells)
{
  int coarsest = 0, last_before_step = 0;
  for (int c = 0; c < mesh.n_cells(); ++c)
    if (layer[c] >= 0)
      coarsest = std::max(coarsest, mesh.cell_level[c]);
  for (int c = 0; c < mesh.n_cells(); ++c)
    if (layer[c] >= 0 && mesh.cell_level[c] < coarsest)
      last_before_step = std::max(last_before_step, layer[c]);
  const int last = last_before_step + 2;
  return last_before_step > 0 && 2 * last <= transition_cells ? last : 0;
}

/// The operators of the overlap and its transition are those of axis-parallel cells.
template <int dim>
void require_boxes(const fem::Mesh<dim> &mesh, const std::vector<int> &layer)
{
  int nearest = -1;
  for (int c = 0; c < mesh.n_cells(); ++c)
    if (layer[c] >= 0 && !mesh.is_box(c) && (nearest < 0 || layer[c] < layer[nearest]))
      nearest = c;
  if (nearest < 0)
    return;
  throw core::InputError(fmt::format(
      "the {} reaches the cell of the far field at {}: it follows a curved or inclined side; keep "
      "the zone away from such sides, or lower /coupling/transition_cells",
      layer[nearest] == 0 ? "overlap" : "transition beside the overlap",
      fem::place_text(mesh, nearest)));
}
} // namespace

template <int dim>
Overlap<dim>::Overlap(const particles::Particles<dim> &particles,
                      const particles::ParticleForce<dim> &force, const fem::Mesh<dim> &mesh,
                      const OverlapParameters<dim> &parameters)
    : mesh(mesh), parameters(parameters)
{
  core::require(!parameters.zone.boxes.empty(), "the discrete zone has no coupled side");
  find_members(particles, force);
  find_cells();
  place_members(particles);
}

template <int dim>
double Overlap<dim>::distance_to_edge(const Vector<dim> &x) const
{
  return parameters.zone.distance(x);
}

template <int dim>
double Overlap<dim>::position(const Vector<dim> &x) const
{
  const double s = (distance_to_edge(x) - depth) / (parameters.length - depth - margin);
  return std::clamp(s, 0., 1.);
}

template <int dim>
double Overlap<dim>::weight(const Vector<dim> &x) const
{
  const double s = position(x);
  switch (parameters.shape) {
  case WeightShape::linear:
    return s;
  case WeightShape::cosine:
    return (1 - std::cos(M_PI * s)) / 2;
  case WeightShape::constant:
    return s <= 0 ? 0 : s < 1 ? 0.5 : 1; // no particle lies beyond s = 0
  case WeightShape::cubic:
    break;
  }
  return s * s * (3 - 2 * s);
}

template <int dim>
Vector<dim> Overlap<dim>::offset(const Vector<dim> &from, const Vector<dim> &to) const
{
  Vector<dim> x = to - from;
  for (int c = 0; c < dim; ++c)
    if (const double period = parameters.period[c]; period > 0)
      x[c] -= period * std::round(x[c] / period);
  return x;
}

template <int dim>
double Overlap<dim>::subtracted_share(const Vector<dim> &location,
                                      const std::vector<int> &particles) const
{
  bool pad = false;
  for (const int i : particles) {
    const int m = member_of_particle[i];
    if (m < 0)
      return 0;
    pad |= members[m].pad;
  }
  return pad ? 1 : 1 - weight(location);
}

template <int dim>
std::vector<int> Overlap<dim>::member_particles() const
{
  std::vector<int> particles;
  for (const Member &m : members)
    particles.push_back(m.particle);
  return particles;
}

template <int dim>
void Overlap<dim>::find_members(const particles::Particles<dim> &particles,
                                const particles::ParticleForce<dim> &force)
{
  const fem::CellLocator<dim> locator(mesh);
  member_of_particle.assign(particles.size(), -1);
  for (int i = 0; i < particles.size(); ++i) {
    const int cell = locator.find(get(particles.reference, i));
    if (cell < 0)
      continue;
    member_of_particle[i] = int(members.size());
    Member &m = members.emplace_back(); // the rest with its cell, in find_cells
    m.particle = i;
    m.pad = m.open = false;
    m.cell = cell; // of the mesh until then
  }
  core::require(!members.empty(), "no particle lies in the mesh: the zones do not overlap");
  margin = force.range() > 0 ? force.range() : parameters.spacing;
  const std::vector<char> open = find_edge(particles, force);
  for (std::size_t k = 0; k < members.size(); ++k)
    members[k].open = open[k];
  for (const int i : edge)
    if (parameters.has_pads) {
      const int k = member_of_particle[i];
      core::require(k >= 0,
                    fmt::format("particle {} at the coupled edge of the packing lies outside the "
                                "mesh: the overlap is too thin or the zone is not closed by the "
                                "specimen's surface; widen /coupling/overlap_cells",
                                i));
      members[k].pad = true;
    }
  if (!parameters.has_pads)
    depth = std::numeric_limits<double>::max();
  for (const Member &m : members) {
    const double distance = distance_to_edge(get(particles.reference, m.particle));
    if (m.pad)
      depth = std::max(depth, distance);
    else if (!parameters.has_pads)
      depth = std::min(depth, distance - parameters.spacing / 2);
  }
  require_width(force.range());
  for (int c = 0; c < dim; ++c)
    core::require(
        parameters.period[c] == 0 || parameters.period[c] > 2 * force.range(),
        fmt::format("the body repeats itself after {:.3g} m, within twice the range of the "
                    "force, {:.3g} m: the overlap sees the nearest image of a particle "
                    "alone; make the specimen wider there",
                    parameters.period[c], force.range()));
}

// Weights need room to rise between the pads and the margin: two spacings where particles see
// their neighbours only, two cells where pads and margin are as thick as the force reaches.
template <int dim>
void Overlap<dim>::require_width(double range) const
{
  double cell = std::numeric_limits<double>::max(); // smallest edge
  for (const Member &m : members)
    cell = std::min(cell, mesh.cell_size[m.cell].minCoeff());
  const double least = depth + margin + 2 * (range > 0 ? cell : parameters.spacing);
  if (parameters.length > least)
    return;
  const std::string reach =
      range > 0 ? fmt::format(", the range of the force {:.3g} m and the weights two cells", range)
                : "";
  throw core::InputError(
      fmt::format("the overlap is {:.3g} m wide, but the particles that close the packing "
                  "need {:.3g} m of it{}, {:.3g} m in all: raise /coupling/overlap_cells to {} or "
                  "/far_field/cell_size",
                  parameters.length, depth, reach, least, int(std::floor(least / cell)) + 1));
}

// The edge are the open members and their neighbours. It lies in the mesh, so nobody else is asked:
// nothing is missing elsewhere.
template <int dim>
std::vector<char> Overlap<dim>::find_edge(const particles::Particles<dim> &particles,
                                          const particles::ParticleForce<dim> &force)
{
  const std::vector<int> open = force.open_particles(particles, member_particles());
  std::vector<char> is_open(members.size(), 0);
  for (const int i : open)
    is_open[member_of_particle[i]] = 1;
  require_closed_surface(particles, force.range(), open);
  edge = open;
  force.for_each_neighbour(
      particles, [&](const particles::Neighbour &n) { edge.push_back(n.j); }, &open);
  std::sort(edge.begin(), edge.end());
  edge.erase(std::unique(edge.begin(), edge.end()), edge.end());
  return is_open;
}

// What a force with a range misses farther from the coupled edge than it reaches lies beyond a
// surface of the body. Such surfaces have a stress of their own, of which the mesh knows nothing.
template <int dim>
void Overlap<dim>::require_closed_surface(const particles::Particles<dim> &particles, double range,
                                          const std::vector<int> &open) const
{
  if (range == 0)
    return;
  for (const int i : open)
    core::require(
        distance_to_edge(get(particles.reference, i)) <= range + parameters.spacing,
        fmt::format("the overlap reaches a free surface of the body at particle {}, where "
                    "a force with a range can't end yet; keep coupled sides of the zone "
                    "inside the specimen",
                    i));
}

// Layer 0: cells that reach into the packing's side of the edge. Each further layer: the cells
// that share a free node with the layer before.
template <int dim>
void Overlap<dim>::find_cells()
{
  const fem::CellCondenser<dim> condense(mesh);
  auto free_nodes = mesh.cells;
  for (int c = 0; c < mesh.n_cells(); ++c)
    if (condense.hangs(c))
      free_nodes[c] = condense(c).nodes;
  std::vector<int> layer(mesh.n_cells(), -1);
  std::vector<int> node_layer(mesh.n_nodes(), -1);
  const auto take = [&](int cell, int l) {
    layer[cell] = l;
    for (const int node : free_nodes[cell])
      if (node_layer[node] < 0)
        node_layer[node] = l;
  };
  for (int c = 0; c < mesh.n_cells(); ++c) {
    const Vector<dim> &lower = mesh.cell_lower[c], &size = mesh.cell_size[c];
    if (parameters.zone.meets(lower, lower + size, 1e-8 * size.minCoeff()))
      take(c, 0);
  }
  for (int l = 1; l <= parameters.transition_cells; ++l) {
    const std::vector<int> before = node_layer;
    for (int c = 0; c < mesh.n_cells(); ++c)
      if (layer[c] < 0 && std::any_of(free_nodes[c].begin(), free_nodes[c].end(),
                                      [&](int node) { return before[node] == l - 1; }))
        take(c, l);
  }

  require_boxes(mesh, layer);

  std::vector<int> near(mesh.n_nodes(), -1), near_cell(mesh.n_cells(), -1);
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (node_layer[node] >= 0) {
      near[node] = int(near_nodes.size());
      near_nodes.push_back(node);
      is_overlap_node.push_back(node_layer[node] == 0);
    }
  cell_size = std::numeric_limits<double>::max();
  const int carried = last_consistent_layer(mesh, layer, parameters.transition_cells);
  for (int c = 0; c < mesh.n_cells(); ++c)
    if (layer[c] >= 0) {
      Cell cell;
      cell.cell = c;
      cell.layer = layer[c];
      cell.size = mesh.cell_size[c].minCoeff();
      const bool is_fine = cell.size < fine_cell * parameters.spacing;
      cell.consistent_share =
          parameters.lumps_mass
              ? 0.
              : std::min(is_fine ? fine_cell_share : 1.,
                         layer[c] <= carried ? 1.
                                             : 1 - (layer[c] - carried - 0.5) /
                                                       (parameters.transition_cells - carried));
      cell.shape = condense(c);
      for (int a = 0; a < n_cell_nodes; ++a)
        cell.nodes[a] = near[cell.shape.nodes[a]];
      if (layer[c] == 0)
        cell_size = std::min(cell_size, cell.size);
      near_cell[c] = int(cells.size());
      cells.push_back(cell);
    }
  for (auto &m : members) {
    core::require(layer[m.cell] == 0, "a particle lies in the mesh beyond the edge of the packing");
    m.cell = near_cell[m.cell];
  }
}

template <int dim>
void Overlap<dim>::place_members(const particles::Particles<dim> &particles)
{
  for (auto &m : members) {
    const Vector<dim> x = get(particles.reference, m.particle);
    m.position = position(x);
    m.weight = weight(x);
    m.nodes = cells[m.cell].nodes;
    m.value = shape_values(cells[m.cell], x);
    m.gradient = shape_gradients(cells[m.cell], x);
  }
}

template <int dim>
Vec<fem::n_cell_nodes<dim>> Overlap<dim>::shape_values(const Cell &cell, const Vector<dim> &x) const
{
  return cell.shape.shares.transpose() *
         fem::shape_values<dim>(mesh.cell_lower[cell.cell], mesh.cell_size[cell.cell], x);
}

template <int dim>
Eigen::Matrix<double, dim, fem::n_cell_nodes<dim>>
Overlap<dim>::shape_gradients(const Cell &cell, const Vector<dim> &x) const
{
  return fem::shape_gradients<dim>(mesh.cell_lower[cell.cell], mesh.cell_size[cell.cell], x) *
         cell.shape.shares;
}

template <int dim>
particles::CoupledEdge<dim> Overlap<dim>::coupled_edge(const Components<dim> &displacement) const
{
  particles::CoupledEdge<dim> coupled{edge, {}, {}, {}};
  std::vector<int> open; // members
  for (const Member &member : members)
    coupled.members.push_back(member.particle);
  for (std::size_t k = 0; k < members.size(); ++k)
    if (members[k].open) {
      open.push_back(int(k));
      coupled.open.push_back(members[k].particle);
    }
  coupled.gradient = [this, &displacement, open = std::move(open)](int k) {
    const Member &m = members[open[k]];
    Eigen::Matrix<double, dim, dim> gradient = Eigen::Matrix<double, dim, dim>::Zero();
    for (int a = 0; a < n_cell_nodes; ++a)
      gradient += get(displacement, near_nodes[m.nodes[a]]) * m.gradient.col(a).transpose();
    return gradient;
  };
  return coupled;
}

template class Overlap<2>;
template class Overlap<3>;
} // namespace ligament::coupling
