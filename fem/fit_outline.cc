#include "fem/fit_outline.h"

#include "core/check.h"
#include "fem/cell_quality.h"
#include "fem/outline_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace ligament::fem
{
namespace
{
constexpr double keep_off = 0.4; // of a cell's size, from slanted sides
constexpr int n_passes = 12;     // of moving nodes
constexpr double good = 0.85;    // quality from which on nothing moves

/// Local nodes of a face in the direction that has the cell on its left.
constexpr std::array<std::array<int, 2>, 4> ends_of_face = {{{2, 0}, {1, 3}, {0, 1}, {3, 2}}};

std::string at(const Vector<2> &x)
{
  return fmt::format("({:.6g}, {:.6g}) m", x[0], x[1]);
}

[[noreturn]] void refuse(const Vector<2> &x, const std::string &why, const std::string &remedy)
{
  throw core::InputError(fmt::format("far-field mesh: near {} {}; {}", at(x), why, remedy));
}

class Fit
{
public:
  Fit(const Mesh<2> &mesh, const core::Solid<2> &outline,
      const std::array<std::vector<double>, 2> &lines)
      : mesh_(mesh), outline_(outline), sides_(outline, lines)
  {
  }

  Mesh<2> make()
  {
    find_neighbours();
    keep_cells();
    find_borders();
    give_up_lines();
    copy_kept();
    for (auto &chain : chains())
      add_layer(chain);
    add_hanging();
    improve();
    find_cell_shapes(fitted_);
    return std::move(fitted_);
  }

private:
  struct Face
  {
    int cell, face, boundary; // -1: a layer goes on from here
  };
  struct Chain
  {
    std::vector<int> nodes; // of fitted_, the body on the left
    bool is_closed;
    std::vector<int> cells; // of fitted_, beside each edge
  };
  /// A node of the layer on the outline.
  struct Slider
  {
    int node, path;
    double place; // m, along the path
    bool is_fixed;
  };

  Vector<2> middle(int cell, int face) const
  {
    const auto &[a, b] = ends_of_face[face];
    return (mesh_.nodes[mesh_.cells[cell][a]] + mesh_.nodes[mesh_.cells[cell][b]]) / 2;
  }

  void find_neighbours();
  void keep_cells();
  bool has_pinch();
  void find_borders();
  void give_up_lines();
  void copy_kept();
  std::vector<Chain> chains();
  void add_layer(const Chain &chain);
  void add_hanging();
  void improve();

  const Mesh<2> &mesh_;
  const core::Solid<2> &outline_;
  SlantedSides sides_;
  /// Of the halves of each face: the cell behind it, -1: none.
  std::vector<std::array<std::array<int, 2>, 4>> neighbour_;
  std::map<std::pair<int, int>, int> boundary_; // of faces that the mesh has on its boundary
  std::vector<char> kept_;
  std::vector<Face> borders_;

  Mesh<2> fitted_;
  std::vector<int> new_node_, new_cell_;
  std::vector<OutlinePath> paths_;
  std::vector<Slider> sliders_;
  std::set<int> fixed_; // nodes that stay
};

void Fit::find_neighbours()
{
  const CellLocator<2> locator(mesh_);
  neighbour_.resize(mesh_.n_cells());
  for (const auto &face : mesh_.boundary_faces)
    boundary_[{face.cell, face.face}] = face.boundary;
  for (int c = 0; c < mesh_.n_cells(); ++c)
    for (int f = 0; f < 4; ++f)
      for (int half = 0; half < 2; ++half) {
        const auto &[a, b] = ends_of_face[f];
        const double share = half ? 0.75 : 0.25;
        Vector<2> x =
            (1 - share) * mesh_.nodes[mesh_.cells[c][a]] + share * mesh_.nodes[mesh_.cells[c][b]];
        x[f / 2] += (f % 2 ? 1e-3 : -1e-3) * mesh_.cell_size[c][f / 2];
        neighbour_[c][f][half] = boundary_.count({c, f}) ? -1 : locator.find(x);
      }
}

void Fit::keep_cells()
{
  kept_.assign(mesh_.n_cells(), 0);
  for (int c = 0; c < mesh_.n_cells(); ++c) {
    const Vector<2> &lower = mesh_.cell_lower[c], upper = lower + mesh_.cell_size[c];
    kept_[c] = !sides_.come_near(lower, upper, keep_off * mesh_.cell_size[c].minCoeff()) &&
               outline_.contains((lower + upper) / 2);
  }
  for (int round = 0; has_pinch(); ++round)
    core::require(round < 1000, "far-field mesh: no layer of cells fits the outline; use smaller "
                                "cells along it (/far_field/outline_cell_size)");
}

/// Leaves out cells that stick out of the others, hang on them by a corner, or of whose face one
/// half has a neighbour. Returns whether there were any.
bool Fit::has_pinch()
{
  std::vector<int> drop;
  std::map<int, std::pair<int, int>>
      leaving; // by node: edges without neighbour, one of their cells
  for (int c = 0; c < mesh_.n_cells(); ++c) {
    if (!kept_[c])
      continue;
    int n_open = 0;
    for (int f = 0; f < 4; ++f) {
      const auto &[first, second] = neighbour_[c][f];
      const bool open_first = first >= 0 && !kept_[first],
                 open_second = second >= 0 && !kept_[second];
      if (open_first != open_second) {
        n_open = 4;
        break;
      }
      if (!open_first)
        continue;
      const auto foot = outline_.nearest(middle(c, f));
      if (sides_.is_slanted(foot.facet) || foot.distance > 1e-6 * mesh_.cell_size[c].minCoeff()) {
        ++n_open;
        auto &[n, cell] = leaving[mesh_.cells[c][ends_of_face[f][0]]];
        ++n;
        cell = c;
      }
    }
    if (n_open > 2)
      drop.push_back(c);
  }
  for (const auto &[node, edges] : leaving)
    if (edges.first > 1)
      drop.push_back(edges.second);
  for (const int c : drop)
    kept_[c] = 0;
  return !drop.empty();
}

void Fit::find_borders()
{
  for (int c = 0; c < mesh_.n_cells(); ++c)
    for (int f = 0; kept_[c] && f < 4; ++f) {
      const int other = neighbour_[c][f][0];
      if (other >= 0 && kept_[other])
        continue;
      const auto foot = outline_.nearest(middle(c, f));
      const bool is_on_outline = foot.distance <= 1e-6 * mesh_.cell_size[c].minCoeff();
      const auto given = boundary_.find({c, f});
      if (given != boundary_.end() && (given->second == inner_surface<2> || !is_on_outline)) {
        if (given->second != inner_surface<2>)
          refuse(middle(c, f), "the outline does not reach the side of its box",
                 "use smaller cells along it (/far_field/outline_cell_size)");
        borders_.push_back({c, f, inner_surface<2>});
      } else if (is_on_outline && !sides_.is_slanted(foot.facet))
        borders_.push_back({c, f, outline_.facets()[foot.facet].boundary});
      else
        borders_.push_back({c, f, -1});
    }
}

/// Sides on lines of the mesh that no cell borders on, as between slanted ones of a round hole, are
/// followed like these.
void Fit::give_up_lines()
{
  const auto &facets = outline_.facets();
  std::vector<char> has_cells(facets.size(), 0);
  for (const Face &face : borders_)
    if (const auto foot = outline_.nearest(middle(face.cell, face.face));
        foot.distance <= 1e-6 * mesh_.cell_size[face.cell].minCoeff())
      has_cells[foot.facet] = 1;
  // Facets of one straight side lie behind each other.
  std::vector<int> from(outline_.vertices().size(), -1);
  for (std::size_t f = 0; f < facets.size(); ++f)
    from[facets[f].edges[0][0]] = int(f);
  const auto goes_on = [&](int f) {
    const int next = from[facets[f].edges[0][1]];
    const bool is_same =
        !sides_.is_slanted(next) && outline_.normal(f).dot(outline_.normal(next)) > 1 - 1e-9;
    return is_same ? next : -1;
  };
  for (bool changed = true; changed;) { // a side has cells where one of its facets has
    changed = false;
    for (int f = 0; f < int(facets.size()); ++f)
      if (!sides_.is_slanted(f))
        if (const int next = goes_on(f); next >= 0 && has_cells[f] != has_cells[next]) {
          has_cells[f] = has_cells[next] = 1;
          changed = true;
        }
  }
  for (int f = 0; f < int(facets.size()); ++f)
    if (!sides_.is_slanted(f) && !has_cells[f])
      sides_.add(f);
}

void Fit::copy_kept()
{
  std::vector<char> used(mesh_.n_nodes(), 0);
  for (int c = 0; c < mesh_.n_cells(); ++c)
    if (kept_[c])
      for (const int node : mesh_.cells[c])
        used[node] = 1;
  new_node_.assign(mesh_.n_nodes(), -1);
  for (int i = 0; i < mesh_.n_nodes(); ++i)
    if (used[i]) {
      new_node_[i] = fitted_.n_nodes();
      fitted_.nodes.push_back(mesh_.nodes[i]);
    }
  new_cell_.assign(mesh_.n_cells(), -1);
  for (int c = 0; c < mesh_.n_cells(); ++c) {
    if (!kept_[c])
      continue;
    new_cell_[c] = fitted_.n_cells();
    auto &cell = fitted_.cells.emplace_back();
    for (int a = 0; a < 4; ++a)
      cell[a] = new_node_[mesh_.cells[c][a]];
    fitted_.cell_level.push_back(mesh_.cell_level[c]);
  }
  for (const Face &face : borders_)
    if (face.boundary >= 0) {
      fitted_.boundary_faces.push_back({new_cell_[face.cell], face.face, face.boundary});
      for (const int a : ends_of_face[face.face])
        fixed_.insert(new_node_[mesh_.cells[face.cell][a]]);
    }
}

std::vector<Fit::Chain> Fit::chains()
{
  std::map<int, std::pair<int, int>> next; // node -> node, cell
  std::set<int> ends;
  for (const Face &face : borders_)
    if (face.boundary < 0) {
      const auto &cell = mesh_.cells[face.cell];
      const int a = new_node_[cell[ends_of_face[face.face][0]]],
                b = new_node_[cell[ends_of_face[face.face][1]]];
      next[a] = {b, new_cell_[face.cell]};
      ends.insert(b);
    }
  std::vector<Chain> chains;
  const auto follow = [&](int start) {
    Chain chain{{start}, false, {}};
    for (auto edge = next.find(start); edge != next.end(); edge = next.find(chain.nodes.back())) {
      const auto [to, cell] = edge->second;
      next.erase(edge);
      chain.cells.push_back(cell);
      if (to == start) {
        chain.is_closed = true;
        break;
      }
      chain.nodes.push_back(to);
    }
    chains.push_back(std::move(chain));
  };
  std::vector<int> starts;
  for (const auto &[from, edge] : next)
    if (!ends.count(from))
      starts.push_back(from);
  for (const int start : starts)
    follow(start);
  while (!next.empty())
    follow(next.begin()->first);
  return chains;
}

/// Nodes on the outline for those of the chain, and cells between.
void Fit::add_layer(const Chain &chain)
{
  std::vector<Vector<2>> places, outside;
  const int n = int(chain.nodes.size());
  for (int k = 0; k < n; ++k) {
    places.push_back(fitted_.nodes[chain.nodes[k]]);
    // A little out of the cells, to be nearest to the side that faces them.
    Vector<2> out = Vector<2>::Zero();
    for (const int from : {k - 1, k}) {
      if (!chain.is_closed && (from < 0 || from + 1 >= n))
        continue;
      const Vector<2> along =
          fitted_.nodes[chain.nodes[(from + 1) % n]] - fitted_.nodes[chain.nodes[(from + n) % n]];
      out += Vector<2>(along[1], -along[0]);
    }
    outside.push_back(places.back() + 0.3 * out);
  }
  OutlinePath path(
      outline_, [&](int facet) { return sides_.is_slanted(facet); }, places, outside,
      chain.is_closed);
  // Where the outline leaves a line of the mesh hardly bent or inwards, a cell has no corner for
  // it: the last node on the line then moves there and is the first one of the layer.
  const auto turns_right = [&](int k) {
    const Vector<2> u = places[k] - places[k - 1], v = places[k + 1] - places[k];
    return u[0] * v[1] - u[1] * v[0] < -0.5 * u.norm() * v.norm();
  };
  const bool joins_start = !chain.is_closed && n > 3 && !path.begins_outward() && turns_right(1);
  const bool joins_end = !chain.is_closed && n > 3 && !path.ends_outward() && turns_right(n - 2);
  const int first = joins_start, end = n - joins_end; // nodes of the chain that the layer joins
  places.assign(places.begin() + first, places.begin() + end);
  outside.assign(outside.begin() + first, outside.begin() + end);
  const auto stops = path.stops(places, outside);
  std::vector<int> outer;
  for (int k = first; k < end; ++k) {
    const auto &stop = stops[k - first];
    if ((joins_start && k == first) || (joins_end && k + 1 == end)) {
      outer.push_back(chain.nodes[k == first ? 0 : n - 1]);
      fitted_.nodes[outer.back()] = path.at(stop.place); // along its line, to where that ends
      continue;
    }
    outer.push_back(fitted_.n_nodes());
    sliders_.push_back({fitted_.n_nodes(), int(paths_.size()), stop.place, stop.is_fixed});
    fitted_.nodes.push_back(path.at(stop.place));
  }
  for (int k = first; k + 1 < end + chain.is_closed; ++k) {
    const int next = (k + 1) % n, cell = fitted_.n_cells();
    fitted_.cells.push_back(
        {chain.nodes[k], outer[k - first], chain.nodes[next], outer[next - first]});
    fitted_.cell_level.push_back(fitted_.cell_level[chain.cells[k]]);
    const double from = stops[k - first].place,
                 to = stops[next - first].place + (next < k ? path.length() : 0);
    fitted_.boundary_faces.push_back({cell, 1, path.boundary_at((from + to) / 2)});
    if (!chain.is_closed && k == 0)
      fitted_.boundary_faces.push_back({cell, 2, path.boundary_before()});
    if (!chain.is_closed && k + 2 == n)
      fitted_.boundary_faces.push_back({cell, 3, path.boundary_behind()});
  }
  paths_.push_back(std::move(path));
}

/// Hanging nodes are those beside whose edge the cell with both masters is left.
void Fit::add_hanging()
{
  std::set<std::pair<int, int>> edges;
  for (const auto &cell : fitted_.cells)
    for (const auto &[a, b] : ends_of_face)
      edges.insert(std::minmax(cell[a], cell[b]));
  for (const HangingNode &old : mesh_.hanging) {
    const int node = new_node_[old.node];
    if (node < 0)
      continue;
    HangingNode hanging{node, {}};
    for (const auto &[master, weight] : old.masters)
      hanging.masters.emplace_back(new_node_[master], weight);
    if (hanging.masters.size() != 2 ||
        !edges.count(std::minmax(hanging.masters[0].first, hanging.masters[1].first)))
      continue;
    fixed_.insert(node);
    for (const auto &[master, weight] : hanging.masters)
      fixed_.insert(master);
    fitted_.hanging.push_back(std::move(hanging));
  }
}

/// Nodes of the layer and of the two next to it move to where the worst of their cells is better.
void Fit::improve()
{
  std::vector<std::vector<int>> cells_of(fitted_.n_nodes()), near(fitted_.n_nodes());
  for (int c = 0; c < fitted_.n_cells(); ++c)
    for (const auto &[a, b] : ends_of_face) {
      const auto &cell = fitted_.cells[c];
      cells_of[cell[a]].push_back(c);
      near[cell[a]].push_back(cell[b]);
      near[cell[b]].push_back(cell[a]);
    }
  const auto quality = [&](int node) {
    double least = 1;
    for (const int c : cells_of[node]) {
      CellVectors<2> corners;
      double shortest = 1e300, longest = 0;
      for (int a = 0; a < 4; ++a)
        corners.col(a) = fitted_.nodes[fitted_.cells[c][a]];
      for (const auto &[a, b] : ends_of_face) {
        const double length = (corners.col(b) - corners.col(a)).norm();
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
      }
      // Thin cells govern the step.
      least = std::min(least, scaled_jacobian<2>(corners) * std::min(1., 3 * shortest / longest));
    }
    return least;
  };
  const auto try_place = [&](int node, const Vector<2> &x) {
    const double before = quality(node);
    const Vector<2> old = std::exchange(fitted_.nodes[node], x);
    if (quality(node) > before + 1e-6)
      return true;
    fitted_.nodes[node] = old;
    return false;
  };
  std::set<int> movable;
  for (const Slider &slider : sliders_)
    for (const int beside : near[slider.node])
      for (const int next : near[beside])
        for (const int node : {beside, next})
          if (!fixed_.count(node))
            movable.insert(node);
  for (const Slider &slider : sliders_)
    movable.erase(slider.node);
  for (int pass = 0; pass < n_passes; ++pass) {
    for (Slider &slider : sliders_) {
      if (slider.is_fixed || quality(slider.node) > good)
        continue;
      double width = 0;
      for (const int other : near[slider.node])
        width = std::max(width, (fitted_.nodes[other] - fitted_.nodes[slider.node]).norm());
      for (const double step : {0.2, -0.2, 0.05, -0.05}) {
        const double place = slider.place + step * width;
        if (paths_[slider.path].holds(place) &&
            try_place(slider.node, paths_[slider.path].at(place)))
          slider.place = place;
      }
    }
    for (const int node : movable) {
      if (quality(node) > good)
        continue;
      Vector<2> mean = Vector<2>::Zero();
      for (const int other : near[node])
        mean += fitted_.nodes[other] / double(near[node].size());
      const Vector<2> x = fitted_.nodes[node];
      for (const double share : {1., 0.5, 0.2})
        if (try_place(node, x + share * (mean - x)))
          break;
    }
  }
  for (const Slider &slider : sliders_)
    if (quality(slider.node) < 0.02)
      refuse(fitted_.nodes[slider.node], "no good cells fit the outline",
             "use smaller cells along it (/far_field/outline_cell_size)");
}
} // namespace

Mesh<2> fit_outline(const Mesh<2> &mesh, const core::Solid<2> &outline,
                    const std::array<std::vector<double>, 2> &lines)
{
  return Fit(mesh, outline, lines).make();
}
} // namespace ligament::fem
