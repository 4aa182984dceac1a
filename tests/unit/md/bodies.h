// Small bodies of atoms in motion, and the oracle of each.
#pragma once

#include "md/atom_force.h"
#include "md/crystal_packing.h"
#include "tests/oracle/atom_oracle.h"
#include "tests/unit/md/potentials.h"

namespace ligament::md::testing
{
template <int dim>
struct Body
{
  Crystal<dim> crystal;
  packings::Packing<dim> packing;
  particles::Particles<dim> atoms;
  AtomForceOptions options;
  Vector<dim> top; // m, upper corner of the box; the lower one is 0

  Body(const Potential &potential, const CrystalParameters<dim> &parameters,
       const CrystalShape<dim> &shape, const std::vector<int> &species = {})
      : crystal(potential, parameters), packing(cut_crystal(crystal, shape)),
        atoms(make_atoms(crystal, packing, species)), top(shape.upper)
  {
    options.species = species;
  }

  AtomForce<dim> force() const { return {crystal, packing, options}; }

  /// Of this potential, which may be in another form than the crystal's.
  oracle::AtomOracle<dim> oracle(const Potential &p) const
  {
    const auto curve = [](const Jet &jet) { return oracle::Curve{jet.value, jet.slope}; };
    oracle::AtomOracle<dim> o;
    o.pair = [&p, curve](int a, int b, double r) { return curve(p.bond(a, b, r).pair); };
    o.density = [&p, curve](int a, int b, double r) { return curve(p.bond(a, b, r).density_at_i); };
    o.embedding = [&p, curve](int a, double rho) { return curve(p.embedding(a, rho)); };
    o.cutoff = p.cutoff();
    o.period = packing.period;
    o.species = options.species.empty()
                    ? std::vector<int>(atoms.size(), crystal.parameters().species)
                    : options.species;
    return o;
  }

  /// Every atom somewhere within a cube of twice this size around its place.
  void disturb(double amplitude, unsigned seed = 1)
  {
    Noise noise(seed);
    for (int i = 0; i < atoms.size(); ++i)
      for (auto &component : atoms.displacement)
        component[i] = amplitude * noise();
  }

  /// Stiffness of a bond, roughly, N/m: scale of forces.
  double stiffness() const
  {
    return crystal.elastic_constants().stiffness(0, 0) * crystal.volume() /
           (crystal.spacing() * crystal.spacing());
  }
};

/// A box of so many lattice parameters, cut somewhere.
template <int dim>
CrystalShape<dim> box(const Crystal<dim> &crystal, const Vector<dim> &size,
                      std::array<bool, dim> periodic = {})
{
  CrystalShape<dim> shape;
  shape.upper = crystal.lattice_parameter() * size;
  if (dim == 2)
    shape.upper[1] *= std::sqrt(3.); // a period
  shape.periodic = periodic;
  return shape;
}

template <int dim>
Body<dim> make_body(const Potential &potential, CrystalKind kind, const Vector<dim> &size,
                    std::array<bool, dim> periodic = {},
                    const Matrix<dim> &orientation = Matrix<dim>::Identity())
{
  CrystalParameters<dim> parameters;
  parameters.kind = kind;
  parameters.orientation = orientation;
  return {potential, parameters, box<dim>(Crystal<dim>(potential, parameters), size, periodic)};
}

inline Body<2> plane_body(const Vector<2> &size = {8, 5}, std::array<bool, 2> periodic = {})
{
  return make_body<2>(plane_atoms(), CrystalKind::triangular, size, periodic);
}

/// Bits of 3D crystals of all kinds of potentials: free, turned, periodic, an alloy.
inline std::vector<Body<3>> bodies()
{
  std::vector<Body<3>> all;
  all.push_back(make_body<3>(foiles_copper(), CrystalKind::fcc, {3, 2.5, 3}));
  all.push_back(make_body<3>(mishin_copper(), CrystalKind::fcc, {2, 3, 2}, {true, false, true}));
  all.push_back(make_body<3>(mendelev_iron(), CrystalKind::bcc, {3, 4, 3}, {}, some_rotation<3>()));
  all.push_back(make_body<3>(argon_pairs(), CrystalKind::fcc, {2, 2, 2}, {true, true, true}));
  const Potential alloy = zhou_johnson_wadley({"Cu", "Ni", "Ag"});
  auto mixed = make_body<3>(alloy, CrystalKind::fcc, {3, 3, 3}, {true, true, false});
  std::vector<int> species(mixed.atoms.size());
  for (int i = 0; i < mixed.atoms.size(); ++i)
    species[i] = i % 3;
  mixed.options.species = species;
  all.push_back(std::move(mixed));
  return all;
}

/// Largest difference over the scale.
template <std::size_t n>
double difference(const Components<n> &a, const Components<n> &b, double scale)
{
  double largest = 0;
  for (std::size_t c = 0; c < n; ++c)
    for (std::size_t i = 0; i < a[c].size(); ++i) {
      const double error = std::abs(a[c][i] - b[c][i]);
      largest = error <= largest ? largest : error; // NaN, too
    }
  return largest / scale;
}
} // namespace ligament::md::testing
