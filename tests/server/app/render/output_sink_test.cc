#include "server/app/render/output_sink.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "render/image/png_file.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using kinescope::testing::ReadFile;
using kinescope::testing::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kSinkWidth = 64, kSinkHeight = 48;
constexpr std::array<const char*, 4> kClipNames = {"a.mp4", "a.webm", "a.webp", "a.gif"};

render::PictureSpec SinkView() {
  render::PictureSpec spec;
  spec.width = kSinkWidth;
  spec.height = kSinkHeight;
  return spec;
}

// Grey of one level.
PicturePtr GreyPicture(std::uint8_t level) {
  auto picture = std::make_shared<DrawnPicture>();
  render::SetSize(*picture, kSinkWidth, kSinkHeight);
  std::fill(picture->rgba.begin(), picture->rgba.end(), level);
  for (std::size_t i = 3; i < picture->rgba.size(); i += 4) picture->rgba[i] = 255;
  picture->layer = "over it";
  return picture;
}

// What no encoder makes small.
PicturePtr NoisePicture() {
  auto picture = std::make_shared<DrawnPicture>(*GreyPicture(0));
  std::mt19937 random(7);
  for (std::uint8_t& value : picture->rgba) value = static_cast<std::uint8_t>(random());
  for (std::size_t i = 3; i < picture->rgba.size(); i += 4) picture->rgba[i] = 255;
  return picture;
}

FuturePicture ReadyPicture(PicturePtr picture) {
  std::promise<PicturePtr> promise;
  promise.set_value(std::move(picture));
  return promise.get_future().share();
}

FuturePicture FailedPicture(const std::string& why) {
  std::promise<PicturePtr> promise;
  promise.set_exception(std::make_exception_ptr(std::runtime_error(why)));
  return promise.get_future().share();
}

// Names the number and where the camera is.
std::map<std::string, std::string> FactsOfPicture(const render::Camera& camera, long k) {
  return {{"comment", "number " + std::to_string(k) + " from " +
                          std::to_string(std::lround(camera.position.x()))}};
}

render::Camera CameraAt(double x) {
  render::Camera camera;
  camera.position.x() = x;
  return camera;
}

template <class Action>
std::string SinkError(Action&& action) {
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

TEST(OutputSink, WritesAPictureOnlyWhenItIsComplete) {
  const TempFolder folder;
  const auto sink = MakePngSink(folder / "a.png", 1, FactsOfPicture, folder / "a.svg");
  std::promise<PicturePtr> picture;
  sink->Put(0, picture.get_future().share(), CameraAt(3));
  EXPECT_THAT(folder.Names(), IsEmpty()) << "it is not even drawn";
  picture.set_value(GreyPicture(120));
  sink->Finish();
  EXPECT_THAT(folder.Names(), ElementsAre("a.png", "a.svg"));
  EXPECT_EQ(render::ReadPng(folder / "a.png").rgba, GreyPicture(120)->rgba);
  EXPECT_EQ(render::ReadPngText(folder / "a.png").at("comment"), "number 0 from 3");
  EXPECT_EQ(ReadFile(folder / "a.svg"), "over it");
}

TEST(OutputSink, NumbersASequenceIndependentlyOfTheRenderingOrder) {
  const TempFolder folder;
  std::vector<std::promise<PicturePtr>> pictures(7);
  const auto sink = MakePngSink(folder / "%03d.png", 3, FactsOfPicture);
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    sink->Put(static_cast<long>(k), pictures[k].get_future().share(), CameraAt(1));
  }
  for (std::size_t k = pictures.size(); k-- > 0;) {
    pictures[k].set_value(GreyPicture(static_cast<std::uint8_t>(30 * k)));
  }
  sink->Finish();
  EXPECT_EQ(folder.Names().size(), pictures.size());
  for (long k = 0; k < 7; ++k) {
    const std::string path = folder / ("00" + std::to_string(k) + ".png");
    EXPECT_EQ(render::ReadPng(path).rgba.front(), 30 * k);
    EXPECT_THAT(render::ReadPngText(path).at("comment"), HasSubstr("number " + std::to_string(k)));
  }
}

