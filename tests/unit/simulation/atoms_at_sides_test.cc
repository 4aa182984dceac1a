// Cracks and openings of crystals go on across joined sides, wherever these come to lie; gauges
// know initial cracks; forces and supports act on parts of sides; what heat begins with and says.
#include "src/output/run_folder.h"
#include "src/simulation/doubts.h"
#include "src/simulation/gauges/gauge_set.h"
#include "src/simulation/heat.h"
#include "src/simulation/make_force.h"
#include "src/simulation/simulation.h"
#include "tests/support/atom_bodies.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// In J, of a bar with a crack from one z to another that is drawn apart across it.
double stretched_energy(double lower, double upper)
{
  AtomsOfScene<3> unit(
      copper_bar, {fmt::format(R"(/specimen/cracks=[{{"points": [["-1.5 nm", "0.05 nm", {0:.17g}],
                                  ["1.5 nm", "0.05 nm", {0:.17g}], ["1.5 nm", "0.05 nm", {1:.17g}],
                                  ["-1.5 nm", "0.05 nm", {1:.17g}]]}}])",
                               lower, upper)});
  auto &state = unit.atoms();
  for (int i = 0; i < state.size(); ++i)
    state.displacement[1][i] = 0.01 * state.reference[1][i];
  unit.body.force()->compute(state, 1);
  return unit.body.force()->potential_energy(state);
}

TEST(AtomsAtJoinedSides, CracksPartPairsAcrossThem)
{
  const double side = AtomsOfScene<3>(copper_bar).scene.specimen.size[2] / 2;
  const double beyond = stretched_energy(-5e-9, 5e-9);
  EXPECT_NEAR(stretched_energy(-side, side) / beyond, 1, 1e-12);
  // One that covers half of the thickness is another crack.
  EXPECT_GT(std::abs(stretched_energy(0, side) / beyond - 1), 1e-3);
}

TEST(AtomsAtJoinedSides, HolesHaveTheirOtherHalfAtTheOtherEnd)
{
  const std::vector<std::string> joined = {R"(/specimen/periodic=["x"])"};
  const auto with_hole = [&](double x) {
    auto overrides = joined;
    overrides.push_back(
        fmt::format(R"(/specimen/holes=[{{"centre": [{:.17g}, 0], "radius": "3 nm"}}])", x));
    return overrides;
  };
  AtomsOfScene<2> whole(plane_of_atoms, joined);
  const double side = whole.scene.specimen.size[0] / 2;
  AtomsOfScene<2> middle(plane_of_atoms, with_hole(0)), seam(plane_of_atoms, with_hole(side));
  const int missing = whole.atoms().size() - middle.atoms().size();
  ASSERT_GT(missing, 100);
  EXPECT_NEAR(whole.atoms().size() - seam.atoms().size(), missing, 0.05 * missing);
  const auto &state = seam.atoms();
  for (int i = 0; i < state.size(); ++i)
    EXPECT_GT(std::hypot(std::abs(state.reference[0][i]) - side, state.reference[1][i]), 2.99e-9);
}

// Those near a part of a side have its area to a spacing only; the force is met all the same.
TEST(AtomsUnderLoad, ForcesOnPartsOfSidesAreMet)
{
  for (const double half : {1.1e-9, 2e-9, 5.3e-9}) {
    AtomsOfScene<2> unit(
        plane_of_atoms,
        {fmt::format(R"(/loads=[{{"boundary": "top", "force": [0, "1 nN"], "from": {:.17g}, "to": {:.17g}}},
                            {{"boundary": "bottom", "velocity": [0, 0]}}])",
                     -half, half)});
    auto &state = unit.atoms();
    unit.body.force()->compute(state, 0);
    const double before = unit.body.force()->reaction(0)[1];
    EXPECT_NEAR(std::abs(before), 1e-9, 1e-15) << half;
  }
}

// The thickness of iron becomes seven periods, a little more than 2 nm.
TEST(AtomsAtJoinedSides, CutsFollowSidesThatMove)
{
  const double half = 1.5e-9;
  const std::vector<std::string> overrides = {
      R"(/atoms={"potential": "zhou", "species": "Fe"})", R"(/discrete_zone/packing="bcc")",
      R"(/specimen/size=["6.5 nm", "5.4 nm", "2 nm"])",
      R"(/specimen/cracks=[{"points": [["-1.5 nm", 0, "-1 nm"], ["1.5 nm", 0, "-1 nm"],
                                       ["1.5 nm", 0, "1 nm"], ["-1.5 nm", 0, "1 nm"]]}])"};
  AtomsOfScene<3> unit(copper_bar, overrides);
  ASSERT_GT(std::abs(unit.scene.specimen.size[2] - 2e-9), 1e-12);
  auto &atoms = unit.atoms();
  int n_beside = 0;
  unit.body.force()->for_each_neighbour(atoms, [&](const particles::Neighbour &n) {
    const Vector<3> a = get(atoms.reference, n.i), b = get(atoms.reference, n.j);
    if (a[1] * b[1] >= 0)
      return;
    const double x = a[0] + (b[0] - a[0]) * a[1] / (a[1] - b[1]);
    EXPECT_GT(std::abs(x), half * (1 - 1e-9));
    ++n_beside;
  });
  EXPECT_GT(n_beside, 100);
}

