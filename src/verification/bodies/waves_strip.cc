#include "src/verification/bodies/waves_strip.h"

#include "core/check.h"
#include "dem/many_body_force.h"
#include "packings/lattice.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ligament::program
{
template <int dim>
fem::Mesh<dim> make_periodic_mesh(const packings::Across<dim> &across, int layers, double size,
                                  double lower, int fine, double growth)
{
  constexpr int nc = fem::n_cell_nodes<dim>;
  fem::Mesh<dim> mesh;
  std::vector<double> border = {lower}, height;
  for (int i = 0; i < layers; ++i) {
    height.push_back(i == 0 || i < fine ? size : std::min(height.back() * growth, 2 * size));
    border.push_back(border.back() + height.back());
  }
  const int columns = across.columns();
  const auto index = [&](int i) { // of cell or node i: along each axis
    Eigen::Matrix<int, dim, 1> k;
    for (int c = 0; c < dim - 1; i /= across[c++])
      k[c] = i % across[c];
    k[dim - 1] = i;
    return k;
  };
  const auto place = [&](int i) {
    Vector<dim> x = size * index(i).template cast<double>();
    x[dim - 1] = border[index(i)[dim - 1]];
    return x;
  };
  for (int i = 0; i < columns * (layers + 1); ++i)
    mesh.nodes.push_back(place(i));
  for (int i = 0; i < columns * layers; ++i) {
    const auto k = index(i);
    std::array<int, nc> nodes;
    for (int a = 0; a < nc; ++a) {
      int node = 0;
      for (int c = dim - 1; c >= 0; --c) {
        const int n = c < dim - 1 ? across[c] : layers + 1;
        node = node * n + (k[c] + (a >> c & 1)) % n;
      }
      nodes[a] = node;
    }
    mesh.cells.push_back(nodes);
    mesh.cell_lower.push_back(place(i));
    mesh.cell_size.push_back(Vector<dim>::Constant(size));
    mesh.cell_size.back()[dim - 1] = height[k[dim - 1]];
    mesh.cell_level.push_back(0);
    if (k[dim - 1] == layers - 1)
      mesh.boundary_faces.push_back({i, 2 * dim - 1, 2 * dim - 1});
  }
  return mesh;
}

fem::Mesh<2> make_graded_mesh(int across, int fine, int coarse, double size, double lower)
{
  core::require(across % 2 == 0, "cells of twice the size need an even number of cells across");
  fem::Mesh<2> mesh = make_periodic_mesh<2>(across, fine, size, lower);
  mesh.boundary_faces.clear();
  const int top = across * fine, half = across / 2, first = mesh.n_nodes();
  const double step = lower + fine * size;
  for (int i = 1; i < across; i += 2)
    mesh.hanging.push_back({top + i, {{top + i - 1, 0.5}, {top + (i + 1) % across, 0.5}}});
  for (int k = 1; k <= coarse; ++k)
    for (int i = 0; i < half; ++i)
      mesh.nodes.push_back({2 * size * i, step + 2 * size * k});
  const auto node = [&](int i, int k) {
    return k == 0 ? top + 2 * (i % half) : first + (k - 1) * half + i % half;
  };
  for (int k = 0; k < coarse; ++k)
    for (int i = 0; i < half; ++i) {
      mesh.cells.push_back({node(i, k), node(i + 1, k), node(i, k + 1), node(i + 1, k + 1)});
      mesh.cell_lower.push_back({2 * size * i, step + 2 * size * k});
      mesh.cell_size.push_back(Vector<2>::Constant(2 * size));
      mesh.cell_level.push_back(1);
      if (k == coarse - 1)
        mesh.boundary_faces.push_back({mesh.n_cells() - 1, 3, 3});
    }
  return mesh;
}

namespace
{
template <int dim>
fem::Mesh<dim> strip_mesh(const StripParameters &p, int layers, double lower)
{
  if constexpr (dim == 2)
    if (p.fine_layers > 0 && p.growth == 1)
      return make_graded_mesh(p.cells_across, p.fine_layers, (layers - p.fine_layers) / 2,
                              p.cell_size, lower);
  return make_periodic_mesh<dim>(p.cells_across, layers, p.cell_size, lower, p.fine_layers,
                                 p.growth);
}
} // namespace

template <int dim>
LatticeBar<dim> lattice_bar(const StripParameters &p)
{
  // Height of a layer, and of a cell above its centre.
  const double layer = dim == 2 ? std::sqrt(3.) / 2 : std::sqrt(0.5);
  const double cell_top = dim == 2 ? 1 / std::sqrt(3.) : std::sqrt(0.5);
  LatticeBar<dim> bar;
  bar.layers = int(std::ceil((p.zone_length + double(p.overlap_cells * p.cell_size)) / layer));
  bar.edge = (bar.layers - 1 + p.mesh_shift) * layer + cell_top;
  return bar;
}

template <int dim>
Strip<dim> make_strip(const StripParameters &p)
{
  const auto bar = lattice_bar<dim>(p);
  return make_strip<dim>(p,
                         packings::make_periodic_packing<dim>(
                             bar.kind, p.cells_across * p.cell_size, bar.layers, false),
                         bar.edge);
}

template <int dim>
Strip<dim> make_strip(const StripParameters &p, packings::Packing<dim> packing, double edge,
                      double dt_limit)
{
  const double overlap_length = p.overlap_cells * p.cell_size;
  Strip<dim> strip;
  strip.mesh_begin = edge - overlap_length;
  particles::Particles<dim> state;
  packings::fill_particles(packing, p.material.density, state);
  strip.zone = std::make_unique<particles::ParticleSolver<dim>>(
      std::move(state),
      std::make_unique<dem::ManyBodyForce<dim>>(std::move(packing), p.material,
                                                std::vector<core::BoundaryLoad<dim>>()));

  fem::Body<dim> body;
  body.stiffness = p.material.template elastic_constants<dim>().stiffness;
  body.density = p.material.density;
  const int far_layers = int(std::ceil((p.far_length + overlap_length) / p.cell_size));
  strip.far =
      std::make_unique<fem::FemSolver<dim>>(strip_mesh<dim>(p, far_layers, strip.mesh_begin), body,
                                            std::vector<core::BoundaryLoad<dim>>());

  coupling::OverlapParameters<dim> overlap;
  auto &zone = overlap.zone.boxes.emplace_back();
  zone.upper = Vector<dim>::Constant(std::numeric_limits<double>::infinity());
  zone.lower = -zone.upper;
  zone.upper[dim - 1] = edge;
  overlap.length = overlap_length;
  overlap.spacing = 1;
  overlap.transition_cells = p.transition_cells;
  for (int c = 0; c < dim - 1; ++c)
    overlap.period[c] = p.cells_across * p.cell_size;
  strip.timers = std::make_unique<core::Timers>();
  auto bodies = strip.bodies();
  if (coupling::is_energy_weighted(p.scheme)) {
    overlap.shape = p.weight;
    auto bridging = p.bridging;
    bridging.scheme = p.scheme;
    strip.coupler =
        std::make_unique<coupling::BridgingDomain<dim>>(bodies, overlap, bridging, *strip.timers);
  }
  strip.dt_stable = strip.zone->force->stable_step(strip.zone->state);
  strip.dt = p.step_fraction * std::min(strip.dt_stable, dt_limit);
  if (!strip.coupler)
    strip.coupler = std::make_unique<coupling::FineScaleSplit<dim>>(bodies, overlap, p.split,
                                                                    strip.dt, *strip.timers);
  return strip;
}

template LatticeBar<2> lattice_bar<2>(const StripParameters &);
template LatticeBar<3> lattice_bar<3>(const StripParameters &);
template Strip<2> make_strip<2>(const StripParameters &);
template Strip<3> make_strip<3>(const StripParameters &);
template Strip<2> make_strip<2>(const StripParameters &, packings::Packing<2>, double, double);
template Strip<3> make_strip<3>(const StripParameters &, packings::Packing<3>, double, double);
} // namespace ligament::program
