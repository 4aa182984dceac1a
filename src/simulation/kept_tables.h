// What a run keeps beside its body, series and copies of motions, as tables of a State.
#pragma once

#include "core/names.h"

#include <optional>

namespace ligament::program
{
/// Rows called 0, 1, ..., n - 1.
core::Table numbered_rows(std::size_t n);

/// A time that is not known yet is a NaN.
void save_optional(core::State &state, const std::string &table, const std::string &column,
                   const std::optional<double> &value);
std::optional<double> load_optional(const core::State &state, const std::string &table,
                                    const std::string &column);

/// Items of so many components, value by value, as columns of a table with a row for each name; a
/// component that is zero everywhere takes none.
void add_items(core::Table &table, const core::Names &names, const std::string &column,
               int n_components, const std::vector<double> &values);
std::vector<double> items(const core::Table &table, const core::Names &names,
                          const std::string &column, int n_components);

/// "kind_...": whatever is kept of one kind at one time has one name.
std::string kept_name(const std::string &kind, double time);
} // namespace ligament::program
