#include "dem/contact_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <unordered_map>

namespace ligament::dem
{
namespace
{
/// Things in space, found by where they are.
template <int dim, typename Thing>
class Cells
{
public:
  explicit Cells(double size) : size_(size) {}

  void add(const Vector<dim> &place, const Thing &thing)
  {
    cells_[key(cell_of(place))].push_back({place, thing});
  }

  /// visit(place, thing) of all that are nearer than `size` to this place, and of others; may visit
  /// one twice.
  template <typename Visit>
  void for_each_near(const Vector<dim> &place, Visit &&visit) const
  {
    constexpr int n = dim == 2 ? 9 : 27;
    const Cell home = cell_of(place);
    for (int m = 0; m < n; ++m) {
      Cell c = home;
      for (int a = 0, rest = m; a < dim; ++a, rest /= 3)
        c[a] += rest % 3 - 1;
      if (const auto found = cells_.find(key(c)); found != cells_.end())
        for (const auto &[where, thing] : found->second)
          visit(where, thing);
    }
  }

private:
  using Cell = std::array<std::int64_t, dim>;

  Cell cell_of(const Vector<dim> &place) const
  {
    Cell c;
    for (int a = 0; a < dim; ++a)
      c[a] = std::int64_t(std::floor(place[a] / size_));
    return c;
  }

  /// Mixes the integer coordinates; two cells may share one.
  static std::uint64_t key(const Cell &c)
  {
    std::uint64_t mixed = 0;
    for (const auto v : c)
      mixed = (mixed ^ std::uint64_t(v)) * 0x9e3779b97f4a7c15ull;
    return mixed;
  }

