// The crystal without stress: published constants, Cauchy-Born energy, stress and moduli.
#include "md/cauchy_born_law.h"

#include "core/check.h"
#include "tests/unit/md/potentials.h"

#include <Eigen/Dense>

#include <functional>

namespace ligament::md::testing
{
/// How the derivatives of a function of distance are taken.
using Derivatives = std::function<Jet(const std::function<double(double)> &, double, double)>;

/// Differences of fourth order over so many steps of the table.
Jet wide_differences(const std::function<double(double)> &f, double r, double step)
{
  const double s = 10 * step, a = f(r - 2 * s), b = f(r - s), c = f(r), d = f(r + s),
               e = f(r + 2 * s);
  return {c, (a - 8 * b + 8 * d - e) / (12 * s),
          (-a + 16 * b - 30 * c + 16 * d - e) / (12 * s * s)};
}

/// LAMMPS's interpolation: cubics through two knots with slopes of differences of fourth order.
Jet hermite(const std::function<double(double)> &f, double r, double step)
{
  const double place = r / step, k = std::floor(place), t = place - k;
  const auto value = [&](double m) { return f(m * step); };
  const auto slope = [&](double m) {
    return (value(m - 2) - value(m + 2) + 8 * (value(m + 1) - value(m - 1))) / 12;
  };
  const double rise = value(k + 1) - value(k), b = slope(k), next = slope(k + 1),
               c = 3 * rise - 2 * b - next, d = b + next - 2 * rise;
  return {value(k) + t * (b + t * (c + t * d)), (b + t * (2 * c + 3 * t * d)) / step,
          (2 * c + 6 * t * d) / (step * step)};
}

/// C11, C12, C44 of a cubic crystal in its own axes from such derivatives, (M5) written out.
Vector<3> constants_from(const Crystal<3> &crystal, const Derivatives &derivatives)
{
  const Potential &p = crystal.potential();
  const double step = p.pair_spline(0, 0).step(), rho = crystal.density_of_neighbours();
  Vector<3> c = Vector<3>::Zero();
  double growth = 0;
  for (const Vector<3> &bond : crystal.half_bonds()) {
    const double r = bond.norm(), x = bond[0] / r, y = bond[1] / r;
    if (r >= p.cutoff())
      continue;
    const Jet pair = derivatives([&](double s) { return p.bond(0, 0, s).pair.value; }, r, step);
    const Jet density =
        derivatives([&](double s) { return p.bond(0, 0, s).density_at_i.value; }, r, step);
    const double along = (pair.curvature - pair.slope / r) * r * r, across = pair.slope * r;
    c += Vector<3>(along * std::pow(x, 4) + across * x * x, along * x * x * y * y,
                   along * x * x * y * y + across * x * x);
    growth += 2 * density.slope * r * x * x;
  }
  const double bulk = p.embedding(0, rho).curvature * growth * growth;
  return (c + Vector<3>(bulk, bulk, 0)) / crystal.volume();
}

void expect_constants(const Vector<3> &found, const Vector<3> &expected)
{
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(found[k] / expected[k], 1, 1e-3) << k;
}

/// Constants of the tables as they are known for these potentials: a in angstrom, C in GPa; to 2e-5
/// and 0.1 %. The iron table has r phi at steps of h = 5.3e-4 angstrom with noise (by its sixth
/// differences) of 8e-10 eV angstrom near the first neighbours, 3e-10 near the second. A spline
/// makes 6/h^2 of noise in values: 7e-3 and 3e-3 eV/angstrom^2 of phi'', some 0.4 GPa of C11 (0.85
/// are found). Differences over ten steps see the smooth functions (noise over 100 times less,
/// truncated at (5.3e-3 angstrom)^4 phi/90). The crystal has the constants of the table as it
/// is, as in LAMMPS, whose interpolation stands beside.
TEST(CrystalTest, ConstantsOfPublishedTables)
{
  struct Case
  {
    Potential potential;
    CrystalKind kind;
    double a;
    Vector<3> c; // C11, C12, C44
    bool is_rough;
  };
  for (const Case &c :
       {Case{foiles_copper(), CrystalKind::fcc, 3.6150, {167.3, 124.1, 76.4}, false},
        Case{mishin_copper(), CrystalKind::fcc, 3.6149, {169.9, 122.6, 76.2}, false},
        Case{mendelev_iron(), CrystalKind::bcc, 2.8553, {243.4, 145.0, 116.1}, true}})
  {
    const Crystal<3> crystal(c.potential, {c.kind});
    const auto stiffness = crystal.elastic_constants().stiffness;
    const Vector<3> own(stiffness(0, 0), stiffness(0, 1), stiffness(3, 3));
    EXPECT_NEAR(crystal.lattice_parameter() / angstrom / c.a, 1, 2e-5);
    expect_constants(c.is_rough ? constants_from(crystal, wide_differences) : own, 1e9 * c.c);
    expect_constants(own, constants_from(crystal, hermite));
  }
}

template <int dim>
void expect_stress_free(const Crystal<dim> &crystal)
{
  const Matrix<dim> rest = Matrix<dim>::Zero();
  const double c11 = crystal.elastic_constants().stiffness(0, 0);
  // The lattice parameter is exact to its last bit: 2e-16 of strain, beside the round-off of a sum.
  EXPECT_LT(crystal.stress(rest).cwiseAbs().maxCoeff() / c11, 4e-15);
  EXPECT_LT(std::abs(crystal.potential()
                         .embedding(crystal.parameters().species, crystal.density_of_neighbours())
                         .slope) *
                crystal.density_of_neighbours() / electron_volt,
            1e-14);
  // A has both minor symmetries where there is no stress.
  const Moduli<dim> a = crystal.moduli(rest);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim * dim; ++k)
        EXPECT_NEAR(a(i * dim + j, k), a(j * dim + i, k), 1e-13 * c11);
  EXPECT_LT((a - a.transpose()).norm(), 1e-14 * a.norm());
}

