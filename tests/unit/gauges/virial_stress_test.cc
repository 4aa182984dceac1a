// The mean virial stress of atoms: against the crystal's own, the slope of their energy under
// strain, and the flux of momentum written down plainly.
#include "src/simulation/gauges/gauge_set.h"
#include "tests/support/atom_bodies.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
constexpr double epsilon = std::numeric_limits<double>::epsilon();

template <int dim>
using Tensor = Eigen::Matrix<double, dim, dim>;

template <int dim>
Tensor<dim> read_tensor(const Scene &scene, const CoupledBody<dim> &body)
{
  const auto v = GaugeSet<dim>(scene, body).read(body, 0);
  Tensor<dim> t;
  if constexpr (dim == 2)
    t << v[0], v[2], v[2], v[1];
  else
    t << v[0], v[5], v[4], v[5], v[1], v[3], v[4], v[3], v[2];
  return t;
}

template <int dim>
Tensor<dim> some_gradient()
{
  Tensor<dim> g;
  if constexpr (dim == 2)
    g << 0.02, 0.03, -0.01, -0.015;
  else
    g << 0.02, 0.03, 0, -0.01, -0.015, 0, 0.01, 0, 0; // z repeats itself
  return g;
}

/// By how much rounding may change a component of the stress of an atom of the crystal under this
/// deformation. Places have coordinates up to `size` and displacements below that: a bond, a
/// difference of two sums of both, is off by 4 epsilon size per component at most. Through it so
/// are the density, the tension t = phi' + 2 F' f' and the product t n (x) r; of the functions
/// themselves, the tens of terms and their sums, 64 epsilon is taken of every term's size.
template <int dim>
double rounding_of_stress(const md::Crystal<dim> &crystal, const Tensor<dim> &gradient, double size)
{
  const md::Potential &p = crystal.potential();
  const Tensor<dim> f = Tensor<dim>::Identity() + gradient;
  const double shift = 4 * std::sqrt(double(dim)) * epsilon * size;
  double density = 0, slopes = 0;
  for (const auto &half : crystal.half_bonds()) {
    const auto jets = p.bond(0, 0, (f * half).norm());
    density += 2 * jets.density_at_i.value;
    slopes += 2 * std::abs(jets.density_at_i.slope);
  }
  const md::Jet embedding = p.embedding(0, density);
  double error = 0;
  for (const auto &half : crystal.half_bonds()) {
    const double r = (f * half).norm();
    const auto jets = p.bond(0, 0, r);
    const double density_error = slopes * shift + 64 * epsilon * density,
                 tension = std::abs(jets.pair.slope) +
                           2 * std::abs(embedding.slope * jets.density_at_i.slope),
                 stiffness = std::abs(jets.pair.curvature) +
                             2 * std::abs(embedding.slope * jets.density_at_i.curvature);
    error += r * (stiffness * shift +
                  2 * std::abs(embedding.curvature * jets.density_at_i.slope) * density_error +
                  64 * epsilon * tension) +
             2 * tension * shift;
  }
  return error / crystal.volume();
}

template <int dim>
void expect_crystals_own(const std::string &text, const std::vector<std::string> &overrides)
{
  AtomsOfScene<dim> unit(text, overrides);
  const Tensor<dim> gradient = some_gradient<dim>();
  unit.impose([&](const Vector<dim> &x) { return Vector<dim>(gradient * x); });
  const auto crystal = crystal_of<dim>(unit.scene);
  const Tensor<dim> f = Tensor<dim>::Identity() + gradient;
  const Tensor<dim> expected = crystal.stress(gradient) * f.transpose() / f.determinant();
  const double size =
      *std::max_element(unit.scene.specimen.size.begin(), unit.scene.specimen.size.begin() + dim);
  const double error = rounding_of_stress<dim>(crystal, gradient, size);
  EXPECT_LT(error, 1e-9 * expected.cwiseAbs().maxCoeff()); // so that the bound says something
  const Tensor<dim> stress = read_tensor<dim>(unit.scene, unit.body);
  EXPECT_LE((stress - expected).cwiseAbs().maxCoeff(), error);
}

