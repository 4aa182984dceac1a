#include "src/scene/gauge_parameters.h"

#include "src/scene/scene.h"

namespace ligament::program
{
std::vector<std::string> keys_of(GaugeKind kind)
{
  switch (kind) {
  case GaugeKind::distance:
    return {"points"};
  case GaugeKind::opening:
    return {"points", "direction"};
  case GaugeKind::strain:
  case GaugeKind::stress:
    return {"points", "lower", "upper", "angle"};
  case GaugeKind::force:
    return {"side", "load", "tool"};
  case GaugeKind::j_integral:
    return {"lower", "upper", "inner_lower", "inner_upper", "direction", "normal"};
  case GaugeKind::crack_tip:
    return {"points", "direction", "smoothing"};
  case GaugeKind::virial_stress:
    return {"lower", "upper", "angle"};
  case GaugeKind::open_crack:
    return {"points", "direction"};
  default:
    return {"mass"};
  }
}

// clang-format off
void declare_gauge(core::ParameterSection &s, GaugeParameters &g)
{
  s.add("name", g.name, "of its columns: letters, digits and _; each gauge has its own").required();
  s.add("kind", g.kind, "distance: change of the distance between two points; opening: motion of the second point against the first along a direction; strain, stress: at a point or averaged over a box; force: of the loads on a side, or of one load; j_integral: energy release rate at a crack tip between two rectangles, and K from it; crack_tip: how far a crack has come; fragments: pieces of the body; virial_stress: mean of the atoms outside the overlap, all or those in a box; open_crack: how far a crack between atoms stands open, to both sides", words(GaugeKind())).required();
  s.add("points", g.points, "distance, opening: the two points; strain, stress: the point, in place of a box; crack_tip, open_crack: where the crack starts").in("m").usually(0, 1e4, "mm um");
  s.add("direction", g.direction, "opening: along which, default from the first point to the second; j_integral, crack_tip: in which the crack grows, for j_integral along an axis; open_crack: along it, both ways; of any length");
  s.add("normal", g.normal, "j_integral: the axis across the crack's faces; J is the mean along the front through the whole specimen").only_in(3);
  s.add("lower", g.lower, "strain, stress, virial_stress: corner of the box with the smallest coordinates, null: reaches through the specimen; j_integral: of the outer rectangle").in("m").usually(0, 1e4, "mm um").null_means(-infinity);
  s.add("upper", g.upper, "the corner with the largest coordinates, likewise").in("m").usually(0, 1e4, "mm um").null_means(infinity);
  s.add("inner_lower", g.inner_lower, "j_integral: the same corner of the inner rectangle, which holds the tip").in("m").usually(0, 1e4, "mm um");
  s.add("inner_upper", g.inner_upper, "j_integral: its other corner").in("m").usually(0, 1e4, "mm um");
  s.add("angle", g.angle, "strain, stress, virial_stress: of the gauge's x against that of the specimen, about z").in("rad").usually(0, 6.3, "deg mrad").at_least(-1000).at_most(1000);
  s.add("side", g.side_name, "force: all loads on this side of the specimen together");
  s.add("load", g.load, "force: one load, by its number in /loads from 0; -1: none").at_least(-1);
  s.add("tool", g.tool, "force: of this tool, by its name");
  s.add("smoothing", g.smoothing, "crack_tip: the speed is the mean one over this time before; 0: a fiftieth of the duration").in("s").usually(1e-12, 1e5, "us ms ns").at_least(0);
  s.add("mass", g.mass, "fragments: lighter pieces are not counted").in("kg").usually(1e-24, 1e12, "g mg").at_least(0);
}
// clang-format on
} // namespace ligament::program
