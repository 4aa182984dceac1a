#include "dem/contacts.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
namespace
{
template <int dim>
Vector<dim> centre_distance(const particles::Particles<dim> &p, const Bond<dim> &face)
{
  Vector<dim> r = get(p.reference, face.j) - get(p.reference, face.i) +
                  (get(p.displacement, face.j) - get(p.displacement, face.i));
  if (face.image)
    r += face.image->offset + face.image->jump;
  return r;
}

/// Rotation of particle i since the state that the contact remembers.
Spin<2> turned_since(const particles::Particles<2> &p, int i, const Turn<2> &, double last_angle)
{
  return Spin<2>(p.rotation[0][i] - last_angle);
}
/// Small against one, hence twice the vector part of q conj(q_last).
Spin<3> turned_since(const particles::Particles<3> &p, int i, const Turn<3> &last, double)
{
  const Turn<3> q = Turn<3>::of(p, i);
  return 2 * (last.w * q.v - q.w * last.v - q.v.cross(last.v));
}

Vector<2> spin_times(const Spin<2> &w, const Vector<2> &a)
{
  return {-w[0] * a[1], w[0] * a[0]};
}
Vector<3> spin_times(const Spin<3> &w, const Vector<3> &a)
{
  return w.cross(a);
}

/// The next increment of the slip counts from here.
template <int dim, typename State>
void remember(Contact<dim> &c, const State &s, const particles::Particles<dim> &p)
{
  c.known = true;
  c.last_between = s.between;
  c.last_lever = s.lever;
  c.last_normal = s.normal;
  c.last_turn_i = Turn<dim>::of(p, c.face.i);
  c.last_turn_j = Turn<dim>::of(p, c.face.j);
  if constexpr (dim == 2) {
    c.last_angle_i = p.rotation[0][c.face.i];
    c.last_angle_j = p.rotation[0][c.face.j];
  }
}
} // namespace

template <int dim>
Contact<dim> &Contacts<dim>::add(const Bond<dim> &face, bool from_face)
{
  return contacts_.emplace_back(make(face, from_face));
}

template <int dim>
void Contacts<dim>::settle()
{
  const auto by_name = [](const Contact<dim> &a, const Contact<dim> &b) { return a.name < b.name; };
  const auto added = std::is_sorted_until(contacts_.begin(), contacts_.end(), by_name);
  if (added == contacts_.end())
    return;
  std::sort(added, contacts_.end(), by_name);
  const auto first = std::upper_bound(contacts_.begin(), added, *added, by_name);
  std::inplace_merge(first, added, contacts_.end(), by_name);
}

template <int dim>
Contact<dim> Contacts<dim>::make(const Bond<dim> &face, bool from_face) const
{
  const auto [first, second] = std::minmax({ids_[face.i], ids_[face.j]});
  Contact<dim> c{{first, second, 0}, face, from_face, face.distance, 0, 0, 0};
  // Of both reaches, not of the distance: that of a softened face is shorter.
  const double reach_i = face.lever_i.dot(face.normal), reach_j = -face.lever_j.dot(face.normal);
  c.share_i = reach_i / (reach_i + reach_j);
  c.shear_modulus = modulus(c);
  c.friction = materials_.friction(face.i, face.j);
  return c;
}

template <int dim>
double Contacts<dim>::modulus(const Contact<dim> &c) const
{
  return in_series(materials_.of(c.face.i).shear_modulus(), materials_.of(c.face.j).shear_modulus(),
                   c.share_i);
}

template <int dim>
void Contacts<dim>::add_joint(const Bond<dim> &face, int cut, const Vector<dim> &cut_normal,
                              const Vector<dim> &centre_j)
{
  Contact<dim> c = make(face, true);
  c.name[2] = cut + 1;
  c.home = centre_j;
  c.cut = cut;
  c.cut_normal = std::copysign(1, cut_normal.dot(face.normal)) * cut_normal;
  contacts_.push_back(std::move(c));
}

