// From the tools of a scene to those that touch its body.
#pragma once

#include "src/simulation/coupled_body.h"
#include "src/simulation/tools/rigid_tools.h"

namespace ligament::program
{
/// Of the materials of the scene.
ContactStiffness contact_stiffness_of(const Scene &scene);

/// What tools feel of the far field, when the cells of an overlap are the coupler's.
template <int dim>
void add_cells(const Scene &scene, const CoupledBody<dim> &body, ContactSurface<dim> &surface);

template <int dim>
ToolDefinition<dim> make_tool(const ToolParameters &parameters);

/// core::KeyedError where a tool overlaps the body or its spring is too stiff for its mass; warns
/// of tools that touch nothing.
template <int dim>
std::unique_ptr<ToolSet<dim>> make_tools(const Scene &scene, const CoupledBody<dim> &body,
                                         ContactSurface<dim> surface, core::Log &log);
} // namespace ligament::program
