// Where a value was written: file, line and column, or the command line option.
#pragma once

#include <string>

namespace ligament::core
{
/// Lines and columns count from 1, columns in characters; line 0: the origin has no lines.
struct Place
{
  std::string origin; // file name or "--set /path"
  int line = 0;
  int column = 0;
};

/// "scene.json:14:7", or the origin alone.
inline std::string to_string(const Place &place)
{
  return place.line == 0
             ? place.origin
             : place.origin + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}
} // namespace ligament::core
