#include "md/neighbour_list.h"

#include "core/check.h"
#include "md/cell_grid.h"
#include "md/neighbour_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ligament::md
{
namespace
{
using Triple = std::array<int, 3>;

constexpr int padding = 16; // lanes of a vector of floats
} // namespace

/// Places in the order of their cells as floats from the corner of the grid, over the reach.
struct NeighbourList::Cells
{
  std::vector<float> x, y, z;
  std::vector<int> begin; // of each cell

  Cells(const CellGrid &grid, const AtomRecord *places, int n, double unit)
      : x(n + padding), y(n + padding), z(n + padding), begin(grid.n_cells() + 1, 0)
  {
    for (int k = 0; k < n; ++k) {
      x[k] = float((places[k].x - grid.lower[0]) / unit);
      y[k] = float((places[k].y - grid.lower[1]) / unit);
      z[k] = float((places[k].z - grid.lower[2]) / unit);
      ++begin[grid.number(grid.cell_of(places[k])) + 1];
    }
    for (int c = 0; c < grid.n_cells(); ++c)
      begin[c + 1] += begin[c];
  }
};

template <int dim>
NeighbourList::NeighbourList(double cutoff, double skin, const Vector<dim> &period)
    : cutoff_(cutoff), skin_(skin)
{
  core::require(cutoff > 0 && skin >= 0, "a neighbour list needs a cut-off above 0, and a skin");
  for (int c = 0; c < dim; ++c) {
    core::require(period[c] >= 0, "periods are lengths: they must not be below 0");
    period_[c] = period[c];
  }
}

AtomRecord NeighbourList::moved(const AtomRecord &place, const Triple &periods) const
{
  AtomRecord r = place;
  for (int c = 0; c < 3; ++c)
    component(r)[c] += periods[c] * period_[c];
  return r;
}

void NeighbourList::set_image_records()
{
  for (int k = 0; k < n_images(); ++k)
    records_[n_atoms() + k] = moved(records_[images_[k].slot], images_[k].periods);
}

template <int dim>
bool NeighbourList::update(const Components<dim> &reference, const Components<dim> &displacement)
{
  if (place<dim>(reference, displacement))
    return false;
  build<dim>(reference, displacement);
  return true;
}

template <int dim>
bool NeighbourList::place(const Components<dim> &reference, const Components<dim> &displacement)
{
  if (n_atoms() != int(reference[0].size()))
    return false;
  bool is_near = true;
  for (int s = 0; s < n_atoms(); ++s) {
    AtomRecord now;
    double way2 = 0;
    for (int c = 0; c < dim; ++c) {
      const double x =
          reference[c][order_[s]] + displacement[c][order_[s]] + wrap_[s][c] * period_[c];
      component(now)[c] = x;
      way2 += (x - component(built_[s])[c]) * (x - component(built_[s])[c]);
    }
    records_[s] = now;
    is_near = is_near && way2 <= skin_ * skin_ / 4; // not so of what is no number
  }
  if (is_near)
    set_image_records();
  return is_near;
}

template <int dim>
void NeighbourList::build(const Components<dim> &reference, const Components<dim> &displacement)
{
  std::vector<AtomRecord> places(reference[0].size());
  for (std::size_t i = 0; i < places.size(); ++i)
    for (int c = 0; c < dim; ++c) {
      component(places[i])[c] = reference[c][i] + displacement[c][i];
      core::require<core::GuardStop>(std::isfinite(component(places[i])[c]),
                                     "an atom has no finite place any more: the step is too large "
                                     "or atoms overlap; use a smaller step");
    }
  build_from(places);
}

void NeighbourList::build_from(const std::vector<AtomRecord> &places)
{
  ++n_builds_;
  const double reach = cutoff_ + skin_;
  const int n = int(places.size());
  std::vector<AtomRecord> atoms(n);
  std::vector<Triple> wrap(n, Triple{});
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c)
      if (period_[c] > 0)
        wrap[i][c] = -int(std::floor(component(places[i])[c] / period_[c]));
    atoms[i] = moved(places[i], wrap[i]);
  }
  std::vector<Image> images = make_images(atoms, reach);
  std::vector<AtomRecord> all = atoms, image_places;
  for (const Image &image : images)
    image_places.push_back(moved(atoms[image.slot], image.periods));
  all.insert(all.end(), image_places.begin(), image_places.end());
  const CellGrid grid(all, reach);

  order_ = grid.order(atoms);
  wrap_.resize(n);
  records_.resize(n + images.size());
  std::vector<int> slot(n);
  for (int s = 0; s < n; ++s) {
    records_[s] = atoms[order_[s]];
    wrap_[s] = wrap[order_[s]];
    slot[order_[s]] = s;
  }
  built_.assign(records_.begin(), records_.begin() + n);
  images_.clear();
  for (const int k : grid.order(image_places))
    images_.push_back({slot[images[k].slot], images[k].periods});
  set_image_records();
  find_pairs(grid, reach);
}

