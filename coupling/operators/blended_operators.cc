#include "coupling/operators/blended_operators.h"

#include "core/check.h"
#include "core/part.h"
#include "coupling/algebra/nodal_matrix.h"
#include "coupling/operators/blended_cells.h"
#include "coupling/operators/dead_load.h"
#include "coupling/operators/free_normals.h"
#include "coupling/operators/member_terms.h"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace ligament::coupling
{
namespace
{
using Triplets = std::vector<Eigen::Triplet<double>>;
using core::require;

constexpr const char *loaded_side =
    "the overlap reaches a loaded or held side of the specimen, where it can't end yet; keep the "
    "discrete zone away from that side";

/// Smallest eigenvalue of a cell's consistent mass over its row sums.
template <int dim>
double consistent_bound(const fem::CondensedCell<dim> &shape)
{
  constexpr int nc = fem::n_cell_nodes<dim>;
  if (!shape.hangs())
    return dim == 2 ? 1. / 9 : 1. / 27;
  using Matrix = Eigen::Matrix<double, nc, nc>;
  Matrix corners; // of a cell of mass 1: products of the masses of lines
  for (int a = 0; a < nc; ++a)
    for (int b = 0; b < nc; ++b) {
      corners(a, b) = 1;
      for (int c = 0; c < dim; ++c)
        corners(a, b) /= (a >> c & 1) == (b >> c & 1) ? 3 : 6;
    }
  const Matrix mass = shape.shares.transpose() * corners * shape.shares;
  const Vec<nc> scale = mass.rowwise().sum().cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * mass * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

template <int dim>
class Assembly
{
public:
  Assembly(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
           const particles::ParticleForce<dim> &force, const fem::Body<dim> &body,
           double coarse_mass)
      : stiffness(overlap.n_nodes()), coarse_mass_(coarse_mass), overlap_(overlap),
        particles_(particles), body_(body), n_(overlap.n_nodes()),
        terms_(overlap, particles, states_, motions_)
  {
    const int n_states = force.is_prestressed() ? dim * dim : n_strains<dim>;
    residual = Eigen::MatrixXd::Zero(dim * n_, n_states);
    mass_bound = Eigen::VectorXd::Zero(n_);
    for (int k = 0; k < n_states; ++k)
      states_.push_back(unit_gradient<dim>(k, n_states));
    motions_ = interpolate_motions(overlap, particles, force);
  }

  void add_cells();
  void add_masses();
  void add_term(const particles::QuadraticTerm<dim> &term);
  /// Once they are all there.
  void finish_terms()
  {
    terms_.add_residual(residual);
    terms_.subtract_stiffness(stiffness);
  }

  NodalMatrix<dim> stiffness;
  Triplets mass;
  Eigen::MatrixXd residual;
  Eigen::VectorXd mass_bound;

private:
  const double coarse_mass_;
  const Overlap<dim> &overlap_;
  const particles::Particles<dim> &particles_;
  const fem::Body<dim> &body_;
  const int n_;
  std::vector<Eigen::Matrix<double, dim, dim>> states_; // columns of the residual
  std::vector<InterpolatedMotion<dim>> motions_;        // of the members
  MemberTerms<dim> terms_;                              // without rotations
  std::vector<int> nodes_;                              // of the present term
};

template <int dim>
void Assembly<dim>::add_cells()
{
  constexpr int nc = fem::n_cell_nodes<dim>;
  for (const auto &cell : overlap_.cells) {
    const double bound = consistent_bound<dim>(cell.shape);
    const fem::CellMatrix<dim> k = blended_cell_stiffness(overlap_, cell, body_);
    const auto consistent = blended_cell_mass(overlap_, cell, body_);
    const double mu = cell.consistent_share;
    for (int a = 0; a < nc; ++a) {
      const double row_sum = consistent.row(a).sum();
      mass.emplace_back(cell.nodes[a], cell.nodes[a], (1 - mu) * row_sum);
      mass_bound[cell.nodes[a]] += row_sum * (1 - mu + mu * bound);
      for (int b = 0; b < nc; ++b)
        mass.emplace_back(cell.nodes[a], cell.nodes[b], mu * consistent(a, b));
    }
    stiffness.add({cell.nodes.begin(), cell.nodes.end()}, k);
    Eigen::Matrix<double, dim * nc, 1> u;
    for (std::size_t s = 0; s < states_.size(); ++s) {
      for (int a = 0; a < nc; ++a)
        u.template segment<dim>(a * dim) = states_[s] * cell.shape.place.col(a);
      const Eigen::Matrix<double, dim * nc, 1> f = k * u;
      for (int a = 0; a < nc; ++a)
        for (int i = 0; i < dim; ++i)
          residual(i * n_ + cell.nodes[a], s) -= f[a * dim + i];
    }
  }
}

template <int dim>
void Assembly<dim>::add_masses()
{
  for (const auto &m : overlap_.members) {
    const double bound = consistent_bound<dim>(overlap_.cells[m.cell].shape);
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
      const double share = coarse_mass_ * m.weight * particles_.mass[m.particle] * m.value[a];
      mass_bound[m.nodes[a]] += share * bound;
      for (int b = 0; b < fem::n_cell_nodes<dim>; ++b)
        mass.emplace_back(m.nodes[a], m.nodes[b], share * m.value[b]);
    }
  }
}

template <int dim>
void Assembly<dim>::add_term(const particles::QuadraticTerm<dim> &term)
{
  const int nd = int(term.rows.cols() / term.members.size());
  const bool turns = nd > dim;
  const bool touches = std::any_of(term.members.begin(), term.members.end(),
                                   [&](int i) { return overlap_.member_of_particle[i] >= 0; });
  if (!touches)
    return;
  require(term.kind != particles::QuadraticTerm<dim>::Kind::wall, loaded_side);
  if (!turns) {
    terms_.add(term);
    return;
  }

  // Forces per unit state on the members, handed to the nodes: Phi^T f, and Psi^T T of the pads;
  // less the share subtracted, by the interpolated motion.
  // Translations do nothing: the first member stands still.
  Eigen::MatrixXd gradient(term.rows.rows(), states_.size()); // stiffness * row . q
  for (std::size_t s = 0; s < states_.size(); ++s) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(term.rows.cols());
    for (std::size_t i = 0; i < term.members.size(); ++i)
      q.segment<dim>(i * nd) =
          states_[s] * overlap_.offset(get(particles_.reference, term.members[0]),
                                       get(particles_.reference, term.members[i]));
    gradient.col(s) = term.stiffness.cwiseProduct(term.rows * q);
  }
  const double share = overlap_.subtracted_share(term.location, term.members);
  for (std::size_t i = 0; i < term.members.size(); ++i) {
    const int index = overlap_.member_of_particle[term.members[i]];
    if (index < 0)
      continue;
    const auto &m = overlap_.members[index];
    const Eigen::MatrixXd force =
        term.rows.middleCols(i * nd, dim).transpose() * gradient; // minus the force
    const Eigen::MatrixXd torque =
        term.rows.middleCols(i * nd + dim, n_spins<dim>).transpose() * gradient;
    const auto add = [&](double factor, int node, double value, const Vector<dim> &gradient,
                         bool with_torque) {
      const auto spin = half_curl<dim>(gradient);
      for (int c = 0; c < dim; ++c) {
        residual.row(c * n_ + node) -= factor * value * force.row(c);
        if (with_torque)
          residual.row(c * n_ + node) -= factor * spin.col(c).transpose() * torque;
      }
    };
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      add(1, m.nodes[a], m.value[a], m.gradient.col(a), m.pad);
    for (const NodeShare<dim> &s : motions_[index])
      add(-share, s.node, s.value, s.gradient, true);
  }
  if (share == 0)
    return;

  // The subtracted stiffness: rows on the interpolated motion.
  nodes_.clear();
  for (const int i : term.members)
    for (const NodeShare<dim> &s : motions_[overlap_.member_of_particle[i]])
      if (std::find(nodes_.begin(), nodes_.end(), s.node) == nodes_.end())
        nodes_.push_back(s.node);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(term.rows.rows(), dim * nodes_.size());
  for (std::size_t i = 0; i < term.members.size(); ++i)
    for (const NodeShare<dim> &s : motions_[overlap_.member_of_particle[term.members[i]]]) {
      const int column =
          dim * int(std::find(nodes_.begin(), nodes_.end(), s.node) - nodes_.begin());
      rows.middleCols(column, dim) +=
          s.value * term.rows.middleCols(i * nd, dim) +
          term.rows.middleCols(i * nd + dim, n_spins<dim>) * half_curl<dim>(s.gradient);
    }
  stiffness.add(nodes_, (rows.transpose() * term.stiffness.asDiagonal() * rows).eval(), -share);
}

} // namespace

