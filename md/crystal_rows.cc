#include "md/crystal_rows.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ligament::md
{
namespace
{
constexpr int most_lanes = 8;
/// Few enough that what lies between the passes of a run stays in the nearer caches.
constexpr int longest_run = 64;

/// Whole numbers k with basis k = x up to `error` (m); false where there are none.
template <int dim>
bool find_index(const Matrix<dim> &basis, const Vector<dim> &x, double error,
                Eigen::Matrix<int, dim, 1> &k)
{
  const Vector<dim> place = basis.inverse() * x;
  if (!(place.cwiseAbs().maxCoeff() < 1e9))
    return false;
  for (int c = 0; c < dim; ++c)
    k[c] = int(std::lround(place[c]));
  return (basis * k.template cast<double>() - x).cwiseAbs().maxCoeff() <= error;
}

template <int dim>
bool comes_before(const Eigen::Matrix<int, dim, 1> &a, const Eigen::Matrix<int, dim, 1> &b)
{
  for (int c = dim - 1; c > 0; --c)
    if (a[c] != b[c])
      return a[c] < b[c];
  return a[0] < b[0];
}

/// The inverse of a matrix of whole numbers with determinant 1 or -1.
template <int dim>
Eigen::Matrix<int, dim, dim> whole_inverse(const Eigen::Matrix<int, dim, dim> &m)
{
  const Matrix<dim> inverse = m.template cast<double>().inverse();
  return inverse.array().round().matrix().template cast<int>();
}

/// Number of rows that lie beside each other before the next ones behind them come: what the second
/// pass waits for should be near.
constexpr int strip_width = 3;

template <int dim>
int strip(const Eigen::Matrix<int, dim, 1> &k)
{
  return dim == 3 ? int(std::floor(double(k[1]) / strip_width)) : 0;
}

/// Lanes that vectors along the rows take.
template <int dim>
long lanes_of(std::vector<Eigen::Matrix<int, dim, 1>> sites)
{
  std::sort(sites.begin(), sites.end(), comes_before<dim>);
  long lanes = 0;
  int length = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    ++length;
    if (i + 1 == sites.size() || sites[i + 1] != sites[i] + Eigen::Matrix<int, dim, 1>::Unit(0)) {
      lanes += (length + most_lanes - 1) / most_lanes * most_lanes;
      length = 0;
    }
  }
  return lanes;
}
} // namespace

/// Sites first to before last of a row; the atoms and images there.
template <int dim>
struct CrystalRows<dim>::Row
{
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  int slot = 0;      // of the first one
  bool used = false; // has atoms or images

  void widen(int from, int to)
  {
    first = std::min(first, from);
    last = std::max(last, to);
  }
};

/// Rows by their other indices.
template <int dim>
class CrystalRows<dim>::Sites
{
public:
  using Key = std::array<int, dim - 1>;
  static Key key(const Index &k)
  {
    Key key;
    for (int c = 1; c < dim; ++c)
      key[dim - 1 - c] = k[c];
    return key;
  }
  std::map<Key, Row> rows;

  Row *find(const Index &k)
  {
    const auto it = rows.find(key(k));
    return it == rows.end() ? nullptr : &it->second;
  }
};

template <int dim>
CrystalRows<dim>::CrystalRows(const Crystal<dim> &crystal, const packings::Packing<dim> &packing,
                              double reach)
{
  const int n = packing.size();
  const Vector<dim> origin = get(packing.centre, 0);
  double extent = 0;
  for (int c = 0; c < dim; ++c)
    for (const double x : packing.centre[c])
      extent = std::max({extent, std::abs(x), packing.period[c]});
  const double error = 16 * std::numeric_limits<double>::epsilon() * extent;
  std::vector<Index> index(n), moves = {Index::Zero()};
  for (int i = 0; i < n; ++i)
    if (!find_index<dim>(crystal.basis(), Vector<dim>(get(packing.centre, i) - origin), error,
                         index[i]))
      return;
  for (int c = 0; c < dim; ++c) {
    Index k;
    if (packing.period[c] == 0)
      continue;
    if (!find_index<dim>(crystal.basis(), Vector<dim>(packing.period[c] * Vector<dim>::Unit(c)),
                         error, k))
      return;
    const int most = int(reach / packing.period[c]) + 1;
    const std::vector<Index> before = moves;
    for (int m = 1; m <= most; ++m)
      for (const int sign : {-1, 1})
        for (const Index &move : before)
          moves.push_back(move + sign * m * k);
  }
  find_bonds(crystal, reach);
  const Eigen::Matrix<int, dim, dim> basis = choose_basis(index),
                                     inverse = whole_inverse<dim>(basis);
  along_ = crystal.basis() * basis.col(0).template cast<double>();
  for (auto *list : {&index, &moves, &steps_})
    for (Index &k : *list)
      k = inverse * k;
  for (std::size_t b = 0; b < bonds_.size(); ++b)
    if (comes_before<dim>(steps_[b], Index::Zero())) {
      steps_[b] *= -1;
      bonds_[b] *= -1;
    }
  spread_rows();
  lay_out(index, moves);
}

