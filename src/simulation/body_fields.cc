#include "src/simulation/body_fields.h"

#include "core/exact_sum.h"
#include "fem/cell_map.h"
#include "src/simulation/far_stress.h"
#include "src/simulation/kept_tables.h"
#include "src/simulation/whole_body.h"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>
#include <utility>

namespace ligament::program
{
namespace
{
/// x, y, z per item from component arrays.
template <std::size_t n>
std::vector<double> interleave(const std::array<std::vector<double>, n> &components)
{
  std::vector<double> values(3 * components[0].size(), 0.);
  for (std::size_t c = 0; c < n; ++c)
    for (std::size_t i = 0; i < components[c].size(); ++i)
      values[3 * i + c] = components[c][i];
  return values;
}

/// Voigt (in-plane in 2D) to xx, yy, zz, xy, yz, xz; zz from the plane mode.
template <int dim>
void put_tensor(const Strain<dim> &s, const CoupledBody<dim> &body, double *out)
{
  if constexpr (dim == 2) {
    const double zz = body.plane == PlaneMode::strain ? body.poissons_ratio * (s[0] + s[1]) : 0;
    const double t[6] = {s[0], s[1], zz, s[2], 0, 0};
    std::copy(t, t + 6, out);
  } else {
    const double t[6] = {s[0], s[1], s[2], s[5], s[3], s[4]};
    std::copy(t, t + 6, out);
  }
}
template <int dim>
void add_flow(const particles::ParticleForce<dim> &force, const particles::Particles<dim> &state,
              std::vector<Field> &fields)
{
  std::vector<double> accumulated(state.size()), strain;
  for (int i = 0; i < state.size(); ++i) {
    accumulated[i] = force.plastic_strain(i);
    const auto e = force.inelastic_strain(state, i);
    strain.insert(strain.end(), e.begin(), e.end());
  }
  fields.push_back(make_field("plastic_strain", std::move(accumulated)));
  fields.push_back(make_field("inelastic_strain", std::move(strain)));
}

/// Of the particles at hand.
template <int dim>
ParticleFields fields_at_hand(const CoupledBody<dim> &body)
{
  ParticleFields fields;
  const auto &state = body.zone->state;
  fields.reference = interleave(state.reference);
  fields.fields.push_back(make_field("displacement", interleave(state.displacement)));
  fields.fields.push_back(make_field("velocity", interleave(state.velocity)));
  Components<n_strains<dim>> stress;
  body.force()->stresses(state, stress);
  std::vector<double> tensor(6 * state.size()), out_of_plane;
  for (std::size_t i = 0; i < stress[0].size(); ++i) // guests have none
    put_tensor<dim>(get(stress, i), body, &tensor[6 * i]);
  body.force()->stresses_out_of_plane(state, out_of_plane);
  for (std::size_t i = 0; i < out_of_plane.size(); ++i)
    tensor[6 * i + 2] = out_of_plane[i];
  fields.fields.push_back(make_field("stress", std::move(tensor)));
  fields.symbols = body.force()->symbols();
  for (auto &own : body.force()->own_fields(state))
    fields.fields.push_back(make_field(own.name, std::move(own.values)));
  if (body.force()->can_flow())
    add_flow(*body.force(), state, fields.fields);
  if (body.force()->softens()) {
    std::vector<double> share, opening;
    body.force()->softening(state, share, opening);
    fields.fields.push_back(make_field("softened", std::move(share)));
    fields.fields.push_back(make_field("opening", std::move(opening)));
  }
  return fields;
}
} // namespace

template <int dim>
ParticleFields particle_fields(const CoupledBody<dim> &body)
{
  if (!body.zone)
    return {};
  ParticleFields fields = fields_at_hand(body);
  fields.reference = owned(*body.zone, std::move(fields.reference), 3);
  for (Field &field : fields.fields)
    field.values = owned(*body.zone, std::move(field.values), field.n_components());
  return fields;
}

template <int dim>
void gather_at_first(const CoupledBody<dim> &body, BodyState &state)
{
  if (body.ranks.is_one() || !body.zone)
    return;
  const auto gather = [&](std::vector<double> &values) {
    values = body.ranks.gather_at_first(values);
  };
  gather(state.particles.reference);
  for (Field &field : state.particles.fields)
    gather(field.values);
}

template <int dim>
CellFields cell_fields(const CoupledBody<dim> &body)
{
  CellFields fields;
  fields.dimension = dim;
  if (!body.far)
    return fields;
  const auto &mesh = body.far->mesh();
  constexpr int nc = fem::n_cell_nodes<dim>;
  // Lexicographic corners to the ring order of VTK.
  const std::array<int, 8> ring = {0, 1, 3, 2, 4, 5, 7, 6};
  fields.reference.assign(3 * mesh.n_nodes(), 0.);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int c = 0; c < dim; ++c)
      fields.reference[3 * i + c] = mesh.nodes[i][c];
  std::vector<double> tensor(6 * mesh.n_nodes(), 0.), count(mesh.n_nodes(), 0.);
  const FarStress<dim> far_stress(body);
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto gradients = fem::centre_gradients(mesh, cell);
    Eigen::Matrix<double, dim, dim> gradient = Eigen::Matrix<double, dim, dim>::Zero();
    for (int a = 0; a < nc; ++a) {
      fields.connectivity.push_back(mesh.cells[cell][ring[a]]);
      gradient += get(body.far->displacement, mesh.cells[cell][a]) * gradients.col(a).transpose();
    }
    double stress[6];
    put_tensor<dim>(far_stress(gradient), body, stress);
    for (const int node : mesh.cells[cell]) {
      count[node] += 1;
      for (int k = 0; k < 6; ++k)
        tensor[6 * node + k] += stress[k];
    }
  }
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int k = 0; k < 6; ++k)
      tensor[6 * i + k] /= count[i];
  fields.node_fields.push_back(make_field("displacement", interleave(body.far->displacement)));
  fields.node_fields.push_back(make_field("velocity", interleave(body.far->velocity)));
  fields.node_fields.push_back(make_field("stress", std::move(tensor)));
  return fields;
}

