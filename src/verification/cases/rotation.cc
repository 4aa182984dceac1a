// Rigid rotation of a discrete body by a right angle: nothing may be felt.
#include "src/verification/bodies/unit_bodies.h"
#include "src/verification/cases.h"

#include <Eigen/Geometry>

#include <random>

namespace ligament::program
{
namespace
{
void turn(particles::Particles<2> &zone, std::mt19937 &)
{
  for (int i = 0; i < zone.size(); ++i) {
    const Vector<2> x = get(zone.reference, i);
    set(zone.displacement, i, Vector<2>(-x[1] - x[0], x[0] - x[1]));
    zone.rotation[0][i] = M_PI / 2;
  }
}

void turn(particles::Particles<3> &zone, std::mt19937 &random)
{
  std::normal_distribution<double> normal;
  const Vector<3> axis = Vector<3>(normal(random), normal(random), normal(random)).normalized();
  const Eigen::Quaterniond q(Eigen::AngleAxisd(M_PI / 2, axis));
  for (int i = 0; i < zone.size(); ++i) {
    const Vector<3> x = get(zone.reference, i);
    set(zone.displacement, i, Vector<3>(q * x - x));
    set(zone.rotation, i, Vec<4>(q.w(), q.x(), q.y(), q.z()));
  }
}

template <int dim>
void rotate(const std::string &packing, std::vector<Result> &results)
{
  const Point size = dim == 2 ? Point{20.3, 17.1, 0} : Point{8.3, 7.6, 6.9};
  std::mt19937 random(7);
  double force = 0, energy = 0;
  for (const double nu : {0., 0.3, 0.49})
    for (int repeat = 0; repeat < (dim == 2 ? 1 : 3); ++repeat) {
      Scene scene = unit_scene(dim, size, nu);
      scene.zone.packing = named<PackingKind>(packing);
      UnitBody<dim> unit(scene);
      auto &zone = unit.body.zone->state;
      turn(zone, random);
      unit.body.zone->compute_forces(0);
      double volume = 0;
      for (int i = 0; i < zone.size(); ++i) {
        keep_largest(force, get(zone.force, i).norm() / unit.c11());
        keep_largest(force, get(zone.torque, i).norm() / unit.c11());
        volume += zone.volume[i];
      }
      keep_largest(energy, unit.body.zone->potential_energy() / (unit.c11() * volume));
    }
  const std::string name =
      "rotation/" + packing + (packing == "random" ? dim == 2 ? "_2d" : "_3d" : "");
  results.push_back({name + "/force", force, 1e-12, {}});
  results.push_back({name + "/energy", energy, 1e-12, {}});
}
} // namespace

std::vector<Case> rotation_cases()
{
  return {{"rotation", "a discrete body turned by 90 degrees", false, [] {
             std::vector<Result> results;
             rotate<2>("hexagonal", results);
             rotate<3>("fcc", results);
             rotate<2>("random", results);
             rotate<3>("random", results);
             return results;
           }}};
}
} // namespace ligament::program
