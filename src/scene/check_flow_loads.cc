#include "src/scene/check_flow_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
constexpr double level = 1e-9; // of the larger one: tractions that balance

/// The largest value of the load's course; none of a pulse, which no static state follows.
std::optional<double> largest_factor(const History &h)
{
  if (h.pulse)
    return {};
  if (h.cycles)
    return std::abs(h.cycles->mean) + std::abs(h.cycles->amplitude);
  double largest = h.table.empty() ? 1 : 0;
  for (const auto &row : h.table)
    largest = std::max(largest, std::abs(row[1]));
  return largest;
}

/// What acts on a side along its normal: a motion, or a stress in Pa, tension positive.
struct Hold
{
  bool moves = false;
  double stress = 0;
};

/// Normal stresses of a box between its loaded sides, in Pa; nothing where they don't follow from
/// tractions on whole sides alone.
std::optional<Point> uniform_stress(const Scene &scene)
{
  Hold sides[6];
  for (const LoadParameters &load : scene.loads) {
    const int axis = load.boundary / 2;
    if (load.boundary < 0 || load.boundary >= 6 || load.periodic || load.servo || load.from ||
        load.to || !load.within.is_everything())
      return {};
    Hold &side = sides[load.boundary];
    side.moves = side.moves || load.velocity[axis] || load.displacement[axis];
    const auto factor = largest_factor(load.history);
    if (!factor || load.force[axis] || load.pressure)
      return {};
    side.stress += (load.boundary % 2 ? 1 : -1) * *factor * load.traction[axis].value_or(0);
  }
  Point stress = {0, 0, 0};
  for (int c = 0; c < scene.dimension; ++c) {
    const Hold &lower = sides[2 * c], &upper = sides[2 * c + 1];
    const double larger = std::max(std::abs(lower.stress), std::abs(upper.stress));
    const bool balance = std::abs(lower.stress - upper.stress) <= level * larger;
    if ((lower.moves && upper.moves) || (!lower.moves && !upper.moves && !balance))
      return {};
    stress[c] = lower.moves ? upper.stress : lower.stress;
  }
  if (scene.dimension == 2 && scene.plane == PlaneMode::strain)
    stress[2] = scene.material.poissons_ratio * (stress[0] + stress[1]);
  return stress;
}

/// Over the stress in the same direction under which the law begins to flow: theory.md, section
/// 1.10.
double share_of_flow(const PlasticityParameters &law, const Point &s)
{
  const double mean = (s[0] + s[1] + s[2]) / 3;
  const double shear = std::sqrt(
      0.5 * (std::pow(s[0] - mean, 2) + std::pow(s[1] - mean, 2) + std::pow(s[2] - mean, 2)));
  if (law.law == PlasticityLaw::von_mises)
    return std::sqrt(3.) * shear /
           (law.curve.empty() ? law.yield_stress.value_or(infinity) : law.curve[0].stress);
  const double sine = std::sin(*law.friction_angle), cosine = std::cos(*law.friction_angle);
  return (sine * mean + (3 - sine) / (2 * std::sqrt(3.)) * shear) / (*law.cohesion * cosine);
}
} // namespace

void check_flow_loads(const Scene &scene, Findings &f)
{
  const std::string key = "/material/plasticity";
  if (!scene.material.plasticity || !scene.far_field || !scene.specimen.is_plain() ||
      scene.zone.extent != DiscreteZone::Extent::box || !scene.specimen.periodic.empty() ||
      !scene.tools.empty() || scene.body_force.is_any() ||
      !f.sound({"/material", "/loads", "/dimension", "/plane"}))
    return;
  const auto stress = uniform_stress(scene);
  const double share = stress ? share_of_flow(*scene.material.plasticity, *stress) : 0;
  if (share < 1)
    return;
  f.warning(
      key,
      fmt::format("the loads alone stress the body by {:.0f} % of what makes its material flow",
                  100 * share),
      "overlap and far field stay elastic: the run will end where they would flow",
      "load less, let the zone fill the specimen, or give \"plasticity\" to an inclusion "
      "inside the zone alone");
}
} // namespace ligament::program
