#include "dem/parts/inelastic_strains.h"

#include "dem/bond_law.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include <cmath>

namespace ligament::dem
{
namespace
{
FlowLaw flow_law_of(const DemMaterial &material, bool is_plane_stress)
{
  FlowLaw law;
  law.is_plane_stress = is_plane_stress;
  law.shear = material.shear_modulus();
  law.bulk = material.youngs_modulus / (3 * (1 - 2 * material.poissons_ratio));
  if (const auto *mises = std::get_if<VonMisesFlow>(&material.plasticity)) {
    const YieldCurve &curve = mises->yield;
    law.kind = FlowLaw::Kind::von_mises;
    law.yield = curve.at(0);
    law.hardening = curve.hardening;
    law.saturation = curve.saturation;
    law.rate = curve.rate;
    law.n_points = int(curve.strain.size());
  }
  if (const auto *prager = std::get_if<DruckerPragerFlow>(&material.plasticity)) {
    law.kind = FlowLaw::Kind::drucker_prager;
    law.yield = prager->cohesion;
    law.hardening = prager->hardening;
    law.friction = prager->friction;
    law.dilatancy = prager->dilatancy;
    core::require(law.hardening > -0.8 * (law.shear + law.bulk * law.dilatancy * law.friction),
                  "the cohesion falls faster than the particle unloads: its energy of softening is "
                  "too small for the spacing");
  }
  return law;
}

bool has_own_strains(const DemMaterial &material)
{
  return flows(material.plasticity) || is_viscous(material.viscosity);
}

/// Open for what is no bond's, but it lacks no face.
template <int dim>
OpenCell<dim> whole_cell(double volume)
{
  OpenCell<dim> cell;
  cell.number[OpenCell<dim>::volume] = volume;
  for (int row = 0; row < dim; ++row)
    for (int a = 0; a < dim; ++a)
      cell.number[OpenCell<dim>::moment + row * n_in_plane<dim> + in_plane_place<dim>(a, a)] = 1;
  return cell;
}

/// Three of each material: its own, an elastic one, and one that keeps what has slid.
constexpr int most_laws = 255;
} // namespace

template <int dim>
InelasticStrains<dim>::InelasticStrains(const packings::Packing<dim> &packing,
                                        const BondedBody<dim> &body,
                                        std::vector<WallFace<dim>> walls,
                                        const std::vector<int> &loaded)
    : body_(&body), part_(particles::Part::whole(body.n_particles())), walls_(std::move(walls))
{
  const auto &materials = body.materials().all();
  if (std::none_of(materials.begin(), materials.end(),
                   [](const DemMaterial &m) { return has_own_strains(m); }))
    return;
  std::stable_sort(
      walls_.begin(), walls_.end(),
      [](const WallFace<dim> &first, const WallFace<dim> &second) { return first.i < second.i; });
  core::require(3 * materials.size() < most_laws, "a body that flows has too many materials");
  for (const DemMaterial &m : materials) {
    check(m.plasticity);
    parameters_.push_back(m.plasticity);
    has_plasticity_ = has_plasticity_ || flows(m.plasticity);
    laws_.push_back(flow_law_of(m, dim == 2 && !body.is_plane_strain()));
    if (dem::is_viscous(m.viscosity))
      most_branches_ = std::max(most_branches_, int(m.viscosity.branches.size()));
  }
  // Of the materials, and of their particles that stay as they are.
  for (int copy = 0; copy < 2; ++copy)
    for (const DemMaterial &m : materials)
      viscous_.emplace_back(m.viscosity, m.shear_modulus());
  laws_.reserve(3 * laws_.size());
  for (std::size_t k = 0; k < laws_.size(); ++k)
    if (dem::is_viscous(materials[k].viscosity))
      laws_[k].viscous = &viscous_[k].step();
  for (std::size_t k = 0; k < laws_.size(); ++k)
    if (const auto *mises = std::get_if<VonMisesFlow>(&parameters_[k])) {
      laws_[k].strain = mises->yield.strain.data();
      laws_[k].stress = mises->yield.stress.data();
    }
  const int n = body.n_particles();
  if (materials.size() > 1)
    for (int i = 0; i < n; ++i)
      law_of_.push_back(std::uint8_t(body.materials().number(i)));
  // Streams don't lie a multiple of 4096 bytes apart, lest they share sets of the cache.
  const long stride = (long(n) + most_lanes + 63) / 64 * 64 + 24;
  numbers_ = core::LargeArray(Streams::count(most_branches_) * stride, false);
  streams_ = {numbers_.data(), stride};
  begun_.assign((n + inelastic_block - 1) / inelastic_block, 0);
  if (body.bonds().n_directions() > 0) {
    const auto &d = body.bonds().directions()[0];
    whole_volume_ = body.bonds().n_directions() * d.area * d.distance / dim;
  }
  open_.assign(n, -1);
  std::vector<char> has_load(n, 0);
  for (const int i : loaded)
    has_load[i] = 1;
  for (int i = 0; i < n; ++i) {
    auto cell = find_cell(i, packing.volume[i]);
    if (!cell && has_load[i])
      cell = whole_cell<dim>(packing.volume[i]);
    if (cell) {
      open_[i] = int(cells_.size());
      cells_.push_back(*cell);
    }
  }
  std::vector<int> loose;
  for (int i = 0; i < n; ++i)
    if (open_[i] >= 0 && !is_held(i, packing.volume[i])) {
      loose.push_back(i);
      const FlowLaw &law = laws_[law_number(i)];
      if (law.kind != FlowLaw::Kind::elastic || law.viscous)
        loose_.push_back(i);
    }
  keep_elastic(loose);
}

template <int dim>
template <typename Visit>
void InelasticStrains<dim>::for_each_wall_of(int i, Visit &&visit) const
{
  auto wall = std::lower_bound(walls_.begin(), walls_.end(), i,
                               [](const WallFace<dim> &w, int of) { return w.i < of; });
  for (; wall != walls_.end() && wall->i == i; ++wall)
    visit(*wall);
}

template <int dim>
bool InelasticStrains<dim>::is_held(int i, double volume) const
{
  Matrix held = Matrix::Zero();
  body_->bonds().for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
    const double q_i = b.lever_i.dot(b.normal), q_j = -b.lever_j.dot(b.normal);
    const double q = i == b.i ? q_i : q_j, other = i == b.i ? q_j : q_i;
    const Vector<dim> n = i == b.i ? b.normal : Vector<dim>(-b.normal),
                      side = b.lever_i - q_i * b.normal;
    if (b.joins_materials) {
      constexpr double share = 0.1; // its particles alone share the motion
      held += share * b.area * q * n * n.transpose();
      return;
    }
    const Matrix mixed = n * side.transpose();
    held += b.area / b.distance *
            (q * other * n * n.transpose() + 0.5 * (other - q) * (mixed + mixed.transpose()) -
             side * side.transpose());
  });
  for_each_wall_of(i, [&](const WallFace<dim> &wall) {
    held += 0.5 * wall.area * wall.q * wall.normal * wall.normal.transpose();
  });
  constexpr double least = 0.05; // 1/2 in a whole cell; edges of clipped lattices have 0.06
  return Eigen::SelfAdjointEigenSolver<Matrix>(held, Eigen::EigenvaluesOnly).eigenvalues()[0] >=
         least * volume;
}

