#include "coupling/operators/fluctuation_projector.h"

namespace ligament::coupling
{
namespace
{
/// Of every particle, in kg; 0 for those that are no free members.
template <int dim>
std::vector<double> particle_masses(const Overlap<dim> &overlap, const Transfer<dim> &transfer)
{
  std::vector<double> mass(overlap.member_of_particle.size());
  for (int k = 0; k < transfer.size(); ++k)
    mass[transfer.particle(k)] = transfer.mass(k);
  return mass;
}
} // namespace

template <int dim>
FluctuationProjector<dim>::FluctuationProjector(const Overlap<dim> &overlap,
                                                const Transfer<dim> &transfer, Solver solver)
    : transfer_(transfer),
      carried_(
          overlap,
          [mass = particle_masses(overlap, transfer)](const typename Overlap<dim>::Member &m) {
            return mass[m.particle];
          },
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
