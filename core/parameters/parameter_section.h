// The table of an input: every key is declared once, in one line, and all else follows from it.
#pragma once

#include "core/parameters/parameter.h"

#include <deque>

namespace ligament::core
{
/// A group of keys, bound to the variables that they fill:
///
///     section.add("spacing", zone.spacing, "distance of neighbours").in("m").above(0).required();
///
/// Reading, errors, documentation, JSON schema and the echo of the resolved values walk this table
/// (read_parameters.h, describe_parameters.h). What a variable holds when it is declared is its
/// default. The variables must outlive the section.
class ParameterSection
{
public:
  Parameter &add(const std::string &key, double &target, const std::string &text);
  Parameter &add(const std::string &key, int &target, const std::string &text);
  Parameter &add(const std::string &key, bool &target, const std::string &text);
  Parameter &add(const std::string &key, std::string &target, const std::string &text);
  Parameter &add(const std::string &key, std::optional<double> &target, const std::string &text);
  Parameter &add(const std::string &key, Point &target, const std::string &text);
  Parameter &add(const std::string &key, PartialPoint &target, const std::string &text);
  Parameter &add(const std::string &key, std::vector<Point> &target, const std::string &text);
  /// A list of pairs [x, y]: x in the unit, y without one.
  Parameter &add(const std::string &key, std::vector<NumberPair> &target, const std::string &text);
  /// Keys of another table, for the program to read later.
  Parameter &add(const std::string &key, std::vector<JsonMember> &target, const std::string &text);

  /// An enum whose values 0, 1, ... are written as these words.
  template <typename Enum>
  Parameter &add(const std::string &key, Enum &target, const std::string &text,
                 std::vector<std::string> words)
  {
    return insert(key, Parameter::Kind::choice,
                  Choice{[&target] { return static_cast<int>(target); },
                         [&target](int k) { target = static_cast<Enum>(k); }},
                  text)
        .one_of(std::move(words));
  }

  /// The same of an enum that may not be given.
  template <typename Enum>
  Parameter &add(const std::string &key, std::optional<Enum> &target, const std::string &text,
                 std::vector<std::string> words)
  {
    return insert(key, Parameter::Kind::choice,
                  Choice{[&target] { return target ? static_cast<int>(*target) : -1; },
                         [&target](int k) { target = static_cast<Enum>(k); }},
                  text)
        .one_of(std::move(words));
  }

  /// A key that others may write (editors: "$schema") and the program leaves alone.
  Parameter &ignore(const std::string &key, const std::string &text);

  /// A group of keys below this one.
  ParameterSection &section(const std::string &key, const std::string &text);

  /// A group that is absent when `word` stands in its place; `target` is then empty.
  template <typename T>
  Parameter &section(const std::string &key, std::optional<T> &target, const std::string &word,
                     const std::string &text, void (*declare)(ParameterSection &, T &))
  {
    auto prototype = std::make_shared<T>();
    Parameter &p = insert(key, Parameter::Kind::section, std::monostate(), text);
    p.section = std::make_shared<ParameterSection>();
    p.absent_word = word;
    p.elements = {[&target] { return std::size_t(target.has_value()); },
                  [&target] { target.reset(); }, [prototype] { *prototype = T(); },
                  [&target, prototype](std::size_t) { *prototype = *target; },
                  [&target, prototype] { target = *prototype; }};
    declare(*p.section, *prototype);
    return p;
  }

  /// A list of groups.
  template <typename T>
  Parameter &list(const std::string &key, std::vector<T> &target, const std::string &text,
                  void (*declare)(ParameterSection &, T &))
  {
    auto prototype = std::make_shared<T>();
    Parameter &p = insert(key, Parameter::Kind::list, std::monostate(), text);
    p.section = std::make_shared<ParameterSection>();
    p.elements = {[&target] { return target.size(); }, [&target] { target.clear(); },
                  [prototype] { *prototype = T(); },
                  [&target, prototype](std::size_t k) { *prototype = target[k]; },
                  [&target, prototype] { target.push_back(*prototype); }};
    declare(*p.section, *prototype);
    return p;
  }

  /// The input must have this group even though none of its keys is required.
  void set_required() { required_ = true; }

  /// A bare word in place of this group stands for {key: word}.
  void set_shorthand(const std::string &key) { shorthand_ = key; }
  const std::string &shorthand() const { return shorthand_; }

  const std::deque<Parameter> &parameters() const { return parameters_; }
  const Parameter *find(const std::string &key) const;
  /// True when this group was declared so, or some key of it or of a group inside has no default.
  bool must_be_given(int dimension) const;
  /// All keys that may be written in this dimension (0: any).
  std::vector<std::string> keys(int dimension) const;

private:
  Parameter &insert(const std::string &key, Parameter::Kind kind, Parameter::Target target,
                    const std::string &text);

  std::deque<Parameter> parameters_; // references stay valid while the table grows
  std::string shorthand_;
  bool required_ = false;
};
} // namespace ligament::core
