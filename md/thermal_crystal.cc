#include "md/thermal_crystal.h"

#include "core/check.h"
#include "core/thermal_noise.h"
#include "md/atom_force.h"
#include "md/crystal_packing.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::md
{
namespace
{
constexpr int n_blocks = 20; // whose means tell the error of the whole mean
constexpr int n_between = 8; // steps between two looks at the stress

/// Edges of the box in lattice parameters.
template <int dim>
Vector<dim> box_of(CrystalKind kind, bool is_turned, int n_atoms)
{
  if constexpr (dim == 2) {
    const double rows = std::sqrt(n_atoms / 2 / std::sqrt(3.) / 2);
    const double n = std::max(4., std::round(rows));
    return {std::round(n * std::sqrt(3.)), n * std::sqrt(3.)};
  } else {
    const double edge = std::cbrt(n_atoms / (kind == CrystalKind::fcc ? 4. : 2.));
    const double across = std::round(edge / std::sqrt(2.)) * std::sqrt(2.);
    return is_turned ? Vector<3>(across, across, std::round(edge))
                     : Vector<3>(Vector<3>::Constant(std::round(edge)));
  }
}

template <int dim>
class ThermalBox
{
public:
  ThermalBox(const Crystal<dim> &crystal, bool is_turned, double stretch, const ThermalRun &run)
      : run_(run)
  {
    CrystalShape<dim> shape;
    shape.upper = crystal.lattice_parameter() *
                  box_of<dim>(crystal.parameters().kind, is_turned, run.n_atoms);
    shape.periodic.fill(true);
    auto packing = cut_crystal(crystal, shape);
    for (double &x : packing.centre[0])
      x *= 1 + stretch;
    packing.period[0] *= 1 + stretch;
    atoms = make_atoms(crystal, packing);
    AtomForceOptions options;
    options.keeps_neighbours = stretch == 0; // rows are those of the lattice as it is
    force = std::make_unique<AtomForce<dim>>(crystal, packing, options);
    const double critical = force->stable_step(atoms);
    dt_ = run.step_fraction * critical;
    kept_ = std::exp(-dt_ * 2 / critical / 20);
    root_ = std::sqrt(run.thermal_energy / atoms.mass[0]);
  }

  /// Velocities of twice the temperature, for positions at rest.
  void warm()
  {
    const core::ThermalNoise noise(run_.seed, -1);
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < atoms.size(); ++i)
        atoms.velocity[c][i] = std::sqrt(2.) * root_ * noise(atoms.global_id[i], c, 3);
  }
  /// Kick, half a drift, friction and noise, half a drift: places of a harmonic crystal have the
  /// spread of their temperature at any step.
  void advance(long step)
  {
    force->compute(atoms, 0);
    const core::ThermalNoise noise(run_.seed, step);
    const double heat = std::sqrt(1 - kept_ * kept_) * root_;
    for (int c = 0; c < dim; ++c)
      for (int i = 0; i < atoms.size(); ++i) {
        double &v = atoms.velocity[c][i], &u = atoms.displacement[c][i];
        v += dt_ / atoms.mass[i] * atoms.force[c][i];
        u += dt_ / 2 * v;
        v = kept_ * v + heat * noise(atoms.global_id[i], c, 2);
        u += dt_ / 2 * v;
      }
  }

  particles::Particles<dim> atoms;
  std::unique_ptr<AtomForce<dim>> force;

private:
  ThermalRun run_;
  double dt_ = 0, kept_ = 1, root_ = 0;
};

/// Samples of the stress, and of the sums of force times displacement along each axis, whose mean
/// is known: -(N - 1) kT.
template <int dim>
struct Samples
{
  Eigen::MatrixXd stress, known; // a row each
};

/// theory.md eq. (M12): what the stress shares with the known sums is taken out; means and errors
/// from blocks.
template <int dim>
void find_means(const Samples<dim> &s, ThermalState<dim> &state)
{
  const Eigen::Index n = s.stress.rows();
  const Eigen::MatrixXd spread = s.known.rowwise() - s.known.colwise().mean(),
                        shares = spread.colPivHouseholderQr().solve(s.stress.rowwise() -
                                                                    s.stress.colwise().mean());
  const Eigen::MatrixXd rest = s.stress - s.known * shares;
  const Eigen::Index per_block = n / n_blocks;
  for (int k = 0; k < n_strains<dim>; ++k) {
    double sum = 0, squares = 0;
    for (int b = 0; b < n_blocks; ++b) {
      const double mean = rest.col(k).segment(b * per_block, per_block).mean();
      sum += mean / n_blocks;
      squares += mean * mean / n_blocks;
    }
    state.stress[k] = sum;
    state.error[k] = std::sqrt(std::max(0., squares - sum * sum) / (n_blocks - 1));
  }
}

template <int dim>
double bulk_modulus(const Crystal<dim> &crystal)
{
  const auto c = crystal.elastic_constants().stiffness;
  return (c(0, 0) + (dim - 1) * c(0, 1)) / dim;
}
} // namespace

