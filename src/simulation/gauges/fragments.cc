#include "src/simulation/gauges/fragments.h"

#include "core/exact_sum.h"
#include "core/files.h"
#include "fem/cell_map.h"
#include "src/output/format.h"
#include "src/simulation/gauges/mesh_share.h"
#include "src/simulation/gauges/pieces.h"

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
  /// Of all ranks.
  Vector<3> value(const core::Ranks &ranks) const
  {
    const auto all = ranks.sum(std::vector<core::ExactSum>(sums.begin(), sums.end()));
    return {all[0].value(), all[1].value(), all[2].value()};
  }
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
    : name_(gauge.name), least_mass_(gauge.mass), rebonds_(scene.rebonds()),
      density_(scene.densities())
{
}

template <int dim>
void FragmentGauge<dim>::follow(const CoupledBody<dim> &body)
{
  const std::int64_t n = body.force() ? body.force()->n_broken() : 0;
  if (n == n_broken_ && !rebonds_) // faces that are bonded again, and tear again, count once
    return;
  n_broken_ = n;
  std::vector<double> particle_mass(body.zone ? body.zone->state.size() : 0, 0.),
      node_mass(body.far && body.ranks.is_first() ? body.far->mesh().n_nodes() : 0, 0.);
  const auto *overlap = body.coupler->overlap();
  if (body.zone) {
    const auto &state = body.zone->state;
    particles::for_each(state.part.owned, [&](int i) {
      const double share = overlap ? overlap->weight(get(state.reference, i)) : 1;
      particle_mass[i] = share * state.volume[i] * density_.at(body.force()->material(i));
    });
  }
  if (!node_mass.empty()) {
    const auto &mesh = body.far->mesh();
    const MeshShare<dim> of_mesh(body);
    const double density = density_[0] * body.thickness;
    for (int cell = 0; cell < mesh.n_cells(); ++cell) {
      const auto add = [&](const auto &shares, double volume) {
        for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
          node_mass[mesh.cells[cell][a]] += density * volume * shares[a];
      };
      if (of_mesh.is_shared(cell))
        of_mesh.for_each_point(cell, [&](const Vector<dim> &x, double volume) {
          add(fem::shape_values(mesh, cell, x), volume);
        });
      else
        add(fem::volume_shares(mesh, cell), 1);
    }
  }
  BodyPieces pieces = find_pieces(body, particle_mass, node_mass);
  mass_ = std::move(pieces.mass);
  carriers_.clear();
  for (int i = 0; i < int(particle_mass.size()); ++i)
    if (particle_mass[i] > 0)
      carriers_.push_back({i, pieces.of_particle[i], false, particle_mass[i]});
  for (int i = 0; i < int(node_mass.size()); ++i)
    if (node_mass[i] > 0)
      carriers_.push_back({i, pieces.of_node[i], true, node_mass[i]});
  std::stable_sort(carriers_.begin(), carriers_.end(),
                   [](const Carrier &a, const Carrier &b) { return a.piece < b.piece; });
  first_.assign(mass_.size() + 1, 0);
  for (const Carrier &c : carriers_)
    ++first_[c.piece + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
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
  const auto *overlap = body.coupler->overlap();
  for (auto k = begin; k < end; ++k) {
    const Carrier &c = carriers_[k];
    centre.add(c.mass * place(c));
    momentum.add(c.mass * velocity_of(body, c));
    f.has_mesh = f.has_mesh || c.is_node;
    f.particles += !c.is_node && (!overlap || overlap->member_of_particle[c.item] < 0);
  }
  const core::Ranks &ranks = body.ranks;
  f.particles = ranks.sum(f.particles);
  f.has_mesh = ranks.any(f.has_mesh);
  f.centre = centre.value(ranks) / f.mass;
  f.velocity = momentum.value(ranks) / f.mass;
  std::vector<core::ExactSum> inertia(9);
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
  inertia = ranks.sum(inertia);
  const Vector<3> momentum_about = angular.value(ranks);
  Eigen::Matrix3d total;
  for (int a = 0; a < 9; ++a)
    total(a / 3, a % 3) = inertia[a].value();
  if (dim == 2 && total(2, 2) > 0)
    f.spin[2] = momentum_about[2] / total(2, 2);
  if (dim == 3)
    f.spin = total.completeOrthogonalDecomposition().solve(momentum_about);
  return f;
}

template <int dim>
std::vector<Fragment> FragmentGauge<dim>::fragments(const CoupledBody<dim> &body)
{
  follow(body);
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
  follow(look.body);
  values[0] = double(std::count_if(mass_.begin(), mass_.end(),
                                   [&](double m) { return m > 0 && m >= least_mass_; }));
  values[1] = mass_[0];
  VectorSum momentum;
  for (auto k = first_[0]; k < first_[1]; ++k)
    momentum.add(carriers_[k].mass * velocity_of(look.body, carriers_[k]));
  const Vector<3> velocity = momentum.value(look.body.ranks) / mass_[0];
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
  const std::vector<Fragment> list = fragments(body);
  if (!body.ranks.is_first())
    return;
  core::OutputFile file(folder.fragments());
  file.write("mass,x,y,z,vx,vy,vz,wx,wy,wz,particles,mesh\n"
             "kg,m,m,m,m/s,m/s,m/s,rad/s,rad/s,rad/s,1,1\n");
  for (const Fragment &f : list)
    file.write(fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", f.mass, f.centre[0],
                           f.centre[1], f.centre[2], f.velocity[0], f.velocity[1], f.velocity[2],
                           f.spin[0], f.spin[1], f.spin[2], f.particles, int(f.has_mesh)));
  file.commit();
}

template class FragmentGauge<2>;
template class FragmentGauge<3>;
} // namespace ligament::program
