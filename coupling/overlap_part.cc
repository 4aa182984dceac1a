#include "coupling/overlap_part.h"

namespace ligament::coupling
{
template <int dim>
Overlap<dim> overlap_at_hand(const OverlapView<dim> &whole, const particles::Particles<dim> &here)
{
  const core::Names names = here.names();
  const auto place = [&](int i) { return names.index(whole.particles.global_id[i]); };
  Overlap<dim> part = whole.overlap;
  part.members.clear();
  part.member_of_particle.assign(here.size(), -1);
  for (auto member : whole.overlap.members) {
    const int i = place(member.particle);
    if (i < 0)
      continue;
    member.particle = i;
    part.member_of_particle[i] = int(part.members.size());
    part.members.push_back(member);
  }
  part.edge.clear();
  for (const int i : whole.overlap.edge)
    if (const int k = place(i); k >= 0)
      part.edge.push_back(k);
  return part;
}

template Overlap<2> overlap_at_hand(const OverlapView<2> &, const particles::Particles<2> &);
template Overlap<3> overlap_at_hand(const OverlapView<3> &, const particles::Particles<3> &);
} // namespace ligament::coupling
