// Nearest neighbours of a crystal that have left each other: what cracks and slip leave behind.
#pragma once

#include "md/bond_view.h"
#include "particles/force_report.h"

#include <map>

namespace ligament::md
{
/// Two nearest neighbours of the reference count as parted for good once they are farther apart
/// than midway between the shells of neighbours, beyond what a bond bears. Heat stretches a few of
/// them so far for a moment: at a temperature they must be so for some time, at every look. A parted
/// bond has the area of the face between the cells of the two atoms and no energy: that is in the
/// potential.
template <int dim>
class PartedBonds
{
public:
  using Particles = particles::Particles<dim>;

  PartedBonds() = default;
  /// Bonds of the reference; `limit` in m, `area` of a face in m^2; `lasting` in s: how long a bond
  /// is longer before it counts, 0: not at all.
  PartedBonds(std::vector<Bond<dim>> bonds, double limit, double area, double lasting);

  /// Adds those that have parted by now, with the time since when they are longer and in its order.
  void look(const Particles &atoms, double time);
  /// Whether a look would tell of a longer bond whether it has parted.
  bool is_due(double time) const;

  /// In the order in which they were seen.
  const std::vector<particles::BrokenBond<dim>> &parted() const { return parted_; }
  double area() const { return area_; }
  /// visit(bond, is_parted)
  template <typename Visit>
  void for_each_bond(Visit &&visit) const
  {
    for (std::size_t b = 0; b < bonds_.size(); ++b)
      visit(bonds_[b], is_parted_[b] != 0);
  }

  void save(core::State &state, const Particles &atoms) const;
  void load(const core::State &state, const Particles &atoms);

private:
  void part(std::size_t bond, const Particles &atoms, double time);
  struct Since
  {
    std::size_t bond;
    double time; // s
  };
  core::Table named(const std::vector<Since> &bonds, const Particles &atoms) const;
  std::vector<Since> found(const core::Table &table, const Particles &atoms) const;

  std::vector<Bond<dim>> bonds_;
  std::vector<char> is_parted_;
  std::vector<std::size_t> order_; // parted bonds as they were seen
  std::vector<particles::BrokenBond<dim>> parted_;
  std::map<std::size_t, double> longer_; // bonds that have not parted yet, since when
  double limit_ = 0, area_ = 0, lasting_ = 0;
};
} // namespace ligament::md
