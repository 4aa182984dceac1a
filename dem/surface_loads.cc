#include "dem/surface_loads.h"

#include "dem/surface_law.h"

#include <fmt/format.h>

namespace ligament::dem
{
template <int dim>
SurfaceLoads<dim>::SurfaceLoads(const packings::Packing<dim> &packing, const Materials &materials,
                                std::vector<core::BoundaryLoad<dim>> loads)
    : loads_(std::move(loads)), displacement_(loads_.size(), Vector<dim>::Zero()),
      traction_(displacement_), reaction_(displacement_)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  for (const auto &face : packing.boundary_faces) {
    const double shear_modulus = materials.of(face.i).shear_modulus();
    WallFace<dim> wall{face.i, face.normal,         face.lever, face.area,
                       face.q, Vector<dim>::Zero(), {},         shear_modulus};
    wall.load.fill(-1);
    for (std::size_t l = 0; l < loads_.size(); ++l)
      if (loads_[l].boundary == face.boundary && loads_[l].kind != Kind::traction)
        for (int c = 0; c < dim; ++c)
          if (loads_[l].value[c]) {
            core::require(
                wall.load[c] < 0,
                fmt::format("two loads prescribe component {} on boundary {}", c, face.boundary));
            wall.prescribed[c] = 1;
            wall.load[c] = int(l);
          }
    if (wall.prescribed.any())
      walls_.push_back(wall);
    for (std::size_t l = 0; l < loads_.size(); ++l)
      if (loads_[l].boundary == face.boundary && loads_[l].kind == Kind::traction)
        tractions_.push_back({face.i, face.lever, face.area, int(l),
                              Vector<dim>(Vector<dim>::Ones() - wall.prescribed), shear_modulus});
  }
}

template <int dim>
std::vector<int> SurfaceLoads<dim>::particles() const
{
  std::vector<int> found;
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
  for (std::size_t l = 0; l < loads_.size(); ++l)
    if (loads_[l].kind == Kind::traction)
      traction_[l] = loads_[l].traction(t);
    else
      for (int c = 0; c < dim; ++c)
        if (loads_[l].value[c])
          displacement_[l][c] = loads_[l].displacement(c, t);
}

