// Bodies whose sides are joined: no end is special, whatever the jump between them.
#include "packings/periodic_sides.h"
#include "packings/random_packing.h"
#include "tests/unit/dem/cases.h"

#include "particles/particle_solver.h"

namespace ligament::dem::testing
{
namespace
{
template <int dim>
using Matrix = Eigen::Matrix<double, dim, dim>;

/// A box that all lattices of its dimension fit into, n spacings wide.
template <typename C>
packings::LatticeParameters<C::dim> periodic_box(const std::array<bool, C::dim> &axes)
{
  packings::LatticeParameters<C::dim> lattice;
  lattice.kind = C::kind;
  lattice.spacing = 0.01;
  lattice.thickness = C::dim == 2 ? 0.3 : 1;
  lattice.periodic = axes;
  for (int c = 0; c < C::dim; ++c)
    lattice.upper[c] = (C::dim == 2 ? 4 : 3.5) * lattice.spacing;
  if (C::kind == packings::LatticeKind::hexagonal)
    lattice.upper[1] = 2 * std::sqrt(3.) * lattice.spacing;
  if (C::kind == packings::LatticeKind::fcc)
    lattice.upper[2] = 2.5 * std::sqrt(2.) * lattice.spacing;
  if (C::turned) { // by a right angle, or 30 degrees: what repeats itself in a box
    if constexpr (C::dim == 2) {
      lattice.orientation[0] = C::kind == packings::LatticeKind::hexagonal ? M_PI / 6 : M_PI / 2;
      std::swap(lattice.upper[0], lattice.upper[1]);
    } else {
      lattice.orientation[0] = M_PI / 2;
      std::swap(lattice.upper[1], lattice.upper[2]);
    }
  }
  lattice.lower = -lattice.upper;
  return lattice;
}

template <int dim>
std::array<bool, dim> all_axes()
{
  std::array<bool, dim> axes;
  axes.fill(true);
  return axes;
}

/// Jumps of a motion with this gradient.
template <int dim>
std::vector<core::BoundaryLoad<dim>> jumps_of(const Matrix<dim> &gradient,
                                              const packings::Packing<dim> &packing)
{
  std::vector<core::BoundaryLoad<dim>> loads;
  for (int a = 0; a < dim; ++a)
    if (packing.period[a] > 0) {
      auto &load = loads.emplace_back();
      load.boundary = core::BoundaryLoad<dim>::jump_across(a);
      load.kind = core::BoundaryLoad<dim>::Kind::displacement;
      for (int c = 0; c < dim; ++c)
        load.value[c] = gradient(c, a) * packing.period[a];
    }
  return loads;
}

template <int dim>
Matrix<dim> tensor_of(const Strain<dim> &s)
{
  Matrix<dim> m;
  if constexpr (dim == 2)
    m << s[0], s[2], s[2], s[1];
  else
    m << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return m;
}

/// Every particle of a body that repeats itself along all axes answers a homogeneous strain by the
/// stiffness, nothing is left on it, and the sides pull with the mean stress.
template <int dim>
void check_homogeneous(const packings::Packing<dim> &packing, double round_off)
{
  for (const double nu : {0., 0.3, 0.45}) {
    const DemMaterial material{7e10, nu, 2500, PlaneMode::strain, 0};
    const double size = 1e-4;
    // nu near 1/2: phi enters lambda by 1/(3 - A phi), which amplifies its round-off.
    const double tolerance = round_off / (1 - 2 * nu);
    double volume = dim == 2 ? packing.thickness : 1;
    for (int a = 0; a < dim; ++a)
      volume *= packing.period[a];
    for (int k = 0; k < n_strains<dim>; ++k) {
      Strain<dim> e = size * Strain<dim>::Unit(k);
      Matrix<dim> gradient = tensor_of<dim>(e);
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b)
          gradient(a, b) *= a == b ? 1 : 0.5;
      ManyBodyForce<dim> force(packing, material, jumps_of<dim>(gradient, packing));
      Particles<dim> p;
      packings::fill_particles(packing, material.density, p);
      for (int i = 0; i < p.size(); ++i)
        set(p.displacement, i, Vector<dim>(gradient * get(p.reference, i)));
      force.compute(p, 0);
      Components<n_strains<dim>> stress;
      force.stresses(p, stress);
      const Strain<dim> expected = force.elastic_constants().stiffness * e;
      const double scale = expected.norm(),
                   area = packing.thickness * std::pow(packing.spacing, dim - 1);
      for (int i = 0; i < p.size(); ++i) {
        EXPECT_LT((get(stress, i) - expected).norm(), tolerance * scale);
        EXPECT_LT(get(p.force, i).norm(), tolerance * scale * area);
        EXPECT_LT(get(p.torque, i).norm(), tolerance * scale * area * packing.spacing);
      }
      for (int a = 0; a < dim; ++a) {
        const Vector<dim> pull = tensor_of<dim>(expected).col(a) * volume / packing.period[a];
        EXPECT_LT((force.reaction(a) - pull).norm(),
                  10 * tolerance * scale * volume / packing.period[a])
            << "axis " << a << ": " << force.reaction(a).transpose() << " for " << pull.transpose();
      }
      const double energy = 0.5 * e.dot(expected) * volume;
      EXPECT_NEAR(force.potential_energy(p), energy, 10 * tolerance * energy);
      if (::testing::Test::HasFailure())
        return;
    }
  }
}

template <int dim>
packings::RandomPacking<dim> random_box(const std::array<bool, dim> &axes)
{
  packings::RandomParameters<dim> p;
  p.spacing = 0.01;
  p.upper = (dim == 2 ? 9 : 6.5) * p.spacing * Vector<dim>::Ones();
  p.thickness = dim == 2 ? 0.3 : 1;
  p.periodic = axes;
  return packings::make_random_packing(p);
}
} // namespace

