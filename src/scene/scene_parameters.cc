#include "src/scene/scene_parameters.h"

#include "src/drawing/shown_field.h"

namespace ligament::program
{
namespace
{
using Section = core::ParameterSection;

// clang-format off
void declare_crack(Section &s, Crack &c)
{
  s.add("points", c.points, "the two ends, or all corners of a bent crack (2D); the corners of a convex plane polygon (3D)").in("m").usually(0, 1e4, "mm um").required();
}

void declare_hole(Section &s, Hole &h)
{
  s.add("centre", h.centre, "centre of the disc").in("m").usually(0, 1e4, "mm um").required();
  s.add("radius", h.radius, "radius of the disc; at least two spacings").in("m").usually(1e-10, 1e4, "mm um nm").above(0).required();
}

void declare_notch(Section &s, Notch &n)
{
  s.add("lower", n.lower, "corner of the box with the smallest coordinates").in("m").usually(0, 1e4, "mm um").required();
  s.add("upper", n.upper, "corner of the box with the largest coordinates").in("m").usually(0, 1e4, "mm um").required();
}

void declare_corner(Section &s, OutlineCorner &c)
{
  s.add("at", c.at, "place of the corner (x and y; in 3D z counts nothing)").in("m").usually(0, 1e4, "mm um").required();
  s.add("centre", c.centre, "the way to it from the corner before is an arc about this point; not given: it is straight; a single corner with a centre is a whole circle").in("m").usually(0, 1e4, "mm um");
  s.add("clockwise", c.clockwise, "the arc runs clockwise about its centre");
  s.add("side", c.side, "name of the side between the two, for loads; not given: left, right, bottom or top where it lies on the box around the specimen");
}

void declare_cutout(Section &s, Cutout &c)
{
  s.list("outline", c.outline, "its corners in turn, either way round", declare_corner).required();
  s.add("side", c.side, "name of its rim, for loads; sides of the outline may have their own");
}

void declare_slot(Section &s, Slot &n)
{
  s.add("from", n.from, "middle of its mouth on the surface; it goes on outward by its width").in("m").usually(0, 1e4, "mm um").required();
  s.add("to", n.to, "its tip").in("m").usually(0, 1e4, "mm um").required();
  s.add("width", n.width, "between its flanks").in("m").usually(1e-10, 1e4, "mm um nm").above(0).required();
  s.add("tip", n.tip, "flat; round: half a circle; v: a wedge, whose flanks are straight from its tip to the full width", words(SlotTip()));
  s.add("tip_angle", n.tip_angle, "between the flanks of a tip v").in("rad").usually(0.05, 3.1, "deg mrad").above(0).below(3.14);
  s.add("side", n.side, "name of its flanks and tip, for loads");
}

void declare_specimen_ball(Section &s, Ball &b)
{
  s.add("radius", b.radius, "of the ball").in("m").usually(1e-10, 1e4, "mm um nm").above(0).required();
}

void declare_periodic_axis(Section &s, PeriodicAxis &p)
{
  s.add("axis", p.axis, "along which the body repeats itself", words(Axis()));
  s.set_shorthand("axis");
}

void declare_specimen(Section &s, Specimen &p)
{
  s.add("size", p.size, "edge lengths of the box, which is centred at the origin; not with outline, ball or file").in("m").usually(1e-9, 1e4, "mm um nm").above(0).required_unless("there is an outline, a ball or a file");
  s.add("thickness", p.thickness, "extent across the plane; in 3D of an outline along z, half of it to either side of 0").in("m").usually(1e-10, 1e4, "mm um nm").above(0);
  s.list("outline", p.outline, "in place of size: the corners of the body's outline in turn, either way round; in 3D that of a prism along z", declare_corner);
  s.list("cutouts", p.cutouts, "openings of any outline; what reaches out of the specimen opens its side; in 3D they go through along z", declare_cutout);
  s.list("slots", p.slots, "notches with parallel flanks at any angle; in 3D they go through along z", declare_slot);
  s.section("ball", p.ball, "none", "in place of size: a ball about the origin", declare_specimen_ball).only_in(3);
  s.add("file", p.file, "in place of size: a file with the body, lengths in m, relative to the scene: gmsh's .msh (text, version 2.2 or 4.1), whose physical groups of lines (2D) or faces (3D) are names of sides; in 3D also .stl");
  s.list("cracks", p.cracks, "cuts without width", declare_crack);
  s.list("holes", p.holes, "discs cut out of the specimen", declare_hole).only_in(2);
  s.list("notches", p.notches, "boxes cut out of the specimen", declare_notch);
  s.list("periodic", p.periodic, "axes along which the box repeats itself: the two sides across each are joined, bonds and cells go on through them; in a lattice the width must fit it", declare_periodic_axis);
}

void declare_weibull(Section &s, WeibullParameters &w)
{
  s.add("modulus", w.modulus, "of Weibull's distribution: 5 for rock, 10 to 20 for ceramics; their standard deviation is about 1.2 / modulus").above(1).at_most(1000).required();
  s.add("reference_area", w.reference_area, "area of the face whose mean strength is the given one, larger ones are weaker; in 2D the thickness counts; not given: the mean is the same for all").in("m^2").usually(1e-18, 1, "mm^2 um^2").above(0);
  s.add("seed", w.seed, "which scatter").at_least(0).at_most(1000000000);
}

void declare_rebonding(Section &s, RebondingParameters &r)
{
  s.add("pressure", r.pressure, "least pressure on a face that touches").in("Pa").usually(1e3, 2e11, "MPa kPa GPa").above(0).required();
  s.add("plastic_strain", r.plastic_strain, "least accumulated plastic strain of both particles, in materials that flow").at_least(0).at_most(10);
  s.add("strength", r.strength, "of adhesion: traction at which the new bond breaks at once, under pressure the shear beyond friction").in("Pa").usually(1e3, 2e11, "MPa kPa GPa").above(0).required();
}

void declare_fracture(Section &s, FractureParameters &f)
{
  s.add("criterion", f.criterion, "what breaks a bond: the largest principal stress as its face carries it, the normal stress on its face alone, or a measure of the stress tensors of its particles with the traction of its face (largest principal stress, von Mises, Drucker-Prager, Mohr-Coulomb, elastic energy); or nothing", words(Criterion()));
  s.add("strength", f.strength, "uniaxial tension at which a bond breaks or, with an energy or a toughness beside it, begins to soften; of mohr_coulomb its cut-off in tension").in("Pa").usually(1e3, 2e11, "MPa kPa GPa").above(0);
  s.add("energy", f.energy, "G_c per area of crack: faces that reach the strength soften and break when they have taken it; without, they break at once").in("J/m^2").usually(1e-2, 1e7, "N/m kJ/m^2").above(0);
  s.add("softening", f.softening, "what a face still bears as it opens: one straight line, or two, with the corner at a third of the strength and an opening of 0.8 G_c/f_t as for concrete", words(SofteningCurve()));
  s.add("mode_ratio", f.mode_ratio, "shear strength over tensile strength of a face that opens").at_least(0.1).at_most(10);
  s.add("toughness", f.toughness, "K_Ic; alone: the strength follows from it and from the spacing; with a strength: faces soften with the energy K_Ic^2/E'").in("Pa*m^0.5").usually(1e3, 1e9, "MPa*m^0.5 kPa*m^0.5").above(0);
  s.add("compressive_strength", f.compressive_strength, "of drucker_prager, and of mohr_coulomb in place of the cohesion: uniaxial compression at which bonds break").in("Pa").usually(1e3, 2e11, "MPa kPa GPa").above(0);
  s.add("cohesion", f.cohesion, "of mohr_coulomb: shear at which a plane without normal stress fails").in("Pa").usually(1e2, 2e11, "MPa kPa GPa").above(0);
  s.add("friction_angle", f.friction_angle, "of mohr_coulomb: by whose tangent a pressure adds to the shear that a plane bears; broken faces rub with \"friction\"").in("rad").usually(0, 1.05, "deg").at_least(0).at_most(1.0472);
  s.add("crack_velocity", f.crack_velocity, "of faces that break at once: what they bear falls to nothing in the time in which a crack of this velocity crosses them, and none next to them begins meanwhile").in("m/s").usually(1e-3, 1e4, "km/s mm/s").above(0);
  s.section("rebonding", f.rebonding, "none", "when faces that touch are bonded again (cold welding); not given: never", declare_rebonding);
  s.section("weibull", f.weibull, "none", "scatter of the strengths of faces, which a face has from the names of its particles alone", declare_weibull);
}

void declare_yield_point(Section &s, YieldPoint &p)
{
  s.add("strain", p.strain, "accumulated plastic strain; 0 at the first point").at_least(0).at_most(10).required();
  s.add("stress", p.stress, "yield stress there; it must not fall").in("Pa").usually(1e3, 2e11, "MPa kPa GPa").above(0).required();
}

void declare_plasticity(Section &s, PlasticityParameters &p)
{
  s.add("law", p.law, "von Mises: metals; Drucker and Prager: rock and soil, whose strength grows with pressure and which dilate", words(PlasticityLaw()));
  s.add("yield_stress", p.yield_stress, "of von_mises: uniaxial stress at which flow begins; either this or a curve").in("Pa").usually(1e3, 2e11, "MPa kPa GPa").above(0);
  s.add("hardening", p.hardening, "growth of the yield stress (of drucker_prager: of the shear strength) with the plastic strain; it must not fall, since softening without a length depends on the spacing").in("Pa").usually(0, 2e12, "GPa MPa kPa").at_least(0);
  s.add("saturation", p.saturation, "of von_mises: Voce's Q, by how much the yield stress grows besides, saturating").in("Pa").usually(1e3, 2e11, "MPa kPa GPa").above(0);
  s.add("saturation_rate", p.saturation_rate, "of von_mises: Voce's b, how fast: Q (1 - exp(-b p)) over the plastic strain p").above(0).at_most(1e6);
  s.list("curve", p.curve, "of von_mises, in place of the yield stress and its growth: points of the curve, straight between them and level behind the last", declare_yield_point);
  s.add("cohesion", p.cohesion, "of drucker_prager: shear strength of a plane without pressure").in("Pa").usually(1e2, 2e11, "MPa kPa GPa").above(0);
  s.add("friction_angle", p.friction_angle, "of drucker_prager: of Coulomb's cone through the edges of triaxial compression").in("rad").usually(0.01, 1.05, "deg").at_least(0).at_most(1.0472);
  s.add("dilatancy_angle", p.dilatancy_angle, "of drucker_prager: by which flow swells; at most the friction angle").in("rad").usually(0, 1.05, "deg").at_least(0).at_most(1.0472);
  s.add("softening_energy", p.softening_energy, "of drucker_prager, in place of hardening: the cohesion falls on a straight line to 0; energy that it takes per area of a band of slip one spacing wide, friction not counted").in("J/m^2").usually(1e-2, 1e7, "N/m kJ/m^2").above(0);
}

void declare_branch(Section &s, BranchParameters &b)
{
  s.add("share", b.share, "of the shear modulus that \"youngs_modulus\" and \"poissons_ratio\" give, which is the instantaneous one").above(0).at_most(1).required();
  s.add("relaxation_time", b.relaxation_time, "within which its stress falls to 1/e; longer than a step").in("s").usually(1e-12, 1e9, "us ms ns").above(0).required();
}

void declare_viscosity(Section &s, ViscosityParameters &v)
{
  s.list("branches", v.branches, "generalised Maxwell material: springs and dashpots in series, beside a spring with the share of the shear modulus that they leave; a share of 1 in all is a fluid. E and nu of the material are those of fast loads; the volume stays elastic", declare_branch);
  s.add("shear_viscosity", v.shear_viscosity, "Kelvin and Voigt's dashpot beside all that: stress 2 eta times the rate of the deviator of strain; it makes the stable step shorter").in("Pa*s").usually(1e-3, 1e12, "mPa*s kPa*s MPa*s GPa*s").above(0);
}

void require_unless_atoms(core::Parameter &p, bool may_be_atoms)
{
  may_be_atoms ? p.required_unless("there are \"atoms\"") : p.required();
}

void declare_material(Section &s, MaterialParameters &m, bool may_be_atoms)
{
  require_unless_atoms(s.add("youngs_modulus", m.youngs_modulus, "E, the same in both models").in("Pa").usually(1e5, 2e12, "GPa MPa kPa").above(0), may_be_atoms);
  require_unless_atoms(s.add("poissons_ratio", m.poissons_ratio, "nu, the same in both models").at_least(-0.2).at_most(0.49), may_be_atoms);
  require_unless_atoms(s.add("density", m.density, "mass per volume").in("kg/m^3").usually(10, 3e4, "g/cm^3 t/m^3").above(0), may_be_atoms);
  s.add("friction", m.friction, "Coulomb friction of broken faces").at_least(0).at_most(10);
  declare_fracture(s.section("fracture", "when bonds break"), m.fracture);
  s.section("plasticity", m.plasticity, "none", "what particles flow by; cells and the overlap stay elastic", declare_plasticity);
  s.section("viscosity", m.viscosity, "none", "how the shear stress of particles relaxes and is damped, also together with plasticity; cells and the overlap stay elastic", declare_viscosity);
}

void declare_ball(Section &s, Hole &h)
{
  s.add("centre", h.centre, "its centre").in("m").usually(0, 1e4, "mm um").required();
  s.add("radius", h.radius, "its radius").in("m").usually(1e-10, 1e4, "mm um nm").above(0).required();
}

void declare_substitution(Section &s, Substitution &a)
{
  s.add("species", a.species, "of these atoms: a name as that of the crystal, which may also be given back").required();
  s.add("share", a.share, "of the sites in the regions, by chance").above(0).at_most(1);
  s.list("balls", a.balls, "discs (2D) or balls; without them and boxes: the whole crystal", declare_ball);
  s.list("boxes", a.boxes, "boxes", declare_notch);
}

void declare_atoms(Section &s, AtomsParameters &a)
{
  s.add("potential", a.potential, "zhou: metals after Zhou, Johnson and Wadley (2004); plane_crystal: a 2D crystal half bound by its density; lennard_jones, morse: pairs; setfl, setfl_fs, funcfl: tables of embedded atoms in a file", words(AtomPotential())).required();
  s.add("species", a.species, "of the crystal: Cu, Ag, Au, Ni, Pb, Fe or W (zhou), or a name in the file (setfl, setfl_fs)");
  s.add("file", a.file, "setfl, setfl_fs, funcfl: the table, relative to the scene");
  s.add("energy", a.energy, "depth of a pair's well (lennard_jones, morse), scale of an atom's energy in the crystal, which has 1.075 times it (plane_crystal)").in("J").usually(1e-22, 1e-17, "eV meV").at_least(0);
  s.add("distance", a.distance, "where the well is (morse); of lennard_jones sigma, where the energy is 0; of plane_crystal the spacing but for second neighbours, with them 0.947 times it").in("m").usually(1e-11, 1e-8, "angstrom nm pm").at_least(0);
  s.add("decay", a.decay, "morse: alpha, the width of the well").in("1/m").usually(1e8, 1e12, "1/angstrom 1/nm").at_least(0);
  s.add("mass", a.mass, "of an atom (lennard_jones, morse, plane_crystal)").in("kg").usually(1e-28, 1e-23, "u").at_least(0);
  s.add("taper_begin", a.taper_begin, "lennard_jones, morse: from here on the pair's energy goes smoothly to 0; 0: 2.2 sigma, 1.6 distances, or 0.88 of a shorter cut-off").in("m").usually(1e-11, 1e-7, "angstrom nm pm").at_least(0);
  s.add("cutoff", a.cutoff, "lennard_jones, morse: where it is 0; 0: 2.5 sigma, 2 distances").in("m").usually(1e-11, 1e-7, "angstrom nm pm").at_least(0);
  s.add("along_x", a.along_x, "direction of the crystal's cube that lies along x, as [1, 1, 0]; not given, with along_y: the cube lies along the axes").usually(-20, 20, "").only_in(3);
  s.add("along_y", a.along_y, "that along y, across the first").usually(-20, 20, "").only_in(3);
  s.add("temperature", a.temperature, "of the crystal, kept by the overlap's friction and its noise; 0: atoms start at rest and nothing heats them").in("K").usually(1, 5e3, "").at_least(0);
  s.add("lattice_parameter", a.lattice_parameter, "at this temperature without stress (hexagonal: the spacing); 0: found by runs of a small periodic crystal").in("m").usually(1e-10, 1e-8, "angstrom nm pm").at_least(0);
  s.add("seed", a.seed, "of the random numbers of its heat and of substitutions").at_least(0);
  s.add("zone_friction", a.zone_friction, "of a heat bath on the atoms outside the overlap, too; 0: none").in("1/s").usually(1e9, 1e14, "1/ps").at_least(0);
  s.add("averaging", a.averaging, "over which the forces of atoms at this temperature are averaged, the mesh held, before the run; 0: 150 periods of the fastest vibration").in("s").usually(1e-13, 1e-7, "ps ns").at_least(0);
  s.list("substitutions", a.substitutions, "atoms of other species (zhou, setfl, setfl_fs) on sites of the crystal, in regions that keep off the overlap by the range of forces; later ones over earlier ones", declare_substitution);
}

void declare_inclusion(Section &s, Inclusion &i)
{
  declare_material(s, i.material, false);
  s.list("balls", i.balls, "discs (2D) or balls of this material", declare_ball);
  s.list("boxes", i.boxes, "boxes of this material", declare_notch);
}

template <typename Box>
void declare_region(Section &s, Box &z)
{
  s.add("lower", z.lower, "corner with the smallest coordinates; null: reaches through the specimen").in("m").usually(0, 1e4, "mm um").null_means(-infinity);
  s.add("upper", z.upper, "corner with the largest coordinates; null: reaches through the specimen").in("m").usually(0, 1e4, "mm um").null_means(infinity);
}

void declare_around(Section &s, ZoneAround &a)
{
  s.add("cracks", a.cracks, "all initial cracks");
  s.add("slots", a.slots, "all slots");
  s.add("notches", a.notches, "all notches");
  s.add("holes", a.holes, "all holes");
  s.add("cutouts", a.cutouts, "all cutouts");
  s.add("corners", a.corners, "re-entrant corners of the outline");
  s.add("margin", a.margin, "width of the zone between these and its overlap").in("m").usually(1e-10, 1e3, "mm um nm").above(0).required();
}

void declare_zone(Section &s, DiscreteZone &z)
{
  s.add("extent", z.extent, "none: finite elements alone; all: discrete elements alone; box: the region below", {"none", "all", "box"});
  declare_region(s.section("region", "box of discrete elements, its overlap with the far field included; for extent box"), z);
  s.list("boxes", z.boxes, "in place of region: several boxes; those that overlap or touch are one zone, others are separate zones", declare_region<ZoneBox>);
  s.section("around", z.around, "none", "in place of region and boxes: zones that follow the specimen", declare_around);
  s.add("packing", z.packing, "arrangement of the particles; the first two are 2D, the next three 3D; of atoms: hexagonal, fcc or bcc, which belongs to atoms alone; file: centres and radii from packing_file", words(PackingKind())).required_unless("extent is none");
  s.add("spacing", z.spacing, "distance d of nearest neighbours; random, file: that of the densest lattice with cells of the same mean volume").in("m").usually(1e-10, 1e2, "mm um nm").above(0).required_unless("extent is none, or there are \"atoms\"");
  s.add("orientation", z.orientation, "turns the packing: an angle (2D) or a rotation vector (3D); close-packed rows lie along x at 0").in("rad").usually(0, 6.3, "deg mrad").at_least(-1000).at_most(1000).as_rotation();
  s.add("seed", z.seed, "random packing: which one").at_least(0).at_most(1000000000);
  s.add("relaxation_sweeps", z.relaxation_sweeps, "random packing: how often every particle moves to the centroid of its cell").at_least(0).at_most(1000);
  s.add("size_ratio", z.size_ratio, "random packing: largest over smallest radius").at_least(1).at_most(5);
  s.add("packing_file", z.packing_file, "packing file: CSV with the columns x, y, z, r, material (0, or the number of an inclusion) and a row of units; relative to the scene");
  s.set_shorthand("extent");
  s.set_required();
}

void declare_far_field(Section &s, FarField &f)
{
  s.add("cell_size", f.cell_size, "size h of the cells beside the discrete zone; 2.5 to 8 spacings").in("m").usually(1e-10, 1e3, "mm um nm").above(0).required();
  s.add("levels", f.levels, "refinement levels: the largest cells have size h 2^levels").at_least(0).at_most(8);
  s.add("cells_per_level", f.cells_per_level, "cells between two steps of the mesh size").at_least(1).at_most(100);
  s.add("growth", f.growth, "above 1: cells grow to that size by this factor from one to the next, in place of refinement, which doubles them").at_least(1).at_most(1.5);
  s.add("fine_cells", f.fine_cells, "cells of size h between the inner end of the overlap and the first larger ones; 0: overlap, transition and two more").at_least(0).at_most(1000);
  s.add("cells_from_file", f.cells_from_file, "the quadrilaterals of /specimen/file are the mesh, less those in the discrete zone, whose edges must be edges of cells; cells beside the zone must be rectangles along x and y").only_in(2);
  s.add("outline_cell_size", f.outline_cell_size, "size of the cells along curved and slanted sides, holes and notches, cell_size times a power of 2; 0: cell_size; not with growth").in("m").usually(1e-9, 1e3, "mm um nm").at_least(0);
}

void declare_coupling(Section &s, CouplingParameters &c)
{
  s.add("scheme", c.scheme, "how the two models act as one body in the overlap; those between the first and the last are energy-weighted couplers of the literature, for comparison", coupling::scheme_names);
  s.add("overlap_cells", c.overlap_cells, "width of the overlap in cells; 3 for fracture, 4 for waves, 2 for statics").at_least(2).at_most(20);
  s.add("transition_cells", c.transition_cells, "cells behind the overlap over which the mass goes from consistent to lumped").at_least(0).at_most(50);
  s.add("step_ratio", c.step_ratio, "fine steps in one step of the far field").at_least(1).at_most(64);
  s.add("fine_damper", c.fine_damper, "c_f, damper of what the mesh cannot carry; 4 for elastic waves, 8 for fracture, 0: off").at_least(0).at_most(100);
  s.add("gap_filter", c.gap_filter, "c_g, filter of the waves that neither model carries well; 4 for fracture, 0: off").at_least(0).at_most(100);
  s.add("patch_fit", c.patch_fit, "corrects the overlap so that homogeneous strains are exact");
  s.add("weight", c.weight, "share of the discrete model across the overlap; energy-weighted schemes only", coupling::weight_names);
  s.add("damper_form", c.damper_form, "how fine_damper acts; printed: as the literature prints it, may add energy; energy-weighted schemes only", coupling::damper_form_names);
  s.add("multiplier_cells", c.multiplier_cells, "edge of the multipliers' hat functions in cells; energy-weighted schemes only").at_least(1).at_most(10);
  s.add("ghost_force_correction", c.ghost_force_correction, "normal strains (xx, yy, zz) at which constant forces cancel the overlap's ghost forces, 0: off; energy-weighted schemes only").at_least(-0.1).at_most(0.1);
  s.add("solver", c.solver, "which library solves the systems of the overlap", coupling::solver_names);
  s.add("guard", c.guard, "what happens when a face of the overlap bears 0.9 of what breaks it or breaks, overlap or far field would flow (from 0.8 of that on there is a warning), or the body leaves the range of its regime; with warn nothing counts from then on, neither for the peak nor for comparisons", words(Guard()));
  s.add("regime", c.regime, "kinematics of overlap and far field: small rotation, large rotation, finite strain; automatic starts linear and changes when the motion asks for it", words(RegimeChoice()));
  s.add("coarse_mass", c.coarse_mass, "factor on the masses of the coarse motion and of the far field, for fewer steps to a static answer; down to spacing/cell_size, with damping only").above(0).at_most(1);
}

void declare_damping(Section &s, Damping &d)
{
  s.add("local", d.local, "fraction of the force that acts against the motion; not smooth: a load changed by 1e-13 changes the load curve by 1e-5 after 1500 steps, and bodies that move steadily are dragged; mass damping is smooth").at_least(0).below(1);
  s.add("mass", d.mass, "force against the momentum, of both models").in("1/s").usually(0, 1e13, "1/s").at_least(0);
  s.add("kinetic", d.kinetic, "velocities become zero when the kinetic energy has a peak");
}

void declare_region_of(Section &s, Region &r)
{
  s.add("lower", r.lower, "corner of a box with the smallest coordinates; null: reaches through").in("m").usually(0, 1e4, "mm um").null_means(-infinity);
  s.add("upper", r.upper, "corner of a box with the largest coordinates; null: reaches through").in("m").usually(0, 1e4, "mm um").null_means(infinity);
  s.add("centre", r.centre, "of a disc (2D) or ball, in place of a box").in("m").usually(0, 1e4, "mm um");
  s.add("radius", r.radius, "of a disc (2D) or ball; 0: a box").in("m").usually(1e-10, 1e4, "mm um nm").at_least(0);
}

void declare_pulse(Section &s, PulseParameters &p)
{
  s.add("shape", p.shape, "half a sine wave; or Ricker's wavelet, (1 - 2 a^2) exp(-a^2), whose peak frequency is 3/duration", words(PulseShape()));
  s.add("start", p.start, "when it begins").in("s").usually(1e-12, 1e5, "us ms ns").at_least(0);
  s.add("duration", p.duration, "how long it lasts; the peak, 1, is in the middle").in("s").usually(1e-12, 1e5, "us ms ns").above(0).required();
}

void declare_cycles(Section &s, CyclesParameters &c)
{
  s.add("mean", c.mean, "about which it swings; reached by the ramp, after which the cycles begin");
  s.add("amplitude", c.amplitude, "of the sine; the load is mean + amplitude sin(2 pi (t - ramp)/period) times its value");
  s.add("period", c.period, "of one cycle").in("s").usually(1e-12, 1e5, "us ms ns").above(0).required();
}

void declare_history(Section &s, History &h)
{
  s.add("table", h.table, "pairs of a time and a factor on the load's value: straight lines between them, level before and after; velocities follow it, displacements move along it").in("s");
  s.section("pulse", h.pulse, "none", "one pulse", declare_pulse);
  s.section("cycles", h.cycles, "none", "a sine wave about a mean", declare_cycles);
}

void declare_servo(Section &s, ServoParameters &v)
{
  s.add("gauge", v.gauge, "the quantity: a column of history.csv that belongs to a gauge in /gauges (its name, where it has one column); not given: the load's own force over its area, tension positive");
  s.add("stress", v.stress, "wanted without gauge: the mean stress of the load; compression is negative").in("Pa").usually(10, 2e11, "MPa kPa GPa");
  s.add("value", v.value, "wanted of the gauge, in the SI unit of its column; reached with the course's 1");
  s.add("ramp", v.ramp, "time over which the wanted value grows").in("s").usually(1e-12, 1e5, "us ms ns").at_least(0);
  declare_history(s.section("history", "course of the wanted value in time, as for loads"), v.history);
  s.add("gain", v.gain, "by how much the gauge's column rises when the load moves by 1 m along its velocity, roughly; 0: 1, as for a distance between points that the whole specimen's elongation opens");
  s.add("response_time", v.response_time, "within which the machine answers; 0: four transits of a shear wave through the specimen's longest edge, times its slenderness").in("s").usually(1e-12, 1e3, "us ms ns").at_least(0);
}

void declare_load(Section &s, LoadParameters &l)
{
  s.add("boundary", l.side, "side of the specimen: left, right, bottom, top, back or front, or the name of a side of its outline, a cutout or a slot").required_unless("there is \"periodic\"");
  s.add("periodic", l.periodic, "in place of boundary: the load is the jump of the displacement across the sides that are joined along this axis, from a point to its image one period further; components that are not given are 0", words(Axis()));
  s.add("velocity", l.velocity, "prescribed velocity; null: free").in("m/s").usually(1e-12, 1e3, "mm/s um/s km/h");
  s.add("displacement", l.displacement, "prescribed displacement; null: free").in("m").usually(0, 1e2, "mm um nm");
  s.add("strain", l.strain, "for periodic: the jump over the period; along the axis the mean strain, across it the mean shear strain (tan of the angle)").usually(0, 1, "%");
  s.add("traction", l.traction, "prescribed force per area; null: none").in("Pa").usually(10, 2e11, "MPa kPa GPa");
  s.add("force", l.force, "prescribed force in all, in 2D over the thickness, spread evenly over the part; null: none").in("N").usually(1e-9, 1e12, "kN MN mN");
  s.add("pressure", l.pressure, "prescribed pressure along the present normal of the surface, which it follows; positive presses").in("Pa").usually(10, 2e11, "MPa kPa GPa");
  s.add("ramp", l.ramp, "time over which the load grows to its value").in("s").usually(1e-12, 1e5, "us ms ns").at_least(0);
  declare_history(s.section("history", "course of the load in time, as a factor on its value, in place of a ramp: one of a table, a pulse, cycles"), l.history);
  s.section("servo", l.servo, "none", "steers the load so that a measured quantity follows a course: it moves along its velocity, at most as fast, either way; in place of ramp and history", declare_servo);
  s.add("from", l.from, "the load acts on a part of the side: from this coordinate along it; not set: from its end").in("m").usually(0, 1e4, "mm um").only_in(2);
  s.add("to", l.to, "to this one; not set: to its end; a force may act at a point, from = to").in("m").usually(0, 1e4, "mm um").only_in(2);
  declare_region_of(s.section("within", "the load acts on the part of the side within a box or a ball"), l.within);
  s.add("absorbing", l.absorbing, "waves leave through this side; alone or with a traction");
  s.add("absorbing_layer", l.absorbing_layer, "width of a damping layer inside the absorbing side, one to two wave lengths; 0: dashpots on the side alone").in("m").usually(0, 1e4, "mm um").at_least(0);
}

void declare_tool(Section &s, ToolParameters &t)
{
  s.add("name", t.name, "of the tool; its columns in history.csv begin with it").required();
  s.add("shape", t.shape, "plate: a rectangle (2D) or box; roller: a disc or cylinder; ball; wedge: a convex polygon or the prism over one", words(ToolKind())).required();
  s.add("place", t.place, "centre of the tool where the run begins; of a wedge the point that its corners refer to").in("m").usually(0, 1e4, "mm um").required();
  s.add("orientation", t.orientation, "turns the tool: an angle (2D) or a rotation vector (3D); a roller's axis and a wedge's edge lie along z at 0").in("rad").usually(0, 6.3, "deg mrad").at_least(-1000).at_most(1000).as_rotation();
  s.add("size", t.size, "plate: edge lengths").in("m").usually(1e-8, 1e4, "mm um").at_least(0);
  s.add("radius", t.radius, "roller, ball").in("m").usually(1e-10, 1e4, "mm um nm").at_least(0);
  s.add("length", t.length, "roller, wedge: along their axis").in("m").usually(1e-8, 1e4, "mm um").above(0).word("endless", infinity).only_in(3);
  s.add("points", t.points, "wedge: three or more corners against its place, in turn; 3D: with 0 as third coordinate").in("m").usually(0, 1e4, "mm um");
  s.add("velocity", t.velocity, "prescribed velocity; null: 0. Without mass that of the tool, with machine_stiffness that of the spring's far end").in("m/s").usually(1e-12, 1e4, "mm/s um/s km/h");
  s.add("displacement", t.displacement, "prescribed displacement, likewise, in place of a velocity").in("m").usually(0, 1e2, "mm um nm");
  s.add("ramp", t.ramp, "time over which the motion grows to its value").in("s").usually(1e-12, 1e5, "us ms ns").at_least(0);
  declare_history(s.section("history", "course of the motion in time, as for loads"), t.history);
  s.add("mass", t.mass, "of a tool that moves as it is pushed; in 2D over the thickness; not given: it moves as prescribed, or stands still").in("kg").usually(1e-18, 1e9, "g mg t").above(0);
  s.add("inertia", t.inertia, "of a tool with mass about its centre, 2D or a ball; 0: it doesn't turn").in("kg*m^2").at_least(0);
  s.add("initial_velocity", t.initial_velocity, "of a tool with mass where the run begins").in("m/s").usually(1e-12, 1e5, "mm/s km/h");
  s.add("machine_stiffness", t.machine_stiffness, "of a spring between the prescribed motion and a tool with mass, alike in all directions; 0: none").in("N/m").usually(1e-3, 1e15, "kN/mm N/mm").at_least(0);
  s.add("friction", t.friction, "Coulomb friction between tool and body").at_least(0).at_most(10);
  s.add("release", t.release, "when the tool is taken away").in("s").usually(1e-12, 1e5, "us ms ns").above(0).word("never", infinity);
}

void declare_initial_motion(Section &s, InitialMotion &m)
{
  s.add("velocity", m.velocity, "of all points there").in("m/s").usually(1e-12, 1e4, "mm/s um/s km/h");
  s.add("spin", m.spin, "turning about the centre besides: a rate (2D) or a vector (3D)").in("rad/s").as_rotation();
  s.add("centre", m.centre, "about which it turns").in("m").usually(0, 1e4, "mm um");
  declare_region_of(s.section("within", "the part of the body that moves; not given: all of it"), m.within);
}

void declare_body_force(Section &s, BodyForceParameters &b)
{
  s.add("acceleration", b.acceleration, "force per mass; gravity is [0, -9.81]").in("m/s^2").usually(1e-6, 1e9, "mm/s^2");
  s.add("ramp", b.ramp, "time over which it grows to its value").in("s").usually(1e-12, 1e5, "us ms ns").at_least(0);
  declare_history(s.section("history", "course of the force in time, as for loads"), b.history);
}

void declare_time(Section &s, TimeParameters &t)
{
  s.add("duration", t.duration, "simulated time").in("s").usually(1e-12, 1e5, "us ms ns").above(0).required();
  s.add("step_fraction", t.step_fraction, "time step as fraction of the largest stable one").above(0).below(1);
  s.add("step", t.step, "time step, in place of step_fraction; refused above 0.99 of the stable one").in("s").usually(1e-18, 1e2, "us ns ps").above(0);
  s.add("rest_threshold", t.rest_threshold, "strain from which on a wave wakes a region at rest, which takes no steps until then; 0: any motion wakes it, and no result changes").at_least(0).at_most(1e-3);
  s.add("stop_when", t.stop_when, "end: after the duration; specimen_broken: as soon as its load path is gone (theory.md section 5.4)", words(StopWhen()));
  s.add("loading", t.loading, "dynamic: by time steps all the way; static: by equilibria up to the load at which the next bond breaks, with time steps from there until the body is calm again; sequential: by equilibria alone, bond by bond, without dynamics", words(Loading()));
  s.add("calm", t.calm, "for loading static: transits of a shear wave through the discrete zone without a break after which time steps may end; they go on while the kinetic energy is above 1 % of the potential one, up to 50 transits").above(0).at_most(50).usually(2, 30, "");
  s.add("static_solver", t.static_solver, "for loading static and sequential: what the equilibria are solved with; automatic: cholesky for small bodies in 2D, multigrid for all others; parallel_multigrid: its levels on all ranks, where others leave equilibria to the first one: faster, but results are no longer those of one process to the last bit", words(StaticSolver()));
}

void declare_picture(Section &s, PictureParameters &p)
{
  s.add("field", p.field, "what colours the pictures; without component the length of a vector").one_of(shown_field_words(3));
  s.set_shorthand("field");
}

void declare_output(Section &s, OutputParameters &o)
{
  s.add("field_interval", o.field_interval, "simulated time between two outputs of all fields").in("s").usually(1e-15, 1e5, "us ms ns").above(0).word("never", infinity);
  s.add("history_interval", o.history_interval, "simulated time between two lines of history.csv; 0: duration/2000, and every 50 steps of the far field in which faces broke").in("s").usually(1e-15, 1e5, "us ms ns").at_least(0);
  s.add("progress_interval", o.progress_interval, "wall time between two progress lines").in("s").above(0);
  s.add("checkpoint_interval", o.checkpoint_interval, "wall time between two checkpoints, from which `ligament resume` goes on; never: only where a signal or --wall-time ends the run").in("s").above(0).word("never", infinity);
  s.list("pictures", o.pictures, "fields that the pictures of the run show, near the peak load and at the end; empty: the stress along the load", declare_picture);
  s.add("magnification", o.magnification, "factor on displacements in pictures; 0: a round one that suits all pictures of the run").at_least(0);
}
} // namespace

void declare_scene(Section &s, Scene &scene, bool may_be_atoms)
{
  s.ignore("$schema", "address of the JSON schema, for editors");
  s.add("title", scene.title, "one line for reports");
  s.add("dimension", scene.dimension, "2 or 3").at_least(2).at_most(3);
  s.add("plane", scene.plane, "plane strain or plane stress", {"strain", "stress"}).only_in(2);
  declare_specimen(s.section("specimen", "the body"), scene.specimen);
  declare_material(s.section("material", "what it is made of"), scene.material, may_be_atoms);
  s.section("atoms", scene.atoms, "none", "the particles are atoms of a crystal, whose spacing, density and elastic constants follow from their potential: in place of material", declare_atoms);
  s.list("inclusions", scene.inclusions, "other materials inside the discrete zone, later ones over earlier ones: particles whose centres lie in their regions, and in a packing from a file those whose material is their number, from 1", declare_inclusion);
  declare_zone(s.section("discrete_zone", "where the body may break"), scene.zone);
  s.section("far_field", scene.far_field, "none", "finite elements around the discrete zone; none: the pure discrete reference of the scene", declare_far_field).required_unless("extent is all");
  declare_coupling(s.section("coupling", "the overlap of the two models"), scene.coupling);
  declare_damping(s.section("damping", "losses without physical meaning, for quasi-static scenes"), scene.damping);
  s.list("loads", scene.loads, "what acts on the sides; sides without load are free", declare_load);
  s.list("tools", scene.tools, "rigid bodies that touch the specimen: supports, punches, projectiles", declare_tool);
  s.list("gauges", scene.gauges, "what is measured besides load and elongation: columns of history.csv, curves of the report", declare_gauge);
  declare_body_force(s.section("body_force", "acts on every mass of the body, of both models; not on tools"), scene.body_force);
  s.list("initial_motion", scene.initial_motion, "motions of the body or parts of it at the beginning, which add up; the overlap begins with the motion of the mesh there", declare_initial_motion);
  declare_time(s.section("time", "how long"), scene.time);
  declare_output(s.section("output", "what is written, and how often"), scene.output);
}
// clang-format on
} // namespace ligament::program
