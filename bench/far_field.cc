// Rates of the far field: its cell kernel and its whole step beside the machine's roofline and
// beside deal.II's MatrixFree in the same run. One JSON line each: {name, value, unit, reference,
// ratio}.
#include "bench/matrix_free.h"
#include "bench/roofline.h"
#include "fem/cell_kernel.h"
#include "fem/cell_quality.h"
#include "fem/fem_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace
{
using namespace ligament;

constexpr double lambda = 1, shear = 1;

void print(const std::string &name, double value, const std::string &unit, double reference)
{
  fmt::print("{{\"name\": \"{}\", \"value\": {:.4g}, \"unit\": \"{}\", \"reference\": {:.4g}, "
             "\"ratio\": {:.3f}}}\n",
             name, value, unit, reference, value / reference);
}

template <int dim>
fem::Body<dim> make_body()
{
  fem::Body<dim> body{Stiffness<dim>::Zero(), 1, 1};
  body.stiffness.template topLeftCorner<dim, dim>().setConstant(lambda);
  for (int i = 0; i < n_strains<dim>; ++i)
    body.stiffness(i, i) += i < dim ? 2 * shear : shear;
  return body;
}

template <int dim>
void measure(const std::string &name, const fem::MeshParameters<dim> &parameters,
             const bench::Roofline &roof, double matrix_free)
{
  auto mesh = fem::make_mesh(parameters);
  const auto body = make_body<dim>();
  Components<dim> u, f;
  for (int c = 0; c < dim; ++c) {
    f[c].assign(mesh.n_nodes(), 0.);
    for (const auto &x : mesh.nodes)
      u[c].push_back(1e-3 * std::sin(0.1 * x[(c + 1) % dim]));
  }
  const double n = double(dim) * mesh.n_nodes(), n_cells = mesh.n_cells();
  const std::string label =
      fmt::format("{}, {:.3g} unknowns, {} hanging nodes", name, n, mesh.hanging.size());
  const fem::CellKernel<dim> kernel(mesh, body, std::vector<char>(mesh.n_cells(), 1));
  const double product = n * bench::rate([&] { kernel.subtract_forces(u, f); });

  // A multiply-add per entry of a cell's matrix; u is read, f read and written.
  const double flops = 2. * fem::CellKernel<dim>::n_dofs * fem::CellKernel<dim>::n_dofs * n_cells;
  const double most = n / std::max(flops / roof.flops, 3 * sizeof(double) * n / roof.bytes);
  const std::string unit = "1e6 unknowns/s";
  print(label + ", product with K; reference: roofline", 1e-6 * product, unit, 1e-6 * most);
  print(label + ", product with K; reference: MatrixFree of deal.II", 1e-6 * product, unit,
        1e-6 * matrix_free);

  fem::FemSolver<dim> solver(std::move(mesh), body, {});
  solver.displacement = u;
  const double dt = 1e-6; // the motion stays as it is
  const double step = n * bench::rate([&] {
                        solver.drift(dt);
                        solver.compute_forces(0);
                        solver.kick(dt, 0);
                      });
  print(label + ", whole step; reference: product with K", 1e-6 * step, unit, 1e-6 * product);
}

/// 1e6 cells/s of the product with K.
template <int dim>
double cell_rate(const fem::Mesh<dim> &mesh)
{
  Components<dim> u, f;
  for (int c = 0; c < dim; ++c) {
    f[c].assign(mesh.n_nodes(), 0.);
    for (const auto &x : mesh.nodes)
      u[c].push_back(1e-3 * std::sin(0.1 * x[(c + 1) % dim]));
  }
  const fem::CellKernel<dim> kernel(mesh, make_body<dim>(), std::vector<char>(mesh.n_cells(), 1));
  return 1e-6 * mesh.n_cells() * bench::rate([&] { kernel.subtract_forces(u, f); });
}

/// Cells as boxes in runs, the same ones in batches, as parallelograms and with a shape each.
template <int dim>
void measure_shapes(int n)
{
  fem::MeshParameters<dim> p;
  p.lower.setZero();
  p.upper.setConstant(n);
  p.cell_size = 1;
  const fem::Mesh<dim> boxes = fem::make_mesh(p);
  const double runs = cell_rate(boxes);
  const auto print_rate = [&](const std::string &name, double rate) {
    print(fmt::format("{}D, {} cells, {}; reference: boxes in runs", dim, boxes.n_cells(), name),
          rate, "1e6 cells/s", runs);
  };
  print_rate("boxes in runs", runs);

  auto changed = boxes; // no cell follows its neighbour: even ones of a row first
  for (int row = 0; row + n <= boxes.n_cells(); row += n)
    for (int i = 0; i < n; ++i) {
      const int from = i < (n + 1) / 2 ? 2 * i : 2 * (i - (n + 1) / 2) + 1;
      changed.cells[row + i] = boxes.cells[row + from];
      changed.cell_lower[row + i] = boxes.cell_lower[row + from];
    }
  print_rate("boxes in batches", cell_rate(changed));

  changed = boxes;
  for (auto &x : changed.nodes)
    x[0] += 0.25 * x[1];
  fem::find_cell_shapes(changed);
  print_rate("equal parallelograms", cell_rate(changed));

  changed = boxes;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  for (auto &x : changed.nodes)
    for (int k = 0; k < dim; ++k)
      x[k] += uniform(random);
  fem::find_cell_shapes(changed);
  print_rate("of a shape each", cell_rate(changed));
}

template <int dim>
void measure_all(int n_small, int n_large, const bench::Roofline &roof)
{
  for (const int n : {n_small, n_large}) {
    long unknowns = 0;
    const auto multiply = bench::matrix_free_product<dim>(n, lambda, shear, unknowns);
    const double matrix_free = double(unknowns) * bench::rate(multiply);
    fem::MeshParameters<dim> p;
    p.lower.setZero();
    p.upper.setConstant(n);
    p.cell_size = 1;
    measure<dim>(fmt::format("{}D, equal cells", dim), p, roof, matrix_free);
    if (n == n_small)
      continue;
    // Around a zone in the middle, refined twice towards it.
    p.inner.push_back({Vector<dim>::Constant(0.4 * n), Vector<dim>::Constant(0.6 * n)});
    p.levels = 2;
    p.cell_size = 0.5;
    p.fine_cells = 8;
    measure<dim>(fmt::format("{}D, three sizes of cells", dim), p, roof, matrix_free);
  }
}
} // namespace

/// "shapes" measures those alone.
int main(int argc, char **argv)
{
  for (const int n : {50, 700})
    measure_shapes<2>(n);
  for (const int n : {12, 60})
    measure_shapes<3>(n);
  if (argc > 1 && std::string(argv[1]) == "shapes")
    return 0;
  const auto roof = bench::measure_roofline();
  measure_all<2>(150, 700, roof);
  measure_all<3>(24, 69, roof);
}
