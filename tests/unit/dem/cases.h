// The lattices that the property tests run over, as types: dimension, kind, orientation.
#pragma once

#include "packings/lattice_packing.h"
#include "tests/unit/dem/body.h"

#include <gtest/gtest.h>

namespace ligament::dem::testing
{
template <int dim_, packings::LatticeKind kind_, bool turned_>
struct Case
{
  static constexpr int dim = dim_;
  static constexpr packings::LatticeKind kind = kind_;
  static constexpr bool turned = turned_;
};

using Kind = packings::LatticeKind;
using Cases =
    ::testing::Types<Case<2, Kind::square, false>, Case<2, Kind::square, true>,
                     Case<2, Kind::hexagonal, false>, Case<2, Kind::hexagonal, true>,
                     Case<3, Kind::simple_cubic, false>, Case<3, Kind::simple_cubic, true>,
                     Case<3, Kind::fcc, false>, Case<3, Kind::fcc, true>>;

inline void turn_lattice(Spin<2> &orientation)
{
  orientation[0] = 0.3;
}
inline void turn_lattice(Spin<3> &orientation)
{
  orientation = {0.3, -0.2, 0.5};
}

/// A box of about n spacings along each axis, commensurate with nothing.
template <typename C>
packings::LatticeParameters<C::dim> box(double n)
{
  packings::LatticeParameters<C::dim> lattice;
  lattice.kind = C::kind;
  lattice.spacing = 0.01;
  lattice.thickness = C::dim == 2 ? 0.3 : 1;
  if (C::turned)
    turn_lattice(lattice.orientation);
  for (int c = 0; c < C::dim; ++c) {
    lattice.lower[c] = -0.5 * lattice.spacing * (n + 0.37 * c);
    lattice.upper[c] = -lattice.lower[c];
  }
  return lattice;
}
} // namespace ligament::dem::testing
