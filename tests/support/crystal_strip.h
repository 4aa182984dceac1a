// A strip of crystal that repeats itself sideways, with a mesh behind its upper end, and what comes
// back of a wave that leaves it.
#pragma once

#include "tests/support/crystal_bodies.h"

namespace ligament::tests
{
/// Cells of edge `size` from `lower` upwards, `across` of them sideways, where the mesh closes.
template <int dim>
fem::Mesh<dim> strip_mesh(int across, int layers, int size, double lower)
{
  fem::Mesh<dim> mesh;
  const int columns = dim == 2 ? across : across * across;
  const auto index = [&](int i) {
    std::array<int, dim> k;
    for (int c = 0; c < dim - 1; ++c, i /= across)
      k[c] = i % across;
    k[dim - 1] = i;
    return k;
  };
  const auto node = [&](std::array<int, dim> k) {
    int number = k[dim - 1];
    for (int c = dim - 2; c >= 0; --c)
      number = number * across + k[c] % across;
    return number;
  };
  const auto place = [&](int i) {
    Vector<dim> x;
    for (int c = 0; c < dim; ++c)
      x[c] = size * index(i)[c] + (c == dim - 1 ? lower : 0);
    return x;
  };
  for (int i = 0; i < columns * (layers + 1); ++i)
    mesh.nodes.push_back(place(i));
  for (int i = 0; i < columns * layers; ++i) {
    std::array<int, fem::n_cell_nodes<dim>> nodes;
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
      auto k = index(i);
      for (int c = 0; c < dim; ++c)
        k[c] += a >> c & 1;
      nodes[a] = node(k);
    }
    mesh.cells.push_back(nodes);
    mesh.cell_lower.push_back(place(i));
    mesh.cell_size.push_back(Vector<dim>::Constant(size));
    mesh.cell_level.push_back(0);
  }
  return mesh;
}

/// Hexagonal rows along x or FCC layers [001], rows [110], `length` m of them below the overlap. No
/// bond bears forces in the reference, as at an equilibrium of the free end.
template <int dim>
struct CrystalStrip
{
  static constexpr int across = 3, size = 4; // cells of the strip sideways, their edge

  CoupledBodies<dim> body;
  double mesh_begin = 0; // m, where the overlap begins

  /// length, far_length in m; the fine damper is c_f.
  CrystalStrip(CrystalParameters<dim> p, double length, double far_length, double fine_damper);

  const CrystalForce<dim> &force() const
  {
    return static_cast<const CrystalForce<dim> &>(*body.zone->force);
  }
};

template <int dim>
CrystalStrip<dim>::CrystalStrip(CrystalParameters<dim> p, double length, double far_length,
                                double fine_damper)
{
  p.split.fine_damper = fine_damper;
  const double overlap_length = p.overlap_cells * size;
  const double layer = dim == 2 ? std::sqrt(0.75) : std::sqrt(0.5);
  const int n_layers = int((length + overlap_length) / layer), n = across * size;
  std::vector<Vector<dim>> places;
  for (int l = 0; l < n_layers; ++l)
    for (int k = 0; k < (dim == 2 ? n : n * n); ++k) {
      const double shift = 0.2 + 0.5 * (l % 2);
      Vector<dim> x;
      if constexpr (dim == 2)
        x << k + shift, l * layer;
      else
        x << k % n + shift, k / n + shift, l * layer;
      places.push_back(x);
    }
  particles::Particles<dim> atoms;
  atoms.resize(int(places.size()));
  for (int i = 0; i < atoms.size(); ++i) {
    set(atoms.reference, i, places[i]);
    atoms.volume[i] = atoms.mass[i] = std::abs(crystal_basis<dim>(0).determinant());
  }
  const double edge = n_layers * layer - 0.3; // the mesh at no fraction of the lattice
  mesh_begin = edge - overlap_length;
  Vector<dim> period = Vector<dim>::Constant(n);
  period[dim - 1] = 0;
  auto force = std::make_unique<CrystalForce<dim>>(
      atoms, 1, EmbeddingPotential(dim, 1, p.reach, p.strain, p.is_normal), 1, true, p.faults,
      period);
  force->forget_reference();
  const auto constants = force->elastic_constants();
  body.zone = std::make_unique<particles::ParticleSolver<dim>>(std::move(atoms), std::move(force));
  fem::Body<dim> material;
  material.stiffness = constants.stiffness;
  material.stress = constants.stress;
  material.density = 1;
  body.far = std::make_unique<fem::FemSolver<dim>>(
      strip_mesh<dim>(across, int((far_length + overlap_length) / size), size, mesh_begin),
      material, std::vector<core::BoundaryLoad<dim>>());
  coupling::OverlapParameters<dim> overlap;
  overlap.length = overlap_length;
  overlap.spacing = 1;
  overlap.transition_cells = 6;
  auto &box = overlap.zone.boxes.emplace_back();
  box.upper.setConstant(std::numeric_limits<double>::infinity());
  box.lower = -box.upper;
  box.upper[dim - 1] = edge;
  for (int c = 0; c < dim - 1; ++c)
    overlap.period[c] = n;
  body.dt = p.step_fraction * body.zone->force->stable_step(body.zone->state);
  auto bodies = body.bodies();
  body.split = std::make_unique<coupling::FineScaleSplit<dim>>(bodies, overlap, p.split, body.dt,
                                                               *body.timers);
}

