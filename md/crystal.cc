#include "md/crystal.h"

#include "core/check.h"

#include <Eigen/Dense>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::md
{
namespace
{
/// So many cut-offs long are the bonds that are kept: they may come into range.
constexpr double kept_reach = 1.25;

std::string name_of(CrystalKind kind)
{
  return kind == CrystalKind::triangular ? "triangular" : kind == CrystalKind::fcc ? "fcc" : "bcc";
}

template <int dim>
const CrystalParameters<dim> &checked(const CrystalParameters<dim> &p, const Potential &potential)
{
  core::require((dim == 2) == (p.kind == CrystalKind::triangular),
                fmt::format("a {} lattice has not {} dimensions: 2D crystals are triangular, 3D "
                            "ones fcc or bcc; choose another kind",
                            name_of(p.kind), dim));
  const Matrix<dim> &q = p.orientation;
  core::require((q.transpose() * q - Matrix<dim>::Identity()).cwiseAbs().maxCoeff() < 1e-12 &&
                    q.determinant() > 0,
                "the orientation of a crystal is no rotation: its columns must be perpendicular "
                "unit vectors, counter-clockwise; give others");
  core::require(p.thickness > 0, "the thickness of a plane crystal must be above 0");
  core::require(p.species >= 0 && p.species < potential.n_species(),
                "a crystal of a species that the potential has not");
  return p;
}

/// Lattice vectors up to `reach`, half of them: those whose last index that is not 0 is above 0.
template <int dim>
std::vector<Vector<dim>> lattice_vectors(const Matrix<dim> &basis, double reach)
{
  const Matrix<dim> inverse = basis.inverse();
  Eigen::Matrix<int, dim, 1> most;
  for (int c = 0; c < dim; ++c)
    most[c] = int(inverse.row(c).norm() * reach) + 1;
  std::vector<std::pair<long, Vector<dim>>> found; // by squared length, in steps far below any gap
  Eigen::Matrix<int, dim, 1> k = -most;
  while (k[dim - 1] <= most[dim - 1]) {
    int last = dim - 1;
    while (last >= 0 && k[last] == 0)
      --last;
    const Vector<dim> r = basis * k.template cast<double>();
    if (last >= 0 && k[last] > 0 && r.norm() <= reach)
      found.emplace_back(std::lround(1e6 * r.squaredNorm()), r);
    ++k[0];
    for (int c = 0; c + 1 < dim && k[c] > most[c]; ++c) {
      k[c] = -most[c];
      ++k[c + 1];
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto &a, const auto &b) { return a.first < b.first; });
  std::vector<Vector<dim>> vectors;
  for (const auto &[length, r] : found)
    vectors.push_back(r);
  return vectors;
}
} // namespace

CrystalKind crystal_kind(const std::string &name)
{
  for (const CrystalKind kind : {CrystalKind::triangular, CrystalKind::fcc, CrystalKind::bcc})
    if (name == name_of(kind))
      return kind;
  throw core::InputError("unknown crystal \"" + name +
                         "\": there are triangular, fcc and bcc; choose one of these");
}

Matrix<3> orientation_of(const Vector<3> &along_x, const Vector<3> &along_y)
{
  const Vector<3> x = along_x.normalized(), y = along_y.normalized();
  core::require(along_x.norm() > 0 && along_y.norm() > 0 && std::abs(x.dot(y)) < 1e-12,
                "the directions of a crystal along x and y are not perpendicular: give others");
  Matrix<3> turn;
  turn.row(0) = x;
  turn.row(1) = y;
  turn.row(2) = x.cross(y);
  return turn;
}

template <int dim>
Matrix<dim> Crystal<dim>::unit_basis() const
{
  Matrix<dim> b;
  if constexpr (dim == 2)
    b << 1, 0.5, 0, std::sqrt(3.) / 2;
  else if (parameters_.kind == CrystalKind::fcc)
    b << 0.5, 0, 0.5, 0.5, 0.5, 0, 0, 0.5, 0.5;
  else
    b << 0.5, -0.5, 0.5, 0.5, 0.5, -0.5, 0.5, 0.5, 0.5;
  return b;
}

template <int dim>
Jet Crystal<dim>::energy_of(double a, const Potential &potential) const
{
  const int s = parameters_.species;
  Jet sum;
  double density = 0, growth = 0;
  for (const auto &bond : half_bonds_) {
    const double r = a * bond.norm();
    const BondJets jets = potential.bond(s, s, r);
    sum.value += jets.pair.value;
    sum.slope += jets.pair.slope * r;
    density += 2 * jets.density_at_i.value;
    growth += 2 * jets.density_at_i.slope * r;
  }
  const Jet embedding = potential.embedding(s, density);
  sum.value += embedding.value;
  sum.slope += embedding.slope * growth;
  return sum;
}

// The lowest of the minima, or the one near what the file says; then the sign of the slope is
// bisected down to neighbouring numbers.
template <int dim>
double Crystal<dim>::find_lattice_parameter(const Potential &potential, int reach) const
{
  const Species &s = potential.species(parameters_.species);
  const double nearest = half_bonds_[0].norm();
  double from = potential.cutoff() / (reach * nearest), to = 0.99 * potential.cutoff() / nearest;
  const bool is_known = s.lattice_parameter > 0 && s.lattice == name_of(parameters_.kind);
  if (is_known) {
    from = std::max(from, 0.85 * s.lattice_parameter);
    to = std::min(to, 1.15 * s.lattice_parameter);
  }
  constexpr int n = 400;
  int best = 0;
  double lowest = 0;
  const auto place = [&](int k) { return from * std::pow(to / from, double(k) / n); };
  for (int k = 0; k <= n; ++k) {
    const double e = energy_of(place(k), potential).value;
    if (e < lowest) {
      lowest = e;
      best = k;
    }
  }
  if (lowest < 0 && best == 0 && !is_known)
    return 0;
  double lower = place(best - 1), upper = place(best + 1);
  const auto slope = [&](double a) { return energy_of(a, potential).slope; };
  core::require(lowest < 0 && best > 0 && best < n && slope(lower) < 0 && slope(upper) > 0,
                fmt::format("the potential of {} has no {} crystal without stress: no spacing "
                            "between {:.3g} and {:.3g} m has the least energy; choose another "
                            "lattice",
                            s.name, name_of(parameters_.kind), from * nearest, to * nearest));
  while (true) {
    const double middle = lower + (upper - lower) / 2;
    if (middle == lower || middle == upper)
      return std::abs(slope(lower)) < std::abs(slope(upper)) ? lower : upper;
    (slope(middle) < 0 ? lower : upper) = middle;
  }
}

template <int dim>
Crystal<dim>::Crystal(const Potential &potential, const CrystalParameters<dim> &parameters)
    : parameters_(checked(parameters, potential)), potential_(potential)
{
  const Matrix<dim> unit = parameters_.orientation * unit_basis();
  // The nearest neighbours come down to a fifth of the cut-off, as a rule.
  for (const int reach : {5, 12}) {
    half_bonds_ = lattice_vectors<dim>(unit, reach * unit.col(0).norm());
    lattice_parameter_ = find_lattice_parameter(potential, reach);
    if (lattice_parameter_ > 0)
      break;
  }
  core::require(lattice_parameter_ > 0,
                fmt::format("the cut-off of {:.3g} m is more than twelve spacings of the crystal "
                            "without stress; choose a shorter one",
                            potential.cutoff()));
  if (const double given = parameters_.lattice_parameter; given > 0) {
    core::require(std::abs(given / lattice_parameter_ - 1) < 0.1,
                  fmt::format("a lattice parameter of {:.4g} m is far from the {:.4g} m of the "
                              "crystal without stress; give one within a tenth of it",
                              given, lattice_parameter_));
    lattice_parameter_ = given;
  }
  const double a = lattice_parameter_;
  cohesive_energy_ = energy_of(a, potential).value;
  basis_ = a * unit;
  volume_ = basis_.determinant() * (dim == 2 ? parameters_.thickness : 1.);
  half_bonds_ = lattice_vectors<dim>(unit, kept_reach * potential.cutoff() / a);
  for (auto &bond : half_bonds_)
    bond *= a;
  const int s = parameters_.species, n = potential.n_species();
  std::vector<double> densities(n, 0.); // other species: in a crystal of the first one
  for (int b = 0; b < n; ++b)
    for (const auto &bond : half_bonds_)
      densities[b] += 2 * potential.bond(b, s, bond.norm()).density_at_i.value;
  density_ = densities[s];
  potential_ = potential.normal_form(densities);
}

template <int dim>
double Crystal<dim>::mass_density() const
{
  return potential_.species(parameters_.species).mass / volume_;
}

template class Crystal<2>;
template class Crystal<3>;
} // namespace ligament::md
