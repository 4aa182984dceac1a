#include "src/simulation/guards.h"

#include "fem/cell_map.h"
#include "src/output/format.h"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::program
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();

// Of a spacing, in one step: the skin of the search for contacts (dem/contact_search.cc). Waves are
// as slow as that, so that nothing that they move is as fast.
constexpr double largest_way = 0.25;
// In spacings: from here on rounding of a displacement is more than 1e-9 of one.
constexpr double largest_distance = 1e7;
// Of the body's energy, from nowhere; below a mean strain of 1e-6 all of it may be rounding.
constexpr double largest_gain = 0.5, least_strain = 1e-6;

/// What is worse comes later.
enum class Fault : std::int64_t
{
  none,
  fast,
  far_away,
  inside_out,
  not_finite
};

/// What one rank found; the place is that in the reference.
template <int dim>
struct Finding
{
  Fault fault = Fault::none;
  bool is_cell = false;
  double much = 0; // m: the way of one step, or from the reference
  std::array<double, dim> place = {};

  bool is_before(const Finding &other) const
  {
    return fault != other.fault ? fault > other.fault : place < other.place;
  }
  void take(const Finding &other)
  {
    if (other.is_before(*this))
      *this = other;
  }
};

template <int dim>
std::array<double, dim> numbers(const Vector<dim> &x)
{
  std::array<double, dim> values;
  for (int c = 0; c < dim; ++c)
    values[c] = x[c];
  return values;
}

/// Of these particles, in squares.
struct MotionLimits
{
  double speed, distance; // m^2/s^2, m^2
};

template <std::size_t n>
double square(const std::array<std::vector<double>, n> &components, int i)
{
  double sum = 0;
  for (const auto &component : components)
    sum += component[i] * component[i];
  return sum;
}

/// A look without branches at particles [begin, end): no comparison holds for what is no number.
template <int dim>
bool are_sound(const particles::Particles<dim> &p, int begin, int end, const MotionLimits &limits)
{
  int unsound = 0;
  for (int i = begin; i < end; ++i)
    unsound |=
        !(square(p.velocity, i) <= limits.speed) | !(square(p.displacement, i) <= limits.distance);
  if (p.turns)
    for (int i = begin; i < end; ++i)
      unsound |= !(square(p.spin, i) < infinity);
  return unsound == 0;
}

template <int dim>
Finding<dim> look_at_particle(const particles::Particles<dim> &p, int i, const MotionLimits &limits,
                              double dt)
{
  const double speed = square(p.velocity, i), distance = square(p.displacement, i),
               spin = p.turns ? square(p.spin, i) : 0;
  Finding<dim> finding;
  finding.place = numbers<dim>(get(p.reference, i));
  if (!(speed < infinity && distance < infinity && spin < infinity))
    finding.fault = Fault::not_finite;
  else if (distance > limits.distance) {
    finding.fault = Fault::far_away;
    finding.much = std::sqrt(distance);
  } else if (speed > limits.speed) {
    finding.fault = Fault::fast;
    finding.much = dt * std::sqrt(speed);
  }
  return finding;
}

template <int dim>
Finding<dim> look_at_particles(const CoupledBody<dim> &body)
{
  const auto &p = body.zone->state;
  const MotionLimits limits = {std::pow(largest_way * body.spacing / body.dt, 2),
                               std::pow(largest_distance * body.spacing, 2)};
  Finding<dim> worst;
  for (const auto &range : p.part.owned)
    if (!are_sound(p, range.begin, range.end, limits))
      for (int i = range.begin; i < range.end; ++i)
        worst.take(look_at_particle(p, i, limits, body.dt));
  return worst;
}

template <int dim>
Finding<dim> look_at_cells(const CoupledBody<dim> &body)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  const auto &mesh = body.far->mesh();
  Finding<dim> worst;
  for (int cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto gradients = fem::centre_gradients(mesh, cell);
    Matrix f = Matrix::Identity();
    Vector<dim> middle = Vector<dim>::Zero();
    for (int a = 0; a < fem::n_cell_nodes<dim>; ++a) {
      const int node = mesh.cells[cell][a];
      f += get(body.far->displacement, node) * gradients.col(a).transpose();
      middle += mesh.nodes[node] / fem::n_cell_nodes<dim>;
    }
    const double volume = f.determinant();
    if (volume > 0 && volume < infinity)
      continue;
    Finding<dim> finding;
    finding.fault = std::isfinite(volume) ? Fault::inside_out : Fault::not_finite;
    finding.is_cell = true;
    finding.place = numbers<dim>(middle);
    worst.take(finding);
  }
  return worst;
}

