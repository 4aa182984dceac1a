// The energy release rate of a crack by the domain form of the J-integral (theory.md section 7).
#pragma once

#include "src/simulation/gauges/gauge.h"
#include "src/simulation/gauges/motion_reading.h"

namespace ligament::program
{
/// J = int (sigma grad q).(H e) - W (grad q . e), with H the gradient of the displacement, e the
/// direction in which the crack grows and q a function that falls from 1 inside the inner rectangle
/// to 0 at the outer one. Particles take part by the strain of a fit to those that bonds join to
/// them, cells by their strain at Gauss points; in the overlap each by its share. Linear: for small
/// rotations and strains, one material, open or frictionless faces along e, and without the terms
/// of inertia.
template <int dim>
class JIntegral : public Gauge<dim>
{
public:
  JIntegral(const GaugeParameters &gauge, const GaugePlaces<dim> &places);

  /// J in J/m^2 and sign(J) sqrt(E' |J|), the mean along the front in 3D.
  std::vector<Column> columns() const override;
  void read(GaugeLook<dim> &look, double *values) override;
  std::string description() const override;

private:
  struct Sample
  {
    int particle;    // -1: of the mesh
    double volume;   // m^3, its share
    Vector<dim> dq;  // 1/m
    double mass;     // q times that of its share, kg; 0 without forces on masses
    int first, size; // of its terms
  };
  struct Term
  {
    int item; // particle or node
    Vector<dim> gradient;
  };

  /// Gradient of q.
  Vector<dim> slope(const Vector<dim> &x) const;
  double q(const Vector<dim> &x) const;
  /// Whether a place has a part in J.
  bool counts(const Vector<dim> &x) const;
  void add_sample(const Vector<dim> &x, double volume, double density,
                  const MotionReading<dim> &reading, int particle);
  void add_cells(const CoupledBody<dim> &body, double density);
  MotionReading<dim> around(const CoupledBody<dim> &body, int particle) const;
  /// Fits anew where bonds have broken.
  void follow(const CoupledBody<dim> &body);

  std::string name_;
  int along_, across_;
  double sign_;
  Vector<dim> lower_, upper_, inner_lower_, inner_upper_; // m
  Stiffness<dim> stiffness_;                              // Pa
  double modulus_;                                        // E', Pa
  double depth_;                                          // m, along the front
  particles::BodyForce<dim> body_force_;
  std::vector<Sample> samples_; // those of one's own particles first, ascending; then cells, which
                                // all ranks have
  std::vector<Term> terms_;
  std::size_t n_broken_ = 0, n_particles_ = 0; // at hand
  std::int64_t n_of_body_ = 0;                 // particles
};

/// When the first face broke between the rectangles of such a gauge, s; infinite: none did.
template <int dim>
double broken_between(const GaugeParameters &g,
                      const std::vector<particles::BrokenBond<dim>> &bonds);
} // namespace ligament::program
