// Fills the variables of a table from an input, and collects everything that is wrong with it.
#pragma once

#include "core/json.h"
#include "core/parameters/parameter_section.h"

namespace ligament::core
{
/// Reads `json` into the variables of `section`, whose JSON pointer is `path` ("" for the root).
/// Unknown and missing keys, wrong types, units, bounds and numbers of components are added to
/// `errors`; everything that is right is read all the same. With dimension 0 (not known because its
/// own key is wrong) any number of components passes. `root` is searched for keys that stand in the
/// wrong section. Values that no input has in practice (Parameter::band) are warnings.
void read_parameters(const ParameterSection &section, const JsonValue &json,
                     const std::string &path, int dimension, const ParameterSection &root,
                     std::vector<Diagnostic> &errors, std::vector<Diagnostic> *warnings = nullptr);

} // namespace ligament::core
