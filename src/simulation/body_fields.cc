#include "src/simulation/body_fields.h"

#include <cmath>

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
} // namespace

template <int dim>
ParticleFields particle_fields(const CoupledBody<dim> &body)
{
  ParticleFields fields;
  if (!body.zone)
    return fields;
  const auto &state = body.zone->state;
  fields.reference = interleave(state.reference);
  fields.fields.push_back(
      {"displacement", "m", Field::Kind::vector, interleave(state.displacement)});
  fields.fields.push_back({"velocity", "m/s", Field::Kind::vector, interleave(state.velocity)});
  Components<n_strains<dim>> stress;
  body.force->stresses(state, stress);
  if (const auto *overlap = body.coupler->overlap()) // pads lack neighbours, their own tensor is
                                                     // not complete: they show the mesh's
  {
    for (const auto &m : overlap->members)
      if (m.pad) {
        Vec<dim * fem::n_cell_nodes<dim>> u;
        for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
          u.template segment<dim>(a * dim) =
              get(body.far->displacement, overlap->near_nodes[m.nodes[a]]);
        const Strain<dim> strain = fem::strain_matrix<dim>(m.gradient) * u;
        set(stress, m.particle, Strain<dim>(body.far->body().stiffness * strain));
      }
  }
  std::vector<double> tensor(6 * state.n_owned);
  for (int i = 0; i < state.n_owned; ++i)
    put_tensor<dim>(get(stress, i), body, &tensor[6 * i]);
  fields.fields.push_back({"stress", "Pa", Field::Kind::tensor, std::move(tensor)});
  return fields;
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
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    const Vector<dim> &lower = mesh.cell_lower[cell], &size = mesh.cell_size[cell];
    const auto b =
        fem::strain_matrix<dim>(fem::shape_gradients<dim>(lower, size, lower + size / 2));
    Vec<dim * nc> u;
    for (int a = 0; a < nc; ++a) {
      fields.connectivity.push_back(mesh.cells[cell][ring[a]]);
      u.template segment<dim>(a * dim) = get(body.far->displacement, mesh.cells[cell][a]);
    }
    double stress[6];
    put_tensor<dim>(body.far->body().stiffness * (b * u), body, stress);
    for (const int node : mesh.cells[cell]) {
      count[node] += 1;
      for (int k = 0; k < 6; ++k)
        tensor[6 * node + k] += stress[k];
    }
  }
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int k = 0; k < 6; ++k)
      tensor[6 * i + k] /= count[i];
  fields.node_fields.push_back(
      {"displacement", "m", Field::Kind::vector, interleave(body.far->displacement)});
  fields.node_fields.push_back(
      {"velocity", "m/s", Field::Kind::vector, interleave(body.far->velocity)});
  fields.node_fields.push_back({"stress", "Pa", Field::Kind::tensor, std::move(tensor)});
  return fields;
}

template <int dim>
Snapshot snapshot(const CoupledBody<dim> &body, double time, const Components<dim> &displacement,
                  const Components<dim> &velocity)
{
  Snapshot s;
  s.dimension = dim;
  s.time = time;
  s.spacing = body.spacing;
  if (!body.zone)
    return s;
  const auto &state = body.zone->state;
  s.global_id = state.global_id.list();
  for (int i = 0; i < state.n_owned; ++i)
    for (int c = 0; c < dim; ++c) {
      s.reference.push_back(state.reference[c][i]);
      s.displacement.push_back(displacement[c][i]);
      s.velocity.push_back(velocity[c][i]);
    }
  return s;
}

template <int dim>
std::vector<BrokenBond> broken_bonds(const CoupledBody<dim> &body)
{
  std::vector<BrokenBond> bonds;
  if (!body.force)
    return bonds;
  for (const auto &broken : body.force->broken_bonds()) {
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
double crack_length(const CoupledBody<dim> &body, int axis)
{
  double sum = 0;
  if (body.force)
    for (const auto &broken : body.force->broken_bonds())
      sum += broken.area * std::abs(broken.normal[axis]);
  return sum / body.thickness;
}

template ParticleFields particle_fields(const CoupledBody<2> &);
template ParticleFields particle_fields(const CoupledBody<3> &);
template CellFields cell_fields(const CoupledBody<2> &);
template CellFields cell_fields(const CoupledBody<3> &);
template Snapshot snapshot<2>(const CoupledBody<2> &, double, const Components<2> &,
                              const Components<2> &);
template Snapshot snapshot<3>(const CoupledBody<3> &, double, const Components<3> &,
                              const Components<3> &);
template std::vector<BrokenBond> broken_bonds(const CoupledBody<2> &);
template std::vector<BrokenBond> broken_bonds(const CoupledBody<3> &);
template double crack_length(const CoupledBody<2> &, int);
template double crack_length(const CoupledBody<3> &, int);
} // namespace ligament::program
