#include "dem/toughness_calibration.h"

#include "dem/many_body_force.h"
#include "particles/linear_equilibrium.h"

namespace ligament::dem
{
namespace
{
constexpr double spacing = 1, modulus = 1; // c has no unit: any values do
constexpr double k_one = 1e-6;             // K_I, small: the solve is linear

/// Orientation of the lattice in axes where the crack grows along x and opens along y.
Spin<2> in_crack_axes(const Spin<2> &orientation, const CrackAxes<2> &crack)
{
  return orientation - Spin<2>(std::atan2(crack.growth[1], crack.growth[0]));
}
Spin<3> in_crack_axes(const Spin<3> &orientation, const CrackAxes<3> &crack)
{
  Eigen::Matrix3d axes;
  axes << crack.growth, crack.normal, crack.growth.cross(crack.normal);
  const double angle = orientation.norm();
  const Eigen::AngleAxisd lattice(angle, angle == 0 ? Vector<3>(Vector<3>::UnitX())
                                                    : Vector<3>(orientation / angle));
  const Eigen::AngleAxisd turned(axes.transpose() * lattice.toRotationMatrix());
  return turned.angle() * turned.axis();
}

/// The square root field of mode I: displacements in m and the rotation about the crack front.
struct NearField
{
  double shear_modulus, kappa;

