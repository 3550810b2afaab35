// When pictures are drawn, by which camera, and what a driver that hangs does to them. The renderer
// is a fake and time is a variable: nothing here waits for a clock.
#include "server/picture/drawing_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <condition_variable>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "tests/captured_log.h"
#include "tests/patience.h"
#include "tests/server/picture/fake_renderer.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using kinescope::testing::kPatience;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr seconds kPeriod{1000};  // of live pictures; far beyond the time of this test
constexpr char kHang[] = "the driver does not respond";

std::shared_ptr<const SceneState> StateAt(int secs) {
  auto state = std::make_shared<SceneState>();
  state->stamp_nanos = std::int64_t{1'000'000'000} * (1000 + secs);
  return state;
}

int SecsOf(const SceneState& state) {
  return static_cast<int>(state.stamp_nanos / 1'000'000'000) - 1000;
}

class ProblematicRenderer : public testing::FakeRenderer {
 public:
  using FakeRenderer::FakeRenderer;
  std::vector<std::string> problems() const override { return {"a mesh is missing"}; }
};

// A loop, and everything that it meets. All functions are called on the test's thread.
class Studio {
 public:
  explicit Studio(CameraController camera = CameraController(ParseCamera("front"), {}),
                  const std::shared_ptr<const SceneState>& first = StateAt(0)) {
    DrawingSettings settings;
    settings.width = 32;
    settings.height = 16;
    settings.rate_hz = 1.0 / kPeriod.count();
    settings.now = [this] {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++looks_at_the_clock_;
      changed_.notify_all();
      return now_;
    };
    loop_.emplace(
        std::move(settings), std::move(camera),
        [this](std::function<void(const std::string&)> on_hang) {
          return MakeRenderer(std::move(on_hang));
        },
        first,
        [this](const render::Image&, const SceneState& state, const render::Camera&) {
          const std::lock_guard<std::mutex> lock(mutex_);
          delivered_.push_back(SecsOf(state));
          changed_.notify_all();
        });
  }
  // Whatever is held goes on, so that a test that fails also ends.
  ~Studio() { Release(); }

  DrawingLoop& loop() { return *loop_; }
  void End() { loop_.reset(); }

  void Advance(seconds by) {
    const std::lock_guard<std::mutex> lock(mutex_);
    now_ += by;
  }

  // The states of the live pictures, once there are so many.
  std::vector<int> Live(std::size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kPatience, [&] { return delivered_.size() >= count; }))
        << delivered_.size() << " of " << count << " live pictures";
    return delivered_;
  }
  // The same when a live picture is due and the loop has decided whether to draw it now: it has
  // looked at the clock after all that came before this call, and then it has done something else.
  std::vector<int> LiveAfterADecision() {
    std::unique_lock<std::mutex> lock(mutex_);
    const int before = looks_at_the_clock_;
    lock.unlock();
    TakeOne();
    lock.lock();
    EXPECT_TRUE(changed_.wait_for(lock, kPatience, [&] { return looks_at_the_clock_ > before; }));
    lock.unlock();
    TakeOne();
    lock.lock();
    return delivered_;
  }

  // Where the camera of a requested picture stands.
  Vector3d TakeOne(std::optional<CameraController> camera = std::nullopt) {
    loop_->Request(kSmall, std::move(camera)).get();
    const std::lock_guard<std::mutex> lock(mutex_);
    return position_;
  }

  // From now on every picture waits in the driver, until Release; with `hangs` the watchdog
  // reports that.
  void Hold(bool hangs) {
    const std::lock_guard<std::mutex> lock(mutex_);
    holds_ = true;
    hangs_ = hangs;
  }
  void Release() {
    const std::lock_guard<std::mutex> lock(mutex_);
    holds_ = hangs_ = false;
    changed_.notify_all();
  }
  // Returns once a picture is in the driver, and reported as hanging if Hold says so.
  void WaitForHeldPicture() {
    std::unique_lock<std::mutex> lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kPatience, [&] { return is_held_; }));
  }
  void FailToStartOnce() {
    const std::lock_guard<std::mutex> lock(mutex_);
    fails_ = true;
  }
  void WaitForStarts(int count) {
    std::unique_lock<std::mutex> lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, kPatience, [&] { return starts_ >= count; }));
  }

  const render::PictureSpec kSmall{16, 16, 1, "", true};

 private:
  std::unique_ptr<render::Renderer> MakeRenderer(std::function<void(const std::string&)> on_hang) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++starts_;
    changed_.notify_all();
    if (std::exchange(fails_, false)) throw render::RenderError("no back-end starts");
    return std::make_unique<ProblematicRenderer>(
        [this, on_hang](render::Image&, const SceneState&, const render::Camera& camera,
                        const render::PictureSpec&) { Draw(camera, on_hang); });
  }

  void Draw(const render::Camera& camera, const std::function<void(const std::string&)>& on_hang) {
    std::unique_lock<std::mutex> lock(mutex_);
    position_ = camera.position;
    if (!holds_) return;
    if (hangs_) {
      lock.unlock();
      on_hang(kHang);
      lock.lock();
    }
    is_held_ = true;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !holds_; });
    is_held_ = false;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  DrawingLoop::Clock::time_point now_{seconds(5'000'000)};
  int looks_at_the_clock_ = 0, starts_ = 0;
  std::vector<int> delivered_;
  Vector3d position_ = Vector3d::Zero();  // of the camera of the newest picture
  bool holds_ = false, hangs_ = false, is_held_ = false, fails_ = false;

  std::optional<DrawingLoop> loop_;  // last: it uses all other members
};

