#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ligament::program
{
namespace
{
using Extent = DiscreteZone::Extent;

const std::string zone_key = "/discrete_zone", far_key = "/far_field",
                  region_key = "/discrete_zone/region", boxes_key = "/discrete_zone/boxes",
                  spacing_key = "/discrete_zone/spacing", cell_key = "/far_field/cell_size",
                  size_key = "/specimen/size";

constexpr const char *axis_names = "xyz";

bool is_coupled(const Scene &scene)
{
  return scene.zone.extent == Extent::box && scene.far_field.has_value();
}

Box box_of(const Specimen &specimen)
{
  Box box;
  for (int c = 0; c < 3; ++c) {
    box.lower[c] = -specimen.size[c] / 2;
    box.upper[c] = specimen.size[c] / 2;
  }
  return box;
}

/// Both models must be able to exist: the keys that are needed only then.
void check_models(const Scene &scene, Findings &f)
{
  if (!f.given(zone_key) || !f.sound({zone_key + "/extent"}))
    return;
  const bool no_far = !scene.far_field.has_value();
  if (scene.zone.extent == Extent::none) {
    if (no_far && f.sound({far_key}))
      f.error(far_key, "neither \"discrete_zone\" nor \"far_field\" is there",
              "a scene needs at least one of the two models", "give one of them");
    return;
  }
  if (scene.zone.extent == Extent::box && no_far && f.sound({far_key}))
    f.error(far_key, "missing key \"far_field\" in /",
            "the discrete zone is a part of the specimen, the rest needs finite elements",
            "add \"far_field\": {\"cell_size\": ..}, or \"far_field\": \"none\" for the pure "
            "discrete reference");
  if (scene.zone.extent == Extent::box && !f.given(region_key) && scene.zone.boxes.empty() &&
      f.sound({region_key, boxes_key}))
    f.error(region_key, "missing key \"region\" in /discrete_zone",
            "it says which part of the specimen is discrete",
            "add \"region\": {\"lower\": [..], \"upper\": [..]}, or \"extent\": \"all\"");
  for (const std::string key : {"packing", "spacing"})
    if (!f.given(zone_key + "/" + key) && f.sound({zone_key + "/" + key}))
      f.error(zone_key + "/" + key, fmt::format("missing key \"{}\" in /discrete_zone", key),
              "scenes with discrete elements need it", fmt::format("add \"{}\"", key));
}

/// Keys that belong to another packing than the one that was chosen; their defaults do no harm.
void check_packing_keys(const Scene &scene, Findings &f)
{
  const DiscreteZone &zone = scene.zone, plain;
  const std::string &packing = zone.packing;
  const auto refuse = [&](const std::string &name, const std::string &needed, bool differs) {
    const std::string key = zone_key + "/" + name;
    if (packing != needed && differs && f.sound({key}))
      f.error(key,
              fmt::format("\"{}\" in /discrete_zone has no meaning for the packing \"{}\"", name,
                          packing),
              fmt::format("only the packing \"{}\" has one", needed),
              fmt::format("remove it, or choose the packing \"{}\"", needed));
  };
  refuse("seed", "random", zone.seed != plain.seed);
  refuse("relaxation_sweeps", "random", zone.relaxation_sweeps != plain.relaxation_sweeps);
  refuse("size_ratio", "random", zone.size_ratio != plain.size_ratio);
  refuse("packing_file", "file", !zone.packing_file.empty());
  if (packing == "file" && zone.packing_file.empty() && f.sound({zone_key + "/packing_file"}))
    f.error(zone_key + "/packing",
            "\"packing\" in /discrete_zone is \"file\", but there is no \"packing_file\"",
            "the particles stand in a file", "add \"packing_file\"");
  if (zone.is_irregular() && zone.orientation != plain.orientation &&
      f.sound({zone_key + "/orientation"}))
    f.error(zone_key + "/orientation",
            fmt::format("\"orientation\" in /discrete_zone has no meaning for the packing \"{}\"",
                        packing),
            "only lattices have rows to turn", "remove it");
}

void check_packing(const Scene &scene, Findings &f)
{
  const std::string key = zone_key + "/packing";
  if (!f.sound_and_given({"/discrete_zone/packing"}))
    return;
  check_packing_keys(scene, f);
  if (!f.sound({"/dimension"}) || scene.zone.is_irregular())
    return;
  const bool plane = scene.zone.packing == "square" || scene.zone.packing == "hexagonal";
  if (plane != (scene.dimension == 2))
    f.error(key,
            fmt::format("\"packing\" in /discrete_zone is \"{}\", which is not a packing in {}D",
                        scene.zone.packing, scene.dimension),
            fmt::format("/dimension is {}", scene.dimension),
            scene.dimension == 2 ? "choose \"hexagonal\", \"square\" or \"random\""
                                 : "choose \"fcc\", \"simple_cubic\" or \"random\"");
}

void check_time(const Scene &scene, Findings &f)
{
  if (f.given("/time/step") && f.given("/time/step_fraction"))
    f.error("/time/step", "both \"step\" and \"step_fraction\" in /time",
            "they are two ways to say the same", "remove one of them");
  else if (f.sound_and_given({"/time/step", "/time/duration"}) &&
           *scene.time.step > scene.time.duration)
    f.error("/time/step",
            fmt::format("\"step\" in /time is {} s, longer than the duration of {} s",
                        *scene.time.step, scene.time.duration),
            "nothing would be computed", "give a smaller step, or none");
  if (f.sound({"/time/stop_when", "/material/fracture/criterion"}) &&
      scene.time.stop_when == "specimen_broken" && scene.material.fracture.criterion == "none")
    f.warning("/time/stop_when", "\"stop_when\" in /time waits for a fracture that cannot happen",
              "the fracture criterion is \"none\"", "");
}

/// The spacing against the specimen: enough particles to be a body, not more than fit an index.
void check_spacing(const Scene &scene, const Box &zone, Findings &f)
{
  const double d = scene.zone.spacing;
  double number = 1;
  for (int c = 0; c < scene.dimension; ++c) {
    number *= (zone.upper[c] - zone.lower[c]) / d;
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
  if (scene.zone.extent != Extent::box)
    return layout;
  layout.coupled = is_coupled(scene);
  bool any_side = false;
  for (int c = 0; c < scene.dimension; ++c) {
    const double lower = scene.zone.lower[c], upper = scene.zone.upper[c];
    const double tolerance = 1e-9 * scene.specimen.size[c];
    if (lower >= upper) {
      f.error(region_key, fmt::format("\"region\" in /discrete_zone is empty in {}", axis_names[c]),
              fmt::format("it goes from {} m to {} m", lower, upper),
              "give \"lower\" below \"upper\"");
      return {};
    }
    if (lower >= specimen.upper[c] - tolerance || upper <= specimen.lower[c] + tolerance) {
      f.error(
          region_key,
          fmt::format("\"region\" in /discrete_zone is outside the specimen in {}", axis_names[c]),
          fmt::format("it goes from {} m to {} m, the specimen from {} m to {} m", lower, upper,
                      specimen.lower[c], specimen.upper[c]),
          "move it; the specimen is centred at the origin");
      return {};
    }
    layout.zone.lower[c] = std::max(lower, specimen.lower[c]);
    layout.zone.upper[c] = std::min(upper, specimen.upper[c]);
    layout.coupled_side[2 * c] = lower > specimen.lower[c] + tolerance;
    layout.coupled_side[2 * c + 1] = upper < specimen.upper[c] - tolerance;
    any_side = any_side || layout.coupled_side[2 * c] || layout.coupled_side[2 * c + 1];
  }
  if (!any_side && layout.coupled && scene.zone.boxes.empty()) {
    f.error(region_key,
            "\"region\" in /discrete_zone covers the whole specimen: no overlap with /far_field",
            "no place is left for the far field",
            "make it smaller, or write \"far_field\": \"none\"");
    return {};
  }
  return layout;
}

void check_ratio(const Scene &scene, Findings &f)
{
  const double ratio = scene.far_field->cell_size / scene.zone.spacing;
  const std::string message = fmt::format(
      "\"cell_size\" in /far_field is {:.4g} times the \"spacing\" in /discrete_zone", ratio);
  const auto remedy = [&](double low, double high) {
    return fmt::format("give a cell_size from {:.4g} m to {:.4g} m", low * scene.zone.spacing,
                       high * scene.zone.spacing);
  };
  // A ratio that was meant as 2 or 16 may miss it by rounding.
  if (ratio < 2 - 1e-9 || ratio > 16 + 1e-9)
    f.error(cell_key, message, "the overlap works for ratios from 2 to 16", remedy(2.5, 8));
  else if (ratio < 2.5 - 1e-9 || ratio > 8 + 1e-9)
    f.warning(cell_key, message, "ratios from 2.5 to 8 were measured to be accurate",
              remedy(2.5, 8));
}

/// Light coarse masses: a numerical device for static answers.
void check_coarse_mass(const Scene &scene, Findings &f)
{
  const std::string key = "/coupling/coarse_mass";
  if (!f.sound_and_given({key}) || scene.coupling.coarse_mass == 1)
    return;
  const auto &damping = scene.damping;
  if (f.sound({"/damping"}) && damping.local == 0 && damping.mass == 0 && !damping.kinetic)
    f.error(key,
            fmt::format("\"coarse_mass\" in /coupling is {:.4g} without damping",
                        scene.coupling.coarse_mass),
            "waves would travel faster in the far field than in the discrete zone: only static "
            "answers do not depend on masses",
            "leave it out, or add \"kinetic\": true, \"local\" or \"mass\" to /damping");
  if (f.sound({"/loads"}) && std::any_of(scene.loads.begin(), scene.loads.end(),
                                         [](const auto &l) { return l.absorbing; }))
    f.error(key, "\"coarse_mass\" in /coupling together with an absorbing side",
            "absorbing sides are matched to the waves of the true masses",
            "leave out one of the two");
  const double lowest = scene.zone.spacing / scene.far_field->cell_size;
  if (f.sound({cell_key, spacing_key}) && scene.coupling.coarse_mass < lowest * (1 - 1e-9))
    f.error(key,
            fmt::format("\"coarse_mass\" in /coupling is {:.4g}, below spacing/cell_size",
                        scene.coupling.coarse_mass),
            "the coarse motion would need a smaller step than the particles",
            fmt::format("give at least {:.4g}", lowest));
}

/// Room for the overlaps inside the zone and for the far field beside it.
void check_widths(const Scene &scene, const Layout &layout, Findings &f)
{
  const double h = layout.cell_size, d = scene.zone.spacing;
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
          region_key,
          fmt::format("\"region\" in /discrete_zone is {:.4g} m wide in {}, too thin for {}", width,
                      axis_names[c], low && high ? "two overlaps" : "its overlap"),
          fmt::format("an overlap takes {} cells of {} m, and 8 spacings must lie between",
                      scene.coupling.overlap_cells, h),
          fmt::format("give more than {:.4g} m, or a smaller cell_size or overlap_cells", needed));
    for (const bool upper : {false, true}) {
      if (!(upper ? high : low))
        continue;
      const double gap = upper ? layout.specimen.upper[c] - layout.zone.upper[c]
                               : layout.zone.lower[c] - layout.specimen.lower[c];
      if (gap < largest * (1 - 1e-9))
        f.error(
            region_key,
            fmt::format("the far field beside the \"region\" in /discrete_zone is only {:.4g} m "
                        "wide at the {} end of {}",
                        gap, upper ? "upper" : "lower", axis_names[c]),
            fmt::format("its largest cells are {:.4g} m (cell_size times 2^levels)", largest),
            "use fewer levels, or let the region end elsewhere or reach through (null)");
    }
  }
}

/// Each of several boxes for itself: inside the specimen, and wide enough.
bool check_boxes(const Scene &scene, Layout &layout, Findings &f)
{
  layout.boxes = zone_shape<3>(scene);
  if (scene.zone.is_irregular()) {
    f.error(boxes_key, "\"boxes\" in /discrete_zone with an irregular packing",
            "only lattice packings can fill a zone of several boxes yet",
            "choose a lattice packing, or one \"region\"");
    return false;
  }
  const Vector<3> lower(layout.specimen.lower.data()), upper(layout.specimen.upper.data());
  if (layout.boxes.covers(lower, upper, 1e-9 * scene.specimen.size[0])) {
    f.error(boxes_key,
            "\"boxes\" in /discrete_zone cover the whole specimen: no overlap with /far_field",
            "no place is left for the far field",
            "make one smaller, or write \"far_field\": \"none\"");
    return false;
  }
  const double d = scene.zone.spacing;
  bool right = true;
  for (std::size_t i = 0; i < scene.zone.boxes.size(); ++i) {
    const std::string key = fmt::format("{}/{}", boxes_key, i);
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
        refuse(c, "is outside the specimen", "move it; the specimen is centred at the origin");
      else if (std::min(box.upper[c], layout.specimen.upper[c]) -
                   std::max(box.lower[c], layout.specimen.lower[c]) <=
               needed)
        refuse(c, "is too thin for its overlaps and 8 spacings between",
               fmt::format("give more than {:.4g} m, or a smaller cell_size or overlap_cells",
                           needed));
    }
  }
  return right;
}

