// main() of GoogleTests that all ranks of a job run together: every rank runs every test, the first
// one reports, the others say what fails on them; all end with a failure when one has seen some.
#include "core/flush_denormals.h"
#include "core/mpi_job.h"
#include "tests/support/ranks.h"

#include <gtest/gtest.h>

namespace ligament::test
{
namespace
{
std::unique_ptr<core::Ranks> &all()
{
  static std::unique_ptr<core::Ranks> ranks;
  return ranks;
}

const core::MpiJob *job = nullptr;

class SayFailures : public ::testing::EmptyTestEventListener
{
  void OnTestPartResult(const ::testing::TestPartResult &result) override
  {
    if (result.failed())
      std::fprintf(stderr, "rank %d: %s:%d\n%s\n", ranks().rank(), result.file_name(),
                   result.line_number(), result.message());
  }
};
} // namespace

const core::Ranks &ranks()
{
  return *all();
}

core::Ranks ranks_in_pieces(std::size_t longest)
{
  return job->ranks(longest);
}
} // namespace ligament::test

int main(int argc, char **argv)
{
  using namespace ligament;
  core::flush_denormals();
  const core::MpiJob job;
  test::job = &job;
  test::all() = std::make_unique<core::Ranks>(job.ranks());
  ::testing::InitGoogleTest(&argc, argv);
  if (test::ranks().rank() > 0) {
    auto &listeners = ::testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new test::SayFailures);
  }
  const int failed = RUN_ALL_TESTS();
  const bool any = test::ranks().any(failed != 0);
  test::all().reset();
  return any ? 1 : 0;
}
