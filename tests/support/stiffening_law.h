// A toy law: the many-body law with bonds that stiffen strongly with their strain.
#pragma once

#include "particles/particle_force.h"

#include <algorithm>
#include <tuple>

namespace ligament::tests
{
/// Adds to a force on every bond the energy 1/4 beta S r e^4, e the strain of the distance of its
/// particles: nothing to the stiffness in the reference.
template <int dim>
class StiffeningLaw : public particles::ParticleForce<dim>
{
public:
  using Particles = particles::Particles<dim>;
  using Base = particles::ParticleForce<dim>;

  StiffeningLaw(const Particles &particles, std::unique_ptr<Base> law, double beta)
      : law_(std::move(law)), beta_(beta)
  {
    law_->for_each_face(particles, [&](const particles::FaceView<dim> &face) {
      if (face.bonded && face.i < face.j)
        springs_.push_back({face.i, face.j, face.area, 1., face.centroid});
    });
  }

  void compute(Particles &p, double time) override
  {
    law_->compute(p, time);
    add(springs_, beta_, p);
  }
  double potential_energy(const Particles &p) const override
  {
    double energy = law_->potential_energy(p);
    for (const Spring &s : springs_)
      energy += s.energy(beta_, p);
    return energy;
  }
  double stable_step(const Particles &p) const override { return law_->stable_step(p); }
  particles::ElasticConstants<dim> elastic_constants() const override
  {
    return law_->elastic_constants();
  }
  void set_energy_weights(const std::vector<double> &weights) override
  {
    law_->set_energy_weights(weights);
  }
  void add_tangent(const Particles &p,
                   const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
                   const std::vector<int> *of = nullptr) const override
  {
    law_->add_tangent(p, add, of);
  }
  void for_each_face(const Particles &p,
                     const std::function<void(const particles::FaceView<dim> &)> &visit,
                     const std::vector<int> *of = nullptr) const override
  {
    law_->for_each_face(p, visit, of);
  }

  std::unique_ptr<particles::PartialForce<dim>>
  part(const Particles &p, const std::vector<int> &members,
       const typename Base::TermShare &share) const override
  {
    auto part = std::make_unique<Part>();
    part->law = law_->part(p, members, share);
    part->beta = beta_;
    for (const Spring &s : springs_) {
      const auto i = std::find(members.begin(), members.end(), s.i);
      const auto j = std::find(members.begin(), members.end(), s.j);
      if (i != members.end() && j != members.end())
        part->springs.push_back({int(i - members.begin()), int(j - members.begin()), s.area,
                                 share(s.location, {s.i, s.j}), s.location});
    }
    return part;
  }

private:
  struct Spring
  {
    int i, j;
    double area, share;
    Vector<dim> location;

    /// Distance vector now, distance in the reference, strain.
    std::tuple<Vector<dim>, double, double> stretch(const Particles &p) const
    {
      const Vector<dim> r = get(p.reference, j) - get(p.reference, i);
      const Vector<dim> x = r + get(p.displacement, j) - get(p.displacement, i);
      return {x, r.norm(), x.norm() / r.norm() - 1};
    }
    double energy(double beta, const Particles &p) const
    {
      const auto [x, r, e] = stretch(p);
      return share * beta * area * r * e * e * e * e / 4;
    }
  };

  static double add(const std::vector<Spring> &springs, double beta, Particles &p)
  {
    double energy = 0;
    for (const Spring &s : springs) {
      const auto [x, r, e] = s.stretch(p);
      const Vector<dim> f = s.share * beta * s.area * e * e * e * x.normalized();
      ligament::add(p.force, s.i, f);
      ligament::add(p.force, s.j, Vector<dim>(-f));
      energy += s.energy(beta, p);
    }
    return energy;
  }

  struct Part : particles::PartialForce<dim>
  {
    double compute(Particles &p) override { return law->compute(p) + add(springs, beta, p); }
    std::unique_ptr<particles::PartialForce<dim>> law;
    std::vector<Spring> springs;
    double beta;
  };

  std::unique_ptr<Base> law_;
  double beta_;
  std::vector<Spring> springs_;
};
} // namespace ligament::tests
