#include "src/simulation/overlap_guard.h"

#include "fem/cell_map.h"
#include "particles/worse_face.h"
#include "src/output/format.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace ligament::program
{
using particles::Watch;

template <int dim>
OverlapGuard<dim>::OverlapGuard(const CoupledBody<dim> &body)
{
  const auto *overlap = body.coupler->overlap();
  if (!overlap || !(body.force()->can_break() || body.force()->can_flow()))
    return;
  watches_ = true;
  watch_.assign(body.zone->state.size(), Watch::none);
  for (const auto &m : overlap->members)
    watch_[m.particle] = m.pad ? Watch::exempt : Watch::watched;
  is_blended_.assign(body.far->mesh().n_cells(), 0);
  for (const auto &cell : overlap->cells)
    is_blended_[cell.cell] = cell.layer == 0;
  body.force()->set_noted_share(limit);
}

template <int dim>
bool OverlapGuard<dim>::is_watched(const particles::BrokenBond<dim> &bond) const
{
  return std::max(watch_[bond.i], watch_[bond.j]) == Watch::watched;
}

// All ranks know how many bonds of the body have broken.
template <int dim>
void OverlapGuard<dim>::count_broken(const CoupledBody<dim> &body, double time)
{
  const auto n = std::size_t(body.force()->n_broken());
  const auto &broken = body.force()->broken_bonds();
  if (!seen_here_)
    seen_here_ = body.ranks.is_one()
                     ? seen_
                     : std::upper_bound(broken.begin(), broken.end(), seen_until_,
                                        [](double t, const auto &b) { return t < b.time; }) -
                           broken.begin();
  seen_until_ = time;
  if (n == seen_)
    return;
  seen_ = n;
  std::int64_t count = 0;
  core::ExactSum energy;
  for (; *seen_here_ < broken.size(); ++*seen_here_) {
    const auto &bond = broken[*seen_here_];
    if (!is_watched(bond) || !body.zone->state.part.owns(bond.i))
      continue;
    ++count;
    energy.add(bond.energy);
  }
  n_broken_ += long(body.ranks.sum(count));
  energy_.merge(body.ranks.sum(energy));
}

template <int dim>
Vector<dim> OverlapGuard<dim>::first_broken(const CoupledBody<dim> &body) const
{
  const auto &state = body.zone->state;
  std::array<std::vector<std::int64_t>, 2> names; // of what is watched, of what is exempt
  particles::for_each(state.part.owned, [&](int i) {
    if (watch_[i] != Watch::none)
      names[watch_[i] == Watch::exempt].push_back(state.global_id[i]);
  });
  for (auto &of : names) {
    of = body.ranks.gather_all(of);
    std::sort(of.begin(), of.end());
  }
  const auto has = [&](int which, const auto &bond) {
    return std::binary_search(names[which].begin(), names[which].end(), bond.global_i) ||
           std::binary_search(names[which].begin(), names[which].end(), bond.global_j);
  };
  for (const auto &bond : body.force()->broken_bonds_of_body(state))
    if (has(0, bond) && !has(1, bond))
      return bond.position;
  return Vector<dim>::Zero();
}

namespace
{
/// The worst of what the ranks found; nothing where all stay below the limit.
template <int dim>
std::optional<particles::Utilisation<dim>> worst_of_all(const particles::Utilisation<dim> &here,
                                                        double limit, const core::Ranks &ranks)
{
  if (!ranks.any(here.share >= limit))
    return {};
  std::vector<double> told = {here.share};
  told.insert(told.end(), here.place.begin(), here.place.end());
  particles::Utilisation<dim> most;
  for (const auto &of : ranks.gather(told)) {
    const particles::Utilisation<dim> found = {of[0], Eigen::Map<const Vector<dim>>(of.data() + 1)};
    if (particles::is_worse(found, most))
      most = found;
  }
  return most;
}
} // namespace

template <int dim>
std::optional<particles::Utilisation<dim>>
OverlapGuard<dim>::worst_face(const CoupledBody<dim> &body) const
{
  return worst_of_all(body.force()->utilisation(body.zone->state, watch_), limit, body.ranks);
}

template <int dim>
std::optional<std::string> OverlapGuard<dim>::look(const CoupledBody<dim> &body, double time)
{
  if (!watches_)
    return {};
  count_broken(body, time);
  if (found_)
    return {};
  constexpr const char *remedy = "make /discrete_zone/region larger";
  if (n_broken_ > 0) {
    found_ = true;
    return fmt::format("{} in the overlap broke, the first at {}: the mesh there still carries as "
                       "if {} had not; {}",
                       n_broken_ == 1 ? "a face" : grouped(n_broken_) + " faces",
                       place(first_broken(body)), n_broken_ == 1 ? "it" : "they", remedy);
  }
  const auto most = worst_face(body);
  if (!most)
    return {};
  found_ = true;
  return fmt::format("a face in the overlap bears {:.0f} % of what breaks it, at {}: fracture "
                     "comes near it; {}",
                     100 * most->share, place(most->place), remedy);
}

// Green's strain of the motion at the middle of each cell: a cell that turns is not strained.
template <int dim>
void OverlapGuard<dim>::look_at_cells(const CoupledBody<dim> &body, Flow &flow) const
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const auto &mesh = body.far->mesh();
  for (int c = 0; c < mesh.n_cells(); ++c) {
    if (is_blended_[c])
      continue;
    const auto gradients = fem::centre_gradients(mesh, c);
    Matrix h = Matrix::Zero();
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      h += get(body.far->displacement, mesh.cells[c][a]) * gradients.col(a).transpose();
    const Matrix e = 0.5 * (h + h.transpose() + h.transpose() * h);
    Strain<dim> strain;
    for (int k = 0; k < dim; ++k)
      strain[k] = e(k, k);
    if constexpr (dim == 2)
      strain[2] = 2 * e(0, 1);
    else
      strain.template tail<3>() << 2 * e(1, 2), 2 * e(0, 2), 2 * e(0, 1);
    const Strain<dim> stress = body.far->body().stiffness * strain;
    const double zz =
        body.plane == PlaneMode::strain ? body.poissons_ratio * (stress[0] + stress[1]) : 0;
    const double share = body.force()->flow_share(stress, zz);
    if (share < near_flow_limit)
      continue;
    Vector<dim> middle = Vector<dim>::Zero();
    for (const int node : mesh.cells[c]) {
      middle += mesh.nodes[node] / fem::n_cell_nodes<dim>;
      flow.lower = flow.lower.cwiseMin(mesh.nodes[node]);
      flow.upper = flow.upper.cwiseMax(mesh.nodes[node]);
    }
    if (share > flow.most.share) {
      flow.most = {share, middle};
      flow.in_mesh = true;
    }
  }
}