/// Energy that comes back into a crystal of a packet of waves along the last axis with this length
/// in cells and polarisation, over that of the packet.
template <int dim>
double reflected_share(double cells_per_wave, int polarisation, int overlap_cells = 4)
{
  CrystalParameters<dim> p;
  p.overlap_cells = overlap_cells;
  const double wave = cells_per_wave * CrystalStrip<dim>::size,
               width = 1.5 * wave; // of the packet: exp(-(y/width)^2)
  CrystalStrip<dim> strip(p, 8 * width, 8 * width, 8);
  auto &body = strip.body;
  auto bodies = body.bodies();
  const auto &stiffness = body.far->body().stiffness;
  const int mode = voigt_index<dim>(polarisation, dim - 1);
  const double speed = std::sqrt(stiffness(mode, mode));

  // Upwards, velocities half a step behind.
  auto &zone_state = body.zone->state;
  const double k = 2 * M_PI / wave, start = 4 * width;
  const auto &law = static_cast<const CrystalForce<dim> &>(*body.zone->force);
  const double omega =
      std::sqrt(law.wave_stiffness(k * Vector<dim>::Unit(dim - 1))(polarisation, polarisation) /
                zone_state.mass[0]);
  const auto packet = [&](double y, double t) {
    const double s = (y - start - speed * t) / width;
    return std::sin(k * (y - start) - omega * t) * std::exp(-s * s);
  };
  for (int i = 0; i < zone_state.size(); ++i) {
    const double y = zone_state.reference[dim - 1][i];
    zone_state.displacement[polarisation][i] = packet(y, 0);
    zone_state.velocity[polarisation][i] = (packet(y, 0) - packet(y, -body.dt)) / body.dt;
  }
  body.split->take_velocities(bodies);
  const auto kinetic = [&] {
    double sum = 0;
    for (int i = 0; i < zone_state.size(); ++i)
      if (zone_state.reference[dim - 1][i] < strip.mesh_begin)
        sum += zone_state.mass[i] * get(zone_state.velocity, i).squaredNorm();
    return sum;
  };
  const double first = kinetic();
  coupling::StepTime time;
  time.dt = body.dt;
  // Until the packet has left, and what comes back has not reached the other end.
  const double left = (strip.mesh_begin + overlap_cells * strip.size - start + 3 * width) / speed;
  while (time.time < left)
    advance(body, time);
  double sum = 0;
  long samples = 0;
  for (; time.time < left + wave / speed; ++samples) {
    sum += kinetic();
    advance(body, time);
  }
  return sum / double(samples) / first;
}
} // namespace ligament::tests