// Those within reach of the atoms, by steps of periods whose last one that is not 0 is above 0.
std::vector<NeighbourList::Image> NeighbourList::make_images(const std::vector<AtomRecord> &atoms,
                                                             double reach) const
{
  std::array<double, 3> lower, upper;
  find_extent(atoms, lower, upper);
  Triple most = {};
  for (int c = 0; c < 3; ++c)
    most[c] = period_[c] > 0 ? int(reach / period_[c]) + 1 : 0;
  std::vector<Image> images;
  for (int z = 0; z <= most[2]; ++z)
    for (int y = z > 0 ? -most[1] : 0; y <= most[1]; ++y)
      for (int x = z > 0 || y > 0 ? -most[0] : 1; x <= most[0]; ++x)
        for (int i = 0; i < int(atoms.size()); ++i) {
          const AtomRecord place = moved(atoms[i], {x, y, z});
          bool is_near = true;
          for (int c = 0; c < 3; ++c)
            is_near = is_near && component(place)[c] > lower[c] - reach &&
                      component(place)[c] < upper[c] + reach;
          if (is_near)
            images.push_back({i, {x, y, z}});
        }
  return images;
}

// Of atoms those in later slots: the rest of the own row of cells, and the rows behind it.
void NeighbourList::find_pairs(const CellGrid &grid, double reach)
{
  const int n = n_atoms();
  // The reach as unit keeps squares of floats in range.
  const Cells atoms(grid, records_.data(), n, reach),
      images(grid, records_.data() + n, n_images(), reach);
  double extent = 0;
  for (int c = 0; c < 3; ++c)
    extent = std::max(extent, grid.n[c] * grid.edge / reach);
  const FindNear find = find_near();
  int n_found = 0;
  float x = 0, y = 0, z = 0, widened = 1;
  const auto search = [&](const Cells &cells, int from, int to) {
    if (from >= to)
      return;
    if (neighbour_.size() < std::size_t(n_found) + (to - from) + padding)
      neighbour_.resize(2 * neighbour_.size() + (to - from) + padding);
    n_found += find({cells.x.data(), cells.y.data(), cells.z.data()}, from, to, x, y, z,
                    widened * widened, neighbour_.data() + n_found);
  };
  const int span = int(std::ceil(reach / grid.edge));
  begin_.assign(1, 0);
  for (int s = 0; s < n; ++s) {
    const Triple cell = grid.cell_of(records_[s]);
    Triple from, to;
    for (int c = 0; c < 3; ++c) {
      from[c] = std::max(cell[c] - span, 0);
      to[c] = std::min(cell[c] + span, grid.n[c] - 1);
    }
    x = atoms.x[s], y = atoms.y[s], z = atoms.z[s];
    // Places beyond the grid know theirs less well.
    const double far = std::max({std::abs(x), std::abs(y), std::abs(z)});
    widened = float(1 + 4 * std::max(extent, far) * std::numeric_limits<float>::epsilon());
    const int own = grid.number({0, cell[1], cell[2]});
    for (int kz = cell[2]; kz <= to[2]; ++kz)
      for (int ky = kz == cell[2] ? cell[1] : from[1]; ky <= to[1]; ++ky) {
        const int row = grid.number({0, ky, kz});
        search(atoms, row == own ? s + 1 : atoms.begin[row + from[0]],
               atoms.begin[row + to[0] + 1]);
      }
    const int first_image = n_found;
    for (int kz = from[2]; kz <= to[2] && n_images() > 0; ++kz)
      for (int ky = from[1]; ky <= to[1]; ++ky) {
        const int row = grid.number({0, ky, kz});
        search(images, images.begin[row + from[0]], images.begin[row + to[0] + 1]);
      }
    for (int k = first_image; k < n_found; ++k)
      neighbour_[k] += n;
    begin_.push_back(n_found);
  }
  neighbour_.resize(n_found);
  neighbour_.resize(n_found + padding, 0); // what vectors may load
}

#define INSTANTIATE(dim)                                                                           \
  template NeighbourList::NeighbourList(double, double, const Vector<dim> &);                      \
  template bool NeighbourList::update<dim>(const Components<dim> &, const Components<dim> &);      \
  template bool NeighbourList::place<dim>(const Components<dim> &, const Components<dim> &);       \
  template void NeighbourList::build<dim>(const Components<dim> &, const Components<dim> &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace ligament::md
