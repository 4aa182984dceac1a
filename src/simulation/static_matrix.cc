// The matrix that a static solver is preconditioned with, theory.md eq. (Q3).
#include "coupling/operators/blended_operators.h"
#include "fem/cell_map.h"
#include "fem/condensed_cell.h"
#include "src/simulation/static_system.h"

#include <map>

namespace ligament::program
{
namespace
{
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Terms of the energy: how several numbers of the blocks of its members move what it resists.
struct Term
{
  std::vector<int> members; // block rows
  Matrix rows;              // per resistance; block columns per member
  Eigen::VectorXd stiffness;
};

/// Visits all terms with every motion written as T y, penalty included.
template <int dim, typename Visit>
class Terms
{
  static constexpr int block = n_particle_dofs<dim>, nc = fem::n_cell_nodes<dim>;
  using Quadratic = particles::QuadraticTerm<dim>;

public:
  Terms(const CoupledBody<dim> &body, const std::vector<char> &is_inert, Visit &visit)
      : body_(body), is_inert_(is_inert), visit_(visit), overlap_(body.coupler->overlap()),
        n_particles_(body.zone ? body.zone->state.size() : 0)
  {
  }

  void visit_zone()
  {
    if (!body_.zone)
      return;
    const auto add = [this](const Quadratic &term) {
      if (!is_left_out(term))
        visit_quadratic(term);
    };
    body_.force()->add_tangent(body_.zone->state, add);
    body_.force()->add_other_tangent(body_.zone->state, add);
  }

  /// kappa/2 |u_i - Phi_i U|^2, kappa = C11 V/h^2.
  void visit_penalty(double factor)
  {
    if (!overlap_)
      return;
    const double modulus = body_.force()->elastic_constants().stiffness(0, 0);
    for (const auto &m : overlap_->members) {
      if (m.pad)
        continue;
      const double kappa = factor * modulus * body_.zone->state.volume[m.particle] /
                           (overlap_->cell_size * overlap_->cell_size);
      term_.members = {m.particle};
      for (const int node : m.nodes)
        term_.members.push_back(n_particles_ + overlap_->near_nodes[node]);
      term_.rows.setZero(dim, block * term_.members.size());
      for (int c = 0; c < dim; ++c) {
        term_.rows(c, c) = 1;
        for (int a = 0; a < nc; ++a)
          term_.rows(c, block * (1 + a) + c) = -m.value[a];
      }
      term_.stiffness.setConstant(dim, kappa);
      finish();
    }
  }

private:
  /// In 3D the pressures of particles make most of the blocks, because neighbours of neighbours
  /// enter. A body without them is as stiff but for a factor 1 + 3 lambda/(2 G) at most.
  bool is_left_out(const Quadratic &q) const
  {
    constexpr double most = 1.5; // lambda/G; nu = 0.3
    if (dim == 2 || q.kind != Quadratic::Kind::volumetric)
      return false;
    const double shear =
        body_.force()->elastic_constants().stiffness(n_strains<dim> - 1, n_strains<dim> - 1);
    return q.stiffness[0] <= most * shear * body_.zone->state.volume[q.members[0]];
  }

  void visit_quadratic(const Quadratic &q)
  {
    constexpr int none = -1;
    core::require(q.rows.cols() == long(block * q.members.size()),
                  "an equilibrium: the force has no rotations");
    bool plain = true;
    for (const int i : q.members)
      plain = plain && !is_pad(i);
    if (plain) {
      term_.members = q.members;
      term_.rows = q.rows;
      term_.stiffness = q.stiffness;
      finish();
      return;
    }
    term_.members.clear();
    std::vector<int> column(q.members.size(), none);
    for (std::size_t k = 0; k < q.members.size(); ++k)
      if (const int i = q.members[k]; !is_pad(i)) {
        column[k] = place_of(i);
      } else
        for (const int node : pad(i).nodes)
          place_of(n_particles_ + overlap_->near_nodes[node]);
    term_.rows.setZero(q.rows.rows(), block * term_.members.size());
    for (std::size_t k = 0; k < q.members.size(); ++k) {
      const auto own = q.rows.middleCols(block * k, block);
      if (column[k] != none) {
        term_.rows.middleCols(block * column[k], block) += own;
        continue;
      }
      const auto &m = pad(q.members[k]);
      for (int a = 0; a < nc; ++a) {
        const int at = place_of(n_particles_ + overlap_->near_nodes[m.nodes[a]]);
        term_.rows.middleCols(block * at, dim) +=
            m.value[a] * own.leftCols(dim) +
            own.rightCols(n_spins<dim>) * coupling::Overlap<dim>::spin_block(m, a);
      }
    }
    term_.stiffness = q.stiffness;
    finish();
  }

  /// Among the members, where it is added if it is not there.
  int place_of(int row)
  {
    for (std::size_t k = 0; k < term_.members.size(); ++k)
      if (term_.members[k] == row)
        return int(k);
    term_.members.push_back(row);
    return int(term_.members.size()) - 1;
  }

  bool is_pad(int particle) const
  {
    return overlap_ && overlap_->member_of_particle[particle] >= 0 && pad(particle).pad;
  }
  const typename coupling::Overlap<dim>::Member &pad(int particle) const
  {
    return overlap_->members[overlap_->member_of_particle[particle]];
  }

