#include "fem/cell_kernel.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

// One binary serves all machines; the loader picks the version. The arithmetic is the same in each:
// multiplications and additions are never contracted.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__)
#define LIGAMENT_DISPATCH __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LIGAMENT_DISPATCH
#endif
#define LIGAMENT_INLINE __attribute__((always_inline)) inline

namespace ligament::fem
{
namespace
{
constexpr int lanes = 8;
constexpr int shortest_run = 6; // below it lanes would idle: better filled up in a batch

using Lanes = double __attribute__((vector_size(64), may_alias));
using LanesMask = long long __attribute__((vector_size(64)));
using UnalignedLanes = double __attribute__((vector_size(64), aligned(8), may_alias));

/// r = K u for one cell per lane.
template <int n>
LIGAMENT_INLINE void multiply(const double *__restrict k, const Lanes *__restrict u,
                              Lanes *__restrict r)
{
  for (int i = 0; i < n; ++i) {
    Lanes sum = k[n * i] * u[0];
#pragma GCC unroll 24
    for (int j = 1; j < n; ++j)
      sum += k[n * i + j] * u[j];
    r[i] = sum;
  }
}

template <int dim>
LIGAMENT_INLINE void subtract_run(const typename CellKernel<dim>::Run &run, const double *k,
                                  const double *const *u, double *const *f)
{
  constexpr int n = CellKernel<dim>::n_dofs, n_rows = CellKernel<dim>::n_rows;
  constexpr LanesMask shift = {8, 0, 1, 2, 3, 4, 5, 6};
  Lanes cell_u[n], cell_r[n];
  // What the last cell of a vector adds to the first node of the next one. Adding both sides of a
  // node in a register avoids overlapping writes, which would stall.
  Lanes carry[n_rows * dim] = {};
  int first = 0;
  for (; first + lanes <= run.n_cells; first += lanes) {
    for (int row = 0; row < n_rows; ++row)
      for (int c = 0; c < dim; ++c) {
        const double *p = u[c] + run.node[row] + first;
        cell_u[2 * row * dim + c] = *reinterpret_cast<const UnalignedLanes *>(p);
        cell_u[(2 * row + 1) * dim + c] = *reinterpret_cast<const UnalignedLanes *>(p + 1);
      }
    multiply<n>(k, cell_u, cell_r);
    for (int row = 0; row < n_rows; ++row)
      for (int c = 0; c < dim; ++c) {
        auto *p = reinterpret_cast<UnalignedLanes *>(f[c] + run.node[row] + first);
        const Lanes right = cell_r[(2 * row + 1) * dim + c];
        *p -= cell_r[2 * row * dim + c] + __builtin_shuffle(right, carry[row * dim + c], shift);
        carry[row * dim + c][0] = right[lanes - 1];
      }
  }
  const int rest = run.n_cells - first;
  if (rest > 0) {
    for (int i = 0; i < n; ++i)
      cell_u[i] = Lanes{};
    for (int row = 0; row < n_rows; ++row)
      for (int c = 0; c < dim; ++c)
        for (int l = 0; l < rest; ++l) {
          const double *p = u[c] + run.node[row] + first + l;
          cell_u[2 * row * dim + c][l] = p[0];
          cell_u[(2 * row + 1) * dim + c][l] = p[1];
        }
    multiply<n>(k, cell_u, cell_r);
  }
  for (int row = 0; row < n_rows; ++row)
    for (int c = 0; c < dim; ++c) {
      double *p = f[c] + run.node[row] + first;
      double from_left = carry[row * dim + c][0];
      for (int l = 0; l < rest; ++l) {
        p[l] -= cell_r[2 * row * dim + c][l] + from_left;
        from_left = cell_r[(2 * row + 1) * dim + c][l];
      }
      p[rest] -= from_left;
    }
}

template <int dim>
LIGAMENT_INLINE void subtract_batch(const typename CellKernel<dim>::Batch &batch, const double *k,
                                    const double *const *u, double *const *f)
{
  constexpr int n = CellKernel<dim>::n_dofs;
  alignas(64) double cell_u[n][lanes], cell_r[n][lanes];
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    for (int c = 0; c < dim; ++c)
      for (int l = 0; l < lanes; ++l) // idle lanes repeat the first cell
        cell_u[a * dim + c][l] = u[c][batch.node[a][l]];
  multiply<n>(k, reinterpret_cast<const Lanes *>(cell_u), reinterpret_cast<Lanes *>(cell_r));
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    for (int c = 0; c < dim; ++c)
      for (int l = 0; l < batch.n_cells; ++l)
        f[c][batch.node[a][l]] -= cell_r[a * dim + c][l];
}

template <int dim>
LIGAMENT_INLINE void subtract_all(const typename CellKernel<dim>::Run *runs, std::size_t n_runs,
                                  const typename CellKernel<dim>::Batch *batches,
                                  std::size_t n_batches, const double *stiffness,
                                  const double *const *u, double *const *f)
{
  constexpr int n = CellKernel<dim>::n_dofs;
  for (std::size_t i = 0; i < n_runs; ++i)
    subtract_run<dim>(runs[i], stiffness + n * n * runs[i].group, u, f);
  for (std::size_t i = 0; i < n_batches; ++i)
    subtract_batch<dim>(batches[i], stiffness + n * n * batches[i].group, u, f);
}

// Not templates: those cannot be cloned.
LIGAMENT_DISPATCH
void subtract_forces_2d(const CellKernel<2>::Run *runs, std::size_t n_runs,
                        const CellKernel<2>::Batch *batches, std::size_t n_batches,
                        const double *stiffness, const double *const *u, double *const *f)
{
  subtract_all<2>(runs, n_runs, batches, n_batches, stiffness, u, f);
}

LIGAMENT_DISPATCH
void subtract_forces_3d(const CellKernel<3>::Run *runs, std::size_t n_runs,
                        const CellKernel<3>::Batch *batches, std::size_t n_batches,
                        const double *stiffness, const double *const *u, double *const *f)
{
  subtract_all<3>(runs, n_runs, batches, n_batches, stiffness, u, f);
}
} // namespace

template <int dim>
CellKernel<dim>::CellKernel(const Mesh<dim> &mesh, const Stiffness<dim> &c, double thickness,
                            const std::vector<char> &is_own)
{
  std::vector<std::vector<int>> cells_of_group;
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    if (!is_own[cell])
      continue;
    const Vector<dim> &h = mesh.cell_size[cell];
    const auto same = std::find_if(size_.begin(), size_.end(), [&](const Vector<dim> &s) {
      return ((s - h).array().abs() <= 1e-12 * h.array()).all();
    });
    if (same == size_.end()) {
      size_.push_back(h);
      cells_of_group.emplace_back();
      cells_of_group.back().push_back(cell);
    } else
      cells_of_group[same - size_.begin()].push_back(cell);
  }

