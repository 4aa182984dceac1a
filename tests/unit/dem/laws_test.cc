// Each law is one text: on lanes it says what it says on doubles, and its form for whole lattices
// is that of single bonds.
#include "dem/bond_law.h"

#include <gtest/gtest.h>

#include <random>

namespace ligament::dem::HWY_NAMESPACE
{
namespace
{
constexpr double round_off = 1e-14;

struct Random
{
  std::mt19937 engine{3};
  std::uniform_real_distribution<double> uniform{-1, 1};

  template <int dim>
  Vector<dim> vector()
  {
    return Vector<dim>::NullaryExpr([&] { return uniform(engine); });
  }
  double positive() { return 1.5 + uniform(engine); }
  Quaternion<double> turn()
  {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(positive(), vector<3>().normalized()));
    return {q.w(), {q.x(), q.y(), q.z()}};
  }
};

using D = hn::CappedTag<double, 4>;
using V = hn::Vec<D>;

V lanes(double value)
{
  return hn::Set(D(), value);
}
Pair<V> lanes(const Vector<2> &v)
{
  return {lanes(v[0]), lanes(v[1])};
}
Triple<V> lanes(const Vector<3> &v)
{
  return {lanes(v[0]), lanes(v[1]), lanes(v[2])};
}
void expect_lanes(V lanes, double value)
{
  EXPECT_NEAR(hn::GetLane(lanes), value, 10 * round_off);
}
void expect_lanes(const Pair<V> &lanes, const Vector<2> &v)
{
  expect_lanes(lanes.x, v[0]), expect_lanes(lanes.y, v[1]);
}
void expect_lanes(const Triple<V> &lanes, const Vector<3> &v)
{
  expect_lanes(lanes.x, v[0]), expect_lanes(lanes.y, v[1]), expect_lanes(lanes.z, v[2]);
}
V none(const Pair<V> &)
{
  return lanes(0.);
}
Triple<V> none(const Triple<V> &)
{
  return lanes(Vector<3>(Vector<3>::Zero()));
}
void expect_torque(V lanes, const Spin<2> &torque)
{
  expect_lanes(lanes, torque[0]);
}
void expect_torque(const Triple<V> &lanes, const Spin<3> &torque)
{
  expect_lanes(lanes, torque);
}

template <int dim>
void compare_lanes()
{
  Random random;
  const Vector<dim> du = random.vector<dim>(), a_i = random.vector<dim>(),
                    a_j = random.vector<dim>();
  const double p_i = random.positive(), p_j = random.positive();
  const BondLaw<dim> law{random.positive(), random.positive()};
  const ElasticBond<V, decltype(lanes(du))> of_lanes{lanes(law.shear), lanes(law.area_r)};
  const Vector<dim> f = law.force(du, p_i, a_i, p_j, a_j);
  const auto f_lanes = of_lanes.force(lanes(du), lanes(p_i), lanes(a_i), lanes(p_j), lanes(a_j));
  expect_lanes(f_lanes, f);
  expect_torque(of_lanes.add_torque(f_lanes, lanes(du), lanes(p_i), lanes(a_i), none(f_lanes)),
                law.add_torque(f, du, p_i, a_i, Spin<dim>(Spin<dim>::Zero())));
  expect_lanes(of_lanes.add_dilatation(lanes(du), lanes(a_i), lanes(0.3)),
               law.add_dilatation(du, a_i, 0.3));
  expect_lanes(of_lanes.twice_energy(lanes(du)), law.twice_energy(du));
}

/// Levers q n and -q n, turned by h: force, torque, dilatation and energy.
template <int dim>
void compare_lattice()
{
  Random random;
  const Vector<dim> n = random.vector<dim>().normalized(), h_i = random.vector<dim>(),
                    h_j = random.vector<dim>(), u = random.vector<dim>();
  const double p_i = random.positive(), p_j = random.positive(), q = random.positive();
  const BondLaw<dim> law{random.positive(), random.positive()};
  const LatticeBonds lattice{law.shear, q, law.shear * q, law.area_r * q};
  const Vector<dim> a_i = q * (n + h_i), a_j = -q * (n + h_j),
                    du = u - q * (h_i + h_j); // the change of a_j less that of a_i
  const Vector<dim> relative = lattice.relative(u, Vector<dim>(h_i + h_j));
  EXPECT_LT((relative - du).norm(), round_off);

  const Vector<dim> g =
      lattice.part(lattice.pressing(p_i), n, h_i) + lattice.part(lattice.pressing(p_j), n, h_j);
  const Vector<dim> f = law.force(du, p_i, a_i, p_j, a_j);
  EXPECT_LT((lattice.force(u, g) - f).norm(), 100 * round_off);
  const Vector<dim> without = lattice.part(h_i) + lattice.part(h_j);
  EXPECT_LT((lattice.force(u, without) - law.force(du, 0, a_i, 0, a_j)).norm(), 100 * round_off);

  const Spin<dim> zero = Spin<dim>::Zero(), of_force = q * cross(Vector<dim>(n + h_i), f),
                  of_motion = cross(Vector<dim>(n + h_i), du);
  const Spin<dim> torque = of_force - lattice.pressing(p_i) * of_motion;
  EXPECT_LT((law.add_torque(f, du, p_i, a_i, zero) - torque).norm(), 100 * round_off);

  const double lambda_per_volume = random.positive();
  EXPECT_NEAR(lattice.pressure(lambda_per_volume, (n + h_i).dot(du), 0.),
              lambda_per_volume * law.add_dilatation(du, a_i, 0), 100 * round_off);
  EXPECT_NEAR(lattice.twice_energy(du.squaredNorm()), law.twice_energy(du), 100 * round_off);
}

Vector<3> vector(const Triple<double> &v)
{
  return {v.x, v.y, v.z};
}
} // namespace

