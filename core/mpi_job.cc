#include "core/mpi_job.h"

#include "core/check.h"

#include <fmt/format.h>

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <climits>
#include <cstdio>
#include <numeric>

namespace ligament::core
{
namespace
{
/// Counts of MPI are ints.
int count(std::size_t bytes)
{
  require<EnvironmentError>(bytes <= std::size_t(INT_MAX),
                            fmt::format("a message of {} bytes between ranks is too long for MPI; "
                                        "use more ranks, with fewer particles each",
                                        bytes));
  return int(bytes);
}

/// Errors end the job: MPI's own handler is left as it is.
class MpiCommunicator : public Communicator
{
public:
  MpiCommunicator()
  {
    MPI_Comm_dup(MPI_COMM_WORLD, &comm_);
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &size_);
  }
  ~MpiCommunicator() override
  {
    int ended = 0;
    MPI_Finalized(&ended);
    if (!ended)
      MPI_Comm_free(&comm_);
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void exchange(const std::vector<Outgoing> &out, const std::vector<Incoming> &in) override
  {
    const Timed timed(seconds_);
    constexpr int tag = 1;
    requests_.clear();
    for (const Incoming &m : in)
      MPI_Irecv(m.data, count(m.bytes), MPI_BYTE, m.from, tag, comm_, &requests_.emplace_back());
    for (const Outgoing &m : out)
      MPI_Isend(m.data, count(m.bytes), MPI_BYTE, m.to, tag, comm_, &requests_.emplace_back());
    MPI_Waitall(int(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  }

  void sum(std::int64_t *values, int n) override
  {
    const Timed timed(seconds_);
    MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_INT64_T, MPI_SUM, comm_);
  }
  void max(std::int64_t *values, int n) override
  {
    const Timed timed(seconds_);
    MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_INT64_T, MPI_MAX, comm_);
  }

  std::vector<std::vector<std::byte>> gather(const void *data, std::size_t bytes) override
  {
    const Timed timed(seconds_);
    const int own = count(bytes);
    std::vector<int> counts(size_), places(size_);
    MPI_Allgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
    const std::size_t total =
        std::accumulate(counts.begin(), counts.end(), std::size_t(0),
                        [](std::size_t sum, int n) { return sum + std::size_t(n); });
    std::vector<std::byte> all(std::size_t(count(total)));
    std::partial_sum(counts.begin(), counts.end() - 1, places.begin() + 1);
    if (total > 0)
      MPI_Allgatherv(data, own, MPI_BYTE, all.data(), counts.data(), places.data(), MPI_BYTE,
                     comm_);
    std::vector<std::vector<std::byte>> parts;
    for (int r = 0; r < size_; ++r)
      parts.emplace_back(all.begin() + places[r], all.begin() + places[r] + counts[r]);
    return parts;
  }

  double seconds() const override { return seconds_; }

  [[noreturn]] void abort(const std::string &reason, int exit_code) override
  {
    if (!reason.empty())
      fmt::print(stderr, "rank {}: {}\n", rank_, reason);
    std::fflush(stderr);
    MPI_Abort(comm_, exit_code);
    std::_Exit(exit_code);
  }

private:
  /// Adds the time until it ends.
  class Timed
  {
  public:
    explicit Timed(double &sum) : sum_(sum), begun_(MPI_Wtime()) {}
    ~Timed() { sum_ += MPI_Wtime() - begun_; }

  private:
    double &sum_;
    const double begun_;
  };

  MPI_Comm comm_;
  int rank_ = 0, size_ = 1;
  double seconds_ = 0;
  std::vector<MPI_Request> requests_;
};
} // namespace

MpiJob::MpiJob()
{
  int threads = 0;
  require<EnvironmentError>(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &threads) ==
                                MPI_SUCCESS,
                            "MPI doesn't start");
}

MpiJob::~MpiJob()
{
  MPI_Finalize();
}

Ranks MpiJob::ranks() const
{
  return Ranks(std::make_shared<MpiCommunicator>());
}
} // namespace ligament::core
