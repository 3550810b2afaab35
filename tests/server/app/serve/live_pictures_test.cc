// What the page receives: small pictures of a real renderer. When they are drawn is tested in
// drawing_loop_test.cc; here, the next one is due at once.
#include "server/app/serve/live_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "core/system/errors.h"
#include "core/system/scratch_folder.h"
#include "render/image/png_file.h"
#include "server/picture/picture_shapes.h"
#include "tests/render/test_scene.h"
#include "tests/server/picture/fake_renderer.h"

namespace kinescope::app {
namespace {

using ::testing::HasSubstr;

constexpr std::chrono::seconds kPicturePatience{30};  // only a failure takes so long
constexpr double kAtOnceHz = 1e6;

std::shared_ptr<const SceneState> NumberedScene(std::uint64_t number) {
  static const SceneState standing = testing::SceneWith(testing::Posture::kStanding);
  auto scene = std::make_shared<SceneState>(standing);
  scene->number = number;
  scene->arrival_nanos = static_cast<std::int64_t>(100 * number);
  return scene;
}

class LivePicturesTest : public ::testing::Test {
 protected:
  void Start(const std::string& camera = "front", const CameraOptions& moves = CameraOptions()) {
    LivePictureSettings settings;
    settings.moves = moves;
    settings.camera = CameraController(ParseCamera(camera), moves);
    settings.width = 96;
    settings.height = 64;
    settings.rate_hz = kAtOnceHz;
    live_.emplace(settings, RenderersOf({}), NumberedScene(1), pictures_);
  }

  // The next live picture that has not been asked for yet.
  std::shared_ptr<const http::Picture> Next() {
    auto picture = pictures_.WaitNewer(seen_, kPicturePatience);
    EXPECT_TRUE(picture) << "no picture came";
    return picture ? picture : std::make_shared<const http::Picture>();
  }

  Latest<http::Picture> pictures_;
  std::uint64_t seen_ = 0;
  std::optional<LivePictures> live_;
};

TEST_F(LivePicturesTest, RendersTheFirstPictureBeforeTheFirstViewer) {
  Start();
  const auto picture = pictures_.Get();
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->state_number, 1u);
  EXPECT_EQ(picture->arrival_nanos, 100);
  ASSERT_GT(picture->jpeg.size(), 100u);
  EXPECT_EQ(picture->jpeg[0], 0xFF);
  EXPECT_EQ(picture->jpeg[1], 0xD8);
  const DrawingStatus status = live_->status();
  EXPECT_EQ(status.drawn, 1u);
  EXPECT_EQ(status.last_error, "");
  EXPECT_EQ(status.renderer.backend, "osmesa");
}

TEST_F(LivePicturesTest, ShowsANewViewerTheNewestState) {
  Start();
  Next();
  for (std::uint64_t number = 2; number < 20; ++number) live_->OnState(NumberedScene(number));
  live_->SetViewers(1);
  EXPECT_EQ(Next()->state_number, 19u) << "the newest, and none of those before";
}

TEST_F(LivePicturesTest, RendersTheSameStateAgainForAnotherCamera) {
  Start("top");
  const auto from_top = Next()->jpeg;
  live_.reset();
  Start();
  const auto from_front = Next()->jpeg;
  ASSERT_NE(from_front, from_top);
  live_->SetViewers(1);
  EXPECT_EQ(Next()->jpeg, from_front);
  EXPECT_TRUE(live_->SetCamera("top"));
  EXPECT_EQ(Next()->jpeg, from_top);
  EXPECT_FALSE(live_->SetCamera("upside_down"));
  live_->OnState(NumberedScene(1));
  EXPECT_EQ(Next()->jpeg, from_top) << "it stays where it was";
}

// Width and height as they stand in the header of a PNG.
std::pair<int, int> SizeOfPng(const std::vector<std::uint8_t>& png) {
  if (png.size() < 24 || png[1] != 'P' || png[2] != 'N' || png[3] != 'G') return {};
  const auto number = [&](std::size_t at) {
    return png[at] << 24 | png[at + 1] << 16 | png[at + 2] << 8 | png[at + 3];
  };
  return {number(16), number(20)};
}

TEST_F(LivePicturesTest, RendersSnapshotsOfAnySizeAndCameraBesideTheLivePicture) {
  Start();
  const auto live = Next()->jpeg;
  const auto front = live_->SnapshotPng({"front", 64, 48});
  const auto top = live_->SnapshotPng({"top", 64, 48});
  EXPECT_EQ(SizeOfPng(front), std::pair(64, 48));
  EXPECT_NE(front, top);
  EXPECT_EQ(SizeOfPng(live_->SnapshotPng({"top", 80, 20})), std::pair(80, 20));
  EXPECT_EQ(live_->SnapshotPng({"top", 64, 48}), top) << "the same every time";
  live_->SetViewers(1);
  EXPECT_EQ(Next()->jpeg, live);
}

TEST_F(LivePicturesTest, RendersSnapshotsOfFormerStates) {
  Start();
  Next();
  auto former = std::make_shared<SceneState>(*NumberedScene(1));
  live_->OnState(std::make_shared<SceneState>());  // nobody is there any more
  const auto empty = live_->SnapshotPng({"front", 64, 48});
  const auto person = live_->SnapshotPng({"front", 64, 48, false, former});
  EXPECT_NE(person, empty);
  former->arrival_nanos = 0;
  EXPECT_EQ(live_->SnapshotPng({"front", 64, 48, false, former}), person)
      << "a former state is a recording, and called one";
  EXPECT_NE(live_->SnapshotPng({"", 64, 48, false, former}), empty) << "by the live camera";
}

// 0 to 255, of the left upper pixel: the background.
int BrightnessOf(const std::vector<std::uint8_t>& png) {
  const ScratchFolder folder;
  const auto path = folder / "picture.png";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  const render::Image image = render::ReadPng(path);
  return (image.rgba[0] + image.rgba[1] + image.rgba[2]) / 3;
}

TEST_F(LivePicturesTest, HasAThemeForEachSnapshotAndOneForTheLivePicture) {
  Start();
  const auto light = Next()->jpeg;
  EXPECT_GT(BrightnessOf(live_->SnapshotPng({"front", 64, 48})), 150);
  EXPECT_LT(BrightnessOf(live_->SnapshotPng({"front", 64, 48, true})), 80);
  live_->SetViewers(1);
  EXPECT_EQ(Next()->jpeg, light);
  live_->SetDark(true);
  EXPECT_NE(Next()->jpeg, light);
  EXPECT_GT(BrightnessOf(live_->SnapshotPng({"front", 64, 48})), 150) << "snapshots keep theirs";
  live_->SetDark(false);
  EXPECT_EQ(Next()->jpeg, light);
}

TEST_F(LivePicturesTest, UsesTheLiveCameraForSnapshotsWithoutACamera) {
  Start();
  EXPECT_EQ(live_->SnapshotPng({"", 64, 48}), live_->SnapshotPng({"front", 64, 48}));
  EXPECT_TRUE(live_->SetCamera("top"));
  EXPECT_EQ(live_->SnapshotPng({"", 64, 48}), live_->SnapshotPng({"top", 64, 48}));
}

TEST_F(LivePicturesTest, ShowsTheNewestStateInASnapshot) {
  Start();
  const auto standing = live_->SnapshotPng({"front", 64, 48});
  auto bent = std::make_shared<SceneState>(testing::SceneWith(testing::Posture::kDeepBend));
  live_->OnState(bent);
  EXPECT_NE(live_->SnapshotPng({"front", 64, 48}), standing);
}

TEST_F(LivePicturesTest, ReportsAnInvalidSnapshotOnlyToItsRequester) {
  Start();
  Next();
  try {
    live_->SnapshotPng({"upside_down", 64, 48});
    FAIL() << "a camera that does not exist";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("upside_down"));
  }
  EXPECT_EQ(live_->status().last_error, "");
  EXPECT_EQ(SizeOfPng(live_->SnapshotPng({"front", 64, 48})), std::pair(64, 48));
  live_->SetViewers(1);
  EXPECT_EQ(Next()->state_number, 1u);
}

