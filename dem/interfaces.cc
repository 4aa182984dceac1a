#include "dem/interfaces.h"

#include "core/exact_sum.h"
#include "dem/bond_law.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
namespace
{
/// The bonds' part of the system for the pressures: [ii ij; ij jj] between two members.
struct Coupling
{
  int i, j;
  double ii, ij, jj; // m^3/Pa
};

double dot(const std::vector<double> &a, const std::vector<double> &b)
{
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += a[k] * b[k];
  return sum;
}

/// Solves (diagonal + couplings) x = b by conjugate gradients, as far as round-off allows.
std::vector<double> solve_system(const std::vector<double> &diagonal,
                                 const std::vector<Coupling> &couplings,
                                 const std::vector<double> &b)
{
  const std::size_t n = b.size();
  std::vector<double> inverse = diagonal, x(n), r(n), z(n), s(n), product(n);
  for (const Coupling &c : couplings)
    inverse[c.i] += c.ii, inverse[c.j] += c.jj;
  for (double &v : inverse)
    v = v > 0 ? 1 / v : 0; // no volumetric stiffness: no pressure
  const auto multiply = [&](const std::vector<double> &v) {
    for (std::size_t k = 0; k < n; ++k)
      product[k] = diagonal[k] * v[k];
    for (const Coupling &c : couplings) {
      product[c.i] += c.ii * v[c.i] + c.ij * v[c.j];
      product[c.j] += c.ij * v[c.i] + c.jj * v[c.j];
    }
  };
  const auto precondition = [&] {
    for (std::size_t k = 0; k < n; ++k)
      z[k] = inverse[k] * r[k];
  };
  for (std::size_t k = 0; k < n; ++k)
    x[k] = inverse[k] * b[k];
  multiply(x);
  for (std::size_t k = 0; k < n; ++k)
    r[k] = inverse[k] > 0 ? b[k] - product[k] : 0;
  precondition();
  s = z;
  constexpr double round_off = 1e-32; // squared, of the first solution
  double rz = dot(r, z);
  const double enough = round_off * std::max(rz, dot(b, x));
  for (std::size_t k = 0; k < 4 * n + 20 && rz > enough; ++k) {
    multiply(s);
    double curvature = 0;
    for (std::size_t a = 0; a < n; ++a)
      curvature += inverse[a] > 0 ? s[a] * product[a] : 0;
    const double step = rz / curvature;
    for (std::size_t a = 0; a < n; ++a) {
      x[a] += step * s[a];
      r[a] -= inverse[a] > 0 ? step * product[a] : 0;
    }
    precondition();
    const double before = rz;
    rz = dot(r, z);
    for (std::size_t a = 0; a < n; ++a)
      s[a] = z[a] + rz / before * s[a];
  }
  return x;
}
} // namespace

template <int dim>
Interfaces<dim>::Interfaces(const BondedBody<dim> &body, const InelasticStrains<dim> &strains)
    : body_(body), strains_(strains)
{
  const BondNetwork<dim> &bonds = body.bonds();
  bonds.for_each_interface([&](BondId id, const Bond<dim> &b) {
    bonds_.push_back({b, id.index});
    members_.push_back(b.i);
    members_.push_back(b.j);
  });
  if (bonds_.empty())
    return;
  std::sort(members_.begin(), members_.end());
  members_.erase(std::unique(members_.begin(), members_.end()), members_.end());
  member_.assign(bonds.n_particles(), -1);
  for (std::size_t k = 0; k < members_.size(); ++k)
    member_[members_[k]] = int(k);
  if (strains.has_law())
    bonds.for_each_irregular([&](BondId id, const Bond<dim> &b) {
      if (is_member(b.i) || is_member(b.j))
        others_.push_back({b, id.index});
    });
}

template <int dim>
SeriesBond<dim> Interfaces<dim>::series_of(const Bond<dim> &b, const Particles &p) const
{
  return {b, strains_.motion(b, p, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j))};
}

template <int dim>
void Interfaces<dim>::remove(const BondId &id, const Bond<dim> &b, const Particles &)
{
  if (id.direction >= 0)
    return;
  auto &bonds = b.joins_materials ? bonds_ : others_;
  const auto bond = std::find_if(bonds.begin(), bonds.end(),
                                 [&](const IndexedBond &of) { return of.index == id.index; });
  if (bond != bonds.end())
    bonds.erase(bond);
}

template <int dim>
void Interfaces<dim>::add_pressures(const Particles &p, Evaluation<dim> &e) const
{
  if (empty() || !e.body.has_dilatation())
    return;
  std::vector<double> volume(members_.size(), 0.);
  for (std::size_t k = 0; k < members_.size(); ++k)
    if (const double stiffness = e.body.lambda_per_volume()[members_[k]]; stiffness > 0)
      volume[k] = e.pressure[members_[k]] / stiffness;
  solve(volume, p, e);
}