template <int dim>
auto InelasticStrains<dim>::moment(const Bond<dim> &b, int i) -> Matrix
{
  const Vector<dim> lever = i == b.i ? b.lever_i : b.lever_j,
                    normal = i == b.i ? b.normal : Vector<dim>(-b.normal);
  if (b.joins_materials)
    return b.area / lever.dot(normal) * lever * lever.transpose();
  const Matrix m = b.area * lever * normal.transpose();
  return 0.5 * (m + m.transpose());
}

template <int dim>
auto InelasticStrains<dim>::cell_of(int i, double volume) const -> MeasuredCell
{
  using Cell = OpenCell<dim>;
  const auto &bonds = body_->bonds();
  const auto other = other_moment_.find(i);
  const bool has_others = other != other_moment_.end();
  Matrix of_bonds = Matrix::Zero();
  if (has_others)
    of_bonds = other->second;
  bool is_closed = bonds.n_directions() == 0 && !has_others; // by bonds that the slices see
  bonds.for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
    of_bonds += moment(b, i);
    is_closed = is_closed && !b.joins_materials;
  });
  std::array<Matrix, dim> rows;
  rows.fill(of_bonds / volume);
  for_each_wall_of(i, [&](const WallFace<dim> &wall) {
    for (int c = 0; c < dim; ++c)
      if (wall.prescribed[c] != 0) {
        is_closed = false;
        rows[c] += wall.area * wall.q / volume * wall.normal * wall.normal.transpose();
      }
  });
  constexpr double round_off = 1e-9;
  MeasuredCell measured{{}, is_closed && (rows[0] - Matrix::Identity()).norm() < round_off};
  measured.cell.number[Cell::volume] = volume;
  for (int row = 0; row < dim; ++row)
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b)
        measured.cell.number[Cell::moment + row * n_in_plane<dim> + in_plane_place<dim>(a, b)] =
            rows[row](a, b);
  return measured;
}

