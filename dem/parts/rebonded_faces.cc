#include "dem/parts/rebonded_faces.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
int RebondedFaces<dim>::n_bonds() const
{
  return int(std::count_if(faces_.begin(), faces_.end(),
                           [](const auto &face) { return face.second.acts; }));
}

template <int dim>
std::optional<Rebonding> RebondedFaces<dim>::rule(int i, int j) const
{
  const Materials &materials = body_.materials();
  const Rebonding &a = rules_[materials.number(i)], &b = rules_[materials.number(j)];
  if (!a.is_on() || !b.is_on() || materials.differ(i, j) || body_.energy_weight(i) != 1 ||
      body_.energy_weight(j) != 1)
    return std::nullopt;
  for (const auto &[k, of] : {std::pair(i, a), std::pair(j, b)})
    if (strains_.has_law() && (strains_.history(k) < of.plastic_strain || !strains_.is_open(k)))
      return std::nullopt;
  return between(a, b);
}

template <int dim>
void RebondedFaces<dim>::look(const Particles &p, const std::vector<double> &pressure, double time)
{
  if (!is_on() || looked_at_ == time)
    return;
  looked_at_ = time;
  const auto &contacts = contacts_.contacts();
  for (std::size_t k = 0; k < contacts.all().size(); ++k) {
    const Contact<dim> &c = contacts.all()[k];
    if (c.is_bonded || c.face.image)
      continue;
    const auto rule = this->rule(c.face.i, c.face.j);
    if (!rule)
      continue;
    const auto pressed = contacts.pressed(k, p);
    if (pressed && pressed->pressure >= rule->pressure) {
      const auto face = make(c, *pressed, p, pressure, rule->strength);
      if (!face)
        continue;
      faces_.emplace(c.name, *face);
      has_new_ = true;
    }
  }
}

// Opening and couple are what is missing of the contact's force and torque: the levers meet, so
// that the gap is none.
template <int dim>
auto RebondedFaces<dim>::make(const Contact<dim> &c, const PressedContact<dim> &pressed,
                              const Particles &p, const std::vector<double> &pressure,
                              double strength) const -> std::optional<Face>
{
  const int i = c.face.i, j = c.face.j;
  const auto turn_i = Turn<dim>::of(p, i), turn_j = Turn<dim>::of(p, j);
  Face face{};
  face.i = i, face.j = j;
  face.turns_with_i = p.global_id[i] < p.global_id[j];
  face.lever_i = in_own_axes<dim>(turn_i, pressed.lever_i);
  face.lever_j = in_own_axes<dim>(turn_j, pressed.lever_j);
  face.normal_i = in_own_axes<dim>(turn_i, pressed.normal);
  face.normal_j = in_own_axes<dim>(turn_j, pressed.normal);
  face.area = pressed.area;
  face.distance = pressed.distance;
  face.shear_modulus = c.shear_modulus;
  const DemMaterial &of_i = body_.materials().of(i), &of_j = body_.materials().of(j);
  face.bending =
      in_series(of_i.template bending_stiffness<dim>(face.area, face.distance, thickness_),
                of_j.template bending_stiffness<dim>(face.area, face.distance, thickness_), 0.5);
  face.twist = of_i.twisting_stiffness(face.area, face.distance);
  face.strength = strength;
  face.friction = c.friction;
  face.opening = Vector<dim>::Zero();
  face.pressure_i = pressure[i];
  face.pressure_j = pressure[j];

  // The force without opening, and what it lacks.
  const RebondedState<dim> bare = state(face, p);
  const Vector<dim> lacking = pressed.force - bare.force(pressure[i], pressure[j]);
  face.opening =
      in_own_axes<dim>(face.turns_with_i ? turn_i : turn_j, Vector<dim>(-lacking / bare.law.shear));
  const RebondedState<dim> now = state(face, p);
  face.flowed = now.normal().dot(now.stretch_i - now.stretch_j);
  const Spin<dim> couple = pressed.torque - now.torques(pressure[i], pressure[j])[0];
  if (couple.norm() > largest_turn * least_bending(face))
    return std::nullopt;
  set_couple(face, p, couple);

  // With these strains a face that adds them and one that is not there are the same, eq. (D45).
  const auto settle = [&](bool of_i, const Matrix &moved) {
    const int k = of_i ? i : j;
    const Matrix m = face.moment(of_i), flowed = strains_.strain(k) * m - moved;
    const double shear = body_.materials().of(k).shear_modulus();
    return Matrix(0.5 * (flowed + flowed.transpose()) - pressure[k] / (2 * shear) * m);
  };
  const Matrix strain_i = settle(true, now.strain_i()), strain_j = settle(false, now.strain_j());
  face.strain_i = strain_i;
  face.strain_j = strain_j;
  face.gained = own_energy(state(face, p), p) - pressed.energy;
  return face;
}

