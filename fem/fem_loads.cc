// What acts on the finite half beside its cells: loads, supports, pressed faces and absorbing sides.
#include "fem/fem_solver.h"

#include "core/check.h"
#include "fem/cell_map.h"
#include "fem/part_shares.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ligament::fem
{
template <int dim>
void FemSolver<dim>::find_held_components()
{
  // Hanging nodes on a held side follow masters that lie on it, too.
  std::vector<char> is_hanging(mesh_.n_nodes(), 0);
  for (const HangingNode &h : mesh_.hanging)
    is_hanging[h.node] = 1;
  for (int c = 0; c < dim; ++c)
    held_[c].assign(mesh_.n_nodes(), 0);
  for (int l = 0; l < int(loads_.size()); ++l)
    for (const CellFace<dim> &face : mesh_.boundary_faces)
      if (face.boundary == loads_[l].boundary &&
          loads_[l].kind != core::BoundaryLoad<dim>::Kind::traction)
        for (const int a : face_nodes<dim>(face.face))
          for (int c = 0; c < dim; ++c) {
            const int node = mesh_.cells[face.cell][a];
            const double tolerance = 1e-9 * mesh_.cell_size[face.cell].minCoeff();
            if (!loads_[l].part.holds(mesh_.nodes[node], tolerance))
              continue;
            if (!loads_[l].value[c] || held_[c][node] || is_hanging[node])
              continue;
            held_[c][node] = 1;
            place_of_held_[{node, c}] = int(held_components_.size());
            held_components_.push_back({node, c, l, 0, false});
          }
}

template <int dim>
void FemSolver<dim>::add_body_forces()
{
  std::vector<double> weight = mass_;
  for (const auto &[node, mass] : weights_)
    weight[node] = mass;
  for (int l = 0; l < int(loads_.size()); ++l)
    if (loads_[l].kind == core::BoundaryLoad<dim>::Kind::acceleration)
      for (int c = 0; c < dim; ++c)
        for (int i = 0; i < mesh_.n_nodes(); ++i)
          if (loads_[l].value[c] && weight[i] != 0)
            traction_components_.push_back({i, c, l, weight[i], true});
}

template <int dim>
void FemSolver<dim>::find_pressed_faces()
{
  pressed_.clear();
  std::map<int, std::vector<std::pair<int, double>>> masters;
  for (const HangingNode &h : mesh_.hanging)
    masters[h.node].assign(h.masters.begin(), h.masters.end());
  for (int l = 0; l < int(loads_.size()); ++l) {
    if (!loads_[l].pressure)
      continue;
    std::map<int, int> first_of;
    for (const CellFace<dim> &face : mesh_.boundary_faces) {
      if (face.boundary != loads_[l].boundary || !is_own_cell_[face.cell])
        continue;
      PressedFace<dim> pressed(mesh_, face, loads_[l].part, dim == 2 ? body_.thickness : 1, l);
      std::vector<PressedShare> shares;
      for (int k = 0; k < PressedFace<dim>::n_corners; ++k) {
        const double share = pressed.shares()[k];
        if (!(share > 0))
          continue;
        std::vector<std::pair<int, double>> to = {{pressed.nodes()[k], 1.}};
        if (const auto found = masters.find(pressed.nodes()[k]); found != masters.end())
          to = found->second;
        for (const auto &[node, weight] : to) {
          const auto [place, is_new] = first_of.emplace(node, int(traction_components_.size()));
          for (int c = 0; is_new && c < dim; ++c)
            traction_components_.push_back({node, c, l, 0, false});
          shares.push_back({place->second, weight * share});
        }
      }
      if (!shares.empty())
        pressed_.emplace_back(std::move(pressed), std::move(shares));
    }
  }
}

template <int dim>
void FemSolver<dim>::add_pressures(double time)
{
  for (const auto &[face, shares] : pressed_) {
    const Vector<dim> all = -loads_[face.load()].pressure_at(time) * face.area(mesh_, displacement);
    for (const PressedShare &part : shares)
      for (int c = 0; c < dim; ++c) {
        LoadedComponent &t = traction_components_[part.first + c];
        t.force += part.share * all[c];
        force[c][t.node] += part.share * all[c];
      }
  }
}

template <int dim>
std::vector<double> FemSolver<dim>::side_areas(int boundary, bool times_depth) const
{
  std::vector<double> area(mesh_.n_nodes(), 0.);
  for (const CellFace<dim> &face : mesh_.boundary_faces)
    if (face.boundary == boundary && is_own_cell_[face.cell]) {
      const Vector<dim> &h = mesh_.cell_size[face.cell];
      Vec<n_cell_nodes<dim>> shares;
      if (mesh_.is_box(face.cell))
        shares.setConstant(h.prod() / (times_depth ? 1 : h[face.face / 2]) * body_.thickness /
                           (n_cell_nodes<dim> / 2));
      else {
        shares = face_shares<dim>(cell_corners(mesh_, face.cell), face.face) * body_.thickness;
        if (times_depth) // the mean one
          shares *= cell_volume(mesh_, face.cell) * body_.thickness / shares.sum();
      }
      for (const int a : face_nodes<dim>(face.face))
        area[mesh_.cells[face.cell][a]] += shares[a];
    }
  hand_to_masters(area);
  return area;
}

template <int dim>
std::vector<double> FemSolver<dim>::loaded_areas(const core::BoundaryLoad<dim> &load) const
{
  if (load.part.is_whole())
    return side_areas(load.boundary);
  std::vector<double> area(mesh_.n_nodes(), 0.);
  for (const CellFace<dim> &face : mesh_.boundary_faces)
    if (face.boundary == load.boundary && is_own_cell_[face.cell]) {
      const auto shares = part_shares<dim>(load.part, mesh_, face);
      for (const int a : face_nodes<dim>(face.face))
        area[mesh_.cells[face.cell][a]] += body_.thickness * shares[a];
    }
  hand_to_masters(area);
  return area;
}

template <int dim>
double FemSolver<dim>::loaded_area(int load) const
{
  double sum = 0;
  for (const double area : loaded_areas(loads_[load]))
    sum += area;
  return sum;
}

template <int dim>
int FemSolver<dim>::n_held_nodes(int load) const
{
  std::set<int> nodes;
  for (const LoadedComponent &h : held_components_)
    if (h.load == load)
      nodes.insert(h.node);
  return int(nodes.size());
}

template <int dim>
void FemSolver<dim>::find_dashpots()
{
  typename core::Dashpots<dim>::Places dashpots;
  for (const auto &load : loads_) {
    if (!load.absorbing)
      continue;
    core::require(load.boundary < inner_surface<dim>,
                  "only sides of the specimen's bounding box absorb waves; give another side");
    const int axis = load.boundary / 2;
    const Vector<dim> speed = normal_wave_speeds(body_, axis);
    const auto area = side_areas(load.boundary);
    if (std::none_of(area.begin(), area.end(), [](double a) { return a > 0; }))
      continue;
    const auto volume = side_areas(load.boundary, true);
    double place = mesh_.nodes[0][axis];
    for (const auto &node : mesh_.nodes)
      place = load.boundary % 2 ? std::max(place, node[axis]) : std::min(place, node[axis]);
    for (int i = 0; i < mesh_.n_nodes(); ++i) {
      const double depth = load.absorbing_layer - std::abs(mesh_.nodes[i][axis] - place);
      core::require(!released_node_[i] || (area[i] == 0 && depth <= 0),
                    "the overlap or its transition reaches an absorbing side of the specimen or "
                    "its layer; keep the zone away from it or lower /coupling/transition_cells");
      for (int c = 0; c < dim; ++c)
        if (!held_[c][i] && mass_[i] > 0) {
          auto &here = dashpots[{i, c}];
          if (area[i] > 0)
            here.push_back({core::Dashpot::Kind::node, area[i] * body_.density * speed[c],
                            volume[i] / area[i] / speed[c]});
          if (depth > 0)
            here.push_back(core::layer_dashpot(mass_[i], depth, load.absorbing_layer, speed[axis]));
        }
    }
  }
  dashpots_ = core::Dashpots<dim>(dashpots);
}

template <int dim>
void FemSolver<dim>::add_held_motion(double from, double to, double factor,
                                     Components<dim> &u) const
{
  for (const LoadedComponent &h : held_components_)
    u[h.component][h.node] += factor * (prescribed(h, to) - prescribed(h, from));
}

template <int dim>
void FemSolver<dim>::add_held_gap(double time, Components<dim> &u) const
{
  for (const LoadedComponent &h : held_components_)
    u[h.component][h.node] += prescribed(h, time) - displacement[h.component][h.node];
}

template <int dim>
double FemSolver<dim>::support_force(const LoadedComponent &h, double time) const
{
  const double others = force[h.component][h.node];
  if (step_ == 0 || released_node_[h.node])
    return -others;
  const double next = (prescribed(h, time + step_) - displacement[h.component][h.node]) / step_;
  const double growth = std::exp(damping_rate_ * step_ / 2);
  const double kick = growth * next - velocity[h.component][h.node] / growth;
  return mass_[h.node] * kick / step_ - others;
}

template <int dim>
void FemSolver<dim>::book_work()
{
  for (auto *components : {&held_components_, &traction_components_})
    for (LoadedComponent &c : *components) {
      const double u = displacement[c.component][c.node];
      const bool counts =
          has_previous_forces_ && (c.counts_when_released || !released_node_[c.node]);
      c.way = counts ? u - c.old_displacement : 0;
      external_work_ += (c.old_force + c.force) / 2 * c.way;
      c.old_force = c.force;
      c.old_displacement = u;
    }
  external_work_ += jumps_.book_work();
  has_previous_forces_ = true;
}

template <int dim>
void FemSolver<dim>::push(int node, const Vector<dim> &f)
{
  for (int c = 0; c < dim; ++c) {
    if (!held_[c][node]) {
      force[c][node] += f[c];
      continue;
    }
    LoadedComponent &h = held_components_[place_of_held_.at({node, c})];
    h.force -= f[c];
    h.old_force = h.force;
    external_work_ -= f[c] / 2 * h.way;
  }
}

template <int dim>
bool FemSolver<dim>::is_loaded(double time) const
{
  const auto acts = [&](const LoadedComponent &c) {
    const core::BoundaryLoad<dim> &load = loads_[c.load];
    const bool is_given = load.kind == core::BoundaryLoad<dim>::Kind::traction ||
                          load.kind == core::BoundaryLoad<dim>::Kind::acceleration;
    if (load.pressure)
      return load.pressure_at(time) != 0;
    return (is_given ? load.traction(time)[c.component] : prescribed(c, time)) != 0;
  };
  for (const auto &load : loads_)
    for (int c = 0; c < dim && load.jump_axis() >= 0; ++c)
      if (load.value[c] && load.displacement(c, time) != 0)
        return true;
  return std::any_of(held_components_.begin(), held_components_.end(), acts) ||
         std::any_of(traction_components_.begin(), traction_components_.end(), acts);
}

template <int dim>
Vector<dim> FemSolver<dim>::reaction(int load) const
{
  const auto &l = loads_[load];
  const bool is_jump = l.kind == core::BoundaryLoad<dim>::Kind::displacement && l.history.jumps();
  Vector<dim> sum = jumps_.reaction(load);
  for (const auto *components : {&held_components_, &traction_components_})
    for (const LoadedComponent &c : *components)
      if (c.load == load)
        sum[c.component] += c.force - (is_jump ? force[c.component][c.node] : 0);
  return sum;
}

template void FemSolver<2>::find_held_components();
template void FemSolver<3>::find_held_components();
template void FemSolver<2>::add_body_forces();
template void FemSolver<3>::add_body_forces();
template void FemSolver<2>::find_pressed_faces();
template void FemSolver<3>::find_pressed_faces();
template void FemSolver<2>::add_pressures(double);
template void FemSolver<3>::add_pressures(double);
template std::vector<double> FemSolver<2>::side_areas(int, bool) const;
template std::vector<double> FemSolver<3>::side_areas(int, bool) const;
template std::vector<double> FemSolver<2>::loaded_areas(const core::BoundaryLoad<2> &) const;
template std::vector<double> FemSolver<3>::loaded_areas(const core::BoundaryLoad<3> &) const;
template double FemSolver<2>::loaded_area(int) const;
template double FemSolver<3>::loaded_area(int) const;
template int FemSolver<2>::n_held_nodes(int) const;
template int FemSolver<3>::n_held_nodes(int) const;
template void FemSolver<2>::find_dashpots();
template void FemSolver<3>::find_dashpots();
template void FemSolver<2>::add_held_motion(double, double, double, Components<2> &) const;
template void FemSolver<3>::add_held_motion(double, double, double, Components<3> &) const;
template void FemSolver<2>::add_held_gap(double, Components<2> &) const;
template void FemSolver<3>::add_held_gap(double, Components<3> &) const;
template double FemSolver<2>::support_force(const LoadedComponent &, double) const;
template double FemSolver<3>::support_force(const LoadedComponent &, double) const;
template void FemSolver<2>::book_work();
template void FemSolver<3>::book_work();
template void FemSolver<2>::push(int, const Vector<2> &);
template void FemSolver<3>::push(int, const Vector<3> &);
template bool FemSolver<2>::is_loaded(double) const;
template bool FemSolver<3>::is_loaded(double) const;
template Vector<2> FemSolver<2>::reaction(int) const;
template Vector<3> FemSolver<3>::reaction(int) const;
} // namespace ligament::fem
