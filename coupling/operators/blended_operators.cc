#include "coupling/operators/blended_operators.h"

#include "core/check.h"
#include "core/part.h"
#include "coupling/algebra/nodal_matrix.h"
#include "coupling/operators/dead_load.h"
#include "coupling/operators/member_terms.h"
#include "fem/cell_map.h"
#include "fem/cell_modes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace ligament::coupling
{
namespace
{
using Triplets = std::vector<Eigen::Triplet<double>>;
using core::require;

constexpr const char *loaded_side =
    "the overlap reaches a loaded or held side of the specimen, where it can't end yet; keep the "
    "discrete zone away from that side";

// Gauss points and weights on [0, 1]; four points integrate the cubic weight times the quadratic
// strain products exactly where s is linear.
constexpr double gauss_point[4] = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                   0.93056815579702629};
constexpr double gauss_weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                    0.17392742256872693};

template <int dim, typename Visit>
void for_each_gauss_point(const Vector<dim> &lower, const Vector<dim> &size, Visit &&visit)
{
  constexpr int n = dim == 2 ? 16 : 64;
  for (int q = 0; q < n; ++q) {
    Vector<dim> x;
    double weight = 1;
    for (int c = 0, rest = q; c < dim; ++c, rest /= 4) {
      x[c] = lower[c] + size[c] * gauss_point[rest % 4];
      weight *= size[c] * gauss_weight[rest % 4];
    }
    visit(x, weight);
  }
}

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

