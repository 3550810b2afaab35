#include "server/app/output_sink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/png_file.h"
#include "server/core/errors.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using kinescope::testing::ReadFile;
using kinescope::testing::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kWidth = 64, kHeight = 48;
constexpr std::array<const char*, 4> kClips = {"a.mp4", "a.webm", "a.webp", "a.gif"};

render::View SmallView() {
  render::View view;
  view.width = kWidth;
  view.height = kHeight;
  return view;
}

// Grey of one level.
PicturePtr Grey(std::uint8_t level) {
  auto picture = std::make_shared<DrawnPicture>();
  render::SetSize(*picture, kWidth, kHeight);
  std::fill(picture->rgba.begin(), picture->rgba.end(), level);
  for (std::size_t i = 3; i < picture->rgba.size(); i += 4) picture->rgba[i] = 255;
  picture->layer = "over it";
  return picture;
}

// What no encoder makes small.
PicturePtr Noise() {
  auto picture = std::make_shared<DrawnPicture>(*Grey(0));
  std::mt19937 random(7);
  for (std::uint8_t& value : picture->rgba) value = static_cast<std::uint8_t>(random());
  for (std::size_t i = 3; i < picture->rgba.size(); i += 4) picture->rgba[i] = 255;
  return picture;
}

FuturePicture Ready(PicturePtr picture) {
  std::promise<PicturePtr> promise;
  promise.set_value(std::move(picture));
  return promise.get_future().share();
}

FuturePicture Failed(const std::string& why) {
  std::promise<PicturePtr> promise;
  promise.set_exception(std::make_exception_ptr(std::runtime_error(why)));
  return promise.get_future().share();
}

// Names the number and where the camera is.
std::map<std::string, std::string> Facts(const render::Camera& camera, long k) {
  return {{"comment", "number " + std::to_string(k) + " from " +
                          std::to_string(std::lround(camera.position.x()))}};
}

render::Camera From(double x) {
  render::Camera camera;
  camera.position.x() = x;
  return camera;
}

template <class Action>
std::string Complaint(Action&& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

// For the time of a test, no file may be longer than that.
class ShortDisk {
 public:
  explicit ShortDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~ShortDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  ShortDisk(const ShortDisk&) = delete;
  ShortDisk& operator=(const ShortDisk&) = delete;

 private:
  rlimit before_{};
};

TEST(OutputSink, APictureIsThereWhenItIsWhole) {
  const TempFolder folder;
  const auto sink = MakePngSink(folder / "a.png", 1, Facts, folder / "a.svg");
  std::promise<PicturePtr> picture;
  sink->Put(0, picture.get_future().share(), From(3));
  EXPECT_THAT(folder.Names(), IsEmpty()) << "it is not even drawn";
  picture.set_value(Grey(120));
  sink->Finish();
  EXPECT_THAT(folder.Names(), ElementsAre("a.png", "a.svg"));
  EXPECT_EQ(render::ReadPng(folder / "a.png").rgba, Grey(120)->rgba);
  EXPECT_EQ(render::ReadPngText(folder / "a.png").at("comment"), "number 0 from 3");
  EXPECT_EQ(ReadFile(folder / "a.svg"), "over it");
}

TEST(OutputSink, ASequenceIsNumberedInWhateverOrderItIsDrawn) {
  const TempFolder folder;
  std::vector<std::promise<PicturePtr>> pictures(7);
  const auto sink = MakePngSink(folder / "%03d.png", 3, Facts);
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    sink->Put(static_cast<long>(k), pictures[k].get_future().share(), From(1));
  }
  for (std::size_t k = pictures.size(); k-- > 0;) {
    pictures[k].set_value(Grey(static_cast<std::uint8_t>(30 * k)));
  }
  sink->Finish();
  EXPECT_EQ(folder.Names().size(), pictures.size());
  for (long k = 0; k < 7; ++k) {
    const std::string path = folder / ("00" + std::to_string(k) + ".png");
    EXPECT_EQ(render::ReadPng(path).rgba.front(), 30 * k);
    EXPECT_THAT(render::ReadPngText(path).at("comment"), HasSubstr("number " + std::to_string(k)));
  }
}

