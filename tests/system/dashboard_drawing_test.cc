// The page of this program at a moment of a recording, drawn by the real Chromium.
#include "server/app/golden/dashboard_drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "server/app/golden/page_browser.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Kinescope;
using testing::TempFolder;

DashboardSpec SpecOf(const std::string& source, double time) {
  DashboardSpec spec;
  spec.source = source;
  spec.time = time;
  spec.program = testing::KinescopePath();
  return spec;
}

std::string WhyNoDashboard(const DashboardSpec& spec) {
  try {
    DrawDashboard(spec);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

std::string TextOf(const PageDrawing& drawing, const std::string& name) {
  for (const PageElement& each : drawing.elements) {
    if (each.name == name) return each.text;
  }
  return "no element " + name;
}

class DashboardTest : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      (void)FindChromium();
    } catch (const std::runtime_error& missing) {
      GTEST_SKIP() << missing.what();
    }
  }
  // A recording of two seconds.
  std::string Recording() const {
    const fs::path file = folder_ / "walk.mvnx";
    EXPECT_EQ(Kinescope({"convert", "demo:walk", "--seconds", "2", "--out", file}).exit_code, 0);
    return file;
  }

  TempFolder folder_;
};

TEST_F(DashboardTest, OfAMomentIsTheSameToTheByteEachTime) {
  for (const char* query : {"", "view=wall&theme=dark", "tab=plots"}) {
    DashboardSpec spec = SpecOf("demo:lift", 2);
    spec.query = query;
    const PageDrawing one = DrawDashboard(spec), other = DrawDashboard(spec);
    EXPECT_EQ(FindChange(one, other), std::nullopt) << query;
    EXPECT_TRUE(one.image.rgba == other.image.rgba) << query;
    EXPECT_EQ(one.elements, other.elements) << query;
  }
}

TEST_F(DashboardTest, OfARecordingShowsTheMomentAndWhatAPersonReads) {
  const PageDrawing drawing = DrawDashboard(SpecOf(Recording(), 1.5));
  EXPECT_EQ(TextOf(drawing, "status-word"), "Recording 0:01.5 of 0:02");
  EXPECT_EQ(TextOf(drawing, "source"), "walk.mvnx") << "without the folder";
  EXPECT_EQ(TextOf(drawing, "sample"), "180");
  EXPECT_EQ(TextOf(drawing, "Right knee word"), "medium");
  EXPECT_EQ(TextOf(drawing, "tab-loads"), "Loads [selected]");
}

TEST_F(DashboardTest, AMomentLaterIsAChangeWithAName) {
  const auto change =
      FindChange(DrawDashboard(SpecOf("demo:lift", 2)), DrawDashboard(SpecOf("demo:lift", 2.02)));
  ASSERT_TRUE(change);
  EXPECT_EQ(*change, "'sample' (240)");
}

TEST_F(DashboardTest, OptionsOfTheServerChangeWhatItShows) {
  DashboardSpec spec = SpecOf("demo:lift", 2);
  spec.options = {"--mass=120"};
  EXPECT_THAT(TextOf(DrawDashboard(spec), "loads-hint"), ::testing::Not(HasSubstr("assumed")));
}

TEST_F(DashboardTest, FitsAPhone) {
  DashboardSpec spec = SpecOf("demo:lift", 2);
  spec.width_px = 390;
  spec.height_px = 844;
  const PageDrawing drawing = DrawDashboard(spec);
  EXPECT_EQ(drawing.image.width, 390);
  EXPECT_EQ(TextOf(drawing, "tab-view"), "View [selected]");
}

TEST_F(DashboardTest, WhatTheServerRefusesIsSaid) {
  const std::string recording = Recording();
  EXPECT_THAT(WhyNoDashboard(SpecOf(recording, 900)),
              AllOf(HasSubstr("page: dashboard: the server has ended with exit code 2"),
                    HasSubstr("ends 2.000 s after its first sample, before 900.000 s")));
  EXPECT_THAT(WhyNoDashboard(SpecOf((folder_ / "nothing.mvnx").string(), 1)),
              HasSubstr("file not found"));
  EXPECT_THAT(WhyNoDashboard(SpecOf("udp://:9763", 1)), HasSubstr("no such moment"));
  DashboardSpec spec = SpecOf("demo:lift", 2);
  spec.options = {"--figur=skin"};
  EXPECT_THAT(WhyNoDashboard(spec), HasSubstr("--figur"));
}

}  // namespace
}  // namespace kinescope::app
