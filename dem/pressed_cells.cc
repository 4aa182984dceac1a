#include "dem/pressed_cells.h"

#include "core/exact_sum.h"
#include "dem/turn.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
void PressedCells<dim>::add_face(const packings::OuterFace<dim> &face, double shear_modulus,
                                 const std::vector<core::BoundaryLoad<dim>> &loads)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  for (std::size_t l = 0; l < loads.size(); ++l) {
    if (!loads[l].pressure || loads[l].boundary != face.of.boundary)
      continue;
    const auto inside = face.inside({loads[l].part});
    if (!inside)
      continue;
    Vector<dim> acting = Vector<dim>::Ones();
    for (const auto &other : loads)
      if (other.boundary == face.of.boundary && other.kind != Kind::traction &&
          face.inside({loads[l].part, other.part}))
        for (int c = 0; c < dim; ++c)
          if (other.value[c])
            acting[c] = 0;
    faces_of_[face.of.i].push_back(int(faces_.size()));
    faces_.push_back(
        {face.of.i, inside->lever, face.of.normal, inside->area, int(l), acting, shear_modulus});
  }
}

template <int dim>
std::vector<int> PressedCells<dim>::particles() const
{
  std::vector<int> found;
  for (const Face &face : faces_)
    found.push_back(face.i);
  return found;
}

template <int dim>
std::vector<int> PressedCells<dim>::particles_under(int load) const
{
  std::vector<int> found;
  for (const Face &face : faces_)
    if (face.load == load && pressure_[load] != 0)
      found.push_back(face.i);
  return found;
}

template <int dim>
void PressedCells<dim>::set_time(const std::vector<core::BoundaryLoad<dim>> &loads, double t)
{
  if (faces_.empty())
    return;
  pressure_.assign(loads.size(), 0);
  for (std::size_t l = 0; l < loads.size(); ++l)
    pressure_[l] = loads[l].pressure_at(t);
}

template <int dim>
double PressedCells<dim>::pressure(const Face &face, const Evaluation<dim> &e) const
{
  return e.has_loads && !pressure_.empty() ? pressure_[face.load] : 0;
}

template <int dim>
Vector<dim> PressedCells<dim>::lever(const Face &face, const Particles &p) const
{
  return face.lever + Turn<dim>::of(p, face.i).change(face.lever);
}

template <int dim>
Vector<dim> PressedCells<dim>::force(const Face &face, const Particles &p,
                                     const Evaluation<dim> &e) const
{
  const Vector<dim> normal = face.normal + Turn<dim>::of(p, face.i).change(face.normal);
  return -pressure(face, e) * face.area * face.acting.cwiseProduct(normal);
}

// S a . t / 2G as for other tractions, in the axes of the particle.
template <int dim>
void PressedCells<dim>::add_pressures(const Particles &, Evaluation<dim> &e) const
{
  if (faces_.empty() || !e.body.has_dilatation())
    return;
  const auto &stiffness = e.body.lambda_per_volume();
  for (const Face &face : faces_)
    e.pressure[face.i] += stiffness[face.i] * pressure(face, e) * face.area *
                          face.lever.dot(unit_traction(face)) / (2 * face.shear_modulus);
}

template <int dim>
void PressedCells<dim>::add_reactions(const Particles &p, Evaluation<dim> &e) const
{
  for (const Face &face : faces_) {
    if (!p.part.owns(face.i))
      continue;
    const Vector<dim> f = force(face, p, e);
    for (int c = 0; c < dim; ++c)
      e.reaction_sums[dim * face.load + c].add(f[c]);
  }
}

template <int dim>
void PressedCells<dim>::add_forces(Particles &p, const Evaluation<dim> &e) const
{
  for (const Face &face : faces_) {
    const Vector<dim> f = force(face, p, e);
    add(p.force, face.i, f);
    add(p.torque, face.i, cross(lever(face, p), f));
  }
}

template <int dim>
void PressedCells<dim>::add_force_on(int i, const Particles &p, const Evaluation<dim> &e,
                                     Wrench<dim> &sum) const
{
  const auto faces = faces_of_.find(i);
  if (faces == faces_of_.end())
    return;
  for (const int k : faces->second) {
    const Vector<dim> f = force(faces_[k], p, e);
    sum.force += f;
    sum.torque += cross(lever(faces_[k], p), f);
  }
}

