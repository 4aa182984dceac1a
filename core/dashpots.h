// Dashpots between a body and the ground: how a side of the specimen lets waves out.
#pragma once

#include "core/exact_sum.h"
#include "core/names.h"
#include "core/types.h"

#include <functional>
#include <map>

namespace ligament::core
{
/// A dashpot with a memory s of the velocity, s + tau ds/dt = v, for the waves of discrete bodies
/// (theory.md eqs. (A5) to (A7)).
struct Dashpot
{
  enum class Kind
  {
    node, // on the side: force -c (s + tau dv/dt)
    face, // of a particle, whose centre lies behind the side: force -c s
    layer // inside the side: force -c (v - s), nothing on a steady motion
  };

  Kind kind;
  double coefficient; // c in kg/s
  /// In s. Node: of a wave from one node to the next, tau follows from it and the step; else tau.
  double time;

  /// tau in s for steps of dt.
  double memory(double dt) const;
};

/// Dashpots on single components of the velocity of particles or nodes. They act on the mean of the
/// velocities before and after the kick, (v(-) + v(+))/2, which leaves the stable step of the
/// leap-frog as it is and books their energy exactly (theory.md eqs. (A2), (A3)).
template <int dim>
class Dashpots
{
public:
  /// By {index, component}.
  using Places = std::map<std::array<int, 2>, std::vector<Dashpot>>;

  Dashpots() = default;
  /// Of a part of a body those of what it steps; `owns` says of which of them it books the energy,
  /// without it of all.
  explicit Dashpots(const Places &places, const std::function<bool(int)> &owns = {});

  bool is_empty() const { return places_.empty(); }

  /// From velocities after the kick v += dt force / mass to those that the dashpots leave;
  /// inverse_mass(index) in 1/kg, 0 for what is held.
  template <typename InverseMass>
  void act(double dt, const InverseMass &inverse_mass, const Components<dim> &force,
           Components<dim> &velocity);

  /// Taken so far, what their memories keep included, in J: one exact sum over places and steps,
  /// which has no order. Those of parts are summed to that of the body.
  double energy() const { return energy_.value(); }
  const core::ExactSum &energy_sum() const { return energy_; }

  /// Memories and energy as tables <name> and <name>_energy; rows are called by the name of the
  /// particle or node, the component and the number of the dashpot there.
  void save(State &state, const std::string &name, const Names &names) const;
  void load(const State &state, const std::string &name, const Names &names);

private:
  struct Place
  {
    int index, component;
    std::size_t end; // of its dashpots, which begin where those before it end
    bool is_own;
  };

  void prepare(double dt);
  /// The name of every dashpot, with its number.
  std::map<std::array<std::int64_t, 3>, std::size_t> numbers(const Names &names) const;

  std::vector<Place> places_;
  std::vector<Dashpot> dashpots_;
  std::vector<double> memory_; // s in m/s, per dashpot

  // For steps of dt_: a dashpot's force is -(resistance v + past s + mass dv/dt) on the mean v, and
  // its memory becomes v + keep (s - v).
  struct Factors
  {
    double resistance, past, mass, keep;
  };
  std::vector<Factors> factors_;
  double dt_ = 0;
  ExactSum energy_;
};

template <int dim>
template <typename InverseMass>
void Dashpots<dim>::act(double dt, const InverseMass &inverse_mass, const Components<dim> &force,
                        Components<dim> &velocity)
{
  if (dt != dt_)
    prepare(dt);
  std::size_t begin = 0;
  for (const Place &place : places_) {
    double resistance = 0, past = 0, mass = 0;
    for (std::size_t k = begin; k < place.end; ++k) {
      resistance += factors_[k].resistance;
      past += factors_[k].past * memory_[k];
      mass += factors_[k].mass;
    }
    double &v = velocity[place.component][place.index];
    const double w = inverse_mass(place.index), kick = dt * force[place.component][place.index] * w;
    // Newton's law for the mean of v(-) = v - kick and v(+).
    const double before = v - kick;
    const double mean = (before * (1 + mass * w) + (kick - dt * past * w) / 2) /
                        (1 + mass * w + dt * resistance * w / 2);
    const double after = 2 * mean - before;
    if (w > 0) {
      if (place.is_own)
        energy_.add((v - after) / w * mean);
      v = after;
    }
    for (; begin < place.end; ++begin)
      memory_[begin] = mean + factors_[begin].keep * (memory_[begin] - mean);
  }
}

/// Damping rate of an absorbing layer in 1/s, `depth` m inside its inner border: rises with the
/// square of the depth (theory.md eq. (A4)). Waves of `speed` m/s are those along its normal.
double layer_rate(double depth, double width, double speed);

/// What a particle or node in such a layer gets, mass in kg.
Dashpot layer_dashpot(double mass, double depth, double width, double speed);
} // namespace ligament::core
