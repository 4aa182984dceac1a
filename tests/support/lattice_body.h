// A lattice of particles on springs as a list of quadratic terms, for tests and benchmarks of
// algebra/.
#pragma once

#include "algebra/block_matrix.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace ligament::test
{
/// Hexagonal in 2D, face-centred cubic in 3D, nearest neighbours at distance 1. Bonds resist
/// extension, and with spins shear and bending, too; in 2D each full neighbourhood resists a change
/// of its volume besides. Terms of the same shape share their entries.
class LatticeBody
{
public:
  struct Term
  {
    std::vector<int> members;
    const Eigen::MatrixXd *entries; // symmetric, so that its order doesn't matter
  };

  /// cells: particles per side in 2D, cubes of four particles in 3D.
  LatticeBody(int dim, bool has_spins, const std::vector<int> &cells, double volumetric = 1)
      : dim_(dim), spins_(has_spins ? (dim == 2 ? 1 : 3) : 0)
  {
    place(cells);
    connect(volumetric);
  }
  LatticeBody(const LatticeBody &) = delete;

  int block_size() const { return dim_ + spins_; }
  int n() const { return int(position_.size()); }
  const std::vector<Eigen::Vector3d> &position() const { return position_; }
  const std::vector<Term> &terms() const { return terms_; }

  /// Rigid motions, one column each.
  Eigen::MatrixXd modes() const
  {
    const int b = block_size(), n_turns = dim_ == 2 ? 1 : 3;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(b * n(), dim_ + n_turns);
    for (int i = 0; i < n(); ++i) {
      for (int c = 0; c < dim_; ++c)
        result(b * i + c, c) = 1;
      for (int k = 0; k < n_turns; ++k) {
        const Eigen::Vector3d axis = Eigen::Vector3d::Unit(dim_ == 2 ? 2 : k);
        result.block(b * i, dim_ + k, dim_, 1) = axis.cross(position_[i]).head(dim_);
        if (spins_ > 0)
          result(b * i + dim_ + k, dim_ + k) = 1;
      }
    }
    return result;
  }

  /// Of all terms; where is_held(position), springs of stiffness `wall` to the ground besides.
  template <typename IsHeld>
  algebra::BlockMatrix matrix(IsHeld &&is_held, double wall = 1) const
  {
    algebra::BlockAssembly assembly(n(), block_size());
    for (const Term &term : terms_)
      assembly.announce(term.members.data(), int(term.members.size()));
    assembly.close();
    for (const Term &term : terms_)
      assembly.add(term.members.data(), int(term.members.size()), term.entries->data());
    const Eigen::MatrixXd ground = wall * Eigen::MatrixXd::Identity(block_size(), block_size());
    for (int i = 0; i < n(); ++i)
      if (is_held(position_[i]))
        assembly.add_block(i, i, ground.data());
    return assembly.take();
  }

private:
  using Place = std::array<int, 3>; // in halves of the cell

  void place(const std::vector<int> &cells)
  {
    const bool flat = dim_ == 2;
    const Eigen::Vector3d half =
        flat ? Eigen::Vector3d(0.5, std::sqrt(0.75), 0) : Eigen::Vector3d::Constant(std::sqrt(0.5));
    for (int z = 0; z < (flat ? 1 : 2 * cells[2]); ++z)
      for (int y = 0; y < (flat ? cells[1] : 2 * cells[1]); ++y)
        for (int x = (y + z) % 2; x < 2 * cells[0]; x += 2) {
          at_[{x, y, z}] = n();
          position_.push_back(half.cwiseProduct(Eigen::Vector3d(x, y, z)));
          place_.push_back({x, y, z});
        }
    if (flat)
      steps_ = {{2, 0, 0}, {1, 1, 0}, {-1, 1, 0}};
    else
      steps_ = {{1, 1, 0}, {-1, 1, 0}, {1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}};
    for (const Place &step : steps_)
      direction_.push_back(half.cwiseProduct(Eigen::Vector3d(step[0], step[1], step[2])));
  }

  int neighbour(int i, int k, int sign) const
  {
    const auto found =
        at_.find({place_[i][0] + sign * steps_[k][0], place_[i][1] + sign * steps_[k][1],
                  place_[i][2] + sign * steps_[k][2]});
    return found == at_.end() ? -1 : found->second;
  }

  void connect(double volumetric)
  {
    entries_.reserve(steps_.size() + 1);
    for (const Eigen::Vector3d &direction : direction_)
      entries_.push_back(bond(direction));
    entries_.push_back(volumetric * volume());
    for (int i = 0; i < n(); ++i) {
      Term around{{i}, &entries_.back()};
      for (std::size_t k = 0; k < steps_.size(); ++k) {
        const int j = neighbour(i, int(k), 1), opposite = neighbour(i, int(k), -1);
        if (j >= 0)
          terms_.push_back({{i, j}, &entries_[k]});
        if (j >= 0 && opposite >= 0)
          around.members.insert(around.members.end(), {j, opposite});
      }
      if (dim_ == 2 && volumetric > 0 && around.members.size() == 7)
        terms_.push_back(around);
    }
  }

  /// Energy 1/2 sum k (row . q)^2 of a bond along `normal`.
  Eigen::MatrixXd bond(const Eigen::Vector3d &normal) const
  {
    const int b = block_size();
    // Motion of one end against the other, at the middle, and turn of one end against the other.
    Eigen::MatrixXd slip = Eigen::MatrixXd::Zero(3, 2 * b), turn = Eigen::MatrixXd::Zero(3, 2 * b);
    for (int side = 0; side < 2; ++side) {
      for (int c = 0; c < dim_; ++c)
        slip(c, side * b + c) = side == 0 ? -1 : 1;
      for (int k = 0; k < spins_; ++k) {
        const Eigen::Vector3d axis = Eigen::Vector3d::Unit(dim_ == 2 ? 2 : k);
        slip.col(side * b + dim_ + k) = -0.5 * axis.cross(normal);
        turn(dim_ == 2 ? 2 : k, side * b + dim_ + k) = side == 0 ? -1 : 1;
      }
    }
    const Eigen::Matrix3d along = normal * normal.transpose();
    Eigen::Matrix3d stiffness = along;
    if (spins_ > 0)
      stiffness += 0.3 * (Eigen::Matrix3d::Identity() - along);
    return slip.transpose() * stiffness * slip + 0.1 * turn.transpose() * turn;
  }

  Eigen::MatrixXd volume() const
  {
    const int b = block_size();
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(b * (1 + 2 * int(steps_.size())));
    for (std::size_t k = 0; k < steps_.size(); ++k)
      for (int sign = 0; sign < 2; ++sign)
        row.segment(b * (1 + 2 * k + sign), dim_) =
            (sign == 0 ? 1 : -1) * direction_[k].head(dim_).transpose() / 6;
    return row.transpose() * row;
  }

  int dim_, spins_;
  std::vector<Eigen::Vector3d> position_, direction_; // directions of half of the neighbours
  std::vector<Place> place_, steps_;
  std::map<Place, int> at_;
  std::vector<Eigen::MatrixXd> entries_;
  std::vector<Term> terms_;
};
} // namespace ligament::test
