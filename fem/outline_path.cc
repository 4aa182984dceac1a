#include "fem/outline_path.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::fem
{
namespace
{
constexpr double corner = 25 * M_PI / 180; // rad, from which on a turn is one

constexpr auto meets_zone =
                   "a curved or slanted side of the outline meets the discrete zone or its "
                   "overlap, or has too little room for its cells",
               remedy_of_meeting =
                   "beside a zone only sides along x or y may: move the zone, or let it hold the "
                   "whole side; elsewhere use smaller cells (/far_field/cell_size)";

std::string at_text(const Vector<2> &x)
{
  return fmt::format("({:.6g}, {:.6g}) m", x[0], x[1]);
}

/// Facets by the vertex at which they begin, and end.
struct Links
{
  std::vector<int> next, before;

  explicit Links(const core::Solid<2> &outline)
      : next(outline.facets().size()), before(outline.facets().size())
  {
    std::vector<int> from(outline.vertices().size(), -1);
    const auto &facets = outline.facets();
    for (std::size_t f = 0; f < facets.size(); ++f)
      from[facets[f].edges[0][0]] = int(f);
    for (std::size_t f = 0; f < facets.size(); ++f) {
      next[f] = from[facets[f].edges[0][1]];
      before[next[f]] = int(f);
    }
  }
};
} // namespace

OutlinePath::OutlinePath(const core::Solid<2> &outline, const std::function<bool(int)> &is_slanted,
                         const std::vector<Vector<2>> &places,
                         const std::vector<Vector<2>> &outside, bool is_closed)
    : outline_(outline), is_closed_(is_closed)
{
  const Links links(outline);
  const auto fail = [&](const std::string &why, const std::string &remedy) {
    throw core::InputError(
        fmt::format("far-field mesh: near {} {}; {}", at_text(places[0]), why, remedy));
  };
  // The first facet of the run that each point faces; the run that most of them face.
  std::map<int, int> votes;
  for (const Vector<2> &x : outside) {
    const int facet = outline.nearest(x).facet;
    if (!is_slanted(facet))
      continue;
    int first = facet, least = facet;
    while (is_slanted(links.before[first]) && links.before[first] != facet) {
      first = links.before[first];
      least = std::min(least, first);
    }
    const bool is_loop = is_slanted(links.before[first]);
    ++votes[is_loop ? least : first];
  }
  if (votes.empty())
    fail("a border of cells faces no side of the outline",
         "use smaller cells along it (/far_field/outline_cell_size)");
  const int first = std::max_element(votes.begin(), votes.end(), [](const auto &a, const auto &b) {
                      return a.second < b.second;
                    })->first;
  int facet = first;
  double length = 0;
  do {
    facets_.push_back(facet);
    start_.push_back(length);
    const auto &edge = outline.facets()[facet].edges[0];
    length += (outline.vertices()[edge[1]] - outline.vertices()[edge[0]]).norm();
    facet = links.next[facet];
  } while (facet != first && is_slanted(facet));
  start_.push_back(length);
  const bool is_loop = facet == first;
  if (is_loop && !is_closed)
    fail(meets_zone, remedy_of_meeting);
  if (!is_loop && is_closed)
    fail("the cells beside a side of the outline end before it does",
         "use smaller cells along it (/far_field/outline_cell_size)");
  boundary_before_ = outline.facets()[links.before[first]].boundary;
  boundary_behind_ = outline.facets()[facet].boundary;
  if (is_closed)
    return;
  begins_outward_ = turn(links.before[first], first) > corner;
  ends_outward_ = turn(facets_.back(), facet) > corner;
  // An open chain begins on the line that leads to the path, and ends on the one behind it.
  const double reach = 6 * (places.size() > 1 ? (places[1] - places[0]).norm() : length);
  for (const auto &[x, end] :
       {std::pair(places.front(), at(0)), std::pair(places.back(), at(length))})
    if ((x - end).norm() > reach)
      fail(meets_zone, remedy_of_meeting);
}

std::size_t OutlinePath::side_at(double &place) const
{
  if (is_closed_)
    place -= length() * std::floor(place / length());
  place = std::clamp(place, 0., length());
  const auto above = std::upper_bound(start_.begin(), start_.end() - 1, place);
  return std::min<std::size_t>(above - start_.begin() - 1, facets_.size() - 1);
}

Vector<2> OutlinePath::at(double place) const
{
  const std::size_t k = side_at(place);
  const auto &edge = outline_.facets()[facets_[k]].edges[0];
  const Vector<2> &a = outline_.vertices()[edge[0]], &b = outline_.vertices()[edge[1]];
  return a + (place - start_[k]) / (start_[k + 1] - start_[k]) * (b - a);
}

int OutlinePath::boundary_at(double place) const
{
  return outline_.facets()[facets_[side_at(place)]].boundary;
}

double OutlinePath::nearest(const Vector<2> &x) const
{
  double best = 0, least = 1e300;
  for (std::size_t k = 0; k < facets_.size(); ++k) {
    const auto &edge = outline_.facets()[facets_[k]].edges[0];
    const Vector<2> &a = outline_.vertices()[edge[0]], way = outline_.vertices()[edge[1]] - a;
    const double share = std::clamp(way.dot(x - a) / way.squaredNorm(), 0., 1.);
    if (const double d = (a + share * way - x).squaredNorm(); d < least) {
      least = d;
      best = start_[k] + share * way.norm();
    }
  }
  return best;
}

double OutlinePath::turn(int facet, int next) const
{
  const Vector<2> &n = outline_.normal(facet), &m = outline_.normal(next);
  return std::atan2(n[0] * m[1] - n[1] * m[0], n.dot(m));
}

// Where one named side ends and the next begins loads do, too.
std::vector<double> OutlinePath::corners() const
{
  std::vector<double> places;
  for (std::size_t k = is_closed_ ? 0 : 1; k < facets_.size(); ++k) {
    const int before = facets_[k == 0 ? facets_.size() - 1 : k - 1], facet = facets_[k];
    if (std::abs(turn(before, facet)) > corner ||
        outline_.facets()[before].boundary != outline_.facets()[facet].boundary)
      places.push_back(start_[k]);
  }
  return places;
}

std::vector<OutlinePath::Fixed>
OutlinePath::nodes_of_corners(const std::vector<Vector<2>> &places) const
{
  const int n = int(places.size());
  const std::vector<double> corners = this->corners();
  const int n_left_over = is_closed_ ? 0 : 1; // the end has a node, too
  std::vector<Fixed> fixed;
  if (!is_closed_)
    fixed.push_back({0, 0.});
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Vector<2> x = at(corners[c]);
    const bool is_first = is_closed_ && c == 0;
    const int from = is_first ? 0 : fixed.back().node + 1;
    const int to =
        is_first ? n
                 : n + (is_closed_ ? fixed[0].node : 0) - int(corners.size() - c - 1) - n_left_over;
    Fixed nearest{-1, corners[c]};
    double least = 1e300;
    for (int k = from; k < to; ++k)
      if (const double d = (places[k % n] - x).norm(); d < least) {
        least = d;
        nearest.node = k;
      }
    if (nearest.node < 0)
      throw core::InputError(fmt::format(
          "far-field mesh: near {} the outline has more corners than there are cells; use smaller "
          "cells along it (/far_field/outline_cell_size)",
          at_text(x)));
    fixed.push_back(nearest);
  }
  if (!is_closed_)
    fixed.push_back({n - 1, length()});
  return fixed;
}

