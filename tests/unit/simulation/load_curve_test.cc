// What counts of a load over time: until it has fallen, or until the run leaves its range.
#include "src/simulation/load_curve.h"

#include <gtest/gtest.h>

using namespace ligament::program;

namespace
{
/// Loads after each other with the faces broken by then; strain is the time.
RunRecord record_of(const std::vector<std::pair<double, int>> &rows, std::size_t ends_at = 1000)
{
  LoadCurve curve;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i == ends_at)
      curve.end();
    curve.add(double(i), {rows[i].first, 10 * rows[i].first, 0, double(i)}, rows[i].second);
  }
  RunRecord record;
  curve.put_into(record);
  return record;
}

TEST(LoadCurve, ReboundsAreNoPeak)
{
  for (const double sign : {1., -1.}) {
    const RunRecord r = record_of({{0, 0},
                                   {sign * 1, 0},
                                   {sign * 2, 0},
                                   {sign * 3, 2},
                                   {sign * 0.2, 30},
                                   {sign * 4, 30},
                                   {sign * -5, 30}});
    EXPECT_EQ(r.peak_load.value(), sign * 3);
    EXPECT_EQ(r.peak_stress.value(), sign * 30);
    EXPECT_EQ(r.peak_time.value(), 3);
  }
}

// From one reading to the next: it never was below a tenth in magnitude.
TEST(LoadCurve, ALoadThatHasTurnedHasFallen)
{
  for (const double sign : {1., -1.}) {
    const RunRecord r = record_of({{0, 0}, {sign * 3, 0}, {sign * -4, 9}, {sign * 5, 9}});
    EXPECT_EQ(r.peak_load.value(), sign * 3);
  }
}

// A load of 11 % is one still: arrested cracks go on.
TEST(LoadCurve, ALoadThatHasNotFallenGoesOn)
{
  EXPECT_EQ(*record_of({{0, 0}, {1, 1}, {0.11, 5}, {2, 8}}).peak_load, 2);
}

// Between cycles the machine lets go: what bears more in the next one is no rebound. Once broken,
// it goes on pulling.
TEST(LoadCurve, UnloadingIsNoFall)
{
  LoadCurve curve;
  double time = 0;
  for (const auto &[load, strain, n_broken] :
       std::vector<std::tuple<double, double, int>>{{-1, -1, 0},
                                                    {-3, -3, 4},
                                                    {-0.1, -0.1, 4},
                                                    {0.2, 0, 4},
                                                    {-5, -6, 9},
                                                    {-0.2, -7, 90},
                                                    {-8, -8, 90}})
    curve.add(time++, {load, 10 * load, 0, strain}, n_broken);
  RunRecord record;
  curve.put_into(record);
  EXPECT_EQ(record.peak_load.value(), -5);
  EXPECT_TRUE(curve.has_fallen());
}

// What broke before the test begins has no load that could fall.
TEST(LoadCurve, NoiseIsNoLoad)
{
  EXPECT_EQ(*record_of({{0, 0}, {-2, 7}, {-3, 7}}).peak_load, -3);
  EXPECT_EQ(*record_of({{1e-12, 0}, {-2, 7}, {-3, 7}}).peak_load, -3);
}

TEST(LoadCurve, WavesWithoutFractureHaveNoPeak)
{
  const RunRecord r = record_of({{0, 0}, {1, 0}, {-2, 0}, {0.1, 0}, {1.5, 0}});
  EXPECT_FALSE(r.peak_load);
  EXPECT_FALSE(r.peak_time);
  EXPECT_EQ(*r.largest_load, -2);
  EXPECT_FALSE(r.stiffness);
  EXPECT_FALSE(record_of({{0, 0}, {0, 0}}).largest_load);
}

// What lies between rows counts where it is a peak; of many such readings one is kept for each row,
// and what a checkpoint has of them goes on.
TEST(LoadCurve, PeaksBetweenRowsCount)
{
  for (const double sign : {1., -1.}) {
    LoadCurve curve;
    const auto reading = [&](double load) { return Reading{sign * load, 10 * sign * load, 0, 0}; };
    curve.add(0, reading(0), 0);
    curve.look(1, reading(1), 0);
    curve.look(2, reading(3), 0);
    curve.look(3, reading(2), 4);
    ligament::core::State state;
    curve.save(state);
    EXPECT_EQ(state.at("load_curve").n_rows(), 2u);
    LoadCurve again;
    again.load(state);
    for (LoadCurve *c : {&curve, &again}) {
      c->look(4, reading(5), 4);
      c->add(5, reading(4), 4);
      c->look(6, reading(-9), 9); // it has fallen
      c->look(7, reading(20), 9);
      RunRecord r;
      c->put_into(r);
      EXPECT_EQ(r.peak_load.value(), sign * 5);
      EXPECT_EQ(r.peak_time.value(), 4);
      state.clear();
      c->save(state);
      EXPECT_EQ(state.at("load_curve").n_rows(), 3u);
    }
  }
}

TEST(LoadCurve, WhatComesAfterTheGuardDoesNotCount)
{
  const RunRecord r = record_of({{0, 0}, {1, 0}, {2, 0}, {3, 4}}, 3);
  EXPECT_EQ(*r.largest_load, 2);
  EXPECT_FALSE(r.peak_load) << "nothing had broken by then";
}
} // namespace
