// Atoms of other species on sites of a crystal: who is of which one, what they weigh, their energy
// written down plainly, how outputs call them, and that a coupled body keeps its energy. The stress
// that nodes of a mesh beside atoms have.
#include "core/check.h"
#include "core/extremes.h"
#include "core/files.h"
#include "md/table_file.h"
#include "src/output/table.h"
#include "src/output/xyz.h"
#include "src/simulation/body_fields.h"
#include "src/simulation/energy_ledger.h"
#include "src/simulation/gauges/gauge_set.h"
#include "src/simulation/regime_control.h"
#include "src/simulation/simulation.h"
#include "tests/oracle/atom_oracle.h"
#include "tests/support/atom_bodies.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
constexpr double nm = 1e-9, mass_unit = 1.66053906660e-27;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A ball of silver, in it one of copper again, and a box in which about a third is nickel.
const std::string substitutions = R"("substitutions": [
    {"species": "Ag", "balls": [{"centre": ["-1 nm", 0, 0], "radius": "0.9 nm"}]},
    {"species": "Cu", "balls": [{"centre": ["-1 nm", 0, 0], "radius": "0.4 nm"}]},
    {"species": "Ni", "share": 0.3,
     "boxes": [{"lower": ["0.5 nm", "-3 nm", "-1 nm"], "upper": ["3.5 nm", "3 nm", "1 nm"]}]}])";
const std::string mixed = R"(/atoms={"potential": "zhou", "species": "Cu", )" + substitutions + "}";

TEST(Alloys, TakeTheSitesOfTheirRegionsLaterOnesFirst)
{
  AtomsOfScene<3> unit(copper_bar, {mixed});
  auto &atoms = unit.atoms();
  const auto &force = *unit.body.force();
  EXPECT_EQ(force.symbols(), (std::vector<std::string>{"Cu", "Ag", "Ni"}));
  const double mass[] = {63.546 * mass_unit, 107.8682 * mass_unit, 58.6934 * mass_unit};
  int n[3] = {}, n_in_box = 0, n_inside = 0;
  for (int i = 0; i < atoms.size(); ++i) {
    const Vector<3> x = get(atoms.reference, i);
    const double r = (x - Vector<3>(-1 * nm, 0, 0)).norm();
    const int a = force.material(i);
    ++n[a];
    // z repeats itself after some 1.1 nm: images of the ball reach into the box, too.
    const double image = std::min((x - Vector<3>(-1 * nm, 0, unit.scene.specimen.size[2])).norm(),
                                  (x + Vector<3>(1 * nm, 0, unit.scene.specimen.size[2])).norm());
    const bool in_box = x[0] > 0.5 * nm && x[0] < 3.5 * nm && std::abs(x[1]) < 3 * nm;
    n_in_box += in_box;
    n_inside += r < 0.4 * nm;
    if (in_box)
      EXPECT_NE(a, 1);
    else
      EXPECT_EQ(a, std::min(r, image) < 0.9 * nm && std::min(r, image) >= 0.4 * nm ? 1 : 0);
    EXPECT_NEAR(atoms.mass[i] / mass[a], 1, 1e-12); // digits of the mass unit
  }
  EXPECT_GT(n[1], 50);
  EXPECT_GT(n_inside, 5);
  // Four standard deviations of a binomial number.
  EXPECT_NEAR(n[2], 0.3 * n_in_box, 4 * std::sqrt(0.21 * n_in_box));
}

/// Nickel in copper in the plane, where neither has a material of its own: a disc in the middle.
const std::string copper_plane = R"({
  "dimension": 2,
  "specimen": {"size": ["46 nm", "46 nm"], "thickness": "0.25 nm"},
  "atoms": {"potential": "zhou", "species": "Cu", "substitutions": [
    {"species": "Ni", "share": 0.8, "balls": [{"centre": ["0.5 nm", 0], "radius": "1.5 nm"}]}]},
  "discrete_zone": {"packing": "hexagonal", "region": {"lower": ["-11 nm", "-11 nm"],
                                                       "upper": ["11 nm", "11 nm"]}},
  "far_field": {"cell_size": "1.1 nm"},
  "coupling": {"overlap_cells": 6},
  "time": {"duration": "1 ps", "step_fraction": 0.2},
  "output": {"progress_interval": 1e9}
})";

/// Names of the sites that are not the crystal's.
template <int dim>
std::vector<std::int64_t> substituted(const CoupledBody<dim> &body)
{
  std::vector<std::int64_t> names;
  for (int i = 0; i < body.zone->state.size(); ++i)
    if (body.force()->material(i) != 0)
      names.push_back(body.zone->state.global_id[i]);
  std::sort(names.begin(), names.end());
  return names;
}

