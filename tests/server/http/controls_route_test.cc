// The routes of controls, without a socket: what they take, what they reject, and downloads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "server/http/control_orders.h"
#include "server/http/router.h"
#include "tests/server/http/fake_controls.h"
#include "tests/server/http/test_scene.h"

namespace kinescope::http::testing {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;

class ControlsRouteTest : public ::testing::Test {
 protected:
  Answer Ask(const std::string& method, const std::string& target, const std::string& body = "",
             const std::string& token = kOperatorToken) {
    Router::Site site;
    site.tokens = {kOperatorToken, kViewerToken};
    site.states = &states_;
    site.controls = has_controls_ ? &controls_ : nullptr;
    site.count_refusal = [this](const std::string& reason) { ++refusals_[reason]; };
    Request request;
    request.method = method;
    request.target = target;
    request.host = "localhost:8080";
    request.authorization = "Bearer " + token;
    request.content_type = "application/json";
    if (method == "POST") request.body = body;
    return Router(std::move(site)).Route(request);
  }
  std::string WrongOf(const std::string& route, const std::string& body) {
    const Answer answer = Ask("POST", route, body);
    EXPECT_EQ(answer.status, 400) << body;
    return answer.body;
  }

  bool has_controls_ = true;
  FakeControls controls_;
  Latest<SceneState> states_;
  std::map<std::string, int> refusals_;
};

TEST_F(ControlsRouteTest, PassOrdersOn) {
  EXPECT_EQ(Ask("POST", "/api/v1/recording", R"({"run": true, "label": " warm up "})").status, 200);
  EXPECT_EQ(Ask("POST", "/api/v1/recording", R"({"run": false})").status, 200);
  EXPECT_EQ(Ask("POST", "/api/v1/clip", R"({"last_secs": 10})").status, 200);
  EXPECT_EQ(Ask("POST", "/api/v1/person", R"({"name": "<b>Ann</b>", "mass_kg": 80})").status, 200);
  EXPECT_EQ(Ask("POST", "/api/v1/class_limits", R"({"medium": 0.2, "high": 0.5})").status, 200);
  EXPECT_EQ(Ask("POST", "/api/v1/trial",
                R"({"start": true, "person": "S07", "condition": "lift", "number": 1})")
                .status,
            200);
  EXPECT_THAT(controls_.orders(), ElementsAre("record warm up", "stop recording", "last 10.000000",
                                              "person <b>Ann</b>", "limits", "trial S07"));
}

TEST_F(ControlsRouteTest, TellWhyAnOrderIsRefused) {
  controls_.refusal = "the disk is full";
  const Answer answer = Ask("POST", "/api/v1/recording", R"({"run": true})");
  EXPECT_EQ(answer.status, 409);
  EXPECT_EQ(json::parse(answer.body)["error"], "the disk is full");
  EXPECT_EQ(refusals_["order refused"], 1);
}

TEST_F(ControlsRouteTest, RejectOrdersThatAreNotWholeOrSayTooMuch) {
  for (const char* route : {"/api/v1/recording", "/api/v1/clip", "/api/v1/person",
                            "/api/v1/class_limits", "/api/v1/trial"}) {
    for (const char* body : {"", "{}", "[]", "null", "{", "\"x\"", R"({"unknown": 1})"}) {
      EXPECT_THAT(WrongOf(route, body), HasSubstr("expected")) << route << " " << body;
    }
  }
  const std::string long_name(61, 'a');
  EXPECT_THAT(WrongOf("/api/v1/recording", R"({"run": 1})"), HasSubstr("run"));
  EXPECT_THAT(WrongOf("/api/v1/recording", R"({"run": true, "label": "  "})"),
              HasSubstr("it is empty"));
  EXPECT_THAT(WrongOf("/api/v1/recording", R"({"run": true, "label": ")" + long_name + "\"}"),
              HasSubstr("61 characters are more than 60"));
  for (const char* clip :
       {R"({"last_secs": 1, "next_secs": 1})", R"({"from_micros": 1})", R"({"to_micros": 2})",
        R"({"last_secs": "1"})", R"({"last_secs": 1e999})",
        R"({"from_micros": -1, "to_micros": 2})", R"({"cancel": 1, "last_secs": 1})",
        R"({"cancel": -1})", R"({"camera": "iso"})"}) {
    EXPECT_THAT(WrongOf("/api/v1/clip", clip), HasSubstr("expected")) << clip;
  }
  for (const char* person :
       {R"({"person": 1})", R"({"sex": "x"})", R"({"mass_kg": "80"})", R"({"mass_kg": null})",
        R"({"person": -1, "mass_kg": 80})", R"({"person": 4294967296, "mass_kg": 80})"}) {
    EXPECT_THAT(WrongOf("/api/v1/person", person), HasSubstr("expected")) << person;
  }
  for (const char* limits : {R"({"medium": 0.3})", R"({"medium": 0.3, "high": null})"}) {
    EXPECT_THAT(WrongOf("/api/v1/class_limits", limits), HasSubstr("expected")) << limits;
  }
  for (const char* trial :
       {R"({"start": true})", R"({"start": true, "person": "S07", "condition": "lift"})",
        R"({"start": true, "stop": true, "person": "S07", "condition": "lift", "number": 1})",
        R"({"start": true, "person": "S07", "condition": "lift", "number": 0})",
        R"({"start": true, "person": "S07", "condition": "lift", "number": 10000})",
        R"({"stop": false})", R"({"trial": "x"})", R"({"clip": true})"}) {
    EXPECT_THAT(WrongOf("/api/v1/trial", trial), HasSubstr("expected")) << trial;
  }
  EXPECT_THAT(controls_.orders(), IsEmpty());
}

