// When the server draws, what, and for whom: small pictures of a real renderer. Nothing here waits
// for a clock, but 20 ms for a picture that must not come: rates are such that the next one is due
// at once or not in this test's time.
#include "server/app/serve/picture_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "core/errors.h"
#include "tests/render/test_scene.h"

namespace kinescope::app {
namespace {

using ::testing::HasSubstr;

constexpr std::chrono::seconds kPicturePatience{30};  // only a failure takes so long
constexpr double kAtOnce = 1e6, kNeverAgain = 1e-3;   // Hz

std::shared_ptr<const SceneState> NumberedScene(std::uint64_t number) {
  static const SceneState standing = testing::SceneWith(testing::Posture::kStanding);
  auto scene = std::make_shared<SceneState>(standing);
  scene->number = number;
  scene->arrival_nanos = static_cast<std::int64_t>(100 * number);
  return scene;
}

class PictureLoopTest : public ::testing::Test {
 protected:
  void Start(double rate_hz, const std::string& camera = "front") {
    PictureOptions options;
    options.camera = ParseCamera(camera);
    options.width = 96;
    options.height = 64;
    options.rate_hz = rate_hz;
    loop_.emplace(options, NumberedScene(1), pictures_);
  }

  // The next live picture that has not been asked for yet.
  std::shared_ptr<const http::Picture> Next() {
    auto picture = pictures_.WaitNewer(seen_, kPicturePatience);
    EXPECT_TRUE(picture) << "no picture came";
    return picture ? picture : std::make_shared<const http::Picture>();
  }
  // Does one come, although it should not? Snapshots go before live pictures, so that these would
  // only be drawn when no snapshot is asked for any more.
  bool HasNext() { return pictures_.WaitNewer(seen_, std::chrono::milliseconds(20)) != nullptr; }

  // When these have been answered, the drawing thread has taken notice of all that came before.
  void AskForSnapshots(int count) {
    for (int i = 0; i < count; ++i) loop_->SnapshotPng("front", 16, 16);
  }

