#include "algebra/parallel_multigrid.h"

#include "algebra/inert_unknowns.h"
#include "algebra/multigrid.h"
#include "algebra/multigrid_settings.h"
#include "algebra/raised_diagonal.h"
#include "core/check.h"

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <ml_utils.h>
#include <mpi.h>

#include <limits>
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
  std::vector<double> value;           // block_size^2 of each block, row-major
  Eigen::MatrixXd modes;               // of its unknowns

  int n_unknowns() const { return int(row_start.size() - 1) * block_size; }
};

Piece cut(const BlockMatrix &matrix, const Eigen::MatrixXd &modes, int rank, int n_ranks)
{
  const int b = matrix.block_size(), begin = first_row(matrix.n_rows(), rank, n_ranks),
            end = first_row(matrix.n_rows(), rank + 1, n_ranks);
  const auto &start = matrix.row_start();
  Piece piece;
  piece.block_size = b;
  piece.n_all = matrix.n_unknowns();
  for (int row = begin; row <= end; ++row)
    piece.row_start.push_back(start[row] - start[begin]);
  piece.column.assign(matrix.column().begin() + start[begin], matrix.column().begin() + start[end]);
  piece.value.assign(matrix.value() + start[begin] * b * b, matrix.value() + start[end] * b * b);
  piece.modes = modes.middleRows(std::int64_t(begin) * b, std::int64_t(end - begin) * b);
  return piece;
}

/// `visit(data, bytes)` for each array of it, in one order.
template <typename P, typename Visit>
void for_each_array(P &piece, Visit &&visit)
{
  visit(piece.row_start.data(), piece.row_start.size() * sizeof(std::int64_t));
  visit(piece.column.data(), piece.column.size() * sizeof(int));
  visit(piece.value.data(), piece.value.size() * sizeof(double));
  visit(piece.modes.data(), std::size_t(piece.modes.size()) * sizeof(double));
}

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
  Piece piece;
  piece.block_size = int(of.block_size);
  piece.n_all = of.n_all;
  piece.row_start.resize(std::size_t(of.n_rows + 1));
  piece.column.resize(std::size_t(of.n_blocks));
  piece.value.resize(std::size_t(of.n_blocks * of.block_size * of.block_size));
  piece.modes.resize(of.n_rows * of.block_size, of.n_modes);
  for_each_array(piece, [&](void *data, std::size_t bytes) {
    ranks.exchange({}, {{0, data, bytes}});
  });
  return piece;
}

std::unique_ptr<Epetra_CrsMatrix> epetra_matrix(const Piece &piece, const Epetra_Map &map)
{
  const int b = piece.block_size, n_rows = int(piece.row_start.size()) - 1;
  std::vector<int> n_entries;
  for (int row = 0; row < n_rows; ++row)
    n_entries.insert(n_entries.end(), b, b * int(piece.row_start[row + 1] - piece.row_start[row]));
  auto matrix = std::make_unique<Epetra_CrsMatrix>(Copy, map, n_entries.data(), true);
  std::vector<int> columns;
  std::vector<double> values;
  for (int unknown = 0; unknown < n_rows * b; ++unknown) {
    const int row = unknown / b, global = map.MinMyGID() + unknown;
    columns.clear();
    values.clear();
    for (auto k = piece.row_start[row]; k < piece.row_start[row + 1]; ++k)
      for (int c = 0; c < b; ++c) {
        const double entry = piece.value[std::size_t((k * b + unknown % b) * b + c)];
        columns.push_back(piece.column[std::size_t(k)] * b + c);
        values.push_back(columns.back() == global ? raised(entry) : entry);
      }
    const int failed =
        matrix->InsertGlobalValues(global, int(values.size()), values.data(), columns.data());
    core::require<core::EnvironmentError>(failed >= 0, "multigrid: Epetra takes no more entries");
  }
  core::require<core::EnvironmentError>(matrix->FillComplete() == 0,
                                        "multigrid: Epetra cannot share the matrix");
  return matrix;
}

/// One rank's part of the levels. All ranks make theirs and apply it together.
class Levels
{
public:
  explicit Levels(Piece piece)
      : communicator_(MPI_COMM_WORLD), map_(int(piece.n_all), piece.n_unknowns(), 0, communicator_),
        modes_(std::move(piece.modes)), matrix_(epetra_matrix(piece, map_)),
        levels_(*matrix_, multigrid_settings(piece.block_size, modes_), false)
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
  Epetra_Map map_;
  Eigen::MatrixXd modes_; // ML keeps a pointer
  std::unique_ptr<Epetra_CrsMatrix> matrix_;
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
      send(cut(matrix, modes, rank, ranks.size()), rank);
    levels_.emplace(cut(matrix, modes, 0, ranks.size()));
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
  void send(const Piece &piece, int rank) const
  {
    const Request request = {Task::make,
                             piece.n_all,
                             std::int64_t(piece.row_start.size()) - 1,
                             std::int64_t(piece.column.size()),
                             piece.block_size,
                             piece.modes.cols()};
    ranks_.exchange({{rank, &request, sizeof request}}, {});
    for_each_array(piece, [&](const void *data, std::size_t bytes) {
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
  core::require<core::EnvironmentError>(matrix.n_unknowns() < std::numeric_limits<int>::max(),
                                        "multigrid: too many unknowns");
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
