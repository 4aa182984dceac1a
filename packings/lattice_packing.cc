#include "packings/lattice_packing.h"

#include "core/check.h"
#include "packings/clipped_cell.h"
#include "packings/periodic_sides.h"
#include "packings/row_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace ligament::packings
{
LatticeKind lattice_kind(const std::string &name)
{
  static const std::map<std::string, LatticeKind> kinds = {
      {"square", LatticeKind::square},
      {"hexagonal", LatticeKind::hexagonal},
      {"simple_cubic", LatticeKind::simple_cubic},
      {"fcc", LatticeKind::fcc}};
  const auto kind = kinds.find(name);
  core::require(kind != kinds.end(),
                "unknown packing \"" + name + "\": use square, hexagonal, simple_cubic or fcc");
  return kind->second;
}

namespace
{
template <int dim>
class Packer
{
public:
  explicit Packer(const LatticeParameters<dim> &parameters);
  Packing<dim> pack() { return pack(0, n_rows()); }
  /// The particles of rows [first, last), with the faces between them.
  Packing<dim> pack(int first, int last);
  /// The particles of the rows that rows_for(reach) says, a pair of first and one past the last,
  /// where no face is between particles farther apart than `reach` rows, but for those so small
  /// that only one of the two cells has them.
  template <typename RowsFor>
  Packing<dim> pack_window(RowsFor &&rows_for);
  /// Of those packed last, how many lie in rows before this one.
  int n_before(int row) const { return n_before_[row - first_packed_]; }

  int n_rows() const { return int(layout_->rows().size()); }
  std::int64_t n_particles(int row) const;
  /// At most so many rows lie between two particles that are no farther apart along any axis.
  int rows_within(double distance) const;

private:
  using Index = LatticeIndex<dim>;
  struct Cell
  {
    bool is_in_zone;
    std::optional<ClippedCell<dim>> clipped; // none: a whole one of the lattice
  };

  void place_particles(int first, int last);
  /// Of a point with a particle of the specimen, so far from its surface.
  Cell cell_at(const Index &k, double distance) const;
  bool has_particle(const Index &k) const;
  /// Most rows between lattice points that are no farther apart than this.
  int rows_between(double distance) const;
  /// Most rows between two of the particles packed last, or one and those beyond, with a common
  /// face.
  int rows_between_joined() const;
  void join_faces();

  bool has_all_neighbours(const Index &k) const;
  bool is_in_zone(const Vector<dim> &x, const Vector<dim> &lower, const Vector<dim> &upper) const;
  int particle_at(const Index &k) const;
  bool is_whole(int i) const { return irregular_of_[i] < 0; }
  void add_lattice_face(int i, int j, int direction);
  void add_irregular_faces(int i, const Index &k);

  const SpecimenShape<dim> shape_;
  const Lattice<dim> lattice_;
  const double tolerance_; // m
  const double thickness_;
  Vector<dim> zone_lower_, zone_upper_;
  std::array<std::array<bool, 2>, dim> coupled_;
  const core::BoxUnion<dim> parts_;

  std::optional<RowLayout<dim>> layout_;
  std::vector<std::vector<int>> particle_in_; // row, at its points; -1: no particle
  int first_packed_ = 0;
  int reach_ = 0;             // rows between the particles of a face, those packed till now
  std::vector<int> n_before_; // from that row on
  std::vector<int> irregular_of_;
  std::vector<ClippedCell<dim>> irregular_;
  Packing<dim> packing_;
};

template <int dim>
Packer<dim>::Packer(const LatticeParameters<dim> &p)
    : shape_(p), lattice_(p), tolerance_(1e-9 * p.spacing), thickness_(dim == 2 ? p.thickness : 1),
      parts_(p.zone_parts)
{
  for (int a = 0; a < dim; ++a) {
    coupled_[a] = {p.zone_lower[a] > p.lower[a] + tolerance_,
                   p.zone_upper[a] < p.upper[a] - tolerance_};
    zone_lower_[a] = std::max(p.zone_lower[a], p.lower[a]);
    zone_upper_[a] = std::min(p.zone_upper[a], p.upper[a]);
    core::require(zone_upper_[a] - zone_lower_[a] > p.spacing,
                  "the discrete zone holds no particles: move it into the specimen or widen it");
  }
  layout_.emplace(lattice_, zone_lower_, zone_upper_, p.small_layer);
  reach_ = rows_between(2 * p.spacing); // seldom surpassed
}

template <int dim>
bool Packer<dim>::has_all_neighbours(const Index &k) const
{
  const double d = lattice_.spacing;
  for (const LatticeNeighbour<dim> &n : lattice_.forward)
    if (!is_kept(shape_, lattice_.position(k + n.offset), d) ||
        !is_kept(shape_, lattice_.position(k - n.offset), d))
      return false;
  return true;
}

template <int dim>
bool Packer<dim>::is_in_zone(const Vector<dim> &x, const Vector<dim> &lower,
                             const Vector<dim> &upper) const
{
  for (int a = 0; a < dim; ++a)
    if ((coupled_[a][0] && x[a] + lower[a] < zone_lower_[a] - tolerance_) ||
        (coupled_[a][1] && x[a] + upper[a] > zone_upper_[a] + tolerance_))
      return false;
  return parts_.boxes.empty() || parts_.covers(x + lower, x + upper, tolerance_);
}

template <int dim>
std::int64_t Packer<dim>::n_particles(int row) const
{
  const auto &r = layout_->rows()[row];
  std::int64_t n = 0;
  for (int k = 0; k < r.n_points; ++k)
    n += has_particle(r.start + k * layout_->step());
  return n;
}

template <int dim>
int Packer<dim>::rows_between(double distance) const
{
  int most = 0;
  for (const LatticeNeighbour<dim> &n : lattice_.reachable)
    if (n.distance <= distance)
      most = std::max(most, std::abs(layout_->row_step(n.offset)));
  return most;
}

template <int dim>
int Packer<dim>::rows_between_joined() const
{
  int most = 0;
  for (const LatticeNeighbour<dim> &n : layout_->forward())
    most = std::max(most, layout_->row_step(n.offset));
  for (const ClippedCell<dim> &cell : irregular_)
    for (const auto &part : cell.parts)
      if (part.neighbour >= 0)
        most =
            std::max(most, std::abs(layout_->row_step(lattice_.reachable[part.neighbour].offset)));
  return most;
}

// How far apart rows lie is linear in the distance.
template <int dim>
int Packer<dim>::rows_within(double distance) const
{
  double rows = 0;
  for (int a = 0; a < dim; ++a) {
    const Vector<dim> k = lattice_.coordinates(distance * Vector<dim>::Unit(a)) -
                          lattice_.coordinates(Vector<dim>::Zero());
    double along = 0;
    for (int b = 0; b < dim; ++b)
      along += k[b] * layout_->row_step(Index::Unit(b));
    rows += std::abs(along);
  }
  return 1 + int(std::min(rows, double(n_rows()))); // one for round-off
}

template <int dim>
bool Packer<dim>::has_particle(const Index &k) const
{
  const double d = lattice_.spacing;
  const Vector<dim> x = lattice_.position(k), farthest = Vector<dim>::Constant(3 * d);
  if (!is_in_zone(x, Vector<dim>::Zero(), Vector<dim>::Zero()))
    return false;
  const double distance = shape_.distance(x);
  // Where the largest clipped cell is in the zone, all are.
  return distance >= clearance * d &&
         (is_in_zone(x, -farthest, farthest) || cell_at(k, distance).is_in_zone);
}

template <int dim>
auto Packer<dim>::cell_at(const Index &k, double distance) const -> Cell
{
  const double d = lattice_.spacing;
  const Vector<dim> &extent = lattice_.extent;
  const Vector<dim> x = lattice_.position(k);
  bool whole = distance > (clearance + 1) * d;
  if (!whole && has_all_neighbours(k)) {
    whole = ((x - extent - shape_.lower).array() > -1e-12 * d).all() &&
            ((shape_.upper - x - extent).array() > -1e-12 * d).all();
    if (shape_.solid)
      whole = whole && shape_.solid->distance(x, 4 * d) > lattice_.cell_radius;
    const double reach = lattice_.cell_radius + 0.1 * d;
    for (const int v : shape_.grid.within(x, reach))
      whole = whole && shape_.voids[v].distance(x) > reach;
  }
  if (whole)
    return {is_in_zone(x, -extent, extent), {}};
  ClippedCell<dim> cell(lattice_, shape_, k);
  return {is_in_zone(x, cell.lower, cell.upper), std::move(cell)};
}

template <int dim>
void Packer<dim>::place_particles(int first, int last)
{
  particle_in_.resize(n_rows());
  first_packed_ = first;
  n_before_ = {0};
  for (int r = first; r < last; ++r, n_before_.push_back(packing_.size())) {
    const auto &row = layout_->rows()[r];
    auto &particle = particle_in_[r];
    particle.assign(row.n_points, -1);
    bool in_run = false;
    for (int n = 0; n < row.n_points; ++n, in_run = particle[n - 1] >= 0) {
      const Index k = row.start + n * layout_->step();
      const Vector<dim> x = lattice_.position(k);
      // Where the centre is out of the zone, so is the cell.
      if (!is_in_zone(x, Vector<dim>::Zero(), Vector<dim>::Zero()))
        continue;
      const double distance = shape_.distance(x);
      if (distance < clearance * lattice_.spacing)
        continue;
      Cell cell = cell_at(k, distance);
      if (!cell.is_in_zone)
        continue;
      if (!cell.clipped) {
        irregular_of_.push_back(-1);
        packing_.volume.push_back(lattice_.cell_volume * thickness_);
      } else {
        irregular_of_.push_back(int(irregular_.size()));
        packing_.volume.push_back(cell.clipped->volume * thickness_);
        irregular_.push_back(std::move(*cell.clipped));
      }
      particle[n] = packing_.size() - 1;
      if (!in_run)
        packing_.row_begin.push_back(particle[n]);
      packing_.global_id.push_back(Lattice<dim>::global_id(k));
      for (int a = 0; a < dim; ++a)
        packing_.centre[a].push_back(x[a]);
    }
  }
  packing_.row_begin.push_back(packing_.size());
}

template <int dim>
int Packer<dim>::particle_at(const Index &k) const
{
  const auto [row, n] = layout_->place(k);
  return row < 0 || particle_in_[row].empty() ? -1 : particle_in_[row][n];
}

template <int dim>
void Packer<dim>::add_lattice_face(int i, int j, int direction)
{
  const LatticeDirection<dim> &n = packing_.directions[direction];
  const double q = n.distance / 2;
  packing_.faces.push_back({i, j, n.normal, n.area, q, q, q * n.normal, -q * n.normal,
                            is_whole(i) && is_whole(j) ? direction : -1, false});
}

template <int dim>
void Packer<dim>::add_irregular_faces(int i, const Index &k)
{
  const std::size_t first_face = packing_.faces.size();
  for (const auto &part : irregular_[irregular_of_[i]].parts) {
    const Vector<dim> lever = part.moment / part.area;
    if (part.neighbour < 0) {
      packing_.boundary_faces.push_back({i, part.normal, part.area * thickness_, part.distance,
                                         lever, part.boundary, part.corners});
      continue;
    }
    const LatticeNeighbour<dim> &n = lattice_.reachable[part.neighbour];
    const int j = particle_at(k + n.offset);
    if (j <= i || is_whole(j)) // those of whole cells are lattice faces
      continue;
    packing_.faces.push_back({i, j, n.direction, part.area * thickness_, n.distance / 2,
                              n.distance / 2, lever, lever - n.distance * n.direction, -1, false});
  }
  const auto &forward = layout_->forward();
  for (std::size_t m = 0; m < forward.size(); ++m)
    if (const int j = particle_at(k + forward[m].offset); j >= 0 && is_whole(j))
      add_lattice_face(i, j, int(m));
  std::sort(packing_.faces.begin() + first_face, packing_.faces.end(),
            [](const auto &a, const auto &b) { return a.j < b.j; });
}

template <int dim>
void Packer<dim>::join_faces()
{
  const auto &forward = layout_->forward();
  packing_.faces.reserve(packing_.size() * forward.size() + 8 * irregular_.size());
  for (std::size_t r = 0; r < particle_in_.size(); ++r)
    for (std::size_t n = 0; n < particle_in_[r].size(); ++n) {
      const int i = particle_in_[r][n];
      if (i < 0)
        continue;
      const Index k = layout_->rows()[r].start + int(n) * layout_->step();
      if (!is_whole(i))
        add_irregular_faces(i, k);
      else
        for (std::size_t m = 0; m < forward.size(); ++m)
          if (const int j = particle_at(k + forward[m].offset); j >= 0)
            add_lattice_face(i, j, int(m));
    }
}

template <int dim>
Packing<dim> Packer<dim>::pack(int first, int last)
{
  packing_ = {};
  packing_.spacing = lattice_.spacing;
  packing_.thickness = thickness_;
  for (const LatticeNeighbour<dim> &n : layout_->forward())
    packing_.directions.push_back({n.direction, n.distance, lattice_.face_area * thickness_});
  place_particles(first, last);
  core::require(packing_.size() > 0 || last - first < n_rows(),
                "the discrete zone holds no whole particle: widen it or make the spacing smaller");
  join_faces();
  reach_ = std::max(reach_, rows_between_joined());
  cut_faces(packing_, shape_.cracks);
  particle_in_.clear();
  irregular_of_ = {};
  irregular_ = {};
  return std::move(packing_);
}

template <int dim>
template <typename RowsFor>
Packing<dim> Packer<dim>::pack_window(RowsFor &&rows_for)
{
  for (;;) {
    const int reach = reach_;
    const auto [first, last] = rows_for(reach);
    Packing<dim> packing = pack(first, last);
    if (reach_ == reach)
      return packing;
  }
}

/// Adds particles [begin, end) of a piece of the same lattice, with the faces whose first particle
/// they are; what follows them in the piece is going to be added next.
template <int dim>
void append(Packing<dim> &packing, const Packing<dim> &piece, int begin, int end)
{
  const int shift = packing.size() - begin;
  const auto add = [&](auto &to, const auto &from) {
    if (!from.empty())
      to.insert(to.end(), from.begin() + begin, from.begin() + end);
  };
  for (int a = 0; a < dim; ++a)
    add(packing.centre[a], piece.centre[a]);
  add(packing.volume, piece.volume);
  add(packing.global_id, piece.global_id);
  for (const int run : piece.row_begin)
    if (begin <= run && run < end)
      packing.row_begin.push_back(run + shift);
  for (Face<dim> face : piece.faces)
    if (begin <= face.i && face.i < end) {
      face.i += shift;
      face.j += shift;
      packing.faces.push_back(face);
    }
  for (BoundaryFace<dim> face : piece.boundary_faces)
    if (begin <= face.i && face.i < end) {
      face.i += shift;
      packing.boundary_faces.push_back(std::move(face));
    }
}

template <int dim>
void require_no_joined_sides(const LatticeParameters<dim> &parameters)
{
  core::require(!PeriodicBox<dim>(parameters).is_any(), "joined sides are packed in one process");
}
} // namespace

template <int dim>
Packing<dim> make_lattice_packing(const LatticeParameters<dim> &parameters)
{
  PeriodicBox<dim> box(parameters);
  if (!box.is_any())
    return Packer<dim>(parameters).pack();
  fit_period(parameters, box);
  LatticeParameters<dim> wide = parameters;
  static_cast<SpecimenParameters<dim> &>(wide) = widened(parameters, box, parameters.spacing);
  const Lattice<dim> lattice(parameters);
  // The names of a point and of its image differ by the same number everywhere.
  std::array<std::int64_t, dim> step{};
  for (int a = 0; a < dim; ++a) {
    const Vector<dim> k = lattice.coordinates(box.period[a] * Vector<dim>::Unit(a)) -
                          lattice.coordinates(Vector<dim>::Zero());
    step[a] = Lattice<dim>::global_id(k.array().round().template cast<int>()) -
              Lattice<dim>::global_id(LatticeIndex<dim>::Zero());
  }
  const Packing<dim> packing = Packer<dim>(wide).pack();
  return folded<dim>(packing, box, [&](int i) {
    ImageOf<dim> of{packing.global_id[i],
                    box.image(get(packing.centre, i), 1e-6 * parameters.spacing)};
    for (int a = 0; a < dim; ++a)
      of.id -= of.image[a] * step[a];
    return of;
  });
}

template <int dim>
PackingPart<dim> make_lattice_part(const LatticeParameters<dim> &parameters,
                                   const core::Ranks &ranks, int rings, const Groups<dim> &groups,
                                   const std::vector<std::int64_t> &weights)
{
  require_no_joined_sides(parameters);
  Packer<dim> packer(parameters);
  // Each rank counts some of the rows.
  const int n_rows = packer.n_rows();
  const auto share = [&](int rank) { return int(std::int64_t(n_rows) * rank / ranks.size()); };
  std::vector<std::int64_t> counts;
  for (int row = share(ranks.rank()); row < share(ranks.rank() + 1); ++row)
    counts.push_back(packer.n_particles(row));
  counts = ranks.gather_all(counts);
  std::vector<std::int64_t> begin(n_rows + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), begin.begin() + 1);
  core::require(begin.back() > 0, "the discrete zone holds no whole particle: widen it or make the "
                                  "spacing smaller");
  const auto partition = particles::make_partition(begin.back(), ranks.size(), weights);
  const auto row_of = [&](std::int64_t place) {
    return int(std::upper_bound(begin.begin(), begin.end(), place) - begin.begin()) - 1;
  };
  const std::int64_t own = partition.begin(ranks.rank()), end = partition.end(ranks.rank());
  // Groups of its own particles, rings around these, and one more for faces that only one cell has.
  const int of_groups = groups.of ? packer.rows_within(groups.reach) : 0;
  int first = 0, last = 0;
  Packing<dim> window = packer.pack_window([&](int reach) {
    const int margin = of_groups + (rings + 1) * reach;
    first = std::clamp(row_of(own) - margin, 0, n_rows);
    last = own < end ? std::clamp(row_of(end - 1) + margin + 1, 0, n_rows) : first;
    return std::pair(first, last);
  });
  core::require(window.size() == begin[last] - begin[first],
                "rows hold another number of particles than was counted");
  return part_of(std::move(window), partition, ranks.rank(), rings, begin[first], groups);
}

