// The crystal as a continuum under finite strain.
#pragma once

#include "core/hyperelastic_law.h"
#include "md/crystal.h"
#include "md/pair_table.h"

namespace ligament::md
{
/// theory.md (M4) and (M5), W and P of Crystal, for cells that ask in every step.
template <int dim>
class CauchyBornLaw : public core::HyperelasticLaw<dim>
{
public:
  explicit CauchyBornLaw(const Crystal<dim> &crystal);

  double energy_density(const Matrix<dim> &gradient) const override
  {
    return crystal_.energy_density(gradient);
  }
  Matrix<dim> stress(const Matrix<dim> &gradient) const override;

private:
  Crystal<dim> crystal_;
  std::vector<PairPiece> table_;
  double cutoff2_, inverse_step_; // m^2, 1/m
};
} // namespace ligament::md
