#include "dem/bond_network.h"

#include <limits>

namespace ligament::dem
{
namespace
{
/// The lattice direction of a face, or -1. Faces of clipped cells count as well when they
/// themselves are whole: volumes are kept per particle anyway.
template <int dim>
int lattice_direction(const packings::Face<dim> &face, const packings::Packing<dim> &packing)
{
  if (face.direction >= 0)
    return face.direction;
  constexpr double round_off = 1e-12;
  for (std::size_t k = 0; k < packing.directions.size(); ++k) {
    const auto &d = packing.directions[k];
    const double half = d.distance / 2, tolerance = round_off * half;
    const Vector<dim> n = (face.normal.dot(d.normal) > 0 ? 1 : -1) * d.normal;
    if ((face.lever_i - half * n).norm() < tolerance &&
        (face.lever_j + half * n).norm() < tolerance && std::abs(face.q_i - half) < tolerance &&
        std::abs(face.q_j - half) < tolerance && std::abs(face.area - d.area) < round_off * d.area)
      return int(k);
  }
  return -1;
}

/// A lattice direction of the packing in the place that the row kernel wants it in.
struct KernelDirection
{
  int index; // in the packing
  bool reversed;
};
using KernelDirections = std::vector<KernelDirection>;

KernelDirections kernel_directions(const std::vector<packings::LatticeDirection<2>> &directions)
{
  KernelDirections all;
  for (std::size_t k = 0; k < directions.size(); ++k)
    all.push_back({int(k), false});
  return all;
}

/// Those of a face-centred cubic lattice as a, b, e - a - b, e - b, e - a, e with a, b
/// perpendicular to each other (Basis<6> of lattice_kernel_3d.cc); others as they are.
KernelDirections kernel_directions(const std::vector<packings::LatticeDirection<3>> &directions)
{
  const int n = int(directions.size());
  KernelDirections all;
  for (int k = 0; k < n; ++k)
    all.push_back({k, false});
  if (n != 6)
    return all;
  const auto normal = [&](int k) { return directions[k].normal; };
  const auto has_direction = [](double dot) { return std::abs(dot) > 0.25; };
  const Vector<3> a = normal(0);
  Vector<3> b = a, e = a;
  for (int k = 1; k < n; ++k)
    if (!has_direction(normal(k).dot(a)))
      b = normal(k);
  for (int k = 1; k < n; ++k)
    if (const double dot = normal(k).dot(a); has_direction(dot) && dot * normal(k).dot(b) > 0)
      e = std::copysign(1, dot) * normal(k);
  const Vector<3> wanted[6] = {a, b, e - a - b, e - b, e - a, e};
  KernelDirections found;
  for (const Vector<3> &w : wanted)
    for (int k = 0; k < n; ++k)
      if (const double dot = normal(k).dot(w); std::abs(std::abs(dot) - 1) < 1e-12)
        found.push_back({k, dot < 0});
  return found.size() == 6 ? found : all;
}

/// 1 for particles of other materials than the first one and for their neighbours in it.
template <int dim>
std::vector<char> particles_off_lattice(const packings::Packing<dim> &packing,
                                        const Materials &materials)
{
  std::vector<char> off(packing.size(), 0);
  for (int i = 0; i < packing.size(); ++i)
    off[i] = materials.number(i) != 0;
  for (const auto &face : packing.faces)
    if (!face.cracked && materials.differ(face.i, face.j))
      off[face.i] = off[face.j] = 1;
  return off;
}
} // namespace

template <int dim>
Bond<dim> BondNetwork<dim>::make_bond(const packings::Face<dim> &face, const Materials &materials,
                                      double thickness)
{
  const double r = face.q_i + face.q_j;
  const DemMaterial &i = materials.of(face.i), &j = materials.of(face.j);
  const double share = face.q_i / r;
  return {face.i,
          face.j,
          face.normal,
          face.lever_i,
          face.lever_j,
          face.area,
          r,
          in_series(i.bending_stiffness<dim>(face.area, r, thickness),
                    j.bending_stiffness<dim>(face.area, r, thickness), share),
          in_series(i.twisting_stiffness(face.area, r), j.twisting_stiffness(face.area, r), share),
          1,
          i.shear_modulus(),
          j.shear_modulus(),
          materials.differ(face.i, face.j)};
}

template <int dim>
BondNetwork<dim>::BondNetwork(const packings::Packing<dim> &packing, const Materials &materials,
                              const PeriodicImages<dim> *images)
    : lattice_shear_modulus_(materials.base().shear_modulus()), mask_(packing.size(), 0)
{
  const DemMaterial &material = materials.base();
  const int n = packing.size(), n_dir = int(packing.directions.size());
  core::require(n_dir <= max_directions, "the packing has more lattice directions than supported");
  std::vector<int> place(n_dir); // of the packing's directions in directions_
  for (const auto &[index, reversed] : kernel_directions(packing.directions)) {
    const auto &d = packing.directions[index];
    place[index] = int(directions_.size());
    directions_.push_back({reversed ? Vector<dim>(-d.normal) : d.normal, d.area, d.distance,
                           material.bending_stiffness<dim>(d.area, d.distance, packing.thickness),
                           material.twisting_stiffness(d.area, d.distance)});
  }

  std::vector<std::array<int, 2 * max_directions>> offset(n);
  for (auto &o : offset)
    o.fill(0);
  const std::vector<char> off_lattice = particles_off_lattice(packing, materials);
  for (const auto &face : packing.faces) {
    if (face.cracked)
      continue;
    ++n_bonds_;
    const auto *const image = images ? images->of(face.image) : nullptr;
    const int direction =
        image || off_lattice[face.i] || off_lattice[face.j] ? -1 : lattice_direction(face, packing);
    if (direction < 0) {
      if (materials.differ(face.i, face.j))
        between_materials_.push_back(int(irregular_.size()));
      irregular_.push_back(make_bond(face, materials, packing.thickness));
      irregular_.back().image = image;
      continue;
    }
    const int k = place[direction];
    const bool along = face.normal.dot(directions_[k].normal) > 0;
    const int i = along ? face.i : face.j, j = along ? face.j : face.i;
    mask_[i] |= 1u << k;
    mask_[j] |= 1u << (n_dir + k);
    offset[i][k] = j - i;
    offset[j][n_dir + k] = i - j;
  }
  intact_.assign(irregular_.size(), 1);
  find_segments(offset);
  index_table();
}

template <int dim>
void BondNetwork<dim>::index_table()
{
  core::require(irregular_.size() <= std::size_t(std::numeric_limits<int>::max()) / 2,
                "/discrete_zone: the packing has more than 1e9 bonds off the lattice, which cannot "
                "be numbered; make the zone smaller or /discrete_zone/spacing larger");
  std::vector<int> n_bonds_of(n_particles(), 0);
  for (const auto &b : irregular_)
    ++n_bonds_of[b.i], ++n_bonds_of[b.j];
  at_table_.clear();
  first_irregular_ = {0};
  std::vector<int> next(n_particles());
  for (int i = 0; i < n_particles(); ++i)
    if (n_bonds_of[i] > 0) {
      at_table_.push_back(i);
      next[i] = first_irregular_.back();
      first_irregular_.push_back(next[i] + n_bonds_of[i]);
    }
  irregular_of_.resize(first_irregular_.back());
  for (std::size_t b = 0; b < irregular_.size(); ++b)
    irregular_of_[next[irregular_[b].i]++] = irregular_of_[next[irregular_[b].j]++] = int(b);
}

template <int dim>
void BondNetwork<dim>::set_weights(const std::vector<double> &weights)
{
  std::vector<BondId> leaving;
  for_each_bond([&](BondId id, const Bond<dim> &b) {
    if (id.direction >= 0 && (weights[b.i] != 1 || weights[b.j] != 1))
      leaving.push_back(id);
  });
  for (const BondId &id : leaving) {
    irregular_.push_back(bond(id));
    intact_.push_back(1);
    remove(id);
    ++n_bonds_;
  }
  for (Bond<dim> &b : irregular_) {
    b.weight = (weights[b.i] + weights[b.j]) / 2;
    b.bending *= b.weight;
    b.twist *= b.weight;
  }
  index_table();
}

template <int dim>
void BondNetwork<dim>::find_segments(const std::vector<std::array<int, 2 * max_directions>> &offset)
{
  const int n = n_particles(), n_slots = 2 * n_directions();
  std::array<int, 2 * max_directions> run{}; // offsets of the present run, 0 while not needed
  int begin = 0;
  const auto close = [&](int end) {
    RowSegment s{begin, end, {}, {}};
    for (int k = 0; k < n_directions(); ++k)
      s.forward[k] = run[k], s.backward[k] = run[n_directions() + k];
    segments_.push_back(s);
  };
  for (int i = 0; i < n; ++i) {
    auto merged = run;
    bool fits = true;
    for (int s = 0; s < n_slots && fits; ++s) {
      if (offset[i][s] != 0) {
        fits = run[s] == 0 || run[s] == offset[i][s];
        merged[s] = offset[i][s];
      }
      fits = fits && begin + merged[s] >= 0 && i + merged[s] < n;
    }
    if (!fits) {
      close(i);
      begin = i;
      merged = offset[i];
    }
    run = merged;
  }
  if (n > 0)
    close(n);
}

template <int dim>
const RowSegment &BondNetwork<dim>::segment_of(int particle) const
{
  return *(std::upper_bound(segments_.begin(), segments_.end(), particle,
                            [](int i, const RowSegment &s) { return i < s.begin; }) -
           1);
}

template <int dim>
Bond<dim> BondNetwork<dim>::lattice_bond(int i, int j, int direction) const
{
  const auto &d = directions_[direction];
  const Vector<dim> lever = d.distance / 2 * d.normal;
  return {i,
          j,
          d.normal,
          lever,
          -lever,
          d.area,
          d.distance,
          d.bending,
          d.twist,
          1,
          lattice_shear_modulus_,
          lattice_shear_modulus_};
}

template <int dim>
Bond<dim> BondNetwork<dim>::bond(const BondId &id) const
{
  if (id.direction < 0)
    return irregular_[id.index];
  const RowSegment &s = segment_of(id.index);
  return lattice_bond(id.index, id.index + s.forward[id.direction], id.direction);
}

template <int dim>
void BondNetwork<dim>::remove(const BondId &id)
{
  --n_bonds_;
  if (id.direction < 0) {
    intact_[id.index] = 0;
    return;
  }
  const Bond<dim> b = bond(id);
  mask_[b.i] &= ~(1u << id.direction);
  mask_[b.j] &= ~(1u << (n_directions() + id.direction));
}

template class BondNetwork<2>;
template class BondNetwork<3>;
} // namespace ligament::dem
