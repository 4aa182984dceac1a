// Weight, sides that let waves out, pressures that follow, servos and gauges on several ranks: byte
// for byte what one process writes. Through the programs.
#include "tests/support/rank_runs.h"

#include <cmath>
#include <sstream>

using namespace ligament::tests;

namespace
{
class RanksLoads : public OnRanks
{
};

/// Falls, lets waves out at one side, and is pressed at another one by what follows it.
Json falling(Json scene)
{
  pull(scene, 1, 1, 3e-3, 20);
  Json acceleration = {4e-6, -2e-5};
  if (scene["dimension"] == 3)
    acceleration.push_back(1e-5);
  scene["body_force"] = {{"acceleration", acceleration}, {"ramp", 15}};
  scene["loads"].push_back({{"boundary", "left"}, {"absorbing", true}, {"absorbing_layer", 4}});
  scene["loads"].push_back({{"boundary", "right"}, {"pressure", 4e-4}, {"ramp", 30}});
  scene["gauges"] = {{{"name", "pieces"}, {"kind", "fragments"}},
                     {{"name", "side"}, {"kind", "force"}, {"side", "right"}}};
  scene["time"]["duration"] = 80;
  return scene;
}

Json falling_plate()
{
  Json scene = scene_of(2, "hexagonal", {30, 40});
  scene["discrete_zone"]["orientation"] = 10;
  scene["specimen"]["cracks"] = {{{"points", {{-15.5, -1}, {6, -1}}}}};
  scene = falling(scene);
  scene["gauges"].push_back({{"name", "tip"},
                             {"kind", "j_integral"},
                             {"direction", {1, 0}},
                             {"lower", {-2, -12}},
                             {"upper", {13, 8}},
                             {"inner_lower", {2, -7}},
                             {"inner_upper", {9, 3}}});
  return scene;
}

/// One machine keeps the stress of its side, another one what a gauge reads.
Json steered()
{
  Json scene = scene_of(2, "hexagonal", {30, 40});
  scene["specimen"]["cracks"] = {{{"points", {{-16, 0}, {-6, 0}}}}};
  scene["gauges"] = {{{"name", "mouth"},
                      {"kind", "opening"},
                      {"points", {{-14, -1}, {-14, 1}}},
                      {"direction", {0, 1}}}};
  const Json stress = {{"stress", 1e-4}, {"ramp", 60}, {"response_time", 40}},
             mouth = {{"gauge", "mouth"},
                      {"value", 0.2},
                      {"ramp", 150},
                      {"gain", 0.5},
                      {"response_time", 60}};
  scene["loads"] = {{{"boundary", "bottom"}, {"displacement", {nullptr, 0}}},
                    {{"boundary", "top"}, {"velocity", {nullptr, 5e-3}}, {"servo", mouth}},
                    {{"boundary", "right"}, {"velocity", {2e-3, nullptr}}, {"servo", stress}}};
  return scene;
}

/// The same inside a mesh: waves leave through its end, sides of mesh and particles are pressed.
/// Faces of the overlap break before the regime turns nonlinear.
Json falling_inside_a_mesh(double servo_ramp)
{
  Json scene = coupled(2, "hexagonal", {40, 110}, {0, 46}, 4.1);
  scene["discrete_zone"]["orientation"] = 12;
  scene["specimen"]["cracks"] = {{{"points", {{-21, 0}, {-6, 0}}}}};
  scene["material"]["fracture"]["strength"] = 1e-3;
  scene["coupling"]["step_ratio"] = 2;
  scene["coupling"]["guard"] = "warn";
  scene["body_force"] = {{"acceleration", {2e-6, -3e-6}}, {"ramp", 40}};
  const auto pressed = [](Json from, Json to) {
    return Json{{"boundary", "right"},
                {"pressure", 1e-4},
                {"ramp", 30},
                {"within", {{"lower", {nullptr, from}}, {"upper", {nullptr, to}}}}};
  };
  scene["loads"] = {{{"boundary", "top"},
                     {"velocity", {nullptr, 3e-3}},
                     {"servo",
                      {{"gauge", "mouth"},
                       {"value", 0.1},
                       {"ramp", servo_ramp},
                       {"gain", 0.5},
                       {"response_time", 60}}}},
                    {{"boundary", "bottom"}, {"absorbing", true}, {"absorbing_layer", 8}},
                    pressed(-11, 11),
                    pressed(41, 50)};
  scene["gauges"] = {{{"name", "mouth"},
                      {"kind", "opening"},
                      {"points", {{-19, -1}, {-19, 1.2}}},
                      {"direction", {0, 1}}},
                     {{"name", "pieces"}, {"kind", "fragments"}},
                     {{"name", "tip"},
                      {"kind", "j_integral"},
                      {"direction", {1, 0}},
                      {"lower", {-18, -34}},
                      {"upper", {8, 34}},
                      {"inner_lower", {-12, -6}},
                      {"inner_upper", {2, 8}}}};
  scene["time"]["duration"] = 240;
  return scene;
}

/// The particles reach to the side that lets waves out.
Json end_of_particles_that_absorbs()
{
  Json scene = coupled(2, "hexagonal", {30, 80}, {0, 0}, 4.1);
  scene["discrete_zone"]["region"] = {{"lower", {nullptr, -4}}, {"upper", {nullptr, nullptr}}};
  scene["loads"] = {{{"boundary", "bottom"}, {"velocity", {nullptr, 4e-3}}, {"ramp", 10}},
                    {{"boundary", "top"}, {"absorbing", true}, {"absorbing_layer", 10}}};
  scene["time"]["duration"] = 120;
  return scene;
}

/// How many faces broke in a band |y| before a time (s).
int broken_between(const std::string &run, double from, double to, double until)
{
  std::istringstream rows(file_text(run + "/broken_bonds.csv"));
  std::string row;
  std::getline(rows, row);
  std::getline(rows, row); // units
  int n = 0;
  while (std::getline(rows, row)) {
    std::vector<double> values;
    std::istringstream cells(row);
    for (std::string cell; std::getline(cells, cell, ',');)
      values.push_back(std::stod(cell));
    n += values.at(2) < until && from < std::abs(values.at(4)) && std::abs(values.at(4)) < to;
  }
  return n;
}

TEST_F(RanksLoads, AFallingPlate)
{
  expect_the_same_on({2, 3}, falling_plate(), 20);
}
TEST_F(RanksLoads, AFallingPlateCutAnew)
{
  expect_the_same_when_cut_anew(3, falling_plate(), 60, 20);
}
TEST_F(RanksLoads, AFallingBlock)
{
  expect_the_same_on({2}, falling(scene_of(3, "fcc", {12, 12, 10})), 10);
}
TEST_F(RanksLoads, SteeredByServos)
{
  expect_the_same_on({2, 3}, steered(), 5);
}
TEST_F(RanksLoads, FallingInsideAMesh)
{
  expect_the_same_on({2, 3}, falling_inside_a_mesh(200), 10);
  const std::string regimes = file_json("on_1/run.json")["regime"];
  const auto turned = regimes.find("nonlinear from ");
  ASSERT_NE(turned, std::string::npos) << regimes;
  // Else it would say little: within the overlap, of two cells.
  EXPECT_GT(broken_between("on_1", 23 - 2 * 4.1, 23, std::stod(regimes.substr(turned + 15))), 10);
}
TEST_F(RanksLoads, GoesOnInsideAMesh)
{
  expect_to_go_on(falling_inside_a_mesh(100), 2);
}
TEST_F(RanksLoads, AnEndOfParticlesThatAbsorbs)
{
  expect_the_same_on({2}, end_of_particles_that_absorbs(), 0);
}
} // namespace
