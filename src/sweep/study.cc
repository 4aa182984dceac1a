#include "src/sweep/study.h"

#include "core/check.h"
#include "core/input_file.h"
#include "core/parameters/describe_parameters.h"
#include "core/parameters/read_parameters.h"
#include "core/parameters/spelling.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace ligament::program
{
namespace
{
using Section = core::ParameterSection;
using core::JsonMember;
using core::JsonValue;

// clang-format off
void declare_grid(Section &s, StudyGrid &g)
{
  s.add("name", g.name, "name in tables and plots; empty: the keys that vary");
  s.add("set", g.set, "keys of the scene and their values, for all cases of the grid");
  s.add("vary", g.vary, "keys of the scene, each with a list of values: every combination is a case").required();
}

void declare_row(Section &s, StudyRow &r)
{
  s.add("name", r.name, "name in tables and plots").required();
  s.add("rival", r.rival, "what one would try in place of coupling: marked by its name in the plots");
  s.add("set", r.set, "keys of the scene and their values; none: the scene as it is");
}

void declare_total(Section &s, TotalReference &t)
{
  s.add("reference", t.reference, "name of a row, output folder of a run, or CSV curve");
  s.add("peak_load", t.peak_load, "peak load of an analytic solution").in("N");
  s.add("peak_stress", t.peak_stress, "peak stress of an analytic solution").in("Pa");
  s.add("stiffness", t.stiffness, "stress over mean strain of an analytic solution").in("Pa").above(0);
}

void declare_study(Section &s, Study &study)
{
  s.ignore("$schema", "address of the JSON schema, for editors");
  s.add("title", study.title, "one line for the summary");
  s.add("scene", study.scene, "file of the scene that varies, relative to the study").required();
  s.add("set", study.set, "keys of the scene and their values, for all cases");
  s.list("grids", study.grids, "sets of cases: every combination of some values", declare_grid);
  s.list("rows", study.rows, "single cases with a name", declare_row);
  s.add("reference", study.reference, "what coupling should agree with: name of a row (pure discrete elements), output folder of a run, or CSV curve");
  declare_total(s.section("total", "the right answer, for the total error: one of these keys"), study.total);
  s.add("measure", study.measure, "which error is plotted", {"peak_load", "stiffness", "energy", "crack_distance", "displacement", "breaking_time"});
  s.add("cost", study.cost, "time in the plots: what a user waits, or what the processors work, which is sound also while others use the machine", {"run_time", "core_time"});
}
// clang-format on

/// What the table cannot say of itself.
class Check
{
public:
  Check(const Study &study, StudyResult &result, const std::string &folder)
      : study_(study), result_(result), folder_(folder)
  {
  }

  void run()
  {
    if (study_.grids.empty() && study_.rows.empty())
      error("", "the study has no cases", "neither /grids nor /rows has an element",
            "add \"rows\": [{\"name\": \"as it is\"}]");
    for (std::size_t k = 0; k < study_.grids.size(); ++k)
      grid(study_.grids[k], fmt::format("/grids/{}/vary", k));
    names();
    if (!study_.reference.empty())
      reference(study_.reference, "/reference");
    total();
  }

private:
  void error(const std::string &key, const std::string &message, const std::string &reason,
             const std::string &remedy)
  {
    result_.errors.push_back({place_of(result_.json, key), key, message, reason, remedy});
  }

  void grid(const StudyGrid &g, const std::string &path)
  {
    if (g.vary.empty())
      error(path, "nothing varies in " + path, "a grid is made from lists of values",
            "write \"vary\": {\"/coupling/overlap_cells\": [2, 3, 4]}, or use /rows");
    double n_cases = 1;
    for (const JsonMember &member : g.vary) {
      values(member);
      n_cases *= double(std::max<std::size_t>(member.value.elements.size(), 1));
    }
    if (n_cases > 1e4)
      error(path, fmt::format("{} has {:.0f} cases", path, n_cases), "at most 10000 are allowed",
            "vary fewer keys together; several grids add their cases instead of multiplying them");
  }

  void values(const JsonMember &member)
  {
    const auto wrong = [&](const core::Place &place, const std::string &message,
                           const std::string &remedy) {
      result_.errors.push_back({place, member.key, fmt::format("\"{}\" {}", member.key, message),
                                "each of the values makes cases of their own", remedy});
    };
    if (!member.value.is(JsonValue::Kind::array))
      return wrong(member.value.place,
                   "is " + core::name_of(member.value.kind) + ", expected a list of values",
                   "write [value, value, ..]; a value that does not vary belongs into \"set\"");
    if (member.value.elements.empty())
      return wrong(member.value.place, "has no values", "give at least one value");
    std::vector<std::string> seen;
    for (const JsonValue &value : member.value.elements) {
      const std::string text = to_text(value);
      if (std::find(seen.begin(), seen.end(), text) != seen.end())
        wrong(value.place, "has the value " + text + " twice", "remove one of them");
      seen.push_back(text);
    }
  }

  std::vector<std::string> row_names() const
  {
    std::vector<std::string> list;
    for (const StudyRow &row : study_.rows)
      list.push_back(row.name);
    return list;
  }

  void names()
  {
    const auto all = row_names();
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool repeated = std::find(all.begin(), all.begin() + k, all[k]) != all.begin() + k;
      if (all[k].empty() ? name_is_written(k) : repeated)
        error(fmt::format("/rows/{}/name", k),
              all[k].empty() ? "a row has an empty name"
                             : fmt::format("two rows have the name \"{}\"", all[k]),
              "tables, plots and references name rows", "give each row a name of its own");
    }
  }

  /// That the key is missing has been reported.
  bool name_is_written(std::size_t k) const
  {
    return result_.json.find("rows")->value.elements[k].find("name");
  }

  void reference(const std::string &name, const std::string &key)
  {
    const auto rows = row_names();
    const bool known = std::find(rows.begin(), rows.end(), name) != rows.end() ||
                       std::filesystem::exists(std::filesystem::path(folder_) / name);
    if (!known)
      error(
          key,
          fmt::format("there is no row and no file \"{}\"{}", name, core::did_you_mean(name, rows)),
          "a reference is a row of this study, the output folder of a run, or a CSV curve",
          rows.empty() ? "add a row with this name, or correct the path"
                       : "the rows are " + core::listed(rows, "and"));
  }

  void total()
  {
    const TotalReference &t = study_.total;
    const int n = !t.reference.empty() + t.peak_load.has_value() + t.peak_stress.has_value() +
                  t.stiffness.has_value();
    if (n > 1)
      error("/total", "several right answers are given",
            "reference, peak_load, peak_stress and stiffness exclude each other", "keep one");
    if (!t.reference.empty())
      reference(t.reference, "/total/reference");
    const bool of_peak = t.peak_load || t.peak_stress;
    if ((of_peak && study_.measure != Measure::peak_load) ||
        (t.stiffness && study_.measure != Measure::stiffness))
      error("/measure", "the right answer says nothing about what is measured",
            of_peak ? "peak_load and peak_stress answer the measure peak_load"
                    : "stiffness answers the measure stiffness",
            "change \"measure\", or give a run as \"reference\"");
  }

  const Study &study_;
  StudyResult &result_;
  std::string folder_;
};

/// Relative to the study file, where it names a file there.
std::string located(const std::string &name, const std::string &folder)
{
  const auto path = std::filesystem::path(folder) / name;
  return std::filesystem::exists(path) ? path.lexically_normal().string() : name;
}

bool is_row(const Study &study, const std::string &name)
{
  return std::any_of(study.rows.begin(), study.rows.end(),
                     [&](const StudyRow &row) { return row.name == name; });
}

} // namespace

