// The wave bench: plane packets through the overlap at all angles, out and back, both kinds.
#include "src/verification/cases.h"
#include "src/verification/wave_passage.h"

#include <fmt/format.h>

namespace ligament::program
{
namespace
{
struct BenchRow
{
  double wave_length, angle; // cells, degrees
  bool outwards;
};

/// Every share of every packet. They are stated, not bounded; what must hold is that they add up to
/// the packet's energy.
template <int dim>
std::vector<Result> measure_rows(const std::string &name, const std::vector<WaveKind> &kinds,
                                 const std::vector<BenchRow> &rows, double fine_damper,
                                 double gap_filter)
{
  constexpr const char *kind_names[] = {"P", "S", "SH"};
  std::vector<Result> results;
  for (const BenchRow &row : rows)
    for (const WaveKind kind : kinds) {
      PassageParameters p;
      p.kind = kind;
      p.wave_length = row.wave_length;
      p.angle = row.angle;
      p.outwards = row.outwards;
      p.strip.material.poissons_ratio = 0.3;
      p.strip.mesh_shift = 0.5;
      p.strip.split.fine_damper = fine_damper;
      p.strip.split.gap_filter = gap_filter;
      const PassageFigures f = measure_passage<dim>(p);
      const std::string prefix =
          fmt::format("{}/{}_{}_{:g}h_{:.1f}deg/", name, row.outwards ? "out" : "back",
                      kind_names[int(kind)], row.wave_length, f.angle);
      const auto add = [&](const char *what, double value, double must) {
        results.push_back({prefix + what, value, must, {}});
      };
      add("reflected_P", f.reflected.p, 1);
      add("reflected_S", f.reflected.s + f.reflected.rest, 1);
      add("transmitted_P", f.transmitted.p, 1.001);
      add("transmitted_S", f.transmitted.s + f.transmitted.rest, 1.001);
      add("lost", f.lost, 1);
      add("missing", std::abs(f.missing()), 1e-2);
    }
  return results;
}

std::vector<BenchRow> all_rows(const std::vector<double> &wave_lengths,
                               const std::vector<double> &angles)
{
  std::vector<BenchRow> rows;
  for (const bool outwards : {true, false})
    for (const double wave_length : wave_lengths)
      for (const double angle : angles)
        // Mesh waves much shorter than four cells don't travel.
        // Long packets at flat angles take minutes.
        if ((outwards || wave_length >= 4) && (wave_length <= 4 || angle == 0 || angle == 30))
          rows.push_back({wave_length, angle, outwards});
  return rows;
}
} // namespace

std::vector<Case> wave_bench_cases()
{
  const std::string text = "shares of packets through the overlap: ";
  const std::vector<double> angles = {0, 15, 30, 45, 60};
  const std::vector<WaveKind> plane = {WaveKind::p, WaveKind::s};
  return {{"waves_bench_2d", text + "2D, all angles, cf 4, cg 0", true,
           [=] {
             return measure_rows<2>("waves_bench_2d", plane, all_rows({8, 4, 2}, angles), 4, 0);
           }},
          {"waves_bench_2d_fracture", text + "2D, all angles, dampers for fracture", true,
           [=] {
             return measure_rows<2>("waves_bench_2d_fracture", plane, all_rows({8, 4, 2}, angles),
                                    8, 4);
           }},
          {"waves_bench_1d", text + "normal incidence, cf 4, cg 0", true,
           [=] {
             return measure_rows<2>("waves_bench_1d", plane, all_rows({16, 8, 6, 4, 3, 2, 1}, {0}),
                                    4, 0);
           }},
          {"waves_bench_3d", text + "FCC, all three kinds, cf 4, cg 0", true, [=] {
             return measure_rows<3>("waves_bench_3d",
                                    {WaveKind::p, WaveKind::s, WaveKind::s_across},
                                    all_rows({8, 4}, {0}), 4, 0);
           }}};
}
} // namespace ligament::program