/// Between fixed nodes: where nodes wish to be, evened out.
std::vector<double> OutlinePath::evened(std::vector<Fixed> fixed,
                                        const std::vector<double> &wish) const
{
  const int n = int(wish.size());
  if (fixed.empty()) // a smooth loop
    fixed.push_back({0, wish[0]});
  if (is_closed_)
    fixed.push_back({fixed[0].node + n, fixed[0].place + length()});
  std::vector<double> place(std::size_t(fixed.back().node) + 1);
  for (std::size_t s = 0; s + 1 < fixed.size(); ++s) {
    const auto [first, low] = fixed[s];
    const auto [last, high] = fixed[s + 1];
    place[first] = low;
    place[last] = high;
    const double mean = (high - low) / (last - first), least = 0.3 * mean;
    for (int k = first + 1; k < last; ++k) {
      double wished = wish[k % n];
      if (is_closed_)
        wished += length() * std::round((place[k - 1] + mean - wished) / length());
      place[k] = std::clamp(wished, place[k - 1] + least, high - least * (last - k));
    }
    for (int round = 0; round < 4; ++round) {
      const std::vector<double> old = place;
      for (int k = first + 1; k < last; ++k)
        place[k] = old[k] / 2 + (old[k - 1] + old[k + 1]) / 4;
    }
  }
  std::vector<double> result(n);
  for (int k = fixed[0].node; k < fixed[0].node + n; ++k)
    result[k % n] = place[k];
  return result;
}

