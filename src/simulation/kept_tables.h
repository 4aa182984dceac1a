// What a run keeps beside its body, series and copies of fields, as tables of a State.
#pragma once

#include "core/state.h"
#include "src/output/fields.h"

#include <optional>

namespace ligament::program
{
/// Rows called 0, 1, ..., n - 1.
core::Table numbered_rows(std::size_t n);

/// Items of so many components, one column for each.
void add_items(core::Table &table, const std::string &column, int n_components,
               const std::vector<double> &values);
std::vector<double> items(const core::Table &table, const std::string &column, int n_components);

/// A time that is not known yet is a NaN.
void save_optional(core::State &state, const std::string &table, const std::string &column,
                   const std::optional<double> &value);
std::optional<double> load_optional(const core::State &state, const std::string &table,
                                    const std::string &column);

/// The values of all fields, and the time; places and what follows from them are the body's.
void save_fields(core::State &state, const std::string &name, const BodyState &kept);
/// `like`: the fields of the same body at another time, which receive the values.
BodyState load_fields(const core::State &state, const std::string &name, BodyState like);
} // namespace ligament::program