TEST(Alloys, ChanceBelongsToTheSites)
{
  const AtomsOfScene<2> coupled(copper_plane);
  const auto names = substituted(coupled.body);
  EXPECT_GT(names.size(), 60u);
  EXPECT_EQ(substituted(AtomsOfScene<2>(copper_plane, {"/far_field=none"}).body), names);
  EXPECT_NE(substituted(AtomsOfScene<2>(copper_plane, {"/atoms/seed=2"}).body), names);
}

/// Of the tables of a file, without normal form and neighbour list.
void expect_energy_of_all_pairs(const std::string &form, const std::string &table,
                                const std::vector<std::string> &species, const md::Potential &p)
{
  const std::string atoms = fmt::format(
      R"(/atoms={{"potential": "{}", "file": "/usr/share/lammps/potentials/{}", "species": "{}",
          "substitutions": [{{"species": "{}", "share": 0.4,
                              "balls": [{{"centre": [0, 0, 0], "radius": "0.9 nm"}}]}}]}})",
      form, table, species[0], species[1]);
  AtomsOfScene<3> unit(copper_bar, {atoms, R"(/specimen/size=["2.6 nm", "2.4 nm", "1.4 nm"])"});
  auto &state = unit.atoms();
  auto &force = *unit.body.force();
  oracle::AtomOracle<3> plain;
  const auto curve = [](const md::Jet &jet) { return oracle::Curve{jet.value, jet.slope}; };
  plain.pair = [&](int a, int b, double r) { return curve(p.bond(a, b, r).pair); };
  plain.density = [&](int a, int b, double r) { return curve(p.bond(a, b, r).density_at_i); };
  plain.embedding = [&](int a, double rho) { return curve(p.embedding(a, rho)); };
  plain.cutoff = p.cutoff();
  plain.period[2] = unit.scene.specimen.size[2];
  int n_other = 0;
  for (int i = 0; i < state.size(); ++i) {
    plain.species.push_back(force.material(i));
    n_other += force.material(i) == 1;
    EXPECT_NEAR(state.mass[i] / p.species(force.material(i)).mass, 1, 4 * epsilon);
  }
  EXPECT_GT(n_other, 30);
  plain.compute(state);
  const double at_rest = plain.energy;
  const double d = unit.scene.zone.spacing;
  unit.shake(0.03 * d, 7);
  plain.compute(state);
  const Components<3> expected = state.force;
  force.compute(state, 0);
  // Tens of terms per atom, some of them of several depths of the crystal's energy; forces are
  // such terms over a tenth of a spacing. The plain energy is one sum of some thirty terms per atom,
  // each of which rounds a sum as large as several depths per atom: a random walk.
  const double depth = std::abs(crystal_of<3>(unit.scene).cohesive_energy()),
               rounding = 300 * epsilon * depth, n = state.size();
  EXPECT_NEAR(force.potential_energy(state), plain.energy - at_rest,
              std::sqrt(30 * n) * epsilon * 5 * n * depth);
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < state.size(); ++i)
      EXPECT_NEAR(state.force[c][i], expected[c][i], 10 * rounding / d);
}

TEST(Alloys, HaveTheEnergyOfAllTheirPairs)
{
  const std::string folder = "/usr/share/lammps/potentials/";
  expect_energy_of_all_pairs("setfl", "NiAlH_jea.eam.alloy", {"Ni", "Al"},
                             md::read_setfl(folder + "NiAlH_jea.eam.alloy", {"Ni", "Al"}));
  expect_energy_of_all_pairs("setfl_fs", "CuZr_mm.eam.fs", {"Cu", "Zr"},
                             md::read_setfl_fs(folder + "CuZr_mm.eam.fs", {"Cu", "Zr"}));
}

TEST(Alloys, AreWrittenByTheirElements)
{
  AtomsOfScene<3> unit(copper_bar, {mixed});
  BodyState state;
  state.particles = particle_fields(unit.body);
  StateFields<3>().complete(unit.body, state);
  write_atoms_xyz("alloy.xyz", state.particles, 0);
  std::istringstream file(core::read_file("alloy.xyz"));
  std::string line, symbol;
  std::getline(file, line);
  EXPECT_EQ(line, std::to_string(unit.atoms().size()));
  std::getline(file, line);
  std::map<std::string, double> mass = {{"Cu", 63.546}, {"Ag", 107.8682}, {"Ni", 58.6934}};
  std::map<std::string, int> n;
  for (int i = 0; i < unit.atoms().size(); ++i) {
    ASSERT_TRUE(std::getline(file, line));
    std::istringstream(line) >> symbol;
    ++n[symbol];
    ASSERT_EQ(mass.count(symbol), 1u);
    EXPECT_NEAR(unit.atoms().mass[i] / mass_unit / mass[symbol], 1, 1e-12);
  }
  EXPECT_EQ(n.size(), 3u);
}