namespace
{
/// Broken and cut faces of every particle that has any, by global id.
std::unordered_map<std::int64_t, int> open_faces(const std::vector<BrokenBond> &broken,
                                                 const std::vector<BrokenBond> &cut)
{
  std::unordered_map<std::int64_t, int> count;
  for (const auto *bonds : {&broken, &cut})
    for (const BrokenBond &bond : *bonds)
      for (const std::int64_t id : {bond.i, bond.j})
        ++count[id];
  return count;
}

template <int dim>
std::vector<double> radii(const CoupledBody<dim> &body, const std::vector<std::int64_t> &ids)
{
  std::vector<double> radius(ids.size(), body.spacing / 2);
  if (!body.seeds)
    return radius;
  std::unordered_map<std::int64_t, double> of_seed;
  for (int k = 0; k < body.seeds->size(); ++k)
    of_seed[body.seeds->id[k]] = body.seeds->radius[k];
  for (std::size_t i = 0; i < ids.size(); ++i)
    radius[i] = of_seed.at(ids[i]);
  return radius;
}

template <int dim>
std::vector<Field> constant_cell_fields(const CoupledBody<dim> &body)
{
  std::vector<double> zone(body.far->mesh().n_cells(), double(ZoneNumber::far));
  if (const auto *overlap = body.coupler->overlap())
    for (const auto &cell : overlap->cells)
      zone[cell.cell] = double(cell.layer == 0 ? ZoneNumber::overlap : ZoneNumber::transition);
  const std::vector<double> material(zone.size(), 0.);
  return {make_field("material", material), make_field("zone", std::move(zone))};
}
} // namespace

template <int dim>
void StateFields<dim>::look_at_what_stays(const CoupledBody<dim> &body)
{
  const auto &state = body.zone->state;
  n_faces_.assign(state.size(), 0);
  body.force()->for_each_face(state, [&](const auto &face) {
    if (face.bonded && !face.is_rebonded) // those are in the list of broken ones
      ++n_faces_[face.i];
  });
  for (const auto &broken : body.force()->broken_bonds())
    for (const int i : {broken.i, broken.j})
      ++n_faces_[i];
  auto cut = open_faces({}, body.cut_faces);
  for (int i = 0; i < state.size() && !cut.empty(); ++i)
    if (const auto found = cut.find(state.global_id[i]); found != cut.end())
      n_faces_[i] += std::uint8_t(found->second);
  material_.resize(state.size());
  for (int i = 0; i < state.size(); ++i)
    material_[i] = body.force()->material(i);
  zone_.assign(state.size(), double(ZoneNumber::discrete));
  if (const auto *overlap = body.coupler->overlap())
    for (const auto &m : overlap->members)
      zone_[m.particle] = double(m.pad ? ZoneNumber::pad : ZoneNumber::overlap);
  zone_ = owned(*body.zone, std::move(zone_));
  n_faces_ = owned(*body.zone, std::move(n_faces_));
  material_ = owned(*body.zone, std::move(material_));
  names_ = owned<dim, std::int64_t>(*body.zone, state.global_id.list());
}