TEST(OutputSink, WritesAllFramesOfAClipOfAnyFormat) {
  for (const char* name : kClipNames) {
    const TempFolder folder;
    const auto sink = MakeClipSink(folder / name, SinkView(), {}, FactsOfPicture);
    for (int k = 0; k < 3; ++k) {
      sink->Put(k, ReadyPicture(GreyPicture(static_cast<std::uint8_t>(60 * (k + 1)))),
                CameraAt(k + 4));
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

TEST(OutputSink, LeavesNoUnfinishedFiles) {
  for (const char* name : kClipNames) {
    const TempFolder folder;
    MakeClipSink(folder / name, SinkView(), {}, FactsOfPicture)
        ->Put(0, ReadyPicture(GreyPicture(9)), CameraAt(1));
    EXPECT_THAT(folder.Names(), IsEmpty()) << name;
  }
}

TEST(OutputSink, ReportsAFailedPictureAndLeavesNoPartialFile) {
  for (const char* name : kClipNames) {
    const TempFolder folder;
    const auto sink = MakeClipSink(folder / name, SinkView(), {}, FactsOfPicture);
    EXPECT_EQ(SinkError([&] {
                sink->Put(0, ReadyPicture(GreyPicture(9)), CameraAt(1));
                sink->Put(1, FailedPicture("the driver fails"), CameraAt(1));
                sink->Finish();
              }),
              "the driver fails")
        << name;
    EXPECT_THAT(folder.Names(), IsEmpty()) << name;
  }
  const TempFolder folder;
  const auto sink = MakePngSink(folder / "%d.png", 1, FactsOfPicture);
  EXPECT_EQ(SinkError([&] {
              sink->Put(0, ReadyPicture(GreyPicture(9)), CameraAt(1));
              sink->Put(1, FailedPicture("the driver fails"), CameraAt(1));
              sink->Finish();
            }),
            "the driver fails");
  EXPECT_THAT(folder.Names(), ElementsAre("0.png")) << "whole pictures of a sequence stay";
}

TEST(OutputSink, ReportsAFullDiskByFileNameAndLeavesNoPartialFile) {
  for (const char* name : {"a.png", "a.mp4", "a.webm", "a.webp", "a.gif"}) {
    const TempFolder folder;
    std::string complaint;
    {
      const ShortDisk disk(512);
      const bool is_clip = render::ClipFormatOf(name).has_value();
      const auto sink = is_clip ? MakeClipSink(folder / name, SinkView(), {}, FactsOfPicture)
                                : MakePngSink(folder / name, 1, FactsOfPicture);
      complaint = SinkError([&] {
        sink->Put(0, ReadyPicture(NoisePicture()), CameraAt(1));
        sink->Finish();
      });
    }
    EXPECT_THAT(complaint, HasSubstr(name));
    EXPECT_THAT(folder.Names(), IsEmpty()) << name;
  }
}

TEST(OutputSink, NamesAPathThatIsNotWritable) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "a.png");
  const auto sink = MakePngSink(folder / "a.png", 1, FactsOfPicture);
  sink->Put(0, ReadyPicture(GreyPicture(9)), CameraAt(1));
  EXPECT_THAT(SinkError([&] { sink->Finish(); }), HasSubstr("a.png: Is a directory"));

  render::VideoOptions too_fast;
  too_fast.rate = {60, 1};
  const auto clip = MakeClipSink(folder / "a.gif", SinkView(), too_fast, FactsOfPicture);
  EXPECT_THROW(clip->Put(0, ReadyPicture(GreyPicture(9)), CameraAt(1)), UsageError);
}

}  // namespace
}  // namespace kinescope::app
