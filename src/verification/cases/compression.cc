// Uniaxial compression without a crack: no tension anywhere, and nothing breaks, at the coupled
// edge of the packing either.
#include "core/extremes.h"
#include "dem/many_body_force.h"
#include "src/simulation/damping.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"

#include <cmath>

namespace ligament::program
{
namespace
{
/// Particles, and what they are made of.
struct Material
{
  std::string packing;
  double angle = 0;      // rad, of lattices; 3D: about (1, 2, 3)
  double size_ratio = 1; // of random packings
  double poissons_ratio = 0;
  PlaneMode plane = PlaneMode::strain;

  void apply(Scene &scene) const
  {
    scene.zone.packing = named<PackingKind>(packing);
    scene.zone.size_ratio = size_ratio;
    scene.zone.orientation[0] = angle;
    if (scene.dimension == 3)
      for (int c = 0; c < 3; ++c)
        scene.zone.orientation[c] = angle * (c + 1) / std::sqrt(14.);
    scene.material.poissons_ratio = poissons_ratio;
    scene.plane = plane;
  }
};

constexpr double degree = M_PI / 180;
const std::vector<Material> packings_2d = {{"hexagonal"}, {"hexagonal", 11 * degree},
                                           {"square"},    {"square", 45 * degree},
                                           {"random"},    {"random", 0, 3}};
const std::vector<Material> packings_3d = {
    {"fcc"}, {"fcc", 20 * degree}, {"simple_cubic"}, {"simple_cubic", 20 * degree}, {"random"}};

template <int dim>
using Tensor = Eigen::Matrix<double, dim, dim>;

/// Strain of the stress 1 along the last axis.
template <int dim>
Tensor<dim> uniaxial_strain(const Stiffness<dim> &stiffness)
{
  const Strain<dim> strain = stiffness.inverse() * Strain<dim>::Unit(dim - 1);
  return strain.template head<dim>().asDiagonal();
}

struct Excess
{
  double tension = 0; // on a face
  double stress = 0;  // averaged tensor of a particle less that of the state
};

/// Imposes uniaxial compression on everything that moves; figures over its stress.
template <int dim>
void impose(Scene scene, const Material &material, Excess &worst)
{
  constexpr double size = 1e-8; // of the strain
  material.apply(scene);
  scene.coupling.patch_fit = false; // nothing is solved
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  const Tensor<dim> strain =
      -size * uniaxial_strain<dim>(body.force()->elastic_constants().stiffness);
  auto &state = body.zone->state;
  std::vector<int> all;
  for (int i = 0; i < state.size(); ++i) {
    set(state.displacement, i, Vector<dim>(strain * get(state.reference, i)));
    all.push_back(i);
  }
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    set(body.far->displacement, i, Vector<dim>(strain * body.far->mesh().nodes[i]));
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies); // takes over the near nodes' displacements as well
  const auto &force = dynamic_cast<const dem::ManyBodyForce<dim> &>(*body.force());
  keep_largest(worst.tension, force.max_tension(state, all) / size);
  Components<n_strains<dim>> stress;
  force.stresses(state, stress);
  for (int i = 0; i < state.size(); ++i) {
    const Strain<dim> rest = get(stress, i) + size * Strain<dim>::Unit(dim - 1);
    keep_largest(worst.stress, rest.cwiseAbs().maxCoeff() / size);
  }
}

/// A band that ends at free sides, and a zone with corners inside the specimen.
std::vector<Result> imposed_2d()
{
  Excess worst;
  for (Material material : packings_2d)
    for (const double nu : {0., 0.25, 0.45}) {
      material.poissons_ratio = nu;
      material.plane = nu == 0.25 ? PlaneMode::stress : PlaneMode::strain;
      Scene band = unit_scene(2, {25, 94, 0}, nu), ring = unit_scene(2, {79, 81, 0}, nu);
      add_far_field(band, {0, 34, 0}, 3.07);
      add_far_field(ring, {35, 33, 0}, 3.07);
      for (Scene *scene : {&band, &ring}) {
        scene->coupling.transition_cells = 2;
        impose<2>(*scene, material, worst);
      }
    }
  return {{"compression_imposed_2d/tension", worst.tension, 1e-6, {}},
          {"compression_imposed_2d/stress", worst.stress, 1e-6, {}}};
}

std::vector<Result> imposed_3d(const std::string &name, const std::vector<Material> &packings,
                               const Point &size, const Point &zone)
{
  Excess worst;
  for (Material material : packings) {
    const double nu = material.poissons_ratio = 0.45;
    Scene scene = unit_scene(3, size, nu);
    add_far_field(scene, zone, 3.6);
    scene.coupling.overlap_cells = 2;
    scene.coupling.transition_cells = 1;
    impose<3>(scene, material, worst);
  }
  return {{name + "/tension", worst.tension, 1e-6, {}}, {name + "/stress", worst.stress, 1e-6, {}}};
}

struct Run
{
  double broken_faces = 0, stress = infinity; // Pa: mean over the particles, of all runs the least
};

/// Presses both ends together until the stress is 40 MPa, in a body of 3 MPa strength.
template <int dim>
void press(const Point &size, double zone_half, int overlap_cells, const Material &material,
           Run &worst)
{
  constexpr double target = 40e6, speed = 0.02; // Pa, m/s of each end
  constexpr double mm = 1e-3;
  Scene scene = unit_scene(dim, size, 0);
  scene.material.youngs_modulus = 40e9;
  scene.material.density = 2600;
  scene.material.fracture.criterion = Criterion::maximum_tension;
  scene.material.fracture.strength = 3e6;
  scene.zone.spacing = 1 * mm;
  scene.damping.mass = 1e4;
  Point zone = {};
  zone[dim - 1] = 2 * zone_half;
  add_far_field(scene, zone, 3 * mm);
  scene.coupling.overlap_cells = overlap_cells;
  scene.coupling.fine_damper = 8;
  scene.coupling.gap_filter = 4;
  for (const bool upper : {false, true}) {
    LoadParameters load;
    load.boundary = 2 * (dim - 1) + upper;
    load.kind = LoadKind::velocity;
    load.value[dim - 1] = upper ? -speed : speed;
    load.velocity = load.value;
    scene.loads.push_back(load);
  }
  material.apply(scene);
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  const double modulus =
      1 / uniaxial_strain<dim>(body.force()->elastic_constants().stiffness)(dim - 1, dim - 1);
  const double duration = 1.02 * target / modulus * size[dim - 1] / (2 * speed);
  BodyDamping<dim> damping(scene.damping);
  auto bodies = body.bodies();
  coupling::StepTime step;
  step.dt = body.dt;
  for (; step.time < duration; ++step.step, step.time += step.dt) {
    body.coupler->compute_forces(bodies, step);
    damping.before_kick(body, step);
    body.coupler->kick(bodies, step);
    damping.after_kick(body, step);
    body.coupler->drift(bodies, step);
  }
  worst.broken_faces += double(body.force()->broken_bonds().size());
  Components<n_strains<dim>> stress;
  body.force()->stresses(body.zone->state, stress);
  double mean = 0;
  for (const double s : stress[dim - 1])
    mean -= s / double(stress[dim - 1].size());
  keep_smallest(worst.stress, mean);
}

std::vector<Result> report(const std::string &name, const Run &worst)
{
  return {{name + "/broken_faces", worst.broken_faces, 0, {}},
          {name + "/stress", worst.stress / 40e6, 0.98, {}, Result::Bound::at_least}};
}

/// The scenes of this many first packings, 30 x 120 mm.
std::vector<Result> run_2d(const std::string &name, const std::vector<Material> &materials)
{
  Run worst;
  for (const Material &material : materials)
    press<2>({0.03, 0.12, 0}, 0.022, 3, material, worst);
  return report(name, worst);
}

std::vector<Result> run_all_2d()
{
  std::vector<Material> materials;
  for (Material material : packings_2d)
    for (const double nu : {0., 0.25, 0.45})
      for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
        material.poissons_ratio = nu;
        material.plane = plane;
        materials.push_back(material);
      }
  return run_2d("compression_runs_2d", materials);
}

