#include "src/scene/gmsh_file.h"

#include "core/keyed_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

namespace ligament::program
{
namespace
{
/// Dimension, number of nodes and of corners of an element type of gmsh.
struct Kind
{
  int dim, n_nodes, n_corners;
};
const std::map<int, Kind> kinds = {
    {15, {0, 1, 1}}, {1, {1, 2, 2}},   {8, {1, 3, 2}},  {2, {2, 3, 3}}, {9, {2, 6, 3}},
    {3, {2, 4, 4}},  {16, {2, 8, 4}},  {10, {2, 9, 4}}, {4, {3, 4, 4}}, {11, {3, 10, 4}},
    {5, {3, 8, 8}},  {17, {3, 20, 8}}, {12, {3, 27, 8}}};

class Reader
{
public:
  Reader(const std::string &file, const std::string &key) : file_(file), key_(key), in_(file)
  {
    if (!in_)
      fail("cannot be read", "there is no such file", "check the path");
  }

  GmshMesh read()
  {
    for (std::string section; in_ >> section;) {
      if (section.empty() || section[0] != '$')
        continue;
      if (section == "$MeshFormat")
        read_format();
      else if (section == "$PhysicalNames")
        read_names();
      else if (section == "$Entities")
        read_entities();
      else if (section == "$Nodes")
        is_new_ ? read_nodes_4() : read_nodes_2();
      else if (section == "$Elements")
        is_new_ ? read_elements_4() : read_elements_2();
      else
        continue;
      end(section);
    }
    if (mesh_.nodes.empty() || (mesh_.faces.empty() && mesh_.volumes.empty()))
      fail("has no mesh", "there are no nodes, or no faces and volumes among the elements",
           "mesh the model before it is saved");
    for (const auto &[group, name] : names_)
      if (group.first > 0 && !used_.count(group))
        fail(fmt::format("has no elements of \"{}\"", name), "its physical group is empty",
             "mesh it, or remove the group");
    return std::move(mesh_);
  }

private:
  [[noreturn]] void fail(const std::string &what, const std::string &reason,
                         const std::string &remedy)
  {
    throw core::KeyedError(key_, fmt::format("\"{}\" {}", place(), what), reason, remedy);
  }
  /// The file, and the line that was read last if any was.
  std::string place()
  {
    in_.clear();
    auto left = std::streamoff(in_.tellg());
    if (left <= 0)
      return file_;
    int line = 1;
    in_.seekg(0);
    for (std::istreambuf_iterator<char> c(in_), end; c != end && left > 0; ++c, --left)
      line += *c == '\n';
    return fmt::format("{}:{}", file_, line);
  }
  template <typename T>
  T next()
  {
    T value;
    if (!(in_ >> value))
      fail("ends too early", "a number is missing", "save it anew");
    return value;
  }
  /// What follows the entries that a section announced: a file that was cut within its last number, or a
  /// wrong count, would else be read as another mesh.
  void end(const std::string &section)
  {
    const std::string expected = "$End" + section.substr(1);
    std::string word;
    if (!(in_ >> word))
      fail("ends too early", fmt::format("{} is missing", expected), "save it anew");
    if (word != expected)
      fail(fmt::format("has \"{}\" where {} should be", word, expected),
           "the section has another number of entries than it announces", "save it anew");
  }
  int number() { return next<int>(); }
  double real() { return next<double>(); }