TEST_F(ControlsRouteTest, ShowViewersTheFilesWithoutTheirFolder) {
  EXPECT_THAT(Ask("GET", "/api/v1/files").body, HasSubstr("/lab"));
  EXPECT_THAT(Ask("GET", "/api/v1/files", "", kViewerToken).body, Not(HasSubstr("/lab")));
  EXPECT_EQ(Ask("GET", "/api/v1/controls", "", kViewerToken).status, 200);
}

TEST_F(ControlsRouteTest, SendFilesToOperatorsAsDownloads) {
  const Answer answer = Ask("GET", "/api/v1/file/S07_lift_001.mp4");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.file, "/lab/S07_lift_001.mp4");
  EXPECT_EQ(answer.content_type, "video/mp4");
  EXPECT_THAT(answer.headers,
              Contains(Pair("Content-Disposition", "attachment; filename=\"S07_lift_001.mp4\"")));
  const Answer refused = Ask("GET", "/api/v1/file/S07_lift_001.mp4", "", kViewerToken);
  EXPECT_EQ(refused.status, 403);
  EXPECT_FALSE(refused.file);
  EXPECT_EQ(Ask("GET", "/api/v1/file/other.mp4").status, 404);
  EXPECT_EQ(Ask("GET", "/api/v1/file/..%2fS07_lift_001.mp4").status, 400);
  EXPECT_EQ(Ask("POST", "/api/v1/file/S07_lift_001.mp4").status, 405);
}

TEST_F(ControlsRouteTest, AreMissingOnAServerWithoutThem) {
  has_controls_ = false;
  EXPECT_EQ(Ask("GET", "/api/v1/controls").status, 503);
  EXPECT_EQ(Ask("GET", "/api/v1/files").status, 503);
  EXPECT_EQ(Ask("POST", "/api/v1/recording", R"({"run": true})").status, 503);
  EXPECT_EQ(Ask("GET", "/api/v1/file/S07_lift_001.mp4").status, 404);
}

}  // namespace
}  // namespace kinescope::http::testing
