// Discs of iron held at the field of a stress intensity, at rest at each: on which front it
// cleaves.
#include "md/analytic.h"
#include "src/verification/cases/atoms.h"
#include "src/verification/instruments/crack_disc.h"

namespace ligament::program
{
namespace
{
CrackDisc iron_disc(const Vector<3> &along_x, const Vector<3> &along_y)
{
  md::CrystalParameters<3> p;
  p.kind = md::CrystalKind::bcc;
  p.orientation = md::orientation_of(along_x, along_y);
  return {md::Crystal<3>(md::zhou_johnson_wadley({"Fe"}), p), 5e-9};
}

/// The stress intensity over Griffith's at which the tip first passes the middle of the disc or
/// something slips; 2 if neither does.
double first_step(CrackDisc &disc, double from, double by)
{
  double share = from;
  for (; share < 2; share += by) {
    disc.load(share);
    if (disc.tip() > 0 || disc.slipped() > 0)
      break;
  }
  return share;
}

std::vector<Result> discs()
{
  const std::string name = "atoms_crack_disc/";
  CrackDisc cleaving = iron_disc({0, 1, -1}, {1, 0, 0});
  cleaving.load(1);
  const double held = cleaving.tip();
  const double opens = first_step(cleaving, 1.02, 0.01);
  const int slipped = cleaving.slipped();
  CrackDisc closing = iron_disc({0, 1, -1}, {1, 0, 0});
  closing.load(1);
  closing.load(0.85);
  CrackDisc slipping = iron_disc({1, 0, 0}, {0, 1, 0});
  slipping.load(1);
  const double slips = first_step(slipping, 1.1, 0.1);
  // Energy asks for Griffith's load at least, a trap between rows lets a crack rest on both sides
  // of it.
  return {{name + "opens", opens, 1, {}, Result::Bound::at_least},
          {name + "opens_by_slip", double(slipped), 0, {}},
          {name + "closes", (closing.tip() - held) * 1e9, -0.1, {}}, // nm; half a spacing of rows
          // On this front slip comes first, whatever is loaded.
          {name + "slips", double(slipping.slipped()), 1, {}, Result::Bound::at_least},
          {name + "slips_at", slips, 1, {}, Result::Bound::at_least}};
}
} // namespace

std::vector<Case> atom_crack_disc_cases()
{
  return {
      {"atoms_crack_disc", "discs of iron held at the field of a stress intensity", true, discs}};
}
} // namespace ligament::program
