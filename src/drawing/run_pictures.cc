#include "src/drawing/run_pictures.h"

#include "core/check.h"
#include "core/parameters/spelling.h"
#include "src/output/broken_bonds.h"
#include "src/output/format.h"
#include "src/output/vtk_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>

namespace ligament::program
{
namespace
{
/// "Stress yy near the peak load, 2.98 ms".
std::string caption(const ShownField &field, const BodyState &state)
{
  std::string text =
      fmt::format("{} {}, {}", field.label(), state.caption, quantity(state.time, "s"));
  text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

bool has_field(const BodyState &state, const std::string &name)
{
  return find_field(state.particles.fields, name) || find_field(state.cells.node_fields, name) ||
         find_field(state.cells.cell_fields, name);
}

/// A picture of a field that the run has not kept would show the body in grey.
void require_fields(const std::vector<const BodyState *> &states,
                    const std::vector<std::string> &words, int dimension, const std::string &run)
{
  const auto is_there = [&](const std::string &word) {
    const std::string name = shown_field(word, dimension).field;
    return std::any_of(states.begin(), states.end(),
                       [&](const BodyState *state) { return has_field(*state, name); });
  };
  for (const std::string &word : words) {
    if (is_there(word))
      continue;
    std::vector<std::string> there = shown_field_words(dimension);
    there.erase(std::remove_if(there.begin(), there.end(), std::not_fn(is_there)), there.end());
    throw core::InputError(
        fmt::format("{}: the run has kept no \"{}\"; choose {}", run, word, core::listed(there)));
  }
}
} // namespace

std::vector<PictureEntry> write_pictures(const RunFolder &folder,
                                         const std::vector<const BodyState *> &states,
                                         const std::vector<std::string> &fields, int dimension,
                                         double magnification, std::vector<std::string> *missing,
                                         std::optional<PictureTime> until)
{
  core::require(missing || !until, "nobody would hear of the pictures that are left out");
  std::vector<PictureEntry> entries;
  FieldView view;
  view.magnify = magnification;
  for (const std::string &word : fields) {
    view.field = shown_field(word, dimension);
    auto pictures = pictures_of(states, dimension, view);
    for (std::size_t s = 0; s < states.size(); ++s) {
      const std::string file = fmt::format("pictures/{}_{}.png", states[s]->name, word);
      if (until && PictureTime::clock::now() >= *until) {
        missing->push_back(
            fmt::format("{}: no time was left; `ligament report {} --field {}` draws it", file,
                        folder.path, word));
        continue;
      }
      pictures[s].title = caption(view.field, *states[s]);
      try {
        write_picture(folder.path + "/" + file, pictures[s]);
        entries.push_back({file, pictures[s].title});
      } catch (const core::EnvironmentError &error) {
        if (!missing)
          throw;
        missing->push_back(error.what());
      }
    }
  }
  return entries;
}

std::vector<PictureEntry> write_pictures(const RunFolder &folder, const RunRecord &record,
                                         const std::vector<std::string> &fields,
                                         const RunFolder &target)
{
  for (const std::string &word : fields)
    shown_field(word, record.dimension); // before anything is read
  core::require(!record.states.empty(), folder.path + ": the run has kept no fields to draw");
  std::vector<BodyState> states;
  for (const StateEntry &entry : record.states)
    states.push_back(read_state(folder, entry));
  std::vector<const BodyState *> all;
  for (const BodyState &state : states)
    all.push_back(&state);
  require_fields(all, fields, record.dimension, folder.path);
  make_folder(target.pictures());
  return write_pictures(target, all, fields, record.dimension, record.magnification);
}

BodyState read_state(const RunFolder &folder, const StateEntry &entry)
{
  BodyState state;
  state.name = entry.name;
  state.caption = entry.caption;
  state.time = entry.time;
  state.tools = entry.tools;
  if (!entry.particles.empty()) {
    const std::string file = folder.path + "/" + entry.particles;
    state.particles = std::filesystem::path(file).extension() == ".pvtp" ? read_particles_pvtp(file)
                                                                         : read_particles_vtp(file);
  }
  if (!entry.cells.empty())
    state.cells = read_cells_vtu(folder.path + "/" + entry.cells);
  if (std::filesystem::exists(folder.broken_bonds()))
    for (const BrokenBond &bond : read_broken_bonds(folder.broken_bonds()))
      if (bond.time <= entry.time)
        state.bonds.push_back(bond);
  if (std::filesystem::exists(folder.cut_faces()))
    state.cuts = read_broken_bonds(folder.cut_faces());
  return state;
}
} // namespace ligament::program
