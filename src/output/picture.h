// Pictures of specimen, zones and crack without a display: coloured particles, cells and lines.
#pragma once

#include "src/output/color.h"
#include "src/output/fields.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ligament::program
{
/// Particles drawn as discs (2D) or shaded spheres (3D). x, y, z per particle.
struct Scatter
{
  std::vector<double> positions; // m
  std::vector<double> values;    // one per particle; empty: all in `color`
  double radius = 0;             // m
  Color color = {120, 140, 160};
};

/// Quadrilaterals with corners in ring order; x, y, z per corner.
struct Quads
{
  std::vector<double> points;        // m
  std::vector<std::int64_t> corners; // 4 per quadrilateral
  std::vector<double> values;        // one per point, interpolated; empty: all in `color`
  Color color = {210, 216, 224};
  bool edges = true; // mesh lines
};

/// Straight lines on top of everything; 3D: hidden parts shine through.
struct Segments
{
  std::vector<double> points; // m, two ends of x, y, z per segment
  Color color = {220, 20, 60};
  double width = 2; // pixels
  bool dashed = false;
};

/// A text at a place of the specimen.
struct Label
{
  std::array<double, 3> position; // m
  std::string text;
  Color color = {40, 40, 40};
};

struct Picture
{
  int dimension = 2;
  std::vector<Quads> quads; // drawn first in 2D; depth decides in 3D
  std::vector<Scatter> scatters;
  std::vector<Segments> segments; // drawn last
  std::vector<Label> labels;

  std::string title;
  std::string value_label; // beside the colour bar; empty: no bar
  std::string value_unit;
  /// Colour range; empty: from the 1 % to the 99 % quantile of all values.
  std::optional<std::array<double, 2>> range;
  int width = 1400; // pixels; the height follows from the shape of the specimen
  /// 3D: direction from which the specimen is seen.
  std::array<double, 3> view = {0.5, 0.35, 1};
};

/// PNG; EnvironmentError when the disk refuses.
void write_picture(const std::string &path, const Picture &picture);

/// What the picture of a run shows.
struct FieldView
{
  std::string field = "stress";
  int component = -1;            // of a vector or tensor; -1: magnitude, von Mises for tensors
  std::optional<double> magnify; // of displacements; empty: the largest one shows as 3 %
  bool crack = true;
  /// 3D: what lies on the positive side of the plane is cut away: point and normal.
  std::optional<std::array<double, 6>> cut;
  std::string title;
  /// Lower and upper corners of boxes to be drawn dashed (zones).
  std::vector<std::array<double, 6>> boxes;
};

/// The specimen at one time in its deformed shape: particles and cells on one colour scale, mesh
/// lines light, broken faces in strong colour. `radius` in m, usually half the spacing.
Picture picture_of(const ParticleFields &particles, const CellFields &cells,
                   const std::vector<BrokenBond> &bonds, int dimension, double radius,
                   const FieldView &view);
} // namespace ligament::program
