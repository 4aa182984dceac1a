// Regions at rest in coupled bodies: with a threshold of zero no result changes, with a small one
// the ledger stays closed.
#include "src/simulation/energy_ledger.h"
#include "tests/support/small_plate.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// A plate with a load on one side, and its steps.
struct LoadedPlate
{
  SmallBody small;
  coupling::StepTime step{0, 0, small.body.dt};

  LoadedPlate(const std::vector<std::string> &overrides, std::optional<double> rest_threshold)
      : small(small_scene(overrides))
  {
    auto &body = small.body;
    auto bodies = body.bodies();
    body.coupler->compute_forces(bodies, step);
    if (!rest_threshold)
      return;
    body.zone->let_rest(particles::RestLimits::of_strain(*rest_threshold, 1, 1));
    body.coupler->let_rest(bodies, *rest_threshold);
  }

  void run(int steps)
  {
    auto bodies = small.body.bodies();
    auto &coupler = *small.body.coupler;
    for (int n = 0; n < steps; ++n) {
      coupler.kick(bodies, step);
      coupler.drift(bodies, step);
      ++step.step;
      step.time = double(step.step) * step.dt;
      coupler.compute_forces(bodies, step);
    }
  }

  EnergyLedger ledger() const { return read_ledger(small.body, step, 0); }
};

double overlap_at_rest(const CoupledBody<2> &body)
{
  return body.coupler->shares_at_rest().at(0).share;
}

const std::string long_plate = R"(/specimen={"size": [24, 320]})";
/// On the far field's side, a step and an absorbed pulse.
const std::string pull = R"(/loads=[{"boundary": "top", "velocity": [null, 0.001]},
                                    {"boundary": "bottom", "velocity": [null, 0]}])";
/// Particles reach down to the side that is hit.
const std::string low_zone =
    R"(/discrete_zone={"region": {"lower": [null, null], "upper": [null, -100]},
                       "packing": "hexagonal", "spacing": 1})";
const std::string hit = R"(/loads=[{"boundary": "bottom", "velocity": [0.0002, 0.001]}])";
const std::vector<std::vector<std::string>> plates = {
    {long_plate, pull}, {long_plate, low_zone, hit}, {long_plate, pull, "/coupling/step_ratio=3"}};

TEST(Rest, CoupledBodiesMoveTheSame)
{
  for (const auto &overrides : plates) {
    LoadedPlate plain(overrides, {}), resting(overrides, 0.);
    plain.run(240);
    resting.run(240);
    const auto &a = plain.small.body, &b = resting.small.body;
    EXPECT_EQ(a.zone->state.displacement, b.zone->state.displacement);
    EXPECT_EQ(a.zone->state.rotation, b.zone->state.rotation);
    EXPECT_EQ(a.zone->state.velocity, b.zone->state.velocity);
    EXPECT_EQ(a.zone->state.spin, b.zone->state.spin);
    EXPECT_EQ(a.far->displacement, b.far->displacement);
    EXPECT_EQ(a.far->velocity, b.far->velocity);
    EXPECT_EQ(plain.ledger().channels(), resting.ledger().channels());
    EXPECT_GT(b.zone->rest()->share_at_rest(), 0);
    EXPECT_GT(overlap_at_rest(b), 0);
    EXPECT_LT(overlap_at_rest(b), 1);
  }
}

// Half the far field's wave away from the zone, and after it has arrived.
TEST(Rest, ThresholdKeepsTheLedgerClosed)
{
  const double threshold = 1e-7; // of waves with strain 1e-3
  for (const auto &overrides : plates) {
    LoadedPlate plain(overrides, {}), exact(overrides, 0.), resting(overrides, threshold);
    for (const int steps : {60, 240}) {
      plain.run(steps);
      exact.run(steps);
      resting.run(steps);
      const EnergyLedger a = plain.ledger(), b = resting.ledger();
      // What waits stands still and does no work; only its waking is not smooth.
      EXPECT_NEAR(b.residual(), a.residual(), 1e-6 * b.external_work);
      EXPECT_NEAR(b.external_work, a.external_work, 1e-3 * a.external_work);
    }
    EXPECT_GT(overlap_at_rest(resting.small.body), overlap_at_rest(exact.small.body) + 0.02);
  }
}
} // namespace
