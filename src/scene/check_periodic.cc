// Axes along which a body repeats itself: what fits, and what cannot stand beside them.
#include "packings/periodic_sides.h"
#include "src/scene/check_scene.h"
#include "src/scene/zone_around.h"

#include "core/check.h"

#include <fmt/format.h>

#include <algorithm>

namespace ligament::program
{
namespace
{
using Extent = DiscreteZone::Extent;

constexpr const char *axis_names = "xyz";
const std::string section = "/specimen/periodic";

bool has_components(const PartialPoint &value)
{
  return std::any_of(value.begin(), value.end(), [](const auto &x) { return x.has_value(); });
}

/// Both sides of a box, or none, lie on the sides that are joined along the axis.
bool spans_or_keeps_off(const Scene &scene, const Point &lower, const Point &upper, int c)
{
  const double tolerance = 1e-9 * scene.specimen.size[c];
  return (lower[c] <= scene.specimen.lower(c) + tolerance) ==
         (upper[c] >= scene.specimen.upper(c) - tolerance);
}

bool spans(const Scene &scene, const Point &lower, const Point &upper, int c)
{
  return spans_or_keeps_off(scene, lower, upper, c) &&
         lower[c] <= scene.specimen.lower(c) + 1e-9 * scene.specimen.size[c];
}

class PeriodicCheck
{
public:
  PeriodicCheck(const Scene &scene, Findings &f) : scene_(scene), f_(f) {}

  void axes()
  {
    const auto &periodic = scene_.specimen.periodic;
    for (std::size_t k = 0; k < periodic.size(); ++k) {
      const std::string key = fmt::format("{}/{}", section, k);
      const int c = int(periodic[k].axis);
      if (c >= scene_.dimension)
        f_.error(key, fmt::format("{} is \"{}\" in 2D", key, axis_names[c]),
                 "a plane body has no sides across z", "remove it, or set \"dimension\" to 3");
      for (std::size_t j = 0; j < k; ++j)
        if (periodic[j].axis == periodic[k].axis)
          f_.error(key, fmt::format("\"{}\" stands twice in {}", axis_names[c], section),
                   "once joins the sides already", "remove one of them");
    }
    if (!scene_.specimen.is_plain() && f_.sound({section}))
      f_.error(section, "\"periodic\" in /specimen of a body with an outline of its own",
               "only boxes, with holes and notches cut out of them, repeat themselves",
               "give a \"size\", \"holes\" and \"notches\", or remove it");
  }

  void others()
  {
    if (!scene_.tools.empty() && f_.sound({"/tools"}))
      f_.error(section, "\"periodic\" in /specimen of a body with tools",
               "a tool has no images: it would touch the body at one place and not at the others",
               "remove the tools, or give a body with sides");
    for (std::size_t k = 0; k < scene_.initial_motion.size(); ++k) {
      const auto &spin = scene_.initial_motion[k].spin;
      const std::string key = fmt::format("/initial_motion/{}/spin", k);
      if ((spin[0] != 0 || spin[1] != 0 || spin[2] != 0) && f_.sound({key}))
        f_.error(key, fmt::format("\"spin\" in /initial_motion/{} of a periodic body", k),
                 "a body that repeats itself cannot turn: its images stay beside it",
                 "remove it, or give a body with sides");
    }
    for (std::size_t k = 0; k < scene_.loads.size(); ++k)
      side(scene_.loads[k].boundary, fmt::format("/loads/{}/boundary", k), scene_.loads[k].side);
    for (std::size_t k = 0; k < scene_.gauges.size(); ++k)
      if (const auto &gauge = scene_.gauges[k]; gauge.side)
        side(*gauge.side, fmt::format("/gauges/{}/side", k), gauge.side_name);
    const auto is_jump = [](const LoadParameters &l) { return l.periodic.has_value(); };
    if (scene_.time.stop_when == StopWhen::specimen_broken && f_.sound({"/time/stop_when"}) &&
        std::any_of(scene_.loads.begin(), scene_.loads.end(), is_jump))
      f_.error("/time/stop_when",
               "\"stop_when\" in /time waits for a body in two parts, and a jump loads it",
               "through its joined sides a body that repeats itself holds together",
               "give a \"duration\" alone");
    const std::string loading = "/time/loading";
    if (scene_.time.has_phases() && scene_.far_field && f_.sound({loading, "/far_field"}))
      f_.error(loading,
               fmt::format("\"loading\" in /time is \"{}\" for a periodic body with a far field",
                           word_of(scene_.time.loading)),
               "equilibria of a mesh know no joined sides yet",
               "choose \"dynamic\", with /damping for slow tests, or the pure discrete twin");
  }

