#include "core/ranks.h"

#include "core/check.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace ligament::core
{
void Ranks::exchange(const std::vector<Communicator::Outgoing> &out,
                     const std::vector<Communicator::Incoming> &in) const
{
  if (all_)
    all_->exchange(out, in);
}

ExactSum Ranks::sum(const ExactSum &part) const
{
  return all_ ? sum(std::vector<ExactSum>{part}).front() : part;
}

// Digits add up; what is no number is counted, kind by kind, lest two infinities make another.
std::vector<ExactSum> Ranks::sum(const std::vector<ExactSum> &parts) const
{
  if (!all_)
    return parts;
  constexpr int n_digits = ExactSum::n_digits, n_kinds = 3, n = n_digits + n_kinds;
  std::vector<std::int64_t> words;
  for (const ExactSum &part : parts) {
    const auto own = part.words();
    words.insert(words.end(), own.begin(), own.begin() + n_digits);
    for (int kind = 0; kind < n_kinds; ++kind)
      words.push_back(own.back() >> kind & 1);
  }
  all_->sum(words.data(), int(words.size()));
  std::vector<ExactSum> sums;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto first = words.begin() + std::ptrdiff_t(k) * n;
    std::vector<std::int64_t> own(first, first + n_digits + 1);
    own.back() = 0;
    for (int kind = 0; kind < n_kinds; ++kind)
      if (first[n_digits + kind] > 0)
        own.back() |= std::int64_t(1) << kind;
    sums.push_back(ExactSum::from_words(own));
  }
  return sums;
}

std::int64_t Ranks::sum(std::int64_t part) const
{
  if (all_)
    all_->sum(&part, 1);
  return part;
}

std::int64_t Ranks::max(std::int64_t here) const
{
  if (all_)
    all_->max(&here, 1);
  return here;
}

std::vector<std::int64_t> Ranks::max(std::vector<std::int64_t> here) const
{
  if (all_)
    all_->max(here.data(), int(here.size()));
  return here;
}

void Ranks::agree_on(const std::string &what, double value) const
{
  const auto all = gather_all(std::vector<double>{value});
  require(std::all_of(all.begin(), all.end(),
                      [&](double of) { return std::memcmp(&of, &all[0], sizeof(of)) == 0; }),
          what + " is not the same on all ranks: they have come apart");
}

void Ranks::abort(const std::string &reason, int exit_code) const
{
  require(!is_one(), "one process has no ranks to end: " + reason);
  all_->abort(reason, exit_code);
  std::abort(); // of a virtual function GCC does not believe that it never returns
}
} // namespace ligament::core
