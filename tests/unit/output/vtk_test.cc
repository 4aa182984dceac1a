// VTK files, decoded by a reader of their own.
#include "src/output/vtk.h"

#include "core/check.h"
#include "core/files.h"
#include "src/drawing/run_pictures.h"
#include "src/output/broken_bonds.h"
#include "src/output/vtk_reader.h"
#include "tests/unit/output/xml.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>

using namespace ligament;
using namespace ligament::program;

namespace
{
std::string from_base64(const std::string &text)
{
  std::string bytes;
  unsigned group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=' || std::isspace(static_cast<unsigned char>(c)))
      continue;
    const int digit = c >= 'A' && c <= 'Z'   ? c - 'A'
                      : c >= 'a' && c <= 'z' ? c - 'a' + 26
                      : c >= '0' && c <= '9' ? c - '0' + 52
                      : c == '+'             ? 62
                                             : 63;
    group = group << 6 | unsigned(digit);
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes += char(group >> bits & 0xff);
    }
  }
  return bytes;
}

/// Header in one piece of base64, blocks in another: their lengths follow from the header.
std::string decode(const std::string &inline_text)
{
  std::string text;
  for (const char c : inline_text)
    if (!std::isspace(static_cast<unsigned char>(c)))
      text += c;
  const auto encoded_length = [](std::size_t n) { return (n + 2) / 3 * 4; };
  std::uint64_t head[3];
  std::memcpy(head, from_base64(text.substr(0, 32)).data(), sizeof(head));
  const std::size_t header_bytes = 8 * (3 + head[0]);
  const std::string header = from_base64(text.substr(0, encoded_length(header_bytes)));
  const std::string blocks = from_base64(text.substr(encoded_length(header_bytes)));
  std::string bytes;
  std::size_t at = 0;
  for (std::uint64_t b = 0; b < head[0]; ++b) {
    std::uint64_t size;
    std::memcpy(&size, header.data() + 8 * (3 + b), 8);
    const bool last = b + 1 == head[0];
    std::string block(last && head[2] > 0 ? head[2] : head[1], '\0');
    uLongf length = block.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef *>(block.data()), &length,
                         reinterpret_cast<const Bytef *>(blocks.data() + at), size),
              Z_OK);
    EXPECT_EQ(length, block.size());
    bytes += block;
    at += size;
  }
  EXPECT_EQ(at, blocks.size());
  return bytes;
}

class VtkFile
{
public:
  explicit VtkFile(const std::string &path) : elements_(tests::parse_xml(core::read_file(path))) {}

  std::vector<double> array(const std::string &name) const
  {
    for (const auto &element : elements_)
      if (element.name == "DataArray" && element.attributes.at("Name") == name) {
        const std::string bytes = decode(element.text), type = element.attributes.at("type");
        return type == "Float32"   ? values<float>(bytes)
               : type == "Float64" ? values<double>(bytes)
               : type == "Int64"   ? values<std::int64_t>(bytes)
                                   : values<std::uint8_t>(bytes);
      }
    ADD_FAILURE() << "no array " << name;
    return {};
  }

  std::string attribute(const std::string &element_name, const std::string &attribute) const
  {
    for (const auto &element : elements_)
      if (element.name == element_name)
        return element.attributes.at(attribute);
    return "";
  }

  bool has_unit(const std::string &unit) const
  {
    for (const auto &element : elements_)
      if (element.name == "InformationKey" && element.text == unit)
        return true;
    return false;
  }

private:
  template <typename T>
  static std::vector<double> values(const std::string &bytes)
  {
    std::vector<T> typed(bytes.size() / sizeof(T));
    if (!typed.empty())
      std::memcpy(typed.data(), bytes.data(), bytes.size());
    return {typed.begin(), typed.end()};
  }

  std::vector<tests::Element> elements_;
};

