#include "src/simulation/load_path.h"

#include "core/names.h"
#include "core/sums.h"
#include "src/simulation/disjoint_sets.h"
#include "src/simulation/whole_body.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>

namespace ligament::program
{
namespace
{
enum class End
{
  low,
  high
};

/// Of the body along the axis at which this coordinate lies, to within that share of its length.
template <int dim>
std::optional<End> end_at(const CoupledBody<dim> &body, int axis, double x, double share)
{
  const double close = share * (body.upper[axis] - body.lower[axis]);
  if (std::abs(x - body.lower[axis]) < close)
    return End::low;
  if (std::abs(x - body.upper[axis]) < close)
    return End::high;
  return {};
}

/// Between two items, both ways.
struct Link
{
  int from, to;
  double area; // m^2
};

/// Faces that carry, and particles at the two sides, of all particles in their order.
struct Faces
{
  std::vector<int> node;                 // that carries the particle, -1: none
  std::vector<Link> links;               // ascending
  std::vector<std::pair<int, End>> held; // particles at the two sides
};

/// Items that nothing can part are one: particles, then nodes, then the two sides.
template <int dim>
class Items
{
public:
  Items(const CoupledBody<dim> &body, const std::vector<int> &node_of_particle, int axis)
      : n_particles_(int(node_of_particle.size())),
        n_nodes_(body.far ? body.far->mesh().n_nodes() : 0), low_(n_particles_ + n_nodes_),
        sets_(low_ + 2)
  {
    if (body.far)
      join_mesh(body, axis);
    for (int i = 0; i < n_particles_; ++i)
      if (node_of_particle[i] >= 0)
        sets_.join(i, n_particles_ + node_of_particle[i]);
  }

  int size() const { return low_ + 2; }
  int particle(int i) { return sets_.find(i); }
  int node(int i) { return sets_.find(n_particles_ + i); }
  int low() { return sets_.find(low_); }
  int high() { return sets_.find(low_ + 1); }
  void hold(int particle, End end) { sets_.join(particle, low_ + (end == End::high)); }

private:
  void join_mesh(const CoupledBody<dim> &body, int axis)
  {
    const auto &mesh = body.far->mesh();
    const auto join = [&](int a, int b) { sets_.join(n_particles_ + a, n_particles_ + b); };
    for (const auto &cell : mesh.cells)
      for (const int node : cell)
        join(node, cell[0]);
    for (const auto &hanging : mesh.hanging)
      for (const auto &[master, weight] : hanging.masters)
        join(hanging.node, master);
    for (int i = 0; i < n_nodes_; ++i)
      if (const auto end = end_at(body, axis, mesh.nodes[i][axis], 1e-9))
        sets_.join(n_particles_ + i, low_ + (*end == End::high));
  }