  Vector<3> operator()(double x, double y) const
  {
    const double r = std::hypot(x, y), t = std::atan2(y, x);
    const double u =
        k_one / (2 * shear_modulus) * std::sqrt(r / (2 * M_PI)) * (kappa - std::cos(t));
    return {u * std::cos(t / 2), u * std::sin(t / 2),
            -k_one * (kappa + 1) / (4 * shear_modulus * std::sqrt(2 * M_PI * r)) * std::sin(t / 2)};
  }
};

/// Midway between the last cut and the first intact of the faces that the plane y = height crosses.
template <int dim>
Vector<2> tip_between_faces(const particles::Packing<dim> &packing, double height,
                            double half_depth)
{
  double last = -1e300, first = 1e300;
  Vector<2> last_place = Vector<2>::Zero(), first_place = Vector<2>::Zero();
  for (const auto &face : packing.faces) {
    const double y_i = packing.centre[1][face.i], y_j = packing.centre[1][face.j];
    if ((y_i - height) * (y_j - height) > 0)
      continue;
    const Vector<dim> place = get(packing.centre, face.i) + face.lever_i;
    if (dim == 3 && std::abs(place[dim - 1]) > half_depth)
      continue;
    if (face.cracked && place[0] > last)
      last = place[0], last_place = place.template head<2>();
    if (!face.cracked && place[0] < first)
      first = place[0], first_place = place.template head<2>();
  }
  return (last_place + first_place) / 2;
}
/// A box around the tip of a crack along x at (shift), of half width radius + 4 d.
template <int dim>
void lay_out(particles::SpecimenParameters<dim> &p, const Vector<2> &shift, double radius,
             double depth)
{
  const double half = radius + 4;
  p.spacing = spacing;
  p.lower.setConstant(-half);
  p.upper.setConstant(half);
  if constexpr (dim == 2)
    p.cracks = {{{-2 * half, shift[1]}, {shift[0], shift[1]}}};
  else {
    p.lower[2] = -depth / 2, p.upper[2] = depth / 2;
    const double z = depth;
    p.cracks = {{{-2 * half, shift[1], -z},
                 {shift[0], shift[1], -z},
                 {shift[0], shift[1], z},
                 {-2 * half, shift[1], z}}};
  }
}

/// Solves around the tip of the crack in the plane y = height of a packing laid out for it.
template <int dim>
double solve_tip(const particles::Packing<dim> &packing, const DemMaterial &material, double height,
                 double radius, double depth)
{
  const Vector<2> tip = tip_between_faces(packing, height, depth / 4);

  DemMaterial scaled = material;
  scaled.youngs_modulus = modulus, scaled.density = 1;
  // 3D: plane strain between two smooth walls.
  std::vector<core::BoundaryLoad<dim>> walls;
  if constexpr (dim == 3)
    for (const int boundary : {4, 5}) {
      core::BoundaryLoad<3> wall;
      wall.boundary = boundary;
      wall.kind = core::BoundaryLoad<3>::Kind::displacement;
      wall.value[2] = 0;
      walls.push_back(wall);
    }
  const ManyBodyForce<dim> force(packing, scaled, walls);

  const double nu = material.poissons_ratio;
  const bool plane_stress = dim == 2 && material.plane == PlaneMode::stress;
  const NearField field{scaled.shear_modulus(), plane_stress ? (3 - nu) / (1 + nu) : 3 - 4 * nu};

  // Outside the radius the particles follow the field; inside they are unknowns.
  constexpr int dofs = n_particle_dofs<dim>;
  const int n = packing.size();
  std::vector<char> is_free(n, 0);
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(dofs * n);
  for (int i = 0; i < n; ++i) {
    const double x = packing.centre[0][i] - tip[0], y = packing.centre[1][i] - tip[1];
    if (std::hypot(x, y) < radius)
      is_free[i] = 1;
    else {
      const Vector<3> u = field(x, y);
      motion.segment<2>(dofs * i) = u.head<2>();
      motion[dofs * i + dofs - 1] = u[2];
    }
  }
  particles::Particles<dim> state;
  particles::fill_particles(packing, scaled.density, state);
  particles::solve_equilibrium(state, force, is_free, motion);

  std::vector<int> near;
  for (int i = 0; i < n; ++i) {
    set(state.displacement, i, Vector<dim>(motion.segment<dim>(dofs * i)));
    for (int c = 0; c < n_spins<dim>; ++c)
      state.rotation[dim == 2 ? 0 : c + 1][i] =
          (dim == 2 ? 1 : 0.5) * motion[dofs * i + dim + c]; // small angles
    const Vector<dim> x = get(packing.centre, i);
    if ((x.template head<2>() - tip).norm() < 4 && (dim == 2 || std::abs(x[dim - 1]) < depth / 4))
      near.push_back(i);
  }
  return force.max_tension(state, near) * std::sqrt(spacing) / k_one;
}

} // namespace

template <int dim>
double crack_tip_factor(particles::LatticeKind kind, const Spin<dim> &orientation,
                        const DemMaterial &material, const CrackAxes<dim> &crack,
                        const Vector<2> &shift, double radius)
{
  const double depth = 2 * std::sqrt(2.);
  particles::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.orientation = in_crack_axes(orientation, crack);
  lay_out<dim>(lattice, shift, radius, depth);
  return solve_tip<dim>(particles::make_lattice_packing<dim>(lattice), material, shift[1], radius,
                        depth);
}

template <int dim>
double crack_tip_factor(const particles::RandomParameters<dim> &packing, int seed,
                        const DemMaterial &material, double radius)
{
  const double depth = 4;
  particles::RandomParameters<dim> sample;
  sample.seed = seed;
  sample.relaxation_sweeps = packing.relaxation_sweeps;
  sample.size_ratio = packing.size_ratio;
  lay_out<dim>(sample, Vector<2>::Zero(), radius, depth);
  return solve_tip<dim>(particles::make_random_packing<dim>(sample).packing, material, 0, radius,
                        depth);
}

template <int dim>
double calibrate_toughness(const particles::RandomParameters<dim> &packing,
                           const DemMaterial &material)
{
  const int n = dim == 2 ? 16 : 4;
  double sum = 0;
  for (int k = 1; k <= n; ++k)
    sum += crack_tip_factor<dim>(packing, packing.seed + 7919 * k, material, dim == 2 ? 8 : 5);
  return sum / n;
}

template <int dim>
double calibrate_toughness(particles::LatticeKind kind, const Spin<dim> &orientation,
                           const DemMaterial &material, const CrackAxes<dim> &crack)
{
  const double radius = dim == 2 ? 30 : 8;
  particles::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.spacing = 1;
  lattice.orientation = in_crack_axes(orientation, crack);
  lattice.lower.setConstant(-3);
  lattice.upper.setConstant(3);
  bool aligned = false;
  for (const auto &direction : particles::make_lattice_packing<dim>(lattice).directions)
    aligned = aligned || std::abs(direction.normal[1]) < 1e-9;
  if (aligned)
    return crack_tip_factor<dim>(kind, orientation, material, crack, {0.1, 0.}, radius);
  double largest = 0;
  for (const double y : {0.05, 0.3, -0.3})
    for (const double x : {0.1, 0.45})
      largest = std::max(largest,
                         crack_tip_factor<dim>(kind, orientation, material, crack, {x, y}, radius));
  return largest;
}

template double crack_tip_factor<2>(particles::LatticeKind, const Spin<2> &, const DemMaterial &,
                                    const CrackAxes<2> &, const Vector<2> &, double);
template double crack_tip_factor<3>(particles::LatticeKind, const Spin<3> &, const DemMaterial &,
                                    const CrackAxes<3> &, const Vector<2> &, double);
template double calibrate_toughness<2>(particles::LatticeKind, const Spin<2> &, const DemMaterial &,
                                       const CrackAxes<2> &);
template double calibrate_toughness<3>(particles::LatticeKind, const Spin<3> &, const DemMaterial &,
                                       const CrackAxes<3> &);
template double crack_tip_factor<2>(const particles::RandomParameters<2> &, int,
                                    const DemMaterial &, double);
template double crack_tip_factor<3>(const particles::RandomParameters<3> &, int,
                                    const DemMaterial &, double);
template double calibrate_toughness<2>(const particles::RandomParameters<2> &, const DemMaterial &);
template double calibrate_toughness<3>(const particles::RandomParameters<3> &, const DemMaterial &);
} // namespace ligament::dem