  void finish()
  {
    for (std::size_t k = 0; k < term_.members.size(); ++k)
      for (int c = 0; c < block; ++c)
        if (is_inert_[std::size_t(term_.members[k]) * block + c])
          term_.rows.col(block * k + c).setZero();
    visit_(term_);
  }

  const CoupledBody<dim> &body_;
  const std::vector<char> &is_inert_;
  Visit &visit_;
  const coupling::Overlap<dim> *overlap_;
  int n_particles_;
  Term term_;
};

/// Stiffnesses of the far field's own cells on free nodes: visit(nodes, matrix), dim rows per node.
template <int dim, typename Visit>
void for_each_own_cell(const fem::FemSolver<dim> &far, Visit &&visit)
{
  const auto &mesh = far.mesh();
  const fem::CellCondenser<dim> condense(mesh);
  const auto make = [&](int cell) { return fem::cell_stiffness(mesh, cell, far.body()); };
  std::map<std::array<double, dim>, fem::CellMatrix<dim>> of_size;
  const auto of_box = [&](int cell) -> const fem::CellMatrix<dim> & {
    std::array<double, dim> key;
    for (int c = 0; c < dim; ++c)
      key[c] = mesh.cell_size[cell][c];
    auto found = of_size.find(key);
    if (found == of_size.end())
      found = of_size.emplace(key, make(cell)).first;
    return found->second;
  };
  fem::CellMatrix<dim> general;
  const auto of_general = [&](int cell) -> const fem::CellMatrix<dim> & {
    return general = make(cell);
  };
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    if (!far.is_own_cell(cell))
      continue;
    const auto &k = mesh.is_box(cell) ? of_box(cell) : of_general(cell);
    if (!condense.hangs(cell)) {
      visit(mesh.cells[cell], k);
      continue;
    }
    const auto condensed = condense(cell);
    fem::CellMatrix<dim> shares = fem::CellMatrix<dim>::Zero();
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
      for (int b = 0; b < fem::n_cell_nodes<dim>; ++b)
        for (int c = 0; c < dim; ++c)
          shares(dim * a + c, dim * b + c) = condensed.shares(a, b);
    visit(condensed.nodes, fem::CellMatrix<dim>(shares.transpose() * k * shares));
  }
}
} // namespace

template <int dim>
algebra::BlockMatrix StaticSystem<dim>::near_stiffness(double penalty) const
{
  algebra::BlockAssembly assembly(n_particles_ + n_nodes_, block);
  const auto of_zone = [&](auto &&visit) {
    Terms<dim, std::decay_t<decltype(visit)>> terms(body_, is_inert_, visit);
    terms.visit_zone();
    terms.visit_penalty(penalty);
  };
  using Nodes = std::array<int, fem::n_cell_nodes<dim>>;
  const auto of_cells = [&](auto &&visit) {
    if (body_.far)
      for_each_own_cell(*body_.far, [&](const Nodes &nodes, const fem::CellMatrix<dim> &k) {
        std::vector<int> members;
        for (const int node : nodes)
          members.push_back(node_block(node));
        visit(members, k);
      });
  };
  const Eigen::SparseMatrix<double> near = body_.coupler->near_stiffness();
  const auto *overlap = body_.coupler->overlap();
  const auto near_block = [&](Eigen::Index k) {
    return node_block(overlap->near_nodes[k % overlap->n_nodes()]);
  };

  of_zone(
      [&](const Term &term) { assembly.announce(term.members.data(), int(term.members.size())); });
  of_cells([&](const std::vector<int> &members, const fem::CellMatrix<dim> &) {
    assembly.announce(members.data(), int(members.size()));
  });
  for (int k = 0; k < near.outerSize(); ++k)
    for (Eigen::SparseMatrix<double>::InnerIterator it(near, k); it; ++it) {
      const int pair[] = {near_block(it.row()), near_block(it.col())};
      assembly.announce(pair, 2);
    }
  assembly.close();

  Matrix entries;
  of_zone([&](const Term &term) {
    entries.noalias() = term.rows.transpose() * term.stiffness.asDiagonal() * term.rows;
    assembly.add(term.members.data(), int(term.members.size()), entries.data());
  });
  of_cells([&](const std::vector<int> &members, const fem::CellMatrix<dim> &k) {
    const int n = int(members.size());
    entries.setZero(block * n, block * n);
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        for (int c = 0; c < dim; ++c)
          for (int d = 0; d < dim; ++d)
            if (!is_inert_[members[a] * block + c] && !is_inert_[members[b] * block + d])
              entries(block * a + c, block * b + d) = k(dim * a + c, dim * b + d);
    assembly.add(members.data(), n, entries.data());
  });
  std::array<double, block * block> one{};
  for (int k = 0; k < near.outerSize(); ++k)
    for (Eigen::SparseMatrix<double>::InnerIterator it(near, k); it; ++it) {
      const int row = near_block(it.row()), column = near_block(it.col());
      const int c = int(it.row()) / overlap->n_nodes(), d = int(it.col()) / overlap->n_nodes();
      if (is_inert_[row * block + c] || is_inert_[column * block + d])
        continue;
      one.fill(0);
      one[c * block + d] = it.value();
      assembly.add_block(row, column, one.data());
    }
  return assembly.take();
}

template algebra::BlockMatrix StaticSystem<2>::near_stiffness(double) const;
template algebra::BlockMatrix StaticSystem<3>::near_stiffness(double) const;
} // namespace ligament::program