TEST(VirialStress, OfHomogeneousStrainIsThatOfTheCrystal)
{
  const std::string whole = R"(/gauges=[{"name": "s", "kind": "virial_stress"}])";
  expect_crystals_own<2>(plane_of_atoms, in_a_mesh({whole}));
  // A body alone has surfaces: the box keeps off them by the range, 0.85 nm, or by twice that, 1.2
  // nm, since the embedding of neighbours enters.
  expect_crystals_own<2>(plane_of_atoms, {R"(/gauges=[{"name": "s", "kind": "virial_stress",
                           "lower": ["-9 nm", "-8 nm"], "upper": ["3 nm", "9 nm"]}])"});
  expect_crystals_own<3>(copper_bar, {R"(/gauges=[{"name": "s", "kind": "virial_stress",
                           "lower": ["-2 nm", "-1.4 nm", null], "upper": ["2 nm", "1.3 nm", null]}])"});
}

TEST(VirialStress, OfABoxInItsOwnAxes)
{
  AtomsOfScene<2> unit(
      plane_of_atoms,
      {R"(/gauges=[{"name": "s", "kind": "virial_stress", "lower": ["-9 nm", "-8 nm"],
                    "upper": ["3 nm", "9 nm"]},
                   {"name": "t", "kind": "virial_stress", "lower": ["-9 nm", "-8 nm"],
                    "upper": ["3 nm", "9 nm"], "angle": "90 deg"}])"});
  const Tensor<2> gradient = some_gradient<2>();
  unit.impose([&](const Vector<2> &x) { return Vector<2>(gradient * x); });
  const auto v = GaugeSet<2>(unit.scene, unit.body).read(unit.body, 0);
  const double scale = std::abs(v[0]) + std::abs(v[1]);
  EXPECT_NEAR(v[3], v[1], 8 * epsilon * scale);
  EXPECT_NEAR(v[4], v[0], 8 * epsilon * scale);
  EXPECT_NEAR(v[5], -v[2], 8 * epsilon * scale);
}

/// Of the affine motion that fits places and values best, by orthogonal columns.
template <int dim>
Eigen::Matrix<double, dim + 1, dim> fit(const Eigen::MatrixXd &places,
                                        const Eigen::MatrixXd &values)
{
  Eigen::MatrixXd columns(places.rows(), dim + 1);
  columns << Eigen::VectorXd::Ones(places.rows()), places;
  return columns.colPivHouseholderQr().solve(values);
}

template <int dim>
Eigen::MatrixXd rows_of(const Components<dim> &components)
{
  Eigen::MatrixXd rows(components[0].size(), int(dim));
  for (int c = 0; c < dim; ++c)
    rows.col(c) = Eigen::Map<const Eigen::VectorXd>(components[c].data(), rows.rows());
  return rows;
}

