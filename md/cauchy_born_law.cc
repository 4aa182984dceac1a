#include "md/cauchy_born_law.h"

#include <cmath>

namespace ligament::md
{
template <int dim>
CauchyBornLaw<dim>::CauchyBornLaw(const Crystal<dim> &crystal)
    : crystal_(crystal), table_(make_pair_table(crystal.potential(), crystal.parameters().species,
                                                crystal.parameters().species)),
      cutoff2_(std::pow(crystal.potential().cutoff(), 2)),
      inverse_step_(double(table_.size() - 1) / crystal.potential().cutoff())
{
}

template <int dim>
Matrix<dim> CauchyBornLaw<dim>::stress(const Matrix<dim> &gradient) const
{
  const Matrix<dim> f = crystal_.deformation(gradient);
  const bool has_embedding = crystal_.potential().has_embedding();
  Matrix<dim> stress = Matrix<dim>::Zero(), growth = Matrix<dim>::Zero();
  double density = 0;
  for (const auto &bond : crystal_.half_bonds()) {
    const Vector<dim> x = f * bond;
    const double r2 = x.squaredNorm();
    if (r2 >= cutoff2_)
      continue;
    const double r = std::sqrt(r2), place = r * inverse_step_;
    const PairPiece &piece = table_[int(place)];
    const double t = place - int(place);
    const Matrix<dim> turned = x * bond.transpose() / r;
    stress -= (piece.pull[0] + t * (piece.pull[1] + t * piece.pull[2])) * turned;
    if (!has_embedding)
      continue;
    const auto &c = piece.density;
    density += 2 * (c[0] + t * (c[1] + t * (c[2] + t * c[3])));
    growth += 2 * inverse_step_ * (c[1] + t * (2 * c[2] + 3 * t * c[3])) * turned;
  }
  if (has_embedding)
    stress += crystal_.potential().embedding(crystal_.parameters().species, density).slope * growth;
  return stress / crystal_.volume();
}

template class CauchyBornLaw<2>;
template class CauchyBornLaw<3>;
} // namespace ligament::md
