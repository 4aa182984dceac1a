#include "src/output/vtk.h"

#include "core/check.h"
#include "core/files.h"
#include "core/folders.h"
#include "src/output/format.h"
#include "src/output/xyz.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace ligament::program
{
namespace
{
/// Bytes that are compressed together.
constexpr std::size_t block_size = 1 << 18;

/// Header (number of blocks, size of a block, of the last one if it is not full, compressed sizes),
/// then the blocks; both in base64.
std::string compressed(const std::string &bytes)
{
  const std::size_t n_blocks = (bytes.size() + block_size - 1) / block_size;
  std::vector<std::uint64_t> header = {n_blocks, block_size, bytes.size() % block_size};
  std::string blocks, block(compressBound(block_size), '\0');
  for (std::size_t b = 0; b < n_blocks; ++b) {
    const std::size_t begin = b * block_size;
    uLongf size = block.size();
    const int error = compress2(reinterpret_cast<Bytef *>(block.data()), &size,
                                reinterpret_cast<const Bytef *>(bytes.data() + begin),
                                std::min(block_size, bytes.size() - begin), Z_BEST_SPEED);
    core::require<core::EnvironmentError>(error == Z_OK, "zlib: out of memory");
    header.push_back(size);
    blocks.append(block, 0, size);
  }
  return base64(header.data(), header.size() * sizeof(header[0])) +
         base64(blocks.data(), blocks.size());
}

template <typename T>
std::string packed(const std::vector<double> &values)
{
  std::string bytes(values.size() * sizeof(T), '\0');
  auto *target = bytes.data();
  for (const double value : values) {
    const T converted = static_cast<T>(value);
    target = std::copy_n(reinterpret_cast<const char *>(&converted), sizeof(T), target);
  }
  return bytes;
}

const char *type_name(Field::Storage storage)
{
  return storage == Field::Storage::float32   ? "Float32"
         : storage == Field::Storage::float64 ? "Float64"
                                              : "Int64";
}

std::string component_names(Field::Kind kind)
{
  if (kind != Field::Kind::tensor)
    return "";
  static constexpr std::array<const char *, 6> names = {"XX", "YY", "ZZ", "XY", "YZ", "XZ"};
  std::string text;
  for (std::size_t c = 0; c < names.size(); ++c)
    text += fmt::format(" ComponentName{}=\"{}\"", c, names[c]);
  return text;
}

void write_array(core::OutputFile &file, const Field &field, std::size_t n_items)
{
  core::require(field.values.size() == n_items * field.n_components(),
                "field '" + field.name + "': wrong number of values");
  std::string bytes;
  switch (field.storage) {
  case Field::Storage::float32:
    bytes = packed<float>(field.values);
    break;
  case Field::Storage::float64:
    bytes = packed<double>(field.values);
    break;
  case Field::Storage::int64:
    bytes = packed<std::int64_t>(field.values);
  }
  file.write(fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{} "
                         "format=\"binary\">\n",
                         type_name(field.storage), escape_xml(field.name), field.n_components(),
                         component_names(field.kind)));
  file.write(compressed(bytes));
  // After the data: readers take the data from right behind the opening tag.
  if (!field.unit.empty() && field.unit != "1")
    file.write(fmt::format("\n<InformationKey name=\"UNITS_LABEL\" "
                           "location=\"vtkDataArray\">{}</InformationKey>",
                           escape_xml(field.unit)));
  file.write("\n</DataArray>\n");
}

void write_fields(core::OutputFile &file, const char *element, const std::vector<Field> &fields,
                  std::size_t n_items)
{
  file.write(fmt::format("<{}>\n", element));
  for (const auto &field : fields)
    write_array(file, field, n_items);
  file.write(fmt::format("</{}>\n", element));
}

void write_points(core::OutputFile &file, const std::vector<double> &points)
{
  file.write("<Points>\n");
  write_array(file, {"Points", "m", Field::Kind::vector, points, Field::Storage::float64},
              points.size() / 3);
  file.write("</Points>\n");
}

/// Cells that all have the same number of points.
void write_topology(core::OutputFile &file, const char *element,
                    const std::vector<double> &connectivity, std::size_t points_per_cell,
                    int vtk_type = 0)
{
  const std::size_t n_cells = connectivity.size() / points_per_cell;
  std::vector<double> offsets(n_cells);
  for (std::size_t c = 0; c < n_cells; ++c)
    offsets[c] = double((c + 1) * points_per_cell);
  file.write(fmt::format("<{}>\n", element));
  const auto integers = [&](const char *name, const std::vector<double> &values) {
    write_array(file, {name, "", Field::Kind::scalar, values, Field::Storage::int64},
                values.size());
  };
  integers("connectivity", connectivity);
  integers("offsets", offsets);
  if (vtk_type != 0) {
    file.write("<DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">\n");
    file.write(compressed(std::string(n_cells, char(vtk_type))));
    file.write("\n</DataArray>\n");
  }
  file.write(fmt::format("</{}>\n", element));
}

std::vector<double> counting(std::size_t n)
{
  std::vector<double> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0.);
  return numbers;
}

/// Opens the file elements, lets `body` write the piece and puts the file in its place.
template <typename Body>
void write_dataset(const std::string &path, const char *type, const std::string &counts,
                   Body &&body)
{
  core::OutputFile file(path);
  file.write(fmt::format("<?xml version=\"1.0\"?>\n"
                         "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
                         "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
                         "<{0}>\n<Piece {1}>\n",
                         type, counts));
  body(file);
  file.write(fmt::format("</Piece>\n</{}>\n</VTKFile>\n", type));
  file.commit();
}

} // namespace

