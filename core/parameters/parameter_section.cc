#include "core/parameters/parameter_section.h"

namespace ligament::core
{
using Kind = Parameter::Kind;

Parameter &ParameterSection::insert(const std::string &key, Kind kind, Parameter::Target target,
                                    const std::string &text)
{
  Parameter p;
  p.key = key;
  p.kind = kind;
  p.target = std::move(target);
  p.text = text;
  return parameters_.emplace_back(std::move(p));
}

Parameter &ParameterSection::add(const std::string &key, double &target, const std::string &text)
{
  return insert(key, Kind::number, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, int &target, const std::string &text)
{
  return insert(key, Kind::integer, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, bool &target, const std::string &text)
{
  return insert(key, Kind::boolean, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, std::string &target,
                                 const std::string &text)
{
  return insert(key, Kind::string, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, std::optional<double> &target,
                                 const std::string &text)
{
  return insert(key, Kind::number, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, Point &target, const std::string &text)
{
  return insert(key, Kind::vector, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, PartialPoint &target,
                                 const std::string &text)
{
  return insert(key, Kind::vector, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, std::vector<Point> &target,
                                 const std::string &text)
{
  return insert(key, Kind::points, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, std::vector<NumberPair> &target,
                                 const std::string &text)
{
  return insert(key, Kind::table, &target, text);
}

Parameter &ParameterSection::add(const std::string &key, std::vector<JsonMember> &target,
                                 const std::string &text)
{
  return insert(key, Kind::members, &target, text);
}

Parameter &ParameterSection::ignore(const std::string &key, const std::string &text)
{
  return insert(key, Kind::ignored, std::monostate(), text);
}

ParameterSection &ParameterSection::section(const std::string &key, const std::string &text)
{
  Parameter &p = insert(key, Kind::section, std::monostate(), text);
  p.section = std::make_shared<ParameterSection>();
  return *p.section;
}

const Parameter *ParameterSection::find(const std::string &key) const
{
  for (const Parameter &p : parameters_)
    if (p.key == key)
      return &p;
  return nullptr;
}

bool ParameterSection::must_be_given(int dimension) const
{
  for (const Parameter &p : parameters_)
    if (p.must_be_given(dimension))
      return true;
  return required_;
}

std::vector<std::string> ParameterSection::keys(int dimension) const
{
  std::vector<std::string> keys;
  for (const Parameter &p : parameters_)
    if (p.applies_in(dimension))
      keys.push_back(p.key);
  return keys;
}
} // namespace ligament::core
