// A force that shares nothing with the many-body law: central springs between the neighbours of a
// hexagonal lattice, without rotations, that break at a stretch. What a new force has to write.
#pragma once

#include "core/check.h"
#include "core/extremes.h"
#include "core/load.h"
#include "packings/packing.h"
#include "particles/particle_force.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::tests
{
/// Cauchy's relation makes lambda = mu: nu = 1/4 in plane strain, 1/3 in plane stress. Springs
/// carry by the share of their face that is left; sides that a load moves pull by half a bond.
class PairForce : public particles::ParticleForce<2>
{
public:
  using Particles = particles::Particles<2>;

  /// Young's modulus in Pa; springs break when longer by `largest_stretch` of their length.
  PairForce(const packings::Packing<2> &packing, std::vector<core::BoundaryLoad<2>> loads,
            double youngs_modulus, double density, PlaneMode plane,
            double largest_stretch = std::numeric_limits<double>::infinity())
      : loads_(std::move(loads)), reactions_(loads_.size(), Vector<2>::Zero()),
        outer_(packing.boundary_faces), pad_(packing.size(), false), weight_(packing.size(), 1.),
        volume_(packing.volume), largest_stretch_(largest_stretch)
  {
    core::require(packing.directions.size() == 3, "the pair force is for hexagonal lattices");
    const double whole = packing.directions[0].area, t = packing.thickness;
    const double spring =
        youngs_modulus * t * (plane == PlaneMode::strain ? 1.6 / std::sqrt(3.) : std::sqrt(3.) / 2);
    for (const auto &f : packing.faces)
      springs_.push_back({f.i, f.j, f.normal, f.q_i + f.q_j, spring * f.area / whole, f.area,
                          get(packing.centre, f.i) + f.lever_i, !f.cracked});
    find_constants(packing, spring, density, plane);
    for (int l = 0; l < int(loads_.size()); ++l) {
      core::require(loads_[l].kind != core::BoundaryLoad<2>::Kind::traction || loads_[l].absorbing,
                    "the pair force knows no tractions");
      for (const auto &f : outer_)
        for (int c = 0; c < 2 && f.boundary == loads_[l].boundary; ++c)
          if (loads_[l].value[c])
            walls_.push_back({f.i, c, l, constants_.stiffness(0, 0) * f.area / f.q,
                              loads_[l].displacement(c, 0), 0});
    }
  }

  bool has_rotations() const override { return false; }

  // In the step in which a spring breaks it acts by half: the mean of the forces before and after.
  void compute(Particles &p, double time) override
  {
    if (time != time_) {
      for (Spring &s : springs_)
        s.breaks = false;
      time_ = time;
    }
    for (int c = 0; c < 2; ++c)
      std::fill(p.force[c].begin(), p.force[c].end(), 0.);
    for (int k = 0; k < int(springs_.size()); ++k) {
      Spring &s = springs_[k];
      if (!s.intact && !s.breaks)
        continue;
      const Vector<2> x = way(s, p);
      const double longer = x.norm() - s.length;
      if (s.intact && longer > largest_stretch_ * s.length && !pad_[s.i] && !pad_[s.j])
        break_spring(s, longer, p);
      const Vector<2> f = (s.breaks ? 0.5 : 1.) * stiffness(s) * longer * x.normalized();
      add(p.force, s.i, f);
      add(p.force, s.j, Vector<2>(-f));
    }
    pull_walls(p);
  }

  double potential_energy(const Particles &p) const override
  {
    double sum = 0;
    for (const Spring &s : springs_)
      if (s.intact)
        sum += 0.5 * stiffness(s) * std::pow(way(s, p).norm() - s.length, 2);
    for (const Wall &w : walls_)
      sum += 0.5 * w.stiffness * std::pow(p.displacement[w.component][w.i] - w.place, 2);
    return sum;
  }

  // A bound by the sums of the rows of M^-1 K.
  double stable_step(const Particles &p) const override
  {
    Components<2> rows;
    for (auto &row : rows)
      row.assign(p.size(), 0.);
    for (const Spring &s : springs_)
      for (const int i : {s.i, s.j})
        for (int c = 0; c < 2; ++c)
          rows[c][i] += 2 * stiffness(s) * std::abs(s.normal[c]) * s.normal.lpNorm<1>();
    for (const Wall &w : walls_)
      rows[w.component][w.i] += w.stiffness;
    double largest = 0;
    for (int c = 0; c < 2; ++c)
      for (int i = 0; i < p.size(); ++i)
        keep_largest(largest, rows[c][i] * p.inverse_mass(i));
    return 2 / std::sqrt(largest);
  }

  particles::ElasticConstants<2> elastic_constants() const override { return constants_; }

  void set_energy_weights(const std::vector<double> &weights) override { weight_ = weights; }

  void set_coupled_edge(const Particles &, particles::CoupledEdge<2> edge) override
  {
    for (const int i : edge.pads)
      pad_[i] = true;
  }

  void add_tangent(const Particles &,
                   const std::function<void(const particles::QuadraticTerm<2> &)> &add,
                   const std::vector<int> *of = nullptr) const override
  {
    using Term = particles::QuadraticTerm<2>;
    for (const Spring &s : springs_)
      if (s.intact && (is_asked(s.i, of) || is_asked(s.j, of))) {
        Term term{Term::Kind::bond,
                  s.place,
                  {s.i, s.j},
                  Eigen::MatrixXd::Zero(1, 6),
                  Eigen::VectorXd::Constant(1, stiffness(s))};
        term.rows.block<1, 2>(0, 0) = -s.normal.transpose();
        term.rows.block<1, 2>(0, 3) = s.normal.transpose();
        add(term);
      }
    for (const Wall &w : walls_) {
      if (!is_asked(w.i, of))
        continue;
      Term term{Term::Kind::wall,
                Vector<2>::Zero(),
                {w.i},
                Eigen::MatrixXd::Zero(1, 3),
                Eigen::VectorXd::Constant(1, w.stiffness)};
      term.rows(0, w.component) = 1;
      add(term);
    }
  }

  void for_each_face(const Particles &p,
                     const std::function<void(const particles::FaceView<2> &)> &visit,
                     const std::vector<int> *of = nullptr) const override
  {
    for (const Spring &s : springs_) {
      if (is_asked(s.i, of))
        visit({s.i, s.j, s.normal, s.area, s.place, s.intact});
      if (is_asked(s.j, of))
        visit({s.j, s.i, -s.normal, s.area, s.place, s.intact});
    }
    for (const auto &f : outer_)
      if (is_asked(f.i, of))
        visit({f.i, -1, f.normal, f.area, get(p.reference, f.i) + f.lever, false});
  }

  particles::ForceLosses losses() const override { return {fracture_, 0, 0, 0}; }
  Vector<2> reaction(int load) const override { return reactions_[load]; }
  double external_work() const override { return work_; }

  // Of each spring half of f x, over the cell.
  void stresses(const Particles &p, Components<3> &stress) const override
  {
    for (auto &component : stress)
      component.assign(p.size(), 0.);
    for (const Spring &s : springs_)
      if (s.intact) {
        const Vector<2> x = way(s, p);
        const double f = stiffness(s) * (x.norm() - s.length) / x.norm();
        for (const int i : {s.i, s.j})
          add(stress, i,
              Vec<3>(Vec<3>(x[0] * x[0], x[1] * x[1], x[0] * x[1]) * f / 2 / volume_[i]));
      }
  }

  long n_bonds() const override
  {
    return std::count_if(springs_.begin(), springs_.end(), [](const auto &s) { return s.intact; });
  }
  bool can_break() const override { return std::isfinite(largest_stretch_); }
  const std::vector<particles::BrokenBond<2>> &broken_bonds() const override { return broken_; }

private:
  static bool is_asked(int i, const std::vector<int> *of)
  {
    return !of || std::binary_search(of->begin(), of->end(), i);
  }
  struct Spring
  {
    int i, j;
    Vector<2> normal;         // unit, from i to j, in the reference
    double length, stiffness; // m, N/m
    double area;              // m^2
    Vector<2> place;          // m, of the face
    bool intact, breaks = false;
  };
  /// A component of a particle and the side that it hangs on.
  struct Wall
  {
    int i, component, load;
    double stiffness, place, pull; // N/m, m, N at the last compute
  };

  double stiffness(const Spring &s) const
  {
    return s.stiffness * (weight_[s.i] + weight_[s.j]) / 2;
  }

  static Vector<2> way(const Spring &s, const Particles &p)
  {
    return s.length * s.normal + get(p.displacement, s.j) - get(p.displacement, s.i);
  }

  // The lattice sum 1/(2V) sum k r^2 n n n n over the six neighbours.
  void find_constants(const packings::Packing<2> &packing, double spring, double density,
                      PlaneMode plane)
  {
    double cell = 0; // of whole hexagons
    for (const auto &d : packing.directions)
      cell += d.area * d.distance / 2;
    auto &c = constants_.stiffness;
    c.setZero();
    for (const auto &d : packing.directions) {
      const Vec<3> n(d.normal[0] * d.normal[0], d.normal[1] * d.normal[1],
                     d.normal[0] * d.normal[1]);
      c += spring * d.distance * d.distance / cell * n * n.transpose();
    }
    const double lambda = c(0, 1), mu = c(2, 2);
    constants_.poissons_ratio =
        plane == PlaneMode::strain ? lambda / (2 * (lambda + mu)) : lambda / c(0, 0);
    constants_.youngs_modulus = 2 * mu * (1 + constants_.poissons_ratio);
    constants_.density = density;
    constants_.wave_speed_p = std::sqrt(c(0, 0) / density);
    constants_.wave_speed_s = std::sqrt(mu / density);
  }

  void break_spring(Spring &s, double longer, const Particles &p)
  {
    s.intact = false;
    s.breaks = true;
    const double energy = 0.5 * stiffness(s) * longer * longer;
    fracture_ += energy;
    broken_.push_back(
        {s.i, s.j, p.global_id[s.i], p.global_id[s.j], time_, s.place, s.normal, s.area, energy});
  }

  // Work by the trapezoidal rule: exact for linear springs.
  void pull_walls(Particles &p)
  {
    std::fill(reactions_.begin(), reactions_.end(), Vector<2>::Zero());
    for (Wall &w : walls_) {
      const double place = loads_[w.load].displacement(w.component, time_);
      const double pull = w.stiffness * (place - p.displacement[w.component][w.i]);
      work_ += 0.5 * (w.pull + pull) * (place - w.place);
      w.place = place;
      w.pull = pull;
      p.force[w.component][w.i] += pull;
      reactions_[w.load][w.component] += pull;
    }
  }

  std::vector<core::BoundaryLoad<2>> loads_;
  std::vector<Vector<2>> reactions_; // N, of the loads
  std::vector<packings::BoundaryFace<2>> outer_;
  std::vector<bool> pad_;
  std::vector<double> weight_, volume_;
  double largest_stretch_;
  std::vector<Spring> springs_;
  std::vector<Wall> walls_;
  particles::ElasticConstants<2> constants_;
  std::vector<particles::BrokenBond<2>> broken_;
  double fracture_ = 0, work_ = 0, time_ = 0;
};
} // namespace ligament::tests
