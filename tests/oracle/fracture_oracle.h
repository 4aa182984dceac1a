// Criteria of fracture written down plainly, in the axes of the face and with tensors in space.
// They share nothing with the production code and serve to check it.
#pragma once

#include "core/types.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <cmath>
#include <string>

namespace ligament::oracle
{
/// Strengths in Pa, angles in rad.
struct Strengths
{
  std::string criterion;
  double tensile = 1, compressive = 1, cohesion = 1, friction_angle = 0;
  double poissons_ratio = 0.3;
  bool plane_strain = true; // 2D
};

/// Share of the strength that a stress takes, of the criterion by its name; the first dim axes are
/// those of the plane.
template <int dim>
double share_of(const Strengths &of, const Eigen::Matrix<double, dim, dim> &in_plane)
{
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  s.topLeftCorner<dim, dim>() = in_plane;
  if (dim == 2 && of.plane_strain)
    s(2, 2) = of.poissons_ratio * in_plane.trace();
  const double mean = s.trace() / 3;
  const double mises = std::sqrt(1.5 * (s - mean * Eigen::Matrix3d::Identity()).squaredNorm());
  const Eigen::Matrix<double, dim, 1> principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>>(in_plane).eigenvalues();
  const double first = principal[dim - 1], last = principal[0];
  if (of.criterion == "principal_stress")
    return first / of.tensile;
  if (of.criterion == "von_mises")
    return mises / of.tensile;
  if (of.criterion == "drucker_prager") {
    const double a = of.compressive / of.tensile;
    return (0.5 * (a + 1) * mises + 1.5 * (a - 1) * mean) / of.compressive;
  }
  if (of.criterion == "mohr_coulomb") {
    // The planes through the axis between the two: the steepest is the one where a circle touches.
    const double sine = std::sin(of.friction_angle), cosine = std::cos(of.friction_angle);
    const double radius = (first - last) / 2, centre = (first + last) / 2;
    return std::max((radius + centre * sine) / (of.cohesion * cosine), first / of.tensile);
  }
  // energy: strains times stresses, over those of a uniaxial tension
  const double nu = of.poissons_ratio;
  const Eigen::Matrix3d strain = (1 + nu) * s - nu * s.trace() * Eigen::Matrix3d::Identity();
  return std::sqrt(std::max(strain.cwiseProduct(s).sum(), 0.)) / of.tensile;
}

/// The same of a face under this traction; 0 where it isn't asked.
template <int dim>
double share_of_face(const Strengths &of, const Eigen::Matrix<double, dim, dim> &mean_stress,
                     const Vector<dim> &normal, const Vector<dim> &traction)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  Matrix axes =
      Eigen::HouseholderQR<Matrix>(normal * Vector<dim>::Unit(0).transpose()).householderQ();
  axes.col(0) = normal;
  Matrix stress = axes.transpose() * mean_stress * axes;
  stress.col(0) = axes.transpose() * traction;
  stress.row(0) = stress.col(0).transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(stress);
  const double first = solver.eigenvalues()[dim - 1], last = solver.eigenvalues()[0];
  const double sigma = stress(0, 0), tau = stress.col(0).tail(dim - 1).norm();
  const double cone = dim == 2 ? 0.577 : 0.4;
  const double value = share_of<dim>(of, stress);
  if (of.criterion == "principal_stress")
    return sigma > 0 && std::abs(solver.eigenvectors()(0, dim - 1)) >= cone ? value : 0;
  if (of.criterion == "energy" && sigma <= 0)
    return 0;
  const double freed = sigma > 0 ? std::hypot(sigma, tau) : tau;
  const double reference =
      of.criterion == "mohr_coulomb"
          ? std::min(of.tensile, 2 * of.cohesion * std::cos(of.friction_angle) /
                                     (1 + std::sin(of.friction_angle)))
          : of.tensile;
  if (freed < cone * std::max(first, (first - last) / 2) || freed < cone / 2 * value * reference)
    return 0;
  return value;
}
} // namespace ligament::oracle
