#include "bench/matrix_free.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>
#include <deal.II/matrix_free/fe_evaluation.h>
#include <deal.II/matrix_free/matrix_free.h>

namespace ligament::bench
{
namespace
{
template <int dim>
class Elasticity
{
public:
  using Vector = dealii::Vector<double>;

  Elasticity(int n, double lambda, double shear)
      : element_(dealii::FE_Q<dim>(1), dim), dofs_(triangulation_), lambda_(lambda), shear_(shear)
  {
    dealii::GridGenerator::subdivided_hyper_cube(triangulation_, n, 0., n);
    dofs_.distribute_dofs(element_);
    constraints_.close();
    typename dealii::MatrixFree<dim, double>::AdditionalData data;
    data.tasks_parallel_scheme = dealii::MatrixFree<dim, double>::AdditionalData::none;
    data.mapping_update_flags = dealii::update_gradients | dealii::update_JxW_values;
    matrix_free_.reinit(dealii::MappingQ1<dim>(), dofs_, constraints_, dealii::QGauss<1>(2), data);
    matrix_free_.initialize_dof_vector(u_);
    matrix_free_.initialize_dof_vector(f_);
    for (auto i = u_.begin(); i != u_.end(); ++i)
      *i = 1e-3 * double((i - u_.begin()) % 17);
  }

  long size() const { return long(dofs_.n_dofs()); }

  void multiply() { matrix_free_.cell_loop(&Elasticity::multiply_cells, this, f_, u_, true); }

private:
  void multiply_cells(const dealii::MatrixFree<dim, double> &matrix_free, Vector &f,
                      const Vector &u, const std::pair<unsigned int, unsigned int> &cells) const
  {
    dealii::FEEvaluation<dim, 1, 2, dim, double> cell(matrix_free);
    for (unsigned int i = cells.first; i < cells.second; ++i) {
      cell.reinit(i);
      cell.gather_evaluate(u, dealii::EvaluationFlags::gradients);
      for (unsigned int q = 0; q < cell.n_q_points; ++q) {
        auto stress = 2. * shear_ * cell.get_symmetric_gradient(q);
        const auto pressure = lambda_ * cell.get_divergence(q);
        for (int c = 0; c < dim; ++c)
          stress[c][c] += pressure;
        cell.submit_symmetric_gradient(stress, q);
      }
      cell.integrate_scatter(dealii::EvaluationFlags::gradients, f);
    }
  }

  dealii::Triangulation<dim> triangulation_;
  dealii::FESystem<dim> element_;
  dealii::DoFHandler<dim> dofs_;
  dealii::AffineConstraints<double> constraints_;
  dealii::MatrixFree<dim, double> matrix_free_;
  Vector u_, f_;
  double lambda_, shear_;
};
} // namespace

template <int dim>
std::function<void()> matrix_free_product(int n, double lambda, double shear, long &unknowns)
{
  const auto body = std::make_shared<Elasticity<dim>>(n, lambda, shear);
  unknowns = body->size();
  return [body] { body->multiply(); };
}

template std::function<void()> matrix_free_product<2>(int, double, double, long &);
template std::function<void()> matrix_free_product<3>(int, double, double, long &);
} // namespace ligament::bench
