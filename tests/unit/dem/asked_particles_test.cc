// Tangent and faces of some particles are those of all that concern them, in the same order.
#include "packings/random_packing.h"
#include "tests/unit/dem/cases.h"

#include <algorithm>

namespace ligament::dem::testing
{
namespace
{
/// Broken faces, held and loaded sides, and a second material in the upper half.
template <int dim>
ManyBodyForce<dim> force_of(Packing<dim> packing)
{
  std::mt19937 random(4);
  for (auto &face : packing.faces)
    face.cracked = random() % 15 == 0;
  const DemMaterial material{3., 0.3, 1, PlaneMode::strain, 0}, other{1., 0.2, 1};
  std::vector<int> number;
  for (const double y : packing.centre[1])
    number.push_back(y >
                     0.6 * *std::max_element(packing.centre[1].begin(), packing.centre[1].end()));
  std::vector<core::BoundaryLoad<dim>> loads(2);
  loads[0].boundary = 0;
  loads[0].value[0] = 1e-3;
  loads[1].boundary = 2;
  loads[1].value.fill(0.);
  return {std::move(packing), Materials({material, other}, number), loads};
}

template <int dim>
void expect_part_of_all(const Packing<dim> &packing)
{
  const auto force = force_of<dim>(packing);
  Particles<dim> p;
  packings::fill_particles(packing, 1., p);
  std::vector<int> few;
  for (int i = 3; i < p.size(); i += 1 + i % 7 * 3)
    few.push_back(i);
  const auto is_asked = [&](int i) { return std::binary_search(few.begin(), few.end(), i); };

  using Term = particles::QuadraticTerm<dim>;
  std::vector<Term> expected, found;
  force.add_tangent(p, [&](const Term &term) {
    if (std::any_of(term.members.begin(), term.members.end(), is_asked))
      expected.push_back(term);
  });
  force.add_tangent(
      p, [&](const Term &term) { found.push_back(term); }, &few);
  ASSERT_EQ(found.size(), expected.size());
  ASSERT_GT(found.size(), few.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    ASSERT_EQ(found[k].kind, expected[k].kind) << k;
    ASSERT_EQ(found[k].members, expected[k].members) << k;
    ASSERT_EQ(found[k].rows, expected[k].rows) << k;
    ASSERT_EQ(found[k].stiffness, expected[k].stiffness) << k;
  }

  using Face = particles::FaceView<dim>;
  std::vector<Face> faces, of_few;
  force.for_each_face(p, [&](const Face &face) {
    if (is_asked(face.i))
      faces.push_back(face);
  });
  force.for_each_face(
      p, [&](const Face &face) { of_few.push_back(face); }, &few);
  ASSERT_EQ(of_few.size(), faces.size());
  for (std::size_t k = 0; k < faces.size(); ++k) {
    ASSERT_EQ(std::pair(of_few[k].i, of_few[k].j), std::pair(faces[k].i, faces[k].j));
    ASSERT_EQ(of_few[k].centroid, faces[k].centroid);
    ASSERT_EQ(of_few[k].bonded, faces[k].bonded);
  }

  const std::vector<int> nobody;
  force.add_tangent(
      p, [](const Term &) { FAIL(); }, &nobody);
  force.for_each_face(
      p, [](const Face &) { FAIL(); }, &nobody);
}
} // namespace

TEST(AskedParticles, GetTheirPartOfAllInTheSameOrder)
{
  expect_part_of_all<2>(packings::make_lattice_packing<2>(box<Case<2, Kind::hexagonal, true>>(14)));
  expect_part_of_all<3>(packings::make_lattice_packing<3>(box<Case<3, Kind::fcc, false>>(6)));
  packings::RandomParameters<2> plane;
  plane.spacing = 1;
  plane.relaxation_sweeps = 2;
  plane.upper.setConstant(12);
  expect_part_of_all<2>(packings::make_random_packing<2>(plane).packing);
}
} // namespace ligament::dem::testing
