#include "src/simulation/gauges/pieces.h"

#include "src/simulation/disjoint_sets.h"

#include <algorithm>
#include <numeric>

namespace ligament::program
{
namespace
{
/// What one rank sees: its own particles and what they are joined to, the first one also the mesh.
/// Items are the particles at hand, then the nodes.
template <int dim>
class PiecesHere
{
public:
  explicit PiecesHere(const CoupledBody<dim> &body)
      : body_(body), n_particles_(body.zone ? body.zone->state.size() : 0),
        n_nodes_(body.far ? body.far->mesh().n_nodes() : 0), sets_(n_particles_ + n_nodes_),
        piece_of_root_(n_particles_ + n_nodes_, -1)
  {
    join_particles();
    if (body.far && body.ranks.is_first())
      join_nodes(body.far->mesh());
    std::int64_t n = 0;
    for_each_own([&](int item) {
      int &piece = piece_of_root_[sets_.find(item)];
      if (piece < 0) {
        piece = int(first_.size());
        first_.push_back({item, n});
      }
      ++n;
    });
  }

  /// In the order of the body.
  template <typename Visit>
  void for_each_own(Visit &&visit) const
  {
    if (body_.zone)
      particles::for_each(body_.zone->state.part.owned, visit);
    for (int k = 0; k < n_nodes_ && body_.ranks.is_first(); ++k)
      visit(n_particles_ + k);
  }
  /// visit(item) for what is joined to one's own and belongs to another rank.
  template <typename Visit>
  void for_each_other(Visit &&visit)
  {
    for (int item = 0; item < n_particles_ + n_nodes_ && !body_.ranks.is_one(); ++item)
      if (!is_own(item) && piece(item) >= 0)
        visit(item);
  }

  bool is_node(int item) const { return item >= n_particles_; }
  bool is_own(int item) const
  {
    return is_node(item) ? body_.ranks.is_first() : body_.zone->state.part.owns(item);
  }
  int node(int item) const { return item - n_particles_; }
  int item_of_node(int node) const { return n_particles_ + node; }
  /// -1: with nothing of one's own.
  int piece(int item) { return piece_of_root_[sets_.find(item)]; }
  /// Of each piece.
  struct First
  {
    int item;
    std::int64_t own_before; // items
  };
  const std::vector<First> &first() const { return first_; }

private:
  void join_particles()
  {
    if (!body_.zone)
      return;
    const particles::Part &part = body_.zone->state.part;
    body_.force()->for_each_face(body_.zone->state, [&](const particles::FaceView<dim> &face) {
      if (face.j > face.i && face.bonded && (part.owns(face.i) || part.owns(face.j)))
        sets_.join(face.i, face.j);
    });
    if (const auto *overlap = body_.coupler->overlap())
      for (const auto &m : overlap->members)
        if (part.owns(m.particle))
          sets_.join(m.particle, item_of_node(overlap->near_nodes[m.nodes[0]]));
  }
  void join_nodes(const fem::Mesh<dim> &mesh)
  {
    for (const auto &cell : mesh.cells)
      for (const int node : cell)
        sets_.join(item_of_node(node), item_of_node(cell[0]));
    for (const auto &hanging : mesh.hanging)
      for (const auto &master : hanging.masters)
        sets_.join(item_of_node(hanging.node), item_of_node(master.first));
  }

