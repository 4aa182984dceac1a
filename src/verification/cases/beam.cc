// Pure bending of a thin beam of square packing: bending moment over that of beam theory.
#include "core/extremes.h"
#include "dem/many_body_force.h"
#include "src/verification/bodies/waves_strip.h"
#include "src/verification/cases.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <cmath>

namespace ligament::program
{
namespace
{
/// M / (E' I kappa) of an endless beam of n particles across, spacing 1. The motion under curvature
/// kappa is u = kappa (-x y, x^2/2), rotation kappa x, plus a part that repeats itself from
/// particle to particle along the beam and makes the energy smallest; M is the slope of the energy.
double moment_ratio(int n, const dem::DemMaterial &material)
{
  constexpr int period = 8, dofs = n_particle_dofs<2>;
  auto packing = packings::make_periodic_packing<2>(packings::LatticeKind::square, period, n, true);
  const auto centre = packing.centre;
  particles::Particles<2> state;
  packings::fill_particles(packing, material.density, state);
  const dem::ManyBodyForce<2> force(std::move(packing), material, {});

  // Energy of one column per unit length: 1/2 (repeated, kappa) H (repeated, kappa).
  const int size = dofs * n;
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(size + 1, size + 1);
  force.add_tangent(state, [&](const particles::QuadraticTerm<2> &term) {
    using Kind = particles::QuadraticTerm<2>::Kind;
    const auto in_column = [&](int i) { return centre[0][i] < 0.5; };
    const double share = term.kind == Kind::bond
                             ? (in_column(term.members[0]) + in_column(term.members[1])) / 2.
                             : in_column(term.members[0]);
    if (share == 0)
      return;
    Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(term.rows.cols(), size + 1);
    for (std::size_t m = 0; m < term.members.size(); ++m) {
      const int i = term.members[m];
      const double x = centre[0][i] - period * std::round(centre[0][i] / period);
      const double y = centre[1][i] - (n - 1) / 2.;
      motion.block<dofs, dofs>(dofs * m, dofs * std::lround(centre[1][i])).setIdentity();
      motion.block<dofs, 1>(dofs * m, size) << -x * y, x * x / 2, x;
    }
    const Eigen::MatrixXd rows = term.rows * motion;
    h += share * rows.transpose() * term.stiffness.asDiagonal() * rows;
  });
  // The first particle stands: translations cost nothing.
  const auto free = Eigen::seq(2, size - 1);
  const Eigen::VectorXd slope = h.col(size)(free);
  const double moment = h(size, size) - slope.dot(h(free, free).ldlt().solve(slope));

  const double nu = material.poissons_ratio;
  const double modulus =
      material.youngs_modulus / (material.plane == PlaneMode::strain ? 1 - nu * nu : 1);
  return moment / (modulus * n * n * n / 12.);
}

std::vector<Result> bend()
{
  // theory.md, section 1.2: the table of the bending law, four decimals.
  const std::array<int, 4> across = {1, 2, 4, 8};
  const std::array<double, 4> plane_stress = {1, 1.0305, 1.0103, 1.0029},
                              plane_strain = {1, 1.0614, 1.0196, 1.0055};
  double worst_exact = 0;
  std::vector<Result> results;
  for (const auto plane : {PlaneMode::stress, PlaneMode::strain}) {
    double worst = 0;
    for (std::size_t i = 0; i < across.size(); ++i) {
      dem::DemMaterial material;
      material.plane = plane;
      keep_largest(worst_exact, std::abs(moment_ratio(across[i], material) - 1));
      material.poissons_ratio = 0.3;
      const double expected = (plane == PlaneMode::stress ? plane_stress : plane_strain)[i];
      keep_largest(worst, std::abs(moment_ratio(across[i], material) - expected));
    }
    results.push_back(
        {plane == PlaneMode::stress ? "beam/moment_plane_stress" : "beam/moment_plane_strain",
         worst, 5e-4, 5e-5});
  }
  results.push_back({"beam/moment_nu_0", worst_exact, 1e-12, {}});
  return results;
}
} // namespace

std::vector<Case> beam_cases()
{
  return {{"beam",
           "pure bending, square packing, 1 to 8 particles across: moment against the table", false,
           bend}};
}
} // namespace ligament::program
