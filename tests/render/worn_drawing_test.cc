// Gloves, props and tracked objects, tested by what the picture shows.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/palette.h"
#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"
#include "tests/worn.h"

namespace kinescope::render {
namespace {

using kinescope::testing::BodyAlone;
using kinescope::testing::FrontCamera;
using kinescope::testing::Wear;

constexpr int kWornWidth = 640, kWornHeight = 480;

SceneState Gloved(double bend = 0.3) {
  SceneState state = BodyAlone();
  Wear(state.people[0], bend);
  return state;
}

// Without what is drawn of both hands.
SceneState Handless() {
  SceneState state = BodyAlone();
  auto model = std::make_shared<PersonModel>(*state.people[0].model);
  for (urdf::Link& link : model->robot.links) {
    if (link.name == "skeleton_right_hand" || link.name == "skeleton_left_hand") {
      link.visuals.clear();
    }
  }
  state.people[0].model = model;
  return state;
}

class WornDrawing : public ::testing::Test {
 protected:
  WornDrawing() {
    spec_.width = kWornWidth;
    spec_.height = kWornHeight;
    spec_.overlays = false;
  }
  Image Draw(const SceneState& state) { return renderer_->Render(state, FrontCamera(), spec_); }
  Comparison Change(const SceneState& before, const SceneState& after) {
    return Compare(Draw(before), Draw(after));
  }

