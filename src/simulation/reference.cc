#include "src/simulation/reference.h"

namespace ligament::program
{
double Reference::value(const std::string &name, const std::function<double()> &find)
{
  const auto values = tables_.find("values");
  if (values != tables_.end() && values->second.has(name))
    return core::load_real(tables_, "values", name);
  const double value = find();
  core::save_value(tables_, "values", name, value);
  return value;
}

std::vector<std::string> Reference::names(const std::string &begin) const
{
  std::vector<std::string> found;
  const auto values = tables_.find("values");
  if (values != tables_.end())
    for (const std::string &name : values->second.columns())
      if (name.compare(0, begin.size(), begin) == 0)
        found.push_back(name);
  return found;
}
} // namespace ligament::program
