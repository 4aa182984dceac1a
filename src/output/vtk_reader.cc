#include "src/output/vtk_reader.h"

#include "core/check.h"
#include "core/files.h"
#include "src/output/format.h"

#include <zlib.h>

#include <cstring>

namespace ligament::program
{
namespace
{
class Reader
{
public:
  explicit Reader(const std::string &path) : path_(path)
  {
    try {
      text_ = core::read_file(path);
    } catch (const core::EnvironmentError &error) {
      throw core::InputError(error.what());
    }
    good(text_.find("compressor=\"vtkZLibDataCompressor\"") != std::string::npos);
    good(text_.find("</VTKFile>") != std::string::npos);
  }

  /// All arrays of an element.
  std::vector<Field> arrays(const std::string &element) const
  {
    const std::size_t begin = text_.find("<" + element + ">");
    const std::size_t end = text_.find("</" + element + ">", begin);
    good(begin != std::string::npos && end != std::string::npos);
    std::vector<Field> fields;
    for (std::size_t at = begin; (at = text_.find("<DataArray", at)) < end; ++at)
      fields.push_back(array(at));
    return fields;
  }

  std::vector<double> array(const std::string &element, const std::string &name) const
  {
    const auto all = arrays(element);
    const Field *field = find_field(all, name);
    good(field != nullptr);
    return field->values;
  }

  /// The files of a set that lies in several.
  std::vector<std::string> pieces() const
  {
    std::vector<std::string> files;
    for (std::size_t at = 0; (at = text_.find("<Piece ", at)) != std::string::npos; ++at)
      files.push_back(attribute(text_.substr(at, text_.find('>', at) - at), "Source"));
    good(!files.empty());
    return files;
  }

private:
  void good(bool condition) const
  {
    core::require(condition, path_ + ": not a field file of this program, or cut short");
  }

  static std::string attribute(const std::string &tag, const std::string &name)
  {
    const std::size_t at = tag.find(name + "=\"");
    if (at == std::string::npos)
      return "";
    const std::size_t begin = at + name.size() + 2;
    return tag.substr(begin, tag.find('"', begin) - begin);
  }

  Field array(std::size_t at) const
  {
    const std::size_t end = text_.find('>', at), data_end = text_.find('<', end);
    good(end != std::string::npos && data_end != std::string::npos);
    const std::string tag = text_.substr(at, end - at);
    const std::string type = attribute(tag, "type"), n = attribute(tag, "NumberOfComponents");
    Field field;
    field.name = attribute(tag, "Name");
    field.kind = n == "3"   ? Field::Kind::vector
                 : n == "6" ? Field::Kind::tensor
                            : Field::Kind::scalar;
    const std::string bytes = unpacked(end + 1, data_end);
    if (type == "Float32")
      field.values = numbers<float>(bytes);
    else if (type == "Float64")
      field.values = numbers<double>(bytes);
    else if (type == "Int64")
      field.values = numbers<std::int64_t>(bytes);
    return field;
  }

  template <typename T>
  static std::vector<double> numbers(const std::string &bytes)
  {
    std::vector<double> values(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < values.size(); ++i) {
      T value;
      std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
      values[i] = double(value);
    }
    return values;
  }

  /// Header and blocks as the writer packs them.
  std::string unpacked(std::size_t begin, std::size_t end) const
  {
    while (begin < end && text_[begin] == '\n')
      ++begin;
    const auto encoded = [](std::size_t n) { return (n + 2) / 3 * 4; };
    const std::size_t start_size = 3 * sizeof(std::uint64_t);
    std::uint64_t start[3]; // number of blocks, size of a block, of the last one or 0
    const std::string first =
        from_base64(std::string_view(text_).substr(begin, encoded(start_size)));
    good(first.size() >= start_size);
    std::memcpy(start, first.data(), start_size);
    good(start[0] <= text_.size() && start[1] <= (1u << 30) && start[2] <= start[1]);
    const std::size_t header_size = start_size + 8 * start[0];
    good(begin + encoded(header_size) <= end);
    const std::string header =
        from_base64(std::string_view(text_).substr(begin, encoded(header_size)));
    begin += encoded(header_size);
    const std::string blocks = from_base64(std::string_view(text_).substr(begin, end - begin));
    std::string bytes, block;
    for (std::size_t b = 0, at = 0; b < start[0]; ++b) {
      std::uint64_t size;
      std::memcpy(&size, &header[start_size + 8 * b], sizeof(size));
      good(size <= blocks.size() - at);
      block.resize(b + 1 == start[0] && start[2] > 0 ? start[2] : start[1]);
      uLongf length = block.size();
      good(uncompress(reinterpret_cast<Bytef *>(block.data()), &length,
                      reinterpret_cast<const Bytef *>(&blocks[at]), size) == Z_OK &&
           length == block.size());
      bytes += block;
      at += size;
    }
    return bytes;
  }

  std::string path_, text_;
};
} // namespace

ParticleFields read_particles_vtp(const std::string &path)
{
  const Reader file(path);
  return {file.array("Points", "Points"), file.arrays("PointData")};
}

ParticleFields read_particles_pvtp(const std::string &path)
{
  const std::string folder = path.substr(0, path.find_last_of('/') + 1);
  ParticleFields all;
  for (const std::string &piece : Reader(path).pieces()) {
    ParticleFields part = read_particles_vtp(folder + piece);
    if (all.fields.empty()) {
      all = std::move(part);
      continue;
    }
    all.reference.insert(all.reference.end(), part.reference.begin(), part.reference.end());
    for (Field &field : all.fields) {
      const Field *more = find_field(part.fields, field.name);
      core::require(more != nullptr && more->kind == field.kind,
                    path + ": its pieces have different fields");
      field.values.insert(field.values.end(), more->values.begin(), more->values.end());
    }
  }
  return all;
}

CellFields read_cells_vtu(const std::string &path)
{
  const Reader file(path);
  CellFields cells;
  cells.reference = file.array("Points", "Points");
  const auto connectivity = file.array("Cells", "connectivity");
  cells.connectivity.assign(connectivity.begin(), connectivity.end());
  const auto offsets = file.array("Cells", "offsets");
  cells.dimension = !offsets.empty() && offsets[0] == 8 ? 3 : 2;
  cells.node_fields = file.arrays("PointData");
  cells.cell_fields = file.arrays("CellData");
  return cells;
}
} // namespace ligament::program
