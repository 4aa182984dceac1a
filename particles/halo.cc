#include "particles/halo.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::particles
{
template <int dim>
template <typename P, typename Visit>
void Halo<dim>::for_each_sent(P &p, Visit &&visit)
{
  for (auto &component : p.displacement)
    visit(component);
  if (p.turns)
    for (auto &component : p.rotation)
      visit(component);
}

template <int dim>
Halo<dim>::Halo(const Owners &owners, const Particles<dim> &p, int first) : ranks_(owners.ranks)
{
  if (ranks_.is_one())
    return;
  core::require(int(owners.of.size()) == p.size(), "a halo needs the owner of every particle");
  const core::Names names = p.names();
  std::vector<std::vector<std::int64_t>> asked(ranks_.size());
  std::vector<std::vector<int>> ghosts(ranks_.size());
  for (const int i : names.ascending())
    if (i >= first && !owners.is_own(i)) {
      asked[owners.of[i]].push_back(names.name(i));
      ghosts[owners.of[i]].push_back(i);
    }
  const auto wanted = ranks_.deal(asked);
  std::int64_t n_unknown = 0;
  for (int r = 0; r < ranks_.size(); ++r) {
    Side side{r, {}, ghosts[r], {}, {}};
    for (const std::int64_t name : wanted[r]) {
      const int i = names.index(name);
      if (i >= 0 && owners.is_own(i))
        side.sent.push_back(i);
      else
        ++n_unknown;
    }
    if (!side.sent.empty() || !side.ghosts.empty())
      sides_.push_back(std::move(side));
  }
  n_unknown = ranks_.sum(n_unknown);
  core::require(n_unknown == 0,
                fmt::format("{} ghosts are not their owners': the parts of the body come from "
                            "different partitions",
                            n_unknown));
}

template <int dim>
void Halo<dim>::update(Particles<dim> &p)
{
  if (sides_.empty())
    return;
  std::vector<core::Communicator::Outgoing> out;
  std::vector<core::Communicator::Incoming> in;
  int n = 0;
  for_each_sent(p, [&](const auto &) { ++n; });
  for (Side &side : sides_) {
    side.out.resize(n * side.sent.size());
    double *to = side.out.data();
    for_each_sent(p, [&](const std::vector<double> &values) {
      for (const int i : side.sent)
        *to++ = values[i];
    });
    if (!side.sent.empty())
      out.push_back({side.rank, side.out.data(), side.out.size() * sizeof(double)});
    side.in.resize(n * side.ghosts.size());
    if (!side.ghosts.empty())
      in.push_back({side.rank, side.in.data(), side.in.size() * sizeof(double)});
  }
  ranks_.exchange(out, in);
  for (const Side &side : sides_) {
    const double *from = side.in.data();
    for_each_sent(p, [&](std::vector<double> &values) {
      for (const int i : side.ghosts)
        values[i] = *from++;
    });
  }
}

template <int dim>
int Halo<dim>::n_ghosts() const
{
  int n = 0;
  for (const Side &side : sides_)
    n += int(side.ghosts.size());
  return n;
}

template <int dim>
std::size_t Halo<dim>::bytes(const Particles<dim> &p) const
{
  std::size_t n = 0, n_sent = 0;
  for_each_sent(p, [&](const auto &) { ++n; });
  for (const Side &side : sides_)
    n_sent += side.sent.size();
  return n * n_sent * sizeof(double);
}

template class Halo<2>;
template class Halo<3>;
} // namespace ligament::particles