/// Largest residual of the ledger and kinetic energy of a run, in J.
std::array<double, 2> run(double step_fraction)
{
  const RunFolder folder{fmt::format("alloy_{}", step_fraction)};
  std::filesystem::remove_all(folder.path);
  folder.create();
  std::FILE *quiet = std::fopen("/dev/null", "w");
  const Scene scene =
      scene_of(copper_plane, {fmt::format("/time/step_fraction={}", step_fraction)});
  const RunRecord record = Simulation<2>(scene, folder, quiet, false).run();
  std::fclose(quiet);
  EXPECT_EQ(record.status, "done") << record.reason;
  EXPECT_EQ(record.broken_bonds, 0);
  const Table history = read_csv(folder.history(), TableEnd::whole);
  const auto residual = history.column("residual", "J"),
             discrete = history.column("kinetic_discrete", "J"),
             far = history.column("kinetic_far", "J");
  std::array<double, 2> largest = {};
  for (std::size_t k = 0; k < residual.size(); ++k) {
    keep_largest(largest[0], std::abs(residual[k]));
    keep_largest(largest[1], discrete[k] + far[k]);
  }
  return largest;
}

// Atoms of nickel are smaller: what they bear at first becomes motion. The ledger of leap-frog is
// exact for linear bodies and of second order in the step else.
TEST(Alloys, CoupledBodyKeepsItsEnergy)
{
  const auto coarse = run(0.2), fine = run(0.1);
  EXPECT_GT(fine[1], 1e-21);
  EXPECT_LT(coarse[0], 1e-2 * coarse[1]);
  EXPECT_LT(fine[0], coarse[0] / 3);
}

/// What is wrong with the body when an atom of another species comes as near to the edge of the zone
/// as this share of the distance that it must keep, behind the back of the checks.
std::string fault_at(double share)
{
  Scene scene = scene_of(copper_plane);
  auto &substitution = scene.atoms->substitutions[0];
  const double keep_off =
      scene.coupling.overlap_cells * scene.far_field->cell_size + scene.atoms->disturbance;
  substitution.share = 1;
  substitution.balls[0].centre = {0, 0, 0};
  substitution.balls[0].radius = scene.zone.upper[0] - share * keep_off;
  EXPECT_GT(substitution.balls[0].radius, scene.zone.spacing);
  core::Log log;
  core::Timers timers;
  try {
    make_body<2>(scene, log, timers);
  } catch (const core::InputError &error) {
    return error.what();
  }
  return "";
}

TEST(Alloys, OverlapIsOfTheCrystalAlone)
{
  EXPECT_EQ(fault_at(1.01), "");
  EXPECT_NE(fault_at(0.9).find("/atoms/substitutions"), std::string::npos);
}

// Cells that obey Cauchy and Born's law tell its stress: all atoms beside them have the same.
TEST(CopperInAMesh, NodesHaveTheStressOfTheAtoms)
{
  for (const double strain : {0.03, -0.02}) {
    AtomsOfScene<2> unit(
        copper_plane, {R"(/atoms={"potential": "zhou", "species": "Cu"})",
                       R"(/coupling={"overlap_cells": 6, "regime": "nonlinear"})",
                       R"(/gauges=[{"name": "s", "kind": "stress", "points": [["20 nm", 0]]}])"});
    const RegimeControl<2> regime(unit.scene.coupling.regime, unit.body);
    Eigen::Matrix2d gradient;
    gradient << 0.3 * strain, 0.5 * strain, 0, strain;
    unit.impose([&](const Vector<2> &x) { return Vector<2>(gradient * x); });
    Components<3> stress;
    unit.body.force()->stresses(unit.atoms(), stress);
    int middle = 0;
    for (int i = 0; i < unit.atoms().size(); ++i)
      if (get(unit.atoms().reference, i).norm() < get(unit.atoms().reference, middle).norm())
        middle = i;
    const Vector<3> expected = get(stress, middle);
    const CellFields cells = cell_fields(unit.body);
    const Field *of_nodes = find_field(cells.node_fields, "stress");
    ASSERT_TRUE(of_nodes);
    const int voigt[] = {0, 1, 3};
    for (std::size_t n = 0; n < cells.reference.size() / 3; ++n)
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(of_nodes->values[6 * n + voigt[c]], expected[c], 1e-3 * expected.norm());
    const auto gauge = GaugeSet<2>(unit.scene, unit.body).read(unit.body, 0);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(gauge[c], expected[c], 1e-3 * expected.norm()) << c;
  }
}
} // namespace
