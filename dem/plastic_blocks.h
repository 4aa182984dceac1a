// Plastic strains of a body, kept only where something has yielded, and which blocks of particles
// must be looked at.
#pragma once

#include "core/large_array.h"
#include "dem/lattice_kernel.h"
#include "dem/yield_law.h"

#include <memory>

namespace ligament::dem
{
/// Blocks are those of TractionScreen. Those without plastic strain take no memory.
template <int dim>
class PlasticBlocks
{
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;

  /// The blocks of the particles `always` are looked at in every step.
  PlasticBlocks(const BondNetwork<dim> &bonds, std::unique_ptr<const YieldLaw> law,
                const std::vector<int> &always);

  const YieldLaw &law() const { return *law_; }
  int n_blocks() const { return int(plastic_.size()); }

  /// Blocks that are marked, must always be looked at or have plastic strains, and their
  /// neighbours.
  std::vector<RowRange> suspects(const std::vector<std::uint8_t> &marks) const;
  /// Blocks with plastic strains and their neighbours: whose forces they change.
  std::vector<RowRange> around_plastic() const;

  /// Blocks with plastic strains.
  std::vector<RowRange> plastic() const;
  /// The blocks and their neighbours.
  std::vector<RowRange> and_neighbours(const std::vector<RowRange> &blocks) const;

  bool is_plastic(int i) const { return plastic_[i / TractionScreen::block]; }
  int n_plastic_blocks() const;
  /// Plastic strain of a particle, in its own axes.
  Matrix strain(int i) const;
  double strain_zz(int i) const { return number(2)[i]; }
  Tensor tensor(int i) const;
  /// The block of the particle has plastic strains from now on.
  void add(int i, const Tensor &increment);

  /// V M : strain of a particle (m^3), theory.md eq. (D20): what its dilatation does not feel.
  const double *flowed_volume() const { return number(7); }
  double &flowed_volume(int i) { return number(7)[i]; }
  /// Plastic strains of all particles, one stream per component.
  std::array<const double *, 6> strains() const
  {
    return {number(0), number(1), number(2), number(3), number(4), number(5)};
  }
  /// Scratch: 2 dim^2 streams of one number per particle.
  double *turned() { return turned_.data(); }
  /// The law's number of each particle.
  double *history() { return number(6); }

  /// Strain and history of the particles in blocks that have yielded, as the table "plastic".
  void save(core::State &state, const core::Names &names) const;
  /// Flowed volumes are the caller's.
  void load(const core::State &state, const core::Names &names);

private:
  std::vector<RowRange> with_neighbours(const std::vector<std::uint8_t> &blocks) const;
  double *number(int k) { return numbers_.data() + k * long(n_); }
  const double *number(int k) const { return numbers_.data() + k * long(n_); }

  int n_;
  std::unique_ptr<const YieldLaw> law_;
  std::vector<std::uint8_t> plastic_, always_blocks_; // of the blocks
  std::vector<std::vector<int>> neighbours_;          // of the blocks
  core::LargeArray numbers_; // strain, history, flowed volume: one stream per number
  core::LargeArray turned_;
};
} // namespace ligament::dem