  std::unique_ptr<Renderer> renderer_ = MakeRenderer();
  PictureSpec spec_;
};

constexpr double kOutOfSight = -50;  // m, x: behind the person and beyond the floor's end

TEST_F(WornDrawing, ShowsAGlovedHandByItsFingersOnly) {
  SceneState gone = Gloved();
  for (auto& glove : gone.people[0].gloves) {
    for (urdf::Pose& link : glove->links) link.position = {10, 0, 0};  // behind the camera
  }
  for (auto& prop : gone.people[0].props) {
    if (prop) prop->pose.position = {10, 0, 0};
  }
  EXPECT_TRUE(Change(Handless(), gone).equal());
  EXPECT_GT(Change(gone, Gloved()).pixels, 500);
}

TEST_F(WornDrawing, ShowsAFingerAtItsPose) {
  SceneState before = Gloved();
  SceneState after = before;
  const int tip = 7;  // SecondDP
  urdf::Pose& pose = after.people[0].gloves[urdf::kLeft]->links[tip];
  const Eigen::Vector3d was = pose.position, is(0, 0.9, 1.6);
  pose.position = is;
  const Comparison change = Change(before, after);
  const Projected from = Project(was, FrontCamera(), kWornWidth, kWornHeight);
  const Projected to = Project(is, FrontCamera(), kWornWidth, kWornHeight);
  EXPECT_NEAR(change.top, to.y_px, 4);
  EXPECT_NEAR(change.bottom, from.y_px, 6);
  EXPECT_NEAR(change.right, to.x_px, 4);
}

TEST_F(WornDrawing, ShowsBentFingers) {
  const Comparison change = Change(Gloved(0), Gloved(1.2));
  EXPECT_GT(change.pixels, 100);
  const PersonState person = Gloved(0).people[0];
  const Projected wrist =
      Project(person.links[urdf::kRightHand].position, FrontCamera(), kWornWidth, kWornHeight);
  EXPECT_GT(change.top, wrist.y_px) << "all below the wrists";
}

TEST_F(WornDrawing, AddsAndRemovesGlovesWhileThePersonStays) {
  EXPECT_TRUE(Compare(Draw(BodyAlone()), Draw(BodyAlone())).equal());
  const Image bare = Draw(BodyAlone());
  const Image gloved = Draw(Gloved());
  EXPECT_GT(Compare(bare, gloved).pixels, 300);
  EXPECT_TRUE(Compare(bare, Draw(BodyAlone())).equal());
  EXPECT_TRUE(Compare(gloved, Draw(Gloved())).equal());
}

TEST_F(WornDrawing, ShowsAPropAsABoxAtItsPose) {
  SceneState before = Gloved();
  before.people[0].props[0]->pose.position.x() = kOutOfSight;
  SceneState after = Gloved();
  const Eigen::Vector3d at = after.people[0].props[0]->pose.position;
  const Comparison change = Change(before, after);
  const Projected seen = Project(at, FrontCamera(), kWornWidth, kWornHeight);
  EXPECT_NEAR((change.left + change.right) / 2.0, seen.x_px, 3);
  EXPECT_NEAR(change.right - change.left, 0.06 * seen.px_per_m, 4);
}

TEST_F(WornDrawing, ShowsAStaleGloveAndPropInGrey) {
  SceneState state = Gloved();
  state.liveness = Liveness::kStale;
  const Image stale = Draw(state);
  const Projected at =
      Project(state.people[0].props[2]->pose.position, FrontCamera(), kWornWidth, kWornHeight);
  const auto pixel = static_cast<std::size_t>(
      4 * (static_cast<int>(at.y_px) * kWornWidth + static_cast<int>(at.x_px)));
  EXPECT_NEAR(stale.rgba[pixel], stale.rgba[pixel + 2], 12) << "a live prop is bluish";
}

TEST_F(WornDrawing, ShowsATrackedObjectAsABoxWithItsName) {
  const SceneState before = BodyAlone();
  SceneState after = before;
  const Eigen::Vector3d at(0, 0.8, 1.2);
  after.objects.push_back({4, 0, "HTC Vive 1", {at, Eigen::Quaterniond::Identity()}, 5});
  const Comparison change = Change(before, after);
  const Projected seen = Project(at, FrontCamera(), kWornWidth, kWornHeight);
  EXPECT_NEAR(change.bottom, seen.y_px + 0.025 * seen.px_per_m, 3);
  EXPECT_NEAR(change.top, seen.y_px - 0.15 * seen.px_per_m, 3) << "its z axis";
  EXPECT_NEAR(change.right, seen.x_px + 0.15 * seen.px_per_m, 3) << "its y axis";
  spec_.overlays = true;
  SceneState nameless = after;
  nameless.objects[0].name.clear();
  EXPECT_GT(Compare(Draw(nameless), Draw(after)).pixels, 200);
}

TEST_F(WornDrawing, ShowsAnyNumberOfObjects) {
  SceneState state = BodyAlone();
  for (int i = 0; i < 70; ++i) {
    state.objects.push_back({4 + i / 23, i % 23, "", {{0, -1.0 + 0.03 * i, 0.3}, {1, 0, 0, 0}}, 5});
  }
  SceneState fewer = state;
  fewer.objects.pop_back();
  const Comparison last = Change(fewer, state);
  const Projected at =
      Project(state.objects.back().pose.position, FrontCamera(), kWornWidth, kWornHeight);
  EXPECT_NEAR(last.right, at.x_px + 0.15 * at.px_per_m, 4);
  fewer.objects.clear();
  EXPECT_TRUE(Compare(Draw(BodyAlone()), Draw(fewer)).equal());
}

// Where the legs are not measured, the floor is wherever the soles are.
TEST_F(WornDrawing, MovesEverythingWithTheFloor) {
  SceneState state = Gloved();
  state.objects.push_back({4, 0, "", {{0, 0.8, 1.2}, Eigen::Quaterniond::Identity()}, 5});
  SceneState low = state;
  const Eigen::Vector3d down(0, 0, -0.9);
  low.floor_z = down.z();
  PersonState& person = low.people[0];
  for (urdf::Pose& link : person.links) link.position += down;
  for (auto& glove : person.gloves) {
    for (urdf::Pose& link : glove->links) link.position += down;
  }
  for (auto& prop : person.props) {
    if (prop) prop->pose.position += down;
  }
  low.objects[0].pose.position += down;
  Camera camera = FrontCamera();
  camera.position += down;
  camera.target += down;
  EXPECT_TRUE(Compare(Draw(state), renderer_->Render(low, camera, spec_)).equal());
}

}  // namespace
}  // namespace kinescope::render