TEST(OutputSink, AClipOfAnyFormatIsThereWithAllPicturesOnceItIsFinished) {
  for (const char* name : kClips) {
    const TempFolder folder;
    const auto sink = MakeClipSink(folder / name, SmallView(), {}, Facts);
    for (int k = 0; k < 3; ++k) {
      sink->Put(k, Ready(Grey(static_cast<std::uint8_t>(60 * (k + 1)))), From(k + 4));
    }
    EXPECT_THAT(folder.Names(), IsEmpty()) << name;
    sink->Finish();
    EXPECT_THAT(folder.Names(), ElementsAre(name));
    const auto clip = render::OpenVideo(folder / name);
    render::Image image;
    for (int k = 0; k < 3; ++k) {
      ASSERT_TRUE(clip->Next(image)) << name;
      EXPECT_NEAR(image.rgba.front(), 60 * (k + 1), 4) << name;
    }
    EXPECT_FALSE(clip->Next(image)) << name;
    EXPECT_EQ(clip->metadata()["comment"], "number 0 from 4") << name << ": of the first picture";
  }
}

TEST(OutputSink, WhatIsNotFinishedLeavesNothing) {
  for (const char* name : kClips) {
    const TempFolder folder;
    MakeClipSink(folder / name, SmallView(), {}, Facts)->Put(0, Ready(Grey(9)), From(1));
    EXPECT_THAT(folder.Names(), IsEmpty()) << name;
  }
}

TEST(OutputSink, APictureThatFailsIsTheErrorAndLeavesNoHalfFile) {
  for (const char* name : kClips) {
    const TempFolder folder;
    const auto sink = MakeClipSink(folder / name, SmallView(), {}, Facts);
    EXPECT_EQ(Complaint([&] {
                sink->Put(0, Ready(Grey(9)), From(1));
                sink->Put(1, Failed("the driver fails"), From(1));
                sink->Finish();
              }),
              "the driver fails")
        << name;
    EXPECT_THAT(folder.Names(), IsEmpty()) << name;
  }
  const TempFolder folder;
  const auto sink = MakePngSink(folder / "%d.png", 1, Facts);
  EXPECT_EQ(Complaint([&] {
              sink->Put(0, Ready(Grey(9)), From(1));
              sink->Put(1, Failed("the driver fails"), From(1));
              sink->Finish();
            }),
            "the driver fails");
  EXPECT_THAT(folder.Names(), ElementsAre("0.png")) << "whole pictures of a sequence stay";
}

TEST(OutputSink, AFullDiskIsAnErrorWithTheNameAndLeavesNoHalfFile) {
  for (const char* name : {"a.png", "a.mp4", "a.webm", "a.webp", "a.gif"}) {
    const TempFolder folder;
    std::string complaint;
    {
      const ShortDisk disk(512);
      const bool is_clip = render::ClipFormatOf(name).has_value();
      const auto sink = is_clip ? MakeClipSink(folder / name, SmallView(), {}, Facts)
                                : MakePngSink(folder / name, 1, Facts);
      complaint = Complaint([&] {
        sink->Put(0, Ready(Noise()), From(1));
        sink->Finish();
      });
    }
    EXPECT_THAT(complaint, HasSubstr(name));
    EXPECT_THAT(folder.Names(), IsEmpty()) << name;
  }
}

TEST(OutputSink, SaysWhereItCannotWrite) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "a.png");
  const auto sink = MakePngSink(folder / "a.png", 1, Facts);
  sink->Put(0, Ready(Grey(9)), From(1));
  EXPECT_THAT(Complaint([&] { sink->Finish(); }), HasSubstr("a.png: Is a directory"));

  render::VideoOptions too_fast;
  too_fast.rate = {60, 1};
  const auto clip = MakeClipSink(folder / "a.gif", SmallView(), too_fast, Facts);
  EXPECT_THROW(clip->Put(0, Ready(Grey(9)), From(1)), UsageError);
}

}  // namespace
}  // namespace kinescope::app