  Latest<http::Picture> pictures_;
  std::uint64_t seen_ = 0;
  std::optional<PictureLoop> loop_;
};

TEST_F(PictureLoopTest, TheFirstPictureIsThereBeforeAnybodyLooks) {
  Start(kAtOnce);
  ASSERT_TRUE(HasNext());
  const auto picture = pictures_.Get();
  EXPECT_EQ(picture->state_number, 1u);
  EXPECT_EQ(picture->arrival_nanos, 100);
  ASSERT_GT(picture->jpeg.size(), 100u);
  EXPECT_EQ(picture->jpeg[0], 0xFF);
  EXPECT_EQ(picture->jpeg[1], 0xD8);
  const PictureStatus status = loop_->status();
  EXPECT_EQ(status.drawn, 1u);
  EXPECT_EQ(status.last_error, "");
  EXPECT_EQ(status.renderer.backend, "osmesa");
}

TEST_F(PictureLoopTest, DrawsNothingWhileNobodyLooks) {
  Start(kAtOnce);
  Next();
  for (std::uint64_t number = 2; number < 20; ++number) loop_->OnState(NumberedScene(number));
  AskForSnapshots(5);
  EXPECT_FALSE(HasNext());
  EXPECT_EQ(loop_->status().drawn, 1u + 5u);
}

TEST_F(PictureLoopTest, WhoeverComesSeesTheNewestStateAtOnce) {
  Start(kAtOnce);
  Next();
  for (std::uint64_t number = 2; number < 20; ++number) loop_->OnState(NumberedScene(number));
  loop_->SetViewers(1);
  EXPECT_EQ(Next()->state_number, 19u) << "the newest, and none of those before";
  loop_->SetViewers(2);
  EXPECT_EQ(Next()->state_number, 19u) << "nothing moves, but somebody new is there";
  loop_->SetViewers(1);
  AskForSnapshots(3);
  EXPECT_FALSE(HasNext()) << "who leaves wants no picture";
  loop_->OnState(NumberedScene(20));
  EXPECT_EQ(Next()->state_number, 20u);
  loop_->SetViewers(0);
  loop_->OnState(NumberedScene(21));
  AskForSnapshots(3);
  EXPECT_FALSE(HasNext());
}

TEST_F(PictureLoopTest, DrawsNoMorePicturesThanTheRateAllows) {
  Start(kNeverAgain);
  Next();
  loop_->SetViewers(1);
  EXPECT_EQ(Next()->state_number, 1u) << "the first one is due at once";
  for (std::uint64_t number = 2; number < 20; ++number) {
    loop_->OnState(NumberedScene(number));
    AskForSnapshots(1);
  }
  EXPECT_TRUE(loop_->SetCamera("top"));
  loop_->SetViewers(2);
  AskForSnapshots(3);
  EXPECT_FALSE(HasNext());
  EXPECT_EQ(loop_->status().drawn, 2u + 18u + 3u) << "snapshots do not wait";
  loop_.reset();  // neither does the end
}

TEST_F(PictureLoopTest, AnotherCameraIsAnotherPictureOfTheSameState) {
  Start(kAtOnce, "top");
  const auto from_top = Next()->jpeg;
  loop_.reset();
  Start(kAtOnce, "front");
  const auto from_front = Next()->jpeg;
  ASSERT_NE(from_front, from_top);
  loop_->SetViewers(1);
  EXPECT_EQ(Next()->jpeg, from_front);
  EXPECT_TRUE(loop_->SetCamera("top"));
  EXPECT_EQ(Next()->jpeg, from_top);
  EXPECT_FALSE(loop_->SetCamera("upside_down"));
  loop_->OnState(NumberedScene(1));
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

TEST_F(PictureLoopTest, ASnapshotHasItsOwnSizeAndCameraAndLeavesTheLivePictureAlone) {
  Start(kAtOnce, "front");
  const auto live = Next()->jpeg;
  const auto front = loop_->SnapshotPng("front", 64, 48);
  const auto top = loop_->SnapshotPng("top", 64, 48);
  EXPECT_EQ(SizeOfPng(front), std::pair(64, 48));
  EXPECT_NE(front, top);
  EXPECT_EQ(SizeOfPng(loop_->SnapshotPng("top", 80, 20)), std::pair(80, 20));
  EXPECT_EQ(loop_->SnapshotPng("top", 64, 48), top) << "the same every time";
  loop_->SetViewers(1);
  EXPECT_EQ(Next()->jpeg, live);
}

TEST_F(PictureLoopTest, ASnapshotWithoutACameraIsByTheLivePictures) {
  Start(kAtOnce, "front");
  EXPECT_EQ(loop_->SnapshotPng("", 64, 48), loop_->SnapshotPng("front", 64, 48));
  EXPECT_TRUE(loop_->SetCamera("top"));
  EXPECT_EQ(loop_->SnapshotPng("", 64, 48), loop_->SnapshotPng("top", 64, 48));
}

TEST_F(PictureLoopTest, ASnapshotShowsTheNewestState) {
  Start(kAtOnce, "front");
  const auto standing = loop_->SnapshotPng("front", 64, 48);
  auto bent = std::make_shared<SceneState>(testing::SceneWith(testing::Posture::kDeepBend));
  loop_->OnState(bent);
  EXPECT_NE(loop_->SnapshotPng("front", 64, 48), standing);
}

TEST_F(PictureLoopTest, ASnapshotThatCannotBeIsAnErrorOfItsOwnAndNoOnesElse) {
  Start(kAtOnce);
  Next();
  try {
    loop_->SnapshotPng("upside_down", 64, 48);
    FAIL() << "a camera that does not exist";
  } catch (const options::BadValue& error) {
    EXPECT_THAT(error.what(), HasSubstr("upside_down"));
  }
  EXPECT_EQ(loop_->status().last_error, "");
  EXPECT_EQ(SizeOfPng(loop_->SnapshotPng("front", 64, 48)), std::pair(64, 48));
  loop_->SetViewers(1);
  EXPECT_EQ(Next()->state_number, 1u);
}

TEST_F(PictureLoopTest, RefusesACameraThatThereIsNot) {
  EXPECT_THROW(Start(kAtOnce, "upside_down"), options::BadValue);
}

}  // namespace
}  // namespace kinescope::app