template <int dim>
std::optional<OpenCell<dim>> InelasticStrains<dim>::find_cell(int i, double volume) const
{
  const auto &bonds = body_->bonds();
  if (other_moment_.count(i) == 0 && bonds.n_directions() > 0 &&
      bonds.mask()[i] == (std::uint32_t(1) << 2 * bonds.n_directions()) - 1)
    return std::nullopt;
  const MeasuredCell measured = cell_of(i, volume);
  return measured.is_whole ? std::nullopt : std::optional(measured.cell);
}

// However small the face that it lost was.
template <int dim>
void InelasticStrains<dim>::set_cell(int i, double volume)
{
  const OpenCell<dim> cell = cell_of(i, volume).cell;
  if (open_[i] < 0) {
    open_[i] = int(cells_.size());
    cells_.emplace_back();
  }
  // What this evaluation has found of its strain stays.
  std::copy(cell.number + OpenCell<dim>::volume, cell.number + OpenCell<dim>::size,
            cells_[open_[i]].number + OpenCell<dim>::volume);
}

template <int dim>
void InelasticStrains<dim>::open_cell(int i, double volume)
{
  if (!has_law() || open_[i] >= 0)
    return;
  open_[i] = int(cells_.size());
  cells_.push_back(whole_cell<dim>(volume));
}

template <int dim>
bool InelasticStrains<dim>::has_begun() const
{
  return std::any_of(begun_.begin(), begun_.end(), [](std::uint8_t b) { return b != 0; });
}

template <int dim>
void InelasticStrains<dim>::keep_elastic(const std::vector<int> &particles)
{
  if (!has_law() || particles.empty())
    return;
  if (law_of_.empty())
    law_of_.assign(body_->n_particles(), 0);
  // One elastic law per material: the stiffness is still the material's.
  const int n = int(parameters_.size());
  if (int(laws_.size()) == n)
    for (int k = 0; k < n; ++k) {
      laws_.push_back(laws_[k]);
      laws_.back().kind = FlowLaw::Kind::elastic;
      laws_.back().viscous = nullptr;
    }
  for (const int i : particles)
    if (law_of_[i] < n)
      law_of_[i] = std::uint8_t(law_of_[i] + n);
}

template <int dim>
InelasticSweep<dim> InelasticStrains<dim>::begin(bool may_flow, double time) const
{
  for (auto &cell : cells_)
    std::fill(cell.number, cell.number + OpenCell<dim>::volume, 0.);
  may_flow = may_flow && flowed_at_ != time;
  if (may_flow) {
    set_viscous_step(time);
    flowed_at_ = time;
  }
  return {streams_,
          begun_.data(),
          int(begun_.size()),
          law_of_.empty() ? nullptr : law_of_.data(),
          laws_.data(),
          open_.data(),
          cells_.data(),
          body_->volumes().empty() ? nullptr : body_->volumes().data(),
          whole_volume_,
          whole_volume_ > 0 ? 1 / whole_volume_ : 0,
          body_->is_plane_strain(),
          may_flow};
}

template <int dim>
void InelasticStrains<dim>::add_strain(const InelasticSweep<dim> &sweep, int i,
                                       const Matrix &strain)
{
  double *const to = sweep.cells[sweep.open[i]].number + OpenCell<dim>::strain;
  for (int k = 0; k < dim * dim; ++k)
    to[k] += strain(k / dim, k % dim);
}

template <int dim>
auto InelasticStrains<dim>::cell_strain(const InelasticSweep<dim> &sweep, int i) -> Matrix
{
  const double *const from = sweep.cells[sweep.open[i]].number + OpenCell<dim>::strain;
  Matrix strain;
  for (int k = 0; k < dim * dim; ++k)
    strain(k / dim, k % dim) = from[k];
  return strain;
}

template <int dim>
void InelasticStrains<dim>::set_cell_strain(const InelasticSweep<dim> &sweep, int i,
                                            const Matrix &strain)
{
  double *const to = sweep.cells[sweep.open[i]].number + OpenCell<dim>::strain;
  for (int k = 0; k < dim * dim; ++k)
    to[k] = strain(k / dim, k % dim);
}

template <int dim>
auto InelasticStrains<dim>::tensor(int i) const -> Tensor
{
  Tensor t = Tensor::Zero();
  if (is_strained(i))
    for (int c = 0; c < n_tensor<dim>; ++c)
      t[c] = streams_.stream(Streams::strain + c)[i];
  return t;
}