/// Grows where angles of the cells between the nodes and their places are bad.
double OutlinePath::badness(const std::vector<Vector<2>> &places,
                            const std::vector<double> &place) const
{
  const std::size_t n = places.size();
  double sum = 0;
  for (std::size_t k = 0; k + 1 < n + is_closed_; ++k) {
    const std::size_t next = (k + 1) % n;
    const std::array<Vector<2>, 4> x = {places[k], at(place[k]), at(place[next]), places[next]};
    double least = 1;
    for (int c = 0; c < 4; ++c) {
      const Vector<2> u = x[(c + 1) % 4] - x[c], v = x[(c + 3) % 4] - x[c];
      least = std::min(least, (u[0] * v[1] - u[1] * v[0]) / (u.norm() * v.norm() + 1e-300));
    }
    sum += 1 / (std::max(least, 0.) + 0.05) + std::max(-least, 0.) * 100;
  }
  return sum;
}

std::vector<OutlinePath::Stop> OutlinePath::stops(const std::vector<Vector<2>> &places,
                                                  const std::vector<Vector<2>> &outside) const
{
  const int n = int(places.size());
  std::vector<double> wish; // the nearest place of each
  for (const Vector<2> &x : outside)
    wish.push_back(nearest(x));
  std::vector<Fixed> fixed = nodes_of_corners(places);
  std::vector<double> place = evened(fixed, wish);
  // A corner may do better with a node beside the nearest one.
  double least = badness(places, place);
  for (std::size_t c = is_closed_ ? 0 : 1; c + (is_closed_ ? 0 : 1) < fixed.size(); ++c)
    for (const int step : {1, -1, 2, -2}) {
      std::vector<Fixed> other = fixed;
      other[c].node += step;
      const int before = c > 0 ? other[c - 1].node : other.back().node - n;
      const int behind = c + 1 < other.size() ? other[c + 1].node : other[0].node + n;
      if (other[c].node <= before || other[c].node >= behind || other[c].node < 0)
        continue;
      const std::vector<double> moved = evened(other, wish);
      if (const double bad = badness(places, moved); bad < least) {
        least = bad;
        fixed = other;
        place = moved;
        break;
      }
    }
  std::vector<Stop> stops;
  for (int k = 0; k < n; ++k)
    stops.push_back({place[k], false});
  for (const auto &[node, where] : fixed)
    stops[node % n].is_fixed = true;
  // Counted from the first node on, less than a length behind it.
  if (is_closed_)
    for (Stop &stop : stops) {
      stop.place -= length() * std::floor((stop.place - stops[0].place) / length());
    }
  return stops;
}
} // namespace ligament::fem
