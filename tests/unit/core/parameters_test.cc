// The table of keys on a small input of its own.
#include "core/check.h"
#include "core/parameters/describe_parameters.h"
#include "core/parameters/override.h"
#include "core/parameters/read_parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace ligament::core;

namespace
{
enum class Mode
{
  slow,
  fast
};

struct Wheel
{
  double radius = 0;
  Point axis = {0, 0, 1};
};

struct Brake
{
  double force = 7;
};

struct Car
{
  std::string name = "car";
  int seats = 4;
  Mode mode = Mode::slow;
  double mass = 0, interval = std::numeric_limits<double>::infinity();
  std::optional<double> load;
  bool open = false;
  Point turn = {0, 0, 0};
  PartialPoint push;
  std::vector<Wheel> wheels;
  std::optional<Brake> brake;
};

void declare_wheel(ParameterSection &s, Wheel &w)
{
  s.add("radius", w.radius, "half the width").in("m").above(0).required();
  s.add("axis", w.axis, "of rotation");
}

void declare_brake(ParameterSection &s, Brake &b)
{
  s.add("force", b.force, "pedal").in("N");
}

void declare_car(ParameterSection &s, Car &car)
{
  s.add("name", car.name, "what it is called");
  s.add("mode", car.mode, "how it drives", {"slow", "fast"});
  ParameterSection &body = s.section("body", "the metal");
  body.add("seats", car.seats, "how many sit").at_least(1).at_most(9);
  body.add("mass", car.mass, "all together").in("kg").above(0).required();
  body.add("load", car.load, "on the roof").in("N").at_least(0);
  body.add("open", car.open, "no roof").only_in(3);
  s.add("interval", car.interval, "between services")
      .in("s")
      .above(0)
      .word("never", std::numeric_limits<double>::infinity());
  s.add("turn", car.turn, "heading").in("rad").as_rotation();
  s.add("push", car.push, "force on it").in("N");
  s.list("wheels", car.wheels, "round", declare_wheel);
  s.section("brake", car.brake, "none", "stops it", declare_brake);
}

struct Input
{
  explicit Input(const std::string &text, int dimension = 2,
                 const std::vector<std::string> &overrides = {})
  {
    declare_car(table, car);
    JsonValue json = parse_json(text, "t", errors);
    for (const std::string &o : overrides)
      apply_override(table, o, json, errors);
    read_parameters(table, json, "", dimension, table, errors);
  }
  Car car;
  ParameterSection table;
  std::vector<Diagnostic> errors;
  std::string all() const
  {
    std::string text;
    for (const Diagnostic &e : errors)
      text += to_string(e) + "\n";
    return text;
  }
};

const char *const full = R"({"name": "van", "mode": "fast",
  "body": {"seats": 2, "mass": "1.5 t", "load": "2 kN"},
  "interval": "2 h", "turn": "90 deg", "push": [null, "3 N"],
  "wheels": [{"radius": 0.25, "axis": [1, 0]}, {"radius": "30 cm"}], "brake": {"force": 5}})";
} // namespace

TEST(Parameters, EveryKindOfValueIsRead)
{
  const Input in(full);
  EXPECT_EQ(in.all(), "");
  EXPECT_EQ(in.car.name, "van");
  EXPECT_EQ(in.car.mode, Mode::fast);
  EXPECT_EQ(in.car.seats, 2);
  EXPECT_EQ(in.car.mass, 1500);
  EXPECT_EQ(in.car.load.value(), 2000);
  EXPECT_EQ(in.car.interval, 7200);
  EXPECT_DOUBLE_EQ(in.car.turn[0], std::acos(-1.0) / 2);
  EXPECT_FALSE(in.car.push[0]);
  EXPECT_EQ(in.car.push[1].value(), 3);
  ASSERT_EQ(in.car.wheels.size(), 2u);
  EXPECT_EQ(in.car.wheels[0].axis, (Point{1, 0, 0}));
  EXPECT_EQ(in.car.wheels[1].radius, 0.3);
  EXPECT_EQ(in.car.wheels[1].axis, (Point{0, 0, 1})); // its default, not that of its predecessor
  EXPECT_EQ(in.car.brake.value().force, 5);
}

TEST(Parameters, DefaultsAreWhatTheVariablesHeld)
{
  const Input in(R"({"body": {"mass": 1}})");
  EXPECT_EQ(in.all(), "");
  EXPECT_EQ(in.car.name, "car");
  EXPECT_EQ(in.car.seats, 4);
  EXPECT_FALSE(in.car.load);
  EXPECT_FALSE(in.car.brake);
}