template <int dim>
auto InelasticStrains<dim>::strain(int i) const -> Matrix
{
  const Tensor t = tensor(i);
  Matrix m;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      m(a, b) = t[tensor_place<dim>(a, b)];
  return m;
}

template <int dim>
double InelasticStrains<dim>::history(int i) const
{
  return is_strained(i) ? streams_.stream(Streams::history)[i] : 0;
}

template <int dim>
void InelasticStrains<dim>::set_strain(int i, const Tensor &strain)
{
  for (int c = 0; c < n_tensor<dim>; ++c)
    streams_.stream(Streams::strain + c)[i] = strain[c];
  begun_[i / inelastic_block] = 1;
}

namespace
{
template <int dim>
Vector<dim> turned(const Turn<dim> &turn, const Vector<dim> &a)
{
  return a + turn.change(a);
}
} // namespace

template <int dim>
BondMotion<dim> InelasticStrains<dim>::motion(const Bond<dim> &b, const Particles &p,
                                              const Turn<dim> &turn_i,
                                              const Turn<dim> &turn_j) const
{
  BondMotion<dim> m(b, turn_i, turn_j, get(p.displacement, b.i), get(p.displacement, b.j));
  if (is_strained(b.i) || is_strained(b.j))
    m.stretch(turned<dim>(turn_i, strain(b.i) * b.lever_i),
              turned<dim>(turn_j, strain(b.j) * b.lever_j));
  return m;
}

template <int dim>
double InelasticStrains<dim>::flowed_volume(int i) const
{
  if (!is_strained(i))
    return 0;
  const Tensor e = tensor(i), flowed = moved(i, e);
  const double out_of_plane = body_->is_plane_strain() ? e[2] : 0;
  return volume(i) * (flowed.template head<dim>().sum() + out_of_plane);
}

template <int dim>
double InelasticStrains<dim>::flowed_volume(const Bond<dim> &b, int i) const
{
  return is_strained(i) ? moment(b, i).cwiseProduct(strain(i)).sum() : 0;
}

// Of both sides, (D20b): a bond's share of -2G V e:E + G V e:(e M).
template <int dim>
double InelasticStrains<dim>::bond_energy(const Bond<dim> &b, const Particles &p,
                                          const Vector<dim> &opening) const
{
  double sum = 0;
  if (!is_strained(b.i) && !is_strained(b.j))
    return sum;
  const BondMotion<dim> m = motion(b, p, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j));
  for (const int i : {b.i, b.j}) {
    const Matrix e = strain(i);
    sum += b.shear_i * (e * e).cwiseProduct(moment(b, i)).sum();
  }
  return sum - law_of(b).shear * (m.du - opening).dot(m.stretch_i - m.stretch_j);
}

template <int dim>
Bond<dim> InelasticStrains<dim>::stretched(const Bond<dim> &b) const
{
  Bond<dim> now = b;
  if (is_strained(b.i))
    now.lever_i += strain(b.i) * b.lever_i;
  if (is_strained(b.j))
    now.lever_j += strain(b.j) * b.lever_j;
  now.distance += b.normal.dot((now.lever_i - b.lever_i) - (now.lever_j - b.lever_j));
  return now;
}

template <int dim>
void InelasticStrains<dim>::add_force_on(int i, const Particles &p, const Evaluation<dim> &e,
                                         Wrench<dim> &wrench) const
{
  if (!has_law())
    return;
  e.body.bonds().for_each_bond_of(i, [&](BondId, const Bond<dim> &b) {
    if (b.joins_materials || (!is_strained(b.i) && !is_strained(b.j)))
      return;
    const BondMotion<dim> m = motion(b, p, Turn<dim>::of(p, b.i), Turn<dim>::of(p, b.j));
    const bool first = b.i == i;
    const double shear = law_of(b).shear, sign = first ? 1 : -1;
    const Vector<dim> change = sign * shear * (m.elastic - m.du);
    wrench.force += change;
    wrench.torque += cross(first ? m.a_i : m.a_j, change) +
                     cross(first ? m.stretch_i : m.stretch_j, Vector<dim>(sign * shear * m.du));
  });
}

template <int dim>
void InelasticStrains<dim>::remove(const BondId &, const Bond<dim> &b, const Particles &p)
{
  if (!has_law())
    return;
  for (const int i : {b.i, b.j}) {
    set_cell(i, p.volume[i]);
    if (!is_held(i, p.volume[i])) {
      forget_viscosity(i);
      keep_elastic({i});
    }
  }
}

template class InelasticStrains<2>;
template class InelasticStrains<3>;
} // namespace ligament::dem
