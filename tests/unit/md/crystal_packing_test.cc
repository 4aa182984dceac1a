// Crystals cut to boxes: all atoms that belong there, in an order and with names of their own.
#include "md/crystal_packing.h"

#include "core/check.h"
#include "tests/unit/md/potentials.h"

#include <set>

namespace ligament::md::testing
{
TEST(CrystalPackingTest, BoxesOfWholePeriodsHoldAllTheirAtoms)
{
  const Crystal<3> copper(foiles_copper(), {});
  const double a = copper.lattice_parameter();
  CrystalShape<3> shape;
  shape.upper = a * Vector<3>(3, 4, 5);
  shape.periodic = {true, true, true};
  const auto packing = cut_crystal(copper, shape);
  EXPECT_EQ(packing.size(), 4 * 60);
  EXPECT_EQ(packing.period, shape.upper);
  double volume = 0;
  for (const double v : packing.volume)
    volume += v;
  EXPECT_NEAR(volume / shape.upper.prod(), 1, 1e-13);
  const Crystal<3> iron(mendelev_iron(), {CrystalKind::bcc});
  shape.upper = iron.lattice_parameter() * Vector<3>(3, 4, 5);
  EXPECT_EQ(cut_crystal(iron, shape).size(), 2 * 60);
  shape.upper[1] *= 1.01;
  EXPECT_THROW(cut_crystal(iron, shape), core::InputError);
}

// Every atom within the box has all its neighbours of the lattice.
template <int dim>
void expect_whole(const Crystal<dim> &crystal, const CrystalShape<dim> &shape)
{
  const auto packing = cut_crystal(crystal, shape);
  const double d = crystal.spacing();
  for (int i = 0; i < packing.size(); ++i) {
    const Vector<dim> x = get(packing.centre, i);
    if (((x - shape.lower).array() < 1.01 * d).any() ||
        ((shape.upper - x).array() < 1.01 * d).any())
      continue;
    int n = 0;
    for (int j = 0; j < packing.size(); ++j)
      n += j != i && (get(packing.centre, j) - x).norm() < 1.01 * d;
    EXPECT_EQ(n, dim == 2 ? 6 : crystal.parameters().kind == CrystalKind::fcc ? 12 : 8);
  }
}

TEST(CrystalPackingTest, HasEveryAtomInAnyOrientation)
{
  CrystalParameters<3> turned;
  turned.orientation = some_rotation<3>();
  CrystalShape<3> box;
  box.lower = angstrom * Vector<3>(-9, -8, -7);
  box.upper = angstrom * Vector<3>(7, 8, 9);
  box.anchor = angstrom * Vector<3>(0.3, 0.2, 0.1);
  expect_whole(Crystal<3>(foiles_copper(), turned), box);
  turned.kind = CrystalKind::bcc;
  expect_whole(Crystal<3>(mendelev_iron(), turned), box);
  CrystalParameters<2> plane;
  plane.orientation = some_rotation<2>();
  CrystalShape<2> square;
  square.lower = angstrom * Vector<2>(-20, -20);
  square.upper = angstrom * Vector<2>(20, 25);
  expect_whole(Crystal<2>(plane_atoms(), plane), square);
}

// What a long thin one takes grows by the square of its length at most: all sites of the cell of
// the lattice around it, 5e10, would take minutes.
TEST(CrystalPackingTest, LongCrystalsAreCutInALittleWhile)
{
  CrystalParameters<3> turned;
  turned.orientation = orientation_of({3, 1, 1}, {0, 1, -1});
  const Crystal<3> copper(foiles_copper(), turned);
  const double a = copper.lattice_parameter();
  CrystalShape<3> box;
  box.upper = a * Vector<3>(6000, 3, 2);
  const auto packing = cut_crystal(copper, box);
  EXPECT_NEAR(packing.size() / (box.upper.prod() / copper.volume()), 1, 0.1);
  box.lower[0] = 3000.3 * a;
  box.upper[0] = 3040.7 * a;
  const auto piece = cut_crystal(copper, box);
  std::set<std::int64_t> names;
  for (int i = 0; i < packing.size(); ++i)
    if (packing.centre[0][i] >= box.lower[0] && packing.centre[0][i] < box.upper[0])
      names.insert(packing.global_id[i]);
  EXPECT_EQ(std::set<std::int64_t>(piece.global_id.begin(), piece.global_id.end()), names);
}

// A larger box, or one with a hole, has the same atoms with the same names in the same order.
TEST(CrystalPackingTest, NamesAndOrderDoNotDependOnTheCut)
{
  const Crystal<3> crystal(foiles_copper(), {});
  CrystalShape<3> small, large;
  small.lower = angstrom * Vector<3>(-9, -9, -9);
  small.upper = angstrom * Vector<3>(9, 9, 9);
  large = small;
  large.upper *= 2;
  small.keep = [](const Vector<3> &x) { return x.norm() > 5 * angstrom; };
  const auto a = cut_crystal(crystal, small), b = cut_crystal(crystal, large);
  std::map<std::int64_t, int> in_large;
  for (int i = 0; i < b.size(); ++i)
    EXPECT_TRUE(in_large.emplace(b.global_id[i], i).second);
  int last = -1;
  for (int i = 0; i < a.size(); ++i) {
    const int j = in_large.at(a.global_id[i]);
    EXPECT_EQ(get(a.centre, i), get(b.centre, j)); // to the last bit
    EXPECT_GT(get(a.centre, i).norm(), 5 * angstrom);
    EXPECT_GT(j, last);
    last = j;
  }
}

TEST(CrystalPackingTest, RowsHaveNoGaps)
{
  const Crystal<3> crystal(mendelev_iron(), {CrystalKind::bcc});
  CrystalShape<3> shape;
  shape.upper = angstrom * Vector<3>(20, 20, 20);
  shape.keep = [](const Vector<3> &x) {
    return (x - angstrom * Vector<3>(10, 10, 10)).norm() > 5 * angstrom;
  };
  const auto packing = cut_crystal(crystal, shape);
  const Vector<3> step = crystal.basis().col(0);
  EXPECT_EQ(packing.row_begin.back(), packing.size());
  for (std::size_t r = 0; r + 1 < packing.row_begin.size(); ++r)
    for (int i = packing.row_begin[r]; i + 1 < packing.row_begin[r + 1]; ++i) {
      EXPECT_LT((get(packing.centre, i + 1) - get(packing.centre, i) - step).norm(),
                1e-12 * angstrom);
      EXPECT_EQ(packing.global_id[i + 1], packing.global_id[i] + 1);
    }
}

TEST(CrystalPackingTest, AtomsHaveTheMassOfTheirSpeciesAndNoOrientation)
{
  const Crystal<3> crystal(zhou_johnson_wadley({"Cu", "Ni"}), {});
  CrystalShape<3> shape;
  shape.upper = angstrom * Vector<3>(8, 8, 8);
  const auto packing = cut_crystal(crystal, shape);
  std::vector<int> species(packing.size(), 0);
  species[3] = 1;
  const auto atoms = make_atoms(crystal, packing, species);
  EXPECT_FALSE(atoms.turns);
  EXPECT_TRUE(atoms.rotation[0].empty());
  EXPECT_NEAR(atoms.mass[0], 63.546 * atomic_mass_unit, 1e-13 * atoms.mass[0]);
  EXPECT_NEAR(atoms.mass[3], 58.6934 * atomic_mass_unit, 1e-13 * atoms.mass[0]);
  shape.upper.setConstant(-1e-10);
  EXPECT_THROW(cut_crystal(crystal, shape), core::InputError);
}
} // namespace ligament::md::testing
