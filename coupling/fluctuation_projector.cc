#include "coupling/fluctuation_projector.h"

namespace ligament::coupling
{
template <int dim>
FluctuationProjector<dim>::FluctuationProjector(const Overlap<dim> &overlap,
                                                const Transfer<dim> &transfer,
                                                const particles::Particles<dim> &particles,
                                                const std::string &solver)
    : transfer_(transfer),
      carried_(
          overlap,
          [&](const typename Overlap<dim>::Member &m) { return particles.mass[m.particle]; },
          solver),
      nodal_(overlap.n_nodes(), dim)
{
}

template <int dim>
void FluctuationProjector<dim>::project(Components<dim> &w) const
{
  nodal_.setZero();
  transfer_.add_momentum(w, nodal_);
  carried_.solve(nodal_);
  transfer_.subtract(nodal_, w);
}

template class FluctuationProjector<2>;
template class FluctuationProjector<3>;
} // namespace ligament::coupling
