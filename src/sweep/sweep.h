// Computes the cases of a study that are not finished yet, each as a process of its own.
#pragma once

#include "src/sweep/cases.h"
#include "src/sweep/child_processes.h"
#include "src/sweep/study_folder.h"

#include <cstdio>
#include <map>

namespace ligament::program
{
/// What became of a scene.
struct CaseEnd
{
  enum class Status
  {
    done,
    stopped, // by the guard; a result too: its reason says what the run met
    refused, // by check
    failed   // ended by a signal or by the machine; done again next time
  };
  Status status = Status::failed;
  std::string reason;
  std::optional<RunFolder> run; // of done and stopped
  bool reused = false;          // it was finished before
};

std::string to_string(CaseEnd::Status status);

/// Runs what is missing: all cases are checked first, which also predicts their times; then they
/// run, `jobs` at the same time. By the id of the case.
class Sweep
{
public:
  /// `solver`: path of the program that computes. `progress` may be null.
  Sweep(const CaseList &list, StudyFolder &folder, std::string solver, int jobs,
        std::FILE *progress);
  std::map<std::string, CaseEnd> run();

private:
  void reuse();
  void check();
  void compute();
  template <typename OnEnd>
  void process(const std::string &command, const std::vector<const Case *> &cases, OnEnd on_end);
  void finish_check(const Case &c, const ChildEnd &end);
  void finish_run(const Case &c, const ChildEnd &end);
  /// Why `command` did not do its work for this case.
  std::string failure_of(const std::string &command, const Case &c, const ChildEnd &end) const;
  void report(const Case &c, const CaseEnd &end, double seconds);
  double seconds_to_go() const;
  template <typename... Arguments>
  void say(const char *format, const Arguments &...arguments) const;

  const CaseList &list_;
  StudyFolder &folder_;
  std::string solver_;
  int jobs_;
  std::FILE *progress_;
  std::map<std::string, CaseEnd> ends_;
  std::vector<const Case *> open_;          // to be computed, one of each scene
  std::map<std::string, double> predicted_; // s, of the open ones
  std::size_t n_computed_ = 0;
  double spent_ = 0, spent_predicted_ = 0; // s, of those computed
};
} // namespace ligament::program
