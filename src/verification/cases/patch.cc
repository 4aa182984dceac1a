// Uniform strain through the overlap: residual of the set-up, and a static solve of the whole body.
#include "src/verification/bodies/box_zones.h"
#include "src/verification/bodies/grading.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/linear_motion.h"

#include <Eigen/LU>

namespace ligament::program
{
namespace
{
constexpr double size_of_strain = 1e-14; // its square is below round-off

/// Worst figures over a set of bodies.
struct Deviation
{
  double residual = 0; // over C11 h^(dim-1)
  double strain = 0;   // over the applied strain
};

template <int dim>
Eigen::Matrix<double, dim, dim> tensor(const Strain<dim> &e)
{
  Eigen::Matrix<double, dim, dim> m;
  if constexpr (dim == 2)
    m << e[0], e[2] / 2, e[2] / 2, e[1];
  else
    m << e[0], e[5] / 2, e[4] / 2, e[5] / 2, e[1], e[3] / 2, e[4] / 2, e[3] / 2, e[2];
  return m;
}

/// Loads `sides` by the stress (in E, in which strains are near 1) and compares with uniform
/// strain.
template <int dim>
void load(Scene scene, const std::vector<int> &sides, Strain<dim> stress, Deviation &worst)
{
  stress *= size_of_strain;
  add_tractions<dim>(scene, sides, stress);
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  if (body.coupler->overlap())
    keep_largest(worst.residual, body.figures.at("patch_residual").value);
  LinearMotion<dim> motion(body);
  const Strain<dim> strain = body.far->body().stiffness.inverse() * stress;
  const auto gradient = tensor<dim>(strain);
  const Eigen::VectorXd error = motion.solve() - motion.affine(gradient);
  keep_largest(worst.strain, motion.largest_strain(error) / gradient.norm());
}

std::vector<Result> report(const std::string &name, const Deviation &worst)
{
  return {{name + "/residual", worst.residual, 1e-12, 1e-14},
          {name + "/strain", worst.strain, 1e-12, 1e-14}};
}

/// The arrangement of the particles: a lattice turned by an angle (2D), or a random packing; and of
/// the cells.
struct Arrangement
{
  double angle = 0;
  double random_ratio = 0; // size ratio of a random packing; 0: the lattice
  Grading grading = {};

  void apply(Scene &scene) const
  {
    grading.apply(scene);
    if (grading.levels > 0)
      scene.coupling.overlap_cells = 4;
    scene.zone.orientation[0] = angle;
    if (random_ratio > 0) {
      scene.zone.packing = PackingKind::random;
      scene.zone.size_ratio = random_ratio;
    }
  }
};

/// Band across the specimen, overlap ends at free edges; uniaxial stress along it.
std::vector<Result> band_2d(const std::string &name, double cell_size, const Arrangement &packing)
{
  Deviation worst;
  for (const double nu : {0., 0.22, 0.45})
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
      Scene scene = unit_scene(2, {25, 94, 0}, nu);
      scene.plane = plane;
      add_far_field(scene, {0, 34, 0}, cell_size);
      packing.apply(scene);
      scene.coupling.transition_cells = 2;
      load<2>(scene, {2, 3}, {0, 1, 0}, worst);
    }
  return report(name, worst);
}

/// Zone inside the specimen, closed overlap with corners; a stress with all components.
std::vector<Result> ring_2d(const std::string &name, double cell_size, const Arrangement &packing)
{
  Deviation worst;
  for (const double nu : {0., 0.22, 0.45})
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
      Scene scene = unit_scene(2, {79, 81, 0}, nu);
      scene.plane = plane;
      add_far_field(scene, {35, 33, 0}, cell_size);
      packing.apply(scene);
      scene.coupling.transition_cells = 2;
      load<2>(scene, {0, 1, 2, 3}, {0.8, -0.5, 0.4}, worst);
    }
  return report(name, worst);
}

/// Zone of several boxes in a closed overlap; a stress with all components.
std::vector<Result> boxes_2d(const std::string &name, Scene (*body)(double poissons_ratio),
                             const Arrangement &packing)
{
  Deviation worst;
  for (const double nu : {0., 0.3, 0.45}) {
    Scene scene = body(nu);
    packing.apply(scene);
    load<2>(scene, {0, 1, 2, 3}, {0.8, -0.5, 0.4}, worst);
  }
  return report(name, worst);
}

