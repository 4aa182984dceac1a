#include "src/verification/cases/law.h"

#include "core/extremes.h"
#include "dem/many_body_force.h"
#include "packings/lattice_packing.h"
#include "packings/random_packing.h"
#include "src/verification/instruments/breaking_run.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
using Law = dem::FractureLaw::Criterion;

constexpr double nu = 0.2, compressive = 6, angle = 0.6, tensile_share = 0.75;
/// Of the material whose planes would bear 1 / tensile_share of the cut-off in tension.
const double cohesion = (1 + std::sin(angle)) / (2 * std::cos(angle)) / tensile_share;

struct Named
{
  std::string name;
  Law criterion;
};
const std::vector<Named> &tensor_criteria()
{
  static const std::vector<Named> all = {{"principal_stress", Law::principal_stress},
                                         {"von_mises", Law::von_mises},
                                         {"drucker_prager", Law::drucker_prager},
                                         {"mohr_coulomb", Law::mohr_coulomb},
                                         {"energy", Law::energy}};
  return all;
}

/// Tension, compression and shear in space at which a material of strength 1 in tension fails; in
/// plane strain with the stress across the plane. 0: it never does.
std::array<double, 3> strengths(const std::string &name, bool plane_strain)
{
  const double lateral = plane_strain ? nu : 0, sum = 1 + lateral;
  const double mises = std::sqrt(1 - lateral + lateral * lateral);
  if (name == "principal_stress")
    return {1, 0, 1};
  if (name == "von_mises")
    return {1 / mises, 1 / mises, 1 / std::sqrt(3.)};
  if (name == "drucker_prager") {
    const double of_mises = (compressive + 1) / (2 * compressive),
                 of_trace = (compressive - 1) / (2 * compressive);
    return {1 / (of_mises * mises + of_trace * sum),
            std::max(0., 1 / (of_mises * mises - of_trace * sum)), 1 / (of_mises * std::sqrt(3.))};
  }
  if (name == "mohr_coulomb")
    return {1, 2 * cohesion * std::cos(angle) / (1 - std::sin(angle)),
            std::min(1., cohesion * std::cos(angle))};
  const double energy = std::sqrt(plane_strain ? 1 - nu * nu : 1);
  return {1 / energy, 0, 1 / std::sqrt(2 * (1 + nu))};
}

/// Largest error of the strength of a homogeneous body along axes that no lattice knows: the load
/// at which its first face breaks over that of the law.
template <int dim>
double error_of_strength(const packings::Packing<dim> &packing, const Named &law)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  constexpr double small = 1e-9; // of the modulus: rotations of second order vanish
  const dem::DemMaterial material{1, nu, 1, PlaneMode::strain, 0};
  // Cells at the sides have less around them, which three rows of neighbours see.
  std::vector<char> beside(packing.size(), 0);
  for (const auto &face : packing.boundary_faces)
    beside[face.i] = 1;
  for (int row = 0; row < 3; ++row) {
    const auto before = beside;
    for (const auto &face : packing.faces)
      beside[face.i] |= before[face.j], beside[face.j] |= before[face.i];
  }
  std::vector<int> inside;
  for (int i = 0; i < packing.size(); ++i)
    if (!beside[i])
      inside.push_back(i);

  dem::FaceStrength strength = small;
  strength.compressive = compressive;
  strength.cohesion = cohesion;
  strength.friction_angle = angle;
  const dem::ManyBodyForce<dim> force(packing, material, {}, {law.criterion, strength});
  const Matrix compliance_of_trace = -nu * (dim == 2 ? 1 + nu : 1) * Matrix::Identity();
  const std::array<double, 3> expected = strengths(law.name, dim == 2);
  double worst = 0;
  for (int load = 0; load < 3; ++load) {
    if (expected[load] <= 0)
      continue;
    Matrix stress = Matrix::Zero(), axes = Matrix::Identity();
    if (load < 2)
      stress(0, 0) = load == 0 ? 1 : -1;
    else
      stress(0, 1) = stress(1, 0) = 1;
    axes.template topLeftCorner<2, 2>() = Eigen::Rotation2Dd(0.35).toRotationMatrix();
    if constexpr (dim == 3)
      axes = Eigen::AngleAxisd(0.5, Vector<3>(1, -2, 0.5).normalized()).toRotationMatrix() * axes;
    stress = (small * axes * stress * axes.transpose()).eval();
    // Plane strain: e = (1 + nu) (s - nu tr s); in space (1 + nu) s - nu tr s.
    const Matrix strain = (1 + nu) * stress + compliance_of_trace * stress.trace();
    particles::Particles<dim> p;
    packings::fill_particles(packing, 1., p);
    for (int i = 0; i < p.size(); ++i)
      set(p.displacement, i, Vector<dim>(strain * get(packing.centre, i)));
    const double measured = 1 / force.weakest_bond(p, inside).utilisation;
    keep_largest(worst, std::abs(measured / expected[load] - 1));
  }
  return worst;
}

template <int dim, typename Parameters>
Parameters box(Parameters p, double n)
{
  p.spacing = 1;
  p.upper.setConstant(n / 2);
  p.lower = -p.upper;
  return p;
}

