#include "src/verification/instruments/wave_modes.h"

#include "core/check.h"
#include "fem/mesh.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>

namespace ligament::program
{
namespace
{
using Complex = std::complex<double>;

/// A wave number repeats itself after 2 pi over the distance of the layers; of all equal ones that
/// nearest to zero.
double folded(double k, double layer_distance)
{
  const double zone = 2 * M_PI / layer_distance;
  return k - zone * std::round(k / zone);
}
} // namespace

WaveModes make_wave_modes(const Eigen::MatrixXcd &stiffness, const Eigen::VectorXd &mass)
{
  const Eigen::VectorXd root = mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXcd dynamic = root.asDiagonal() * stiffness * root.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(dynamic);
  return {solver.eigenvalues().cwiseMax(0.).cwiseSqrt(),
          Eigen::MatrixXcd(root.asDiagonal() * solver.eigenvectors()), mass};
}

template <int dim>
SelectedMode select_mode(const WaveModes &modes, const Vector<dim> &polarisation)
{
  const int n = int(modes.frequency.size());
  // Of mass-normalised shapes: what of the mode's motion is along the polarisation.
  const Eigen::VectorXcd share = std::sqrt(modes.mass[0]) * (modes.shape.topRows(dim).transpose() *
                                                             polarisation.template cast<Complex>());
  // Spin waves may move along, too, but are faster: the first that moves well is the right one.
  int first = 0;
  const double well = std::min(0.5, 0.9 * share.cwiseAbs().maxCoeff());
  while (std::abs(share[first]) < well)
    ++first;
  const double tolerance = 1e-7 * modes.frequency[n - 1];
  SelectedMode mode{modes.frequency[first], Eigen::VectorXcd::Zero(n)};
  for (int i = 0; i < n; ++i)
    if (std::abs(modes.frequency[i] - mode.frequency) < tolerance)
      mode.amplitude += modes.shape.col(i) * std::conj(share[i]);
  const Complex along = polarisation.template cast<Complex>().dot(mode.amplitude.head<dim>());
  mode.amplitude /= along;
  return mode;
}

template <int dim>
WaveModes mesh_modes(const Vector<dim> &wave_vector, const Stiffness<dim> &stiffness,
                     double density, double size)
{
  const Vector<dim> edges = Vector<dim>::Constant(size);
  const auto k = fem::cell_stiffness<dim>(edges, stiffness, 1);
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(dim, dim);
  for (int a = 0; a < fem::n_cell_nodes<dim>; ++a)
    for (int b = 0; b < fem::n_cell_nodes<dim>; ++b)
      sum +=
          std::polar(1., wave_vector.dot(fem::corner<dim>(edges, b) - fem::corner<dim>(edges, a))) *
          k.template block<dim, dim>(a * dim, b * dim).template cast<Complex>();
  return make_wave_modes(sum, Eigen::VectorXd::Constant(dim, density * edges.prod()));
}

template <int dim>
Vector<dim> polarisation(WaveKind kind, const Vector<dim> &wave_vector)
{
  const Vector<dim> along = wave_vector.normalized();
  if (kind == WaveKind::p)
    return along;
  if (kind == WaveKind::s_across)
    return Vector<dim>::Unit(1);
  Vector<dim> across = Vector<dim>::Zero();
  across[0] = along[dim - 1];
  across[dim - 1] = -along[0];
  return across;
}

template <int dim>
Packet<dim>::Packet(const Dispersion<dim> &dispersion, const Vector<dim> &wave_vector,
                    WaveKind kind, double width, double centre, double dt)
    : centre_(centre)
{
  // A sum over wave numbers repeats itself after 2 pi over their distance.
  constexpr int half = 80;
  const double spread = 1 / width, step = 6 * spread / half;
  for (int i = -half; i <= half; ++i) {
    Vector<dim> k = wave_vector;
    k[dim - 1] += i * step;
    if (k[dim - 1] * wave_vector[dim - 1] <= 0)
      continue;
    const auto mode = select_mode<dim>(dispersion(k), polarisation<dim>(kind, k));
    // Discrete time: sin(omega dt/2) = frequency dt/2; velocities belong to -dt/2.
    const double omega = 2 / dt * std::asin(mode.frequency * dt / 2);
    const double weight =
        std::exp(-0.5 * std::pow(i * step / spread, 2)) * step * width / std::sqrt(2 * M_PI);
    const Complex rate = (1. - std::polar(1., omega * dt)) / dt;
    waves_.push_back({k, weight * mode.amplitude, weight * rate * mode.amplitude});
  }
  core::require(!waves_.empty(), "a packet without waves");
}

template <int dim>
typename Packet<dim>::Motion Packet<dim>::at(const Vector<dim> &x) const
{
  const int n = int(waves_[0].displacement.size());
  Motion sum{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (const Wave &wave : waves_) {
    const Complex phase = std::polar(1., wave.vector.dot(x) - wave.vector[dim - 1] * centre_);
    sum.displacement += (phase * wave.displacement).real();
    sum.velocity += (phase * wave.velocity).real();
  }
  return sum;
}

template <int dim>
WaveEnergy measure_energy(const Dispersion<dim> &dispersion, const std::vector<Site<dim>> &sites,
                          double layer_distance, const std::vector<Vector<dim>> &lateral, double dt)
{
  core::require(!sites.empty(), "no sites to measure waves at");
  const int dofs = int(sites[0].displacement.size());
  std::map<long, std::vector<const Site<dim> *>> layers;
  for (const auto &site : sites)
    layers[std::lround(site.place[dim - 1] / layer_distance * 1024)].push_back(&site);
  const int n = int(layers.size()), across = int(layers.begin()->second.size());

  WaveEnergy energy;
  for (const Vector<dim> &side : lateral) {
    Eigen::MatrixXcd u = Eigen::MatrixXcd::Zero(dofs, n), v = u;
    Eigen::VectorXd z(n);
    int l = 0;
    for (const auto &[place, layer] : layers) {
      z[l] = layer[0]->place[dim - 1];
      for (const auto *site : layer) {
        double angle = 0;
        for (int c = 0; c < dim - 1; ++c)
          angle += side[c] * site->place[c];
        const Complex phase = std::polar(1. / across, -angle);
        u.col(l) += phase * site->displacement.template cast<Complex>();
        v.col(l) += phase * site->velocity.template cast<Complex>();
      }
      ++l;
    }
    const bool has_opposite = lateral[0].norm() > 0;
    for (int j = 0; j < n; ++j) {
      Vector<dim> k = side;
      k[dim - 1] = folded(2 * M_PI * j / (n * layer_distance), layer_distance);
      const Eigen::VectorXcd phase =
          (Complex(0, -k[dim - 1]) * z.template cast<Complex>()).array().exp();
      const WaveModes modes = dispersion(k);
      const Eigen::MatrixXcd project = modes.shape.adjoint() * modes.mass.asDiagonal();
      const Eigen::VectorXcd a = project * (u * phase), b = project * (v * phase);
      for (int m = 0; m < dofs; ++m) {
        const double step = std::pow(modes.frequency[m] * dt / 2, 2);
        const double e = (1 - step) * (has_opposite ? 2 : 1) * 0.5 * across / n *
                         (std::norm(b[m]) + std::pow(modes.frequency[m], 2) * std::norm(a[m]));
        const Eigen::VectorXcd moved = std::sqrt(modes.mass[0]) * modes.shape.col(m).head(dim);
        const double along =
            k.norm() > 0 ? std::norm(k.normalized().template cast<Complex>().dot(moved)) : 0;
        if (moved.squaredNorm() < 0.5)
          energy.rest += e;
        else if (along > moved.squaredNorm() / 2)
          energy.p += e;
        else
          energy.s += e;
      }
    }
  }
  return energy;
}

template SelectedMode select_mode<2>(const WaveModes &, const Vector<2> &);
template SelectedMode select_mode<3>(const WaveModes &, const Vector<3> &);
template WaveModes mesh_modes<2>(const Vector<2> &, const Stiffness<2> &, double, double);
template WaveModes mesh_modes<3>(const Vector<3> &, const Stiffness<3> &, double, double);
template Vector<2> polarisation<2>(WaveKind, const Vector<2> &);
template Vector<3> polarisation<3>(WaveKind, const Vector<3> &);
template class Packet<2>;
template class Packet<3>;
template WaveEnergy measure_energy<2>(const Dispersion<2> &, const std::vector<Site<2>> &, double,
                                      const std::vector<Vector<2>> &, double);
template WaveEnergy measure_energy<3>(const Dispersion<3> &, const std::vector<Site<3>> &, double,
                                      const std::vector<Vector<3>> &, double);
} // namespace ligament::program
