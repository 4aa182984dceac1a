// Numbers as people read them.
#include "src/output/format.h"

#include "src/analysis/phases.h"
#include "src/analysis/verdict.h"
#include "src/output/progress.h"

#include <gtest/gtest.h>

using namespace ligament::program;

namespace
{
TEST(Format, NumbersWithPrefixesAndGroups)
{
  EXPECT_EQ(grouped(121000), "121 000");
  EXPECT_EQ(grouped(-1234567), "-1 234 567");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(quantity(2.5e6, "Pa"), "2.50 MPa");
  EXPECT_EQ(quantity(-1.234e-5, "m"), "-12.3 µm");
  EXPECT_EQ(quantity(1000, "N"), "1.00 kN");
  EXPECT_EQ(quantity(0, "J"), "0 J");
  EXPECT_EQ(quantity(0.82, ""), "0.82");
  EXPECT_EQ(quantity(2e-4, "m^2"), "0.0002 m^2");
  EXPECT_EQ(quantity(0, "kg"), "0 kg");
  EXPECT_EQ(quantity(2.5, "kg"), "2.50 kg");
  EXPECT_EQ(quantity(4e-3, "kg"), "4.00 g");
  EXPECT_EQ(quantity(1e-18, "J"), "1.00 aJ");
  EXPECT_EQ(quantity(-3.456e-21, "J"), "-3.46e-21 J");
  EXPECT_EQ(quantity(9.99e14, "Pa"), "999 TPa");
  EXPECT_EQ(quantity(1e15, "Pa"), "1e+15 Pa");
  EXPECT_EQ(quantity(1e-25, "kg"), "1e-25 kg");
  EXPECT_EQ(with_unit("mass", unit_prefix(1e-3, "kg"), "kg"), "mass (kg)");
  EXPECT_EQ(percent(0.0031), "+0.31 %");
  EXPECT_EQ(percent({}), "-");
  EXPECT_EQ(duration(200), "3 min 20 s");
  EXPECT_EQ(duration(7500), "2 h 05 min");
}

// The test vectors of RFC 4648, section 10.
TEST(Format, Base64)
{
  const std::string text = "foobar";
  const char *expected[] = {"", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
  for (std::size_t n = 0; n <= text.size(); ++n)
    EXPECT_EQ(base64(text.data(), n), expected[n]);
}

TEST(Verdict, ScalesTheMeasuredRateToThePureModel)
{
  RunRecord r;
  r.kind = "coupled";
  r.status = "done";
  r.particles = 8700;
  r.cells = 2350;
  r.equivalent_particles = 121000;
  r.wall_seconds = 20;
  r.discrete_seconds = 12;
  r.energy_residual = 3e-5;
  EXPECT_DOUBLE_EQ(*predicted_saving(r), 12. * 121000 / 8700 / 20);
  EXPECT_EQ(verdict(r), "8 700 particles and 2 350 cells stood for 121 000 particles: 8.3 x faster "
                        "than pure discrete elements would be at this rate; energy residual "
                        "3e-05; nothing unstable");
  r.status = "stopped";
  r.reason = "the crack reached the overlap";
  EXPECT_EQ(verdict(r).find("nothing unstable"), std::string::npos);
  EXPECT_NE(verdict(r).find(r.reason), std::string::npos);
  r.status = "done";
  r.energy_residual = 0.5;
  EXPECT_EQ(verdict(r).find("nothing unstable"), std::string::npos);
  // What both models write costs either of them the same.
  r.timing = {{"discrete forces", 12, 1}, {"output", 30, 1}};
  r.wall_seconds = 50;
  EXPECT_DOUBLE_EQ(*predicted_saving(r), (12. * 121000 / 8700 + 30) / 50);
  r.discrete_seconds = {};
  EXPECT_FALSE(predicted_saving(r));
}

// What the pure discrete model's equilibria would cost is not known: no saving is claimed.
TEST(Verdict, SaysWhatPhasesStoodFor)
{
  RunRecord r;
  r.kind = "coupled";
  r.status = "done";
  r.particles = 8700;
  r.cells = 2350;
  r.equivalent_particles = 121000;
  r.wall_seconds = 20;
  r.discrete_seconds = 12;
  r.energy_residual = 3e-5;
  r.steps = 121000000;
  r.phases = {{"static", 0, 4, 0, 120000000, 3, 90, 5e4, 1, "a bond is to break", 1.5},
              {"dynamic", 4, 4.1, 24000, 0, 0, 0, 4e4, 80, "calm", 6},
              {"static", 4.1, 5, 0, 976000, 2, 60, 5e3, 0, "end", 0.5}};
  EXPECT_FALSE(predicted_saving(r));
  EXPECT_EQ(steps_done(r), 24000);
  EXPECT_EQ(verdict(r), "8 700 particles and 2 350 cells stood for 121 000 particles; 2 static "
                        "phases and 24 000 steps stood for 121 000 000 steps; energy residual "
                        "3e-05; nothing unstable");
  r.kind = "pure_dem"; // 8700 * 24000 / 6 s, not / 20 s
  EXPECT_NE(verdict(r).find(", 34.8 million particle-steps per second"), std::string::npos)
      << verdict(r);
  const PhaseTotals t = totals(r);
  EXPECT_EQ(t.n_static, 2);
  EXPECT_EQ(t.n_dynamic, 1);
  EXPECT_EQ(t.broken, 81);
  EXPECT_EQ(t.solves, 5);
  EXPECT_EQ(t.iterations, 150);
  EXPECT_EQ(t.static_s, 2);

  r.phases.clear();
  EXPECT_EQ(steps_done(r), r.steps);
  EXPECT_EQ(phases_section(r), "");
}

TEST(Verdict, SaysWhereTheBalanceIsNotClosed)
{
  RunRecord r;
  r.kind = "coupled";
  r.status = "done";
  const auto says = [&](double residual) {
    r.energy_residual = residual;
    return verdict(r).find("above the 1e-04 of a closed balance") != std::string::npos;
  };
  EXPECT_FALSE(says(9e-5));
  EXPECT_TRUE(says(6e-4));
  EXPECT_TRUE(is_stable(r)) << "a remark, no fault";
  EXPECT_NE(verdict(r).find("nothing unstable"), std::string::npos);
  EXPECT_FALSE(says(0.5)) << "that run is not to be trusted at all";
}

TEST(Verdict, RepeatsEveryWarningWithItsEnergy)
{
  RunRecord r;
  r.kind = "pure_dem";
  r.status = "done";
  r.energy_residual = 1e-6;
  r.external_work = 2;
  r.warnings = {{"/far_field/levels is not used"}};
  EXPECT_NE(verdict(r).find(r.warnings[0].text), std::string::npos);
  EXPECT_NE(verdict(r).find("nothing unstable"), std::string::npos) << "a hint about the input";
  r.warnings.push_back({"the change of regime took energy", 3.});
  const std::string text = verdict(r);
  for (const char *part : {"levels", "change of regime", "3.00 J", "1.5 of the external work"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_EQ(text.find("nothing unstable"), std::string::npos);
}

TEST(Verdict, NothingUnstableOnlyWhenNothingWas)
{
  RunRecord sound;
  sound.kind = "coupled";
  sound.status = "done";
  sound.energy_residual = 1e-6;
  EXPECT_TRUE(is_stable(sound));
  const auto broken = [&](auto &&change) {
    RunRecord r = sound;
    change(r);
    EXPECT_EQ(verdict(r).find("nothing unstable"), std::string::npos) << verdict(r);
    return is_stable(r);
  };
  EXPECT_FALSE(broken([](RunRecord &r) { r.trusted_until = 1e-3; }));
  EXPECT_FALSE(broken([](RunRecord &r) { r.broken_in_overlap = 1; }));
  EXPECT_FALSE(broken([](RunRecord &r) { r.energy_residual = 0.1; }));
  for (const char *status : {"stopped", "interrupted", "failed", "running"})
    EXPECT_FALSE(broken([&](RunRecord &r) { r.status = status; }));
}

TEST(Headline, NamesThePeakOnlyWhereThereIsOne)
{
  RunRecord r;
  r.status = "done";
  r.largest_load = 2e3;
  EXPECT_EQ(headline(r), "Largest load 2.00 kN; nothing broke.");
  r.peak_load = r.largest_load;
  r.broken_bonds = 12;
  EXPECT_EQ(headline(r), "Peak load 2.00 kN; 12 broken faces.");
  r.broken_in_overlap = 3;
  r.status = "interrupted";
  EXPECT_EQ(headline(r),
            "The run was interrupted: peak load 2.00 kN; 12 broken faces, 3 of them in "
            "the overlap.");
}

TEST(Progress, LineShowsRateAndTimeToGo)
{
  ProgressState state;
  state.step = 1000;
  state.n_steps = 4000;
  state.time = 5e-5;
  state.broken_bonds = 12;
  state.crack_length = 0.0421;
  const std::string line = progress_line(state, 5, 2);
  // 1000 steps in 5 s: 200 steps/s, the other 3000 take 15 s.
  for (const char *part :
       {" 25 %", "1000/4000", "50.0 µs", "broken 12", "42.1 mm", "200 steps/s", "ETA 15 s"})
    EXPECT_NE(line.find(part), std::string::npos) << part << " in " << line;
}

TEST(Progress, FileGetsOneLinePerInterval)
{
  std::FILE *file = std::tmpfile();
  Progress progress(file, 2, 3600);
  EXPECT_TRUE(progress.is_due());
  progress.print({});
  EXPECT_FALSE(progress.is_due());
  progress.finish({});
  std::rewind(file);
  int lines = 0, returns = 0;
  for (int c; (c = std::fgetc(file)) != EOF;) {
    lines += c == '\n';
    returns += c == '\r';
  }
  std::fclose(file);
  EXPECT_EQ(lines, 2);
  EXPECT_EQ(returns, 0);
  EXPECT_FALSE(Progress(nullptr, 2, 0).is_due());
}
} // namespace
