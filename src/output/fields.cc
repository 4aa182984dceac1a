#include "src/output/fields.h"

#include "core/check.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
const std::vector<FieldInfo> &field_table()
{
  using Kind = Field::Kind;
  using Only = FieldInfo::Only;
  constexpr auto number = Field::Storage::float32, name = Field::Storage::int64;
  static const std::vector<FieldInfo> table = {
      {"displacement", "m", Kind::vector, number, true, true, false},
      {"velocity", "m/s", Kind::vector, number, true, true, false},
      {"stress", "Pa", Kind::tensor, number, true, true, false},
      {"equivalent_stress", "Pa", Kind::scalar, number, true, true, false},
      {"radius", "m", Kind::scalar, number, true, false, false},
      {"global_id", "1", Kind::scalar, name, true, false, false},
      {"material", "1", Kind::scalar, name, true, false, true},
      {"zone", "1", Kind::scalar, name, true, false, true},
      {"softened", "1", Kind::scalar, number, false, false, false}, // where faces soften
      {"opening", "m", Kind::scalar, number, false, false, false},
      {"broken_bond_share", "1", Kind::scalar, number, true, false, false},
      {"plastic_strain", "1", Kind::scalar, number, true, false, false, Only::where_it_flows},
      {"inelastic_strain", "1", Kind::tensor, number, true, false, false, Only::where_it_flows},
      {"potential_energy", "J", Kind::scalar, number, true, false, false, Only::of_atoms},
      {"centro_symmetry", "1", Kind::scalar, number, true, false, false, Only::of_atoms},
      {"coordination", "1", Kind::scalar, number, true, false, false, Only::of_atoms}};
  return table;
}

Field make_field(const std::string &name, std::vector<double> values)
{
  for (const FieldInfo &info : field_table())
    if (info.name == name)
      return {name, info.unit, info.kind, std::move(values), info.storage};
  throw core::InputError("there is no field '" + name + "'");
}

double equivalent_stress(const double *s)
{
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) +
                   3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

std::vector<double> equivalent_stress(const std::vector<double> &stress)
{
  std::vector<double> values(stress.size() / 6);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = equivalent_stress(&stress[6 * i]);
  return values;
}

std::array<std::array<double, 3>, 2> face_tangents(const double *n)
{
  // Close to the z axis every direction in the plane z = 0 will do.
  const double in_plane = std::hypot(n[0], n[1]);
  std::array<double, 3> t = {1, 0, 0};
  if (in_plane > 1e-6)
    t = {-n[1] / in_plane, n[0] / in_plane, 0};
  std::array<double, 3> s = {n[1] * t[2] - n[2] * t[1], n[2] * t[0] - n[0] * t[2],
                             n[0] * t[1] - n[1] * t[0]};
  const double length = std::hypot(s[0], s[1], s[2]);
  for (double &c : s)
    c /= length;
  return {t, s};
}

const Field *find_field(const std::vector<Field> &fields, const std::string &name)
{
  const auto field =
      std::find_if(fields.begin(), fields.end(), [&](const Field &f) { return f.name == name; });
  return field == fields.end() ? nullptr : &*field;
}

std::vector<double> turned_points(const ToolOutline &tool)
{
  if (tool.turn.size() != 12)
    return tool.points;
  std::vector<double> points;
  for (std::size_t k = 0; k < tool.points.size(); k += 3)
    for (const double *row = tool.turn.data(); row < tool.turn.data() + 12; row += 4)
      points.push_back(row[0] * tool.points[k] + row[1] * tool.points[k + 1] +
                       row[2] * tool.points[k + 2] + row[3]);
  return points;
}
} // namespace ligament::program
