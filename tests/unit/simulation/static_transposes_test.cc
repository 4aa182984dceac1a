// Motions z = T y of a body and forces T^T f on y: the two are transposes for every coupler, and T
// changes nothing of what it made where it is a projection.
#include "tests/support/static_body.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
struct Scheme
{
  const char *name;
  bool projects;
};
// The lumped constraint takes out only a share of most gaps, theory.md eq. (B5).
const std::vector<Scheme> schemes = {{"fine_scale_split", true},
                                     {"acceleration", true},
                                     {"pointwise", true},
                                     {"xiao_belytschko", true},
                                     {"xiao_belytschko_lumped", false}};

/// A motion of all particles and nodes, or forces on them.
template <int dim>
struct Field
{
  particles::Particles<dim> zone;
  Components<dim> nodal;

  Field(const CoupledBody<dim> &body, unsigned seed) : zone(body.zone->state)
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto fill = [&](auto &components, std::size_t n) {
      for (auto &component : components) {
        component.resize(n);
        for (double &value : component)
          value = uniform(random);
      }
    };
    const std::size_t n = zone.size();
    fill(zone.velocity, n);
    fill(zone.force, n);
    fill(zone.spin, n);
    fill(zone.torque, n);
    fill(nodal, body.far->mesh().n_nodes());
  }
};

template <typename A, typename B>
double product(const A &a, const B &b)
{
  double sum = 0;
  for (std::size_t c = 0; c < a.size(); ++c)
    for (std::size_t k = 0; k < a[c].size(); ++k)
      sum += a[c][k] * b[c][k];
  return sum;
}

/// <motion of a, forces of b>
template <int dim>
double work(const Field<dim> &a, const Field<dim> &b)
{
  return product(a.zone.velocity, b.zone.force) + product(a.zone.spin, b.zone.torque) +
         product(a.nodal, b.nodal);
}
template <int dim>
double motion_norm(const Field<dim> &a)
{
  return std::sqrt(product(a.zone.velocity, a.zone.velocity) + product(a.zone.spin, a.zone.spin) +
                   product(a.nodal, a.nodal));
}

template <int dim>
Field<dim> difference(Field<dim> a, const Field<dim> &b)
{
  const auto subtract = [](auto &from, const auto &what) {
    for (std::size_t c = 0; c < from.size(); ++c)
      for (std::size_t k = 0; k < from[c].size(); ++k)
        from[c][k] -= what[c][k];
  };
  subtract(a.zone.velocity, b.zone.velocity);
  subtract(a.zone.spin, b.zone.spin);
  subtract(a.nodal, b.nodal);
  return a;
}

template <int dim>
void look_at(const Scheme &scheme, const std::vector<std::string> &overrides)
{
  SCOPED_TRACE(scheme.name + std::to_string(dim));
  StaticBody<dim> one(overrides +
                      std::vector{std::string("/coupling/scheme=\"") + scheme.name + "\""});
  const auto &coupler = *one.body.coupler;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Field<dim> y(one.body, 2 * seed), f(one.body, 2 * seed + 1);
    Field<dim> z = y, g = f;
    coupler.expand(z.zone, z.nodal);
    coupler.restrict_forces(g.zone, g.nodal);
    // To the scale of the sums, most terms of which cancel.
    const double scale =
        motion_norm(y) * std::sqrt(product(f.nodal, f.nodal) + product(f.zone.force, f.zone.force));
    EXPECT_NEAR(work(z, f), work(y, g), 1e-13 * scale);
    EXPECT_GT(motion_norm(difference(z, y)), 1e-2 * motion_norm(y)); // it does something

    Field<dim> again = z;
    coupler.expand(again.zone, again.nodal);
    const double more = motion_norm(difference(again, z)) / motion_norm(z);
    if (scheme.projects)
      EXPECT_LT(more, 1e-12);
    else
      EXPECT_GT(more, 1e-3); // once it is a projection, it belongs among the others
  }
}

TEST(StaticTransposes, ForEveryCoupler)
{
  for (const Scheme &scheme : schemes) {
    look_at<2>(scheme, {});
    look_at<2>(scheme, {"/discrete_zone/packing=\"random\""});
    look_at<3>(scheme, {});
  }
}

// What is damped in the overlap is no part of a body at rest: T must not know of it.
TEST(StaticTransposes, WhateverTheDampersTake)
{
  for (const char *damper : {"0", "2", "8"}) {
    look_at<2>(schemes[0], {std::string("/coupling/fine_damper=") + damper});
    look_at<2>(schemes[0],
               {std::string("/coupling/fine_damper=") + damper, "/coupling/step_ratio=4"});
  }
}
} // namespace