template <int dim>
auto OverlapGuard<dim>::find_flow(const CoupledBody<dim> &body) const -> Flow
{
  Flow flow;
  flow.most = worst_of_all(body.force()->flow_utilisation(body.zone->state, watch_),
                           near_flow_limit, body.ranks)
                  .value_or(particles::Utilisation<dim>());
  flow.lower.setConstant(std::numeric_limits<double>::infinity());
  flow.upper = -flow.lower;
  if (flow.most.share >= near_flow_limit)
    flow.lower = flow.upper = flow.most.place;
  look_at_cells(body, flow);
  return flow;
}

template <int dim>
auto OverlapGuard<dim>::look_at_flow(const CoupledBody<dim> &body) -> std::optional<FlowFinding>
{
  if (!watches_ || found_ || !body.force()->can_flow())
    return {};
  const Flow found = find_flow(body);
  if (found.most.share < (found_near_flow_ ? flow_limit : near_flow_limit))
    return {};
  found_near_flow_ = true;
  found_ = found.most.share >= flow_limit;
  // What is near flow would lie inside, the overlap around it.
  const double length = body.coupler->overlap()->parameters.length;
  const Vector<dim> lower = (found.lower.array() - length).matrix().cwiseMax(body.lower),
                    upper = (found.upper.array() + length).matrix().cwiseMin(body.upper);
  return FlowFinding{
      fmt::format(
          "{} {} {}, where it stays elastic: it bears {:.0f} % of the stress that makes its "
          "material flow; let /discrete_zone/region contain at least the box from {} to {}",
          found.in_mesh ? "the far field" : "the overlap",
          found_ ? "would flow at" : "comes near flow at", place(found.most.place),
          100 * found.most.share, place(lower), place(upper)),
      found_};
}

template <int dim>
void OverlapGuard<dim>::save(core::State &state) const
{
  core::save_value(state, "recorder", "guard_seen", std::int64_t(seen_));
  core::save_value(state, "recorder", "guard_seen_until", seen_until_);
  core::save_value(state, "recorder", "guard_broken", std::int64_t(n_broken_));
  core::save_sum(state, "guard_energy", energy_);
  core::save_value(state, "recorder", "guard_found", std::int64_t(found_));
  core::save_value(state, "recorder", "guard_near_flow", std::int64_t(found_near_flow_));
}

template <int dim>
void OverlapGuard<dim>::load(const core::State &state)
{
  seen_ = std::size_t(core::load_integer(state, "recorder", "guard_seen"));
  seen_here_.reset();
  seen_until_ = core::load_real(state, "recorder", "guard_seen_until");
  n_broken_ = long(core::load_integer(state, "recorder", "guard_broken"));
  energy_ = core::load_sum(state, "guard_energy");
  found_ = core::load_integer(state, "recorder", "guard_found") != 0;
  found_near_flow_ = core::load_integer(state, "recorder", "guard_near_flow") != 0;
}

template class OverlapGuard<2>;
template class OverlapGuard<3>;
} // namespace ligament::program
