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

/// Keys about larger cells need some.
void check_size_keys(const Scene &scene, Findings &f)
{
  if (f.sound({levels_key}) && scene.far_field->levels == 0)
    for (const std::string key : {"growth", "fine_cells"})
      if (f.sound_and_given({"/far_field/" + key}))
        f.warning("/far_field/" + key, fmt::format("\"{}\" in /far_field is not used", key),
                  "all cells have the size \"cell_size\" as long as \"levels\" is 0",
                  "remove it, or give \"levels\"");
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
  check_size_keys(scene, f);
  if (is_coupled)
    check_open_field(scene, f);
}
} // namespace ligament::program