TEST(CrystalTest, IsFreeOfStressInAnyOrientation)
{
  for (const NamedCrystal &s : solids())
    for (const Matrix<3> &q : {Matrix<3>(Matrix<3>::Identity()), some_rotation<3>()}) {
      SCOPED_TRACE(s.name);
      CrystalParameters<3> parameters;
      parameters.kind = s.kind;
      parameters.orientation = q;
      expect_stress_free(Crystal<3>(s.potential, parameters));
    }
  CrystalParameters<2> plane;
  plane.orientation = some_rotation<2>();
  expect_stress_free(Crystal<2>(plane_atoms(), plane));
}

// P = dW/dF and A = dP/dF at a finite strain with rotation, by central differences.
template <int dim>
void expect_derivatives(const Crystal<dim> &crystal)
{
  Noise noise(1);
  const Matrix<dim> one = Matrix<dim>::Identity(),
                    f = some_rotation<dim>() * (one + 0.03 * noise.matrix<dim, dim>()) - one;
  const double c11 = crystal.elastic_constants().stiffness(0, 0), h = 1e-5;
  const Matrix<dim> p = crystal.stress(f);
  const Moduli<dim> a = crystal.moduli(f);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      Matrix<dim> d = Matrix<dim>::Zero();
      d(i, j) = h;
      const double slope =
          (crystal.energy_density(f + d) - crystal.energy_density(f - d)) / (2 * h);
      EXPECT_NEAR(slope / c11, p(i, j) / c11, 1e-7);
      const Matrix<dim> change = (crystal.stress(f + d) - crystal.stress(f - d)) / (2 * h);
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
          EXPECT_NEAR(change(k, l) / c11, a(k * dim + l, i * dim + j) / c11, 2e-3);
    }
  EXPECT_LT((CauchyBornLaw<dim>(crystal).stress(f) - p).norm(), 1e-13 * c11);
  // Turning the strained crystal turns its stress: W depends on F^T F alone.
  const Matrix<dim> q = some_rotation<dim>();
  EXPECT_NEAR(crystal.energy_density(q * (one + f) - one), crystal.energy_density(f), 1e-14 * c11);
  EXPECT_LT((crystal.stress(q * (one + f) - one) - q * p).norm(), 1e-13 * c11);
  // Energies of tiny strains keep their digits: W = 1/2 e A e to first order in e.
  Matrix<dim> e = 1e-9 * noise.matrix<dim, dim>();
  double expected = 0;
  const Moduli<dim> rest = crystal.moduli(Matrix<dim>::Zero());
  for (int k = 0; k < dim * dim; ++k)
    for (int l = 0; l < dim * dim; ++l)
      expected += 0.5 * rest(k, l) * e(k / dim, k % dim) * e(l / dim, l % dim);
  EXPECT_NEAR(crystal.energy_density(e), expected, 1e-5 * expected);
}

