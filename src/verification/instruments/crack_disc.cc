#include "src/verification/instruments/crack_disc.h"

#include "core/extremes.h"
#include "md/crystal_packing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
/// m, of the crystal along z, often enough for its atoms not to see themselves.
double period_along_front(const md::Crystal<3> &crystal)
{
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto &b : crystal.half_bonds())
    if (b.head<2>().norm() < 1e-6 * b.norm())
      shortest = std::min(shortest, b.norm());
  core::require(std::isfinite(shortest), "no row of atoms lies along the front of the crack");
  return std::ceil(2.2 * crystal.potential().cutoff() / shortest) * shortest;
}

packings::Packing<3> disc_box(const md::Crystal<3> &crystal, double radius, double period)
{
  md::CrystalShape<3> shape;
  shape.lower = {-radius, -radius, -period / 2};
  shape.upper = -shape.lower;
  shape.periodic = {false, false, true};
  double plane = radius; // distance of planes across y
  for (const auto &b : crystal.half_bonds())
    if (std::abs(b[1]) > 1e-3 * b.norm())
      plane = std::min(plane, std::abs(b[1]));
  shape.anchor = {0, plane / 2, 0};
  return md::cut_crystal<3>(crystal, shape);
}
} // namespace

CrackDisc::CrackDisc(const md::Crystal<3> &crystal, double radius)
    : period_(period_along_front(crystal)), limit_(1.35 * crystal.spacing()),
      griffith_k_(
          md::griffith_crack(crystal, Vector<3>::Unit(1), Vector<3>::Unit(2))->stress_intensity),
      field_(crystal.elastic_constants().stiffness), packing_(disc_box(crystal, radius, period_)),
      atoms_(md::make_atoms<3>(crystal, packing_)), force_(crystal, packing_)
{
  const double inner = radius - 2 * crystal.potential().cutoff();
  const auto is_free = [&](int i) { return get(atoms_.reference, i).head<2>().norm() < inner; };
  for (int i = 0; i < atoms_.size(); ++i)
    if (is_free(i))
      free_.push_back(i);
  force_.for_each_neighbour(atoms_, [&](const particles::Neighbour &n) {
    const Vector<3> a = get(atoms_.reference, n.i);
    Vector<3> way = get(atoms_.reference, n.j) - a;
    way[2] -= period_ * std::round(way[2] / period_);
    if (is_free(n.i) && way.norm() < 1.05 * crystal.spacing())
      bonds_.push_back({n.i, n.j, a[0] + way[0] / 2, a[1] * (a[1] + way[1]) < 0});
  });
}

void CrackDisc::load(double share)
{
  for (int i = 0; i < atoms_.size(); ++i) {
    const Vector<2> u = field_.displacement(get(atoms_.reference, i).head<2>());
    for (int c = 0; c < 2; ++c)
      atoms_.displacement[c][i] += (share - share_) * griffith_k_ * u[c];
  }
  share_ = share;
  relax();
}

// E. Bitzek, P. Koskinen, F. Gaehler, M. Moseler, P. Gumbsch, Phys. Rev. Lett. 97 (2006) 170201.
void CrackDisc::relax()
{
  constexpr double tolerance = 2e-3 * 1.602176634e-9; // N
  const double start = 0.2 * force_.stable_step(atoms_), reach = 1e-11, mass = atoms_.mass[0];
  for (auto &v : atoms_.velocity)
    std::fill(v.begin(), v.end(), 0.0);
  double dt = start, mixing = 0.1;
  for (int n = 0, downhill = 0; n < 4000; ++n) {
    force_.compute(atoms_, 0);
    double power = 0, speed = 0, pull = 0, largest = 0;
    for (int c = 0; c < 3; ++c)
      for (const int i : free_) {
        const double f = atoms_.force[c][i], v = atoms_.velocity[c][i];
        power += f * v;
        speed += v * v;
        pull += f * f;
        keep_largest(largest, std::abs(f));
      }
    if (largest < tolerance)
      return;
    const bool stops = power <= 0 && n > 0;
    downhill = stops ? 0 : downhill + 1;
    const double keep = stops ? 0 : 1 - mixing, turn = stops ? 0 : mixing * std::sqrt(speed / pull);
    double fastest = 0;
    for (int c = 0; c < 3; ++c)
      for (const int i : free_) {
        double &v = atoms_.velocity[c][i];
        v = keep * v + (turn + dt / mass) * atoms_.force[c][i];
        keep_largest(fastest, std::abs(v));
      }
    const double way = std::min(dt, reach / std::max(fastest, 1e-300));
    for (int c = 0; c < 3; ++c)
      for (const int i : free_)
        atoms_.displacement[c][i] += way * atoms_.velocity[c][i];
    if (stops) {
      dt /= 2;
      mixing = 0.1;
    } else if (downhill > 5) {
      dt = std::min(1.1 * dt, 4 * start);
      mixing *= 0.99;
    }
  }
}

bool CrackDisc::is_parted(const Bond &bond) const
{
  Vector<3> way = get(atoms_.reference, bond.j) - get(atoms_.reference, bond.i);
  way[2] -= period_ * std::round(way[2] / period_);
  way += get(atoms_.displacement, bond.j) - get(atoms_.displacement, bond.i);
  return way.norm() > limit_;
}

double CrackDisc::tip() const
{
  double x = -std::numeric_limits<double>::infinity();
  for (const Bond &bond : bonds_)
    if (bond.across && bond.x > x && is_parted(bond))
      x = bond.x;
  return x;
}

int CrackDisc::slipped() const
{
  return int(std::count_if(bonds_.begin(), bonds_.end(),
                           [&](const Bond &b) { return !b.across && is_parted(b); }));
}
} // namespace ligament::program
