// What counts of the mesh where particles lie in it, too.
#pragma once

#include "src/simulation/coupled_body.h"
#include "src/simulation/gauges/motion_reading.h"

#include <cmath>
#include <vector>

namespace ligament::program
{
/// Volumes of the mesh times its share 1 - a of them (theory.md, "Overlap and weights"); what is
/// left are the particles' own volumes times a. So both sum to the body, whatever cells of particles
/// the edge of the mesh cuts.
template <int dim>
class MeshShare
{
public:
  /// Of a body with a far field, which outlives this.
  explicit MeshShare(const CoupledBody<dim> &body)
      : mesh_(body.far->mesh()), overlap_(body.coupler->overlap()), is_shared_(mesh_.n_cells(), 0)
  {
    if (overlap_)
      for (const auto &cell : overlap_->cells)
        is_shared_[cell.cell] = cell.layer == 0;
  }

  /// visit(place, volume) for points that stand for the share of a cell, m^dim. It falls within a
  /// cell or two: cells of the overlap are looked at in parts.
  template <typename Visit>
  void for_each_point(int cell, Visit &&visit) const
  {
    constexpr int parts_per_axis = dim == 2 ? 4 : 2;
    const auto add = [&](const Vector<dim> &x, double volume) {
      if (const double share = overlap_ ? 1 - overlap_->weight(x) : 1; share > 0)
        visit(x, share * volume);
    };
    if (!mesh_.is_box(cell)) { // never of the overlap
      for_each_gauss_point(mesh_, cell, 1, add);
      return;
    }
    const int n = is_shared_[cell] ? parts_per_axis : 1;
    const Vector<dim> size = mesh_.cell_size[cell] / n;
    for (int part = 0; part < std::lround(std::pow(n, dim)); ++part) {
      Vector<dim> from = mesh_.cell_lower[cell];
      for (int c = 0, rest = part; c < dim; ++c, rest /= n)
        from[c] += rest % n * size[c];
      for_each_gauss_point<dim>(from, from + size, add);
    }
  }

  bool is_shared(int cell) const { return is_shared_[cell]; }

private:
  const fem::Mesh<dim> &mesh_;
  const coupling::Overlap<dim> *overlap_;
  std::vector<char> is_shared_; // per cell: particles lie in it
};
} // namespace ligament::program
