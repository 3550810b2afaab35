// What a golden case allows to differ, and that it says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "render/image/png_file.h"
#include "server/app/golden/golden_lock.h"
#include "tests/shared_data.h"
#include "tests/system/golden_fixture.h"

namespace kinescope {
namespace {

using ::testing::AllOf;
using testing::Golden;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProgramResult;

class GoldenLimitsOfACase : public testing::GoldenCheck {
 protected:
  // Accepts the case with `key`, then another picture, whose pixels `change` has made of it.
  template <class Change>
  void AcceptOther(const std::string& key, const Change& change) const {
    AddToCase(key);
    ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
    render::Image image = render::ReadPng(case_ / "bend.png");
    change(image);
    render::WritePng(case_ / "bend.png", image);
    app::GoldenLock lock = app::ReadLock(case_ / "golden.lock");
    lock["bend"].pixels_sha256 = app::PixelsHash(image);
    app::WriteLock(case_ / "golden.lock", lock);
  }
};

void Invert(render::Image& image, int x, int y) {
  const std::size_t at = 4 * static_cast<std::size_t>(y * image.width + x);
  for (std::size_t i = at; i < at + 3; ++i) image.rgba[i] = image.rgba[i] < 128 ? 255 : 0;
}

TEST_F(GoldenLimitsOfACase, HideWhatLiesUnderAMaskAndSaySo) {
  AcceptOther("mask: ['20x10+280+4 the clock']", [](render::Image& image) {
    Invert(image, 281, 5);
    Invert(image, 299, 13);
  });
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, AllOf(HasSubstr("same (within the limits)"),
                                HasSubstr("mask 20x10+280+4 hides 2 pixels that differ "
                                          "(the clock)")));
  EXPECT_EQ(Check({"--strict"}).exit_code, 1) << "only equal bytes are the same";
  std::filesystem::remove(case_ / "bend.png");
  EXPECT_THAT(Check().out, HasSubstr("pixels differ under the masks alone"));
}

TEST_F(GoldenLimitsOfACase, HideNothingBesideAMask) {
  AcceptOther("mask: ['20x10+280+4 the clock']", [](render::Image& image) {
    for (int y = 5; y < 14; ++y) Invert(image, 279, y);
  });
  const ProgramResult result = Check();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("pixels: "), HasSubstr("1x9 px at x 279, y 5")));
  EXPECT_THAT(testing::ReadFile(case_ / "out/report.html"), HasSubstr("class=\"mask\" x=\"280\""));
}

TEST_F(GoldenLimitsOfACase, HideTextsButNoClassOfALoad) {
  AddToCase(
      "title: one\nclass_limits: 0.3,0.6\nmask: ['100x40+0+0 the title changes', "
      "'40x140+140+40 the person']");
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  AddToCase("tolerance: ['structure 0.9 the title again']");
  std::string yaml = testing::ReadFile(case_ / "bend.yaml");
  const auto replace = [&](const std::string& before, const std::string& now) {
    const std::size_t at = yaml.find(before);
    ASSERT_NE(at, std::string::npos);
    std::ofstream(case_ / "bend.yaml") << yaml.replace(at, before.size(), now);
  };
  replace("title: one", "title: two");
  EXPECT_THAT(Check().out, Not(HasSubstr("title: expected")));
  replace("class_limits: 0.3,0.6", "class_limits: 0.01,0.02");
  EXPECT_THAT(Check().out, HasSubstr("found"));
  EXPECT_THAT(Check().out, HasSubstr("high (red)"));
}

TEST_F(GoldenLimitsOfACase, AllowWhatATolerancePermitsAndSaySo) {
  AcceptOther("tolerance: [pixels 3 sparks of the driver]", [](render::Image& image) {
    Invert(image, 3, 175);
    Invert(image, 90, 175);
    Invert(image, 300, 100);
  });
  ProgramResult result = Check();
  EXPECT_THAT(result.out, HasSubstr("structure: ")) << "the others keep their limits";
  std::string yaml = testing::ReadFile(case_ / "bend.yaml");
  const std::string before = "[pixels 3 sparks of the driver]";
  yaml.replace(yaml.find(before), before.size(),
               "[pixels 3 sparks of the driver, structure 0.5 the same sparks]");
  std::ofstream(case_ / "bend.yaml") << yaml;
  result = Check();
  EXPECT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("pixels: passes by the tolerance of the case (sparks of the driver)"),
                    HasSubstr("same (within the limits)")));
}

TEST_F(GoldenLimitsOfACase, AreRefusedWithoutAReasonOrIfTheyHideTooMuch) {
  const auto complaint = [&](const std::string& line) {
    WriteCase("bend", "source: demo:lift\ntime: 2.5\ncamera: right\nsize: 320x180\n" + line);
    const ProgramResult result = Check();
    EXPECT_EQ(result.exit_code, 2) << line;
    return result.out;
  };
  EXPECT_THAT(complaint("mask: [20x10+280+4]\n"),
              HasSubstr("bend.yaml:5: mask=20x10+280+4: '20x10+280+4' has no reason"));
  EXPECT_THAT(complaint("mask: [20x10 clock]\n"), HasSubstr("WIDTHxHEIGHT+LEFT+TOP REASON"));
  EXPECT_THAT(complaint("mask: [20x10+301+4 clock]\n"),
              HasSubstr("mask 20x10+301+4: is not within the picture of 320x180"));
  EXPECT_THAT(complaint("mask: [320x30+0+0 a, 320x30+0+6 b, 320x7+0+40 c]\n"),
              HasSubstr("23.9 % of the picture is masked; at most 20 % may be"));
  EXPECT_THAT(complaint("tolerance: [light 2]\n"), HasSubstr("'light 2' has no reason"));
  EXPECT_THAT(complaint("tolerance: [lihgt 2 a]\n"), HasSubstr("nearest: light"));
  EXPECT_THAT(complaint("tolerance: [light 11 a]\n"), HasSubstr("light: expected a number from 0 "
                                                                "to 10 levels"));
  EXPECT_THAT(complaint("tolerance: [light 2 a, light 3 b]\n"), HasSubstr("light is given twice"));
}

}  // namespace
}  // namespace kinescope
