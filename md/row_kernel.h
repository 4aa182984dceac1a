// Forces of a crystal whose atoms keep their neighbours, by vectors of atoms along its rows: the
// fastest way of AtomForce.
#pragma once

#include "md/crystal_rows.h"
#include "md/pair_table.h"

#include <algorithm>
#include <cstddef>

namespace ligament::md
{
/// What the passes over rows read and write; arrays of slots are padded by a vector.
struct RowArrays
{
  const double *displacement[3]; // m
  double *density, *slope;       // rho; -F' over the step of the distance
  double *force[3];              // N
  const double *bonds;           // dim numbers each, m
  const PairPiece *table;
  /// The same by columns, so long each: -phi' and f.
  const double *columns;
  int column_size;
  double beyond2, inverse_step; // m^2: the cut-off's and a little more; 1/m
  const double *embedding;      // coefficients of F, 4 per piece
  double embedding_step, n_embedding;
};

struct RowTask
{
  int first, last; // slots
  const int *shift;
  int n_bonds;
  /// Two vectors per bond and vector of atoms: (df/dt)/r and -phi'/r.
  double *between;
};

/// The largest square of u - base - n gradient over slots, n counted from the first one; inf where
/// there is no number.
struct RowPasses
{
  using Pass = void (*)(const RowArrays &, const RowTask &);
  /// Densities and what lies between; F' of whole densities; forces. Without embedding: forces.
  Pass first, slopes, second, pairs;
  double (*largest_rest)(const RowArrays &, const RowTask &, const double *base,
                         const double *gradient);
};
/// Those of the instruction set at hand.
template <int dim>
RowPasses row_passes();

/// For bodies of one species. Every bond is taken with one sign, in the order of runs and bonds.
template <int dim>
class RowKernel
{
public:
  RowKernel(const Crystal<dim> &crystal, const packings::Packing<dim> &packing, int species,
            double reach);

  bool exists() const { return rows_.exist(); }

  /// Takes up the displacements (m). Returns whether every pair within the cut-off is one of the
  /// bonds, as it is if u = affine motion + w with |w_i| + |w_j| small: no pair that is longer
  /// than R in the reference is then shorter than the least stretch times R less |w_i| + |w_j|.
  /// The answer depends on the displacements alone.
  bool holds(const Components<dim> &displacement);

  /// Overwrites the forces of all atoms by those at the displacements that holds() said yes to.
  /// Bonds out of range add zeros: how many shells a run looks at does not change a bit.
  void compute(Components<dim> &force);

  /// That an atom looks along at present.
  int most_bonds() const { return *std::max_element(n_bonds_.begin(), n_bonds_.end()); }

private:
  struct Affine
  {
    Vector<dim> base; // m
    Matrix<dim> gradient;
    double least_stretch; // of lengths, by 1 + gradient
  };
  void sample_places(const packings::Packing<dim> &packing);
  Affine fit(const Components<dim> &displacement) const;
  void take_up(const Components<dim> &displacement);
  RowArrays arrays();
  RowTask task(int run);
  void fold(std::vector<double> &values, int run) const;

  CrystalRows<dim> rows_;
  std::vector<PairPiece> table_;
  std::vector<double> columns_;
  Spline embedding_;
  bool has_embedding_;
  double cutoff_;
  PassSchedule schedule_;
  std::vector<double> bonds_;
  std::vector<Vector<dim>> place_; // m, of the first atom of each run

  // Of the fit: some atoms, their places from the mean, and the inverse of the sum of squares.
  std::vector<int> sample_;
  std::vector<Vector<dim>> from_mean_;
  Vector<dim> mean_;
  Matrix<dim> inverse_squares_;

  std::vector<int> n_bonds_; // of runs, at present
  std::vector<double> rest_; // of runs, largest |w|, m
  Components<dim> displacement_, force_;
  std::vector<double> density_, slope_;
  std::vector<std::vector<double>> between_;
};
} // namespace ligament::md
