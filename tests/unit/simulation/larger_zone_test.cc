// A body under load whose zone becomes larger: what was there goes on, what is new moves with the
// mesh, and what that takes of the energy is booked.
#include "core/extremes.h"
#include "src/simulation/larger_zone.h"

#include "core/check.h"
#include "src/simulation/energy_ledger.h"
#include "tests/support/small_plate.h"

#include <cmath>

namespace ligament::program
{
namespace
{
using tests::operator+;

// Mesh lines every 5, whatever the zone: it ends at 30 or at 40, its overlap is 10 wide.
const std::string narrow = R"(/discrete_zone/region={"lower": [null, -30], "upper": [null, 30]})",
                  wide = R"(/discrete_zone/region={"lower": [null, -40], "upper": [null, 40]})";

/// A cracked plate that is stretched at both ends.
std::vector<std::string> stretched(const std::string &packing, double rate)
{
  const std::string v = std::to_string(rate);
  return {R"(/specimen={"size": [20, 160], "cracks": [{"points": [[-4, 0], [4, 0]]}]})",
          "/far_field/cell_size=5", "/discrete_zone/packing=" + packing, "/time/step=0.25",
          R"(/loads=[{"boundary": "top", "velocity": [null, )" + v + R"(], "ramp": 100},
                     {"boundary": "bottom", "velocity": [null, -)" +
              v + R"(], "ramp": 100}])"};
}

struct Grown
{
  core::Log log;
  core::Timers timers;
  CoupledBody<2> body;
  coupling::StepTime now;

  explicit Grown(const std::vector<std::string> &overrides)
      : body(make_body<2>(tests::small_scene(overrides), log, timers))
  {
    now.dt = body.dt;
    compute();
  }
  void compute()
  {
    auto bodies = body.bodies();
    body.coupler->compute_forces(bodies, now);
  }
  /// Up to the forces of the next step.
  void move()
  {
    auto bodies = body.bodies();
    body.coupler->kick(bodies, now);
    body.coupler->drift(bodies, now);
    now.time = double(++now.step) * now.dt;
  }
  void run(double to)
  {
    while (now.time < to) {
      move();
      compute();
    }
  }
  EnergyLedger ledger() const { return read_ledger(body, now, 0); }
};

/// Takes the state of `old` at its next step, into `larger`; both have their forces then.
int grow(Grown &old, Grown &larger)
{
  old.move();
  const core::State state = take_state(old.body);
  old.compute();
  const int n_new = give_state_to_larger(state, old.body.far->mesh(), old.body.dt, larger.body);
  larger.now = old.now;
  larger.compute();
  book_zone_change(motion_energy(old.body, old.now), larger.body, larger.now);
  return n_new;
}

double largest_residual(Grown &body, double to)
{
  double most = 0;
  while (body.now.time < to) {
    body.run(body.now.time + 5);
    keep_largest(most, std::abs(body.ledger().residual()));
  }
  return most;
}

class LargerZone : public testing::TestWithParam<const char *>
{
};

TEST_P(LargerZone, GoesOnUnderLoad)
{
  const auto scene = stretched(GetParam(), 1e-4);
  Grown old(scene + std::vector<std::string>{narrow}),
      larger(scene + std::vector<std::string>{wide});
  old.run(300); // a wave needs 80 from an end to the middle
  const int n_new = grow(old, larger);
  const auto &before = old.body.zone->state, &after = larger.body.zone->state;
  EXPECT_GT(n_new, 2 * 20 * 8);
  EXPECT_EQ(after.size(), before.size() + n_new);

  // What was there is where it was, to the last bit.
  const core::Names names = after.names(), old_names = before.names();
  for (int i = 0; i < before.size(); ++i) {
    const int k = names.index(before.global_id[i]);
    ASSERT_GE(k, 0);
    for (int c = 0; c < 2; ++c) {
      ASSERT_EQ(after.displacement[c][k], before.displacement[c][i]);
      ASSERT_EQ(after.velocity[c][k], before.velocity[c][i]);
    }
    ASSERT_EQ(after.rotation[0][k], before.rotation[0][i]);
    ASSERT_EQ(after.spin[0][k], before.spin[0][i]);
  }
  const auto &mesh = larger.body.far->mesh(), &old_mesh = old.body.far->mesh();
  ASSERT_LT(mesh.n_nodes(), old_mesh.n_nodes());
  const auto &u = larger.body.far->displacement, &old_u = old.body.far->displacement;
  const auto node_names = fem::node_names<2>(mesh, larger.body.lower, larger.body.upper),
             old_node_names = fem::node_names<2>(old_mesh, old.body.lower, old.body.upper);
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int c = 0; c < 2; ++c)
      ASSERT_EQ(u[c][i], old_u[c][old_node_names.index(node_names.name(i))]);

  // What is new lies in the motion of the mesh: its cell's four corners, interpolated by hand.
  const fem::CellLocator<2> locator(old_mesh);
  const auto &old_v = old.body.far->velocity;
  int n_looked_at = 0;
  double largest_turn = 0;
  for (int k = 0; k < after.size(); ++k) {
    if (old_names.index(after.global_id[k]) >= 0)
      continue;
    const int cell = locator.find(get(after.reference, k));
    ASSERT_GE(cell, 0);
    const Vector<2> place = (get(after.reference, k) - old_mesh.cell_lower[cell])
                                .cwiseQuotient(old_mesh.cell_size[cell]);
    const auto interpolated = [&](const Components<2> &values, int c) {
      const auto at = [&](int a) { return values[c][old_mesh.cells[cell][a]]; };
      const double bottom = at(0) + place[0] * (at(1) - at(0)),
                   top = at(2) + place[0] * (at(3) - at(2));
      return bottom + place[1] * (top - bottom);
    };
    for (int c = 0; c < 2; ++c) {
      ASSERT_NEAR(after.displacement[c][k], interpolated(old_u, c), 1e-14);
      ASSERT_NEAR(after.velocity[c][k], interpolated(old_v, c), 1e-16);
    }
    // Half the curl, by differences over the width of the cell at the place of the particle.
    const auto turn = [&](const Components<2> &values) {
      const auto at = [&](int c, int a) { return values[c][old_mesh.cells[cell][a]]; };
      const Vector<2> size = old_mesh.cell_size[cell];
      const auto mix = [](double share, double a, double b) { return a + share * (b - a); };
      return 0.5 * (mix(place[1], at(1, 1) - at(1, 0), at(1, 3) - at(1, 2)) / size[0] -
                    mix(place[0], at(0, 2) - at(0, 0), at(0, 3) - at(0, 1)) / size[1]);
    };
    largest_turn = std::max(largest_turn, std::abs(turn(old_u)));
    // Polar rotations differ from it by the strain, which is below 1e-2.
    ASSERT_NEAR(after.rotation[0][k], turn(old_u), 1e-2 * std::abs(turn(old_u)) + 1e-9);
    ASSERT_NEAR(after.spin[0][k], turn(old_v), 1e-2 * std::abs(turn(old_v)) + 1e-9);
    ++n_looked_at;
  }
  EXPECT_EQ(n_looked_at, n_new);
  EXPECT_GT(largest_turn, 1e-6);

  // The jump is small, and the books close on both sides of it as well as without it.
  const double energy = motion_energy(old.body, old.now);
  const double jump = larger.body.regime_change - old.body.regime_change;
  EXPECT_NE(jump, 0);
  EXPECT_LT(std::abs(jump), 1e-3 * energy);
  EXPECT_NEAR(larger.ledger().residual(), old.ledger().residual(), 1e-12 * energy);
  const double end = old.now.time + 100;
  const double residual = largest_residual(old, end), of_larger = largest_residual(larger, end);
  EXPECT_LT(of_larger, 2 * residual + 1e-12 * energy);

  // Both bodies go on alike: cells and particles differ by their dispersion, (kh)^2 of the waves
  // that the load and the crack send, h = 5 and 2 pi/k of the order of the specimen.
  const double kh = 2 * M_PI * 5 / 160;
  double most = 0, difference = 0;
  for (int i = 0; i < mesh.n_nodes(); ++i)
    for (int c = 0; c < 2; ++c) {
      const double there = old_u[c][old_node_names.index(node_names.name(i))];
      keep_largest(most, std::abs(there));
      keep_largest(difference, std::abs(u[c][i] - there));
    }
  EXPECT_LT(difference, kh * kh * most);
}

INSTANTIATE_TEST_SUITE_P(Packings, LargerZone, testing::Values("hexagonal", "random"));

TEST(LargerZone, RefusesWhatDoesNotFit)
{
  const auto scene = stretched("hexagonal", 1e-4);
  Grown old(scene + std::vector<std::string>{narrow});
  old.move();
  const core::State state = take_state(old.body);
  const auto why = [&](std::vector<std::string> overrides) -> std::string {
    Grown larger(scene + std::vector<std::string>{wide} + overrides);
    try {
      give_state_to_larger(state, old.body.far->mesh(), old.body.dt, larger.body);
    } catch (const core::InputError &error) {
      return error.what();
    }
    return "";
  };
  const auto has = [](const std::string &text, const char *part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  EXPECT_EQ(why({}), "");
  has(why({"/far_field=none"}), "a zone grows into a mesh");
  has(why({"/time/step=0.2"}), "give /time/step");
  has(why({R"(/discrete_zone/region={"lower": [null, -40], "upper": [null, 42]})"}),
      "move the edges of the zone by whole cells");
  has(why({R"(/discrete_zone/region={"lower": [null, -40], "upper": [null, 25]})"}),
      "is not in the larger zone");
  has(why({"/coupling/scheme=acceleration", "/time/step=0.25"}), "energy-weighted couplers");
  has(why({R"(/discrete_zone/region={"lower": [null, -40], "upper": [null, null]})"}),
      "along a loaded side");
}
} // namespace
} // namespace ligament::program
