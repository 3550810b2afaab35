// The alarms that `serve` raises without a file of rules: silent while people do ordinary things,
// and not while they lift too much.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/process.h"
#include "tests/server/http/test_client.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"

namespace kinescope {
namespace {

using testing::RestOfLine;

// The texts of the alarms in the first `secs` of `source`.
std::vector<std::string> AlarmsIn(const std::string& source, double secs,
                                  const std::string& options = "") {
  testing::Process process(
      {"/bin/sh", "-c",
       fmt::format(
           "exec '{}' serve '{}' --stop_at {} --http_port 0 --pictures off --ros off {} 2>&1",
           testing::KinescopePath(), source, secs, options)});
  const int port = std::stoi(RestOfLine(process, "page at http://127.0.0.1:"));
  RestOfLine(process, "stopped at ");
  const nlohmann::json answer = http::testing::Fetch(port, "/api/v1/alarms").json();
  std::vector<std::string> texts;
  for (const nlohmann::json& alarm : answer.at("alarms")) texts.push_back(alarm.at("text"));
  return texts;
}

TEST(DefaultAlarms, AreSilentWhilePeopleDoOrdinaryThings) {
  for (const char* motion : {"n_pose", "walk", "sit", "squat", "lift", "overhead"}) {
    EXPECT_THAT(AlarmsIn(fmt::format("demo:{}", motion), 20), ::testing::IsEmpty()) << motion;
  }
}

TEST(DefaultAlarms, AreSilentOnARealRecording) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  EXPECT_THAT(AlarmsIn(testing::SharedData("mvnx/test_mocap.mvnx"), 1.8), ::testing::IsEmpty());
}

TEST(DefaultAlarms, AreRaisedWhereSomebodyLiftsTooMuch) {
  EXPECT_THAT(AlarmsIn("demo:lift", 20, "--hand_load both:40"),
              ::testing::Contains(::testing::HasSubstr("L5/S1 compression")));
}

TEST(DefaultAlarms, AreRaisedForALoadThatIsShownAsHigh) {
  EXPECT_THAT(AlarmsIn("demo:squat", 5, "--hand_load both:20"),
              ::testing::Contains(::testing::HasSubstr("more than 60 %")));
  EXPECT_THAT(AlarmsIn("demo:squat", 5, "--hand_load both:20 --class_limits 0.6,0.9"),
              ::testing::Contains(::testing::HasSubstr("more than 90 %")));
}

}  // namespace
}  // namespace kinescope
