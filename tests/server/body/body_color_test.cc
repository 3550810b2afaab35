#include "server/body/body_color.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "server/scene/scene_builder.h"
#include "server/subject/subject.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::app {
namespace {

double NearestClass(const Rgb& body) {
  double nearest = 1e9;
  for (const LoadClass load_class : {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh}) {
    nearest = std::min(nearest, ColorDifference(body, ColorOf(load_class)));
  }
  return nearest;
}

TEST(BodyColor, OfTheFirstPersonIsTheStandardColour) {
  EXPECT_EQ(BodyColor(std::nullopt, 0), kBodyColor);
}

TEST(BodyColor, DistinguishesPeopleAndKeepsTheClassesReadable) {
  for (std::size_t i = 0; i < kBodyColors; ++i) {
    EXPECT_GE(NearestClass(BodyColor(std::nullopt, i)), kMinContrast) << i;
    // A joint whose load is unknown, and a body that went stale, are grey: nearer, but not the
    // same.
    EXPECT_GE(ColorDifference(BodyColor({}, i), ColorOf(LoadClass::kUnknown)), 12) << i;
    EXPECT_GE(ColorDifference(BodyColor({}, i), kStaleBodyColor), 15) << i;
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_GE(ColorDifference(BodyColor({}, i), BodyColor({}, k)), 9) << i << " and " << k;
    }
  }
  EXPECT_EQ(BodyColor({}, kBodyColors), BodyColor({}, 0));
}

TEST(BodyColor, OfAnOptionIsRefusedWhereItLooksLikeALoadClassWithOneThatDoesNot) {
  int refused = 0;
  for (std::uint32_t rgb = 0; rgb <= 0xFFFFFF; rgb += 0x0A0B07) {
    const auto channel = [&](int shift) { return (rgb >> shift & 0xFF) / 255.0; };
    const Rgb color = {channel(16), channel(8), channel(0)};
    const auto near = FindNearClass(color);
    ASSERT_EQ(near.has_value(),
              std::min(NearestClass(color), ColorDifference(color, ColorOf(LoadClass::kUnknown))) <
                  kMinContrast);
    refused += near ? 1 : 0;
    if (!near) {
      ASSERT_EQ(NearestSafeColor(color), color);
      const SuitColors suit = SuitOf(kBodyColor, color);
      EXPECT_EQ(suit.top, color);
      EXPECT_FALSE(FindNearClass(suit.trousers)) << ToHex(color) << ' ' << ToHex(suit.trousers);
      continue;
    }
    const Rgb safe = NearestSafeColor(color);
    EXPECT_FALSE(FindNearClass(safe)) << ToHex(color);
    EXPECT_LT(ColorDifference(color, safe), 30) << ToHex(color) << ' ' << ToHex(safe);
  }
  EXPECT_GT(refused, 3);
}

TEST(BodyColor, TintsTheBandsOfASuitOnly) {
  const Rgb own = BodyColor(0xFF0000, 0);
  const SuitColors suit = SuitOf(own, std::nullopt);
  EXPECT_EQ(suit.band, own);
  EXPECT_EQ(suit.top, SuitColors().top);
  EXPECT_EQ(SuitOf(kBodyColor, std::nullopt).band, SuitColors().top) << "no colour of its own";
}

TEST(BodyColor, IsMutedIfAPersonalColourHidesTheClasses) {
  for (std::uint32_t r = 0; r <= 0xFF; r += 0x11) {
    for (std::uint32_t g = 0; g <= 0xFF; g += 0x11) {
      for (std::uint32_t b = 0; b <= 0xFF; b += 0x11) {
        const Rgb body = BodyColor(r << 16 | g << 8 | b, 0);
        ASSERT_GE(NearestClass(body), kMinContrast) << r << ' ' << g << ' ' << b;
        for (const double channel : body) {
          ASSERT_GE(channel, 0);
          ASSERT_LE(channel, 1);
        }
      }
    }
  }
  const Rgb orange = BodyColor(0xE96417, 0);
  EXPECT_GT(orange[0], orange[1]);
  EXPECT_GT(orange[1], orange[2]) << "still of its hue";
}

Rgb ColorIn(const PersonState& person) {
  const Eigen::Vector4d rgba = *person.model->robot.links.front().visuals.front().rgba;
  return {rgba[0], rgba[1], rgba[2]};
}

void ExpectColor(const PersonState& person, const Rgb& expected) {
  const Rgb actual = ColorIn(person);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(actual[i], expected[i], 1e-5) << i;
}

TEST(BodyColor, IsInTheUrdfOfEachPersonAndFollowsTheStream) {
  SceneOptions options;
  options.appearance.is_smooth = false;
  std::shared_ptr<const SceneState> last;
  SceneBuilder builder(options, "test", 0, [&](auto state) { last = state; });
  BodySample sample = subject::MakeMotion("n_pose")->At(0);
  builder.OnSample(sample);
  sample.character = 1;
  builder.OnSample(sample);
  ASSERT_EQ(last->people.size(), 2U);
  ExpectColor(last->people[0], kBodyColor);
  ExpectColor(last->people[1], BodyColor({}, 1));
  const std::uint64_t revision = last->people[1].model->revision;

  Character painted;
  painted.id = 1;
  painted.color_rgb = 0x3C78A0;
  builder.OnCharacter(painted);
  builder.OnCharacter(painted);
  builder.OnSample(sample);
  ExpectColor(last->people[1], BodyColor(0x3C78A0, 1));
  EXPECT_EQ(last->people[1].model->revision, revision + 1) << "the same colour again is no news";
  ExpectColor(last->people[0], kBodyColor);
}

}  // namespace
}  // namespace kinescope::app
