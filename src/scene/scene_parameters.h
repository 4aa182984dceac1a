// The table of the scene file: every key, its default, unit, bounds and text.
#pragma once

#include "core/parameters/parameter_section.h"
#include "src/scene/scene.h"

namespace ligament::program
{
/// Declares all keys, bound to the scene, whose present values count as the defaults. A new key is
/// one line here and one member in scene.h. Where the particles may be atoms no key of the material
/// is required.
void declare_scene(core::ParameterSection &section, Scene &scene, bool may_be_atoms = true);
} // namespace ligament::program
