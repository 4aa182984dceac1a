// Multigrid by several ranks solves what one process solves, in about as many iterations.
#include "algebra/conjugate_gradients.h"
#include "algebra/parallel_multigrid.h"
#include "tests/support/lattice_body.h"
#include "tests/support/ranks.h"

#include <gtest/gtest.h>

namespace
{
using namespace ligament;
using algebra::Preconditioning;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::ranks;

/// The first rank acts while the others serve it.
template <typename Act>
void while_others_serve(Act &&act)
{
  if (!ranks().is_first()) {
    algebra::serve_multigrid(ranks());
    return;
  }
  act();
  algebra::dismiss_servers(ranks());
}

/// Held on one side; so many particles in the middle of the list that nothing is tied to.
struct System
{
  System(const test::LatticeBody &body, int n_loose)
  {
    algebra::BlockAssembly assembly(body.n() + n_loose, body.block_size());
    const auto row = [&](int i) { return i < body.n() / 2 ? i : i + n_loose; };
    const auto rows = [&](std::vector<int> members) {
      for (int &i : members)
        i = row(i);
      return members;
    };
    for (const auto &term : body.terms())
      assembly.announce(rows(term.members).data(), int(term.members.size()));
    assembly.close();
    for (const auto &term : body.terms())
      assembly.add(rows(term.members).data(), int(term.members.size()), term.entries->data());
    const MatrixXd ground = MatrixXd::Identity(body.block_size(), body.block_size());
    for (int i = 0; i < body.n(); ++i)
      if (body.position()[i][1] < 0.1)
        assembly.add_block(row(i), row(i), ground.data());
    matrix = assembly.take();
    const int b = body.block_size();
    const MatrixXd of_body = body.modes();
    modes.setZero(matrix.n_unknowns(), of_body.cols());
    for (int i = 0; i < body.n(); ++i)
      modes.middleRows(row(i) * b, b) = of_body.middleRows(i * b, b);
    loose = {body.n() / 2 * b, n_loose * b};
  }

  Eigen::VectorBlock<VectorXd> of_loose(VectorXd &x) const
  {
    return x.segment(loose.first, loose.second);
  }

  VectorXd right() const
  {
    VectorXd f = VectorXd::Random(matrix.n_unknowns());
    of_loose(f).setZero();
    return f;
  }

  algebra::CgResult solve(const algebra::Preconditioner &near, const VectorXd &f, VectorXd &x) const
  {
    x.resize(0);
    return algebra::conjugate_gradients(
        [&](const VectorXd &p, VectorXd &ap) { matrix.multiply(p, ap); },
        [&](const VectorXd &r, VectorXd &z) { near.apply(r, z); }, f, x, 1e-11 * f.norm(), 300);
  }

  algebra::BlockMatrix matrix;
  MatrixXd modes;
  std::pair<int, int> loose; // first of these unknowns, and how many
};

void expect_the_same_solution(const test::LatticeBody &body, int dim)
{
  while_others_serve([&] {
    for (const int n_loose : {0, 7}) { // levels are made anew
      const System system(body, n_loose);
      const auto one = algebra::make_preconditioner(Preconditioning::multigrid, system.matrix,
                                                    system.modes, dim);
      const auto all = algebra::make_preconditioner(Preconditioning::parallel_multigrid,
                                                    system.matrix, system.modes, dim, ranks());
      EXPECT_STREQ(all->name(), ranks().is_one() ? "multigrid" : "parallel multigrid");
      for (int load = 0; load < 2; ++load) {
        const VectorXd f = system.right();
        VectorXd x, y;
        const auto by_one = system.solve(*one, f, x), by_all = system.solve(*all, f, y);
        EXPECT_EQ(by_one.end, algebra::CgResult::End::converged);
        EXPECT_EQ(by_all.end, algebra::CgResult::End::converged);
        EXPECT_LE(by_all.iterations, 1.3 * by_one.iterations);
        EXPECT_LT((y - x).norm(), 1e-8 * x.norm());
      }
      VectorXd r = VectorXd::Random(system.matrix.n_unknowns()), z;
      all->apply(r, z);
      EXPECT_EQ(system.of_loose(z), system.of_loose(r));
      VectorXd before = z;
      all->apply(r, z);
      EXPECT_EQ(z, before);
      // What the loose ones are given, the others don't see.
      system.of_loose(r).setZero();
      system.of_loose(before).setZero();
      all->apply(r, z);
      EXPECT_EQ(z, before);
    }
  });
}

TEST(ParallelMultigrid, OfAPlate)
{
  expect_the_same_solution(test::LatticeBody(2, true, {60, 80}), 2);
}

TEST(ParallelMultigrid, OfABlock)
{
  expect_the_same_solution(test::LatticeBody(3, true, {8, 12, 12}), 3);
}

/// Entries of n members in blocks with one unknown more, which has none.
MatrixXd widened(const MatrixXd &entries, int n, int block)
{
  const int wide = block + 1;
  MatrixXd result = MatrixXd::Zero(n * wide, n * wide);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      result.block(i * wide, j * wide, block, block) =
          entries.block(i * block, j * block, block, block);
  return result;
}

// Coarse functions reach into them, as rigid motions do into the spins that nodes lack.
TEST(ParallelMultigrid, UnknownsWithoutEntriesWithinBlocksArePassedBy)
{
  while_others_serve([] {
    const test::LatticeBody body(2, false, {60, 80});
    const int block = body.block_size(), wide = block + 1;
    algebra::BlockAssembly assembly(body.n(), wide);
    for (const auto &term : body.terms())
      assembly.announce(term.members.data(), int(term.members.size()));
    assembly.close();
    for (const auto &term : body.terms()) {
      const int n = int(term.members.size());
      const MatrixXd entries = widened(*term.entries, n, block);
      assembly.add(term.members.data(), n, entries.data());
    }
    const algebra::BlockMatrix matrix = assembly.take();
    const MatrixXd of_body = body.modes();
    MatrixXd modes = MatrixXd::Ones(body.n() * wide, of_body.cols());
    for (int i = 0; i < body.n(); ++i)
      modes.middleRows(i * wide, block) = of_body.middleRows(i * block, block);
    const auto near = algebra::make_preconditioner(Preconditioning::parallel_multigrid, matrix,
                                                   modes, 2, ranks());
    VectorXd r = VectorXd::Random(matrix.n_unknowns()), z, other;
    near->apply(r, z);
    for (int i = 0; i < body.n(); ++i) {
      EXPECT_EQ(z[i * wide + block], r[i * wide + block]);
      r[i * wide + block] = 0;
    }
    near->apply(r, other);
    for (int i = 0; i < body.n(); ++i)
      EXPECT_EQ(z.segment(i * wide, block), other.segment(i * wide, block)) << i;
  });
}

TEST(ParallelMultigrid, SmallOnesAreLeftToTheFirstRank)
{
  while_others_serve([] {
    const System system(test::LatticeBody(2, true, {20, 20}), 0);
    const auto near = algebra::make_preconditioner(Preconditioning::parallel_multigrid,
                                                   system.matrix, system.modes, 2, ranks());
    EXPECT_STREQ(near->name(), "multigrid");
    const VectorXd f = system.right();
    VectorXd x;
    EXPECT_EQ(system.solve(*near, f, x).end, algebra::CgResult::End::converged);
  });
}
} // namespace
