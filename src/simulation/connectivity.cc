#include "src/simulation/connectivity.h"

#include <cmath>
#include <numeric>

namespace ligament::program
{
namespace
{
class Sets
{
public:
  explicit Sets(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int i, int j) { parent_[find(i)] = find(j); }

private:
  std::vector<int> parent_;
};
} // namespace

template <int dim>
bool is_broken_across(const CoupledBody<dim> &body, int axis)
{
  // Items: particles, then nodes, then the two sides.
  const int n_particles = body.zone ? body.zone->state.n_owned : 0;
  const int n_nodes = body.far ? body.far->mesh().n_nodes() : 0;
  const int low = n_particles + n_nodes, high = low + 1;
  Sets sets(high + 1);
  if (body.zone) {
    body.zone->force->for_each_face(body.zone->state, [&](const particles::FaceView<dim> &face) {
      if (face.j >= 0) {
        if (face.bonded)
          sets.join(face.i, face.j);
      } else if (std::abs(face.normal[axis]) > 0.999 &&
                 std::abs(std::abs(face.centroid[axis]) - body.upper[axis]) < 1e-6 * body.spacing)
        sets.join(face.i, face.centroid[axis] < 0 ? low : high);
    });
  }
  if (body.far) {
    const auto &mesh = body.far->mesh();
    for (const auto &cell : mesh.cells)
      for (const int node : cell)
        sets.join(n_particles + node, n_particles + cell[0]);
    for (const auto &hanging : mesh.hanging)
      for (const auto &[master, weight] : hanging.masters)
        sets.join(n_particles + hanging.node, n_particles + master);
    for (int i = 0; i < n_nodes; ++i)
      if (std::abs(std::abs(mesh.nodes[i][axis]) - body.upper[axis]) < 1e-9 * body.upper[axis])
        sets.join(n_particles + i, mesh.nodes[i][axis] < 0 ? low : high);
  }
  if (const auto *overlap = body.coupler->overlap())
    for (const auto &m : overlap->members)
      sets.join(m.particle, n_particles + overlap->near_nodes[m.nodes[0]]);
  return sets.find(low) != sets.find(high);
}

template bool is_broken_across(const CoupledBody<2> &, int);
template bool is_broken_across(const CoupledBody<3> &, int);
} // namespace ligament::program
