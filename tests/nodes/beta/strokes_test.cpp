#include "beta/strokes_node.h"
#include "nodes/beta/fields.h"

namespace sherd {
namespace {

using namespace test;

TEST(Strokes, AreReadWithDefaults) {
  const auto strokes = readStrokes(
      R"([{ "points": [[0, 1, 2], [3.5, -4, 5e-1]], "radius": 0.1, "value": 8 },
          { "points": [1, 2, 3], "radius": 2, "value": -1, "falloff": 0, "blend": "max" }])");
  ASSERT_TRUE(strokes.ok()) << errorOf(strokes);
  ASSERT_EQ(strokes->size(), 2u);
  const Stroke &line = strokes.value()[0], &dab = strokes.value()[1];
  EXPECT_EQ(line.points, (std::vector<Vec3>{{0, 1, 2}, {3.5, -4, 0.5}}));
  EXPECT_EQ(line.radius, 0.1);
  EXPECT_EQ(line.value, 8);
  EXPECT_EQ(line.falloff, 0.5);
  EXPECT_EQ(line.blend, Blend::Replace);
  EXPECT_EQ(dab.points, (std::vector<Vec3>{{1, 2, 3}}));
  EXPECT_EQ(dab.falloff, 0);
  EXPECT_EQ(dab.blend, Blend::Max);
  EXPECT_TRUE(readStrokes("[]")->empty());
}

TEST(Strokes, WhatIsWrongIsNamed) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({})", "strokes would have to be a list"},
      {R"([)", "strokes would have to be a list"},
      {R"([7])", "stroke 1 is 7"},
      {R"([{ "points": [0, 0, 0], "radius": 1, "value": 2 }, { "point": [0, 0, 0] }])",
       R"(stroke 2 has no field "point"; did you mean "points"?)"},
      {R"([{ "radius": 1, "value": 2 }])", R"(stroke 1 has no "points")"},
      {R"([{ "points": [], "radius": 1, "value": 2 }])", "stroke 1 has no list of points"},
      {R"([{ "points": "here", "radius": 1, "value": 2 }])", "stroke 1 has no list of points"},
      {R"([{ "points": [[0, 0, 0], [0, 0]], "radius": 1, "value": 2 }])", "isn't three numbers, number 2"},
      {R"([{ "points": [0, 0, 0], "value": 2 }])", R"(stroke 1 has no "radius")"},
      {R"([{ "points": [0, 0, 0], "radius": "wide", "value": 2 }])", R"(radius that is the string "wide")"},
      {R"([{ "points": [0, 0, 0], "radius": 0, "value": 2 }])", "stroke 1 has a radius of 0"},
      {R"([{ "points": [0, 0, 0], "radius": 1 }])", R"(stroke 1 has no "value")"},
      {R"([{ "points": [0, 0, 0], "radius": 1, "value": 2, "falloff": 2 }])", "stroke 1 has a falloff of 2"},
      {R"([{ "points": [0, 0, 0], "radius": 1, "value": 2, "blend": "multply" }])",
       "stroke 1 has a blend that is"},
  };
  for (const auto& [json, part] : cases) EXPECT_TRUE(says(errorOf(readStrokes(json)), part)) << json;
}

}  // namespace
}  // namespace sherd