template <int dim>
void StateFields<dim>::add_particle_fields(const CoupledBody<dim> &body, BodyState &state)
{
  const std::size_t n = names_.size();
  std::vector<double> share(n);
  const auto open = open_faces(state.bonds, body.cut_faces);
  for (std::size_t i = 0; i < n; ++i) {
    if (const auto found = open.find(names_[i]); found != open.end())
      share[i] = double(found->second) / std::max<int>(n_faces_[i], 1);
  }
  auto &fields = state.particles.fields;
  fields.push_back(make_field("radius", radii(body, names_)));
  fields.push_back(make_field("global_id", {names_.begin(), names_.end()}));
  fields.push_back(make_field("material", material_));
  fields.push_back(make_field("zone", zone_));
  fields.push_back(make_field("broken_bond_share", std::move(share)));
}

template <int dim>
void StateFields<dim>::complete(const CoupledBody<dim> &body, BodyState &state)
{
  for (auto *fields : {&state.particles.fields, &state.cells.node_fields})
    if (const Field *stress = find_field(*fields, "stress"))
      fields->push_back(make_field("equivalent_stress", equivalent_stress(stress->values)));
  if (body.zone && !std::exchange(has_looked_, true))
    look_at_what_stays(body);
  state.cuts = body.cut_faces;
  if (state.cells.n_cells() > 0)
    state.cells.cell_fields = constant_cell_fields(body);
  if (body.zone)
    add_particle_fields(body, state);
}

