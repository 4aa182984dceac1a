#include "coupling/operators/free_normals.h"

#include "core/check.h"
#include "fem/cell_map.h"

#include <algorithm>
#include <unordered_map>

namespace ligament::coupling
{
namespace
{
using core::require;

template <int dim>
void add_normal(std::vector<Vector<dim>> &normals, const Vector<dim> &normal)
{
  for (const auto &n : normals)
    if ((n - normal).norm() < 1e-6)
      return;
  normals.push_back(normal);
}

/// Whether the mesh ends there because particles alone go on: as deep as the overlap is long.
template <int dim>
bool looks_into_zone(const Overlap<dim> &overlap, const fem::CellFace<dim> &face,
                     const core::FaceCorners<dim> &corners)
{
  if (face.boundary != inner_surface<dim>)
    return false;
  constexpr double round_off = 1e-6;
  return overlap.distance_to_edge(core::face_centroid<dim>(corners)) >
         overlap.parameters.length * (1 - round_off);
}
} // namespace

template <int dim>
std::vector<std::vector<Vector<dim>>> find_free_normals(const Overlap<dim> &overlap,
                                                        const particles::Particles<dim> &particles,
                                                        const particles::ParticleForce<dim> &force)
{
  using Face = particles::FaceView<dim>;
  const std::vector<int> members = overlap.member_particles();
  std::vector<int> near_members = members; // and their neighbours
  const auto add_neighbour = [&](const particles::Neighbour &n) { near_members.push_back(n.j); };
  force.for_each_neighbour(particles, add_neighbour, &members);
  std::sort(near_members.begin(), near_members.end());
  near_members.erase(std::unique(near_members.begin(), near_members.end()), near_members.end());

  std::unordered_map<int, std::vector<Vector<dim>>> on_surface;
  const auto add_surface = [&](const Face &face) {
    if (face.j < 0)
      add_normal<dim>(on_surface[face.i], face.normal);
  };
  force.for_each_face(particles, add_surface, &near_members);
  auto felt = on_surface;
  const auto feel = [&](const Face &face) {
    if (const auto found = on_surface.find(face.j); found != on_surface.end())
      for (const auto &normal : found->second)
        add_normal<dim>(felt[face.i], normal);
  };
  force.for_each_face(particles, feel, &members);
  std::vector<std::vector<Vector<dim>>> normals(overlap.n_nodes());
  for (const auto &m : overlap.members)
    for (const auto &normal : felt[m.particle]) {
      require((normal.cwiseAbs().array() > 1 - 1e-9).any(),
              "the overlap ends at a curved or inclined free surface, which is not supported yet; "
              "keep holes and notches away from it");
      for (const int node : m.nodes)
        add_normal<dim>(normals[node], normal);
    }
  std::vector<int> near(overlap.mesh.n_nodes(), -1);
  for (int i = 0; i < overlap.n_nodes(); ++i)
    near[overlap.near_nodes[i]] = i;
  for (const auto &face : overlap.mesh.boundary_faces) {
    const auto &nodes = overlap.mesh.cells[face.cell];
    const auto local = fem::face_nodes<dim>(face.face);
    if (std::none_of(local.begin(), local.end(), [&](int a) { return near[nodes[a]] >= 0; }))
      continue;
    const auto corners = fem::cell_corners(overlap.mesh, face.cell);
    if (looks_into_zone(overlap, face, fem::face_corners<dim>(corners, face.face)))
      continue;
    const Vector<dim> normal = fem::face_normal<dim>(corners, face.face);
    for (const int a : local)
      if (const int node = near[nodes[a]]; node >= 0)
        add_normal<dim>(normals[node], normal);
  }
  return normals;
}

template std::vector<std::vector<Vector<2>>> find_free_normals(const Overlap<2> &,
                                                               const particles::Particles<2> &,
                                                               const particles::ParticleForce<2> &);
template std::vector<std::vector<Vector<3>>> find_free_normals(const Overlap<3> &,
                                                               const particles::Particles<3> &,
                                                               const particles::ParticleForce<3> &);
} // namespace ligament::coupling
