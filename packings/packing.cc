#include "packings/packing.h"

#include "core/check.h"

#include <algorithm>

namespace ligament::packings
{
template <int dim>
double mean_face_area(const Packing<dim> &packing)
{
  if (packing.whole)
    return packing.whole->face_area;
  core::ExactSum sum;
  if (!packing.directions.empty()) {
    for (const auto &d : packing.directions)
      sum.add(d.area);
    return sum.value() / double(packing.directions.size());
  }
  for (const auto &face : packing.faces)
    sum.add(face.area);
  return packing.faces.empty() ? 0. : sum.value() / double(packing.faces.size());
}

template <int dim>
double largest_diameter(const Packing<dim> &packing)
{
  if (packing.whole)
    return packing.whole->diameter;
  double largest = packing.spacing;
  for (const double diameter : packing.diameter)
    largest = std::max(largest, diameter);
  return largest;
}

template <int dim>
void cut_faces(Packing<dim> &packing, const std::vector<CrackPlane<dim>> &cracks)
{
  packing.cuts = cracks;
  if (cracks.empty())
    return;
  for (auto &face : packing.faces) {
    face.cut = first_crossed<dim>(cracks, get(packing.centre, face.i), get(packing.centre, face.j));
    face.cracked = face.cut >= 0;
  }
}

template <int dim>
void fill_particles(const Packing<dim> &packing, const std::vector<double> &densities,
                    particles::Particles<dim> &particles)
{
  for (const double density : densities)
    core::require(density > 0, "the density of a packing must be positive");
  const int n = packing.size();
  particles.resize(n);
  particles.reference = packing.centre;
  particles.volume = packing.volume;
  particles.global_id = particles::GlobalIds(packing.global_id);
  particles.gyration = packing.spacing * packing.spacing / (dim == 2 ? 8 : 10);
  for (int i = 0; i < n; ++i) {
    const double density = densities[packing.material.empty() ? 0 : packing.material[i]];
    particles.mass[i] = density * packing.volume[i];
  }
}

template double mean_face_area(const Packing<2> &);
template double mean_face_area(const Packing<3> &);
template double largest_diameter(const Packing<2> &);
template double largest_diameter(const Packing<3> &);
template void cut_faces(Packing<2> &, const std::vector<CrackPlane<2>> &);
template void cut_faces(Packing<3> &, const std::vector<CrackPlane<3>> &);
template void fill_particles(const Packing<2> &, const std::vector<double> &,
                             particles::Particles<2> &);
template void fill_particles(const Packing<3> &, const std::vector<double> &,
                             particles::Particles<3> &);
} // namespace ligament::packings