  double size_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<Vector<dim>, Thing>>> cells_;
};
} // namespace

template <int dim>
ContactSearch<dim>::ContactSearch(const packings::Packing<dim> &packing, double face_area,
                                  const PeriodicImages<dim> *images)
    : images_(images), flanks_(packing), spacing_(packing.spacing), skin_(packing.spacing / 4),
      face_area_(face_area), largest_(packings::largest_diameter(packing)),
      diameter_(packing.diameter), on_surface_(packing.size(), 0)
{
  searched_jumps_.fill(Vector<dim>::Zero());
  for (const auto &face : packing.boundary_faces) {
    add_surface_particle(face.i);
    may_meet_ = may_meet_ || face.boundary >= inner_surface<dim>;
  }
  for (const auto &face : packing.faces)
    if (face.cracked)
      add_surface_particle(face.i), add_surface_particle(face.j);
}

template <int dim>
void ContactSearch<dim>::add_surface_particle(int i)
{
  if (on_surface_[i])
    return;
  add_seen(i);
  due_ = due_ || is_own(i); // else its owner says so
}

template <int dim>
void ContactSearch<dim>::add_seen(int i)
{
  on_surface_[i] = 1;
  surface_.push_back(i);
}

template <int dim>
double ContactSearch<dim>::rest_distance(const Particles &p, int i, const Partner &partner) const
{
  const auto &[j, image] = partner;
  Vector<dim> r = get(p.reference, i) - get(p.reference, j);
  if (image)
    r -= image->offset;
  return std::min((diameter(i) + diameter(j)) / 2, r.norm());
}

template <int dim>
Vector<dim> ContactSearch<dim>::place_of(const Particles &p, const Partner &partner)
{
  const auto &[j, image] = partner;
  Vector<dim> x = get(p.reference, j) + get(p.displacement, j);
  if (image)
    x += image->offset + image->jump;
  return x;
}

template <int dim>
bool ContactSearch<dim>::has_moved(const Particles &p) const
{
  // An image has moved by that of its particle and its jump.
  double jumped = 0;
  const auto now = jumps();
  for (int a = 0; a < dim; ++a)
    jumped += (now[a] - searched_jumps_[a]).norm();
  const double skin = std::max(skin_ - jumped / 2, 0.);
  for (std::size_t s = 0; s < searched_at_.size(); ++s)
    if ((get(p.displacement, surface_[s]) - searched_at_[s]).squaredNorm() > skin * skin &&
        is_own(surface_[s]))
      return true;
  return !searched_at_.empty() && skin == 0;
}

template <int dim>
std::array<Vector<dim>, dim> ContactSearch<dim>::jumps() const
{
  return images_ ? images_->jumps() : searched_jumps_;
}

template <int dim>
void ContactSearch<dim>::update(Particles &p, const BondNetwork<dim> &bonds,
                                Contacts<dim> &contacts)
{
  if (!due_) {
    due_ = has_moved(p);
    return;
  }
  due_ = false;
  if (guests_)
    meet_others(p, contacts);
  searched_at_.clear();
  for (const int i : surface_)
    searched_at_.push_back(get(p.displacement, i));
  searched_jumps_ = jumps();
  const double reach = largest_ + 2 * skin_;
  contacts.drop_distant(p, reach);
  flanks_.leave_where_turned(p, contacts);
  if (guests_)
    pass_on_joints(p, contacts);
  else
    flanks_.pass_on_joints(p, contacts);
  flanks_.find_joined(p, contacts);

  Cells<dim, Partner> cells(reach);
  for (const int i : surface_)
    cells.add(place_of(p, {i, nullptr}), {i, nullptr});
  // No two images of a particle are near the same one: pairs are known by their particles alone.
  if (images_)
    images_->for_each([&](const PeriodicImage<dim> *image) {
      for (const int i : surface_)
        cells.add(place_of(p, {i, image}), {i, image});
    });

  const auto key = [](int i, int j) { return std::pair<int, int>(std::min(i, j), std::max(i, j)); };
  std::vector<std::pair<int, int>> touching;
  for (const auto &c : contacts.all())
    touching.push_back(key(c.face.i, c.face.j));
  std::sort(touching.begin(), touching.end());
  const auto are_bonded = [&](int i, int j) {
    bool found = false;
    const int bearing = i < bonds.n_particles() ? i : j; // guests have no bonds
    if (bearing < bonds.n_particles())
      bonds.for_each_bond_of(bearing, [&](BondId, const Bond<dim> &b) {
        found = found || key(b.i, b.j) == key(i, j);
      });
    return found;
  };

  struct Pair
  {
    int i;
    Partner j;
  };
  std::vector<Pair> found;
  for (const int i : surface_) {
    const Vector<dim> x = place_of(p, {i, nullptr});
    const std::int64_t name = p.global_id[i];
    cells.for_each_near(x, [&](const Vector<dim> &place, const Partner &other) {
      const int j = other.particle;
      const double apart = (place - x).norm();
      // The distance of rest is no more than that of the sizes, which passes over most at once.
      if (apart < (diameter(i) + diameter(j)) / 2 + 2 * skin_ && name < p.global_id[j] &&
          apart < rest_distance(p, i, other) + 2 * skin_ && (!guests_ || guests_->keeps(i, j)) &&
          !std::binary_search(touching.begin(), touching.end(), key(i, j)) && !are_bonded(i, j) &&
          !flanks_.face_each_other(i, j))
        found.push_back({i, other});
    });
  }
  const auto names = [&](const Pair &pair) {
    return std::pair(p.global_id[pair.i], p.global_id[pair.j.particle]);
  };
  std::stable_sort(found.begin(), found.end(),
                   [&](const Pair &a, const Pair &b) { return names(a) < names(b); });
  found.erase(std::unique(found.begin(), found.end(),
                          [&](const Pair &a, const Pair &b) { return names(a) == names(b); }),
              found.end());
  for (const auto &[i, other] : found) {
    const double apart = (place_of(p, other) - place_of(p, {i, nullptr})).norm();
    contacts.add(
        face_between(i, other.particle, std::min(rest_distance(p, i, other), apart), other.image),
        false);
  }
  contacts.settle();
}

template <int dim>
Bond<dim> ContactSearch<dim>::face_between(int i, int j, double distance,
                                           const PeriodicImage<dim> *image) const
{
  const double size = (diameter(i) + diameter(j)) / 2;
  const Vector<dim> n = Vector<dim>::Unit(0), lever = distance * diameter(i) / (2 * size) * n;
  Bond<dim> face{
      i,        j, n, lever, lever - distance * n, face_area_ * std::pow(size / spacing_, dim - 1),
      distance, 0, 0};
  face.image = image;
  return face;
}

namespace
{
/// Of component c of the jump along axis a.
std::string column(int a, int c)
{
  return std::to_string(a) + "_" + std::to_string(c);
}
} // namespace

template <int dim>
void ContactSearch<dim>::save(core::State &state, const core::Names &names) const
{
  std::map<std::int64_t, Vector<dim>> places;
  for (std::size_t s = 0; s < searched_at_.size(); ++s)
    places[names.name(surface_[s])] = searched_at_[s];
  std::vector<std::int64_t> keys;
  Components<dim> displacement;
  for (const auto &[name, place] : places) {
    keys.push_back(name);
    for (int c = 0; c < dim; ++c)
      displacement[c].push_back(place[c]);
  }
  core::Table table(std::move(keys));
  for (int c = 0; c < dim; ++c)
    table.add("displacement_" + std::to_string(c), displacement[c]);
  state["searched"] = std::move(table);
  core::save_value(state, "search", "due", std::int64_t(due_));
  if (images_ && images_->is_any())
    for (int a = 0; a < dim; ++a)
      for (int c = 0; c < dim; ++c)
        core::save_value(state, "searched_jumps", column(a, c), searched_jumps_[a][c]);
  flanks_.save(state);
}

// Particles that came to the surface after the last search are the last ones in the list, and a
// search is due then.
template <int dim>
void ContactSearch<dim>::load(const core::State &state, const core::Names &names)
{
  flanks_.load(state, names);
  const core::Table &table = core::table(state, "searched");
  std::map<int, Vector<dim>> places;
  for (int c = 0; c < dim; ++c) {
    const auto values = table.reals("displacement_" + std::to_string(c));
    for (std::size_t r = 0; r < table.n_rows(); ++r)
      if (const int i = names.index(table.keys()[r]); i >= 0)
        places[i][c] = values[r];
  }
  due_ = core::load_integer(state, "search", "due") != 0;
  if (images_ && images_->is_any() && state.count("searched_jumps"))
    for (int a = 0; a < dim; ++a)
      for (int c = 0; c < dim; ++c)
        searched_jumps_[a][c] = core::load_real(state, "searched_jumps", column(a, c));
  // Nobody has searched yet, and older states don't say where from: the reference.
  if (places.empty())
    return;
  searched_at_.clear();
  for (const int i : surface_) {
    const auto place = places.find(i);
    if (place == places.end() && is_own(i)) {
      due_ = true;
      break;
    }
    searched_at_.push_back(place == places.end() ? Vector<dim>(Vector<dim>::Zero())
                                                 : place->second);
  }
}

template class ContactSearch<2>;
template class ContactSearch<3>;
} // namespace ligament::dem
