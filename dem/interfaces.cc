#include "dem/interfaces.h"

#include "core/exact_sum.h"
#include "dem/bond_law.h"
#include "dem/laws/series_bond.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
namespace
{
template <int dim>
SeriesBond<dim> series_of(const Bond<dim> &b, const particles::Particles<dim> &p)
{
  return {b, BondMotion<dim>(b, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j),
                             get(p.displacement, b.i), get(p.displacement, b.j))};
}

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
std::vector<double> solve(const std::vector<double> &diagonal,
                          const std::vector<Coupling> &couplings, const std::vector<double> &b)
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
Interfaces<dim>::Interfaces(const BondNetwork<dim> &bonds)
{
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
}

template <int dim>
void Interfaces<dim>::remove(const BondId &id, const Bond<dim> &b, const Particles &)
{
  if (b.joins_materials)
    bonds_.erase(std::find_if(bonds_.begin(), bonds_.end(),
                              [&](const IndexedBond &bond) { return bond.index == id.index; }));
}

template <int dim>
void Interfaces<dim>::add_pressures(const Particles &p, Evaluation<dim> &e) const
{
  if (empty() || !e.body.has_dilatation())
    return;
  const auto &lambda_per_volume = e.body.lambda_per_volume();
  const std::size_t n = members_.size();
  std::vector<double> diagonal(n, 0.), b(n, 0.);
  for (std::size_t k = 0; k < n; ++k) {
    const double stiffness = lambda_per_volume[members_[k]];
    diagonal[k] = stiffness > 0 ? 1 / stiffness : 0;
    b[k] = diagonal[k] * e.pressure[members_[k]];
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
  const std::vector<double> solution = solve(diagonal, couplings, b);
  for (std::size_t k = 0; k < n; ++k)
    e.pressure[members_[k]] = solution[k];
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
    energy[b.i] += s.energy(s.traction(p_i, p_j), p_i, p_j) + bending_energy(b, p);
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