/// The far field's own, by the nodes that carry the cell.
template <int dim>
fem::CellMatrix<dim> whole_cell_stiffness(const fem::CondensedCell<dim> &shape,
                                          const Vector<dim> &size, const fem::Body<dim> &body)
{
  const auto k = fem::cell_stiffness<dim>(size, body);
  if (!shape.hangs())
    return k;
  fem::CellMatrix<dim> shares;
  for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
    for (int b = 0; b < fem::n_cell_nodes<dim>; ++b)
      shares.template block<dim, dim>(dim * a, dim * b) =
          shape.shares(a, b) * Eigen::Matrix<double, dim, dim>::Identity();
  return shares.transpose() * k * shares;
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
    const Vector<dim> &lower = overlap_.mesh.cell_lower[cell.cell];
    const Vector<dim> &size = overlap_.mesh.cell_size[cell.cell];
    const fem::CellMatrix<dim> k = blended_cell_stiffness(overlap_, cell, body_);
    Eigen::Matrix<double, nc, nc> consistent;
    consistent.setZero();
    for_each_gauss_point<dim>(lower, size, [&](const Vector<dim> &x, double w) {
      w *= (cell.layer == 0 ? 1 - overlap_.weight(x) : 1) * body_.thickness * body_.density;
      const auto value = overlap_.shape_values(cell, x);
      consistent += w * value * value.transpose();
    });
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

template <int dim>
void add_normal(std::vector<Vector<dim>> &normals, const Vector<dim> &normal)
{
  for (const auto &n : normals)
    if ((n - normal).norm() < 1e-6)
      return;
  normals.push_back(normal);
}

/// Whether the mesh ends there because particles alone go on: as deep as the overlap is long.
template <int dim>
bool looks_into_zone(const Overlap<dim> &overlap, const fem::CellFace<dim> &face,
                     const core::FaceCorners<dim> &corners)
{
  if (face.boundary != inner_surface<dim>)
    return false;
  constexpr double round_off = 1e-6;
  return overlap.distance_to_edge(core::face_centroid<dim>(corners)) >
         overlap.parameters.length * (1 - round_off);
}

// A node feels a free surface when a particle at that surface, or a neighbour of one, hands it
// forces, or when it lies on the surface itself: on a side of the box, one with a name or one
// without. Where no particle lies in the outermost cells the mesh alone tells.
template <int dim>
std::vector<std::vector<Vector<dim>>> find_free_normals(const Overlap<dim> &overlap,
                                                        const particles::Particles<dim> &particles,
                                                        const particles::ParticleForce<dim> &force)
{
  using Face = particles::FaceView<dim>;
  const std::vector<int> members = overlap.member_particles();
  std::vector<int> near_members = members; // and their neighbours
  const auto add_neighbour = [&](const particles::Neighbour &n) { near_members.push_back(n.j); };
  force.for_each_neighbour(particles, add_neighbour, &members);
  std::sort(near_members.begin(), near_members.end());
  near_members.erase(std::unique(near_members.begin(), near_members.end()), near_members.end());

  std::unordered_map<int, std::vector<Vector<dim>>> on_surface;
  const auto add_surface = [&](const Face &face) {
    if (face.j < 0)
      add_normal<dim>(on_surface[face.i], face.normal);
  };
  force.for_each_face(particles, add_surface, &near_members);
  auto felt = on_surface;
  const auto feel = [&](const Face &face) {
    if (const auto found = on_surface.find(face.j); found != on_surface.end())
      for (const auto &normal : found->second)
        add_normal<dim>(felt[face.i], normal);
  };
  force.for_each_face(particles, feel, &members);
  std::vector<std::vector<Vector<dim>>> normals(overlap.n_nodes());
  for (const auto &m : overlap.members)
    for (const auto &normal : felt[m.particle]) {
      require((normal.cwiseAbs().array() > 1 - 1e-9).any(),
              "the overlap ends at a curved or inclined free surface, which is not supported yet; "
              "keep holes and notches away from it");
      for (const int node : m.nodes)
        add_normal<dim>(normals[node], normal);
    }
  std::vector<int> near(overlap.mesh.n_nodes(), -1);
  for (int i = 0; i < overlap.n_nodes(); ++i)
    near[overlap.near_nodes[i]] = i;
  for (const auto &face : overlap.mesh.boundary_faces) {
    const auto &nodes = overlap.mesh.cells[face.cell];
    const auto local = fem::face_nodes<dim>(face.face);
    if (std::none_of(local.begin(), local.end(), [&](int a) { return near[nodes[a]] >= 0; }))
      continue;
    const auto corners = fem::cell_corners(overlap.mesh, face.cell);
    if (looks_into_zone(overlap, face, fem::face_corners<dim>(corners, face.face)))
      continue;
    const Vector<dim> normal = fem::face_normal<dim>(corners, face.face);
    for (const int a : local)
      if (const int node = near[nodes[a]]; node >= 0)
        add_normal<dim>(normals[node], normal);
  }
  return normals;
}

/// What the cell's own modes take of its stiffness where the mesh is alone: behind the pads' depth
/// no particle moves but with it (theory.md eq. (C21)). Their mean over that part is taken off
/// them, so that uniform strain is as without them.
template <int dim>
fem::CellMatrix<dim> relief_by_modes(const Overlap<dim> &overlap,
                                     const typename Overlap<dim>::Cell &cell,
                                     const fem::Body<dim> &body)
{
  constexpr int n = dim * fem::n_cell_nodes<dim>, n_modes = fem::n_cell_modes<dim>;
  const Vector<dim> &lower = overlap.mesh.cell_lower[cell.cell];
  const Vector<dim> &size = overlap.mesh.cell_size[cell.cell];
  const auto for_each_lonely_point = [&](auto &&visit) {
    for_each_gauss_point<dim>(lower, size, [&](const Vector<dim> &x, double w) {
      const Vector<dim> s = 2 * (x - lower).cwiseQuotient(size) - Vector<dim>::Ones();
      if (overlap.distance_to_edge(x) < overlap.depth)
        visit(x, fem::mode_strains<dim>(s), w * (1 - overlap.weight(x)) * body.thickness);
    });
  };
  double volume = 0, energy = 0; // energy of all modes, their means included
  Eigen::Matrix<double, n_strains<dim>, n_modes> mean = decltype(mean)::Zero();
  for_each_lonely_point([&](const Vector<dim> &, const auto &modes, double w) {
    volume += w;
    mean += w * modes;
    energy += w * (modes.transpose() * body.stiffness * modes).trace();
  });
  if (volume == 0)
    return fem::CellMatrix<dim>::Zero();
  mean /= volume;
  Eigen::Matrix<double, n_modes, n> coupled = decltype(coupled)::Zero();
  Eigen::Matrix<double, n_modes, n_modes> own = decltype(own)::Zero();
  for_each_lonely_point([&](const Vector<dim> &x, const auto &modes, double w) {
    const Eigen::Matrix<double, n_strains<dim>, n_modes> g = modes - mean;
    const auto b = fem::strain_matrix<dim>(overlap.shape_gradients(cell, x));
    coupled += w * g.transpose() * body.stiffness * b;
    own += w * g.transpose() * body.stiffness * g;
  });
  // In a thin part some modes are constant and do nothing, where a corner has one point alone all.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n_modes, n_modes>> solver(own);
  const double least = 1e-10 * energy;
  fem::CellMatrix<dim> relief = fem::CellMatrix<dim>::Zero();
  for (int m = 0; m < n_modes; ++m)
    if (solver.eigenvalues()[m] > least) {
      const Eigen::Matrix<double, n, 1> row = coupled.transpose() * solver.eigenvectors().col(m);
      relief += row * row.transpose() / solver.eigenvalues()[m];
    }
  return relief;
}
} // namespace

