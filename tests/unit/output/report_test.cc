// The report: one well-formed page with everything that the run knows.
#include "src/analysis/report.h"

#include "core/check.h"
#include "src/analysis/compare.h"
#include "src/analysis/phases.h"
#include "src/analysis/verdict.h"
#include "src/drawing/drawing.h"
#include "src/output/format.h"
#include "src/output/vtk.h"
#include "tests/unit/output/synthetic_run.h"
#include "tests/unit/output/xml.h"

#include <gtest/gtest.h>

using namespace ligament;
using namespace ligament::program;
using ligament::tests::SyntheticRun;

namespace
{
TEST(Report, HoldsEverythingInOneFile)
{
  const SyntheticRun run;
  const RunFolder folder = run.write("reported");
  RunRecord record = read_run_record(folder.record());
  record.timing = {{"discrete forces", 3, 10}, {"rest", 1, 0}};
  record.skipped = {{"contact search", "nothing <is> broken"}};
  record.pictures = {{"pictures/peak.png", "At the peak"}, {"pictures/gone.png", "Lost"}};
  write_run_record(folder.record(), record);
  const std::string png = Drawing(8, 8, ImageFormat::png).file();
  core::write_file(folder.pictures() + "/peak.png", png);
  core::write_file(folder.resolved_scene(), "{\"title\": \"a & b\"}");
  SyntheticRun().write("report_reference");
  CompareResult comparison = compare("reported", "report_reference");
  write_comparison(comparison, "reported");

  const std::string path = write_report("reported");
  EXPECT_EQ(path, folder.report());
  const std::string text = core::read_file(path);
  EXPECT_NO_THROW(tests::parse_xml(text));
  for (const std::string &part :
       {escape_xml(record.title), escape_xml(verdict(record)), escape_xml(headline(record)),
        std::string("At the peak"), "data:image/png;base64," + base64(png.data(), png.size()),
        std::string("external work"), std::string("discrete forces"),
        std::string("nothing &lt;is&gt; broken"), std::string("a &amp; b"), std::string("1.2.3"),
        std::string("reported against report_reference")})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(text.find("<script"), std::string::npos);
  EXPECT_EQ(text.find("Lost"), std::string::npos);
}

// Another field of a run that has ended: its pictures replace those of the run.
TEST(Report, DrawsOtherFieldsFromTheKeptStates)
{
  const RunFolder folder = SyntheticRun().write("redrawn");
  BodyState state;
  state.name = "peak";
  state.particles.reference = {0, 0, 0, 1, 0, 0};
  state.particles.fields = {make_field("displacement", {0, 0, 0, 1e-3, 0, 0}),
                            make_field("velocity", {3, 4, 0, 0, 0, 0}),
                            make_field("radius", {0.5, 0.5}), make_field("global_id", {0, 1})};
  FieldSeries(folder, 2).write(state);
  RunRecord record = read_run_record(folder.record());
  record.pictures = {{"pictures/peak.png", "of the run"}};
  EXPECT_THROW(write_report("redrawn", {"velocity"}), core::InputError);
  record.states = {{"peak", "near the peak load", 1e-3, "fields/particles_peak.vtp", ""}};
  record.magnification = 50;
  write_run_record(folder.record(), record);
  const std::string text = core::read_file(write_report("redrawn", {"velocity", "velocity_x"}));
  EXPECT_NO_THROW(tests::parse_xml(text));
  EXPECT_NE(text.find("Velocity near the peak load, 1.00 ms"), std::string::npos);
  EXPECT_NE(text.find("Velocity x near the peak load, 1.00 ms"), std::string::npos);
  EXPECT_EQ(text.find("of the run<"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.pictures() + "/peak_velocity.png"));
  EXPECT_THROW(write_report("redrawn", {"veloctiy"}), core::InputError);
  // A field of the table that this run has not kept.
  try {
    write_report("redrawn", {"velocity", "plastic_strain"});
    ADD_FAILURE() << "a grey picture";
  } catch (const core::InputError &error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("no \"plastic_strain\""), std::string::npos) << message;
    EXPECT_NE(message.find("velocity_x"), std::string::npos) << message;
    EXPECT_EQ(message.find("stress_yy"), std::string::npos) << message;
  }
}