  for (int group = 0; group < n_groups(); ++group) {
    const auto k = cell_stiffness<dim>(size_[group], c, thickness);
    stiffness_.emplace_back();
    for (int i = 0; i < n_dofs; ++i)
      for (int j = 0; j < n_dofs; ++j)
        stiffness_.back()[n_dofs * i + j] = k(i, j);

    const std::vector<int> &cells = cells_of_group[group];
    const auto nodes = [&](std::size_t i) -> const auto &
    {
      return mesh.cells[cells[i]];
    };
    const auto is_next = [&](std::size_t i) { // does cell i continue the run of cell i - 1?
      for (int row = 0; row < n_rows; ++row)
        if (nodes(i)[2 * row] != nodes(i - 1)[2 * row + 1] ||
            nodes(i)[2 * row + 1] != nodes(i)[2 * row] + 1 ||
            nodes(i - 1)[2 * row + 1] != nodes(i - 1)[2 * row] + 1)
          return false;
      return true;
    };
    std::vector<std::size_t> loose;
    for (std::size_t begin = 0, end; begin < cells.size(); begin = end) {
      for (end = begin + 1; end < cells.size() && is_next(end);)
        ++end;
      if (end - begin >= shortest_run) {
        Run run{group, int(end - begin), {}};
        for (int row = 0; row < n_rows; ++row)
          run.node[row] = nodes(begin)[2 * row];
        runs_.push_back(run);
      } else
        for (std::size_t i = begin; i < end; ++i)
          loose.push_back(i);
    }
    for (std::size_t begin = 0; begin < loose.size(); begin += lanes) {
      Batch batch{group, int(std::min<std::size_t>(lanes, loose.size() - begin)), {}};
      for (int a = 0; a < n_cell_nodes<dim>; ++a)
        for (int l = 0; l < lanes; ++l)
          batch.node[a][l] = nodes(loose[begin + (l < batch.n_cells ? l : 0)])[a];
      batches_.push_back(batch);
    }
  }
}

template <int dim>
void CellKernel<dim>::subtract_forces(const Components<dim> &displacement,
                                      Components<dim> &force) const
{
  const double *u[dim];
  double *f[dim];
  for (int c = 0; c < dim; ++c) {
    u[c] = displacement[c].data();
    f[c] = force[c].data();
  }
  const double *k = stiffness_.empty() ? nullptr : stiffness_.front().data();
  if constexpr (dim == 2)
    subtract_forces_2d(runs_.data(), runs_.size(), batches_.data(), batches_.size(), k, u, f);
  else
    subtract_forces_3d(runs_.data(), runs_.size(), batches_.data(), batches_.size(), k, u, f);
}

template <int dim>
double CellKernel<dim>::stable_step(double density, double thickness) const
{
  double step = std::numeric_limits<double>::infinity();
  for (int group = 0; group < n_groups(); ++group) {
    const Eigen::Map<const Eigen::Matrix<double, n_dofs, n_dofs>> k(stiffness_[group].data());
    const double largest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k, Eigen::EigenvaluesOnly)
                               .eigenvalues()[n_dofs - 1];
    const double mass = density * size_[group].prod() * thickness / n_cell_nodes<dim>;
    step = std::min(step, 2 * std::sqrt(mass / largest));
  }
  return step;
}

template class CellKernel<2>;
template class CellKernel<3>;
} // namespace ligament::fem
