#include "server/app/golden/finding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/palette.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ObjectFact Thing(const std::string& name) {
  ObjectFact object;
  object.name = name;
  object.pixels = 300;
  object.x_px = 100;
  object.y_px = 50;
  return object;
}

ObjectFact Load(const std::string& joint, LoadClass load_class, double ratio) {
  ObjectFact object = Thing(joint);
  object.load_class = load_class;
  object.ratio = ratio;
  return object;
}

PictureFacts Facts() {
  PictureFacts facts;
  facts.objects = {Load("right_elbow", LoadClass::kLow, 0.29), Thing("centre of pressure")};
  facts.texts = {{"title", "a lift", 20, 30}, {"legend", "≤ 60 %", 20, 400}};
  facts.cameras = {{"", render::Camera()}};
  return facts;
}

std::vector<std::string> Words(const PictureFacts& actual) {
  std::vector<std::string> words;
  for (const GoldenFinding& finding : Compare(Facts(), actual)) words.push_back(finding.text);
  return words;
}

TEST(Findings, AreNoneForTheSamePicture) { EXPECT_THAT(Words(Facts()), IsEmpty()); }

TEST(Findings, NameTheJointWhoseClassHasChangedBeforeWhatIsLess) {
  PictureFacts now = Facts();
  now.objects[0] = Load("right_elbow", LoadClass::kMedium, 0.31);
  now.texts[1].text = "≤ 70 %";
  EXPECT_THAT(Words(now), ElementsAre("right_elbow: expected low (green), found medium (orange)",
                                      "legend: expected “≤ 60 %”, found “≤ 70 %”",
                                      "right_elbow: expected a load ratio of 0.290, found 0.310"));
}

TEST(Findings, NameWhatIsMissingAndNew) {
  PictureFacts now = Facts();
  now.objects[1].name = "robot 1";
  EXPECT_THAT(Words(now), ElementsAre("centre of pressure: is missing; expected at x 100, y 50",
                                      "robot 1: is new, at x 100, y 50"));
}

TEST(Findings, SayWhenALoadIsNoLongerKnown) {
  PictureFacts now = Facts();
  now.objects[0].ratio.reset();
  EXPECT_THAT(Words(now), ElementsAre("right_elbow: its load is now unknown"));
}

TEST(Findings, AllowTwoPixelsOfPlaceAndNoMore) {
  PictureFacts now = Facts();
  now.objects[1].x_px += 1.9;
  EXPECT_THAT(Words(now), IsEmpty());
  now.objects[1].x_px += 1.1;
  EXPECT_THAT(Words(now), ElementsAre("centre of pressure: moved by 3.0 px"));
}

TEST(Findings, SayWhenSomethingIsCovered) {
  PictureFacts now = Facts();
  now.objects[1].pixels = 100;
  EXPECT_THAT(Words(now), ElementsAre("centre of pressure: expected 300 px in front, found 100"));
}

TEST(Findings, SayWhenLessShinesThrough) {
  PictureFacts now = Facts(), before = Facts();
  before.objects[1].through = 127;
  const auto findings = Compare(before, now);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].text, "centre of pressure: expected 127 px shining through, found 0");
}

// From any side, and also where nothing of it is drawn.
TEST(Findings, NameTheJointThatIsBentFurtherBeforeTheCameraThatItMoves) {
  const auto bent = [](double degrees) -> std::array<double, 4> {
    const double half = degrees * M_PI / 360;
    return {std::cos(half), 0, std::sin(half), 0};
  };
  PictureFacts before = Facts();
  before.joints = {{"right_elbow", bent(40)}, {"left_elbow", bent(40)}};
  PictureFacts now = before;
  now.joints[0].parent_from_child = bent(43);
  now.joints[1].parent_from_child = bent(40.4);
  now.cameras[0].camera.target.y() += 0.01;
  const auto findings = Compare(before, now);
  ASSERT_GE(findings.size(), 2u);
  EXPECT_EQ(findings[0].text, "right_elbow: turned by 3.0°");
  EXPECT_EQ(findings[0].x_px, 100) << "where the load of the joint is seen";
  EXPECT_EQ(findings[1].kind, FindingKind::kCamera);
  const auto written = FactsFrom(nlohmann::json::parse("{" + ToJson(now) + "}"));
  ASSERT_EQ(written.joints.size(), 2u);
  EXPECT_EQ(written.joints[1].name, "right_elbow");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(written.joints[1].parent_from_child[i], bent(43)[i], 1e-4);
  }
  for (const GoldenFinding& each : Compare(Facts(), now)) {
    EXPECT_EQ(each.kind, FindingKind::kCamera) << "an older lock has no joints";
  }
}

