// Gauges of a body in parts read what those of the whole one do, bit by bit, while it breaks.
#include "src/simulation/gauges/fragments.h"
#include "src/simulation/gauges/gauge_set.h"
#include "tests/support/ranks.h"
#include "tests/support/small_plate.h"

#include <cstring>
#include <random>

namespace ligament::program
{
namespace
{
using test::ranks;
using tests::operator+;
using Overrides = std::vector<std::string>;

// A crack up to the middle, and rectangles around its tip, within the zone and out of it.
const Overrides cracked = {
    R"(/specimen/cracks=[{"points": [[-12, 0], [0, 0]]}])",
    R"(/material/fracture={"criterion": "maximum_tension", "strength": 0.02})",
    R"(/gauges=[
      {"name": "pieces", "kind": "fragments"},
      {"name": "near", "kind": "j_integral", "direction": [1, 0], "lower": [-8, -8], "upper": [8, 8],
       "inner_lower": [-4, -4], "inner_upper": [4, 4]},
      {"name": "wide", "kind": "j_integral", "direction": [1, 0], "lower": [-9, -30], "upper": [9, 30],
       "inner_lower": [-3, -5], "inner_upper": [3, 5]}])"};

/// Velocities of all particles, whoever holds them.
void stir(CoupledBody<2> &body, double speed)
{
  auto &p = body.zone->state;
  for (int i = 0; i < p.size(); ++i) {
    std::mt19937_64 random(p.global_id[i]);
    std::uniform_real_distribution<double> uniform(-speed, speed);
    for (auto &v : p.velocity)
      v[i] = uniform(random);
  }
  auto bodies = body.bodies();
  body.coupler->take_velocities(bodies);
}

std::uint64_t bits_of(double value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

std::vector<double> numbers_of(const std::vector<Fragment> &list)
{
  std::vector<double> all;
  for (const Fragment &f : list) {
    all.insert(all.end(), {f.mass, double(f.particles), double(f.has_mesh)});
    for (const auto *v : {&f.centre, &f.velocity, &f.spin})
      all.insert(all.end(), v->begin(), v->end());
  }
  return all;
}

/// Where they differ, by number.
std::string differences(const std::vector<double> &a, const std::vector<double> &b)
{
  std::string found = a.size() == b.size() ? "" : "sizes";
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    if (bits_of(a[k]) != bits_of(b[k]))
      found += " " + std::to_string(k);
  return found;
}

/// One of the bodies, its gauges, and where it is in time.
struct Course
{
  Course(const Scene &scene, CoupledBody<2> &the_body)
      : body(the_body), gauges(scene, body), fragments(scene.gauges[0], scene, body)
  {
  }
  void advance(int n)
  {
    auto bodies = body.bodies();
    for (; n > 0; --n) {
      if (step.step > 0) {
        body.coupler->kick(bodies, step);
        body.coupler->drift(bodies, step);
      }
      step = {step.step + 1, double(step.step + 1) * body.dt, body.dt};
      body.coupler->compute_forces(bodies, step);
    }
  }

  CoupledBody<2> &body;
  GaugeSet<2> gauges;
  FragmentGauge<2> fragments;
  coupling::StepTime step{0, 0, body.dt};
};

/// Returns in how many pieces it ends.
std::size_t expect_the_readings_of_the_whole(const Overrides &overrides, double speed)
{
  const Scene scene = tests::small_scene(cracked + overrides);
  tests::SmallBody small(scene);
  core::Log log;
  core::Timers timers;
  Reference reference;
  auto parts = make_body<2>(scene, log, timers, reference, make_many_body_force<2>, ranks());
  Course part(scene, parts), whole(scene, small.body);
  for (auto *body : {&parts, &small.body})
    stir(*body, speed);
  std::string differs;
  for (int look = 0; look < 4 && !ranks().any(!differs.empty()); ++look) {
    part.advance(8);
    whole.advance(8);
    differs = differences(part.gauges.read(parts, part.step.time),
                          whole.gauges.read(small.body, whole.step.time));
    EXPECT_EQ(differs, "") << "readings at look " << look;
    differs += differences(numbers_of(part.fragments.fragments(parts)),
                           numbers_of(whole.fragments.fragments(small.body)));
    EXPECT_EQ(differs, "") << "pieces at look " << look;
  }
  EXPECT_GT(small.body.force()->n_broken(), 20); // else the test would say little
  for (std::size_t k = 0; k < part.gauges.entries().size(); ++k)
    EXPECT_EQ(part.gauges.entries()[k].text, whole.gauges.entries()[k].text);
  return whole.fragments.fragments(small.body).size();
}

TEST(GaugesInParts, OfParticlesAlone)
{
  for (const char *packing : {"hexagonal", "square", "random"}) {
    SCOPED_TRACE(packing);
    EXPECT_GT(expect_the_readings_of_the_whole(
                  {"/far_field=none", "/discrete_zone/packing=" + std::string(packing)}, 0.024),
              5u);
  }
}

TEST(GaugesInParts, InsideAMesh)
{
  for (const char *packing : {"hexagonal", "random"}) {
    SCOPED_TRACE(packing);
    EXPECT_GT(
        expect_the_readings_of_the_whole({"/discrete_zone/packing=" + std::string(packing)}, 0.024),
        1u);
  }
}

// Cut into pieces from the start, some of them across seams and some of one rank alone.
TEST(GaugesInParts, OfABodyThatIsCut)
{
  const std::string cuts =
      R"(/specimen/cracks=[{"points": [[-12, 0], [0, 0]]}, {"points": [[-13, 3.2], [13, 3.2]]},
         {"points": [[-13, -3.1], [13, -3.1]]}, {"points": [[4.2, -3.1], [4.2, 3.2]]}])";
  for (const char *far : {"/coupling/overlap_cells=2", "/far_field=none"}) {
    SCOPED_TRACE(far);
    EXPECT_GT(expect_the_readings_of_the_whole(
                  {far, cuts, R"(/gauges=[{"name": "pieces", "kind": "fragments"}])"}, 0.024),
              3u);
  }
}
} // namespace
} // namespace ligament::program
