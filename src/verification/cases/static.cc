// Equilibria of small bodies: stiffness, uniform strain, iterations, the motion of stretching.
#include "src/verification/cases/static.h"

#include "src/simulation/equilibrium_solver.h"
#include "src/verification/bodies/unit_bodies.h"

#include <fmt/format.h>

#include <random>

namespace ligament::program
{
namespace
{
constexpr double small = 1e-14; // strain whose square is below round-off

struct Body
{
  std::string name;
  Scene scene;
};

/// A band of particles between meshes, with this coupler, or particles alone.
Scene band(int dim, double nu, coupling::Scheme scheme = coupling::Scheme::fine_scale_split)
{
  Scene scene = dim == 2 ? unit_scene(2, {25, 94, 0}, nu) : unit_scene(3, {9.3, 56, 8.7}, nu);
  add_far_field(scene, {0, dim == 2 ? 34. : 25., 0}, dim == 2 ? 4.1 : 3.1);
  scene.coupling.transition_cells = 2;
  scene.coupling.scheme = scheme;
  return scene;
}

std::vector<Body> bodies(int dim)
{
  using coupling::Scheme;
  std::vector<Body> list;
  for (const auto &[name, scheme] :
       {std::pair("split", Scheme::fine_scale_split),
        std::pair("acceleration", Scheme::acceleration), std::pair("pointwise", Scheme::pointwise),
        std::pair("xiao_belytschko", Scheme::xiao_belytschko)})
    list.push_back({name, band(dim, 0.22, scheme)});
  for (const double nu : {0., 0.49})
    list.push_back({fmt::format("split_nu_{}", nu), band(dim, nu)});
  list.push_back({"split_random", band(dim, 0.22)});
  list.back().scene.zone.packing = PackingKind::random;
  list.push_back({"pure", unit_scene(dim, {12, 18, 7}, 0.22)});
  list.push_back({"pure_random", unit_scene(dim, {12, 18, 7}, 0.22)});
  list.back().scene.zone.packing = PackingKind::random;
  for (auto &body : list)
    body.scene.time.step_fraction = 0.7;
  return list;
}

/// Top and bottom moved apart by a strain, nothing across.
void add_stretch(Scene &scene, double strain)
{
  for (const bool upper : {false, true}) {
    LoadParameters load;
    load.boundary = 2 + upper;
    load.kind = LoadKind::displacement;
    load.ramp = 1;
    load.value[1] = (upper ? 1 : -1) * strain * scene.specimen.size[1] / 2;
    load.displacement = load.value;
    scene.loads.push_back(load);
  }
}

template <int dim>
struct Solved
{
  UnitBody<dim> unit;
  EquilibriumSolver<dim> solver;