template <int dim>
void CrystalRows<dim>::find_bonds(const Crystal<dim> &crystal, double reach)
{
  const auto &all = crystal.half_bonds();
  const double known = 1.25 * crystal.potential().cutoff();
  for (std::size_t b = 0; b < all.size(); ++b) {
    const double length = all[b].norm();
    if (b > 0 && length > (1 + 1e-6) * all[b - 1].norm() && length >= crystal.potential().cutoff())
      shells_.push_back({int(b), length});
    if (length >= std::min(reach, known))
      break;
    Index k;
    find_index<dim>(crystal.basis(), all[b], crystal.spacing(), k);
    bonds_.push_back(all[b]);
    steps_.push_back(k);
  }
  if (shells_.empty() || shells_.back().n_bonds < int(bonds_.size()))
    shells_.push_back({int(bonds_.size()), known});
}

// What has just been added to a row cannot be loaded for a while by a vector that lies otherwise.
template <int dim>
void CrystalRows<dim>::spread_rows()
{
  int first = 0;
  std::map<typename Sites::Key, int> last_use;
  for (const Shells &shells : shells_) {
    for (int b = first; b < shells.n_bonds; ++b) {
      std::map<typename Sites::Key, int> left; // bonds of each row
      for (int other = b; other < shells.n_bonds; ++other)
        ++left[Sites::key(steps_[other])];
      const auto urgency = [&](int other) {
        const auto key = Sites::key(steps_[other]);
        const auto used = last_use.find(key);
        const int since = used == last_use.end() ? 8 : std::min(8, b - used->second);
        return std::array<int, 2>{since, left[key]};
      };
      int next = b;
      for (int other = b + 1; other < shells.n_bonds; ++other)
        if (urgency(other) > urgency(next))
          next = other;
      std::swap(bonds_[b], bonds_[next]);
      std::swap(steps_[b], steps_[next]);
      last_use[Sites::key(steps_[b])] = b;
    }
    first = shells.n_bonds;
  }
}

template <int dim>
Eigen::Matrix<int, dim, dim> CrystalRows<dim>::choose_basis(const std::vector<Index> &index) const
{
  Eigen::Matrix<int, dim, dim> best = Eigen::Matrix<int, dim, dim>::Identity(), basis;
  long least = std::numeric_limits<long>::max();
  const Vector<dim> nearest = bonds_[0]; // they come nearest first
  int n = 0;
  while (n < int(bonds_.size()) && bonds_[n].norm() < 1.5 * nearest.norm())
    ++n;
  const auto has_volume_1 = [&] {
    return std::lround(std::abs(basis.template cast<double>().determinant())) == 1;
  };
  for (int a = 0; a < n; ++a) {
    bool found = false;
    basis.col(0) = steps_[a];
    for (int b = 0; b < n && !found; ++b) {
      basis.col(1) = steps_[b];
      for (int c = 0; c < (dim == 3 ? n : 1) && !found; ++c) {
        basis.col(dim - 1) = steps_[dim == 3 ? c : b];
        found = has_volume_1();
      }
    }
    if (!found)
      continue;
    const Eigen::Matrix<int, dim, dim> inverse = whole_inverse<dim>(basis);
    std::vector<Index> sites;
    sites.reserve(index.size());
    for (const Index &k : index)
      sites.push_back(inverse * k);
    const long lanes = lanes_of<dim>(std::move(sites));
    if (lanes < least) {
      least = lanes;
      best = basis;
    }
  }
  return best;
}

