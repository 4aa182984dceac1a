#include "src/simulation/load_path.h"

#include "core/sums.h"
#include "src/simulation/disjoint_sets.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace ligament::program
{
namespace
{
/// Between two items, both ways.
struct Link
{
  int from, to;
  double area; // m^2
};

/// Items that nothing can part are one: particles, then nodes, then the two sides.
template <int dim>
class Items
{
public:
  Items(const CoupledBody<dim> &body, int axis)
      : n_particles_(body.zone ? body.zone->state.size() : 0),
        n_nodes_(body.far ? body.far->mesh().n_nodes() : 0), low_(n_particles_ + n_nodes_),
        sets_(low_ + 2)
  {
    if (body.far)
      join_mesh(body, axis);
    if (const auto *overlap = body.coupler->overlap())
      for (const auto &m : overlap->members)
        sets_.join(m.particle, n_particles_ + overlap->near_nodes[m.nodes[0]]);
  }

  int size() const { return low_ + 2; }
  int particle(int i) { return sets_.find(i); }
  int low() { return sets_.find(low_); }
  int high() { return sets_.find(low_ + 1); }
  void hold(int particle, bool at_low) { sets_.join(particle, low_ + !at_low); }

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
      if (std::abs(std::abs(mesh.nodes[i][axis]) - body.upper[axis]) < 1e-9 * body.upper[axis])
        sets_.join(n_particles_ + i, low_ + (mesh.nodes[i][axis] > 0));
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

template <int dim>
double smallest_section(const CoupledBody<dim> &body, int axis, Carrying carrying)
{
  Items<dim> items(body, axis);
  std::set<std::pair<int, int>> broken;
  if (body.zone && carrying == Carrying::at_start)
    for (const auto &b : body.force()->broken_bonds())
      broken.insert(std::minmax(b.i, b.j));
  std::vector<Link> links;
  if (body.zone)
    body.force()->for_each_face(body.zone->state, [&](const particles::FaceView<dim> &face) {
      if (face.j >= 0) {
        if (face.i < face.j && (face.bonded || broken.count({face.i, face.j})))
          links.push_back({face.i, face.j, face.area});
      } else if (std::abs(face.normal[axis]) > 0.999 &&
                 std::abs(std::abs(face.centroid[axis]) - body.upper[axis]) < 1e-6 * body.spacing)
        items.hold(face.i, face.centroid[axis] < 0);
    });
  const int low = items.low(), high = items.high();
  if (low == high)
    return std::numeric_limits<double>::infinity();
  for (Link &l : links)
    l = {items.particle(l.from), items.particle(l.to), l.area};
  return maximum_flow(items.size(), links, low, high);
}

// Breaking faces takes at most their area from any section.
template <int dim>
std::optional<double> LoadPath<dim>::lost(const CoupledBody<dim> &body)
{
  if (!body.force() || body.force()->broken_bonds().empty())
    return {};
  const auto &broken = body.force()->broken_bonds();
  if (at_start_ < 0)
    at_least_ = at_start_ = smallest_section(body, axis_, Carrying::at_start);
  if (std::isinf(at_start_)) // the mesh goes round the zone
    return {};
  const double least = lost_share * at_start_;
  if (counted_ < broken.size()) {
    at_least_ -= core::exact_sum(broken.size() - counted_, [&](std::size_t k) {
                   return broken[counted_ + k].area;
                 }).value();
    counted_ = broken.size();
    if (at_least_ <= least)
      at_least_ = smallest_section(body, axis_, Carrying::now);
  }
  if (at_least_ > least)
    return {};
  return at_start_ > 0 ? at_least_ / at_start_ : 0;
}

template <int dim>
void LoadPath<dim>::save(core::State &state) const
{
  core::save_value(state, "recorder", "section_at_start", at_start_);
  core::save_value(state, "recorder", "section_at_least", at_least_);
  core::save_value(state, "recorder", "section_counted", std::int64_t(counted_));
}

template <int dim>
void LoadPath<dim>::load(const core::State &state)
{
  at_start_ = core::load_real(state, "recorder", "section_at_start");
  at_least_ = core::load_real(state, "recorder", "section_at_least");
  counted_ = std::size_t(core::load_integer(state, "recorder", "section_counted"));
}

template double smallest_section(const CoupledBody<2> &, int, Carrying);
template double smallest_section(const CoupledBody<3> &, int, Carrying);
template class LoadPath<2>;
template class LoadPath<3>;
} // namespace ligament::program
