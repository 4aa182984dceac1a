#include "algebra/parallel_multigrid.h"

#include "algebra/epetra_rows.h"
#include "algebra/inert_unknowns.h"
#include "algebra/multigrid.h"
#include "algebra/multigrid_settings.h"
#include "core/check.h"

#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <ml_utils.h>
#include <mpi.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>

namespace ligament::algebra
{
namespace
{
constexpr int least_rows = 1000; // of blocks, for each rank

enum class Task : std::int64_t
{
  dismiss,
  make,
  apply
};

/// What the first rank asks another one for, and how much comes behind that.
struct Request
{
  Task task = Task::dismiss;
  std::int64_t n_all = 0;    // unknowns, of all ranks
  std::int64_t n_rows = 0;   // of blocks, of that rank
  std::int64_t n_blocks = 0; // in these
  std::int64_t block_size = 1, n_modes = 0;
};

/// Where the block rows of a rank begin.
int first_row(int n_rows, int rank, int n_ranks)
{
  return int(std::int64_t(n_rows) * rank / n_ranks);
}

/// Contiguous block rows of a matrix.
struct Piece
{
  int block_size = 1;
  std::int64_t n_all = 0;              // unknowns, of all pieces
  std::vector<std::int64_t> row_start; // one more entry than block rows
  std::vector<int> column;             // of each block, in the whole matrix
  core::LargeArray value;              // block_size^2 of each block, row-major
  Eigen::MatrixXd modes;               // of its unknowns

  explicit Piece(const Request &of)
      : block_size(int(of.block_size)), n_all(of.n_all), row_start(std::size_t(of.n_rows + 1)),
        column(std::size_t(of.n_blocks)),
        value(std::size_t(of.n_blocks * of.block_size * of.block_size), true),
        modes(of.n_rows * of.block_size, of.n_modes)
  {
  }

  /// fill(data, bytes) for each of its arrays, in the order of Cut.
  template <typename Fill>
  void for_each_array(Fill &&fill)
  {
    const std::size_t n_values = column.size() * std::size_t(block_size * block_size);
    fill(row_start.data(), row_start.size() * sizeof(std::int64_t));
    fill(column.data(), column.size() * sizeof(int));
    fill(value.data(), n_values * sizeof(double));
    fill(modes.data(), std::size_t(modes.size()) * sizeof(double));
  }

  int n_rows() const { return int(row_start.size()) - 1; }
};

/// The same where it stands in the whole: arrays in place of copies.
class Cut
{
public:
  Cut(const BlockMatrix &matrix, const Eigen::MatrixXd &modes, int rank, int n_ranks)
      : matrix_(matrix), modes_(modes), begin_(first_row(matrix.n_rows(), rank, n_ranks)),
        end_(first_row(matrix.n_rows(), rank + 1, n_ranks))
  {
  }

  Request request() const
  {
    return {Task::make, matrix_.n_unknowns(), end_ - begin_,
            n_blocks(), matrix_.block_size(), modes_.cols()};
  }

  /// take(data, bytes) with each of its arrays.
  template <typename Take>
  void for_each_array(Take &&take) const
  {
    const int b = matrix_.block_size();
    const auto &start = matrix_.row_start();
    std::vector<std::int64_t> row_start(start.begin() + begin_, start.begin() + end_ + 1);
    for (std::int64_t &k : row_start)
      k -= start[begin_];
    const Eigen::MatrixXd modes =
        modes_.middleRows(std::int64_t(begin_) * b, std::int64_t(end_ - begin_) * b);
    take(row_start.data(), row_start.size() * sizeof(std::int64_t));
    take(matrix_.column().data() + start[begin_], std::size_t(n_blocks()) * sizeof(int));
    take(matrix_.value() + start[begin_] * b * b, std::size_t(n_blocks() * b * b) * sizeof(double));
    take(modes.data(), std::size_t(modes.size()) * sizeof(double));
  }

