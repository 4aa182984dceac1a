#include "dem/parts/flow_trial.h"

#include "dem/inelastic/response.h"

namespace ligament::dem
{
template <int dim>
FlowTrial<dim>::FlowTrial(const BondedBody<dim> &body, const InelasticStrains<dim> &strains,
                          const InelasticSweep<dim> &sweep, const Particles &p,
                          const std::vector<int> &particles)
    : body_(body), strains_(strains), sweep_(sweep), particle_(particles)
{
  for (const int i : particle_) {
    Matrix x = InelasticStrains<dim>::cell_strain(sweep, i);
    body.bonds().for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
      if (!b.joins_materials)
        x += InelasticStrains<dim>::face_strain(b, i, p);
    });
    strain_.push_back(x);
  }
  inelastic_.resize(particle_.size());
  pressure_.resize(particle_.size());
  is_known_.resize(particle_.size(), 0);
}

template <int dim>
double FlowTrial<dim>::answer(int place)
{
  if (!is_known_[place]) {
    const int i = particle_[place];
    std::tie(inelastic_[place], pressure_[place]) =
        strains_.try_response(sweep_, i, strain_[place], body_.lambda_per_volume()[i]);
    is_known_[place] = 1;
  }
  return pressure_[place];
}

// The deviator of (w (x) A) s/V, times A.
template <int dim>
auto FlowTrial<dim>::damping(int place, double shear, double share, const Vector<dim> &a) const
    -> Matrix
{
  const int i = particle_[place];
  const double rate = strains_.dashpot_rate(i);
  if (rate == 0)
    return Matrix::Zero();
  const double by = rate * shear * share / strains_.volume(i);
  return by * (0.5 * a.squaredNorm() * Matrix::Identity() + (0.5 - 1 / 3.) * a * a.transpose());
}

// By the kernels' own text, of one lane; what it writes is put back.
template <int dim>
auto InelasticStrains<dim>::try_response(const InelasticSweep<dim> &sweep, int i, const Matrix &x,
                                         double lambda_per_volume) const
    -> std::pair<Matrix, double>
{
  using D = HWY_NAMESPACE::hn::CappedTag<double, 1>;
  using Place = HWY_NAMESPACE::InARow<dim, D>;
  const D d;
  std::vector<double> before(n_streams());
  for (int k = 0; k < n_streams(); ++k)
    before[k] = streams_.stream(k)[i];
  const std::uint8_t begun = begun_[i / inelastic_block];
  const Matrix in_cell = open_[i] < 0 ? Matrix(Matrix::Zero()) : cell_strain(sweep, i);
  HWY_NAMESPACE::hn::Vec<D> of_bonds[dim][dim];
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      of_bonds[a][b] = HWY_NAMESPACE::hn::Set(d, x(a, b) - in_cell(a, b));
  const Place place{i};
  const auto response =
      HWY_NAMESPACE::respond<dim>(d, sweep, place, HWY_NAMESPACE::hn::FirstN(d, 1), of_bonds,
                                  HWY_NAMESPACE::hn::Set(d, (x - in_cell).trace()),
                                  HWY_NAMESPACE::hn::Set(d, lambda_per_volume));
  Matrix e;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      e(a, b) = HWY_NAMESPACE::hn::GetLane(response.strain(a, b));
  for (int k = 0; k < n_streams(); ++k)
    streams_.stream(k)[i] = before[k];
  begun_[i / inelastic_block] = begun;
  return {e, HWY_NAMESPACE::hn::GetLane(response.pressure)};
}

template <int dim>
bool InelasticStrains<dim>::is_near(int i) const
{
  namespace hn = HWY_NAMESPACE::hn;
  using D = hn::CappedTag<double, 1>;
  const D d;
  const Tensor kept = stress(i);
  HWY_NAMESPACE::SymmetricTensor<dim, hn::Vec<D>> t;
  for (int c = 0; c < n_tensor<dim>; ++c)
    t.c[c] = hn::Set(d, kept[c]);
  const FlowLaw &law = laws_[law_number(i)];
  switch (law.kind) {
  case FlowLaw::Kind::elastic:
    return false;
  case FlowLaw::Kind::von_mises:
    return hn::AllTrue(d, HWY_NAMESPACE::VonMisesReturn<dim, D>(d, law).is_near(t));
  case FlowLaw::Kind::drucker_prager:
    return hn::AllTrue(d, HWY_NAMESPACE::DruckerPragerReturn<dim, D>(d, law).is_near(t));
  }
  return false;
}

template class FlowTrial<2>;
template class FlowTrial<3>;
template bool InelasticStrains<2>::is_near(int) const;
template bool InelasticStrains<3>::is_near(int) const;
template std::pair<Eigen::Matrix2d, double>
InelasticStrains<2>::try_response(const InelasticSweep<2> &, int, const Eigen::Matrix2d &,
                                  double) const;
template std::pair<Eigen::Matrix3d, double>
InelasticStrains<3>::try_response(const InelasticSweep<3> &, int, const Eigen::Matrix3d &,
                                  double) const;
} // namespace ligament::dem
