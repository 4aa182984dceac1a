// The parts of sides on which loads act, and the loads' course in time.
#include "src/scene/body_shape.h"
#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
/// The part; where it has no width, a little of one.
template <int dim>
core::Part<dim> part_with_area(const Scene &scene, LoadParameters load)
{
  constexpr double little = 1e-6;
  const int along = axis_across(load, dim) == 0 ? 1 : 0;
  if (load.from && load.to && *load.from == *load.to) {
    *load.from -= little * scene.specimen.size[along];
    *load.to += little * scene.specimen.size[along];
  }
  for (int c = 0; c < dim; ++c)
    if (c != axis_across(load, dim) && load.within.lower[c] == load.within.upper[c]) {
      load.within.lower[c] -= little * scene.specimen.size[c];
      load.within.upper[c] += little * scene.specimen.size[c];
    }
  return part_of<dim>(load);
}

template <int dim>
bool share_area(const Scene &scene, const LoadParameters &a, const LoadParameters &b)
{
  const auto part_a = part_with_area<dim>(scene, a), part_b = part_with_area<dim>(scene, b);
  double common = 0, all = 0;
  for (const auto &face : faces_of<dim>(scene.specimen, a.boundary)) {
    all += core::face_area<dim>(face);
    common += core::face_area<dim>(part_b.clip(part_a.clip(face)));
  }
  return common > 1e-12 * all;
}

/// Smallest box around the loaded part of the side; nothing where there is none.
template <int dim>
std::optional<Box> box_of(const Scene &scene, const LoadParameters &load)
{
  const auto part = part_with_area<dim>(scene, load);
  std::vector<Point> points;
  for (const auto &face : faces_of<dim>(scene.specimen, load.boundary))
    for (const auto &x : part.clip(face)) {
      Point p = {0, 0, 0};
      for (int c = 0; c < dim; ++c)
        p[c] = x[c];
      points.push_back(p);
    }
  if (points.empty())
    return {};
  return bounding_box(points);
}

template <int dim>
std::vector<Point> corners_of(const Scene &scene, const LoadParameters &load)
{
  std::vector<Point> points;
  for (const auto &face : faces_of<dim>(scene.specimen, load.boundary))
    for (const auto &x : face) {
      Point p = {0, 0, 0};
      std::copy(x.data(), x.data() + dim, p.begin());
      points.push_back(p);
    }
  return points;
}

std::optional<Box> box_of(const Scene &scene, const LoadParameters &load)
{
  return scene.dimension == 2 ? box_of<2>(scene, load) : box_of<3>(scene, load);
}

/// Boxes around pieces of the loaded part: those of slanted faces are short, so that the boxes are
/// near to them.
template <int dim>
std::vector<Box> pieces_of(const Scene &scene, const LoadParameters &load)
{
  constexpr int n = 16;
  const auto part = part_with_area<dim>(scene, load);
  std::vector<Box> pieces;
  for (const auto &face : faces_of<dim>(scene.specimen, load.boundary)) {
    const auto clipped = part.clip(face);
    const bool is_slanted = axis_across(load, dim) < 0 && dim == 2 && clipped.size() == 2;
    for (int k = 0; k < (is_slanted ? n : 1) && !clipped.empty(); ++k) {
      std::vector<Point> points;
      for (std::size_t c = 0; c < clipped.size(); ++c) {
        const Vector<dim> x =
            is_slanted
                ? Vector<dim>(clipped[0] + double(k + int(c)) / n * (clipped[1] - clipped[0]))
                : clipped[c];
        Point p = {0, 0, 0};
        std::copy(x.data(), x.data() + dim, p.begin());
        points.push_back(p);
      }
      pieces.push_back(bounding_box(points));
    }
  }
  return pieces;
}

std::vector<Box> pieces_of(const Scene &scene, const LoadParameters &load)
{
  return scene.dimension == 2 ? pieces_of<2>(scene, load) : pieces_of<3>(scene, load);
}

/// Up to which value at most `most` the condition holds, if it does at 0.
template <typename Holds>
double largest(double most, Holds &&holds)
{
  if (!holds(0.))
    return -infinity;
  double low = 0, high = most;
  if (holds(most))
    return most;
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (holds(middle) ? low : high) = middle;
  }
  return low;
}

bool is_point_like(const LoadParameters &load, int dim)
{
  const int axis = axis_across(load, dim);
  if (load.from && load.to && *load.from == *load.to)
    return true;
  for (int c = 0; c < dim; ++c)
    if (c != axis && load.within.lower[c] == load.within.upper[c])
      return true;
  return false;
}

