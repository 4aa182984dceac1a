#include "coupling/operators/patch_equations.h"

#include "core/check.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

namespace ligament::coupling
{
namespace
{
template <int dim, int ns>
StateForces<ns> gather(const PatchBlock<dim, ns> &block, const StateForces<ns> &field)
{
  StateForces<ns> local(ns, dim * block.nodes.size());
  for (std::size_t i = 0; i < block.nodes.size(); ++i)
    local.template middleCols<dim>(dim * i) = field.template middleCols<dim>(dim * block.nodes[i]);
  return local;
}

template <int dim, int ns>
void scatter(const PatchBlock<dim, ns> &block, const StateForces<ns> &local, StateForces<ns> &field)
{
  for (std::size_t i = 0; i < block.nodes.size(); ++i)
    field.template middleCols<dim>(dim * block.nodes[i]) += local.template middleCols<dim>(dim * i);
}

template <int ns>
StateMatrix<ns> symmetric_part(const StateMatrix<ns> &m)
{
  return (m + m.transpose()) / 2;
}

// The second level is the whole system in 2D, up to so many unknowns: its factors are small, and
// overlaps of a thousand cells have modes that are too slow for anything less. In 3D the factors
// would be nearly dense, and in overlaps that are too large it is one of multilinear hats.
template <int dim>
constexpr int most_unknowns_exact = dim == 2 ? 200000 : 0;
constexpr int most_unknowns_of_hats = 20000;

// Added to the diagonal, of it. Much smaller, and the modes that do nothing to any block, in which
// the right side is round-off, grow until the conjugate residuals lose the others; much larger,
// and the slow modes are left to the conjugate residuals.
template <int dim>
constexpr double coarse_shift = dim == 2 ? 1e-9 : 1e-6;

double dot(const Eigen::Ref<const Eigen::MatrixXd> &a, const Eigen::Ref<const Eigen::MatrixXd> &b)
{
  return a.cwiseProduct(b).sum();
}
} // namespace

template <int dim, int ns>
PatchEquations<dim, ns>::PatchEquations(std::vector<PatchBlock<dim, ns>> &blocks,
                                        const std::vector<Eigen::MatrixXd> &states,
                                        const Overlap<dim> &overlap)
    : blocks_(blocks)
{
  for (const auto &s : states)
    projectors_.push_back(s.cols() == ns  ? StateMatrix<ns>(StateMatrix<ns>::Identity())
                          : s.size() == 0 ? StateMatrix<ns>(StateMatrix<ns>::Zero())
                                          : StateMatrix<ns>(s * s.transpose()));
  diagonal_ = Eigen::VectorXd::Zero(states.size());
  for (const auto &block : blocks_)
    for (const int node : block.nodes)
      diagonal_[node] += std::pow(block.volume / block.length, 2);
  make_coarse_space(overlap);
}

template <int dim, int ns>
void PatchEquations<dim, ns>::restrict_to_states(Field &field) const
{
  for (std::size_t node = 0; node < projectors_.size(); ++node)
    field.template middleCols<dim>(dim * node) =
        (projectors_[node] * field.template middleCols<dim>(dim * node)).eval();
}

template <int dim, int ns>
void PatchEquations<dim, ns>::make_coarse_space(const Overlap<dim> &overlap)
{
  const int n = overlap.n_nodes();
  hats_.assign(n, {});
  n_hats_ = 0;
  for (int node = 0; node < n; ++node)
    if (diagonal_[node] > 0)
      hats_[node].emplace_back(n_hats_++, 1.);
  if (n_hats_ * dim * ns > most_unknowns_exact<dim>)
    make_hats(overlap);
  factorize_coarse_space();
}

// Hats on a grid four times coarser than the cells, coarser still where they would be too many:
// they hold the slow modes, those that are nearly affine over many blocks.
template <int dim, int ns>
void PatchEquations<dim, ns>::make_hats(const Overlap<dim> &overlap)
{
  const int n = overlap.n_nodes();
  Vector<dim> low = overlap.mesh.nodes[overlap.near_nodes[0]];
  for (const int node : overlap.near_nodes)
    low = low.cwiseMin(overlap.mesh.nodes[node]);
  for (double spacing = 4 * overlap.cell_size;; spacing *= 1.25) {
    std::map<std::array<int, 3>, int> numbers;
    hats_.assign(n, {});
    for (int node = 0; node < n; ++node) {
      if (diagonal_[node] == 0)
        continue;
      const Vector<dim> t = (overlap.mesh.nodes[overlap.near_nodes[node]] - low) / spacing;
      for (int j = 0; j < (1 << dim); ++j) {
        std::array<int, 3> place = {};
        double value = 1;
        for (int c = 0, rest = j; c < dim; ++c, rest /= 2) {
          const double f = t[c] - std::floor(t[c]);
          const double values[2] = {1 - f, f};
          place[c] = int(std::floor(t[c])) + rest % 2;
          value *= values[rest % 2];
        }
        if (value > 0)
          hats_[node].emplace_back(numbers.emplace(place, int(numbers.size())).first->second,
                                   value);
      }
    }
    n_hats_ = int(numbers.size());
    if (n_hats_ * dim * ns <= most_unknowns_of_hats)
      return;
  }
}

template <int dim, int ns>
void PatchEquations<dim, ns>::factorize_coarse_space()
{
  CoarseMatrix<dim * ns> sum(n_hats_);
  for (std::size_t node = 0; node < hats_.size(); ++node)
    for (const auto &[i, value_i] : hats_[node])
      for (const auto &[j, value_j] : hats_[node])
        if (i >= j)
          for (int c = 0; c < dim; ++c)
            sum.at(i, j).template block<ns, ns>(c * ns, c * ns) +=
                diagonal_[node] * value_i * value_j * projectors_[node];
  for (const auto &block : blocks_)
    add_coarse_share(block, sum);
  Eigen::SparseMatrix<double> matrix = sum.lower_half();
  // Rigid motions and some affine ones do nothing to any block: only they feel the shift.
  const Eigen::VectorXd diagonal = matrix.diagonal();
  coarse_scale_ = diagonal.cwiseMax(1e-12 * diagonal.maxCoeff()).cwiseSqrt().cwiseInverse();
  matrix = (coarse_scale_.asDiagonal() * matrix * coarse_scale_.asDiagonal()).eval();
  matrix.diagonal().array() += coarse_shift<dim>;
  coarse_.compute(matrix);
  core::require(coarse_.info() == Eigen::Success,
                "the patch fit's coarse equations are not positive definite");
}

template <int dim, int ns>
void PatchEquations<dim, ns>::add_coarse_share(const PatchBlock<dim, ns> &block,
                                               CoarseMatrix<dim * ns> &sum) const
{
  std::vector<int> used;
  for (const int node : block.nodes)
    for (const auto &[j, value] : hats_[node])
      if (std::find(used.begin(), used.end(), j) == used.end())
        used.push_back(j);
  if constexpr (ns == dim * dim)
    add_share_of_gradients(block, used, sum);
  else
    add_share_of_strains(block, used, sum);
}

template <int dim, int ns>
void PatchEquations<dim, ns>::add_share_of_strains(const PatchBlock<dim, ns> &block,
                                                   const std::vector<int> &used,
                                                   CoarseMatrix<dim * ns> &sum) const
{
  const auto &q = block.basis->homogeneous;
  const int nq = int(q.cols()), n_columns = int(used.size()) * dim * ns;
  // Column by column the homogeneous part of a hat's field, and its moduli.
  Eigen::MatrixXd parts = Eigen::MatrixXd::Zero(ns * nq, n_columns);
  for (std::size_t i = 0; i < block.nodes.size(); ++i)
    for (const auto &[j, value] : hats_[block.nodes[i]]) {
      const int first = int(std::find(used.begin(), used.end(), j) - used.begin()) * dim * ns;
      const StateMatrix<ns> states = value * projectors_[block.nodes[i]];
      for (int c = 0; c < dim; ++c)
        for (int m = 0; m < nq; ++m)
          parts.template block<ns, ns>(m * ns, first + c * ns) += q(i * dim + c, m) * states;
    }
  Eigen::MatrixXd moduli(ns * ns, n_columns);
  for (int k = 0; k < n_columns; ++k) {
    const Eigen::Map<const Eigen::MatrixXd> part(parts.col(k).data(), ns, nq);
    const StateMatrix<ns> s = symmetric_part<ns>(part * block.basis->strain);
    moduli.col(k) = Eigen::Map<const Eigen::VectorXd>(s.data(), ns * ns);
  }
  const double scale = block.volume / block.length;
  const Eigen::MatrixXd share = block.volume * block.volume * moduli.transpose() * moduli -
                                scale * scale * parts.transpose() * parts;
  for (std::size_t i = 0; i < used.size(); ++i)
    for (std::size_t j = 0; j < used.size(); ++j)
      if (used[i] >= used[j])
        sum.at(used[i], used[j]) +=
            share.template block<dim * ns, dim * ns>(i * dim * ns, j * dim * ns);
}

// Every node admits all gradients. A hat's field of component c and state k has then the
// homogeneous part e_k (x) q and the moduli sym(e_k (x) g), with rows q of the basis, g = q strain;
// products of two of these are (delta_kk' g.g' + g'_k g_k') / 2.
template <int dim, int ns>
void PatchEquations<dim, ns>::add_share_of_gradients(const PatchBlock<dim, ns> &block,
                                                     const std::vector<int> &used,
                                                     CoarseMatrix<dim * ns> &sum) const
{
  const auto &basis = *block.basis;
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(dim * used.size(), basis.homogeneous.cols());
  for (std::size_t i = 0; i < block.nodes.size(); ++i)
    for (const auto &[j, value] : hats_[block.nodes[i]]) {
      const int hat = int(std::find(used.begin(), used.end(), j) - used.begin());
      q.middleRows(dim * hat, dim) += value * basis.homogeneous.middleRows(dim * i, dim);
    }
  const Eigen::MatrixXd g = q * basis.strain;
  const double squared = block.volume * block.volume, scale = squared / std::pow(block.length, 2);
  const Eigen::MatrixXd diagonal = squared / 2 * g * g.transpose() - scale * q * q.transpose();
  for (std::size_t i = 0; i < used.size(); ++i)
    for (std::size_t j = 0; j < used.size(); ++j) {
      if (used[i] < used[j])
        continue;
      auto &whole = sum.at(used[i], used[j]);
      for (std::size_t a = 0; a < dim; ++a)
        for (std::size_t b = 0; b < dim; ++b) {
          auto part = whole.template block<ns, ns>(a * ns, b * ns);
          part += squared / 2 * g.row(dim * j + b).transpose() * g.row(dim * i + a);
          part.diagonal().array() += diagonal(dim * i + a, dim * j + b);
        }
    }
}

// G^T y added to the unknowns.
template <int dim, int ns>
void PatchEquations<dim, ns>::add_transposed(const Field &y)
{
  for (auto &block : blocks_) {
    const auto &q = block.basis->homogeneous;
    const Field local = gather(block, y), part = local * q;
    block.s += block.volume * block.volume * symmetric_part<ns>(part * block.basis->strain);
    block.h += std::pow(block.volume / block.length, 2) * (local - part * q.transpose());
  }
}

// G x.
template <int dim, int ns>
typename PatchEquations<dim, ns>::Field PatchEquations<dim, ns>::forces() const
{
  Field sum = Field::Zero(ns, dim * projectors_.size());
  for (const auto &block : blocks_) {
    const auto &basis = *block.basis;
    const Field homogeneous = block.s * basis.strain.transpose();
    scatter<dim, ns>(block, block.h + homogeneous * basis.homogeneous.transpose(), sum);
  }
  restrict_to_states(sum);
  return sum;
}

// G G^T y.
template <int dim, int ns>
typename PatchEquations<dim, ns>::Field PatchEquations<dim, ns>::apply(const Field &y) const
{
  Field sum(ns, y.cols());
  for (int node = 0; node < diagonal_.size(); ++node)
    sum.template middleCols<dim>(dim * node) =
        diagonal_[node] * y.template middleCols<dim>(dim * node);
  for (const auto &block : blocks_) {
    const auto &basis = *block.basis;
    const double scale = block.volume / block.length;
    const Field part = gather(block, y) * basis.homogeneous;
    const StateMatrix<ns> s = block.volume * block.volume * symmetric_part<ns>(part * basis.strain);
    const Field rest = s * basis.strain.transpose() - scale * scale * part;
    scatter<dim, ns>(block, rest * basis.homogeneous.transpose(), sum);
  }
  restrict_to_states(sum);
  return sum;
}

// Diagonal plus coarse level.
template <int dim, int ns>
typename PatchEquations<dim, ns>::Field PatchEquations<dim, ns>::precondition(const Field &r) const
{
  Eigen::VectorXd coarse = Eigen::VectorXd::Zero(n_hats_ * dim * ns);
  for (std::size_t node = 0; node < hats_.size(); ++node)
    for (const auto &[j, value] : hats_[node])
      for (int c = 0; c < dim; ++c)
        coarse.template segment<ns>((j * dim + c) * ns) += value * r.col(dim * node + c);
  // The second solve takes the shifted modes out again: what they hold is round-off.
  const Eigen::VectorXd once = coarse_.solve(coarse.cwiseProduct(coarse_scale_).eval());
  const Eigen::VectorXd twice = coarse_.solve(once);
  coarse = (once - coarse_shift<dim> * twice).cwiseProduct(coarse_scale_);
  Field z = Field::Zero(ns, r.cols());
  for (std::size_t node = 0; node < hats_.size(); ++node) {
    if (diagonal_[node] == 0)
      continue;
    for (int c = 0; c < dim; ++c) {
      auto column = z.col(dim * node + c);
      column = r.col(dim * node + c) / diagonal_[node];
      for (const auto &[j, value] : hats_[node])
        column += value * coarse.template segment<ns>((j * dim + c) * ns);
    }
  }
  restrict_to_states(z);
  return z;
}

// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983), whose residuals only fall:
// round-off within ten steps on the whole system, where conjugate gradients take hundreds. Of the
// modes that do nothing to any block the right side holds round-off, which makes the residuals of
// those jump by orders.
template <int dim, int ns>
typename PatchEquations<dim, ns>::Field
PatchEquations<dim, ns>::conjugate_residuals(const Field &right, double tolerance) const
{
  constexpr int patience = 10;         // steps without progress: round-off reached
  constexpr std::size_t most_kept = 5; // directions: one would do without rounding
  Field y = Field::Zero(ns, right.cols()), r = right;
  std::deque<std::pair<Field, Field>> kept; // directions and what they make
  const double goal = tolerance * r.norm();
  double mark = r.norm();
  for (int steps_without = 0; r.norm() > goal && steps_without < patience; ++steps_without) {
    Field p = precondition(r), ap = apply(p);
    for (const auto &[q, aq] : kept) {
      const double share = dot(ap, aq);
      p -= share * q;
      ap -= share * aq;
    }
    const double length = ap.norm();
    if (length == 0)
      break;
    p /= length;
    ap /= length;
    const double step = dot(r, ap);
    y += step * p;
    r -= step * ap;
    if (r.norm() < 0.9 * mark) {
      mark = r.norm();
      steps_without = 0;
    }
    kept.emplace_back(std::move(p), std::move(ap));
    if (kept.size() > most_kept)
      kept.pop_front();
  }
  return y;
}

// For right sides with a share in modes that do next to nothing to any block: the second level
// hides these, the answer is large, and residuals that have to fall come to a halt far above
// round-off.
template <int dim, int ns>
typename PatchEquations<dim, ns>::Field
PatchEquations<dim, ns>::conjugate_gradients(const Field &right, double tolerance) const
{
  constexpr int patience = 50; // iterations without progress: round-off reached
  Field y = Field::Zero(ns, right.cols()), r = right;
  Field z = precondition(r), p = z;
  double rz = dot(r, z);
  Field best_y = y;
  double best = r.norm();
  const double goal = tolerance * best;
  for (int i = 0, best_i = 0; best > goal && i < best_i + patience; ++i) {
    const Field ap = apply(p);
    const double step = rz / dot(p, ap);
    y += step * p;
    r -= step * ap;
    z = precondition(r);
    const double next = dot(r, z);
    p = z + next / rz * p;
    rz = next;
    if (const double norm = r.norm(); norm < 0.9 * best) {
      best = norm;
      best_i = i;
      best_y = y;
    }
  }
  return best_y;
}

template <int dim, int ns>
typename PatchEquations<dim, ns>::Field PatchEquations<dim, ns>::solve(const Field &right)
{
  const std::vector<PatchBlock<dim, ns>> none = blocks_;
  Field rest = refine(right, &PatchEquations::conjugate_residuals);
  if (rest.norm() > 1e-11 * right.norm()) { // far above round-off
    blocks_ = none;
    rest = refine(right, &PatchEquations::conjugate_gradients);
  }
  return rest;
}

// The normal equations lose digits that refinement on x itself brings back, up to what the sums of
// the right side have lost themselves.
template <int dim, int ns>
typename PatchEquations<dim, ns>::Field PatchEquations<dim, ns>::refine(const Field &right,
                                                                        Method method)
{
  Field rest = right;
  while (rest.norm() > 1e-13 * right.norm()) {
    const std::vector<PatchBlock<dim, ns>> before = blocks_;
    add_transposed((this->*method)(rest, 1e-6));
    const Field next = right - forces();
    const double gain = next.norm() / rest.norm();
    if (gain < 1)
      rest = next;
    else
      blocks_ = before;
    if (gain > 0.5)
      break;
  }
  return rest;
}

template class PatchEquations<2, n_strains<2>>;
template class PatchEquations<2, 4>;
template class PatchEquations<3, n_strains<3>>;
template class PatchEquations<3, 9>;
} // namespace ligament::coupling
