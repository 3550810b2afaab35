#include "server/app/serve/diagnostics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/server/http/test_scene.h"

namespace kinescope::app {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

std::shared_ptr<SceneState> OnePerson() {
  return std::make_shared<SceneState>(http::testing::MakeScene(
      1, 0, 5'000'000'000, http::testing::MakePersonModel(7), /*people=*/1));
}

TEST(DiagnosticsJson, WarnsOfAnAssumedMassAndOfADifferentCentreOfMass) {
  const auto state = OnePerson();
  BodyForces& forces = state->people[0].forces;
  forces.body_mass_is_assumed = true;
  forces.com_disagrees = true;
  forces.com_minus_mvn = Eigen::Vector3d(0.012, 0, -0.009);
  const json person = json::parse(DiagnosticsJson(state, nullptr, {}, {}))["loads"][0];
  EXPECT_THAT(person["warnings"],
              ElementsAre("the body mass is assumed",
                          "centre of mass differs from MVN's by 15 mm; check frames, segment "
                          "lengths and body data"));
  EXPECT_NEAR(person["com_minus_mvn_m"].get<double>(), 0.015, 1e-9);
}

TEST(DiagnosticsJson, HasWhatIsWrongWithSamplesThatAreShown) {
  const auto counters = std::make_shared<SourceCounters>();
  counters->problems = {"people are in the frame 'lab'"};
  const json told = json::parse(DiagnosticsJson(OnePerson(), counters, {}, {}));
  EXPECT_THAT(told["source"]["problems"], ElementsAre("people are in the frame 'lab'"));
}

TEST(DiagnosticsJson, HasNoDifferenceOfTheCentreOfMassIfMvnSendsNone) {
  const auto state = OnePerson();
  state->people[0].forces.com_minus_mvn.reset();
  const json person = json::parse(DiagnosticsJson(state, nullptr, {}, {}))["loads"][0];
  EXPECT_TRUE(person.at("com_minus_mvn_m").is_null());
}

TEST(DiagnosticsJson, ReportsADriverThatDoesNotRespondForPicturesAndRosView) {
  DrawingStatus pictures;
  DrawingStatus view;
  pictures.hangs = true;
  json status = json::parse(DiagnosticsJson(nullptr, nullptr, {}, pictures, view));
  EXPECT_EQ(status["pictures"]["driver_hung"], true);
  EXPECT_EQ(status["view"]["driver_hung"], false);
  view.hangs = true;
  status = json::parse(DiagnosticsJson(nullptr, nullptr, {}, {}, view));
  EXPECT_TRUE(status["pictures"].is_null());
  EXPECT_EQ(status["view"]["driver_hung"], true);
}

TEST(DiagnosticsJson, CountsRejectedMessagesAndCallsByReason) {
  ros_bridge::BridgeStatus ros;
  ros.rejected_calls["more than 4 MiB"] = 2;
  ros.inputs["hand_wrench/right"].refused["not a number"] = 3;
  const json status = json::parse(DiagnosticsJson(nullptr, nullptr, ros, {}));
  EXPECT_EQ(status["ros"]["inputs"]["hand_wrench/right"]["rejected"]["not a number"], 3);
  EXPECT_EQ(status["ros"]["rejected_calls"]["more than 4 MiB"], 2);
}

}  // namespace
}  // namespace kinescope::app
