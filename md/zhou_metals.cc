// The metals of X. W. Zhou, R. A. Johnson, H. N. G. Wadley, Phys. Rev. B 69 (2004) 144113, whose
// lattice parameter, cohesive energy and elastic constants come out within 1 % of the measured
// ones.
#include "md/analytic.h"
#include "md/atomic_units.h"
#include "md/sampled_spline.h"

#include "core/check.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ligament::md
{
namespace
{
/// The parameters of the paper, in its symbols; energies in eV, r_e in angstrom, mass in u.
struct Metal
{
  const char *name, *lattice;
  double r_e, f_e, rho_e, rho_s, alpha, beta, a, b, kappa, lambda;
  std::array<double, 4> f_n, f; // of the embedding energy below rho_n, and around rho_e
  double eta, f_above, mass;    // of the embedding energy above
};

// clang-format off
const std::array metals = {
  Metal{"Cu", "fcc", 2.556162, 1.554485, 21.175871, 21.175395, 8.127620, 4.334731, 0.396620, 0.548085, 0.308782, 0.756515,
        {-2.170269, -0.263788, 1.088878, -0.817603}, {-2.19, 0.00, 0.561830, -2.100595}, 0.310490, -2.186568, 63.546},
  Metal{"Ag", "fcc", 2.891814, 1.106232, 14.604100, 14.604144, 9.132010, 4.870405, 0.277758, 0.419611, 0.339710, 0.750758,
        {-1.729364, -0.255882, 0.912050, -0.561432}, {-1.75, 0.00, 0.744561, -1.150650}, 0.783924, -1.748423, 107.8682},
  Metal{"Au", "fcc", 2.885034, 1.529021, 19.991632, 19.991509, 9.516052, 5.075228, 0.229762, 0.356666, 0.356570, 0.748798,
        {-2.937772, -0.500288, 1.601954, -0.835530}, {-2.98, 0.00, 1.706587, -1.134778}, 1.021095, -2.978815, 196.96654},
  Metal{"Ni", "fcc", 2.488746, 2.007018, 27.562015, 27.562031, 8.383453, 4.471175, 0.429046, 0.633531, 0.443599, 0.820658,
        {-2.693513, -0.076445, 0.241442, -2.375626}, {-2.70, 0.00, 0.265390, -0.152856}, 0.445470, -2.7, 58.6934},
  Metal{"Pb", "fcc", 3.499723, 0.647872, 8.450154, 8.450063, 9.121799, 5.212457, 0.161219, 0.236884, 0.250805, 0.764955,
        {-1.422370, -0.210107, 0.682886, -0.529378}, {-1.44, 0.00, 0.702726, -0.538766}, 0.935380, -1.439436, 207.2},
  Metal{"Fe", "bcc", 2.481987, 1.885957, 20.041463, 20.041463, 9.818270, 5.236411, 0.392811, 0.646243, 0.170306, 0.340613,
        {-2.534992, -0.059605, 0.193065, -2.282322}, {-2.54, 0.00, 0.200269, -0.148770}, 0.391750, -2.539945, 55.847},
  Metal{"W", "bcc", 2.740840, 3.487340, 37.234847, 37.234847, 8.900114, 4.746728, 0.882435, 1.394592, 0.139209, 0.278417,
        {-4.946281, -0.148818, 0.365057, -4.432406}, {-4.96, 0.00, 0.661935, 0.348147}, 0.582714, -4.961306, 183.84},
};
// clang-format on

double decaying(double x, double rate, double shift)
{
  return std::exp(-rate * (x - 1)) / (1 + std::pow(x - shift, 20));
}

double density(const Metal &m, double r)
{
  return m.f_e * decaying(r / m.r_e, m.beta, m.lambda);
}

double pair(const Metal &m, double r)
{
  const double x = r / m.r_e;
  return m.a * decaying(x, m.alpha, m.kappa) - m.b * decaying(x, m.beta, m.lambda);
}

double pair(const Metal &m, const Metal &n, double r)
{
  if (&m == &n)
    return pair(m, r);
  const double ratio = density(n, r) / density(m, r);
  return 0.5 * (ratio * pair(m, r) + pair(n, r) / ratio);
}

double polynomial(const std::array<double, 4> &c, double x)
{
  return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

double embedding(const Metal &m, double rho)
{
  const double rho_n = 0.85 * m.rho_e, rho_0 = 1.15 * m.rho_e;
  if (rho < rho_n)
    return polynomial(m.f_n, rho / rho_n - 1);
  if (rho < rho_0)
    return polynomial(m.f, rho / m.rho_e - 1);
  const double power = std::pow(rho / m.rho_s, m.eta);
  return m.f_above * (1 - std::log(power)) * power;
}

const Metal &metal(const std::string &name)
{
  const auto found =
      std::find_if(metals.begin(), metals.end(), [&](const Metal &m) { return name == m.name; });
  core::require(found != metals.end(), "no built-in potential for \"" + name + "\": there are " +
                                           list_of_names(zhou_metals()) +
                                           "; choose one of these or a file");
  return *found;
}

Spline embedding_spline(const Metal &m)
{
  constexpr int n = 4000;
  const double largest = 3 * m.rho_e;
  std::vector<double> values(n + 1);
  for (int k = 0; k <= n; ++k)
    values[k] = electron_volt * embedding(m, largest * k / n);
  return {largest / n, values};
}
} // namespace

const std::vector<std::string> &zhou_metals()
{
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Metal &m : metals)
      all.emplace_back(m.name);
    return all;
  }();
  return names;
}

Potential zhou_johnson_wadley(const std::vector<std::string> &names)
{
  core::require(!names.empty(), "no metal is named");
  double widest = 0;
  for (const std::string &name : names)
    widest = std::max(widest, metal(name).r_e);
  const double begin = 2.0 * widest, end = 2.3 * widest;
  const auto spline = [&](const FunctionOfDistance &function, double unit) {
    return sample(
        [&](double r) { return unit * function(r / angstrom) * taper(r / angstrom, begin, end); },
        end * angstrom, 4000);
  };
  std::vector<Species> species;
  std::vector<Spline> pairs, densities, embeddings;
  for (const std::string &name : names) {
    const Metal &m = metal(name);
    const bool is_bcc = std::string(m.lattice) == "bcc";
    species.push_back({name, m.mass * atomic_mass_unit,
                       m.r_e * angstrom * (is_bcc ? 2 / std::sqrt(3.) : std::sqrt(2.)), m.lattice});
    embeddings.push_back(embedding_spline(m));
    for (const std::string &other : names) {
      const Metal &n = metal(other);
      pairs.push_back(spline([&](double r) { return pair(m, n, r); }, electron_volt));
      densities.push_back(spline([&](double r) { return density(n, r); }, 1));
    }
  }
  return {std::move(species), std::move(pairs), std::move(densities), std::move(embeddings)};
}
} // namespace ligament::md
