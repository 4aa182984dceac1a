#include "dem/surface_loads.h"

#include "dem/parts/inelastic_strains.h"
#include "dem/surface_law.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::dem
{
template <int dim>
SurfaceLoads<dim>::SurfaceLoads(const packings::Packing<dim> &packing, const Materials &materials,
                                std::vector<core::BoundaryLoad<dim>> loads)
    : loads_(std::move(loads)), displacement_(loads_.size(), Vector<dim>::Zero()),
      traction_(displacement_), has_begun_(loads_.size(), 0)
{
  for (const auto &face : packing.boundary_faces)
    add_faces(packings::OuterFace<dim>(face, packing), materials.of(face.i).shear_modulus());
  for (std::size_t w = 0; w < walls_.size(); ++w)
    faces_of_[walls_[w].i][0].push_back(int(w));
  for (std::size_t f = 0; f < tractions_.size(); ++f)
    faces_of_[tractions_[f].i][1].push_back(int(f));
}

// Loads that hold the same part of the face make one wall, so that all components of it are told
// the same by the particle.
template <int dim>
void SurfaceLoads<dim>::add_faces(const packings::OuterFace<dim> &face, double shear_modulus)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  struct Held
  {
    core::Part<dim> part;
    WallFace<dim> wall;
  };
  std::vector<Held> held;
  const auto wall_of = [&](const core::Part<dim> &part) -> WallFace<dim> * {
    for (Held &h : held)
      if (h.part == part)
        return &h.wall;
    const auto inside = face.inside({part});
    if (!inside)
      return nullptr;
    WallFace<dim> wall{face.of.i,    face.of.normal, inside->lever,
                       inside->area, face.of.q,      Vector<dim>::Zero(),
                       {},           shear_modulus};
    wall.load.fill(-1);
    held.push_back({part, wall});
    return &held.back().wall;
  };
  for (std::size_t l = 0; l < loads_.size(); ++l)
    if (loads_[l].boundary == face.of.boundary && loads_[l].kind != Kind::traction)
      if (WallFace<dim> *wall = wall_of(loads_[l].part))
        for (int c = 0; c < dim; ++c)
          if (loads_[l].value[c]) {
            core::require(wall->load[c] < 0,
                          fmt::format("two loads prescribe component {} on boundary {}", c,
                                      face.of.boundary));
            wall->prescribed[c] = 1;
            wall->load[c] = int(l);
          }
  for (const Held &h : held)
    if (h.wall.prescribed.any())
      walls_.push_back(h.wall);
  pressed_.add_face(face, shear_modulus, loads_);
  for (std::size_t l = 0; l < loads_.size(); ++l)
    if (loads_[l].boundary == face.of.boundary && loads_[l].kind == Kind::traction &&
        !loads_[l].pressure)
      if (const auto inside = face.inside({loads_[l].part})) {
        Vector<dim> acting = Vector<dim>::Ones();
        for (const Held &h : held)
          if (face.inside({loads_[l].part, h.part}))
            acting -= acting.cwiseProduct(h.wall.prescribed);
        tractions_.push_back(
            {face.of.i, inside->lever, inside->area, int(l), acting, shear_modulus});
      }
}

template <int dim>
std::vector<int> SurfaceLoads<dim>::particles() const
{
  std::vector<int> found = pressed_.particles();
  for (const auto &wall : walls_)
    found.push_back(wall.i);
  for (const auto &face : tractions_)
    found.push_back(face.i);
  return found;
}

template <int dim>
void SurfaceLoads<dim>::set_time(double t)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  pressed_.set_time(loads_, t);
  for (std::size_t l = 0; l < loads_.size(); ++l)
    if (loads_[l].kind == Kind::traction)
      traction_[l] = loads_[l].traction(t);
    else
      for (int c = 0; c < dim; ++c)
        if (loads_[l].value[c])
          displacement_[l][c] = loads_[l].displacement(c, t);
}

