// What ROS sees: the picture of the state, by the camera that goes out with it, while somebody
// listens.
#include "server/app/serve/ros_camera_loop.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "core/errors.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::app {
namespace {

constexpr std::chrono::seconds kPatience{60};  // only a failure takes so long

std::shared_ptr<const SceneState> SceneAt(std::int64_t stamp_nanos) {
  auto scene = std::make_shared<SceneState>();
  scene->liveness = Liveness::kLive;
  scene->stamp_nanos = stamp_nanos;
  scene->people.push_back(testing::MakePerson(
      testing::MakeModel(), testing::Posture(static_cast<double>(stamp_nanos)), 1, stamp_nanos));
  return scene;
}

struct Taken {
  std::vector<std::uint8_t> rgba;
  std::int64_t stamp_nanos = 0;
};

class Album {
 public:
  RosCameraLoop::Send Send() {
    return [this](const ros_bridge::RosImage& picture) {
      const std::lock_guard<std::mutex> lock(mutex_);
      taken_.push_back({picture.rgba, picture.stamp_nanos});
      changed_.notify_all();
    };
  }
  // The newest, once there are so many; empty when they do not come.
  Taken Newest(std::size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    const bool came = changed_.wait_for(lock, kPatience, [&] { return taken_.size() >= count; });
    EXPECT_TRUE(came) << taken_.size() << " of " << count << " pictures";
    return came ? taken_.back() : Taken();
  }
  std::size_t size() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return taken_.size();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Taken> taken_;
};

const RosCameraSettings kSmall{CameraController(ParseCamera("front"), {}), 96, 64, 240};

TEST(RosCameraLoop, ShowsWhatARendererShowsOfThatStateByThatCamera) {
  const auto state = SceneAt(7);
  Album album;
  RosCameraLoop loop(kSmall, RenderersOf({}), state, album.Send());
  loop.SetSubscribers(1);
  const Taken taken = album.Newest(1);
  EXPECT_EQ(taken.stamp_nanos, 7);
  const render::Image alone = render::MakeRenderer()->Render(
      *state, render::NamedCamera("front", *state), {96, 64, 1, "", true});
  EXPECT_TRUE(taken.rgba == alone.rgba) << "not the same bytes";
}

TEST(RosCameraLoop, DrawsOnlyWhileSomebodyListensAndAtOnceForWhoeverComes) {
  Album album;
  RosCameraLoop loop(kSmall, RenderersOf({}), SceneAt(1), album.Send());
  for (std::int64_t stamp = 2; stamp < 50; ++stamp) loop.OnState(SceneAt(stamp));
  EXPECT_EQ(loop.status().drawn, 0u);
  loop.SetSubscribers(1);
  EXPECT_EQ(album.Newest(1).stamp_nanos, 49) << "the newest, and none of those before";
  loop.SetSubscribers(2);
  EXPECT_EQ(album.Newest(2).stamp_nanos, 49) << "nothing moves, but somebody new is there";
  loop.SetSubscribers(0);
  loop.OnState(SceneAt(50));
  loop.SetSubscribers(1);
  EXPECT_EQ(album.Newest(3).stamp_nanos, 50);
  EXPECT_EQ(album.size(), 3u);
  EXPECT_EQ(loop.status().viewers, 1);
}

}  // namespace
}  // namespace kinescope::app
