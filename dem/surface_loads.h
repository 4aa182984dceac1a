// Supports and tractions on the outer faces of the packing, and the work they do.
#pragma once

#include "core/load.h"
#include "dem/materials.h"
#include "dem/turn.h"
#include "packings/packing.h"

#include <algorithm>
#include <functional>
#include <map>

namespace ligament::dem
{
/// Side of the specimen whose motion is prescribed: a bond of length q between the particle and the
/// wall. Du = P (u_wall - u_i - (a - A)) at the face centroid, P the prescribed components; stress
/// 2G Du/q + lambda theta P n; theta gets S n . Du / V. A motion that the wall allows and that is
/// affine is answered exactly, also by clipped cells.
template <int dim>
struct WallFace
{
  int i;
  Vector<dim> normal, lever;
  double area, q;
  Vector<dim> prescribed;    // 1 where the component is prescribed, 0 where it is free
  std::array<int, dim> load; // number of the load that prescribes the component, or -1
  double shear_modulus;      // Pa, of the particle
  Vector<dim> plastic = Vector<dim>::Zero(); // m, what no traction answers of Du
};

/// Outer face under a given traction (theory.md, loaded outer faces).
template <int dim>
struct TractionFace
{
  int i;
  Vector<dim> lever;
  double area;
  int load;
  Vector<dim> acting;   // 1 where the traction acts, 0 where a wall holds the component
  double shear_modulus; // Pa, of the particle
};

template <int dim>
class SurfaceLoads
{
public:
  SurfaceLoads(const packings::Packing<dim> &packing, const Materials &materials,
               std::vector<core::BoundaryLoad<dim>> loads);

  /// Displacements and tractions at time t (s).
  void set_time(double t);
  /// As if nothing were applied: supports stand still, tractions vanish.
  void set_zero();

  /// visit(particles) once for each load, as soon as it acts: a support moves, a traction is
  /// applied.
  template <typename Visit>
  void for_each_that_begins(Visit &&visit);

  /// Adds lambda theta (Pa) of the loaded faces: stiffness_per_volume = lambda_i / V_i.
  void add_dilatation(const particles::Particles<dim> &particles,
                      const std::vector<double> &stiffness_per_volume,
                      std::vector<double> &pressure) const;

  /// Adds forces and torques; pressure = lambda_i theta_i.
  void add_forces(particles::Particles<dim> &particles, const std::vector<double> &pressure);

  /// Elastic energy of the walls without the volumetric part, in J.
  double energy(const particles::Particles<dim> &particles) const;

  /// visit(i, a, f): lever (m) and force (N) of every loaded face of particle i.
  template <typename Visit>
  void for_each_moment(const particles::Particles<dim> &particles,
                       const std::vector<double> &pressure, Visit &&visit) const;

  /// Plastic strains of the particles, in their own axes, stretch the wall pairs.
  void set_plastic(const std::function<Eigen::Matrix<double, dim, dim>(int)> &strain_of);

  /// Adds S a (x) t of the loaded faces to the tensors of their particles (Voigt order, N m).
  void add_moments(const particles::Particles<dim> &particles, const std::vector<double> &pressure,
                   Components<n_strains<dim>> &moments) const;

  /// Adds to external_work() what the loads did since the last call: trapezoidal rule.
  void book_work(const particles::Particles<dim> &particles, const std::vector<double> &pressure);

  Vector<dim> reaction(int load) const { return reaction_[load]; }
  double external_work() const { return work_; }
  void reset_work() { work_ = 0; }

  /// What the next work is booked against, as the tables "loads" and "loaded_faces".
  void save(core::State &state, const core::Names &names) const;
  void load(const core::State &state, const core::Names &names);

  const std::vector<WallFace<dim>> &walls() const { return walls_; }
  /// Particles of all loaded faces, some perhaps twice.
  std::vector<int> particles() const;
  const std::vector<core::BoundaryLoad<dim>> &loads() const { return loads_; }
  bool empty() const { return walls_.empty() && tractions_.empty(); }

private:
  Vector<dim> relative(const WallFace<dim> &wall, const particles::Particles<dim> &p) const;
  Vector<dim> traction(const TractionFace<dim> &face) const;
  /// On the particle, in N.
  Vector<dim> force(const WallFace<dim> &wall, const particles::Particles<dim> &p,
                    double pressure) const;
  Vector<dim> force(const TractionFace<dim> &face) const;

  /// Faces under tractions by the name of their particle and their number there.
  std::map<std::array<std::int64_t, 2>, std::size_t> face_names(const core::Names &names) const;

  std::vector<core::BoundaryLoad<dim>> loads_;
  std::vector<WallFace<dim>> walls_;
  std::vector<TractionFace<dim>> tractions_;
  std::vector<Vector<dim>> displacement_, traction_, reaction_; // of each load
  std::vector<char> has_begun_;                                 // of each load
  double work_ = 0;
  bool booked_ = false;
  std::vector<Vector<dim>> old_displacement_, old_traction_, old_reaction_;
  std::vector<Vector<dim>> old_place_, old_gradient_; // of each traction face
};

template <int dim>
template <typename Visit>
void SurfaceLoads<dim>::for_each_moment(const particles::Particles<dim> &particles,
                                        const std::vector<double> &pressure, Visit &&visit) const
{
  const auto lever = [&](const auto &face) -> Vector<dim> {
    return face.lever + Turn<dim>::of(particles, face.i).change(face.lever);
  };
  for (const auto &wall : walls_)
    visit(wall.i, lever(wall), force(wall, particles, pressure[wall.i]));
  for (const auto &face : tractions_)
    visit(face.i, lever(face), force(face));
}

template <int dim>
template <typename Visit>
void SurfaceLoads<dim>::for_each_that_begins(Visit &&visit)
{
  has_begun_.resize(loads_.size(), 0);
  for (int l = 0; l < int(loads_.size()); ++l) {
    if (has_begun_[l] || (displacement_[l].isZero(0) && traction_[l].isZero(0)))
      continue;
    has_begun_[l] = 1;
    std::vector<int> loaded;
    for (const auto &wall : walls_)
      if (std::find(wall.load.begin(), wall.load.end(), l) != wall.load.end())
        loaded.push_back(wall.i);
    for (const auto &face : tractions_)
      if (face.load == l)
        loaded.push_back(face.i);
    visit(loaded);
  }
}

/// The tensor a (x) b, symmetric part, in Voigt order without engineering factors.
template <int dim>
Strain<dim> symmetric_product(const Vector<dim> &a, const Vector<dim> &b)
{
  Strain<dim> s;
  for (int c = 0; c < dim; ++c)
    s[c] = a[c] * b[c];
  if constexpr (dim == 2)
    s[2] = (a[0] * b[1] + a[1] * b[0]) / 2;
  else {
    s[3] = (a[1] * b[2] + a[2] * b[1]) / 2;
    s[4] = (a[0] * b[2] + a[2] * b[0]) / 2;
    s[5] = (a[0] * b[1] + a[1] * b[0]) / 2;
  }
  return s;
}
} // namespace ligament::dem