template <int dim>
void RebondedFaces<dim>::take_part(const Particles &p)
{
  std::map<int, double> shares;
  std::vector<OtherFace<dim>> cells;
  for (const auto &[name, face] : faces_) {
    if (!face.acts)
      continue;
    const Matrix m_i = face.moment(true), m_j = face.moment(false);
    shares[face.i] += m_i.trace() / p.volume[face.i];
    shares[face.j] += m_j.trace() / p.volume[face.j];
    cells.push_back({face.i, face.j, m_i, m_j});
    body_.add_other_particle(face.i);
    body_.add_other_particle(face.j);
  }
  body_.set_other_shares(shares, p);
  strains_.set_other_faces(cells, p);
}

template <int dim>
void RebondedFaces<dim>::begin(const Particles &p)
{
  if (!has_new_)
    return;
  has_new_ = false;
  std::map<int, double> shares = body_.other_shares();
  for (auto &[name, face] : faces_) {
    if (face.acts)
      continue;
    face.acts = true;
    contacts_.bond(name);
    energy_.add(-face.gained);
    for (const bool of_i : {true, false}) {
      const int i = of_i ? face.i : face.j;
      double &share = shares[i];
      const double before = body_.lambda_per_volume_with(i, share, p.volume[i]);
      share += face.moment(of_i).trace() / p.volume[i];
      energy_.add(-settle(face, of_i, before, body_.lambda_per_volume_with(i, share, p.volume[i])));
    }
  }
  take_part(p);
}

// The pressure stays, though the volume is softer or stiffer. Eq. (D9) says by how much, but where
// phi is cut off.
template <int dim>
double RebondedFaces<dim>::settle(Face &face, bool of_i, double before, double after) const
{
  if (before == 0 || after == 0)
    return 0;
  const int i = of_i ? face.i : face.j;
  const double pressure = of_i ? face.pressure_i : face.pressure_j,
               shear = body_.materials().of(i).shear_modulus(), softer = 1 / after - 1 / before,
               off = pressure * (softer + face.moment(of_i).trace() / (2 * shear));
  (of_i ? face.strain_i : face.strain_j) += off / dim * Matrix::Identity();
  return 0.5 * pressure * pressure * softer - 2 * shear * off / dim * strains_.strain(i).trace();
}

template <int dim>
double RebondedFaces<dim>::strained_energy(const RebondedState<dim> &s, bool of_i) const
{
  const int i = of_i ? s.face.i : s.face.j;
  const Matrix e = strains_.strain(i), x = of_i ? s.strain_i() : s.strain_j();
  const double shear = body_.materials().of(i).shear_modulus();
  return shear * ((e * e).cwiseProduct(s.face.moment(of_i)).sum() - 2 * e.cwiseProduct(x).sum());
}

template <int dim>
double RebondedFaces<dim>::own_energy(const RebondedState<dim> &s, const Particles &p) const
{
  return s.shear_energy() + couple_energy(s.face, p) + strained_energy(s, true) +
         strained_energy(s, false);
}

template <int dim>
auto RebondedFaces<dim>::torn(const Particles &p, const std::vector<double> &pressure) const
    -> std::vector<Name>
{
  std::vector<Name> found;
  for (const auto &[name, face] : faces_) {
    if (!face.acts)
      continue;
    const RebondedState<dim> s = state(face, p);
    const Vector<dim> traction = s.force(pressure[face.i], pressure[face.j]) / face.area,
                      n = s.normal();
    const double normal = n.dot(traction);
    if (adhesion_utilisation(normal, (traction - normal * n).norm(), face.strength,
                             face.friction) >= 1)
      found.push_back(name);
  }
  return found;
}

template <int dim>
double RebondedFaces<dim>::local_energy(const Name &name, const Particles &p,
                                        const std::vector<double> &pressure) const
{
  const Face &face = faces_.at(name);
  return own_energy(state(face, p), p) + body_.volume_energy(face.i, pressure[face.i]) +
         body_.volume_energy(face.j, pressure[face.j]);
}