template <typename C>
struct Periodic : ::testing::Test
{
};
TYPED_TEST_SUITE(Periodic, Cases);

TYPED_TEST(Periodic, HomogeneousStrainIsExactInEveryParticle)
{
  constexpr int dim = TypeParam::dim;
  const auto lattice = periodic_box<TypeParam>(all_axes<dim>());
  check_homogeneous<dim>(packings::make_lattice_packing<dim>(lattice), 1e-12);
}

TEST(PeriodicRandom, HomogeneousStrainIsExactInEveryParticle)
{
  check_homogeneous<2>(random_box<2>({true, true}).packing, 1e-11);
  check_homogeneous<3>(random_box<3>({true, true, true}).packing, 1e-11);
}

namespace
{
template <int dim>
Matrix<dim> some_gradient(double size)
{
  Matrix<dim> gradient;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      gradient(a, b) = size * (0.3 + 0.17 * a - 0.4 * b + 0.2 * a * b);
  return gradient;
}

/// Forces are minus the gradient of the energy, the reactions its gradient by the jumps.
template <int dim>
void check_gradient(const packings::Packing<dim> &packing)
{
  const DemMaterial material{1, 0.3, 1, PlaneMode::strain, 0};
  const auto loads = jumps_of<dim>(some_gradient<dim>(0.1), packing);
  ManyBodyForce<dim> force(packing, material, loads);
  Particles<dim> p = at_rest(packing, material);
  disturb<dim>(p, packing.spacing, 0.05, Spin<dim>::Constant(0.2), 7);
  force.compute(p, 0);
  const double h = 1e-6 * packing.spacing, scale = std::pow(packing.spacing, dim - 1);
  const Particles<dim> at = p;
  for (int i = 0; i < p.size(); ++i)
    for (int c = 0; c < dim; ++c) {
      double energy[2];
      for (const int end : {0, 1}) {
        p.displacement[c][i] = at.displacement[c][i] + (end ? h : -h);
        energy[end] = force.potential_energy(p);
      }
      p.displacement[c][i] = at.displacement[c][i];
      EXPECT_NEAR(at.force[c][i], -(energy[1] - energy[0]) / (2 * h), 1e-7 * scale);
    }
  for (int a = 0; a < dim; ++a)
    for (int c = 0; c < dim; ++c) {
      double energy[2];
      for (const int end : {0, 1}) {
        auto moved = loads;
        *moved[a].value[c] += end ? h : -h;
        ManyBodyForce<dim> other(packing, material, moved);
        other.compute(p, 0);
        energy[end] = other.potential_energy(p);
      }
      EXPECT_NEAR(force.reaction(a)[c], (energy[1] - energy[0]) / (2 * h), 1e-6 * scale);
      EXPECT_GT(std::abs(force.reaction(a)[c]), 1e-4 * scale); // there is something to compare
    }
}
} // namespace