// One row per phase; the page says how many steps were done. Long tables are folded.
TEST(Report, ListsThePhases)
{
  const RunFolder folder = SyntheticRun().write("phases");
  EXPECT_EQ(core::read_file(write_report("phases")).find("Phases"), std::string::npos);
  RunRecord record = read_run_record(folder.record());
  const PhaseEntry equilibrium{"static", 0, 12, 0, 1230000, 3, 84, 5e4, 1, "a bond <breaks>", 2.25},
      steps{"dynamic", 12, 12.001, 4321, 0, 0, 0, 4e4, 77, "calm", 9};
  record.phases = {equilibrium, steps};
  write_run_record(folder.record(), record);
  const std::string text = core::read_file(write_report("phases"));
  EXPECT_NO_THROW(tests::parse_xml(text));
  const auto row = [](const std::vector<std::string> &cells) {
    std::string html = "<tr>";
    for (const std::string &cell : cells)
      html += "<td>" + cell + "</td>";
    return html + "</tr>";
  };
  for (const std::string &part :
       {row({"1", "static", "0 s", "12.0 s", "50.0 kN", "1", "-", "1 230 000", "3", "84", "2.2 s",
             "a bond &lt;breaks&gt;"}),
        row({"2", "dynamic", "12.0 s", "1.00 ms", "40.0 kN", "77", "4 321", "-", "-", "-", "9 s",
             "calm"}),
        row({"steps", "4 321"}), row({"steps that static phases skipped", "1 230 000"}),
        std::string("78 faces broke")})
    EXPECT_NE(text.find(part), std::string::npos) << part << phases_section(record);
  EXPECT_EQ(text.find("<details><summary>All"), std::string::npos);

  for (int k = 0; k < 30; ++k)
    record.phases.push_back(steps);
  write_run_record(folder.record(), record);
  const std::string folded = core::read_file(write_report("phases"));
  EXPECT_NO_THROW(tests::parse_xml(folded));
  EXPECT_NE(folded.find("<details><summary>All 32</summary>"), std::string::npos);
}

TEST(Report, NeedsNoMoreThanTheRecord)
{
  const RunFolder folder{"bare"};
  folder.create();
  write_run_record(folder.record(), {});
  EXPECT_NO_THROW(tests::parse_xml(core::read_file(write_report("bare"))));
  EXPECT_THROW(write_report("no_run_here"), core::InputError);
}

/// The value beside a name in the table of figures.
std::string figure(const std::string &page, const std::string &name)
{
  const std::string head = "<tr><td>" + name + "</td><td>";
  const std::size_t begin = page.find(head);
  if (begin == std::string::npos)
    return "missing";
  const std::size_t value = begin + head.size();
  return page.substr(value, page.find("</td>", value) - value);
}

// A run that was killed has a body and a history; what it knows only at its end is no figure.
TEST(Report, OfARunWithoutEndSaysWhatIsUnknown)
{
  const RunFolder folder = SyntheticRun().write("killed");
  RunRecord record = read_run_record(folder.record());
  record.status = "running";
  record.reason = "";
  record.wall_seconds = 0;
  for (const bool goes_on : {false, true}) {
    if (goes_on) { // from a checkpoint: the record still has the figures of its earlier end
      record.steps = 1234;
      record.simulated_time = 1;
      record.broken_bonds = 7;
      record.stiffness = 1e9;
      record.verdict = "the earlier verdict";
    } else
      record.largest_load = record.largest_stress = record.largest_time = record.peak_load = {};
    write_run_record(folder.record(), record);
    const std::string page = core::read_file(write_report("killed"));
    EXPECT_NO_THROW(tests::parse_xml(page));
    for (const char *name :
         {"steps", "simulated time", "stiffness", "broken faces", "wall time, set-up and loop"})
      EXPECT_EQ(figure(page, name), "-") << name;
    EXPECT_EQ(figure(page, "particles"), "1 000");
    EXPECT_NE(page.find("<p class=\"headline\">The run is not finished.</p>"), std::string::npos);
    EXPECT_NE(page.find("cells; it is not finished</p>"), std::string::npos);
    for (const char *part :
         {"nothing broke", "not finished: ", "earlier verdict", "peak load", "at the end<"})
      EXPECT_EQ(page.find(part), std::string::npos) << part;
  }
}

TEST(Report, OfARunInItsSetUpHasNoBody)
{
  const RunFolder folder{"set_up"};
  folder.create();
  RunRecord record;
  record.reason = "it is being set up";
  write_run_record(folder.record(), record);
  const std::string page = core::read_file(write_report("set_up"));
  for (const char *name : {"specimen", "particles", "cells", "time step", "steps"})
    EXPECT_EQ(figure(page, name), "-") << name;
  EXPECT_EQ(figure(page, "dimension"), "2D");
  EXPECT_NE(page.find("The run is not finished: it is being set up."), std::string::npos);
}
} // namespace
