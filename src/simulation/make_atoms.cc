// Atoms from their scene: the crystal, cut to shape, and its force.
#include "core/counter_random.h"
#include "core/keyed_error.h"
#include "md/atom_force.h"
#include "md/crystal_packing.h"
#include "md/griffith.h"
#include "src/scene/atoms.h"
#include "src/scene/geometry.h"
#include "src/simulation/heat.h"
#include "src/simulation/make_force.h"
#include "src/simulation/make_packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
/// Where an atom lies: so that planes of low indices through the middle of the specimen pass
/// between atoms.
template <int dim>
Vector<dim> anchor_of(const Scene &scene, const md::Crystal<dim> &crystal)
{
  const double share = crystal.parameters().kind == md::CrystalKind::fcc ? 0.25 : 0.5;
  return to_vector<dim>(scene.specimen.centre) + share * crystal.basis() * Vector<dim>::Ones();
}

/// Species of all atoms, by the sites' own random numbers: a larger zone has the same ones.
template <int dim>
void substitute(const Scene &scene, packings::Packing<dim> &packing, core::Log &log)
{
  const AtomsParameters &atoms = *scene.atoms;
  if (atoms.substitutions.empty())
    return;
  const std::vector<std::string> names = species_of(scene);
  packing.material.assign(packing.size(), 0);
  for (std::size_t k = 0; k < atoms.substitutions.size(); ++k) {
    const Substitution &s = atoms.substitutions[k];
    const int species = int(std::find(names.begin(), names.end(), s.species) - names.begin());
    const bool is_everywhere = s.balls.empty() && s.boxes.empty();
    long n = 0;
    for (int i = 0; i < packing.size(); ++i) {
      const Vector<dim> x = get(packing.centre, i);
      if (core::random_number(atoms.seed, packing.global_id[i], int(k)) >= s.share ||
          !(is_everywhere || is_in_regions<dim>(scene.specimen, s.balls, s.boxes, x)))
        continue;
      packing.material[i] = species;
      ++n;
    }
    if (n == 0)
      throw core::KeyedError(fmt::format("/atoms/substitutions/{}", k),
                             fmt::format("/atoms/substitutions/{} has no atom", k),
                             "no site of the crystal lies there, or none by chance",
                             "enlarge or move its regions");
    log.info("substitution {}: {} atoms of {}", k, n, s.species);
  }
}

/// Nowhere does an atom of another species change the forces in an overlap.
template <int dim>
void require_own_overlap(const Scene &scene, const packings::Packing<dim> &packing)
{
  if (!scene.far_field || scene.zone.extent != DiscreteZone::Extent::box)
    return;
  const double keep_off =
      scene.coupling.overlap_cells * scene.far_field->cell_size + scene.atoms->disturbance;
  const auto zone = zone_shape<dim>(scene);
  for (std::size_t i = 0; i < packing.material.size(); ++i)
    core::require(packing.material[i] == 0 ||
                      zone.distance(get(packing.centre, int(i))) > keep_off * (1 - 1e-9),
                  "/atoms/substitutions: an atom of another species changes the forces in the "
                  "overlap; widen /discrete_zone or move it");
}

/// What a crack that reaches through the specimen along one joined axis, its front, would need at
/// least.
void add_griffith(const Scene &scene, const md::Crystal<3> &crystal,
                  const std::vector<packings::CrackPlane<3>> &cuts,
                  std::map<std::string, Figure> &figures)
{
  if (cuts.empty() || scene.specimen.cracks.size() != 1 || scene.is_warm())
    return;
  std::vector<Vector<3>> fronts;
  for (int c = 0; c < 3; ++c) {
    double lower = infinity, upper = -infinity;
    for (const Point &x : scene.specimen.cracks[0].points) {
      lower = std::min(lower, x[c]);
      upper = std::max(upper, x[c]);
    }
    const bool is_through = lower <= scene.specimen.lower(c) && upper >= scene.specimen.upper(c);
    if (is_through && scene.specimen.is_periodic(c) && std::abs(cuts[0].normal()[c]) < 1e-9)
      fronts.push_back(Vector<3>::Unit(c));
  }
  if (fronts.size() != 1)
    return;
  // Across the front to the last digit.
  Vector<3> normal = cuts[0].normal();
  normal -= normal.dot(fronts[0]) * fronts[0];
  if (const auto crack = md::griffith_crack(crystal, normal.normalized(), fronts[0])) {
    figures["surface_energy"] = {crack->surface_energy, "J/m^2"};
    figures["crack_modulus"] = {crack->modulus, "Pa"};
    figures["griffith_k"] = {crack->stress_intensity, "Pa*m^0.5"};
  }
}
/// Openings and cracks go on across joined sides: their images lie a period away. The scene's own
/// ones stay in front.
template <int dim>
void add_images(packings::SpecimenParameters<dim> &specimen)
{
  for (int c = 0; c < dim; ++c) {
    if (!specimen.periodic[c])
      continue;
    const Vector<dim> period = (specimen.upper[c] - specimen.lower[c]) * Vector<dim>::Unit(c);
    const auto repeat = [&](auto &things, auto &&moved) {
      const auto own = things;
      for (const double side : {-1., 1.})
        for (const auto &thing : own)
          things.push_back(moved(thing, Vector<dim>(side * period)));
    };
    repeat(specimen.holes, [](packings::DiscHole<dim> hole, const Vector<dim> &by) {
      hole.centre += by;
      return hole;
    });
    repeat(specimen.notches, [](packings::BoxNotch<dim> notch, const Vector<dim> &by) {
      notch.lower += by;
      notch.upper += by;
      return notch;
    });
    repeat(specimen.cracks, [](packings::CrackPoints<dim> crack, const Vector<dim> &by) {
      for (Vector<dim> &x : crack)
        x += by;
      return crack;
    });
  }
}
} // namespace