ParticleFields some_particles(int n)
{
  ParticleFields particles;
  Field u{"displacement", "m", Field::Kind::vector, {}, Field::Storage::float64};
  Field stress{"stress", "Pa", Field::Kind::tensor, {}, Field::Storage::float32};
  Field id{"global_id", "1", Field::Kind::scalar, {}, Field::Storage::int64};
  for (int i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) {
      particles.reference.push_back(std::sin(3. * i + c));
      u.values.push_back(std::cos(7. * i + c) / 3);
    }
    for (int c = 0; c < 6; ++c)
      stress.values.push_back(float(1e6 * std::sin(6. * i + c)));
    id.values.push_back(double(i) + (std::int64_t(1) << 40));
  }
  particles.fields = {u, stress, id};
  return particles;
}

// 20 000 particles make several compressed blocks, the last one not full; 0 make none.
TEST(Vtk, ParticlesComeBack)
{
  for (const int n : {0, 1, 20000}) {
    const ParticleFields particles = some_particles(n);
    write_particles_vtp("particles.vtp", particles);
    const VtkFile file("particles.vtp");
    EXPECT_EQ(file.attribute("VTKFile", "header_type"), "UInt64");
    EXPECT_EQ(file.attribute("Piece", "NumberOfPoints"), std::to_string(n));
    EXPECT_EQ(file.array("Points"), particles.reference);
    for (const auto &field : particles.fields)
      EXPECT_EQ(file.array(field.name), field.values) << field.name;
    const auto offsets = file.array("offsets");
    ASSERT_EQ(offsets.size(), std::size_t(n));
    for (int i = 0; i < n; ++i)
      ASSERT_EQ(offsets[i], i + 1);
    EXPECT_TRUE(file.has_unit("m"));
    EXPECT_TRUE(file.has_unit("Pa"));
  }
}

TEST(Vtk, CellsComeBack)
{
  for (const int dimension : {2, 3}) {
    CellFields cells;
    cells.dimension = dimension;
    const int n = cells.nodes_per_cell();
    for (int i = 0; i < 2 * n; ++i)
      cells.reference.insert(cells.reference.end(), {0.1 * i, 0.2 * i, 0.3 * i});
    for (int i = 0; i < 2 * n; ++i)
      cells.connectivity.push_back(2 * n - 1 - i);
    cells.cell_fields = {{"level", "1", Field::Kind::scalar, {3, 4}, Field::Storage::float32}};
    write_cells_vtu("cells.vtu", cells);
    const VtkFile file("cells.vtu");
    EXPECT_EQ(file.array("Points"), cells.reference);
    EXPECT_EQ(file.array("connectivity"),
              std::vector<double>(cells.connectivity.begin(), cells.connectivity.end()));
    EXPECT_EQ(file.array("offsets"), (std::vector<double>{double(n), 2. * n}));
    const double type = dimension == 2 ? 9 : 12; // VTK_QUAD, VTK_HEXAHEDRON
    EXPECT_EQ(file.array("types"), (std::vector<double>{type, type}));
    EXPECT_EQ(file.array("level"), (std::vector<double>{3, 4}));
  }
}

// The segment of a face is centred on it, as long as it and perpendicular to its normal.
TEST(Vtk, BrokenBondsAreSegmentsAndSquares)
{
  const double size = 0.25;
  const BrokenBond bond{3, 8, 1.5e-5, {1, 2, 0.5}, {0.6, 0.8, 0}, size, 2e-6};
  for (const int dimension : {2, 3}) {
    write_broken_bonds_vtp("broken.vtp", {bond}, dimension);
    const VtkFile file("broken.vtp");
    const auto points = file.array("Points");
    const std::size_t corners = dimension == 2 ? 2 : 4;
    ASSERT_EQ(points.size(), 3 * corners);
    double across[3];
    for (int c = 0; c < 3; ++c) {
      across[c] = points[3 * (corners / 2) + c] - points[c];
      double mean = 0;
      for (std::size_t k = 0; k < corners; ++k)
        mean += points[3 * k + c] / double(corners);
      EXPECT_NEAR(mean, bond.centroid[c], 1e-14);
    }
    const double length = std::hypot(across[0], across[1], across[2]);
    EXPECT_NEAR(length, dimension == 2 ? size : std::sqrt(2 * size), 1e-14);
    EXPECT_NEAR(across[0] * bond.normal[0] + across[1] * bond.normal[1] +
                    across[2] * bond.normal[2],
                0, 1e-14);
    EXPECT_EQ(file.array("time"), std::vector<double>{bond.time});
    EXPECT_EQ(file.array("global_id_j"), std::vector<double>{8});
  }
}