template <int dim>
void Interfaces<dim>::solve(const std::vector<double> &volume, const Particles &p,
                            Evaluation<dim> &e) const
{
  const auto &lambda_per_volume = e.body.lambda_per_volume();
  const std::size_t n = members_.size();
  std::vector<double> diagonal(n, 0.), b(n, 0.);
  for (std::size_t k = 0; k < n; ++k)
    if (const double stiffness = lambda_per_volume[members_[k]]; stiffness > 0) {
      diagonal[k] = 1 / stiffness;
      b[k] = volume[k];
    }
  std::vector<Coupling> couplings;
  for (const auto &[bond, index] : bonds_) {
    const auto c = series_of(bond, p).coupling();
    const int i = member_[bond.i], j = member_[bond.j];
    const bool has_i = diagonal[i] > 0, has_j = diagonal[j] > 0;
    couplings.push_back({i, j, has_i ? c.ii : 0., has_i && has_j ? c.ij : 0., has_j ? c.jj : 0.});
    b[i] += has_i ? c.of_motion_i : 0;
    b[j] += has_j ? c.of_motion_j : 0;
  }
  const std::vector<double> solution = solve_system(diagonal, couplings, b);
  for (std::size_t k = 0; k < n; ++k)
    e.pressure[members_[k]] = solution[k];
}

template <int dim>
void Interfaces<dim>::add_strains(const Particles &p, Evaluation<dim> &e) const
{
  if (empty())
    return;
  FlowingInterfaces<dim> &at = e.interfaces;
  at.of_surface.clear();
  at.strain.clear();
  at.viscous.clear();
  for (const int i : members_) {
    at.of_surface.push_back(InelasticStrains<dim>::cell_strain(*e.inelastic, i));
    at.strain.push_back(strains_.tensor(i));
    at.viscous.push_back(strains_.viscous_strain(i));
  }
  divide(p, e);
  for (std::size_t k = 0; k < bonds_.size(); ++k) {
    const Bond<dim> &b = bonds_[k].bond;
    const auto [of_i, of_j] = strain_of(b, p, at.whole[k]);
    InelasticStrains<dim>::add_strain(*e.inelastic, b.i, of_i);
    InelasticStrains<dim>::add_strain(*e.inelastic, b.j, of_j);
  }
}

template <int dim>
void Interfaces<dim>::divide(const Particles &p, Evaluation<dim> &e) const
{
  FlowingInterfaces<dim> &at = e.interfaces;
  std::vector<double> volume;
  for (std::size_t k = 0; k < members_.size(); ++k)
    volume.push_back(at.of_surface[k].trace() - strains_.flowed_volume(members_[k]));
  const auto add_to = [&](int i, double change) {
    if (const int k = member_[i]; k >= 0)
      volume[k] += change;
  };
  for (const auto &[b, index] : others_) {
    const auto m = strains_.motion(b, p, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j));
    add_to(b.i, law_of(b).add_dilatation(m.du, m.a_i, 0));
    add_to(b.j, law_of(b).add_dilatation(Vector<dim>(-m.du), m.a_j, 0));
  }
  for (const auto &[b, index] : bonds_) // the rest of Du alone counts there
    for (const int i : {b.i, b.j})
      add_to(i, strains_.flowed_volume(b, i));
  if (e.body.has_dilatation())
    solve(volume, p, e);
  at.pressure.clear();
  for (const int i : members_)
    at.pressure.push_back(e.pressure[i]);
  at.whole.clear();
  for (const auto &[b, index] : bonds_)
    at.whole.push_back(whole(b, p, e));
}

template <int dim>
std::array<Vector<dim>, 2> Interfaces<dim>::whole(const Bond<dim> &b, const Particles &p,
                                                  const Evaluation<dim> &e) const
{
  const auto s = series_of(b, p);
  const double p_i = e.pressure[b.i], p_j = e.pressure[b.j];
  const Vector<dim> t = s.traction(p_i, p_j);
  return {s.whole_i(t, p_i), s.whole_j(t, p_j)};
}

template <int dim>
auto Interfaces<dim>::strain_of(const Bond<dim> &b, const Particles &p,
                                const std::array<Vector<dim>, 2> &whole) const
    -> std::array<Matrix, 2>
{
  const auto side = [&](int i, const Vector<dim> &motion, const Vector<dim> &lever, double q) {
    const Vector<dim> own = motion + Turn<dim>::of(p, i).inverse().change(motion);
    return Matrix(b.area / q * own * lever.transpose());
  };
  return {side(b.i, whole[0], b.lever_i, b.lever_i.dot(b.normal)),
          side(b.j, Vector<dim>(-whole[1]), b.lever_j, -b.lever_j.dot(b.normal))};
}