TEST(AtomsWithACrack, ItsFacesAreKnownFromTheStart)
{
  const double d = AtomsOfScene<2>(plane_of_atoms).scene.zone.spacing;
  AtomsOfScene<2> unit(
      plane_of_atoms,
      {fmt::format(R"(/specimen/cracks=[{{"points": [[{:.17g}, 0], [{:.17g}, 0]]}}])", -10 * d,
                   10 * d),
       R"(/gauges=[{"name": "tip", "kind": "crack_tip", "points": [[0, 0]], "direction": [1, 0]}])"});
  // Two pairs per atom of a row, whose middles are half a spacing apart.
  const auto values = GaugeSet<2>(unit.scene, unit.body).read(unit.body, 0);
  EXPECT_NEAR(values[0], 10 * d, 0.5 * d);
  EXPECT_EQ(values[1], 0);
  double length = 0;
  for (const BrokenBond &face : unit.body.cut_faces) {
    EXPECT_NEAR(face.centroid[1], 0, 1e-6 * d);
    length += face.size * std::abs(face.normal[1]);
  }
  EXPECT_NEAR(length, 20 * d, d);
  doubt_body(unit.scene, unit.body, unit.log);
  EXPECT_TRUE(unit.log.warnings().empty());
  // One in a hole cuts nothing.
  AtomsOfScene<2> none(plane_of_atoms,
                       {R"(/specimen/notches=[{"lower": ["-4 nm", "-2 nm"],
                                                              "upper": ["4 nm", "2 nm"]}])",
                        R"(/specimen/cracks=[{"points": [["-3 nm", 0], ["3 nm", 0]]}])"});
  doubt_body(none.scene, none.body, none.log);
  EXPECT_EQ(none.log.warnings().size(), 1u);
}

// Atoms where two parts of a side meet belong to both, by their shares.
TEST(AtomsUnderLoad, SupportsOnAdjoiningPartsAreThatOfTheWhole)
{
  const auto reactions = [](const std::string &loads, int n) {
    AtomsOfScene<2> unit(plane_of_atoms, {"/loads=" + loads});
    auto &state = unit.atoms();
    for (double &u : state.displacement[1])
      u = 1e-12;
    unit.body.force()->compute(state, 0);
    double sum = 0;
    for (int l = 0; l < n; ++l)
      sum += unit.body.force()->reaction(l)[1];
    return sum;
  };
  const double whole = reactions(R"([{"boundary": "top", "velocity": [null, 0]}])", 1);
  EXPECT_LT(whole, 0);
  for (const char *at : {"0", "\"0.07 nm\"", "\"3.31 nm\""})
    EXPECT_NEAR(reactions(fmt::format(R"([{{"boundary": "top", "velocity": [null, 0], "to": {0}}},
                                          {{"boundary": "top", "velocity": [null, 0], "from": {0}}}])",
                                      at),
                          2) /
                    whole,
                1, 1e-9)
        << at;
}

TEST(AtomsUnderLoad, ForcesAtPointsActOnTheNearestAtoms)
{
  for (const char *at : {"0", "\"1.23 nm\"", "\"-4.56 nm\""}) {
    AtomsOfScene<2> unit(
        plane_of_atoms,
        {fmt::format(R"(/loads=[{{"boundary": "top", "force": [0, "1 nN"], "from": {0}, "to": {0}}},
                            {{"boundary": "bottom", "velocity": [0, 0]}}])",
                     at)});
    unit.body.force()->compute(unit.atoms(), 0);
    EXPECT_NEAR(unit.body.force()->reaction(0)[1], 1e-9, 1e-15) << at;
  }
  AtomsOfScene<3> bar(copper_bar, {R"(/loads=[{"boundary": "top", "force": [0, "1 nN", 0],
                   "within": {"lower": ["0.1 nm", "-9 nm", "0.2 nm"],
                              "upper": ["0.1 nm", "9 nm", "0.2 nm"]}},
                  {"boundary": "bottom", "velocity": [0, 0, 0]}])"});
  bar.body.force()->compute(bar.atoms(), 0);
  EXPECT_NEAR(bar.body.force()->reaction(0)[1], 1e-9, 1e-15);
}