TEST(Vtk, SeriesListsAllPartsOfAllTimes)
{
  std::filesystem::remove_all("series");
  const RunFolder folder{"series"};
  folder.create();
  FieldSeries series(folder, 2);
  BodyState state;
  state.particles = some_particles(2);
  state.cells.reference = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  state.cells.connectivity = {0, 1, 2, 3};
  series.write(state);
  state.time = 0.5;
  state.bonds = {{0, 1, 0.25, {0, 0, 0}, {1, 0, 0}, 1, 0}};
  series.write(state);
  int n = 0;
  for (const auto &element : tests::parse_xml(core::read_file(folder.pvd())))
    if (element.name == "DataSet") {
      const std::string file = "series/" + element.attributes.at("file");
      ASSERT_TRUE(std::filesystem::exists(file)) << file;
      tests::parse_xml(core::read_file(file));
      EXPECT_EQ(std::stod(element.attributes.at("timestep")), n < 3 ? 0 : 0.5);
      ++n;
    }
  EXPECT_EQ(n, 6); // three parts at two times
}

// States that a run kept come after the others but stand at their times, once.
TEST(Vtk, NamedStatesAreSortedIn)
{
  std::filesystem::remove_all("named");
  const RunFolder folder{"named"};
  folder.create();
  FieldSeries series(folder, 2);
  BodyState state;
  state.particles = some_particles(2);
  for (const double time : {0., 1., 2.}) {
    state.time = time;
    series.write(state);
  }
  state.name = "peak";
  state.time = 0.5;
  series.write(state);
  state.name = "end";
  state.time = 2;
  series.write(state);
  std::vector<double> times;
  std::string last;
  for (const auto &element : tests::parse_xml(core::read_file(folder.pvd())))
    if (element.name == "DataSet" && element.attributes.at("part") == "0") {
      times.push_back(std::stod(element.attributes.at("timestep")));
      last = element.attributes.at("file");
    }
  EXPECT_EQ(times, (std::vector<double>{0, 0.5, 1, 2}));
  EXPECT_EQ(last, "fields/particles_end.vtp");
}

