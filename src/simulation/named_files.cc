#include "src/simulation/named_files.h"

#include "core/files.h"
#include "core/keyed_error.h"

#include <fmt/format.h>

#include <zlib.h>

namespace ligament::program
{
namespace
{
void keep(const char *name, const std::string &key, const std::string &file, Reference &reference)
{
  if (file.empty())
    return;
  const std::string text = core::read_file(file);
  const double sum =
      double(crc32_z(0, reinterpret_cast<const Bytef *>(text.data()), text.size()));
  if (reference.value(name, [&] { return sum; }) != sum)
    throw core::KeyedError(key, fmt::format("{} is not the file that the run began with", file),
                           "the state of the run belongs to what it held then",
                           "put it back as it was, or repeat the run");
}
} // namespace

void keep_named_files(const Scene &scene, Reference &reference)
{
  keep("specimen_file_checksum", "/specimen/file", scene.specimen.file, reference);
  if (scene.atoms)
    keep("atoms_file_checksum", "/atoms/file", scene.atoms->file, reference);
}
} // namespace ligament::program