// Of a joint, 2 G S/r0 is 2 G A/h: A = S n.N the face's area projected on the cut, h = r0 n.N the
// distance of the centres across it.
template <int dim>
typename Contacts<dim>::State Contacts<dim>::state(const Contact<dim> &c, const Particles &p) const
{
  State s;
  s.between = centre_distance<dim>(p, c.face);
  s.stiffness = 2 * c.shear_modulus * c.face.area / c.face.distance;
  if (!c.is_joint()) {
    const double r = s.between.norm();
    s.normal = s.between / r;
    s.lever = c.share_i * s.between;
    s.overlap = c.face.distance - r;
    return s;
  }
  const Turn<dim> turn_i = Turn<dim>::of(p, c.face.i), turn_j = Turn<dim>::of(p, c.face.j);
  const BondMotion<dim> m(c.face, turn_i, turn_j, get(p.displacement, c.face.i),
                          get(p.displacement, c.face.j));
  s.normal =
      (2 * c.cut_normal + turn_i.change(c.cut_normal) + turn_j.change(c.cut_normal)).normalized();
  const Vector<dim> apart = m.du - c.passed;
  s.overlap = -s.normal.dot(apart);
  s.lever = m.a_i + apart / 2;
  return s;
}

template <int dim>
double Contacts<dim>::update_slip(Contact<dim> &c, const State &s, const Particles &p) const
{
  const double stored = c.slip.norm();
  if constexpr (dim == 3)
    if (c.known && stored > 0) { // turned with the two about their normal
      const double angle =
          0.5 * s.normal.dot(turned_since(p, c.face.i, c.last_turn_i, c.last_angle_i) +
                             turned_since(p, c.face.j, c.last_turn_j, c.last_angle_j));
      c.slip +=
          std::sin(angle) * s.normal.cross(c.slip) - (1 - std::cos(angle)) * Vector<dim>(c.slip);
    }
  // The slip follows the face: turned into its plane, of the same length.
  c.slip -= s.normal * s.normal.dot(c.slip);
  if (stored > 0 && c.slip.norm() > 0)
    c.slip *= stored / c.slip.norm();
  Vector<dim> increment = Vector<dim>::Zero();
  if (c.known) {
    const Vector<dim> n = (s.normal + c.last_normal).normalized();
    const Vector<dim> lever_i = (s.lever + c.last_lever) / 2,
                      lever_j = lever_i - (s.between + c.last_between) / 2;
    increment = s.between - c.last_between -
                spin_times(turned_since(p, c.face.i, c.last_turn_i, c.last_angle_i), lever_i) +
                spin_times(turned_since(p, c.face.j, c.last_turn_j, c.last_angle_j), lever_j);
    increment -= n * n.dot(increment);
  }
  const Vector<dim> carried = c.slip;
  c.slip += increment;
  const double trial = c.slip.norm(), limit = c.friction * std::max(s.overlap, 0.);
  double taken = 0;
  if (trial > limit) {
    const Vector<dim> slid = c.slip * (1 - limit / trial);
    c.slip -= slid;
    // Work of the mean force less the change of stored energy.
    taken = 0.5 * s.stiffness * (carried + c.slip).dot(slid);
  }
  remember(c, s, p);
  return taken;
}

template <int dim>
double Contacts<dim>::follow_slip(Contact<dim> &c, const State &s, const Particles &p) const
{
  if (c.friction <= 0)
    return 0;
  if (s.overlap > 0 || (grips_at_touch_ && s.overlap == 0) || c.slip.squaredNorm() > 0)
    return update_slip(c, s, p);
  c.known = false; // apart: the next touch starts anew
  return 0;
}

template <int dim>
void Contacts<dim>::add_force(const Contact<dim> &c, const State &s, const Vector<dim> &f,
                              Particles &p) const
{
  ligament::add(p.force, c.face.i, f);
  ligament::add(p.force, c.face.j, Vector<dim>(-f));
  if (c.friction > 0 || c.is_joint()) { // else the force runs through the centres
    ligament::add(p.torque, c.face.i, cross(s.lever, f));
    ligament::add(p.torque, c.face.j, cross(Vector<dim>(s.between - s.lever), f));
  }
}

