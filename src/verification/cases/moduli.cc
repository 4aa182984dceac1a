// Young's modulus and Poisson's ratio of finite specimens in uniaxial stress.
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"
#include "src/verification/instruments/linear_motion.h"

#include <functional>

namespace ligament::program
{
namespace
{
constexpr double strain = 1e-14; // applied along x; its square is below round-off

/// Worst deviations over a set of specimens.
struct Deviation
{
  double youngs_modulus = 0; // relative
  double poissons_ratio = 0; // absolute
  double residual = 0;       // of the exact motion, over C11 d^(dim-1) strain
};

void hold(Scene &scene, int side, double displacement)
{
  LoadParameters load;
  load.boundary = side;
  load.kind = LoadKind::displacement;
  load.ramp = 1;
  load.value[side / 2] = displacement;
  load.displacement = load.value;
  scene.loads.push_back(load);
}

/// Mean lateral strain of the particles: slope of their displacements along `axis`.
template <int dim>
double lateral_strain(const particles::Particles<dim> &zone, int axis)
{
  const int n = zone.size();
  double x = 0, u = 0, xx = 0, xu = 0;
  for (int i = 0; i < n; ++i) {
    x += zone.reference[axis][i] / n;
    u += zone.displacement[axis][i] / n;
  }
  for (int i = 0; i < n; ++i) {
    const double dx = zone.reference[axis][i] - x;
    xx += dx * dx;
    xu += dx * (zone.displacement[axis][i] - u);
  }
  return xu / xx;
}

/// Pulls the sides left and right apart; bottom (and back) are planes of symmetry, the rest free.
template <int dim>
void pull(Scene scene, Deviation &worst)
{
  const double length = scene.specimen.size[0];
  hold(scene, 0, -strain * length / 2);
  hold(scene, 1, strain * length / 2);
  for (int c = 1; c < dim; ++c)
    hold(scene, 2 * c, 0);
  UnitBody<dim> unit(scene);
  auto &body = unit.body;
  LinearMotion<dim> motion(body);
  motion.solve();

  double area = 1;
  for (int c = 1; c < dim; ++c)
    area *= scene.specimen.size[c];
  const bool plane_strain = dim == 2 && scene.plane == PlaneMode::strain;
  const double modulus = body.force()->reaction(1)[0] / (area * strain);
  for (int c = 1; c < dim; ++c) {
    const double ratio = -lateral_strain(body.zone->state, c) / strain;
    const double nu = plane_strain ? ratio / (1 + ratio) : ratio;
    const double e = plane_strain ? modulus * (1 - nu * nu) : modulus;
    keep_largest(worst.youngs_modulus, std::abs(e - 1));
    keep_largest(worst.poissons_ratio, std::abs(nu - scene.material.poissons_ratio));
  }

  // The same state written down: every particle must be in equilibrium.
  const double nu = scene.material.poissons_ratio;
  const double ratio = plane_strain ? nu / (1 - nu) : nu;
  auto &zone = body.zone->state;
  Eigen::Matrix<double, dim, dim> gradient = Eigen::Matrix<double, dim, dim>::Zero();
  for (int c = 0; c < dim; ++c)
    gradient(c, c) = c == 0 ? strain : -ratio * strain;
  Vector<dim> shift = Vector<dim>::Zero(); // bottom and back stand still
  for (int c = 1; c < dim; ++c)
    shift[c] = -ratio * strain * scene.specimen.size[c] / 2;
  motion.accelerations(motion.affine(gradient, shift), true);
  for (int i = 0; i < zone.size(); ++i) {
    keep_largest(worst.residual, get(zone.force, i).norm() / (unit.c11() * strain));
    keep_largest(worst.residual, get(zone.torque, i).norm() / (unit.c11() * strain));
  }
}

/// What makes a specimen another one than a plain box of a lattice.
using Change = std::function<void(Scene &)>;

template <int dim>
void add_moduli(const std::string &name, const Change &change, double must,
                std::vector<Result> &results)
{
  Deviation worst;
  for (const double nu : {-0.2, 0., 0.2, 0.22, 0.3, 0.45, 0.49})
    for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress}) {
      if (dim == 3 && plane == PlaneMode::stress)
        continue;
      Scene scene = unit_scene(dim, dim == 2 ? Point{10.3, 9.1, 0} : Point{5.3, 4.6, 4.9}, nu);
      scene.plane = plane;
      change(scene);
      pull<dim>(scene, worst);
    }
  results.push_back({name + "/youngs_modulus", worst.youngs_modulus, must, {}});
  results.push_back({name + "/poissons_ratio", worst.poissons_ratio, must, {}});
  results.push_back({name + "/residual", worst.residual, must, {}});
}

std::vector<Result> lattices()
{
  std::vector<Result> results;
  const auto choose = [](const char *packing) {
    return [=](Scene &scene) { scene.zone.packing = named<PackingKind>(packing); };
  };
  for (const char *packing : {"square", "hexagonal"})
    add_moduli<2>(std::string("moduli/") + packing, choose(packing), 1e-12, results);
  for (const char *packing : {"simple_cubic", "fcc"})
    add_moduli<3>(std::string("moduli/") + packing, choose(packing), 1e-12, results);
  return results;
}

/// Random packings: nearly unrelaxed, relaxed, and with radii from 1 to 5.
template <int dim>
std::vector<Result> random_packings()
{
  const std::string name = dim == 2 ? "moduli_random_2d" : "moduli_random_3d";
  std::vector<Result> results;
  const auto choose = [](int sweeps, double ratio) {
    return [=](Scene &scene) {
      scene.zone.packing = PackingKind::random;
      scene.zone.relaxation_sweeps = sweeps;
      scene.zone.size_ratio = ratio;
    };
  };
  add_moduli<dim>(name + "/rough", choose(1, 1), 1e-9, results);
  add_moduli<dim>(name + "/equal", choose(10, 1), 1e-9, results);
  add_moduli<dim>(name + "/ratio_5", choose(10, 5), 1e-9, results);
  return results;
}
} // namespace

std::vector<Case> moduli_cases()
{
  const std::string text = "E and nu of clipped specimens in uniaxial stress, nu -0.2 to 0.49";
  return {{"moduli", text, false, lattices},
          {"moduli_random_2d", text + ", random", false, random_packings<2>},
          {"moduli_random_3d", text + ", random", false, random_packings<3>}};
}
} // namespace ligament::program
