// Bodies on which laws of flow are tested: clipped lattices and random packings, with faces
// missing.
#pragma once

#include "packings/random_packing.h"
#include "tests/unit/dem/cases.h"

namespace ligament::dem::testing
{
/// Without so many of a hundred faces.
template <int dim>
Packing<dim> torn(Packing<dim> packing, int percent)
{
  std::mt19937 random(5);
  auto &faces = packing.faces;
  faces.erase(std::remove_if(faces.begin(), faces.end(),
                             [&](const auto &) { return int(random() % 100) < percent; }),
              faces.end());
  return packing;
}

/// Clipped cells all around.
template <int dim>
Packing<dim> lattice_body(int percent = 5)
{
  auto parameters = box<Case<dim, dim == 2 ? Kind::hexagonal : Kind::fcc, true>>(dim == 2 ? 21 : 7);
  return torn(packings::make_lattice_packing<dim>(parameters), percent);
}

template <int dim>
Packing<dim> random_body(int percent = 5)
{
  packings::RandomParameters<dim> p;
  p.spacing = 0.01;
  p.size_ratio = 1.5;
  p.relaxation_sweeps = 5;
  p.upper.setConstant((dim == 2 ? 14.3 : 6.3) * p.spacing);
  return torn(packings::make_random_packing<dim>(p).packing, percent);
}
template <int dim>
void set_random_strains(ManyBodyForce<dim> &force, int n, double amplitude)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  for (int i = 0; i < n; ++i) {
    typename InelasticStrains<dim>::Tensor e;
    for (int c = 0; c < e.size(); ++c)
      e[c] = uniform(random);
    force.strains().set_strain(i, e);
  }
}

/// A homogeneous strain as all particles see it, turned.
template <int dim>
void deform(Particles<dim> &p, const Eigen::Matrix<double, dim, dim> &strain,
            const Spin<dim> &turn = Spin<dim>::Zero())
{
  for (int i = 0; i < p.size(); ++i) {
    for (auto &r : p.rotation)
      r[i] = 0;
    if constexpr (dim == 3)
      p.rotation[0][i] = 1;
    turn_by<dim>(p, i, turn);
    const Vector<dim> x = get(p.reference, i), y = x + strain * x;
    set(p.displacement, i, Vector<dim>(y + Turn<dim>::of(p, i).change(y) - x));
  }
}

/// The one next to the middle of all.
template <int dim>
int inner_particle(const Particles<dim> &p)
{
  int best = 0;
  Vector<dim> middle = Vector<dim>::Zero();
  for (int i = 0; i < p.size(); ++i)
    middle += get(p.reference, i) / p.size();
  for (int i = 0; i < p.size(); ++i)
    if ((get(p.reference, i) - middle).norm() < (get(p.reference, best) - middle).norm())
      best = i;
  return best;
}
} // namespace ligament::dem::testing
