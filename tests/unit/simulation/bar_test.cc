// What looks at a body in three dimensions: sections, test machine, fields.
#include "src/simulation/body_fields.h"
#include "src/simulation/doubts.h"
#include "src/simulation/load_path.h"
#include "src/simulation/test_machine.h"
#include "tests/support/small_bar.h"

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
// Simple cubic packing of spacing 1: each column of particles is a face of area 1.
TEST(Bar, SectionIsWhatTheCutsLeave)
{
  const auto section = [](const std::string &cracks, const std::string &far, int axis) {
    const Bar bar({"/discrete_zone/packing=\"simple_cubic\"", "/specimen/cracks=" + cracks, far});
    return smallest_section(bar.body, axis, Carrying::now);
  };
  // From x = -4 to 1: three of the eight columns are left; in z all seven.
  const std::string cut =
      R"([{"points": [[-5, 0.5, -5], [1, 0.5, -5], [1, 0.5, 5], [-5, 0.5, 5]]}])";
  const std::string through =
      R"([{"points": [[-5, 0.5, -5], [5, 0.5, -5], [5, 0.5, 5], [-5, 0.5, 5]]}])";
  for (const std::string far : {"/coupling/overlap_cells=2", "/far_field=none"}) {
    SCOPED_TRACE(far);
    EXPECT_NEAR(section(cut, far, 1), 3 * 7, 1e-9);
    EXPECT_EQ(section(through, far, 1), 0);
    EXPECT_GT(section(through, far, 2), 8 * 20); // the halves still reach across
  }
}

// Uniaxial stress along y of a bar with E = 1, nu = 0.22 whose other sides are free.
TEST(Bar, TheTestMachineReadsItsStress)
{
  constexpr double strain = 1e-4, nu = 0.22, length = 60, area = 8 * 7;
  const std::string held_ends =
      R"(/loads=[{"boundary": "top", "displacement": [null, 0.003, null]},
                 {"boundary": "bottom", "displacement": [null, -0.003, null]}])";
  for (const auto &kind : body_kinds) {
    SCOPED_TRACE(kind.name);
    Bar bar(kind.overrides + std::vector<std::string>{held_ends});
    bar.deform(Eigen::Vector3d(-nu * strain, strain, -nu * strain).asDiagonal());
    const Reading r = TestMachine<3>(bar.body).read(bar.body, 0);
    EXPECT_NEAR(r.load / (area * strain), 1, 1e-9);
    EXPECT_NEAR(r.stress / strain, 1, 1e-9);
    EXPECT_NEAR(r.strain / strain, 1, 1e-12);
    EXPECT_NEAR(r.displacement / (length * strain), 1, 1e-12);
  }
}

// Both outer layers of face-centred cubic particles overhang a bar that is five spacings deep: each
// of their cells is held by too few bonds. Six spacings end between two layers. So do the layers of
// a cubic lattice, four of them.
TEST(Bar, LayersThatCannotFlowAreDoubted)
{
  const auto doubts = [](const std::string &depth, const std::string &packing, bool breaks = true) {
    const Scene scene = static_scene<3>(
        {"/far_field=none", "/specimen/size=[4, 6, " + depth + "]",
         breaks ? R"(/material/fracture={"criterion": "maximum_tension", "strength": 1})"
                : R"(/material/fracture={"criterion": "none"})",
         R"(/discrete_zone={"extent": "all", "spacing": 1, "packing": ")" + packing + "\"}",
         R"(/material/plasticity={"yield_stress": 1e-3, "hardening": 0.1})"});
    core::Log log;
    core::Timers timers;
    const auto body = make_body<3>(scene, log, timers);
    core::Log of_doubts;
    doubt_body(scene, body, of_doubts);
    return of_doubts.warnings();
  };
  const auto expect_loose = [&](const char *packing, const std::string &share) {
    const auto found = doubts("5", packing);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].rfind(share + " particles neither flow", 0), 0u) << found[0];
  };
  expect_loose("fcc", "48 of 144");
  expect_loose("simple_cubic", "48 of 96");
  for (const auto &[depth, packing] : {std::pair("6", "fcc"), {"6", "simple_cubic"}}) {
    const auto none = doubts(depth, packing);
    EXPECT_TRUE(none.empty()) << none[0];
  }
  const auto none = doubts("5", "fcc", false); // with straight levers they flow
  EXPECT_TRUE(none.empty()) << none[0];
}

// Six components that are all different: xx, yy, zz, xy, yz, xz of the files are those of Hooke's
// law, of particles and of elements.
TEST(Bar, FieldsNameTheComponentsOfStress)
{
  constexpr double nu = 0.22, shear = 1 / (2 * (1 + nu)), lame = nu / ((1 + nu) * (1 - 2 * nu));
  Eigen::Matrix3d e;
  e << 1, 4, 6, 4, 2, 5, 6, 5, 3;
  e *= 1e-7;
  const Eigen::Matrix3d s = lame * e.trace() * Eigen::Matrix3d::Identity() + 2 * shear * e;
  const double expected[] = {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
  Bar bar({"/coupling/overlap_cells=2"});
  bar.deform(e);
  const auto expect_stress = [&](const std::vector<Field> &fields, std::size_t i) {
    const auto &values = find_field(fields, "stress")->values;
    for (int k = 0; k < 6; ++k)
      EXPECT_NEAR(values[6 * i + k] / expected[k], 1, 1e-5) << k;
  };
  const ParticleFields particles = particle_fields(bar.body);
  std::size_t middle = 0;
  const auto off = [&](std::size_t i) {
    return Eigen::Map<const Eigen::Vector3d>(&particles.reference[3 * i]).norm();
  };
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (off(i) < off(middle))
      middle = i;
  expect_stress(particles.fields, middle);
  const CellFields cells = cell_fields(bar.body);
  ASSERT_GT(cells.n_nodes(), 0u);
  expect_stress(cells.node_fields, 0);
}
} // namespace
