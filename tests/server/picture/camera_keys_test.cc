// What a file of camera keys may say, and where it says something else. What cameras make of it:
// camera_controller_test.cc.
#include "server/picture/camera_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/system/errors.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using testing::TempFolder;

class CameraKeys : public ::testing::Test {
 protected:
  std::vector<CameraKeySpec> Read(const std::string& text) const {
    std::ofstream(path_) << text;
    return ReadCameraKeys(path_);
  }
  // Of a list of keys, one in each line from the second on; "" where there is no error.
  std::string ErrorOf(const std::string& keys) const { return ErrorOfText("keys:\n" + keys); }
  std::string ErrorOfText(const std::string& text) const {
    try {
      Read(text);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }

  TempFolder folder_;
  const std::string path_ = (folder_ / "keys.yaml").string();
};

TEST_F(CameraKeys, HaveEveryFieldOfTheFile) {
  const auto keys = Read(
      "keys:\n"
      "- {time: 0, camera: front}\n"
      "- {time: 1.5, camera: top, fov: 45, ease: linear}\n"
      "- {time: 2, position: [3, -2, 1.5], target: [0, 0, 1], fov: 60, ease: hold}\n"
      "- {time: 1000000, position: [1e3, 0, 0], target: [-1000, 0, 0], ease: smooth}\n");
  ASSERT_THAT(keys, SizeIs(4));
  EXPECT_EQ(keys[0].secs, 0);
  EXPECT_EQ(keys[0].name, "front");
  EXPECT_FALSE(keys[0].fov_rad);
  EXPECT_EQ(keys[0].ease, render::Ease::kSmooth);
  EXPECT_EQ(keys[1].secs, 1.5);
  ASSERT_TRUE(keys[1].fov_rad);
  EXPECT_NEAR(*keys[1].fov_rad, M_PI / 4, 1e-12);
  EXPECT_EQ(keys[1].ease, render::Ease::kLinear);
  EXPECT_EQ(keys[2].name, "");
  EXPECT_EQ(keys[2].place.position, Vector3d(3, -2, 1.5));
  EXPECT_EQ(keys[2].place.target, Vector3d(0, 0, 1));
  EXPECT_NEAR(keys[2].place.vertical_fov_rad, M_PI / 3, 1e-12);
  EXPECT_EQ(keys[2].ease, render::Ease::kHold);
  EXPECT_EQ(keys[3].secs, 1e6);
  EXPECT_EQ(keys[3].place.position.x(), 1000);
  EXPECT_EQ(keys[3].place.vertical_fov_rad, render::Camera().vertical_fov_rad);
}

TEST_F(CameraKeys, AreRejectedWithFileAndLineOutsideTheLimits) {
  for (const char* time : {"-1", "1e7", ".inf", "soon", "[1]"}) {
    EXPECT_THAT(
        ErrorOf("- {time: 0, camera: top}\n- {time: " + std::string(time) + "}\n"),
        AllOf(HasSubstr(path_ + ": line 3: time: "), HasSubstr("a number from 0 to 1000000")))
        << time;
  }
  for (const char* fov : {"0", "151", ".nan", "wide"}) {
    EXPECT_THAT(ErrorOf("- {time: 0, camera: top, fov: " + std::string(fov) + "}\n"),
                AllOf(HasSubstr("line 2: fov: " + std::string(fov)), HasSubstr("1 to 150")));
  }
  EXPECT_THAT(ErrorOf("- {time: 0, position: [1001, 0, 0], target: [0, 0, 0]}\n"),
              AllOf(HasSubstr("line 2: position: 1001"), HasSubstr("-1000 to 1000")));
  EXPECT_THAT(ErrorOf("- {time: 0, camera: top, ease: quick}\n"),
              AllOf(HasSubstr("line 2: ease: quick"), HasSubstr("smooth, linear or hold")));
  EXPECT_THAT(ErrorOf("- {camera: top}\n"), HasSubstr("line 2: time is missing"));
  EXPECT_THAT(ErrorOf("- {time: 0}\n"), HasSubstr("line 2: "));
  EXPECT_THAT(ErrorOf("- {time: 0, camera: top, position: [0, 0, 1], target: [0, 0, 0]}\n"),
              HasSubstr("either camera, or position and target"));
  EXPECT_THAT(ErrorOf("- front\n"), HasSubstr("line 2: expected a keyframe"));
}

TEST_F(CameraKeys, MustBeInTheOrderOfTheirTimes) {
  const std::string first = "- {time: 2, camera: top}\n";
  for (const char* time : {"2", "1.999", "0"}) {
    EXPECT_THAT(ErrorOf(first + "- {time: " + time + ", camera: top}\n"),
                AllOf(HasSubstr("line 3: time: " + std::string(time)), HasSubstr("more than 2")));
  }
  EXPECT_EQ(ErrorOf(first + "- {time: 2.001, camera: top}\n"), "");
}

TEST_F(CameraKeys, AreReportedAsMissingWithTheExpectedFormat) {
  for (const char* text : {"", "keys:\n", "keys: []\n", "keys: front\n", "front\n", "- 1\n",
                           "keys: [{time: 0, camera: top}]\nfps: 30\n"}) {
    EXPECT_THAT(ErrorOfText(text), AllOf(HasSubstr(path_), HasSubstr("'keys:'"))) << text;
  }
  EXPECT_THAT(ErrorOfText("keys:\n- {time: 0\n- }"), HasSubstr(path_ + ": line "));
}

TEST_F(CameraKeys, AreLimitedToAThousandInAMegabyte) {
  std::string keys;
  for (int i = 0; i < 1000; ++i) keys += "- {time: " + std::to_string(i) + ", camera: top}\n";
  EXPECT_EQ(ErrorOf(keys), "");
  EXPECT_THAT(ErrorOf(keys + "- {time: 1000, camera: top}\n"),
              AllOf(HasSubstr("1001"), HasSubstr("at most 1000")));
  EXPECT_THAT(ErrorOfText(std::string((1 << 20) + 1, '#')), HasSubstr("at most 1048576"));
}

TEST_F(CameraKeys, HaveNoAliasesAndNoDeepLists) {
  EXPECT_THAT(ErrorOfText("a: &a [x, x]\nkeys: [*a, *a]\n"),
              HasSubstr(path_ + ": line 2: alias; write the value itself"));
  EXPECT_THAT(ErrorOf("- " + std::string(100'000, '[')),
              HasSubstr(path_ + ": line 2: too many levels; at most 16"));
}

TEST_F(CameraKeys, AreRejectedFromAnUnreadableFile) {
  EXPECT_THROW(ReadCameraKeys(folder_ / "none.yaml"), UsageError);
  EXPECT_THROW(ReadCameraKeys(folder_.path()), UsageError);
}

TEST(ParsePoint, AcceptsOnlyThreeNumbers) {
  EXPECT_EQ(ParsePoint("1,-2.5,3e2"), Vector3d(1, -2.5, 300));
  EXPECT_EQ(ParsePoint("-1000,1000,0"), Vector3d(-1000, 1000, 0));
  for (const char* bad : {"", "1", "1,2", "1,2,3,4", "1,2,", ",,", "a,b,c", "1,2,nan", "1,2,inf",
                          "1001,0,0", "1;2;3"}) {
    EXPECT_FALSE(ParsePoint(bad)) << bad;
  }
}

TEST(CameraFromTo, HasClippingPlanesBeforeAndBehindItsTarget) {
  for (const double distance : {0.01, 1.0, 10.0, 1000.0}) {
    const auto camera = CameraFromTo({distance, 0, 0}, Vector3d::Zero());
    ASSERT_TRUE(camera);
    EXPECT_LT(camera->near_m, 0.5 * distance);
    EXPECT_GT(camera->far_m, 2 * distance);
    EXPECT_EQ(camera->up, Vector3d::UnitZ());
  }
  EXPECT_FALSE(CameraFromTo({1, 2, 3}, {1, 2, 3.0005}));
}

}  // namespace
}  // namespace kinescope::app
