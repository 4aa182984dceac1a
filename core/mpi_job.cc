#include "core/mpi_job.h"

#include "core/check.h"

#include <fmt/format.h>

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>

namespace ligament::core
{
namespace
{
/// Calls visit(first byte, number of bytes) for pieces that MPI can count, in ints.
template <typename Visit>
void in_pieces(std::size_t bytes, std::size_t longest, Visit &&visit)
{
  for (std::size_t begin = 0; begin < bytes; begin += longest)
    visit(begin, int(std::min(longest, bytes - begin)));
}

/// Errors end the job: MPI's own handler is left as it is.
class MpiCommunicator : public Communicator
{
public:
  explicit MpiCommunicator(std::size_t longest) : longest_(longest)
  {
    require(0 < longest && longest <= std::size_t(INT_MAX), "MPI counts bytes in ints");
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
      in_pieces(m.bytes, longest_, [&](std::size_t at, int n) {
        MPI_Irecv(static_cast<std::byte *>(m.data) + at, n, MPI_BYTE, m.from, tag, comm_,
                  &requests_.emplace_back());
      });
    for (const Outgoing &m : out)
      in_pieces(m.bytes, longest_, [&](std::size_t at, int n) {
        MPI_Isend(static_cast<const std::byte *>(m.data) + at, n, MPI_BYTE, m.to, tag, comm_,
                  &requests_.emplace_back());
      });
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
    const std::uint64_t own = bytes;
    std::vector<std::uint64_t> sizes(size_);
    MPI_Allgather(&own, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, comm_);
    const std::uint64_t total = std::accumulate(sizes.begin(), sizes.end(), std::uint64_t(0));
    std::vector<std::vector<std::byte>> parts;
    if (total > longest_)
      for (int r = 0; r < size_; ++r) {
        std::vector<std::byte> &part = parts.emplace_back(sizes[r]);
        if (r == rank_ && bytes > 0)
          std::memcpy(part.data(), data, bytes);
        in_pieces(part.size(), longest_, [&](std::size_t at, int n) {
          MPI_Bcast(part.data() + at, n, MPI_BYTE, r, comm_);
        });
      }
    else {
      const std::vector<int> counts(sizes.begin(), sizes.end());
      std::vector<int> places(size_);
      std::partial_sum(counts.begin(), counts.end() - 1, places.begin() + 1);
      std::vector<std::byte> all(total);
      if (total > 0)
        MPI_Allgatherv(data, counts[rank_], MPI_BYTE, all.data(), counts.data(), places.data(),
                       MPI_BYTE, comm_);
      for (int r = 0; r < size_; ++r)
        parts.emplace_back(all.begin() + places[r], all.begin() + places[r] + counts[r]);
    }
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

  const std::size_t longest_; // bytes, of what MPI is given at once
  MPI_Comm comm_;
  int rank_ = 0, size_ = 1;
  double seconds_ = 0;
  std::vector<MPI_Request> requests_;
};
} // namespace

// Open MPI's ranks wait by asking again and again. One that doesn't let others run meanwhile keeps
// the rank that it waits for off its core wherever something else wants a core, too, and each
// message takes a time slice of the system. Letting them run costs nothing that could be measured
// where cores are idle (docs/scaling.md), and nobody knows at the start what else will run.
MpiJob::MpiJob()
{
  ::setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0); // what the user has set stays
  int threads = 0;
  require<EnvironmentError>(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &threads) ==
                                MPI_SUCCESS,
                            "MPI doesn't start");
}

MpiJob::~MpiJob()
{
  MPI_Finalize();
}

Ranks MpiJob::ranks(std::size_t longest_piece) const
{
  return Ranks(std::make_shared<MpiCommunicator>(longest_piece));
}
} // namespace ligament::core