  const CoupledBody<dim> &body_;
  int n_particles_, n_nodes_;
  DisjointSets sets_;
  std::vector<int> piece_of_root_;
  std::vector<First> first_;
};

/// Numbers of the pieces of the ranks, rank after rank, and what stands for those of them that are
/// one: what a rank's own are joined to, its owner has in a piece of its own.
template <int dim>
DisjointSets join_ranks(const CoupledBody<dim> &body, PiecesHere<dim> &here, std::int64_t before,
                        std::int64_t n)
{
  struct Link
  {
    std::int64_t is_node, name, piece;
  };
  std::vector<Link> links;
  here.for_each_other([&](int item) {
    links.push_back({here.is_node(item),
                     here.is_node(item) ? here.node(item) : body.zone->state.global_id[item],
                     before + here.piece(item)});
  });
  DisjointSets all{int(n)};
  links = body.ranks.gather_all(links);
  if (links.empty())
    return all;
  const core::Names names = body.zone->state.names();
  std::vector<std::array<std::int64_t, 2>> pairs;
  for (const Link &link : links) {
    const int item = link.is_node ? here.item_of_node(int(link.name)) : names.index(link.name);
    if (item >= 0 && here.is_own(item))
      pairs.push_back({link.piece, before + here.piece(item)});
  }
  for (const auto &[a, b] : body.ranks.gather_all(pairs))
    all.join(int(a), int(b));
  return all;
}

/// What each rank has of the pieces, rank after rank.
struct Parts
{
  std::int64_t before = 0;         // of the ranks before
  std::vector<std::int64_t> first; // item in the order of the body: particles, then nodes
  std::vector<double> mass;        // kg
};

template <int dim>
Parts parts_of_ranks(const CoupledBody<dim> &body, const PiecesHere<dim> &here,
                     const std::vector<core::ExactSum> &mass)
{
  const core::Ranks &ranks = body.ranks;
  const std::int64_t n_own = body.zone ? particles::count(body.zone->state.part.owned) : 0;
  const auto all = ranks.gather_all(
      std::vector<std::array<std::int64_t, 2>>{{n_own, std::int64_t(mass.size())}});
  Parts parts;
  std::int64_t own_before = 0, n_particles = 0;
  for (int rank = 0; rank < ranks.size(); ++rank) {
    own_before += rank < ranks.rank() ? all[rank][0] : 0;
    parts.before += rank < ranks.rank() ? all[rank][1] : 0;
    n_particles += all[rank][0];
  }
  for (std::size_t k = 0; k < mass.size(); ++k) {
    const int item = here.first()[k].item;
    parts.first.push_back(here.is_node(item) ? n_particles + here.node(item)
                                             : own_before + here.first()[k].own_before);
    parts.mass.push_back(mass[k].value());
  }
  parts.first = ranks.gather_all(parts.first);
  parts.mass = ranks.gather_all(parts.mass);
  return parts;
}

struct Piece
{
  std::int64_t first; // item, in the order of the body
  double mass;        // kg, of one of its parts
  int n_parts = 0;
};

/// The pieces of the body, and which one each part belongs to.
struct PiecesOfParts
{
  std::vector<Piece> pieces;
  std::vector<int> of_part;
};

PiecesOfParts pieces_of(const Parts &parts, DisjointSets &joined)
{
  const int n = int(parts.first.size());
  PiecesOfParts found;
  std::vector<int> of_root(n, -1);
  for (int k = 0; k < n; ++k) {
    int &number = of_root[joined.find(k)];
    if (number < 0) {
      number = int(found.pieces.size());
      found.pieces.push_back({parts.first[k], parts.mass[k]});
    }
    Piece &piece = found.pieces[number];
    piece.first = std::min(piece.first, parts.first[k]);
    ++piece.n_parts;
    found.of_part.push_back(number);
  }
  return found;
}

/// Exact sums are large: ranks tell each other those of pieces alone that several have parts of.
void sum_masses(const core::Ranks &ranks, const std::vector<core::ExactSum> &of_parts_here,
                std::int64_t before, PiecesOfParts &all)
{
  std::vector<int> divided(all.pieces.size(), -1);
  std::vector<core::ExactSum> sums;
  for (std::size_t p = 0; p < divided.size(); ++p)
    if (all.pieces[p].n_parts > 1) {
      divided[p] = int(sums.size());
      sums.emplace_back();
    }
  if (sums.empty())
    return;
  for (std::size_t k = 0; k < of_parts_here.size(); ++k)
    if (const int d = divided[all.of_part[before + k]]; d >= 0)
      sums[d].merge(of_parts_here[k]);
  sums = ranks.sum(sums);
  for (std::size_t p = 0; p < divided.size(); ++p)
    if (divided[p] >= 0)
      all.pieces[p].mass = sums[divided[p]].value();
}
} // namespace

template <int dim>
BodyPieces find_pieces(const CoupledBody<dim> &body, const std::vector<double> &particle_mass,
                       const std::vector<double> &node_mass)
{
  PiecesHere<dim> here(body);
  std::vector<core::ExactSum> masses(here.first().size());
  here.for_each_own([&](int item) {
    masses[here.piece(item)].add(here.is_node(item) ? node_mass[here.node(item)]
                                                    : particle_mass[item]);
  });
  const Parts parts = parts_of_ranks(body, here, masses);
  DisjointSets joined = join_ranks(body, here, parts.before, std::int64_t(parts.first.size()));
  PiecesOfParts all = pieces_of(parts, joined);
  sum_masses(body.ranks, masses, parts.before, all);

  std::vector<int> order(all.pieces.size()), place(order.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const Piece &p = all.pieces[a], &q = all.pieces[b];
    return p.mass != q.mass ? p.mass > q.mass : p.first < q.first;
  });
  BodyPieces found;
  for (std::size_t k = 0; k < order.size(); ++k) {
    place[order[k]] = int(k);
    found.mass.push_back(all.pieces[order[k]].mass);
  }
  found.of_particle.assign(particle_mass.size(), BodyPieces::elsewhere);
  found.of_node.assign(node_mass.size(), BodyPieces::elsewhere);
  here.for_each_own([&](int item) {
    const int number = place[all.of_part[parts.before + here.piece(item)]];
    (here.is_node(item) ? found.of_node[here.node(item)] : found.of_particle[item]) = number;
  });
  return found;
}

template BodyPieces find_pieces(const CoupledBody<2> &, const std::vector<double> &,
                                const std::vector<double> &);
template BodyPieces find_pieces(const CoupledBody<3> &, const std::vector<double> &,
                                const std::vector<double> &);
} // namespace ligament::program
