// Contacts that open or close between two steps: what makes good their energy, theory.md eq. (E11).
#include "dem/contacts.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
namespace
{
/// How a contact's distance will move in the next step, without and with a force along its normal.
struct Outlook
{
  double moves;      // m, the overlap grows by
  double compliance; // m/N, less so much per newton of pressure
};

template <int dim, typename Motion>
Outlook outlook(const particles::Particles<dim> &p, int i, int j, const Motion &of_i,
                const Motion &of_j, const Vector<dim> &normal, const Vector<dim> &lever_i,
                const Vector<dim> &lever_j, double dt)
{
  Outlook o{0, 0};
  const auto add = [&](int k, const Motion &of, const Vector<dim> &lever, double sign) {
    const Spin<dim> arm = cross(lever, normal);
    const double mass = p.inverse_mass(k), inertia = p.inverse_inertia(k);
    const double v = normal.dot(of.velocity + dt * mass * of.force) +
                     arm.dot(of.spin + dt * inertia * of.torque);
    o.moves += sign * dt * v;
    o.compliance += dt * dt * (mass + inertia * arm.squaredNorm());
  };
  add(i, of_i, lever_i, 1);
  add(j, of_j, lever_j, -1);
  return o;
}

/// The force f with f (moved + next(f)) = 2 error: over the two steps beside it, it does the work
/// that the change of the contact left out. 0 where the motion turns back before.
double correcting_force(double error, double moved, const Outlook &next, double largest)
{
  const double sum = moved + next.moves;
  const double square = sum * sum - 8 * next.compliance * error;
  if (square < 0 || sum == 0)
    return 0;
  return std::clamp(4 * error / (sum + std::copysign(std::sqrt(square), sum)), -largest, largest);
}
} // namespace

template <int dim>
typename Contacts<dim>::Motion Contacts<dim>::motion_of(const Particles &p, int i)
{
  return {get(p.velocity, i), get(p.force, i), get(p.spin, i), get(p.torque, i)};
}

// A contact that opens or closes between two steps: over that step the leap-frog's work (the mean
// of both forces) and the energy differ by k/2 |o1 o2|. The force of this step is chosen so that it
// makes good half of it in the step before and half in the next; what it misses there is booked.
template <int dim>
void Contacts<dim>::correct(const std::vector<Change> &changed, const Particles &p, double dt)
{
  const std::map<int, Motion> foreign = foreign_motions(changed, p);
  const auto motion = [&](int i) {
    const auto found = foreign.find(i);
    return found == foreign.end() ? motion_of(p, i) : found->second;
  };
  for (const auto &[k, s, last] : changed) {
    Contact<dim> &c = contacts_[k];
    const int i = c.face.i, j = c.face.j;
    const double moved = s.overlap - last;
    const double error = std::copysign(0.5, s.overlap) * s.stiffness * s.overlap * last;
    const Vector<dim> lever_j = s.lever - s.between;
    c.correction = correcting_force(
        error, moved, outlook<dim>(p, i, j, motion(i), motion(j), s.normal, s.lever, lever_j, dt),
        s.stiffness * std::max(std::abs(last), std::abs(s.overlap)));
    if (p.part.owns(i))
      step_error_.add(0.5 * c.correction * moved - error);
  }
}

template Contacts<2>::Motion Contacts<2>::motion_of(const Particles &, int);
template Contacts<3>::Motion Contacts<3>::motion_of(const Particles &, int);
template void Contacts<2>::correct(const std::vector<Change> &, const Particles &, double);
template void Contacts<3>::correct(const std::vector<Change> &, const Particles &, double);
} // namespace ligament::dem
