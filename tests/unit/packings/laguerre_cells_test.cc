// Our Laguerre cells against those of Voro++, a code of its own.
#include "packings/random_packing.h"

#include <gtest/gtest.h>
#include <voro++/voro++.hh>

#include <map>

namespace ligament::packings::test
{
namespace
{
using FaceAreas = std::map<std::pair<int, int>, double>; // of the pairs i < j

struct Cells
{
  std::vector<double> volume;
  FaceAreas area;
};

/// A slab of unit thickness stands for two dimensions: all its faces are upright.
template <int dim>
Cells cells_of_voro(const RandomParameters<dim> &p, const Seeds<dim> &seeds)
{
  const bool flat = dim == 2;
  voro::container_poly box(p.lower[0], p.upper[0], p.lower[1], p.upper[1],
                           flat ? 0. : p.lower[dim - 1], flat ? p.thickness : p.upper[dim - 1], 4,
                           4, flat ? 1 : 4, false, false, false, 8);
  for (int i = 0; i < seeds.size(); ++i) {
    const auto &x = seeds.centre[i];
    box.put(i, x[0], x[1], flat ? p.thickness / 2 : x[dim - 1], seeds.radius[i]);
  }
  Cells cells;
  cells.volume.assign(seeds.size(), 0.);
  voro::voronoicell_neighbor cell;
  voro::c_loop_all each(box);
  if (each.start())
    do
      if (box.compute_cell(cell, each)) {
        const int i = each.pid();
        cells.volume[i] = cell.volume();
        std::vector<int> neighbour;
        std::vector<double> area;
        cell.neighbors(neighbour);
        cell.face_areas(area);
        for (std::size_t f = 0; f < area.size(); ++f)
          if (neighbour[f] > i) // walls are negative
            cells.area[{i, neighbour[f]}] = area[f];
      }
    while (each.inc());
  return cells;
}

/// The box at the origin in units of the spacing: Voro++ works with absolute tolerances.
template <int dim>
void check_against_voro(double ratio)
{
  RandomParameters<dim> p;
  p.spacing = 1;
  p.size_ratio = ratio;
  p.relaxation_sweeps = 5;
  for (int a = 0; a < dim; ++a) {
    p.lower[a] = 0;
    p.upper[a] = dim == 2 ? 20 : 8;
  }
  const auto [packing, seeds, n_healed] = make_random_packing<dim>(p);
  ASSERT_EQ(packing.size(), seeds.size());
  Cells ours;
  ours.volume = packing.volume;
  for (const auto &face : packing.faces)
    ours.area[{std::min(face.i, face.j), std::max(face.i, face.j)}] = face.area;
  const Cells theirs = cells_of_voro(p, seeds);

  // Voro++ takes points nearer than 1e-11 or so of its own unit for one.
  const double tolerance = 1e-9;
  for (int i = 0; i < packing.size(); ++i)
    EXPECT_NEAR(ours.volume[i], theirs.volume[i], tolerance) << "cell " << i;
  const auto area_in = [](const FaceAreas &areas, const std::pair<int, int> &pair) {
    const auto found = areas.find(pair);
    return found == areas.end() ? 0. : found->second;
  };
  for (const auto &[pair, area] : ours.area)
    EXPECT_NEAR(area, area_in(theirs.area, pair), tolerance);
  for (const auto &[pair, area] : theirs.area)
    EXPECT_NEAR(area, area_in(ours.area, pair), tolerance);
  EXPECT_GT(ours.area.size(), std::size_t(dim * packing.size() * 2 / 3));
}

TEST(LaguerreCells, AgreeWithVoroInTheUnitThickPlate)
{
  check_against_voro<2>(1);
  check_against_voro<2>(5);
}

TEST(LaguerreCells, AgreeWithVoroInTheBox)
{
  check_against_voro<3>(1);
  check_against_voro<3>(5);
}
} // namespace
} // namespace ligament::packings::test