  explicit Solved(const Scene &scene)
      : unit(scene), solver(unit.body, algebra::Preconditioning::automatic)
  {
  }
};

template <int dim>
void measure_stiffness(const Scene &scene, double &symmetry, double &difference)
{
  Solved<dim> one(scene);
  auto &system = one.solver.system();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto noise = [&] {
    Eigen::VectorXd y =
        Eigen::VectorXd::NullaryExpr(system.size(), [&] { return uniform(random); });
    system.drop_inert(y);
    return y;
  };
  const Eigen::VectorXd x = noise(), y = noise();
  const Eigen::VectorXd kx = system.stiffness_times(x), ky = system.stiffness_times(y);
  keep_largest(symmetry, std::abs(y.dot(kx) - x.dot(ky)) / (x.norm() * ky.norm()));
  constexpr double step = 1e-6;
  const auto start = system.place();
  system.displace(y, step);
  const Eigen::VectorXd up = system.forces(0);
  system.put_back(start);
  system.displace(y, -step);
  const Eigen::VectorXd down = system.forces(0);
  keep_largest(difference, ((down - up) / (2 * step) - ky).norm() / ky.norm());
}

std::vector<Result> stiffness()
{
  std::vector<Result> results;
  for (const int dim : {2, 3}) {
    double symmetry = 0, difference = 0;
    for (const Body &body : bodies(dim))
      dim == 2 ? measure_stiffness<2>(body.scene, symmetry, difference)
               : measure_stiffness<3>(body.scene, symmetry, difference);
    const std::string name = fmt::format("static_stiffness/{}d_", dim);
    results.push_back({name + "asymmetry", symmetry, 1e-13, {}});
    results.push_back({name + "from_differences", difference, 1e-7, {}});
  }
  return results;
}

/// Uniform strain of a body under a pull along y: motion y and its rate of a unit of strain.
template <int dim>
Eigen::VectorXd uniform_strain(Solved<dim> &one, double size)
{
  const auto &body = one.unit.body;
  const double nu = body.poissons_ratio, across = dim == 2 ? -nu / (1 - nu) : -nu;
  constexpr int block = StaticSystem<dim>::block;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(one.solver.system().size());
  const int n = body.zone ? body.zone->state.size() : 0;
  const auto put = [&](int row, const Vector<dim> &x) {
    for (int c = 0; c < dim; ++c)
      y[block * row + c] = size * (c == 1 ? 1 : across) * x[c];
  };
  for (int i = 0; i < n; ++i)
    put(i, get(body.zone->state.reference, i));
  for (int i = 0; body.far && i < body.far->mesh().n_nodes(); ++i)
    put(n + i, body.far->mesh().nodes[i]);
  return y;
}

template <int dim>
double patch_residual(Scene scene)
{
  add_stretch(scene, small);
  Solved<dim> one(scene);
  one.solver.system().displace(uniform_strain(one, small));
  const double face = small * std::pow(scene.far_field ? scene.far_field->cell_size : 1, dim - 1);
  return one.solver.system().forces(1).cwiseAbs().maxCoeff() / face;
}

std::vector<Result> patch()
{
  std::vector<Result> results;
  for (const int dim : {2, 3}) {
    double worst = 0;
    for (const Body &body : bodies(dim))
      if (body.scene.coupling.scheme == coupling::Scheme::fine_scale_split)
        keep_largest(worst,
                     dim == 2 ? patch_residual<2>(body.scene) : patch_residual<3>(body.scene));
    results.push_back({fmt::format("static_patch/{}d_out_of_balance", dim), worst, 1e-12, 1e-14});
  }
  return results;
}

/// Energy of the motion that a phase ends with, over that of uniform stretching at the loads' rate.
std::vector<Result> kinetic()
{
  std::vector<Result> results;
  for (const int ratio : {1, 2, 4, 8}) {
    Scene scene = unit_scene(2, {40, 240, 0}, 0.22);
    add_far_field(scene, {0, 60, 0}, 8.2);
    scene.coupling.transition_cells = 4;
    scene.coupling.step_ratio = ratio;
    constexpr double strain = 1e-6;
    add_stretch(scene, strain);
    Solved<2> one(scene);
    auto &system = one.solver.system();
    Eigen::VectorXd moved, response;
    using End = EquilibriumSolver<2>::End;
    if (one.solver.find_equilibrium(0.5, moved) != End::converged ||
        one.solver.find_response(0.5, 1, response) != End::converged)
      return {{"static_kinetic", std::nan(""), 0, {}}};
    const coupling::StepTime step{ratio, 0.5, one.unit.body.dt};
    system.forces(0.5);
    system.set_velocities(response / 0.5, step);
    const double w = 40, h = 240, across = 0.22 / 0.78;
    const double uniform = strain * strain / 24 * (w * h * h * h + across * across * h * w * w * w);
    const double share = system.motion_energy(step) / uniform;
    const std::string name = fmt::format("static_kinetic/ratio_{}", ratio);
    results.push_back({name + "_most", share, 1.05, {}});
    results.push_back({name + "_least", share, 0.9, {}, Result::Bound::at_least});
  }
  return results;
}

/// Iterations per Newton step of an equilibrium from rest.
template <int dim>
Result iterations(const std::string &name, Scene scene)
{
  add_stretch(scene, 1e-4);
  scene.specimen.cracks =
      dim == 2 ? std::vector<Crack>{{{{-8, 0, 0}, {8, 0, 0}}}} : std::vector<Crack>{};
  Solved<dim> one(scene);
  Eigen::VectorXd moved;
  const auto end = one.solver.find_equilibrium(1, moved);
  const double each = double(one.solver.n_iterations()) / one.solver.n_solves();
  fmt::print("  {}: {} unknowns, {}, {} Newton steps\n", name, one.solver.system().n_unknowns(),
             one.solver.preconditioner(), one.solver.n_solves());
  return {"static_iterations/" + name,
          end == EquilibriumSolver<dim>::End::converged ? each : std::nan(""), 60, 15};
}

std::vector<Result> iterations_of(bool full)
{
  std::vector<Result> results;
  const double size = full ? 3.2 : 1;
  for (const double nu : {0.22, 0.49}) {
    Scene scene = unit_scene(2, {100 * size, 400 * size, 0}, nu);
    add_far_field(scene, {0, 110 * size, 0}, 4.1);
    scene.coupling.transition_cells = 3;
    scene.time.step_fraction = 0.7;
    results.push_back(iterations<2>(fmt::format("2d_{}_nu_{}", full ? "4e5" : "4e4", nu), scene));
  }
  Scene bar = unit_scene(3, {14, 100, 13}, 0.22);
  add_far_field(bar, {0, full ? 72. : 48., 0}, 3.1);
  bar.coupling.transition_cells = 2;
  results.push_back(iterations<3>(full ? "3d_larger" : "3d_7e4", bar));
  return results;
}
} // namespace

std::vector<Case> static_cases()
{
  return {{"static_stiffness", "the stiffness at rest: symmetric, and what forces change by", false,
           stiffness},
          {"static_patch", "uniform strain at rest: forces out of balance", false, patch},
          {"static_kinetic", "motion of stretching behind a static phase, step ratios 1 to 8",
           false, kinetic},
          {"static_iterations", "conjugate gradients per Newton step", false,
           [] { return iterations_of(false); }},
          {"static_iterations_large", "the same of larger bodies", true,
           [] { return iterations_of(true); }}};
}
} // namespace ligament::program
