// A crystal as rows of sites, in which an atom's neighbours are found by index.
#pragma once

#include "md/crystal.h"
#include "md/pass_schedule.h"
#include "packings/packing.h"

namespace ligament::md
{
/// Atoms one behind the other along a row.
struct RowRun
{
  int first, last; // slots, to before the last
};

/// Slots hold the sites of rows along a lattice vector: atoms, images of atoms beyond sides that
/// repeat, and empty sites, wherever a bond of an atom may lead. The neighbour across bond b of the
/// atom in slot s of run r is in slot s + shift(r)[b]; empty, where there is none: holes, cracks
/// and surfaces need no care.
template <int dim>
class CrystalRows
{
public:
  /// Bonds shorter than `reach` (m), or than the crystal knows. There are no runs where the atoms
  /// or the periods do not lie on the lattice to rounding.
  CrystalRows(const Crystal<dim> &crystal, const packings::Packing<dim> &packing, double reach);

  bool exist() const { return !runs_.empty(); }

  int n_slots() const { return int(atom_.size()); }
  const std::vector<RowRun> &runs() const { return runs_; }
  /// Of each slot; -1: empty or an image.
  const std::vector<int> &atoms() const { return atom_; }
  /// From one site of a row to the next, m.
  const Vector<dim> &along() const { return along_; }

  struct Image
  {
    int slot, of; // slots
  };
  /// In the order of the runs of their atoms; those of run r from image_begin()[r] on.
  const std::vector<Image> &images() const { return images_; }
  const std::vector<int> &image_begin() const { return image_begin_; }

  /// Half of the bonds, those within the cut-off first, then shell by shell; those that follow each
  /// other lead to different rows where possible.
  const std::vector<Vector<dim>> &bonds() const { return bonds_; }
  /// A number of bonds that are all within the cut-off or more, and the length of the next one (m).
  struct Shells
  {
    int n_bonds;
    double next;
  };
  const std::vector<Shells> &shells() const { return shells_; }
  const int *shift(int run) const { return shift_.data() + std::size_t(run) * bonds_.size(); }
  /// Runs whose atoms its bonds reach, ascending.
  const std::vector<int> &reached(int run) const { return reached_[run]; }

private:
  using Index = Eigen::Matrix<int, dim, 1>;
  struct Row;
  class Sites;

  void find_bonds(const Crystal<dim> &crystal, double reach);
  void spread_rows();
  /// Columns: primitive vectors in whole numbers of the crystal's, of which the first runs along
  /// rows that fill vectors best.
  Eigen::Matrix<int, dim, dim> choose_basis(const std::vector<Index> &index) const;
  void lay_out(const std::vector<Index> &index, const std::vector<Index> &moves);

  Vector<dim> along_;
  std::vector<Vector<dim>> bonds_;
  std::vector<Index> steps_; // bonds in whole numbers
  std::vector<Shells> shells_;
  std::vector<RowRun> runs_;
  std::vector<int> atom_, shift_, image_begin_;
  std::vector<Image> images_;
  std::vector<std::vector<int>> reached_;
};
} // namespace ligament::md
