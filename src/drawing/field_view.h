// Pictures of a body's fields: which quantity is shown, how far displacements are magnified.
#pragma once

#include "src/drawing/picture.h"
#include "src/drawing/shown_field.h"
#include "src/output/fields.h"

#include <optional>
#include <vector>

namespace ligament::program
{
struct FieldView
{
  ShownField field;
  std::optional<double> magnify; // of displacements; empty: good_magnification() of the state
  bool crack = true;
  /// 3D: what lies on the positive side of the plane is cut away: point and normal.
  std::optional<std::array<double, 6>> cut;
};

/// A round factor on displacements that suits all states: those of the first one show as up to
/// 3 % of the specimen, those of the others, in which halves may fly apart, as up to 6 %. Above 1,
/// or 0 where nothing has moved.
double good_magnification(const std::vector<const BodyState *> &states);

/// The body in its deformed shape: particles and cells on one colour scale, mesh lines light, both
/// flanks of broken faces in strong colour where they are now. Particles have the radii of their
/// field `radius`.
Picture picture_of(const BodyState &state, int dimension, const FieldView &view);

/// One picture per state, with one magnification and one range of colours for all.
std::vector<Picture> pictures_of(const std::vector<const BodyState *> &states, int dimension,
                                 const FieldView &view);
} // namespace ligament::program
