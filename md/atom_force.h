// Forces between atoms: a potential on a neighbour list, as the loop and the coupler know forces.
#pragma once

#include "md/atom_kernel.h"
#include "md/atom_loads.h"
#include "md/atom_tangent.h"
#include "md/crystal.h"
#include "md/energy_change.h"
#include "md/parted_bonds.h"
#include "md/row_kernel.h"
#include "packings/packing.h"

#include <memory>
#include <optional>

namespace ligament::md
{
struct AtomForceOptions
{
  double skin = 0; // m: how much farther than the cut-off the neighbour list sees; 0: 1e-10 m, or
                   // 0.3 spacings where these are none of atoms
  std::vector<int> species = {}; // of each atom; empty: all are the crystal's
  bool keeps_neighbours = true;  // need not look for them while the crystal is undisturbed
  bool is_warm = false;          // bonds must be longer for a while before they count as parted
};

/// theory.md (M1). Atoms have no orientation. Energies are differences to the reference, and as
/// long as no atom has moved by half of the skin they are sums of differences, with all their
/// digits.
template <int dim>
class AtomForce : public particles::ParticleForce<dim>
{
public:
  using Particles = particles::Particles<dim>;

  /// The packing is one of the crystal (cut_crystal()), perhaps with atoms of other species; its
  /// cuts part atoms. Loads act on its boundary faces.
  AtomForce(const Crystal<dim> &crystal, const packings::Packing<dim> &packing,
            const AtomForceOptions &options = {},
            const std::vector<core::BoundaryLoad<dim>> &loads = {});

  bool has_rotations() const override { return false; }
  void compute(Particles &atoms, double time) override;
  double potential_energy(const Particles &atoms) const override;
  /// About the reference, (M6).
  double stable_step(const Particles &atoms) const override;
  particles::ElasticConstants<dim> elastic_constants() const override
  {
    return crystal_.elastic_constants();
  }
  /// Cauchy and Born's.
  std::shared_ptr<const core::HyperelasticLaw<dim>> finite_strain_law() const override;
  double range() const override { return body_.potential.cutoff(); }
  bool is_prestressed() const override { return true; }
  void reference_forces(const Particles &atoms, Components<dim> &force) const override;
  /// Pairs within the cut-off in the reference that no crack parts.
  void for_each_neighbour(const Particles &atoms,
                          const std::function<void(const particles::Neighbour &)> &visit,
                          const std::vector<int> *of = nullptr) const override;
  /// Those with fewer neighbours than the crystal gives them.
  std::vector<int> open_particles(const Particles &atoms,
                                  const std::vector<int> &of) const override;
  /// Atoms that lack neighbours there have the stress of the crystal in the mesh's motion, and no
  /// defect.
  void set_coupled_edge(const Particles &, particles::CoupledEdge<dim> edge) override
  {
    edge_ = std::move(edge);
  }
  void set_energy_weights(const std::vector<double> &weights) override;
  void add_tangent(const Particles &atoms,
                   const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
                   const std::vector<int> *of = nullptr) const override;
  /// The terms of add_tangent() at any deformation, in normal form, and pairs that come into range
  /// (of the list at rest) where both atoms are members: they have the share of their middle, and
  /// enter the densities.
  std::unique_ptr<particles::PartialForce<dim>>
  part(const Particles &atoms, const std::vector<int> &members,
       const typename particles::ParticleForce<dim>::TermShare &share) const override;
  void save(core::State &state, const core::Names &names, const Particles &atoms) const override;
  void load(const core::State &state, const core::Names &names, const Particles &atoms) override;

  /// Between nearest neighbours, with areas that close around an atom of the crystal and fill its
  /// volume (in triangular and face-centred crystals those of its cell); atoms at the surface have
  /// no faces there. Pairs that the cuts part have one that is not bonded.
  void for_each_face(const Particles &atoms,
                     const std::function<void(const particles::FaceView<dim> &)> &visit,
                     const std::vector<int> *of = nullptr) const override;

  /// Of the atoms' bonds, each half, over the reference volume: (M7). For small strains Cauchy's
  /// stress, in general Kirchhoff's.
  void stresses(const Particles &atoms, Components<n_strains<dim>> &stress) const override;
  bool can_break() const override { return true; }
  /// Nearest neighbours that have left each other, seen when the list of neighbours is built anew.
  const std::vector<particles::BrokenBond<dim>> &broken_bonds() const override
  {
    return parted_.parted();
  }
  /// Materials are species, 0 that of the crystal.
  std::vector<std::string> symbols() const override;
  int material(int atom) const override;
  /// Those that lack a quarter of the crystal's neighbours, as atoms at any surface do; beside
  /// dislocations and vacancies, and by heat, single ones are missing.
  std::vector<char> at_crack_faces(const Particles &atoms) const override;
  /// Potential energy in J, centro-symmetry and coordination.
  std::vector<particles::OwnField> own_fields(const Particles &atoms) const override;
  Vector<dim> reaction(int load) const override { return loads_.reaction(load); }
  double external_work() const override { return loads_.external_work(); }
  /// Pairs that the list has at present.
  long n_bonds() const override { return list_.n_pairs(); }