void write_particles_vtp(const std::string &path, const ParticleFields &particles)
{
  const std::size_t n = particles.size();
  write_dataset(path, "PolyData", fmt::format("NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\"", n),
                [&](core::OutputFile &file) {
                  write_fields(file, "PointData", particles.fields, n);
                  write_points(file, particles.reference);
                  write_topology(file, "Verts", counting(n), 1);
                });
}

void write_particles_pvtp(const std::string &path, const ParticleFields &like,
                          const std::vector<std::string> &files)
{
  const auto array = [](const Field &field) {
    return fmt::format("<PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{}/>\n",
                       type_name(field.storage), escape_xml(field.name), field.n_components(),
                       component_names(field.kind));
  };
  std::string text = "<?xml version=\"1.0\"?>\n"
                     "<VTKFile type=\"PPolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                     "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
                     "<PPolyData GhostLevel=\"0\">\n<PPointData>\n";
  for (const Field &field : like.fields)
    text += array(field);
  text += "</PPointData>\n<PPoints>\n" +
          array({"Points", "m", Field::Kind::vector, {}, Field::Storage::float64}) + "</PPoints>\n";
  for (const std::string &file : files)
    text += fmt::format("<Piece Source=\"{}\"/>\n", escape_xml(file));
  core::write_file(path, text + "</PPolyData>\n</VTKFile>\n");
}

void write_cells_vtu(const std::string &path, const CellFields &cells)
{
  constexpr int vtk_quad = 9, vtk_hexahedron = 12;
  write_dataset(
      path, "UnstructuredGrid",
      fmt::format("NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", cells.n_nodes(), cells.n_cells()),
      [&](core::OutputFile &file) {
        write_fields(file, "PointData", cells.node_fields, cells.n_nodes());
        write_fields(file, "CellData", cells.cell_fields, cells.n_cells());
        write_points(file, cells.reference);
        write_topology(file, "Cells", {cells.connectivity.begin(), cells.connectivity.end()},
                       cells.nodes_per_cell(), cells.dimension == 2 ? vtk_quad : vtk_hexahedron);
      });
}

void write_broken_bonds_vtp(const std::string &path, const std::vector<BrokenBond> &bonds,
                            int dimension)
{
  const std::size_t n = bonds.size(), corners = dimension == 2 ? 2 : 4;
  using Kind = Field::Kind;
  using Storage = Field::Storage;
  std::vector<double> points;
  Field time{"time", "s", Kind::scalar, {}, Storage::float64};
  Field normal{"normal", "1", Kind::vector, {}, Storage::float32};
  Field energy{"energy", "J", Kind::scalar, {}, Storage::float32};
  Field size{"size", dimension == 2 ? "m" : "m^2", Kind::scalar, {}, Storage::float32};
  Field i{"global_id_i", "1", Kind::scalar, {}, Storage::int64};
  Field j{"global_id_j", "1", Kind::scalar, {}, Storage::int64};
  for (const auto &bond : bonds) {
    const auto [t, s] = face_tangents(bond.normal);
    const double half = 0.5 * (dimension == 2 ? bond.size : std::sqrt(bond.size));
    static constexpr double along_t[] = {-1, 1, 1, -1}, along_s[] = {-1, -1, 1, 1};
    for (std::size_t k = 0; k < corners; ++k)
      for (int c = 0; c < 3; ++c)
        points.push_back(bond.centroid[c] + half * along_t[k] * t[c] +
                         (dimension == 3 ? half * along_s[k] * s[c] : 0));
    time.values.push_back(bond.time);
    normal.values.insert(normal.values.end(), bond.normal, bond.normal + 3);
    energy.values.push_back(bond.energy);
    size.values.push_back(bond.size);
    i.values.push_back(double(bond.i));
    j.values.push_back(double(bond.j));
  }
  write_dataset(path, "PolyData",
                fmt::format("NumberOfPoints=\"{}\" {}=\"{}\"", n * corners,
                            dimension == 2 ? "NumberOfLines" : "NumberOfPolys", n),
                [&](core::OutputFile &file) {
                  write_fields(file, "CellData", {time, normal, energy, size, i, j}, n);
                  write_points(file, points);
                  write_topology(file, dimension == 2 ? "Lines" : "Polys", counting(n * corners),
                                 corners);
                });
}