StudyResult read_study(const std::string &file)
{
  StudyResult result;
  std::string text;
  std::string reason;
  try {
    text = core::read_input(file);
    reason = text.find_first_not_of(" \t\r\n") == text.npos ? "it is empty" : "";
  } catch (const core::EnvironmentError &error) {
    reason = error.what();
  }
  const std::string name = file == "-" ? "standard input" : file;
  if (!reason.empty()) {
    result.errors.push_back(
        {core::Place{name}, "", "cannot read the study", reason, "check the path"});
    return result;
  }
  result.json = core::parse_json(text, name, result.errors);
  if (result.json.is(JsonValue::Kind::null) && !result.errors.empty())
    return result;
  Study study;
  Section table;
  declare_study(table, study);
  core::read_parameters(table, result.json, "", 0, table, result.errors);
  const std::string folder =
      core::is_named_file(file) ? std::filesystem::path(file).parent_path() : "";
  if (result.json.is(JsonValue::Kind::object)) {
    Check(study, result, folder).run();
    if (!study.scene.empty() &&
        !std::filesystem::is_regular_file(std::filesystem::path(folder) / study.scene))
      result.errors.push_back({place_of(result.json, "/scene"), "/scene",
                               fmt::format("there is no scene \"{}\"", study.scene),
                               "the path is relative to the study file", "correct the path"});
  }
  core::sort_by_place(result.errors);
  if (!result.errors.empty())
    return result;
  study.scene = located(study.scene, folder);
  for (std::string *reference : {&study.reference, &study.total.reference})
    if (!reference->empty() && !is_row(study, *reference))
      *reference = located(*reference, folder);
  result.study = std::move(study);
  return result;
}

std::string study_markdown()
{
  Study study;
  Section table;
  declare_study(table, study);
  return "# Study files: all keys\n"
         "\n"
         "Generated from the table in `src/sweep/study.cc` by `ligament explain --study "
         "--markdown`; a test keeps it up to date.\n"
         "\n"
         "A study is JSON with comments, read by `ligament sweep`. Keys of the scene are written "
         "as their paths,\n"
         "such as `\"/coupling/overlap_cells\": 4`, and take values as in a scene.\n" +
         core::markdown_tables(table, "The study as a whole");
}

std::string study_schema()
{
  Study study;
  Section table;
  declare_study(table, study);
  auto schema = core::schema(table);
  schema["title"] = "Ligament study";
  return schema.dump(2) + "\n";
}
} // namespace ligament::program