  std::int64_t n_blocks() const { return matrix_.row_start()[end_] - matrix_.row_start()[begin_]; }

private:
  const BlockMatrix &matrix_;
  const Eigen::MatrixXd &modes_;
  int begin_, end_;
};

/// From the first rank, the same for all others.
void ask(const core::Ranks &ranks, Task task)
{
  Request request;
  request.task = task;
  std::vector<core::Communicator::Outgoing> out;
  for (int rank = 1; rank < ranks.size(); ++rank)
    out.push_back({rank, &request, sizeof request});
  ranks.exchange(out, {});
}

Request next_request(const core::Ranks &ranks)
{
  Request request;
  ranks.exchange({}, {{0, &request, sizeof request}});
  return request;
}

Piece receive_piece(const core::Ranks &ranks, const Request &of)
{
  Piece piece(of);
  piece.for_each_array([&](void *data, std::size_t bytes) {
    ranks.exchange({}, {{0, data, bytes}});
  });
  return piece;
}

Piece copy_of(const Cut &cut)
{
  Piece piece(cut.request());
  std::vector<void *> to;
  piece.for_each_array([&](void *data, std::size_t) { to.push_back(data); });
  std::size_t k = 0;
  cut.for_each_array([&](const void *data, std::size_t bytes) {
    if (bytes > 0)
      std::memcpy(to[k], data, bytes);
    ++k;
  });
  return piece;
}

/// Numbers its columns as they are at hand: its own first, then others, which are returned by their
/// numbers in the whole.
std::vector<int> number_columns(Piece &piece, int first_row)
{
  const auto is_own = [&](int column) {
    return first_row <= column && column < first_row + piece.n_rows();
  };
  std::vector<int> others;
  for (const int column : piece.column)
    if (!is_own(column))
      others.push_back(column);
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  for (int &column : piece.column)
    column = is_own(column)
                 ? column - first_row
                 : piece.n_rows() +
                       int(std::lower_bound(others.begin(), others.end(), column) - others.begin());
  return others;
}

/// The unknowns of its columns, which it numbers.
Epetra_Map columns_of(Piece &piece, const Epetra_Map &rows)
{
  const int b = piece.block_size, first = rows.MinMyGID() / b;
  std::vector<int> unknowns(rows.NumMyElements());
  std::iota(unknowns.begin(), unknowns.end(), first * b);
  for (const int column : number_columns(piece, first))
    for (int c = 0; c < b; ++c)
      unknowns.push_back(column * b + c);
  return Epetra_Map(-1, int(unknowns.size()), unknowns.data(), 0, rows.Comm());
}

BlockMatrix matrix_of(Piece &piece)
{
  return BlockMatrix(piece.block_size, std::move(piece.row_start), std::move(piece.column),
                     std::move(piece.value));
}

/// One rank's part of the levels. All ranks make theirs and apply it together.
class Levels
{
public:
  explicit Levels(Piece piece)
      : communicator_(MPI_COMM_WORLD),
        map_(int(piece.n_all), piece.n_rows() * piece.block_size, 0, communicator_),
        columns_(columns_of(piece, map_)), modes_(std::move(piece.modes)),
        rows_(matrix_of(piece), map_, columns_),
        levels_(rows_, multigrid_settings(piece.block_size, modes_), false)
  {
    // Eigenvalues are estimated from a random vector on: the same matrix, the same levels.
    ML_set_random_seed(1);
    core::require<core::EnvironmentError>(levels_.ComputePreconditioner() == 0,
                                          "multigrid: ML cannot make its levels");
  }

  int n_unknowns() const { return map_.NumMyElements(); }