/// Keys that only some schemes read, and what the scheme cannot do.
void check_scheme(const Scene &scene, Findings &f)
{
  if (!f.sound({"/coupling/scheme"}))
    return;
  const bool weighted = coupling::is_energy_weighted(scene.coupling.scheme);
  const std::string name = coupling::scheme_names[int(scene.coupling.scheme)];
  if (weighted && f.sound({"/coupling/step_ratio"}) && scene.coupling.step_ratio > 1)
    f.error("/coupling/step_ratio",
            fmt::format("\"step_ratio\" in /coupling is {}, but \"{}\" takes no steps of its own "
                        "in the far field",
                        scene.coupling.step_ratio, name),
            "its constraint joins all velocities in every step", "give 1");
  if (const std::string &regime = scene.coupling.regime;
      weighted && (regime == "corotated" || regime == "nonlinear"))
    f.error("/coupling/regime",
            fmt::format("\"regime\" in /coupling is \"{}\", but \"{}\" is linear", regime, name),
            "energy-weighted schemes have no other regime",
            "leave it out, or choose \"fine_scale_split\"");
  const std::vector<std::string> split = {"gap_filter", "patch_fit", "coarse_mass"},
                                 literature = {"weight", "damper_form", "multiplier_cells",
                                               "ghost_force_correction"};
  for (const std::string &key : weighted ? split : literature)
    if (f.given("/coupling/" + key))
      f.warning("/coupling/" + key, fmt::format("\"{}\" in /coupling is not used", key),
                fmt::format("the scheme is \"{}\"", name), "");
}

