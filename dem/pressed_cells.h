// Outer faces of cells under a pressure that follows them: tractions that turn with the particle.
#pragma once

#include "core/load.h"
#include "core/state.h"
#include "dem/loaded_faces.h"
#include "dem/parts/evaluation.h"
#include "packings/outer_face.h"

#include <functional>
#include <map>

namespace ligament::dem
{
/// theory.md section 8. In the axes of its particle such a traction is constant: theta, and with it
/// the energy, depend on the pressure alone, and the torque is the lever's.
template <int dim>
class PressedCells
{
public:
  using Particles = particles::Particles<dim>;

  /// What of the face lies under pressures, without components that other loads hold.
  void add_face(const packings::OuterFace<dim> &face, double shear_modulus,
                const std::vector<core::BoundaryLoad<dim>> &loads);

  bool empty() const { return faces_.empty(); }
  std::vector<int> particles() const;
  /// Of one load; those on which nothing acts yet are left out.
  std::vector<int> particles_under(int load) const;
  void set_time(const std::vector<core::BoundaryLoad<dim>> &loads, double t);

  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const;
  /// To the sums of reactions, of one's own particles.
  void add_reactions(const Particles &particles, Evaluation<dim> &evaluation) const;
  void add_forces(Particles &particles, const Evaluation<dim> &evaluation) const;
  void add_force_on(int i, const Particles &particles, const Evaluation<dim> &evaluation,
                    Wrench<dim> &wrench) const;
  /// visit(particle, lever, force)
  void for_each_moment(
      const Particles &particles, const Evaluation<dim> &evaluation,
      const std::function<void(int, const Vector<dim> &, const Vector<dim> &)> &visit) const;

  /// What the pressures did on every face of one's own since the last call: trapezoidal rule.
  void book_work(const Particles &particles, const Evaluation<dim> &evaluation,
                 core::ExactSum &work);
  void save(core::State &state, const core::Names &names) const;
  void load(const core::State &state, const core::Names &names);

private:
  struct Face
  {
    int i;
    Vector<dim> lever, normal; // in the reference
    double area;
    int load;
    Vector<dim> acting; // 0 where a wall holds the component
    double shear_modulus;
  };
  /// What a face's work was booked with: its place and pressure, the force, the slope of the
  /// energy by the pressure.
  struct Booked
  {
    Vector<dim> place, force;
    double pressure, slope;
  };

  /// Of one Pa, in the particle's axes.
  Vector<dim> unit_traction(const Face &face) const
  {
    return -face.acting.cwiseProduct(face.normal);
  }
  /// In Pa.
  double pressure(const Face &face, const Evaluation<dim> &evaluation) const;
  Vector<dim> lever(const Face &face, const Particles &particles) const;
  /// N
  Vector<dim> force(const Face &face, const Particles &particles,
                    const Evaluation<dim> &evaluation) const;
  std::vector<std::pair<std::array<std::int64_t, 2>, std::size_t>>
  names_of_faces(const core::Names &names) const;

  std::vector<Face> faces_;
  std::map<int, std::vector<int>> faces_of_; // of particles
  std::vector<double> pressure_; // Pa, of each load
  std::vector<Booked> booked_;   // empty: nothing yet
};
} // namespace ligament::dem
