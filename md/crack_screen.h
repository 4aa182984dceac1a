// Cuts without width in a crystal: which pairs of atoms no longer see each other.
#pragma once

#include "md/neighbour_list.h"
#include "packings/specimen_shape.h"

namespace ligament::md
{
/// Pairs whose vector in the reference crosses a cut. They stay apart for good: flanks that meet
/// again pass through each other.
template <int dim>
class CrackScreen
{
public:
  CrackScreen() = default;
  /// `reach` in m: atoms that were farther apart in the reference never see each other.
  CrackScreen(std::vector<packings::CrackPlane<dim>> cuts, const Components<dim> &reference,
              const Vector<dim> &period, double reach);

  bool is_empty() const { return cuts_.empty(); }
  /// Whether the cuts part atom i from the image of j that is so many periods away.
  bool parts(int i, int j, const std::array<int, 3> &periods) const;
  /// Takes the pairs that the cuts part out of the list.
  void apply(NeighbourList &list) const
  {
    if (!is_empty())
      list.remove_pairs([this](int i, int j, const auto &periods) { return parts(i, j, periods); });
  }

private:
  std::vector<packings::CrackPlane<dim>> cuts_;
  Components<dim> reference_; // m
  Vector<dim> period_ = Vector<dim>::Zero();
  std::vector<char> is_near_; // a cut
};
} // namespace ligament::md
