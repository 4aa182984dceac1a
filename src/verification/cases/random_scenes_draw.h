// Small scenes drawn at random: geometry, packing, material, coupling and loads from a seed alone.
#pragma once

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace ligament::program
{
/// A scene and what was drawn, in words.
struct RandomScene
{
  int seed;
  nlohmann::ordered_json json; // the coupled scene, as a scene file has it; SI units
  int dimension;
  std::string packing; // word of the scene's key
  std::string zone;    // band, box, l_shape
  std::string crack;   // none, centre, edge
  std::string load;    // tension, shear, compression, mixed
  std::string control; // velocity, displacement, traction
  std::string damping; // none, mass, local
  /// Nothing may break: no crack, and loads that only press.
  bool must_hold = false;

  /// For scenes with a formula for the stress intensity: straight central crack across tension.
  struct Toughness
  {
    double half_length, width; // m, a and W
    double toughness;          // Pa m^0.5, K_Ic of the material
    double drag;               // Pa, by which damping lowers the stress at the crack
  };
  std::optional<Toughness> toughness;
};

/// The scene of a seed, the same on every machine; each quantity has a stream of random numbers of
/// its own (core::random_number). 500 to 4000 particles when it is all discrete.
RandomScene draw_scene(int seed);

/// The scene without far field: all discrete.
nlohmann::ordered_json all_discrete(nlohmann::ordered_json scene);

/// The image in a mirror at x = 0: geometry, loads, and the orientation that makes the image of a
/// lattice of it. The packing of irregular ones is not a matter of the scene's keys: it needs a
/// file with the mirrored particles.
nlohmann::ordered_json mirrored(const nlohmann::ordered_json &scene);
} // namespace ligament::program
