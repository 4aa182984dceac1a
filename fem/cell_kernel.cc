#include "fem/cell_kernel.h"

#include "fem/cell_classes.h"
#include "fem/cell_map.h"

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
// As many general cells of one shape share a stiffness: below it lanes that idle cost more than
// reading a stiffness per cell (bench_far_field).
constexpr int fewest_equal = 4;

using Lanes = double __attribute__((vector_size(64), may_alias));
// Lanes at any double. A packed struct, as alignments of vector types get lost: Clang ignores them
// in an alias, GCC drops those of a typedef where a template names them.
struct __attribute__((packed, aligned(8), may_alias)) UnalignedLanes
{
  Lanes value;
};

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
  Lanes cell_u[n], cell_r[n];
  // What the last cell of a vector adds to the first node of the next one. Adding both sides of a
  // node in a register avoids overlapping writes, which would stall.
  Lanes carry[n_rows * dim] = {};
  int first = 0;
  for (; first + lanes <= run.n_cells; first += lanes) {
    for (int row = 0; row < n_rows; ++row)
      for (int c = 0; c < dim; ++c) {
        const double *p = u[c] + run.node[row] + first;
        cell_u[2 * row * dim + c] = reinterpret_cast<const UnalignedLanes *>(p)->value;
        cell_u[(2 * row + 1) * dim + c] = reinterpret_cast<const UnalignedLanes *>(p + 1)->value;
      }
    multiply<n>(k, cell_u, cell_r);
    for (int row = 0; row < n_rows; ++row)
      for (int c = 0; c < dim; ++c) {
        auto *p = reinterpret_cast<UnalignedLanes *>(f[c] + run.node[row] + first);
        const Lanes right = cell_r[(2 * row + 1) * dim + c];
        p->value -= cell_r[2 * row * dim + c] +
                    __builtin_shufflevector(right, carry[row * dim + c], 8, 0, 1, 2, 3, 4, 5, 6);
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

/// r = K u for one cell and one matrix per lane, of which the upper triangle is stored: rows four
/// at a time, their square on the diagonal first (row by row), then column by column. Each entry is
/// read once, in the order of memory: that is what takes the time.
template <int n>
LIGAMENT_INLINE void multiply_singles(const double (*__restrict k)[lanes],
                                      const Lanes *__restrict u, Lanes *__restrict r)
{
  for (int i = 0; i < n; ++i)
    r[i] = Lanes{};
  const auto *entry = reinterpret_cast<const Lanes *>(k);
  for (int i = 0; i < n; i += 4) {
    Lanes sum[4] = {r[i], r[i + 1], r[i + 2], r[i + 3]};
#pragma GCC unroll 4
    for (int a = 0; a < 4; ++a) {
      sum[a] += *entry++ * u[i + a];
#pragma GCC unroll 4
      for (int b = a + 1; b < 4; ++b) {
        const Lanes kab = *entry++;
        sum[a] += kab * u[i + b];
        sum[b] += kab * u[i + a];
      }
    }
    for (int j = i + 4; j < n; ++j) {
      Lanes right = r[j];
#pragma GCC unroll 4
      for (int a = 0; a < 4; ++a) {
        const Lanes kaj = *entry++;
        sum[a] += kaj * u[j];
        right += kaj * u[i + a];
      }
      r[j] = right;
    }
    for (int a = 0; a < 4; ++a)
      r[i + a] = sum[a];
  }
}

/// Where entry (i, j), i <= j, of the upper triangle is stored.
template <int n>
int triangle_index(int i, int j)
{
  const int first = i / 4 * 4;
  int index = 0;
  for (int row = 0; row < first; row += 4)
    index += 10 + 4 * (n - row - 4);
  if (j >= first + 4)
    return index + 10 + 4 * (j - first - 4) + i - first;
  for (int a = 0; a < i - first; ++a)
    index += 4 - a;
  return index + j - i;
}

template <int dim>
LIGAMENT_INLINE void subtract_singles(const typename CellKernel<dim>::SingleBatch &batch,
                                      const double *const *u, double *const *f)
{
  constexpr int n = CellKernel<dim>::n_dofs;
  alignas(64) double cell_u[n][lanes], cell_r[n][lanes];
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    for (int c = 0; c < dim; ++c)
      for (int l = 0; l < lanes; ++l)
        cell_u[a * dim + c][l] = u[c][batch.node[a][l]];
  multiply_singles<n>(reinterpret_cast<const double(*)[lanes]>(batch.stiffness.data()),
                      reinterpret_cast<const Lanes *>(cell_u), reinterpret_cast<Lanes *>(cell_r));
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

LIGAMENT_DISPATCH
void subtract_singles_2d(const CellKernel<2>::SingleBatch *batches, std::size_t n_batches,
                         const double *const *u, double *const *f)
{
  for (std::size_t i = 0; i < n_batches; ++i) {
    // Streams this short end before the processor sees them; those of 3D do not.
    const auto *next = reinterpret_cast<const char *>(batches + std::min(i + 1, n_batches - 1));
    for (std::size_t line = 0; line < sizeof(*batches); line += 64)
      __builtin_prefetch(next + line);
    subtract_singles<2>(batches[i], u, f);
  }
}

LIGAMENT_DISPATCH
void subtract_singles_3d(const CellKernel<3>::SingleBatch *batches, std::size_t n_batches,
                         const double *const *u, double *const *f)
{
  for (std::size_t i = 0; i < n_batches; ++i)
    subtract_singles<3>(batches[i], u, f);
}
} // namespace

template <int dim>
CellKernel<dim>::CellKernel(const Mesh<dim> &mesh, const Body<dim> &body,
                            const std::vector<char> &is_own)
{
  std::vector<std::vector<int>> cells_of_group;
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    if (!is_own[cell] || !mesh.is_box(cell))
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

  for (std::size_t group = 0; group < size_.size(); ++group)
    add_group(mesh, cell_stiffness<dim>(size_[group], body), cells_of_group[group]);
  if (!mesh.general.empty())
    add_general_cells(mesh, body, is_own);
}

template <int dim>
void CellKernel<dim>::add_group(const Mesh<dim> &mesh, const CellMatrix<dim> &k,
                                const std::vector<int> &cells)
{
  const int group = n_groups();
  stiffness_.emplace_back();
  for (int i = 0; i < n_dofs; ++i)
    for (int j = 0; j < n_dofs; ++j)
      stiffness_.back()[n_dofs * i + j] = k(i, j);

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

template <int dim>
void CellKernel<dim>::add_general_cells(const Mesh<dim> &mesh, const Body<dim> &body,
                                        const std::vector<char> &is_own)
{
  CellClasses<dim> classes;
  std::vector<std::vector<int>> cells_of_class;
  for (int cell = 0; cell < mesh.n_cells(); ++cell)
    if (is_own[cell] && !mesh.is_box(cell)) {
      const int number = classes.number(cell_corners(mesh, cell));
      cells_of_class.resize(classes.size());
      cells_of_class[number].push_back(cell);
    }
  for (const std::vector<int> &cells : cells_of_class) {
    const CellMatrix<dim> k = cell_stiffness(mesh, cells[0], body);
    const Vec<n_cell_nodes<dim>> mass = body.thickness * volume_shares(mesh, cells[0]);
    CellMatrix<dim> scaled;
    for (int i = 0; i < n_dofs; ++i)
      for (int j = 0; j < n_dofs; ++j)
        scaled(i, j) = k(i, j) / std::sqrt(mass[i / dim] * mass[j / dim]);
    stiffest_ = std::max(
        stiffest_, Eigen::SelfAdjointEigenSolver<CellMatrix<dim>>(scaled, Eigen::EigenvaluesOnly)
                       .eigenvalues()[n_dofs - 1]);
    if (int(cells.size()) >= fewest_equal)
      add_group(mesh, k, cells);
    else
      for (const int cell : cells)
        add_single(mesh.cells[cell], k);
  }
}

template <int dim>
void CellKernel<dim>::add_single(const std::array<int, n_cell_nodes<dim>> &nodes,
                                 const CellMatrix<dim> &k)
{
  if (singles_.empty() || singles_.back().n_cells == lanes) {
    singles_.emplace_back();
    SingleBatch &batch = singles_.back();
    batch.n_cells = 0;
    for (auto &entry : batch.stiffness)
      entry.fill(0);
    for (int a = 0; a < n_cell_nodes<dim>; ++a)
      batch.node[a].fill(nodes[a]); // idle lanes read some node
  }
  SingleBatch &batch = singles_.back();
  const int lane = batch.n_cells++;
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    batch.node[a][lane] = nodes[a];
  for (int i = 0; i < n_dofs; ++i)
    for (int j = i; j < n_dofs; ++j)
      batch.stiffness[triangle_index<n_dofs>(i, j)][lane] = k(i, j);
}

template <int dim>
int CellKernel<dim>::n_single_cells() const
{
  return singles_.empty() ? 0 : lanes * int(singles_.size() - 1) + singles_.back().n_cells;
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
  if (singles_.empty())
    return;
  if constexpr (dim == 2)
    subtract_singles_2d(singles_.data(), singles_.size(), u, f);
  else
    subtract_singles_3d(singles_.data(), singles_.size(), u, f);
}

template <int dim>
double CellKernel<dim>::stable_step(double density, double thickness) const
{
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t group = 0; group < size_.size(); ++group) {
    const Eigen::Map<const Eigen::Matrix<double, n_dofs, n_dofs>> k(stiffness_[group].data());
    const double largest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k, Eigen::EigenvaluesOnly)
                               .eigenvalues()[n_dofs - 1];
    const double mass = density * size_[group].prod() * thickness / n_cell_nodes<dim>;
    step = std::min(step, 2 * std::sqrt(mass / largest));
  }
  return stiffest_ > 0 ? std::min(step, 2 * std::sqrt(density / stiffest_)) : step;
}

template class CellKernel<2>;
template class CellKernel<3>;
} // namespace ligament::fem
