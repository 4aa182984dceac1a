#include "md/row_kernel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace ligament::md
{
namespace
{
constexpr int padding = 16;
/// Cut-offs: where empty sites lie, far out of everybody's range.
constexpr double nowhere = 1e9;
} // namespace

template <int dim>
RowKernel<dim>::RowKernel(const Crystal<dim> &crystal, const packings::Packing<dim> &packing,
                          int species, double reach)
    : rows_(crystal, packing, reach),
      table_(make_pair_table(crystal.potential(), species, species)),
      has_embedding_(crystal.potential().has_embedding()), cutoff_(crystal.potential().cutoff())
{
  if (!exists())
    return;
  columns_.assign(7 * (table_.size() + padding), 0.);
  for (std::size_t m = 0; m < table_.size(); ++m)
    for (int c = 0; c < 7; ++c)
      columns_[c * (table_.size() + padding) + m] =
          c < 3 ? table_[m].pull[c] : table_[m].density[c - 3];
  if (has_embedding_)
    embedding_ = crystal.potential().embedding_spline(species);
  const int n_runs = int(rows_.runs().size()), n = rows_.n_slots() + padding;
  schedule_ = PassSchedule(n_runs, [&](auto &&visit) {
    for (int r = 0; r < n_runs; ++r)
      for (const int other : rows_.reached(r))
        visit(r, other);
  });
  for (const Vector<dim> &bond : rows_.bonds())
    bonds_.insert(bonds_.end(), bond.data(), bond.data() + dim);
  for (int c = 0; c < dim; ++c) {
    displacement_[c].assign(n, nowhere * cutoff_);
    force_[c].assign(n, 0.);
  }
  density_.assign(n, 0.);
  slope_.assign(n, 0.);
  n_bonds_.assign(n_runs, int(rows_.bonds().size()));
  rest_.assign(n_runs, 0.);
  for (const RowRun &run : rows_.runs())
    place_.push_back(get(packing.centre, rows_.atoms()[run.first]));
  sample_places(packing);
}

// Along sides that repeat there is no gradient: images move as their atoms do.
template <int dim>
void RowKernel<dim>::sample_places(const packings::Packing<dim> &packing)
{
  mean_.setZero();
  for (int i = 0; i < packing.size(); i += std::max(1, packing.size() / 256))
    sample_.push_back(i);
  for (const int i : sample_)
    mean_ += get(packing.centre, i) / double(sample_.size());
  Matrix<dim> squares = Matrix<dim>::Zero();
  for (const int i : sample_) {
    from_mean_.push_back(get(packing.centre, i) - mean_);
    for (int c = 0; c < dim; ++c)
      if (packing.period[c] > 0)
        from_mean_.back()[c] = 0;
    squares += from_mean_.back() * from_mean_.back().transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix<dim>> solver(squares);
  inverse_squares_.setZero();
  for (int c = 0; c < dim; ++c)
    if (solver.eigenvalues()[c] > 1e-6 * solver.eigenvalues()[dim - 1])
      inverse_squares_ += solver.eigenvectors().col(c) * solver.eigenvectors().col(c).transpose() /
                          solver.eigenvalues()[c];
}

template <int dim>
typename RowKernel<dim>::Affine RowKernel<dim>::fit(const Components<dim> &displacement) const
{
  Affine a;
  a.base.setZero();
  a.gradient.setZero();
  for (std::size_t k = 0; k < sample_.size(); ++k) {
    const Vector<dim> u = get(displacement, sample_[k]);
    a.base += u / double(sample_.size());
    a.gradient += u * from_mean_[k].transpose();
  }
  a.gradient = (a.gradient * inverse_squares_).eval();
  a.base -= a.gradient * mean_;
  const Matrix<dim> f = Matrix<dim>::Identity() + a.gradient;
  const Eigen::SelfAdjointEigenSolver<Matrix<dim>> squares(f.transpose() * f,
                                                           Eigen::EigenvaluesOnly);
  a.least_stretch = std::sqrt(squares.eigenvalues()[0]);
  return a;
}

template <int dim>
void RowKernel<dim>::take_up(const Components<dim> &displacement)
{
  const std::vector<int> &atoms = rows_.atoms();
  for (const RowRun &run : rows_.runs())
    for (int c = 0; c < dim; ++c)
      for (int s = run.first; s < run.last; ++s)
        displacement_[c][s] = displacement[c][atoms[s]];
  for (const auto &image : rows_.images())
    for (int c = 0; c < dim; ++c)
      displacement_[c][image.slot] = displacement_[c][image.of];
}

template <int dim>
RowArrays RowKernel<dim>::arrays()
{
  RowArrays a = {};
  for (int c = 0; c < dim; ++c) {
    a.displacement[c] = displacement_[c].data();
    a.force[c] = force_[c].data();
  }
  a.density = density_.data();
  a.slope = slope_.data();
  a.bonds = bonds_.data();
  a.table = table_.data();
  a.columns = columns_.data();
  a.column_size = int(table_.size()) + padding;
  a.beyond2 = cutoff_ * cutoff_ * (1 + 1e-12);
  a.inverse_step = double(table_.size() - 1) / cutoff_;
  if (has_embedding_) {
    a.embedding = embedding_.pieces()[0].data();
    a.embedding_step = embedding_.step();
    a.n_embedding = double(embedding_.pieces().size());
  }
  return a;
}

template <int dim>
RowTask RowKernel<dim>::task(int run)
{
  return {rows_.runs()[run].first, rows_.runs()[run].last, rows_.shift(run), n_bonds_[run],
          nullptr};
}

template <int dim>
bool RowKernel<dim>::holds(const Components<dim> &displacement)
{
  if (!exists())
    return false;
  take_up(displacement);
  const Affine affine = fit(displacement);
  const Vector<dim> step = affine.gradient * rows_.along();
  const RowPasses passes = row_passes<dim>();
  const RowArrays k = arrays();
  const int n_runs = int(rows_.runs().size());
  double largest = 0;
  for (int r = 0; r < n_runs; ++r) {
    const Vector<dim> base = affine.base + affine.gradient * place_[r];
    rest_[r] = std::sqrt(passes.largest_rest(k, task(r), base.data(), step.data()));
    largest = std::max(largest, rest_[r]);
  }
  const auto &shells = rows_.shells();
  const double limit = cutoff_ * (1 + 1e-9); // wider than any rounding of places
  if (!(affine.least_stretch * shells.back().next - 2 * largest > limit))
    return false;
  for (int r = 0; r < n_runs; ++r) {
    double other = rest_[r];
    for (const int o : rows_.reached(r))
      other = std::max(other, rest_[o]);
    std::size_t s = 0;
    while (affine.least_stretch * shells[s].next - rest_[r] - other <= limit &&
           s + 1 < shells.size())
      ++s;
    n_bonds_[r] = shells[s].n_bonds;
  }
  return true;
}

template <int dim>
void RowKernel<dim>::fold(std::vector<double> &values, int run) const
{
  for (int m = rows_.image_begin()[run]; m < rows_.image_begin()[run + 1]; ++m)
    values[rows_.images()[m].of] += values[rows_.images()[m].slot];
}

template <int dim>
void RowKernel<dim>::compute(Components<dim> &force)
{
  const RowPasses passes = row_passes<dim>();
  const RowArrays k = arrays();
  for (auto &component : force_)
    std::fill(component.begin(), component.end(), 0.);
  const int n_runs = int(rows_.runs().size());
  if (has_embedding_) {
    std::fill(density_.begin(), density_.end(), 0.);
    const auto with_buffer = [&](int run, int buffer) {
      if (buffer >= int(between_.size()))
        between_.resize(buffer + 1);
      RowTask t = task(run);
      const std::size_t size = 2 * std::size_t(t.n_bonds) * (t.last - t.first + padding);
      if (between_[buffer].size() < size)
        between_[buffer].resize(size);
      t.between = between_[buffer].data();
      return t;
    };
    schedule_.run([&](int run, int buffer) { passes.first(k, with_buffer(run, buffer)); },
                  [&](int run) {
                    fold(density_, run);
                    passes.slopes(k, task(run));
                    for (int m = rows_.image_begin()[run]; m < rows_.image_begin()[run + 1]; ++m)
                      slope_[rows_.images()[m].slot] = slope_[rows_.images()[m].of];
                  },
                  [&](int run, int buffer) { passes.second(k, with_buffer(run, buffer)); });
  } else
    for (int r = 0; r < n_runs; ++r)
      passes.pairs(k, task(r));
  const std::vector<int> &atoms = rows_.atoms();
  for (int c = 0; c < dim; ++c)
    for (int r = 0; r < n_runs; ++r) {
      fold(force_[c], r);
      for (int s = rows_.runs()[r].first; s < rows_.runs()[r].last; ++s)
        force[c][atoms[s]] = force_[c][s];
    }
}

template class RowKernel<2>;
template class RowKernel<3>;
} // namespace ligament::md