/// The keys of the part for themselves.
void check_part_keys(const Scene &scene, const LoadParameters &load, const std::string &key,
                     Findings &f)
{
  const Region &w = load.within;
  const bool has_range = load.from || load.to;
  if (has_range && !w.is_everything())
    f.error(key + "/within", fmt::format("both \"within\" and \"from\" or \"to\" in {}", key),
            "they are two ways to say on which part of the side the load acts", "keep one of them");
  if (has_range && axis_across(load, scene.dimension) < 0)
    f.error(key + "/from",
            fmt::format("\"from\" or \"to\" in {}, on the side \"{}\"", key, load.side),
            "only sides of the box around the specimen have one coordinate along them",
            "give \"within\"");
  if (load.from && load.to && *load.from > *load.to)
    f.error(key + "/to", fmt::format("\"to\" in {} is below \"from\"", key),
            fmt::format("the part would go from {} m to {} m", *load.from, *load.to), "swap them");
  check_within(scene, w, key, f);
  const bool is_part = has_range || !w.is_everything();
  if (load.absorbing && is_part)
    f.error(key + "/absorbing", fmt::format("\"absorbing\" on a part of a side in {}", key),
            "only whole sides let waves out", "let the load act on the whole side");
}
} // namespace

void check_within(const Scene &scene, const Region &within, const std::string &key, Findings &f)
{
  const std::string region = key + "/within";
  const auto &centre = within.centre;
  const int dim = scene.dimension;
  const auto n_coordinates = std::count_if(centre.begin(), centre.begin() + dim,
                                           [](const auto &x) { return x.has_value(); });
  if ((n_coordinates > 0) != within.is_ball())
    return f.error(region,
                   fmt::format("\"within\" in {} has one of \"centre\" and \"radius\"", key),
                   "a ball needs both", "give both, or \"lower\" and \"upper\" of a box");
  if (within.is_ball() && n_coordinates < dim)
    return f.error(region + "/centre", fmt::format("\"centre\" in {} lacks a coordinate", region),
                   "a ball lies about a point", "give all coordinates");
  const Region plain;
  if (within.is_ball() && (within.lower != plain.lower || within.upper != plain.upper))
    return f.error(region, fmt::format("a box and a ball in {}", region),
                   "they are two ways to say where", "keep one of them");
  for (int c = 0; c < dim; ++c)
    if (within.lower[c] > within.upper[c])
      return f.error(region, fmt::format("\"within\" in {} is empty in {}", key, "xyz"[c]),
                     fmt::format("it goes from {} m to {} m", within.lower[c], within.upper[c]),
                     "give \"lower\" below \"upper\"");
}

bool act_on_common_area(const Scene &scene, const LoadParameters &a, const LoadParameters &b)
{
  return scene.dimension == 2 ? share_area<2>(scene, a, b) : share_area<3>(scene, a, b);
}

void check_history(const Scene &scene, const LoadParameters &load, const std::string &key,
                   Findings &f)
{
  const History &h = load.history;
  const std::string history = key + "/history";
  const bool is_late = load.ramp > scene.time.duration && f.sound_and_given({"/time/duration"});
  if (is_late)
    f.warning(key + "/ramp",
              fmt::format("\"ramp\" in {} is {} s, longer than the duration", key, load.ramp),
              "what grows by it will not reach its value", "run longer, or give a shorter ramp");
  if (!h.is_given() || !f.sound({history}))
    return;
  if (int(!h.table.empty()) + int(h.pulse.has_value()) + int(h.cycles.has_value()) > 1)
    return f.error(history,
                   fmt::format("{} has several of \"table\", \"pulse\", \"cycles\"", history),
                   "a load has one course in time", "keep one; a table describes any course");
  if (load.ramp > 0 && !h.cycles)
    f.error(key + "/ramp", fmt::format("both \"ramp\" and \"history\" in {}", key),
            "the history says how the load grows; only cycles have a ramp, to their mean",
            "remove one of them");
  for (std::size_t k = 0; k < h.table.size(); ++k)
    if (k == 0 ? h.table[k][0] < 0 : h.table[k][0] <= h.table[k - 1][0])
      return f.error(
          fmt::format("{}/table/{}", history, k),
          fmt::format("row {} of \"table\" in {} is at {} s", k + 1, history, h.table[k][0]),
          k == 0 ? "runs begin at 0 s"
                 : fmt::format("the row before is at {} s", h.table[k - 1][0]),
          "give times from 0 on that rise from row to row");
  if (!f.sound_and_given({"/time/duration"}))
    return;
  const double end = scene.time.duration;
  const std::string remedy = "run longer, unless the rest of it is not wanted";
  if (h.pulse && h.pulse->start >= end)
    f.error(history + "/pulse/start",
            fmt::format("the pulse in {} begins at {} s, after the end of the run", key,
                        h.pulse->start),
            fmt::format("/time/duration is {} s", end), "begin it earlier, or run longer");
  else if (h.pulse && h.pulse->start + h.pulse->duration > end)
    f.warning(history + "/pulse/duration",
              fmt::format("the pulse in {} ends at {} s, after the end of the run", key,
                          h.pulse->start + h.pulse->duration),
              fmt::format("/time/duration is {} s", end), remedy);
  if (!h.table.empty() && h.table.back()[0] > end)
    f.warning(history + "/table",
              fmt::format("the table in {} goes on until {} s, after the end of the run", history,
                          h.table.back()[0]),
              fmt::format("/time/duration is {} s", end), remedy);
  if (h.cycles && load.ramp + h.cycles->period > end && !is_late)
    f.warning(history + "/cycles/period",
              fmt::format("the run ends within the first cycle of {}", key),
              fmt::format("/time/duration is {} s", end), remedy);
}

