#include "src/simulation/larger_zone.h"

#include "core/check.h"
#include "core/polar_rotation.h"
#include "fem/cell_map.h"
#include "particles/orientation.h"
#include "src/simulation/body_names.h"
#include "src/simulation/energy_ledger.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
using core::require;

bool has(const core::Table &table, std::int64_t name)
{
  return std::binary_search(table.keys().begin(), table.keys().end(), name);
}

/// Loads remember the motion of their faces, which new ones don't have.
template <int dim>
void require_free_side(const CoupledBody<dim> &body, const Vector<dim> &x)
{
  for (const core::BoundaryLoad<dim> &load : body.loads) {
    if (load.boundary < 0)
      continue;
    require(load.boundary < inner_surface<dim>,
            "a zone of a body with loads on sides with names of their own cannot grow");
    const int axis = load.boundary / 2;
    const double distance =
        load.boundary % 2 ? body.upper[axis] - x[axis] : x[axis] - body.lower[axis];
    require(distance > 2 * body.spacing + load.absorbing_layer,
            "the zone grows along a loaded side");
  }
}

template <int dim>
void require_that_it_fits(const core::State &state, double old_dt, const CoupledBody<dim> &larger,
                          BodyNames<dim> &names)
{
  require(larger.zone && larger.far && state.count("particles") && state.count("nodes"),
          "a zone grows into a mesh: both bodies need particles and cells");
  require(state.count("split") > 0 && larger.coupler->can_turn(),
          "energy-weighted couplers weigh the whole overlap: their zone cannot grow");
  require(larger.zone->body_force.is_empty(),
          "a zone on whose masses a body force acts cannot grow");
  require(!larger.zone->rest(), "a zone whose particles may rest cannot grow");
  require(
      larger.dt == old_dt,
      fmt::format("the larger body's step is {} s, not {} s; give /time/step", larger.dt, old_dt));
  const core::Table &particles = core::table(state, "particles");
  for (const std::int64_t name : particles.keys())
    require(names.particles().index(name) >= 0,
            fmt::format("particle {} is not in the larger zone", name));
  const core::Table &nodes = core::table(state, "nodes");
  for (int i = 0; i < names.nodes().size(); ++i)
    require(has(nodes, names.nodes().name(i)),
            "the larger body's mesh has other lines than the old one; move the edges of the zone "
            "by whole cells");
}

/// The motion of a mesh, by rows of a state.
template <int dim>
class MeshMotion
{
public:
  MeshMotion(const core::State &state, const fem::Mesh<dim> &mesh, const core::Names &names)
      : mesh_(mesh), locator_(mesh)
  {
    const core::Table &rows = core::table(state, "nodes");
    require(rows.keys() == names.sorted(), "the state is not of this mesh");
    for (auto *values : {&displacement_, &velocity_})
      for (auto &component : *values)
        component.assign(mesh.n_nodes(), 0.);
    names.load(rows, "displacement", displacement_);
    names.load(rows, "velocity", velocity_);
  }

  /// Puts the particle into the motion at its place.
  void carry(particles::Particles<dim> &p, int i) const
  {
    const Vector<dim> x = get(p.reference, i);
    const int cell = locator_.find(x);
    require(cell >= 0, fmt::format("particle {} of the larger zone lies where the old body had "
                                   "neither particle nor cell",
                                   p.global_id[i]));
    const auto share = fem::shape_values(mesh_, cell, x);
    const auto gradient = fem::shape_gradients(mesh_, cell, x);
    Vector<dim> u = Vector<dim>::Zero(), v = u;
    Eigen::Matrix<double, dim, dim> f = Eigen::Matrix<double, dim, dim>::Identity();
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
      const int node = mesh_.cells[cell][a];
      u += share[a] * get(displacement_, node);
      v += share[a] * get(velocity_, node);
      f += get(displacement_, node) * gradient.col(a).transpose();
    }
    set(p.displacement, i, u);
    set(p.velocity, i, v);
    if (!p.turns)
      return;
    const core::PolarRotation<dim> rotation(f);
    Spin<dim> spin = Spin<dim>::Zero();
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      spin += rotation.spin_block(gradient.col(a)) * get(velocity_, mesh_.cells[cell][a]);
    particles::set_orientation<dim>(p, i, rotation.matrix());
    set(p.spin, i, spin);
  }

private:
  const fem::Mesh<dim> &mesh_;
  fem::CellLocator<dim> locator_;
  Components<dim> displacement_, velocity_;
};
} // namespace

template <int dim>
int give_state_to_larger(const core::State &state, const fem::Mesh<dim> &old_mesh, double old_dt,
                         CoupledBody<dim> &larger)
{
  BodyNames<dim> names(larger);
  require_that_it_fits(state, old_dt, larger, names);
  const MeshMotion<dim> motion(state, old_mesh,
                               fem::node_names<dim>(old_mesh, larger.lower, larger.upper));
  const core::Table &old = core::table(state, "particles");
  auto &particles = larger.zone->state;
  int n_new = 0;
  for (int i = 0; i < particles.size(); ++i)
    if (!has(old, particles.global_id[i])) {
      require_free_side(larger, get(particles.reference, i));
      motion.carry(particles, i);
      ++n_new;
    }
  give_state(state, larger); // what has no row keeps this motion
  return n_new;
}

template <int dim>
void book_zone_change(double energy_before, CoupledBody<dim> &larger,
                      const coupling::StepTime &step)
{
  larger.regime_change -= motion_energy(larger, step) - energy_before;
}

template int give_state_to_larger(const core::State &, const fem::Mesh<2> &, double,
                                  CoupledBody<2> &);
template int give_state_to_larger(const core::State &, const fem::Mesh<3> &, double,
                                  CoupledBody<3> &);
template void book_zone_change(double, CoupledBody<2> &, const coupling::StepTime &);
template void book_zone_change(double, CoupledBody<3> &, const coupling::StepTime &);
} // namespace ligament::program
