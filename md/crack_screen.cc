#include "md/crack_screen.h"

namespace ligament::md
{
template <int dim>
CrackScreen<dim>::CrackScreen(std::vector<packings::CrackPlane<dim>> cuts,
                              const Components<dim> &reference, const Vector<dim> &period,
                              double reach)
    : cuts_(std::move(cuts)), reference_(reference), period_(period)
{
  is_near_.assign(reference[0].size(), 0);
  for (std::size_t i = 0; i < is_near_.size(); ++i)
    for (const auto &cut : cuts_)
      is_near_[i] |= std::abs(cut.height(get(reference_, int(i)))) < reach;
}

template <int dim>
bool CrackScreen<dim>::parts(int i, int j, const std::array<int, 3> &periods) const
{
  if (!is_near_[i] || !is_near_[j])
    return false;
  Vector<dim> image = get(reference_, j);
  for (int c = 0; c < dim; ++c)
    image[c] += periods[c] * period_[c];
  return packings::first_crossed<dim>(cuts_, get(reference_, i), image) >= 0;
}

template class CrackScreen<2>;
template class CrackScreen<3>;
} // namespace ligament::md
