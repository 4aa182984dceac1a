// A body that ranks step together, and the whole one, which every rank steps beside it: both must
// have the same bits.
#pragma once

#include "core/check.h"
#include "dem/many_body_force.h"
#include "packings/absorbing_sides.h"
#include "packings/lattice_packing.h"
#include "packings/packing_part.h"
#include "packings/random_packing.h"
#include "particles/block_sum.h"
#include "particles/particle_solver.h"
#include "tests/support/ranks.h"
#include "tests/unit/dem/cases.h"

#include <cstring>

namespace ligament::dem::testing
{
template <int dim>
struct Scene
{
  Packing<dim> packing;
  DemMaterial material{1, 0.3, 1, PlaneMode::strain, 0};
  std::vector<core::BoundaryLoad<dim>> loads;
  FractureLaw law;
  double random_velocity = 0; // m/s, of all particles at the start
  bool may_rest = false;
  double step_share = 0.7; // of the critical step
};

inline std::uint64_t bits_of(double value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

/// Of the whole, where there is no part of it.
template <int dim>
struct Solver
{
  Solver(const Scene<dim> &scene, const packings::PackingPart<dim> *held)
  {
    const Packing<dim> &packing = held ? held->packing : scene.packing;
    Particles<dim> p;
    packings::fill_particles(packing, scene.material.density, p);
    if (held)
      p.part = held->part;
    for (int i = 0; i < p.size() && scene.random_velocity > 0; ++i) {
      std::mt19937_64 random(p.global_id[i]); // whoever holds it
      std::uniform_real_distribution<double> uniform(-1, 1);
      for (auto &v : p.velocity)
        v[i] = p.part.owns(i) ? scene.random_velocity * uniform(random) : 0;
    }
    auto f = std::make_unique<ManyBodyForce<dim>>(packing, scene.material, scene.loads, scene.law);
    force = f.get();
    solver = std::make_unique<particles::ParticleSolver<dim>>(std::move(p), std::move(f));
    solver->body_force = particles::BodyForce<dim>(scene.loads);
    const auto constants = force->elastic_constants();
    solver->dashpots = packings::absorbing_dashpots<dim>(
        packing, solver->state, scene.loads,
        {{scene.material.density,
          packings::isotropic_speeds<dim>(constants.wave_speed_p, constants.wave_speed_s)}},
        held ? test::ranks() : core::Ranks());
    if (held)
      solver->join({test::ranks(), held->owner});
  }
  void step(double dt, double time)
  {
    solver->kick(dt);
    solver->drift(dt);
    solver->update_ghosts();
    solver->compute_forces(time);
  }

  ManyBodyForce<dim> *force;
  std::unique_ptr<particles::ParticleSolver<dim>> solver;
};

/// Names of the numbers that differ, with the first particle or bond where they do.
template <int dim>
class Comparison
{
public:
  Comparison(const Solver<dim> &part, const Solver<dim> &whole, const std::vector<int> &place)
      : part_(part), whole_(whole), place_(place)
  {
  }

  /// Motion and forces of what is owned; everything else that all ranks read, which all call.
  bool is_same(double dt)
  {
    differs_.clear();
    compare_particles();
    const auto &a = *part_.force, &b = *whole_.force;
    const auto &p = part_.solver->state, &q = whole_.solver->state;
    number("kinetic energy", part_.solver->kinetic_energy(dt), whole_.solver->kinetic_energy(dt));
    number("potential energy", a.potential_energy(p), b.potential_energy(q));
    number("external work", a.external_work(), b.external_work());
    number("fracture energy", a.fracture_energy(), b.fracture_energy());
    number("breaking step error", a.breaking_step_error(), b.breaking_step_error());
    number("frictional work", a.frictional_work(), b.frictional_work());
    number("cohesive work", a.cohesive_work(), b.cohesive_work());
    if (a.fracture().faces_open())
      compare_openings();
    number("plastic dissipation", a.plastic_dissipation(), b.plastic_dissipation());
    number("hardening energy", a.hardening_energy(), b.hardening_energy());
    number("viscous dissipation", a.viscous_dissipation(), b.viscous_dissipation());
    number("absorbed energy", part_.solver->absorbed_energy(), whole_.solver->absorbed_energy());
    number("work of accelerations", part_.solver->body_force_work(),
           whole_.solver->body_force_work());
    return differs_.empty();
  }
  bool reactions_are_same(int n_loads)
  {
    for (int l = 0; l < n_loads; ++l) {
      const Vector<dim> a = part_.force->reaction(l), b = whole_.force->reaction(l);
      for (int c = 0; c < dim; ++c)
        number("reaction", a[c], b[c]);
    }
    return differs_.empty();
  }
  bool broken_bonds_are_same()
  {
    const auto a = part_.force->broken_bonds_of_body(part_.solver->state);
    const auto &b = whole_.force->broken_bonds();
    if (a.size() != b.size())
      differs_ += " number of broken bonds";
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
      if (a[k].global_i != b[k].global_i || a[k].global_j != b[k].global_j)
        differs_ += " names of broken bonds";
      number("time of break", a[k].time, b[k].time);
      number("energy of break", a[k].energy, b[k].energy);
      number("area of break", a[k].area, b[k].area);
      for (int c = 0; c < dim; ++c) {
        number("place of break", a[k].position[c], b[k].position[c]);
        number("normal of break", a[k].normal[c], b[k].normal[c]);
      }
    }
    return differs_.empty();
  }
  const std::string &differs() const { return differs_; }

private:
  void number(const std::string &name, double a, double b)
  {
    if (bits_of(a) != bits_of(b) && differs_.find(name) == std::string::npos)
      differs_ += " " + name;
  }
  void compare_particles()
  {
    auto &p = part_.solver->state;
    auto &q = whole_.solver->state;
    std::vector<const std::vector<double> *> of_whole;
    q.for_each_array([&](const char *, const auto &array) { of_whole.push_back(&array); });
    std::size_t a = 0;
    p.for_each_array([&](const char *name, const auto &array) {
      const std::vector<double> &other = *of_whole[a++];
      particles::for_each(p.part.owned, [&](int i) { number(name, array[i], other[place_[i]]); });
    });
    const auto &of_part = part_.force->strains();
    const auto &strains = whole_.force->strains();
    if (of_part.has_law())
      particles::for_each(p.part.owned, [&](int i) {
        const int j = place_[i];
        number("history", of_part.history(i), strains.history(j));
        const auto e = of_part.tensor(i), f = strains.tensor(j),
                   viscous = of_part.viscous_strain(i), expected = strains.viscous_strain(j);
        for (int c = 0; c < e.size(); ++c) {
          number("inelastic strain", e[c], f[c]);
          number("viscous strain", viscous[c], expected[c]);
        }
      });
  }

  void compare_openings()
  {
    const auto &p = part_.solver->state;
    std::vector<double> share, opening, whole_share, whole_opening;
    part_.force->softening(p, share, opening);
    whole_.force->softening(whole_.solver->state, whole_share, whole_opening);
    particles::for_each(p.part.owned, [&](int i) {
      number("share that softened", share[i], whole_share[place_[i]]);
      number("opening", opening[i], whole_opening[place_[i]]);
    });
  }

  const Solver<dim> &part_, &whole_;
  const std::vector<int> &place_;
  std::string differs_;
};

/// Weights of the blocks: another cut for each number, 0 for equal shares. Ranks behind the first
/// `n_busy` ones own nothing; 0: none.
inline particles::Partition some_partition(int n, unsigned number, int n_busy = 0)
{
  std::vector<std::int64_t> weights;
  std::mt19937 random(number);
  for (int b = 0; b * particles::sum_block < n && number > 0; ++b)
    weights.push_back(1 + random() % 3);
  const int n_ranks = test::ranks().size();
  auto partition = particles::make_partition(n, n_busy > 0 ? n_busy : n_ranks, weights);
  partition.cuts.resize(n_ranks + 1, n);
  return partition;
}

struct Outcome
{
  int n_broken = 0, n_across = 0;  // bonds; between particles of different ranks
  double friction = 0;             // J
  double at_rest = 0;              // of this rank's steps
  int n_found = 0, n_met = 0;      // contacts that no face began; between particles of two ranks
  double share_flowed = 0;         // of the particles
  double plastic = 0, viscous = 0; // J
  // Most faces that softened at one time: in the body, across a seam; and of all ranks' own those
  // that are told to others, and not.
  int n_soft = 0, n_soft_across = 0, n_told = 0, n_untold = 0;
  bool has_reloaded = false; // one that had gone back opened further

