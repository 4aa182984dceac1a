#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
bool has_components(const PartialPoint &value)
{
  return std::any_of(value.begin(), value.end(), [](const auto &x) { return x.has_value(); });
}

/// The keys of a load that have components.
std::vector<std::string> kinds_of(const LoadParameters &load)
{
  std::vector<std::string> kinds;
  if (has_components(load.velocity))
    kinds.push_back("velocity");
  if (has_components(load.displacement))
    kinds.push_back("displacement");
  if (has_components(load.traction))
    kinds.push_back("traction");
  if (has_components(load.force))
    kinds.push_back("force");
  if (load.pressure)
    kinds.push_back("pressure");
  return kinds;
}

bool acts_on(const LoadParameters &load, int c, int dim)
{
  // A pressure may act beside what holds the side along itself.
  const bool presses = load.pressure && (load.boundary >= 2 * dim || load.boundary / 2 == c);
  return load.velocity[c] || load.displacement[c] || load.traction[c] || load.force[c] || presses;
}

/// What "absorbing" excludes, alone and with the loads before.
void check_absorbing(const Scene &scene, std::size_t k, const std::string &key, Findings &f)
{
  const LoadParameters &load = scene.loads[k];
  if (load.absorbing_layer > 0 && !load.absorbing)
    f.error(key + "/absorbing_layer",
            fmt::format("\"absorbing_layer\" in {}, whose side does not absorb", key),
            "the layer belongs to an absorbing side", "set \"absorbing\" to true, or remove it");
  const bool holds = has_components(load.velocity) || has_components(load.displacement);
  if (load.absorbing && !scene.specimen.is_plain())
    f.error(key + "/absorbing", fmt::format("\"absorbing\" in {}", key),
            "only bodies that are boxes let waves out",
            "remove it, or give the specimen a \"size\"");
  if (load.absorbing && holds)
    f.error(key + "/absorbing", fmt::format("\"absorbing\" in {}, which prescribes a motion", key),
            "an absorbing side moves as the waves ask; it can only carry a traction",
            "replace the motion by a traction, or remove \"absorbing\"");
  if (!f.sound({key}))
    return;
  for (std::size_t j = 0; j < k; ++j) {
    const LoadParameters &other = scene.loads[j];
    if (other.boundary != load.boundary)
      continue;
    const bool other_holds = has_components(other.velocity) || has_components(other.displacement);
    if ((load.absorbing && (other.absorbing || other_holds)) || (other.absorbing && holds))
      return f.error(
          key + "/boundary",
          fmt::format("\"boundary\" in {}: side \"{}\" absorbs waves and has another load "
                      "that {}",
                      key, load.side,
                      load.absorbing && other.absorbing ? "absorbs them, too"
                                                        : "prescribes its motion"),
          fmt::format("/loads/{} acts on it already", j), "keep one of the two");
  }
}

/// What an earlier load does to the same component; one is enough to tell.
void check_twice(const Scene &scene, std::size_t k, const std::string &key, Findings &f)
{
  const LoadParameters &load = scene.loads[k];
  for (std::size_t j = 0; j < k; ++j)
    for (int c = 0; c < scene.dimension; ++c)
      if (scene.loads[j].boundary == load.boundary && acts_on(load, c, scene.dimension) &&
          acts_on(scene.loads[j], c, scene.dimension) &&
          act_on_common_area(scene, load, scene.loads[j]))
        return f.error(
            key + "/boundary",
            fmt::format("\"boundary\" in {}: component {} of side \"{}\" is loaded twice", key,
                        "xyz"[c], load.side),
            fmt::format("/loads/{} acts on it already", j),
            "keep one of the two, set the component to null in one, or let them act on parts of "
            "the "
            "side that do not overlap");
}

/// Whether several boxes leave no gap in this side of the specimen, down to a depth in m.
bool cover_side(const Layout &layout, int side, double depth)
{
  Vector<3> lower(layout.specimen.lower.data()), upper(layout.specimen.upper.data());
  const int axis = side / 2;
  if (side % 2)
    lower[axis] = upper[axis] - depth;
  else
    upper[axis] = lower[axis] + depth;
  return layout.boxes.covers(lower, upper, 1e-9 * layout.cell_size);
}

