// What a part of a packing should be, found without regard for time or memory.
#pragma once

#include "packings/packing_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace ligament::packings::testing
{
/// Bit for bit.
template <int dim>
void expect_same_packing(const Packing<dim> &a, const Packing<dim> &b)
{
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.thickness, b.thickness);
  EXPECT_EQ(a.period, b.period);
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.diameter, b.diameter);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.global_id, b.global_id);
  EXPECT_EQ(a.row_begin, b.row_begin);
  ASSERT_EQ(a.directions.size(), b.directions.size());
  for (std::size_t k = 0; k < a.directions.size(); ++k)
    EXPECT_TRUE(a.directions[k].normal == b.directions[k].normal &&
                a.directions[k].distance == b.directions[k].distance &&
                a.directions[k].area == b.directions[k].area);
  ASSERT_EQ(a.cuts.size(), b.cuts.size());
  for (std::size_t k = 0; k < a.cuts.size(); ++k)
    EXPECT_TRUE(a.cuts[k].normal() == b.cuts[k].normal() &&
                a.cuts[k].height(Vector<dim>::Zero()) == b.cuts[k].height(Vector<dim>::Zero()));
  EXPECT_EQ(mean_face_area(a), mean_face_area(b));
  EXPECT_EQ(largest_diameter(a), largest_diameter(b));
  ASSERT_EQ(a.faces.size(), b.faces.size());
  for (std::size_t k = 0; k < a.faces.size(); ++k) {
    const Face<dim> &f = a.faces[k], &g = b.faces[k];
    ASSERT_TRUE(f.i == g.i && f.j == g.j && f.normal == g.normal && f.area == g.area &&
                f.q_i == g.q_i && f.q_j == g.q_j && f.lever_i == g.lever_i &&
                f.lever_j == g.lever_j && f.direction == g.direction && f.cracked == g.cracked &&
                f.cut == g.cut && f.image == g.image)
        << k;
  }
  ASSERT_EQ(a.boundary_faces.size(), b.boundary_faces.size());
  for (std::size_t k = 0; k < a.boundary_faces.size(); ++k) {
    const BoundaryFace<dim> &f = a.boundary_faces[k], &g = b.boundary_faces[k];
    ASSERT_TRUE(f.i == g.i && f.normal == g.normal && f.area == g.area && f.q == g.q &&
                f.lever == g.lever && f.boundary == g.boundary && f.corners == g.corners)
        << k;
  }
}

/// These and their neighbours, by breadth first; the k-th set is what lies within k faces.
template <int dim>
std::vector<std::set<int>> rings_around(const Packing<dim> &whole, const std::set<int> &these,
                                        int rings)
{
  std::vector<std::set<int>> neighbours(whole.size());
  for (const auto &face : whole.faces) {
    neighbours[face.i].insert(face.j);
    neighbours[face.j].insert(face.i);
  }
  std::vector<std::set<int>> within = {these};
  for (int ring = 1; ring <= rings; ++ring) {
    std::set<int> wider = within.back();
    for (const int i : within.back())
      wider.insert(neighbours[i].begin(), neighbours[i].end());
    within.push_back(std::move(wider));
  }
  return within;
}

/// Particle by particle, face by face.
template <int dim>
Packing<dim> piece_of(const Packing<dim> &whole, const std::set<int> &kept)
{
  Packing<dim> piece;
  piece.spacing = whole.spacing;
  piece.thickness = whole.thickness;
  piece.period = whole.period;
  piece.directions = whole.directions;
  piece.cuts = whole.cuts;
  piece.whole = WholeSizes{mean_face_area(whole), largest_diameter(whole)};
  std::vector<int> number(whole.size(), -1);
  const std::set<int> runs(whole.row_begin.begin(), whole.row_begin.end());
  for (const int i : kept) {
    number[i] = piece.size();
    for (int a = 0; a < dim; ++a)
      piece.centre[a].push_back(whole.centre[a][i]);
    piece.volume.push_back(whole.volume[i]);
    if (!whole.diameter.empty())
      piece.diameter.push_back(whole.diameter[i]);
    if (!whole.material.empty())
      piece.material.push_back(whole.material[i]);
    piece.global_id.push_back(whole.global_id[i]);
    if (!whole.row_begin.empty() && (runs.count(i) > 0 || kept.count(i - 1) == 0))
      piece.row_begin.push_back(number[i]);
  }
  if (!whole.row_begin.empty())
    piece.row_begin.push_back(int(kept.size()));
  for (Face<dim> face : whole.faces)
    if (kept.count(face.i) > 0 && kept.count(face.j) > 0) {
      face.i = number[face.i];
      face.j = number[face.j];
      piece.faces.push_back(face);
    }
  for (BoundaryFace<dim> face : whole.boundary_faces)
    if (kept.count(face.i) > 0) {
      face.i = number[face.i];
      piece.boundary_faces.push_back(face);
    }
  return piece;
}

/// Cells of a grid of a random place and size, from `least` to `most` wide, in a random box of at
/// least half of the specimen; one in four is none.
template <int dim>
Groups<dim> random_cells(std::mt19937 &random, const Vector<dim> &upper, double least, double most)
{
  std::uniform_real_distribution<double> share(0, 1);
  Vector<dim> from, to, size;
  for (int a = 0; a < dim; ++a) {
    from[a] = 0.5 * share(random) * upper[a];
    to[a] = from[a] + (0.5 + 0.5 * share(random)) * upper[a];
    size[a] = least + share(random) * (most - least);
  }
  const unsigned salt = random();
  Groups<dim> groups;
  groups.reach = size.maxCoeff();
  groups.of = [=](const Vector<dim> &x) {
    unsigned number = 0;
    for (int a = 0; a < dim; ++a) {
      if (x[a] < from[a] || x[a] > to[a])
        return -1;
      number = 1000 * number + unsigned(std::floor((x[a] - from[a]) / size[a]));
    }
    return (number + salt) % 4 == 0 ? -1 : int(number);
  };
  return groups;
}

/// The particles of a group, by its number; those of none are under -1.
template <int dim>
std::map<int, std::set<int>> members(const Packing<dim> &whole, const Groups<dim> &groups)
{
  std::map<int, std::set<int>> found;
  for (int i = 0; i < whole.size(); ++i)
    found[std::max(-1, groups.of ? groups.of(get(whole.centre, i)) : -1)].insert(i);
  return found;
}
} // namespace ligament::packings::testing