TEST(Findings, HaveTextsByTheirPart) {
  PictureFacts now = Facts();
  now.texts.erase(now.texts.begin());
  now.texts.push_back({"banner", "STALE", 300, 40});
  now.texts[0].y_px += 18;
  EXPECT_THAT(Words(now),
              ElementsAre("banner: text “STALE” is new", "title: text “a lift” is missing",
                          "legend: texts moved by up to 18.0 px"));
}

// Half a degree moves no load sphere by a pixel, because they are near the target.
TEST(Findings, MeasureTheCamera) {
  PictureFacts now = Facts();
  now.cameras[0].camera = Turned(now.cameras[0].camera, 0.5 * M_PI / 180);
  const auto words = Words(now);
  ASSERT_EQ(words.size(), 1u);
  EXPECT_THAT(words[0], ::testing::StartsWith("camera: turned by 0.4"));  // about the vertical
  now = Facts();
  render::Camera& camera = now.cameras[0].camera;
  camera.position += 0.1 * (camera.target - camera.position).normalized();
  EXPECT_THAT(Words(now), ElementsAre("camera: is 100 mm nearer"));
}

TEST(Findings, KnowTheFloor) {
  PictureFacts now = Facts();
  now.has_floor = false;
  EXPECT_THAT(Words(now), ElementsAre("floor: expected a floor, found none"));
  PictureFacts then = now = Facts();
  now.floor_z_m = 0.05;
  EXPECT_THAT(Words(now), IsEmpty()) << "a lock of an earlier version does not say where it was";
  then.floor_z_m = 0;
  const auto findings = Compare(then, now);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].text, "floor: expected 0.000 m, found 0.050 m");
  EXPECT_EQ(findings[0].kind, FindingKind::kFloor);
}

TEST(Findings, AreALineForEachObject) {
  PictureFacts now = Facts();
  now.objects[0] = Load("right_elbow", LoadClass::kMedium, 0.31);
  now.objects[0].x_px += 5;
  std::vector<GoldenFinding> findings = Compare(Facts(), now);
  findings.push_back({FindingKind::kPixels, kWholePicture, "", "", 0, "9 pixels differ"});
  EXPECT_THAT(
      Summarize(findings),
      ElementsAre("right_elbow: expected low (green), found medium (orange); expected a load "
                  "ratio of 0.290, found 0.310; moved by 5.0 px",
                  "9 pixels differ"));
}

TEST(Findings, OfManyObjectsAreToldTogether) {
  PictureFacts before, now;
  for (const char* joint : {"left_hip", "left_knee", "right_hip", "right_knee", "l5_s1"}) {
    before.objects.push_back(Load(joint, LoadClass::kUnknown, 0));
    before.objects.back().ratio.reset();
    now.objects.push_back(Load(joint, LoadClass::kLow, 0.1));
  }
  now.objects.back().load_class = LoadClass::kHigh;
  EXPECT_THAT(
      Summarize(Compare(before, now)),
      ElementsAre("5 loads (left_hip, left_knee and 3 more): expected unknown (grey), found 1 "
                  "high (red), 4 low (green)",
                  "5 loads are now known"));
}

}  // namespace
}  // namespace kinescope::app
