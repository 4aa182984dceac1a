#include "fem/cell_modes.h"

#include <Eigen/Cholesky>

namespace ligament::fem
{
template <int dim>
Vec<n_cell_nodes<dim>> shape_values(const Vector<dim> &lower, const Vector<dim> &size,
                                    const Vector<dim> &p)
{
  const Vector<dim> s = (p - lower).cwiseQuotient(size);
  Vec<n_cell_nodes<dim>> values;
  for (int a = 0; a < n_cell_nodes<dim>; ++a) {
    values[a] = 1;
    for (int k = 0; k < dim; ++k)
      values[a] *= a >> k & 1 ? s[k] : 1 - s[k];
  }
  return values;
}

template <int dim>
Eigen::Matrix<double, dim, n_cell_nodes<dim>>
shape_gradients(const Vector<dim> &lower, const Vector<dim> &size, const Vector<dim> &p)
{
  const Vector<dim> s = (p - lower).cwiseQuotient(size);
  Eigen::Matrix<double, dim, n_cell_nodes<dim>> gradients;
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    for (int k = 0; k < dim; ++k) {
      double g = (a >> k & 1 ? 1 : -1) / size[k];
      for (int l = 0; l < dim; ++l)
        if (l != k)
          g *= a >> l & 1 ? s[l] : 1 - s[l];
      gradients(k, a) = g;
    }
  return gradients;
}

template <int dim>
Eigen::Matrix<double, n_strains<dim>, dim * n_cell_nodes<dim>>
strain_matrix(const Eigen::Matrix<double, dim, n_cell_nodes<dim>> &gradients)
{
  Eigen::Matrix<double, n_strains<dim>, dim * n_cell_nodes<dim>> b;
  b.setZero();
  for (int a = 0; a < n_cell_nodes<dim>; ++a) {
    const auto g = gradients.col(a);
    for (int k = 0; k < dim; ++k)
      b(k, dim * a + k) = g[k];
    if constexpr (dim == 2) {
      b(2, dim * a) = g[1];
      b(2, dim * a + 1) = g[0];
    } else
      for (int k = 0; k < 3; ++k) // rows yz, xz, xy: the shear that leaves out direction k
      {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        b(3 + k, dim * a + i) = g[j];
        b(3 + k, dim * a + j) = g[i];
      }
  }
  return b;
}

template <int dim>
Eigen::Matrix<double, n_strains<dim>, n_cell_modes<dim>> mode_strains(const Vector<dim> &s)
{
  Eigen::Matrix<double, n_strains<dim>, n_cell_modes<dim>> g;
  g.setZero();
  int mode = 0;
  for (int k = 0; k < dim; ++k)
    g(k, mode++) = s[k];
  for (int shear = dim; shear < n_strains<dim>; ++shear)
    for (int k = 0; k < dim; ++k)
      if (dim == 2 || k != shear - 3) // the shear in row 3 + k leaves out direction k
        g(shear, mode++) = s[k];
  if constexpr (dim == 3)
    for (int k = 0; k < 3; ++k)
      g.col(mode++).template head<3>().setConstant(s[(k + 1) % 3] * s[(k + 2) % 3]);
  return g;
}

template <int dim>
CellMatrix<dim> cell_stiffness(const Vector<dim> &size, const Stiffness<dim> &c, double thickness)
{
  constexpr int n = dim * n_cell_nodes<dim>, modes = n_cell_modes<dim>;
  Eigen::Matrix<double, n + modes, n + modes> k; // of corners and modes
  k.setZero();
  const double weight = size.prod() * thickness / n_cell_nodes<dim>;
  for (int q = 0; q < n_cell_nodes<dim>; ++q) {
    Vector<dim> s;
    for (int d = 0; d < dim; ++d)
      s[d] = (q >> d & 1 ? 1 : -1) / std::sqrt(3.);
    const Vector<dim> p = size.cwiseProduct(s + Vector<dim>::Ones()) / 2;
    Eigen::Matrix<double, n_strains<dim>, n + modes> b;
    b << strain_matrix<dim>(shape_gradients<dim>(Vector<dim>::Zero(), size, p)),
        mode_strains<dim>(s);
    k += weight * b.transpose() * c * b;
  }
  // The modes belong to the cell alone: they are where its energy is least.
  const Eigen::Matrix<double, modes, n> coupled = k.template bottomLeftCorner<modes, n>();
  const Eigen::Matrix<double, modes, modes> own = k.template bottomRightCorner<modes, modes>();
  const CellMatrix<dim> condensed =
      k.template topLeftCorner<n, n>() - coupled.transpose() * own.ldlt().solve(coupled);
  return (condensed + condensed.transpose()) / 2;
}

template <int dim>
CellMatrix<dim> cell_stiffness(const Vector<dim> &size, const Body<dim> &body)
{
  CellMatrix<dim> k = cell_stiffness<dim>(size, body.stiffness, body.thickness);
  if (body.stress.isZero(0))
    return k;
  for (int q = 0; q < n_cell_nodes<dim>; ++q) {
    Vector<dim> p;
    for (int d = 0; d < dim; ++d)
      p[d] = size[d] / 2 * (1 + (q >> d & 1 ? 1 : -1) / std::sqrt(3.));
    k += stress_stiffness<dim>(shape_gradients<dim>(Vector<dim>::Zero(), size, p), body.stress,
                               size.prod() * body.thickness / n_cell_nodes<dim>);
  }
  return k;
}

template <int dim>
CellMatrix<dim> stress_stiffness(const CellVectors<dim> &gradients, const Strain<dim> &stress,
                                 double volume)
{
  Eigen::Matrix<double, dim, dim> tensor;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      tensor(i, j) = stress[voigt_index<dim>(i, j)];
  const Eigen::Matrix<double, n_cell_nodes<dim>, n_cell_nodes<dim>> pairs =
      volume * gradients.transpose() * tensor * gradients;
  CellMatrix<dim> k = CellMatrix<dim>::Zero();
  for (int a = 0; a < n_cell_nodes<dim>; ++a)
    for (int b = 0; b < n_cell_nodes<dim>; ++b)
      for (int c = 0; c < dim; ++c)
        k(dim * a + c, dim * b + c) = pairs(a, b);
  return k;
}

template Vec<4> shape_values<2>(const Vector<2> &, const Vector<2> &, const Vector<2> &);
template Vec<8> shape_values<3>(const Vector<3> &, const Vector<3> &, const Vector<3> &);
template Eigen::Matrix<double, 2, 4> shape_gradients<2>(const Vector<2> &, const Vector<2> &,
                                                        const Vector<2> &);
template Eigen::Matrix<double, 3, 8> shape_gradients<3>(const Vector<3> &, const Vector<3> &,
                                                        const Vector<3> &);
template Eigen::Matrix<double, 3, 8> strain_matrix<2>(const Eigen::Matrix<double, 2, 4> &);
template Eigen::Matrix<double, 6, 24> strain_matrix<3>(const Eigen::Matrix<double, 3, 8> &);
template Eigen::Matrix<double, 3, 4> mode_strains<2>(const Vector<2> &);
template Eigen::Matrix<double, 6, 12> mode_strains<3>(const Vector<3> &);
template CellMatrix<2> cell_stiffness<2>(const Vector<2> &, const Stiffness<2> &, double);
template CellMatrix<3> cell_stiffness<3>(const Vector<3> &, const Stiffness<3> &, double);
template CellMatrix<2> cell_stiffness<2>(const Vector<2> &, const Body<2> &);
template CellMatrix<3> cell_stiffness<3>(const Vector<3> &, const Body<3> &);
template CellMatrix<2> stress_stiffness<2>(const CellVectors<2> &, const Strain<2> &, double);
template CellMatrix<3> stress_stiffness<3>(const CellVectors<3> &, const Strain<3> &, double);
} // namespace ligament::fem