template <int dim>
fem::CellMatrix<dim> blended_cell_stiffness(const Overlap<dim> &overlap,
                                            const typename Overlap<dim>::Cell &cell,
                                            const fem::Body<dim> &body)
{
  const Vector<dim> &lower = overlap.mesh.cell_lower[cell.cell];
  const Vector<dim> &size = overlap.mesh.cell_size[cell.cell];
  if (cell.layer > 0)
    return whole_cell_stiffness(cell.shape, size, body);
  const bool is_stressed = !body.stress.isZero(0);
  fem::CellMatrix<dim> k;
  k.setZero();
  for_each_gauss_point<dim>(lower, size, [&](const Vector<dim> &x, double w) {
    w *= (1 - overlap.weight(x)) * body.thickness;
    const auto gradients = overlap.shape_gradients(cell, x);
    const auto b = fem::strain_matrix<dim>(gradients);
    k += w * b.transpose() * body.stiffness * b;
    if (is_stressed)
      k += fem::stress_stiffness<dim>(gradients, body.stress, w);
  });
  return k - relief_by_modes(overlap, cell, body);
}

template <int dim>
fem::CellMean<dim> blended_cell_mean(const Overlap<dim> &overlap,
                                     const typename Overlap<dim>::Cell &cell,
                                     const fem::Body<dim> &body)
{
  fem::CellMean<dim> mean;
  for_each_gauss_point<dim>(overlap.mesh.cell_lower[cell.cell], overlap.mesh.cell_size[cell.cell],
                            [&](const Vector<dim> &x, double w) {
                              const double share = cell.layer > 0 ? 1 : 1 - overlap.weight(x);
                              mean.add(overlap.shape_gradients(cell, x),
                                       share * w * body.thickness);
                            });
  mean.close();
  return mean;
}

template <int dim>
Eigen::SparseMatrix<double> change_of_cells_alone(const Overlap<dim> &overlap,
                                                  const fem::Body<dim> &from,
                                                  const fem::Body<dim> &to)
{
  NodalMatrix<dim> change(overlap.n_nodes());
  for (const auto &cell : overlap.cells) {
    const Vector<dim> &lower = overlap.mesh.cell_lower[cell.cell];
    const Vector<dim> &size = overlap.mesh.cell_size[cell.cell];
    fem::CellMatrix<dim> k;
    k.setZero();
    if (cell.layer > 0)
      k = whole_cell_stiffness(cell.shape, size, to) - whole_cell_stiffness(cell.shape, size, from);
    else {
      for_each_gauss_point<dim>(lower, size, [&](const Vector<dim> &x, double w) {
        if (overlap.distance_to_edge(x) >= overlap.depth)
          return;
        w *= (1 - overlap.weight(x)) * to.thickness;
        const auto gradients = overlap.shape_gradients(cell, x);
        const auto b = fem::strain_matrix<dim>(gradients);
        k += w * b.transpose() * (to.stiffness - from.stiffness) * b;
        k += fem::stress_stiffness<dim>(gradients, Strain<dim>(to.stress - from.stress), w);
      });
      k -= relief_by_modes(overlap, cell, to) - relief_by_modes(overlap, cell, from);
    }
    change.add({cell.nodes.begin(), cell.nodes.end()}, k);
  }
  return change.to_sparse();
}

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
template Eigen::SparseMatrix<double> change_of_cells_alone(const Overlap<2> &, const fem::Body<2> &,
                                                           const fem::Body<2> &);
template Eigen::SparseMatrix<double> change_of_cells_alone(const Overlap<3> &, const fem::Body<3> &,
                                                           const fem::Body<3> &);
template fem::CellMatrix<2> blended_cell_stiffness(const Overlap<2> &, const Overlap<2>::Cell &,
                                                   const fem::Body<2> &);
template fem::CellMatrix<3> blended_cell_stiffness(const Overlap<3> &, const Overlap<3>::Cell &,
                                                   const fem::Body<3> &);
template fem::CellMean<2> blended_cell_mean(const Overlap<2> &, const Overlap<2>::Cell &,
                                            const fem::Body<2> &);
template fem::CellMean<3> blended_cell_mean(const Overlap<3> &, const Overlap<3>::Cell &,
                                            const fem::Body<3> &);
template Eigen::Matrix<double, 2, 2> unit_strain<2>(int);
template Eigen::Matrix<double, 3, 3> unit_strain<3>(int);
template Eigen::Matrix<double, 2, 2> unit_gradient<2>(int, int);
template Eigen::Matrix<double, 3, 3> unit_gradient<3>(int, int);
} // namespace ligament::coupling