  /// After a step.
  template <int dim>
  void look_at_faces(const Solver<dim> &part, const Solver<dim> &whole,
                     const particles::Partition &partition);

private:
  std::map<std::array<std::int64_t, 2>, bool> went_back_;
};

template <int dim>
void Outcome::look_at_faces(const Solver<dim> &part, const Solver<dim> &whole,
                            const particles::Partition &partition)
{
  int across = 0;
  std::int64_t told = 0, untold = 0;
  for (const auto &[name, face] : whole.force->cohesive().all()) {
    across += partition.owner(face.bond.i) != partition.owner(face.bond.j);
    const bool back = face.law.unloads(face.opening, face.bond.normal);
    has_reloaded = has_reloaded || (went_back_[name] && !back && face.opening.largest > 0);
    went_back_[name] = back;
  }
  for (const auto &[name, face] : part.force->cohesive().all())
    if (face.is_own)
      ++(face.is_told ? told : untold);
  n_soft = std::max(n_soft, int(whole.force->cohesive().all().size()));
  n_soft_across = std::max(n_soft_across, across);
  n_told = std::max(n_told, int(test::ranks().sum(told)));
  n_untold = std::max(n_untold, int(test::ranks().sum(untold)));
}

/// An acceleration that comes and goes, a side that absorbs under a traction, with a layer, and
/// another one under a pressure that follows it.
template <int dim>
std::vector<core::BoundaryLoad<dim>> fall_absorb_and_press(int axis, double layer, double duration)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  std::vector<core::BoundaryLoad<dim>> loads(3);
  loads[0].boundary = core::BoundaryLoad<dim>::whole_body, loads[0].kind = Kind::acceleration;
  loads[0].value[0] = 0.02, loads[0].value[dim - 1] = -0.05;
  loads[0].history = core::Pulse{core::Pulse::Shape::half_sine, 0, duration};
  loads[1].boundary = 2 * axis + 1, loads[1].kind = Kind::traction;
  loads[1].value[axis] = 3e-4;
  loads[1].absorbing = true, loads[1].absorbing_layer = layer;
  loads[2].boundary = 2 * ((axis + 1) % dim), loads[2].kind = Kind::traction;
  loads[2].pressure = 4e-4;
  loads[2].history = core::Ramp{duration / 2};
  return loads;
}