std::optional<Layout> check_layout(const Scene &scene, const Box &specimen, Findings &f)
{
  if (!f.sound({zone_key + "/extent"}))
    return {};
  const bool particles = scene.zone.extent != Extent::none;
  const bool mesh = scene.zone.extent != Extent::all && scene.far_field.has_value();
  if (particles && !f.sound({region_key, boxes_key}))
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
  check_ratio(scene, f);
  check_coarse_mass(scene, f);
  check_scheme(scene, f);
  if (scene.coupling.scheme == coupling::Scheme::none)
    f.warning("/coupling/scheme",
              "\"scheme\" in /coupling is \"none\": the two models do not feel "
              "each other",
              "they overlap but are not joined", "");
  if (f.sound({"/coupling/regime", "/coupling/scheme"}) &&
      scene.coupling.scheme == coupling::Scheme::none && scene.coupling.regime == "nonlinear")
    f.error("/coupling/regime", "\"regime\" in /coupling is \"nonlinear\" without a coupler",
            "it is about the energy of the overlap, and \"scheme\" is \"none\"",
            "choose \"corotated\" for a far field that turns, or another scheme");
  if (!layout || !f.sound({cell_key, spacing_key, "/far_field/levels", "/coupling/overlap_cells"}))
    return {};
  layout->cell_size = scene.far_field->cell_size;
  layout->overlap = scene.coupling.overlap_cells * layout->cell_size;
  if (!scene.zone.boxes.empty())
    return check_boxes(scene, *layout, f) ? layout : std::nullopt;
  check_widths(scene, *layout, f);
  return f.sound({region_key}) ? layout : std::nullopt;
}
} // namespace