TEST(CrystalTest, StressAndModuliAreDerivativesOfTheEnergy)
{
  for (const NamedCrystal &s : solids()) {
    if (s.name == "Mendelev iron") // its rounding spoils differences of curvatures
      continue;
    SCOPED_TRACE(s.name);
    expect_derivatives(Crystal<3>(s.potential, {s.kind}));
  }
  expect_derivatives(Crystal<2>(plane_atoms(), {}));
}

// C turns with the crystal, waves do not mind.
TEST(CrystalTest, ElasticConstantsTurnWithTheCrystal)
{
  CrystalParameters<3> turned;
  turned.orientation = some_rotation<3>();
  const Crystal<3> straight(foiles_copper(), {}), oblique(foiles_copper(), turned);
  const auto a = straight.elastic_constants(), b = oblique.elastic_constants();
  EXPECT_NEAR(a.youngs_modulus / b.youngs_modulus, 1, 1e-13);
  EXPECT_NEAR(a.poissons_ratio, b.poissons_ratio, 1e-13);
  EXPECT_NEAR(a.wave_speed_p / b.wave_speed_p, 1, 1e-13);
  EXPECT_NEAR(a.wave_speed_s / b.wave_speed_s, 1, 1e-13);
  const Moduli<3> of_straight = straight.moduli(Matrix<3>::Zero()),
                  of_oblique = oblique.moduli(Matrix<3>::Zero());
  const Matrix<3> &q = turned.orientation;
  for (int k = 0; k < 81; ++k) {
    const int i = k % 3, j = k / 3 % 3, m = k / 9 % 3, l = k / 27;
    double sum = 0;
    for (int s = 0; s < 81; ++s)
      sum += q(i, s % 3) * q(j, s / 3 % 3) * q(m, s / 9 % 3) * q(l, s / 27) *
             of_straight(s % 3 * 3 + s / 3 % 3, s / 9 % 3 * 3 + s / 27);
    EXPECT_NEAR(of_oblique(i * 3 + j, m * 3 + l) / sum, 1, std::abs(1e-13 * 1.7e11 / sum));
  }
}

// Voigt's average of a cubic crystal, and of the plane one, which is isotropic.
TEST(CrystalTest, AveragesAreVoigts)
{
  const auto c = Crystal<3>(foiles_copper(), {}).elastic_constants();
  const double c11 = c.stiffness(0, 0), c12 = c.stiffness(0, 1), c44 = c.stiffness(3, 3),
               bulk = (c11 + 2 * c12) / 3, shear = (c11 - c12 + 3 * c44) / 5;
  EXPECT_NEAR(c.youngs_modulus / (9 * bulk * shear / (3 * bulk + shear)), 1, 1e-13);
  EXPECT_NEAR(c.wave_speed_p, std::sqrt((c11 + 2 * c12 + 4 * c44) / (3 * c.density)),
              1e-9);                                                           // along [111]
  EXPECT_NEAR(c.wave_speed_s, std::sqrt((c11 - c12) / (2 * c.density)), 1e-9); // along [110]
  EXPECT_NEAR(c.density, 8930, 20);                                            // kg/m^3

  const auto p = Crystal<2>(plane_atoms(), {}).elastic_constants();
  const double lambda = p.stiffness(0, 1), mu = p.stiffness(2, 2);
  EXPECT_NEAR(p.stiffness(0, 0) / (lambda + 2 * mu), 1, 1e-13);
  EXPECT_NEAR(p.poissons_ratio, lambda / (2 * (lambda + mu)), 1e-13);
  EXPECT_GT(std::abs(lambda / mu - 1), 0.1); // no Cauchy relation
}