// The members have the e that they answered with; those of others divide Du, too.
template <int dim>
void Interfaces<dim>::follow_flow(const Particles &p, Evaluation<dim> &e) const
{
  if (empty() || !e.inelastic)
    return;
  FlowingInterfaces<dim> &at = e.interfaces;
  bool have_flowed = false;
  std::vector<double> seen;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    seen.push_back(e.pressure[members_[k]]);
    have_flowed = have_flowed || strains_.tensor(members_[k]) != at.strain[k];
  }
  if (!have_flowed) {
    for (std::size_t k = 0; k < members_.size(); ++k)
      e.pressure[members_[k]] = at.pressure[k];
    return;
  }
  const auto before = at.whole;
  divide(p, e);
  std::vector<Matrix> change(members_.size(), Matrix::Zero());
  for (std::size_t k = 0; k < bonds_.size(); ++k) {
    const Bond<dim> &b = bonds_[k].bond;
    const auto [of_i, of_j] =
        strain_of(b, p, {at.whole[k][0] - before[k][0], at.whole[k][1] - before[k][1]});
    change[member_[b.i]] += of_i;
    change[member_[b.j]] += of_j;
  }
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const int i = members_[k];
    strains_.follow_stress(i, strains_.stress_change(i, change[k], e.pressure[i] - seen[k]),
                           at.strain[k], at.viscous[k]);
    at.strain[k] = strains_.tensor(i);
    at.viscous[k] = strains_.viscous_strain(i);
  }
}

template <int dim>
auto Interfaces<dim>::own_stresses(
    const Particles &p, const Evaluation<dim> &e,
    const std::function<void(const VisitStrain &)> &for_each_strain) const -> std::vector<Tensor>
{
  if (!strains_.has_law())
    return {};
  std::vector<Matrix> x(members_.size(), Matrix::Zero());
  for (const auto &[b, index] : others_)
    for (const int i : {b.i, b.j})
      if (const int k = member_[i]; k >= 0)
        x[k] += strains_.face_strain(b, i, p);
  for (const auto &[b, index] : bonds_) {
    const auto [of_i, of_j] = strain_of(b, p, whole(b, p, e));
    x[member_[b.i]] += of_i;
    x[member_[b.j]] += of_j;
  }
  for_each_strain([&](int i, const Matrix &strain) {
    if (is_member(i))
      x[member_[i]] += strain;
  });
  std::vector<Tensor> stress;
  for (std::size_t k = 0; k < members_.size(); ++k)
    stress.push_back(strains_.stress_of(members_[k], x[k], e.pressure[members_[k]]));
  return stress;
}

template <int dim>
void Interfaces<dim>::take_pressures(const Particles &p, Evaluation<dim> &e) const
{
  const auto &lambda_per_volume = e.body.lambda_per_volume();
  std::vector<double> part(members_.size(), 0.);
  for (const auto &[bond, index] : bonds_) {
    const auto s = series_of(bond, p);
    const double p_i = e.pressure[bond.i], p_j = e.pressure[bond.j];
    const Vector<dim> t = s.traction(p_i, p_j);
    part[member_[bond.i]] += lambda_per_volume[bond.i] * s.dilatation_i(t, p_i);
    part[member_[bond.j]] += lambda_per_volume[bond.j] * s.dilatation_j(t, p_j);
  }
  for (std::size_t k = 0; k < members_.size(); ++k)
    e.pressure[members_[k]] -= part[k];
}

template <int dim>
void Interfaces<dim>::add_forces(Particles &p, Evaluation<dim> &e) const
{
  for (const auto &[b, index] : bonds_) {
    const auto s = series_of(b, p);
    const double p_i = e.pressure[b.i], p_j = e.pressure[b.j];
    const Vector<dim> t = s.traction(p_i, p_j), f = b.area * t;
    const Spin<dim> bend = bending_torque(b, p);
    add(p.force, b.i, f);
    add(p.force, b.j, Vector<dim>(-f));
    add(p.torque, b.i, Spin<dim>(s.torque_i(t, p_i) + bend));
    add(p.torque, b.j, Spin<dim>(s.torque_j(t, p_j) - bend));
  }
}

template <int dim>
void Interfaces<dim>::add_energies(const Particles &p, Evaluation<dim> &e,
                                   std::vector<double> &energy) const
{
  for (const auto &[b, index] : bonds_) {
    const auto s = series_of(b, p);
    const double p_i = e.pressure[b.i], p_j = e.pressure[b.j];
    energy[b.i] += s.whole_energy(s.traction(p_i, p_j), p_i, p_j) + bending_energy(b, p);
  }
}

template <int dim>
double Interfaces<dim>::energy(const Particles &p, const Evaluation<dim> &e) const
{
  core::ExactSum sum;
  for (const auto &[b, index] : bonds_) {
    const auto s = series_of(b, p);
    const double p_i = e.pressure[b.i], p_j = e.pressure[b.j];
    sum.add(s.energy(s.traction(p_i, p_j), p_i, p_j) + bending_energy(b, p));
  }
  for (const int i : members_)
    sum.add(e.body.volume_energy(i, e.pressure[i]));
  return sum.value();
}

template class Interfaces<2>;
template class Interfaces<3>;
} // namespace ligament::dem