template <int dim>
void PressedCells<dim>::for_each_moment(
    const Particles &p, const Evaluation<dim> &e,
    const std::function<void(int, const Vector<dim> &, const Vector<dim> &)> &visit) const
{
  for (const Face &face : faces_)
    visit(face.i, lever(face, p), force(face, p, e));
}

template <int dim>
void PressedCells<dim>::book_work(const Particles &p, const Evaluation<dim> &e,
                                  core::ExactSum &work)
{
  std::vector<Booked> now;
  for (const Face &face : faces_) {
    const Vector<dim> place =
        get(p.displacement, face.i) + Turn<dim>::of(p, face.i).change(face.lever);
    const double slope = e.pressure.empty()
                             ? 0
                             : e.pressure[face.i] * face.area *
                                   face.lever.dot(unit_traction(face)) / (2 * face.shear_modulus);
    now.push_back({place, force(face, p, e), pressure(face, e), slope});
  }
  if (booked_.empty()) // as if pressures that are there at once had come in proportion
    for (const Booked &b : now)
      booked_.push_back({b.place, Vector<dim>::Zero(), 0, 0});
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (!p.part.owns(faces_[f].i))
      continue;
    const Booked &old = booked_[f];
    work.add(0.5 * (now[f].force + old.force).dot(now[f].place - old.place));
    work.add(0.5 * (now[f].slope + old.slope) * (now[f].pressure - old.pressure));
  }
  booked_ = std::move(now);
}

template <int dim>
std::vector<std::pair<std::array<std::int64_t, 2>, std::size_t>>
PressedCells<dim>::names_of_faces(const core::Names &names) const
{
  std::map<int, std::int64_t> n_of;
  std::vector<std::pair<std::array<std::int64_t, 2>, std::size_t>> found;
  for (std::size_t f = 0; f < faces_.size(); ++f)
    found.push_back({{names.name(faces_[f].i), n_of[faces_[f].i]++}, f});
  std::sort(found.begin(), found.end());
  return found;
}

template <int dim>
void PressedCells<dim>::save(core::State &state, const core::Names &names) const
{
  if (booked_.size() != faces_.size())
    return; // nothing yet
  const auto rows = names_of_faces(names);
  std::vector<std::int64_t> keys;
  for (const auto &row : rows)
    keys.insert(keys.end(), row.first.begin(), row.first.end());
  core::Table table(std::move(keys), 2);
  const auto add = [&](const std::string &name, const auto &value_of) {
    std::vector<double> column;
    for (const auto &row : rows)
      column.push_back(value_of(booked_[row.second]));
    table.add(name, column);
  };
  for (int c = 0; c < dim; ++c) {
    add("place_" + std::to_string(c), [c](const Booked &b) { return b.place[c]; });
    add("force_" + std::to_string(c), [c](const Booked &b) { return b.force[c]; });
  }
  add("pressure", [](const Booked &b) { return b.pressure; });
  add("slope", [](const Booked &b) { return b.slope; });
  state["pressed_cells"] = std::move(table);
}

template <int dim>
void PressedCells<dim>::load(const core::State &state, const core::Names &names)
{
  booked_.clear();
  if (faces_.empty() || !state.count("pressed_cells"))
    return;
  const core::Table &table = core::table(state, "pressed_cells");
  booked_.assign(faces_.size(), {Vector<dim>::Zero(), Vector<dim>::Zero(), 0, 0});
  std::map<std::array<std::int64_t, 2>, std::size_t> face_of;
  for (const auto &row : names_of_faces(names))
    face_of.insert(row);
  const auto take = [&](const std::string &name, const auto &place) {
    const auto column = table.reals(name);
    for (std::size_t r = 0; r < table.n_rows(); ++r)
      if (const auto f = face_of.find({table.keys()[2 * r], table.keys()[2 * r + 1]});
          f != face_of.end())
        place(booked_[f->second]) = column[r];
  };
  for (int c = 0; c < dim; ++c) {
    take("place_" + std::to_string(c), [c](Booked &b) -> double & { return b.place[c]; });
    take("force_" + std::to_string(c), [c](Booked &b) -> double & { return b.force[c]; });
  }
  take("pressure", [](Booked &b) -> double & { return b.pressure; });
  take("slope", [](Booked &b) -> double & { return b.slope; });
}

template class PressedCells<2>;
template class PressedCells<3>;
} // namespace ligament::dem
