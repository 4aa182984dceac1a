#include "src/simulation/gauges/fragments.h"

#include "core/exact_sum.h"
#include "core/files.h"
#include "fem/cell_map.h"
#include "src/output/format.h"
#include "src/simulation/disjoint_sets.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace ligament::program
{
namespace
{
template <int dim>
Vector<3> in_space(const Vector<dim> &v)
{
  Vector<3> w = Vector<3>::Zero();
  w.template head<dim>() = v;
  return w;
}

/// Vectors summed exactly.
struct VectorSum
{
  std::array<core::ExactSum, 3> sums;
  void add(const Vector<3> &v)
  {
    for (int c = 0; c < 3; ++c)
      sums[c].add(v[c]);
  }
  Vector<3> value() const { return {sums[0].value(), sums[1].value(), sums[2].value()}; }
};
template <int dim, typename Carrier>
Vector<3> velocity_of(const CoupledBody<dim> &body, const Carrier &c)
{
  return in_space<dim>(get(c.is_node ? body.far->velocity : body.zone->state.velocity, c.item));
}
} // namespace

template <int dim>
FragmentGauge<dim>::FragmentGauge(const GaugeParameters &gauge, const Scene &scene,
                                  const CoupledBody<dim> &)
    : name_(gauge.name), least_mass_(gauge.mass), density_(scene.densities())
{
}

template <int dim>
void FragmentGauge<dim>::find_pieces(const CoupledBody<dim> &body)
{
  is_known_ = true;
  n_broken_ = body.force() ? body.force()->broken_bonds().size() : 0;
  const int n_particles = body.zone ? body.zone->state.size() : 0,
            n_nodes = body.far ? body.far->mesh().n_nodes() : 0;
  const auto *overlap = body.coupler->overlap();
  DisjointSets sets(n_particles + n_nodes);
  std::vector<double> mass(n_particles + n_nodes, 0.);
  if (body.zone) {
    const auto &state = body.zone->state;
    body.force()->for_each_face(state, [&](const particles::FaceView<dim> &face) {
      if (face.j > face.i && face.bonded)
        sets.join(face.i, face.j);
    });
    for (int i = 0; i < n_particles; ++i)
      if (!overlap || overlap->member_of_particle[i] < 0)
        mass[i] = state.volume[i] * density_.at(body.force()->material(i));
  }
  if (overlap)
    for (const auto &m : overlap->members)
      sets.join(m.particle, n_particles + overlap->near_nodes[m.nodes[0]]);
  if (body.far) {
    const auto &mesh = body.far->mesh();
    for (int cell = 0; cell < mesh.n_cells(); ++cell) {
      const auto shares = fem::volume_shares(mesh, cell);
      for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
        const int node = mesh.cells[cell][a];
        sets.join(n_particles + node, n_particles + mesh.cells[cell][0]);
        mass[n_particles + node] += density_[0] * body.thickness * shares[a];
      }
    }
    for (const auto &hanging : mesh.hanging)
      for (const auto &master : hanging.masters)
        sets.join(n_particles + hanging.node, n_particles + master.first);
  }

  // Pieces by the number of their first item, then by mass.
  std::vector<int> piece_of(mass.size(), -1), members;
  std::vector<core::ExactSum> sums;
  for (int i = 0; i < int(mass.size()); ++i) {
    const int root = sets.find(i);
    if (piece_of[root] < 0) {
      piece_of[root] = int(sums.size());
      sums.emplace_back();
    }
    piece_of[i] = piece_of[root];
    sums[piece_of[i]].add(mass[i]);
  }
  std::vector<int> order(sums.size()), place(sums.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> masses;
  for (const core::ExactSum &sum : sums)
    masses.push_back(sum.value());
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return masses[a] > masses[b]; });
  mass_.clear();
  for (int k = 0; k < int(order.size()); ++k) {
    place[order[k]] = k;
    mass_.push_back(masses[order[k]]);
  }
  carriers_.clear();
  for (int i = 0; i < int(mass.size()); ++i)
    if (mass[i] > 0)
      carriers_.push_back(
          {i < n_particles ? i : i - n_particles, place[piece_of[i]], i >= n_particles, mass[i]});
  std::stable_sort(carriers_.begin(), carriers_.end(),
                   [](const Carrier &a, const Carrier &b) { return a.piece < b.piece; });
  first_.assign(mass_.size() + 1, carriers_.size());
  for (std::size_t k = carriers_.size(); k-- > 0;)
    first_[carriers_[k].piece] = k;
}