// Bonds across a plane by hand: nearest neighbours of a pair potential alone.
TEST(CrystalTest, SurfaceEnergyCountsBrokenBonds)
{
  const double d = 2.5 * angstrom, depth = 0.3 * electron_volt;
  const Potential p = morse(argon(), depth, d, 3 / angstrom, {1.1 * d, 1.3 * d});
  const Crystal<3> fcc(p, {CrystalKind::fcc});
  const double a = fcc.lattice_parameter();
  EXPECT_NEAR(a, d * std::sqrt(2.), 1e-9 * d); // as good as the splines
  // Broken bonds per atom of the surface, and its area.
  EXPECT_NEAR(fcc.surface_energy({0, 1, 0}) / (4 * depth / 2 / (a * a / 2)), 1, 1e-9);
  EXPECT_NEAR(fcc.surface_energy({1, -1, 1}) / (3 * depth / 2 / (a * a * std::sqrt(3.) / 4)), 1,
              1e-9);
  // (110): 5 of the first and 1 of the second layer.
  EXPECT_NEAR(fcc.surface_energy({0, 1, 1}) / (6 * depth / 2 / (a * a / std::sqrt(2.))), 1, 1e-9);
  CrystalParameters<2> thick;
  thick.thickness = 3e-10;
  const Crystal<2> plane(p, thick);
  EXPECT_NEAR(plane.surface_energy({0, 1}) / (2 * depth / 2 / (d * 3e-10)), 1, 1e-9);
}

/// The spacing of Lennard-Jones's crystals nears what its lattice sums give without a cut-off,
/// r^6 = 2 A_12 / A_6: 14.4539, 12.1319 (fcc) and 6.3759, 6.0098 (triangular).
TEST(CrystalTest, LongCutOffs)
{
  const double size = 3.4e-10;
  for (const double cutoff : {5.4, 6., 7., 9.}) {
    const Potential p =
        lennard_jones({"A", 1e-25}, 1e-21, size, {0.9 * cutoff * size, cutoff * size});
    CrystalParameters<3> cubic;
    cubic.kind = CrystalKind::fcc;
    EXPECT_NEAR(Crystal<3>(p, cubic).spacing() / size, std::pow(2 * 12.1319 / 14.4539, 1. / 6),
                2e-3);
    EXPECT_NEAR(Crystal<2>(p, {}).spacing() / size, std::pow(2 * 6.0098 / 6.3759, 1. / 6), 1e-3);
  }
  EXPECT_THROW(Crystal<2>(lennard_jones({"A", 1e-25}, 1e-21, size, {13 * size, 14 * size}), {}),
               core::InputError);
}

TEST(CrystalTest, WrongParametersAreRefused)
{
  const Potential p = foiles_copper();
  CrystalParameters<3> wrong;
  wrong.orientation(0, 0) = -1; // a mirror
  EXPECT_THROW(Crystal<3>(p, wrong), core::InputError);
  wrong.orientation(0, 0) = 1 + 1e-9;
  EXPECT_THROW(Crystal<3>(p, wrong), core::InputError);
  EXPECT_THROW(Crystal<3>(p, {CrystalKind::triangular}), core::InputError);
  EXPECT_THROW(Crystal<2>(p, {CrystalKind::fcc}), core::InputError);
  EXPECT_THROW(crystal_kind("hcp"), core::InputError);
  EXPECT_THROW(orientation_of({1, 0, 0}, {1, 1, 0}), core::InputError);
  const Matrix<3> q = orientation_of({1, 1, 0}, {0, 0, 1});
  EXPECT_NEAR((q * Vector<3>(1, 1, 0).normalized() - Vector<3>(1, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR(q.determinant(), 1, 1e-15);
  const Crystal<3> crystal(p, {});
  EXPECT_THROW(crystal.stress(-0.21 * Matrix<3>::Identity()), core::GuardStop);
  EXPECT_NO_THROW(crystal.stress(-0.19 * Matrix<3>::Identity()));
}
} // namespace ligament::md::testing