/// The first by place of those that are as bad as the worst one of all ranks.
template <int dim>
Finding<dim> agreed(const Finding<dim> &here, const core::Ranks &ranks)
{
  const auto worst = Fault(ranks.max(std::int64_t(here.fault)));
  if (worst == Fault::none)
    return here;
  Finding<dim> first;
  for (const Finding<dim> &finding : ranks.gather_all(std::vector<Finding<dim>>{here}))
    first.take(finding);
  return first;
}

template <int dim>
std::string words(const Finding<dim> &finding, double spacing)
{
  const char *remedy = "lower /time/step_fraction or the load's rate";
  switch (finding.fault) {
  case Fault::fast:
    return fmt::format("the particle from {} moves by {:.2g} spacings in one step, farther than "
                       "the search for contacts sees ahead ({}); {}",
                       place(finding.place), finding.much / spacing, largest_way, remedy);
  case Fault::far_away:
    return fmt::format("the particle from {} is lost: it has gone {:.2g} spacings, and from {:.0e} "
                       "on rounding spoils what its bonds bear; {}, or end the run earlier",
                       place(finding.place), finding.much / spacing, largest_distance, remedy);
  case Fault::inside_out:
    return fmt::format("the cell of the far field at {} is turned inside out; make "
                       "/discrete_zone/region larger, or {}",
                       place(finding.place), remedy);
  case Fault::not_finite:
    return fmt::format("the motion of the {} {} is no longer finite: the run is unstable; {}",
                       finding.is_cell ? "cell of the far field at" : "particle from",
                       place(finding.place), remedy);
  case Fault::none:
    break;
  }
  return "";
}

/// J: of the whole body at the least strain that counts.
template <int dim>
double least_energy(const CoupledBody<dim> &body)
{
  double volume = dim == 2 ? body.thickness : 1;
  for (int c = 0; c < dim; ++c)
    volume *= body.upper[c] - body.lower[c];
  const double stiffness = body.far ? body.far->body().stiffness(0, 0)
                                    : body.force()->elastic_constants().stiffness(0, 0);
  return 0.5 * stiffness * volume * least_strain * least_strain;
}
} // namespace

template <int dim>
std::optional<std::string> find_broken_motion(const CoupledBody<dim> &body)
{
  Finding<dim> here;
  if (body.zone)
    here.take(look_at_particles(body));
  if (body.far)
    here.take(look_at_cells(body));
  const Finding<dim> finding = agreed(here, body.ranks);
  if (finding.fault == Fault::none)
    return {};
  return words(finding, body.spacing);
}

template <int dim>
std::optional<std::string> find_broken_balance(const EnergyLedger &ledger, double most_work,
                                               const CoupledBody<dim> &body)
{
  // The term for the far field's impulses (theory.md eq. (E5)) stands for loads that change little
  // within its step: of one that has just risen it may be all that the residual is.
  const double gain = ledger.residual() - std::abs(ledger.body.impulses);
  if (!std::isfinite(gain))
    return "the energies are no longer finite: the run is unstable; lower /time/step_fraction or "
           "the load's rate";
  // Flow takes energy from what is strained, which has none to give below zero.
  constexpr double largest_debt = 0.1; // loaded faces may have a little less than none
  const double debt = -ledger.body.potential_discrete;
  if (ledger.force.plastic > 0 && debt > least_energy(body) &&
      debt > largest_debt * std::max(most_work, ledger.kinetic()))
    return fmt::format("the particles' elastic energy is {} below zero: cells gain energy by "
                       "flowing, as in packings that are not relaxed, and at aslant sides of "
                       "lattices that break; give \"relaxation_sweeps\", or the packing "
                       "\"random\", or hardening of a fifth of the shear modulus",
                       quantity(debt, "J"));
  const double energy = ledger.kinetic() + std::abs(ledger.potential());
  if (gain <= largest_gain * energy || gain <= most_work || gain <= least_energy(body))
    return {};
  return fmt::format("{:.0f} % of the body's energy, {}, came from nowhere: the run is unstable; "
                     "lower /time/step_fraction or the load's rate",
                     100 * gain / energy, quantity(gain, "J"));
}

template std::optional<std::string> find_broken_motion(const CoupledBody<2> &);
template std::optional<std::string> find_broken_motion(const CoupledBody<3> &);
template std::optional<std::string> find_broken_balance(const EnergyLedger &, double,
                                                        const CoupledBody<2> &);
template std::optional<std::string> find_broken_balance(const EnergyLedger &, double,
                                                        const CoupledBody<3> &);
} // namespace ligament::program
