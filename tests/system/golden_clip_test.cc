// A golden clip: every n-th picture, drawn as the clip is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "render/image/png_file.h"
#include "server/app/golden/golden_lock.h"
#include "tests/shared_data.h"
#include "tests/system/golden_fixture.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::ExpectRefusal;
using testing::Golden;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::Not;
using testing::ProgramResult;

class GoldenClip : public testing::GoldenCheck {
 protected:
  void SetUp() override {
    WriteCase("walk",
              "source: demo:walk\nseconds: 1\nfps: 30\nevery: 10\nsize: 160x90\n"
              "camera: front\nfollow: 0.5\n");
    const ProgramResult result = Golden({"update", case_});
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  }
};

TEST_F(GoldenClip, HasOnePictureForEveryNthFrame) {
  const app::GoldenLock lock = app::ReadLock(case_ / "golden.lock");
  ASSERT_EQ(lock.size(), 3u);
  for (const std::string name : {"walk@0000", "walk@0010", "walk@0020"}) {
    EXPECT_EQ(lock.count(name), 1u) << name;
    EXPECT_TRUE(fs::exists(case_ / (name + ".png")));
  }
  const ProgramResult result = Check({"--strict"});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("walk@0010                same, frame 10 (0.333 s)"),
                                HasSubstr("All 3 pictures are the same")));
}

TEST_F(GoldenClip, HasThePicturesOfTheClipThatIsRendered) {
  fs::create_directory(case_ / "sub");
  ASSERT_EQ(
      Kinescope({"render", "demo:walk", "--seconds=1", "--fps=30", "--size=160x90",
                 "--camera=front", "--follow=0.5", "--title=walk", "--out", case_ / "sub/%04d.png"})
          .exit_code,
      0);
  for (const std::string number : {"0000", "0010", "0020"}) {
    EXPECT_EQ(render::ReadPng(case_ / ("walk@" + number + ".png")).rgba,
              render::ReadPng(case_ / ("sub/" + number + ".png")).rgba)
        << number;
  }
}

TEST_F(GoldenClip, SaysWhenItBeginsToDiffer) {
  render::Image image = render::ReadPng(case_ / "walk@0010.png");
  app::GoldenLock lock = app::ReadLock(case_ / "golden.lock");
  for (const std::string name : {"walk@0010", "walk@0020"}) {
    for (app::ObjectFact& object : lock[name].facts.objects) object.x_px += 3;
    lock[name].pixels_sha256 = std::string(64, '0');
  }
  app::WriteLock(case_ / "golden.lock", lock);
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("walk@0000                same, frame 0 (0.000 s)"),
                    HasSubstr("walk@0010                DIFFERS, frame 10 (0.333 s)"),
                    HasSubstr("the clip begins to differ in frame 10 (0.333 s); 2 of 3 compared "
                              "pictures are not the same")));
  EXPECT_EQ(Golden({"accept", case_ / "out", "walk"}).exit_code, 0) << "all of the clip";
  EXPECT_EQ(Check({"walk@0010"}).exit_code, 0) << "a picture stands for its case";
}

TEST_F(GoldenClip, MissesThePicturesThatAreNotDrawnAnyMore) {
  WriteCase("walk",
            "source: demo:walk\nseconds: 1\nfps: 30\nevery: 20\nsize: 160x90\n"
            "camera: front\nfollow: 0.5\n");
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("walk@0010                DIFFERS"),
                                HasSubstr("the case does not draw it any more")));
  EXPECT_THAT(Golden({"update", case_}).out, HasSubstr("walk@0010                removed"));
  EXPECT_FALSE(fs::exists(case_ / "walk@0010.png"));
  EXPECT_EQ(Check().exit_code, 0);
  fs::copy(case_ / "walk@0000.png", case_ / "walk@0007.png");
  EXPECT_THAT(Check().out, HasSubstr("walk@0007.png"));
}

TEST_F(GoldenClip, IsRefusedIfItHasTooManyPicturesOrNoEnd) {
  const auto complaint = [&](const std::string& yaml) {
    WriteCase("walk", "size: 32x32\n" + yaml);
    const ProgramResult result = Check();
    EXPECT_EQ(result.exit_code, 2) << yaml;
    return result.out;
  };
  EXPECT_THAT(complaint("source: demo:walk\nseconds: 100\nevery: 1\n"),
              HasSubstr("3001 pictures would be compared, 200 at most; write a larger `every`"));
  EXPECT_THAT(complaint("source: demo:walk\nevery: 2\n"), HasSubstr("without seconds"));
  EXPECT_THAT(complaint("source: demo:walk\nseconds: 1\nstate: stale\n"),
              HasSubstr("leave out state"));
  ASSERT_EQ(
      Kinescope({"convert", "demo:walk", "--seconds", "0.5", "--out", case_ / "w.mvnx"}).exit_code,
      0);
  EXPECT_THAT(complaint("source: w.mvnx\nseconds: 1\nevery: 3\n"),
              AllOf(HasSubstr("w.mvnx ends at 0."), HasSubstr("before the clip")));
}

}  // namespace
}  // namespace kinescope