std::string ErrorOf(std::future<render::Image>& picture) {
  try {
    picture.get();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(DrawingLoop, RendersTheNewestStateOnlyForViewers) {
  Studio studio;
  for (const int secs : {1, 2, 3}) studio.loop().OnState(StateAt(secs));
  studio.TakeOne();
  EXPECT_EQ(studio.loop().status().drawn, 1u) << "the requested one";
  studio.loop().SetViewers(1);
  EXPECT_THAT(studio.Live(1), ElementsAre(3));
  studio.Advance(kPeriod);
  studio.loop().SetViewers(2);
  EXPECT_THAT(studio.Live(2), ElementsAre(3, 3)) << "nothing moves, but there is a new viewer";
  studio.Advance(kPeriod);
  studio.loop().SetViewers(0);
  studio.loop().OnState(StateAt(4));
  studio.TakeOne();
  studio.TakeOne();
  EXPECT_THAT(studio.Live(2), ElementsAre(3, 3));
  EXPECT_EQ(studio.loop().status().viewers, 0);
  EXPECT_EQ(studio.loop().status().drawn, 5u);
}

TEST(DrawingLoop, KeepsThePeriodBetweenLivePicturesAfterAPause) {
  Studio studio;
  studio.loop().SetViewers(1);
  EXPECT_THAT(studio.Live(1), ElementsAre(0));
  studio.Advance(10 * kPeriod + kPeriod / 2);
  studio.loop().OnState(StateAt(1));
  EXPECT_THAT(studio.Live(2), ElementsAre(0, 1));
  studio.loop().OnState(StateAt(2));
  EXPECT_THAT(studio.LiveAfterADecision(), ElementsAre(0, 1)) << "two at once";
  studio.Advance(kPeriod - seconds(1));
  EXPECT_THAT(studio.LiveAfterADecision(), ElementsAre(0, 1));
  studio.Advance(seconds(1));
  studio.TakeOne();
  EXPECT_THAT(studio.Live(3), ElementsAre(0, 1, 2));
}

TEST(DrawingLoop, KeepsThePeriodAfterALatePicture) {
  Studio studio;
  studio.loop().SetViewers(1);
  EXPECT_THAT(studio.Live(1), ElementsAre(0));
  studio.Advance(2 * kPeriod - seconds(1));  // the second was due a period ago
  studio.loop().OnState(StateAt(1));
  EXPECT_THAT(studio.Live(2), ElementsAre(0, 1));
  studio.Advance(seconds(1));  // an even step of the rate
  studio.loop().OnState(StateAt(2));
  EXPECT_THAT(studio.LiveAfterADecision(), ElementsAre(0, 1));
  studio.Advance(kPeriod - seconds(1));
  studio.TakeOne();
  EXPECT_THAT(studio.Live(3), ElementsAre(0, 1, 2));
}

TEST(DrawingLoop, LimitsTheRateOfLivePicturesButNotOfRequests) {
  Studio studio;
  studio.loop().SetViewers(1);
  studio.Live(1);
  studio.loop().SetViewers(2);
  studio.loop().SetCamera(CameraController(ParseCamera("top"), {}));
  EXPECT_THAT(studio.LiveAfterADecision(), ElementsAre(0));
  EXPECT_EQ(studio.loop().status().drawn, 3u);
}

TEST(DrawingLoop, RendersTheSameStateAgainForAnotherCamera) {
  Studio studio;
  studio.loop().SetViewers(1);
  studio.Live(1);
  studio.Advance(kPeriod);
  studio.loop().SetCamera(CameraController(ParseCamera("9,8,7:0,0,1"), {}));
  EXPECT_THAT(studio.Live(2), ElementsAre(0, 0));
  EXPECT_EQ(studio.TakeOne(), Vector3d(9, 8, 7)) << "a request without a camera is by the same";
  EXPECT_EQ(studio.TakeOne(CameraController(ParseCamera("1,2,3:0,0,1"), {})), Vector3d(1, 2, 3));
  EXPECT_EQ(studio.TakeOne(), Vector3d(9, 8, 7));
}

TEST(DrawingLoop, RunsKeyframesFromTheFirstSampleEvenWithoutViewers) {
  const testing::TempFolder folder;
  const std::string path = folder / "keys.yaml";
  std::ofstream(path) << "keys:\n"
                         "  - {time: 0, position: [0, -4, 1], target: [0, 0, 1], ease: linear}\n"
                         "  - {time: 10, position: [8, -4, 1], target: [8, 0, 1]}\n";
  Studio studio(CameraController(ParseCamera(path), {}), std::make_shared<SceneState>());
  std::filesystem::remove(path);  // it is not read again
  studio.loop().OnState(StateAt(0));
  studio.loop().OnState(StateAt(5));
  EXPECT_NEAR((studio.TakeOne() - Vector3d(4, -4, 1)).norm(), 0, 1e-9);
  studio.loop().OnState(StateAt(10));
  EXPECT_NEAR((studio.TakeOne() - Vector3d(8, -4, 1)).norm(), 0, 1e-9);
}

TEST(DrawingLoop, StartsTheRotationOfACameraWhenItIsSelected) {
  CameraOptions options;
  options.orbit.Parse("9");
  Studio studio;
  studio.loop().OnState(StateAt(3));
  studio.loop().SetCamera(CameraController(ParseCamera("2,0,1:0,0,1"), options));
  studio.loop().OnState(StateAt(13));
  EXPECT_NEAR((studio.TakeOne() - Vector3d(0, 2, 1)).norm(), 0, 1e-9);
}

TEST(DrawingLoop, RejectsMoreThanSixteenWaitingRequests) {
  Studio studio;
  studio.Hold(false);
  std::vector<std::future<render::Image>> pictures;
  pictures.push_back(studio.loop().Request(studio.kSmall));
  studio.WaitForHeldPicture();
  for (int i = 0; i < 16; ++i) pictures.push_back(studio.loop().Request(studio.kSmall));
  try {
    studio.loop().Request(studio.kSmall);
    ADD_FAILURE() << "a seventeenth waits";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("too many requests are waiting"));
  }
  studio.Release();
  for (auto& picture : pictures) EXPECT_EQ(picture.get().width, 16);
  EXPECT_EQ(studio.TakeOne().size(), 3) << "there is room again";
}

// With a picture or with the reason: which of them depends on when the end is noticed.
TEST(DrawingLoop, AnswersWaitingRequestsAtItsEnd) {
  std::future<render::Image> waiting;
  {
    Studio studio;
    studio.Hold(false);
    auto in_hand = studio.loop().Request(studio.kSmall);
    studio.WaitForHeldPicture();
    waiting = studio.loop().Request(studio.kSmall);
    // The loop ends in another thread, because its end waits for the picture in hand.
    auto end = std::async(std::launch::async, [&] { studio.End(); });
    studio.Release();
    end.get();
  }
  const std::string error = ErrorOf(waiting);
  EXPECT_TRUE(error.empty() || error == "the server is shutting down") << error;
}

TEST(DrawingLoop, ReportsARendererThatDoesNotStartAndTriesAgain) {
  const testing::CapturedLog log;
  Studio studio;
  studio.FailToStartOnce();
  auto failed = studio.loop().Request(studio.kSmall);
  EXPECT_EQ(ErrorOf(failed), "no back-end starts");
  EXPECT_EQ(studio.loop().status().last_error, "") << "it is the requester's";
  studio.FailToStartOnce();
  studio.loop().SetViewers(1);
  studio.WaitForStarts(2);
  studio.Advance(kPeriod);
  studio.loop().OnState(StateAt(1));
  EXPECT_THAT(studio.Live(1), ElementsAre(1));
  studio.End();
  EXPECT_EQ(log.text(), "error: picture: no back-end starts\n");
}

TEST(DrawingLoop, NamesTheRendererAndTheProblemsOfItsPictures) {
  Studio studio;
  EXPECT_EQ(studio.loop().status().renderer.backend, "");
  EXPECT_THAT(studio.loop().status().problems, IsEmpty());
  studio.loop().SetViewers(1);
  studio.Live(1);
  EXPECT_EQ(studio.loop().status().renderer.backend, "fake");
  EXPECT_THAT(studio.loop().status().problems, ElementsAre("a mesh is missing"));
}

TEST(DrawingLoop, AnswersAllRequestsWhileTheDriverDoesNotRespond) {
  const testing::CapturedLog log;
  Studio studio;
  studio.TakeOne();
  studio.Hold(true);
  auto in_hand = studio.loop().Request(studio.kSmall);
  EXPECT_EQ(ErrorOf(in_hand), kHang);
  studio.WaitForHeldPicture();
  EXPECT_TRUE(studio.loop().status().hangs);
  EXPECT_EQ(studio.loop().status().last_error, kHang);
  EXPECT_THROW(studio.loop().Request(studio.kSmall), std::runtime_error) << "not at once";
  studio.loop().SetViewers(1);
  studio.Release();
  studio.Live(1);
  EXPECT_FALSE(studio.loop().status().hangs);
  EXPECT_EQ(studio.loop().status().last_error, "");
  studio.TakeOne();
  studio.End();
  EXPECT_EQ(log.text(), std::string("error: picture: ") + kHang +
                            "\nwarning: picture: the graphics driver responds again\n");
}

TEST(DrawingLoop, ReportsADriverThatDoesNotRespondForTheLivePicture) {
  const testing::CapturedLog log;
  Studio studio;
  studio.Hold(true);
  studio.loop().SetViewers(1);
  studio.WaitForHeldPicture();
  EXPECT_TRUE(studio.loop().status().hangs);
  EXPECT_THROW(studio.loop().Request(studio.kSmall), std::runtime_error);
  studio.Release();
  EXPECT_THAT(studio.Live(1), ElementsAre(0));
  EXPECT_FALSE(studio.loop().status().hangs);
  studio.TakeOne();
  studio.End();
  EXPECT_THAT(log.text(), HasSubstr("warning: picture: the graphics driver responds again\n"));
}

// The drawing thread cannot be joined; the process ends all the same.
TEST(DrawingLoopDeathTest, EndsTheProcessAtShutdownIfTheDriverDoesNotRespond) {
  const auto shut_down_during = [](bool live) {
    alarm(20);  // only a failure takes so long
    Studio studio;
    studio.Hold(true);
    std::future<render::Image> picture;
    if (live) {
      studio.loop().SetViewers(1);
    } else {
      picture = studio.loop().Request(studio.kSmall);
    }
    studio.WaitForHeldPicture();
    studio.End();
  };
  for (const bool live : {true, false}) {
    EXPECT_EXIT(shut_down_during(live), ::testing::ExitedWithCode(2),
                std::string("stopped without a clean shutdown: ") + kHang);
  }
}

}  // namespace
}  // namespace kinescope::app
