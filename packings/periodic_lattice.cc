#include "packings/periodic_lattice.h"

#include "core/check.h"
#include "packings/lattice.h"

#include <algorithm>
#include <cmath>

namespace ligament::packings
{
template <int dim>
Packing<dim> make_periodic_packing(LatticeKind kind, const Across<dim> &across, int layers,
                                   bool closed)
{
  core::require(*std::min_element(across.n.begin(), across.n.end()) >= 3,
                "a periodic packing is at least 3 particles across");
  LatticeParameters<dim> parameters;
  parameters.kind = kind;
  parameters.spacing = 1;
  const Lattice<dim> lattice(parameters);
  using Index = LatticeIndex<dim>;
  const Vector<dim> origin = lattice.position(Index::Zero());

  const int columns = across.columns();
  // Columns run along the last basis vector: neighbours of a column lie at constant offsets.
  const auto number = [&](const Index &k) {
    int column = 0;
    for (int c = dim - 2; c >= 0; --c)
      column = column * across[c] + ((k[c] % across[c]) + across[c]) % across[c];
    return column * layers + k[dim - 1];
  };
  const auto has_layer = [&](int layer) { return layer >= 0 && layer < layers; };

  Packing<dim> packing;
  packing.spacing = 1;
  const int n = columns * layers;
  packing.volume.assign(n, lattice.cell_volume);
  for (auto &x : packing.centre)
    x.resize(n);
  for (const auto &step : lattice.forward)
    packing.directions.push_back({step.direction, step.distance, lattice.face_area});
  for (int column = 0; column <= columns; ++column)
    packing.row_begin.push_back(column * layers);

  for (int i = 0; i < n; ++i) {
    Index k;
    for (int c = 0, rest = i / layers; c < dim - 1; rest /= across[c++])
      k[c] = rest % across[c];
    k[dim - 1] = i % layers;
    Vector<dim> x = lattice.position(k) - origin;
    for (int c = 0; c < dim - 1; ++c)
      x[c] -= across[c] * std::floor(x[c] / across[c]);
    set(packing.centre, i, x);
    packing.global_id.push_back(Lattice<dim>::global_id(k));

    for (std::size_t direction = 0; direction < lattice.forward.size(); ++direction)
      for (const int sign : {1, -1}) {
        const auto &step = lattice.forward[direction];
        const Index neighbour = k + sign * step.offset;
        const Vector<dim> normal = sign * step.direction, lever = normal / 2;
        if (!has_layer(neighbour[dim - 1])) {
          if (neighbour[dim - 1] < 0 || closed)
            packing.boundary_faces.push_back(
                {i, normal, lattice.face_area, 0.5, lever, 2 * dim - (sign > 0 ? 1 : 2)});
        } else if (sign > 0)
          packing.faces.push_back({i, number(neighbour), normal, lattice.face_area, 0.5, 0.5, lever,
                                   -lever, int(direction), false});
      }
  }
  return packing;
}

template Packing<2> make_periodic_packing(LatticeKind, const Across<2> &, int, bool);
template Packing<3> make_periodic_packing(LatticeKind, const Across<3> &, int, bool);
} // namespace ligament::packings
