// Where the models lie: the zone and its overlaps inside the specimen, and room for the far field.
#include "src/scene/check_scene.h"
#include "src/scene/zone_around.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
using Extent = DiscreteZone::Extent;

const std::string zone_key = "/discrete_zone", far_key = "/far_field",
                  region_key = "/discrete_zone/region", boxes_key = "/discrete_zone/boxes",
                  spacing_key = "/discrete_zone/spacing", cell_key = "/far_field/cell_size";

constexpr const char *axis_names = "xyz";

/// What messages call the key that says where the zone is.
std::string name_of(const std::string &place)
{
  return fmt::format("\"{}\" in /discrete_zone", place.substr(zone_key.size() + 1));
}

bool is_coupled(const Scene &scene)
{
  return scene.zone.extent == Extent::box && scene.far_field.has_value();
}

/// The spacing against the specimen: enough particles to be a body, not more than fit an index.
void check_spacing(const Scene &scene, const Box &zone, Findings &f)
{
  const double d = scene.zone.spacing;
  double number = 1;
  for (int c = 0; c < scene.dimension; ++c) {
    number *= (zone.upper[c] - zone.lower[c]) / d;
    if (scene.specimen.size[c] < 4 * d && scene.atoms) {
      if (scene.specimen.is_periodic(c) && scene.specimen.size[c] >= 2 * d)
        continue; // atoms may meet several images of each other
      f.error(
          "/specimen/size",
          fmt::format("the specimen is {:.4g} m long in {}", scene.specimen.size[c], axis_names[c]),
          fmt::format("that is less than {} spacings of the crystal, {:.4g} m",
                      scene.specimen.is_periodic(c) ? 2 : 4, d),
          "make it longer");
      return;
    }
    if (scene.specimen.size[c] < 4 * d) {
      f.error(spacing_key,
              fmt::format("\"spacing\" in /discrete_zone is {} m, more than a quarter of the "
                          "specimen in {}",
                          d, axis_names[c]),
              fmt::format("the specimen is {} m there", scene.specimen.size[c]),
              fmt::format("give at most {:.4g} m", scene.specimen.size[c] / 4));
      return;
    }
  }
  if (number > 1e9)
    f.error(spacing_key,
            fmt::format("\"spacing\" in /discrete_zone is {} m, which makes about {:.1e} particles",
                        d, number),
            "more than 1e9 cannot be numbered", "give a larger spacing, or check its unit");
}

/// Where the zone lies; empty when its region is impossible.
std::optional<Layout> check_region(const Scene &scene, const Box &specimen, Findings &f)
{
  Layout layout;
  layout.dim = scene.dimension;
  layout.specimen = layout.zone = specimen;
  layout.place = zone_place(scene);
  const std::string &place = layout.place, name = name_of(place);
  if (scene.zone.extent != Extent::box)
    return layout;
  layout.coupled = is_coupled(scene);
  bool any_side = false;
  for (int c = 0; c < scene.dimension; ++c) {
    const double lower = scene.zone.lower[c], upper = scene.zone.upper[c];
    const double tolerance = 1e-9 * scene.specimen.size[c];
    if (lower >= upper) {
      f.error(place, fmt::format("{} is empty in {}", name, axis_names[c]),
              fmt::format("it goes from {} m to {} m", lower, upper),
              "give \"lower\" below \"upper\"");
      return {};
    }
    if (lower >= specimen.upper[c] - tolerance || upper <= specimen.lower[c] + tolerance) {
      f.error(place, fmt::format("{} is outside the specimen in {}", name, axis_names[c]),
              fmt::format("it goes from {} m to {} m, the specimen from {} m to {} m", lower, upper,
                          specimen.lower[c], specimen.upper[c]),
              "move it into the specimen");
      return {};
    }
    layout.zone.lower[c] = std::max(lower, specimen.lower[c]);
    layout.zone.upper[c] = std::min(upper, specimen.upper[c]);
    layout.coupled_side[2 * c] = lower > specimen.lower[c] + tolerance;
    layout.coupled_side[2 * c + 1] = upper < specimen.upper[c] - tolerance;
    any_side = any_side || layout.coupled_side[2 * c] || layout.coupled_side[2 * c + 1];
  }
  if (!any_side && layout.coupled && scene.zone.boxes.empty()) {
    f.error(place, name + " covers the whole specimen: no overlap with /far_field",
            "no place is left for the far field",
            "make it smaller, or write \"far_field\": \"none\"");
    return {};
  }
  return layout;
}