std::vector<Result> run_all_3d()
{
  Run worst;
  for (Material material : packings_3d)
    for (const double nu : {0., 0.3, 0.45}) {
      material.poissons_ratio = nu;
      press<3>({0.01, 0.01, 0.1}, 0.02, 3, material, worst);
    }
  return report("compression_runs_3d", worst);
}
} // namespace

std::vector<Case> compression_cases()
{
  const std::string imposed = "uniaxial compression imposed on band and closed zone, ",
                    runs = "30 x 120 mm pressed to 40 MPa at 3 MPa strength, ",
                    all = "all packings, nu 0 to 0.45";
  return {
      {"compression_imposed_2d", imposed + all, false, imposed_2d},
      {"compression_imposed_band_3d",
       "uniaxial compression imposed on a 3D band, FCC and random, nu 0.45", false,
       [] {
         return imposed_3d("compression_imposed_band_3d", {{"fcc", 20 * degree}, {"random"}},
                           {9.3, 8.7, 55}, {0, 0, 24});
       }},
      {"compression_imposed_ring_3d",
       "uniaxial compression imposed on a closed 3D zone, all packings, nu 0.45", true,
       [] {
         return imposed_3d("compression_imposed_ring_3d", packings_3d, {52, 51, 53}, {24, 23, 25});
       }},
      {"compression_run_random", runs + "random, nu 0.45", false,
       [] {
         return run_2d("compression_run_random", {{"random", 0, 1, 0.45}});
       }},
      {"compression_runs_2d", runs + all, true, run_all_2d},
      {"compression_runs_3d", "bar of 10 x 10 x 100 mm pressed likewise, " + all, true,
       run_all_3d}};
}
} // namespace ligament::program
