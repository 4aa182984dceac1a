// What a scene says of a gauge: a quantity that is measured besides load and elongation.
#pragma once

#include "core/parameters/parameter_section.h"
#include "src/scene/point.h"

#include <string>
#include <vector>

namespace ligament::program
{
enum class GaugeKind
{
  distance,
  opening,
  strain,
  stress,
  force,
  j_integral,
  crack_tip,
  fragments,
  virial_stress,
  open_crack
};

inline const std::vector<std::string> &words(GaugeKind)
{
  static const std::vector<std::string> list = {
      "distance",   "opening",   "strain",    "stress",        "force",
      "j_integral", "crack_tip", "fragments", "virial_stress", "open_crack"};
  return list;
}

/// Most keys belong to some kinds only, see keys_of().
struct GaugeParameters
{
  std::string name;
  GaugeKind kind = GaugeKind::distance;
  std::vector<Point> points;                              // m
  Point direction = {0, 0, 0};                            // any length; 0: not given
  Point normal = {0, 0, 0};                               // 3D, of a crack
  Point lower = {-infinity, -infinity, -infinity};        // m
  Point upper = {infinity, infinity, infinity};           // m
  Point inner_lower = {0, 0, 0}, inner_upper = {0, 0, 0}; // m
  double angle = 0;                                       // rad
  std::string side_name;
  std::optional<int> side; // its number, see side_names_of
  int load = -1;           // index into Scene::loads; -1: none
  std::string tool;        // name of one
  double smoothing = 0;    // s
  double mass = 0;         // kg
};

/// The keys that this kind reads, besides name and kind.
std::vector<std::string> keys_of(GaugeKind kind);

void declare_gauge(core::ParameterSection &section, GaugeParameters &gauge);
} // namespace ligament::program
