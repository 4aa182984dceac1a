#include "src/output/fields.h"

#include <algorithm>

namespace ligament::program
{
const Field *find_field(const std::vector<Field> &fields, const std::string &name)
{
  const auto field =
      std::find_if(fields.begin(), fields.end(), [&](const Field &f) { return f.name == name; });
  return field == fields.end() ? nullptr : &*field;
}
} // namespace ligament::program
