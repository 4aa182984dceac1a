// Random packings: closed cells, the true volume, the same particles whatever is packed, healing.
#include "core/extremes.h"
#include "packings/packing_file.h"
#include "packings/power_diagram.h"
#include "packings/random_packing.h"

#include "core/check.h"
#include "core/files.h"
#include "tests/unit/packings/packing_checks.h"

#include <algorithm>

namespace ligament::packings::test
{
namespace
{
/// A specimen far from the origin, with a notch and in 2D a hole.
template <int dim>
RandomParameters<dim> random_specimen(double ratio)
{
  RandomParameters<dim> p;
  p.spacing = 0.01;
  p.thickness = 0.3;
  p.size_ratio = ratio;
  p.relaxation_sweeps = dim == 2 ? 8 : 4;
  const double size = dim == 2 ? 24 : 9;
  for (int a = 0; a < dim; ++a) {
    p.lower[a] = 0.7 - 0.4 * a;
    p.upper[a] = p.lower[a] + size * p.spacing * (1 - 0.1 * a);
  }
  BoxNotch<dim> notch{p.lower, p.upper};
  notch.upper[0] = p.lower[0] + 0.3 * size * p.spacing;
  notch.lower[1] = p.lower[1] + 0.3 * size * p.spacing;
  notch.upper[1] = notch.lower[1] + 1.5 * p.spacing;
  p.notches.push_back(notch);
  if constexpr (dim == 2)
    p.holes.push_back({p.lower + Vector<2>(15, 14) * p.spacing, 3.3 * p.spacing});
  return p;
}

/// Of the box without the notch and the polygon, which has the area of the disc.
template <int dim>
double material_volume(const RandomParameters<dim> &p)
{
  double volume = (p.upper - p.lower).prod() - (p.notches[0].upper - p.notches[0].lower).prod();
  for (const auto &hole : p.holes)
    volume -= M_PI * hole.radius * hole.radius;
  return volume * (dim == 2 ? p.thickness : 1);
}

template <int dim>
void check_closure(double ratio)
{
  const auto p = random_specimen<dim>(ratio);
  const auto packing = make_random_packing<dim>(p).packing;
  const double round_off =
      1e3 * std::numeric_limits<double>::epsilon() * p.upper.norm() / p.spacing;
  EXPECT_LT(closure_error(packing), round_off);
  EXPECT_NEAR(total_volume(packing) / material_volume<dim>(p), 1, round_off);
  EXPECT_TRUE(std::is_sorted(packing.global_id.begin(), packing.global_id.end()));
  for (const auto &face : packing.faces) {
    EXPECT_GT(std::min(face.q_i, face.q_j), 0);
    EXPECT_EQ(face.direction, -1);
  }
  // One seed per mean cell: the number fluctuates only where the surface cuts the squares (cubes).
  const double cell = mean_cell_volume<dim>(p.spacing) * (dim == 2 ? p.thickness : 1);
  EXPECT_NEAR(packing.size() * cell / material_volume<dim>(p), 1, 0.05);
}
} // namespace

TEST(RandomPacking, CellsAreClosedAndFillTheSpecimen2D)
{
  check_closure<2>(1);
  check_closure<2>(5);
}

TEST(RandomPacking, CellsAreClosedAndFillTheSpecimen3D)
{
  check_closure<3>(1);
  check_closure<3>(5);
}

TEST(RandomPacking, TheSeedDecides)
{
  auto p = random_specimen<2>(2);
  const auto one = make_random_packing<2>(p).packing, same = make_random_packing<2>(p).packing;
  EXPECT_EQ(one.centre, same.centre);
  EXPECT_EQ(one.volume, same.volume);
  p.seed = 2;
  EXPECT_NE(one.centre, make_random_packing<2>(p).packing.centre);
}

TEST(RandomPacking, SeedsLieInTheirSquares)
{
  RandomParameters<2> p;
  p.spacing = 1;
  p.lower.setConstant(-6);
  p.upper.setConstant(6);
  const SpecimenShape<2> shape(p);
  const auto seeds = draw_seeds<2>(shape, 1, 1, 3, p.lower, p.upper);
  const double side = std::sqrt(std::sqrt(3.) / 2);
  std::vector<std::pair<long, long>> squares;
  double sum = 0;
  for (int i = 0; i < seeds.size(); ++i) {
    squares.push_back({std::lround(std::floor(seeds.centre[i][0] / side)),
                       std::lround(std::floor(seeds.centre[i][1] / side))});
    sum += 4 * seeds.radius[i] * seeds.radius[i];
  }
  std::sort(squares.begin(), squares.end());
  EXPECT_EQ(std::unique(squares.begin(), squares.end()), squares.end());
  // Four standard errors of the mean of r^2: its variance over its squared mean is 0.45 for 1 to 3.
  EXPECT_NEAR(sum / seeds.size(), 1, 4 * std::sqrt(0.45 / seeds.size()));
}

TEST(RandomPacking, AZoneHasTheParticlesOfTheSpecimen)
{
  for (const double ratio : {1., 3.}) {
    auto p = random_specimen<2>(ratio);
    p.upper[1] = p.lower[1] + 80 * p.spacing;
    p.relaxation_sweeps = 4;
    p.notches.clear();
    const auto whole = make_random_packing<2>(p).packing;
    p.zone_lower[1] = p.lower[1] + 20 * p.spacing;
    p.zone_upper[1] = p.lower[1] + 45 * p.spacing;
    const auto zone = make_random_packing<2>(p).packing;
    ASSERT_GT(zone.size(), 300);
    ASSERT_LT(zone.size(), whole.size());
    std::vector<char> is_inside(zone.size(), 1);
    for (int i = 0; i < zone.size(); ++i) {
      const auto found =
          std::lower_bound(whole.global_id.begin(), whole.global_id.end(), zone.global_id[i]);
      ASSERT_TRUE(found != whole.global_id.end() && *found == zone.global_id[i]);
      const int j = int(found - whole.global_id.begin());
      EXPECT_EQ(get(zone.centre, i), get(whole.centre, j));
      EXPECT_EQ(zone.volume[i], whole.volume[j]);
      // Cells within reach of the edge may lack neighbours.
      const double y = zone.centre[1][i];
      is_inside[i] = std::min(y - p.zone_lower[1], p.zone_upper[1] - y) > 4 * ratio * p.spacing;
    }
    EXPECT_LT(closure_error(zone, is_inside), 1e-12);
  }
}

TEST(RandomPacking, CracksCutTheFacesThatTheyCross)
{
  auto p = random_specimen<2>(1);
  p.notches.clear();
  const double height = p.lower[1] + 5.1 * p.spacing;
  p.cracks = {{{p.lower[0], height}, {p.upper[0], height}}};
  const auto packing = make_random_packing<2>(p).packing;
  int n_cracked = 0;
  for (const auto &face : packing.faces) {
    const bool crosses =
        (packing.centre[1][face.i] > height) != (packing.centre[1][face.j] > height);
    EXPECT_EQ(face.cracked, crosses);
    n_cracked += face.cracked;
  }
  EXPECT_GT(n_cracked, 20);
}

// A large radius beside small ones takes their centres; without healing their cells are lost.
TEST(RandomPacking, LostCellsAreHealed)
{
  SpecimenParameters<2> p;
  p.spacing = 1;
  p.lower.setConstant(-5);
  p.upper.setConstant(5);
  Seeds<2> seeds;
  for (int i = 0; i < 100; ++i)
    seeds.add(Vector<2>(i % 10 - 4.5 + 0.1 * (i % 3), i / 10 - 4.5), 0.5, i);
  seeds.radius[44] = 3; // covers its neighbours
  Seeds<2> healed = seeds;
  EXPECT_EQ(heal_radii(healed, 1.), 1);
  EXPECT_EQ(heal_radii(healed, 1.), 0);
  const auto result = pack_seeds<2>(p, seeds);
  EXPECT_EQ(result.n_healed, 1);
  EXPECT_EQ(result.packing.size(), 100);
  EXPECT_LT(closure_error(result.packing), 1e-12);
  EXPECT_NEAR(total_volume(result.packing), 100, 1e-11);
  // As little as possible: one of the faces of the large one is at its limit, a quarter of the
  // distance from the smaller one.
  double least = 1;
  for (const auto &face : result.packing.faces)
    keep_smallest(least, std::min(face.q_i, face.q_j) / (face.q_i + face.q_j));
  EXPECT_NEAR(least, 0.25, 1e-12);
}

TEST(RandomPacking, WrongParametersAreRefused)
{
  auto p = random_specimen<2>(1);
  p.size_ratio = 5.1;
  EXPECT_THROW(make_random_packing<2>(p), core::InputError);
  p.size_ratio = 0.9;
  EXPECT_THROW(make_random_packing<2>(p), core::InputError);
  p.size_ratio = 1;
  p.relaxation_sweeps = -1;
  EXPECT_THROW(make_random_packing<2>(p), core::InputError);
  Seeds<2> outside;
  outside.add(p.lower - Vector<2>(1, 1), 1, 0);
  EXPECT_THROW(pack_seeds<2>(p, outside), core::InputError);
  Seeds<2> twice;
  for (int k = 0; k < 2; ++k)
    twice.add(p.lower + Vector<2>(0.01, 0.01), 0.005, k);
  EXPECT_THROW(pack_seeds<2>(p, twice), core::InputError);
  Seeds<2> sparse;
  sparse.add(p.lower + Vector<2>(0.01, 0.01), 0.005, 0);
  EXPECT_THROW(pack_seeds<2>(p, sparse), core::InputError);
}

TEST(PackingFile, GivesTheSamePackingAgain)
{
  const auto check = [](auto p) {
    constexpr int dim = decltype(p.lower)::RowsAtCompileTime;
    p.zone_upper[0] = p.upper[0] - 3.5 * p.spacing;
    const auto first = make_random_packing<dim>(p);
    write_packing_file<dim>("packing.csv", first.seeds);
    const auto again = pack_seeds<dim>(p, read_packing_file<dim>("packing.csv"));
    EXPECT_EQ(first.packing.centre, again.packing.centre);
    ASSERT_EQ(first.packing.faces.size(), again.packing.faces.size());
    // Seeds that touch no cell at the end are not in the file, but cut on the way: round-off.
    for (int i = 0; i < again.packing.size(); ++i)
      EXPECT_NEAR(first.packing.volume[i], again.packing.volume[i],
                  1e-12 * first.packing.volume[i]);
    EXPECT_EQ(again.n_healed, 0);
  };
  check(random_specimen<2>(4));
  check(random_specimen<3>(1));
}

TEST(PackingFile, ReadsUnitsAndOrders)
{
  core::write_file("order.csv", "# made by hand\nr, y, x, colour\nmm, cm, m, 1\n\n2, 3, 4, 9\n");
  const auto seeds = read_packing_file<2>("order.csv");
  ASSERT_EQ(seeds.size(), 1);
  EXPECT_DOUBLE_EQ(seeds.radius[0], 2e-3);
  EXPECT_DOUBLE_EQ(seeds.centre[0][0], 4);
  EXPECT_DOUBLE_EQ(seeds.centre[0][1], 3e-2);
}

TEST(PackingFile, WrongFilesAreRefusedWithTheLine)
{
  const auto message = [](const std::string &text) -> std::string {
    core::write_file("wrong.csv", text);
    try {
      read_packing_file<2>("wrong.csv");
    } catch (const core::InputError &error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string head = "x,y,r,material\nm,m,m,1\n";
  EXPECT_EQ(message(""),
            "wrong.csv:1: the file is empty: the first line names the columns x, y, z, "
            "r, material");
  EXPECT_EQ(message("x,y\nm,m\n"), "wrong.csv:2: there is no column \"r\"");
  EXPECT_EQ(message("x,x,r\nm,m,m\n"), "wrong.csv:1: two columns are called \"x\"");
  EXPECT_EQ(message("x,y,r\n"), "wrong.csv:1: the row with the units is missing: the second line, "
                                "such as m,m,m,m,1");
  EXPECT_EQ(message("x,y,r\nm,s,m\n"),
            "wrong.csv:2: the unit \"s\" of \"y\" is no length, such as m or mm");
  EXPECT_EQ(message(head), "wrong.csv:2: the file holds no particles");
  EXPECT_EQ(message(head + "0,0,1,0\n0,0,1\n"), "wrong.csv:4: 3 values for 4 columns");
  EXPECT_EQ(message(head + "0,one,1,0\n"), "wrong.csv:3: \"one\" in column \"y\" is no number");
  EXPECT_EQ(message(head + "0,nan,1,0\n"), "wrong.csv:3: \"nan\" in column \"y\" is no number");
  EXPECT_EQ(message(head + "0,0,-1,0\n"), "wrong.csv:3: the radius must be positive");
  EXPECT_EQ(message("x,y,r\nkm,m,m\n1e308,0,1\n"),
            "wrong.csv:3: the value in column \"x\" is too large");
  EXPECT_EQ(message("x,y,r\nm,m,km\n0,0,1e308\n"),
            "wrong.csv:3: the value in column \"r\" is too large");
  EXPECT_EQ(message(head + "0,0,1,0.5\n"),
            "wrong.csv:3: the material must be 0 or the number of an inclusion");
  EXPECT_THROW(read_packing_file<2>("no_such_file.csv"), core::EnvironmentError);
}
} // namespace ligament::packings::test