  /// Whether every pair within the cut-off is one of the reference, so that nobody needs to be
  /// looked for.
  bool is_undisturbed(const Particles &atoms) const { return update_list(atoms); }
  const Crystal<dim> &crystal() const { return crystal_; }
  const NeighbourList &list() const { return list_; }

  /// sum |r_a + r_b|^2 over the pairs of nearest neighbours that are most opposite, over the
  /// squared spacing (C. Kelchner, S. Plimpton, J. Hamilton, Phys. Rev. B 58 (1998) 11085): 0 in
  /// the crystal, however strained; some tenths and more at defects.
  std::vector<double> centro_symmetry(const Particles &atoms) const;
  /// Neighbours nearer than midway between the first and the next shell (bcc: second and third): 6,
  /// 12 or 14 in the crystal.
  std::vector<int> coordination(const Particles &atoms) const;

private:
  /// m: farther apart, two atoms are no nearest neighbours.
  double shell_limit() const;
  /// Pairs of the list as it stands.
  std::vector<Bond<dim>> nearest_neighbours(const Particles &atoms) const;
  /// Within the shell limit; of an atom of the crystal, and of all as the list stands.
  int coordination_of_crystal() const;
  std::vector<int> count_neighbours(const Particles &atoms) const;
  /// Afterwards the list has all pairs within the cut-off. Returns whether the crystal is
  /// undisturbed: these are bonds of the rows.
  bool update_list(const Particles &atoms) const;
  Particles at_rest() const;
  /// visit(bond) of the list as it is.
  template <typename Visit>
  void for_each_present_bond(const Particles &atoms, bool or_reference, Visit &&visit) const
  {
    for_each_bond<dim>(list_, atoms, body_.period, or_reference, visit);
  }
  /// visit(bond, tension): N, above 0 where it pulls.
  template <typename Visit>
  void for_each_tension(const Particles &atoms, Visit &&visit) const;
  void compute_plainly(Particles &atoms) const;
  std::vector<double> densities(const Particles &atoms) const;
  /// Half of each pair's energy and the embedding energy of each atom, in J; and what they are
  /// more than in the reference, bond by bond.
  std::vector<double> energies(const Particles &atoms) const;
  std::vector<double> energy_changes(const Particles &atoms) const;
  /// Sum of the latter, by vectors where it can be.
  double energy_change(const Particles &atoms) const;
  /// Of all bonds of the list, which is up to date; J.
  double whole_energy(const Particles &atoms) const;
  /// Vectors to the present neighbours of each atom within `reach`, in m.
  std::vector<std::vector<Vector<dim>>> neighbours(const Particles &atoms, double reach) const;

  Crystal<dim> crystal_;
  AtomBody<dim> body_;
  Components<dim> reference_; // m
  mutable AtomKernel kernel_; // has work space of its own
  mutable std::optional<EnergyChange<dim>> energy_change_; // of bodies of one species, likewise
  AtomLoads<dim> loads_;
  particles::CoupledEdge<dim> edge_;
  PartedBonds<dim> parted_;
  std::vector<Bond<dim>> cut_; // nearest neighbours of the reference that the cuts part
  int looked_build_ = 0; // number of the list at the last look for parted bonds
  std::vector<int> whole_coordination_; // at rest, of the body without its cuts
  std::vector<double> reference_density_;
  double reference_energy_ = 0; // J
  // Looking at a state may bring the list up to date. Which way a state goes depends on its
  // displacements, and on whether and where the list was built, which save() keeps: a run that is
  // taken up again goes the same way.
  mutable std::optional<RowKernel<dim>> rows_; // of bodies of one species
  mutable NeighbourList list_;
  mutable bool list_is_reference_ = true;
  mutable Components<dim> built_; // m, else: displacements at which it was built
};

template <int dim>
template <typename Visit>
void AtomForce<dim>::for_each_tension(const Particles &atoms, Visit &&visit) const
{
  std::vector<double> slope = densities(atoms);
  for (int i = 0; i < atoms.size(); ++i)
    slope[i] = body_.weight_of(i) * body_.potential.embedding(body_.species[i], slope[i]).slope;
  for_each_present_bond(atoms, false, [&](const Bond<dim> &b) {
    const BondJets jets = body_.potential.bond(body_.species[b.i], body_.species[b.j], b.length);
    visit(b, body_.weight_of(b.i, b.j) * jets.pair.slope + slope[b.i] * jets.density_at_i.slope +
                 slope[b.j] * jets.density_at_j.slope);
  });
}
} // namespace ligament::md
