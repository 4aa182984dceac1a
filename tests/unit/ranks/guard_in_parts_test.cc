// The guard of the overlap sees of a body in parts what it sees of the whole one.
#include "src/simulation/overlap_guard.h"
#include "tests/support/ranks.h"
#include "tests/support/small_plate.h"

#include <set>

namespace ligament::program
{
namespace
{
using test::ranks;

/// A body whose one particle out of the overlap is displaced, by whoever holds it.
struct Pulled
{
  explicit Pulled(CoupledBody<2> &the_body) : body(the_body) { OverlapGuard<2> notes(body); }

  std::optional<std::string> look(std::int64_t name, const Vector<2> &displacement)
  {
    auto &p = body.zone->state;
    for (int i = 0; i < p.size(); ++i)
      if (p.global_id[i] == name)
        for (int c = 0; c < 2; ++c)
          p.displacement[c][i] = displacement[c];
    auto bodies = body.bodies();
    ++step.step;
    step.time = double(step.step) * step.dt;
    body.coupler->compute_forces(bodies, step);
    return OverlapGuard<2>(body).look(body, step.time);
  }

  CoupledBody<2> &body;
  coupling::StepTime step{0, 0, body.dt};
};

// Each particle that has a face with a member of the overlap and is none is drawn away from it,
// until a face is near its limit.
void expect_to_see_what_the_whole_does(const std::string &packing)
{
  const Scene scene = tests::small_scene(std::vector<std::string>{
      "/specimen/size=[80, 80]", // seams run through the overlap, which closes around the zone
      R"(/discrete_zone/region={"lower": [-19, -19], "upper": [19, 19]})",
      "/discrete_zone/packing=\"" + packing + "\"",
      R"(/material/fracture={"criterion": "face_tension", "strength": 0.01})"});
  tests::SmallBody small(scene);
  core::Log log;
  core::Timers timers;
  Reference reference;
  auto parts = make_body<2>(scene, log, timers, reference, make_many_body_force<2>, ranks());
  Pulled part(parts), whole(small.body);
  const auto &p = small.body.zone->state;
  std::set<int> members;
  for (const auto &m : small.body.coupler->overlap()->members)
    members.insert(m.particle);
  std::vector<std::pair<int, Vector<2>>> pulls; // out of the overlap
  small.body.force()->for_each_face(p, [&](const particles::FaceView<2> &face) {
    if (face.j >= 0 && members.count(face.i) == 0 && members.count(face.j) > 0)
      pulls.push_back({face.i, Vector<2>(-face.normal)});
  });
  ASSERT_GT(pulls.size(), 20u);
  for (const auto &[i, way] : pulls) {
    std::optional<std::string> seen;
    for (double u = 4e-3; !seen && u < 0.1; u *= 1.08) {
      seen = whole.look(p.global_id[i], u * way);
      EXPECT_EQ(part.look(p.global_id[i], u * way), seen);
    }
    EXPECT_TRUE(seen && seen->find(" bears 9") != seen->npos) << seen.value_or("nothing");
    whole.look(p.global_id[i], Vector<2>::Zero());
    part.look(p.global_id[i], Vector<2>::Zero());
  }
}

TEST(GuardInParts, SeesFacesAcrossSeams)
{
  for (const char *packing : {"hexagonal", "square", "random"}) {
    SCOPED_TRACE(packing);
    expect_to_see_what_the_whole_does(packing);
  }
}
} // namespace
} // namespace ligament::program
