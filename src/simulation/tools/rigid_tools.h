// The tools of a scene, with the surface of the body that they share.
#pragma once

#include "src/simulation/tools/tool_contact.h"

#include <memory>

namespace ligament::program
{
template <int dim>
class RigidTools : public ToolSet<dim>
{
public:
  /// `reach` in m: pictures show no more of a tool.
  RigidTools(std::vector<ToolDefinition<dim>> definitions, ContactSurface<dim> surface,
             const SearchLimits &limits, double reach);

  void act(coupling::Bodies<dim> bodies, const coupling::StepTime &step, int ratio) override;
  void push_again(coupling::Bodies<dim> bodies) const override;
  ToolEnergy energy() const override;
  int size() const override { return int(tools_.size()); }
  const std::string &name(int tool) const override { return tools_[tool].definition().name; }
  ToolReading<dim> read(int tool) const override;
  Vector<dim> drive(int tool) const override;
  Vector<dim> place(int tool) const override { return tools_[tool].definition().place; }
  std::vector<std::array<Vector<dim>, 2>> edges(int tool) const override;
  void save(core::State &state) const override;
  void load(const core::State &state, const coupling::Bodies<dim> &bodies) override;

  const RigidTool<dim> &tool(int k) const { return tools_[k]; }
  const ToolContact<dim> &contact(int k) const { return contacts_[k]; }
  const ContactSurface<dim> &surface() const { return surface_; }

private:
  void require_heavy(int tool, double stiffness, double dt) const;

  std::vector<RigidTool<dim>> tools_;
  std::vector<ToolContact<dim>> contacts_;          // of each
  std::vector<Vector<dim>> zone_force_, far_force_; // N, on the body at the last look
  ContactSurface<dim> surface_;
  double reach_;
};
} // namespace ligament::program