void check_part(const Scene &scene, const LoadParameters &load, const std::string &key, Findings &f)
{
  check_part_keys(scene, load, key, f);
  if (!f.sound({key, "/specimen"}))
    return;
  const std::string part = load.from || load.to ? key + "/from" : key + "/within";
  const bool has_force =
      std::any_of(load.force.begin(), load.force.end(), [](const auto &x) { return bool(x); });
  if (is_point_like(load, scene.dimension) && !has_force)
    return f.error(part, fmt::format("the part of the side in {} has no width", key),
                   "only a force may act at a point or on a line",
                   "give a \"force\", or the part a width");
  if (box_of(scene, load))
    return;
  std::string where;
  const auto faces = scene.dimension == 2 ? corners_of<2>(scene, load) : corners_of<3>(scene, load);
  if (faces.empty())
    return f.error(key + "/boundary",
                   fmt::format("nothing of the specimen lies on its side \"{}\"", load.side),
                   "it touches that side of the box around it at a point, an edge or not at all",
                   scene.specimen.body
                       ? "load another side, or name a part of the surface in the file (gmsh)"
                       : "name a side of the outline, and load that");
  const Box side = bounding_box(faces);
  for (int c = 0; c < scene.dimension; ++c)
    where += fmt::format(
        "{}{} {:.6g} m{}", where.empty() ? "" : ", ", "xyz"[c], side.lower[c],
        side.lower[c] == side.upper[c] ? "" : fmt::format(" to {:.6g} m", side.upper[c]));
  f.error(part, fmt::format("{} acts on no part of the side \"{}\"", key, load.side),
          "the side lies at " + where, "move the part onto the side");
}

void check_part_against_overlap(const Scene &scene, const LoadParameters &load,
                                const std::string &key, const Layout &layout, Findings &f)
{
  const int axis = axis_across(load, scene.dimension);
  if (!layout.coupled || (axis >= 0 && layout.coupled_side[load.boundary]))
    return;
  const auto zone = zone_shape<3>(scene);
  const double tolerance = 1e-9 * layout.cell_size;
  // Within the zone: off the overlap and the cells that reach into it. Beside it: off the
  // transition, whose cells the coupler has.
  const double margin_inside = layout.overlap + 2 * scene.zone.spacing,
               margin_beside = (scene.coupling.transition_cells + 1) * layout.cell_size;
  double missing = 0; // of the piece of the side that lies worst
  for (const Box &piece : pieces_of(scene, load)) {
    const Vector<3> lower(piece.lower.data()), upper(piece.upper.data());
    const double inside = largest(margin_inside, [&](double margin) {
      return zone.eroded(margin).covers(lower, upper, tolerance);
    });
    const double beside = largest(margin_beside, [&](double margin) {
      Vector<3> far = Vector<3>::Constant(margin);
      if (axis >= 0)
        far[axis] = 0;
      return !zone.meets(lower - far, upper + far, tolerance);
    });
    missing = std::max(missing, std::min(margin_inside - inside, margin_beside - beside));
  }
  if (missing == 0)
    return;
  f.error(key + "/boundary",
          fmt::format("\"boundary\" in {}: the loaded part of the side \"{}\" is too near to the "
                      "end of the overlap there",
                      key, load.side),
          missing < infinity
              ? fmt::format("{:.4g} m are missing: within the zone it keeps {:.4g} m from the "
                            "zone's edge (the overlap and two spacings), beside it {:.4g} m (the "
                            "transition and a cell)",
                            missing, margin_inside, margin_beside)
              : "it lies across the edge of the zone, where both models are one body",
          "move the part or the zone's edge, or make the overlap or the transition narrower");
}
} // namespace ligament::program