// Angular momentum is that of the carriers and of the particles' own spins; the spin is that of the
// rigid body which has it at this moment.
template <int dim>
Fragment FragmentGauge<dim>::motion(const CoupledBody<dim> &body, int piece) const
{
  Fragment f;
  f.mass = mass_[piece];
  const auto begin = first_[piece], end = first_[piece + 1];
  const auto place = [&](const Carrier &c) -> Vector<3> {
    return c.is_node
               ? in_space<dim>(body.far->mesh().nodes[c.item] + get(body.far->displacement, c.item))
               : in_space<dim>(get(body.zone->state.reference, c.item) +
                               get(body.zone->state.displacement, c.item));
  };
  VectorSum centre, momentum, angular;
  for (auto k = begin; k < end; ++k) {
    const Carrier &c = carriers_[k];
    centre.add(c.mass * place(c));
    momentum.add(c.mass * velocity_of(body, c));
    f.has_mesh = f.has_mesh || c.is_node;
    f.particles += !c.is_node;
  }
  f.centre = centre.value() / f.mass;
  f.velocity = momentum.value() / f.mass;
  std::array<core::ExactSum, 9> inertia;
  for (auto k = begin; k < end; ++k) {
    const Carrier &c = carriers_[k];
    const Vector<3> r = place(c) - f.centre;
    angular.add(c.mass * r.cross(velocity_of(body, c) - f.velocity));
    Eigen::Matrix3d own =
        c.mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    if (!c.is_node && body.zone->state.turns) {
      const double turned = body.zone->state.gyration * c.mass;
      Vector<3> spin = Vector<3>::Zero();
      if constexpr (dim == 2)
        spin[2] = body.zone->state.spin[0][c.item];
      else
        spin = get(body.zone->state.spin, c.item);
      angular.add(turned * spin);
      own += turned * Eigen::Matrix3d::Identity();
    }
    for (int a = 0; a < 9; ++a)
      inertia[a].add(own(a / 3, a % 3));
  }
  Eigen::Matrix3d total;
  for (int a = 0; a < 9; ++a)
    total(a / 3, a % 3) = inertia[a].value();
  if (dim == 2 && total(2, 2) > 0)
    f.spin[2] = angular.value()[2] / total(2, 2);
  if (dim == 3)
    f.spin = total.completeOrthogonalDecomposition().solve(angular.value());
  return f;
}

template <int dim>
std::vector<Fragment> FragmentGauge<dim>::fragments(const CoupledBody<dim> &body)
{
  if (!is_known_ || body.force()->broken_bonds().size() != n_broken_)
    find_pieces(body);
  std::vector<Fragment> list;
  for (int k = 0; k < int(mass_.size()) && mass_[k] > 0 && mass_[k] >= least_mass_; ++k)
    list.push_back(motion(body, k));
  return list;
}

template <int dim>
std::vector<Column> FragmentGauge<dim>::columns() const
{
  std::vector<Column> columns = {{name_ + "_number", "1"}, {name_ + "_largest_mass", "kg"}};
  for (int c = 0; c < dim; ++c)
    columns.push_back({fmt::format("{}_largest_v{}", name_, "xyz"[c]), "m/s"});
  return columns;
}

template <int dim>
void FragmentGauge<dim>::read(GaugeLook<dim> &look, double *values)
{
  if (!is_known_ || look.body.force()->broken_bonds().size() != n_broken_)
    find_pieces(look.body);
  values[0] = double(std::count_if(mass_.begin(), mass_.end(),
                                   [&](double m) { return m > 0 && m >= least_mass_; }));
  values[1] = mass_[0];
  VectorSum momentum;
  for (auto k = first_[0]; k < first_[1]; ++k)
    momentum.add(carriers_[k].mass * velocity_of(look.body, carriers_[k]));
  const Vector<3> velocity = momentum.value() / mass_[0];
  for (int c = 0; c < dim; ++c)
    values[2 + c] = velocity[c];
}

template <int dim>
std::string FragmentGauge<dim>::description() const
{
  return least_mass_ > 0 ? fmt::format("pieces of at least {}; a look at all faces when bonds have "
                                       "broken, and at the heaviest piece for each row",
                                       quantity(least_mass_, "kg"))
                         : "all pieces; a look at all faces when bonds have broken, and at the "
                           "heaviest piece for each row";
}

template <int dim>
void FragmentGauge<dim>::write(const CoupledBody<dim> &body, const RunFolder &folder)
{
  core::OutputFile file(folder.fragments());
  file.write("mass,x,y,z,vx,vy,vz,wx,wy,wz,particles,mesh\n"
             "kg,m,m,m,m/s,m/s,m/s,rad/s,rad/s,rad/s,1,1\n");
  for (const Fragment &f : fragments(body))
    file.write(fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", f.mass, f.centre[0],
                           f.centre[1], f.centre[2], f.velocity[0], f.velocity[1], f.velocity[2],
                           f.spin[0], f.spin[1], f.spin[2], f.particles, int(f.has_mesh)));
  file.commit();
}

template class FragmentGauge<2>;
template class FragmentGauge<3>;
} // namespace ligament::program