  int n_particles_, n_nodes_, low_;
  DisjointSets sets_;
};

/// Of the network of links between items with these capacities.
double maximum_flow(int n_items, const std::vector<Link> &links, int source, int sink)
{
  using Graph =
      boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                         boost::no_property, int, int>;
  using Edge = boost::graph_traits<Graph>::edge_descriptor;
  // Links 2k and 2k + 1 are the two ways of one; the graph wants them by their origin.
  std::vector<int> first(n_items + 1, 0);
  const auto ends = [&](int way) {
    const Link &l = links[way / 2];
    return way % 2 ? std::pair(l.to, l.from) : std::pair(l.from, l.to);
  };
  const int n_ways = 2 * int(links.size());
  for (int way = 0; way < n_ways; ++way)
    ++first[ends(way).first + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> place(n_ways);
  std::vector<std::pair<int, int>> sorted(n_ways);
  std::vector<double> capacity(n_ways), residual(n_ways);
  for (int way = 0; way < n_ways; ++way) {
    place[way] = first[ends(way).first]++;
    sorted[place[way]] = ends(way);
    capacity[place[way]] = links[way / 2].area;
  }
  const Graph graph(boost::edges_are_sorted, sorted.begin(), sorted.end(), n_items);
  std::vector<Edge> edge(n_ways), reverse(n_ways), predecessor(n_items);
  for (auto [e, end] = boost::edges(graph); e != end; ++e)
    edge[boost::get(boost::edge_index, graph, *e)] = *e;
  for (int way = 0; way < n_ways; ++way)
    reverse[place[way]] = edge[place[way ^ 1]];
  std::vector<boost::default_color_type> color(n_items);
  std::vector<long> distance(n_items);
  const auto of_edge = [&](auto &values) {
    return boost::make_iterator_property_map(values.begin(), boost::get(boost::edge_index, graph));
  };
  const auto index = boost::get(boost::vertex_index, graph);
  const auto of_item = [&](auto &values) {
    return boost::make_iterator_property_map(values.begin(), index);
  };
  return boost::boykov_kolmogorov_max_flow(graph, of_edge(capacity), of_edge(residual),
                                           of_edge(reverse), of_item(predecessor), of_item(color),
                                           of_item(distance), index, source, sink);
}
} // namespace

namespace
{
/// Of a part, with the particles as the first rank numbers those of the body; it alone has all.
template <int dim>
Faces faces_at_first(const CoupledBody<dim> &body, const Faces &part)
{
  struct NamedLink
  {
    std::int64_t from, to;
    double area;
  };
  const auto &id = body.zone->state.global_id;
  std::vector<NamedLink> links;
  for (const Link &l : part.links)
    links.push_back({id[l.from], id[l.to], l.area});
  std::vector<std::array<std::int64_t, 2>> held;
  for (const auto &[particle, end] : part.held)
    held.push_back({id[particle], std::int64_t(end)});
  links = body.ranks.gather_at_first(links);
  held = body.ranks.gather_at_first(held);
  const core::Names names(names_at_first(*body.zone));
  Faces all;
  all.node = at_first(*body.zone, part.node);
  for (const NamedLink &l : links)
    all.links.push_back({names.index(l.from), names.index(l.to), l.area});
  for (const auto &[name, end] : held)
    all.held.emplace_back(int(names.index(name)), End(end));
  return all;
}

/// Each side of each face that carries and of which the particle is this rank's, and each outer
/// face at the two sides.
template <int dim, typename Carries, typename Holds>
void look_at_faces(const CoupledBody<dim> &body, int axis, Carrying carrying, Carries &&carries,
                   Holds &&holds)
{
  const auto &state = body.zone->state;
  const double length = body.upper[axis] - body.lower[axis];
  std::set<std::pair<int, int>> broken;
  if (carrying == Carrying::at_start)
    for (const auto &b : body.force()->broken_bonds())
      broken.insert(std::minmax(b.i, b.j));
  body.force()->for_each_face(state, [&](const particles::FaceView<dim> &face) {
    if (!state.part.owns(face.i))
      return; // another rank has it
    if (face.j >= 0) {
      if (face.bonded || broken.count(std::minmax(face.i, face.j)))
        carries(face);
    } else if (std::abs(face.normal[axis]) > 0.999)
      if (const auto end = end_at(body, axis, face.centroid[axis], 1e-6 * body.spacing / length))
        holds(face.i, *end);
  });
}

/// The mesh node that carries the particle, -1: none.
template <int dim>
std::vector<int> nodes_of_particles(const CoupledBody<dim> &body)
{
  std::vector<int> node(body.zone->state.size(), -1);
  if (const auto *overlap = body.coupler->overlap())
    for (const auto &m : overlap->members)
      node[m.particle] = overlap->near_nodes[m.nodes[0]];
  return node;
}

/// Of the body; of several ranks the first one has them.
template <int dim>
Faces carrying_faces(const CoupledBody<dim> &body, int axis, Carrying carrying)
{
  Faces faces;
  if (!body.zone)
    return faces;
  look_at_faces(
      body, axis, carrying,
      [&](const auto &face) {
        if (face.i < face.j)
          faces.links.push_back({face.i, face.j, face.area});
      },
      [&](int particle, End end) { faces.held.emplace_back(particle, end); });
  faces.node = nodes_of_particles(body);
  if (!body.ranks.is_one())
    faces = faces_at_first(body, faces);
  std::sort(faces.links.begin(), faces.links.end(), [](const Link &a, const Link &b) {
    return std::tie(a.from, a.to) < std::tie(b.from, b.to);
  });
  return faces;
}

/// Of what is at hand.
template <int dim>
double smallest_section(const CoupledBody<dim> &body, int axis, Faces faces)
{
  Items<dim> items(body, faces.node, axis);
  for (const auto &[particle, end] : faces.held)
    items.hold(particle, end);
  const int low = items.low(), high = items.high();
  if (low == high)
    return std::numeric_limits<double>::infinity();
  for (Link &l : faces.links)
    l = {items.particle(l.from), items.particle(l.to), l.area};
  return maximum_flow(items.size(), faces.links, low, high);
}
} // namespace

template <int dim>
double smallest_section(const CoupledBody<dim> &body, int axis, Carrying carrying)
{
  const Faces faces = carrying_faces(body, axis, carrying);
  const double section = body.ranks.is_first() ? smallest_section(body, axis, faces) : 0;
  return body.ranks.gather_all(std::vector<double>{section}).front();
}

// A uniform field along the axis flows through all faces and needs no more than their areas. What
// does not carry lets particles swallow a part of it (sum of the flows out of one below zero); the
// rest comes from the low side, and goes to the high one.
template <int dim>
double section_at_least(const CoupledBody<dim> &body, int axis, Carrying carrying)
{
  Items<dim> mesh(body, {}, axis);
  if (mesh.low() == mesh.high())
    return std::numeric_limits<double>::infinity();
  core::ExactSum section;
  if (body.zone) {
    const auto &state = body.zone->state;
    std::vector<double> flow(state.size(), 0);
    std::vector<int> item(state.size(), -1);
    const std::vector<int> node = nodes_of_particles(body);
    for (int i = 0; i < state.size(); ++i)
      if (node[i] >= 0)
        item[i] = mesh.node(node[i]);
    look_at_faces(
        body, axis, carrying,
        [&](const auto &face) { flow[face.i] += face.area * face.normal[axis]; },
        [&](int particle, End end) {
          item[particle] = end == End::low ? mesh.low() : mesh.high();
        });
    for (int i = 0; i < state.size(); ++i)
      if (state.part.owns(i) && (item[i] == mesh.low() || (item[i] != mesh.high() && flow[i] < 0)))
        section.add(flow[i]);
  }
  return std::max(0., body.ranks.sum(section).value());
}

template <int dim>
double section_at_start(const CoupledBody<dim> &body, int axis)
{
  const double bound = section_at_least(body, axis, Carrying::at_start);
  return bound > 0 ? bound : smallest_section(body, axis, Carrying::at_start);
}

template <int dim>
void LoadPath<dim>::start(const CoupledBody<dim> &body)
{
  is_bound_ = true;
  // Sums of unit normals times areas are zero to round-off only.
  at_least_ = at_start_ = (1 - 1e-6) * section_at_least(body, axis_, Carrying::at_start);
  counted_ = 0;
}

// Breaking faces takes at most their area from any section.
template <int dim>
void LoadPath<dim>::count(const CoupledBody<dim> &body)
{
  const auto broken = body.force()->broken_bonds_of_body(body.zone->state);
  at_least_ -= core::exact_sum(broken.size() - counted_, [&](std::size_t k) {
                 return broken[counted_ + k].area;
               }).value();
  counted_ = broken.size();
}

// While less has broken than that share of a bound on the section of the start, the share of the
// section itself is left, too.
template <int dim>
std::optional<double> LoadPath<dim>::lost(const CoupledBody<dim> &body)
{
  const std::size_t n_broken = body.force() ? std::size_t(body.force()->n_broken()) : 0;
  if (n_broken == 0)
    return {};
  if (at_start_ < 0)
    start(body);
  // The mesh goes round the zone, or no flat face lies at one of the ends.
  const auto has_no_answer = [&] {
    return std::isinf(at_start_) || (at_start_ == 0 && !is_bound_);
  };
  if (has_no_answer())
    return {};
  if (counted_ < n_broken) {
    count(body);
    if (is_bound_ && !has_enough()) {
      is_bound_ = false;
      at_least_ = at_start_ = smallest_section(body, axis_, Carrying::at_start);
      counted_ = 0;
      if (has_no_answer())
        return {};
      count(body);
    }
    if (!has_enough())
      at_least_ = smallest_section(body, axis_, Carrying::now);
  }
  if (has_enough())
    return {};
  return at_least_ / at_start_;
}

// A bound is as easily had again.
template <int dim>
void LoadPath<dim>::save(core::State &state) const
{
  core::save_value(state, "recorder", "section_at_start", is_bound_ ? -1. : at_start_);
  core::save_value(state, "recorder", "section_at_least", is_bound_ ? 0. : at_least_);
  core::save_value(state, "recorder", "section_counted", is_bound_ ? 0 : std::int64_t(counted_));
}

template <int dim>
void LoadPath<dim>::load(const core::State &state)
{
  is_bound_ = false; // a bound comes as none
  at_start_ = core::load_real(state, "recorder", "section_at_start");
  at_least_ = core::load_real(state, "recorder", "section_at_least");
  counted_ = std::size_t(core::load_integer(state, "recorder", "section_counted"));
}

template double smallest_section(const CoupledBody<2> &, int, Carrying);
template double smallest_section(const CoupledBody<3> &, int, Carrying);
template double section_at_least(const CoupledBody<2> &, int, Carrying);
template double section_at_least(const CoupledBody<3> &, int, Carrying);
template double section_at_start(const CoupledBody<2> &, int);
template double section_at_start(const CoupledBody<3> &, int);
template class LoadPath<2>;
template class LoadPath<3>;
} // namespace ligament::program
