#include "src/sweep/sweep.h"

#include "core/check.h"
#include "core/files.h"
#include "core/tell.h"
#include "core/version.h"
#include "src/output/format.h"
#include "src/output/run_record.h"

#include <fmt/format.h>

#include <sstream>

namespace ligament::program
{
namespace
{
/// The last line of a text that is not empty.
std::string last_line(const std::string &text)
{
  std::istringstream lines(text);
  std::string line, last;
  while (std::getline(lines, line))
    if (!line.empty())
      last = line;
  return last;
}

/// "error: " and what stands before it says nothing in a table.
std::string without_prefix(const std::string &line)
{
  const std::size_t at = line.find("error: ");
  return at == std::string::npos ? line : line.substr(at + 7);
}

/// The first error of the object that a program with --json leaves as its last line; empty without
/// one.
std::string first_error(const std::string &output)
{
  const auto json = nlohmann::json::parse(last_line(output), nullptr, false);
  const auto errors = json.is_object() ? json.find("errors") : json.end();
  if (errors == json.end() || !errors->is_array() || errors->empty())
    return "";
  const auto &first = errors->front();
  const std::string message = first.value("message", ""), reason = first.value("reason", "");
  return message + (reason.empty() ? "" : ": " + reason);
}

/// Why a child did not do its work.
std::string failure(const ChildEnd &end, const std::string &output, const std::string &errors)
{
  if (end.code == 128 + 9)
    return "killed: perhaps there is not enough memory";
  if (end.code > 128)
    return fmt::format("ended by signal {}", end.code - 128);
  // Where a scene is refused, the last line on standard error only counts.
  if (const std::string error = first_error(output); !error.empty())
    return error;
  const std::string line = last_line(errors);
  return line.empty() ? fmt::format("exit code {}", end.code) : without_prefix(line);
}
} // namespace

std::string to_string(CaseEnd::Status status)
{
  constexpr const char *names[] = {"done", "stopped", "refused", "failed"};
  return names[int(status)];
}

Sweep::Sweep(const CaseList &list, StudyFolder &folder, std::string solver, int jobs,
             std::FILE *progress)
    : list_(list), folder_(folder), solver_(std::move(solver)), jobs_(jobs), progress_(progress)
{
}

template <typename... Arguments>
void Sweep::say(const char *format, const Arguments &...arguments) const
{
  core::tell(progress_, fmt::format(fmt::runtime(format), arguments...) + "\n");
}

std::map<std::string, CaseEnd> Sweep::run()
{
  reuse();
  check();
  compute();
  return ends_;
}

void Sweep::reuse()
{
  std::map<std::string, bool> seen;
  std::size_t n_old = 0, n_other_version = 0;
  for (const Case &c : list_.cases) {
    if (!c.refused.empty() || seen[c.id])
      continue;
    seen[c.id] = true;
    const auto run = folder_.finished(scene_text(c.scene));
    if (!run) {
      open_.push_back(&c);
      continue;
    }
    const RunRecord record = read_run_record(run->record());
    ends_[c.id] = {record.status == "stopped" ? CaseEnd::Status::stopped : CaseEnd::Status::done,
                   record.reason, run, true};
    ++n_old;
    n_other_version += record.commit != core::commit();
  }
  if (n_old > 0)
    say("{} runs are finished already", n_old);
  if (n_other_version > 0)
    say("warning: {} of them by another version of the program; remove their folders to repeat "
        "them",
        n_other_version);
}

template <typename OnEnd>
void Sweep::process(const std::string &command, const std::vector<const Case *> &cases,
                    OnEnd on_end)
{
  ChildProcesses children;
  std::map<pid_t, const Case *> running;
  for (std::size_t next = 0; next < cases.size() || !running.empty();) {
    while (next < cases.size() && running.size() < std::size_t(jobs_)) {
      const Case &c = *cases[next++];
      const std::string scene = folder_.case_file(c.id, "scene.json");
      core::write_file(scene, c.scene.dump(2) + "\n");
      std::vector<std::string> words = {solver_, command, scene, "--json"};
      if (command == "check") // a study wants the time, and to know what is refused
        words.push_back("--full");
      if (command == "run")
        words.insert(words.end(), {"--output", folder_.new_run(c.id).path});
      running[children.start(words, folder_.case_file(c.id, command + ".out"),
                             folder_.case_file(c.id, command + ".err"))] = &c;
    }
    const ChildEnd end = children.wait();
    const Case &c = *running.at(end.id);
    running.erase(end.id);
    on_end(c, end);
  }
}

std::string Sweep::failure_of(const std::string &command, const Case &c, const ChildEnd &end) const
{
  return failure(end, core::read_file(folder_.case_file(c.id, command + ".out")),
                 core::read_file(folder_.case_file(c.id, command + ".err")));
}

void Sweep::check()
{
  if (open_.empty())
    return;
  say("checking {} cases", open_.size());
  process("check", open_, [this](const Case &c, const ChildEnd &end) { finish_check(c, end); });
  std::vector<const Case *> accepted;
  for (const Case *c : open_)
    if (predicted_.count(c->id))
      accepted.push_back(c);
  open_ = accepted;
}

void Sweep::finish_check(const Case &c, const ChildEnd &end)
{
  if (end.code == 0) {
    const std::string line = last_line(core::read_file(folder_.case_file(c.id, "check.out")));
    // Nothing is predicted of bodies too large to be built for it, and of runs with phases.
    const auto seconds = nlohmann::json::parse(line).at("predicted_seconds");
    predicted_[c.id] = seconds.is_number() ? seconds.get<double>() : 0;
    return;
  }
  const bool refused = end.code == 2 || end.code == 3;
  ends_[c.id] = {refused ? CaseEnd::Status::refused : CaseEnd::Status::failed,
                 failure_of("check", c, end),
                 {},
                 false};
  say("{}: {}: {}", c.name, to_string(ends_[c.id].status), ends_[c.id].reason);
}

void Sweep::compute()
{
  if (open_.empty())
    return;
  say("computing {} cases, {} at a time: about {}{}", open_.size(), jobs_,
      duration(seconds_to_go()),
      jobs_ > 1 ? "; runs that share a machine disturb their times" : "");
  process("run", open_, [this](const Case &c, const ChildEnd &end) { finish_run(c, end); });
}

void Sweep::finish_run(const Case &c, const ChildEnd &end)
{
  const RunFolder folder = folder_.new_run(c.id);
  CaseEnd &result = ends_[c.id];
  if (end.code == 0 || end.code == 3)
    folder_.look_at(folder);
  result.run = folder_.finished(scene_text(c.scene));
  if (result.run) {
    const RunRecord record = read_run_record(result.run->record());
    result.status = record.status == "stopped" ? CaseEnd::Status::stopped : CaseEnd::Status::done;
    result.reason = record.reason;
    write_cost(folder, {end.core_seconds, end.peak_memory, jobs_});
  } else
    result.reason = failure_of("run", c, end);
  ++n_computed_;
  spent_ += end.seconds;
  spent_predicted_ += predicted_.at(c.id);
  predicted_.erase(c.id);
  report(c, result, end.seconds);
}

void Sweep::report(const Case &c, const CaseEnd &end, double seconds)
{
  const bool last = n_computed_ == open_.size();
  say("[{}/{}] {}: {} in {}{}{}", n_computed_, open_.size(), c.name, to_string(end.status),
      duration(seconds), end.status == CaseEnd::Status::done ? "" : " (" + end.reason + ")",
      last ? "" : ", about " + duration(seconds_to_go()) + " to go");
}

/// By the predictions of check, corrected by how they came out so far. Two seconds stand for set-up
/// and pictures, which check does not predict.
double Sweep::seconds_to_go() const
{
  constexpr double around = 2;
  double open = 0;
  for (const auto &[id, seconds] : predicted_)
    open += seconds + around;
  const double factor =
      n_computed_ == 0 ? 1 : spent_ / (spent_predicted_ + around * double(n_computed_));
  return open * factor / jobs_;
}
} // namespace ligament::program
