// A scene as the program works with it: plain values in SI units, already checked.
#pragma once

#include "core/types.h"
#include "coupling/coupler_parameters.h"
#include "src/scene/choices.h"
#include "src/scene/gauge_parameters.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace ligament::program
{
/// A cut without width: 2D a line of two or more points, 3D a convex plane polygon (three or more).
struct Crack
{
  std::vector<Point> points; // m
};

/// 2D: a disc cut out of the specimen.
struct Hole
{
  Point centre;  // m
  double radius; // m
};

/// A box cut out of the specimen.
struct Notch
{
  Point lower, upper; // m
};

/// A corner of a closed curve in the plane of x and y, and the way to it from the one before.
struct OutlineCorner
{
  Point at = {0, 0, 0};   // m
  PartialPoint centre;    // m, of an arc; none: straight
  bool clockwise = false; // an arc's way about its centre
  std::string side;       // name of what lies between; none: the side of the box, or nothing
};

/// An opening of any outline.
struct Cutout
{
  std::vector<OutlineCorner> outline;
  std::string side; // name of its rim
};

/// A notch with parallel flanks, at any angle.
struct Slot
{
  Point from = {0, 0, 0}, to = {0, 0, 0}; // m, middle of its mouth and its tip
  double width = 0;                       // m
  SlotTip tip = SlotTip::flat;
  double tip_angle = M_PI / 3; // rad, for tip v
  std::string side;            // name of its flanks and tip
};

struct Ball
{
  double radius = 0; // m, about the origin
};

/// An axis along which the body repeats itself: the two sides across it are one.
struct PeriodicAxis
{
  Axis axis = Axis::x;
};

struct BodyFile; // src/scene/body_file.h

struct Specimen
{
  Point size = {0, 0, 0};             // m, of the smallest box around it
  Point centre = {0, 0, 0};           // m, of that box: the origin unless there is an outline
  double thickness = 1;               // m, 2D; 3D: of an outline, along z
  std::vector<OutlineCorner> outline; // empty: the box
  std::vector<Cutout> cutouts;
  std::vector<Slot> slots;
  std::optional<Ball> ball;             // 3D
  std::string file;                     // with the body; relative to the scene until it is read
  std::shared_ptr<const BodyFile> body; // what it holds
  std::vector<Crack> cracks;
  std::vector<Hole> holes;
  std::vector<Notch> notches;
  std::vector<PeriodicAxis> periodic;

  bool is_periodic(int c) const
  {
    for (const PeriodicAxis &p : periodic)
      if (int(p.axis) == c)
        return true;
    return false;
  }
  double lower(int c) const { return centre[c] - size[c] / 2; }
  double upper(int c) const { return centre[c] + size[c] / 2; }
  Point lower() const { return {lower(0), lower(1), lower(2)}; }
  Point upper() const { return {upper(0), upper(1), upper(2)}; }
  /// A box, perhaps with boxes and discs cut out of it.
  bool is_plain() const
  {
    return outline.empty() && cutouts.empty() && slots.empty() && !ball && file.empty();
  }
  /// Its box follows from something else.
  bool has_own_box() const { return !outline.empty() || ball || !file.empty(); }
};

/// Scatter of the strengths of faces.
struct WeibullParameters
{
  double modulus = 0;
  std::optional<double> reference_area; // m^2
  int seed = 1;
};

/// When faces that touch become bonds again.
struct RebondingParameters
{
  double pressure = 0, plastic_strain = 0, strength = 0; // Pa, -, Pa
};

struct FractureParameters
{
  Criterion criterion = Criterion::none;
  std::optional<double> strength;  // Pa
  std::optional<double> toughness; // Pa m^0.5: strength = c K/sqrt(d), c calibrated at set-up
  std::optional<double> energy;    // J/m^2: G_c of faces that soften
  SofteningCurve softening = SofteningCurve::linear;
  double mode_ratio = 1;
  // Of the criteria that have more than one strength.
  std::optional<double> compressive_strength; // Pa
  std::optional<double> cohesion;             // Pa
  std::optional<double> friction_angle;       // rad
  std::optional<WeibullParameters> weibull;
  std::optional<double> crack_velocity; // m/s
  std::optional<RebondingParameters> rebonding;

  /// Cohesion of mohr_coulomb in Pa, given or from the compressive strength; with a friction angle.
  double plane_cohesion() const
  {
    return cohesion ? *cohesion
                    : *compressive_strength * (1 - std::sin(*friction_angle)) /
                          (2 * std::cos(*friction_angle));
  }
};

/// A point of a yield curve.
struct YieldPoint
{
  double strain = 0, stress = 0; // -, Pa
};

struct PlasticityParameters
{
  PlasticityLaw law = PlasticityLaw::von_mises;
  double hardening = 0; // Pa
  // Of von_mises.
  std::optional<double> yield_stress;                // Pa
  std::optional<double> saturation, saturation_rate; // Pa, -
  std::vector<YieldPoint> curve;
  // Of drucker_prager.
  std::optional<double> cohesion, friction_angle; // Pa, rad
  double dilatancy_angle = 0;                     // rad
  std::optional<double> softening_energy;         // J/m^2

  /// Of drucker_prager, without pressure: sqrt(1/2 s:s) in Pa at which flow begins.
  double shear_strength() const
  {
    return 2 * std::sqrt(3.) * *cohesion * std::cos(*friction_angle) /
           (3 - std::sin(*friction_angle));
  }
};

/// A spring and a dashpot in series.
struct BranchParameters
{
  double share = 0, relaxation_time = 0; // of the shear modulus, s
};

struct ViscosityParameters
{
  std::vector<BranchParameters> branches;
  std::optional<double> shear_viscosity; // Pa s
};

struct MaterialParameters
{
  double youngs_modulus = 0; // Pa
  double poissons_ratio = 0;
  double density = 0; // kg/m^3
  double friction = 0;
  FractureParameters fracture;
  std::optional<PlasticityParameters> plasticity;
  std::optional<ViscosityParameters> viscosity;
};

/// Particles of another material: those with their centre in one of the regions. The k-th one, from
/// 1, also has the particles whose material is k in the file of the packing.
struct Inclusion
{
  MaterialParameters material;
  std::vector<Hole> balls; // discs in 2D
  std::vector<Notch> boxes;
};

/// Atoms of the crystal that are of another species: those of its sites in one of the regions.
struct Substitution
{
  std::string species;
  double share = 1;        // of these sites, by chance
  std::vector<Hole> balls; // discs in 2D
  std::vector<Notch> boxes;
};

/// The particles are atoms; what the material is follows from them.
struct AtomsParameters
{
  AtomPotential potential = AtomPotential::zhou;
  std::string species; // of the crystal
  std::string file;    // with tables; relative to the scene until it is read
  // Of the potentials that are formulas:
  double energy = 0, distance = 0; // J, m: depth of the well, place of it (lennard_jones: sigma)
  double decay = 0;                // 1/m, of morse
  double mass = 0;                 // kg
  double taper_begin = 0;          // m; 0: the potential's own, also of the next
  double cutoff = 0;               // m
  /// 3D: directions of the crystal's cube that lie along x and y; all 0: the cube lies along the
  /// axes.
  Point along_x = {0, 0, 0}, along_y = {0, 0, 0};
  double temperature = 0;       // K
  double lattice_parameter = 0; // m, at this temperature; 0: to be found
  int seed = 1;                 // of random numbers: heat, and which sites are substituted
  double zone_friction = 0;     // 1/s, of a thermostat on the zone's atoms outside the overlap
  double averaging = 0;         // s, over which thermal means are taken; 0: as long as they need
  std::vector<Substitution> substitutions; // later ones over earlier ones
  // What follows from them and the potential:
  std::vector<double> other_densities; // kg/m^3, of the same crystal of each further species
  double disturbance = 0; // m: how far around an atom of another species forces at rest change
};

/// m; sides as those of DiscreteZone.
struct ZoneBox
{
  Point lower = {-infinity, -infinity, -infinity}, upper = {infinity, infinity, infinity};
};

/// What of the specimen a zone holds, and how much around it.
struct ZoneAround
{
  bool cracks = false, slots = false, notches = false, holes = false, cutouts = false,
       corners = false;
  double margin = 0; // m, between these and the overlap
};

struct DiscreteZone
{
  enum class Extent
  {
    none, // pure finite elements
    all,  // pure discrete elements
    box
  };
  Extent extent = Extent::box;
  /// m; sides that reach beyond the specimen are not coupled. Infinite only while it is read:
  /// afterwards such sides lie half a specimen outside.
  Point lower = {-infinity, -infinity, -infinity}, upper = {infinity, infinity, infinity};
  /// The zone is their union; `lower` and `upper` then are the corners around all. Empty: one box.
  std::vector<ZoneBox> boxes;
  std::optional<ZoneAround> around; // in place of both; afterwards they are what it means
  std::optional<PackingKind> packing;
  std::string packing_file;   // for packing file; relative to the scene until it is read
  int seed = 1;               // this and the next two: for packing random
  int relaxation_sweeps = 10; // of Lloyd's relaxation
  double size_ratio = 1;      // largest over smallest radius
  double spacing = 0;         // m, d; 0: not given, which only scenes without particles may do
  /// 2D: {angle}; 3D: rotation vector; rad. Close-packed rows lie along x at 0.
  Point orientation = {0, 0, 0};

  bool is_irregular() const
  {
    return packing == PackingKind::random || packing == PackingKind::file;
  }
};

struct FarField
{
  double cell_size;        // m, h beside the zone
  int levels = 0;          // refinement levels: the largest cells have size h 2^levels
  int cells_per_level = 4; // cells between two steps of the mesh size
  double growth = 1;       // above 1: from cell to cell, in place of refinement
  int fine_cells = 0;      // cells of size h, from the inner end of the overlap on; 0: automatic
  bool cells_from_file = false; // of /specimen/file
  double outline_cell_size = 0; // m, along curved and slanted sides; 0: cell_size
};

struct CouplingParameters
{
  static constexpr coupling::FineScaleSplitParameters split = {}; // the defaults
  static constexpr coupling::BridgingDomainParameters weighted = {};

  coupling::Scheme scheme = coupling::Scheme::fine_scale_split;
  int overlap_cells = 3;
  int transition_cells = 6;               // over which the mass goes from consistent to lumped
  int step_ratio = split.step_ratio;      // m: far field steps once per m fine steps
  double fine_damper = split.fine_damper; // c_f
  double gap_filter = split.gap_filter;   // c_g
  bool patch_fit = split.patch_fit;
  // Energy-weighted schemes only:
  coupling::WeightShape weight = coupling::WeightShape::cubic;
  coupling::DamperForm damper_form = weighted.damper_form;
  int multiplier_cells = weighted.multiplier_cells;
  Point ghost_force_correction = {0, 0, 0}; // normal strains
  coupling::Solver solver = split.solver;
  Guard guard = Guard::stop;
  RegimeChoice regime = RegimeChoice::automatic;
  double coarse_mass =
      split.coarse_mass; // factor on the masses of the coarse motion and the far field
};

struct Damping
{
  double local = 0; // fraction of the force, against the motion
  double mass = 0;  // 1/s, all bodies
  bool kinetic = false;
};

/// Of the smallest box around the specimen, by number: twice the axis, and one more for the upper
/// side. Further ones have names of their own: side_names_of().
inline const std::vector<std::string> box_sides = {"left", "right", "bottom",
                                                   "top",  "back",  "front"};

/// A part of the body: a box, or a ball (in 2D a disc) where there is a radius.
struct Region
{
  Point lower = {-infinity, -infinity, -infinity}, upper = {infinity, infinity, infinity}; // m
  PartialPoint centre;                                                                     // m
  double radius = 0;                                                                       // m

  bool is_ball() const { return radius > 0; }
  /// Nothing is left out.
  bool is_everything() const
  {
    const Region plain;
    return !is_ball() && lower == plain.lower && upper == plain.upper;
  }
};

struct PulseParameters
{
  PulseShape shape = PulseShape::half_sine;
  double start = 0, duration = 0; // s
};

struct CyclesParameters
{
  double mean = 0, amplitude = 1, period = 0; // -, -, s
};

/// The course of a load in time; nothing of it: its ramp.
struct History
{
  std::vector<std::array<double, 2>> table; // s, -
  std::optional<PulseParameters> pulse;
  std::optional<CyclesParameters> cycles;

  bool is_given() const { return !table.empty() || pulse || cycles; }
};

/// A machine that moves so that a measured quantity follows a course.
struct ServoParameters
{
  std::string gauge;            // column of a gauge; empty: the load's own mean stress
  std::optional<double> stress; // Pa, wanted where there is no gauge
  std::optional<double> value;  // wanted of the gauge, in the unit of its column
  double ramp = 0;              // s
  History history;
  double gain = 0;          // of the gauge per m of the load's motion; 0: 1
  double response_time = 0; // s; 0: automatic

  double wanted() const { return gauge.empty() ? stress.value_or(0) : value.value_or(0); }
};

struct LoadParameters
{
  std::string side;                                     // its name
  int boundary = 0;                                     // number of the side, see side_names_of
  std::optional<Axis> periodic;                         // in place of a side: the jump across it
  PartialPoint strain;                                  // of that jump over the period
  PartialPoint velocity, displacement, traction, force; // m/s, m, Pa, N; one has components
  std::optional<double> pressure;                       // Pa, in place of them
  double ramp = 0;                                      // s
  History history;
  std::optional<ServoParameters> servo; // in place of both; of a velocity, which bounds it
  std::optional<double> from, to;       // m, along the side in 2D
  Region within;
  bool absorbing = false;             // lets waves out, beside a traction or alone
  double absorbing_layer = 0;         // m
  LoadKind kind = LoadKind::traction; // the one that has components
  PartialPoint value;                 // and its components
};

/// A rigid body that touches the specimen.
struct ToolParameters
{
  std::string name;
  ToolKind shape = ToolKind::plate;
  Point place = {0, 0, 0};             // m, of its centre
  Point orientation = {0, 0, 0};       // rad, as that of the packing
  Point size = {0, 0, 0};              // m, edges of a plate
  double radius = 0;                   // m, roller and ball
  double length = infinity;            // m, 3D: of rollers and wedges, along their third axis
  std::vector<Point> points;           // m, corners of a wedge against its place, before it turns
  PartialPoint velocity, displacement; // m/s, m; of the tool or of the far end of its spring
  double ramp = 0;                     // s
  History history;                     // of the motion
  std::optional<double> mass;          // kg; none: it moves as prescribed
  double inertia = 0;                  // kg m^2; 0: it doesn't turn
  Point initial_velocity = {0, 0, 0};  // m/s
  double machine_stiffness = 0;        // N/m; 0: no spring
  double friction = 0;                 // Coulomb's coefficient
  double release = infinity;           // s

  bool is_driven() const
  {
    for (int c = 0; c < 3; ++c)
      if (velocity[c] || displacement[c])
        return true;
    return false;
  }
};

/// Where the run begins, a part of the body or all of it moves.
struct InitialMotion
{
  Point velocity = {0, 0, 0}; // m/s
  Point spin = {0, 0, 0};     // rad/s, 2D: the first; about the centre
  Point centre = {0, 0, 0};   // m
  Region within;
};

/// Acts on every mass.
struct BodyForceParameters
{
  Point acceleration = {0, 0, 0}; // m/s^2
  double ramp = 0;                // s
  History history;

  bool is_any() const
  {
    return acceleration[0] != 0 || acceleration[1] != 0 || acceleration[2] != 0;
  }
};

struct TimeParameters
{
  double duration; // s
  double step_fraction = 0.9;
  std::optional<double> step; // s; refused above the stable one
  StopWhen stop_when = StopWhen::end;
  double rest_threshold = 0; // strain from which on a wave wakes what is at rest
  Loading loading = Loading::dynamic;
  double calm = 8; // transits of a shear wave through the zone without a break, then it is calm
  StaticSolver static_solver = StaticSolver::automatic;

  bool has_phases() const { return loading != Loading::dynamic; }
};

/// One of the quantities that pictures show.
struct PictureParameters
{
  std::string field = "equivalent_stress"; // a word of shown_field_words()
};

struct OutputParameters
{
  double field_interval = infinity;        // s; infinite: never
  double history_interval = 0;             // s; 0: duration/2000
  double progress_interval = 2;            // s of wall time
  double checkpoint_interval = 900;        // s of wall time; infinite: never by itself
  std::vector<PictureParameters> pictures; // empty: the stress along the load
  double magnification = 0;                // of displacements in pictures; 0: one that suits
};

struct Scene
{
  std::string title;
  int dimension = 2;
  PlaneMode plane = PlaneMode::strain;
  Specimen specimen;
  MaterialParameters material;
  std::optional<AtomsParameters> atoms; // the material, spacing and plane then follow from them
  std::vector<Inclusion> inclusions;    // later ones over earlier ones
  DiscreteZone zone;
  std::optional<FarField> far_field;
  CouplingParameters coupling;
  Damping damping;
  std::vector<LoadParameters> loads;
  std::vector<ToolParameters> tools;
  std::vector<GaugeParameters> gauges;
  BodyForceParameters body_force;
  std::vector<InitialMotion> initial_motion;
  TimeParameters time;
  OutputParameters output;

  /// Of all materials by their numbers, kg/m^3.
  std::vector<double> densities() const
  {
    std::vector<double> all = {material.density};
    for (const Inclusion &i : inclusions)
      all.push_back(i.material.density);
    if (atoms)
      all.insert(all.end(), atoms->other_densities.begin(), atoms->other_densities.end());
    return all;
  }
  /// Whether any material may flow, or is viscous.
  bool flows() const { return any_has(&MaterialParameters::plasticity); }
  /// Atoms at a temperature.
  bool is_warm() const { return atoms && atoms->temperature > 0; }
  bool is_viscous() const { return any_has(&MaterialParameters::viscosity); }
  /// Whether faces of any may be bonded again.
  bool rebonds() const
  {
    return material.fracture.rebonding ||
           std::any_of(inclusions.begin(), inclusions.end(), [](const Inclusion &i) {
             return i.material.fracture.rebonding.has_value();
           });
  }

private:
  template <typename Law>
  bool any_has(std::optional<Law> MaterialParameters::*law) const
  {
    return (material.*law).has_value() ||
           std::any_of(inclusions.begin(), inclusions.end(),
                       [&](const Inclusion &i) { return (i.material.*law).has_value(); });
  }
};
} // namespace ligament::program
