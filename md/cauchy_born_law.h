// The crystal as a continuum under finite strain.
#pragma once

#include "core/hyperelastic_law.h"
#include "md/crystal.h"

namespace ligament::md
{
/// theory.md (M4) and (M5): W and P of Crystal in one go, for cells that ask often.
template <int dim>
class CauchyBornLaw : public core::HyperelasticLaw<dim>
{
public:
  explicit CauchyBornLaw(const Crystal<dim> &crystal);
  double evaluate(const Matrix<dim> &gradient, Matrix<dim> &stress) const override;

private:
  struct HalfBond
  {
    Vector<dim> reference;        // m
    double length, pair, density; // m, J, unit of the potential: at rest
  };

  Crystal<dim> crystal_;
  std::vector<HalfBond> bonds_;
};
} // namespace ligament::md