/// All ranks step the body `steps` times beside the whole one.
template <int dim>
Outcome expect_parts_to_move_like_the_whole(const Scene<dim> &scene, int steps, unsigned cut = 0)
{
  const particles::Partition partition = some_partition(scene.packing.size(), cut);
  const auto held = packings::part_of(scene.packing, partition, test::ranks().rank(),
                                      ManyBodyForce<dim>::n_rings(scene.law));
  Solver<dim> whole(scene, nullptr), part(scene, &held);
  const double critical = whole.force->stable_step(whole.solver->state),
               dt = scene.step_share * critical;
  EXPECT_EQ(bits_of(part.force->stable_step(part.solver->state)), bits_of(critical));
  test::ranks().agree_on("the step", dt);
  Comparison<dim> comparison(part, whole, held.place);
  for (Solver<dim> *s : {&whole, &part}) {
    s->solver->compute_forces(0);
    if (scene.may_rest)
      s->solver->let_rest();
  }
  bool same = true;
  Outcome outcome;
  for (int s = 0; s <= steps && same; ++s) {
    if (s > 0) {
      whole.step(dt, s * dt);
      part.step(dt, s * dt);
    }
    const bool is_same = comparison.is_same(dt) &
                         comparison.reactions_are_same(int(scene.loads.size())) &
                         comparison.broken_bonds_are_same();
    EXPECT_TRUE(is_same) << "step " << s << ":" << comparison.differs();
    same = !test::ranks().any(!is_same);
    if (scene.law.faces_open())
      outcome.look_at_faces(part, whole, partition);
  }
  EXPECT_TRUE(std::isfinite(whole.solver->kinetic_energy(dt)));
  outcome.n_broken = int(whole.force->broken_bonds().size());
  for (const auto &b : whole.force->broken_bonds())
    outcome.n_across += partition.owner(b.i) != partition.owner(b.j);
  outcome.friction = whole.force->frictional_work();
  for (const auto &c : whole.force->contacts().all())
    if (!c.from_face) {
      ++outcome.n_found;
      outcome.n_met += partition.owner(c.face.i) != partition.owner(c.face.j);
    }
  const int n = scene.packing.size();
  for (int i = 0; i < n; ++i)
    outcome.share_flowed += (whole.force->strains().history(i) > 0) / double(n);
  outcome.plastic = whole.force->plastic_dissipation();
  outcome.viscous = whole.force->viscous_dissipation();
  if (part.solver->rest())
    outcome.at_rest = part.solver->rest()->share_at_rest();
  return outcome;
}
} // namespace ligament::dem::testing
