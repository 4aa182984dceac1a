#include "dem/edge_cells.h"

#include "dem/tensors.h"
#include "dem/turn.h"

#include <algorithm>

namespace ligament::dem
{
namespace
{
template <int dim>
Eigen::Matrix<double, dim, dim> rotation(const particles::Particles<dim> &p, int i)
{
  const Turn<dim> turn = Turn<dim>::of(p, i);
  Eigen::Matrix<double, dim, dim> r = Eigen::Matrix<double, dim, dim>::Identity();
  for (int c = 0; c < dim; ++c)
    r.col(c) += turn.change(Vector<dim>::Unit(c));
  return r;
}
} // namespace

// By (D2b) the faces that are there and those that are missing make the whole moment I, but for the
// free ones, which carry nothing.
template <int dim>
EdgeCells<dim>::EdgeCells(particles::CoupledEdge<dim> edge,
                          const std::vector<packings::BoundaryFace<dim>> &boundary_faces,
                          const Materials &materials, const particles::Particles<dim> &particles,
                          const std::vector<double> &weights)
    : is_pad_(particles.size(), 0), gradient_(std::move(edge.gradient))
{
  for (const int i : edge.pads)
    is_pad_[i] = 1;
  std::vector<int> cell_of(particles.size(), -1);
  for (const int i : edge.open) {
    cell_of[i] = int(open_.size());
    open_.push_back({i, Matrix::Identity(), materials.of(i).shear_modulus(), 0,
                     weights.empty() ? 1 : weights[i]});
  }
  for (const auto &face : boundary_faces)
    if (const int k = cell_of[face.i]; k >= 0)
      open_[k].moment -=
          face.area / particles.volume[face.i] * face.lever * face.normal.transpose();
  for (OpenCell &cell : open_)
    cell.lambda =
        materials.of(cell.particle).template volumetric_stiffness<dim>(cell.moment.trace());
}

// R^T F - I
template <int dim>
auto EdgeCells<dim>::strain(const particles::Particles<dim> &p, int k) const -> Matrix
{
  const Matrix f = Matrix::Identity() + gradient_(k);
  return rotation<dim>(p, open_[k].particle).transpose() * f - Matrix::Identity();
}

template <int dim>
void EdgeCells<dim>::complete_pressures(const particles::Particles<dim> &p,
                                        std::vector<double> &pressure) const
{
  for (std::size_t k = 0; k < open_.size(); ++k) {
    const OpenCell &cell = open_[k];
    pressure[cell.particle] =
        cell.weight * cell.lambda * strain(p, int(k)).cwiseProduct(cell.moment).sum();
  }
}

template <int dim>
void EdgeCells<dim>::complete_stresses(const particles::Particles<dim> &p,
                                       Components<n_strains<dim>> &stress) const
{
  for (std::size_t k = 0; k < open_.size(); ++k) {
    const OpenCell &cell = open_[k];
    const Matrix e = strain(p, int(k)), r = rotation<dim>(p, cell.particle);
    const double dilatation = e.cwiseProduct(cell.moment).sum();
    const Matrix traction =
        2 * cell.shear_modulus * e + cell.lambda * dilatation * Matrix::Identity();
    const Matrix sum = r * cell.moment * traction.transpose() * r.transpose();
    Strain<dim> tensor = Strain<dim>::Zero();
    for (int c = 0; c < dim; ++c)
      tensor += symmetric_product<dim>(Vector<dim>::Unit(c), sum.row(c).transpose());
    set(stress, cell.particle, tensor);
  }
}

template class EdgeCells<2>;
template class EdgeCells<3>;
} // namespace ligament::dem
