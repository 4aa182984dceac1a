// Homogeneous deformation of the crystal: energy, stress, moduli, and what follows from them.
#include "core/check.h"
#include "md/crystal.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace ligament::md
{
namespace
{
/// Components of a symmetric tensor in Voigt order.
template <int dim>
std::pair<int, int> voigt(int k)
{
  static constexpr int first[] = {0, 1, 2, 1, 0, 0}, second[] = {0, 1, 2, 2, 2, 1};
  return dim == 2 ? std::pair(k == 1 ? 1 : 0, k == 0 ? 0 : 1) : std::pair(first[k], second[k]);
}

/// The symmetric part of A in both pairs of components.
template <int dim>
Stiffness<dim> stiffness_of(const Moduli<dim> &a)
{
  Stiffness<dim> c;
  const auto at = [](int i, int j) { return i * dim + j; };
  for (int p = 0; p < n_strains<dim>; ++p)
    for (int q = 0; q < n_strains<dim>; ++q) {
      const auto [i, j] = voigt<dim>(p);
      const auto [k, l] = voigt<dim>(q);
      c(p, q) = (a(at(i, j), at(k, l)) + a(at(j, i), at(k, l)) + a(at(i, j), at(l, k)) +
                 a(at(j, i), at(l, k))) /
                4;
    }
  return c;
}

/// Squares of the wave speeds times the density, ascending, of waves along n.
template <int dim>
Vector<dim> acoustic(const Moduli<dim> &a, const Vector<dim> &n)
{
  Matrix<dim> tensor = Matrix<dim>::Zero();
  for (int i = 0; i < dim; ++i)
    for (int k = 0; k < dim; ++k)
      for (int j = 0; j < dim; ++j)
        for (int l = 0; l < dim; ++l)
          tensor(i, k) += a(i * dim + j, k * dim + l) * n[j] * n[l];
  return Eigen::SelfAdjointEigenSolver<Matrix<dim>>(tensor, Eigen::EigenvaluesOnly).eigenvalues();
}

/// Directions of high symmetry, in crystal axes.
template <int dim>
std::vector<Vector<dim>> symmetry_directions()
{
  if constexpr (dim == 2)
    return {{1, 0}, {0, 1}};
  else
    return {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
}

/// Largest number that divides all of these, by Euclid's way; numbers below `zero` are none.
double common_divisor(double a, double b, double zero)
{
  while (b > zero) {
    const double rest = std::abs(a - std::round(a / b) * b);
    a = b;
    b = rest;
  }
  return a;
}
} // namespace

template <int dim>
Matrix<dim> Crystal<dim>::deformation(const Matrix<dim> &gradient) const
{
  const Matrix<dim> f = Matrix<dim>::Identity() + gradient, c = f.transpose() * f;
  // Most deformations are small: a bound by the norm settles them.
  if ((c - Matrix<dim>::Identity()).norm() < 0.3)
    return f;
  const double least =
      Eigen::SelfAdjointEigenSolver<Matrix<dim>>(c, Eigen::EigenvaluesOnly).eigenvalues()[0];
  core::require<core::GuardStop>(f.determinant() > 0 && least >= 0.64,
                                 "a crystal is compressed by more than a fifth: its far field no "
                                 "longer knows its bonds; load it less");
  return f;
}

template <int dim>
double Crystal<dim>::energy_density(const Matrix<dim> &gradient) const
{
  const Matrix<dim> f = deformation(gradient);
  const int s = parameters_.species;
  double energy = 0, density_change = 0;
  for (const auto &bond : half_bonds_) {
    const Vector<dim> moved = gradient * bond;
    const double r = bond.norm(), longer = moved.dot(2 * bond + moved) / ((f * bond).norm() + r);
    energy += potential_.pair_spline(s, s).change(r, longer);
    if (potential_.has_embedding())
      density_change += 2 * potential_.density_spline(s, s).change(r, longer);
  }
  if (potential_.has_embedding())
    energy += potential_.embedding_spline(s).change(density_, density_change);
  return energy / volume_;
}

template <int dim>
Matrix<dim> Crystal<dim>::stress(const Matrix<dim> &gradient) const
{
  const Matrix<dim> f = deformation(gradient);
  const int s = parameters_.species;
  Matrix<dim> pairs = Matrix<dim>::Zero(), growth = Matrix<dim>::Zero();
  double density = 0;
  for (const auto &bond : half_bonds_) {
    const Vector<dim> x = f * bond;
    const double r = x.norm();
    const BondJets jets = potential_.bond(s, s, r);
    pairs += jets.pair.slope / r * x * bond.transpose();
    growth += 2 * jets.density_at_i.slope / r * x * bond.transpose();
    density += 2 * jets.density_at_i.value;
  }
  return (pairs + potential_.embedding(s, density).slope * growth) / volume_;
}

template <int dim>
Moduli<dim> Crystal<dim>::moduli(const Matrix<dim> &gradient) const
{
  const Matrix<dim> f = deformation(gradient);
  const int s = parameters_.species;
  double density = 0;
  for (const auto &bond : half_bonds_)
    density += 2 * potential_.bond(s, s, (f * bond).norm()).density_at_i.value;
  const Jet embedding = potential_.embedding(s, density);
  Moduli<dim> a = Moduli<dim>::Zero();
  Eigen::Matrix<double, dim * dim, 1> growth;
  growth.setZero();
  for (const auto &bond : half_bonds_) {
    const Vector<dim> x = f * bond, n = x.normalized();
    const double r = x.norm();
    const BondJets jets = potential_.bond(s, s, r);
    const double across = (jets.pair.slope + 2 * embedding.slope * jets.density_at_i.slope) / r,
                 along = jets.pair.curvature + 2 * embedding.slope * jets.density_at_i.curvature;
    const Matrix<dim> k = (along - across) * n * n.transpose() + across * Matrix<dim>::Identity();
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) {
        growth[i * dim + j] += 2 * jets.density_at_i.slope * n[i] * bond[j];
        for (int m = 0; m < dim; ++m)
          for (int l = 0; l < dim; ++l)
            a(i * dim + j, m * dim + l) += k(i, m) * bond[j] * bond[l];
      }
  }
  return (a + embedding.curvature * growth * growth.transpose()) / volume_;
}

template <int dim>
particles::ElasticConstants<dim> Crystal<dim>::elastic_constants() const
{
  const Moduli<dim> a = moduli(Matrix<dim>::Zero());
  particles::ElasticConstants<dim> constants;
  Moduli<dim> without_stress = a; // (C23)
  if (parameters_.lattice_parameter > 0) {
    const Matrix<dim> sigma = stress(Matrix<dim>::Zero());
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        for (int l = 0; l < dim; ++l)
          without_stress(i * dim + j, i * dim + l) -= sigma(j, l);
    for (int p = 0; p < n_strains<dim>; ++p) {
      const auto [i, j] = voigt<dim>(p);
      constants.stress[p] = (sigma(i, j) + sigma(j, i)) / 2;
    }
  }
  const auto &c = constants.stiffness = stiffness_of<dim>(without_stress);
  constants.density = mass_density();
  // Voigt's average keeps both linear invariants of C. In 2D: plane strain of the same E and nu.
  double bulk = 0, trace = 0; // C_iijj, C_ijij
  for (int p = 0; p < n_strains<dim>; ++p) {
    trace += p < dim ? c(p, p) : 2 * c(p, p);
    for (int q = 0; p < dim && q < dim; ++q)
      bulk += c(p, q);
  }
  const double shear = (trace - bulk / dim) / (dim * (dim + 1) - 2),
               lambda = (bulk - 2 * dim * shear) / (dim * dim);
  constants.poissons_ratio = lambda / (2 * (lambda + shear));
  constants.youngs_modulus = 2 * shear * (1 + constants.poissons_ratio);
  double fastest = 0, slowest = 1e300;
  for (const Vector<dim> &direction : symmetry_directions<dim>()) {
    const Vector<dim> values = acoustic<dim>(a, (parameters_.orientation * direction).normalized());
    fastest = std::max(fastest, values[dim - 1]);
    slowest = std::min(slowest, values[0]);
  }
  constants.wave_speed_p = std::sqrt(fastest / constants.density);
  constants.wave_speed_s = std::sqrt(std::max(0., slowest) / constants.density);
  return constants;
}

// Layer after layer from the surface down: an atom loses the bonds that would end above it.
template <int dim>
double Crystal<dim>::surface_energy(const Vector<dim> &normal) const
{
  core::require(normal.norm() > 0, "a surface needs a direction");
  const Vector<dim> n = (parameters_.orientation * normal).normalized();
  const int s = parameters_.species;
  double layer = 0; // between layers, m
  for (int c = 0; c < dim; ++c)
    layer = common_divisor(std::max(layer, std::abs(basis_.col(c).dot(n))),
                           std::min(layer, std::abs(basis_.col(c).dot(n))), 1e-6 * spacing());
  double energy = 0;
  for (int k = 0; k * layer < potential_.cutoff(); ++k) {
    double pairs = 0, density = density_;
    for (const auto &bond : half_bonds_)
      if (std::abs(bond.dot(n)) > (k + 0.5) * layer) { // it or its opposite
        const BondJets jets = potential_.bond(s, s, bond.norm());
        pairs -= 0.5 * jets.pair.value;
        density -= jets.density_at_i.value;
      }
    energy +=
        pairs + potential_.embedding(s, density).value - potential_.embedding(s, density_).value;
  }
  return energy * layer / volume_;
}

template Matrix<2> Crystal<2>::deformation(const Matrix<2> &) const;
template Matrix<3> Crystal<3>::deformation(const Matrix<3> &) const;
template double Crystal<2>::energy_density(const Matrix<2> &) const;
template double Crystal<3>::energy_density(const Matrix<3> &) const;
template Matrix<2> Crystal<2>::stress(const Matrix<2> &) const;
template Matrix<3> Crystal<3>::stress(const Matrix<3> &) const;
template Moduli<2> Crystal<2>::moduli(const Matrix<2> &) const;
template Moduli<3> Crystal<3>::moduli(const Matrix<3> &) const;
template particles::ElasticConstants<2> Crystal<2>::elastic_constants() const;
template particles::ElasticConstants<3> Crystal<3>::elastic_constants() const;
template double Crystal<2>::surface_energy(const Vector<2> &) const;
template double Crystal<3>::surface_energy(const Vector<3> &) const;
} // namespace ligament::md
