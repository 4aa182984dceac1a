// What assembly, product and preconditioners of a body's stiffness cost: {name, value, unit} as
// JSON lines.
//   bench_algebra [particles per side] [dimension] [cholesky|amd|multigrid|none]
#include "algebra/cholesky.h"
#include "algebra/conjugate_gradients.h"
#include "algebra/preconditioner.h"
#include "bench/roofline.h"
#include "tests/support/lattice_body.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdlib>
#include <string>

namespace
{
using namespace ligament;

class Stopwatch
{
public:
  double seconds() const { return bench::seconds_now() - start_; }

private:
  double start_ = bench::seconds_now();
};

void print(const std::string &name, double value, const std::string &unit)
{
  fmt::print("{{\"name\": \"{}\", \"value\": {:.4g}, \"unit\": \"{}\"}}\n", name, value, unit);
}

double peak_memory() // GB
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1048576;
}

/// The bottom is held, all else pulled upwards, from rest to 1e-9 of the load.
void solve(const algebra::BlockMatrix &matrix, const algebra::Preconditioner &preconditioner)
{
  Eigen::VectorXd right = Eigen::VectorXd::Zero(matrix.n_unknowns()), x;
  for (Eigen::Index k = 1; k < right.size(); k += matrix.block_size())
    right[k] = 1;
  const Stopwatch watch;
  const algebra::CgResult result =
      algebra::conjugate_gradients([&](const auto &p, auto &ap) { matrix.multiply(p, ap); },
                                   [&](const auto &r, auto &z) { preconditioner.apply(r, z); },
                                   right, x, 1e-9 * right.norm(), 1000);
  print("solve", watch.seconds(), "s");
  print("iterations", result.iterations, "-");
  print("residual", result.residual / right.norm(), "of the load");
}
} // namespace

int main(int argc, char **argv)
{
  const int side = argc > 1 ? std::atoi(argv[1]) : 384, dim = argc > 2 ? std::atoi(argv[2]) : 2;
  const std::string kind = argc > 3 ? argv[3] : "multigrid";
  const test::LatticeBody body(dim, true, std::vector<int>(dim, side));
  print("unknowns", body.n() * body.block_size(), "-");

  const Stopwatch all;
  algebra::BlockAssembly assembly(body.n(), body.block_size());
  for (const auto &term : body.terms())
    assembly.announce(term.members.data(), int(term.members.size()));
  assembly.close();
  print("pattern", 1e6 * all.seconds() / body.n(), "us per particle");
  for (const auto &term : body.terms())
    assembly.add(term.members.data(), int(term.members.size()), term.entries->data());
  print("pattern_and_values", 1e6 * all.seconds() / body.n(), "us per particle");
  const Eigen::MatrixXd ground = Eigen::MatrixXd::Identity(body.block_size(), body.block_size());
  for (int i = 0; i < body.n(); ++i)
    if (body.position()[i][1] < 0.1)
      assembly.add_block(i, i, ground.data());
  const algebra::BlockMatrix matrix = assembly.take();

  Eigen::VectorXd x = Eigen::VectorXd::Ones(matrix.n_unknowns()), y;
  matrix.multiply(x, y);
  const Stopwatch product;
  for (int k = 0; k < 10; ++k)
    matrix.multiply(x, y);
  const double seconds = product.seconds() / 10,
               block = 8.0 * body.block_size() * body.block_size() + 4;
  print("multiply", 1e3 * seconds, "ms");
  print("multiply_bandwidth", 1e-9 * double(matrix.n_blocks()) * block / seconds, "GB/s");
  print("memory_matrix", peak_memory(), "GB");
  if (kind == "none") {
    print("triad_bandwidth", 1e-9 * bench::measure_roofline().bytes, "GB/s");
    return 0;
  }

  const Stopwatch setup;
  const auto preconditioner =
      kind == "cholesky" ? algebra::make_cholesky(matrix, algebra::Ordering::nested_dissection)
      : kind == "amd"    ? algebra::make_cholesky(matrix, algebra::Ordering::minimum_degree)
                         : algebra::make_preconditioner(algebra::Preconditioning::multigrid, matrix,
                                                        body.modes(), dim);
  print("setup_" + kind, setup.seconds(), "s");
  print("memory", peak_memory(), "GB");
  Eigen::VectorXd z;
  const Stopwatch once;
  preconditioner->apply(x, z);
  print("apply", once.seconds(), "s");
  solve(matrix, *preconditioner);
}
