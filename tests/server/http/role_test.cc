// Viewers look, operators change: every route and every command of the tables, with each role.
#include "server/http/role.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "server/alarms/alarms.h"
#include "server/history/history.h"
#include "server/http/hub.h"
#include "server/http/router.h"
#include "server/marks/mark_book.h"
#include "tests/server/http/fake_controls.h"
#include "tests/server/http/test_scene.h"
#include "tests/server/http/test_server.h"
#include "tests/temp_folder.h"

namespace kinescope::http::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string TokenOf(Role role) { return role == Role::kOperator ? kOperatorToken : kViewerToken; }

class RoleOfRouteTest : public ::testing::Test {
 protected:
  RoleOfRouteTest() {
    const auto state =
        std::make_shared<const SceneState>(MakeScene(12, 0.2, 1, MakePersonModel(7), 1));
    states_.Publish(state);
    history_.Add(state);
  }

  Router MakeRouter() {
    Router::Site site;
    site.tokens = {kOperatorToken, kViewerToken};
    site.cookie_name = "kinescope_80";
    site.cameras = MakeCameras();
    site.framing = MakeFraming();
    site.has_pictures = true;
    site.files = &files_;
    site.states = &states_;
    site.history = &history_;
    site.marks = &marks_;
    site.controls = &controls_;
    site.set_hand_load = [this](int, const HandLoad&) {
      ++changes_;
      return std::string();
    };
    site.diagnostics = [] { return std::string("{}"); };
    site.live_camera = [] { return std::string("iso"); };
    site.alarms = &alarms_;
    site.surroundings = [] { return std::make_shared<const Surroundings>(); };
    site.count_refusal = [this](const std::string& reason) { ++refusals_[reason]; };
    return Router(site);
  }

  static Request RequestOf(const Router::RouteInfo& route, Role role) {
    Request request;
    request.method = route.method;
    for (std::size_t at = 0; at < route.path.size(); ++at) {
      const bool is_variable = route.path[at] == '{';
      request.target += is_variable ? '0' : route.path[at];
      if (is_variable) at = route.path.find('}', at);
    }
    if (route.path == "/api/v1/series") {  // has no answer without a question
      request.target += "?person=0&keys=l5_s1&from=0&to=1000000&columns=2";
    }
    request.host = "lab.example";
    request.authorization = "Bearer " + TokenOf(role);
    request.content_type = "application/json";
    return request;
  }

  // The answer to a client that may use the route.
  static int StatusFor(const Router::RouteInfo& route) {
    const auto has = [&](const char* part) { return route.path.find(part) != std::string::npos; };
    if (has("{revision}")) return 307;  // of revision 0
    return has("{") ? 404 : route.path == Router::kWebSocketPath ? 426 : 200;
  }

  kinescope::testing::TempFolder web_;
  StaticFiles files_{web_.path()};
  Latest<SceneState> states_;
  history::History history_;
  marks::MarkBook marks_{{web_ / "marks.jsonl", {"lift"}}};
  FakeControls controls_;
  alarms::Alarms alarms_{{}, /*is_live=*/true};
  int changes_ = 0;
  std::map<std::string, int> refusals_;
};

TEST_F(RoleOfRouteTest, IsThatOfAnOperatorForEveryRouteThatChangesAnything) {
  for (const Router::RouteInfo& route : Router::ApiRoutes()) {
    // What is downloaded is the lab's.
    const bool is_open = route.method == "GET" && route.path != "/api/v1/file/{name}";
    EXPECT_EQ(route.least, is_open ? Role::kViewer : Role::kOperator) << route.path;
  }
}

