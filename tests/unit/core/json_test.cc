#include "core/json.h"

#include <gtest/gtest.h>

using namespace ligament::core;
using Kind = JsonValue::Kind;

namespace
{
JsonValue parse(const std::string &text)
{
  std::vector<Diagnostic> errors;
  JsonValue value = parse_json(text, "t", errors);
  for (const Diagnostic &error : errors)
    ADD_FAILURE() << to_string(error);
  return value;
}

/// Place and message of the only mistake.
std::string mistake(const std::string &text)
{
  std::vector<Diagnostic> errors;
  parse_json(text, "t", errors);
  EXPECT_EQ(errors.size(), 1u) << text;
  return errors.empty() ? "" : to_string(errors[0].place) + " " + errors[0].message;
}
} // namespace

TEST(Json, PlacesOfKeysAndValuesAreTheirFirstCharacters)
{
  const JsonValue root =
      parse("// first line\n{\n  \"a\": [1,\n    {\"b\" : -2.5e3}],\n\t\"c\":\"x\"}");
  EXPECT_EQ(to_string(root.place), "t:2:1");
  const JsonMember *a = root.find("a");
  ASSERT_TRUE(a);
  EXPECT_EQ(to_string(a->place), "t:3:3");
  EXPECT_EQ(to_string(a->value.place), "t:3:8");
  EXPECT_EQ(to_string(a->value.elements[0].place), "t:3:9");
  const JsonMember &b = a->value.elements[1].members[0];
  EXPECT_EQ(to_string(b.place), "t:4:6");
  EXPECT_EQ(to_string(b.value.place), "t:4:12");
  EXPECT_EQ(b.value.number, -2500);
  EXPECT_EQ(to_string(root.find("c")->place), "t:5:2");
}

TEST(Json, ColumnsCountCharactersNotBytes)
{
  const JsonValue root = parse("{\"\u00e4\u20ac\": 1, \"b\": 2}");
  EXPECT_EQ(root.find("b")->place.column, 11);
}

TEST(Json, CommentsAreBlanks)
{
  const JsonValue root = parse("/* a\n b */ { // c\n \"a\" /**/ : /* \" */ 1 // d\n }\n// e");
  EXPECT_EQ(root.find("a")->value.number, 1);
  EXPECT_EQ(root.find("a")->place.line, 3);
}

TEST(Json, ByteOrderMarkIsSkipped)
{
  EXPECT_EQ(parse("\xEF\xBB\xBF[]").place.column, 1);
}

TEST(Json, Values)
{
  const JsonValue v = parse("[null, true, false, 0, -0.5, 1e-400, \"\", [], {}]");
  EXPECT_TRUE(v.elements[0].is(Kind::null));
  EXPECT_TRUE(v.elements[1].boolean);
  EXPECT_FALSE(v.elements[2].boolean);
  EXPECT_EQ(v.elements[3].number, 0);
  EXPECT_EQ(v.elements[4].number, -0.5);
  EXPECT_EQ(v.elements[5].number, 0); // below the smallest double
  EXPECT_TRUE(v.elements[6].is(Kind::string));
  EXPECT_TRUE(v.elements[7].is(Kind::array));
  EXPECT_TRUE(v.elements[8].is(Kind::object));
}

TEST(Json, Escapes)
{
  EXPECT_EQ(parse(R"("\"\\\/\b\f\n\r\t")").text, "\"\\/\b\f\n\r\t");
  EXPECT_EQ(parse(R"("\u0041\u00e9\u20AC\ud83d\ude00")").text, "A\u00e9\u20ac\U0001F600");
}

TEST(Json, DuplicateKeysAreFoundAtEveryDepthAndTheFirstIsKept)
{
  std::vector<Diagnostic> errors;
  const JsonValue root =
      parse_json("{\"a\": 1, \"b\": {\"c\": 1, \"c\": 2},\n \"a\": 3}", "t", errors);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0].key, "/b/c");
  EXPECT_EQ(to_string(errors[0].place), "t:1:24");
  EXPECT_EQ(errors[1].key, "/a");
  EXPECT_EQ(to_string(errors[1].place), "t:2:2");
  EXPECT_EQ(root.find("a")->value.number, 1);
}

TEST(Json, MistakesOfSyntaxHaveAPlace)
{
  EXPECT_EQ(mistake("{\n\"a\": 1\n\"b\": 2}"), "t:3:1 expected a comma or }, found \"\"\"");
  EXPECT_EQ(mistake("[1,]"), "t:1:3 a comma before ]");
  EXPECT_EQ(mistake("[1"), "t:1:1 this bracket is never closed");
  EXPECT_EQ(mistake("\"a"), "t:1:1 this string does not end on its line");
  EXPECT_EQ(mistake("[1] 2"), "t:1:5 text after the end of the scene");
  EXPECT_EQ(mistake("/* a"), "t:1:1 this comment does not end");
  EXPECT_EQ(mistake("[nan]"), "t:1:2 \"nan\" is not a finite number");
  EXPECT_EQ(mistake("1e999"), "t:1:1 \"1e999\" is too large for a number");
  EXPECT_EQ(mistake("01"), "t:1:1 \"01\" is not a number");
  EXPECT_EQ(mistake(""), "t:1:1 expected a value, found the end of the text");
  EXPECT_EQ(mistake("\"\xff\""), "t:1:2 a byte that is not UTF-8");
  EXPECT_EQ(mistake("\"\xc0\xaf\""), "t:1:2 a byte that is not UTF-8");     // overlong
  EXPECT_EQ(mistake("\"\xed\xa0\x80\""), "t:1:2 a byte that is not UTF-8"); // surrogate
}

TEST(Json, QuotedInputDoesNotReachTheTerminalAsItIs)
{
  const Diagnostic d = {{"scene.json", 1, 2}, "/a", "unknown key \"a\n\x1b[31m\"", "r\r", "\x7F"};
  EXPECT_EQ(to_string(d), "scene.json:1:2: error: unknown key \"a\\x0a\\x1b[31m\"\n"
                          "  reason: r\\x0d\n  remedy: \\x7f");
}

TEST(Json, DepthIsLimited)
{
  EXPECT_TRUE(parse(std::string(64, '[') + std::string(64, ']')).is(Kind::array));
  EXPECT_EQ(mistake(std::string(100000, '[')), "t:1:65 more than 64 levels of brackets");
}

TEST(Json, EveryBeginningOfATextIsRefusedWithoutHarm)
{
  const std::string text = R"({"a": [1.5e3, "\u00e4x", true, null], /* c */ "b": {"c": -2}})";
  parse(text);
  for (std::size_t n = 0; n < text.size(); ++n) {
    std::vector<Diagnostic> errors;
    parse_json(text.substr(0, n), "t", errors);
    EXPECT_FALSE(errors.empty()) << text.substr(0, n);
  }
}

TEST(Json, PlaceOfAPointer)
{
  const JsonValue root = parse("{\"a\": [1,\n {\"b/c\": 2}]}");
  EXPECT_EQ(to_string(place_of(root, "")), "t:1:1");
  EXPECT_EQ(to_string(place_of(root, "/a")), "t:1:2");
  EXPECT_EQ(to_string(place_of(root, "/a/1/b~1c")), "t:2:3");
  EXPECT_EQ(to_string(place_of(root, "/a/1/missing")), "t:2:2");
  EXPECT_EQ(pointer_parts("/x~0y/~1"), (std::vector<std::string>{"x~y", "/"}));
}
