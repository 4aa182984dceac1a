// A crystal of atoms with a plain embedding potential: the force with a range that the coupler's
// tests use, and the faults that they plant in it.
#pragma once

#include "core/extremes.h"
#include "particles/particle_force.h"
#include "tests/support/embedding_potential.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::tests
{
/// What a crystal may tell a coupler wrongly.
struct CrystalFaults
{
  bool embeds_at_atoms = false; // the bonds' share of the embedding stands at x_i, not at bonds
  bool hides_reference = false; // no forces in the reference
  bool hides_range = false;     // answers 1.3 spacings
  bool closes_by_faces = false; // neighbours are those of the first shell
  bool hides_prestress = false; // terms are said to be blind to rotation; the load is there
};

/// Atoms of one kind on a hexagonal or FCC lattice, turned as it may be: neighbours are fixed by
/// index, x_j - x_i = X_j - X_i + u_j - u_i. No rotations, loads or boundaries.
template <int dim>
class CrystalForce : public particles::ParticleForce<dim>
{
public:
  using Particles = particles::Particles<dim>;
  using Matrix = Eigen::Matrix<double, dim, dim>;
  struct BondStiffness
  {
    double along, across; // N/m
  };

  /// spacing in m; a harmonic crystal has the linearised forces. It repeats itself along axes with
  /// a period (m) above 0, by more than twice its range.
  CrystalForce(const Particles &p, double spacing, const EmbeddingPotential &potential,
               double density, bool is_harmonic = true, CrystalFaults faults = {},
               const Vector<dim> &period = Vector<dim>::Zero())
      : potential_(potential), spacing_(spacing), density_(density), faults_(faults),
        period_(period)
  {
    find_neighbours(p);
    find_bulk(p);
    densities_ = densities(Components<dim>{});
    if (!is_harmonic)
      return;
    for (std::size_t i = 0; i < bonds_.size(); ++i)
      for (std::size_t b = 0; b < bonds_[i].size(); ++b) {
        const double r = bonds_[i][b].norm();
        stiffnesses_.push_back(stiffness(r, densities_[i], densities_[neighbours_[i][b]]));
        slopes_.push_back(potential_.density(r).slope);
      }
    find_forces(Components<dim>{}, first_forces_);
  }

  bool has_rotations() const override { return false; }

  void compute(Particles &p, double) override
  {
    if (first_forces_[0].empty())
      find_forces(p.displacement, p.force);
    else
      find_linear_forces(p.displacement, p.force);
  }

  // Against the reference.
  double potential_energy(const Particles &p) const override
  {
    if (!first_forces_[0].empty()) {
      Components<dim> force;
      find_linear_forces(p.displacement, force);
      double sum = 0;
      for (int i = 0; i < p.size(); ++i)
        sum -= get(p.displacement, i).dot(get(force, i) + get(first_forces_, i)) / 2;
      return sum;
    }
    const auto rho = densities(p.displacement);
    double sum = 0;
    for (std::size_t i = 0; i < bonds_.size(); ++i) {
      sum += potential_.embedding(rho[i]).value - potential_.embedding(densities_[i]).value;
      for (std::size_t b = 0; b < bonds_[i].size(); ++b)
        sum += 0.5 * (potential_.pair(bond(p.displacement, i, b).norm()).value -
                      potential_.pair(bonds_[i][b].norm()).value);
    }
    return sum;
  }

  // Of the crystal without end: its fastest wave, the best of many improved by going uphill.
  double stable_step(const Particles &p) const override
  {
    constexpr int n = dim == 2 ? 40 : 16;
    const auto squared_frequency = [&](const Vector<dim> &k) {
      return Eigen::SelfAdjointEigenSolver<Matrix>(wave_stiffness(k), Eigen::EigenvaluesOnly)
          .eigenvalues()[dim - 1];
    };
    std::vector<std::pair<double, Vector<dim>>> waves;
    for (int q = 0; q < int(std::pow(n, dim)); ++q) {
      Vector<dim> k;
      for (int c = 0, rest = q; c < dim; ++c, rest /= n)
        k[c] = (rest % n - n / 2 + 0.37) * 4 * M_PI / (n * spacing_);
      waves.emplace_back(squared_frequency(k), k);
    }
    std::sort(waves.begin(), waves.end(), [](auto &a, auto &b) { return a.first > b.first; });
    double largest = 0;
    for (int start = 0; start < 8; ++start) {
      auto [best, k] = waves[start];
      for (double step = 0.2 / spacing_; step > 1e-6 / spacing_;) {
        bool moved = false;
        for (int c = 0; c < 2 * dim; ++c) {
          const Vector<dim> next = k + (c % 2 ? step : -step) * Vector<dim>::Unit(c / 2);
          if (const double value = squared_frequency(next); value > best) {
            best = value;
            k = next;
            moved = true;
          }
        }
        if (!moved)
          step /= 2;
      }
      keep_largest(largest, best);
    }
    return 2 / std::sqrt(largest / p.mass[bulk_]);
  }

  particles::ElasticConstants<dim> elastic_constants() const override
  {
    particles::ElasticConstants<dim> c;
    c.density = density_;
    const double volume =
        dim == 2 ? std::sqrt(0.75) * spacing_ * spacing_ : std::pow(spacing_, 3) / std::sqrt(2.);
    Strain<dim> density = Strain<dim>::Zero(); // d rho / d strain
    for (const Vector<dim> &r : bonds_[bulk_]) {
      const BondStiffness k = stiffness(r.norm(), densities_[bulk_], densities_[bulk_]);
      const Vector<dim> n = r.normalized();
      Strain<dim> nn;
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b)
          nn[voigt_index<dim>(a, b)] = n[a] * n[b];
      c.stiffness += (k.along - k.across) * r.squaredNorm() / (2 * volume) * nn * nn.transpose();
      c.stress += k.across * r.squaredNorm() / (2 * volume) * nn;
      density += potential_.density(r.norm()).slope * r.norm() * nn;
    }
    c.stiffness +=
        potential_.embedding(densities_[bulk_]).bend / volume * density * density.transpose();
    c.wave_speed_p = std::sqrt(c.stiffness.diagonal().maxCoeff() / density_);
    c.wave_speed_s = std::sqrt(c.stiffness.diagonal().minCoeff() / density_);
    return c;
  }

  void set_energy_weights(const std::vector<double> &) override {}

  /// Of a harmonic crystal: from now on no bond bears forces in the reference, but all keep their
  /// stiffness: motion about the equilibrium of free ends.
  void forget_reference()
  {
    forgets_ = true;
    for (auto &component : first_forces_)
      std::fill(component.begin(), component.end(), 0.);
  }

  double range() const override
  {
    return faults_.hides_range ? 1.3 * spacing_ : potential_.range();
  }
  bool is_prestressed() const override { return !faults_.hides_prestress; }
  void reference_forces(const Particles &p, Components<dim> &force) const override
  {
    particles::ParticleForce<dim>::reference_forces(p, force);
    if (!faults_.hides_reference && !forgets_)
      find_forces(Components<dim>{}, force);
  }

  void for_each_neighbour(const Particles &p,
                          const std::function<void(const particles::Neighbour &)> &visit,
                          const std::vector<int> *of = nullptr) const override
  {
    for (int i = 0; i < p.size(); ++i)
      if (is_asked(i, of))
        for (std::size_t b = 0; b < bonds_[i].size(); ++b)
          if (sees(bonds_[i][b]))
            visit({i, neighbours_[i][b], true});
  }

  std::vector<int> open_particles(const Particles &, const std::vector<int> &of) const override
  {
    const auto seen = [&](int i) {
      return std::count_if(bonds_[i].begin(), bonds_[i].end(), [&](auto &r) { return sees(r); });
    };
    std::vector<int> open;
    for (const int i : of)
      if (seen(i) < seen(bulk_))
        open.push_back(i);
    return open;
  }

  void add_tangent(const Particles &p,
                   const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
                   const std::vector<int> *of = nullptr) const override
  {
    for (int i = 0; i < p.size(); ++i) {
      bool is_felt = is_asked(i, of);
      for (std::size_t b = 0; b < bonds_[i].size(); ++b) {
        const int j = neighbours_[i][b];
        is_felt = is_felt || is_asked(j, of);
        if (i < j && (is_asked(i, of) || is_asked(j, of)))
          add(pair_term(p, i, b));
      }
      if (!is_felt)
        continue;
      add(embedding_term(p, i));
      if (faults_.embeds_at_atoms)
        add(bonds_at_atom(p, i));
    }
  }

  /// m omega^2 in N/m of waves exp(i k.X) of the crystal without end: the matrix of all components.
  Matrix wave_stiffness(const Vector<dim> &k) const
  {
    Matrix d = Matrix::Zero();
    Vector<dim> g = Vector<dim>::Zero();
    for (const Vector<dim> &r : bonds_[bulk_]) {
      const BondStiffness s = stiffness(r.norm(), densities_[bulk_], densities_[bulk_]);
      const Vector<dim> n = r.normalized();
      d += (1 - std::cos(k.dot(r))) *
           ((s.along - s.across) * n * n.transpose() + s.across * Matrix::Identity());
      g += potential_.density(r.norm()).slope * std::sin(k.dot(r)) * n;
    }
    return d + potential_.embedding(densities_[bulk_]).bend * g * g.transpose();
  }

private:
  static bool is_asked(int i, const std::vector<int> *of)
  {
    return !of || std::binary_search(of->begin(), of->end(), i);
  }
  bool sees(const Vector<dim> &r) const
  {
    return !faults_.closes_by_faces || r.norm() < 1.1 * spacing_;
  }

  void find_neighbours(const Particles &p)
  {
    const double range = potential_.range();
    using Box = std::array<int, dim>;
    const auto box = [&](const Vector<dim> &x) {
      Box b;
      for (int c = 0; c < dim; ++c)
        b[c] = int(std::floor(x[c] / range));
      return b;
    };
    std::map<Box, std::vector<int>> boxes;
    for (int j = 0; j < p.size(); ++j)
      boxes[box(get(p.reference, j))].push_back(j);
    std::vector<Vector<dim>> images; // of a place
    for (int q = 0; q < n_around; ++q)
      if (const Vector<dim> step = around(q); (step.array() == 0 || period_.array() > 0).all())
        images.push_back(step.cwiseProduct(period_));
    neighbours_.resize(p.size());
    bonds_.resize(p.size());
    for (int i = 0; i < p.size(); ++i)
      for (const Vector<dim> &image : images)
        for (int q = 0; q < n_around; ++q) {
          const Vector<dim> x = get(p.reference, i) + image;
          const auto found = boxes.find(box(x + range * around(q)));
          for (const int j : found == boxes.end() ? std::vector<int>() : found->second)
            if (const Vector<dim> r = get(p.reference, j) - x; j != i && r.norm() < range) {
              neighbours_[i].push_back(j);
              bonds_[i].push_back(r);
            }
        }
  }
  static constexpr int n_around = dim == 2 ? 9 : 27;
  /// Steps of -1, 0, 1 along each axis.
  static Vector<dim> around(int q)
  {
    Vector<dim> step;
    for (int c = 0; c < dim; ++c, q /= 3)
      step[c] = q % 3 - 1;
    return step;
  }
  // The atom in the middle sees all it can.
  void find_bulk(const Particles &p)
  {
    for (int i = 0; i < p.size(); ++i)
      if (neighbours_[i].size() > neighbours_[bulk_].size())
        bulk_ = i;
  }

  /// Without displacements: in the reference.
  Vector<dim> bond(const Components<dim> &u, std::size_t i, std::size_t b) const
  {
    if (u[0].empty())
      return bonds_[i][b];
    return bonds_[i][b] + get(u, neighbours_[i][b]) - get(u, int(i));
  }
  std::vector<double> densities(const Components<dim> &u) const
  {
    std::vector<double> rho(bonds_.size(), 0.);
    for (std::size_t i = 0; i < bonds_.size(); ++i)
      for (std::size_t b = 0; b < bonds_[i].size(); ++b)
        rho[i] += potential_.density(bond(u, i, b).norm()).value;
    return rho;
  }
  void find_forces(const Components<dim> &u, Components<dim> &force) const
  {
    const auto rho = densities(u);
    std::vector<double> slope(rho.size());
    for (std::size_t i = 0; i < rho.size(); ++i)
      slope[i] = potential_.embedding(rho[i]).slope;
    for (auto &component : force)
      component.assign(rho.size(), 0.);
    for (std::size_t i = 0; i < rho.size(); ++i)
      for (std::size_t b = 0; b < bonds_[i].size(); ++b) {
        const Vector<dim> x = bond(u, i, b);
        const double r = x.norm(),
                     pull = potential_.pair(r).slope +
                            (slope[i] + slope[neighbours_[i][b]]) * potential_.density(r).slope;
        add(force, int(i), Vector<dim>(pull / r * x));
      }
  }

  void find_linear_forces(const Components<dim> &u, Components<dim> &force) const
  {
    force = first_forces_;
    std::vector<double> pull(bonds_.size()); // F'' times the change of the density
    std::size_t k = 0;
    for (std::size_t i = 0; i < bonds_.size(); ++i) {
      double change = 0;
      for (std::size_t b = 0; b < bonds_[i].size(); ++b, ++k) {
        const Vector<dim> n = bonds_[i][b].normalized();
        const Vector<dim> d = get(u, neighbours_[i][b]) - get(u, int(i));
        change += slopes_[k] * n.dot(d);
        const auto &s = stiffnesses_[k];
        add(force, int(i), Vector<dim>(s.across * d + (s.along - s.across) * n.dot(d) * n));
      }
      pull[i] = potential_.embedding(densities_[i]).bend * change;
    }
    k = 0;
    for (std::size_t i = 0; i < bonds_.size(); ++i)
      for (std::size_t b = 0; b < bonds_[i].size(); ++b, ++k)
        add(force, int(i),
            Vector<dim>((pull[i] + pull[neighbours_[i][b]]) * slopes_[k] *
                        bonds_[i][b].normalized()));
  }

  BondStiffness stiffness(double r, double rho_i, double rho_j) const
  {
    const auto phi = potential_.pair(r), f = potential_.density(r);
    const double slope = potential_.embedding(rho_i).slope + potential_.embedding(rho_j).slope;
    return {phi.bend + slope * f.bend, (phi.slope + slope * f.slope) / r};
  }

  /// Directions along and across a bond as rows.
  static Matrix axes(const Vector<dim> &r)
  {
    Matrix rows;
    rows.row(0) = r.normalized();
    if constexpr (dim == 2)
      rows.row(1) << -rows(0, 1), rows(0, 0);
    else {
      rows.row(1) = Vector<3>(rows.row(0)).unitOrthogonal();
      rows.row(2) = Vector<3>(rows.row(0)).cross(Vector<3>(rows.row(1)));
    }
    return rows;
  }

  particles::QuadraticTerm<dim> pair_term(const Particles &p, int i, std::size_t b) const
  {
    const int j = neighbours_[i][b];
    const Vector<dim> &r = bonds_[i][b];
    BondStiffness k = stiffness(r.norm(), densities_[i], densities_[j]);
    if (faults_.embeds_at_atoms) {
      const auto phi = potential_.pair(r.norm());
      k = {phi.bend, phi.slope / r.norm()};
    }
    particles::QuadraticTerm<dim> term;
    term.location = get(p.reference, i) + r / 2;
    term.members = {i, j};
    term.rows.resize(dim, 2 * dim);
    term.rows << -axes(r), axes(r);
    term.stiffness = Eigen::VectorXd::Constant(dim, k.across);
    term.stiffness[0] = k.along;
    return term;
  }

  particles::QuadraticTerm<dim> embedding_term(const Particles &p, int i) const
  {
    particles::QuadraticTerm<dim> term;
    term.kind = particles::QuadraticTerm<dim>::Kind::volumetric;
    term.location = get(p.reference, i);
    term.members = {i};
    term.rows.setZero(1, dim * (1 + bonds_[i].size()));
    for (std::size_t b = 0; b < bonds_[i].size(); ++b) {
      term.members.push_back(neighbours_[i][b]);
      const Vector<dim> g =
          potential_.density(bonds_[i][b].norm()).slope * bonds_[i][b].normalized();
      term.rows.template middleCols<dim>(dim * (1 + b)) = g.transpose();
      term.rows.template leftCols<dim>() -= g.transpose();
    }
    term.stiffness = Eigen::VectorXd::Constant(1, potential_.embedding(densities_[i]).bend);
    return term;
  }

  /// F'(rho_i) times the second derivatives of f over all bonds of an atom.
  particles::QuadraticTerm<dim> bonds_at_atom(const Particles &p, int i) const
  {
    particles::QuadraticTerm<dim> term = embedding_term(p, i);
    const int n = int(bonds_[i].size());
    const double slope = potential_.embedding(densities_[i]).slope;
    term.rows.setZero(dim * n, dim * (1 + n));
    term.stiffness.resize(dim * n);
    for (int b = 0; b < n; ++b) {
      const auto f = potential_.density(bonds_[i][b].norm());
      term.rows.template block<dim, dim>(dim * b, dim * (1 + b)) = axes(bonds_[i][b]);
      term.rows.template block<dim, dim>(dim * b, 0) = -axes(bonds_[i][b]);
      term.stiffness.segment(dim * b, dim).setConstant(slope * f.slope / bonds_[i][b].norm());
      term.stiffness[dim * b] = slope * f.bend;
    }
    return term;
  }

  EmbeddingPotential potential_;
  double spacing_, density_; // m, kg/m^3
  CrystalFaults faults_;
  Vector<dim> period_; // m
  int bulk_ = 0;       // an atom that sees all its neighbours
  std::vector<std::vector<int>> neighbours_;
  std::vector<std::vector<Vector<dim>>> bonds_; // m, in the reference, to the neighbours
  std::vector<double> densities_;               // in the reference
  // Of a harmonic crystal: bond by bond k and f', and the forces in the reference.
  std::vector<BondStiffness> stiffnesses_;
  std::vector<double> slopes_;
  Components<dim> first_forces_;
  bool forgets_ = false;
};
} // namespace ligament::tests
