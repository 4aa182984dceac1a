// Tables are read as they are meant, and wrong ones are told by file, line, column and reason.
#include "core/check.h"
#include "core/files.h"
#include "tests/unit/md/potentials.h"

#include <fmt/format.h>

#include <fstream>

namespace ligament::md::testing
{
/// funcfl: 5 densities, 10 distances of step 0.5, cut-off 4; functions that end there.
std::string small_funcfl(const std::string &head = "29 63.5 3.6 FCC",
                         const std::string &grids = "5 0.25 10 0.5 4.0")
{
  return "a comment\n" + head + "\n" + grids +
         "\n0 -1 -1.5 -1.8 -2\n"
         "9 8 7 5 3\n1 0.3 0.02 0 0\n"
         "8 7 6 5 4\n3 2 1D-2 0 0\n";
}

/// Two species; the pair of them is -1, 1 at 2.5.
std::string small_setfl(const std::string &names = "2 Aa Bb")
{
  const std::string function = "8 7 6 5 4 3 2 0.01 0 0\n", embedding = "0 -1 -1.5 -1.8 -2\n";
  return "one\ntwo\nthree\n" + names + "\n5 0.25 10 0.5 4.0\n" + "1 10.0 3 fcc\n" + embedding +
         function + "2 20.0 3 bcc\n" + embedding + "4 4 4 4 4 4 4 0 0 0\n" + function +
         "-8 -7 -6 -5 -4 -3 -2 0 0 0\n" + function;
}

std::string path_of(const std::string &text)
{
  static int number = 0;
  const std::string path = ::testing::TempDir() + fmt::format("table_{}.txt", number++);
  std::ofstream(path) << text;
  return path;
}

template <typename Read>
std::string complaint(Read &&read)
{
  try {
    read();
  } catch (const core::InputError &error) {
    return error.what();
  }
  return "nothing";
}

/// Functions that end smoothly at their cut-off may be followed by any number of zeros.
TEST(TableFileTest, TablesMayGoOnBehindTheCutOff)
{
  for (const int n : {110, 160, 240}) { // up to 5.5, 8 and 12 angstrom
    std::string functions;
    for (const double size : {9., 3.})
      for (int k = 0; k < n; ++k)
        functions += fmt::format("{}\n", size * std::pow(std::max(0., 1 - 0.05 * k / 4.95), 3));
    const std::string text = fmt::format("a comment\n29 63.5 3.6 FCC\n5 0.25 {} 0.05 4.95\n"
                                         "0 -1 -1.5 -1.8 -2\n",
                                         n) +
                             functions;
    EXPECT_NEAR(read_funcfl({path_of(text)}).cutoff(), 4.95 * angstrom, 1e-24) << n;
  }
}

TEST(TableFileTest, ValuesOfTheFileAreThoseOfThePotential)
{
  const Potential p = read_funcfl({path_of(small_funcfl())});
  EXPECT_EQ(p.species(0).name, "29");
  EXPECT_NEAR(p.species(0).mass, 63.5 * atomic_mass_unit, 1e-40);
  EXPECT_NEAR(p.species(0).lattice_parameter, 3.6 * angstrom, 1e-25);
  EXPECT_EQ(p.species(0).lattice, "fcc");
  EXPECT_NEAR(p.cutoff(), 4 * angstrom, 1e-24);
  EXPECT_NEAR(p.embedding(0, 0.5).value, -1.5 * electron_volt, 1e-33);
  const BondJets at_2_5 = p.bond(0, 0, 2.5 * angstrom);
  EXPECT_NEAR(at_2_5.pair.value, 27.2 * 0.529 / 2.5 * electron_volt, 1e-14 * electron_volt);
  EXPECT_NEAR(at_2_5.density_at_i.value, 3, 1e-14);

  const Potential q = read_setfl(path_of(small_setfl()), {"Bb", "Aa"});
  EXPECT_EQ(q.species(1).name, "Aa");
  EXPECT_NEAR(q.species(0).mass, 20 * atomic_mass_unit, 1e-40);
  const BondJets mixed = q.bond(0, 1, 1.5 * angstrom); // at Bb, of Aa
  EXPECT_NEAR(mixed.pair.value, -5 / 1.5 * electron_volt, 1e-14 * electron_volt);
  EXPECT_NEAR(mixed.density_at_i.value, 5, 1e-14);
  EXPECT_NEAR(mixed.density_at_j.value, 4, 1e-14);
  EXPECT_NEAR(q.bond(1, 0, 1.5 * angstrom).density_at_i.value, 4, 1e-14);
}

// In the section of a species stand the densities that it adds at each species in turn.
TEST(TableFileTest, FinnisSinclairDensitiesBelongToPairs)
{
  const auto row = [](double a) { return fmt::format("{0} {0} {0} {0} {0} {0} 0 0 0 0\n", a); };
  const std::string text = "1\n2\n3\n2 Aa Bb\n5 0.25 10 0.5 4.0\n1 10.0 3 fcc\n0 -1 -2 -3 -4\n" +
                           row(1) + row(2) + "2 20.0 3 bcc\n0 -1 -2 -3 -4\n" + row(3) + row(4) +
                           row(5) + row(6) + row(7);
  const Potential p = read_setfl_fs(path_of(text), {"Aa", "Bb"});
  const double r = 1.5 * angstrom;
  EXPECT_NEAR(p.bond(0, 0, r).density_at_i.value, 1, 1e-14);
  EXPECT_NEAR(p.bond(1, 0, r).density_at_i.value, 2, 1e-14); // of Aa at Bb
  EXPECT_NEAR(p.bond(0, 1, r).density_at_i.value, 3, 1e-14); // of Bb at Aa
  EXPECT_NEAR(p.bond(0, 1, r).density_at_j.value, 2, 1e-14);
  EXPECT_NEAR(p.bond(0, 1, r).pair.value, 6 / 1.5 * electron_volt, 1e-13 * electron_volt);
}

TEST(TableFileTest, WrongFilesAreToldByTheirPlace)
{
  const auto funcfl = [](const std::string &text) {
    return complaint([&] { read_funcfl({path_of(text)}); });
  };
  const auto expect = [](const std::string &said, const std::string &place,
                         const std::string &reason) {
    EXPECT_NE(said.find(place), std::string::npos) << said;
    EXPECT_NE(said.find(reason), std::string::npos) << said;
  };
  const std::string good = small_funcfl();
  EXPECT_EQ(funcfl(good), "nothing");
  expect(funcfl(good.substr(0, good.size() - 4)), ".txt:8:10: ", "number 9 of 10 of the density");
  expect(funcfl("a comment"), ".txt:1:10: ", "cut short");
  expect(funcfl(""), ".txt:1:1: ", "cut short");
  expect(funcfl(good + "7\n"), ".txt:9:1: ", "goes on behind its last table");
  std::string wrong = good;
  wrong.replace(wrong.find("-1.5"), 4, "-1,5");
  expect(funcfl(wrong), ".txt:4:6: ", "\"-1,5\" is no finite number");
  wrong.replace(wrong.find("-1,5"), 4, "nan ");
  expect(funcfl(wrong), ".txt:4:6: ", "\"nan\" is no finite number");
  expect(funcfl(small_funcfl("29 0 3.6 FCC")), ".txt:2:4: ", "mass is not above 0");
  expect(funcfl(small_funcfl("29 -1 3.6 FCC")), ".txt:2:4: ", "mass is not above 0");
  expect(funcfl(small_funcfl("29 63.5 3.6 FCC", "5 -0.25 10 0.5 4")), ".txt:3:3: ", "must rise");
  expect(funcfl(small_funcfl("29 63.5 3.6 FCC", "5 0.25 10 0 4")), ".txt:3:11: ", "must rise");
  expect(funcfl(small_funcfl("29 63.5 3.6 FCC", "5 0.25 10 0.5 5.5")),
         ".txt:3:15: ", "beyond the table");
  expect(funcfl(small_funcfl("29 63.5 3.6 FCC", "5 0.25 10.5 0.5 4")),
         ".txt:3:8: ", "whole number");
  expect(funcfl(small_funcfl("29 63.5 3.6 FCC", "5 0.25 10 0.5 3")), "", "at the cut-off 3");
  expect(complaint([&] { read_setfl(path_of(small_setfl()), {"Cc"}); }),
         ".txt:4:6: ", "no species \"Cc\": the file has Aa, Bb");
  expect(complaint([&] { read_setfl(path_of(small_setfl("3 Aa Bb")), {"Aa"}); }),
         ".txt:5:", "number of densities");
  EXPECT_THROW(read_funcfl({"no such file"}), core::EnvironmentError);
}

// One step before its last knot, or between two.
TEST(TableFileTest, ACutOffMayLieBetweenKnotsAndOneStepBehind)
{
  EXPECT_NEAR(read_funcfl({path_of(small_funcfl("1 1 1 x", "5 0.25 10 0.5 5.0"))}).cutoff(),
              5 * angstrom, 1e-24);
  // Functions (1 - x/4.23)^2, whose spline is exact.
  std::string columns;
  for (int column = 0; column < 2; ++column)
    for (int k = 0; k < 50; ++k)
      columns += fmt::format(" {:.17g}", k < 43 ? std::pow(1 - 0.1 * k / 4.23, 2) : 0.);
  const Potential between =
      read_funcfl({path_of("comment\n1 1 1 x\n5 0.25 50 0.1 4.23\n0 -1 -1.5 -1.8 -2\n" + columns)});
  EXPECT_NEAR(between.cutoff(), 4.23 * angstrom, 1e-24);
  EXPECT_LT(between.pair_spline(0, 0).step(), 0.1 * angstrom);
  for (double x = 1; x < 3.5; x += 0.0321)
    EXPECT_NEAR(between.bond(0, 0, x * angstrom).density_at_i.value, std::pow(1 - x / 4.23, 2),
                1e-6);
}
} // namespace ligament::md::testing