FieldSeries::FieldSeries(RunFolder folder, int dimension)
    : folder_(std::move(folder)), dimension_(dimension)
{
}

namespace
{
std::string number(std::size_t n)
{
  return fmt::format("{:04}", n);
}

std::string bonds_file(const std::string &name)
{
  return "fields/broken_bonds_" + name + ".vtp";
}

std::string particles_file(const std::string &name, bool in_pieces)
{
  return fmt::format("fields/particles_{}.{}", name, in_pieces ? "pvtp" : "vtp");
}

/// Beside the file of all pieces.
std::string piece_file(const std::string &name, int number)
{
  return fmt::format("particles_{}_{}.vtp", name, number);
}

StateFiles files_of(const std::string &name, bool has_particles, bool has_cells, bool in_pieces)
{
  StateFiles files;
  if (has_particles)
    files.particles = particles_file(name, in_pieces);
  if (has_cells)
    files.cells = "fields/cells_" + name + ".vtu";
  return files;
}
} // namespace

StateFiles FieldSeries::files(const BodyState &state, const std::string &name, const Piece &piece)
{
  // A rank without particles has fields without values.
  return files_of(name, !state.particles.fields.empty(), state.cells.n_cells() > 0, piece.of > 1);
}

void FieldSeries::write_particles(const BodyState &state, const std::string &name,
                                  const Piece &piece) const
{
  const std::string file = folder_.path + "/" + particles_file(name, piece.of > 1);
  const auto beside = [&](int k) { return folder_.path + "/fields/" + piece_file(name, k); };
  if (piece.of == 1)
    write_particles_vtp(file, state.particles);
  else
    write_particles_vtp(beside(piece.number), state.particles);
  if (piece.number > 0)
    return;
  if (piece.of > 1) {
    std::vector<std::string> files;
    for (int k = 0; k < piece.of; ++k)
      files.push_back(piece_file(name, k));
    write_particles_pvtp(file, state.particles, files);
  }
  // What a run wrote there before it was cut back, on another number of ranks.
  const std::string other = folder_.path + "/" + particles_file(name, piece.of == 1);
  if (std::filesystem::exists(other))
    core::remove_file(other);
}

void FieldSeries::write(const BodyState &state, const Piece &piece)
{
  const std::string name = state.name.empty() ? number(times_.size()) : state.name;
  const StateFiles files = FieldSeries::files(state, name, piece);
  if (state.name.empty())
    times_.push_back(state.time);
  if (!files.particles.empty())
    write_particles(state, name, piece);
  if (piece.number > 0)
    return;
  if (!files.particles.empty()) {
    if (!state.particles.symbols.empty())
      write_atoms_xyz(fmt::format("{}/fields/atoms_{}.xyz", folder_.path, name), state.particles,
                      state.time);
    // Also while nothing is broken: a part must exist at every time or at none.
    write_broken_bonds_vtp(folder_.path + "/" + bonds_file(name), state.bonds, dimension_);
  }
  if (!files.cells.empty())
    write_cells_vtu(folder_.path + "/" + files.cells, state.cells);
  add(state.time, name, files);
  write_collection();
}

void FieldSeries::go_on(const std::vector<double> &times, bool has_particles, bool has_cells)
{
  for (const double time : times) {
    const std::string name = number(times_.size());
    const bool in_pieces = std::filesystem::exists(folder_.path + "/" + particles_file(name, true));
    add(time, name, files_of(name, has_particles, has_cells, in_pieces));
    times_.push_back(time);
  }
  std::error_code none;
  if (!times.empty())
    write_collection();
  else // without states there is no collection
    std::filesystem::remove(folder_.pvd(), none);
}

void FieldSeries::add(double time, const std::string &name, const StateFiles &files)
{
  if (!files.particles.empty()) {
    add(time, 0, files.particles);
    add(time, 2, bonds_file(name));
  }
  if (!files.cells.empty())
    add(time, 1, files.cells);
}

void FieldSeries::add(double time, int part, const std::string &file)
{
  const auto same = [&](const Entry &e) { return e.time == time && e.part == part; };
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(), same), entries_.end());
  const auto later =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry &e) { return e.time > time; });
  entries_.insert(later, {time, part, file});
}

void FieldSeries::write_collection() const
{
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                     "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const auto &entry : entries_)
    text += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" file=\"{}\"/>\n", entry.time,
                        entry.part, entry.file);
  core::write_file(folder_.pvd(), text + "</Collection>\n</VTKFile>\n");
}
} // namespace ligament::program