  void read_format()
  {
    const std::string version = next<std::string>();
    if (version != "2.2" && version != "4.1")
      fail("is of version " + version, "versions 2.2 and 4.1 are read",
           "save it as version 4.1 (Mesh.MshFileVersion)");
    is_new_ = version == "4.1";
    if (number() != 0)
      fail("is binary", "text is read", "save it as text (Mesh.Binary = 0)");
    number(); // bytes of a number where it is binary
  }
  void read_names()
  {
    for (int n = number(); n > 0; --n) {
      const int dim = number(), tag = number();
      std::string name;
      std::getline(in_, name);
      const auto first = name.find('"'), last = name.rfind('"');
      if (first == name.npos || last <= first)
        fail("has a physical group without a name", "names stand in quotes", "save it anew");
      names_[{dim, tag}] = name.substr(first + 1, last - first - 1);
    }
  }
  /// Which physical groups each curve, surface and volume is in; numbers below 0 turn it over.
  void read_entities()
  {
    std::array<int, 4> n;
    for (int &count : n)
      count = number();
    for (int dim = 0; dim < 4; ++dim)
      for (int k = 0; k < n[dim]; ++k) {
        const int tag = number();
        for (int c = 0; c < (dim == 0 ? 3 : 6); ++c)
          real();
        for (int p = number(); p > 0; --p)
          groups_of_entity_[{dim, tag}].push_back(std::abs(number()));
        if (dim > 0)
          for (int b = number(); b > 0; --b)
            number();
      }
  }
  void add_node(int tag)
  {
    number_of_[tag] = int(mesh_.nodes.size());
    Vector<3> &x = mesh_.nodes.emplace_back();
    for (int c = 0; c < 3; ++c)
      x[c] = real();
  }
  void read_nodes_2()
  {
    for (int n = number(); n > 0; --n)
      add_node(number());
  }
  void read_nodes_4()
  {
    const int n_blocks = number();
    for (int k = 0; k < 3; ++k)
      number();
    for (int b = 0; b < n_blocks; ++b) {
      number();
      number();
      if (number() != 0)
        fail("has parametric nodes", "places are read alone", "save it without parameters");
      std::vector<int> tags; // as many as there are, whatever number is announced
      for (int n = number(); n > 0; --n)
        tags.push_back(number());
      for (const int tag : tags)
        add_node(tag);
    }
  }
  /// Its name is that of the first group that has one. Version 2.2 repeats an element for each.
  /// Points are read and left.
  void add_element(int type, const std::vector<int> &groups)
  {
    const auto kind = kinds.find(type);
    if (kind == kinds.end())
      fail(fmt::format("has elements of type {}", type),
           "lines, triangles, quadrilaterals, tetrahedra and hexahedra of first and second order "
           "are read",
           "mesh it with these");
    const auto &[dim, n_nodes, n_corners] = kind->second;
    GmshMesh::Element element;
    for (int k = 0; k < n_nodes; ++k) {
      const auto node = number_of_.find(number());
      if (node == number_of_.end())
        fail("names a node that is not there", "an element has it", "save it anew");
      if (k < n_corners)
        element.corners.push_back(node->second);
    }
    for (const int group : groups)
      if (const auto name = names_.find({dim, group}); name != names_.end()) {
        if (element.name.empty())
          element.name = name->second;
        used_.insert(name->first);
      }
    if (dim == 0)
      return;
    mesh_.was_second_order |= n_nodes > n_corners;
    auto &elements = dim == 1 ? mesh_.lines : dim == 2 ? mesh_.faces : mesh_.volumes;
    std::vector<int> corners = element.corners;
    std::sort(corners.begin(), corners.end());
    const auto [seen, is_new] = seen_[dim - 1].emplace(std::move(corners), elements.size());
    if (is_new)
      elements.push_back(std::move(element));
    else if (std::string &name = elements[seen->second].name; name.empty())
      name = element.name;
  }
  void read_elements_2()
  {
    for (int n = number(); n > 0; --n) {
      number();
      const int type = number();
      int group = 0;
      for (int t = number(), k = 0; k < t; ++k)
        (k == 0 ? group : last_) = number();
      add_element(type, {group});
    }
  }
  void read_elements_4()
  {
    const int n_blocks = number();
    for (int k = 0; k < 3; ++k)
      number();
    for (int b = 0; b < n_blocks; ++b) {
      const int dim = number(), tag = number(), type = number();
      const std::vector<int> &groups = groups_of_entity_[{dim, tag}];
      for (int n = number(); n > 0; --n) {
        number();
        add_element(type, groups);
      }
    }
  }

  const std::string file_, key_;
  std::ifstream in_;
  bool is_new_ = true;
  int last_ = 0;                                                     // a number that counts nothing
  std::map<std::pair<int, int>, std::string> names_;                 // dimension and tag of a group
  std::map<std::pair<int, int>, std::vector<int>> groups_of_entity_; // dimension and tag of it
  std::set<std::pair<int, int>> used_;
  std::array<std::map<std::vector<int>, std::size_t>, 3> seen_; // by dimension: corners, element
  std::map<int, int> number_of_; // of nodes, by tag
  GmshMesh mesh_;
};
} // namespace

GmshMesh read_gmsh(const std::string &file, const std::string &key)
{
  return Reader(file, key).read();
}
} // namespace ligament::program