// What a run kept can be drawn later: the same fields, and the faces broken by then.
TEST(Vtk, StatesAreReadBack)
{
  std::filesystem::remove_all("kept");
  const RunFolder folder{"kept"};
  folder.create();
  BodyState state;
  state.name = "peak";
  state.time = 0.5;
  state.particles = some_particles(20000);
  state.particles.fields[0].storage = Field::Storage::float64;
  for (const int dimension : {2, 3}) {
    state.cells.dimension = dimension;
    const int n = state.cells.nodes_per_cell();
    state.cells.reference.assign(3 * n, 0.25);
    state.cells.connectivity.clear();
    for (int i = 0; i < n; ++i)
      state.cells.connectivity.push_back(n - 1 - i);
    state.cells.cell_fields = {make_field("zone", {4})};
    FieldSeries(folder, dimension).write(state);
    write_broken_bonds(
        folder.broken_bonds(),
        {{0, 1, 0.25, {0, 0, 0}, {1, 0, 0}, 1, 0}, {1, 2, 0.75, {0, 0, 0}, {1, 0, 0}, 1, 0}},
        dimension);
    const StateFiles files = FieldSeries::files(state, "peak");
    const BodyState back =
        read_state(folder, {"peak", "near the peak load", 0.5, files.particles, files.cells});
    EXPECT_EQ(back.particles.reference, state.particles.reference);
    for (const Field &field : state.particles.fields)
      EXPECT_EQ(find_field(back.particles.fields, field.name)->values, field.values);
    EXPECT_EQ(back.cells.dimension, dimension);
    EXPECT_EQ(back.cells.connectivity, state.cells.connectivity);
    EXPECT_EQ(find_field(back.cells.cell_fields, "zone")->values, (std::vector<double>{4}));
    EXPECT_EQ(back.bonds.size(), 1u);
  }
  const std::string file = core::read_file("kept/fields/particles_peak.vtp");
  for (const std::size_t length : {std::size_t(10), file.size() / 2, file.size() - 20}) {
    core::write_file("kept/short.vtp", file.substr(0, length));
    EXPECT_THROW(read_particles_vtp("kept/short.vtp"), core::InputError);
  }
  std::string damaged = file;
  damaged[file.find("format=\"binary\">\n") + 100] ^= 1;
  core::write_file("kept/damaged.vtp", damaged);
  EXPECT_THROW(read_particles_vtp("kept/damaged.vtp"), core::InputError);
  EXPECT_THROW(read_particles_vtp("kept/absent.vtp"), core::InputError);
}

// As several ranks write them, in any order; what an earlier run wrote there in one piece goes.
TEST(Vtk, StatesInPiecesAreReadBack)
{
  std::filesystem::remove_all("pieces");
  const RunFolder folder{"pieces"};
  folder.create();
  BodyState state;
  state.time = 0.5;
  state.particles = some_particles(10);
  FieldSeries(folder, 2).write(state);
  const std::vector<std::size_t> cuts = {0, 3, 4, 10};
  for (const int k : {2, 0, 1}) {
    BodyState part = state;
    const auto take = [&](std::vector<double> &values, int n) {
      values = {values.begin() + long(n * cuts[k]), values.begin() + long(n * cuts[k + 1])};
    };
    take(part.particles.reference, 3);
    for (Field &field : part.particles.fields)
      take(field.values, field.n_components());
    FieldSeries(folder, 2).write(part, {k, 3});
  }
  EXPECT_FALSE(std::filesystem::exists("pieces/fields/particles_0000.vtp"));
  EXPECT_NE(core::read_file(folder.pvd()).find("\"fields/particles_0000.pvtp\""),
            std::string::npos);
  const BodyState back = read_state(folder, {"0000", "", 0.5, "fields/particles_0000.pvtp", ""});
  EXPECT_EQ(back.particles.reference, state.particles.reference);
  ASSERT_EQ(back.particles.fields.size(), state.particles.fields.size());
  for (const Field &field : state.particles.fields)
    EXPECT_EQ(find_field(back.particles.fields, field.name)->values, field.values) << field.name;

  FieldSeries more(folder, 2);
  more.go_on({0.5}, true, false);
  EXPECT_NE(core::read_file(folder.pvd()).find("\"fields/particles_0000.pvtp\""),
            std::string::npos);
  FieldSeries(folder, 2).write(state);
  EXPECT_FALSE(std::filesystem::exists("pieces/fields/particles_0000.pvtp"));

  std::filesystem::remove("pieces/fields/particles_0000_1.vtp");
  FieldSeries(folder, 2).write(state, {0, 3});
  EXPECT_THROW(read_particles_pvtp("pieces/fields/particles_0000.pvtp"), core::InputError);
}

TEST(Vtk, FullDiskAndWrongSizesAreNoticed)
{
  EXPECT_THROW(write_particles_vtp("/dev/full", some_particles(3)), core::EnvironmentError);
  ParticleFields wrong = some_particles(3);
  wrong.fields[0].values.pop_back();
  EXPECT_THROW(write_particles_vtp("wrong.vtp", wrong), core::InputError);
  EXPECT_FALSE(std::filesystem::exists("wrong.vtp"));
}
} // namespace