std::vector<Result> boxes_3d(const std::string &name, const Point &size,
                             const std::vector<ZoneBox> &boxes, const Arrangement &packing,
                             double cell_size = 3.07)
{
  Deviation worst;
  Scene scene = unit_scene(3, size, 0.3);
  add_far_field(scene, {23, 22, 24}, cell_size);
  set_boxes(scene, boxes);
  packing.apply(scene);
  scene.coupling.overlap_cells = 2;
  scene.coupling.transition_cells = 1;
  load<3>(scene, {0, 1, 2, 3, 4, 5}, {0.8, -0.5, 0.6, 0.3, -0.2, 0.4}, worst);
  return report(name, worst);
}

/// Bands through joined sides: what the fit leaves.
std::vector<Result> joined_sides()
{
  const std::string name = "patch_joined_sides";
  std::vector<Result> results;
  const auto add = [&](const std::string &packing, double residual) {
    results.push_back({name + "/" + packing, residual, 1e-12, 1e-14});
  };
  for (const bool random : {false, true}) {
    double worst = 0;
    for (const double nu : {0., 0.3, 0.45}) {
      Scene scene = unit_scene(2, {24, 94, 0}, nu);
      scene.specimen.periodic.push_back({Axis::x});
      add_far_field(scene, {0, 34, 0}, 4);
      scene.coupling.transition_cells = 2;
      if (random)
        scene.zone.packing = PackingKind::random;
      keep_largest(worst, UnitBody<2>(scene).body.figures.at("patch_residual").value);
    }
    add(random ? "random" : "hexagonal", worst);
  }
  Scene scene = unit_scene(3, {9, 9, 56}, 0.3);
  scene.specimen.periodic = {{Axis::x}, {Axis::y}};
  add_far_field(scene, {0, 0, 25}, 3);
  scene.coupling.transition_cells = 2;
  add("fcc", UnitBody<3>(scene).body.figures.at("patch_residual").value);
  return results;
}

std::vector<Result> band_3d(const std::string &name, double cell_size, const Arrangement &packing)
{
  Deviation worst;
  for (const double nu : {0., 0.3}) {
    Scene scene = unit_scene(3, {9.3, 8.7, packing.grading.levels > 0 ? 72. : 56.}, nu);
    add_far_field(scene, {0, 0, 25}, cell_size);
    packing.apply(scene);
    scene.coupling.transition_cells = 2;
    load<3>(scene, {4, 5}, {0, 0, 1, 0, 0, 0}, worst);
  }
  return report(name, worst);
}

std::vector<Result> ring_3d(const std::string &name, double cell_size, const Arrangement &packing)
{
  Deviation worst;
  for (const double nu : {0., 0.3}) {
    const double more = packing.grading.levels > 0 ? 6 : 0; // for a fourth cell in the overlap
    Scene scene = unit_scene(3, {45 + more, 44 + more, 46 + more}, nu);
    add_far_field(scene, {23 + more, 22 + more, 24 + more}, cell_size);
    packing.apply(scene);
    scene.coupling.transition_cells = 1;
    load<3>(scene, {0, 1, 2, 3, 4, 5}, {0.8, -0.5, 0.6, 0.3, -0.2, 0.4}, worst);
  }
  return report(name, worst);
}
} // namespace