TEST(Parameters, EchoReadsBackToItself)
{
  const Input first(full);
  const std::string text = echo(first.table, 2).dump();
  const Input second(text);
  EXPECT_EQ(second.all(), "");
  EXPECT_EQ(echo(second.table, 2).dump(), text);
  EXPECT_EQ(second.car.wheels[1].radius, 0.3);
  EXPECT_EQ(text.find("open"), std::string::npos); // a key of 3D only

  const Input defaults(R"({"body": {"mass": 1}})");
  const auto json = echo(defaults.table, 2);
  EXPECT_EQ(json["interval"], "never");
  EXPECT_EQ(json["brake"], "none");
  EXPECT_TRUE(json["body"]["load"].is_null());
  const Input again(json.dump());
  EXPECT_EQ(again.all(), "");
  EXPECT_EQ(again.car.interval, std::numeric_limits<double>::infinity());
}

TEST(Parameters, AllErrorsComeAtOnceWithPlaceReasonAndRemedy)
{
  const Input in("{\"nme\": 1,\n \"body\": {\"seats\": 10},\n \"mode\": \"fats\",\n"
                 " \"wheels\": [{\"radius\": \"3 kg\"}]}");
  EXPECT_EQ(in.all(),
            "t:1:2: error: unknown key \"nme\" in /, did you mean \"name\"?\n"
            "  reason: only known keys are read, a misspelt one would be lost\n"
            "  remedy: write \"name\"\n"
            "t:2:20: error: \"seats\" in /body is 10, which is out of range\n"
            "  reason: how many sit\n"
            "  remedy: give a value at least 1, at most 9\n"
            "t:2:10: error: missing key \"mass\" in /body\n"
            "  reason: it has no default: all together\n"
            "  remedy: add \"mass\": a number in kg\n"
            "t:3:10: error: unknown word \"fats\" for \"mode\" in /, did you mean \"fast\"?\n"
            "  reason: how it drives\n"
            "  remedy: choose \"slow\" or \"fast\"\n"
            "t:4:24: error: unit of \"radius\" in /wheels/0 does not fit: \"3 kg\" is in kg, "
            "expected m\n"
            "  reason: half the width\n"
            "  remedy: give a plain number in m, or a string with a unit of this kind such as "
            "\"1 m\"\n");
}

TEST(Parameters, BoundsAreOpenOrClosed)
{
  EXPECT_EQ(Input(R"({"body": {"mass": 1, "seats": 9}})").errors.size(), 0u);
  EXPECT_EQ(Input(R"({"body": {"mass": 1, "seats": 10}})").errors.size(), 1u);
  EXPECT_EQ(Input(R"({"body": {"mass": 1, "seats": 0}})").errors.size(), 1u);
  EXPECT_EQ(Input(R"({"body": {"mass": 0}})").errors.size(), 1u);
  EXPECT_EQ(Input(R"({"body": {"mass": 1, "load": 0}})").errors.size(), 0u);
}

TEST(Parameters, DimensionDecidesComponentsAndKeys)
{
  EXPECT_EQ(Input(R"({"body": {"mass": 1, "open": true}, "turn": [0, 0, 1]})", 3).errors.size(),
            0u);
  EXPECT_EQ(Input(R"({"body": {"mass": 1, "open": true}})", 2).errors.size(), 1u);
  EXPECT_EQ(Input(R"({"body": {"mass": 1}, "turn": [0, 0, 1]})", 2).errors.size(), 1u);
  EXPECT_EQ(Input(R"({"body": {"mass": 1}, "push": [1, 2]})", 3).errors.size(), 1u);
  EXPECT_EQ(Input(R"({"body": {"mass": 1}, "push": [1, 2]})", 0).errors.size(), 0u); // not known
}

TEST(Overrides, ReplaceAddAndGrow)
{
  const Input in(full, 2,
                 {"/name=a b", "/body/mass=2 kg", "/wheels/1/radius=1", "/wheels/-={\"radius\": 2}",
                  "/brake=none", "/push/0=4 N"});
  EXPECT_EQ(in.all(), "");
  EXPECT_EQ(in.car.name, "a b");
  EXPECT_EQ(in.car.mass, 2);
  ASSERT_EQ(in.car.wheels.size(), 3u);
  EXPECT_EQ(in.car.wheels[1].radius, 1);
  EXPECT_EQ(in.car.wheels[2].radius, 2);
  EXPECT_FALSE(in.car.brake);
  EXPECT_EQ(in.car.push[0].value(), 4);
  EXPECT_EQ(Input("{}", 2, {"/body/mass=3"}).car.mass, 3); // the section is made
  EXPECT_EQ(Input(R"({"body": {"mass": 1}, "brake": "none"})", 2, {"/brake/force=3"})
                .car.brake.value()
                .force,
            3);
}

