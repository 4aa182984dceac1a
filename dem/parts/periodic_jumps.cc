#include "dem/parts/periodic_jumps.h"

#include <algorithm>

namespace ligament::dem
{
template <int dim>
PeriodicJumps<dim>::PeriodicJumps(const BondedBody<dim> &body,
                                  std::vector<core::BoundaryLoad<dim>> loads)
    : images_(body.images()), loads_(std::move(loads))
{
  jump_.fill(Vector<dim>::Zero());
  for (std::size_t l = 0; l < loads_.size(); ++l)
    // Of a zone that keeps off the sides the far field alone has the jump.
    if (const int axis = loads_[l].jump_axis(); axis >= 0 && images_.period()[axis] > 0)
      jumps_.push_back({int(l), axis});
  if (!images_.is_any())
    return;
  body.bonds().for_each_bond([&](BondId id, const Bond<dim> &b) {
    if (!b.image)
      return;
    across_.push_back(id);
    particles_.insert(particles_.end(), {b.i, b.j});
  });
}

template <int dim>
void PeriodicJumps<dim>::set_time(double t)
{
  if (jumps_.empty())
    return;
  jump_.fill(Vector<dim>::Zero());
  for (const auto &[l, axis] : jumps_)
    for (int c = 0; c < dim; ++c)
      if (loads_[l].value[c])
        jump_[axis][c] += loads_[l].displacement(c, t);
  images_.set_jumps(jump_);
}

template <int dim>
void PeriodicJumps<dim>::show(bool has_loads) const
{
  if (jumps_.empty())
    return;
  std::array<Vector<dim>, dim> none;
  none.fill(Vector<dim>::Zero());
  images_.set_jumps(has_loads ? jump_ : none);
}

template <int dim>
void PeriodicJumps<dim>::wake(particles::RestBlocks<dim> *rest)
{
  if (!rest || has_begun_ || rest->all_awake() ||
      std::all_of(jump_.begin(), jump_.end(), [](const auto &j) { return j.isZero(0); }))
    return;
  has_begun_ = true;
  rest->wake(particles_);
}

template <int dim>
void PeriodicJumps<dim>::remove(const BondId &id, const Bond<dim> &b, const Particles &)
{
  if (b.image)
    across_.erase(std::find_if(across_.begin(), across_.end(), [&](const BondId &other) {
      return other.index == id.index && other.direction == id.direction;
    }));
}

template <int dim>
void PeriodicJumps<dim>::find_reactions(const StressedBody<dim> &state,
                                        const Contacts<dim> &contacts, Evaluation<dim> &e) const
{
  if (jumps_.empty())
    return;
  std::array<std::array<core::ExactSum, dim>, dim> sums;
  const auto add = [&](const PeriodicImage<dim> &image, const Vector<dim> &on_i) {
    for (int a = 0; a < dim; ++a)
      for (int c = 0; c < dim && image.periods[a] != 0; ++c)
        sums[a][c].add(image.periods[a] * on_i[c]);
  };
  for (const BondId &id : across_) {
    const Bond<dim> b = state.body().bonds().bond(id);
    add(*b.image, state.whole_force(b));
  }
  contacts.for_each_across(state.particles, add);
  std::array<std::array<bool, dim>, dim> named{};
  for (const auto &[l, axis] : jumps_)
    for (int c = 0; c < dim; ++c)
      named[axis][c] = named[axis][c] || loads_[l].value[c];
  for (const auto &[l, axis] : jumps_) {
    e.reactions[l].setZero();
    for (int c = 0; c < dim; ++c)
      if (loads_[l].value[c] || !named[axis][c]) {
        e.reactions[l][c] = sums[axis][c].value();
        named[axis][c] = true;
      }
  }
}

template <int dim>
void PeriodicJumps<dim>::book_work(const Evaluation<dim> &e)
{
  if (jumps_.empty())
    return;
  if (!booked_) { // as if a jump that is there at once had come in proportion
    std::array<Vector<dim>, dim> none;
    none.fill(Vector<dim>::Zero());
    booked_ = Booked{none, std::vector<Vector<dim>>(jumps_.size(), none[0])};
  }
  Booked now{jump_, {}};
  for (std::size_t k = 0; k < jumps_.size(); ++k) {
    const auto &[l, axis] = jumps_[k];
    now.reaction.push_back(e.reactions[l]);
    for (int c = 0; c < dim; ++c)
      if (const double moved = jump_[axis][c] - booked_->jump[axis][c]; loads_[l].value[c] && moved != 0)
        work_.add(0.5 * (now.reaction[k][c] + booked_->reaction[k][c]) * moved);
  }
  booked_ = std::move(now);
}

template <int dim>
void PeriodicJumps<dim>::save(core::State &state, const core::Names &) const
{
  if (jumps_.empty())
    return;
  core::save_sum(state, "periodic_work", work_);
  core::save_value(state, "periodic", "booked", std::int64_t(booked_.has_value()));
  if (!booked_)
    return;
  std::vector<std::int64_t> numbers;
  for (const Jump &jump : jumps_)
    numbers.push_back(jump.load);
  core::Table table(std::move(numbers));
  for (int c = 0; c < dim; ++c) {
    std::vector<double> reaction, jump;
    for (std::size_t k = 0; k < jumps_.size(); ++k) {
      reaction.push_back(booked_->reaction[k][c]);
      jump.push_back(booked_->jump[jumps_[k].axis][c]);
    }
    table.add("reaction_" + std::to_string(c), reaction);
    table.add("displacement_" + std::to_string(c), jump);
  }
  state["periodic_jumps"] = std::move(table);
}

template <int dim>
void PeriodicJumps<dim>::load(const core::State &state, const core::Names &, const Particles &)
{
  if (jumps_.empty())
    return;
  work_ = core::load_sum(state, "periodic_work");
  booked_.reset();
  if (core::load_integer(state, "periodic", "booked") == 0)
    return;
  const core::Table &table = core::table(state, "periodic_jumps");
  core::require(table.n_rows() == jumps_.size(), "the state is of another number of loads");
  Booked old{jump_, std::vector<Vector<dim>>(jumps_.size())};
  for (int c = 0; c < dim; ++c) {
    const auto reaction = table.reals("reaction_" + std::to_string(c)),
               jump = table.reals("displacement_" + std::to_string(c));
    for (std::size_t k = 0; k < jumps_.size(); ++k) {
      old.reaction[k][c] = reaction[k];
      old.jump[jumps_[k].axis][c] = jump[k];
    }
  }
  booked_ = std::move(old);
}

template class PeriodicJumps<2>;
template class PeriodicJumps<3>;
} // namespace ligament::dem
