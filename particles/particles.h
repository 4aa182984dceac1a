// The state of all particles, whatever force moves them: public parallel arrays.
#pragma once

#include "core/names.h"
#include "core/types.h"
#include "particles/global_ids.h"
#include "particles/part.h"

#include <vector>

namespace ligament::particles
{
/// In one order, which no process changes: rows of a lattice, places of seeds. Total Lagrangian:
/// reference centres, displacements and orientations against the reference. Orientation: 2D one
/// angle (rad, unwrapped); 3D a unit quaternion (w, x, y, z). Held particles have infinite mass.
/// Where nothing turns them they have no orientation: rotation, spin and torque are empty.
template <int dim>
struct Particles
{
  static constexpr int n_rotations = dim == 2 ? 1 : 4;

  Part part;         // what is whose: by default all is one's own
  bool turns = true; // else rotation, spin and torque are empty

  Components<dim> reference;        // m, centre in the reference configuration
  Components<dim> displacement;     // m
  Components<n_rotations> rotation; // rad (2D), unit quaternion (3D)
  Components<dim> velocity;         // m/s
  Components<n_spins<dim>> spin;    // rad/s, in space axes
  Components<dim> force;            // N
  Components<n_spins<dim>> torque;  // N m, in space axes
  std::vector<double> volume;       // m^3 (2D: area times thickness)
  std::vector<double> mass;         // kg
  double gyration = 1;              // m^2, inertia per mass, of all
  GlobalIds global_id;

  int size() const { return int(mass.size()); }

  double inverse_mass(int i) const { return 1 / mass[i]; }       // 1/kg
  double inertia(int i) const { return gyration * mass[i]; }     // kg m^2
  double inverse_inertia(int i) const { return 1 / inertia(i); } // 1/(kg m^2)

  /// Calls visit(name, array) for every array: those that resize() makes.
  template <typename Visit>
  void for_each_array(Visit &&visit);

  /// The names of all particles.
  core::Names names() const { return core::Names(global_id.list()); }

  /// The motion as the table "particles". What has no row stays as it is.
  void save(core::State &state, const core::Names &names) const;
  void load(const core::State &state, const core::Names &names);

  /// n particles at rest, in the reference orientation, with zero mass, called 0 to n - 1.
  void resize(int n);

  /// So called ones more at the end, at rest in the reference orientation, with zero mass; they
  /// belong to nobody's part.
  void append(const std::vector<std::int64_t> &names);

  /// From now on they have no orientation.
  void drop_orientations();
};

template <int dim>
template <typename Visit>
void Particles<dim>::for_each_array(Visit &&visit)
{
  const auto components = [&](const char *name, auto &arrays) {
    for (auto &array : arrays)
      visit(name, array);
  };
  components("reference", reference);
  components("displacement", displacement);
  if (turns)
    components("rotation", rotation);
  components("velocity", velocity);
  if (turns)
    components("spin", spin);
  components("force", force);
  if (turns)
    components("torque", torque);
  visit("volume", volume);
  visit("mass", mass);
}

template <int dim>
void Particles<dim>::save(core::State &state, const core::Names &names) const
{
  core::Table table(names.sorted());
  names.save(table, "displacement", displacement);
  names.save(table, "velocity", velocity);
  if (turns) {
    names.save(table, "rotation", rotation);
    names.save(table, "spin", spin);
  }
  state["particles"] = std::move(table);
}

template <int dim>
void Particles<dim>::load(const core::State &state, const core::Names &names)
{
  const core::Table &table = core::table(state, "particles");
  names.load(table, "displacement", displacement);
  names.load(table, "velocity", velocity);
  if (turns) {
    names.load(table, "rotation", rotation);
    names.load(table, "spin", spin);
  }
}

template <int dim>
void Particles<dim>::resize(int n)
{
  part = Part::whole(n);
  for_each_array([&](const char *, auto &array) { array.assign(n, 0); });
  if (dim == 3 && turns)
    rotation[0].assign(n, 1.);
  global_id = GlobalIds(n);
}

template <int dim>
void Particles<dim>::append(const std::vector<std::int64_t> &names)
{
  const int n = size();
  for_each_array([&](const char *, auto &array) { array.resize(n + int(names.size()), 0); });
  if (dim == 3 && turns)
    std::fill(rotation[0].begin() + n, rotation[0].end(), 1.);
  auto all = global_id.list();
  all.insert(all.end(), names.begin(), names.end());
  global_id = GlobalIds(all);
}

template <int dim>
void Particles<dim>::drop_orientations()
{
  turns = false;
  rotation = {};
  spin = {};
  torque = {};
}
} // namespace ligament::particles
