// One key of an input: the value it fills, and all that is known about it.
#pragma once

#include "core/json.h"
#include "core/units.h"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace ligament::core
{
class ParameterSection;

using Point = std::array<double, 3>;
using NumberPair = std::array<double, 2>;
using PartialPoint = std::array<std::optional<double>, 3>;

/// An enum, reached by the index of its word in Parameter::choices; -1: not given.
struct Choice
{
  std::function<int()> get;
  std::function<void(int)> set;
};

struct Bound
{
  double value;
  bool open; // the bound itself is not allowed
};

/// Values that inputs have in practice, in magnitude; 0 always belongs to them. What lies outside
/// was probably meant in one of the units, and is beyond reason by a factor of `reason`.
struct Band
{
  double low, high;
  std::vector<std::string> units;
  static constexpr double reason = 1e12;

  bool holds(double value) const;
  bool is_within_reason(double value) const;
};

/// Objects of which there may be several (a list) or none (an optional section). They are read and
/// written one after the other through one prototype, to which the section of the key is bound.
struct Elements
{
  std::function<std::size_t()> size;
  std::function<void()> clear;
  std::function<void()> reset;           // the prototype takes its defaults
  std::function<void(std::size_t)> load; // the prototype becomes this element
  std::function<void()> store;           // the prototype becomes a further element
};

/// The methods are written as a sentence behind ParameterSection::add; what they set is public.
struct Parameter
{
  enum class Kind
  {
    ignored, // allowed, but means nothing to the program
    number,  // plain numbers are SI
    integer,
    boolean,
    string,
    choice,   // one of a few words
    vector,   // one number per dimension
    rotation, // 2D: an angle, 3D: a rotation vector
    points,   // list of vectors
    table,    // list of pairs: a number in the unit, and one without
    members,  // keys of another table with their values, kept as they were written
    section,
    list // of sections
  };
  enum class Necessity
  {
    optional, // the value that the target had when it was declared is the default
    required,
    conditional // checked where the condition is known; absent values are zero or empty
  };
  using Target =
      std::variant<std::monostate, double *, int *, bool *, std::string *, std::optional<double> *,
                   Point *, PartialPoint *, std::vector<Point> *, std::vector<NumberPair> *,
                   std::vector<JsonMember> *, Choice>;

  std::string key;
  Kind kind = Kind::ignored;
  Target target;
  std::string text; // what it means, one line
  std::string unit_name;
  UnitExponents unit = {0, 0, 0, 0, 0};
  std::optional<Bound> lower, upper;
  std::optional<Band> band;
  std::vector<std::string> choices;
  std::map<std::string, double> words; // words that stand for a number
  std::optional<double> null_value;    // number that null stands for in a vector
  Necessity necessity = Necessity::optional;
  std::string condition;                     // of a conditional necessity: "unless extent is none"
  int only_dimension = 0;                    // 2 or 3; 0: both
  std::shared_ptr<ParameterSection> section; // of kinds section and list
  Elements elements;                         // of lists and sections that may be absent
  std::string absent_word;                   // such as "none", of sections that may be absent

  Parameter &in(const std::string &unit);
  Parameter &above(double bound) { return set(lower, bound, true); }
  Parameter &at_least(double bound) { return set(lower, bound, false); }
  Parameter &below(double bound) { return set(upper, bound, true); }
  Parameter &at_most(double bound) { return set(upper, bound, false); }
  /// In SI; `units` in the order in which they are likely to be meant, separated by blanks.
  Parameter &usually(double low, double high, const std::string &units);
  Parameter &one_of(std::vector<std::string> words);
  Parameter &word(const std::string &word, double value);
  Parameter &null_means(double value);
  Parameter &required();
  Parameter &required_unless(const std::string &condition);
  Parameter &only_in(int dimension);
  Parameter &as_rotation();

  bool applies_in(int dimension) const
  {
    return only_dimension == 0 || dimension == 0 || dimension == only_dimension;
  }
  /// True when an input without this key is wrong, in this dimension (0: in both).
  bool must_be_given(int dimension) const;
  /// "above 0, at most 1"; empty without bounds.
  std::string range() const;
  /// "1e5 to 2e12"; empty without band.
  std::string usual_range() const;
  /// "a number in m", "a list of 2 numbers in m", ...; dimension 0: whatever it may be.
  std::string type(int dimension) const;

private:
  Parameter &set(std::optional<Bound> &bound, double value, bool open);
};
} // namespace ligament::core
