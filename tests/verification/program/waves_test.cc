#include "dem/many_body_force.h"
#include "src/verification/bloch.h"
#include "src/verification/waves.h"

#include <gtest/gtest.h>

namespace ligament::program
{
namespace
{
struct Hexagonal
{
  dem::DemMaterial material;
  particles::Particles<2> state;
  std::unique_ptr<dem::ManyBodyForce<2>> force;

  Hexagonal()
  {
    material.poissons_ratio = 0.3;
    auto packing = make_periodic_packing<2>(particles::LatticeKind::hexagonal, 4, 9, true);
    particles::fill_particles(packing, material.density, state);
    force = std::make_unique<dem::ManyBodyForce<2>>(std::move(packing), material,
                                                    std::vector<core::BoundaryLoad<2>>());
  }
};

// Long waves run at the speeds of the continuum and turn with half the curl: for u_x exp(ikz) that
// is -ik/2. Dispersion is of order (k d)^2 = 4e-6.
TEST(BlochWaves, LongWavesAreThoseOfTheContinuum)
{
  const Hexagonal body;
  const BlochWaves<2> waves(body.state, *body.force, 4, 1);
  const auto c = body.force->elastic_constants();
  const double k = 2e-3;
  const auto p = waves.mode(k, {0, 1}), s = waves.mode(k, {1, 0});
  EXPECT_NEAR(p.frequency / (k * c.wave_speed_p), 1, 1e-6);
  EXPECT_NEAR(s.frequency / (k * c.wave_speed_s), 1, 1e-6);
  EXPECT_NEAR(waves.group_velocity(k, {1, 0}), c.wave_speed_s, 1e-5);
  EXPECT_NEAR(std::abs(s.amplitude[2] - std::complex<double>(0, -k / 2)), 0, 1e-5 * k);
}

// A standing wave of a closed ring: the force on every particle is -m omega^2 u, the torque
// -J omega^2 phi, with omega and phi of the mode.
TEST(BlochWaves, ModeIsAnEigenvectorOfTheForce)
{
  Hexagonal body;
  const BlochWaves<2> waves(body.state, *body.force, 4, 1);
  const double k = 0.9;
  const auto mode = waves.mode(k, {1, 0});
  auto &state = body.state;
  for (int i = 0; i < state.n_owned; ++i) {
    const auto motion = (1e-9 * mode.amplitude * std::polar(1., k * state.reference[1][i])).eval();
    state.displacement[0][i] = motion[0].real();
    state.rotation[0][i] = motion[2].real();
  }
  body.force->compute(state, 0);
  const double w2 = mode.frequency * mode.frequency;
  const int middle = 4; // two layers from the ends feel nothing of them
  EXPECT_NEAR(state.force[0][middle], -state.mass[middle] * w2 * state.displacement[0][middle],
              1e-15);
  EXPECT_NEAR(state.torque[0][middle], -state.inertia[middle] * w2 * state.rotation[0][middle],
              1e-15);
}

// Sideways the strip has no end: the patch fit reaches round-off on both sides of the period.
TEST(PeriodicStrip, CarriesUniformStrain)
{
  StripParameters parameters;
  parameters.material.poissons_ratio = 0.3;
  parameters.zone_length = 10;
  parameters.far_length = 60;
  const auto strip = make_strip<2>(parameters);
  const auto &split = dynamic_cast<const coupling::FineScaleSplit<2> &>(*strip.coupler);
  EXPECT_LT(split.report().patch_residual, 1e-13);
}
} // namespace
} // namespace ligament::program