/// The layer must leave room for the overlap and its transition.
void check_layer(const Scene &scene, const LoadParameters &load, const std::string &key,
                 const Layout &layout, Findings &f)
{
  const int side = load.boundary, axis = side / 2;
  const bool upper = side % 2;
  double room = layout.specimen.upper[axis] - layout.specimen.lower[axis];
  if (layout.coupled_side[side])
    room = (upper ? layout.specimen.upper[axis] - layout.zone.upper[axis]
                  : layout.zone.lower[axis] - layout.specimen.lower[axis]) -
           scene.coupling.transition_cells * layout.cell_size;
  else if (layout.coupled)
    room = layout.zone.upper[axis] - layout.zone.lower[axis] - layout.overlap;
  const bool covered = layout.boxes.boxes.empty() || layout.coupled_side[side] ||
                       cover_side(layout, side, load.absorbing_layer + layout.overlap);
  if (load.absorbing_layer > 0 && !covered)
    f.error(
        key + "/absorbing_layer",
        fmt::format("\"absorbing_layer\" in {} reaches into the overlap", key),
        fmt::format("the union of {} is not that deep everywhere behind the side", layout.place),
        "make the layer thinner, or the zone deeper");
  else if (load.absorbing_layer >= room)
    f.error(key + "/absorbing_layer",
            fmt::format("\"absorbing_layer\" in {} is {:.4g} m, more than the {:.4g} m that there "
                        "are between the side and the overlap with its transition",
                        key, load.absorbing_layer, std::max(room, 0.)),
            "the layer may damp only what one model carries alone",
            "make the layer thinner, or move the side away from the zone");
}

void check_against_overlap(const Scene &scene, const LoadParameters &load, const std::string &key,
                           const Layout &layout, Findings &f)
{
  const int side = load.boundary, axis = axis_across(load, layout.dim);
  if (!layout.coupled || (axis >= 0 && layout.coupled_side[side]))
    return;
  if (axis < 0 || load.from || load.to || !load.within.is_everything())
    return check_part_against_overlap(scene, load, key, layout, f);
  if (!layout.boxes.boxes.empty()) {
    if (!cover_side(layout, side, 0))
      f.error(
          key + "/boundary",
          fmt::format("\"boundary\" in {}: the overlap ends at the side \"{}\", which is loaded",
                      key, load.side),
          fmt::format("the union of {} reaches this side and covers a part of it; an overlap may "
                      "end only at free sides",
                      layout.place),
          "end the zone before this side, let it cover the side, or load other sides");
    return;
  }
  // The zone reaches this side. Overlaps along the other axes end on it.
  for (int other = 0; other < 2 * layout.dim; ++other)
    if (other / 2 != axis && layout.coupled_side[other]) {
      f.error(
          key + "/boundary",
          fmt::format("\"boundary\" in {}: the overlap ends at the side \"{}\", which is loaded",
                      key, load.side),
          fmt::format("{} reaches this side and is coupled along \"{}\"; an overlap may end only "
                      "at free sides",
                      layout.place, box_sides[other]),
          "end the zone before this side, or load other sides");
      return;
    }
}
} // namespace

void check_loads(const Scene &scene, const Layout *layout, Findings &f)
{
  for (std::size_t k = 0; k < scene.loads.size(); ++k) {
    const LoadParameters &load = scene.loads[k];
    const std::string key = "/loads/" + std::to_string(k);
    if (!f.sound({key}))
      continue;
    if (load.periodic || has_components(load.strain)) {
      check_jump(scene, k, f);
      continue;
    }
    if (load.boundary < 0) // was told
      continue;
    const std::vector<std::string> kinds = kinds_of(load);
    if (kinds.empty() && !load.absorbing)
      f.error(key,
              fmt::format("{} has no \"velocity\", \"displacement\", \"traction\", \"force\" or "
                          "\"pressure\"",
                          key),
              "a load without components does nothing",
              "add one of them or \"absorbing\", or remove the load");
    if (kinds.size() > 1)
      f.error(key + "/" + kinds[1],
              fmt::format("both \"{}\" and \"{}\" in {}", kinds[0], kinds[1], key),
              "one load is of one kind", "write two loads with different components");
    check_absorbing(scene, k, key, f);
    check_history(scene, load, key, f);
    if (load.servo)
      check_servo(scene, k, f);
    check_part(scene, load, key, f);
    if (!f.sound({key, "/specimen"}))
      continue;
    check_twice(scene, k, key, f);
    if (layout && f.sound({key}))
      check_against_overlap(scene, load, key, *layout, f);
    if (layout && load.absorbing && f.sound({key}))
      check_layer(scene, load, key, *layout, f);
  }
  if (scene.loads.empty() && !scene.body_force.is_any() && scene.initial_motion.empty() &&
      scene.tools.empty() && !scene.time.has_phases() && f.sound({"/loads"}))
    f.warning("/loads", "nothing loads the specimen", "\"loads\" is empty",
              "give loads, tools, a body force or an initial motion");
}
} // namespace ligament::program
