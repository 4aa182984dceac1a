// The wave bench: plane packets through the overlap at all angles, out and back, both kinds, every
// coupling scheme.
#include "src/verification/cases.h"
#include "src/verification/cases/wave_passage.h"

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

struct Bench
{
  std::string name;
  coupling::Scheme scheme;
  std::vector<BenchRow> rows;
  double fine_damper = 4, gap_filter = 0;
};

/// Shares of one packet. They are stated, not bounded; what must hold is that they add up to the
/// packet's energy.
template <int dim>
void measure_row(const Bench &bench, const BenchRow &row, WaveKind kind,
                 std::vector<Result> &results)
{
  PassageParameters p;
  p.kind = kind;
  p.wave_length = row.wave_length;
  p.angle = row.angle;
  p.outwards = row.outwards;
  p.strip.material.poissons_ratio = 0.3;
  p.strip.mesh_shift = 0.5;
  p.strip.scheme = bench.scheme;
  p.strip.split.fine_damper = p.strip.bridging.fine_damper = bench.fine_damper;
  p.strip.split.gap_filter = bench.gap_filter;
  const PassageFigures f = measure_passage<dim>(p);
  const std::string prefix =
      fmt::format("{}/{}_{}_{:g}h_{:.1f}deg/", bench.name, row.outwards ? "out" : "back",
                  kind == WaveKind::p ? "P" : "S", row.wave_length, f.angle);
  const auto add = [&](const char *what, double value, double must) {
    results.push_back({prefix + what, value, must, {}});
  };
  add("reflected_P", f.reflected.p, 1.001);
  add("reflected_S", f.reflected.s + f.reflected.rest, 1.001);
  add("transmitted_P", f.transmitted.p, 1.001);
  add("transmitted_S", f.transmitted.s + f.transmitted.rest, 1.001);
  add("lost", f.lost, 1);
  add("missing", std::abs(f.missing()), 1e-2);
}

template <int dim>
Case bench_case(const Bench &bench, const std::string &text)
{
  return {bench.name, "shares of packets through the overlap: " + text, true, [bench] {
            std::vector<Result> results;
            for (const BenchRow &row : bench.rows)
              for (const WaveKind kind : {WaveKind::p, WaveKind::s})
                measure_row<dim>(bench, row, kind, results);
            return results;
          }};
}
} // namespace

std::vector<Case> wave_bench_cases()
{
  using coupling::Scheme;
  const auto normal = all_rows({16, 8, 6, 4, 3, 2, 1}, {0});
  const auto oblique = all_rows({8, 4, 2}, {0, 15, 30, 45, 60});
  const std::vector<BenchRow> three_d = {{4, 0, true}, {2, 0, true}, {4, 0, false}};
  std::vector<Case> cases;
  for (const auto scheme : {Scheme::fine_scale_split, Scheme::acceleration, Scheme::xiao_belytschko,
                            Scheme::xiao_belytschko_lumped, Scheme::pointwise})
  {
    const auto name = [&](const char *bench) {
      return bench + ("_" + coupling::scheme_names[int(scheme)]);
    };
    cases.push_back(
        bench_case<2>({name("waves_bench_1d"), scheme, normal}, "normal incidence, cf 4, cg 0"));
    cases.push_back(
        bench_case<2>({name("waves_bench_2d"), scheme, oblique}, "2D, all angles, cf 4, cg 0"));
    cases.push_back(bench_case<3>({name("waves_bench_3d"), scheme, three_d},
                                  "FCC, normal incidence, cf 4, cg 0"));
  }
  cases.push_back(
      bench_case<2>({"waves_bench_2d_fracture", Scheme::fine_scale_split, oblique, 8, 4},
                    "2D, all angles, dampers for fracture"));
  return cases;
}
} // namespace ligament::program
