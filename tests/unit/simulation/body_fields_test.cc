// The fields of a state: those of the table, and what their numbers say.
#include "src/simulation/body_fields.h"
#include "tests/support/small_plate.h"

#include <Eigen/Geometry>

#include <map>

using namespace ligament;
using namespace ligament::program;
using namespace ligament::tests;

namespace
{
/// Of a body of `scene` at rest, with these broken faces.
BodyState complete_state(const SmallBody &small, std::vector<BrokenBond> bonds = {})
{
  BodyState state;
  state.particles = particle_fields(small.body);
  state.cells = cell_fields(small.body);
  state.bonds = std::move(bonds);
  StateFields<2>().complete(small.body, state);
  return state;
}

/// All that the table promises, no more, and a value for every item.
void expect_fields(const std::vector<Field> &fields, bool FieldInfo::*on, std::size_t n_items,
                   bool flows = false)
{
  std::size_t n = 0;
  for (const FieldInfo &info : field_table())
    if (info.*on && (info.only == FieldInfo::Only::anywhere ||
                     (flows && info.only == FieldInfo::Only::where_it_flows)))
    {
      ++n;
      const Field *field = find_field(fields, info.name);
      ASSERT_NE(field, nullptr) << info.name;
      EXPECT_EQ(field->unit, info.unit);
      EXPECT_EQ(field->values.size(), n_items * field->n_components()) << info.name;
    }
  EXPECT_EQ(fields.size(), n);
}

const std::vector<double> &values(const BodyState &state, const char *name)
{
  return find_field(state.particles.fields, name)->values;
}

// Those of flow are there where a material flows.
const std::string flows = R"(/material/plasticity={"yield_stress": 1e-3, "hardening": 0.1})";

TEST(StateFields, AreThoseOfTheTable)
{
  for (const std::string scene :
       {"/coupling/overlap_cells=2", "/far_field=none", "/discrete_zone=none", flows.c_str()})
  {
    SCOPED_TRACE(scene);
    const SmallBody small(small_scene({scene}));
    const BodyState state = complete_state(small);
    if (state.particles.size() > 0)
      expect_fields(state.particles.fields, &FieldInfo::on_particles, state.particles.size(),
                    scene == flows);
    if (state.cells.n_cells() > 0) {
      expect_fields(state.cells.node_fields, &FieldInfo::on_nodes, state.cells.n_nodes());
      expect_fields(state.cells.cell_fields, &FieldInfo::on_cells, state.cells.n_cells());
    }
  }
}

// A homogeneous strain beyond yielding, in a body that has turned: the stress lies on the yield
// surface, its part out of the plane included; the strain has the axes of space.
TEST(StateFields, FlowLeavesItsStrain)
{
  constexpr double strain = 0.01, angle = 0.4;
  SmallBody small(small_scene({"/far_field=none", flows}));
  const Eigen::Rotation2Dd turn(angle);
  Eigen::Matrix2d stretch = Eigen::Matrix2d::Identity();
  stretch(1, 1) += strain;
  small.deform(turn * stretch - Eigen::Matrix2d::Identity());
  auto &particles = small.body.zone->state;
  std::fill(particles.rotation[0].begin(), particles.rotation[0].end(), angle);
  small.body.force()->compute(particles, 1);
  const BodyState state = complete_state(small);
  std::size_t middle = 0;
  const auto &x = state.particles.reference;
  for (std::size_t i = 0; i < x.size() / 3; ++i)
    if (std::hypot(x[3 * i], x[3 * i + 1]) < std::hypot(x[3 * middle], x[3 * middle + 1]))
      middle = i;
  const double p = values(state, "plastic_strain")[middle];
  EXPECT_GT(p, 0.5 * strain);
  EXPECT_NEAR(values(state, "equivalent_stress")[middle], 1e-3 + 0.1 * p, 1e-12);
  const double *const e = &values(state, "inelastic_strain")[6 * middle];
  EXPECT_NEAR(e[0] + e[1] + e[2], 0, 1e-15);
  // Along the pull p, across it half of that: yy in the body's own axes.
  const Eigen::Vector2d along = turn * Eigen::Vector2d(0, 1), across = turn * Eigen::Vector2d(1, 0);
  Eigen::Matrix2d in_plane;
  in_plane << e[0], e[3], e[3], e[1];
  EXPECT_NEAR(along.dot(in_plane * along), p, 1e-12);
  EXPECT_NEAR(across.dot(in_plane * across), -p / 2, 1e-12);
  EXPECT_NEAR(e[2], -p / 2, 1e-12);
  EXPECT_NEAR(along.dot(in_plane * across), 0, 1e-12);
}

// Cells that turn bear no stress from that, and turn the one that they have.
TEST(StateFields, StressOfTheMeshTurnsWithIt)
{
  constexpr double angle = 0.4, strain = 1e-3;
  SmallBody small(small_scene({"/discrete_zone=none"}));
  small.body.far->set_corotated(true);
  Eigen::Matrix2d stretch = Eigen::Matrix2d::Identity();
  stretch(1, 1) += strain;
  small.deform(stretch - Eigen::Matrix2d::Identity());
  const auto straight = find_field(cell_fields(small.body).node_fields, "stress")->values;
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(angle).toRotationMatrix();
  small.deform(turn * stretch - Eigen::Matrix2d::Identity());
  const auto turned = find_field(cell_fields(small.body).node_fields, "stress")->values;
  for (std::size_t k = 0; k < straight.size(); k += 6) {
    Eigen::Matrix2d own;
    own << straight[k], straight[k + 3], straight[k + 3], straight[k + 1];
    ASSERT_GT(own(1, 1), 0);
    const Eigen::Matrix2d expected = turn * own * turn.transpose();
    const double round_off = 1e-9 * own(1, 1);
    ASSERT_NEAR(turned[k], expected(0, 0), round_off);
    ASSERT_NEAR(turned[k + 1], expected(1, 1), round_off);
    ASSERT_NEAR(turned[k + 2], straight[k + 2], round_off);
    ASSERT_NEAR(turned[k + 3], expected(0, 1), round_off);
  }
}

// Particles say where they are in the coupling as the overlap does.
TEST(StateFields, ZonesAreThoseOfTheOverlap)
{
  const SmallBody small(small_scene({"/coupling/overlap_cells=2"}));
  const BodyState state = complete_state(small);
  const auto &zone = values(state, "zone");
  const auto &overlap = *small.body.coupler->overlap();
  std::map<double, int> n;
  for (std::size_t i = 0; i < zone.size(); ++i) {
    ++n[zone[i]];
    const int member = overlap.member_of_particle[i];
    const ZoneNumber expected = member < 0                    ? ZoneNumber::discrete
                                : overlap.members[member].pad ? ZoneNumber::pad
                                                              : ZoneNumber::overlap;
    ASSERT_EQ(zone[i], double(expected)) << i;
  }
  EXPECT_EQ(n.size(), 3u);
  const auto &cells = find_field(state.cells.cell_fields, "zone")->values;
  for (const auto &cell : overlap.cells)
    EXPECT_EQ(cells[cell.cell],
              double(cell.layer == 0 ? ZoneNumber::overlap : ZoneNumber::transition));
  EXPECT_EQ(std::count(cells.begin(), cells.end(), double(ZoneNumber::far)),
            long(cells.size() - overlap.cells.size()));
}

// A particle inside a hexagonal packing has six neighbours: one broken face makes a share of 1/6.
// The names of broken_bonds.csv lead to the two particles at the face.
TEST(StateFields, BrokenSharesStandAtTheNamedParticles)
{
  const SmallBody small(small_scene({"/coupling/overlap_cells=2"}));
  BrokenBond bond = {};
  small.body.force()->for_each_face(small.body.zone->state, [&](const auto &face) {
    if (!face.bonded || face.centroid.norm() > 1 || face.i > face.j)
      return;
    bond.i = small.body.zone->state.global_id[face.i];
    bond.j = small.body.zone->state.global_id[face.j];
    bond.centroid[0] = face.centroid[0];
    bond.centroid[1] = face.centroid[1];
  });
  ASSERT_NE(bond.i, bond.j);
  const BodyState state = complete_state(small, {bond});
  const auto &id = values(state, "global_id"), &share = values(state, "broken_bond_share");
  double middle[2] = {};
  int n = 0;
  for (std::size_t i = 0; i < id.size(); ++i) {
    const bool named = id[i] == double(bond.i) || id[i] == double(bond.j);
    EXPECT_NEAR(share[i], named ? 1 / 6. : 0, 1e-15);
    if (named) {
      ++n;
      for (int c = 0; c < 2; ++c)
        middle[c] += state.particles.reference[3 * i + c] / 2;
    }
  }
  EXPECT_EQ(n, 2);
  EXPECT_NEAR(middle[0], bond.centroid[0], 1e-12);
  EXPECT_NEAR(middle[1], bond.centroid[1], 1e-12);
}

// Faces that a crack cuts count, and are listed.
TEST(StateFields, CutFacesAreListed)
{
  const SmallBody small(
      small_scene({"/specimen/cracks=[{\"points\": [[-4, 0], [4, 0]]}]", "/far_field=none"}));
  const BodyState state = complete_state(small);
  EXPECT_EQ(state.cuts.size(), std::size_t(small.body.n_cracked_faces));
  EXPECT_GT(state.cuts.size(), 5u);
  for (const BrokenBond &cut : state.cuts) {
    EXPECT_LT(std::abs(cut.centroid[1]), small.body.spacing);
    EXPECT_LT(std::abs(cut.centroid[0]), 4 + small.body.spacing);
    EXPECT_GT(cut.size, 0);
  }
  const auto &share = values(state, "broken_bond_share");
  EXPECT_GT(*std::max_element(share.begin(), share.end()), 0.3); // two of six
}

TEST(StateFields, RadiiAreThoseOfTheSeeds)
{
  const SmallBody small(small_scene(
      {"/discrete_zone/packing=random", "/discrete_zone/size_ratio=3", "/far_field=none"}));
  const BodyState state = complete_state(small);
  std::map<std::int64_t, double> of_seed;
  for (int k = 0; k < small.body.seeds->size(); ++k)
    of_seed[small.body.seeds->id[k]] = small.body.seeds->radius[k];
  const auto &id = values(state, "global_id"), &radius = values(state, "radius");
  for (std::size_t i = 0; i < id.size(); ++i)
    ASSERT_EQ(radius[i], of_seed.at(std::int64_t(id[i])));
  EXPECT_GT(*std::max_element(radius.begin(), radius.end()),
            1.5 * *std::min_element(radius.begin(), radius.end()));
}
} // namespace