// What the picture of a renderer alone looks like.
std::vector<std::uint8_t> PngBy(const std::string& camera, const CameraOptions& moves) {
  const auto scene = NumberedScene(1);
  CameraController controller(ParseCamera(camera), moves);
  const render::PictureSpec view{64, 48, 2, "", true};
  const render::Camera live = controller.OnlyLive(*scene, PictureShapes().Of(view, *scene));
  return render::EncodePng(render::MakeRenderer()->Render(*scene, live, view));
}

TEST(LivePictures, GoOnWhileASnapshotIsRendered) {
  std::promise<void> begun, released;
  const std::shared_future<void> release = released.get_future().share();
  const RendererFactory make_renderer = [&](const auto&) {
    return std::make_unique<testing::FakeRenderer>([&](render::Image&, const SceneState&,
                                                       const render::Camera&,
                                                       const render::PictureSpec& spec) {
      if (spec.width != 48) return;
      begun.set_value();
      release.wait();
    });
  };
  LivePictureSettings settings;
  settings.width = 96;
  settings.height = 64;
  settings.rate_hz = kAtOnceHz;
  Latest<http::Picture> pictures;
  LivePictures live(settings, make_renderer, NumberedScene(1), pictures);
  std::uint64_t seen = 0;
  pictures.WaitNewer(seen, kPicturePatience);
  std::thread client([&] { live.SnapshotPng({"front", 48, 32}); });
  begun.get_future().wait();
  live.SetViewers(1);
  live.OnState(NumberedScene(2));
  std::shared_ptr<const http::Picture> picture;
  do {
    picture = pictures.WaitNewer(seen, kPicturePatience);
  } while (picture && picture->state_number < 2);
  EXPECT_TRUE(picture) << "the live picture waits for the snapshot";
  EXPECT_EQ(live.status().problems, std::vector<std::string>());
  released.set_value();
  client.join();
}

TEST_F(LivePicturesTest, UsesTheLiveOptionsForSnapshotsWithoutACamera) {
  CameraOptions moves;
  moves.projection = true;
  moves.fit = Fit::kNow;
  Start("left", moves);
  EXPECT_EQ(live_->SnapshotPng({"", 64, 48}), PngBy("left", moves));
  EXPECT_EQ(live_->SnapshotPng({"left", 64, 48}), PngBy("left", {})) << "a named one has none";
  EXPECT_TRUE(live_->SetCamera("front"));
  EXPECT_EQ(live_->SnapshotPng({"", 64, 48}), PngBy("front", moves)) << "they stay";
}

TEST_F(LivePicturesTest, ComeBackToTheCameraThatWasPlaced) {
  const std::string place = "3,1,2:0,0,1";
  Start(place);
  EXPECT_TRUE(live_->SetCamera("top"));
  EXPECT_EQ(live_->SnapshotPng({"own", 64, 48}), PngBy(place, {}));
  EXPECT_TRUE(live_->SetCamera("own"));
  EXPECT_EQ(live_->SnapshotPng({"", 64, 48}), PngBy(place, {}));
  Start("front");
  EXPECT_FALSE(live_->SetCamera("own")) << "there is none";
}

}  // namespace
}  // namespace kinescope::app
