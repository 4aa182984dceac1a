// Couplers beside a far field whose cells are no boxes beyond the transition, and their refusal
// where those reach it.
#include "core/check.h"
#include "tests/support/distorted_meshes.h"
#include "tests/support/noise.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ligament
{
namespace
{
using namespace tests;

/// A ring in 2D, a band in 3D; cells are moved out of shape where they are farther than `distance`
/// from the zone.
template <int dim>
CoupledBodiesParameters<dim> plate(double distance)
{
  CoupledBodiesParameters<dim> p;
  p.material.poissons_ratio = 0.22;
  p.transition_cells = 3;
  if constexpr (dim == 2) {
    p.size = {110, 104};
    p.zone_size = {44, 41};
  } else {
    p.size = {13, 11, 90};
    p.zone_size = {100, 100, 34};
    p.cell_size = 3.1;
  }
  p.change_mesh = [half = p.zone_size / 2, distance](fem::Mesh<dim> &mesh) {
    mesh = fem::distorted(mesh, 0.2, 1, [&](const Vector<dim> &x) {
      return (x.cwiseAbs() - half).maxCoeff() > distance;
    });
  };
  return p;
}

template <int dim>
void check_patch()
{
  const auto p = plate<dim>(5 * (dim == 2 ? 4.1 : 3.1));
  auto body = make_coupled_bodies(p);
  EXPECT_LT(body.split->report().patch_residual, 1e-12);
  const auto &mesh = body.far->mesh();
  ASSERT_GT(std::count(mesh.general.begin(), mesh.general.end(), 1), mesh.n_cells() / 10);
  Eigen::Matrix<double, dim, dim> gradient = Eigen::Matrix<double, dim, dim>::Zero();
  for (int i = 0; i < dim * dim; ++i)
    gradient.data()[i] = 1e-6 * (i % 4 - 1.5);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    set<dim>(body.far->displacement, i, Vector<dim>(gradient * mesh.nodes[i]));
  auto &state = body.zone->state;
  for (int i = 0; i < state.size(); ++i)
    set<dim>(state.displacement, i, Vector<dim>(gradient * get(state.reference, i)));
  auto bodies = body.bodies();
  coupling::StepTime time;
  time.dt = body.dt;
  body.split->compute_forces(bodies, time);
  std::vector<char> on_side(mesh.n_nodes(), 0);
  for (const auto &face : mesh.boundary_faces)
    for (const int a : fem::face_nodes<dim>(face.face))
      on_side[mesh.cells[face.cell][a]] = 1;
  int n_inside = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    if (!on_side[i] && !body.far->is_released_node(i)) {
      ++n_inside;
      // Forces of faces of h^(dim-1) at strains of 1e-6.
      EXPECT_LT(get(body.far->force, i).norm(), 1e-12 * 1e-6 * std::pow(p.cell_size, dim));
    }
  EXPECT_GT(n_inside, 50);
}

TEST(GeneralCells, BeyondTheTransitionKeepThePatchTest)
{
  check_patch<2>();
  check_patch<3>();
}

TEST(GeneralCells, BeyondTheTransitionKeepTheEnergyOfNoise)
{
  EXPECT_LT(std::abs(drift_of_noise(plate<2>(5 * 4.1), 1e-9, 2000)), 1e-9);
}

TEST(GeneralCells, AreRefusedInOverlapAndTransitionWithTheirPlace)
{
  const auto message = [](double distance) {
    try {
      make_coupled_bodies(plate<2>(distance));
    } catch (const core::InputError &error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string transition = message(4.1);
  EXPECT_EQ(transition.find("the transition beside the overlap reaches the cell of the far field "
                            "at ("),
            0u)
      << transition;
  EXPECT_NE(transition.find("transition_cells"), std::string::npos);
  EXPECT_EQ(message(-8).find("the overlap reaches the cell"), 0u) << message(-8);
}
} // namespace
} // namespace ligament
