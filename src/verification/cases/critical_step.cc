// The stable step of the coupled body against that of the plain discrete model.
#include "core/extremes.h"
#include "src/verification/bodies/box_zones.h"
#include "src/verification/bodies/grading.h"
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/linear_motion.h"

namespace ligament::program
{
namespace
{
/// Worst figures over a set of bodies.
struct Measured
{
  double ratio = 1e300; // critical step, coupled / plain discrete
  double margin =
      1e300;            // critical step of the coupled body / the step that the set-up calls stable
  double asymmetry = 0; // of the step operator
};

template <int dim>
void measure(const Scene &coupled, Measured &worst)
{
  Scene plain = coupled;
  plain.zone.extent = DiscreteZone::Extent::all;
  plain.far_field.reset();
  UnitBody<dim> plain_body(plain), coupled_body(coupled);
  LinearMotion<dim> plain_motion(plain_body.body), motion(coupled_body.body);
  const double frequency = motion.largest_frequency();
  keep_smallest(worst.ratio, plain_motion.largest_frequency() / frequency);
  keep_smallest(worst.margin, 2 / frequency / coupled_body.body.dt_zone);

  const Eigen::VectorXd x = 1e-14 * motion.noise();
  const Eigen::VectorXd y = motion.accelerations(x, false);
  const Eigen::VectorXd z = motion.accelerations(y, false);
  // (y, A y) = (A x, A A x) and (x, A A y): A moved from one side to the other twice.
  const double left = motion.inner(y, z), right = motion.inner(x, motion.accelerations(z, false));
  keep_largest(worst.asymmetry, std::abs(left / right - 1));
}

void report(const std::string &name, const Measured &worst, std::vector<Result> &results)
{
  results.push_back({name + "/ratio", worst.ratio, 0.99, 1, Result::Bound::at_least});
  results.push_back({name + "/margin", worst.margin, 1, {}, Result::Bound::at_least});
  results.push_back({name + "/asymmetry", worst.asymmetry, 1e-12, {}});
}

std::vector<Result> critical_step()
{
  std::vector<Result> results;
  Measured two, three;
  for (const double nu : {0., 0.22, 0.45}) {
    Scene band = unit_scene(2, {25, 94, 0}, nu);
    add_far_field(band, {0, 34, 0}, 4.1);
    band.coupling.transition_cells = 3;
    measure<2>(band, two);
    Scene ring = unit_scene(2, {79, 81, 0}, nu);
    ring.zone.orientation[0] = 15 * M_PI / 180;
    add_far_field(ring, {35, 33, 0}, 3.07);
    ring.coupling.transition_cells = 3;
    measure<2>(ring, two);
  }
  report("critical_step/hexagonal", two, results);
  Scene band = unit_scene(3, {9.3, 8.7, 56}, 0.3);
  add_far_field(band, {0, 0, 25}, 3.1);
  band.coupling.transition_cells = 2;
  measure<3>(band, three);
  report("critical_step/fcc", three, results);
  return results;
}

std::vector<Result> random_packings()
{
  std::vector<Result> results;
  Measured equal, unequal, three;
  for (const double nu : {0., 0.22, 0.45}) {
    Scene band = unit_scene(2, {25, 94, 0}, nu);
    band.zone.packing = PackingKind::random;
    add_far_field(band, {0, 34, 0}, 4.1);
    band.coupling.transition_cells = 3;
    measure<2>(band, equal);
    band.zone.size_ratio = 3;
    measure<2>(band, unequal);
  }
  report("critical_step_random/equal_2d", equal, results);
  report("critical_step_random/ratio_3_2d", unequal, results);
  Scene band = unit_scene(3, {9.3, 8.7, 56}, 0.3);
  band.zone.packing = PackingKind::random;
  add_far_field(band, {0, 0, 25}, 3.1);
  band.coupling.transition_cells = 2;
  measure<3>(band, three);
  report("critical_step_random/equal_3d", three, results);
  return results;
}
std::vector<Result> graded_meshes()
{
  std::vector<Result> results;
  for (const bool grows : {false, true}) {
    Measured two, three;
    const Grading grading = grows ? growing_cells : hanging_cells;
    for (const double h : {2.6, 4.1})
      for (const int fine_cells : {1, 5}) {
        Scene band = unit_scene(2, {25, 124, 0}, 0.3);
        add_far_field(band, {0, 48, 0}, h);
        grading.apply(band);
        band.far_field->fine_cells = fine_cells;
        band.coupling.overlap_cells = 4;
        band.coupling.transition_cells = 3;
        measure<2>(band, two);
      }
    Scene band = unit_scene(3, {10.6, 10.1, 64}, 0.3);
    add_far_field(band, {0, 0, 30}, 2.6);
    grading.apply(band);
    band.coupling.overlap_cells = 4;
    band.coupling.transition_cells = 2;
    measure<3>(band, three);
    const std::string name =
        grows ? "critical_step_graded/growing" : "critical_step_graded/hanging";
    report(name + "_2d", two, results);
    report(name + "_3d", three, results);
  }
  return results;
}

std::vector<Result> zones_of_boxes()
{
  std::vector<Result> results;
  Measured l_shape, two_zones;
  for (const double nu : {0., 0.3, 0.45}) {
    measure<2>(l_shape_2d(nu), l_shape);
    measure<2>(two_zones_2d(nu), two_zones);
  }
  report("critical_step_boxes/l_shape", l_shape, results);
  report("critical_step_boxes/two_zones", two_zones, results);
  return results;
}
} // namespace

std::vector<Case> critical_step_cases()
{
  return {{"critical_step", "largest frequency of the step operator, coupled and plain discrete",
           false, critical_step},
          {"critical_step_random", "the same of random packings", true, random_packings},
          {"critical_step_graded", "the same where cells change their size in the overlap", true,
           graded_meshes},
          {"critical_step_boxes", "the same of zones of several boxes", true, zones_of_boxes}};
}
} // namespace ligament::program
