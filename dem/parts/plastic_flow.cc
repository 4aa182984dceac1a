#include "dem/parts/plastic_flow.h"

#include "dem/bond_law.h"
#include "dem/laws/eigenstretch.h"

#include <algorithm>
#include <cmath>

namespace ligament::dem
{
namespace
{
/// R of a turn.
template <int dim>
Eigen::Matrix<double, dim, dim> matrix_of(const Turn<dim> &turn)
{
  Eigen::Matrix<double, dim, dim> r;
  for (int c = 0; c < dim; ++c)
    r.col(c) = Vector<dim>::Unit(c) + turn.change(Vector<dim>::Unit(c));
  return r;
}

Tensor to_tensor(const Eigen::Matrix2d &m, double zz)
{
  Tensor t;
  t << m(0, 0), m(1, 1), zz, 0, 0, m(0, 1);
  return t;
}
Tensor to_tensor(const Eigen::Matrix3d &m, double)
{
  Tensor t;
  t << m(0, 0), m(1, 1), m(2, 2), m(1, 2), m(0, 2), m(0, 1);
  return t;
}
} // namespace

template <int dim>
void PlasticFlow<dim>::set_law(std::unique_ptr<const YieldLaw> law, const BondedBody<dim> &body,
                               const LatticeConstants<dim> &rows, std::vector<int> loaded)
{
  core::require(body.energy_weights().empty(),
                "plastic flow needs a body of one elastic material with its whole energy");
  pressure_share_ =
      body.is_plane_strain() ? 2 * std::abs(body.materials().base().poissons_ratio) : 0;
  constexpr double round_off = 1e-9;
  yield_traction_ =
      (1 - round_off) * law->elastic_limit() / (body.largest_lever_share() + pressure_share_);
  core::require(yield_traction_ > 0, "the elastic limit must be positive");
  flowed_at_.reset();
  body_ = &body;
  constants_ = rows;
  blocks_ = std::make_unique<PlasticBlocks<dim>>(body.bonds(), std::move(law), std::move(loaded));
}

template <int dim>
std::array<Vector<dim>, 2> PlasticFlow<dim>::stretch(const Bond<dim> &b, const Turn<dim> &turn_i,
                                                     const Turn<dim> &turn_j) const
{
  const double q_i = b.lever_i.dot(b.normal), q_j = -b.lever_j.dot(b.normal);
  const Vector<dim> part_i = q_j * (blocks_->strain(b.i) * b.normal),
                    part_j = q_i * (blocks_->strain(b.j) * b.normal);
  return {Vector<dim>(part_i + turn_i.change(part_i)), Vector<dim>(part_j + turn_j.change(part_j))};
}

template <int dim>
BondMotion<dim> PlasticFlow<dim>::motion(const Bond<dim> &b, const Particles &p,
                                         const Turn<dim> &turn_i, const Turn<dim> &turn_j) const
{
  BondMotion<dim> m(b, turn_i, turn_j, get(p.displacement, b.i), get(p.displacement, b.j));
  if (blocks_ && (blocks_->is_plastic(b.i) || blocks_->is_plastic(b.j))) {
    const auto part = stretch(b, turn_i, turn_j);
    m.elastic -= part[0] + part[1];
  }
  return m;
}

template <int dim>
double PlasticFlow<dim>::flowed_volume(const Bond<dim> &b, int i) const
{
  if (!blocks_ || !blocks_->is_plastic(i))
    return 0;
  const Vector<dim> stretch = b.area * (blocks_->strain(i) * b.normal);
  return i == b.i ? b.lever_i.dot(stretch) : -b.lever_j.dot(stretch);
}

template <int dim>
void PlasticFlow<dim>::update_flowed_volume(int i, double volume)
{
  double sum = body_->is_plane_strain() ? volume * blocks_->strain_zz(i) : 0;
  body_->bonds().for_each_bond_of(i,
                                  [&](BondId, const Bond<dim> &b) { sum += flowed_volume(b, i); });
  blocks_->flowed_volume(i) = sum;
}

template <int dim>
std::vector<int> PlasticFlow<dim>::particles() const
{
  std::vector<int> found;
  if (blocks_)
    for (const RowRange &range : blocks_->plastic())
      for (int i = range.begin; i < range.end; ++i)
        found.push_back(i);
  return found;
}

template <int dim>
void PlasticFlow<dim>::add_pressures(const Particles &, Evaluation<dim> &e) const
{
  if (!blocks_ || !e.body.has_dilatation())
    return;
  for (const RowRange &range : blocks_->plastic())
    for (int i = range.begin; i < range.end; ++i)
      e.pressure[i] -= e.body.lambda_per_volume()[i] * blocks_->flowed_volume()[i];
}

template <int dim>
double PlasticFlow<dim>::add_change(const Bond<dim> &b, int i, const Particles &p,
                                    Wrench<dim> &wrench) const
{
  if (!blocks_->is_plastic(b.i) && !blocks_->is_plastic(b.j))
    return 0;
  const auto turn_i = Turn<dim>::of(p, b.i), turn_j = Turn<dim>::of(p, b.j);
  const BondMotion<dim> m(b, turn_i, turn_j, get(p.displacement, b.i), get(p.displacement, b.j));
  const auto parts = stretch(b, turn_i, turn_j);
  const bool first = b.i == i;
  const double sign = first ? 1 : -1;
  const Vector<dim> du = sign * m.du, stretch = sign * (parts[0] + parts[1]),
                    own = sign * (first ? parts[0] : parts[1]);
  const HWY_NAMESPACE::Eigenstretch<double, Vector<dim>> law{law_of(b).shear};
  const Vector<dim> lost = law.lost(stretch);
  wrench.force -= lost;
  wrench.torque = law.add_torque(lost, du, first ? m.a_i : m.a_j, own, wrench.torque);
  return -0.25 * law.twice_lost_energy(lost, du, stretch);
}

template <int dim>
void PlasticFlow<dim>::add_force_on(int i, const Particles &p, const Evaluation<dim> &e,
                                    Wrench<dim> &wrench) const
{
  if (has_flowed())
    e.body.bonds().for_each_bond_of(
        i, [&](BondId, const Bond<dim> &b) { add_change(b, i, p, wrench); });
}

template <int dim>
PlasticRows<dim> PlasticFlow<dim>::rows(const Particles &p, Evaluation<dim> &e) const
{
  return {e.arrays(p),        constants_,        &e.body.bonds().segments(),
          blocks_->strains(), blocks_->turned(), e.body.n_particles()};
}

template <int dim>
template <typename Visit>
void PlasticFlow<dim>::for_each_force(const Particles &p, Evaluation<dim> &e, Visit &&visit) const
{
  using Rows = PlasticRows<dim>;
  Rows rows = this->rows(p, e);
  const auto ranges = blocks_->around_plastic();
  const bool has_rows = e.body.bonds().n_directions() > 0;
  std::vector<double> sums(Rows::n_forces * TractionScreen::block, 0.);
  rows.sums = sums.data();
  if (has_rows)
    for (const RowRange &range : blocks_->and_neighbours(ranges))
      turn_plastic(rows, range);
  for (const RowRange &range : ranges) {
    if (has_rows)
      sum_plastic(rows, range, Rows::Sums::forces);
    for (int i = range.begin; i < range.end; ++i) {
      const double *const sum = sums.data() + (i - range.begin);
      Wrench<dim> wrench;
      for (int c = 0; c < dim; ++c)
        wrench.force[c] = sum[c * TractionScreen::block];
      for (int c = 0; c < n_spins<dim>; ++c)
        wrench.torque[c] = sum[(dim + c) * TractionScreen::block];
      double energy = sum[n_particle_dofs<dim> * TractionScreen::block];
      e.body.bonds().for_each_entry_of(
          i, [&](BondId, const Bond<dim> &b) { energy += add_change(b, i, p, wrench); });
      visit(i, wrench, energy);
    }
  }
}

template <int dim>
void PlasticFlow<dim>::add_forces(Particles &p, Evaluation<dim> &e) const
{
  e.plastic_energy.clear();
  if (!blocks_)
    return;
  for_each_force(p, e, [&](int i, const Wrench<dim> &wrench, double energy) {
    ligament::add(p.force, i, wrench.force);
    ligament::add(p.torque, i, wrench.torque);
    e.plastic_energy.push_back(energy);
  });
}

template <int dim>
void PlasticFlow<dim>::add_energies(const Particles &p, Evaluation<dim> &e,
                                    std::vector<double> &energy) const
{
  if (blocks_)
    for_each_force(p, e,
                   [&](int i, const Wrench<dim> &, double of_bonds) { energy[i] += of_bonds; });
}

template <int dim>
void PlasticFlow<dim>::remove(const BondId &, const Bond<dim> &b, const Particles &p)
{
  for (const int i : {b.i, b.j})
    if (blocks_ && blocks_->is_plastic(i))
      update_flowed_volume(i, p.volume[i]);
}

template <int dim>
void PlasticFlow<dim>::ask(Evaluation<dim> &e) const
{
  if (!blocks_)
    return;
  e.yield_traction = yield_traction_;
  e.marks.assign(blocks_->n_blocks(), 0);
}

template <int dim>
void PlasticFlow<dim>::find_stresses(const Particles &p, const PlasticRows<dim> &rows,
                                     const RowRange &range, const Evaluation<dim> &e,
                                     const Moments &moments, std::vector<Tensor> &stress) const
{
  using Matrix = typename PlasticBlocks<dim>::Matrix;
  stress.clear();
  if (e.body.bonds().n_directions() > 0)
    sum_plastic(rows, range, PlasticRows<dim>::Sums::stresses);
  const double twice_shear = 2 * e.body.materials().base().shear_modulus();
  for (int i = range.begin; i < range.end; ++i) {
    Matrix moment;
    for (int c = 0; c < dim * dim; ++c)
      moment(c / dim, c % dim) = rows.sums[c * TractionScreen::block + (i - range.begin)];
    e.body.bonds().for_each_entry_of(i, [&](BondId, const Bond<dim> &b) {
      const BondMotion<dim> m = motion(b, p, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j));
      const Vector<dim> f =
          law_of(b).force(m.elastic, e.pressure[b.i], m.a_i, e.pressure[b.j], m.a_j);
      moment += b.i == i ? Matrix(f * m.a_i.transpose()) : Matrix(-f * m.a_j.transpose());
    });
    if (const auto loaded = moments.find(i); loaded != moments.end())
      moment += loaded->second;
    const Matrix r = matrix_of(Turn<dim>::of(p, i));
    const Matrix in_plane = r.transpose() * (moment + moment.transpose()) * r / (2 * p.volume[i]);
    const double zz =
        e.body.is_plane_strain() ? e.pressure[i] - twice_shear * blocks_->tensor(i)[2] : 0;
    stress.push_back(to_tensor(in_plane, zz));
  }
}

