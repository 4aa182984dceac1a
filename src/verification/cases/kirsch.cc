// A plate with a hole under tension: displacements of the packing against Kirsch's solution.
#include "core/extremes.h"
#include "dem/many_body_force.h"
#include "packings/lattice_packing.h"
#include "particles/linear_equilibrium.h"
#include "src/verification/bodies/kirsch_field.h"
#include "src/verification/cases.h"

#include <fmt/format.h>

#include <cmath>

namespace ligament::program
{
namespace
{
/// Largest error of displacement over the body, over the largest displacement of the hole's rim.
/// The body is a square of half width 2.5 R; particles within 3 d of its sides follow the solution.
double displacement_error(double radius)
{
  constexpr int dofs = n_particle_dofs<2>;
  const double half = 2.5 * radius;
  packings::LatticeParameters<2> lattice;
  lattice.spacing = 1;
  lattice.lower.setConstant(-half);
  lattice.upper.setConstant(half);
  lattice.holes = {{Vector<2>::Zero(), radius}};
  const auto packing = packings::make_lattice_packing<2>(lattice);
  dem::DemMaterial material;
  material.poissons_ratio = 0.3;
  const dem::ManyBodyForce<2> force(packing, material, {});
  particles::Particles<2> state;
  packings::fill_particles(packing, material.density, state);
  const KirschField field{radius, material.shear_modulus(), material.poissons_ratio};

  const int n = packing.size();
  std::vector<char> is_free(n, 0);
  Eigen::VectorXd exact(dofs * n);
  for (int i = 0; i < n; ++i) {
    const Vector<2> x = get(packing.centre, i);
    exact.segment<dofs>(dofs * i) = field(x);
    is_free[i] = x.cwiseAbs().maxCoeff() < half - 3;
  }
  Eigen::VectorXd motion = exact;
  particles::solve_equilibrium(state, force, is_free, motion);

  double worst = 0;
  for (int i = 0; i < n; ++i)
    keep_largest(worst, (motion - exact).segment<2>(dofs * i).norm());
  return worst / field({radius, 0}).head<2>().norm();
}

Case kirsch_case(const std::string &name, double radius, double must, bool slow)
{
  return {name,
          fmt::format("plate with a hole of radius {:g} d: displacement against Kirsch", radius),
          slow, [=] {
            return std::vector<Result>{
                {name + "/displacement_error", displacement_error(radius), must, {}}};
          }};
}
} // namespace

std::vector<Case> kirsch_cases()
{
  return {kirsch_case("kirsch_10", 10, 0.015, false), kirsch_case("kirsch_40", 40, 0.003, true)};
}
} // namespace ligament::program