template <int dim>
Packing<dim> make_grouped_lattice(const LatticeParameters<dim> &parameters, int n_windows,
                                  const Groups<dim> &groups, int rings)
{
  require_no_joined_sides(parameters);
  core::require(n_windows > 0, "a lattice is made from at least one window of rows");
  Packer<dim> packer(parameters);
  const int n_rows = packer.n_rows();
  Packing<dim> all;
  for (int w = 0; w < n_windows; ++w) {
    const auto row = [&](int window) { return int(std::int64_t(n_rows) * window / n_windows); };
    // Beyond a window lie the second particles of its faces, beyond these their rings; one more for
    // faces that only one cell has.
    Packing<dim> piece = packer.pack_window([&](int reach) {
      return std::pair(std::max(row(w) - (rings + 1) * reach, 0),
                       std::min(row(w + 1) + (rings + 2) * reach, n_rows));
    });
    const std::vector<int> places = grouped_places(piece, groups, rings);
    const auto n_kept_before = [&](int r) {
      return int(std::lower_bound(places.begin(), places.end(), packer.n_before(r)) -
                 places.begin());
    };
    piece = those_at(places, std::move(piece));
    if (w == 0) {
      all.spacing = piece.spacing;
      all.thickness = piece.thickness;
      all.directions = piece.directions;
      all.cuts = piece.cuts;
      all.whole = piece.whole;
    }
    append(all, piece, n_kept_before(row(w)), n_kept_before(row(w + 1)));
  }
  all.row_begin.push_back(all.size());
  return all;
}

template Packing<2> make_lattice_packing(const LatticeParameters<2> &);
template Packing<3> make_lattice_packing(const LatticeParameters<3> &);
template PackingPart<2> make_lattice_part(const LatticeParameters<2> &, const core::Ranks &, int,
                                          const Groups<2> &, const std::vector<std::int64_t> &);
template PackingPart<3> make_lattice_part(const LatticeParameters<3> &, const core::Ranks &, int,
                                          const Groups<3> &, const std::vector<std::int64_t> &);
template Packing<2> make_grouped_lattice(const LatticeParameters<2> &, int, const Groups<2> &, int);
template Packing<3> make_grouped_lattice(const LatticeParameters<3> &, int, const Groups<3> &, int);
} // namespace ligament::packings