template <int dim>
void SurfaceLoads<dim>::set_zero()
{
  for (auto *values : {&displacement_, &traction_})
    for (auto &v : *values)
      v.setZero();
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::relative(const WallFace<dim> &wall,
                                        const particles::Particles<dim> &p) const
{
  Vector<dim> du = -get(p.displacement, wall.i) - Turn<dim>::of(p, wall.i).change(wall.lever);
  for (int c = 0; c < dim; ++c)
    du[c] = wall.load[c] < 0 ? 0. : du[c] + displacement_[wall.load[c]][c];
  return du - wall.plastic;
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::force(const WallFace<dim> &wall, const particles::Particles<dim> &p,
                                     double pressure) const
{
  return law_of(wall).force(relative(wall, p), pressure, pressed_along(wall));
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::force(const TractionFace<dim> &face) const
{
  return law_of(face).force(traction(face));
}

template <int dim>
Vector<dim> SurfaceLoads<dim>::traction(const TractionFace<dim> &face) const
{
  return face.acting.cwiseProduct(traction_[face.load]);
}

template <int dim>
void SurfaceLoads<dim>::add_dilatation(const particles::Particles<dim> &particles,
                                       const std::vector<double> &stiffness_per_volume,
                                       std::vector<double> &pressure) const
{
  for (const auto &wall : walls_)
    pressure[wall.i] +=
        stiffness_per_volume[wall.i] *
        law_of(wall).add_dilatation(relative(wall, particles), pressed_along(wall), 0);
  for (const auto &face : tractions_) {
    const Vector<dim> a = face.lever + Turn<dim>::of(particles, face.i).change(face.lever);
    pressure[face.i] += stiffness_per_volume[face.i] * law_of(face).dilatation(traction(face), a);
  }
}

template <int dim>
void SurfaceLoads<dim>::add_forces(particles::Particles<dim> &particles,
                                   const std::vector<double> &pressure)
{
  for (auto &r : reaction_)
    r.setZero();
  for (const auto &wall : walls_) {
    const Vector<dim> a = wall.lever + Turn<dim>::of(particles, wall.i).change(wall.lever);
    const Vector<dim> f = force(wall, particles, pressure[wall.i]);
    add(particles.force, wall.i, f);
    add(particles.torque, wall.i, cross(a, f));
    for (int c = 0; c < dim; ++c)
      if (wall.load[c] >= 0)
        reaction_[wall.load[c]][c] += f[c];
  }
  for (const auto &face : tractions_) {
    const Vector<dim> a = face.lever + Turn<dim>::of(particles, face.i).change(face.lever);
    const TractionLaw<dim> law = law_of(face);
    const Vector<dim> t = traction(face), f = law.force(t);
    add(particles.force, face.i, f);
    add(particles.torque, face.i, law.torque(t, a, pressure[face.i]));
    reaction_[face.load] += f;
  }
}

template <int dim>
double SurfaceLoads<dim>::energy(const particles::Particles<dim> &particles) const
{
  double sum = 0;
  for (const auto &wall : walls_)
    sum += law_of(wall).twice_energy(relative(wall, particles)) / 2;
  return sum;
}

template <int dim>
void SurfaceLoads<dim>::add_moments(const particles::Particles<dim> &particles,
                                    const std::vector<double> &pressure,
                                    Components<n_strains<dim>> &moments) const
{
  for_each_moment(particles, pressure, [&](int i, const Vector<dim> &a, const Vector<dim> &f) {
    add(moments, i, symmetric_product<dim>(a, f));
  });
}

template <int dim>
void SurfaceLoads<dim>::set_plastic(
    const std::function<Eigen::Matrix<double, dim, dim>(int)> &strain_of)
{
  for (auto &wall : walls_)
    wall.plastic = wall.q * wall.prescribed.cwiseProduct(strain_of(wall.i) * wall.normal);
}

template <int dim>
void SurfaceLoads<dim>::book_work(const particles::Particles<dim> &particles,
                                  const std::vector<double> &pressure)
{
  // The energy depends on the traction itself through theta: its gradient times the change of the
  // traction is work too.
  std::vector<Vector<dim>> place, gradient;
  for (const auto &face : tractions_) {
    const Vector<dim> change = Turn<dim>::of(particles, face.i).change(face.lever);
    place.push_back(get(particles.displacement, face.i) + change);
    gradient.push_back(
        law_of(face).gradient(face.acting.cwiseProduct(face.lever + change), pressure[face.i]));
  }
  if (booked_) {
    for (std::size_t l = 0; l < loads_.size(); ++l)
      work_ += 0.5 * (reaction_[l] + old_reaction_[l]).dot(displacement_[l] - old_displacement_[l]);
    for (std::size_t f = 0; f < tractions_.size(); ++f) {
      const auto &face = tractions_[f];
      const Vector<dim> now = traction_[face.load], before = old_traction_[face.load];
      work_ +=
          0.5 * face.area * face.acting.cwiseProduct(now + before).dot(place[f] - old_place_[f]);
      work_ += 0.5 * (gradient[f] + old_gradient_[f]).dot(now - before);
    }
  }
  booked_ = true;
  old_displacement_ = displacement_;
  old_traction_ = traction_;
  old_reaction_ = reaction_;
  old_place_ = std::move(place);
  old_gradient_ = std::move(gradient);
}

template <int dim>
std::map<std::array<std::int64_t, 2>, std::size_t>
SurfaceLoads<dim>::face_names(const core::Names &names) const
{
  std::map<int, std::int64_t> n_of;
  std::map<std::array<std::int64_t, 2>, std::size_t> faces;
  for (std::size_t f = 0; f < tractions_.size(); ++f)
    faces[{names.name(tractions_[f].i), n_of[tractions_[f].i]++}] = f;
  return faces;
}

template <int dim>
void SurfaceLoads<dim>::save(core::State &state, const core::Names &names) const
{
  core::save_value(state, "surface", "work", work_);
  core::save_value(state, "surface", "booked", std::int64_t(booked_));
  if (!booked_)
    return;
  const auto add = [](core::Table &table, const std::string &name,
                      const std::vector<Vector<dim>> &rows) {
    for (int c = 0; c < dim; ++c) {
      std::vector<double> values;
      for (const auto &v : rows)
        values.push_back(v[c]);
      table.add(name + "_" + std::to_string(c), values);
    }
  };
  std::vector<std::int64_t> numbers, keys;
  for (std::size_t l = 0; l < loads_.size(); ++l)
    numbers.push_back(std::int64_t(l));
  core::Table loads(std::move(numbers));
  add(loads, "displacement", old_displacement_);
  add(loads, "traction", old_traction_);
  add(loads, "reaction", old_reaction_);
  state["loads"] = std::move(loads);
  std::vector<Vector<dim>> place, gradient;
  for (const auto &[key, f] : face_names(names)) {
    keys.insert(keys.end(), key.begin(), key.end());
    place.push_back(old_place_[f]);
    gradient.push_back(old_gradient_[f]);
  }
  core::Table faces(std::move(keys), 2);
  add(faces, "place", place);
  add(faces, "gradient", gradient);
  state["loaded_faces"] = std::move(faces);
}

template <int dim>
void SurfaceLoads<dim>::load(const core::State &state, const core::Names &names)
{
  work_ = core::load_real(state, "surface", "work");
  booked_ = core::load_integer(state, "surface", "booked") != 0;
  if (!booked_)
    return;
  const auto row = [](const core::Table &table, const std::string &name, std::size_t r) {
    Vector<dim> v;
    for (int c = 0; c < dim; ++c)
      v[c] = table.reals(name + "_" + std::to_string(c))[r];
    return v;
  };
  const core::Table &loads = core::table(state, "loads");
  core::require(loads.n_rows() == loads_.size(), "the state is of another number of loads");
  old_displacement_ = old_traction_ = old_reaction_ =
      std::vector<Vector<dim>>(loads_.size(), Vector<dim>::Zero());
  for (std::size_t l = 0; l < loads_.size(); ++l) {
    old_displacement_[l] = row(loads, "displacement", l);
    old_traction_[l] = row(loads, "traction", l);
    old_reaction_[l] = row(loads, "reaction", l);
  }
  const core::Table &faces = core::table(state, "loaded_faces");
  const auto names_of = face_names(names);
  old_place_ = old_gradient_ = std::vector<Vector<dim>>(tractions_.size(), Vector<dim>::Zero());
  for (int c = 0; c < dim; ++c) {
    const auto place = faces.reals("place_" + std::to_string(c));
    const auto gradient = faces.reals("gradient_" + std::to_string(c));
    for (std::size_t r = 0; r < faces.n_rows(); ++r)
      if (const auto f = names_of.find({faces.keys()[2 * r], faces.keys()[2 * r + 1]});
          f != names_of.end())
      {
        old_place_[f->second][c] = place[r];
        old_gradient_[f->second][c] = gradient[r];
      }
  }
}

template class SurfaceLoads<2>;
template class SurfaceLoads<3>;
} // namespace ligament::dem
