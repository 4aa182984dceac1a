#include "dem/contacts.h"

#include "dem/surface_loads.h"

namespace ligament::dem
{
namespace
{
template <int dim>
Vector<dim> centre_distance(const particles::Particles<dim> &p, int i, int j)
{
  return get(p.reference, j) - get(p.reference, i) +
         (get(p.displacement, j) - get(p.displacement, i));
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
} // namespace

template <int dim>
void Contacts<dim>::add(const Bond<dim> &face, bool from_face)
{
  Contact<dim> c;
  c.face = face;
  c.from_face = from_face;
  c.share_i = face.lever_i.dot(face.normal) / face.distance;
  c.shear_modulus = in_series(materials_.of(face.i).shear_modulus(),
                              materials_.of(face.j).shear_modulus(), c.share_i);
  c.friction = materials_.friction(face.i, face.j);
  contacts_.push_back(c);
}

template <int dim>
typename Contacts<dim>::State Contacts<dim>::state(const Contact<dim> &c, const Particles &p) const
{
  const Vector<dim> x = centre_distance<dim>(p, c.face.i, c.face.j);
  const double r = x.norm();
  return {x / r, r, c.face.distance - r, 2 * c.shear_modulus * c.face.area / c.face.distance};
}

template <int dim>
void Contacts<dim>::update_slip(Contact<dim> &c, const State &s, const Particles &p)
{
  const Vector<dim> x = s.distance * s.normal;
  const double stored = c.slip.norm();
  // The slip follows the face: turned into its plane, of the same length.
  c.slip -= s.normal * s.normal.dot(c.slip);
  if (stored > 0 && c.slip.norm() > 0)
    c.slip *= stored / c.slip.norm();
  Vector<dim> increment = Vector<dim>::Zero();
  if (c.known) {
    const Vector<dim> middle = (x + c.last_distance) / 2, n = middle.normalized();
    const Spin<dim> turn =
        c.share_i * turned_since(p, c.face.i, c.last_turn_i, c.last_angle_i) +
        (1 - c.share_i) * turned_since(p, c.face.j, c.last_turn_j, c.last_angle_j);
    increment = x - c.last_distance - spin_times(turn, middle);
    increment -= n * n.dot(increment);
  }
  const Vector<dim> carried = c.slip;
  c.slip += increment;
  const double trial = c.slip.norm(), limit = c.friction * std::max(s.overlap, 0.);
  if (trial > limit) {
    const Vector<dim> slid = c.slip * (1 - limit / trial);
    c.slip -= slid;
    // Work of the mean force less the change of stored energy.
    frictional_work_ += 0.5 * s.stiffness * (carried + c.slip).dot(slid);
  }
  c.known = true;
  c.last_distance = x;
  c.last_turn_i = Turn<dim>::of(p, c.face.i);
  c.last_turn_j = Turn<dim>::of(p, c.face.j);
  if constexpr (dim == 2) {
    c.last_angle_i = p.rotation[0][c.face.i];
    c.last_angle_j = p.rotation[0][c.face.j];
  }
}

template <int dim>
void Contacts<dim>::add_forces(Particles &p)
{
  for (auto &c : contacts_) {
    const State s = state(c, p);
    if (c.friction > 0) {
      if (s.overlap > 0 || c.slip.squaredNorm() > 0)
        update_slip(c, s, p);
      else
        c.known = false; // apart: the next touch starts anew
    }
    if (s.overlap <= 0)
      continue;
    const Vector<dim> f = s.stiffness * (c.slip - s.overlap * s.normal); // on i
    ligament::add(p.force, c.face.i, f);
    ligament::add(p.force, c.face.j, Vector<dim>(-f));
    if (c.friction > 0) {
      const Spin<dim> torque = s.distance * cross(s.normal, f);
      ligament::add(p.torque, c.face.i, Spin<dim>(c.share_i * torque));
      ligament::add(p.torque, c.face.j, Spin<dim>((1 - c.share_i) * torque));
    }
  }
}

template <int dim>
double Contacts<dim>::compression_energy(const Contact<dim> &c, const Particles &p) const
{
  const State s = state(c, p);
  return s.overlap > 0 ? 0.5 * s.stiffness * s.overlap * s.overlap : 0.;
}

template <int dim>
double Contacts<dim>::energy(const Particles &p) const
{
  double sum = 0;
  for (const auto &c : contacts_)
    sum += compression_energy(c, p) + 0.5 * state(c, p).stiffness * c.slip.squaredNorm();
  return sum;
}

template <int dim>
void Contacts<dim>::add_moments(const Particles &p, Components<n_strains<dim>> &moments) const
{
  for_each_moment(p, [&](int i, const Vector<dim> &a, const Vector<dim> &f) {
    ligament::add(moments, i, symmetric_product<dim>(a, f));
  });
}

template <int dim>
bool Contacts<dim>::has_slid(const Particles &p, double distance) const
{
  for (const auto &c : contacts_) {
    const Vector<dim> u = get(p.displacement, c.face.j) - get(p.displacement, c.face.i);
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
                                   return !c.from_face && state(c, p).distance > distance;
                                 }),
                  contacts_.end());
}

template class Contacts<2>;
template class Contacts<3>;
} // namespace ligament::dem
