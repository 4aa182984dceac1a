// The overlap's particles as the time loop goes through them: 8 cells side by side, one per lane of
// a vector, and the two passes of a step.
#pragma once

#include "core/types.h"
#include "coupling/octet.h"

#include <array>
#include <vector>

namespace ligament::coupling
{
/// Members of the overlap, cell by cell: the k-th members of 8 cells make a slot. Each sum over a
/// cell's members stays in its lane.
template <int dim>
struct MemberLanes
{
  static constexpr int nc = 1 << dim; // nodes of a cell

  struct alignas(64) Slot
  {
    Octet value[nc];          // shape functions, 0 in idle lanes
    Octet mass, inverse_mass; // kg, 1/kg; 0 for pads and in idle lanes
    Octet damping;            // 1 - exp(-c_f dt)
    int particle[octet_size]; // idle lanes repeat another one's
    int n_members;            // idle lanes come last
  };
  struct Batch
  {
    int begin, end; // slots
    int n_cells;
    int node[nc][octet_size]; // near nodes
  };

  std::vector<Slot> slots;
  std::vector<Batch> batches;
};

/// First pass: w' = (1 - damping) w + dt f/m of the free members, forces and momenta to the nodes.
template <int dim>
struct FineKick
{
  std::array<const double *, dim> force; // of the particles, N
  double dt;                             // s
  const Octet *old_motion;               // w, m/s: dim per slot
  Octet *motion;                         // w'
  double *nodal_force;                   // += Phi^T f, dim per near node
  double *nodal_momentum;                // += Phi^T M w'
};

/// Second pass: w = w' - Phi x of the free members; v = Phi V + w of all.
template <int dim>
struct FineSplit
{
  const double *carried;              // x, m/s: dim per near node
  const double *coarse;               // V, m/s
  const Octet *old_motion;            // w before the step
  Octet *motion;                      // w' in, w out
  std::array<double *, dim> velocity; // of the particles, m/s
};

template <int dim>
void kick_members(const MemberLanes<dim> &members, const FineKick<dim> &kick);

/// Returns sum damping m w_old (w_old + w) over the members, in J: twice what the damper took.
template <int dim>
double split_members(const MemberLanes<dim> &members, const FineSplit<dim> &split);
} // namespace ligament::coupling
