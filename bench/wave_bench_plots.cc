// Plots and tables of the wave bench: `wave_bench_plots FOLDER FILE...` reads what
// `ligament verify waves_bench --full --json` printed, writes SVG files into FOLDER, and prints the
// tables of docs/verification_wave_bench.md.
#include "src/drawing/plot.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <tuple>

namespace
{
using namespace ligament::program;

constexpr std::array schemes = {"fine_scale_split", "acceleration", "xiao_belytschko",
                                "xiao_belytschko_lumped", "pointwise"};

/// One packet; angles as asked for are told from the real ones by rounding to 15 degrees.
struct Key
{
  std::string bench, scheme, way, kind;
  double wave_length; // cells
  int angle;          // degrees

  bool operator<(const Key &o) const
  {
    return std::tie(bench, scheme, way, kind, wave_length, angle) <
           std::tie(o.bench, o.scheme, o.way, o.kind, o.wave_length, o.angle);
  }
};
struct Shares
{
  double reflected = 0, transmitted = 0, lost = 0;
};
using Table = std::map<Key, Shares>;

/// "waves_bench_2d_acceleration/out_P_4h_30.0deg/lost" and its value.
void take(Table &table, const std::string &name, double value)
{
  const auto first = name.find('/'), last = name.rfind('/');
  const std::string start = "waves_bench_";
  if (name.compare(0, start.size(), start) != 0 || first == last)
    return;
  const std::string bench = name.substr(start.size(), 2);
  char way[8], kind[8];
  double wave_length, angle;
  if (std::sscanf(name.substr(first + 1).c_str(), "%7[a-z]_%7[A-Z]_%lfh_%lfdeg", way, kind,
                  &wave_length, &angle) != 4)
    return;
  Shares &shares = table[{bench, name.substr(start.size() + 3, first - start.size() - 3), way, kind,
                          wave_length, int(15 * std::lround(angle / 15))}];
  const std::string what = name.substr(last + 1);
  if (what == "lost")
    shares.lost = value;
  else if (what.compare(0, 9, "reflected") == 0)
    shares.reflected += value;
  else if (what.compare(0, 11, "transmitted") == 0)
    shares.transmitted += value;
}

Table read(int n, char **files)
{
  Table table;
  for (int i = 0; i < n; ++i) {
    std::ifstream file(files[i]);
    std::string line, last;
    while (std::getline(file, line))
      if (!line.empty() && line[0] == '{')
        last = line;
    const auto json = nlohmann::json::parse(last);
    for (const auto &c : json.at("cases"))
      take(table, c.at("name"), c.at("value"));
  }
  return table;
}

/// Curves of all schemes over wave length (at normal incidence) or angle (at this wave length).
void plot(const Table &table, const std::string &file, const std::string &title, const Key &like,
          bool over_angle, double Shares::*share)
{
  Plot plot;
  plot.title = title;
  plot.x = {over_angle ? "angle of incidence in degrees" : "wave length in cells", "", false};
  plot.y = {"share of the energy", "", true};
  for (const char *scheme : schemes) {
    Series series{scheme, {}, {}};
    series.markers = true;
    for (const auto &[key, shares] : table)
      if (key.bench == like.bench && key.scheme == scheme && key.way == like.way &&
          key.kind == like.kind &&
          (over_angle ? key.wave_length == like.wave_length : key.angle == like.angle))
      {
        series.x.push_back(over_angle ? key.angle : key.wave_length);
        series.y.push_back(shares.*share > 1e-8 ? shares.*share : NAN); // below: round-off
      }
    if (!series.x.empty())
      plot.series.push_back(series);
  }
  std::ofstream(file) << draw_plot(plot);
}

std::string number(double value)
{
  return value < 1e-8  ? "0"
         : value < 0.1 ? fmt::format("{:.1e}", value)
                       : fmt::format("{:.3f}", value);
}

/// A row per packet, a column per scheme: reflected, lost.
void print(const Table &table, const std::string &bench, const char *title)
{
  fmt::print("\n| {} |", title);
  for (const char *scheme : schemes)
    fmt::print(" `{}` |", scheme);
  fmt::print("\n|---|---|---|---|---|---|\n");
  for (const std::string way : {"out", "back"})
    for (const double wave_length : {16., 8., 6., 4., 3., 2., 1.})
      for (const int angle : {0, 15, 30, 45, 60})
        for (const std::string kind : {"P", "S"}) {
          const auto of = [&](const char *scheme) {
            return table.find({bench, scheme, way, kind, wave_length, angle});
          };
          if (of(schemes[0]) == table.end())
            continue;
          fmt::print("| {} {}, {:g} h{} |", way, kind, wave_length,
                     bench == "2d" ? fmt::format(", {}°", angle) : "");
          for (const char *scheme : schemes) {
            const auto found = of(scheme);
            fmt::print(" {} |", found == table.end()
                                    ? "-"
                                    : fmt::format("{}, {}", number(found->second.reflected),
                                                  number(found->second.lost)));
          }
          fmt::print("\n");
        }
}
} // namespace

int main(int n, char **words)
{
  if (n < 3) {
    fmt::print(stderr, "wave_bench_plots FOLDER FILE...\n");
    return 2;
  }
  const Table table = read(n - 2, words + 2);
  const std::string folder = words[1];
  for (const std::string kind : {"P", "S"}) {
    const auto file = [&](const char *what) {
      return fmt::format("{}/waves_{}_{}.svg", folder, what, kind);
    };
    plot(table, file("normal_reflected"), kind + " waves at normal incidence: reflected",
         {"1d", "", "out", kind, 0, 0}, false, &Shares::reflected);
    plot(table, file("normal_lost"), kind + " waves at normal incidence: lost",
         {"1d", "", "out", kind, 0, 0}, false, &Shares::lost);
    plot(table, file("oblique_reflected"), kind + " waves of 4 cells out of the packing: reflected",
         {"2d", "", "out", kind, 4, 0}, true, &Shares::reflected);
    plot(table, file("oblique_back"), kind + " waves of 4 cells into the packing: reflected",
         {"2d", "", "back", kind, 4, 0}, true, &Shares::reflected);
  }
  print(table, "1d", "normal");
  print(table, "2d", "oblique");
  print(table, "3d", "FCC, normal");
  return 0;
}
