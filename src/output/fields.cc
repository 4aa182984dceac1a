#include "src/output/fields.h"

#include <algorithm>
#include <cmath>

namespace ligament::program
{
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
} // namespace ligament::program