TEST(Laws, LanesSayWhatDoublesSay)
{
  compare_lanes<2>();
  compare_lanes<3>();
}

TEST(Laws, LatticeBondsAreSingleBonds)
{
  compare_lattice<2>();
  compare_lattice<3>();
}

/// In the plane the parts of g along n and across it are those of the whole vector.
TEST(Laws, PartsAlongTheNormalAreThoseOfTheVector)
{
  Random random;
  const LatticeBonds law{1.3, 0.7, 1.3 * 0.7, 0.4};
  const Vector<2> n = random.vector<2>().normalized(), across(-n[1], n[0]);
  const Pair<double> h{0.2, -0.5};
  const Vector<2> whole = law.part(0.9, n, Vector<2>(h.x * n + h.y * across));
  const Pair<double> parts = law.part_along(0.9, h);
  EXPECT_NEAR(parts.x, whole.dot(n), round_off);
  EXPECT_NEAR(parts.y, whole.dot(across), round_off);
}

/// The sum over the two neighbours along n of the couples of single bonds, turned into space.
TEST(Laws, LatticeBendingIsThatOfSingleBonds)
{
  Random random;
  const Quaternion<double> i = random.turn(), forward = random.turn(), backward = random.turn();
  const Vector<3> n = random.vector<3>().normalized();
  const SpaceBending<double> law{random.positive(), -0.3 * random.positive()};
  Vector<3> couple = Vector<3>::Zero();
  for (const auto &[j, sign] : {std::pair(forward, 1.), std::pair(backward, -1.)})
    couple = law.add_half_couple(Vector<3>(sign * n), i.w * j.w + vector(i.v).dot(vector(j.v)),
                                 relative_turn(i.w, vector(i.v), j.w, vector(j.v)), couple);
  const Vector<3> body = 2 * couple, expected = body + Turn<3>{i.w, vector(i.v)}.change(body);

  const auto of = [](const Quaternion<double> &q) -> Quaternion<V> {
    return {lanes(q.w), lanes(vector(q.v))};
  };
  const auto all = [](V v) { return v; };
  LatticeBending<V> sum(lanes(0.));
  sum.add(of(i), lanes(n), of(forward), all, of(backward), all);
  expect_lanes(sum.add_torque(of(i), lanes(2 * law.bending), lanes(2 * law.twist),
                              lanes(Vector<3>(Vector<3>::Zero()))),
               expected);
}
} // namespace ligament::dem::HWY_NAMESPACE