TEST_F(RoleOfRouteTest, DecidesWhichRoutesOfTheTableAViewerMayUse) {
  const Router router = MakeRouter();
  int refused = 0;
  for (const Router::RouteInfo& route : Router::ApiRoutes()) {
    const Request request = RequestOf(route, Role::kViewer);  // its body is not read yet
    const Answer answer = router.Route(request);
    if (route.least == Role::kViewer) {
      EXPECT_EQ(answer.status, StatusFor(route)) << route.path << ": " << answer.body;
      continue;
    }
    ++refused;
    EXPECT_EQ(answer.status, 403) << route.path;
    EXPECT_FALSE(answer.needs_body) << route.path << ": refused before its body is read";
    EXPECT_THAT(answer.body, AllOf(HasSubstr(route.method + " " + request.target),
                                   HasSubstr("viewer"), HasSubstr("operator's token")));
    Request with_body = request;
    with_body.body =
        route.path == "/api/v1/mark" ? R"({"state": 12, "button": 1})" : R"({"right_kg": 5})";
    EXPECT_EQ(router.Route(with_body).status, 403) << route.path;
  }
  EXPECT_GT(refused, 0);
  EXPECT_EQ(changes_, 0);
  EXPECT_THAT(controls_.orders(), IsEmpty());
  EXPECT_EQ(marks_.revision(), 0U);
  EXPECT_EQ(refusals_["not an operator"], 2 * refused);
}

TEST_F(RoleOfRouteTest, PermitsEveryRouteToAnOperator) {
  const Router router = MakeRouter();
  for (const Router::RouteInfo& route : Router::ApiRoutes()) {
    const Answer answer = router.Route(RequestOf(route, Role::kOperator));
    EXPECT_EQ(answer.status, StatusFor(route)) << route.path << ": " << answer.body;
    EXPECT_EQ(answer.needs_body, route.method != "GET") << route.path;
  }
  EXPECT_EQ(refusals_["not an operator"], 0);
}

TEST_F(RoleOfRouteTest, IsToldToThePage) {
  const Router router = MakeRouter();
  for (const Role role : {Role::kViewer, Role::kOperator}) {
    const Answer answer = router.Route(RequestOf({"/api/v1/session", "GET", role}, role));
    EXPECT_EQ(nlohmann::json::parse(answer.body).at("role"), Name(role));
  }
}

TEST_F(RoleOfRouteTest, StaysInTheCookieOfItsToken) {
  const Router router = MakeRouter();
  Request request = RequestOf({"/api/v1/session", "GET", Role::kViewer}, Role::kViewer);
  request.authorization.clear();
  request.target += std::string("?token=") + kViewerToken;
  std::string cookie;
  for (const auto& [name, value] : router.Route(request).headers) {
    if (name == "Set-Cookie") cookie = value.substr(0, value.find(';'));
  }
  EXPECT_EQ(cookie, std::string("kinescope_80=") + kViewerToken);
  request.target = "/api/v1/session";
  request.cookies = cookie;
  EXPECT_EQ(nlohmann::json::parse(router.Route(request).body).at("role"), "viewer");
}

TEST_F(RoleOfRouteTest, IsThatOfTheWebSocket) {
  const Router router = MakeRouter();
  for (const Role role : {Role::kViewer, Role::kOperator}) {
    Role found = role == Role::kViewer ? Role::kOperator : Role::kViewer;
    EXPECT_FALSE(router.RefuseWebSocket(RequestOf({"/api/v1/ws", "GET", role}, role), &found));
    EXPECT_EQ(found, role);
  }
}

class FakeClient final : public HubClient {
 public:
  explicit FakeClient(Role role) : role_(role) {}
  void Offer(Slot slot, SharedBytes message) override {
    if (slot == Slot::kError) errors_.emplace_back(message->begin(), message->end());
  }
  void SetWantsPictures(bool wanted) override { wants_ = wanted; }
  bool wants_pictures() const override { return wants_; }
  void SetWantsDark(bool wanted) override { dark_ = wanted; }
  bool wants_dark() const override { return dark_; }
  bool OnSeen(Slot, std::uint64_t) override { return true; }
  ClientCounters counters() const override { return {}; }
  const std::string& address() const override { return address_; }
  Role role() const override { return role_; }
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  const Role role_;
  const std::string address_ = "10.0.0.7";
  bool wants_ = false;
  bool dark_ = false;
  std::vector<std::string> errors_;
};

// What all clients share.
struct Shared {
  Latest<SceneState> states;
  Latest<Picture> pictures;
  FakeFeed feed;
  history::History history;
  Counters counters;
  Hub hub{states, pictures, &feed, &history, "iso", counters};

