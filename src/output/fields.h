// What both models show at one time, as plain arrays: the common ground of VTK files and pictures.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ligament::program
{
/// A quantity on particles, nodes or cells. Both models use the names and units of field_table().
struct Field
{
  enum class Kind
  {
    scalar, // 1 number per item
    vector, // 3 numbers, z = 0 in 2D
    tensor  // 6 numbers: xx, yy, zz, xy, yz, xz
  };
  enum class Storage
  {
    float32,
    float64,
    int64
  };
  std::string name;
  std::string unit; // "1" for plain numbers
  Kind kind = Kind::scalar;
  std::vector<double> values; // item by item
  Storage storage = Storage::float32;

  int n_components() const { return kind == Kind::scalar ? 1 : kind == Kind::vector ? 3 : 6; }
};

/// Particles: reference centres and fields. x, y, z per particle also in 2D (z = 0).
struct ParticleFields
{
  std::vector<double> reference; // m
  std::vector<Field> fields;
  std::vector<std::string> symbols = {}; // chemical, of the materials of atoms; else empty

  std::size_t size() const { return reference.size() / 3; }
};

/// Cells of the far field: quadrilaterals or hexahedra with their nodes in the order of VTK
/// (counter-clockwise; bottom face then top face).
struct CellFields
{
  int dimension = 2;
  std::vector<double> reference;          // m, x, y, z per node
  std::vector<std::int64_t> connectivity; // 2^dimension nodes per cell
  std::vector<Field> node_fields;
  std::vector<Field> cell_fields;

  int nodes_per_cell() const { return 1 << dimension; }
  std::size_t n_nodes() const { return reference.size() / 3; }
  std::size_t n_cells() const { return connectivity.size() / nodes_per_cell(); }
};

/// A face that broke. Positions of the reference configuration.
struct BrokenBond
{
  std::int64_t i, j;  // global ids of the particles
  double time;        // s
  double centroid[3]; // m
  double normal[3];   // unit, from i to j
  double size;        // 2D: length of the face, m; 3D: its area, m^2
  double energy;      // J, released by the face
};

/// A rigid tool as pictures show it.
struct ToolOutline
{
  std::vector<double> points;         // m, two ends of x, y, z per edge, where the run began
  std::array<double, 3> displacement; // m
  /// Three rows of a turn x' = R x + t of the points, before the displacement; empty: it has none.
  std::vector<double> turn = {};
};

/// Its points turned, without the displacement.
std::vector<double> turned_points(const ToolOutline &tool);

/// A body at one time that is worth keeping: what pictures are drawn from, during a run and later.
struct BodyState
{
  std::string name;    // of its files
  std::string caption; // "Near the peak load"
  double time = 0;     // s
  ParticleFields particles;
  CellFields cells;
  std::vector<BrokenBond> bonds; // broken by then
  std::vector<BrokenBond> cuts;  // faces that initial cracks cut
  std::vector<ToolOutline> tools;
};

/// A field that runs write, and where.
struct FieldInfo
{
  std::string name, unit;
  Field::Kind kind;
  Field::Storage storage;
  bool on_particles, on_nodes, on_cells;
  enum class Only
  {
    anywhere,
    where_it_flows, // a material
    of_atoms
  };
  Only only = Only::anywhere;
};
const std::vector<FieldInfo> &field_table();

/// A field of the table with these values; InputError for another name.
Field make_field(const std::string &name, std::vector<double> values);

/// What the numbers of the field `zone` mean.
enum class ZoneNumber
{
  discrete,   // discrete elements alone
  overlap,    // both models
  pad,        // particles that move with the mesh
  transition, // cells behind the overlap, which the coupler moves
  far         // finite elements alone
};

/// Von Mises of a tensor xx, yy, zz, xy, yz, xz.
double equivalent_stress(const double *stress);
std::vector<double> equivalent_stress(const std::vector<double> &stress);

/// Two unit vectors that span the plane of a face with unit normal n; the first one has z = 0, in
/// 2D it is the direction of the face.
std::array<std::array<double, 3>, 2> face_tangents(const double *n);

/// The field of this name; null when there is none.
const Field *find_field(const std::vector<Field> &fields, const std::string &name);
} // namespace ligament::program