  void apply(const double *r, double *z) const
  {
    const Epetra_Vector right(View, map_, const_cast<double *>(r));
    Epetra_Vector result(View, map_, z);
    const int failed = levels_.ApplyInverse(right, result);
    core::require<core::EnvironmentError>(failed == 0, "multigrid: ML failed");
  }

private:
  Epetra_MpiComm communicator_;
  Epetra_Map map_, columns_;
  Eigen::MatrixXd modes_; // ML keeps a pointer
  EpetraRows rows_;
  ML_Epetra::MultiLevelPreconditioner levels_;
};

class ParallelMultigrid : public Preconditioner
{
public:
  ParallelMultigrid(const BlockMatrix &matrix, const Eigen::MatrixXd &modes,
                    const core::Ranks &ranks)
      : ranks_(ranks), inert_(matrix)
  {
    const int b = matrix.block_size();
    for (int rank = 0; rank <= ranks.size(); ++rank)
      begins_.push_back(std::int64_t(first_row(matrix.n_rows(), rank, ranks.size())) * b);
    for (int rank = 1; rank < ranks.size(); ++rank)
      send(Cut(matrix, modes, rank, ranks.size()), rank);
    levels_.emplace(copy_of(Cut(matrix, modes, 0, ranks.size())));
  }

  void apply(const Eigen::VectorXd &r, Eigen::VectorXd &z) const override
  {
    inert_.pass_by(r, z, [&](const Eigen::VectorXd &from, Eigen::VectorXd &to) {
      ask(ranks_, Task::apply);
      std::vector<core::Communicator::Outgoing> out;
      std::vector<core::Communicator::Incoming> in;
      for (int rank = 1; rank < ranks_.size(); ++rank) {
        const std::size_t bytes = std::size_t(begins_[rank + 1] - begins_[rank]) * sizeof(double);
        out.push_back({rank, from.data() + begins_[rank], bytes});
        in.push_back({rank, to.data() + begins_[rank], bytes});
      }
      ranks_.exchange(out, {});
      levels_->apply(from.data(), to.data());
      ranks_.exchange({}, in);
    });
  }

  const char *name() const override { return "parallel multigrid"; }

private:
  void send(const Cut &cut, int rank) const
  {
    const Request request = cut.request();
    ranks_.exchange({{rank, &request, sizeof request}}, {});
    cut.for_each_array([&](const void *data, std::size_t bytes) {
      ranks_.exchange({{rank, data, bytes}}, {});
    });
  }

  core::Ranks ranks_;
  InertUnknowns inert_;
  std::vector<std::int64_t> begins_; // of each rank's unknowns, and their end
  std::optional<Levels> levels_;
};
} // namespace

std::unique_ptr<Preconditioner> make_parallel_multigrid(const BlockMatrix &matrix,
                                                        const Eigen::MatrixXd &modes,
                                                        const core::Ranks &ranks)
{
  if (ranks.is_one() || matrix.n_rows() / ranks.size() < least_rows)
    return make_multigrid(matrix, modes);
  const std::int64_t block = matrix.block_size() * matrix.block_size();
  for (int rank = 0; rank < ranks.size(); ++rank)
    core::require<core::EnvironmentError>(
        std::max(Cut(matrix, modes, rank, ranks.size()).n_blocks() * block, matrix.n_unknowns()) <
            std::numeric_limits<int>::max(),
        "multigrid: too many unknowns; take more ranks");
  core::require(modes.rows() == matrix.n_unknowns() && modes.cols() > 0,
                "multigrid: the modes don't fit the matrix");
  return std::make_unique<ParallelMultigrid>(matrix, modes, ranks);
}

void serve_multigrid(const core::Ranks &ranks)
{
  std::optional<Levels> levels;
  while (true) {
    const Request request = next_request(ranks);
    switch (request.task) {
    case Task::dismiss:
      return;
    case Task::make:
      levels.reset();
      levels.emplace(receive_piece(ranks, request));
      break;
    case Task::apply: {
      Eigen::VectorXd r(levels->n_unknowns()), z(levels->n_unknowns());
      const std::size_t bytes = std::size_t(r.size()) * sizeof(double);
      ranks.exchange({}, {{0, r.data(), bytes}});
      levels->apply(r.data(), z.data());
      ranks.exchange({{0, z.data(), bytes}}, {});
      break;
    }
    }
  }
}

void dismiss_servers(const core::Ranks &ranks)
{
  if (!ranks.is_one())
    ask(ranks, Task::dismiss);
}
} // namespace ligament::algebra