TYPED_TEST(Periodic, ForcesAndReactionsAreTheSlopesOfTheEnergy)
{
  constexpr int dim = TypeParam::dim;
  check_gradient<dim>(
      packings::make_lattice_packing<dim>(periodic_box<TypeParam>(all_axes<dim>())));
}

TEST(PeriodicRandom, ForcesAndReactionsAreTheSlopesOfTheEnergy)
{
  check_gradient<2>(random_box<2>({true, true}).packing);
}

namespace
{
/// The same body cut open elsewhere: seeds shifted along the axes and wrapped again.
packings::Packing<2> shifted_packing(const packings::RandomParameters<2> &p,
                                     packings::Seeds<2> seeds, const Vector<2> &shift)
{
  const packings::PeriodicBox<2> box(p);
  for (auto &x : seeds.centre)
    x = box.wrapped(x + shift);
  return packings::pack_seeds<2>(p, seeds).packing;
}
} // namespace

// Particles that end up in another period have the jump in addition, from the start and with its
// rate; else they move alike.
TEST(PeriodicRandom, WhereTheSidesLieMakesNoDifference)
{
  packings::RandomParameters<2> p;
  p.spacing = 0.01;
  p.upper = {0.12, 0.09};
  p.periodic = {true, true};
  const auto random = packings::make_random_packing(p);
  const Vector<2> shift(0.06, 0.045);
  const DemMaterial material{1, 0.3, 1, PlaneMode::strain, 0.3};
  const packings::Packing<2> packings[2] = {random.packing,
                                            shifted_packing(p, random.seeds, shift)};
  ASSERT_EQ(packings[0].size(), packings[1].size());
  ASSERT_EQ(packings[0].global_id, packings[1].global_id);
  FractureLaw fracture;
  fracture.criterion = FractureLaw::Criterion::maximum_tension;
  fracture.strength = 0.01;
  const auto gradient = some_gradient<2>(0.03);
  Particles<2> states[2];
  std::vector<std::array<std::int64_t, 3>> broken[2]; // step and names, in their order
  for (const int k : {0, 1}) {
    auto loads = jumps_of<2>(gradient, packings[k]);
    for (auto &load : loads)
      load.kind = core::BoundaryLoad<2>::Kind::velocity;
    auto force = std::make_unique<ManyBodyForce<2>>(packings[k], material, loads, fracture);
    auto *law = force.get();
    Particles<2> state;
    packings::fill_particles(packings[k], material.density, state);
    const double dt = 0.5 * force->stable_step(state);
    for (int i = 0; i < state.size(); ++i) // velocities are those of the first half step
      set(state.velocity, i,
          Vector<2>(gradient * get(state.reference, i) +
                    Vector<2>(0.002 * std::sin(3. * double(state.global_id[i])), 0)));
    particles::ParticleSolver<2> solver(std::move(state), std::move(force));
    for (int step = 0; step < 300; ++step) {
      solver.drift(dt);
      solver.compute_forces((step + 1) * dt);
      solver.kick(dt);
    }
    states[k] = solver.state;
    for (const auto &bond : law->broken_bonds()) {
      const auto [a, b] = std::minmax(bond.global_i, bond.global_j);
      broken[k].push_back({std::llround(bond.time / dt), a, b});
    }
    std::sort(broken[k].begin(), broken[k].end());
    EXPECT_GT(law->n_contacts(), 0);
    // Motion against the images' own: what the shift alone adds.
    const double t = 300 * dt;
    for (int i = 0; i < states[k].size(); ++i) {
      const Vector<2> x = get(packings[k].centre, i);
      set(states[k].displacement, i, Vector<2>(get(states[k].displacement, i) - t * gradient * x));
    }
  }
  EXPECT_GT(broken[0].size(), 20u);
  ASSERT_EQ(broken[0].size(), broken[1].size());
  for (std::size_t b = 0; b < broken[0].size(); ++b) {
    EXPECT_EQ(broken[0][b], broken[1][b]);
  }
  double largest = 0;
  for (int i = 0; i < states[0].size(); ++i)
    largest =
        std::max(largest, (get(states[0].displacement, i) - get(states[1].displacement, i)).norm());
  // Particles that come near each other are found at other steps: the search waits for how far they
  // have moved.
  EXPECT_LT(largest, 1e-4 * p.spacing);
}
} // namespace ligament::dem::testing