template <int dim>
double RebondedFaces<dim>::part(const Name &name, Particles &p, std::vector<double> &pressure,
                                bool takes_over, double dt)
{
  const Face face = faces_.at(name);
  const RebondedState<dim> s = state(face, p);
  const Vector<dim> force = s.force(pressure[face.i], pressure[face.j]);
  const bool presses = force.dot(s.normal()) < 0;
  const double grown = s.normal().dot(s.stretch_i - s.stretch_j) - face.flowed;
  faces_.erase(name);
  const std::array<Matrix, 2> lost = {s.strain_i(), s.strain_j()};
  std::array<double, 2> before, volume;
  for (const int side : {0, 1}) {
    const int i = side == 0 ? face.i : face.j;
    const double lambda = body_.lambda_per_volume()[i];
    before[side] = pressure[i];
    if (lambda != 0)
      volume[side] = pressure[i] / lambda - lost[side].trace() +
                     strains_.strain(i).cwiseProduct(face.moment(side == 0)).sum();
  }
  take_part(p);
  for (const int side : {0, 1}) {
    const int i = side == 0 ? face.i : face.j;
    const double lambda = body_.lambda_per_volume()[i];
    if (lambda != 0)
      pressure[i] = lambda * volume[side];
    strains_.forget(i, face.moment(side == 0), lost[side], before[side], pressure[i]);
  }
  const double of_contact = contacts_.act_parted(
      name, takes_over && presses ? force : Vector<dim>(Vector<dim>::Zero()), grown, p, dt);
  return of_contact + body_.volume_energy(face.i, pressure[face.i]) +
         body_.volume_energy(face.j, pressure[face.j]);
}

template <int dim>
void RebondedFaces<dim>::add_neighbours(int particle, std::vector<int> &to) const
{
  for (const auto &[name, face] : faces_)
    if (face.acts && (face.i == particle || face.j == particle))
      to.push_back(face.i == particle ? face.j : face.i);
}

template <int dim>
void RebondedFaces<dim>::add_pressures(const Particles &p, Evaluation<dim> &e) const
{
  if (!body_.has_dilatation())
    return;
  const auto &lambda = body_.lambda_per_volume();
  for (const auto &[name, face] : faces_) {
    if (!face.acts)
      continue;
    const RebondedState<dim> s = state(face, p);
    e.pressure[face.i] += lambda[face.i] * s.volume_i();
    e.pressure[face.j] += lambda[face.j] * s.volume_j();
  }
}

template <int dim>
void RebondedFaces<dim>::add_strains(const Particles &p, Evaluation<dim> &e) const
{
  for (const auto &[name, face] : faces_) {
    if (!face.acts)
      continue;
    const RebondedState<dim> s = state(face, p);
    InelasticStrains<dim>::add_strain(*e.inelastic, face.i, s.strain_i());
    InelasticStrains<dim>::add_strain(*e.inelastic, face.j, s.strain_j());
  }
}

template <int dim>
void RebondedFaces<dim>::add_forces(Particles &p, Evaluation<dim> &e) const
{
  for (const auto &[name, face] : faces_) {
    if (!face.acts)
      continue;
    const double p_i = e.pressure[face.i], p_j = e.pressure[face.j];
    const RebondedState<dim> s = state(face, p);
    const Vector<dim> f = s.force(p_i, p_j);
    const auto torques = s.torques(p_i, p_j);
    const Spin<dim> bend = couple(face, p);
    ligament::add(p.force, face.i, f);
    ligament::add(p.force, face.j, Vector<dim>(-f));
    ligament::add(p.torque, face.i, Spin<dim>(torques[0] + bend));
    ligament::add(p.torque, face.j, Spin<dim>(torques[1] - bend));
  }
}

template <int dim>
void RebondedFaces<dim>::add_force_on(int i, const Particles &p, const Evaluation<dim> &e,
                                      Wrench<dim> &wrench) const
{
  for (const auto &[name, face] : faces_) {
    if (!face.acts || (face.i != i && face.j != i))
      continue;
    const double p_i = e.pressure[face.i], p_j = e.pressure[face.j];
    const RebondedState<dim> s = state(face, p);
    const double sign = face.i == i ? 1 : -1;
    wrench.force += sign * s.force(p_i, p_j);
    wrench.torque += s.torques(p_i, p_j)[face.i == i ? 0 : 1] + sign * couple(face, p);
  }
}

// What strains of the particles change is counted with these.
template <int dim>
void RebondedFaces<dim>::add_energies(const Particles &p, Evaluation<dim> &,
                                      std::vector<double> &energy) const
{
  for (const auto &[name, face] : faces_)
    if (face.acts)
      energy[face.i] += state(face, p).shear_energy() + couple_energy(face, p);
}

template <int dim>
void RebondedFaces<dim>::for_each_moment(const Particles &p, const Evaluation<dim> &e,
                                         const VisitMoment<dim> &visit) const
{
  for (const auto &[name, face] : faces_) {
    if (!face.acts)
      continue;
    const RebondedState<dim> s = state(face, p);
    const Vector<dim> f = s.force(e.pressure[face.i], e.pressure[face.j]);
    visit(face.i, s.a_i, f);
    visit(face.j, s.a_j, Vector<dim>(-f));
  }
}

template class RebondedFaces<2>;
template class RebondedFaces<3>;
} // namespace ligament::dem
