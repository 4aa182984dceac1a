// Both couplers against a chain of point masses and linear elements: on a square lattice without
// Poisson's effect, in which all rows move alike, they must be one-dimensional to round-off.
#include "core/extremes.h"
#include "src/verification/bodies/waves_strip.h"
#include "tests/oracle/split_chain.h"
#include "tests/oracle/weighted_chain.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace ligament
{
namespace
{
using coupling::Scheme;

constexpr int n_layers = 40, n_steps = 400;

program::StripParameters strip_parameters(Scheme scheme)
{
  program::StripParameters p;
  p.material = {1, 0, 1, PlaneMode::strain, 0};
  p.far_length = 40;
  p.transition_cells = 4;
  p.scheme = scheme;
  return p;
}

/// The edge of the packing lies 0.8 above the last particle: nodes between the layers.
program::Strip<2> make_strip(const program::StripParameters &p)
{
  return program::make_strip<2>(p,
                                packings::make_periodic_packing<2>(packings::LatticeKind::square,
                                                                   p.cells_across * p.cell_size,
                                                                   n_layers, false),
                                n_layers - 0.2);
}

oracle::ChainParameters chain_parameters(const program::StripParameters &p,
                                         const program::Strip<2> &strip)
{
  oracle::ChainParameters chain;
  chain.n_particles = n_layers;
  chain.edge = n_layers - 0.2;
  chain.length = p.overlap_cells * p.cell_size;
  chain.transition_cells = p.transition_cells;
  chain.columns = 3;
  chain.dt = strip.dt;
  std::vector<double> nodes;
  for (const auto &x : strip.far->mesh().nodes)
    if (x[0] == 0)
      nodes.push_back(x[1]);
  chain.nodes = Eigen::Map<Eigen::VectorXd>(nodes.data(), nodes.size());
  return chain;
}

/// Particle or node of every row at the height of those of the chain.
std::vector<std::vector<int>> rows(const std::vector<double> &heights, const Eigen::VectorXd &chain)
{
  std::vector<std::vector<int>> found(chain.size());
  for (std::size_t i = 0; i < heights.size(); ++i)
    for (int k = 0; k < chain.size(); ++k)
      if (std::abs(heights[i] - chain[k]) < 1e-6)
        found[k].push_back(int(i));
  return found;
}

/// Both move from the same noise; the largest difference of displacements that is ever seen, over
/// the largest displacement, against a bound.
template <typename Oracle>
void expect_same_motion(program::Strip<2> &strip, Oracle &chain)
{
  auto &zone = strip.zone->state;
  auto &far = *strip.far;
  std::vector<double> heights;
  for (const auto &x : far.mesh().nodes)
    heights.push_back(x[1]);
  const auto particles = rows({zone.reference[1].begin(), zone.reference[1].end()},
                              Eigen::VectorXd::LinSpaced(n_layers, 0, n_layers - 1));
  const auto nodes = rows(heights, chain.p.nodes);

  for (const auto &row : particles)
    ASSERT_EQ(row.size(), 12u);
  for (const auto &row : nodes)
    ASSERT_EQ(row.size(), 3u);

  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1e-9, 1e-9);
  const auto start = [&](const auto &row_of, std::vector<double> &velocity) {
    for (const auto &row : row_of) {
      const double v = uniform(random);
      for (const int i : row)
        velocity[i] = v;
    }
  };
  start(particles, zone.velocity[1]);
  start(nodes, far.velocity[1]);
  auto bodies = strip.bodies();
  strip.coupler->take_velocities(bodies);
  for (int i = 0; i < chain.n; ++i)
    chain.v[i] = zone.velocity[1][particles[i][0]];
  for (int i = 0; i < chain.n_nodes; ++i)
    chain.nodal_v[i] = far.velocity[1][nodes[i][0]];
  chain.start();

  double largest = 0, difference = 0;
  coupling::StepTime time;
  time.dt = strip.dt;
  const auto compare = [&](const auto &row_of, const Components<2> &u, const auto &expected) {
    for (int k = 0; k < expected.size(); ++k)
      for (const int i : row_of[k]) {
        keep_largest(largest, std::abs(expected[k]));
        difference = std::max({difference, std::abs(u[0][i]), std::abs(u[1][i] - expected[k])});
      }
  };
  for (int k = 0; k < n_steps; ++k) {
    strip.coupler->compute_forces(bodies, time);
    strip.coupler->kick(bodies, time);
    strip.coupler->drift(bodies, time);
    time.time += time.dt;
    ++time.step;
    chain.step();
    compare(particles, zone.displacement, chain.u);
    compare(nodes, far.displacement, chain.nodal_u);
  }
  EXPECT_TRUE(std::isfinite(zone.displacement[1][0] + chain.u.sum() + chain.nodal_u.sum()));
  EXPECT_LT(difference, chain.roundoff(n_steps) * largest);
}

TEST(CoupledChain, IsTheFineScaleSplitWhereRowsMoveAlike)
{
  for (const bool is_full : {false, true}) {
    auto p = strip_parameters(Scheme::fine_scale_split);
    p.split.patch_fit = is_full;
    p.split.fine_damper = is_full ? 8 : 0;
    p.split.gap_filter = is_full ? 4 : 0;
    auto strip = make_strip(p);
    auto parameters = chain_parameters(p, strip);
    parameters.fit_patch = p.split.patch_fit;
    parameters.fine_damper = p.split.fine_damper;
    parameters.gap_filter = p.split.gap_filter;
    oracle::SplitChain chain(parameters);
    expect_same_motion(strip, chain);
  }
}

TEST(CoupledChain, IsTheBridgingDomainWhereRowsMoveAlike)
{
  using oracle::Correction;
  for (const auto &[scheme, correction] :
       {std::pair{Scheme::acceleration, Correction::acceleration},
        std::pair{Scheme::xiao_belytschko, Correction::whole_steps},
        std::pair{Scheme::xiao_belytschko_lumped, Correction::whole_steps_lumped},
        std::pair{Scheme::pointwise, Correction::pointwise}})
    for (const double damper : {0., 8.}) {
      SCOPED_TRACE(coupling::scheme_names[int(scheme)]);
      auto p = strip_parameters(scheme);
      p.bridging.fine_damper = damper;
      auto strip = make_strip(p);
      auto parameters = chain_parameters(p, strip);
      parameters.has_pads = false;
      parameters.is_lumped = correction == Correction::whole_steps_lumped;
      parameters.fine_damper = damper;
      oracle::WeightedChain chain(parameters, correction);
      expect_same_motion(strip, chain);
    }
}
} // namespace
} // namespace ligament