template <int dim>
void CrystalRows<dim>::lay_out(const std::vector<Index> &index, const std::vector<Index> &moves)
{
  // Sites of atoms, in order, then of those images that a bond reaches.
  struct Site
  {
    Index k;
    int atom;
  };
  std::vector<Site> atoms;
  for (std::size_t i = 0; i < index.size(); ++i)
    atoms.push_back({index[i], int(i)});
  const auto earlier = [](const Site &a, const Site &b) { return comes_before<dim>(a.k, b.k); };
  std::sort(atoms.begin(), atoms.end(), earlier);
  const auto same = [](const Site &a, const Site &b) { return a.k == b.k; };
  if (std::adjacent_find(atoms.begin(), atoms.end(), same) != atoms.end())
    return;
  const auto find_atom = [&](const Index &k) {
    const auto it = std::lower_bound(atoms.begin(), atoms.end(), Site{k, 0}, earlier);
    return it != atoms.end() && it->k == k ? it->atom : -1;
  };
  struct Run
  {
    Index k;
    int length, first; // sites and the first of them
  };
  std::vector<Run> runs;
  for (std::size_t i = 0; i < atoms.size(); ++i)
    if (i > 0 && runs.back().length < longest_run && atoms[i].k == atoms[i - 1].k + Index::Unit(0))
      ++runs.back().length;
    else
      runs.push_back({atoms[i].k, 1, int(i)});
  std::stable_sort(runs.begin(), runs.end(),
                   [](const Run &a, const Run &b) { return strip<dim>(a.k) < strip<dim>(b.k); });
  std::vector<Site> images;
  for (const Run &run : runs)
    for (std::size_t b = 0; b < steps_.size() && moves.size() > 1; ++b) {
      auto at = std::lower_bound(atoms.begin(), atoms.end(), Site{run.k + steps_[b], 0}, earlier);
      for (int s = 0; s < run.length; ++s) {
        const Site sought{run.k + steps_[b] + s * Index::Unit(0), 0};
        while (at != atoms.end() && earlier(*at, sought))
          ++at;
        if (at != atoms.end() && at->k == sought.k)
          continue;
        for (std::size_t m = 1; m < moves.size(); ++m) {
          const int atom = find_atom(sought.k - moves[m]);
          if (atom >= 0) {
            images.push_back({sought.k, atom});
            break;
          }
        }
      }
    }
  std::sort(images.begin(), images.end(), earlier);
  images.erase(std::unique(images.begin(), images.end(), same), images.end());

  // Rows as long as their sites and the vectors that begin at them or reach them.
  Sites sites;
  for (const auto *list : {&atoms, &images})
    for (const Site &s : *list) {
      Row &row = sites.rows[Sites::key(s.k)];
      row.widen(s.k[0], s.k[0] + 1);
      row.used = true;
    }
  int longest = 0;
  for (const Run &run : runs) {
    longest = std::max(longest, run.length);
    sites.find(run.k)->widen(run.k[0], run.k[0] + run.length + most_lanes);
    for (const Index &b : steps_)
      if (Row *row = sites.find(run.k + b))
        row->widen(run.k[0] + b[0], run.k[0] + b[0] + run.length + most_lanes);
  }
  int n_slots = 0;
  for (auto &[key, row] : sites.rows) {
    row.slot = n_slots;
    n_slots += row.last - row.first;
  }
  const int nowhere = n_slots; // an empty row for bonds that lead out of the body
  atom_.assign(n_slots + longest + most_lanes, -1);
  const auto slot_of = [&](const Index &k) {
    const Row *row = sites.find(k);
    return row ? row->slot + k[0] - row->first : -1;
  };
  std::vector<int> slot_of_atom(atoms.size());
  for (const Site &s : atoms) {
    slot_of_atom[s.atom] = slot_of(s.k);
    atom_[slot_of(s.k)] = s.atom;
  }
  std::vector<int> run_of_slot(atom_.size(), -1);
  for (const Run &run : runs) {
    const int first = slot_of(run.k);
    for (int s = first; s < first + run.length; ++s)
      run_of_slot[s] = int(runs_.size());
    runs_.push_back({first, first + run.length});
    for (const Index &b : steps_) {
      const int slot = slot_of(run.k + b);
      shift_.push_back((slot < 0 ? nowhere : slot) - first);
    }
  }
  for (const Site &s : images)
    images_.push_back({slot_of(s.k), slot_of_atom[s.atom]});
  std::stable_sort(images_.begin(), images_.end(), [&](const Image &a, const Image &b) {
    return run_of_slot[a.of] < run_of_slot[b.of];
  });
  image_begin_.assign(runs_.size() + 1, 0);
  for (const Image &image : images_)
    ++image_begin_[run_of_slot[image.of] + 1];
  for (std::size_t r = 0; r < runs_.size(); ++r)
    image_begin_[r + 1] += image_begin_[r];
  for (const Image &image : images_)
    run_of_slot[image.slot] = run_of_slot[image.of];
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    std::vector<int> reached;
    for (std::size_t b = 0; b < steps_.size(); ++b)
      for (int s = runs_[r].first; s < runs_[r].last; ++s)
        if (const int other = run_of_slot[s + shift(int(r))[b]]; other >= 0)
          reached.push_back(other);
    std::sort(reached.begin(), reached.end());
    reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
    reached_.push_back(std::move(reached));
  }
}

template class CrystalRows<2>;
template class CrystalRows<3>;
} // namespace ligament::md
