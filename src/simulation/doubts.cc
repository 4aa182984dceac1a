#include "src/simulation/doubts.h"

#include "src/scene/geometry.h"
#include "src/simulation/gauges/pieces.h"
#include "src/simulation/initial_motion.h"
#include "src/simulation/load_path.h"
#include "src/simulation/test_machine.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
namespace
{
bool cuts(const Crack &crack, const BrokenBond &face, double spacing, int dim)
{
  Point a, b;
  for (int c = 0; c < 3; ++c) {
    a[c] = face.centroid[c] - spacing * face.normal[c];
    b[c] = face.centroid[c] + spacing * face.normal[c];
  }
  return crosses(crack, a, b, dim);
}

template <int dim>
void doubt_cracks(const Scene &scene, const CoupledBody<dim> &body, core::Log &log)
{
  if (!body.zone)
    return;
  const auto &cracks = scene.specimen.cracks;
  for (std::size_t k = 0; k < cracks.size(); ++k)
    if (std::none_of(body.cut_faces.begin(), body.cut_faces.end(), [&](const BrokenBond &face) {
          return cuts(cracks[k], face, body.spacing, dim);
        }))
      log.warning("no face is cut by /specimen/cracks/{}: does it lie in the material, and is it "
                  "longer than a spacing?",
                  k);
}

/// Models that are not joined are pieces in any case, and crystals have no faces.
template <int dim>
void doubt_unity(const Scene &scene, const CoupledBody<dim> &body, core::Log &log)
{
  const Specimen &s = scene.specimen;
  const bool is_cut = !s.cracks.empty() || !s.notches.empty() || !s.slots.empty();
  const bool is_joined = !body.far || body.coupler->overlap();
  if (!is_cut || !body.zone || !is_joined || scene.atoms)
    return;
  const std::vector<double> of_particles(body.zone->state.size(), 1.),
      of_nodes(body.far && body.ranks.is_first() ? body.far->mesh().n_nodes() : 0, 1.);
  const std::size_t n = find_pieces(body, of_particles, of_nodes).mass.size();
  if (n > 1)
    log.warning("cracks and notches leave the body in {} pieces from the beginning; make them "
                "smaller, unless the pieces are wanted",
                n);
}

template <int dim>
void doubt_motions(const Scene &scene, const CoupledBody<dim> &body, core::Log &log)
{
  for (std::size_t k = 0; k < scene.initial_motion.size(); ++k)
    if (!moves_any(scene.initial_motion[k].within, body))
      log.warning("/initial_motion/{} moves nothing: no particle and no node of the far field lies "
                  "within its region; make it larger, or move it",
                  k);
}

/// The particles of a layer that overhangs the last one of a lattice bear what those below can't:
/// a few at edges and corners do no harm.
template <int dim>
void doubt_flow(const CoupledBody<dim> &body, core::Log &log)
{
  if (!body.zone || !body.force())
    return;
  const particles::Part &part = body.zone->state.part;
  std::int64_t n_loose = 0;
  for (const int i : body.force()->loose_particles())
    n_loose += part.owns(i);
  n_loose = body.ranks.sum(n_loose);
  const std::int64_t n = body.ranks.sum(std::int64_t(particles::count(part.owned)));
  constexpr double most = 0.01;
  if (double(n_loose) > most * double(n))
    log.warning("{} of {} particles neither flow nor creep, as too few bonds hold their strains: "
                "outer layers of the packing that overhang a side stay elastic, and the body is "
                "too strong; give it a size that ends half a layer behind its last particles, or "
                "another packing (\"random\")",
                n_loose, n);
}

template <int dim>
void doubt_end(const Scene &scene, const CoupledBody<dim> &body, core::Log &log)
{
  if (scene.time.stop_when != StopWhen::specimen_broken)
    return;
  const int axis = TestMachine<dim>(body).axis();
  const double section = section_at_start(body, axis);
  if (section > 0 && std::isfinite(section))
    return;
  log.warning(
      "\"stop_when\" in /time waits for a body in two parts along {}, which it will not be: "
      "{}; give a \"duration\" alone",
      "xyz"[axis],
      section > 0 ? "the mesh, which does not break, joins its two ends"
                  : "nothing joins two flat sides there");
}
} // namespace

template <int dim>
void doubt_body(const Scene &scene, const CoupledBody<dim> &body, core::Log &log)
{
  doubt_cracks(scene, body, log);
  doubt_unity(scene, body, log);
  doubt_motions(scene, body, log);
  doubt_flow(body, log);
  doubt_end(scene, body, log);
}

template void doubt_body(const Scene &, const CoupledBody<2> &, core::Log &);
template void doubt_body(const Scene &, const CoupledBody<3> &, core::Log &);
} // namespace ligament::program