std::vector<Case> patch_cases()
{
  constexpr double turned = 15 * M_PI / 180;
  const Arrangement equal{0, 1}, unequal{0, 3};
  const Arrangement hanging{0, 0, hanging_cells}, growing{0, 0, growing_cells};
  const Arrangement random_hanging{0, 1, hanging_cells}, random_growing{0, 1, growing_cells};
  const std::string band = "overlap that ends at free edges", ring = "closed overlap with corners";
  return {{"patch_band_2d", band + ", hexagonal, h/d 4.1", false,
           [] { return band_2d("patch_band_2d", 4.1, {}); }},
          {"patch_band_2d_turned", band + ", hexagonal turned by 15 degrees, h/d 3.07", false,
           [] { return band_2d("patch_band_2d_turned", 3.07, {turned}); }},
          {"patch_ring_2d", ring + ", hexagonal, h/d 4.1", false,
           [] { return ring_2d("patch_ring_2d", 4.1, {}); }},
          {"patch_ring_2d_turned", ring + ", hexagonal turned by 15 degrees, h/d 3.07", false,
           [] { return ring_2d("patch_ring_2d_turned", 3.07, {turned}); }},
          {"patch_band_2d_random", band + ", random, h/d 4.1", false,
           [=] { return band_2d("patch_band_2d_random", 4.1, equal); }},
          {"patch_band_2d_ratio_3", band + ", random, radii 1 to 3, h/d 4.1", false,
           [=] { return band_2d("patch_band_2d_ratio_3", 4.1, unequal); }},
          {"patch_ring_2d_random", ring + ", random, h/d 3.07", false,
           [=] { return ring_2d("patch_ring_2d_random", 3.07, equal); }},
          {"patch_band_2d_hanging", band + " and doubles its cells, hexagonal, h/d 3.07", false,
           [=] { return band_2d("patch_band_2d_hanging", 3.07, hanging); }},
          {"patch_band_2d_growing", band + ", growing cells, hexagonal, h/d 3.07", false,
           [=] { return band_2d("patch_band_2d_growing", 3.07, growing); }},
          {"patch_ring_2d_hanging", ring + " that doubles its cells, hexagonal, h/d 3.07", false,
           [=] { return ring_2d("patch_ring_2d_hanging", 3.07, hanging); }},
          {"patch_ring_2d_growing", ring + ", growing cells, hexagonal, h/d 3.07", false,
           [=] { return ring_2d("patch_ring_2d_growing", 3.07, growing); }},
          {"patch_band_2d_random_hanging", band + " and doubles its cells, random, h/d 3.07", false,
           [=] { return band_2d("patch_band_2d_random_hanging", 3.07, random_hanging); }},
          {"patch_ring_2d_random_growing", ring + ", growing cells, random, h/d 3.07", true,
           [=] { return ring_2d("patch_ring_2d_random_growing", 3.07, random_growing); }},
          {"patch_band_3d_random_hanging", band + " and doubles its cells, random, h/d 2.6", true,
           [=] { return band_3d("patch_band_3d_random_hanging", 2.6, random_hanging); }},
          {"patch_joined_sides", "overlap through joined sides", false, joined_sides},
          {"patch_l_shape_2d", "zone of two boxes with a re-entrant corner, hexagonal", false,
           [] { return boxes_2d("patch_l_shape_2d", l_shape_2d, {}); }},
          {"patch_l_shape_2d_random", "zone of two boxes with a re-entrant corner, random", false,
           [=] { return boxes_2d("patch_l_shape_2d_random", l_shape_2d, equal); }},
          {"patch_two_zones_2d", "two zones whose transitions meet, hexagonal", false,
           [] { return boxes_2d("patch_two_zones_2d", two_zones_2d, {}); }},
          {"patch_two_zones_2d_random", "two zones whose transitions meet, random, radii 1 to 3",
           false, [=] { return boxes_2d("patch_two_zones_2d_random", two_zones_2d, unequal); }},
          {"patch_l_shape_3d", "zone of two boxes with a re-entrant edge, FCC, h/d 3.07", true,
           [] {
             return boxes_3d("patch_l_shape_3d", {49, 48, 38},
                             {{{-17, -16, -11}, {17, 6, 11}}, {{-17, -16, -11}, {5, 16, 11}}}, {});
           }},
          {"patch_l_shape_3d_random", "zone of two boxes with a re-entrant edge, random, h/d 3.2",
           true,
           [=] {
             return boxes_3d("patch_l_shape_3d_random", {49, 48, 38},
                             {{{-17, -16, -11}, {17, 6, 11}}, {{-17, -16, -11}, {5, 16, 11}}},
                             equal, 3.2); // what closes the packing needs 6.22 d
           }},
          {"patch_two_zones_3d", "two zones, FCC, h/d 3.07", true,
           [] {
             return boxes_3d("patch_two_zones_3d", {72, 37, 37},
                             {{{-28, -11, -11}, {-6, 11, 11}}, {{6, -11, -11}, {28, 11, 11}}}, {});
           }},
          {"patch_band_3d", band + ", FCC, h/d 3.1", false,
           [] { return band_3d("patch_band_3d", 3.1, {}); }},
          {"patch_band_3d_hanging", band + " and doubles its cells, FCC, h/d 2.6", true,
           [=] { return band_3d("patch_band_3d_hanging", 2.6, hanging); }},
          {"patch_ring_3d_hanging", ring + " that doubles its cells, FCC, h/d 2.6", true,
           [=] { return ring_3d("patch_ring_3d_hanging", 2.6, hanging); }},
          {"patch_band_3d_growing", band + ", growing cells, FCC, h/d 2.6", true,
           [=] { return band_3d("patch_band_3d_growing", 2.6, growing); }},
          {"patch_band_3d_random", band + ", random, h/d 3.1", false,
           [=] { return band_3d("patch_band_3d_random", 3.1, equal); }},
          {"patch_ring_3d_random", ring + ", random, h/d 3.07", true,
           [=] { return ring_3d("patch_ring_3d_random", 3.07, equal); }},
          {"patch_ring_3d", ring + ", FCC, h/d 3.07", true,
           [] { return ring_3d("patch_ring_3d", 3.07, {}); }}};
}
} // namespace ligament::program