template <int dim>
void SurfaceLoads<dim>::wake(particles::RestBlocks<dim> *rest)
{
  if (!rest || rest->all_awake())
    return;
  for (int l = 0; l < n_loads(); ++l) {
    std::vector<int> loaded = pressed_.particles_under(l);
    if (has_begun_[l] || (displacement_[l].isZero(0) && traction_[l].isZero(0) && loaded.empty()))
      continue;
    has_begun_[l] = 1;
    for (const auto &wall : walls_)
      if (std::find(wall.load.begin(), wall.load.end(), l) != wall.load.end())
        loaded.push_back(wall.i);
    for (const auto &face : tractions_)
      if (face.load == l)
        loaded.push_back(face.i);
    rest->wake(loaded);
  }
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::relative(const WallFace<dim> &wall, const Particles &p,
                                        bool has_loads) const
{
  Vector<dim> du = -get(p.displacement, wall.i) - Turn<dim>::of(p, wall.i).change(wall.lever);
  for (int c = 0; c < dim; ++c)
    if (wall.load[c] < 0)
      du[c] = 0;
    else if (has_loads)
      du[c] += displacement_[wall.load[c]][c];
  return du;
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::force(const WallFace<dim> &wall, const Particles &p,
                                     const Evaluation<dim> &e) const
{
  return law_of(wall).force(relative(wall, p, e.has_loads) - stretch(wall, e), e.pressure[wall.i],
                            pressed_along(wall));
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::traction(const TractionFace<dim> &face, bool has_loads) const
{
  if (!has_loads)
    return Vector<dim>::Zero();
  return face.acting.cwiseProduct(traction_[face.load]);
}

template <int dim>
void SurfaceLoads<dim>::add_pressures(const Particles &p, Evaluation<dim> &e) const
{
  if (!e.body.has_dilatation())
    return;
  const auto &stiffness = e.body.lambda_per_volume();
  for (const auto &wall : walls_)
    e.pressure[wall.i] +=
        stiffness[wall.i] *
        law_of(wall).add_dilatation(relative(wall, p, e.has_loads), pressed_along(wall), 0);
  for (const auto &face : tractions_) {
    const Vector<dim> a = face.lever + Turn<dim>::of(p, face.i).change(face.lever);
    e.pressure[face.i] +=
        stiffness[face.i] * law_of(face).dilatation(traction(face, e.has_loads), a);
  }
  pressed_.add_pressures(p, e);
}

template <int dim>
void SurfaceLoads<dim>::add_strains(const Particles &p, Evaluation<dim> &e) const
{
  using Strains = InelasticStrains<dim>;
  for (const auto &wall : walls_)
    Strains::add_strain(*e.inelastic, wall.i,
                        wall.area * relative(wall, p, e.has_loads) * wall.normal.transpose());
  for (const auto &face : tractions_) {
    const Vector<dim> t = traction(face, e.has_loads);
    const Vector<dim> own = t + Turn<dim>::of(p, face.i).inverse().change(t);
    Strains::add_strain(*e.inelastic, face.i,
                        face.area / (2 * face.shear_modulus) * own * face.lever.transpose());
  }
}

template <int dim>
Wrench<dim> SurfaceLoads<dim>::wrench(const WallFace<dim> &wall, const Particles &p,
                                      const Vector<dim> &force) const
{
  const Vector<dim> a = wall.lever + Turn<dim>::of(p, wall.i).change(wall.lever);
  return {force, cross(a, force)};
}

template <int dim>
Wrench<dim> SurfaceLoads<dim>::wrench(const TractionFace<dim> &face, const Particles &p,
                                      const Evaluation<dim> &e) const
{
  const Vector<dim> a = face.lever + Turn<dim>::of(p, face.i).change(face.lever);
  const TractionLaw<dim> law = law_of(face);
  const Vector<dim> t = traction(face, e.has_loads);
  return {law.force(t),
          law.torque(t, a, e.pressure[face.i]) + cross(stretch(face, p, e), law.force(t))};
}

template <int dim>
std::vector<core::ExactSum> SurfaceLoads<dim>::reaction_sums(const Particles &p,
                                                             const Evaluation<dim> &e) const
{
  std::vector<core::ExactSum> reactions(dim * loads_.size());
  for (std::size_t w = 0; w < walls_.size(); ++w)
    for (int c = 0; c < dim && p.part.owns(walls_[w].i); ++c)
      if (walls_[w].load[c] >= 0)
        reactions[dim * walls_[w].load[c] + c].add(e.wall_forces[w][c]);
  for (const auto &face : tractions_) {
    if (!p.part.owns(face.i))
      continue;
    const Vector<dim> f = law_of(face).force(traction(face, e.has_loads));
    for (int c = 0; c < dim; ++c)
      reactions[dim * face.load + c].add(f[c]);
  }
  return reactions;
}

template <int dim>
void SurfaceLoads<dim>::find_reactions(const Particles &p, Evaluation<dim> &e) const
{
  e.wall_forces.clear();
  for (const auto &wall : walls_)
    e.wall_forces.push_back(force(wall, p, e));
  e.reaction_sums = reaction_sums(p, e);
  pressed_.add_reactions(p, e);
  e.reactions.resize(loads_.size());
  for (std::size_t l = 0; l < loads_.size(); ++l)
    for (int c = 0; c < dim; ++c)
      e.reactions[l][c] = e.reaction_sums[dim * l + c].value();
}

template <int dim>
void SurfaceLoads<dim>::add_forces(Particles &p, Evaluation<dim> &e) const
{
  find_reactions(p, e);
  const auto act = [&](int i, const Wrench<dim> &wrench) {
    add(p.force, i, wrench.force);
    add(p.torque, i, wrench.torque);
  };
  for (std::size_t w = 0; w < walls_.size(); ++w)
    act(walls_[w].i, wrench(walls_[w], p, e.wall_forces[w]));
  for (const auto &face : tractions_)
    act(face.i, wrench(face, p, e));
  pressed_.add_forces(p, e);
}

template <int dim>
void SurfaceLoads<dim>::add_force_on(int i, const Particles &p, const Evaluation<dim> &e,
                                     Wrench<dim> &sum) const
{
  const auto act = [&](const Wrench<dim> &wrench) {
    sum.force += wrench.force;
    sum.torque += wrench.torque;
  };
  pressed_.add_force_on(i, p, e, sum);
  const auto faces = faces_of_.find(i);
  if (faces == faces_of_.end())
    return;
  for (const int w : faces->second[0])
    act(wrench(walls_[w], p, force(walls_[w], p, e)));
  for (const int f : faces->second[1])
    act(wrench(tractions_[f], p, e));
}

template <int dim>
void SurfaceLoads<dim>::add_energies(const Particles &p, Evaluation<dim> &e,
                                     std::vector<double> &energy) const
{
  for (const auto &wall : walls_)
    energy[wall.i] += law_of(wall).twice_energy(relative(wall, p, e.has_loads)) / 2;
  // What the strains of particles have of it is the work of the load.
  if (e.inelastic)
    for (const auto &face : tractions_)
      energy[face.i] += law_of(face).force(traction(face, e.has_loads)).dot(stretch(face, p, e));
}

template <int dim>
void SurfaceLoads<dim>::for_each_moment(const Particles &p, const Evaluation<dim> &e,
                                        const VisitMoment<dim> &visit) const
{
  const auto lever = [&](const auto &face) -> Vector<dim> {
    return face.lever + Turn<dim>::of(p, face.i).change(face.lever);
  };
  for (const auto &wall : walls_)
    visit(wall.i, lever(wall), force(wall, p, e));
  for (const auto &face : tractions_)
    visit(face.i, lever(face), law_of(face).force(traction(face, e.has_loads)));
  pressed_.for_each_moment(p, e, visit);
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::stretch(const WallFace<dim> &wall, const Evaluation<dim> &e) const
{
  if (!e.inelastic)
    return Vector<dim>::Zero();
  return wall.q * wall.prescribed.cwiseProduct(e.inelastic->strain(wall.i) * wall.normal);
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::stretch(const TractionFace<dim> &face, const Particles &p,
                                       const Evaluation<dim> &e) const
{
  if (!e.inelastic)
    return Vector<dim>::Zero();
  const Vector<dim> own = e.inelastic->strain(face.i) * face.lever;
  return own + Turn<dim>::of(p, face.i).change(own);
}

// Face by face, so that a body in parts books what the whole one does.
template <int dim>
void SurfaceLoads<dim>::book_work(const Particles &p, const Evaluation<dim> &e)
{
  if (loads_.empty())
    return;
  // The energy depends on the traction itself through theta: its gradient times the change of the
  // traction is work too.
  Booked now{displacement_, traction_, e.wall_forces, {}, {}};
  for (const auto &face : tractions_) {
    const Vector<dim> change = Turn<dim>::of(p, face.i).change(face.lever);
    now.place.push_back(get(p.displacement, face.i) + change + stretch(face, p, e));
    now.gradient.push_back(
        law_of(face).gradient(face.acting.cwiseProduct(face.lever + change), e.pressure[face.i]));
  }
  if (!booked_) { // as if loads that are there at once had come in proportion
    const auto none = [](std::size_t n) {
      return std::vector<Vector<dim>>(n, Vector<dim>::Zero());
    };
    booked_ = Booked{none(loads_.size()), none(loads_.size()), none(walls_.size()), now.place,
                     none(tractions_.size())};
  }
  const Booked &old = *booked_;
  for (std::size_t w = 0; w < walls_.size(); ++w)
    for (int c = 0; c < dim && p.part.owns(walls_[w].i); ++c)
      if (const int l = walls_[w].load[c]; l >= 0)
        if (const double moved = now.displacement[l][c] - old.displacement[l][c]; moved != 0)
          work_.add(0.5 * (now.wall_force[w][c] + old.wall_force[w][c]) * moved);
  for (std::size_t f = 0; f < tractions_.size(); ++f) {
    const auto &face = tractions_[f];
    if (!p.part.owns(face.i))
      continue;
    const Vector<dim> t = now.traction[face.load], t_old = old.traction[face.load];
    work_.add(0.5 * face.area *
              face.acting.cwiseProduct(t + t_old).dot(now.place[f] - old.place[f]));
    work_.add(0.5 * (now.gradient[f] + old.gradient[f]).dot(t - t_old));
  }
  booked_ = std::move(now);
  pressed_.book_work(p, e, work_);
}

namespace
{
/// Faces by the name of their particle and their number there.
template <typename Face>
std::map<std::array<std::int64_t, 2>, std::size_t> names_of(const std::vector<Face> &faces,
                                                            const core::Names &names)
{
  std::map<int, std::int64_t> n_of;
  std::map<std::array<std::int64_t, 2>, std::size_t> found;
  for (std::size_t f = 0; f < faces.size(); ++f)
    found[{names.name(faces[f].i), n_of[faces[f].i]++}] = f;
  return found;
}

/// Rows in the order of the faces' names.
template <int dim, typename Face>
core::Table
table_of(const std::vector<Face> &faces, const core::Names &names,
         const std::vector<std::pair<std::string, const std::vector<Vector<dim>> *>> &columns)
{
  const auto rows = names_of(faces, names);
  std::vector<std::int64_t> keys;
  for (const auto &[key, f] : rows)
    keys.insert(keys.end(), key.begin(), key.end());
  core::Table table(std::move(keys), 2);
  for (const auto &[name, values] : columns)
    for (int c = 0; c < dim; ++c) {
      std::vector<double> column;
      for (const auto &[key, f] : rows)
        column.push_back((*values)[f][c]);
      table.add(name + "_" + std::to_string(c), column);
    }
  return table;
}

/// Of faces without a row: zero.
template <int dim, typename Face>
std::vector<Vector<dim>> column_of(const core::Table &table, const std::string &name,
                                   const std::vector<Face> &faces, const core::Names &names)
{
  std::vector<Vector<dim>> values(faces.size(), Vector<dim>::Zero());
  const auto rows = names_of(faces, names);
  for (int c = 0; c < dim; ++c) {
    const auto column = table.reals(name + "_" + std::to_string(c));
    for (std::size_t r = 0; r < table.n_rows(); ++r)
      if (const auto f = rows.find({table.keys()[2 * r], table.keys()[2 * r + 1]}); f != rows.end())
        values[f->second][c] = column[r];
  }
  return values;
}
} // namespace

template <int dim>
void SurfaceLoads<dim>::save(core::State &state, const core::Names &names) const
{
  core::save_sum(state, "surface_work", work_);
  core::save_value(state, "surface", "booked", std::int64_t(booked_.has_value()));
  if (!booked_)
    return;
  std::vector<std::int64_t> numbers;
  for (int l = 0; l < n_loads(); ++l)
    numbers.push_back(l);
  core::Table loads(std::move(numbers));
  for (const auto &[name, values] : {std::pair("displacement", &booked_->displacement),
                                     std::pair("traction", &booked_->traction)})
    for (int c = 0; c < dim; ++c) {
      std::vector<double> column;
      for (const auto &v : *values)
        column.push_back(v[c]);
      loads.add(std::string(name) + "_" + std::to_string(c), column);
    }
  state["loads"] = std::move(loads);
  state["walls"] = table_of<dim>(walls_, names, {{"force", &booked_->wall_force}});
  state["loaded_faces"] = table_of<dim>(
      tractions_, names, {{"place", &booked_->place}, {"gradient", &booked_->gradient}});
  if (presses())
    pressed_.save(state, names);
}

template <int dim>
void SurfaceLoads<dim>::load(const core::State &state, const core::Names &names, const Particles &)
{
  work_ = core::load_sum(state, "surface_work");
  booked_.reset();
  if (core::load_integer(state, "surface", "booked") == 0)
    return;
  const core::Table &loads = core::table(state, "loads"), &walls = core::table(state, "walls"),
                    &faces = core::table(state, "loaded_faces");
  core::require(int(loads.n_rows()) == n_loads(), "the state is of another number of loads");
  Booked old{displacement_, traction_, column_of<dim>(walls, "force", walls_, names),
             column_of<dim>(faces, "place", tractions_, names),
             column_of<dim>(faces, "gradient", tractions_, names)};
  for (int c = 0; c < dim; ++c) {
    const auto displacement = loads.reals("displacement_" + std::to_string(c)),
               traction = loads.reals("traction_" + std::to_string(c));
    for (int l = 0; l < n_loads(); ++l) {
      old.displacement[l][c] = displacement[l];
      old.traction[l][c] = traction[l];
    }
  }
  booked_ = std::move(old);
  pressed_.load(state, names);
}

template class SurfaceLoads<2>;
template class SurfaceLoads<3>;
} // namespace ligament::dem
