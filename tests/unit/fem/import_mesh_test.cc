// Quadrilaterals from elsewhere as the far field.
#include "core/check.h"
#include "core/outline.h"
#include "fem/cell_map.h"
#include "fem/import_mesh.h"

#include <gtest/gtest.h>

#include <map>

namespace
{
using namespace ligament;
using namespace ligament::fem;

/// n x m cells of size 1, corners of each in a way of its own round; the last column leans.
struct Quads
{
  std::vector<Vector<2>> places;
  std::vector<std::array<int, 4>> cells;
  std::shared_ptr<core::Solid<2>> outline;

  Quads(int n, int m, double lean)
  {
    for (int j = 0; j <= m; ++j)
      for (int i = 0; i <= n; ++i)
        places.emplace_back(i + (i == n ? lean * j : 0), j + 1e-13 * (i % 3)); // as files round
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i;
        std::array<int, 4> quad = {a, a + 1, a + n + 2, a + n + 1};
        std::rotate(quad.begin(), quad.begin() + (i + 2 * j) % 4, quad.end());
        if ((i + j) % 3 == 0)
          std::reverse(quad.begin(), quad.end());
        cells.push_back(quad);
      }
    const core::Polygon polygon = {
        {{0, 0}, 2}, {{double(n), 0}, 7}, {{n + lean * m, double(m)}, 3}, {{0, double(m)}, 0}};
    outline = std::make_shared<core::Solid<2>>(core::make_solid({polygon}));
  }
};

TEST(ImportMesh, RectanglesBecomeBoxesAndSidesKeepTheirNames)
{
  const Quads q(6, 4, 0.2);
  const auto mesh = import_mesh(q.places, q.cells, *q.outline, {{{2, 1}, {4, 3}}});
  EXPECT_EQ(mesh.n_cells(), 20);
  double area = 0;
  int n_boxes = 0;
  for (int c = 0; c < mesh.n_cells(); ++c) {
    area += cell_volume(mesh, c);
    n_boxes += mesh.is_box(c);
  }
  EXPECT_EQ(n_boxes, 16);
  EXPECT_NEAR(area, 24 + 0.2 * 8 - 4, 1e-13);
  std::map<int, double> sides;
  for (const auto &face : mesh.boundary_faces)
    sides[face.boundary] +=
        core::face_area<2>(face_corners<2>(cell_corners(mesh, face.cell), face.face));
  EXPECT_NEAR(sides.at(0), 4, 1e-13);
  EXPECT_NEAR(sides.at(2), 6, 1e-13);
  EXPECT_NEAR(sides.at(3), 6.8, 1e-13);
  EXPECT_NEAR(sides.at(7), 4 * std::hypot(1, 0.2), 1e-13);
  EXPECT_NEAR(sides.at(inner_surface<2>), 8, 1e-13);
}

TEST(ImportMesh, WhatDoesNotFitIsRefusedWithItsPlace)
{
  const Quads q(6, 4, 0.2);
  const auto message = [&](const std::vector<std::array<int, 4>> &cells, const InnerBox<2> &inner) {
    try {
      import_mesh(q.places, cells, *q.outline, {inner});
    } catch (const core::InputError &error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message(q.cells, {{2, 1}, {3.5, 3}}).find("cuts the cell at (3.5, 1.5) m"),
            std::string::npos);
  auto gap = q.cells;
  gap.erase(gap.begin() + 8);
  EXPECT_NE(message(gap, {{4, 1}, {5, 3}}).find("end inside the body"), std::string::npos);
  EXPECT_NE(message(q.cells, {{-1, -1}, {9, 9}}).find("no cells"), std::string::npos);
}
TEST(ImportMesh, SeamsThatAreNotMergedAreRefused)
{
  Quads q(6, 4, 0);
  const int twin = int(q.places.size());
  q.places.push_back(q.places[10]);
  for (auto &cell : q.cells)
    if (const auto found = std::find(cell.begin(), cell.end(), 10); found != cell.end()) {
      *found = twin;
      break;
    }
  try {
    import_mesh(q.places, q.cells, *q.outline, {});
    ADD_FAILURE() << "two nodes in one place";
  } catch (const core::InputError &error) {
    EXPECT_NE(std::string(error.what()).find("two nodes lie at (3, 1) m"), std::string::npos)
        << error.what();
  }
}

} // namespace
