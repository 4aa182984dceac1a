// Centro-symmetry and coordination tell atoms of the crystal from those at defects.
#include "core/extremes.h"
#include "tests/unit/md/bodies.h"

#include <algorithm>

namespace ligament::md::testing
{
template <int dim>
void expect_defects(Body<dim> body, int coordination)
{
  const auto force = body.force();
  const double d = body.crystal.spacing();
  // A homogeneous strain and a small motion are no defects.
  Matrix<dim> gradient = Matrix<dim>::Zero();
  gradient(0, 1) = 0.03;
  gradient(0, 0) = -0.02;
  Noise noise(3);
  for (int i = 0; i < body.atoms.size(); ++i)
    set(body.atoms.displacement, i,
        Vector<dim>(gradient * get(body.atoms.reference, i) + 1e-3 * d * noise.matrix<dim, 1>()));
  const auto symmetry = force.centro_symmetry(body.atoms);
  const auto numbers = force.coordination(body.atoms);
  int n_inside = 0;
  for (int i = 0; i < body.atoms.size(); ++i) {
    const Vector<dim> x = get(body.atoms.reference, i);
    const double edge = std::min(x.minCoeff(), (body.top - x).minCoeff());
    if (edge > 1.7 * d) {
      ++n_inside;
      EXPECT_LT(symmetry[i], 1e-3);
      EXPECT_EQ(numbers[i], coordination);
    } else if (edge < 0.3 * d) {
      EXPECT_GT(symmetry[i], 0.4);
      EXPECT_LT(numbers[i], coordination);
    }
  }
  EXPECT_GT(n_inside, 0);
}

TEST(DefectsTest, SurfacesAreSeenAndStrainsAreNot)
{
  expect_defects<3>(make_body<3>(foiles_copper(), CrystalKind::fcc, {4, 4, 4}), 12);
  expect_defects<3>(make_body<3>(mendelev_iron(), CrystalKind::bcc, {5, 5, 5}), 14);
  expect_defects<2>(plane_body({8, 5}), 6);
}

// An atom that is not there is missed by its neighbours.
TEST(DefectsTest, VacanciesAreSeen)
{
  const Crystal<3> crystal(foiles_copper(), {});
  auto shape = box<3>(crystal, {4, 4, 4}, {true, true, true});
  const double a = crystal.lattice_parameter();
  shape.keep = [&](const Vector<3> &x) { return (x - a * Vector<3>(2, 2, 2)).norm() > 0.1 * a; };
  const Body<3> body(foiles_copper(), {}, shape);
  EXPECT_EQ(body.atoms.size(), 255);
  const auto force = body.force();
  const auto symmetry = force.centro_symmetry(body.atoms);
  const auto numbers = force.coordination(body.atoms);
  EXPECT_EQ(std::count_if(symmetry.begin(), symmetry.end(), [](double s) { return s > 0.5; }), 12);
  EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 11), 12);
  EXPECT_EQ(std::count(numbers.begin(), numbers.end(), 12), 243);
}

// Sides are no cracks; half of the crystal moved away makes two faces. Close-packed ones lack just
// a quarter of their neighbours.
TEST(DefectsTest, FacesOfCracksLackAQuarterOfTheirNeighbours)
{
  // Whole periods along [1 -1 0] and [1 1 -2].
  auto body =
      make_body<3>(foiles_copper(), CrystalKind::fcc, {4 / std::sqrt(2.), 4, 3 * std::sqrt(1.5)},
                   {true, false, true}, orientation_of({1, -1, 0}, {1, 1, 1}));
  const auto force = body.force();
  const auto n_at_faces = [&] {
    const auto at = force.at_crack_faces(body.atoms);
    return std::count(at.begin(), at.end(), 1);
  };
  EXPECT_EQ(n_at_faces(), 0);
  const double middle = body.top[1] / 2, layer = body.crystal.lattice_parameter() / std::sqrt(3.);
  int n_nearest = 0;
  for (int i = 0; i < body.atoms.size(); ++i) {
    const double above = body.atoms.reference[1][i] - middle;
    body.atoms.displacement[1][i] = above > 0 ? layer : 0;
    n_nearest += std::abs(above) < layer * 0.999;
  }
  EXPECT_GT(n_nearest, 20);
  EXPECT_EQ(n_at_faces(), n_nearest);
}

TEST(DefectsTest, MaterialsBeginWithThatOfTheCrystal)
{
  const Potential alloy = zhou_johnson_wadley({"Cu", "Ni", "Ag"});
  CrystalParameters<3> parameters;
  parameters.species = 1;
  const Crystal<3> crystal(alloy, parameters);
  const auto shape = box<3>(crystal, {1, 1, 1});
  std::vector<int> species(cut_crystal(crystal, shape).size(), 1);
  species[0] = 0;
  species[1] = 2;
  const Body<3> body(alloy, parameters, shape, species);
  const auto force = body.force();
  EXPECT_EQ(force.symbols(), (std::vector<std::string>{"Ni", "Cu", "Ag"}));
  EXPECT_EQ(force.material(0), 1);
  EXPECT_EQ(force.material(1), 2);
  EXPECT_EQ(force.material(2), 0);
}

// The published ones are those of relaxed surfaces: layers go down along their forces.
TEST(DefectsTest, SurfaceEnergiesOfTables)
{
  struct Case
  {
    Potential potential;
    CrystalKind kind;
    double energy; // J/m^2
  };
  for (const Case &c : {Case{foiles_copper(), CrystalKind::fcc, 1.288},
                        Case{mishin_copper(), CrystalKind::fcc, 1.345},
                        Case{mendelev_iron(), CrystalKind::bcc, 1.785}})
  {
    auto body = make_body<3>(c.potential, c.kind, {1, 1, 12}, {true, true, false});
    auto force = body.force();
    const double a = body.crystal.lattice_parameter();
    double largest = 1;
    for (int step = 0; step < 2000 && largest > 1e-6; ++step) {
      force.compute(body.atoms, 0);
      largest = 0;
      for (int i = 0; i < body.atoms.size(); ++i) {
        const double f = body.atoms.force[2][i] / body.stiffness(); // m
        body.atoms.displacement[2][i] += 0.1 * f;
        keep_largest(largest, std::abs(f) / body.crystal.spacing());
      }
    }
    EXPECT_LT(largest, 1e-6);
    const double relaxed =
        body.crystal.surface_energy({0, 0, 1}) + force.potential_energy(body.atoms) / (2 * a * a);
    EXPECT_NEAR(relaxed / c.energy, 1, 0.002);
  }
}
} // namespace ligament::md::testing
