#include "src/simulation/make_force.h"

#include "dem/many_body_force.h"
#include "dem/principal_tension.h"
#include "dem/toughness_calibration.h"
#include "packings/straight_levers.h"
#include "src/scene/atoms.h"
#include "src/scene/check_scene.h"
#include "src/scene/crack_axes.h"
#include "src/scene/fracture_energy.h"
#include "src/scene/geometry.h"
#include "src/simulation/make_packing.h"
#include "src/simulation/toughness_cache.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace ligament::program
{
namespace
{
/// Coulomb's angles as slopes of the cone through the edges of triaxial compression.
double cone_slope(double angle)
{
  return 2 * std::sqrt(3.) * std::sin(angle) / (3 - std::sin(angle));
}

/// `width` in m of the bands in which flow that softens gathers.
dem::Plasticity plasticity_of(const std::optional<PlasticityParameters> &p, double width)
{
  if (!p)
    return {};
  if (p->law == PlasticityLaw::drucker_prager) {
    const double angle = *p->friction_angle;
    const double yield = p->shear_strength();
    const double hardening =
        p->softening_energy ? -yield * yield * width / (2 * *p->softening_energy) : p->hardening;
    return dem::DruckerPragerFlow{yield, hardening, cone_slope(angle),
                                  cone_slope(p->dilatancy_angle)};
  }
  dem::YieldCurve curve;
  curve.initial = p->yield_stress.value_or(0);
  curve.hardening = p->hardening;
  curve.saturation = p->saturation.value_or(0);
  curve.rate = p->saturation_rate.value_or(0);
  for (const YieldPoint &point : p->curve) {
    curve.strain.push_back(point.strain);
    curve.stress.push_back(point.stress);
  }
  return dem::VonMisesFlow{curve};
}

dem::Viscosity viscosity_of(const std::optional<ViscosityParameters> &p)
{
  dem::Viscosity v;
  if (!p)
    return v;
  for (const BranchParameters &b : p->branches)
    v.branches.push_back({b.share, b.relaxation_time});
  v.dashpot = p->shear_viscosity.value_or(0);
  return v;
}

dem::DemMaterial material_of(const MaterialParameters &parameters, const Scene &scene)
{
  dem::DemMaterial m;
  m.youngs_modulus = parameters.youngs_modulus;
  m.poissons_ratio = parameters.poissons_ratio;
  m.density = parameters.density;
  m.plane = scene.plane;
  m.friction = parameters.friction;
  m.plasticity = plasticity_of(parameters.plasticity, scene.zone.spacing);
  m.viscosity = viscosity_of(parameters.viscosity);
  return m;
}

dem::FractureLaw::Criterion criterion_of(const MaterialParameters &material)
{
  using Criterion = dem::FractureLaw::Criterion;
  switch (material.fracture.criterion) {
  case program::Criterion::maximum_tension:
    return Criterion::maximum_tension;
  case program::Criterion::face_tension:
    return Criterion::face_tension;
  case program::Criterion::principal_stress:
    return Criterion::principal_stress;
  case program::Criterion::von_mises:
    return Criterion::von_mises;
  case program::Criterion::drucker_prager:
    return Criterion::drucker_prager;
  case program::Criterion::mohr_coulomb:
    return Criterion::mohr_coulomb;
  case program::Criterion::energy:
    return Criterion::energy;
  case program::Criterion::none:
    break;
  }
  return Criterion::none;
}

/// Nothing for cracks along x that open along y.
template <int dim>
std::string text_of(const CrackAxes<dim> &crack)
{
  const auto components = [](const Vector<dim> &v) {
    std::vector<std::string> texts;
    for (int c = 0; c < dim; ++c)
      texts.push_back(fmt::format("{:.6g}", v[c]));
    return fmt::format("({})", fmt::join(texts, ", "));
  };
  return crack == CrackAxes<dim>() ? ""
                                   : fmt::format(" along {} across {}", components(crack.growth),
                                                 components(crack.normal));
}

/// All that the factor c depends on, in one line.
template <int dim>
std::string toughness_key(const Scene &scene, program::Criterion criterion,
                          const dem::DemMaterial &material)
{
  const DiscreteZone &zone = scene.zone;
  const std::string packing =
      zone.packing == PackingKind::random
          ? fmt::format("sweeps {} ratio {}", zone.relaxation_sweeps, zone.size_ratio)
          : fmt::format("turned {}{}", fmt::join(zone.orientation, " "),
                        text_of<dim>(crack_axes<dim>(scene.specimen)));
  return fmt::format("c{} {} {}D {} {} nu {} {}", dem::toughness_method, word_of(criterion),
                     scene.dimension, scene.plane == PlaneMode::stress ? "stress" : "strain",
                     word_of(*zone.packing), material.poissons_ratio, packing);
}

template <int dim>
double toughness_factor(const Scene &scene, const MaterialParameters &parameters)
{
  const auto criterion = criterion_of(parameters);
  // The sample is elastic and has units of its own.
  dem::DemMaterial material = material_of(parameters, scene);
  material.plasticity = {};
  material.viscosity = {};
  material.friction = 0;
  const std::string key = toughness_key<dim>(scene, parameters.fracture.criterion, material);
  return ToughnessCache().factor(key, [&] {
    if (scene.zone.packing == PackingKind::random) {
      auto packing = random_packing_of<dim>(scene);
      packing.periodic = {}; // of a sample
      return dem::calibrate_toughness<dim>(packing, material, criterion);
    }
    const auto lattice = lattice_of<dim>(scene);
    const auto crack = crack_axes<dim>(scene.specimen);
    return dem::calibrate_toughness<dim>(lattice.kind, lattice.orientation, material, criterion,
                                         {crack.growth, crack.normal});
  });
}

/// Strength from the scene, or from the toughness through the calibrated factor c. `name` is added
/// to the names of the figures.
template <int dim>
double strength_of(const Scene &scene, const MaterialParameters &material, const std::string &name,
                   std::map<std::string, Figure> &figures, core::Log &log)
{
  const auto &p = material.fracture;
  double strength = p.strength.value_or(0);
  if (!p.strength) {
    const auto known = figures.find("toughness_factor" + name);
    const double c =
        known != figures.end() ? known->second.value : toughness_factor<dim>(scene, material);
    strength = c * *p.toughness / std::sqrt(scene.zone.spacing);
    figures["toughness_factor" + name] = {c, ""};
    const bool is_lattice = scene.zone.packing != PackingKind::random;
    log.info("toughness factor c = {:.4f}{}: strength {:.4g} Pa at spacing {:.4g} m", c,
             is_lattice ? text_of<dim>(crack_axes<dim>(scene.specimen)) : "", strength,
             scene.zone.spacing);
  }
  figures["strength" + name] = {strength, "Pa"};
  return strength;
}

/// With what the criterion reads besides the strength; of Coulomb's planes the uniaxial tension
/// that comes first, on a plane of slip or by the cut-off.
template <int dim>
dem::FaceStrength face_strength_of(const Scene &scene, const MaterialParameters &material,
                                   const std::string &name, std::map<std::string, Figure> &figures,
                                   core::Log &log)
{
  const FractureParameters &p = material.fracture;
  dem::FaceStrength strength = strength_of<dim>(scene, material, name, figures, log);
  if (p.criterion == program::Criterion::drucker_prager)
    strength.compressive = *p.compressive_strength / strength.value;
  if (p.criterion == program::Criterion::mohr_coulomb) {
    const double cut_off = strength.value, cohesion = p.plane_cohesion();
    strength.friction_angle = *p.friction_angle;
    strength.value = std::min(cut_off, 2 * cohesion * std::cos(strength.friction_angle) /
                                           (1 + std::sin(strength.friction_angle)));
    strength.cohesion = cohesion / strength.value;
    strength.cut_off = cut_off / strength.value;
    figures["strength" + name] = {strength.value, "Pa"};
  }
  if (p.weibull)
    strength.scatter = {p.weibull->modulus, p.weibull->reference_area.value_or(0), p.weibull->seed};
  return strength;
}

template <int dim>
dem::FractureLaw fracture_of(const Scene &scene, std::map<std::string, Figure> &figures,
                             core::Log &log)
{
  dem::FractureLaw law;
  std::vector<const MaterialParameters *> materials = {&scene.material};
  for (const Inclusion &inclusion : scene.inclusions)
    materials.push_back(&inclusion.material);
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const std::string name = m == 0 ? "" : fmt::format("_inclusion_{}", m);
    law.criteria.push_back(criterion_of(*materials[m]));
    law.energies.push_back(fracture_energy(scene, *materials[m]).value_or(0));
    if (law.criteria[m] == dem::FractureLaw::Criterion::none)
      law.energies[m] = 0;
    if (law.energies[m] > 0) {
      law.criteria[m] = dem::FractureLaw::Criterion::opening_tension;
      figures["fracture_energy" + name] = {law.energies[m], "J/m^2"};
    }
    law.softenings.push_back(materials[m]->fracture.softening == SofteningCurve::bilinear
                                 ? dem::Softening{1 / 3., 0.8}
                                 : dem::Softening{});
    law.mode_ratios.push_back(materials[m]->fracture.mode_ratio);
    law.strengths.push_back(law.criteria[m] == dem::FractureLaw::Criterion::none
                                ? dem::FaceStrength()
                                : face_strength_of<dim>(scene, *materials[m], name, figures, log));
  }
  for (const MaterialParameters *m : materials) {
    const bool breaks = m->fracture.criterion != program::Criterion::none;
    law.crack_velocities.push_back(breaks ? m->fracture.crack_velocity.value_or(0) : 0);
    const auto &r = m->fracture.rebonding;
    law.rebonding.push_back(r ? dem::Rebonding{r->pressure, r->plastic_strain, r->strength}
                              : dem::Rebonding());
  }
  if (!scene.rebonds())
    law.rebonding.clear();
  law.criterion = law.criteria[0];
  law.strength = law.strengths[0];
  // What a toughness was calibrated with, and no given strength.
  const double whole_face = dem::PrincipalTension<dim>::whole_face(scene.zone.spacing) *
                            (dim == 2 ? scene.specimen.thickness : 1);
  for (std::size_t m = 0; m < materials.size(); ++m)
    law.whole_faces.push_back(law.criteria[m] != dem::FractureLaw::Criterion::none &&
                                      !materials[m]->fracture.strength
                                  ? whole_face
                                  : 0);
  law.whole_face = law.whole_faces[0];
  law.energy = law.energies[0];
  law.softening = law.softenings[0];
  law.mode_ratio = law.mode_ratios[0];
  if (materials.size() == 1) {
    law.whole_faces.clear();
    law.softenings.clear();
    law.mode_ratios.clear();
    law.energies.clear();
    law.criteria.clear();
    law.strengths.clear();
  }
  return law;
}
} // namespace