const std::vector<std::string> warm = {R"(/atoms/temperature="5 K")",
                                       R"(/atoms/lattice_parameter="3.79 angstrom")",
                                       "/time/step_fraction=0.1"};

TEST(WarmAtoms, DriftOnlyWhereASupportTakesThem)
{
  const auto drift = [](const std::vector<std::string> &further) {
    auto overrides = warm;
    overrides.insert(overrides.end(), further.begin(), further.end());
    AtomsOfScene<2> unit(plane_of_atoms, overrides);
    start_heat(unit.scene, unit.body, unit.log);
    Vector<2> momentum = Vector<2>::Zero(), all = momentum;
    for (int i = 0; i < unit.atoms().size(); ++i) {
      const Vector<2> p = unit.atoms().mass[i] * get(unit.atoms().velocity, i);
      momentum += p;
      all += p.cwiseAbs();
    }
    return Vector<2>(momentum.cwiseAbs().cwiseQuotient(all));
  };
  EXPECT_LT(drift({}).maxCoeff(), 1e-13);
  const Vector<2> held = drift({R"(/loads=[{"boundary": "bottom", "velocity": [null, 0]}])"});
  EXPECT_LT(held[0], 1e-13);
  EXPECT_GT(held[1], 1e-6); // as drawn
}

TEST(WarmAtoms, FiguresAreThoseOfTheTemperatureAfterAResumeToo)
{
  auto overrides = warm;
  overrides.push_back("/coupling/gap_filter=0");
  const Scene scene = scene_of(plane_of_atoms, in_a_mesh(overrides));
  Reference reference;
  const std::map<std::string, double> found = {
      {"thermal_c11", 5e9}, {"thermal_c12", 2e9}, {"thermal_c44", 1.5e9}, {"thermal_c_error", 1e7}};
  for (const auto &[name, value] : found)
    reference.value(name, [v = value] { return v; });
  core::Log log;
  core::Timers timers;
  const auto figures_of = [&](std::optional<double> error) {
    auto body = make_body<2>(scene, log, timers, reference, make_zone_force<2>);
    if (error)
      body.figures["thermal_load_error"] = {*error, ""};
    tell_heat(reference, body);
    return body.figures;
  };
  auto first = figures_of(3e-5), again = figures_of({});
  for (auto *figures : {&first, &again}) {
    EXPECT_EQ(figures->at("thermal_load_error").value, 3e-5);
    EXPECT_NEAR(figures->at("C11").value, 5e9, 1);
    EXPECT_NEAR(figures->at("C12").value, 2e9, 1);
    EXPECT_NEAR(figures->at("C33").value, 1.5e9, 1);
  }
}

TEST(WarmAtoms, ALatticeThatWasFoundBelongsToItsTemperature)
{
  const auto read = [](const std::string &text, const std::string &temperature) {
    return parse_scene(text, "atoms",
                       {fmt::format(R"(/atoms/temperature="{}")", temperature), warm[2]});
  };
  const ReadResult first = read(plane_of_atoms, "5 K");
  ASSERT_TRUE(first.scene);
  const double cold = first.scene->atoms->lattice_parameter;
  const ReadResult again = read(first.resolved.dump(), "5 K"),
                   warmer = read(first.resolved.dump(), "15 K");
  ASSERT_TRUE(again.scene && warmer.scene);
  EXPECT_EQ(again.scene->atoms->lattice_parameter, cold);
  EXPECT_GT(warmer.scene->atoms->lattice_parameter, cold * 1.001);
}

// A mesh that loads crush within a few steps: what the run has seen until then stays.
TEST(AtomsInMotion, ARunThatEndsWithinAStepLeavesItsResults)
{
  const RunFolder folder{"blown_up"};
  std::filesystem::remove_all(folder.path);
  folder.create();
  std::FILE *quiet = std::fopen("/dev/null", "w");
  const Scene scene = scene_of(
      plane_of_atoms,
      in_a_mesh({R"(/coupling={"overlap_cells": 6, "regime": "nonlinear", "guard": "warn"})",
                 R"(/loads=[{"boundary": "top", "velocity": [null, "-400 m/s"]},
                            {"boundary": "bottom", "velocity": [null, "400 m/s"]}])",
                 R"(/time/duration="100 ps")", R"(/output={"history_interval": "0.2 ps"})"}));
  const RunRecord record = Simulation<2>(scene, folder, quiet, false).run();
  std::fclose(quiet);
  EXPECT_EQ(record.status, "stopped") << record.reason;
  EXPECT_NE(record.reason.find("compressed by more than a fifth"), std::string::npos)
      << record.reason;
  EXPECT_TRUE(record.trusted_until.has_value());
  for (const std::string &file : {folder.broken_bonds(), folder.history(), folder.record()})
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
}
} // namespace
