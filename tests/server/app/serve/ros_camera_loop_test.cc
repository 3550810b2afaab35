// What ROS receives: the picture of the state, with the calibration of its camera. When it is drawn
// is tested in drawing_loop_test.cc.
#include "server/app/serve/ros_camera_loop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <vector>

#include "server/picture/picture_shapes.h"
#include "server/picture/pinhole.h"
#include "tests/patience.h"
#include "tests/server/picture/fake_renderer.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::app {
namespace {

using kinescope::testing::kPatience;

std::shared_ptr<const SceneState> SceneAt(std::int64_t stamp_nanos) {
  auto scene = std::make_shared<SceneState>();
  scene->liveness = Liveness::kLive;
  scene->stamp_nanos = stamp_nanos;
  scene->people.push_back(testing::MakePerson(
      testing::MakeModel(), testing::Posture(static_cast<double>(stamp_nanos)), 1, stamp_nanos));
  return scene;
}

struct Sent {
  std::vector<std::uint8_t> rgba;
  std::int64_t stamp_nanos = 0;
  urdf::Pose world_from_optical;
  double focal_px = 0;
};

// The first picture that is sent; further ones are dropped.
class FirstPicture {
 public:
  RosCameraLoop::Send Send() {
    return [this](const ros_bridge::RosImage& image) {
      if (is_sent_) return;
      is_sent_ = true;
      picture_.set_value({image.rgba, image.stamp_nanos, image.world_from_optical, image.focal_px});
    };
  }
  Sent Get() {
    std::future<Sent> picture = picture_.get_future();
    if (picture.wait_for(kPatience) == std::future_status::ready) return picture.get();
    ADD_FAILURE() << "no picture was sent";
    return {};
  }

 private:
  bool is_sent_ = false;  // used by the drawing thread only
  std::promise<Sent> picture_;
};

const RosCameraSettings kSmall{CameraController(ParseCamera("front"), {}), 96, 64, 240};

TEST(RosCameraLoop, SendsThePictureOfARendererAndTheCalibrationOfItsCamera) {
  const auto state = SceneAt(7);
  FirstPicture first;
  RosCameraLoop loop(kSmall, RenderersOf({}), state, first.Send());
  loop.SetSubscribers(1);
  const Sent sent = first.Get();
  EXPECT_EQ(sent.stamp_nanos, 7);
  const render::Camera camera = CameraController(ParseCamera("front"), {})
                                    .AimLive(*state, PictureShapes().Of(LiveView(96, 64), *state));
  EXPECT_TRUE(sent.rgba == render::MakeRenderer()->Render(*state, camera, LiveView(96, 64)).rgba)
      << "not the same bytes";
  const Pinhole pinhole = PinholeOf(camera, 64);
  EXPECT_EQ(sent.focal_px, pinhole.focal_px);
  EXPECT_EQ(sent.world_from_optical.position, pinhole.world_from_optical.position);
  EXPECT_TRUE(sent.world_from_optical.orientation.isApprox(pinhole.world_from_optical.orientation));
}

TEST(RosCameraLoop, RendersNothingBeforeTheFirstSubscriber) {
  FirstPicture first;
  RosCameraLoop loop(
      kSmall,
      [](const std::function<void(const std::string&)>&) {
        return std::make_unique<testing::FakeRenderer>();
      },
      SceneAt(1), first.Send());
  for (const std::int64_t stamp : {2, 3, 4}) loop.OnState(SceneAt(stamp));
  EXPECT_EQ(loop.status().renderer.backend, "") << "no renderer";
  loop.SetSubscribers(1);
  EXPECT_EQ(first.Get().stamp_nanos, 4) << "the newest, and none of those before";
  EXPECT_EQ(loop.status().viewers, 1);
}

}  // namespace
}  // namespace kinescope::app
