#include "md/atom_tangent.h"

#include "core/check.h"
#include "core/counter_random.h"
#include "md/crystal.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace ligament::md
{
namespace
{
template <int dim>
particles::Particles<dim> at_rest(particles::Particles<dim> atoms)
{
  for (auto &component : atoms.displacement)
    std::fill(component.begin(), component.end(), 0.);
  return atoms;
}

bool is_asked(int i, const std::vector<int> *of)
{
  return !of || std::binary_search(of->begin(), of->end(), i);
}

/// dim - 1 unit vectors across n.
template <int dim>
Eigen::Matrix<double, dim, dim - 1> across(const Vector<dim> &n)
{
  Eigen::Matrix<double, dim, dim - 1> t;
  if constexpr (dim == 2)
    t << -n[1], n[0];
  else {
    int least = 0;
    n.cwiseAbs().minCoeff(&least);
    t.col(0) = n.cross(Vector<3>::Unit(least)).normalized();
    t.col(1) = n.cross(Vector<3>(t.col(0)));
  }
  return t;
}
} // namespace

template <int dim>
ReferenceBonds<dim>::ReferenceBonds(const AtomBody<dim> &body,
                                    const particles::Particles<dim> &atoms)
    : period_(body.period), at_rest_(at_rest(atoms)), list_(body.potential.cutoff(), 0, body.period)
{
  list_.build<dim>(at_rest_.reference, at_rest_.displacement);
  body.screen.apply(list_);
}

template <int dim>
AtomTangent<dim>::AtomTangent(const AtomBody<dim> &body, const particles::Particles<dim> &atoms)
    : body_(body), bonds_(body, atoms), density_(atoms.size(), 0.)
{
  bonds_.for_each([&](const Bond<dim> &b) {
    const BondJets jets = body.potential.bond(body.species[b.i], body.species[b.j], b.length);
    density_[b.i] += jets.density_at_i.value;
    density_[b.j] += jets.density_at_j.value;
  });
  for (int i = 0; i < atoms.size(); ++i) {
    const Jet embedding = body.potential.embedding(body.species[i], density_[i]);
    slope_.push_back(embedding.slope);
    curvature_.push_back(embedding.curvature);
  }
}

template <int dim>
typename AtomTangent<dim>::Stiffness AtomTangent<dim>::stiffness(const Bond<dim> &b) const
{
  const BondJets jets = body_.potential.bond(body_.species[b.i], body_.species[b.j], b.length);
  const double w = body_.weight_of(b.i, b.j), at_i = body_.weight_of(b.i) * slope_[b.i],
               at_j = body_.weight_of(b.j) * slope_[b.j];
  return {w * jets.pair.curvature + at_i * jets.density_at_i.curvature +
              at_j * jets.density_at_j.curvature,
          (w * jets.pair.slope + at_i * jets.density_at_i.slope + at_j * jets.density_at_j.slope) /
              b.length,
          jets.density_at_i.slope, jets.density_at_j.slope};
}

template <int dim>
double AtomTangent<dim>::embedding_stiffness(int i) const
{
  return body_.weight_of(i) * curvature_[i];
}

template <int dim>
template <typename Visit>
void AtomTangent<dim>::for_each_pair(Visit &&visit) const
{
  if (kept_.empty()) {
    bonds_.for_each([&](const Bond<dim> &bond) { visit(bond, stiffness(bond)); });
    return;
  }
  Bond<dim> bond;
  bond.moved.setZero();
  for (const KeptPair &k : kept_) {
    bond.i = k.i;
    bond.j = k.j;
    bond.reference = bond.present = k.reference;
    bond.length = k.length;
    visit(bond, k.stiffness);
  }
}

template <int dim>
void AtomTangent<dim>::keep_stiffness()
{
  constexpr long most = 14'000'000; // 72 bytes each: half a million atoms
  if (bonds_.n_pairs() > most)
    return;
  std::vector<KeptPair> kept;
  kept.reserve(bonds_.n_pairs());
  for_each_pair([&](const Bond<dim> &b, const Stiffness &k) {
    kept.push_back({b.i, b.j, b.reference, b.length, k});
  });
  kept_ = std::move(kept);
}

template <int dim>
void AtomTangent<dim>::add_terms(
    const std::function<void(const particles::QuadraticTerm<dim> &)> &add,
    const std::vector<int> *of) const
{
  using Term = particles::QuadraticTerm<dim>;
  struct Arm
  {
    int atom;
    Vector<dim> slope; // f' n
  };
  std::vector<std::vector<Arm>> arms(body_.potential.has_embedding() ? density_.size() : 0);
  for_each_pair([&](const Bond<dim> &b, const Stiffness &k) {
    const Vector<dim> n = b.reference / b.length;
    if (!arms.empty()) {
      arms[b.i].push_back({b.j, k.slope_i * n});
      arms[b.j].push_back({b.i, -k.slope_j * n});
    }
    if (!is_asked(b.i, of) && !is_asked(b.j, of))
      return;
    Term term{Term::Kind::bond,
              bonds_.place(b.i) + b.reference / 2,
              {b.i, b.j},
              Eigen::MatrixXd(dim, 2 * dim),
              Eigen::VectorXd::Constant(dim, k.across)};
    term.stiffness[0] = k.along;
    Matrix<dim> rows;
    rows << n.transpose(), across<dim>(n).transpose();
    term.rows.template leftCols<dim>() = -rows;
    term.rows.template rightCols<dim>() = rows;
    add(term);
  });
  for (int i = 0; i < int(arms.size()); ++i) {
    const auto enters = [&](const Arm &arm) { return is_asked(arm.atom, of); };
    if (arms[i].empty() ||
        (!is_asked(i, of) && std::none_of(arms[i].begin(), arms[i].end(), enters)))
      continue;
    Term term{Term::Kind::volumetric,
              bonds_.place(i),
              {i},
              Eigen::MatrixXd::Zero(1, (1 + arms[i].size()) * dim),
              Eigen::VectorXd::Constant(1, embedding_stiffness(i))};
    for (const Arm &arm : arms[i]) {
      const int column = int(term.members.size()) * dim;
      term.members.push_back(arm.atom);
      term.rows.template block<1, dim>(0, column) += arm.slope.transpose();
      term.rows.template block<1, dim>(0, 0) -= arm.slope.transpose();
    }
    add(term);
  }
}

template <int dim>
void AtomTangent<dim>::apply(const Components<dim> &u, Components<dim> &force) const
{
  const int n = int(density_.size());
  for (auto &component : force)
    component.assign(n, 0.);
  std::vector<double> growth(n, 0.); // of the density
  for_each_pair([&](const Bond<dim> &b, const Stiffness &k) {
    const Vector<dim> normal = b.reference / b.length, du = get(u, b.j) - get(u, b.i);
    const double along = normal.dot(du);
    const Vector<dim> f = k.across * du + (k.along - k.across) * along * normal;
    add(force, b.i, f);
    add(force, b.j, Vector<dim>(-f));
    growth[b.i] += k.slope_i * along;
    growth[b.j] += k.slope_j * along;
  });
  if (!body_.potential.has_embedding())
    return;
  for (int i = 0; i < n; ++i)
    growth[i] *= embedding_stiffness(i);
  for_each_pair([&](const Bond<dim> &b, const Stiffness &k) {
    const Vector<dim> f =
        (growth[b.i] * k.slope_i + growth[b.j] * k.slope_j) * b.reference / b.length;
    add(force, b.i, f);
    add(force, b.j, Vector<dim>(-f));
  });
}

template <int dim>
double stable_step(AtomTangent<dim> tangent, const particles::Particles<dim> &atoms)
{
  tangent.keep_stiffness();
  const int n = atoms.size(), size = dim * n;
  Components<dim> motion, force;
  for (auto &component : motion)
    component.resize(n);
  std::vector<double> root(n); // M^(-1/2)
  for (int i = 0; i < n; ++i)
    root[i] = std::sqrt(atoms.inverse_mass(i));
  core::require(*std::max_element(root.begin(), root.end()) > 0, "no atom is free to move");
  const auto multiply = [&](const Eigen::VectorXd &v, Eigen::VectorXd &y) {
    for (int k = 0; k < size; ++k)
      motion[k / n][k % n] = root[k % n] * v[k];
    tangent.apply(motion, force);
    for (int k = 0; k < size; ++k)
      y[k] = -root[k % n] * force[k / n][k % n];
  };
  Eigen::VectorXd v(size), previous = Eigen::VectorXd::Zero(size), y(size);
  for (int k = 0; k < size; ++k)
    v[k] = core::random_number(1, k, 0) - 0.5;
  v.normalize();
  std::vector<double> diagonal, off_diagonal;
  double beta = 0;
  for (int s = 0; s < std::min(60, size); ++s) {
    multiply(v, y);
    diagonal.push_back(v.dot(y));
    y -= diagonal.back() * v + beta * previous;
    beta = y.norm();
    if (!(beta > 1e-12 * std::abs(diagonal.front())))
      break;
    off_diagonal.push_back(beta);
    previous = v;
    v = y / beta;
  }
  const int m = int(diagonal.size());
  off_diagonal.resize(m);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<Eigen::VectorXd>(diagonal.data(), m),
                                Eigen::Map<Eigen::VectorXd>(off_diagonal.data(), m - 1),
                                Eigen::EigenvaluesOnly);
  const double largest = solver.eigenvalues().maxCoeff();
  core::require(largest > 0, "no free atom feels another one: there is no stable step to find");
  return 2 / (1.01 * std::sqrt(largest));
}

#define INSTANTIATE(dim)                                                                           \
  template class ReferenceBonds<dim>;                                                              \
  template class AtomTangent<dim>;                                                                 \
  template double stable_step(AtomTangent<dim>, const particles::Particles<dim> &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace ligament::md
