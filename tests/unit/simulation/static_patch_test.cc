// A body whose ends are drawn apart without anything across: uniform strain is its equilibrium, on
// any packing and through the overlap, and none of the solver's iterations are needed for it.
#include "tests/support/static_body.h"

#include <Eigen/LU>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
constexpr double size_of_strain = 1e-14; // its square is below round-off

struct Patch
{
  std::string name;
  int dim;
  std::vector<std::string> overrides;
};

std::vector<Patch> all_patches()
{
  std::vector<Patch> patches;
  for (const int dim : {2, 3}) {
    const std::string end = dim == 2 ? "_2d" : "_3d";
    const auto add = [&](const std::string &name, const std::vector<std::string> &overrides) {
      patches.push_back({name + end, dim, overrides});
    };
    const std::string random = "/discrete_zone/packing=\"random\"", pure = "/far_field=none";
    add("coupled", {});
    add("coupled_nu_0", {"/material/poissons_ratio=0"});
    add("coupled_nu_049", {"/material/poissons_ratio=0.49", "/time/step_fraction=0.7"});
    add("coupled_random", {random});
    // Three dimensions of particles alone take a while to factorise.
    const std::string size = dim == 2 ? "/specimen/size=[24, 40]" : "/specimen/size=[5, 20, 4]";
    add("pure", {pure, size});
    add("pure_random", {pure, random, size});
    add("mesh", {"/discrete_zone=none"});
    add("turning", {"/coupling/regime=\"corotated\""});
  }
  patches.push_back({"coupled_square_2d", 2, {"/discrete_zone/packing=\"square\""}});
  patches.push_back({"step_ratio_2d", 2, {"/coupling/step_ratio=2"}});
  patches.push_back(
      {"ratio_3_2d", 2, {"/discrete_zone/packing=\"random\"", "/discrete_zone/size_ratio=3"}});
  patches.push_back({"turned_2d", 2, {"/discrete_zone/orientation=0.3"}});
  patches.push_back({"simple_cubic_3d",
                     3,
                     {"/far_field=none", "/discrete_zone/packing=\"simple_cubic\"",
                      "/specimen/size=[5, 20, 4]"}});
  return patches;
}

class StaticPatches : public ::testing::TestWithParam<Patch>
{
};
INSTANTIATE_TEST_SUITE_P(, StaticPatches, ::testing::ValuesIn(all_patches()),
                         [](const auto &info) { return info.param.name; });

/// Strain of a unit of it along the axis y and the contraction across, plane strain in 2D.
template <int dim>
Vector<dim> stretched(double nu)
{
  Vector<dim> strain = Vector<dim>::Constant(dim == 2 ? -nu / (1 - nu) : -nu);
  strain[1] = 1;
  return size_of_strain * strain;
}

template <int dim>
void expect_equilibrium(const Patch &patch, bool is_drawn)
{
  const char *kind = is_drawn ? "traction" : "displacement";
  const std::string no = "null", one_unit = "1";
  const std::vector<std::string> way =
      dim == 2 ? std::vector{no, one_unit} : std::vector{no, one_unit, no};
  Scene scene = static_scene<dim>(patch.overrides +
                                  std::vector{loads({{"top", kind, way}, {"bottom", kind, way}})});
  const double nu = scene.material.poissons_ratio, height = scene.specimen.size[1];
  // Plane strain: the stress of a unit of strain is E/(1 - nu^2).
  const double stress = size_of_strain / (dim == 2 ? 1 - nu * nu : 1);
  for (auto &load : scene.loads) {
    load.value[1] =
        (load.boundary == 3 ? 1 : -1) * (is_drawn ? stress : size_of_strain * height / 2);
    (is_drawn ? load.traction : load.displacement) = load.value;
  }
  StaticBody<dim> one(scene);

  auto &body = one.body;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(one.system().size());
  const Vector<dim> strain = stretched<dim>(nu);
  constexpr int block = StaticSystem<dim>::block;
  const int n = body.zone ? body.zone->state.size() : 0;
  for (int i = 0; i < n; ++i)
    y.template segment<dim>(block * i) = strain.cwiseProduct(get(body.zone->state.reference, i));
  for (int i = 0; body.far && i < body.far->mesh().n_nodes(); ++i)
    y.template segment<dim>(block * (n + i)) = strain.cwiseProduct(body.far->mesh().nodes[i]);
  one.system().displace(y);

  const double left = one.system().forces(1).cwiseAbs().maxCoeff();
  ASSERT_GT(one.system().load_force(1), 0);
  // Over what the strain makes act on a face of a particle, or of a cell.
  const double length = body.zone ? 1 : one.body.far->mesh().cell_size[0].minCoeff();
  const double face = stress * std::pow(length, dim - 1);
  EXPECT_LT(left, 1e-12 * face * (body.zone ? body.far ? 4.1 : 1 : 1));

  Eigen::VectorXd moved;
  ASSERT_EQ(one.solver.find_equilibrium(1, moved), EquilibriumSolver<dim>::End::converged);
  EXPECT_LT(moved.cwiseAbs().maxCoeff(), 1e-9 * size_of_strain * height);
}

TEST_P(StaticPatches, DrawnByTractions)
{
  GetParam().dim == 2 ? expect_equilibrium<2>(GetParam(), true)
                      : expect_equilibrium<3>(GetParam(), true);
}

TEST_P(StaticPatches, HeldAtItsEnds)
{
  GetParam().dim == 2 ? expect_equilibrium<2>(GetParam(), false)
                      : expect_equilibrium<3>(GetParam(), false);
}
} // namespace
