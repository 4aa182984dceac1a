#include "src/verification/instruments/held_boundary.h"

#include "algebra/conjugate_gradients.h"
#include "algebra/preconditioner.h"
#include "core/check.h"
#include "core/extremes.h"
#include "fem/cell_map.h"

#include <algorithm>

namespace ligament::program
{
namespace
{
/// Per number of y whether it is held.
std::vector<char> find_held(const CoupledBody<2> &body, const std::function<bool(int)> &side,
                            int size)
{
  constexpr int block = StaticSystem<2>::block;
  const int n = body.zone ? body.zone->state.size() : 0;
  std::vector<char> is_held(size, 0);
  const auto &mesh = body.far->mesh();
  for (const auto &face : mesh.boundary_faces)
    if (side(face.boundary))
      for (const int a : fem::face_nodes<2>(face.face))
        std::fill_n(is_held.begin() + block * (n + mesh.cells[face.cell][a]), block, 1);
  return is_held;
}
} // namespace

double settle_with_sides(CoupledBody<2> &body, const std::function<bool(int boundary)> &side,
                         const PlaneField &field)
{
  constexpr int block = StaticSystem<2>::block;
  StaticSystem<2> system(body);
  const auto is_held = find_held(body, side, system.size());
  const auto release = [&](Eigen::VectorXd &y) {
    for (int k = 0; k < y.size(); ++k)
      if (is_held[k])
        y[k] = 0;
  };
  double largest = 0;
  Eigen::VectorXd imposed = Eigen::VectorXd::Zero(system.size());
  const int n = body.zone ? body.zone->state.size() : 0;
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    if (is_held[block * (n + i)]) {
      const Vector<2> u = field(body.far->mesh().nodes[i]);
      imposed.segment<2>(block * (n + i)) = u;
      keep_largest(largest, u.norm());
    }
  core::require(largest > 0, "nothing of the body is held");
  system.displace(imposed);
  const auto preconditioner = algebra::make_preconditioner(
      algebra::Preconditioning::automatic, system.near_stiffness(1), system.rigid_motions(), 2);
  constexpr int rounds = 3; // each from the true forces
  for (int round = 0; round < rounds; ++round) {
    Eigen::VectorXd right = system.forces(0), y;
    release(right);
    algebra::conjugate_gradients(
        [&](const Eigen::VectorXd &p, Eigen::VectorXd &kp) {
          kp = system.stiffness_times(p);
          release(kp);
        },
        [&](const Eigen::VectorXd &r, Eigen::VectorXd &z) {
          preconditioner->apply(r, z);
          system.drop_inert(z);
          release(z);
        },
        right, y, 1e-9 * right.norm(), 2000);
    system.displace(y);
  }
  return largest;
}

double largest_distance(const CoupledBody<2> &body, const PlaneField &field)
{
  double largest = 0;
  const auto look = [&](const Vector<2> &x, const Vector<2> &u) {
    const double distance = (u - field(x)).norm();
    if (!(distance <= largest))
      largest = distance;
  };
  for (int i = 0; body.zone && i < body.zone->state.size(); ++i)
    look(get(body.zone->state.reference, i), get(body.zone->state.displacement, i));
  for (int i = 0; i < body.far->mesh().n_nodes(); ++i)
    look(body.far->mesh().nodes[i], get(body.far->displacement, i));
  return largest;
}
} // namespace ligament::program
