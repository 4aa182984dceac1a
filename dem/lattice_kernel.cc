#include "dem/lattice_kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace ligament::dem
{
namespace
{
// The message is made only where it is needed: kernels ask in every step.
void check_length(long least, long n_particles, long stride)
{
  if (std::min(least, n_particles) <= stride)
    return;
  throw core::InputError(
      fmt::format("/discrete_zone: neighbours of the packing are {} particles apart in their "
                  "order, and at most {} can be bridged; make the zone smaller across its "
                  "longest side, or /discrete_zone/spacing larger",
                  (least - window_length_for(0)) / 3, largest_reach));
}
} // namespace

void RowWindow::reset(int n_streams, long stride, long least, int n)
{
  check_length(least, n, stride);
  // Sliding takes little time when the window is twice as long as it must be.
  const int length = int(std::min({2 * least, stride, long(n)}));
  if (n_streams != n_streams_ || stride != stride_ || length > length_) {
    constexpr int several_pages = 4096;
    data_ = core::LargeArray(n_streams * stride, length > several_pages);
  }
  n_streams_ = n_streams;
  stride_ = stride;
  length_ = length;
  begin_ = 0;
}

void RowWindow::slide(int keep, int end)
{
  if (end <= begin_ + length_)
    return;
  if (end - keep > length_)
    throw core::InputError("the row kernel's window is too short for its sweep");
  if (keep < begin_ + length_) // else a gap at rest lies in between
    for (int s = 0; s < n_streams_; ++s) {
      double *const first = data_.data() + s * stride_;
      std::copy(first + (keep - begin_), first + length_, first);
    }
  begin_ = keep;
}

template <int dim>
LatticeKernel<dim>::LatticeKernel(const std::vector<DirectionData<dim>> &directions,
                                  const std::vector<RowSegment> &segments, int n_particles,
                                  double shear_modulus, bool volumetric)
    : n_particles_(n_particles), volumetric_(volumetric),
      everything_(particles::AwakeRanges::of_all(n_particles))
{
  const int n = int(directions.size());
  auto &c = constants_;
  c.n_directions = n;
  core::require(n == 0 || n == dim || n == 3 * (dim - 1),
                "no kernel for a lattice with this number of directions");
  for (int k = 0; k < n; ++k)
    for (int a = 0; a < dim; ++a)
      c.normal[k][a] = directions[k].normal[a];
  if (n > 0) {
    const auto &d = directions[0];
    for (const auto &other : directions)
      core::require(std::abs(other.area - d.area) < 1e-12 * d.area &&
                        std::abs(other.distance - d.distance) < 1e-12 * d.distance,
                    "no kernel for a lattice with unequal faces");
    c.half = d.distance / 2;
    c.area_r = d.area / d.distance;
    c.shear = 2 * shear_modulus * c.area_r;
    c.bending = d.bending;
    c.twist = d.twist - d.bending;
    area_ = d.area;
  }
  if (dim == 2 && n == 3) { // the kernel combines the third normal of the others
    const Vector<dim> a = directions[0].normal, b = directions[1].normal, e = directions[2].normal;
    core::require(std::min((e - (b + a)).norm(), (e - (b - a)).norm()) < 1e-12,
                  "three directions in 2D must be those of a hexagonal lattice");
  }
  if (dim == 3 && n == 6) { // the kernel turns three normals and combines the others
    const auto &m = directions;
    const Vector<dim> a = m[0].normal, b = m[1].normal, e = m[5].normal;
    core::require((m[2].normal - (e - a - b)).norm() < 1e-12 &&
                      (m[3].normal - (e - b)).norm() < 1e-12 &&
                      (m[4].normal - (e - a)).norm() < 1e-12,
                  "six directions in 3D must be those of a face-centred cubic lattice");
  }
  for (const RowSegment &s : segments)
    for (int k = 0; k < n; ++k)
      reach_ = std::max({reach_, std::abs(s.forward[k]), std::abs(s.backward[k])});
  check_length(window_length_for(reach_), n_particles, RowWindow::wide);
}

template <int dim>
RowSweep<dim> LatticeKernel<dim>::sweep(const LatticeArrays<dim> &arrays,
                                        const std::vector<RowSegment> &segments,
                                        RowWindow &window) const
{
  return {arrays, constants_,  &segments, n_particles_, &everything_,
          reach_, volumetric_, false,     nullptr,      &window};
}

template <int dim>
void LatticeKernel<dim>::dilatation(const LatticeArrays<dim> &arrays,
                                    const std::vector<RowSegment> &segments, RowWindow &window,
                                    const InelasticSweep<dim> *inelastic) const
{
  if (constants_.n_directions == 0)
    return;
  RowSweep<dim> s = sweep(arrays, segments, window);
  s.inelastic = inelastic;
  s.volumetric = s.volumetric || inelastic;
  sweep_rows(s);
}

template <int dim>
long LatticeKernel<dim>::forces(const LatticeArrays<dim> &arrays,
                                const std::vector<RowSegment> &segments,
                                const BreakScreen &breaking, RowWindow &window,
                                std::vector<RowRange> &exceeded,
                                const particles::AwakeRanges *ranges, bool by_particle,
                                bool faces_too, const InelasticSweep<dim> *inelastic) const
{
  exceeded.clear();
  if (constants_.n_directions == 0)
    return 0;
  RowSweep<dim> s = sweep(arrays, segments, window);
  s.with_forces = true;
  if (ranges)
    s.ranges = ranges;
  const auto force = [&](double traction) {
    return traction > 0 ? traction * area_ : std::numeric_limits<double>::infinity();
  };
  const auto squared = [](double value) { return value * value; };
  s.constants.strength = force(breaking.strength);
  s.constants.tangent = breaking.tangent;
  s.constants.measure = breaking.measure;
  s.constants.limit2 = squared(force(breaking.least_traction()));
  s.exceeded = &exceeded;
  s.by_particle = by_particle && !ranges;
  s.faces_too = faces_too;
  s.inelastic = inelastic;
  s.volumetric = s.volumetric || inelastic;
  long n_looked = 0;
  s.n_looked = &n_looked;
  sweep_rows(s);
  return n_looked;
}

template <int dim>
void LatticeKernel<dim>::energies(const LatticeArrays<dim> &arrays,
                                  const std::vector<RowSegment> &segments, RowWindow &window,
                                  double *energy, const InelasticSweep<dim> *inelastic) const
{
  if (constants_.n_directions == 0)
    return;
  RowSweep<dim> s = sweep(arrays, segments, window);
  s.with_forces = true;
  s.energy = energy;
  s.inelastic = inelastic;
  s.volumetric = s.volumetric || inelastic;
  sweep_rows(s);
}

template class LatticeKernel<2>;
template class LatticeKernel<3>;
} // namespace ligament::dem
