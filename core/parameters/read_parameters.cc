#include "core/parameters/read_parameters.h"

#include "core/parameters/spelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace ligament::core
{
namespace
{
using JsonKind = JsonValue::Kind;
using Kind = Parameter::Kind;

std::string shown(const std::string &path)
{
  return path.empty() ? "/" : path;
}

/// JSON pointer of the section that holds this key, if any section does.
std::string home_of(const ParameterSection &section, const std::string &key,
                    const std::string &path)
{
  for (const Parameter &p : section.parameters())
    if (p.section) {
      const std::string below = path + "/" + p.key;
      if (p.section->find(key))
        return below;
      if (const std::string home = home_of(*p.section, key, below); !home.empty())
        return home;
    }
  return "";
}

class Reader
{
public:
  Reader(int dimension, const ParameterSection &root, std::vector<Diagnostic> &errors,
         std::vector<Diagnostic> *warnings)
      : dimension_(dimension), root_(root), errors_(errors), warnings_(warnings)
  {
  }

  void section(const ParameterSection &section, const JsonValue &json, const std::string &path)
  {
    if (!section.shorthand().empty() && json.is(JsonKind::string)) {
      JsonValue object;
      object.kind = JsonKind::object;
      object.place = json.place;
      object.members.push_back({section.shorthand(), json.place, json});
      return this->section(section, object, path);
    }
    if (!json.is(JsonKind::object)) {
      error(json.place, path,
            fmt::format("{} is {}, expected an object {{..}}",
                        path.empty() ? "the file" : "\"" + path + "\"", name_of(json.kind)),
            "it has keys of its own", "write the keys of this section between { and }");
      return;
    }
    // A missing key is not reported beside the misspelt one that seems to stand for it.
    std::vector<std::string> meant;
    for (const JsonMember &member : json.members) {
      const Parameter *p = section.find(member.key);
      if (!p)
        meant.push_back(unknown_key(section, member, path));
      else if (!p->applies_in(dimension_))
        error(member.place, path + "/" + member.key,
              fmt::format("key \"{}\" in {} has no meaning in {}D", member.key, shown(path),
                          dimension_),
              fmt::format("it belongs to scenes of dimension {}", p->only_dimension),
              "remove it, or change /dimension");
      else
        parameter(*p, member.value, path);
    }
    for (const Parameter &p : section.parameters())
      if (p.must_be_given(dimension_) && !json.find(p.key) &&
          std::find(meant.begin(), meant.end(), p.key) == meant.end())
        error(json.place, path + "/" + p.key,
              fmt::format("missing key \"{}\" in {}", p.key, shown(path)),
              "it has no default: " + p.text,
              fmt::format("add \"{}\": {}", p.key, p.type(dimension_)));
  }

private:
  void error(const Place &place, const std::string &key, const std::string &message,
             const std::string &reason, const std::string &remedy)
  {
    errors_.push_back({place, key, message, reason, remedy});
  }

  std::string unknown_key(const ParameterSection &section, const JsonMember &member,
                          const std::string &path)
  {
    const std::vector<std::string> keys = section.keys(dimension_);
    const std::string meant = nearest_word(member.key, keys);
    const std::string home = meant.empty() ? home_of(root_, member.key, "") : "";
    const bool root_key = meant.empty() && home.empty() && root_.find(member.key);
    error(member.place, path + "/" + (meant.empty() ? member.key : meant),
          fmt::format("unknown key \"{}\" in {}{}", member.key, shown(path),
                      did_you_mean(member.key, keys)),
          home.empty() && !root_key ? "only known keys are read, a misspelt one would be lost"
                                    : "this key belongs to " + shown(home),
          meant.empty() ? "the keys here are " + listed(keys, "and") : "write \"" + meant + "\"");
    return meant;
  }

  void wrong_type(const Parameter &p, const JsonValue &json, const std::string &path,
                  const std::string &label)
  {
    error(json.place, path,
          fmt::format("{} is {}, expected {}", label, name_of(json.kind), p.type(dimension_)),
          p.text, "give " + p.type(dimension_));
  }

  void parameter(const Parameter &p, const JsonValue &json, const std::string &section_path)
  {
    const std::string path = section_path + "/" + p.key;
    const std::string label = fmt::format("\"{}\" in {}", p.key, shown(section_path));
    switch (p.kind) {
    case Kind::ignored:
      return;
    case Kind::section:
      return sub_section(p, json, path);
    case Kind::list:
      return list(p, json, path, label);
    case Kind::points:
      return points(p, json, path, label);
    case Kind::table:
      return table(p, json, path, label);
    case Kind::members:
      if (!json.is(JsonKind::object))
        return wrong_type(p, json, path, label);
      *std::get<std::vector<JsonMember> *>(p.target) = json.members;
      return;
    case Kind::rotation:
      if (dimension_ == 2 || (dimension_ == 0 && !json.is(JsonKind::array))) {
        if (const auto value = number(p, json, path, label))
          *std::get<Point *>(p.target) = {*value, 0, 0};
        return;
      }
      [[fallthrough]];
    case Kind::vector:
      return vector(p, json, path, label);
    default:
      return scalar(p, json, path, label);
    }
  }

  void sub_section(const Parameter &p, const JsonValue &json, const std::string &path)
  {
    if (p.absent_word.empty())
      return section(*p.section, json, path);
    p.elements.clear();
    if (json.is(JsonKind::string) && json.text == p.absent_word)
      return;
    if (json.is(JsonKind::string))
      return error(json.place, path,
                   fmt::format("unknown word \"{}\" for \"{}\"{}", json.text, p.key,
                               did_you_mean(json.text, {p.absent_word})),
                   p.text, "give " + p.type(dimension_));
    p.elements.reset();
    section(*p.section, json, path);
    if (json.is(JsonKind::object))
      p.elements.store();
  }

  void list(const Parameter &p, const JsonValue &json, const std::string &path,
            const std::string &label)
  {
    if (!json.is(JsonKind::array))
      return wrong_type(p, json, path, label);
    p.elements.clear();
    for (std::size_t k = 0; k < json.elements.size(); ++k) {
      p.elements.reset();
      section(*p.section, json.elements[k], path + "/" + std::to_string(k));
      p.elements.store();
    }
  }

  void points(const Parameter &p, const JsonValue &json, const std::string &path,
              const std::string &label)
  {
    if (!json.is(JsonKind::array))
      return wrong_type(p, json, path, label);
    auto &target = *std::get<std::vector<Point> *>(p.target);
    target.clear();
    for (std::size_t k = 0; k < json.elements.size(); ++k) {
      PartialPoint value{};
      components(p, json.elements[k], path + "/" + std::to_string(k),
                 fmt::format("point {} of {}", k + 1, label), value);
      target.push_back({value[0].value_or(0), value[1].value_or(0), value[2].value_or(0)});
    }
  }

  void table(const Parameter &p, const JsonValue &json, const std::string &path,
             const std::string &label)
  {
    if (!json.is(JsonKind::array))
      return wrong_type(p, json, path, label);
    auto &target = *std::get<std::vector<NumberPair> *>(p.target);
    target.clear();
    for (std::size_t k = 0; k < json.elements.size(); ++k) {
      const JsonValue &row = json.elements[k];
      const std::string row_path = path + "/" + std::to_string(k);
      if (!row.is(JsonKind::array) || row.elements.size() != 2 ||
          !row.elements[1].is(JsonKind::number)) {
        error(row.place, row_path,
              fmt::format("row {} of {} is no pair [{}, a number]", k + 1, label, number_type(p)),
              p.text, "give " + p.type(dimension_));
        continue;
      }
      if (const auto first = number(p, row.elements[0], row_path + "/0",
                                    fmt::format("row {} of {}", k + 1, label)))
        target.push_back({*first, row.elements[1].number});
    }
  }

  void vector(const Parameter &p, const JsonValue &json, const std::string &path,
              const std::string &label)
  {
    PartialPoint value{};
    const bool may_be_absent = std::holds_alternative<PartialPoint *>(p.target);
    if ((json.is(JsonKind::null) && may_be_absent) || !components(p, json, path, label, value))
      return;
    if (auto *partial = std::get_if<PartialPoint *>(&p.target))
      **partial = value;
    else
      for (std::size_t c = 0; c < 3; ++c) // 2D: z is what null would be
        (*std::get<Point *>(p.target))[c] = value[c].value_or(p.null_value.value_or(0));
  }

  bool components(const Parameter &p, const JsonValue &json, const std::string &path,
                  const std::string &label, PartialPoint &value)
  {
    if (!json.is(JsonKind::array)) {
      // "a list of points" when the list is there but its points are not.
      const std::string expected =
          p.kind == Kind::points ? "a point [..] of numbers in " + p.unit_name : p.type(dimension_);
      error(json.place, path,
            fmt::format("{} is {}, expected {}", label, name_of(json.kind), expected), p.text,
            "give " + expected);
      return false;
    }
    const std::size_t n = json.elements.size();
    if (dimension_ == 0 ? n != 2 && n != 3 : n != std::size_t(dimension_)) {
      error(json.place, path,
            fmt::format("{} has {} components, expected {}", label, n,
                        dimension_ == 0 ? "2 or 3" : std::to_string(dimension_)),
            dimension_ == 0 ? "bodies have two or three dimensions"
                            : fmt::format("/dimension is {}", dimension_),
            "give one number per dimension");
      return false;
    }
    bool good = true;
    for (std::size_t c = 0; c < n; ++c) {
      const JsonValue &element = json.elements[c];
      if (element.is(JsonKind::null) && std::holds_alternative<PartialPoint *>(p.target))
        continue;
      if (element.is(JsonKind::null) && p.null_value)
        value[c] = *p.null_value;
      else {
        value[c] = number(p, element, path + "/" + std::to_string(c),
                          fmt::format("component {} of {}", c + 1, label));
        good = good && value[c];
      }
    }
    return good;
  }

  void scalar(const Parameter &p, const JsonValue &json, const std::string &path,
              const std::string &label)
  {
    // In the echo of the resolved values null says that a value without default is not given.
    const bool may_be_absent = p.necessity == Parameter::Necessity::conditional ||
                               std::holds_alternative<std::optional<double> *>(p.target);
    if (json.is(JsonKind::null) && may_be_absent)
      return;
    if (p.kind == Kind::boolean && json.is(JsonKind::boolean))
      *std::get<bool *>(p.target) = json.boolean;
    else if (p.kind == Kind::string && json.is(JsonKind::string))
      *std::get<std::string *>(p.target) = json.text;
    else if (p.kind == Kind::choice && json.is(JsonKind::string))
      choice(p, json, path, label);
    else if (p.kind == Kind::integer)
      integer(p, json, path, label);
    else if (p.kind == Kind::number) {
      if (const auto value = number(p, json, path, label)) {
        if (auto *optional = std::get_if<std::optional<double> *>(&p.target))
          **optional = *value;
        else
          *std::get<double *>(p.target) = *value;
      }
    } else
      wrong_type(p, json, path, label);
  }

  void choice(const Parameter &p, const JsonValue &json, const std::string &path,
              const std::string &label)
  {
    const auto found = std::find(p.choices.begin(), p.choices.end(), json.text);
    if (found == p.choices.end())
      return error(json.place, path,
                   fmt::format("unknown word \"{}\" for {}{}", json.text, label,
                               did_you_mean(json.text, p.choices)),
                   p.text, "choose " + listed(p.choices));
    if (auto *text = std::get_if<std::string *>(&p.target))
      **text = json.text;
    else
      std::get<Choice>(p.target).set(int(found - p.choices.begin()));
  }

  void integer(const Parameter &p, const JsonValue &json, const std::string &path,
               const std::string &label)
  {
    const double value = json.number;
    if (!json.is(JsonKind::number))
      return wrong_type(p, json, path, label);
    if (value != std::floor(value))
      return error(json.place, path,
                   fmt::format("{} is {}, expected a whole number", label, json.text), p.text,
                   "give a whole number");
    if (!in_range(p, value, json, path, label))
      return;
    if (std::abs(value) > std::numeric_limits<int>::max())
      return error(json.place, path, fmt::format("{} is {}, which is too large", label, json.text),
                   p.text, "give a smaller number");
    *std::get<int *>(p.target) = int(value);
  }

  std::optional<double> number(const Parameter &p, const JsonValue &json, const std::string &path,
                               const std::string &label)
  {
    double value = json.number;
    if (json.is(JsonKind::string)) {
      if (const auto word = p.words.find(json.text); word != p.words.end())
        return word->second;
      const std::optional<double> quantity = from_text(p, json, path, label);
      if (!quantity)
        return {};
      value = *quantity;
    } else if (!json.is(JsonKind::number)) {
      error(json.place, path,
            fmt::format("{} is {}, expected {}", label, name_of(json.kind), number_type(p)), p.text,
            "give " + number_type(p));
      return {};
    }
    if (!in_range(p, value, json, path, label))
      return {};
    return value;
  }

  static std::string number_type(const Parameter &p)
  {
    return p.unit_name.empty() ? "a number" : "a number in " + p.unit_name;
  }

  std::optional<double> from_text(const Parameter &p, const JsonValue &json,
                                  const std::string &path, const std::string &label)
  {
    const std::string remedy =
        p.unit_name.empty() ? "give a plain number"
                            : fmt::format("give a plain number in {0}, or a string with a unit of "
                                          "this kind such as \"1 {0}\"",
                                          p.unit_name);
    try {
      const Quantity quantity = parse_quantity(json.text);
      if (same_dimension(quantity.exponents, p.unit))
        return quantity.value;
      error(json.place, path,
            fmt::format("unit of {} does not fit: \"{}\" is in {}, expected {}", label, json.text,
                        to_string(quantity.exponents),
                        p.unit_name.empty() ? "a number without unit" : p.unit_name),
            p.text, remedy);
    } catch (const std::invalid_argument &reason) {
      error(json.place, path,
            fmt::format("cannot read \"{}\" as value of {}, expected {}", json.text, label,
                        number_type(p)),
            reason.what(), remedy);
    }
    return {};
  }

  bool in_range(const Parameter &p, double value, const JsonValue &json, const std::string &path,
                const std::string &label)
  {
    if (in_bounds(p, value))
      return is_plausible(p, value, json, path, label);
    const std::string unit = p.unit_name.empty() ? "" : " " + p.unit_name;
    error(json.place, path, fmt::format("{} is {}{}, which is out of range", label, value, unit),
          p.text, fmt::format("give a value {}{}", p.range(), unit));
    return false;
  }

  /// Doubts a value outside its band; false when no input can mean it.
  bool is_plausible(const Parameter &p, double value, const JsonValue &json,
                    const std::string &path, const std::string &label)
  {
    if (!p.band || p.band->holds(value))
      return true;
    const std::string message =
        fmt::format("{} is {}{}", label, value, p.unit_name.empty() ? "" : " " + p.unit_name);
    const std::string reason = fmt::format("{}; usual are {}{}", p.text, p.usual_range(),
                                           p.unit_name.empty() ? "" : " " + p.unit_name);
    const std::string remedy = probably_meant(p, json);
    if (!p.band->is_within_reason(value)) {
      error(json.place, path, message + ", which is beyond reason", reason, remedy);
      return false;
    }
    // A list of components in the wrong unit is one mistake.
    if (warnings_ && doubted_.insert(without_components(path)).second)
      warnings_->push_back({json.place, path, message + ", which is unusual", reason, remedy,
                            Diagnostic::Severity::warning});
    return true;
  }

  static std::string without_components(std::string path)
  {
    for (std::size_t at = path.rfind('/');
         at != path.npos && path.find_first_not_of("0123456789", at + 1) == path.npos;
         at = path.rfind('/'))
      path.resize(at);
    return path;
  }

  /// The unit that was left out of a plain number, or what else to do.
  static std::string probably_meant(const Parameter &p, const JsonValue &json)
  {
    if (json.is(JsonKind::number))
      for (const std::string &unit : p.band->units)
        if (const double value = parse_unit(unit).value * json.number;
            value != 0 && p.band->holds(value) && in_bounds(p, value))
          return fmt::format("did you mean \"{} {}\"?", json.text, unit);
    return p.unit_name.empty() ? "check the value" : "check the value and its unit";
  }

  static bool in_bounds(const Parameter &p, double value)
  {
    const bool low = p.lower && (p.lower->open ? value <= p.lower->value : value < p.lower->value);
    const bool high = p.upper && (p.upper->open ? value >= p.upper->value : value > p.upper->value);
    return !low && !high;
  }

  int dimension_;
  const ParameterSection &root_;
  std::vector<Diagnostic> &errors_;
  std::vector<Diagnostic> *warnings_;
  std::set<std::string> doubted_; // keys
};
} // namespace

void read_parameters(const ParameterSection &section, const JsonValue &json,
                     const std::string &path, int dimension, const ParameterSection &root,
                     std::vector<Diagnostic> &errors, std::vector<Diagnostic> *warnings)
{
  Reader(dimension, root, errors, warnings).section(section, json, path);
}
} // namespace ligament::core
