// The perfect crystal of a potential: generated, not read. Its lattice parameter is the one without
// stress, its potential is brought to normal form, its elastic constants follow from both.
#pragma once

#include "md/potential.h"
#include "particles/particle_force.h"

namespace ligament::md
{
enum class CrystalKind
{
  triangular, // 2D
  fcc,
  bcc
};

/// Reads "triangular", "fcc" or "bcc"; throws core::InputError on others.
CrystalKind crystal_kind(const std::string &name);

template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;
/// Derivatives of P (or of the energy density, twice) by the displacement gradient; entry of the
/// components (i, J) and (k, L) at i dim + J, k dim + L.
template <int dim>
using Moduli = Eigen::Matrix<double, dim * dim, dim * dim>;

template <int dim>
struct CrystalParameters
{
  CrystalKind kind = dim == 2 ? CrystalKind::triangular : CrystalKind::fcc;
  int species = 0;
  /// Turns crystal axes into those of space: cube axes (3D); a close-packed row and its normal.
  Matrix<dim> orientation = Matrix<dim>::Identity();
  double thickness = 1;         // m, 2D only: volumes include it
  double lattice_parameter = 0; // m; 0: that without stress
};

/// The rotation that brings these two perpendicular directions of the crystal to x and y. Throws
/// core::InputError where they are not.
Matrix<3> orientation_of(const Vector<3> &along_x, const Vector<3> &along_y);

/// One kind of atoms on a Bravais lattice, without stress at rest unless it was given a lattice
/// parameter.
template <int dim>
class Crystal
{
public:
  /// Throws core::InputError for an orientation that is no rotation, a lattice of another dimension
  /// and a potential without a stress-free lattice of this kind.
  Crystal(const Potential &potential, const CrystalParameters<dim> &parameters);

  const CrystalParameters<dim> &parameters() const { return parameters_; }
  /// In normal form: F' = 0 at the density of this crystal, (M2); also of its other species.
  const Potential &potential() const { return potential_; }

  double lattice_parameter() const { return lattice_parameter_; } // m; triangular: the spacing
  double spacing() const { return half_bonds_[0].norm(); }        // m, of nearest neighbours
  double volume() const { return volume_; }                       // m^3, per atom
  double density_of_neighbours() const { return density_; }       // rho_0, unit of the potential
  double mass_density() const;                                    // kg/m^3
  double cohesive_energy() const { return cohesive_energy_; }     // J per atom, below 0

  /// Columns: primitive vectors in space, m; the first is a shortest one.
  const Matrix<dim> &basis() const { return basis_; }
  /// From an atom to half of the others (the rest are opposite), in space, nearest first: those
  /// within 1.25 times the cut-off.
  const std::vector<Vector<dim>> &half_bonds() const { return half_bonds_; }

  /// W in J/m^3, less that at rest; P in Pa and A = dP/dF of the homogeneous deformation F = 1 +
  /// gradient, that of the displacement: (M4) and (M5). Throw core::GuardStop where F shortens a
  /// length by more than a fifth.
  double energy_density(const Matrix<dim> &gradient) const;
  Matrix<dim> stress(const Matrix<dim> &gradient) const;
  Moduli<dim> moduli(const Matrix<dim> &gradient) const;
  /// F; throws likewise.
  Matrix<dim> deformation(const Matrix<dim> &gradient) const;

  /// C and stress in the axes of space, theory.md (C23). Young's modulus and Poisson's ratio are those of Voigt's average over
  /// all orientations, wave speeds the largest (P) and smallest (S) along high symmetry directions.
  particles::ElasticConstants<dim> elastic_constants() const;

  /// Of the crystal cut across this direction of the crystal axes, atoms left where they are;
  /// J/m^2.
  double surface_energy(const Vector<dim> &normal) const;

private:
  /// The primitive vectors in crystal axes over the lattice parameter.
  Matrix<dim> unit_basis() const;
  /// Bonds over the lattice parameter, to so many of them.
  void find_bonds(double reach);
  /// Energy per atom and a times its derivative by a, of the lattice with parameter a.
  Jet energy_of(double a, const Potential &potential) const;
  /// From bonds of up to `reach` spacings; 0 where the least energy lies at smaller ones.
  double find_lattice_parameter(const Potential &potential, int reach) const;
  CrystalParameters<dim> parameters_;
  Potential potential_;
  std::vector<Vector<dim>> half_bonds_;
  double lattice_parameter_ = 1, volume_ = 0, density_ = 0, cohesive_energy_ = 0;
  Matrix<dim> basis_;
};
} // namespace ligament::md
