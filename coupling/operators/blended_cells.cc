#include "coupling/operators/blended_cells.h"

#include "coupling/algebra/nodal_matrix.h"
#include "fem/cell_modes.h"

#include <Eigen/Eigenvalues>

namespace ligament::coupling
{
namespace
{
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
Eigen::Matrix<double, fem::n_cell_nodes<dim>, fem::n_cell_nodes<dim>>
blended_cell_mass(const Overlap<dim> &overlap, const typename Overlap<dim>::Cell &cell,
                  const fem::Body<dim> &body)
{
  Eigen::Matrix<double, fem::n_cell_nodes<dim>, fem::n_cell_nodes<dim>> mass;
  mass.setZero();
  const Vector<dim> &lower = overlap.mesh.cell_lower[cell.cell];
  const Vector<dim> &size = overlap.mesh.cell_size[cell.cell];
  for_each_gauss_point<dim>(lower, size, [&](const Vector<dim> &x, double w) {
    w *= (cell.layer == 0 ? 1 - overlap.weight(x) : 1) * body.thickness * body.density;
    const auto value = overlap.shape_values(cell, x);
    mass += w * value * value.transpose();
  });
  return mass;
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
template Eigen::Matrix<double, 4, 4> blended_cell_mass(const Overlap<2> &, const Overlap<2>::Cell &,
                                                       const fem::Body<2> &);
template Eigen::Matrix<double, 8, 8> blended_cell_mass(const Overlap<3> &, const Overlap<3>::Cell &,
                                                       const fem::Body<3> &);
} // namespace ligament::coupling
