// Faces that soften, as part of the force: what their openings change in it, and how these grow.
#pragma once

#include "core/exact_sum.h"
#include "dem/fracture/crack_velocity.h"
#include "dem/laws/cohesive.h"
#include "dem/parts/force_part.h"

#include <algorithm>
#include <map>
#include <optional>

namespace ligament::dem
{
/// A bond whose face has begun to open. It stays a bond of the body.
template <int dim>
struct CohesiveFace
{
  BondId id;
  Bond<dim> bond;
  CohesiveLaw<dim> law;
  bool turns_with_i;    // the opening, with the particle of the smaller global id
  Opening<dim> opening; // in the axes of that particle, as the forces see it
  Opening<dim> stayed;  // the same as the last step left it
  Vector<dim> force = Vector<dim>::Zero();      // N, in these axes, of the last step or trial
  Vector<dim> last_force = Vector<dim>::Zero(); // of the last step
  Spin<dim> last_turn = Spin<dim>::Zero();      // of j against i
  double spent = 0;                             // J, below the curve of softening so far
  double whole_energy = 0;                      // J, of a crack along the face
  double work = 0;                              // J, done on the opening so far
  FallInTime fall = {};                         // in place of softening
  double gone = 0;                              // of what falls, at the time of the opening

  /// From which the opening of this step goes on.
  double damage_before() const { return fall.is_on() ? gone : stayed.damage; }
};

template <int dim>
class CohesiveFaces : public ForcePart<dim>
{
public:
  using Particles = particles::Particles<dim>;
  /// Global ids of both particles, ascending.
  using Name = std::array<std::int64_t, 2>;

  CohesiveFaces(const BondedBody<dim> &body, const Softening &shape, double mode_ratio)
      : body_(body), shape_(shape), mode_ratio_(mode_ratio)
  {
  }

  /// In an order that no numbering changes.
  const std::map<Name, CohesiveFace<dim>> &all() const { return faces_; }
  bool has(const Bond<dim> &bond, const Particles &particles) const
  {
    return find(bond, particles) != nullptr;
  }
  /// Null where it has not begun to open.
  const CohesiveFace<dim> *find(const Bond<dim> &bond, const Particles &particles) const;

  /// A bond begins to soften at this force (N) on its particle i. `energy` in J is what it takes to
  /// open it wholly along its normal.
  void begin(const BondId &id, const Bond<dim> &bond, const Particles &particles,
             const Vector<dim> &force, double energy);

  /// In place of it: from now (s) on its strength falls to nothing within `duration`. False where
  /// it bears neither tension nor shear: then nothing could fall.
  bool begin_fall(const BondId &id, const Bond<dim> &bond, const Particles &particles,
                  const Vector<dim> &force, double now, double duration);
  /// Whether a crack is still crossing one of the particle's faces.
  bool is_at_front(int particle) const
  {
    return std::binary_search(at_front_.begin(), at_front_.end(), particle);
  }

  /// Once at every new time, between the pressures of the parts and those of the rows: openings
  /// follow the motion, face after face; what that takes is booked.
  void open(const Particles &particles, double time, Evaluation<dim> &evaluation);
  /// The same in a state in which the body may not stay: the next step opens from the last one.
  void try_to_open(const Particles &particles, Evaluation<dim> &evaluation);
  /// The next state is not one step away from the last.
  void expect_a_jump() { has_jumped_ = true; }
  /// As if nothing had been tried since the last step.
  void forget_trial();
  /// As in the state of the last trial or step, and to first order in how far this one is from it.
  void open_to_first_order(const Particles &particles, Evaluation<dim> &evaluation);
  /// Openings as the forces see them, in the order of all(), to be put back.
  std::vector<Opening<dim>> openings() const;
  void put_back(const std::vector<Opening<dim>> &openings);
  /// About what is left of the stiffness of a bond and of its bending, where changes are small;
  /// first whether it would open further.
  struct Softness
  {
    bool opens;
    double share, bending_share;
  };
  Softness softness(const CohesiveFace<dim> &face, const Particles &particles) const;
  /// Those that bear nothing any more and are open, or have slid far.
  std::vector<BondId> torn() const;
  /// Forces jumped: the next step starts from those of the present state.
  void take_up(const Particles &particles, const Evaluation<dim> &evaluation);

  /// Of a bond in m, in space; zero where it doesn't soften.
  Vector<dim> opening(const Bond<dim> &bond, const Particles &particles) const;
  /// Energy of bending that a bond has lost, in J.
  double lost_bending_energy(const Bond<dim> &bond, const Particles &particles) const;
  /// Work in J that opened faces so far. What closing ones give back is taken off.
  double work() const { return work_.value(); }

  std::vector<int> particles() const override;
  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_forces(Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_force_on(int i, const Particles &particles, const Evaluation<dim> &evaluation,
                    Wrench<dim> &wrench) const override;
  void add_energies(const Particles &particles, Evaluation<dim> &evaluation,
                    std::vector<double> &energy) const override;
  /// The part of the stresses that the motion of a bond has too much.
  void for_each_moment(const Particles &particles, const Evaluation<dim> &evaluation,
                       const VisitMoment<dim> &visit) const override;
  void remove(const BondId &id, const Bond<dim> &bond, const Particles &particles) override;

  void save(core::State &state, const core::Names &names) const override;
  void load(const core::State &state, const core::Names &names,
            const Particles &particles) override;

private:
  using Face = CohesiveFace<dim>;
  static Name name_of(const Bond<dim> &bond, const Particles &particles);
  Face make(const BondId &id, const Bond<dim> &bond, const Particles &particles) const;

  void find_fronts();

  const BondedBody<dim> &body_;
  Softening shape_;
  double mode_ratio_;
  std::map<Name, Face> faces_;
  std::vector<int> at_front_;       // ascending
  std::optional<double> opened_at_; // s
  bool has_jumped_ = false;
  core::ExactSum work_;
};
} // namespace ligament::dem