// All atoms: x -> x + s E x changes the energy by V sigma : E, whatever the atoms look like,
// surfaces and a crack among them; V is their volume after the motion that fits them.
template <int dim>
void expect_slope_of_energy(const std::string &text, const std::vector<std::string> &overrides)
{
  AtomsOfScene<dim> unit(text, overrides);
  auto &atoms = unit.atoms();
  const double d = unit.scene.zone.spacing;
  const Tensor<dim> gradient = some_gradient<dim>();
  unit.impose([&](const Vector<dim> &x) { return Vector<dim>(gradient * x); });
  unit.shake(0.04 * d, 5);
  const Components<dim> shaken = atoms.displacement;
  const Eigen::MatrixXd scaled = rows_of<dim>(atoms.reference) / d;
  const auto motion = fit<dim>(scaled, rows_of<dim>(shaken) / d);
  const Tensor<dim> grown =
      Tensor<dim>::Identity() + Tensor<dim>(motion.template bottomRows<dim>().transpose());
  double volume = 0;
  for (const double v : atoms.volume)
    volume += v;
  volume *= grown.determinant();
  const Tensor<dim> stress = read_tensor<dim>(unit.scene, unit.body);
  const double n = atoms.size(), depth = std::abs(crystal_of<dim>(unit.scene).cohesive_energy());
  for (int i = 0; i < 2; ++i) // z repeats itself
    for (int j = 0; j <= i; ++j) {
      const auto energy = [&](double s) {
        for (int k = 0; k < atoms.size(); ++k) {
          const Vector<dim> u = get(shaken, k), x = get(atoms.reference, k) + u;
          Vector<dim> moved = u;
          moved[i] += s * x[j];
          set<dim>(atoms.displacement, k, moved);
        }
        return unit.body.force()->potential_energy(atoms);
      };
      const double step = 1e-4;
      const auto slope = [&](double s) { return (energy(s) - energy(-s)) / (2 * s); };
      const double fine = slope(step), coarse = slope(2 * step);
      // The error of a difference goes with the square of the step, or, where bonds pass knots,
      // with a lower power: it is below what halving the step changes. Rounding: tens of terms per
      // atom, whose sizes are some depths.
      const double rounding = 100 * epsilon * n * depth / step;
      EXPECT_LT(rounding + std::abs(fine - coarse), 1e-3 * volume * stress.norm());
      EXPECT_NEAR(volume * stress(i, j), fine, std::abs(fine - coarse) + rounding);
    }
}

TEST(VirialStress, IsTheSlopeOfTheEnergyUnderStrain)
{
  const std::string whole = R"(/gauges=[{"name": "s", "kind": "virial_stress"}])";
  expect_slope_of_energy<2>(
      plane_of_atoms,
      {whole, R"(/specimen/cracks=[{"points": [["-5 nm", 0], ["4 nm", "1 nm"]]}])"});
  expect_slope_of_energy<3>(copper_bar, {whole});
}

// Heat: a run of a body at a temperature differs by the atoms' momentum alone.
TEST(VirialStress, CountsTheMomentumOfHeat)
{
  AtomsOfScene<2> unit(plane_of_atoms, {R"(/gauges=[{"name": "s", "kind": "virial_stress"}])"});
  auto &atoms = unit.atoms();
  Scene warm = unit.scene;
  warm.atoms->temperature = 10;
  const Tensor<2> still = read_tensor<2>(warm, unit.body);
  Tensor<2> rate;
  rate << 1e9, 3e8, -2e8, 5e8; // 1/s
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, 45); // m/s, argon at 10 K
  for (int i = 0; i < atoms.size(); ++i)
    set<2>(atoms.velocity, i,
           Vector<2>(Vector<2>(20, -30) + rate * get(atoms.reference, i) +
                     Vector<2>(normal(random), 0.5 * normal(random))));
  const Eigen::MatrixXd places = rows_of<2>(atoms.reference) / 1e-9, v = rows_of<2>(atoms.velocity);
  Eigen::MatrixXd columns(places.rows(), 3);
  columns << Eigen::VectorXd::Ones(places.rows()), places;
  const Eigen::MatrixXd heat = v - columns * fit<2>(places, v);
  const double n = atoms.size(), volume = atoms.volume[0] * n;
  const Tensor<2> flux = n / (n - 3) * atoms.mass[0] * heat.transpose() * heat / volume;
  const Tensor<2> moving = read_tensor<2>(warm, unit.body);
  // Of fits of thousands of numbers up to 30 times as large.
  EXPECT_LT((still - flux - moving).cwiseAbs().maxCoeff(), 1e-11 * flux.norm());
  EXPECT_EQ(read_tensor<2>(unit.scene, unit.body), still); // without a temperature
}
} // namespace
