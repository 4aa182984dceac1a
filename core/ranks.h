// Processes that compute one body together, each a part of it: what they tell each other.
#pragma once

#include "core/exact_sum.h"

#include <cstddef>
#include <memory>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

namespace ligament::core
{
/// The messages themselves (core/mpi_job.h). All ranks make the same calls in the same order, but
/// for abort(). Whoever implements it ends the job where a message fails.
class Communicator
{
public:
  struct Outgoing
  {
    int to;
    const void *data;
    std::size_t bytes;
  };
  struct Incoming
  {
    int from;
    void *data;
    std::size_t bytes; // as many as are sent
  };

  virtual ~Communicator() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// At most one message from each rank to each; both sides know which.
  virtual void exchange(const std::vector<Outgoing> &out, const std::vector<Incoming> &in) = 0;
  /// Overwrites the values by their sums, or their largest ones, over the ranks.
  virtual void sum(std::int64_t *values, int n) = 0;
  virtual void max(std::int64_t *values, int n) = 0;
  /// What every rank gives, in the order of the ranks.
  virtual std::vector<std::vector<std::byte>> gather(const void *data, std::size_t bytes) = 0;
  /// That these calls have taken here so far, in s: most of it is waiting for others.
  virtual double seconds() const { return 0; }
  /// Ends all ranks.
  [[noreturn]] virtual void abort(const std::string &reason, int exit_code) = 0;
};

/// A value that parts are handed: one process by itself, which never sends anything, or the ranks
/// of a job. What it says is the same on all of them, to the last bit.
class Ranks
{
public:
  /// One process.
  Ranks() = default;
  explicit Ranks(std::shared_ptr<Communicator> all)
  {
    if (all && all->size() > 1)
      all_ = std::move(all);
  }

  int rank() const { return all_ ? all_->rank() : 0; }
  int size() const { return all_ ? all_->size() : 1; }
  bool is_one() const { return !all_; }
  /// In messages so far, in s.
  double waited() const { return all_ ? all_->seconds() : 0; }
  /// Of all of them it alone writes files and talks.
  bool is_first() const { return rank() == 0; }

  /// See Communicator. One process has nobody to write to.
  void exchange(const std::vector<Communicator::Outgoing> &out,
                const std::vector<Communicator::Incoming> &in) const;

  /// As if all terms had come on one rank.
  ExactSum sum(const ExactSum &part) const;
  /// One by one, in one message.
  std::vector<ExactSum> sum(const std::vector<ExactSum> &parts) const;
  std::int64_t sum(std::int64_t part) const;

  bool any(bool here) const { return max(std::int64_t(here)) != 0; }
  std::int64_t max(std::int64_t here) const;
  /// Value by value, in one message.
  std::vector<std::int64_t> max(std::vector<std::int64_t> here) const;

  /// What every rank has, in the order of the ranks; and all in one.
  template <typename T>
  std::vector<std::vector<T>> gather(const std::vector<T> &here) const;
  template <typename T>
  std::vector<T> gather_all(const std::vector<T> &here) const;

  /// The same on the first rank alone; the others get nothing.
  template <typename T>
  std::vector<T> gather_at_first(const std::vector<T> &here) const;

  /// What each rank wants of each other one: the k-th list of `to` goes to rank k; returns what
  /// came, by rank. For set-ups: all learn how many go where.
  template <typename T>
  std::vector<std::vector<T>> deal(const std::vector<std::vector<T>> &to) const;

  /// Throws core::InputError on every rank where `what` is not the same number on all of them.
  void agree_on(const std::string &what, double value) const;

  /// Ends all ranks; says why on standard error unless that is empty. Never to be called by one
  /// process.
  [[noreturn]] void abort(const std::string &reason, int exit_code) const;

private:
  std::shared_ptr<Communicator> all_; // null: one process
};

template <typename T>
std::vector<std::vector<T>> Ranks::gather(const std::vector<T> &here) const
{
  static_assert(std::is_trivially_copyable_v<T>);
  if (!all_)
    return {here};
  std::vector<std::vector<T>> found;
  for (const auto &bytes : all_->gather(here.data(), here.size() * sizeof(T))) {
    std::vector<T> &of = found.emplace_back(bytes.size() / sizeof(T));
    if (!of.empty())
      std::memcpy(static_cast<void *>(of.data()), bytes.data(), bytes.size());
  }
  return found;
}

template <typename T>
std::vector<T> Ranks::gather_all(const std::vector<T> &here) const
{
  std::vector<T> all;
  for (const auto &of : gather(here))
    all.insert(all.end(), of.begin(), of.end());
  return all;
}

template <typename T>
std::vector<T> Ranks::gather_at_first(const std::vector<T> &here) const
{
  static_assert(std::is_trivially_copyable_v<T>);
  if (!all_)
    return here;
  const auto sizes = gather_all(std::vector<std::int64_t>{std::int64_t(here.size())});
  if (!is_first()) {
    if (!here.empty())
      exchange({{0, here.data(), here.size() * sizeof(T)}}, {});
    return {};
  }
  std::vector<T> all = here;
  all.resize(std::size_t(std::accumulate(sizes.begin(), sizes.end(), std::int64_t(0))));
  std::vector<Communicator::Incoming> in;
  std::size_t at = here.size();
  for (int r = 1; r < size(); at += std::size_t(sizes[r++]))
    if (sizes[r] > 0)
      in.push_back({r, all.data() + at, std::size_t(sizes[r]) * sizeof(T)});
  exchange({}, in);
  return all;
}

template <typename T>
std::vector<std::vector<T>> Ranks::deal(const std::vector<std::vector<T>> &to) const
{
  static_assert(std::is_trivially_copyable_v<T>);
  if (!all_)
    return to;
  std::vector<std::int64_t> sizes;
  for (const auto &of : to)
    sizes.push_back(std::int64_t(of.size()));
  const auto all_sizes = gather(sizes);
  std::vector<std::vector<T>> come(size());
  std::vector<Communicator::Outgoing> out;
  std::vector<Communicator::Incoming> in;
  for (int k = 0; k < size(); ++k) {
    if (k == rank()) {
      come[k] = to[k];
      continue;
    }
    come[k].resize(std::size_t(all_sizes[k][rank()]));
    if (!come[k].empty())
      in.push_back({k, come[k].data(), come[k].size() * sizeof(T)});
    if (!to[k].empty())
      out.push_back({k, to[k].data(), to[k].size() * sizeof(T)});
  }
  exchange(out, in);
  return come;
}
} // namespace ligament::core
