#include "dem/toughness_calibration.h"

#include "dem/crack_strip.h"
#include "dem/grips.h"
#include "dem/many_body_force.h"
#include "dem/principal_tension.h"
#include "particles/linear_equilibrium.h"

#include <algorithm>
#include <limits>

namespace ligament::dem
{
namespace
{
constexpr double spacing = 1, modulus = 1; // c has no unit: any values do
constexpr double k_one = 1e-6;             // K_I, small: the solve is linear
/// Stress along a crack of 2a = 80 d under tension across it, sigma = K_I/sqrt(pi a), in
/// K_I/sqrt(d).
const double tensile_t_stress = -1 / std::sqrt(M_PI * 40);

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
Vector<2> tip_between_faces(const packings::Packing<dim> &packing, double height, double half_depth)
{
  double last = -1e300, first = 1e300;
  Vector<2> last_place = Vector<2>::Zero(), first_place = Vector<2>::Zero();
  for (const auto &face : packing.faces) {
    const double y_i = packing.centre[1][face.i], y_j = packing.centre[1][face.j];
    const double on_plane = 1e-9 * spacing; // counts as above, as cracks have it
    if ((y_i - height < -on_plane) == (y_j - height < -on_plane))
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
/// A box around the tip of a crack along x, of half width radius + 4 d.
template <int dim>
void lay_out(packings::SpecimenParameters<dim> &p, const CrackPatch &patch)
{
  const double half = patch.radius + 4, x = patch.shift[0], y = patch.shift[1];
  p.spacing = spacing;
  p.lower.setConstant(-half);
  p.upper.setConstant(half);
  if constexpr (dim == 2)
    p.cracks = {{{-2 * half, y}, {x, y}}};
  else {
    const double z = patch.depth;
    p.lower[2] = -z / 2, p.upper[2] = z / 2;
    p.cracks = {{{-2 * half, y, -z}, {x, y, -z}, {x, y, z}, {-2 * half, y, z}}};
  }
}

/// Of strength 1.
template <int dim>
FractureLaw unit_law(FractureLaw::Criterion criterion)
{
  return {criterion, 1., {}, PrincipalTension<dim>::whole_face(spacing)};
}

/// A crack along x in a packing laid out for it, which breaks face after face while the body around
/// it follows the near field of its tip.
template <int dim>
class RunningCrack
{
public:
  RunningCrack(packings::Packing<dim> packing, const DemMaterial &material,
               FractureLaw::Criterion criterion, const CrackPatch &patch)
      : packing_(std::move(packing)), material_(material), criterion_(criterion),
        t_stress_(patch.t_stress * k_one / std::sqrt(spacing)), depth_(patch.depth),
        tip_(tip_between_faces(packing_, patch.shift[1], patch.depth / 4))
  {
    material_.youngs_modulus = modulus, material_.density = 1;
    for (int i = 0; i < packing_.size(); ++i)
      is_free_.push_back(from_tip(i).norm() < patch.radius);
  }

  /// The factor c of the next face to break, which breaks.
  double advance()
  {
    const auto force = make_force();
    const auto state = at_rest(force);
    std::vector<int> near;
    for (int i = 0; i < packing_.size(); ++i)
      if (from_tip(i).norm() < 4)
        near.push_back(i);
    const auto weakest = force.weakest_bond(state, near);
    core::require(weakest.utilisation > 0, "nothing is under tension at the tip of a crack");
    for (auto &face : packing_.faces)
      if (std::minmax(face.i, face.j) == std::minmax(weakest.bond.i, weakest.bond.j))
        cut(face);
    return weakest.utilisation * std::sqrt(spacing) / k_one;
  }

  /// Projected length that broke, in d.
  double length() const { return length_; }

private:
  Vector<2> from_tip(int i) const
  {
    return Vector<2>(packing_.centre[0][i], packing_.centre[1][i]) - tip_;
  }

  void cut(packings::Face<dim> &face)
  {
    face.cracked = true;
    const double step = face.area * std::abs(face.normal[1]) / (dim == 2 ? 1 : depth_);
    length_ += step;
    tip_[0] += step;
  }

  // 3D: plane strain between two smooth walls.
  ManyBodyForce<dim> make_force() const
  {
    std::vector<core::BoundaryLoad<dim>> walls;
    add_smooth_walls(walls);
    return {packing_, material_, walls, unit_law<dim>(criterion_)};
  }

  /// Outside the radius the particles follow the field; inside they are unknowns.
  particles::Particles<dim> at_rest(const ManyBodyForce<dim> &force) const
  {
    const double nu = material_.poissons_ratio;
    const bool plane_stress = dim == 2 && material_.plane == PlaneMode::stress;
    const NearField field{material_.shear_modulus(),
                          plane_stress ? (3 - nu) / (1 + nu) : 3 - 4 * nu};
    constexpr int dofs = n_particle_dofs<dim>;
    const int n = packing_.size();
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(dofs * n);
    for (int i = 0; i < n; ++i)
      if (!is_free_[i]) {
        const Vector<2> x = from_tip(i);
        Vector<3> u = field(x[0], x[1]);
        // The stress along the crack, in plane strain or plane stress.
        u[0] += t_stress_ / modulus * (plane_stress ? 1 : 1 - nu * nu) * x[0];
        u[1] -= t_stress_ / modulus * nu * (plane_stress ? 1 : 1 + nu) * x[1];
        motion.segment<2>(dofs * i) = u.head<2>();
        motion[dofs * i + dofs - 1] = u[2];
      }
    particles::Particles<dim> state;
    packings::fill_particles(packing_, material_.density, state);
    particles::solve_equilibrium(state, force, is_free_, motion);
    for (int i = 0; i < n; ++i) {
      set(state.displacement, i, Vector<dim>(motion.segment<dim>(dofs * i)));
      for (int c = 0; c < n_spins<dim>; ++c)
        state.rotation[dim == 2 ? 0 : c + 1][i] =
            (dim == 2 ? 1 : 0.5) * motion[dofs * i + dim + c]; // small angles
    }
    return state;
  }

  packings::Packing<dim> packing_;
  DemMaterial material_;
  FractureLaw::Criterion criterion_;
  double t_stress_, depth_; // Pa, m
  Vector<2> tip_;
  std::vector<char> is_free_;
  double length_ = 0;
};
template <int dim>
RunningCrack<dim> crack_in_lattice(packings::LatticeKind kind, const Spin<dim> &orientation,
                                   const DemMaterial &material, FractureLaw::Criterion criterion,
                                   const CrackAxes<dim> &crack, const CrackPatch &patch)
{
  packings::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.orientation = in_crack_axes(orientation, crack);
  lay_out<dim>(lattice, patch);
  return {packings::make_lattice_packing<dim>(lattice), material, criterion, patch};
}

template <int dim>
RunningCrack<dim> crack_in_sample(const packings::RandomParameters<dim> &packing, int seed,
                                  const DemMaterial &material, FractureLaw::Criterion criterion,
                                  const CrackPatch &patch)
{
  packings::RandomParameters<dim> sample;
  sample.seed = seed;
  sample.relaxation_sweeps = packing.relaxation_sweeps;
  sample.size_ratio = packing.size_ratio;
  lay_out<dim>(sample, patch);
  return {packings::make_random_packing<dim>(sample).packing, material, criterion, patch};
}

/// A hard face breaks in the wave of an easier one before it: what holds a crack is the stretch of
/// 1.5 d in which the largest factor is least. The first stretch belongs to the cut.
double running_factor(RunningCrack<2> crack)
{
  constexpr double stretch = 1.5, whole = 6; // d
  std::vector<double> at, factor;
  double least = std::numeric_limits<double>::infinity();
  while (crack.length() < whole) {
    at.push_back(crack.length());
    factor.push_back(crack.advance());
    if (at.back() < stretch)
      continue;
    double largest = 0;
    for (std::size_t k = 0; k < at.size(); ++k)
      if (at[k] >= at.back() - stretch)
        largest = std::max(largest, factor[k]);
    least = std::min(least, largest);
  }
  return least;
}

/// Of the crack that runs in a body of this kind, whose tip lies at (x, y) = shift, in d.
template <int dim>
double running_factor(packings::LatticeKind kind, const Spin<dim> &orientation,
                      const DemMaterial &material, FractureLaw::Criterion criterion,
                      const CrackAxes<dim> &crack, const Vector<2> &shift)
{
  if constexpr (dim == 2)
    return running_factor(crack_in_lattice<2>(kind, orientation, material, criterion, crack,
                                              {shift, 15, 0, tensile_t_stress}));
  else {
    const CrackStrip strip;
    packings::LatticeParameters<3> cracked, whole;
    cracked.kind = whole.kind = kind;
    cracked.orientation = whole.orientation = in_crack_axes(orientation, crack);
    strip.lay_out<3>(cracked, shift);
    strip.lay_out_whole<3>(whole);
    return strip.factor<3>(packings::make_lattice_packing<3>(cracked),
                           packings::make_lattice_packing<3>(whole), material, criterion);
  }
}
template <int dim>
double running_factor(const packings::RandomParameters<dim> &packing, int seed,
                      const DemMaterial &material, FractureLaw::Criterion criterion)
{
  if constexpr (dim == 2)
    return running_factor(
        crack_in_sample<2>(packing, seed, material, criterion, {{0, 0}, 12, 0, tensile_t_stress}));
  else {
    const CrackStrip strip;
    const auto lay_out_sample = [&](auto &&lay_out) {
      packings::RandomParameters<3> sample;
      sample.seed = seed;
      sample.relaxation_sweeps = packing.relaxation_sweeps;
      sample.size_ratio = packing.size_ratio;
      lay_out(sample);
      return packings::make_random_packing<3>(sample).packing;
    };
    return strip.factor<3>(lay_out_sample([&](auto &p) {
                             strip.lay_out<3>(p, {0, 0});
                           }),
                           lay_out_sample([&](auto &p) { strip.lay_out_whole<3>(p); }), material,
                           criterion);
  }
}

/// Whether a row (layer) of the lattice lies in the plane of the crack: all tips are alike.
template <int dim>
bool is_aligned(packings::LatticeKind kind, const Spin<dim> &orientation,
                const CrackAxes<dim> &crack)
{
  packings::LatticeParameters<dim> lattice;
  lattice.kind = kind;
  lattice.spacing = spacing;
  lattice.orientation = in_crack_axes(orientation, crack);
  lattice.lower.setConstant(-3);
  lattice.upper.setConstant(3);
  const auto directions = packings::make_lattice_packing<dim>(lattice).directions;
  return std::any_of(directions.begin(), directions.end(),
                     [](const auto &d) { return std::abs(d.normal[1]) < 1e-9; });
}
} // namespace

template <int dim>
double crack_tip_factor(packings::LatticeKind kind, const Spin<dim> &orientation,
                        const DemMaterial &material, FractureLaw::Criterion criterion,
                        const CrackAxes<dim> &crack, const CrackPatch &patch)
{
  return crack_in_lattice(kind, orientation, material, criterion, crack, patch).advance();
}

template <int dim>
double crack_tip_factor(const packings::RandomParameters<dim> &packing, int seed,
                        const DemMaterial &material, FractureLaw::Criterion criterion,
                        const CrackPatch &patch)
{
  return crack_in_sample(packing, seed, material, criterion, patch).advance();
}

template <int dim>
double calibrate_toughness(const packings::RandomParameters<dim> &packing,
                           const DemMaterial &material, FractureLaw::Criterion criterion)
{
  // Samples until the mean is known to half a per cent, which takes more the more the radii differ;
  // a sample in 3D takes seconds.
  constexpr int least = dim == 2 ? 8 : 4, most = dim == 2 ? 32 : 4;
  constexpr double standard_error = 0.005; // over the mean
  double sum = 0, squares = 0;
  for (int n = 1;; ++n) {
    // A seed that nobody chooses for a specimen.
    const double c = running_factor<dim>(packing, 1000003 + 7919 * n, material, criterion);
    sum += c;
    squares += c * c;
    const double mean = sum / n, variance = (squares - n * mean * mean) / std::max(1, n - 1);
    if (n == most || (n >= least && variance <= n * std::pow(standard_error * mean, 2)))
      return mean;
  }
}

template <int dim>
double calibrate_toughness(packings::LatticeKind kind, const Spin<dim> &orientation,
                           const DemMaterial &material, FractureLaw::Criterion criterion,
                           const CrackAxes<dim> &crack)
{
  std::vector<Vector<2>> shifts = {{0.1, 0}};
  if (!is_aligned<dim>(kind, orientation, crack))
    shifts = {{0.1, 0.1}, {0.1, -0.1}, {0.45, 0.3}, {0.45, -0.3}}; // as the mirror image has them
  double sum = 0;
  for (const Vector<2> &shift : shifts)
    sum += running_factor<dim>(kind, orientation, material, criterion, crack, shift);
  return sum / double(shifts.size());
}

template double crack_tip_factor<2>(packings::LatticeKind, const Spin<2> &, const DemMaterial &,
                                    FractureLaw::Criterion, const CrackAxes<2> &,
                                    const CrackPatch &);
template double calibrate_toughness<2>(packings::LatticeKind, const Spin<2> &, const DemMaterial &,
                                       FractureLaw::Criterion, const CrackAxes<2> &);
template double crack_tip_factor<2>(const packings::RandomParameters<2> &, int, const DemMaterial &,
                                    FractureLaw::Criterion, const CrackPatch &);
template double calibrate_toughness<2>(const packings::RandomParameters<2> &, const DemMaterial &,
                                       FractureLaw::Criterion);
template double crack_tip_factor<3>(packings::LatticeKind, const Spin<3> &, const DemMaterial &,
                                    FractureLaw::Criterion, const CrackAxes<3> &,
                                    const CrackPatch &);
template double calibrate_toughness<3>(packings::LatticeKind, const Spin<3> &, const DemMaterial &,
                                       FractureLaw::Criterion, const CrackAxes<3> &);
template double crack_tip_factor<3>(const packings::RandomParameters<3> &, int, const DemMaterial &,
                                    FractureLaw::Criterion, const CrackPatch &);
template double calibrate_toughness<3>(const packings::RandomParameters<3> &, const DemMaterial &,
                                       FractureLaw::Criterion);
} // namespace ligament::dem