  /// The zone reaches both of two joined sides, or none.
  void zone()
  {
    if (scene_.zone.extent != Extent::box)
      return;
    const bool many = !scene_.zone.boxes.empty();
    std::vector<ZoneBox> boxes = scene_.zone.boxes;
    if (!many)
      boxes.push_back({scene_.zone.lower, scene_.zone.upper});
    for (std::size_t k = 0; k < boxes.size(); ++k)
      for (int c = 0; c < scene_.dimension; ++c) {
        const std::string key = many && !scene_.zone.around
                                    ? fmt::format("/discrete_zone/boxes/{}", k)
                                    : zone_place(scene_);
        if (!scene_.specimen.is_periodic(c) || !f_.sound({key}))
          continue;
        if (!spans_or_keeps_off(scene_, boxes[k].lower, boxes[k].upper, c))
          f_.error(key,
                   fmt::format("{} reaches one of the two sides that are joined along {}", key,
                               axis_names[c]),
                   "beyond them lies the other end of the body, which is mesh: particles and cells "
                   "would be joined without an overlap",
                   "let it reach both sides, or none");
        else if (scene_.far_field && spans(scene_, boxes[k].lower, boxes[k].upper, c))
          overlap_through(c, key);
        else if (scene_.far_field && f_.sound({"/far_field", "/coupling"}))
          room(boxes[k], c, key);
      }
    if (f_.sound({"/coupling/scheme"}) && coupling::is_energy_weighted(scene_.coupling.scheme))
      f_.error("/coupling/scheme",
               fmt::format("\"scheme\" in /coupling is \"{}\" for a periodic body",
                           coupling::scheme_names[std::size_t(scene_.coupling.scheme)]),
               "its overlap does not go on through joined sides", "choose \"fine_scale_split\"");
  }

  /// Whether the packing fits.
  void packing()
  {
    if (scene_.zone.extent == Extent::none || !scene_.zone.packing || scene_.atoms ||
        !f_.sound_and_given({"/discrete_zone/spacing"}) ||
        !f_.sound({"/discrete_zone", "/specimen"}))
      return;
    if (scene_.dimension == 2)
      packing<2>();
    else
      packing<3>();
  }

private:
  /// What the coupler takes over must not reach nodes that follow those of the other side.
  void room(const ZoneBox &box, int c, const std::string &key)
  {
    const Specimen &s = scene_.specimen;
    const double needed = (scene_.coupling.transition_cells + 2) * scene_.far_field->cell_size,
                 gap = std::min(box.lower[c] - s.lower(c), s.upper(c) - box.upper[c]);
    if (gap < needed)
      f_.error(key,
               fmt::format("{} comes as near as {:.4g} m to the sides that are joined along {}",
                           key, gap, axis_names[c]),
               fmt::format("the transition of the overlap and two cells need {:.4g} m", needed),
               "make the zone smaller, or lower /coupling/transition_cells");
  }

  /// The overlap goes on through the joined sides.
  void overlap_through(int c, const std::string &key)
  {
    for (std::size_t l = 0; l < scene_.loads.size(); ++l)
      if (const std::string load = fmt::format("/loads/{}", l);
          scene_.loads[l].periodic && int(*scene_.loads[l].periodic) == c && f_.sound({load}))
        f_.error(load, fmt::format("{} is a jump across sides through which an overlap goes", load),
                 "the motion of the mesh in the overlap does not jump",
                 "load another side, or let the zone keep off these sides");
    if (!f_.sound({"/far_field"}))
      return;
    const double width = scene_.specimen.size[c], cell = scene_.far_field->cell_size;
    if (width < 2.5 * cell)
      f_.error(key,
               fmt::format("the body repeats itself after {:.4g} m along {}, two cells of the far "
                           "field",
                           width, axis_names[c]),
               "an overlap that goes on through joined sides needs three cells between them: the "
               "nearest image of a node must be one",
               fmt::format("make the specimen at least {:.4g} m wide there", 2.5 * cell));
  }

  void side(int boundary, const std::string &key, const std::string &name)
  {
    if (boundary < 0 || boundary >= 2 * scene_.dimension ||
        !scene_.specimen.is_periodic(boundary / 2) || !f_.sound({key}))
      return;
    f_.error(key, fmt::format("the side \"{}\" is joined with the one across the body", name),
             fmt::format("/specimen is periodic along {}: there is no surface",
                         axis_names[boundary / 2]),
             fmt::format("load it by a jump, {{\"periodic\": \"{}\", \"strain\": ..}}, or use "
                         "another side",
                         axis_names[boundary / 2]));
  }