template <int dim>
Eigen::Matrix<double, dim, dim> unit_strain(int k)
{
  Eigen::Matrix<double, dim, dim> e = Eigen::Matrix<double, dim, dim>::Zero();
  if (k < dim)
    e(k, k) = 1;
  else {
    // Voigt order of the shears: 2D xy; 3D yz, xz, xy.
    const int i = dim == 2 ? 0 : (k == 3 ? 1 : 0);
    const int j = dim == 2 ? 1 : (k == 5 ? 1 : 2);
    e(i, j) = e(j, i) = 0.5;
  }
  return e;
}

template <int dim>
Eigen::Matrix<double, dim, dim> unit_gradient(int k, int n_states)
{
  if (n_states == n_strains<dim>)
    return unit_strain<dim>(k);
  Eigen::Matrix<double, dim, dim> h = Eigen::Matrix<double, dim, dim>::Zero();
  h(k / dim, k % dim) = 1;
  return h;
}

template <int dim>
BlendedOperators<dim> make_blended_operators(const Overlap<dim> &overlap,
                                             const particles::Particles<dim> &particles,
                                             const particles::ParticleForce<dim> &force,
                                             const fem::Body<dim> &body, double coarse_mass)
{
  Assembly<dim> assembly(overlap, particles, force, body, coarse_mass);
  assembly.add_cells();
  assembly.add_masses();
  const std::vector<int> members = overlap.member_particles();
  force.add_tangent(
      particles, [&](const particles::QuadraticTerm<dim> &term) { assembly.add_term(term); },
      &members);
  assembly.finish_terms();

  const int n = overlap.n_nodes();
  BlendedOperators<dim> result;
  result.stiffness = assembly.stiffness.to_sparse();
  result.mass.resize(n, n);
  result.mass.setFromTriplets(assembly.mass.begin(), assembly.mass.end());
  result.mass_bound = assembly.mass_bound;
  result.residual = assembly.residual;
  result.free_normals = find_free_normals(overlap, particles, force);
  if (force.is_prestressed())
    result.dead_load = make_dead_load(overlap, particles, force);
  return result;
}

