// Coulomb friction of a plate that is moved over a body which is held in place.
#include "tests/support/tool_body.h"

#include <fmt/format.h>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
constexpr double tangential_share = 0.3; // theory.md eq. (T4)

struct Row
{
  double time, x, y, force_x, force_y, contact, heat, work;
};

/// The body is lifted against a plate by `depth` in the first half of a second; the plate's way
/// along it is the table.
std::vector<Row> slide(const std::vector<std::array<double, 2>> &table, double depth,
                       double friction, int n)
{
  std::string text;
  for (const auto &row : table)
    text += fmt::format("{}[{}, {}]", text.empty() ? "" : ", ", row[0], row[1]);
  ToolBody<2> b(std::vector<std::string>{
      "/far_field=none", "/time/duration=5",
      fmt::format(R"(/tools=[{{"name": "a", "shape": "plate", "size": [60, 4], "place": [0, 62],
      "displacement": [1, null], "friction": {}, "history": {{"table": [{}]}}}}])",
                  friction, text)});
  std::vector<Row> rows;
  for (int k = 0; k <= n; ++k) {
    const double t = 4. * k / n, press = depth * std::min(1., 2 * t);
    auto &state = b.body.zone->state;
    std::fill(state.displacement[1].begin(), state.displacement[1].end(), press);
    b.now = {k, t, b.now.dt};
    b.body.tools->act(b.body.bodies(), b.now, 1);
    const auto r = b.body.tools->read(0);
    const auto e = b.body.tools->energy();
    rows.push_back(
        {t, r.displacement[0], press, r.force[0], r.force[1], e.contact, e.friction, e.work});
  }
  return rows;
}

TEST(ToolFriction, SticksUntilItSlides)
{
  // Still until t = 1, then 0.4 until t = 3, back by 0.1 until t = 4.
  const double mu = 0.4, depth = 0.1;
  const auto rows = slide({{0, 0}, {1, 0}, {3, 0.4}, {4, 0.3}}, depth, mu, 4000);
  const double normal = -rows.back().force_y;
  const double k = normal / depth, kt = tangential_share * k, reach = mu * normal / kt;
  ASSERT_LT(2 * reach, 0.4);
  double turned = 0;
  for (const Row &row : rows) {
    if (row.time < 1)
      continue;
    EXPECT_NEAR(row.force_y / -normal, 1, 1e-9);
    // Dragged along by the tool: the body is pulled to where it goes.
    double expected = std::min(kt * row.x, mu * normal);
    if (row.time > 3) {
      turned = 0.4 - row.x;
      expected = std::max(mu * normal - kt * turned, -mu * normal);
    }
    EXPECT_NEAR(row.force_x / (mu * normal), expected / (mu * normal), 1e-9) << row.time;
    const double slipped = std::max(0., std::min(row.time > 3 ? 0.4 : row.x, 0.4) - reach) +
                           std::max(0., turned - 2 * reach);
    // To the step in which it begins to slide.
    EXPECT_NEAR(row.heat / (mu * normal * 0.4), slipped / 0.4, 1e-3) << row.time;
  }
  // The body is held: what the drive gave sideways is spring and heat; the rest pressed the body.
  const Row &last = rows.back();
  const double pressed = k * depth * depth / 2;
  EXPECT_NEAR((last.work - (last.contact - pressed) - last.heat) / last.heat, 0, 1e-3);
}

TEST(ToolFriction, NoneWithoutACoefficient)
{
  for (const Row &row : slide({{0, 0}, {1, 0}, {3, 0.4}}, 0.1, 0, 40)) {
    EXPECT_EQ(row.force_x, 0);
    EXPECT_EQ(row.heat, 0);
  }
}
} // namespace