std::vector<Result> homogeneous_strengths()
{
  std::vector<std::pair<std::string, packings::Packing<2>>> plane;
  for (const double degrees : {0., 15., 30.}) {
    auto p = box<2>(packings::LatticeParameters<2>(), 16);
    p.kind = packings::LatticeKind::hexagonal;
    p.orientation[0] = degrees * M_PI / 180;
    plane.emplace_back(fmt::format("hexagonal_{:.0f}", degrees),
                       packings::make_lattice_packing<2>(p));
  }
  for (const double ratio : {1., 3.}) {
    auto p = box<2>(packings::RandomParameters<2>(), 18);
    p.size_ratio = ratio;
    plane.emplace_back(fmt::format("random_{:.0f}", ratio),
                       packings::make_random_packing<2>(p).packing);
  }
  std::vector<std::pair<std::string, packings::Packing<3>>> space;
  for (const double degrees : {0., 20.}) {
    auto p = box<3>(packings::LatticeParameters<3>(), 10);
    p.kind = packings::LatticeKind::fcc;
    p.orientation[2] = degrees * M_PI / 180;
    space.emplace_back(fmt::format("fcc_{:.0f}", degrees), packings::make_lattice_packing<3>(p));
  }
  space.emplace_back(
      "random_3d",
      packings::make_random_packing<3>(box<3>(packings::RandomParameters<3>(), 9)).packing);
  std::vector<Result> results;
  for (const Named &law : tensor_criteria()) {
    double worst = 0;
    for (const auto &[name, packing] : plane)
      keep_largest(worst, error_of_strength<2>(packing, law));
    for (const auto &[name, packing] : space)
      keep_largest(worst, error_of_strength<3>(packing, law));
    results.push_back({"law_strengths/" + law.name, worst, 0.01, 1e-6});
  }
  return results;
}

/// A plate of 48 by 96 spacings of a random packing with a crack of 2a = 16 d, inclined by 30
/// degrees, pulled at its ends.
Scene inclined(Criterion criterion, int seed)
{
  constexpr double inclination = M_PI / 6, a = 8;
  Scene scene = unit_scene(2, {48, 96, 0}, nu);
  scene.zone.packing = PackingKind::random;
  scene.zone.seed = seed;
  scene.specimen.cracks = {{{{-a * std::cos(inclination), -a * std::sin(inclination), 0},
                             {a * std::cos(inclination), a * std::sin(inclination), 0}}}};
  FractureParameters &p = scene.material.fracture;
  p.criterion = criterion;
  p.strength = 1e-3;
  if (criterion == Criterion::drucker_prager || criterion == Criterion::mohr_coulomb)
    p.compressive_strength = 6e-3;
  if (criterion == Criterion::mohr_coulomb)
    p.friction_angle = angle;
  add_pull(scene, 1, 4e-5, 200);
  return scene;
}

/// Direction in degrees of the faces that broke from 3 to 12 spacings beyond either tip, by least
/// squares through each tip's own, mean of both; the plane of the crack has 30, across the load 0.
double direction(Criterion criterion, int seed)
{
  BreakingRun<2> run(inclined(criterion, seed));
  double peak = 0;
  for (bool broken = false; !broken && run.time() < 6000;) {
    run.step();
    const auto &force = *run.body().force();
    const double load = (force.reaction(1)[1] - force.reaction(0)[1]) / 2;
    keep_largest(peak, load);
    broken = !force.broken_bonds().empty() && load < peak / 3;
  }
  const double tip = 8 * std::cos(M_PI / 6);
  double sum = 0;
  int tips = 0;
  for (const int side : {-1, 1}) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const auto &b : run.body().force()->broken_bonds()) {
      const double x = side * b.position[0] - tip, y = side * b.position[1];
      if (x < 3 || x > 12)
        continue;
      const double w = b.area * std::abs(b.normal[1]); // projected
      n += w, sx += w * x, sy += w * y, sxx += w * x * x, sxy += w * x * y;
    }
    if (n < 4)
      continue;
    sum += std::atan((n * sxy - sx * sy) / (n * sxx - sx * sx)) * 180 / M_PI;
    ++tips;
  }
  return tips > 0 ? sum / tips : std::numeric_limits<double>::quiet_NaN();
}

/// Mean and standard deviation over random packings of each criterion; the direction is stated.
std::vector<Result> mixed_mode_directions()
{
  std::vector<Result> results;
  constexpr int n = 6;
  for (const Criterion criterion :
       {Criterion::maximum_tension, Criterion::face_tension, Criterion::principal_stress,
        Criterion::energy, Criterion::von_mises, Criterion::drucker_prager,
        Criterion::mohr_coulomb})
  {
    double sum = 0, squares = 0;
    for (int seed = 1; seed <= n; ++seed) {
      const double one = direction(criterion, seed);
      sum += one, squares += one * one;
    }
    const double mean = sum / n,
                 deviation = std::sqrt(std::max(0., (squares - n * mean * mean) / (n - 1)));
    const std::string name = "law_directions/" + word_of(criterion);
    results.push_back({name + "/mean_direction", std::abs(mean), 90, {}});
    results.push_back({name + "/standard_deviation", deviation, 90, {}});
  }
  return results;
}
} // namespace

std::vector<Case> law_cases()
{
  return {{"law_strengths",
           "uniaxial and shear strengths of homogeneous bodies by criteria of tensors", false,
           homogeneous_strengths},
          {"law_directions", "where an inclined crack runs in random packings, by criterion", true,
           mixed_mode_directions}};
}
} // namespace ligament::program
