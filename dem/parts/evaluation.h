// One evaluation of the forces of a body: what it is asked for, and what it leaves behind.
#pragma once

#include "dem/bond_slices.h"
#include "dem/bonded_body.h"

#include <algorithm>
#include <optional>

namespace ligament::dem
{
/// Where to look for bonds that break.
struct BreakLook
{
  BreakScreen rows, table; // of lattice bonds, and of the others in terms of the first material's
  bool cleared_by_stress;  // what is noted by particle is asked again with its neighbours' stresses
  double share;            // of their limit, from which bonds are looked for
};

/// Where they were found: those that break are among the bonds of these particles.
struct NotedBonds
{
  std::vector<RowRange> rows; // of lattice bonds
  std::vector<int> table;     // of the others
  /// Of every such bond a particle whose own stress says so, theory.md eq. (D12d), is noted.
  bool own_terms = false;
};

/// Face by face costs nothing while few faces bear much, by particle a little always.
struct WayToLook
{
  bool by_particle = false;
  int since_face = 0, patience = 0; // steps by particle, and after how many faces are asked again

  /// After a step that looked at so many of n particles more closely.
  void choose(long n_looked, long n)
  {
    constexpr int many = 8, least = 64, most = 4096;
    if (by_particle) {
      by_particle = ++since_face < patience;
      return;
    }
    by_particle = many * n_looked > n;
    patience = by_particle ? std::clamp(2 * patience, least, most) : 0;
    since_face = 0;
  }
};

/// What acts on a particle.
template <int dim>
struct Wrench
{
  Vector<dim> force = Vector<dim>::Zero(); // N
  Spin<dim> torque = Spin<dim>::Zero();    // N m
};

/// What particles at faces between materials see while they answer, and what they were before.
template <int dim>
struct FlowingInterfaces
{
  using Tensor = Eigen::Matrix<double, n_tensor<dim>, 1>;

  std::vector<Eigen::Matrix<double, dim, dim>> of_surface; // of X: walls and loads, m^dim
  std::vector<Tensor> strain, viscous;                     // e, and what of it is viscous
  std::vector<std::array<Vector<dim>, 2>> whole;           // m, of the faces: Du on both sides
  std::vector<double> pressure;                            // Pa, at these strains
};

template <int dim>
struct Evaluation
{
  explicit Evaluation(const BondedBody<dim> &of) : body(of) {}

  const BondedBody<dim> &body;

  // Asked for.
  const particles::RestBlocks<dim> *rest = nullptr; // null: nothing is left out
  bool has_loads = true;                            // false: supports stand still, tractions vanish
  std::optional<BreakLook> look;
  bool may_flow = false;        // once, at a new time
  double *own_energy = nullptr; // J, of the particles: see InelasticSweep; null: not asked for

  // Left behind.
  std::vector<double> pressure;         // lambda_i theta_i, Pa
  std::vector<Vector<dim>> wall_forces; // N, on the particle of each wall
  std::vector<Vector<dim>> reactions;   // N, of each load on the body
  NotedBonds noted;
  std::optional<InelasticSweep<dim>> inelastic; // where a material flows
  FlowingInterfaces<dim> interfaces;            // the same

  // Carried from one to the next.
  WayToLook way;
  std::vector<double> other_pressures; // Pa, of the other particles before the rows'
  SliceNearness nearness;
  long nearness_version = -1; // of the ranges

  // Left behind: reactions on one's own particles, component by component, before they are rounded.
  std::vector<core::ExactSum> reaction_sums;

  /// What of these particles is passed over; null: all.
  const particles::AwakeRanges *ranges(const particles::Particles<dim> &p) const
  {
    if (rest && !rest->all_awake())
      return &rest->ranges();
    return p.part.is_whole(p.size()) ? nullptr : &p.part;
  }
  /// Whether particles have strains of their own.
  bool has_strains() const
  {
    return inelastic && std::any_of(inelastic->begun, inelastic->begun + inelastic->n_blocks,
                                    [](std::uint8_t begun) { return begun != 0; });
  }
  const InelasticSweep<dim> *sweep() const { return inelastic ? &*inelastic : nullptr; }

  LatticeArrays<dim> arrays(const particles::Particles<dim> &p)
  {
    LatticeArrays<dim> a{};
    for (int c = 0; c < dim; ++c)
      a.displacement[c] = p.displacement[c].data();
    for (int c = 0; c < a.n_rotations; ++c)
      a.rotation[c] = p.rotation[c].data();
    a.mask = body.bonds().mask().data();
    a.lambda_per_volume = body.lambda_per_volume().data();
    a.other_particles = &body.other_particles();
    a.pressure = pressure.data();
    return a;
  }
  LatticeArrays<dim> arrays_with_forces(particles::Particles<dim> &p)
  {
    LatticeArrays<dim> a = arrays(p);
    for (int c = 0; c < dim; ++c)
      a.force[c] = p.force[c].data();
    for (int c = 0; c < n_spins<dim>; ++c)
      a.torque[c] = p.torque[c].data();
    return a;
  }
};
} // namespace ligament::dem
