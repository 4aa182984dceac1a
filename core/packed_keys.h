// Names of rows in few bytes: where they count up by one, a whole run takes as much as one name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ligament::core
{
/// `keys`: n_keys numbers per row. Rows whose last number counts up while the others stay are a
/// run: its first row, as differences from the last row before, and its length.
std::string pack_keys(const std::vector<std::int64_t> &keys, int n_keys);

/// Throws InputError for bytes that are not what pack_keys() makes of so many rows.
std::vector<std::int64_t> unpack_keys(std::string_view bytes, int n_keys, std::int64_t n_rows);
} // namespace ligament::core
