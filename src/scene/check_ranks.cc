#include "src/scene/check_ranks.h"

#include "src/scene/fracture_energy.h"

#include <fmt/format.h>

namespace ligament::program
{
namespace
{
const std::string remedy = "leave -n out, or mpirun and srun";

class Refusals
{
public:
  explicit Refusals(const core::JsonValue &json) : json_(json) {}

  void add_where(bool is_there, const std::string &key, const std::string &what,
                 const std::string &reason)
  {
    if (is_there)
      found_.push_back(
          {core::place_of(json_, key), key, what + " on several ranks", reason, remedy});
  }
  std::vector<core::Diagnostic> take() { return std::move(found_); }

private:
  const core::JsonValue &json_;
  std::vector<core::Diagnostic> found_;
};

void look_at_material(const Scene &scene, const MaterialParameters &material,
                      const std::string &key, Refusals &refusals)
{
  const std::string reason = "what such a material remembers stays with its rank";
  const bool flows = material.plasticity || material.viscosity,
             softens = material.fracture.criterion != Criterion::none &&
                       fracture_energy(scene, material).value_or(0) > 0;
  refusals.add_where(flows && softens, key + "/fracture", "faces that soften in what flows",
                     "what their particles answer is tried in one process");
  refusals.add_where(material.fracture.rebonding.has_value(), key + "/fracture/rebonding",
                     "faces that are bonded again", reason);
}
} // namespace

std::vector<core::Diagnostic> refused_on_ranks(const ReadResult &input)
{
  const Scene &scene = *input.scene;
  Refusals refusals(input.json);
  refusals.add_where(scene.zone.extent == DiscreteZone::Extent::none, "/discrete_zone",
                     "finite elements alone", "particles are what ranks share");
  refusals.add_where(scene.far_field && coupling::is_energy_weighted(scene.coupling.scheme),
                     "/coupling/scheme", "an energy-weighted scheme",
                     "its multipliers are solved for in one process");
  refusals.add_where(scene.atoms.has_value(), "/atoms", "atoms",
                     "their forces know no parts of a body");
  look_at_material(scene, scene.material, "/material", refusals);
  refusals.add_where(!scene.inclusions.empty(), "/inclusions", "inclusions",
                     "pressures where materials meet are solved for in one process");
  refusals.add_where(!scene.specimen.periodic.empty(), "/specimen/periodic", "joined sides",
                     "images of particles are looked for in one process");
  refusals.add_where(!scene.tools.empty(), "/tools", "tools",
                     "the surface that they touch is known in one process");
  refusals.add_where(scene.time.loading == Loading::sequential, "/time/loading",
                     "loading bond by bond", "its equilibria are solved for in one process");
  refusals.add_where(scene.time.rest_threshold > 0, "/time/rest_threshold",
                     "a threshold below which blocks rest",
                     "which blocks there are depends on the parts");
  return refusals.take();
}
} // namespace ligament::program
