// What observers ask of atoms: stresses, defects, and the state of the neighbour list.
#include "core/check.h"
#include "md/atom_force.h"

#include <algorithm>
#include <cmath>

namespace ligament::md
{
namespace
{
/// Nearest neighbours of an atom in the crystal.
int n_nearest(CrystalKind kind)
{
  return kind == CrystalKind::triangular ? 6 : kind == CrystalKind::fcc ? 12 : 8;
}
} // namespace

template <int dim>
void AtomForce<dim>::stresses(const Particles &atoms, Components<n_strains<dim>> &stress) const
{
  update_list(atoms);
  for (auto &component : stress)
    component.assign(atoms.size(), 0.);
  static constexpr int first[] = {0, 1, 2, 1, 0, 0}, second[] = {0, 1, 2, 2, 2, 1};
  for_each_tension(atoms, [&](const Bond<dim> &b, double tension) {
    for (int k = 0; k < n_strains<dim>; ++k) {
      const int r = dim == 2 && k == 2 ? 0 : first[k], c = dim == 2 && k == 2 ? 1 : second[k];
      const double half = tension / b.length * b.present[r] * b.present[c] / 2;
      stress[k][b.i] += half / atoms.volume[b.i];
      stress[k][b.j] += half / atoms.volume[b.j];
    }
  });
  for (std::size_t o = 0; o < edge_.open.size(); ++o) {
    const Matrix<dim> gradient = edge_.gradient(int(o));
    const Matrix<dim> kirchhoff =
        crystal_.stress(gradient) * (Matrix<dim>::Identity() + gradient).transpose();
    for (int k = 0; k < n_strains<dim>; ++k) {
      const int r = dim == 2 && k == 2 ? 0 : first[k], c = dim == 2 && k == 2 ? 1 : second[k];
      stress[k][edge_.open[o]] = kirchhoff(r, c);
    }
  }
}

template <int dim>
void AtomForce<dim>::for_each_face(
    const Particles &atoms, const std::function<void(const particles::FaceView<dim> &)> &visit,
    const std::vector<int> *of) const
{
  const double area = parted_.area();
  const auto is_asked = [&](int i) { return !of || std::binary_search(of->begin(), of->end(), i); };
  const auto both_sides = [&](const Bond<dim> &b, bool is_parted) {
    const Vector<dim> normal = b.reference.normalized(), half = b.reference / 2;
    if (is_asked(b.i))
      visit({b.i, b.j, normal, area, get(atoms.reference, b.i) + half, !is_parted});
    if (is_asked(b.j))
      visit({b.j, b.i, -normal, area, get(atoms.reference, b.j) - half, !is_parted});
  };
  parted_.for_each_bond(both_sides);
  for (const Bond<dim> &b : cut_)
    both_sides(b, true);
}

template <int dim>
double AtomForce<dim>::shell_limit() const
{
  const CrystalKind kind = crystal_.parameters().kind;
  const double next = kind == CrystalKind::triangular ? std::sqrt(3.)
                      : kind == CrystalKind::fcc      ? std::sqrt(2.)
                                                      : std::sqrt(8 / 3.);
  const double last = kind == CrystalKind::bcc ? std::sqrt(4 / 3.) : 1;
  return (last + next) / 2 * crystal_.spacing();
}

template <int dim>
std::vector<std::vector<Vector<dim>>> AtomForce<dim>::neighbours(const Particles &atoms,
                                                                 double reach) const
{
  update_list(atoms);
  core::require(reach <= list_.cutoff() + list_.skin() / 2,
                "neighbours farther than the potential sees are not known");
  std::vector<std::vector<Vector<dim>>> found(atoms.size());
  for_each_bond<dim>(list_, atoms, body_.period, false, [&](const Bond<dim> &b) {
    if (b.length < reach) {
      found[b.i].push_back(b.present);
      found[b.j].push_back(-b.present);
    }
  });
  return found;
}

template <int dim>
std::vector<double> AtomForce<dim>::centro_symmetry(const Particles &atoms) const
{
  const int n = n_nearest(crystal_.parameters().kind);
  auto near = neighbours(atoms, std::min(2 * crystal_.spacing(), list_.cutoff()));
  std::vector<double> symmetry(atoms.size(), 0.);
  const double scale = 1 / (crystal_.spacing() * crystal_.spacing());
  for (int i = 0; i < atoms.size(); ++i) {
    auto &x = near[i];
    std::sort(x.begin(), x.end(),
              [](const auto &a, const auto &b) { return a.squaredNorm() < b.squaredNorm(); });
    x.resize(std::min<std::size_t>(x.size(), n));
    std::vector<double> sums;
    for (std::size_t a = 0; a < x.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        sums.push_back((x[a] + x[b]).squaredNorm() * scale);
    std::sort(sums.begin(), sums.end());
    for (std::size_t k = 0; k < sums.size() && int(k) < n / 2; ++k)
      symmetry[i] += sums[k];
    symmetry[i] += double(n - int(x.size())); // each one that is missing counts 1
  }
  for (const int i : edge_.open)
    symmetry[i] = 0;
  return symmetry;
}

template <int dim>
int AtomForce<dim>::coordination_of_crystal() const
{
  const CrystalKind kind = crystal_.parameters().kind;
  return kind == CrystalKind::triangular ? 6 : kind == CrystalKind::fcc ? 12 : 14;
}

template <int dim>
std::vector<int> AtomForce<dim>::count_neighbours(const Particles &atoms) const
{
  std::vector<int> numbers(atoms.size(), 0);
  const double reach = shell_limit();
  for_each_present_bond(atoms, false, [&](const Bond<dim> &b) {
    numbers[b.i] += b.length < reach;
    numbers[b.j] += b.length < reach;
  });
  return numbers;
}

template <int dim>
std::vector<int> AtomForce<dim>::coordination(const Particles &atoms) const
{
  update_list(atoms);
  std::vector<int> numbers = count_neighbours(atoms);
  for (const int i : edge_.open)
    numbers[i] = coordination_of_crystal();
  return numbers;
}

template <int dim>
std::vector<char> AtomForce<dim>::at_crack_faces(const Particles &atoms) const
{
  const std::vector<int> numbers = coordination(atoms);
  std::vector<char> at(atoms.size());
  for (int i = 0; i < atoms.size(); ++i)
    at[i] = 4 * (whole_coordination_[i] - numbers[i]) >= coordination_of_crystal();
  return at;
}

template <int dim>
std::vector<std::string> AtomForce<dim>::symbols() const
{
  const Potential &potential = crystal_.potential();
  const int own = crystal_.parameters().species;
  std::vector<std::string> names = {potential.species(own).name};
  for (int a = 0; a < potential.n_species(); ++a)
    if (a != own)
      names.push_back(potential.species(a).name);
  return names;
}

template <int dim>
int AtomForce<dim>::material(int atom) const
{
  const int a = body_.species[atom], own = crystal_.parameters().species;
  return a == own ? 0 : a < own ? a + 1 : a;
}

template <int dim>
std::vector<particles::OwnField> AtomForce<dim>::own_fields(const Particles &atoms) const
{
  update_list(atoms);
  const std::vector<int> numbers = coordination(atoms);
  return {{"potential_energy", energies(atoms)},
          {"centro_symmetry", centro_symmetry(atoms)},
          {"coordination", {numbers.begin(), numbers.end()}}};
}

// The list decides about the order of sums: it is built anew where it was built.
template <int dim>
void AtomForce<dim>::save(core::State &state, const core::Names &names,
                          const Particles &atoms) const
{
  loads_.save(state, names);
  parted_.save(state, atoms);
  if (list_is_reference_)
    return;
  core::Table table(names.sorted());
  names.save(table, "displacement", built_);
  state["neighbour_list"] = std::move(table);
}

template <int dim>
void AtomForce<dim>::load(const core::State &state, const core::Names &names,
                          const Particles &atoms)
{
  list_is_reference_ = state.count("neighbour_list") == 0;
  for (auto &component : built_)
    component.assign(atoms.size(), 0.);
  if (!list_is_reference_)
    names.load(core::table(state, "neighbour_list"), "displacement", built_);
  list_.build<dim>(atoms.reference, built_);
  body_.screen.apply(list_);
  loads_.load(state, names, atoms);
  parted_.load(state, atoms);
  looked_build_ = list_.n_builds();
}

#define INSTANTIATE(dim)                                                                           \
  template void AtomForce<dim>::stresses(const Particles &, Components<n_strains<dim>> &) const;   \
  template double AtomForce<dim>::shell_limit() const;                                             \
  template std::vector<double> AtomForce<dim>::centro_symmetry(const Particles &) const;           \
  template std::vector<int> AtomForce<dim>::coordination(const Particles &) const;                 \
  template std::vector<int> AtomForce<dim>::count_neighbours(const Particles &) const;             \
  template std::vector<char> AtomForce<dim>::at_crack_faces(const Particles &) const;              \
  template std::vector<std::string> AtomForce<dim>::symbols() const;                               \
  template int AtomForce<dim>::material(int) const;                                                \
  template std::vector<particles::OwnField> AtomForce<dim>::own_fields(const Particles &) const;   \
  template void AtomForce<dim>::for_each_face(                                                     \
      const Particles &, const std::function<void(const particles::FaceView<dim> &)> &,            \
      const std::vector<int> *) const;                                                             \
  template void AtomForce<dim>::save(core::State &, const core::Names &, const Particles &) const; \
  template void AtomForce<dim>::load(const core::State &, const core::Names &, const Particles &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace ligament::md
