#include "md/cauchy_born_law.h"

#include <cmath>

namespace ligament::md
{
namespace
{
/// Value at x + by less that at x, the value there known: over a short way with all its digits,
/// over a long one in one look at the table.
double change(const Spline &spline, double x, double by, double from, double to)
{
  return std::abs(by) < 4 * spline.step() ? spline.change(x, by) : to - from;
}
} // namespace

template <int dim>
CauchyBornLaw<dim>::CauchyBornLaw(const Crystal<dim> &crystal) : crystal_(crystal)
{
  const Potential &p = crystal_.potential();
  const int s = crystal_.parameters().species;
  for (const auto &bond : crystal_.half_bonds()) {
    const BondJets jets = p.bond(s, s, bond.norm());
    bonds_.push_back({bond, bond.norm(), jets.pair.value, jets.density_at_i.value});
  }
}

template <int dim>
double CauchyBornLaw<dim>::evaluate(const Matrix<dim> &gradient, Matrix<dim> &stress) const
{
  const Matrix<dim> f = crystal_.deformation(gradient);
  const Potential &p = crystal_.potential();
  const int s = crystal_.parameters().species;
  const Spline &pair = p.pair_spline(s, s);
  const Spline *density = p.has_embedding() ? &p.density_spline(s, s) : nullptr;
  double energy = 0, denser = 0;
  Matrix<dim> growth = Matrix<dim>::Zero();
  stress.setZero();
  for (const HalfBond &b : bonds_) {
    const Vector<dim> moved = gradient * b.reference, x = f * b.reference;
    const double r = x.norm(), longer = moved.dot(2 * b.reference + moved) / (r + b.length);
    if (b.length >= p.cutoff() && r >= p.cutoff())
      continue;
    const Jet phi = pair(r);
    energy += change(pair, b.length, longer, b.pair, phi.value);
    stress += phi.slope / r * x * b.reference.transpose();
    if (density) {
      const Jet rho = (*density)(r);
      denser += 2 * change(*density, b.length, longer, b.density, rho.value);
      growth += 2 * rho.slope / r * x * b.reference.transpose();
    }
  }
  if (density) {
    const Spline &embedding = p.embedding_spline(s);
    const double rest = crystal_.density_of_neighbours();
    const Jet now = embedding(rest + denser);
    energy += change(embedding, rest, denser, embedding(rest).value, now.value);
    stress += now.slope * growth;
  }
  stress /= crystal_.volume();
  return energy / crystal_.volume();
}

template class CauchyBornLaw<2>;
template class CauchyBornLaw<3>;
} // namespace ligament::md