/// Room for the overlaps inside the zone and for the far field beside it.
void check_widths(const Scene &scene, const Layout &layout, Findings &f)
{
  const double h = layout.cell_size, d = scene.zone.spacing;
  const std::string name = name_of(layout.place);
  const FarField &far = *scene.far_field;
  const double largest = far.growth > 1 ? h : h * std::pow(2.0, far.levels);
  for (int c = 0; c < layout.dim; ++c) {
    const bool low = layout.coupled_side[2 * c], high = layout.coupled_side[2 * c + 1];
    if (!low && !high)
      continue;
    const double width = layout.zone.upper[c] - layout.zone.lower[c];
    const double needed = (low + high) * layout.overlap + 8 * d;
    if (width <= needed)
      f.error(
          layout.place,
          fmt::format("{} is {:.4g} m wide in {}, too thin for {}", name, width, axis_names[c],
                      low && high ? "two overlaps" : "its overlap"),
          fmt::format("an overlap takes {} cells of {} m, and 8 spacings must lie between",
                      scene.coupling.overlap_cells, h),
          fmt::format("give more than {:.4g} m, or a smaller cell_size or overlap_cells", needed));
    for (const bool upper : {false, true}) {
      if (!(upper ? high : low))
        continue;
      const double gap = upper ? layout.specimen.upper[c] - layout.zone.upper[c]
                               : layout.zone.lower[c] - layout.specimen.lower[c];
      if (gap < largest * (1 - 1e-9))
        f.error(layout.place,
                fmt::format("the far field beside the {} is only {:.4g} m wide at the {} end of {}",
                            name, gap, upper ? "upper" : "lower", axis_names[c]),
                fmt::format("its largest cells are {:.4g} m (cell_size times 2^levels)", largest),
                "use fewer levels, or let the zone end elsewhere or reach through (null)");
    }
  }
}

/// Each of several boxes for itself: inside the specimen, and wide enough.
bool check_boxes(const Scene &scene, Layout &layout, Findings &f)
{
  layout.boxes = zone_shape<3>(scene);
  const Vector<3> lower(layout.specimen.lower.data()), upper(layout.specimen.upper.data());
  if (layout.boxes.covers(lower, upper, 1e-9 * scene.specimen.size[0])) {
    f.error(layout.place,
            name_of(layout.place) + " cover the whole specimen: no overlap with /far_field",
            "no place is left for the far field",
            "make one smaller, or write \"far_field\": \"none\"");
    return false;
  }
  const double d = scene.zone.spacing;
  bool right = true;
  for (std::size_t i = 0; i < scene.zone.boxes.size(); ++i) {
    const std::string key = scene.zone.around ? layout.place : fmt::format("{}/{}", boxes_key, i);
    const auto &box = layout.boxes.boxes[i];
    const auto refuse = [&](int c, const std::string &what, const std::string &remedy) {
      f.error(key, fmt::format("{} {} in {}", key, what, axis_names[c]),
              fmt::format("it goes from {} m to {} m, the specimen from {} m to {} m",
                          scene.zone.boxes[i].lower[c], scene.zone.boxes[i].upper[c],
                          layout.specimen.lower[c], layout.specimen.upper[c]),
              remedy);
      right = false;
    };
    for (int c = 0; c < layout.dim; ++c) {
      const double width = box.upper[c] - box.lower[c];
      const int n_overlaps = std::isfinite(box.lower[c]) + std::isfinite(box.upper[c]);
      const double needed = n_overlaps * layout.overlap + 8 * d;
      if (width <= 0)
        refuse(c, "is empty", "give \"lower\" below \"upper\"");
      else if (box.lower[c] >= layout.specimen.upper[c] || box.upper[c] <= layout.specimen.lower[c])
        refuse(c, "is outside the specimen",
               fmt::format("move it into the specimen, which goes from {} m to {} m",
                           layout.specimen.lower[c], layout.specimen.upper[c]));
      else if (n_overlaps > 0 && std::min(box.upper[c], layout.specimen.upper[c]) -
                                         std::max(box.lower[c], layout.specimen.lower[c]) <=
                                     needed)
        refuse(c, "is too thin for its overlaps and 8 spacings between",
               fmt::format("give more than {:.4g} m, or a smaller cell_size or overlap_cells",
                           needed));
    }
  }
  return right;
}
} // namespace

std::optional<Layout> check_layout(const Scene &scene, const Box &specimen, Findings &f)
{
  if (!f.sound({zone_key + "/extent"}))
    return {};
  const bool particles = scene.zone.extent != Extent::none;
  const bool mesh = scene.zone.extent != Extent::all && scene.far_field.has_value();
  if (particles && !f.sound({region_key, boxes_key, zone_key + "/around"}))
    return {};
  std::optional<Layout> layout = check_region(scene, specimen, f);
  const bool spacing = particles && f.sound_and_given({spacing_key});
  if (layout && spacing)
    check_spacing(scene, layout->zone, f);
  if (mesh)
    check_mesh(scene, is_coupled(scene), f);
  if (!is_coupled(scene))
    return f.sound({far_key}) ? layout : std::nullopt;
  if (!spacing || !f.sound({cell_key}))
    return {};
  check_coupling(scene, f);
  if (!layout || !f.sound({cell_key, spacing_key, "/far_field/levels", "/coupling/overlap_cells"}))
    return {};
  layout->cell_size = scene.far_field->cell_size;
  layout->overlap = scene.coupling.overlap_cells * layout->cell_size;
  if (!scene.zone.boxes.empty())
    return check_boxes(scene, *layout, f) ? layout : std::nullopt;
  check_widths(scene, *layout, f);
  return f.sound({layout->place}) ? layout : std::nullopt;
}
} // namespace ligament::program
