// The State of a body in parts: each rank has rows of it.
#pragma once

#include "core/ranks.h"
#include "core/state.h"

namespace ligament::core
{
/// That of the whole body, on all ranks: rows of all of them, sums of sums. Rows that several have
/// are the same on them, as are the columns of a table. Throws core::InputError on all ranks where
/// they are not.
State merged(const State &part, const Ranks &ranks);

/// The same on the first rank alone, which may throw; the others get nothing.
State merged_at_first(const State &part, const Ranks &ranks);

/// What a part takes of the whole: everything, but for sums, which one rank goes on with; merged()
/// then has them once.
State share_of(const State &whole, const Ranks &ranks);

/// What the first rank has, on all of them; what others give is not read.
std::map<std::string, State> from_first(const std::map<std::string, State> &states,
                                        const Ranks &ranks);

/// Whether save_sum() made it.
bool is_sum(const Table &table);
} // namespace ligament::core
