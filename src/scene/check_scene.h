// Checks that need more than one key: impossible geometry, contradictions, what is missing.
#pragma once

#include "core/box_union.h"
#include "src/scene/findings.h"
#include "src/scene/geometry.h"
#include "src/scene/scene.h"

#include <optional>

namespace ligament::program
{
/// Where the models are, as far as the keys they follow from are right.
struct Layout
{
  int dim = 2;
  Box specimen;
  Box zone;                  // the discrete zone inside the specimen
  std::string place;         // the key that says where it is
  core::BoxUnion<3> boxes;   // of a zone of several boxes, infinite where they reach through
  bool coupled = false;      // both models, joined along the sides below
  bool coupled_side[6] = {}; // numbered like the sides of the specimen, core/types.h
  double overlap = 0;        // m, width
  double cell_size = 0;      // m, h
};

/// The scene as it was read, region sides still infinite where they reach through.
void check_scene(const Scene &scene, Findings &findings);

/// Where the models lie, and what joins them; empty when zone or far field are wrong themselves.
std::optional<Layout> check_layout(const Scene &scene, const Box &specimen, Findings &findings);

/// Scheme, sizes and masses of a coupled scene with sound spacing and cell size.
void check_coupling(const Scene &scene, Findings &findings);

/// What is possible for each key, and not together: speeds, strains, numbers of steps.
void check_scales(const Scene &scene, Findings &findings);

/// Sizes of the far field's cells.
void check_mesh(const Scene &scene, bool is_coupled, Findings &findings);

/// The ways between corners of outlines, each for itself: nothing is made of wrong ones.
void check_corners(const Scene &scene, Findings &findings);
/// What the specimen is, and whether it bounds a body.
void check_shape(const Scene &scene, Findings &findings);
/// Finds the numbers of the sides that loads and gauges name; without findings unknown ones go
/// unsaid.
void resolve_sides(Scene &scene, Findings *findings);

/// Notches, holes and cracks. `layout` is null when zone or far field are wrong themselves.
void check_cuts(const Scene &scene, const Box &specimen, const Layout *layout, Findings &findings);

/// Whether the crack, a sound one, can run straight ahead in the lattice of the zone.
void check_path(const Scene &scene, const Crack &crack, const std::string &key, Findings &findings);

/// Whether what lies in the box keeps its distance from the overlap: the mesh there is whole and of
/// one material. `name` begins the message.
void check_inside_zone(const Box &cut, const std::string &name, const std::string &key,
                       const Layout &layout, Findings &findings);

/// Whether two materials differ in Young's modulus or Poisson's ratio; any two of the scene.
bool have_other_constants(const MaterialParameters &a, const MaterialParameters &b);
bool joins_other_constants(const Scene &scene);
/// Other materials. `layout` as above.
void check_inclusions(const Scene &scene, const Box &specimen, const Layout *layout,
                      Findings &findings);

/// Whether sides cut cells of a lattice otherwise than through their middles or along their faces.
bool is_cut_aslant(const Scene &scene);
/// Laws of flow, and what they cannot be used with.
void check_plasticity(const Scene &scene, Findings &f);
/// Viscosity, and what it cannot be used with.
void check_viscosity(const Scene &scene, Findings &f);

/// When the bonds of a material break; `section` is the key of its "fracture".
void check_fracture(const MaterialParameters &material, const std::string &section,
                    const Scene &scene, Findings &findings);

/// Whether anything may break, and whether faces of any material soften before.
bool may_break(const Scene &scene);
bool may_soften(const Scene &scene);

/// Keys that mean nothing in a body without particles, at rest or without heat.
void check_unused_keys(const Scene &scene, Findings &findings);

/// Whether faces can soften as it says.
void check_softening(const Scene &scene, const MaterialParameters &material,
                     const std::string &section, Findings &findings);

/// Limits of the velocity of cracks and faces that are bonded again, in all materials.
void check_face_life(const Scene &scene, Findings &findings);

/// What loading by equilibria asks of loads, supports, damping and rest.
void check_phases(const Scene &scene, Findings &findings);

/// Rigid tools: names, shapes, what moves them.
void check_tools(const Scene &scene, Findings &findings);

/// Gauges: their keys, and whether there is something to measure where they lie.
void check_gauges(const Scene &scene, const Box &specimen, Findings &findings);
/// The rectangles of a J-integral: around one tip, inside the specimen, nothing else between them.
void check_j_integral(const Scene &scene, const GaugeParameters &gauge, const Box &specimen,
                      const std::string &key, Findings &findings);
/// The course in time of a load, and the part of its side, each for itself.
void check_history(const Scene &scene, const LoadParameters &load, const std::string &key,
                   Findings &findings);
void check_part(const Scene &scene, const LoadParameters &load, const std::string &key,
                Findings &findings);
/// "within" of the section at the key: a box or a ball, not empty.
void check_within(const Scene &scene, const Region &within, const std::string &key,
                  Findings &findings);
/// The servo of a load that has one.
void check_servo(const Scene &scene, std::size_t load, Findings &findings);
/// Whether the parts of the same side on which they act have an area in common.
bool act_on_common_area(const Scene &scene, const LoadParameters &a, const LoadParameters &b);
/// Whether the part keeps its distance from an overlap that ends at the same side.
void check_part_against_overlap(const Scene &scene, const LoadParameters &load,
                                const std::string &key, const Layout &layout, Findings &findings);

/// Axes along which the body repeats itself, and what cannot stand beside them.
void check_periodic(const Scene &scene, const Layout *layout, Findings &findings);
/// Load number k, which is a jump across joined sides.
void check_jump(const Scene &scene, std::size_t k, Findings &findings);

/// What moves at the beginning, and what acts on every mass.
void check_motion(const Scene &scene, Findings &findings);

/// Loads against each other, and against the overlap. `layout` as above.
void check_loads(const Scene &scene, const Layout *layout, Findings &findings);
} // namespace ligament::program
