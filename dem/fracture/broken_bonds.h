// The bonds that broke, and what that took from the energy of the body.
#pragma once

#include "core/exact_sum.h"
#include "dem/parts/evaluation.h"
#include "particles/force_report.h"

#include <optional>

namespace ligament::dem
{
using particles::BrokenBond;

template <int dim>
class BrokenBonds
{
public:
  using Particles = particles::Particles<dim>;

  /// All so far that are at hand, in the order of breaking.
  const std::vector<BrokenBond<dim>> &all() const { return all_; }
  /// Which one of the whole body's all()[k] is; from 0 on.
  std::int64_t number(std::size_t k) const
  {
    return numbers_.empty() ? std::int64_t(k) : numbers_[k];
  }
  /// Of a body in parts, after the last ones at hand broke: these are the `places`-th (ascending)
  /// of those that did in the body, of which there were so many before; at this time (s).
  void count(double time, std::int64_t before, const std::vector<std::int64_t> &places);
  /// Those at hand are called by these numbers.
  void set_numbers(std::vector<std::int64_t> numbers) { numbers_ = std::move(numbers); }

  /// The step of dt (s) after the last break ends.
  void end_step(const Particles &particles, double dt);

  /// No step followed the last break.
  void forget_step() { jumps_.clear(); }

  /// Whether some did at this time (s): then no other does.
  bool have_broken_at(double time) const { return broken_at_ == time; }

  /// `energy` in J, released; and what had opened the face before, which is booked elsewhere.
  /// Booked where the first particle is one's own.
  void add(const Bond<dim> &bond, const Particles &particles, double time, double energy,
           double of_opening = 0);

  /// One that was bonded again, which is not among all().
  void add_again(double time, double energy);

  /// Forces and torques of one's own of the particles `near` (ascending), which are those after the
  /// break, become the mean with those before it. Over the step before, the force before would have
  /// made the work exact, over the next one that after: theory.md eq. (E10).
  void take_mean(Particles &particles, const std::vector<int> &near,
                 const std::vector<Wrench<dim>> &before, double dt);

  /// Released, in J.
  const core::ExactSum &energy() const { return energy_; }
  /// Energy in J by which the leap-frog's invariant (kinetic energy 1/2 v(-) m v(+)) fell because
  /// forces jumped.
  const core::ExactSum &step_error() const { return step_error_; }

  void save(core::State &state, const core::Names &names) const;
  /// all() is there already.
  void load(const core::State &state, const core::Names &names);

private:
  struct Jump
  {
    int i;
    Vector<dim> force = Vector<dim>::Zero(); // N, after less before
    Spin<dim> torque = Spin<dim>::Zero();    // N m
  };
  /// Adds `sign` times a quarter of the work in J that the jumps of the last break do over a step.
  void book_jumps(const Particles &particles, double dt, int sign);
  void save_jumps(core::State &state, const core::Names &names) const;
  void load_jumps(const core::State &state, const core::Names &names);

  std::vector<BrokenBond<dim>> all_;
  std::vector<std::int64_t> numbers_; // empty: 0, 1, ...
  std::vector<Jump> jumps_;           // where bonds broke in the last step
  std::optional<double> broken_at_;   // s
  core::ExactSum energy_, step_error_;
};
} // namespace ligament::dem