template <int dim>
BlendedOperators<dim>
make_cell_operators(const Overlap<dim> &overlap, const particles::Particles<dim> &particles,
                    const particles::ParticleForce<dim> &force, const fem::Body<dim> &body)
{
  const std::vector<int> members = overlap.member_particles();
  force.add_tangent(
      particles,
      [&](const particles::QuadraticTerm<dim> &term) {
        require(term.kind != particles::QuadraticTerm<dim>::Kind::wall, loaded_side);
      },
      &members);
  Assembly<dim> assembly(overlap, particles, force, body, 1);
  assembly.add_cells();
  const int n = overlap.n_nodes();
  BlendedOperators<dim> result;
  result.stiffness = assembly.stiffness.to_sparse();
  result.mass.resize(n, n);
  result.mass.setFromTriplets(assembly.mass.begin(), assembly.mass.end());
  return result;
}

template <int dim>
Eigen::SparseMatrix<double> take_over_cells(const Overlap<dim> &overlap, fem::FemSolver<dim> &far)
{
  std::vector<int> released;
  for (const auto &cell : overlap.cells)
    released.push_back(cell.cell);
  far.release_cells(released);
  const int n = overlap.n_nodes();
  Triplets entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, far.lumped_mass()[overlap.near_nodes[i]]);
    for (int c = 0; c < dim; ++c)
      require(!far.is_held(overlap.near_nodes[i], c),
              "the overlap or its transition reaches a held side of the specimen; keep the zone "
              "away from it or lower /coupling/transition_cells");
  }
  Eigen::SparseMatrix<double> mass(n, n);
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

template Eigen::SparseMatrix<double> take_over_cells(const Overlap<2> &, fem::FemSolver<2> &);
template Eigen::SparseMatrix<double> take_over_cells(const Overlap<3> &, fem::FemSolver<3> &);
template BlendedOperators<2> make_cell_operators(const Overlap<2> &,
                                                 const particles::Particles<2> &,
                                                 const particles::ParticleForce<2> &,
                                                 const fem::Body<2> &);
template BlendedOperators<3> make_cell_operators(const Overlap<3> &,
                                                 const particles::Particles<3> &,
                                                 const particles::ParticleForce<3> &,
                                                 const fem::Body<3> &);
template BlendedOperators<2> make_blended_operators(const Overlap<2> &,
                                                    const particles::Particles<2> &,
                                                    const particles::ParticleForce<2> &,
                                                    const fem::Body<2> &, double);
template BlendedOperators<3> make_blended_operators(const Overlap<3> &,
                                                    const particles::Particles<3> &,
                                                    const particles::ParticleForce<3> &,
                                                    const fem::Body<3> &, double);
template Eigen::Matrix<double, 2, 2> unit_strain<2>(int);
template Eigen::Matrix<double, 3, 3> unit_strain<3>(int);
template Eigen::Matrix<double, 2, 2> unit_gradient<2>(int, int);
template Eigen::Matrix<double, 3, 3> unit_gradient<3>(int, int);
} // namespace ligament::coupling
