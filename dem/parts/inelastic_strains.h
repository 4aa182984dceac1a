// Strains of particles that no stress answers, theory.md section 1.10: what they change in the
// force, beside the kernels in which they grow.
#pragma once

#include "core/exact_sum.h"
#include "core/large_array.h"
#include "dem/parts/force_part.h"

#include <map>
#include <optional>

namespace ligament::dem
{
/// Viscosity of a material, and what it does in a step.
class ViscousNumbers
{
public:
  ViscousNumbers(const Viscosity &material, double shear_modulus);
  ViscousNumbers(ViscousNumbers &&) = default; // what points into it stays

  /// In s; 0: everything follows at once.
  void set_step(double dt);
  const ViscousStep &step() const { return step_; }
  /// eta / G in s.
  double damping_time() const { return time_; }

private:
  Viscosity material_;
  double time_;
  std::vector<BranchStep> branches_;
  ViscousStep step_;
};

/// A bond beside those of the network as the cells of its particles see it: S a (x) n of either
/// side, symmetric, in m^dim.
template <int dim>
struct OtherFace
{
  int i, j;
  Eigen::Matrix<double, dim, dim> moment_i, moment_j;
};

/// Of bodies with a material that flows; of others nothing here costs anything.
template <int dim>
class InelasticStrains : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;
  using Matrix = Eigen::Matrix<double, dim, dim>;
  using Tensor = Eigen::Matrix<double, n_tensor<dim>, 1>; // as n_tensor has it

  InelasticStrains(const packings::Packing<dim> &packing, const BondedBody<dim> &body,
                   std::vector<WallFace<dim>> walls, const std::vector<int> &loaded);

  bool has_law() const { return !laws_.empty(); }
  bool has_plasticity() const { return has_plasticity_; }
  bool is_viscous() const { return most_branches_ >= 0; }
  /// Of the dashpots, eta / G in s.
  double longest_damping() const;
  /// Whether any particle has had half of the stress under which it flows.
  bool has_begun() const;

  /// Of a body in parts: sums go over what is owned.
  void join(const particles::Part &part) { part_ = part; }

  /// Those of the intact body that would flow but for too few bonds that hold their strains.
  const std::vector<int> &loose() const { return loose_; }
  /// These never flow, whatever their material.
  void keep_elastic(const std::vector<int> &particles);
  /// Of a particle with so many m^3 whose strain is not that of its bonds alone.
  void open_cell(int i, double volume);

  /// At the begin of an evaluation: open cells have no strains yet. At a new time particles may
  /// flow, once.
  InelasticSweep<dim> begin(bool may_flow, double time) const;

  /// What the side of the particle adds to the strain of its cell, in m^dim and its own axes.
  static void add_strain(const InelasticSweep<dim> &sweep, int i, const Matrix &strain);
  /// All that was added to that of an open cell, m^dim.
  static Matrix cell_strain(const InelasticSweep<dim> &sweep, int i);
  static void set_cell_strain(const InelasticSweep<dim> &sweep, int i, const Matrix &strain);

  /// e of a particle, in its own axes: all of it, and of the axes of the body.
  Tensor tensor(int i) const;
  Matrix strain(int i) const;
  bool is_strained(int i) const
  {
    return has_law() && i < body_->n_particles() && begun_[i / inelastic_block]; // no guest
  }
  /// The law's number of a particle: accumulated plastic strain.
  double history(int i) const;
  void set_strain(int i, const Tensor &strain);
  /// Own stress in Pa as the last step left it; zero where none is kept.
  Tensor stress(int i) const;
  /// The part of e that is viscous.
  Tensor viscous_strain(int i) const;

  /// Of a bond, its elastic part without what the strains take, eq. (D22).
  BondMotion<dim> motion(const Bond<dim> &bond, const Particles &particles, const Turn<dim> &turn_i,
                         const Turn<dim> &turn_j) const;
  /// V M : e of a particle, in m^3, and the share of a bond in it.
  double flowed_volume(int i) const;
  double flowed_volume(const Bond<dim> &bond, int i) const;
  /// What strains change in the energy of a bond beside the pressures', in J, where so much of its
  /// motion is an opening (m).
  double bond_energy(const Bond<dim> &bond, const Particles &particles,
                     const Vector<dim> &opening) const;
  /// The face as it is now, its levers stretched.
  Bond<dim> stretched(const Bond<dim> &bond) const;

  std::vector<int> particles() const override { return {}; }
  void add_force_on(int i, const Particles &particles, const Evaluation<dim> &evaluation,
                    Wrench<dim> &wrench) const override;
  void add_energies(const Particles &, Evaluation<dim> &, std::vector<double> &) const override {}
  void remove(const BondId &id, const Bond<dim> &bond, const Particles &particles) override;
  /// After it, with the pressures of particle i before and after: its stress is that without the
  /// face, which had opened by so many m. Returns by how much what its viscous part keeps,
  /// theory.md eq. (D28), grew, in J.
  double forget_face(const Bond<dim> &bond, int i, const Particles &particles,
                     const Vector<dim> &opening, double before, double after);

  /// All bonds beside those of the network from now on.
  void set_other_faces(const std::vector<OtherFace<dim>> &faces, const Particles &particles);
  /// After it: particle i has lost one of this moment and of this share in X (m^dim), its pressure
  /// was another before.
  void forget(int i, const Matrix &moment, const Matrix &x, double before, double after);
  /// Whether its cell lacks faces of the packing, or has other ones.
  bool is_open(int i) const { return !has_law() || open_[i] >= 0; }