void check_fracture(const FractureParameters &fracture, const std::string &section,
                    const DiscreteZone &zone, Findings &f)
{
  const bool strength = f.given(section + "/strength"), toughness = f.given(section + "/toughness");
  if (strength && toughness)
    f.error(section + "/toughness",
            fmt::format("both \"strength\" and \"toughness\" in {}", section),
            "the strength of a bond follows from the toughness", "remove one of them");
  if (toughness && zone.packing == "file")
    f.error(section + "/toughness",
            fmt::format("\"toughness\" in {} cannot be used with the packing \"file\"", section),
            "the factor between toughness and strength is calibrated on samples of a packing, "
            "which a file cannot give",
            "give the \"strength\" of a face");
  if (!f.sound({section + "/criterion"}))
    return;
  if (fracture.criterion == "none" && (strength || toughness))
    f.warning(section + (strength ? "/strength" : "/toughness"),
              "\"strength\" and \"toughness\" are not used", "the \"criterion\" is \"none\"", "");
  if (fracture.criterion != "none" && !strength && !toughness && f.sound({section}))
    f.error(section + "/criterion",
            fmt::format("\"criterion\" in {} has neither \"strength\" nor \"toughness\"", section),
            "it needs to know when a bond breaks", "add one of them, or choose \"none\"");
}

void check_scene(const Scene &scene, Findings &f)
{
  check_models(scene, f);
  check_packing(scene, f);
  check_fracture(scene.material.fracture, "/material/fracture", scene.zone, f);
  check_time(scene, f);
  if (!f.sound({"/dimension"}))
    return;
  std::optional<Layout> layout;
  if (f.sound({size_key})) {
    const Box specimen = box_of(scene.specimen);
    layout = check_layout(scene, specimen, f);
    check_cuts(scene, specimen, layout ? &*layout : nullptr, f);
    check_inclusions(scene, specimen, layout ? &*layout : nullptr, f);
  }
  check_loads(scene, layout ? &*layout : nullptr, f);
}
} // namespace ligament::program