template <int dim>
void Contacts<dim>::press(std::size_t k, Particles &p, std::vector<Change> &changed,
                          std::vector<std::size_t> &corrected)
{
  Contact<dim> &c = contacts_[k];
  if (c.is_bonded)
    return;
  const State s = state(c, p);
  const bool is_own = p.part.owns(c.face.i);
  if (const double taken = follow_slip(c, s, p); taken != 0 && is_own)
    frictional_work_.add(taken);
  if (s.overlap > 0) // on i
    add_force(c, s, s.stiffness * (c.slip - s.overlap * s.normal), p);
  if (c.last_overlap && *c.last_overlap != s.overlap) {
    const double last = *c.last_overlap;
    if (is_own)
      step_error_.add(0.5 * c.correction * (s.overlap - last));
    c.correction = 0;
    if ((s.overlap > 0) != (last > 0))
      changed.push_back({k, s, last});
  }
  c.last_overlap = s.overlap;
  if (c.correction != 0) // the same state again
    corrected.push_back(k);
  const double shift = c.own_distance - c.face.distance;
  if (shift != 0 && s.overlap <= 0 && s.overlap + shift <= 0) { // open either way
    c.face.distance = c.own_distance;
    c.last_overlap = state(c, p).overlap;
  }
}

template <int dim>
void Contacts<dim>::add_corrections(const std::vector<std::size_t> &corrected, Particles &p) const
{
  for (const std::size_t k : corrected) {
    const Contact<dim> &c = contacts_[k];
    if (c.correction == 0)
      continue;
    const State s = state(c, p);
    add_force(c, s, -c.correction * s.normal, p);
  }
}

template <int dim>
void Contacts<dim>::add_forces(Particles &p, double dt)
{
  std::vector<Change> changed;
  std::vector<std::size_t> corrected;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    press(k, p, changed, corrected);
  correct(changed, p, dt);
  for (const Change &change : changed)
    corrected.push_back(change.contact);
  std::sort(corrected.begin(), corrected.end());
  add_corrections(corrected, p);
}

template <int dim>
void Contacts<dim>::add_force(std::size_t k, Particles &p, double dt)
{
  std::vector<Change> changed;
  std::vector<std::size_t> corrected;
  press(k, p, changed, corrected);
  if (!changed.empty()) {
    correct(changed, p, dt);
    corrected.push_back(k);
  }
  add_corrections(corrected, p);
}

template <int dim>
void Contacts<dim>::take_over(std::size_t k, const Vector<dim> &force, const Particles &p)
{
  Contact<dim> &c = contacts_[k];
  const State s = state(c, p);
  const double pressure = -force.dot(s.normal);
  if (pressure <= 0)
    return;
  const double at_distance = s.stiffness * c.face.distance; // N/m times m, whatever the distance
  c.face.distance = s.between.norm() / (1 - pressure / at_distance);
  const double stiffness = at_distance / c.face.distance;
  c.slip = (force + pressure * s.normal) / stiffness;
  const double most = c.friction * pressure / stiffness, carried = c.slip.norm();
  if (carried > most)
    c.slip *= most / carried;
}

template <int dim>
std::vector<ClosedContact<dim>> Contacts<dim>::add_trial_forces(Particles &p) const
{
  std::vector<ClosedContact<dim>> closed;
  for (Contact<dim> c : contacts_) {
    if (c.is_bonded)
      continue;
    const State s = state(c, p);
    const bool was_known = c.known;
    follow_slip(c, s, p);
    if (s.overlap <= 0)
      continue;
    add_force(c, s, s.stiffness * (c.slip - s.overlap * s.normal), p);
    constexpr double round_off = 1e-12;
    const bool sticks =
        was_known && c.friction > 0 && c.slip.norm() < c.friction * s.overlap * (1 - round_off);
    ClosedContact<dim> now{
        c.face.i,    c.face.j, Vector<dim>::Zero(), Vector<dim>::Zero(), s.normal,
        s.stiffness, sticks};
    if (c.friction > 0 || c.is_joint()) {
      now.lever_i = s.lever;
      now.lever_j = s.lever - s.between;
    }
    closed.push_back(now);
  }
  return closed;
}