template <int dim>
packings::Packing<dim> make_crystal_packing(const Scene &scene, core::Log &log)
{
  const auto crystal = crystal_of<dim>(scene);
  auto specimen = packed_specimen_of<dim>(scene);
  add_images(specimen);
  const packings::SpecimenShape<dim> body(specimen);
  md::CrystalShape<dim> shape;
  shape.specimen_lower = specimen.lower;
  shape.specimen_upper = specimen.upper;
  shape.lower = specimen.lower.cwiseMax(specimen.zone_lower);
  shape.upper = specimen.upper.cwiseMin(specimen.zone_upper);
  shape.anchor = anchor_of<dim>(scene, crystal);
  // A zone that keeps off joined sides has a mesh there, and ends like any other.
  for (int c = 0; c < dim; ++c)
    shape.periodic[c] = specimen.periodic[c] && shape.lower[c] <= specimen.lower[c] &&
                        shape.upper[c] >= specimen.upper[c];
  const auto &parts = specimen.zone_parts;
  shape.keep = [&](const Vector<dim> &x) {
    return body.distance(x) > -1e-9 * crystal.spacing() &&
           (parts.boxes.empty() || parts.distance(x) > 0);
  };
  for (int c = 0; c < dim; ++c)
    if (specimen.periodic[c]) {
      const double size = specimen.upper[c] - specimen.lower[c];
      log.info("along {} the specimen's size is now {:.6g} m ({} periods of the crystal)", "xyz"[c],
               size, std::lround(size / period_along<dim>(crystal, c, 1.5 * size)));
    }
  packings::Packing<dim> packing = md::cut_crystal<dim>(crystal, shape);
  packing.cuts = body.cracks;
  substitute<dim>(scene, packing, log);
  require_own_overlap<dim>(scene, packing);
  return packing;
}

template <int dim>
std::unique_ptr<particles::ParticleForce<dim>>
make_atom_force(const Scene &scene, packings::Packing<dim> packing,
                const std::vector<core::BoundaryLoad<dim>> &loads,
                std::map<std::string, Figure> &figures, core::Log &log)
{
  const auto crystal = crystal_of<dim>(scene);
  const auto c = crystal.elastic_constants().stiffness;
  figures["spacing"] = {crystal.spacing(), "m"};
  figures["lattice_parameter"] = {crystal.lattice_parameter(), "m"};
  figures["C11"] = {c(0, 0), "Pa"};
  figures["C12"] = {c(0, 1), "Pa"};
  figures[dim == 2 ? "C33" : "C44"] = {c(dim, dim), "Pa"};
  if constexpr (dim == 3)
    add_griffith(scene, crystal, packing.cuts, figures);
  log.info("crystal: spacing {:.6g} m, range {:.4g} m, cohesive energy {:.4g} J, C11, C12, {} = "
           "{:.4g}, {:.4g}, {:.4g} Pa along x, y",
           crystal.spacing(), crystal.potential().cutoff(), crystal.cohesive_energy(),
           dim == 2 ? "C33" : "C44", c(0, 0), c(0, 1), c(dim, dim));
  md::AtomForceOptions options;
  options.species = packing.material;
  options.is_warm = scene.is_warm();
  return std::make_unique<md::AtomForce<dim>>(crystal, packing, options, loads);
}

template <int dim>
Stiffness<dim> thermal_stiffness(const Scene &scene, Reference &reference, core::Log &log)
{
  std::optional<md::CubicConstants> found;
  const auto value = [&](const char *name, double md::CubicConstants::*member) {
    return reference.value(name, [&] {
      if (!found)
        found = thermal_constants_of<dim>(scene);
      return (*found).*member;
    });
  };
  md::CubicConstants c;
  c.c11 = value("thermal_c11", &md::CubicConstants::c11);
  c.c12 = value("thermal_c12", &md::CubicConstants::c12);
  c.c44 = value("thermal_c44", &md::CubicConstants::c44);
  c.error = value("thermal_c_error", &md::CubicConstants::error);
  const auto crystal = crystal_of<dim>(scene);
  log.info("crystal at {} K: lattice parameter {:.6g} m, C11, C12, C44 of its cube {:.4g}, {:.4g}, "
           "{:.4g} Pa (+- {:.1g}); the overlap turns with the body from the start",
           scene.atoms->temperature, crystal.lattice_parameter(), c.c11, c.c12, c.c44, c.error);
  return md::stiffness_of<dim>(c, crystal.parameters().orientation);
}

template Stiffness<2> thermal_stiffness<2>(const Scene &, Reference &, core::Log &);
template Stiffness<3> thermal_stiffness<3>(const Scene &, Reference &, core::Log &);
template packings::Packing<2> make_crystal_packing(const Scene &, core::Log &);
template packings::Packing<3> make_crystal_packing(const Scene &, core::Log &);
template std::unique_ptr<particles::ParticleForce<2>>
make_atom_force(const Scene &, packings::Packing<2>, const std::vector<core::BoundaryLoad<2>> &,
                std::map<std::string, Figure> &, core::Log &);
template std::unique_ptr<particles::ParticleForce<3>>
make_atom_force(const Scene &, packings::Packing<3>, const std::vector<core::BoundaryLoad<3>> &,
                std::map<std::string, Figure> &, core::Log &);
} // namespace ligament::program
