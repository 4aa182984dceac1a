// Modes of one wave vector, packets made of them, and the energy that a body's motion holds in
// them.
#pragma once

#include "core/types.h"

#include <Eigen/Core>

#include <complex>
#include <functional>

namespace ligament::program
{
enum class WaveKind
{
  p,
  s,       // 2D: in the plane; 3D: in the plane of the wave vector and the last axis
  s_across // 3D: across that plane
};

/// q_i = Re shape exp(i (k x_i - omega t)) of a medium whose sites are all alike: particles
/// (displacement, then rotation) or nodes. Columns are modes of growing frequency, orthonormal in
/// the mass of one site: shape^H diag(mass) shape = 1.
struct WaveModes
{
  Eigen::VectorXd frequency; // rad/s, without time step
  Eigen::MatrixXcd shape;    // 1/sqrt(kg)
  Eigen::VectorXd mass;      // kg, kg m^2: of one site
};

template <int dim>
using Dispersion = std::function<WaveModes(const Vector<dim> &wave_vector)>;

/// Eigenmodes of a Hermitian stiffness for sites of this (diagonal) mass.
WaveModes make_wave_modes(const Eigen::MatrixXcd &stiffness, const Eigen::VectorXd &mass);

/// The mode that moves most along `polarisation`; of degenerate ones the combination that does.
struct SelectedMode
{
  double frequency;
  Eigen::VectorXcd amplitude; // moves by 1 along the polarisation
};
template <int dim>
SelectedMode select_mode(const WaveModes &modes, const Vector<dim> &polarisation);

/// Modes of the mesh of cubes of edge `size` with lumped mass.
template <int dim>
WaveModes mesh_modes(const Vector<dim> &wave_vector, const Stiffness<dim> &stiffness,
                     double density, double size);

/// Direction of the displacement of a wave of this kind; the plane of incidence holds the first and
/// the last axis.
template <int dim>
Vector<dim> polarisation(WaveKind kind, const Vector<dim> &wave_vector);

/// Wave packet exp(-(z - centre)^2/(2 width^2)) along the last axis with one wave number across it:
/// all its waves travel to the same side. For displacements at time 0 and velocities at -dt/2 of
/// the leap-frog. `wave_vector` is that of its middle.
template <int dim>
class Packet
{
public:
  Packet(const Dispersion<dim> &dispersion, const Vector<dim> &wave_vector, WaveKind kind,
         double width, double centre, double dt);

  struct Motion
  {
    Eigen::VectorXd displacement, velocity; // of amplitude 1
  };
  Motion at(const Vector<dim> &x) const;

private:
  struct Wave
  {
    Vector<dim> vector;
    Eigen::VectorXcd displacement, velocity;
  };
  double centre_;
  std::vector<Wave> waves_;
};

/// A site's place and motion.
template <int dim>
struct Site
{
  Vector<dim> place;
  Eigen::VectorXd displacement, velocity;
};

/// J.
struct WaveEnergy
{
  double p = 0, s = 0;
  double rest = 0; // neither along nor across the wave vector: spin waves

  double sum() const { return p + s + rest; }
};

/// Energy of sites in layers of equal distance along the last axis, each with the same number of
/// sites, by the kind of the wave. Across, the motion has the wave numbers of `lateral` (the last
/// component is not used) and, when that is not zero, their opposites. It is that of the leap-frog
/// of step dt (theory.md eq. (E1)), 1 - (omega dt/2)^2 of that without time step.
template <int dim>
WaveEnergy measure_energy(const Dispersion<dim> &dispersion, const std::vector<Site<dim>> &sites,
                          double layer_distance, const std::vector<Vector<dim>> &lateral,
                          double dt);
} // namespace ligament::program
