#include "src/scene/atoms.h"

#include "core/keyed_error.h"
#include "md/analytic.h"
#include "md/atomic_units.h"
#include "md/table_file.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

namespace ligament::program
{
namespace
{
const std::string section = "/atoms";

/// `names`: of the species that it shall have; potentials of one species know no names.
md::Potential potential_of(const AtomsParameters &a, const std::vector<std::string> &names)
{
  const md::Species species = {a.species.empty() ? "A" : a.species, a.mass};
  // Where only the end is given the taper begins before it, as early as by default or later.
  const auto cut_off = [&](double begin, double end) {
    end = a.cutoff > 0 ? a.cutoff : end * a.distance;
    begin = a.taper_begin > 0 ? a.taper_begin : std::min(begin * a.distance, 0.88 * end);
    if (begin >= end)
      throw core::KeyedError(
          section + (a.cutoff > 0 ? "/cutoff" : "/taper_begin"),
          fmt::format("the pair's energy in /atoms goes to 0 from {:.4g} m to {:.4g} m", begin,
                      end),
          "it must begin below its end", "give a smaller \"taper_begin\" or a larger \"cutoff\"");
    return md::CutOff{begin, end};
  };
  switch (a.potential) {
  case AtomPotential::zhou:
    return md::zhou_johnson_wadley(names);
  case AtomPotential::plane_crystal:
    return md::plane_crystal(species, a.energy, a.distance);
  case AtomPotential::lennard_jones:
    return md::lennard_jones(species, a.energy, a.distance, cut_off(2.2, 2.5));
  case AtomPotential::morse:
    return md::morse(species, a.energy, a.distance, a.decay, cut_off(1.6, 2));
  case AtomPotential::setfl:
    return md::read_setfl(a.file, names);
  case AtomPotential::setfl_fs:
    return md::read_setfl_fs(a.file, names);
  case AtomPotential::funcfl:
    break;
  }
  return md::read_funcfl({a.file});
}

md::Potential read_potential(const AtomsParameters &a, const std::vector<std::string> &names)
{
  const std::string source = a.file.empty() ? section : section + "/file";
  return core::at_key(source, "correct it or its path", [&] {
    try {
      return potential_of(a, names);
    } catch (const core::EnvironmentError &error) {
      throw core::KeyedError(source, "the \"file\" in /atoms cannot be read", error.what(),
                             "check the path; it starts in the folder of the scene");
    }
  });
}

bool is_zero(const Point &p)
{
  return p[0] == 0 && p[1] == 0 && p[2] == 0;
}

template <int dim>
md::Matrix<dim> orientation_of(const Scene &scene)
{
  const Point &turn = scene.zone.orientation;
  if constexpr (dim == 2)
    return Eigen::Rotation2Dd(turn[0]).toRotationMatrix();
  else {
    const Vector<3> vector(turn.data());
    const double angle = vector.norm();
    const md::Matrix<3> turned =
        Eigen::AngleAxisd(angle, angle > 0 ? Vector<3>(vector / angle) : Vector<3>::UnitZ())
            .toRotationMatrix();
    const AtomsParameters &a = *scene.atoms;
    if (is_zero(a.along_x) && is_zero(a.along_y))
      return turned;
    return turned * md::orientation_of(Vector<3>(a.along_x.data()), Vector<3>(a.along_y.data()));
  }
}

md::CrystalKind kind_of(const Scene &scene)
{
  if (scene.dimension == 2)
    return md::CrystalKind::triangular;
  return scene.zone.packing == PackingKind::bcc ? md::CrystalKind::bcc : md::CrystalKind::fcc;
}

/// What lay on a joined side lies on it again where that has moved, and what went beyond still
/// does: cuts and openings that went through the specimen go through.
void follow_sides(int axis, double old_lower, double old_upper, Scene &scene)
{
  Specimen &s = scene.specimen;
  const double tolerance = 1e-9 * (old_upper - old_lower);
  const auto follow = [&](Point &p) {
    double &x = p[axis];
    if (x >= old_upper - tolerance)
      x = s.upper(axis) + std::max(0., x - old_upper);
    else if (x <= old_lower + tolerance)
      x = s.lower(axis) + std::min(0., x - old_lower);
  };
  const auto follow_all = [&](auto &balls, auto &boxes) {
    for (Hole &ball : balls)
      follow(ball.centre);
    for (Notch &box : boxes) {
      follow(box.lower);
      follow(box.upper);
    }
  };
  for (Crack &crack : s.cracks)
    for (Point &p : crack.points)
      follow(p);
  follow_all(s.holes, s.notches);
  for (Substitution &substitution : scene.atoms->substitutions)
    follow_all(substitution.balls, substitution.boxes);
  follow(scene.zone.lower);
  follow(scene.zone.upper);
  for (ZoneBox &box : scene.zone.boxes) {
    follow(box.lower);
    follow(box.upper);
  }
  for (LoadParameters &load : scene.loads) {
    follow(load.within.lower);
    follow(load.within.upper);
    // "from" and "to" in 2D; numbers of sides are not known yet.
    const int along = load.side == "left" || load.side == "right" ? 1 : 0;
    if (scene.dimension == 2 && axis == along)
      for (std::optional<double> *end : {&load.from, &load.to})
        if (*end) {
          Point p{};
          p[axis] = **end;
          follow(p);
          **end = p[axis];
        }
  }
  for (auto &motion : scene.initial_motion) {
    follow(motion.within.lower);
    follow(motion.within.upper);
  }
  for (GaugeParameters &gauge : scene.gauges) {
    follow(gauge.lower);
    follow(gauge.upper);
    for (Point &p : gauge.points)
      follow(p);
  }
}
} // namespace

// The axis in lattice vectors, stretched until one of them after the other is met a whole number of
// times.
template <int dim>
double period_along(const md::Crystal<dim> &crystal, int axis, double most)
{
  const md::Matrix<dim> &basis = crystal.basis();
  const Vector<dim> course = basis.inverse().col(axis); // per m
  const double largest = course.cwiseAbs().maxCoeff(), tolerance = 2.4e-8 * crystal.spacing();
  const long last = long(std::floor(most * (1 + 1e-9) * largest));
  for (long k = 1; k <= last; ++k) {
    const double along = double(k) / largest;
    const Vector<dim> r = basis * (along * course).array().round().matrix();
    if (along > 0.5 * crystal.spacing() && (r - along * Vector<dim>::Unit(axis)).norm() < tolerance)
      return r[axis];
  }
  return 0;
}

namespace
{
template <int dim>
void fit_periods(const md::Crystal<dim> &crystal, Scene &scene)
{
  for (int c = 0; c < dim; ++c) {
    if (!scene.specimen.is_periodic(c))
      continue;
    double &size = scene.specimen.size[c];
    const double lower = scene.specimen.lower(c), upper = scene.specimen.upper(c);
    const double period = period_along<dim>(crystal, c, size * 1.5);
    if (period == 0)
      throw core::KeyedError(
          fmt::format("/specimen/periodic"),
          fmt::format("the crystal does not repeat itself along {} within the specimen", "xyz"[c]),
          fmt::format("the specimen is {:.6g} m long there", size),
          "make it longer, or give the crystal a simpler orientation");
    size = std::max(1., std::round(size / period)) * period;
    follow_sides(c, lower, upper, scene);
  }
}

md::ThermalRun thermal_run_of(const Scene &scene)
{
  md::ThermalRun run;
  run.thermal_energy = thermal_energy_of(scene);
  run.seed = scene.atoms->seed;
  return run;
}

/// All that a thermal figure depends on.
std::string thermal_name(const Scene &scene)
{
  const AtomsParameters &a = *scene.atoms;
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {}", scene.dimension,
                     int(kind_of(scene)), int(a.potential), md::list_of_names(species_of(scene)),
                     a.file, a.energy, a.distance, a.decay, a.mass, a.taper_begin, a.cutoff,
                     a.temperature, a.seed, scene.specimen.thickness);
}

/// Each further species for itself, so that the message is about its key.
void find_other_species(const Scene &scene)
{
  const AtomsParameters &a = *scene.atoms;
  if (a.substitutions.empty())
    return;
  read_potential(a, {a.species});
  for (std::size_t k = 0; k < a.substitutions.size(); ++k)
    core::at_key(fmt::format("{}/substitutions/{}/species", section, k), "give another one",
                 [&] { return potential_of(a, {a.substitutions[k].species}); });
}

template <int dim>
void derive(Scene &scene)
{
  find_other_species(scene);
  const bool is_found = scene.atoms->lattice_parameter == 0; // or given
  if (scene.is_warm()) {
    if (is_found)
      scene.atoms->lattice_parameter =
          core::at_key(section + "/temperature", "choose a lower one, or another potential",
                       [&] { return thermal_lattice_of<dim>(scene).parameter; });
    // About the mean positions a static overlap feels how it is turned.
    if (scene.coupling.regime == RegimeChoice::automatic)
      scene.coupling.regime = RegimeChoice::corotated;
  }
  const auto crystal = crystal_of<dim>(scene);
  const auto constants = crystal.elastic_constants();
  using Stiffness = Eigen::Matrix<double, n_strains<dim>, n_strains<dim>>;
  // Wider than without heat the lattice bears a stress, which resists as well: eq. (C23).
  Stiffness stiffness = constants.stiffness;
  const double tension = constants.stress.template head<dim>().mean();
  for (int c = 0; c < n_strains<dim>; ++c)
    stiffness(c, c) += c < dim ? tension : tension / 2;
  const auto resistance =
      Eigen::SelfAdjointEigenSolver<Stiffness>(stiffness, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .eval();
  const bool is_stable = resistance.minCoeff() > 1e-3 * resistance.maxCoeff();
  if (!is_stable && scene.is_warm())
    throw core::KeyedError(
        section + (is_found ? "/temperature" : "/lattice_parameter"),
        is_found ? fmt::format("the crystal is not stable as wide as it is at {} K",
                               scene.atoms->temperature)
                 : "the crystal is not stable with this lattice parameter",
        fmt::format("at a lattice parameter of {:.4g} m the least of its elastic constants is "
                    "{:.3g} Pa, the largest {:.3g} Pa",
                    crystal.lattice_parameter(), resistance.minCoeff(), resistance.maxCoeff()),
        is_found ? "choose a lower one, or another potential"
                 : "leave it out, and it is found for this temperature");
  if (!is_stable)
    throw core::KeyedError(
        "/discrete_zone/packing", "this lattice of the potential in /atoms is not stable",
        fmt::format("the least of its elastic constants is {:.3g} Pa, the largest "
                    "{:.3g} Pa",
                    resistance.minCoeff(), resistance.maxCoeff()),
        "choose the packing in which the element crystallises, or another "
        "potential");
  scene.zone.spacing = crystal.spacing();
  scene.material = MaterialParameters();
  scene.material.youngs_modulus = constants.youngs_modulus;
  scene.material.poissons_ratio = constants.poissons_ratio;
  scene.material.density = constants.density;
  const md::Potential &potential = crystal.potential();
  AtomsParameters &a = *scene.atoms;
  a.other_densities.clear();
  for (int k = 1; k < potential.n_species(); ++k)
    a.other_densities.push_back(potential.species(k).mass / crystal.volume());
  // Neighbours have another density, and their neighbours other forces.
  a.disturbance = potential.cutoff() * (potential.has_embedding() ? 2 : 1);
  fit_periods<dim>(crystal, scene);
}

/// Potentials are made for one lattice; in another one the crystal has other constants than the
/// element, if it holds at all.
void doubt_lattice(const Scene &scene, Findings &f)
{
  const std::string key = "/discrete_zone/packing";
  if (scene.dimension == 2 || !scene.zone.packing)
    return;
  const md::Species species = read_potential(*scene.atoms, species_of(scene)).species(0);
  if ((species.lattice == "fcc" || species.lattice == "bcc") &&
      species.lattice != word_of(*scene.zone.packing))
    f.warning(key,
              fmt::format("\"packing\" in /discrete_zone is \"{}\" for {}",
                          word_of(*scene.zone.packing), species.name),
              fmt::format("its potential was made for a crystal that is {}", species.lattice),
              fmt::format("choose \"{}\", unless that is meant", species.lattice));
}

/// Keys that its potential reads, and others that it doesn't.
class KeyCheck
{
public:
  KeyCheck(const AtomsParameters &a, Findings &f)
      : f_(f), word_(word_of(a.potential)),
        is_table_(a.potential == AtomPotential::setfl || a.potential == AtomPotential::setfl_fs ||
                  a.potential == AtomPotential::funcfl),
        is_formula_(!is_table_ && a.potential != AtomPotential::zhou),
        is_pair_(a.potential == AtomPotential::lennard_jones || a.potential == AtomPotential::morse)
  {
    key("species", !is_formula_ && a.potential != AtomPotential::funcfl, !a.species.empty(),
        a.potential != AtomPotential::funcfl);
    key("file", is_table_, !a.file.empty(), is_table_);
    key("energy", is_formula_, a.energy > 0, is_formula_);
    key("distance", is_formula_, a.distance > 0, is_formula_);
    key("mass", is_formula_, a.mass > 0, is_formula_);
    key("decay", a.potential == AtomPotential::morse, a.decay > 0,
        a.potential == AtomPotential::morse);
    key("taper_begin", false, a.taper_begin > 0, is_pair_);
    key("cutoff", false, a.cutoff > 0, is_pair_);
    key("substitutions", false, !a.substitutions.empty(),
        a.potential == AtomPotential::zhou || a.potential == AtomPotential::setfl ||
            a.potential == AtomPotential::setfl_fs);
  }

private:
  void key(const std::string &name, bool is_needed, bool is_there, bool has_meaning)
  {
    const std::string key = section + "/" + name;
    if (!f_.sound({key}))
      return;
    if (is_needed && !is_there)
      f_.error(key, fmt::format("missing key \"{}\" in {}", name, section),
               fmt::format("the potential \"{}\" needs it", word_),
               fmt::format("add \"{}\"", name));
    else if (!has_meaning && is_there)
      f_.error(
          key,
          fmt::format("\"{}\" in {} has no meaning for the potential \"{}\"", name, section, word_),
          name == "substitutions" ? "it knows one species" : "it follows from the potential",
          name == "substitutions" ? "remove it, or choose \"zhou\", \"setfl\" or \"setfl_fs\""
                                  : "remove it");
  }

  Findings &f_;
  std::string word_;
  bool is_table_, is_formula_, is_pair_;
};

void check_lattice(const Scene &scene, Findings &f)
{
  const std::string packing = "/discrete_zone/packing", spacing = "/discrete_zone/spacing";
  if (f.sound_and_given({packing})) {
    const PackingKind kind = *scene.zone.packing;
    const bool fits = scene.dimension == 2 ? kind == PackingKind::hexagonal
                                           : kind == PackingKind::fcc || kind == PackingKind::bcc;
    if (!fits)
      f.error(packing,
              fmt::format("\"packing\" in /discrete_zone is \"{}\" for atoms in {}D", word_of(kind),
                          scene.dimension),
              "crystals are hexagonal in 2D, fcc or bcc in 3D",
              scene.dimension == 2 ? "choose \"hexagonal\"" : "choose \"fcc\" or \"bcc\"");
  }
  if (scene.dimension == 3 && scene.atoms->potential == AtomPotential::plane_crystal)
    f.error(section + "/potential", "\"potential\" in /atoms is \"plane_crystal\" in 3D",
            "its density is that of six neighbours in a plane",
            "choose another one, or \"dimension\" 2");
  if (f.sound_and_given({spacing}))
    f.error(spacing, "\"spacing\" in /discrete_zone of atoms",
            "it follows from the potential: that of the crystal without stress", "remove it");
  if (scene.dimension == 2 && !f.given("/specimen/thickness") && f.sound({"/specimen/thickness"}))
    f.error("/specimen/thickness", "missing key \"thickness\" in /specimen of a plane crystal",
            "its stresses and tractions are forces over length and thickness",
            "add one, as a rule the spacing of the atoms");
  const AtomsParameters &a = *scene.atoms;
  if (is_zero(a.along_x) != is_zero(a.along_y) && f.sound({section}))
    f.error(section + (is_zero(a.along_x) ? "/along_x" : "/along_y"),
            "only one of \"along_x\" and \"along_y\" in /atoms", "two directions say how it lies",
            "give both, or none");
}
} // namespace

template <int dim>
md::Crystal<dim> crystal_of(const Scene &scene)
{
  const AtomsParameters &a = *scene.atoms;
  md::CrystalParameters<dim> p;
  p.kind = kind_of(scene);
  const md::Potential potential = read_potential(a, species_of(scene));
  // A mesh alone needs no packing, but its constants are those of some lattice.
  const std::string &own = potential.species(0).lattice;
  if (dim == 3 && !scene.zone.packing && (own == "bcc" || own == "BCC"))
    p.kind = md::CrystalKind::bcc;
  p.orientation = core::at_key(section + "/along_x", "give two directions at a right angle",
                               [&] { return orientation_of<dim>(scene); });
  p.thickness = dim == 2 ? scene.specimen.thickness : 1;
  p.lattice_parameter = scene.is_warm() ? a.lattice_parameter : 0;
  return core::at_key(section + "/potential", "choose another potential or packing",
                      [&] { return md::Crystal<dim>(potential, p); });
}

void resolve_atoms(Scene &scene, Findings *f)
{
  if (!scene.atoms)
    return;
  if (f) {
    if (!f->sound({section, "/discrete_zone/packing", "/discrete_zone/orientation", "/dimension",
                   "/specimen"}))
      return;
    const KeyCheck keys(*scene.atoms, *f);
    check_lattice(scene, *f);
    if (!f->sound(
            {section, "/discrete_zone/packing", "/discrete_zone/spacing", "/specimen/thickness"}) ||
        (!scene.zone.packing && scene.zone.extent != DiscreteZone::Extent::none))
      return;
  }
  try {
    scene.dimension == 2 ? derive<2>(scene) : derive<3>(scene);
  } catch (const core::KeyedError &error) {
    if (!f)
      throw;
    f->error(error.key, error.message, error.reason, error.remedy);
    return;
  }
  if (!f)
    return;
  doubt_lattice(scene, *f);
  for (const char *key : {"/discrete_zone/spacing", "/material/youngs_modulus",
                          "/material/poissons_ratio", "/material/density"})
    f->derive(key);
}

std::vector<std::string> species_of(const Scene &scene)
{
  const AtomsParameters &a = *scene.atoms;
  std::vector<std::string> names = {a.species};
  for (const Substitution &s : a.substitutions)
    if (std::find(names.begin(), names.end(), s.species) == names.end())
      names.push_back(s.species);
  return names;
}

double thermal_energy_of(const Scene &scene)
{
  constexpr double boltzmann = 1.380649e-23; // J/K
  return scene.is_warm() ? boltzmann * scene.atoms->temperature : 0;
}

template <int dim>
md::ThermalLattice thermal_lattice_of(const Scene &scene)
{
  static std::map<std::string, md::ThermalLattice> known;
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const std::string name = thermal_name(scene);
  if (const auto found = known.find(name); found != known.end())
    return found->second;
  Scene still = scene;
  still.atoms->temperature = still.atoms->lattice_parameter = 0;
  const auto crystal = crystal_of<dim>(still);
  return known[name] = md::thermal_lattice<dim>(crystal.potential(), crystal.parameters(),
                                                thermal_run_of(scene));
}

template <int dim>
md::CubicConstants thermal_constants_of(const Scene &scene)
{
  const auto crystal = crystal_of<dim>(scene);
  return md::thermal_constants<dim>(crystal.potential(), crystal.parameters(),
                                    thermal_run_of(scene));
}

template md::ThermalLattice thermal_lattice_of<2>(const Scene &);
template md::ThermalLattice thermal_lattice_of<3>(const Scene &);
template md::CubicConstants thermal_constants_of<2>(const Scene &);
template md::CubicConstants thermal_constants_of<3>(const Scene &);
template double period_along(const md::Crystal<2> &, int, double);
template double period_along(const md::Crystal<3> &, int, double);
template md::Crystal<2> crystal_of(const Scene &);
template md::Crystal<3> crystal_of(const Scene &);
} // namespace ligament::program