template <int dim>
int ghost_rings(const Scene &scene)
{
  dem::FractureLaw law;
  law.criteria.push_back(criterion_of(scene.material));
  for (const Inclusion &inclusion : scene.inclusions)
    law.criteria.push_back(criterion_of(inclusion.material));
  return dem::ManyBodyForce<dim>::n_rings(law);
}

template <int dim>
particles::ElasticConstants<dim> elastic_constants_of(const Scene &scene)
{
  if (scene.atoms)
    return crystal_of<dim>(scene).elastic_constants();
  return elastic_constants_of<dim>(scene, scene.material);
}

template <int dim>
particles::ElasticConstants<dim> elastic_constants_of(const Scene &scene,
                                                      const MaterialParameters &material)
{
  return material_of(material, scene).elastic_constants<dim>();
}

template <int dim>
std::unique_ptr<particles::ParticleForce<dim>>
make_many_body_force(const Scene &scene, packings::Packing<dim> packing,
                     const std::vector<core::BoundaryLoad<dim>> &loads,
                     std::map<std::string, Figure> &figures, core::Log &log)
{
  std::vector<dem::DemMaterial> materials = {material_of(scene.material, scene)};
  for (const Inclusion &inclusion : scene.inclusions)
    materials.push_back(material_of(inclusion.material, scene));
  const dem::Materials of_particles(std::move(materials), packing.material);
  // What breaks goes by stresses at the surface, which straight levers falsify; what is viscous
  // alone has a stiffness left that bounds it.
  if (scene.flows() && !may_break(scene) && !packing.directions.empty()) {
    const auto zone = zone_shape<dim>(scene);
    const double reach = reach_of_overlap(scene); // which stays elastic, and has a patch test
    packings::straighten_levers(
        packing, [&](const Vector<dim> &x) { return reach == 0 || zone.distance(x) > reach; });
  }
  return std::make_unique<dem::ManyBodyForce<dim>>(std::move(packing), of_particles, loads,
                                                   fracture_of<dim>(scene, figures, log));
}

