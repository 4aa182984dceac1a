// Bodies that repeat themselves: jumps across their joined sides act as homogeneous strains, in
// particles and in meshes, and pull with the mean stress.
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases/lab.h"

#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double nu = 0.3;

struct Errors
{
  double force = 0;    // left on a particle or node, over stress times d^(dim - 1)
  double reaction = 0; // of the joined sides, over mean stress times their area
  double energy = 0;   // over that of the homogeneous body
};

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

/// Strain along and across all axes, without rotation: the law is linear then.
template <int dim>
Matrix<dim> strain()
{
  Matrix<dim> e;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      e(a, b) = 1e-4 * (a == b ? 1 - 2.5 * a : 0.7 + 0.2 * (a + b));
  return e;
}

template <int dim>
Errors measure(Scene scene)
{
  const Matrix<dim> e = strain<dim>();
  for (int a = 0; a < dim; ++a) {
    scene.specimen.periodic.push_back({Axis(a)});
    LoadParameters &load = scene.loads.emplace_back();
    load.periodic = Axis(a);
    load.boundary = core::BoundaryLoad<dim>::jump_across(a);
    load.kind = LoadKind::displacement;
    for (int c = 0; c < dim; ++c)
      load.value[c] = e(c, a) * scene.specimen.size[a];
  }
  UnitBody<dim> unit(scene);
  CoupledBody<dim> &body = unit.body;
  const double lambda = nu / ((1 + nu) * (1 - 2 * nu)), shear = 1 / (2 * (1 + nu));
  const Matrix<dim> stress = 2 * shear * e + lambda * e.trace() * Matrix<dim>::Identity();
  const double volume = (body.upper - body.lower).prod(),
               expected = 0.5 * e.cwiseProduct(stress).sum() * volume;
  Errors worst;
  const auto check = [&](double energy, const std::function<Vector<dim>(int)> &reaction) {
    keep_largest(worst.energy, std::abs(energy / expected - 1));
    for (int a = 0; a < dim; ++a) {
      const double area = volume / (body.upper - body.lower)[a];
      keep_largest(worst.reaction,
                   (reaction(a) - stress.col(a) * area).norm() / area / stress.norm());
    }
  };
  if (body.zone) {
    auto &state = body.zone->state;
    for (int i = 0; i < state.size(); ++i)
      set(state.displacement, i, Vector<dim>(e * get(state.reference, i)));
    body.zone->compute_forces(0);
    for (int i = 0; i < state.size(); ++i)
      keep_largest(worst.force, get(state.force, i).norm() / stress.norm());
    check(body.zone->potential_energy(), [&](int a) { return body.force()->reaction(a); });
  } else {
    auto &far = *body.far;
    for (int i = 0; i < far.mesh().n_nodes(); ++i)
      set(far.displacement, i, Vector<dim>(e * far.mesh().nodes[i]));
    far.compute_forces(0);
    for (int i = 0; i < far.mesh().n_nodes(); ++i)
      keep_largest(worst.force, get(far.force, i).norm() / stress.norm());
    check(far.potential_energy(), [&](int a) { return far.reaction(a); });
  }
  return worst;
}

std::vector<Result> measure()
{
  std::vector<Result> results;
  const auto add = [&](const std::string &model, const Errors &e, double must) {
    const std::string name = "lab_periodic/" + model;
    results.push_back({name + "_force", e.force, must, {}});
    results.push_back({name + "_reaction", e.reaction, must, {}});
    results.push_back({name + "_energy", e.energy, must, {}});
  };
  const Point plane = {12, 8 * std::sqrt(3.), 0}, space = {7, 6, 5 * std::sqrt(2.)};
  add("hexagonal", measure<2>(unit_scene(2, plane, nu)), 1e-12);
  add("fcc", measure<3>(unit_scene(3, space, nu)), 1e-12);
  Scene random = unit_scene(2, {17.3, 13.1, 0}, nu);
  random.zone.packing = PackingKind::random;
  add("random", measure<2>(random), 1e-9);
  random = unit_scene(3, {7.2, 6.7, 8.1}, nu);
  random.zone.packing = PackingKind::random;
  add("random_3d", measure<3>(random), 1e-9);
  Scene mesh = unit_scene(2, {17.3, 13.1, 0}, nu);
  add_far_field(mesh, {0, 0, 0}, 1.3);
  mesh.zone.extent = DiscreteZone::Extent::none;
  add("mesh", measure<2>(mesh), 1e-12);
  return results;
}
} // namespace

std::vector<Case> lab_periodic_cases()
{
  return {{"lab_periodic", "joined sides: jumps act as homogeneous strains on every packing", false,
           [] { return measure(); }}};
}
} // namespace ligament::program