TEST(Overrides, ErrorsNameTheOverride)
{
  const auto only = [](const std::string &text) {
    const Input in(full, 2, {text});
    EXPECT_EQ(in.errors.size(), 1u) << in.all();
    return in.errors.empty() ? "" : to_string(in.errors[0].place) + ": " + in.errors[0].message;
  };
  EXPECT_EQ(only("/body/seats=20"),
            "--set /body/seats: \"seats\" in /body is 20, which is out of range");
  EXPECT_EQ(only("/body/seat=2"),
            "--set /body/seat: unknown key \"seat\" in /body, did you mean \"seats\"?");
  EXPECT_EQ(only("/wheels/2/radius=1"), "--set /wheels/2/radius: /wheels has no element 2 yet");
  EXPECT_EQ(only("/body/seats/x=1"),
            "--set /body/seats/x: \"seats\" in /body has no keys below it");
  EXPECT_EQ(only("name=x"), "--set name: cannot read \"name=x\"");
}

TEST(Explain, FindsKeysByPathAndName)
{
  Car car;
  ParameterSection table;
  declare_car(table, car);
  const std::string text = "/wheels/*/radius\n"
                           "  meaning  half the width\n"
                           "  type     a number in m\n"
                           "  unit     m\n"
                           "  default  required\n"
                           "  allowed  above 0\n";
  EXPECT_EQ(explain(table, "/wheels/0/radius"), text);
  EXPECT_EQ(explain(table, "wheels.radius"), text);
  EXPECT_EQ(explain(table, "radius"), text);
  EXPECT_NE(explain(table, "body").find("/body/seats"), std::string::npos); // with all below
  EXPECT_NE(explain(table, "").find("/brake/force"), std::string::npos);
  try {
    explain(table, "raduis");
    FAIL();
  } catch (const InputError &error) {
    EXPECT_STREQ(error.what(), "there is no key \"raduis\", did you mean \"radius\"?");
  }
  EXPECT_EQ(explain_json(table, "seats")[0]["default"], "4");
}

TEST(Schema, SaysWhatTheTableSays)
{
  Car car;
  ParameterSection table;
  declare_car(table, car);
  const auto json = schema(table);
  EXPECT_EQ(json["properties"]["body"]["properties"]["seats"]["maximum"], 9);
  EXPECT_EQ(json["properties"]["body"]["required"], nlohmann::ordered_json({"mass"}));
  EXPECT_EQ(json["properties"]["mode"]["enum"], nlohmann::ordered_json({"slow", "fast"}));
  EXPECT_EQ(json["additionalProperties"], false);
  EXPECT_EQ(json["required"], nlohmann::ordered_json({"body"}));
}

// A band says what inputs have in practice, and in which units other numbers were probably meant.
TEST(Parameters, UnusualValuesAreDoubtedAndAbsurdOnesRefused)
{
  struct
  {
    double modulus = 0, angle = 0;
    Point place = {0, 0, 0};
  } body;
  ParameterSection table;
  table.add("modulus", body.modulus, "stiffness").in("Pa").above(0).usually(1e5, 2e12, "GPa MPa");
  table.add("angle", body.angle, "turn").in("rad").usually(0, 6.3, "deg").at_most(1000);
  table.add("place", body.place, "where").in("m").usually(0, 1e4, "mm um");
  const auto read = [&](const std::string &text) {
    std::vector<Diagnostic> errors, warnings;
    read_parameters(table, parse_json(text, "t", errors), "", 2, table, errors, &warnings);
    std::string all;
    for (const auto *list : {&errors, &warnings})
      for (const Diagnostic &d : *list)
        all += to_string(d) + "\n";
    return all;
  };
  EXPECT_EQ(read(R"({"modulus": 1e5, "angle": -6.3, "place": [0, 1e-30]})"), "");
  EXPECT_EQ(read(R"({"modulus": 72})"),
            "t:1:13: warning: \"modulus\" in / is 72 Pa, which is unusual\n"
            "  reason: stiffness; usual are 100000 to 2e+12 Pa\n"
            "  remedy: did you mean \"72 GPa\"?\n");
  EXPECT_EQ(body.modulus, 72) << "doubted, and read all the same";
  const auto has = [&](const std::string &text, const std::string &part) {
    return read(text).find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(R"({"modulus": 72000})", "did you mean \"72000 MPa\"?"));
  EXPECT_TRUE(has(R"({"modulus": "72 Pa"})", "remedy: check the value and its unit"));
  EXPECT_TRUE(has(R"({"angle": -30})", "did you mean \"-30 deg\"?"));
  EXPECT_TRUE(has(R"({"angle": 1e9})", "error: \"angle\" in / is 1000000000 rad, which is out of"));
  EXPECT_TRUE(has(R"({"modulus": 1e30})", "error: \"modulus\" in / is 1e+30 Pa, which is beyond"));
  EXPECT_TRUE(has(R"({"modulus": 1e-30})", "which is beyond reason"));
  // One warning for a point, and none behind another mistake of it.
  EXPECT_EQ(read(R"({"place": [20000, 30000]})"),
            "t:1:12: warning: component 1 of \"place\" in / is 20000 m, which is unusual\n"
            "  reason: where; usual are up to 10000 m\n"
            "  remedy: did you mean \"20000 mm\"?\n");
}
