// The overlap's particles as the time loop goes through them: 8 cells side by side, one per lane of
// a vector, and the two passes of a step.
#pragma once

#include "core/types.h"
#include "coupling/algebra/lane_array.h"

#include <array>
#include <vector>

namespace ligament::coupling
{
/// Members of the overlap, cell by cell: the k-th members of 8 cells make a slot. Each sum over a
/// cell's members stays in its lane.
template <int dim>
struct MemberBatches
{
  static constexpr int nc = 1 << dim; // nodes of a cell

  struct alignas(64) Slot
  {
    LaneArray value[nc];            // shape functions, 0 in idle lanes
    LaneArray mass;                 // kg; 0 for pads and in idle lanes
    float damping[lane_array_size]; // 1 - exp(-c_f dt)
    int particle[lane_array_size];  // idle lanes come last and repeat another one's
  };
  struct Batch
  {
    int begin, end; // slots
    int n_cells;
    int node[nc][lane_array_size]; // near nodes
  };

  std::vector<Slot> slots;
  std::vector<int> n_members; // of each slot
  std::vector<Batch> batches;
};

/// What the first pass sums over the members of a cell for its nodes.
enum MemberSum
{
  force_sum,    // Phi^T f
  momentum_sum, // Phi^T M w'
  loss_sum,     // Phi^T M damping (w + w')
  n_member_sums
};

/// First pass, theory.md eq. (C19): w' = (1 - damping) w + (1 - damping/2) dt f/m of the free
/// members; forces, momenta and what the damper takes of the momentum, summed cell by cell.
template <int dim>
struct FineKick
{
  std::array<const double *, dim> force; // of the particles, N
  double dt;                             // s
  LaneArray *motion;                     // w in, w' out, m/s: dim per slot
  LaneArray *sums;                       // out, per batch: n_member_sums x dim x nodes of a cell
  LaneArray *cell_loss; // out, per batch: sum damping/(2 - damping) m (w + w')^2, J
};

/// Second pass: w = w' - (1 - damping/2) Phi x of the free members; v = Phi V + w of all.
template <int dim>
struct FineSplit
{
  const double *carried;              // x, m/s: dim per near node
  const double *coarse;               // V, m/s
  LaneArray *motion;                  // w' in, w out
  std::array<double *, dim> velocity; // of the particles, m/s
};

/// What it sums in a lane belongs to one cell: it doesn't depend on what the other lanes hold.
template <int dim>
void kick_members(const MemberBatches<dim> &members, const FineKick<dim> &kick);

template <int dim>
void split_members(const MemberBatches<dim> &members, const FineSplit<dim> &split);
} // namespace ligament::coupling