  /// The share of a bond within one material in X of its particle i, theory.md eq. (D22), m^dim;
  /// `opening` in m of its motion is none.
  static Matrix face_strain(const Bond<dim> &bond, int i, const Particles &particles,
                            const Vector<dim> &opening = Vector<dim>::Zero());
  /// e in its own axes and pressure in Pa that a particle is going to answer in this sweep to X
  /// (m^dim), of which its cell knows a part. Nothing changes.
  std::pair<Matrix, double> try_response(const InelasticSweep<dim> &sweep, int i, const Matrix &x,
                                         double lambda_per_volume) const;
  /// eta / (G Dt) of the dashpots of a particle in this sweep.
  double dashpot_rate(int i) const
  {
    const ViscousStep *viscous = laws_[law_number(i)].viscous;
    return viscous ? viscous->rate : 0;
  }
  double volume(int i) const; // m^3
  /// Own stress in Pa with this X (m^dim) under a pressure, eq. (D21).
  Tensor stress_of(int i, const Matrix &x, double pressure) const;
  /// How it changes with both.
  Tensor stress_change(int i, const Matrix &x, double pressure) const;
  /// A particle that has answered bears so much more than it knew (Pa): what was booked of its flow
  /// in this step, from these strains on, follows.
  void follow_stress(int i, const Tensor &change, const Tensor &strain_before,
                     const Tensor &viscous_before) const;
  /// Of a particle whose stress jumped so as a face near it broke. Returns what forget_face does.
  double jump(int i, const Tensor &change, double pressure);

  /// Energy in J that flow took of one's own particles, and the part of it that hardening stores.
  core::ExactSum dissipation() const;
  core::ExactSum viscous_dissipation() const; // J
  core::ExactSum stored_energy() const;

  void save(core::State &state, const core::Names &names) const override;
  void load(const core::State &state, const core::Names &names,
            const Particles &particles) override;
  /// Of a viscous body: whether a step ends with the next sweep. Else that takes no time.
  bool knows_last_sweep() const { return flowed_at_.has_value(); }
  void forget_last_sweep() { flowed_at_.reset(); }

private:
  using Streams = InelasticStreams<dim>;

  int n_streams() const { return Streams::count(most_branches_); }
  core::ExactSum sum_of(int stream) const;
  /// For the step that ends at this time.
  void set_viscous_step(double time) const;
  Tensor viscous_tensor(int i, int stream) const;
  static double dot(const Tensor &a, const Tensor &b);
  /// What the dashpot has of it.
  Tensor damped_strain(int i) const;
  /// Whether its law reads the stress that the step before left.
  bool keeps_stress(int i) const;
  /// And the next sweep will: it is viscous, has flowed, or had half of the limit. Whatever else
  /// its block keeps.
  bool knows_stress(int i) const;
  bool is_near(int i) const;
  /// Whether any of its numbers is one that the next sweep reads.
  bool has_state(int i) const;
  /// sym(e M) of a particle, and M.
  Tensor moved(int i, const Tensor &e) const;
  Tensor pressed(int i) const;
  static Tensor symmetric(const Matrix &m);
  /// The viscous part of a particle whose stress jumped as it lost a face and what that had of M.
  double lose_face(int i, double volume, const Tensor &jump, const Matrix &lost, double pressure);
  /// Of a particle that stays elastic from now on.
  void forget_viscosity(int i);
  int law_number(int i) const { return law_of_.empty() ? 0 : law_of_[i]; }
  template <typename Visit>
  void for_each_wall_of(int i, Visit &&visit) const;
  /// V M of the bonds and walls of a particle; whole: its bonds leave no gap.
  struct MeasuredCell
  {
    OpenCell<dim> cell;
    bool is_whole;
  };
  MeasuredCell cell_of(int i, double volume) const;
  /// The same; null: a whole cell.
  std::optional<OpenCell<dim>> find_cell(int i, double volume) const;
  void set_cell(int i, double volume);
  /// Whether the faces of a particle hold it so that flow gives way to the stress, eq. (D22b).
  bool is_held(int i, double volume) const;
  /// S a (x) n of a bond as its particle i sees it, symmetric, m^dim.
  static Matrix moment(const Bond<dim> &bond, int i);

  const BondedBody<dim> *body_;
  particles::Part part_;
  std::vector<WallFace<dim>> walls_; // by particles
  std::vector<FlowLaw> laws_;
  std::vector<Plasticity> parameters_;          // of the laws, whose tables they hold
  mutable std::vector<ViscousNumbers> viscous_; // of the materials, twice
  int most_branches_ = -1;                      // of a viscous material; -1: there is none
  bool has_plasticity_ = false;
  std::vector<std::uint8_t> law_of_; // of the particles; empty: all 0
  std::vector<int> loose_;
  mutable core::LargeArray numbers_;
  Streams streams_;
  mutable std::vector<std::uint8_t> begun_; // of the blocks
  std::map<int, Matrix> other_moment_;      // of particles with bonds beside the network's
  std::vector<int> open_;                   // of the particles
  mutable std::vector<OpenCell<dim>> cells_;
  double whole_volume_ = 0;
  mutable std::optional<double> flowed_at_; // s
};
} // namespace ligament::dem