  Shared() {
    auto state = std::make_shared<SceneState>(MakeScene(12, 0.2, 1, MakePersonModel(7), 1));
    states.Publish(state);
    history.Add(std::move(state));
  }
};

// The errors that the command `text` brings to a client of `role`.
std::vector<std::string> ErrorsOf(Shared& shared, Role role, const std::string& text) {
  FakeClient client(role);
  EXPECT_TRUE(shared.hub.Join(client));
  shared.hub.OnMessage(client, text);
  shared.hub.Leave(client);
  return client.errors();
}

TEST(ThemeOfTheLivePicture, IsDarkWhileAllOfItsViewersWantItSo) {
  Shared shared;
  FakeClient dark(Role::kViewer), light(Role::kViewer);
  ASSERT_TRUE(shared.hub.Join(dark) && shared.hub.Join(light));
  shared.hub.OnMessage(dark, R"({"dark": true})");
  EXPECT_FALSE(shared.feed.is_dark()) << "it watches no picture yet";
  shared.hub.OnMessage(dark, R"({"pictures": true})");
  EXPECT_TRUE(shared.feed.is_dark());
  shared.hub.OnMessage(light, R"({"pictures": true})");
  EXPECT_FALSE(shared.feed.is_dark());
  shared.hub.Leave(light);
  EXPECT_TRUE(shared.feed.is_dark());
  shared.hub.OnMessage(dark, R"({"dark": false})");
  EXPECT_FALSE(shared.feed.is_dark());
  shared.hub.Leave(dark);
}

TEST(RoleOfCommand, IsThatOfAnOperatorIfItChangesWhatOthersSee) {
  std::set<std::string> changing;
  for (const CommandInfo& command : Commands()) {
    Shared shared;
    EXPECT_THAT(ErrorsOf(shared, Role::kOperator, command.example), IsEmpty()) << command.example;
    if (shared.hub.camera() == "iso" && shared.feed.camera().empty()) continue;
    changing.insert(command.name);
    EXPECT_EQ(command.least, Role::kOperator) << command.name;
  }
  EXPECT_THAT(changing, ::testing::ElementsAre("camera"));
}

TEST(RoleOfCommand, DecidesWhichCommandsOfTheTableAViewerMaySend) {
  for (const CommandInfo& command : Commands()) {
    Shared shared;
    const auto errors = ErrorsOf(shared, Role::kViewer, command.example);
    EXPECT_EQ(shared.hub.camera(), "iso") << command.name;
    EXPECT_EQ(shared.feed.camera(), "") << command.name;
    if (command.least == Role::kViewer) {
      EXPECT_THAT(errors, IsEmpty()) << command.name;
      continue;
    }
    ASSERT_EQ(errors.size(), 1u) << command.name;
    EXPECT_THAT(errors.front(), AllOf(HasSubstr(command.name), HasSubstr("operator's token")));
    EXPECT_EQ(shared.counters.rejected["not an operator"], 1u) << command.name;
  }
}

TEST(RoleOfCommand, RefusesAMessageAsAWhole) {
  Shared shared;
  FakeClient client(Role::kViewer);
  ASSERT_TRUE(shared.hub.Join(client));
  shared.hub.OnMessage(client, R"({"pictures": true, "camera": "front"})");
  EXPECT_FALSE(client.wants_pictures());
  EXPECT_EQ(client.errors().size(), 1u);
  shared.hub.Leave(client);
}

// Over sockets.
TEST(RoleOfClient, ComesFromTheTokenWithWhichItConnected) {
  TestServer site(kOperatorToken);
  // The answer to "ping" comes with every permitted message, and an error with another.
  const auto ask = [&](Role role, const std::string& key) {
    WsClient client(site.server.port(), "/api/v1/ws?token=" + TokenOf(role));
    client.Send(R"({"camera": "front", "ping": 1})");
    return client.ReceiveText(key).dump();
  };
  EXPECT_THAT(ask(Role::kViewer, "error"), HasSubstr("operator's token"));
  EXPECT_EQ(site.feed.camera(), "");
  EXPECT_THAT(ask(Role::kOperator, "pong"), HasSubstr("1"));
  EXPECT_EQ(site.feed.camera(), "front");
}

}  // namespace
}  // namespace kinescope::http::testing