template <int dim>
void Contacts<dim>::forget_steps()
{
  for (auto &c : contacts_) {
    c.last_overlap.reset();
    c.correction = 0;
  }
  grips_at_touch_ = true;
}

template <int dim>
double Contacts<dim>::compression_energy(const Contact<dim> &c, const Particles &p) const
{
  const State s = state(c, p);
  return s.overlap > 0 ? 0.5 * s.stiffness * s.overlap * s.overlap : 0.;
}

template <int dim>
double Contacts<dim>::slip_energy(const Contact<dim> &c, const Particles &p) const
{
  return 0.5 * state(c, p).stiffness * c.slip.squaredNorm();
}

template <int dim>
double Contacts<dim>::energy(const Contact<dim> &c, const Particles &p) const
{
  if (c.is_bonded)
    return 0;
  const State s = state(c, p);
  const double overlap = std::max(s.overlap, 0.);
  return 0.5 * s.stiffness * (overlap * overlap + c.slip.squaredNorm());
}

template <int dim>
bool Contacts<dim>::has_slid(const Particles &p, double distance) const
{
  for (const auto &c : contacts_) {
    Vector<dim> u = get(p.displacement, c.face.j) - get(p.displacement, c.face.i);
    if (c.face.image)
      u += c.face.image->jump;
    if (u.squaredNorm() > distance * distance)
      return true;
  }
  return false;
}

template <int dim>
void Contacts<dim>::drop_distant(const Particles &p, double distance)
{
  contacts_.erase(std::remove_if(contacts_.begin(), contacts_.end(),
                                 [&](const Contact<dim> &c) {
                                   return !c.from_face && !c.is_joint() && !c.is_bonded &&
                                          state(c, p).between.norm() > distance;
                                 }),
                  contacts_.end());
}

template <int dim>
Vector<dim> Contacts<dim>::slide(const Contact<dim> &c, const Particles &p)
{
  const Turn<dim> turn_i = Turn<dim>::of(p, c.face.i), turn_j = Turn<dim>::of(p, c.face.j);
  const BondMotion<dim> m(c.face, turn_i, turn_j, get(p.displacement, c.face.i),
                          get(p.displacement, c.face.j));
  const Vector<dim> apart = m.du - c.passed;
  const Vector<dim> slide = apart + turn_i.inverse().change(apart);
  return c.passed + slide - c.cut_normal * c.cut_normal.dot(slide);
}

// The new partner's point is the one that i's point has come to, as high above the cut as that was
// in the reference.
template <int dim>
void Contacts<dim>::pass_on(std::size_t k, int j, const Particles &p)
{
  Contact<dim> &c = contacts_[k];
  const auto book = [&, is_own = p.part.owns(c.face.i)](double taken) {
    if (is_own)
      frictional_work_.add(taken);
  };
  if (c.known)
    book(update_slip(c, state(c, p), p));
  if (c.correction != 0 && p.part.owns(c.face.i)) // as press() would, which sees another pair
    step_error_.add(0.5 * c.correction * (state(c, p).overlap - c.last_overlap.value_or(0)));
  c.correction = 0;
  const double before = compression_energy(c, p);
  if (j < 0) {
    book(before + 0.5 * state(c, p).stiffness * c.slip.squaredNorm());
    contacts_.erase(contacts_.begin() + k);
    return;
  }
  c.passed = slide(c, p);
  c.face.j = j;
  c.face.lever_j = get(p.reference, c.face.i) + c.face.lever_i - c.passed - get(p.reference, j);
  c.from_face = false;
  const State s = state(c, p);
  if (c.known)
    remember(c, s, p);
  c.last_overlap = s.overlap;
  book(before - compression_energy(c, p));
}

template class Contacts<2>;
template class Contacts<3>;
} // namespace ligament::dem