template <int dim>
ThermalState<dim> run_thermal_crystal(const Potential &potential, CrystalParameters<dim> parameters,
                                      bool is_turned, double stretch, const ThermalRun &run,
                                      long n_steps)
{
  parameters.orientation.setIdentity();
  if constexpr (dim == 3)
    if (is_turned)
      parameters.orientation = orientation_of(Vector<3>(1, 1, 0), Vector<3>(-1, 1, 0));
  const Crystal<dim> crystal(potential, parameters);
  ThermalBox<dim> box(crystal, is_turned, stretch, run);
  box.warm();
  const auto &atoms = box.atoms;
  const int n = atoms.size();
  const long n_first = std::max(n_steps / 10, 2000l);
  for (long k = 0; k < n_first; ++k)
    box.advance(k);

  const long n_samples = std::max(long(n_blocks), n_steps / n_between);
  Samples<dim> samples;
  samples.stress.resize(n_samples, n_strains<dim>);
  samples.known.resize(n_samples, dim);
  ThermalState<dim> state;
  Components<n_strains<dim>> stress;
  for (long s = 0; s < n_samples; ++s) {
    for (int k = 0; k < n_between; ++k)
      box.advance(n_first + s * n_between + k);
    box.force->compute(box.atoms, 0); // of the present places
    box.force->stresses(atoms, stress);
    for (int k = 0; k < n_strains<dim>; ++k) {
      double sum = 0;
      for (const double value : stress[k])
        sum += value / n;
      samples.stress(s, k) =
          sum - (k < dim ? run.thermal_energy * (n - 1) / n / atoms.volume[0] : 0);
    }
    for (int c = 0; c < dim; ++c) {
      double work = (n - 1) * run.thermal_energy, mean = 0, square = 0;
      for (int i = 0; i < n; ++i) {
        const double u = atoms.displacement[c][i];
        work += atoms.force[c][i] * u;
        mean += u / n;
        square += u * u / n;
      }
      samples.known(s, c) = work / (n * run.thermal_energy);
      state.squared_displacement += (square - mean * mean) / double(dim * n_samples);
    }
  }
  find_means(samples, state);
  return state;
}

template <int dim>
ThermalLattice thermal_lattice(const Potential &potential, CrystalParameters<dim> parameters,
                               const ThermalRun &run)
{
  parameters.orientation.setIdentity();
  ThermalLattice lattice;
  parameters.lattice_parameter = 0;
  const double cold = Crystal<dim>(potential, parameters).lattice_parameter();
  lattice.parameter = cold;
  for (const double share : {0.15, 0.35, 1.}) {
    parameters.lattice_parameter = lattice.parameter;
    const double stiffness = dim * bulk_modulus(Crystal<dim>(potential, parameters));
    const auto state = run_thermal_crystal(potential, parameters, false, 0., run,
                                           std::lround(share * double(run.lattice_steps)));
    double mean = 0, variance = 0;
    for (int c = 0; c < dim; ++c) {
      mean += state.stress[c] / dim;
      variance += std::pow(state.error[c] / dim, 2);
    }
    lattice.pressure = -mean;
    lattice.stress_error = std::sqrt(variance);
    lattice.squared_displacement = state.squared_displacement;
    lattice.error = lattice.parameter * lattice.stress_error / stiffness;
    lattice.parameter *= 1 - mean / stiffness;
    core::require(std::abs(lattice.parameter / cold - 1) < 0.1,
                  fmt::format("heat would widen the crystal from a lattice parameter of {:.4g} m "
                              "to {:.4g} m: it does not stay one",
                              cold, lattice.parameter));
  }
  return lattice;
}

template <int dim>
CubicConstants thermal_constants(const Potential &potential, CrystalParameters<dim> parameters,
                                 const ThermalRun &run)
{
  constexpr double stretch = 0.01;
  CubicConstants c;
  const auto slopes = [&](bool is_turned) -> Strain<dim> {
    const auto longer = run_thermal_crystal(potential, parameters, is_turned, stretch, run,
                                            run.stiffness_steps),
               shorter = run_thermal_crystal(potential, parameters, is_turned, -stretch, run,
                                             run.stiffness_steps);
    c.error = std::max(c.error, std::hypot(longer.error[0], shorter.error[0]) / (2 * stretch));
    return (longer.stress - shorter.stress) / (2 * stretch);
  };
  const Strain<dim> straight = slopes(false);
  c.c11 = straight[0];
  c.c12 = dim == 2 ? straight[1] : (straight[1] + straight[dim - 1]) / 2;
  c.c44 = (c.c11 - c.c12) / 2;
  if constexpr (dim == 3)
    c.c44 = slopes(true)[0] - (c.c11 + c.c12) / 2;
  return c;
}

template <int dim>
Stiffness<dim> stiffness_of(const CubicConstants &c, const Matrix<dim> &orientation)
{
  static constexpr int first[] = {0, 1, 2, 1, 0, 0}, second[] = {0, 1, 2, 2, 2, 1};
  const auto index = [](int k) {
    return dim == 2 ? std::pair(k == 1 ? 1 : 0, k == 0 ? 0 : 1) : std::pair(first[k], second[k]);
  };
  Stiffness<dim> result;
  for (int p = 0; p < n_strains<dim>; ++p)
    for (int q = 0; q < n_strains<dim>; ++q) {
      const auto [i, j] = index(p);
      const auto [k, l] = index(q);
      double cubic = 0; // sum over the cube's axes
      for (int m = 0; m < dim; ++m)
        cubic += orientation(i, m) * orientation(j, m) * orientation(k, m) * orientation(l, m);
      result(p, q) = c.c12 * (i == j && k == l) +
                     c.c44 * ((i == k && j == l) + (i == l && j == k)) +
                     (c.c11 - c.c12 - 2 * c.c44) * cubic;
    }
  return result;
}

#define INSTANTIATE(dim)                                                                           \
  template ThermalState<dim> run_thermal_crystal(const Potential &, CrystalParameters<dim>, bool,  \
                                                 double, const ThermalRun &, long);                \
  template ThermalLattice thermal_lattice(const Potential &, CrystalParameters<dim>,               \
                                          const ThermalRun &);                                     \
  template CubicConstants thermal_constants(const Potential &, CrystalParameters<dim>,             \
                                            const ThermalRun &);                                   \
  template Stiffness<dim> stiffness_of(const CubicConstants &, const Matrix<dim> &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace ligament::md
