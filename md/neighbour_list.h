// Pairs of atoms that are near or may soon be: cells, a skin, and images of a box that repeats.
#pragma once

#include "core/types.h"
#include "md/atom_record.h"

namespace ligament::md
{
struct CellGrid;

/// Holds every pair within cut-off plus skin once; built anew when an atom has moved by half of the
/// skin. Atoms lie in slots, cell after cell, x fastest; behind them images of atoms beyond the
/// sides that repeat: of two images of one pair only that whose image lies on the upper side.
class NeighbourList
{
public:
  /// Lengths in m. `period`: after which the box repeats itself along each axis; 0: it does not.
  template <int dim>
  NeighbourList(double cutoff, double skin, const Vector<dim> &period);

  /// Atoms are at reference + displacement (m) now; returns whether the list was built anew.
  template <int dim>
  bool update(const Components<dim> &reference, const Components<dim> &displacement);

  /// The same without building: returns false where that is due.
  template <int dim>
  bool place(const Components<dim> &reference, const Components<dim> &displacement);

  /// The same, built in any case.
  template <int dim>
  void build(const Components<dim> &reference, const Components<dim> &displacement);

  /// Takes out the pairs for which parts(i, j, periods) holds, as for_each_pair() names them.
  template <typename Parts>
  void remove_pairs(Parts &&parts);

  double cutoff() const { return cutoff_; }
  double skin() const { return skin_; }
  int n_atoms() const { return int(order_.size()); }
  int n_images() const { return int(images_.size()); }
  long n_pairs() const { return begin_.empty() ? 0 : begin_.back(); }
  int n_builds() const { return n_builds_; }

  /// Atom in each slot.
  const std::vector<int> &order() const { return order_; }
  /// Neighbours of slot s: neighbours()[begin()[s]] to before begin()[s + 1]; from n_atoms() on
  /// they are images. Behind the last one there is room for a vector.
  const std::vector<int> &begin() const { return begin_; }
  const std::vector<int> &neighbours() const { return neighbour_; }
  /// Where the atoms of slots and their images are, n_atoms() + n_images().
  const std::vector<AtomRecord> &records() const { return records_; }
  void set_extra(int record, double value) { records_[record].extra = value; }
  /// The slot whose atom a neighbour is.
  int slot_of(int neighbour) const
  {
    return neighbour < n_atoms() ? neighbour : images_[neighbour - n_atoms()].slot;
  }

  /// visit(i, j, image): atoms i and j and the whole numbers of periods by which j is moved.
  template <typename Visit>
  void for_each_pair(Visit &&visit) const;

private:
  using Triple = std::array<int, 3>;
  struct Image
  {
    int slot;
    Triple periods;
  };
  struct Cells;

  /// From slot s to a neighbour of it.
  Triple periods_to(int s, int neighbour) const;
  void set_image_records();
  void build_from(const std::vector<AtomRecord> &places);
  /// Their slots are numbers of atoms at first.
  std::vector<Image> make_images(const std::vector<AtomRecord> &atoms, double reach) const;
  void find_pairs(const CellGrid &grid, double reach);
  AtomRecord moved(const AtomRecord &place, const Triple &periods) const;

  double cutoff_, skin_;
  std::array<double, 3> period_ = {};
  int n_builds_ = 0;
  std::vector<int> order_, begin_, neighbour_;
  std::vector<Triple> wrap_; // of slots: periods that bring the atom into the box
  std::vector<Image> images_;
  std::vector<AtomRecord> records_, built_; // now, and when the list was built
};

inline std::array<int, 3> NeighbourList::periods_to(int s, int neighbour) const
{
  const int t = slot_of(neighbour);
  Triple periods = {};
  for (int c = 0; c < 3; ++c)
    periods[c] = wrap_[t][c] - wrap_[s][c];
  if (neighbour >= n_atoms())
    for (int c = 0; c < 3; ++c)
      periods[c] += images_[neighbour - n_atoms()].periods[c];
  return periods;
}

template <typename Visit>
void NeighbourList::for_each_pair(Visit &&visit) const
{
  for (int s = 0; s < n_atoms(); ++s)
    for (int k = begin_[s]; k < begin_[s + 1]; ++k)
      visit(order_[s], order_[slot_of(neighbour_[k])], periods_to(s, neighbour_[k]));
}

template <typename Parts>
void NeighbourList::remove_pairs(Parts &&parts)
{
  int kept = 0, first = 0;
  for (int s = 0; s < n_atoms(); ++s) {
    const int last = begin_[s + 1];
    for (int k = first; k < last; ++k)
      if (!parts(order_[s], order_[slot_of(neighbour_[k])], periods_to(s, neighbour_[k])))
        neighbour_[kept++] = neighbour_[k];
    first = last;
    begin_[s + 1] = kept;
  }
}
} // namespace ligament::md