template <int dim>
std::unique_ptr<particles::ParticleForce<dim>>
make_zone_force(const Scene &scene, packings::Packing<dim> packing,
                const std::vector<core::BoundaryLoad<dim>> &loads,
                std::map<std::string, Figure> &figures, core::Log &log)
{
  const ForceMaker<dim> make = scene.atoms ? make_atom_force<dim> : make_many_body_force<dim>;
  return make(scene, std::move(packing), loads, figures, log);
}

template int ghost_rings<2>(const Scene &);
template int ghost_rings<3>(const Scene &);
template particles::ElasticConstants<2> elastic_constants_of(const Scene &);
template particles::ElasticConstants<3> elastic_constants_of(const Scene &);
template particles::ElasticConstants<2> elastic_constants_of(const Scene &,
                                                             const MaterialParameters &);
template particles::ElasticConstants<3> elastic_constants_of(const Scene &,
                                                             const MaterialParameters &);
template std::unique_ptr<particles::ParticleForce<2>>
make_zone_force(const Scene &, packings::Packing<2>, const std::vector<core::BoundaryLoad<2>> &,
                std::map<std::string, Figure> &, core::Log &);
template std::unique_ptr<particles::ParticleForce<3>>
make_zone_force(const Scene &, packings::Packing<3>, const std::vector<core::BoundaryLoad<3>> &,
                std::map<std::string, Figure> &, core::Log &);
template std::unique_ptr<particles::ParticleForce<2>>
make_many_body_force(const Scene &, packings::Packing<2>,
                     const std::vector<core::BoundaryLoad<2>> &, std::map<std::string, Figure> &,
                     core::Log &);
template std::unique_ptr<particles::ParticleForce<3>>
make_many_body_force(const Scene &, packings::Packing<3>,
                     const std::vector<core::BoundaryLoad<3>> &, std::map<std::string, Figure> &,
                     core::Log &);
} // namespace ligament::program
