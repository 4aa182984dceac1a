#include "src/output/xyz.h"

#include "core/files.h"

#include <fmt/format.h>

namespace ligament::program
{
namespace
{
/// What one of these is in SI.
struct Unit
{
  const char *of; // unit of the field
  double size;
};
constexpr double angstrom = 1e-10;
constexpr Unit units[] = {
    {"m", angstrom}, {"m/s", 100}, {"J", 1.602176634e-19}, {"Pa", 1e9}, {"1", 1}};

double unit_of(const Field &field)
{
  for (const Unit &unit : units)
    if (field.unit == unit.of)
      return unit.size;
  return 1;
}
} // namespace

void write_atoms_xyz(const std::string &path, const ParticleFields &atoms, double time)
{
  const Field *displacement = find_field(atoms.fields, "displacement"),
              *material = find_field(atoms.fields, "material");
  std::string columns = "species:S:1:pos:R:3";
  std::vector<const Field *> written;
  for (const Field &field : atoms.fields)
    if (&field != displacement && &field != material && field.name != "radius") {
      written.push_back(&field);
      columns +=
          fmt::format(":{}:{}:{}", field.name == "velocity" ? "velo" : field.name,
                      field.storage == Field::Storage::int64 ? "I" : "R", field.n_components());
    }
  std::string text = fmt::format("{}\nProperties={} Time={:.9g} time_unit=ps\n", atoms.size(),
                                 columns, time / 1e-12);
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    text += atoms.symbols[material ? std::size_t(material->values[i]) : 0];
    for (int c = 0; c < 3; ++c) {
      const double u = displacement ? displacement->values[3 * i + c] : 0;
      fmt::format_to(out, " {:.8f}", (atoms.reference[3 * i + c] + u) / angstrom);
    }
    for (const Field *field : written) {
      const int n = field->n_components();
      for (int c = 0; c < n; ++c)
        if (field->storage == Field::Storage::int64)
          fmt::format_to(out, " {}", std::int64_t(field->values[n * i + c]));
        else
          fmt::format_to(out, " {:.7g}", field->values[n * i + c] / unit_of(*field));
    }
    text += '\n';
  }
  core::write_file(path, text);
}
} // namespace ligament::program
