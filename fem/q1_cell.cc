#include "fem/mesh.h"

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
Eigen::Matrix<double, dim * n_cell_nodes<dim>, dim * n_cell_nodes<dim>>
cell_stiffness(const Vector<dim> &size, const Stiffness<dim> &c, double thickness)
{
  Eigen::Matrix<double, dim * n_cell_nodes<dim>, dim * n_cell_nodes<dim>> k;
  k.setZero();
  const double weight = size.prod() * thickness / n_cell_nodes<dim>;
  const double gauss[2] = {0.5 - std::sqrt(1. / 12), 0.5 + std::sqrt(1. / 12)};
  for (int q = 0; q < n_cell_nodes<dim>; ++q) {
    Vector<dim> p;
    for (int d = 0; d < dim; ++d)
      p[d] = size[d] * gauss[q >> d & 1];
    const auto b = strain_matrix<dim>(shape_gradients<dim>(Vector<dim>::Zero(), size, p));
    k += weight * b.transpose() * c * b;
  }
  return (k + k.transpose()) / 2;
}

template Vec<4> shape_values<2>(const Vector<2> &, const Vector<2> &, const Vector<2> &);
template Vec<8> shape_values<3>(const Vector<3> &, const Vector<3> &, const Vector<3> &);
template Eigen::Matrix<double, 2, 4> shape_gradients<2>(const Vector<2> &, const Vector<2> &,
                                                        const Vector<2> &);
template Eigen::Matrix<double, 3, 8> shape_gradients<3>(const Vector<3> &, const Vector<3> &,
                                                        const Vector<3> &);
template Eigen::Matrix<double, 3, 8> strain_matrix<2>(const Eigen::Matrix<double, 2, 4> &);
template Eigen::Matrix<double, 6, 24> strain_matrix<3>(const Eigen::Matrix<double, 3, 8> &);
template Eigen::Matrix<double, 8, 8> cell_stiffness<2>(const Vector<2> &, const Stiffness<2> &,
                                                       double);
template Eigen::Matrix<double, 24, 24> cell_stiffness<3>(const Vector<3> &, const Stiffness<3> &,
                                                         double);
} // namespace ligament::fem
