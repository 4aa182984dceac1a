#include "packings/periodic_sides.h"

#include "core/check.h"
#include "packings/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace ligament::packings
{
namespace
{
// In sizes of a particle: neighbours of a cell lie within the first, what bounds those within both.
constexpr double packed_margin = 6, margin = 14;
constexpr double fewest_spacings = 6; // of a period: no particle meets two images of another
constexpr double crack_distance = 2;

template <int dim>
bool is_own(const std::array<int, dim> &image)
{
  return std::all_of(image.begin(), image.end(), [](int n) { return n == 0; });
}
} // namespace

double margin_of(double largest_size)
{
  return margin * largest_size;
}

template <int dim>
PeriodicBox<dim>::PeriodicBox(const SpecimenParameters<dim> &p) : lower(p.lower)
{
  for (int a = 0; a < dim; ++a) {
    if (!p.periodic[a])
      continue;
    const double tolerance = 1e-9 * p.spacing;
    const bool low = p.zone_lower[a] <= p.lower[a] + tolerance,
               high = p.zone_upper[a] >= p.upper[a] - tolerance;
    core::require(low == high, fmt::format("the discrete zone reaches one of the two sides that "
                                           "are joined along {}; let it reach both, or none",
                                           "xyz"[a]));
    if (!low)
      continue;
    core::require(!p.solid, "a body with an outline of its own does not repeat itself; give a box "
                            "with holes and notches");
    for (const auto &points : p.cracks)
      for (const Vector<dim> &x : points)
        core::require(x[a] >= p.lower[a] + crack_distance * p.spacing &&
                          x[a] <= p.upper[a] - crack_distance * p.spacing,
                      fmt::format("a crack comes nearer than {} spacings to the sides that are "
                                  "joined along {}; shift the whole body along {}: where its sides "
                                  "lie makes no difference",
                                  crack_distance, "xyz"[a], "xyz"[a]));
    period[a] = p.upper[a] - p.lower[a];
    core::require(period[a] >= fewest_spacings * p.spacing * (1 - 1e-9),
                  fmt::format("the specimen is less than {} spacings wide along its periodic axis "
                              "{}, so that particles meet their own images; make it wider or the "
                              "spacing smaller",
                              fewest_spacings, "xyz"[a]));
  }
}

template <int dim>
std::array<int, dim> PeriodicBox<dim>::image(const Vector<dim> &x, double tolerance) const
{
  std::array<int, dim> n{};
  for (int a = 0; a < dim; ++a)
    if (period[a] > 0)
      n[a] = int(std::floor((x[a] - lower[a] + tolerance) / period[a]));
  return n;
}

template <int dim>
Vector<dim> PeriodicBox<dim>::offset(const std::array<int, dim> &n) const
{
  Vector<dim> x;
  for (int a = 0; a < dim; ++a)
    x[a] = n[a] * period[a];
  return x;
}

template <int dim>
void PeriodicBox<dim>::for_each_image(
    double reach, const std::function<void(const std::array<int, dim> &)> &visit) const
{
  std::array<int, dim> most{}, n;
  for (int a = 0; a < dim; ++a)
    most[a] = period[a] > 0 ? int(std::ceil(reach / period[a])) : 0;
  for (int a = 0; a < dim; ++a)
    n[a] = -most[a];
  while (n[dim - 1] <= most[dim - 1]) {
    if (!is_own<dim>(n))
      visit(n);
    for (int a = 0; a < dim; ++a) {
      if (++n[a] <= most[a] || a == dim - 1)
        break;
      n[a] = -most[a];
    }
  }
}

template <int dim>
Seeds<dim> PeriodicBox<dim>::with_images(const Seeds<dim> &seeds, double reach) const
{
  Seeds<dim> all;
  for (int i = 0; i < seeds.size(); ++i)
    all.add(seeds.centre[i], seeds.radius[i], i);
  std::int64_t k = 0;
  for_each_image(reach, [&](const std::array<int, dim> &n) {
    ++k;
    for (int i = 0; i < seeds.size(); ++i) {
      const Vector<dim> x = seeds.centre[i] + offset(n);
      bool near = true;
      for (int a = 0; a < dim; ++a)
        near = near &&
               (period[a] == 0 || (x[a] > lower[a] - reach && x[a] < lower[a] + period[a] + reach));
      if (near)
        all.add(x, seeds.radius[i], k * seeds.size() + i);
    }
  });
  return all;
}

template <int dim>
void fit_period(const LatticeParameters<dim> &p, PeriodicBox<dim> &box)
{
  const Lattice<dim> lattice(p);
  const double d = p.spacing;
  for (int a = 0; a < dim; ++a) {
    if (box.period[a] == 0)
      continue;
    const Vector<dim> per_metre =
        lattice.coordinates(Vector<dim>::Unit(a)) - lattice.coordinates(Vector<dim>::Zero());
    // The smallest lattice vector along the axis.
    constexpr int most = 1000;
    double repeat = 0;
    for (int q = 1; q <= most && repeat == 0; ++q) {
      const double length = q / per_metre.cwiseAbs().maxCoeff();
      const Vector<dim> k = length * per_metre;
      if ((k - Vector<dim>(k.array().round())).norm() < 1e-9 * q)
        repeat = length;
    }
    core::require(repeat > 0 && repeat <= box.period[a] * 1.5,
                  fmt::format("the lattice does not repeat itself along {} within the width of the "
                              "specimen: give it another orientation",
                              "xyz"[a]));
    const double n = std::round(box.period[a] / repeat);
    const double below = std::floor(box.period[a] / repeat), above = below + 1;
    core::require(
        std::abs(box.period[a] - n * repeat) < 1e-4 * d,
        fmt::format("the lattice repeats itself along {} after {:.10g} m, which does not fit into "
                    "the width of {:.10g} m: give {}{:.10g} m",
                    "xyz"[a], repeat, box.period[a],
                    below > 0 ? fmt::format("{:.10g} m or ", below * repeat) : "", above * repeat));
    // About the same centre: the lattice is anchored there.
    box.lower[a] += (box.period[a] - n * repeat) / 2;
    box.period[a] = n * repeat;
  }
}

template <int dim>
SpecimenParameters<dim> widened(const SpecimenParameters<dim> &p, const PeriodicBox<dim> &box,
                                double size)
{
  SpecimenParameters<dim> wide = p;
  wide.periodic = {};
  for (int a = 0; a < dim; ++a)
    if (box.period[a] > 0) {
      wide.lower[a] = box.lower[a] - margin * size;
      wide.upper[a] = box.lower[a] + box.period[a] + margin * size;
      wide.zone_lower[a] = box.lower[a] - packed_margin * size;
      wide.zone_upper[a] = box.lower[a] + box.period[a] + packed_margin * size;
    }
  const auto meets = [&](const Vector<dim> &lower, const Vector<dim> &upper) {
    return (upper.array() > wide.lower.array()).all() && (lower.array() < wide.upper.array()).all();
  };
  // Holes may reach out of the box: one image more than the margin meets.
  box.for_each_image(margin * size + box.period.maxCoeff(), [&](const std::array<int, dim> &n) {
    const Vector<dim> x = box.offset(n);
    for (const auto &hole : p.holes) {
      const Vector<dim> centre = hole.centre + x, r = Vector<dim>::Constant(hole.radius);
      if (meets(centre - r, centre + r))
        wide.holes.push_back({centre, hole.radius});
    }
    for (const auto &notch : p.notches)
      if (meets(notch.lower + x, notch.upper + x))
        wide.notches.push_back({notch.lower + x, notch.upper + x});
  });
  return wide;
}

template <int dim>
Packing<dim> folded(const Packing<dim> &wide, const PeriodicBox<dim> &box,
                    const std::function<ImageOf<dim>(int)> &image_of)
{
  Packing<dim> p;
  p.spacing = wide.spacing;
  p.thickness = wide.thickness;
  p.directions = wide.directions;
  p.cuts = wide.cuts;
  p.period = box.period;
  std::vector<int> own(wide.size(), -1);
  std::vector<ImageOf<dim>> images;
  std::unordered_map<std::int64_t, int> index_of;
  std::size_t row = 0;
  for (int i = 0, last = -2; i < wide.size(); ++i) {
    images.push_back(image_of(i));
    if (!is_own<dim>(images[i].image))
      continue;
    bool begins_row = last != i - 1;
    for (; row < wide.row_begin.size() && wide.row_begin[row] <= i; ++row)
      begins_row = begins_row || wide.row_begin[row] == i;
    own[i] = index_of[images[i].id] = p.size();
    if (begins_row && !wide.row_begin.empty())
      p.row_begin.push_back(p.size());
    last = i;
    p.volume.push_back(wide.volume[i]);
    p.global_id.push_back(images[i].id);
    if (!wide.diameter.empty())
      p.diameter.push_back(wide.diameter[i]);
    for (int a = 0; a < dim; ++a)
      p.centre[a].push_back(wide.centre[a][i]);
  }
  if (!wide.row_begin.empty())
    p.row_begin.push_back(p.size());

  const auto add = [&](Face<dim> face) {
    const bool turn = own[face.i] < 0 || (own[face.j] >= 0 && own[face.j] < own[face.i]);
    if (turn) {
      std::swap(face.i, face.j);
      std::swap(face.q_i, face.q_j);
      std::swap(face.lever_i, face.lever_j);
      face.normal = -face.normal;
    }
    const auto twin = index_of.find(images[face.j].id);
    core::require(twin != index_of.end(), "the particles beside two joined sides differ");
    face.image = images[face.j].image;
    face.i = own[face.i];
    face.j = twin->second;
    if (!is_own<dim>(face.image)) {
      if (face.j <= face.i) // its other side sees it, too
        return;
      core::require(!face.cracked, "a crack runs through a side that is joined to another one; "
                                   "keep it within the specimen");
      face.direction = -1;
    }
    p.faces.push_back(face);
  };
  for (const auto &face : wide.faces)
    if (own[face.i] >= 0 || own[face.j] >= 0)
      add(face);
  std::stable_sort(p.faces.begin(), p.faces.end(), [](const auto &a, const auto &b) {
    return std::pair(a.i, a.j) < std::pair(b.i, b.j);
  });
  for (std::size_t f = 1; f < p.faces.size(); ++f)
    core::require(
        p.faces[f].i != p.faces[f - 1].i || p.faces[f].j != p.faces[f - 1].j,
        "the specimen is so narrow along a periodic axis that a particle meets two images "
        "of another; make it wider or the spacing smaller");
  for (auto face : wide.boundary_faces)
    if (own[face.i] >= 0) {
      face.i = own[face.i];
      p.boundary_faces.push_back(face);
    }
  return p;
}

template struct PeriodicBox<2>;
template struct PeriodicBox<3>;
template void fit_period(const LatticeParameters<2> &, PeriodicBox<2> &);
template void fit_period(const LatticeParameters<3> &, PeriodicBox<3> &);
template SpecimenParameters<2> widened(const SpecimenParameters<2> &, const PeriodicBox<2> &,
                                       double);
template SpecimenParameters<3> widened(const SpecimenParameters<3> &, const PeriodicBox<3> &,
                                       double);
template Packing<2> folded(const Packing<2> &, const PeriodicBox<2> &,
                           const std::function<ImageOf<2>(int)> &);
template Packing<3> folded(const Packing<3> &, const PeriodicBox<3> &,
                           const std::function<ImageOf<3>(int)> &);
} // namespace ligament::packings
