#include "src/simulation/tools/rigid_tools.h"

#include "core/check.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::program
{
namespace
{
// A free tool that the layer lets swing at more than this share of the largest frequency of a
// step, squared, is too light: the rest is left to the body.
constexpr double swing_share = 0.3;

std::string prefix(int tool)
{
  return fmt::format("{}_", tool);
}
} // namespace

template <int dim>
RigidTools<dim>::RigidTools(std::vector<ToolDefinition<dim>> definitions,
                            ContactSurface<dim> surface, const SearchLimits &limits, double reach)
    : surface_(std::move(surface)), reach_(reach)
{
  for (auto &definition : definitions) {
    contacts_.emplace_back(definition.friction, limits);
    tools_.emplace_back(std::move(definition));
  }
  zone_force_.assign(tools_.size(), Vector<dim>::Zero());
  far_force_ = zone_force_;
}

template <int dim>
void RigidTools<dim>::require_heavy(int tool, double stiffness, double dt) const
{
  const auto &definition = tools_[tool].definition();
  const double least = stiffness / (swing_share * std::pow(2 / dt, 2));
  core::require<core::GuardStop>(
      definition.mass == 0 || definition.mass >= least,
      fmt::format("the tool \"{}\" of {:.4g} kg is too light for what it touches: on that area it "
                  "needs {:.4g} kg; give more \"mass\", or a prescribed motion",
                  definition.name, definition.mass, least));
}

template <int dim>
void RigidTools<dim>::act(coupling::Bodies<dim> bodies, const coupling::StepTime &step, int ratio)
{
  const bool far_acts = bodies.far && step.step % ratio == 0;
  const int first = bodies.zone ? surface_.add_broken(*bodies.zone) : surface_.size();
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    RigidTool<dim> &tool = tools_[k];
    if (tool.is_gone())
      continue;
    tool.advance(step.time, step.dt);
    if (first < surface_.size())
      contacts_[k].begin(first, tool, surface_, bodies);
    const bool leaves = step.time >= tool.definition().release && step.step % ratio == 0;
    const auto answer = contacts_[k].act(tool, surface_, bodies, step.dt, far_acts, !leaves);
    // What acts on the far field does so every `ratio` steps, for as long.
    require_heavy(int(k), answer.stiffness + ratio * ratio * answer.far_stiffness, step.dt);
    tool.finish(step.dt, answer.zone, far_acts ? &answer.far : nullptr, ratio);
    zone_force_[k] = -answer.zone.force;
    if (far_acts)
      far_force_[k] = -answer.far.force;
    if (!leaves)
      continue;
    // The force that is taken away belongs to half a step of motion, theory.md eq. (T7).
    tool.leave(contacts_[k].energy() +
               step.dt / 2 * (contacts_[k].power(false) + ratio * contacts_[k].power(true)));
    zone_force_[k].setZero();
    far_force_[k].setZero();
  }
}

template <int dim>
void RigidTools<dim>::push_again(coupling::Bodies<dim> bodies) const
{
  for (const auto &contact : contacts_)
    contact.push_again(surface_, bodies);
}

template <int dim>
ToolEnergy RigidTools<dim>::energy() const
{
  ToolEnergy sum;
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    sum.kinetic += tools_[k].kinetic();
    sum.spring += tools_[k].spring();
    sum.work += tools_[k].work();
    sum.friction += contacts_[k].heat();
    if (!tools_[k].is_gone())
      sum.contact += contacts_[k].energy();
  }
  return sum;
}

template <int dim>
ToolReading<dim> RigidTools<dim>::read(int k) const
{
  const RigidTool<dim> &tool = tools_[k];
  return {zone_force_[k] + far_force_[k], tool.displacement(), tool.velocity(),
          tool.is_gone() ? 0 : contacts_[k].area(), tool.rotation()};
}

template <int dim>
std::vector<std::array<Vector<dim>, 2>> RigidTools<dim>::edges(int k) const
{
  const RigidTool<dim> &tool = tools_[k];
  if (tool.is_gone())
    return {};
  auto edges = tool.definition().shape.edges(reach_);
  for (auto &edge : edges)
    for (Vector<dim> &end : edge)
      end += tool.definition().place;
  return edges;
}

template <int dim>
Vector<dim> RigidTools<dim>::drive(int k) const
{
  Vector<dim> way = Vector<dim>::Zero();
  if (const auto &drive = tools_[k].definition().drive)
    for (int c = 0; c < dim; ++c)
      way[c] = drive->value[c].value_or(0);
  return way;
}

template <int dim>
void RigidTools<dim>::save(core::State &state) const
{
  std::map<std::array<std::int64_t, 3>, std::vector<double>> rows;
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    tools_[k].save(state, prefix(int(k)));
    contacts_[k].save_heat(state, prefix(int(k)));
    for (int c = 0; c < dim; ++c)
      core::save_value(state, "tools", prefix(int(k)) + "on_far_" + std::to_string(c),
                       far_force_[k][c]);
    if (!tools_[k].is_gone())
      contacts_[k].save(int(k), surface_, rows);
  }
  std::vector<std::int64_t> keys;
  std::vector<std::vector<double>> columns(2 + 2 * dim);
  for (const auto &[key, values] : rows) {
    keys.insert(keys.end(), key.begin(), key.end());
    for (std::size_t c = 0; c < columns.size(); ++c)
      columns[c].push_back(values[c]);
  }
  core::Table table(std::move(keys), 3);
  for (std::size_t c = 0; c < columns.size(); ++c)
    table.add("value_" + std::to_string(c), columns[c]);
  state["tool_contacts"] = std::move(table);
}

template <int dim>
void RigidTools<dim>::load(const core::State &state, const coupling::Bodies<dim> &bodies)
{
  if (bodies.zone)
    surface_.add_broken(*bodies.zone);
  const core::Table &table = core::table(state, "tool_contacts");
  std::map<std::array<std::int64_t, 3>, std::vector<double>> rows;
  for (int c = 0; c < 2 + 2 * dim; ++c) {
    const auto column = table.reals("value_" + std::to_string(c));
    for (std::size_t r = 0; r < table.n_rows(); ++r) {
      const std::int64_t *key = &table.keys()[3 * r];
      rows[{key[0], key[1], key[2]}].push_back(column[r]);
    }
  }
  for (std::size_t k = 0; k < tools_.size(); ++k) {
    tools_[k].load(state, prefix(int(k)));
    contacts_[k].load_heat(state, prefix(int(k)));
    for (int c = 0; c < dim; ++c)
      far_force_[k][c] =
          core::load_real(state, "tools", prefix(int(k)) + "on_far_" + std::to_string(c));
    contacts_[k].load(int(k), surface_, rows);
  }
}

template class RigidTools<2>;
template class RigidTools<3>;
} // namespace ligament::program
