// Faces that soften, as part of the force: what their openings change in it, and how these grow.
#pragma once

#include "core/exact_sum.h"
#include "dem/fracture/crack_velocity.h"
#include "dem/fracture_law.h"
#include "dem/parts/inelastic_strains.h"
#include "particles/halo.h"

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
  int material;         // by whose law it softens
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
  // Of a body in parts: whoever owns the bond's first particle opens it and books its work, and
  // tells others of it where they need to know.
  bool is_own = true, is_told = false;

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

  CohesiveFaces(const BondedBody<dim> &body, const InelasticStrains<dim> &strains,
                const FractureLaw &law)
      : body_(body), strains_(strains), law_(law)
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

  /// A bond begins to soften at this force (N) on its particle i, by the law of this material.
  /// `way` is the unit direction of the largest principal stress, in space; `energy` in J is what
  /// it takes to open the bond wholly along its normal.
  void begin(const BondId &id, const Bond<dim> &bond, const Particles &particles,
             const Vector<dim> &force, const Vector<dim> &way, int material, double energy);

  /// In place of it: from now (s) on its strength falls to nothing within `duration`. False where
  /// it bears neither tension nor shear: then nothing could fall.
  bool begin_fall(const BondId &id, const Bond<dim> &bond, const Particles &particles,
                  const Vector<dim> &force, int material, double now, double duration);
  /// Of a body in parts: ranks tell each other which faces began and which are torn, and open
  /// together those that hang together across a seam. All ranks call it, and the next three.
  /// `names` outlive this: of the particles at hand.
  void join(std::shared_ptr<particles::Owners> owners, const core::Names &names,
            const Particles &particles);
  /// What began here by begin() or begin_fall(), called by these names, begins on all ranks that
  /// have the bond. Returns the names of all that began in the body, ascending.
  std::vector<Name> tell_begun(const std::vector<Name> &here, const Particles &particles);
  /// Those of own_torn() of all ranks, ascending.
  std::vector<Name> torn_of_body() const;
  /// So many faces of the body are no more; remove() was called where they are at hand.
  void follow_torn(std::size_t n) { n_all_ -= std::int64_t(n); }
  /// One's own of those of torn(), ascending.
  std::vector<Name> own_torn() const;
  static Name name_of(const Bond<dim> &bond, const Particles &particles);

  /// Whether a crack is still crossing one of the particle's faces.
  bool is_at_front(int particle) const
  {
    return std::binary_search(at_front_.begin(), at_front_.end(), particle);
  }

  /// Once at every new time, between the pressures of the parts and those of the rows: openings
  /// follow the motion, face after face; what that takes is booked.
  void open(const Particles &particles, double time, Evaluation<dim> &evaluation);
  /// The same where what the faces bear is known after all others have answered only: book() comes
  /// then. `follow_others` makes pressures follow openings; each face opens again until none does.
  void open_beside(const Particles &particles, double time, Evaluation<dim> &evaluation,
                   const std::function<void()> &follow_others);
  /// Where materials flow, by what their particles are going to answer; open cells hold what is no
  /// bond's within a material, with openings. book() comes later.
  void open_in_flow(const Particles &particles, double time, Evaluation<dim> &evaluation);
  /// What openings took that were not booked yet, at the pressures and strains of all.
  void book(const Particles &particles, Evaluation<dim> &evaluation);
  /// The same in a state in which the body may not stay: the next step opens from the last one.
  /// Returns by how much a face opened, in units of its reach, before it saw the others.
  double try_to_open(const Particles &particles, Evaluation<dim> &evaluation);
  /// The next state is not one step away from the last.
  void expect_a_jump() { has_jumped_ = true; }
  /// As if nothing had been tried since the last step.
  void forget_trial();
  /// As in the state of the last trial or step, and to first order in how far this one is from it.
  /// Returns what try_to_open() does.
  double open_to_first_order(const Particles &particles, Evaluation<dim> &evaluation);
  /// Openings as the forces see them, in the order of all(), to be put back.
  std::vector<Opening<dim>> openings() const;
  void put_back(const std::vector<Opening<dim>> &openings);
  /// About what is left of the stiffness of a bond (N/m) and of its bending, where changes are
  /// small; first whether it would open further.
  struct Softness
  {
    bool opens;
    double share, bending_share, shear;
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
  /// What it adds to V theta of i and of j, in m^3.
  std::array<double, 2> opened_volumes(const Bond<dim> &bond, const Particles &particles) const;
  /// What openings of faces between materials change in their energy, in J, volumes aside.
  double energy_between_materials(const Particles &particles) const;
  /// visit(i, what its openings add to X of a particle in m^dim).
  void for_each_strain(
      const Particles &particles,
      const std::function<void(int, const Eigen::Matrix<double, dim, dim> &)> &visit) const;
  /// Work in J that opened faces so far. What closing ones give back is taken off.
  const core::ExactSum &work() const { return work_; }

  std::vector<int> particles() const override;
  void add_pressures(const Particles &particles, Evaluation<dim> &evaluation) const override;
  void add_strains(const Particles &particles, Evaluation<dim> &evaluation) const override;
  /// To the force of a bond on its first particle, in N.
  void add_force_of(const Bond<dim> &bond, const Particles &particles,
                    Vector<dim> &force) const override;
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
  Face make(const BondId &id, const Bond<dim> &bond, const Particles &particles,
            int material) const;
  bool begin_opening(double time);
  /// Each face bears its `force` now.
  void book(const Particles &particles);

  void find_fronts();

  bool is_in_parts() const { return owners_ && !owners_->ranks.is_one(); }
  /// Whether the body has none.
  bool none() const { return is_in_parts() ? n_all_ == 0 : faces_.empty(); }
  /// Both of them are at hand.
  std::optional<BondId> bond_between(int i, int j) const;
  /// A face as it was left, after its numbers.
  static void go_on(Face &face);
  /// visit(name, face) for those that bear nothing any more and are open, or have slid far.
  template <typename Visit>
  void for_each_torn(Visit &&visit) const;
  /// Which of one's own faces are told to others. All ranks call it.
  void find_told();

  const BondedBody<dim> &body_;
  const InelasticStrains<dim> &strains_;
  const FractureLaw law_;
  std::map<Name, Face> faces_;
  std::vector<int> at_front_;       // ascending
  std::optional<double> opened_at_; // s
  bool has_jumped_ = false, is_booked_ = true;
  core::ExactSum work_;
  // Of a body in parts.
  std::shared_ptr<particles::Owners> owners_;
  const core::Names *names_ = nullptr; // of the particles at hand
  std::vector<char> seen_;             // by particle: another rank has it, too
  std::int64_t n_all_ = 0;             // faces of the body
  bool tells_ = false;                 // some rank tells others of faces
};
} // namespace ligament::dem
