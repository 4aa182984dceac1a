#include "fem/join_sides.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::fem
{
namespace
{
/// Masters that hang in their turn give way to theirs.
void resolve(std::vector<HangingNode> &hanging)
{
  std::map<int, std::size_t> row_of;
  for (std::size_t h = 0; h < hanging.size(); ++h)
    row_of[hanging[h].node] = h;
  for (bool changed = true; changed;) {
    changed = false;
    for (HangingNode &h : hanging) {
      std::map<int, double> masters;
      for (const auto &[master, weight] : h.masters) {
        const auto row = row_of.find(master);
        if (row == row_of.end()) {
          masters[master] += weight;
          continue;
        }
        changed = true;
        const HangingNode &other = hanging[row->second];
        for (const auto &[further, share] : other.masters)
          masters[further] += weight * share;
        for (std::size_t a = 0; a < h.periods.size(); ++a)
          h.periods[a] += weight * other.periods[a];
      }
      h.masters.assign(masters.begin(), masters.end());
    }
  }
}
} // namespace

template <int dim>
void join_sides(Mesh<dim> &mesh, int axis, const Vector<dim> &lower, const Vector<dim> &upper)
{
  // Places across the axis, in millionths of the box: no cell is that small.
  using Place = std::array<long, dim>;
  const auto place = [&](int node) {
    Place p;
    for (int c = 0; c < dim; ++c)
      p[c] = c == axis
                 ? 0
                 : std::lround(1e6 * (mesh.nodes[node][c] - lower[c]) / (upper[c] - lower[c]));
    return p;
  };
  const double tolerance = 1e-9 * (upper[axis] - lower[axis]);
  std::vector<char> hangs(mesh.n_nodes(), 0);
  for (const HangingNode &h : mesh.hanging)
    hangs[h.node] = 1;
  std::map<Place, int> twins;
  std::vector<int> followers;
  for (int i = 0; i < mesh.n_nodes(); ++i) {
    if (std::abs(mesh.nodes[i][axis] - lower[axis]) < tolerance)
      twins[place(i)] = i;
    if (std::abs(mesh.nodes[i][axis] - upper[axis]) < tolerance)
      followers.push_back(i);
  }
  const auto refuse = [&](const Vector<dim> &x) {
    std::string at = fmt::format("{:.6g}", x[0]);
    for (int c = 1; c < dim; ++c)
      at += fmt::format(", {:.6g}", x[c]);
    throw core::InputError(fmt::format(
        "the cells at the two sides that are joined along {} differ: the node at ({}) m "
        "has no twin on the other side; place the discrete zone in the middle, or give "
        "fewer levels",
        "xyz"[axis], at));
  };
  if (twins.size() != followers.size() && twins.size() > followers.size()) {
    for (const int i : followers)
      twins.erase(place(i));
    refuse(mesh.nodes[twins.begin()->second]);
  }
  for (const int i : followers) {
    const auto twin = twins.find(place(i));
    if (twin == twins.end())
      refuse(mesh.nodes[i]);
    if (hangs[i]) // on an edge of the side: its masters follow theirs
      continue;
    HangingNode h{i, {{twin->second, 1.}}};
    h.periods[std::size_t(axis)] = 1;
    mesh.hanging.push_back(std::move(h));
  }
  resolve(mesh.hanging);
  auto &faces = mesh.boundary_faces;
  faces.erase(std::remove_if(faces.begin(), faces.end(),
                             [&](const auto &face) { return face.boundary / 2 == axis; }),
              faces.end());
}

template void join_sides(Mesh<2> &, int, const Vector<2> &, const Vector<2> &);
template void join_sides(Mesh<3> &, int, const Vector<3> &, const Vector<3> &);
} // namespace ligament::fem
