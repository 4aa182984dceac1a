#include "src/scene/check_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
const std::string cell_key = "/far_field/cell_size", levels_key = "/far_field/levels";

void check_cell_number(const Scene &scene, Findings &f)
{
  const double largest = scene.far_field->cell_size * std::pow(2.0, scene.far_field->levels);
  double number = 1;
  for (int c = 0; c < scene.dimension; ++c)
    number *= std::max(1.0, scene.specimen.size[c] / largest);
  if (number > 1e9)
    f.error(cell_key,
            fmt::format("\"cell_size\" in /far_field is {} m, which makes at least {:.1e} cells",
                        scene.far_field->cell_size, number),
            "more than 1e9 cannot be numbered", "give a larger size, or check its unit");
}

/// Those of the keys about sizes of cells that say something else than by default.
std::vector<std::string> size_keys(const FarField &far)
{
  const FarField plain = {};
  std::vector<std::string> keys;
  for (const auto &[key, differs] :
       {std::pair("levels", far.levels != plain.levels),
        std::pair("growth", far.growth != plain.growth),
        std::pair("fine_cells", far.fine_cells != plain.fine_cells),
        std::pair("cells_per_level", far.cells_per_level != plain.cells_per_level),
        std::pair("outline_cell_size", far.outline_cell_size != plain.outline_cell_size)})
    if (differs)
      keys.push_back(key);
  return keys;
}

/// A box, whose mesh follows no outline.
bool is_box(const Scene &scene)
{
  const Specimen &s = scene.specimen;
  return s.is_plain() && (scene.dimension == 3 || (s.holes.empty() && s.notches.empty()));
}

/// Why the mesh does not ask for the key; empty: it does.
std::string why_unused(const Scene &scene, const std::string &key, bool is_coupled)
{
  const FarField &far = *scene.far_field;
  if (far.cells_from_file)
    return "the cells are those of /specimen/file";
  if (key == "outline_cell_size")
    return is_box(scene) ? "the specimen has no side that cells would have to follow" : "";
  if (!is_coupled && is_box(scene))
    return "without a discrete zone all cells have the size \"cell_size\"";
  if (!is_coupled && (key == "growth" || key == "fine_cells"))
    return "there is no discrete zone beside which cells are small";
  if (far.levels == 0 && (key == "growth" || key == "fine_cells"))
    return "all cells have the size \"cell_size\" as long as \"levels\" is 0";
  if (key == "cells_per_level" && far.levels == 0 && far.outline_cell_size == 0)
    return "all cells have the size \"cell_size\"";
  return "";
}

void check_size_keys(const Scene &scene, bool is_coupled, Findings &f)
{
  if (!f.sound({"/far_field", "/specimen"}))
    return;
  for (const std::string &key : size_keys(*scene.far_field))
    if (const std::string reason = why_unused(scene, key, is_coupled); !reason.empty())
      f.unused("/far_field/" + key, reason);
}

/// Cells along the outline are halves of others.
void check_outline_cells(const Scene &scene, Findings &f)
{
  const std::string key = "/far_field/outline_cell_size";
  const FarField &far = *scene.far_field;
  if (far.outline_cell_size == 0 || far.cells_from_file || is_box(scene) ||
      !f.sound_and_given({key}) || !f.sound({"/far_field"}))
    return;
  if (far.growth > 1)
    return f.error(key, "\"outline_cell_size\" in /far_field beside \"growth\"",
                   "cells that grow one by one are of one size along a row",
                   "remove one of them; \"levels\" alone refines by halves");
  const double power = std::log2(far.outline_cell_size / far.cell_size),
               taken =
                   std::ldexp(far.cell_size, std::min(far.levels, int(std::floor(power + 0.01))));
  if (std::abs(taken / far.outline_cell_size - 1) < 0.01)
    return;
  const bool is_large = power > far.levels + 0.01;
  f.warning(
      key,
      fmt::format("\"outline_cell_size\" in /far_field is {} m, but the cells will have {:.4g} m",
                  far.outline_cell_size, taken),
      is_large ? "the largest cells have the size cell_size times 2^levels"
               : "it is cell_size times a power of 2",
      fmt::format("give {:.4g} m{}", taken, is_large ? ", or more \"levels\"" : ""));
}

/// Steps of the mesh size reflect waves, least where the mass is consistent.
void check_open_field(const Scene &scene, Findings &f)
{
  const bool is_open = std::any_of(scene.loads.begin(), scene.loads.end(),
                                   [](const auto &load) { return load.absorbing; });
  const int near = scene.coupling.overlap_cells + scene.coupling.transition_cells;
  if (f.sound({levels_key, "/far_field/growth", "/far_field/fine_cells", "/coupling/overlap_cells",
               "/coupling/transition_cells", "/loads"}) &&
      is_open && scene.far_field->levels > 0 && scene.far_field->growth == 1 &&
      fine_cells(scene) >= near)
    f.warning(levels_key,
              fmt::format("\"levels\" in /far_field is {}, and waves are to leave the body",
                          scene.far_field->levels),
              "where cells double behind the transition, 4 % of the energy of waves of 8 cell_size "
              "come back, 0.1 % of those of 16, some 1e-4 of those of 30",
              "give levels 0; or levels 1 with \"growth\" 1.2 and \"fine_cells\" 1, by which cells "
              "grow in the overlap");
}
} // namespace

void check_mesh(const Scene &scene, bool is_coupled, Findings &f)
{
  if (f.sound({cell_key, levels_key}))
    check_cell_number(scene, f);
  check_size_keys(scene, is_coupled, f);
  check_outline_cells(scene, f);
  if (is_coupled)
    check_open_field(scene, f);
}
} // namespace ligament::program
