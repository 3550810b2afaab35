// /api/v1/alarms and /api/v1/acknowledge, without a socket: what they answer and what they reject.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "server/alarms/alarms.h"
#include "server/alarms/rule_file.h"
#include "server/http/router.h"
#include "tests/server/http/test_scene.h"

namespace kinescope::http::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class AlarmsRouteTest : public ::testing::Test {
 protected:
  AlarmsRouteTest() {
    SceneState state = MakeScene(1, 0, 1, MakePersonModel(), 1);
    state.made_nanos = 5'000'000;
    alarms_.OnState(state);  // with a compression of 2150 N
  }

  Answer Ask(const std::string& method, const std::string& target, const std::string& token,
             std::optional<std::string> body = {}) {
    Router::Site site;
    site.tokens = {kOperatorToken, kViewerToken};
    site.states = &states_;
    site.alarms = has_alarms_ ? &alarms_ : nullptr;
    site.count_refusal = [this](const std::string& reason) { ++refusals_[reason]; };
    Request request;
    request.method = method;
    request.target = target;
    request.host = "localhost:8080";
    request.authorization = "Bearer " + token;
    request.content_type = "application/json";
    request.body = std::move(body);
    return Router(std::move(site)).Route(request);
  }
  Answer Acknowledge(const std::string& body, const std::string& token = kOperatorToken) {
    return Ask("POST", "/api/v1/acknowledge", token, body);
  }

  alarms::Alarms alarms_{
      alarms::ParseRules("test", "rules: [{name: high, value: compression, above: 2000}]"),
      /*is_live=*/true};
  Latest<SceneState> states_;
  bool has_alarms_ = true;
  std::map<std::string, int> refusals_;
};

TEST_F(AlarmsRouteTest, TellsRulesAndAlarmsToViewers) {
  const json answer = json::parse(Ask("GET", "/api/v1/alarms", kViewerToken).body);
  ASSERT_EQ(answer["rules"].size(), 2u);
  EXPECT_EQ(answer["rules"][0]["above"], 2000);
  EXPECT_EQ(answer["rules"][1]["name"], "lost");
  ASSERT_EQ(answer["alarms"].size(), 1u);
  EXPECT_EQ(answer["alarms"][0]["value"], 2150);
  EXPECT_EQ(answer["alarms"][0]["began"]["micros"], 5000);
  EXPECT_EQ(answer["alarms"][0]["is_on"], true);
}

TEST_F(AlarmsRouteTest, AnOperatorAcknowledges) {
  const Answer answer = Acknowledge(R"({"id": 1})");
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(json::parse(answer.body)["acknowledged"]["role"], "operator");
  const Answer again = Acknowledge(R"({"id": 1})");
  EXPECT_EQ(again.status, 409);
  EXPECT_THAT(again.body, HasSubstr("alarm 1 has been acknowledged before"));
}

TEST_F(AlarmsRouteTest, RejectsViewersAndWhatIsNoAcknowledgement) {
  EXPECT_EQ(Acknowledge(R"({"id": 1})", kViewerToken).status, 403);
  EXPECT_EQ(Acknowledge(R"({"id": 7})").status, 409);
  for (const char* body : {"", "{", "[]", "{}", R"({"id": -1})", R"({"id": 1.5})", R"({"id": "1"})",
                           R"({"id": 1, "x": 2})"}) {
    const Answer answer = Acknowledge(body);
    EXPECT_EQ(answer.status, 400) << body;
    EXPECT_THAT(answer.body, HasSubstr(R"(expected {\"id\": NUMBER})")) << body;
  }
  EXPECT_FALSE(alarms_.shown().at(0).acknowledged);
}

TEST_F(AlarmsRouteTest, SaysSoIfNothingIsWatched) {
  has_alarms_ = false;
  EXPECT_EQ(Ask("GET", "/api/v1/alarms", kOperatorToken).status, 503);
  EXPECT_EQ(Acknowledge(R"({"id": 1})").status, 503);
}

}  // namespace
}  // namespace kinescope::http::testing
