// Dashpots of single masses against the closed form of their step.
#include "core/dashpots.h"
#include "core/extremes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ligament::core
{
namespace
{
// v(+) (1 + g) = v(-) (1 - g) + dt f/m with g = c dt/2m, whatever g; the energy is what the kinetic
// energy and the work of f say.
TEST(Dashpots, ActOnTheMeanVelocity)
{
  for (const double c : {0.3, 2., 500.}) {
    const double dt = 0.1, m = 0.5, f = 0.7, before = -1.3, g = c * dt / (2 * m);
    const std::vector<double> inverse_mass = {0., 1 / m};
    Components<2> force, velocity;
    for (auto *a : {&force, &velocity})
      for (auto &x : *a)
        x.assign(2, 0.);
    force[1][1] = f;
    velocity[1][1] = before + dt * f / m;
    Dashpots<2> dashpots(
        {{{1, 1}, {{Dashpot::Kind::node, c, 0}}}, {{0, 0}, {{Dashpot::Kind::node, c, 0}}}});
    dashpots.act(
        dt, [&](int i) { return inverse_mass[i]; }, force, velocity);
    const double after = velocity[1][1];
    EXPECT_NEAR(after, (before * (1 - g) + dt * f / m) / (1 + g), 1e-14);
    const double work = f * dt * (before + after) / 2;
    EXPECT_NEAR(dashpots.energy(), work + m / 2 * (before * before - after * after), 1e-14);
    EXPECT_EQ(velocity[0][1], 0);
    EXPECT_EQ(velocity[0][0], 0); // a held one stays
  }
}

/// Nodes or particles at distances of 1, speed of waves 1, density 1; the first one moves as
/// prescribed. The last one stands on the side, or half a spacing behind it.
class Chain
{
public:
  static constexpr int n = 200;
  static constexpr double dt = 0.25;

  Chain(Dashpot::Kind end, double time, double layer) : inverse_mass_(n, 1.)
  {
    for (auto *a : {&u_, &v_, &f_})
      for (auto &x : *a)
        x.assign(n, 0.);
    if (end == Dashpot::Kind::node)
      inverse_mass_.back() = 2;
    Dashpots<2>::Places places;
    places[{n - 1, 0}].push_back({end, 1, time});
    for (int i = n - int(layer); i < n; ++i)
      places[{i, 0}].push_back(layer_dashpot(1 / inverse_mass_[i], layer - (n - 1 - i), layer, 1.));
    dashpots_ = Dashpots<2>(places);
  }

  /// The first one has moved to u at the end of the step.
  void step(double u)
  {
    v_[0][0] = (u - u_[0][0]) / dt;
    for (int i = 0; i < n; ++i)
      u_[0][i] += dt * v_[0][i];
    std::fill(f_[0].begin(), f_[0].end(), 0.);
    for (int i = 0; i + 1 < n; ++i) {
      f_[0][i] += u_[0][i + 1] - u_[0][i];
      f_[0][i + 1] -= u_[0][i + 1] - u_[0][i];
    }
    load = -f_[0][0];
    for (int i = 0; i < n; ++i)
      v_[0][i] += dt * f_[0][i] * inverse_mass_[i];
    dashpots_.act(
        dt, [&](int i) { return inverse_mass_[i]; }, f_, v_);
  }

  double energy() const
  {
    double sum = 0;
    for (int i = 1; i < n; ++i)
      sum += v_[0][i] * v_[0][i] / inverse_mass_[i] + std::pow(u_[0][i] - u_[0][i - 1], 2);
    return sum / 2;
  }

  double load = 0;

private:
  std::vector<double> inverse_mass_;
  Components<2> u_, v_, f_;
  Dashpots<2> dashpots_;
};

/// Energy that is left of eight waves once they have been to the end.
double reflected(Chain chain, double wave_length)
{
  const double pulse = 8 * wave_length;
  double before = 0;
  for (double t = 0; t < Chain::n + 1.5 * pulse; t += Chain::dt) {
    const double envelope = t < pulse ? std::sin(M_PI * t / pulse) : 0;
    chain.step(envelope * envelope * std::sin(2 * M_PI * t / wave_length));
    if (t < 1.2 * pulse)
      before = chain.energy();
  }
  return chain.energy() / before;
}

/// Largest distance of the load from that of an endless chain, in the last of these ways there and
/// back; the first one moves steadily after a smooth start.
double error_of_load(Chain chain, int ways)
{
  constexpr double start = 40;
  double u = 0, error = 0;
  for (double t = 0; t < ways * 2 * Chain::n; t += Chain::dt) {
    u += Chain::dt * (t < start ? std::pow(std::sin(M_PI / 2 * t / start), 2) : 1);
    chain.step(u);
    if (t > (ways - 1) * 2 * Chain::n + start)
      keep_largest(error, std::abs(chain.load - 1));
  }
  return error;
}

// Bounds: a plain dashpot on nodes reflects tan^4(kh/4), 1.6e-3 at 8 spacings per wave, on
// particles (kh/4)^2, 9.6e-3 at 16; with a memory what is left is of third and of second order,
// (0.18 (kh/2)^3)^2 = 1.1e-4 and (kh/4)^4 = 9.3e-5 and a little for the width of the spectrum.
TEST(Dashpots, ReflectLittleOfWaves)
{
  using Kind = Dashpot::Kind;
  EXPECT_GT(reflected(Chain(Kind::node, 0, 0), 8), 1e-3);
  EXPECT_LT(reflected(Chain(Kind::node, 1, 0), 8), 3e-4);
  EXPECT_GT(reflected(Chain(Kind::face, 0, 0), 16), 8e-3);
  EXPECT_LT(reflected(Chain(Kind::face, 0.5, 0), 16), 3e-4);
  EXPECT_LT(reflected(Chain(Kind::node, 1, 16), 8), 5e-4);
  EXPECT_LT(reflected(Chain(Kind::face, 0.5, 32), 16), 5e-4);
}

// A factor of 0.966 in place of the memory leaves 3.4e-2, a layer without memory 1 and more.
TEST(Dashpots, PassASteadyLoad)
{
  using Kind = Dashpot::Kind;
  EXPECT_LT(error_of_load(Chain(Kind::node, 1, 0), 2), 1e-4);
  EXPECT_LT(error_of_load(Chain(Kind::face, 0.5, 0), 2), 1e-3);
  EXPECT_LT(error_of_load(Chain(Kind::node, 1, 16), 6), 1e-3);
  EXPECT_LT(error_of_load(Chain(Kind::face, 0.5, 16), 6), 1e-3);
}

// Whatever the force, no more comes out than went in.
TEST(Dashpots, NeverGiveEnergy)
{
  using Kind = Dashpot::Kind;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const auto kind : {Kind::node, Kind::face, Kind::layer})
    for (const double dt : {0.1, 1., 3.}) {
      Components<2> force, velocity;
      for (auto *a : {&force, &velocity})
        for (auto &x : *a)
          x.assign(1, 0.);
      Dashpots<2> dashpots({{{0, 1}, {{kind, 3., 2.}, {Kind::layer, 1., 0.5}}}});
      double work = 0, least = 0;
      for (int k = 0; k < 1000; ++k) {
        const double before = velocity[1][0];
        force[1][0] = uniform(random);
        velocity[1][0] += dt * force[1][0];
        dashpots.act(
            dt, [](int) { return 1.; }, force, velocity);
        work += force[1][0] * dt * (before + velocity[1][0]) / 2;
        EXPECT_NEAR(dashpots.energy(), work - velocity[1][0] * velocity[1][0] / 2, 1e-11);
        keep_smallest(least, dashpots.energy());
      }
      EXPECT_EQ(least, 0);
    }
}

TEST(Dashpots, LayerRisesFromItsInnerBorder)
{
  EXPECT_EQ(layer_rate(-1, 4, 3), 0);
  EXPECT_EQ(layer_rate(0, 4, 3), 0);
  EXPECT_DOUBLE_EQ(layer_rate(2, 4, 3), layer_rate(4, 4, 3) / 4);
  EXPECT_DOUBLE_EQ(layer_rate(4, 4, 3), layer_rate(8, 8, 6));
}
} // namespace
} // namespace ligament::core