namespace
{
/// What of a segment lies in a box; false where nothing does.
template <int dim>
bool clip_to_box(const Vector<dim> &lower, const Vector<dim> &upper,
                 std::array<Vector<dim>, 2> &segment)
{
  const Vector<dim> start = segment[0], way = segment[1] - segment[0];
  double from = 0, to = 1;
  for (int c = 0; c < dim; ++c) {
    if (way[c] == 0 && (start[c] < lower[c] || start[c] > upper[c]))
      return false;
    if (way[c] == 0)
      continue;
    const double a = (lower[c] - start[c]) / way[c], b = (upper[c] - start[c]) / way[c];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  segment = {start + from * way, start + to * way};
  return from < to;
}

// Around the body, as a share of its longest edge: pictures show what of a tool lies there.
constexpr double shown_margin = 0.25;

/// As ToolOutline has it.
template <int dim>
std::vector<double> turn_of(const Eigen::Matrix<double, dim, dim> &rotation,
                            const Vector<dim> &centre)
{
  if (rotation.isIdentity(0))
    return {};
  const Vector<dim> moved = centre - rotation * centre;
  std::vector<double> turn;
  for (int row = 0; row < 3; ++row) {
    for (int c = 0; c < 3; ++c)
      turn.push_back(row < dim && c < dim ? rotation(row, c) : row == c);
    turn.push_back(row < dim ? moved[row] : 0);
  }
  return turn;
}

std::string turn_name(std::size_t tool, int number)
{
  return fmt::format("{}_turn_{}", tool, number);
}
} // namespace

template <int dim>
std::vector<ToolOutline> tool_outlines(const CoupledBody<dim> &body)
{
  std::vector<ToolOutline> outlines;
  for (int k = 0; body.tools && k < body.tools->size(); ++k) {
    ToolOutline outline = {};
    const double margin = shown_margin * (body.upper - body.lower).maxCoeff();
    for (auto edge : body.tools->edges(k)) {
      if (!clip_to_box<dim>(body.lower.array() - margin, body.upper.array() + margin, edge))
        continue;
      for (const Vector<dim> &end : edge)
        for (int c = 0; c < 3; ++c)
          outline.points.push_back(c < dim ? end[c] : 0);
    }
    const ToolReading<dim> now = body.tools->read(k);
    for (int c = 0; c < dim; ++c)
      outline.displacement[c] = now.displacement[c];
    outline.turn = turn_of<dim>(now.rotation, body.tools->place(k));
    outlines.push_back(std::move(outline));
  }
  return outlines;
}

template <int dim>
core::State save_fields(const BodyState &kept, BodyNames<dim> &names)
{
  core::State state;
  const auto save = [&](const std::string &table, const core::Names &rows, const auto &fields) {
    if (fields.empty())
      return;
    core::Table values(rows.sorted());
    for (const Field &field : fields)
      add_items(values, rows, field.name, field.n_components(), field.values);
    state.emplace(table, std::move(values));
  };
  save("particles", names.particles(), kept.particles.fields);
  save("nodes", names.nodes(), kept.cells.node_fields);
  for (std::size_t k = 0; k < kept.tools.size(); ++k) {
    for (int c = 0; c < 3; ++c)
      core::save_value(state, "tools", fmt::format("{}_displacement_{}", k, c),
                       kept.tools[k].displacement[c]);
    core::save_value(state, "tools", fmt::format("{}_gone", k),
                     std::int64_t(kept.tools[k].points.empty()));
    for (std::size_t number = 0; number < kept.tools[k].turn.size(); ++number)
      core::save_value(state, "tools", turn_name(k, int(number)), kept.tools[k].turn[number]);
  }
  return state;
}

template <int dim>
BodyState load_fields(const core::State &state, BodyNames<dim> &names, BodyState like)
{
  const auto load = [&](const std::string &table, const core::Names &rows, auto &fields) {
    for (Field &field : fields)
      field.values = items(core::table(state, table), rows, field.name, field.n_components());
  };
  load("particles", names.particles(), like.particles.fields);
  load("nodes", names.nodes(), like.cells.node_fields);
  for (std::size_t k = 0; k < like.tools.size(); ++k) {
    for (int c = 0; c < 3; ++c)
      like.tools[k].displacement[c] =
          core::load_real(state, "tools", fmt::format("{}_displacement_{}", k, c));
    if (core::load_integer(state, "tools", fmt::format("{}_gone", k)))
      like.tools[k].points.clear();
    like.tools[k].turn.clear();
    for (int number = 0; number < 12 && core::table(state, "tools").has(turn_name(k, number));
         ++number)
      like.tools[k].turn.push_back(core::load_real(state, "tools", turn_name(k, number)));
  }
  return like;
}

template <int dim>
Snapshot empty_snapshot(const CoupledBody<dim> &body)
{
  Snapshot s;
  s.dimension = dim;
  s.spacing = body.spacing;
  if (!body.zone)
    return s;
  s.global_id = names_at_first(*body.zone);
  const auto reference = at_first(*body.zone, body.zone->state.reference);
  for (std::size_t i = 0; i < s.global_id.size(); ++i)
    for (int c = 0; c < dim; ++c)
      s.reference.push_back(reference[c][i]);
  return s;
}

template <int dim>
std::vector<BrokenBond> broken_bonds(const CoupledBody<dim> &body)
{
  std::vector<BrokenBond> bonds;
  if (!body.force())
    return bonds;
  for (const auto &broken : body.force()->broken_bonds_of_body(body.zone->state)) {
    BrokenBond b = {};
    b.i = broken.global_i;
    b.j = broken.global_j;
    b.time = broken.time;
    for (int c = 0; c < dim; ++c) {
      b.centroid[c] = broken.position[c];
      b.normal[c] = broken.normal[c];
    }
    b.size = broken.area / body.thickness;
    b.energy = broken.energy;
    bonds.push_back(b);
  }
  return bonds;
}

template <int dim>
double crack_length(const CoupledBody<dim> &body)
{
  if (!body.force())
    return 0;
  std::vector<core::ExactSum> seen_along(dim);
  for (const auto &broken : body.force()->broken_bonds())
    if (body.zone->state.part.owns(broken.i)) // else another rank counts it
      for (int axis = 0; axis < dim; ++axis)
        seen_along[axis].add(broken.area * std::abs(broken.normal[axis]));
  double most = 0;
  for (const core::ExactSum &sum : body.ranks.sum(seen_along))
    most = std::max(most, sum.value());
  return most / body.thickness;
}

template ParticleFields particle_fields(const CoupledBody<2> &);
template ParticleFields particle_fields(const CoupledBody<3> &);
template void gather_at_first(const CoupledBody<2> &, BodyState &);
template void gather_at_first(const CoupledBody<3> &, BodyState &);
template CellFields cell_fields(const CoupledBody<2> &);
template CellFields cell_fields(const CoupledBody<3> &);
template std::vector<ToolOutline> tool_outlines(const CoupledBody<2> &);
template std::vector<ToolOutline> tool_outlines(const CoupledBody<3> &);
template core::State save_fields(const BodyState &, BodyNames<2> &);
template core::State save_fields(const BodyState &, BodyNames<3> &);
template BodyState load_fields(const core::State &, BodyNames<2> &, BodyState);
template BodyState load_fields(const core::State &, BodyNames<3> &, BodyState);
template class StateFields<2>;
template class StateFields<3>;
template Snapshot empty_snapshot(const CoupledBody<2> &);
template Snapshot empty_snapshot(const CoupledBody<3> &);
template std::vector<BrokenBond> broken_bonds(const CoupledBody<2> &);
template std::vector<BrokenBond> broken_bonds(const CoupledBody<3> &);
template double crack_length(const CoupledBody<2> &);
template double crack_length(const CoupledBody<3> &);
} // namespace ligament::program