  template <int dim>
  void packing()
  {
    packings::LatticeParameters<dim> p;
    p.spacing = scene_.zone.spacing;
    for (int c = 0; c < dim; ++c) {
      p.lower[c] = scene_.specimen.lower(c);
      p.upper[c] = scene_.specimen.upper(c);
      p.periodic[c] = scene_.specimen.is_periodic(c);
      if (scene_.zone.extent == Extent::box && scene_.zone.boxes.empty()) {
        p.zone_lower[c] = scene_.zone.lower[c];
        p.zone_upper[c] = scene_.zone.upper[c];
      }
    }
    for (int c = 0; c < n_spins<dim>; ++c)
      p.orientation[c] = scene_.zone.orientation[c];
    for (const Crack &crack : scene_.specimen.cracks) {
      auto &points = p.cracks.emplace_back();
      for (const Point &x : crack.points)
        points.push_back(Vector<dim>(x.data()));
    }
    if (!scene_.zone.boxes.empty())
      return;
    try {
      packings::PeriodicBox<dim> box(p);
      if (scene_.zone.is_irregular())
        return;
      p.kind = packings::lattice_kind(word_of(*scene_.zone.packing));
      packings::fit_period(p, box);
    } catch (const core::InputError &error) {
      const std::string text = error.what();
      const auto colon = text.find(": "), semicolon = text.find("; ");
      const auto cut = std::min(colon, semicolon);
      f_.error(section, "the particles do not repeat themselves", text.substr(0, cut),
               cut == std::string::npos ? "change the specimen" : text.substr(cut + 2));
    }
  }

  const Scene &scene_;
  Findings &f_;
};
} // namespace

void check_periodic(const Scene &scene, const Layout *, Findings &f)
{
  if (scene.specimen.periodic.empty())
    return;
  PeriodicCheck check(scene, f);
  check.axes();
  if (!f.sound({section}))
    return;
  check.others();
  check.zone();
  check.packing();
}

void check_jump(const Scene &scene, std::size_t k, Findings &f)
{
  const LoadParameters &load = scene.loads[k];
  const std::string key = fmt::format("/loads/{}", k);
  if (!load.periodic)
    return f.error(
        key + "/strain", fmt::format("\"strain\" in {} on a side", key),
        "it is that of a jump across joined sides",
        "give \"periodic\" with an axis in place of \"boundary\", or a \"displacement\"");
  const int axis = int(*load.periodic);
  if (!load.side.empty())
    return f.error(key + "/periodic", fmt::format("both \"boundary\" and \"periodic\" in {}", key),
                   "a load acts on a side, or is the jump across joined ones",
                   "remove one of them");
  if (!scene.specimen.is_periodic(axis))
    return f.error(key + "/periodic",
                   fmt::format("\"periodic\" in {} is \"{}\", along which the body has sides", key,
                               axis_names[axis]),
                   fmt::format("{} does not name the axis", section),
                   fmt::format("add \"{}\" to it, or load the sides", axis_names[axis]));
  std::vector<std::string> kinds;
  for (const auto &[name, value] :
       {std::pair("strain", &load.strain), std::pair("displacement", &load.displacement),
        std::pair("velocity", &load.velocity)})
    if (has_components(*value))
      kinds.push_back(name);
  if (kinds.empty())
    f.error(key, fmt::format("{} has no \"strain\", \"displacement\" or \"velocity\"", key),
            "a load without components does nothing", "add one of them, or remove the load");
  if (kinds.size() > 1)
    f.error(key + "/" + kinds[1],
            fmt::format("both \"{}\" and \"{}\" in {}", kinds[0], kinds[1], key),
            "one load is of one kind", "write two loads with different components");
  for (const auto &[name, is_given] :
       {std::pair("traction", has_components(load.traction)),
        std::pair("force", has_components(load.force)), std::pair("from", load.from.has_value()),
        std::pair("to", load.to.has_value()), std::pair("within", !load.within.is_everything()),
        std::pair("absorbing", load.absorbing),
        std::pair("absorbing_layer", load.absorbing_layer > 0),
        std::pair("pressure", load.pressure.has_value())})
    if (is_given)
      f.error(key + "/" + std::string(name), fmt::format("\"{}\" in {}, a jump", name, key),
              "joined sides have no surface for it", "remove it");
  if (load.servo)
    f.error(key + "/servo", fmt::format("\"servo\" in {}, a jump", key),
            "a servo moves a side of the specimen", "remove it, and give the jump a course");
  check_history(scene, load, key, f);
  if (!f.sound({key}))
    return;
  const auto jump = [](const LoadParameters &l, int c) {
    return l.strain[c] ? l.strain[c] : l.displacement[c] ? l.displacement[c] : l.velocity[c];
  };
  for (std::size_t j = 0; j < scene.loads.size(); ++j)
    for (int c = 0; c < scene.dimension; ++c) {
      const LoadParameters &other = scene.loads[j];
      if (!jump(load, c))
        continue;
      if (j < k && other.periodic == load.periodic && jump(other, c))
        return f.error(key + "/periodic",
                       fmt::format("component {} of the jump along {} is prescribed twice",
                                   axis_names[c], axis_names[axis]),
                       fmt::format("/loads/{} prescribes it already", j), "keep one of the two");
      if (!other.periodic && *jump(load, c) != 0 && (other.velocity[c] || other.displacement[c]))
        return f.error(
            key + "/periodic",
            fmt::format("{} moves the ends of the side \"{}\" apart in {}, and /loads/{} "
                        "holds it as one",
                        key, other.side, axis_names[c], j),
            "the two prescribe different motions of the same points",
            fmt::format("free component {} of /loads/{} (null), or of the jump", axis_names[c], j));
    }
}
} // namespace ligament::program
