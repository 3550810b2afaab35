// What a picture shows, found by drawing it with numbers for colours.
#include "render/contents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "render/camera/spheres.h"
#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/marker_samples.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::FrontCamera;
using kinescope::testing::MixedScene;
using kinescope::testing::Posture;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Field;
using ::testing::Not;

class Contents : public ::testing::Test {
 protected:
  Contents() {
    spec_.width = 640;
    spec_.height = 480;
    spec_.supersample = 2;
    spec_.title = "the title";
  }
  PictureContents Of(const SceneState& state) {
    image_ = renderer_->Render(state, FrontCamera(), spec_);
    return renderer_->Contents(state, FrontCamera(), spec_);
  }
  static std::map<std::string, SeenObject> ByName(const PictureContents& contents) {
    std::map<std::string, SeenObject> by_name;
    for (const SeenObject& object : contents.objects) by_name[object.name] = object;
    return by_name;
  }

  std::unique_ptr<Renderer> renderer_ = MakeRenderer();
  PictureSpec spec_;
  Image image_;
};

TEST_F(Contents, AreTheThingsOfAPersonWhereTheyAre) {
  const SceneState state = MixedScene(Posture::kStanding);
  const auto seen = ByName(Of(state));
  ASSERT_EQ(seen.count("body"), 1u);
  ASSERT_EQ(seen.count("centre of mass"), 1u);
  for (const SphereInPicture& sphere : LocateSpheres(state, FrontCamera(), 640, 480)) {
    ASSERT_EQ(seen.count(sphere.joint), 1u) << sphere.joint;
    const SeenObject& object = seen.at(sphere.joint);
    const double most = M_PI * sphere.radius_px * sphere.radius_px;
    EXPECT_LT(object.pixels + object.through, 1.1 * most + 8) << sphere.joint;
    EXPECT_GE(object.box.x, sphere.x_px - sphere.radius_px - 2) << sphere.joint;
    EXPECT_LE(object.box.x + object.box.width, sphere.x_px + sphere.radius_px + 2);
    EXPECT_GE(object.box.y, sphere.y_px - sphere.radius_px - 2) << sphere.joint;
    EXPECT_LE(object.box.y + object.box.height, sphere.y_px + sphere.radius_px + 2);
  }
  const SeenObject& knee = seen.at("left_knee");
  EXPECT_GT(knee.pixels, 20) << "in front of the leg";
}

TEST_F(Contents, NameEachMarkerTrailLoadAndObject) {
  SceneState state = MixedScene(Posture::kArmsForward);
  std::vector<std::string> expected;
  for (const SceneMarker& marker : testing::MarkersOfAllTypes("/missing.stl")) {
    state.markers.push_back(std::make_shared<SceneMarker>(marker));
    if (marker.type != MarkerType::kText) expected.push_back("marker " + IdentityOf(marker));
  }
  auto glass = std::make_shared<SceneMarker>(*state.markers.front());
  glass->ns = "glass";
  glass->color.w() = 0.5;
  glass->pose.position.x() += 0.3;
  state.markers.push_back(glass);
  expected.emplace_back("marker glass/0");
  const auto line = [](double y) {
    return std::vector<Eigen::Vector3d>{{0.5, y, 0}, {0.5, y, 0.3}};
  };
  spec_.look.trails = {{line(0.6), {1, 0, 0}, "left_hand"}, {line(-0.6), {0, 0, 1}, "pelvis"}};
  expected.insert(expected.end(), {"trail of left_hand", "trail of pelvis"});
  PersonState& person = state.people.front();
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    HandForce& hand = person.forces.hands[side];
    hand.mass_kg = 5 + 5 * side;
    hand.grip = hand.point = person.links[urdf::At(urdf::HandSegmentOf(side))].position;
    expected.emplace_back(side == urdf::kRight ? "load in the right hand"
                                               : "load in the left hand");
  }
  for (int i = 0; i < 40; ++i) {  // more than one draw call takes
    TrackedObject object;
    object.name = "box " + std::to_string(i);
    object.pose.position = {0.6, 0.9 - 0.045 * i, 0.2};
    state.objects.push_back(object);
    expected.push_back("object " + object.name);
  }
  spec_.look.shown.Set(ScenePart::kFrames, true);
  expected.emplace_back("link frames");
  const auto seen = ByName(Of(state));
  for (const std::string& name : expected) EXPECT_EQ(seen.count(name), 1u) << name;
  EXPECT_GT(seen.at("load in the right hand").x_px, 0);
  // They face the camera: their left is on the right.
  EXPECT_LT(seen.at("load in the right hand").x_px, seen.at("load in the left hand").x_px);
  EXPECT_LT(seen.at("trail of pelvis").x_px, seen.at("trail of left_hand").x_px);
  EXPECT_LT(seen.at("object box 39").x_px, seen.at("object box 0").x_px);
}

// Not what the scene has, but what the picture shows.
TEST_F(Contents, HaveNothingThatIsHidden) {
  const SceneState state = MixedScene(Posture::kStanding);
  ASSERT_THAT(ByName(Of(state)), Contains(::testing::Key("centre of pressure")));
  spec_.look.shown.Set(ScenePart::kCop, false);
  spec_.look.shown.Set(ScenePart::kBody, false);
  const auto seen = ByName(Of(state));
  EXPECT_EQ(seen.count("centre of pressure"), 0u);
  EXPECT_EQ(seen.count("body"), 0u);
  EXPECT_EQ(seen.at("left_knee").through, 0) << "nothing is in front of it";
}

TEST_F(Contents, DoNotChangeThePicturesThatFollow) {
  const SceneState state = MixedScene(Posture::kDeepBend);
  Of(state);
  const Image first = image_;
  Of(state);
  EXPECT_TRUE(Compare(first, image_, 0).equal());
}

TEST_F(Contents, AreTheTextsWithTheirPlaces) {
  const PictureContents contents = Of(MixedScene(Posture::kStanding));
  EXPECT_THAT(contents.texts, Contains(AllOf(Field(&PaintedText::text, "the title"),
                                             Field(&PaintedText::part, "title"))));
  EXPECT_THAT(contents.texts, Contains(Field(&PaintedText::part, "legend")));
  for (const PaintedText& text : contents.texts) {
    EXPECT_GE(text.x_px, 0) << text.text;
    EXPECT_LE(text.x_px + text.width_px, spec_.width) << text.text;
  }
  spec_.overlays = false;
  EXPECT_THAT(Of(MixedScene(Posture::kStanding)).texts, ::testing::IsEmpty());
}

TEST_F(Contents, NameTheViewOfSeveral) {
  spec_.panes = {{"front", FrontCamera()}, {"back", Turned(FrontCamera(), M_PI)}};
  spec_.pane_columns = 2;
  const PictureContents contents = Of(MixedScene(Posture::kStanding));
  int bodies = 0;
  for (const SeenObject& object : contents.objects) {
    if (object.name != "body") continue;
    ++bodies;
    EXPECT_EQ(object.view == "back", object.x_px > 320) << object.view;
  }
  EXPECT_EQ(bodies, 2);
}

}  // namespace
}  // namespace kinescope::render
