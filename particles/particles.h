// The state of all particles, whatever force moves them: public parallel arrays.
#pragma once

#include "core/names.h"
#include "core/types.h"
#include "particles/global_ids.h"

#include <vector>

namespace ligament::particles
{
/// Owned particles first, ghosts after. Total Lagrangian: reference centres, displacements and
/// orientations against the reference. Orientation: 2D one angle (rad, unwrapped); 3D a unit
/// quaternion (w, x, y, z). Held particles have infinite mass.
template <int dim>
struct Particles
{
  static constexpr int n_rotations = dim == 2 ? 1 : 4;

  int n_owned = 0;
  int n_ghosts = 0;

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

  int size() const { return n_owned + n_ghosts; }

  double inverse_mass(int i) const { return 1 / mass[i]; }       // 1/kg
  double inertia(int i) const { return gyration * mass[i]; }     // kg m^2
  double inverse_inertia(int i) const { return 1 / inertia(i); } // 1/(kg m^2)

  /// Calls visit(name, array) for every array; halo, output and checkpoint read this list.
  template <typename Visit>
  void for_each_array(Visit &&visit);

  /// The names of all particles.
  core::Names names() const { return core::Names(global_id.list()); }

  /// The motion as the table "particles". What has no row stays as it is.
  void save(core::State &state, const core::Names &names) const;
  void load(const core::State &state, const core::Names &names);

  /// n owned particles at rest, in the reference orientation, with zero mass, called 0 to n - 1.
  void resize(int n);
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
  components("rotation", rotation);
  components("velocity", velocity);
  components("spin", spin);
  components("force", force);
  components("torque", torque);
  visit("volume", volume);
  visit("mass", mass);
}

template <int dim>
void Particles<dim>::save(core::State &state, const core::Names &names) const
{
  core::Table table(names.sorted());
  names.save(table, "displacement", displacement);
  names.save(table, "rotation", rotation);
  names.save(table, "velocity", velocity);
  names.save(table, "spin", spin);
  state["particles"] = std::move(table);
}

template <int dim>
void Particles<dim>::load(const core::State &state, const core::Names &names)
{
  const core::Table &table = core::table(state, "particles");
  names.load(table, "displacement", displacement);
  names.load(table, "rotation", rotation);
  names.load(table, "velocity", velocity);
  names.load(table, "spin", spin);
}

template <int dim>
void Particles<dim>::resize(int n)
{
  n_owned = n;
  n_ghosts = 0;
  for_each_array([&](const char *, auto &array) { array.assign(n, 0); });
  if (dim == 3)
    rotation[0].assign(n, 1.);
  global_id = GlobalIds(n);
}
} // namespace ligament::particles
