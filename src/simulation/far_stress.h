// Stress of the far field's material, from the gradient of its displacement.
#pragma once

#include "core/check.h"
#include "core/polar_rotation.h"
#include "coupling/fine_scale_split.h"
#include "src/simulation/coupled_body.h"
#include "src/simulation/gauges/small_strain.h"

namespace ligament::program
{
/// In Pa, Voigt order, space axes, from the displacement's gradient.
template <int dim>
class FarStress
{
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;

  /// Of a body that has a far field, as its cells are at present.
  explicit FarStress(const CoupledBody<dim> &body) : far_(*body.far)
  {
    const auto *split = dynamic_cast<const coupling::FineScaleSplit<dim> *>(body.coupler.get());
    if (split && split->regime() == coupling::Regime::nonlinear && body.force())
      law_ = body.force()->finite_strain_law();
  }

  /// Of cells under finite strain (theory.md eq. (C31)) it is Kirchhoff's stress of their law.
  /// Where they only turn with their material (eq. (F6)) it is that of the strain in their own
  /// axes, turned with them. Particles tell theirs likewise.
  Strain<dim> operator()(const Matrix &gradient) const
  {
    if (!far_.is_corotated())
      return far_.body().stiffness * small_strain<dim>(gradient);
    const Matrix f = Matrix::Identity() + gradient;
    if (law_)
      try {
        return numbers(law_->stress(gradient) * f.transpose());
      } catch (const core::GuardStop &) { // what the law doesn't know ends steps, not looks
      }
    const Matrix r = core::PolarRotation<dim>(f).matrix();
    const Strain<dim> s =
        far_.body().stiffness * small_strain<dim>(r.transpose() * f - Matrix::Identity());
    Matrix own;
    if constexpr (dim == 2)
      own << s[0], s[2], s[2], s[1];
    else
      own << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
    return numbers(r * own * r.transpose());
  }

private:
  static Strain<dim> numbers(const Matrix &t)
  {
    Strain<dim> stress;
    if constexpr (dim == 2)
      stress << t(0, 0), t(1, 1), t(0, 1);
    else
      stress << t(0, 0), t(1, 1), t(2, 2), t(1, 2), t(0, 2), t(0, 1);
    return stress;
  }

  const fem::FemSolver<dim> &far_;
  std::shared_ptr<const core::HyperelasticLaw<dim>> law_;
};
} // namespace ligament::program