template <int dim>
auto PlasticFlow<dim>::increments(const Particles &p, double time, Evaluation<dim> &e,
                                  const ForcePart<dim> &surface) -> Increments
{
  if (!blocks_ || flowed_at_ == time)
    return {};
  flowed_at_ = time;
  if (pressure_share_ > 0)
    for (int b = 0; b < blocks_->n_blocks(); ++b) {
      const int begin = b * TractionScreen::block,
                end = std::min(begin + TractionScreen::block, e.body.n_particles());
      int found = 0; // without a branch, so that it is done in vectors
      for (int i = begin; i < end; ++i)
        found |= std::abs(e.pressure[i]) >= pressure_share_ * yield_traction_;
      e.marks[b] |= std::uint8_t(found);
    }
  Increments found;
  std::vector<Tensor> stress, increment(TractionScreen::block);
  const auto suspects = blocks_->suspects(e.marks);
  PlasticRows<dim> rows = this->rows(p, e);
  std::vector<double> sums(PlasticRows<dim>::n_stresses * TractionScreen::block, 0.);
  rows.sums = sums.data();
  if (e.body.bonds().n_directions() > 0)
    for (const RowRange &range : blocks_->and_neighbours(suspects))
      turn_plastic(rows, range);
  Moments moments;
  surface.for_each_moment(p, e, [&](int i, const Vector<dim> &a, const Vector<dim> &f) {
    const auto [place, is_new] = moments.try_emplace(i, f * a.transpose());
    if (!is_new)
      place->second += f * a.transpose();
  });
  for (const RowRange &range : suspects) {
    find_stresses(p, rows, range, e, moments, stress);
    blocks_->law().flow(range.end - range.begin, stress.data(), blocks_->history() + range.begin,
                        increment.data());
    for (int i = range.begin; i < range.end; ++i)
      if (!increment[i - range.begin].isZero(0))
        found.push_back({i, increment[i - range.begin]});
  }
  return found;
}

template <int dim>
void PlasticFlow<dim>::add(const Increments &increments, const Particles &p)
{
  for (const auto &[i, tensor] : increments)
    blocks_->add(i, tensor);
  for (const auto &[i, tensor] : increments)
    update_flowed_volume(i, p.volume[i]);
}

template <int dim>
void PlasticFlow<dim>::save(core::State &state, const core::Names &names) const
{
  if (!blocks_)
    return;
  blocks_->save(state, names);
  core::save_value(state, "flow", "flowed_at", flowed_at_.value_or(std::nan("")));
  core::save_sum(state, "plastic_dissipation", dissipation_);
}

template <int dim>
void PlasticFlow<dim>::load(const core::State &state, const core::Names &names, const Particles &p)
{
  if (!blocks_)
    return;
  blocks_->load(state, names);
  for (const int i : particles())
    update_flowed_volume(i, p.volume[i]);
  const double time = core::load_real(state, "flow", "flowed_at");
  flowed_at_ = std::isnan(time) ? std::nullopt : std::optional(time);
  dissipation_ = core::load_sum(state, "plastic_dissipation");
}

template class PlasticFlow<2>;
template class PlasticFlow<3>;
} // namespace ligament::dem
