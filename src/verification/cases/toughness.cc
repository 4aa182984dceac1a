// Toughness of plates that break: K at the peak load over the K_Ic of the scene, on any packing.
#include "core/extremes.h"
#include "dem/grips.h"
#include "dem/many_body_force.h"
#include "dem/principal_tension.h"
#include "dem/toughness_calibration.h"
#include "packings/lattice_packing.h"
#include "packings/random_packing.h"
#include "particles/particle_solver.h"
#include "src/verification/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace ligament::program
{
namespace
{
/// A glass plate of 40 mm by 100 mm with a central crack of 2a = 20 mm, pulled at its ends; all of
/// discrete elements.
struct CrackedPlate
{
  std::string packing = "hexagonal";
  double angle = 0;      // degrees, lattices
  int seed = 1;          // random packings
  double size_ratio = 1; // random packings
  double spacing = 0.5e-3;
  double tip = 0; // spacings by which the crack is longer at either end
  double poissons_ratio = 0.22;
  PlaneMode plane = PlaneMode::strain;
  dem::FractureLaw::Criterion criterion = dem::FractureLaw::Criterion::maximum_tension;
};

constexpr double width = 40e-3, height = 100e-3, half_crack = 10e-3, toughness = 0.75e6,
                 density = 2450;

template <typename Parameters>
void lay_out(const CrackedPlate &plate, Parameters &p)
{
  const double a = half_crack + plate.tip * plate.spacing;
  p.spacing = plate.spacing;
  p.lower = {-width / 2, -height / 2};
  p.upper = {width / 2, height / 2};
  p.cracks = {{{-a, 0}, {a, 0}}};
}

packings::RandomParameters<2> random_parameters(const CrackedPlate &plate)
{
  packings::RandomParameters<2> p;
  lay_out(plate, p);
  p.seed = plate.seed;
  p.size_ratio = plate.size_ratio;
  return p;
}

packings::LatticeParameters<2> lattice_parameters(const CrackedPlate &plate)
{
  packings::LatticeParameters<2> p;
  lay_out(plate, p);
  p.kind = packings::lattice_kind(plate.packing);
  p.orientation[0] = plate.angle * M_PI / 180;
  return p;
}

/// Half the distance between the two tips, each midway between the last cut and the first intact
/// of the faces that the plane y = 0 crosses.
double half_length(const packings::Packing<2> &packing)
{
  double sum = 0;
  for (const int side : {-1, 1}) {
    double last = 0, first = width;
    for (const auto &face : packing.faces) {
      const double on_plane = 1e-9 * packing.spacing; // counts as above, as cracks have it
      const double x = side * (packing.centre[0][face.i] + face.lever_i[0]);
      if ((packing.centre[1][face.i] < -on_plane) == (packing.centre[1][face.j] < -on_plane))
        continue;
      if (face.cracked)
        last = std::max(last, x);
      else if (x > 0)
        first = std::min(first, x);
    }
    sum += (last + first) / 4;
  }
  return sum;
}

/// Largest load in N until it has fallen to half.
double peak_load(packings::Packing<2> packing, const dem::DemMaterial &glass,
                 const dem::FractureLaw &law)
{
  particles::Particles<2> state;
  packings::fill_particles(packing, density, state);
  auto owned = std::make_unique<dem::ManyBodyForce<2>>(std::move(packing), glass,
                                                       dem::grips<2>(6.6e-3, 0.4e-3), law);
  const auto &force = *owned;
  const double dt = 0.9 * force.stable_step(state);
  particles::ParticleSolver<2> plate(std::move(state), std::move(owned));
  plate.compute_forces(0);
  double peak = 0;
  for (double time = dt; time < 5e-3; time += dt) {
    plate.kick(dt);
    plate.drift(dt);
    plate.compute_forces(time);
    const double load = (force.reaction(1)[1] - force.reaction(0)[1]) / 2;
    keep_largest(peak, load);
    if (load < peak / 2 && !force.broken_bonds().empty())
      return peak;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// K_c/K_Ic.
double relative_toughness(const CrackedPlate &plate)
{
  const dem::DemMaterial glass{72e9, plate.poissons_ratio, density, plate.plane, 0};
  packings::Packing<2> packing;
  double c = 0;
  if (plate.packing == "random") {
    const auto p = random_parameters(plate);
    packing = packings::make_random_packing<2>(p).packing;
    c = dem::calibrate_toughness<2>(p, glass, plate.criterion);
  } else {
    const auto p = lattice_parameters(plate);
    packing = packings::make_lattice_packing<2>(p);
    c = dem::calibrate_toughness<2>(p.kind, p.orientation, glass, plate.criterion);
  }
  const double a = half_length(packing);
  const double stress = peak_load(std::move(packing), glass,
                                  {plate.criterion,
                                   c * toughness / std::sqrt(plate.spacing),
                                   {},
                                   dem::PrincipalTension<2>::whole_face(plate.spacing)}) /
                        width;
  return stress * std::sqrt(M_PI * a / std::cos(M_PI * a / width)) / toughness;
}

/// Least, largest, mean and standard deviation over some plates. Of ten random ones that scatter as
/// they may one lies 2.5 standard deviations off the mean.
std::vector<Result> spread(const std::string &name, const std::vector<CrackedPlate> &plates)
{
  std::vector<double> k;
  for (const auto &plate : plates)
    k.push_back(relative_toughness(plate));
  const auto [least, largest] = std::minmax_element(k.begin(), k.end());
  double sum = 0, squares = 0;
  for (const double one : k)
    sum += one, squares += one * one;
  const double n = double(k.size()), mean = sum / n;
  const bool random = std::all_of(plates.begin(), plates.end(),
                                  [](const auto &plate) { return plate.packing == "random"; });
  const double must = random ? 0.1 : 0.05, aim = random ? 0.05 : 0.02;
  return {{name + "/least", *least, 1 - must, 1 - aim, Result::Bound::at_least},
          {name + "/largest", *largest, 1 + must, 1 + aim},
          {name + "/off_the_mean", std::abs(mean - 1), 0.03, 0.02},
          {name + "/standard_deviation", std::sqrt(std::max(squares / n - mean * mean, 0.)), 0.04,
           0.02}};
}

CrackedPlate turned(const std::string &lattice, double degrees, double tip = 0)
{
  CrackedPlate plate;
  plate.packing = lattice;
  plate.angle = degrees;
  plate.tip = tip;
  return plate;
}

CrackedPlate random_plate(int seed, double size_ratio = 1)
{
  CrackedPlate plate;
  plate.packing = "random";
  plate.seed = seed;
  plate.size_ratio = size_ratio;
  return plate;
}

std::vector<CrackedPlate> turned_plates(const std::string &lattice, double last, double step)
{
  std::vector<CrackedPlate> plates;
  for (double angle = 0; angle <= last; angle += step)
    for (const double tip : {0., 1 / 3., 2 / 3.})
      plates.push_back(turned(lattice, angle, tip));
  return plates;
}

std::vector<CrackedPlate> random_plates(double size_ratio)
{
  std::vector<CrackedPlate> plates;
  for (int seed = 101; seed <= 110; ++seed)
    plates.push_back(random_plate(seed, size_ratio));
  return plates;
}

std::vector<CrackedPlate> plates_of_poissons_ratios()
{
  std::vector<CrackedPlate> plates;
  for (const PlaneMode plane : {PlaneMode::strain, PlaneMode::stress})
    for (const double nu : {0.1, 0.3, 0.45})
      for (CrackedPlate plate : {turned("hexagonal", 20), random_plate(101)}) {
        plate.poissons_ratio = nu;
        plate.plane = plane;
        plates.push_back(plate);
      }
  return plates;
}

/// With particles of twice the size: some seconds.
std::vector<CrackedPlate> coarse_plates()
{
  std::vector<CrackedPlate> plates = {turned("hexagonal", 15), random_plate(201)};
  for (CrackedPlate &plate : plates)
    plate.spacing = 1e-3;
  return plates;
}

/// The same criterion on turned and random packings, a/d = 10.
std::vector<CrackedPlate> plates_of(dem::FractureLaw::Criterion criterion)
{
  std::vector<CrackedPlate> plates;
  for (const double degrees : {0, 10, 20, 30})
    plates.push_back(turned("hexagonal", degrees));
  for (int seed = 201; seed <= 204; ++seed)
    plates.push_back(random_plate(seed));
  for (CrackedPlate &plate : plates) {
    plate.spacing = 1e-3;
    plate.criterion = criterion;
  }
  return plates;
}

Case plates_case(const std::string &name, const std::string &text, bool slow,
                 std::function<std::vector<CrackedPlate>()> plates)
{
  return {name, "K_c over K_Ic of a breaking plate: " + text, slow,
          [=] { return spread(name, plates()); }};
}

Case criterion_case(const std::string &word, dem::FractureLaw::Criterion criterion)
{
  const std::string name = "law_toughness_" + word;
  return {name, "K_c over K_Ic of breaking plates by " + word + ", a/d = 10", true,
          [=] { return spread(name, plates_of(criterion)); }};
}
} // namespace

std::vector<Case> toughness_cases()
{
  return {
      plates_case("toughness_coarse", "a turned and a random packing, a/d = 10", false,
                  coarse_plates),
      plates_case("toughness_hexagonal", "hexagonal, 0 to 30 degrees, three tips each", true,
                  [] { return turned_plates("hexagonal", 30, 5); }),
      plates_case("toughness_square", "square, 0 to 45 degrees, three tips each", true,
                  [] { return turned_plates("square", 45, 15); }),
      plates_case("toughness_random_1", "random, ten seeds", true, [] { return random_plates(1); }),
      plates_case("toughness_random_2", "random, radii 1 to 2, ten seeds", true,
                  [] { return random_plates(2); }),
      plates_case("toughness_random_5", "random, radii 1 to 5, ten seeds", true,
                  [] { return random_plates(5); }),
      criterion_case("maximum_tension", dem::FractureLaw::Criterion::maximum_tension),
      criterion_case("principal_stress", dem::FractureLaw::Criterion::principal_stress),
      criterion_case("energy", dem::FractureLaw::Criterion::energy),
      plates_case("toughness_poisson", "nu 0.1 to 0.45, plane strain and stress", true,
                  plates_of_poissons_ratios),
  };
}
} // namespace ligament::program
