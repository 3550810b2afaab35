// What each address answers, without a socket: requests in, answers out.
#include "server/http/router.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/http/protocol.h"
#include "tests/mesh_file_on_demand.h"
#include "tests/server/http/test_scene.h"
#include "tests/temp_folder.h"

namespace kinescope::http::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr std::uintmax_t kLargestMesh = 64u << 20;  // bytes
constexpr char kCookie[] = "kinescope_8080";
constexpr char kFiveInTheRightHand[] = R"({"right_kg": 5})";

void WriteText(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

// As a browser on this machine sends it.
Request RequestOf(const std::string& method, const std::string& target) {
  Request request;
  request.method = method;
  request.target = target;
  request.host = "localhost:8080";
  return request;
}

Request PostOf(const std::string& body) {
  Request request = RequestOf("POST", "/api/v1/hand_load");
  request.content_type = "application/json";
  request.body = body;
  return request;
}

std::string HeaderOf(const Answer& answer, const std::string& name) {
  for (const auto& [key, value] : answer.headers) {
    if (key == name) return value;
  }
  return "";
}

std::string ErrorIn(const Answer& answer) {
  return nlohmann::json::parse(answer.body).at("error").get<std::string>();
}

class RouterTest : public ::testing::Test {
 protected:
  RouterTest() {
    WriteText(web_ / "index.html", "<title>page</title>");
    WriteText(web_ / "app.js", "start();");
    WriteText(meshes_ / "pelvis.stl", "solid pelvis");
    files_ = std::make_unique<StaticFiles>(web_.path());
  }

  Router::Site SiteOf() {
    Router::Site site;
    site.cookie_name = kCookie;
    site.cameras = MakeCameras();
    site.framing = MakeFraming();
    site.has_pictures = true;
    site.files = files_.get();
    site.states = &states_;
    site.set_hand_load = [this](int character, const HandLoad& load) {
      if (load.mass_kg[urdf::kRight] > 100) return std::string("nobody holds that");
      held_[character] = load;
      return std::string();
    };
    site.diagnostics = [] { return std::string(R"({"source": {}})"); };
    site.live_camera = [] { return std::string("iso"); };
    site.count_refusal = [this](const std::string& reason) { ++refusals_[reason]; };
    return site;
  }

  Router::Site GuardedSite() {
    Router::Site site = SiteOf();
    site.tokens.of_operator = "s3cret";
    site.guesses = &guesses_;
    return site;
  }

  Answer Get(const std::string& target) { return Router(SiteOf()).Route(RequestOf("GET", target)); }
  Answer Send(const Request& request) { return Router(SiteOf()).Route(request); }

  void PublishPeople(int people) {
    states_.Publish(std::make_shared<const SceneState>(
        MakeScene(12, 0.2, 1, MakePersonModel(7, meshes_.path().string()), people)));
  }

  kinescope::testing::TempFolder web_, meshes_;
  std::unique_ptr<StaticFiles> files_;
  Latest<SceneState> states_;
  std::map<int, HandLoad> held_;
  std::map<std::string, int> refusals_;
  GuessGuard guesses_{nullptr};
};

TEST_F(RouterTest, AnswersEveryRouteInItsFormat) {
  PublishPeople(1);
  struct Route {
    const char* target;
    const char* content_type;
    const char* cache_control;
  };
  for (const Route& route : {Route{"/", "text/html; charset=utf-8", "no-cache"},
                             Route{"/app.js", "text/javascript; charset=utf-8", "no-cache"},
                             Route{"/api/v1/state", "application/json", "no-store"},
                             Route{"/api/v1/model", "application/json", "no-store"},
                             Route{"/api/v1/cameras", "application/json", "no-store"},
                             Route{"/api/v1/diagnostics", "application/json", "no-store"},
                             Route{"/api/v1/mesh/0/7/0", "model/stl", "no-cache"},
                             Route{"/api/v1/snapshot.png", "image/png", "no-store"}}) {
    const Answer answer = Get(route.target);
    EXPECT_EQ(answer.status, 200) << route.target << ": " << answer.body;
    EXPECT_EQ(answer.content_type, route.content_type) << route.target;
    EXPECT_EQ(HeaderOf(answer, "Cache-Control"), route.cache_control) << route.target;
  }
  EXPECT_THAT(refusals_, IsEmpty());
}

TEST_F(RouterTest, ServesMeshesFromMemoryWithoutWritingFiles) {
  auto model = std::make_shared<PersonModel>(*MakePersonModel(8, meshes_.path().string()));
  fs::remove(meshes_ / "pelvis.stl");
  const auto files =
      std::make_shared<kinescope::testing::MeshFileOnDemand>(meshes_ / "pelvis.stl", "an STL file");
  model->mesh_files = files;
  states_.Publish(std::make_shared<const SceneState>(MakeScene(12, 0.2, 1, model, 1)));
  EXPECT_EQ(Get("/api/v1/mesh/0/8/0").body, "an STL file");
  EXPECT_EQ(Get("/api/v1/mesh/0/8/1").status, 404) << "named, but not of this set";
  EXPECT_FALSE(files->is_provided());
}

TEST_F(RouterTest, ServesTheSkinOfTheNewestModelUnlessItIsMadeOfParts) {
  auto parts = std::make_shared<PersonModel>(*MakePersonModel(8));
  states_.Publish(std::make_shared<const SceneState>(MakeScene(12, 0.2, 1, parts, 1)));
  EXPECT_THAT(ErrorIn(Get("/api/v1/skin/0/8")), HasSubstr("made of parts"));
  auto model = std::make_shared<PersonModel>(*parts);
  model->has_built_in_surface = true;
  states_.Publish(std::make_shared<const SceneState>(MakeScene(12, 0.2, 1, model, 1)));
  const Answer skin = Get("/api/v1/skin/0/8");
  EXPECT_EQ(skin.status, 200);
  EXPECT_EQ(skin.content_type, "application/octet-stream");
  EXPECT_LE(skin.body.size(), 600'000u);
  Request again = RequestOf("GET", "/api/v1/skin/0/8");
  again.if_none_match = HeaderOf(skin, "ETag");
  EXPECT_EQ(Send(again).status, 304);
  EXPECT_TRUE(Send(again).body.empty());
  EXPECT_EQ(Get("/api/v1/skin/0/8?error_mm=0").body, skin.body);
  const Answer coarse = Get("/api/v1/skin/0/8?error_mm=4");
  EXPECT_EQ(coarse.status, 200);
  EXPECT_LT(coarse.body.size(), skin.body.size() / 4);
  EXPECT_LT(Get("/api/v1/skin/0/8?error_mm=10").body.size(), coarse.body.size());
  EXPECT_EQ(Get("/api/v1/skin/0/8?error_mm=4").body, coarse.body);
  for (const char* error : {"11", "-1", "4.5", "", "x", "99999999999"}) {
    const Answer refused = Get(std::string("/api/v1/skin/0/8?error_mm=") + error);
    EXPECT_EQ(refused.status, 400) << error;
    EXPECT_THAT(ErrorIn(refused), HasSubstr("expected a whole number from 0 to 10"));
  }
  for (const char* target :
       {"/api/v1/skin/0/9", "/api/v1/skin/1/8", "/api/v1/skin/18446744073709551615/8",
        "/api/v1/skin/0", "/api/v1/skin/0/8/0", "/api/v1/skin/a/8", "/api/v1/skin/0/-8"}) {
    EXPECT_EQ(Get(target).status, 404) << target;
  }
}

// A page that asks for what it was told before a change had an error in its console.
TEST_F(RouterTest, SendsWhoAsksForAnEarlierModelToTheNewestOne) {
  PublishPeople(2);
  for (const auto& [target, address] :
       std::map<std::string, std::string>{{"/api/v1/skin/0/6", "7"},
                                          {"/api/v1/skin/1/1?error_mm=3", "7?error_mm=3"},
                                          {"/api/v1/mesh/0/6/0", "../7/0"},
                                          {"/api/v1/mesh/1/0/14?a=b", "../7/14?a=b"}}) {
    const Answer answer = Get(target);
    EXPECT_EQ(answer.status, 307) << target;
    EXPECT_EQ(HeaderOf(answer, "Location"), address) << target;
  }
  EXPECT_EQ(Get("/api/v1/skin/0/6?error_mm=11").status, 400);
}

// A guessable folder for temporary files belongs to everybody.
TEST_F(RouterTest, ServesNoFileThatSomebodyElsePlaced) {
  auto model = std::make_shared<PersonModel>(*MakePersonModel(8, meshes_.path().string()));
  model->mesh_files =
      std::make_shared<kinescope::testing::MeshFileOnDemand>(meshes_ / "pelvis.stl", "an STL file");
  fs::remove(meshes_ / "pelvis.stl");
  fs::create_symlink("/etc/passwd", meshes_ / "pelvis.stl");
  fs::create_symlink("/etc/passwd", meshes_ / "l5.stl");
  states_.Publish(std::make_shared<const SceneState>(MakeScene(12, 0.2, 1, model, 1)));
  EXPECT_EQ(Get("/api/v1/mesh/0/8/0").body, "an STL file");
  EXPECT_EQ(Get("/api/v1/mesh/0/8/1").status, 404);
}

TEST_F(RouterTest, AnswersWithTheNewestStateOrWithoutData) {
  EXPECT_EQ(nlohmann::json::parse(Get("/api/v1/state").body).at("liveness"), "no data");
  EXPECT_TRUE(nlohmann::json::parse(Get("/api/v1/model").body).at("people").empty());
  PublishPeople(2);
  EXPECT_EQ(nlohmann::json::parse(Get("/api/v1/state").body).at("state_number"), 12);
  EXPECT_EQ(nlohmann::json::parse(Get("/api/v1/model").body).at("people").size(), 2u);
  const auto cameras = nlohmann::json::parse(Get("/api/v1/cameras").body);
  EXPECT_EQ(cameras.at("cameras").size(), MakeCameras().size());
  EXPECT_THAT(cameras.dump(), HasSubstr("iso"));
  EXPECT_EQ(Get("/api/v1/diagnostics").body, R"({"source": {}})");
}

TEST_F(RouterTest, ListsTheKnownAddressesForAnUnknownOne) {
  const auto expect_unknown = [&](const std::string& target, const std::string& what) {
    const Answer answer = Get(target);
    EXPECT_EQ(answer.status, 404) << target;
    EXPECT_EQ(answer.content_type, "application/json") << target;
    EXPECT_THAT(ErrorIn(answer), HasSubstr(what)) << target;
    EXPECT_FALSE(answer.file) << target;
  };
  expect_unknown("/nothing", "no page at this address");
  expect_unknown("/app.js/", "no page at this address");
  expect_unknown("/API/state", "no page at this address");
  expect_unknown("/api", "no page at this address");
  expect_unknown("/lib/three/three.module.js", "sh web/fetch_libraries.sh");
  expect_unknown("/api/v1/mesh/0", "/api/v1/mesh/{person}/{revision}/{number}");
  EXPECT_EQ(refusals_["unknown address"], 6);
  for (const char* target :
       {"/api/v1/", "/api/v1/nothing", "/api/v1/state/", "/api/v1/hand_loads"}) {
    for (const char* route : {"/api/v1/session", "/api/v1/state", "/api/v1/model",
                              "/api/v1/cameras", "/api/v1/diagnostics", "/api/v1/hand_load"}) {
      expect_unknown(target, route);
    }
  }
}

TEST_F(RouterTest, AcceptsOnlyGetAndHead) {
  for (const char* target :
       {"/", "/api/v1/state", "/api/v1/mesh/0/7/0", "/api/v1/snapshot.png", "/nothing"}) {
    EXPECT_EQ(Send(RequestOf("HEAD", target)).status, Get(target).status) << target;
    for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "get", ""}) {
      const Answer answer = Send(RequestOf(method, target));
      EXPECT_EQ(answer.status, 405) << method << " " << target;
      EXPECT_EQ(HeaderOf(answer, "Allow"), "GET, HEAD");
      EXPECT_THAT(ErrorIn(answer), HasSubstr("GET, HEAD"));
    }
  }
  for (const char* method : {"GET", "HEAD", "PUT", "DELETE"}) {
    const Answer answer = Send(RequestOf(method, "/api/v1/hand_load"));
    EXPECT_EQ(answer.status, 405) << method;
    EXPECT_EQ(HeaderOf(answer, "Allow"), "POST") << method;
  }
  EXPECT_EQ(refusals_["bad method"], 5 * 7 + 4);
}

TEST_F(RouterTest, RejectsInvalidAddressesBeforeRouting) {
  for (const std::string& target :
       {std::string(), std::string("app.js"), std::string("http://localhost/"),
        std::string("/../index.html"), std::string("/%2e%2e/index.html"), std::string("/%"),
        std::string("/a%00"), "/" + std::string(kMaxTargetBytes, 'a')}) {
    const Answer answer = Get(target);
    EXPECT_EQ(answer.status, 400) << target;
    EXPECT_FALSE(ErrorIn(answer).empty()) << target;
    EXPECT_EQ(Router(SiteOf()).RefuseWebSocket(RequestOf("GET", target)).value_or(Answer()).status,
              400)
        << target;
  }
  EXPECT_EQ(Get("/" + std::string(kMaxTargetBytes - 1, 'a')).status, 404) << "just short enough";
  EXPECT_EQ(refusals_["bad address"], 2 * 8);
}

TEST_F(RouterTest, SendsAFileUnlessTheClientHasIt) {
  const Answer first = Get("/app.js?v=2");
  EXPECT_EQ(first.file.value_or(""), web_ / "app.js");
  const std::string tag = HeaderOf(first, "ETag");
  EXPECT_FALSE(tag.empty());
  Request again = RequestOf("GET", "/app.js");
  again.if_none_match = tag;
  EXPECT_EQ(Send(again).status, 304);
  EXPECT_FALSE(Send(again).file);
  EXPECT_EQ(HeaderOf(Send(again), "ETag"), tag);
  WriteText(web_ / "app.js", "start(2);  // longer");
  EXPECT_EQ(Send(again).status, 200);
  fs::remove(web_ / "app.js");
  EXPECT_EQ(Send(again).status, 404) << "it was there at the start";
}

TEST_F(RouterTest, ServesMeshesOfTheNewestModelUpToALimit) {
  EXPECT_EQ(Get("/api/v1/mesh/0/7/0").status, 404) << "no state yet";
  PublishPeople(2);
  EXPECT_EQ(Get("/api/v1/mesh/0/7/0").body, "solid pelvis");
  EXPECT_EQ(Get("/api/v1/mesh/1/7/0").body, "solid pelvis");
  for (const char* target :
       {"/api/v1/mesh/2/7/0", "/api/v1/mesh/2/6/0", "/api/v1/mesh/0/8/0", "/api/v1/mesh/0/7/1",
        "/api/v1/mesh/0/7/9999", "/api/v1/mesh/18446744073709551615/7/0",
        "/api/v1/mesh/4294967296/7/0"}) {
    const Answer answer = Get(target);
    EXPECT_EQ(answer.status, 404) << target;
    EXPECT_THAT(ErrorIn(answer), HasSubstr("does not contain this STL file")) << target;
  }
  for (const char* target :
       {"/api/v1/mesh/0/7", "/api/v1/mesh/0/7/0/0", "/api/v1/mesh/0/7/", "/api/v1/mesh/a/7/0",
        "/api/v1/mesh/-0/7/0", "/api/v1/mesh/+0/7/0", "/api/v1/mesh/0x0/7/0",
        "/api/v1/mesh/0/7/0.0", "/api/v1/mesh/18446744073709551616/7/0"}) {
    EXPECT_THAT(ErrorIn(Get(target)), HasSubstr("/api/v1/mesh/{person}/{revision}/{number}"))
        << target;
  }
  fs::resize_file(meshes_ / "pelvis.stl", kLargestMesh);
  EXPECT_EQ(Get("/api/v1/mesh/0/7/0").status, 200);
  fs::resize_file(meshes_ / "pelvis.stl", kLargestMesh + 1);
  EXPECT_EQ(Get("/api/v1/mesh/0/7/0").status, 404);
  fs::remove(meshes_ / "pelvis.stl");
  fs::create_directory(meshes_ / "pelvis.stl");
  EXPECT_EQ(Get("/api/v1/mesh/0/7/0").status, 404) << "a folder";
}

// Revisions begin at 1 in each process.
TEST_F(RouterTest, SendsAMeshAgainOnlyIfItIsThatOfAnotherBody) {
  PublishPeople(1);
  const Answer first = Get("/api/v1/mesh/0/7/0");
  const std::string tag = HeaderOf(first, "ETag");
  EXPECT_FALSE(tag.empty());
  Request again = RequestOf("GET", "/api/v1/mesh/0/7/0");
  again.if_none_match = tag;
  const Answer same = Send(again);
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(same.body, "");
  EXPECT_EQ(HeaderOf(same, "ETag"), tag);
  WriteText(meshes_ / "pelvis.stl", "solid PELVIS");  // after a restart, with another person
  EXPECT_EQ(Send(again).status, 200);
  EXPECT_EQ(Send(again).body, "solid PELVIS");
}

TEST_F(RouterTest, AcceptsSnapshotSizesFrom16To4096) {
  const Answer plain = Get("/api/v1/snapshot.png");
  ASSERT_TRUE(plain.snapshot);
  EXPECT_EQ(plain.snapshot->camera, "");
  EXPECT_EQ(plain.snapshot->width, 1280);
  EXPECT_EQ(plain.snapshot->height, 720);
  const Answer asked = Get("/api/v1/snapshot.png?camera=top&width=16&height=4096&t=99");
  ASSERT_TRUE(asked.snapshot);
  EXPECT_EQ(asked.snapshot->camera, "top");
  EXPECT_EQ(asked.snapshot->width, 16);
  EXPECT_EQ(asked.snapshot->height, 4096);
  EXPECT_FALSE(asked.snapshot->is_dark);
  EXPECT_TRUE(Get("/api/v1/snapshot.png?theme=dark").snapshot->is_dark);
  EXPECT_FALSE(Get("/api/v1/snapshot.png?theme=light").snapshot->is_dark);
  for (const char* query :
       {"width=15", "width=4097", "height=15", "height=4097", "width=-64", "width=64.0",
        "width=", "width", "height=99999999999", "size=64x64", "theme=pink"}) {
    const Answer answer = Get(std::string("/api/v1/snapshot.png?") + query);
    EXPECT_EQ(answer.status, 400) << query;
    EXPECT_FALSE(answer.snapshot) << query;
    EXPECT_THAT(ErrorIn(answer), HasSubstr("from 16 to 4096")) << query;
  }
  EXPECT_THAT(ErrorIn(Get("/api/v1/snapshot.png?camera=fron")),
              AllOf(HasSubstr("camera=fron"), HasSubstr("expected front")));
  EXPECT_EQ(refusals_["bad snapshot"], 12);
}

TEST_F(RouterTest, HasNoSnapshotWithoutARenderer) {
  Router::Site site = SiteOf();
  site.has_pictures = false;
  const Answer answer = Router(site).Route(RequestOf("GET", "/api/v1/snapshot.png"));
  EXPECT_EQ(answer.status, 503);
  EXPECT_FALSE(answer.snapshot);
  EXPECT_THAT(refusals_, UnorderedElementsAre(Pair("no renderer", 1)));
}

TEST_F(RouterTest, RequiresAnUpgradeAtTheWebSocketAddress) {
  const Answer answer = Get("/api/v1/ws");
  EXPECT_EQ(answer.status, 426);
  EXPECT_EQ(HeaderOf(answer, "Upgrade"), "websocket");
  const Router router(SiteOf());
  EXPECT_FALSE(router.RefuseWebSocket(RequestOf("GET", "/api/v1/ws")));
  EXPECT_FALSE(router.RefuseWebSocket(RequestOf("GET", "/api/v1/ws?t=1")));
  const auto elsewhere = router.RefuseWebSocket(RequestOf("GET", "/"));
  ASSERT_TRUE(elsewhere);
  EXPECT_EQ(elsewhere->status, 404);
  EXPECT_THAT(ErrorIn(*elsewhere), HasSubstr("/api/v1/ws"));
}

TEST_F(RouterTest, NamesTheNewAddressAtEveryOldOne) {
  for (const auto& [old, now] :
       std::map<std::string, std::string>{{"/api/state", "/api/v1/state"},
                                          {"/api/mesh/0/7/0", "/api/v1/mesh/0/7/0"},
                                          {"/api/hand_load", "/api/v1/hand_load"},
                                          {"/snapshot.png?camera=front", "/api/v1/snapshot.png"},
                                          {"/ws", "/api/v1/ws"}}) {
    for (const char* method : {"GET", "POST"}) {
      const Answer answer = Send(RequestOf(method, old));
      EXPECT_EQ(answer.status, 404) << old;
      EXPECT_THAT(ErrorIn(answer), HasSubstr("the address is now " + now + ";")) << method;
    }
  }
  EXPECT_EQ(refusals_["old address"], 10);
}

TEST_F(RouterTest, OpensTheWebSocketForClientsOfItsVersionOnly) {
  const Router router(SiteOf());
  Request request = RequestOf("GET", "/api/v1/ws");
  const std::string ours = SocketProtocol();
  EXPECT_EQ(nlohmann::json::parse(Get("/api/v1/session").body).at("socket"), ours);
  for (const std::string& offered :
       {std::string(), ours, ours + ", kinescope.v99", "kinescope.v99 ,  " + ours}) {
    request.socket_protocols = offered;
    EXPECT_FALSE(router.RefuseWebSocket(request)) << offered;
  }
  for (const char* offered : {"kinescope.v99", "chat", "kinescope.v", ",", "kinescope.v1, "}) {
    request.socket_protocols = offered;
    const auto refusal = router.RefuseWebSocket(request);
    ASSERT_TRUE(refusal) << offered;
    EXPECT_EQ(refusal->status, 400) << offered;
    EXPECT_THAT(ErrorIn(*refusal), AllOf(HasSubstr(offered), HasSubstr(ours)));
  }
  EXPECT_EQ(refusals_["other protocol"], 5);
}

TEST_F(RouterTest, OpensTheWebSocketForItsOwnPageOnly) {
  const Router router(SiteOf());
  Request request = RequestOf("GET", "/api/v1/ws");
  request.origin = "http://localhost:8080";
  EXPECT_FALSE(router.RefuseWebSocket(request));
  for (const char* origin : {"http://localhost:8081", "http://evil.example", "null"}) {
    request.origin = origin;
    const auto refusal = router.RefuseWebSocket(request);
    ASSERT_TRUE(refusal) << origin;
    EXPECT_EQ(refusal->status, 403) << origin;
  }
  request.origin = "http://evil.example";
  request.host = "evil.example";
  EXPECT_EQ(router.RefuseWebSocket(request).value_or(Answer()).status, 403) << "a name for us";
  EXPECT_EQ(refusals_["foreign origin"], 3);
  EXPECT_EQ(refusals_["unknown host"], 1);
}

TEST_F(RouterTest, RequiresTheTokenAtEveryAddress) {
  PublishPeople(1);
  Router::Site site = SiteOf();
  site.tokens.of_operator = "s3cret";
  const Router router(site);
  for (const char* target :
       {"/", "/api/v1/state", "/api/v1/mesh/0/7/0", "/api/v1/snapshot.png", "/api/v1/ws", "/no"}) {
    for (const char* query : {"", "?token=", "?token=s3cre", "?token=s3cretx", "?Token=s3cret"}) {
      const Answer answer = router.Route(RequestOf("GET", std::string(target) + query));
      EXPECT_EQ(answer.status, 401) << target << query;
      EXPECT_EQ(HeaderOf(answer, "Set-Cookie"), "") << target << query;
    }
    const Answer by_query = router.Route(RequestOf("GET", std::string(target) + "?token=s3cret"));
    EXPECT_NE(by_query.status, 401) << target;
    EXPECT_EQ(HeaderOf(by_query, "Set-Cookie"),
              std::string(kCookie) + "=s3cret; Path=/; HttpOnly; SameSite=Strict");
    Request by_cookie = RequestOf("GET", target);
    by_cookie.cookies = std::string("other=1; ") + kCookie + "=s3cret";
    EXPECT_NE(router.Route(by_cookie).status, 401) << target;
    EXPECT_EQ(HeaderOf(router.Route(by_cookie), "Set-Cookie"), "") << "it is there already";
  }
  Request post = PostOf(kFiveInTheRightHand);
  EXPECT_EQ(router.Route(post).status, 401);
  EXPECT_THAT(held_, IsEmpty());
  post.target += "?token=s3cret";
  EXPECT_EQ(router.Route(post).status, 200);
  EXPECT_EQ(router.RefuseWebSocket(RequestOf("GET", "/api/v1/ws")).value_or(Answer()).status, 401);
  EXPECT_FALSE(router.RefuseWebSocket(RequestOf("GET", "/api/v1/ws?token=s3cret")));
}

TEST_F(RouterTest, AcceptsABearerTokenWithoutSettingACookie) {
  Router::Site site = SiteOf();
  site.tokens.of_operator = "s3cret";
  Request request = RequestOf("GET", "/api/v1/snapshot.png");
  request.authorization = "Bearer s3cret";
  EXPECT_EQ(Router(site).Route(request).status, 200);
  EXPECT_EQ(HeaderOf(Router(site).Route(request), "Set-Cookie"), "");
  request.authorization = "Bearer wrong";
  EXPECT_EQ(Router(site).Route(request).status, 401);
  EXPECT_EQ(HeaderOf(Router(site).Route(request), "WWW-Authenticate"), "Bearer");
}

TEST_F(RouterTest, SetsASecureCookieBehindATlsProxy) {
  Router::Site site = SiteOf();
  site.tokens.of_operator = "s3cret";
  Request request = RequestOf("GET", "/?token=s3cret");
  request.is_encrypted = true;
  EXPECT_THAT(HeaderOf(Router(site).Route(request), "Set-Cookie"), HasSubstr("; Secure"));
  request.is_encrypted = false;
  EXPECT_THAT(HeaderOf(Router(site).Route(request), "Set-Cookie"),
              ::testing::Not(HasSubstr("Secure")));
}

TEST_F(RouterTest, SlowsDownWrongTokensButNeverTheRightOne) {
  const Router router(GuardedSite());
  const auto status = [&](const std::string& token, const std::string& address) {
    Request request = RequestOf("GET", "/?token=" + token);
    request.address = address;
    return router.Route(request).status;
  };
  for (std::size_t i = 0; i < GuessGuard::kPerMinute; ++i) {
    EXPECT_EQ(status("guess" + std::to_string(i), "10.0.0.7"), 401) << i;
  }
  EXPECT_EQ(status("another", "10.0.0.7"), 429);
  EXPECT_EQ(status("s3cret", "10.0.0.7"), 200) << "others do not lock out the owner of the token";
  EXPECT_EQ(status("guess3", "10.0.0.7"), 401) << "the same again tells nothing new";
  EXPECT_EQ(status("s3cret", "10.0.0.8"), 200);
  Request socket = RequestOf("GET", "/api/v1/ws?token=s3cret");
  socket.address = "10.0.0.7";
  EXPECT_FALSE(router.RefuseWebSocket(socket));
}

TEST_F(RouterTest, CountsEveryTokenOfARequestAsAGuessUnlessOneIsRight) {
  const Router router(GuardedSite());
  Request request = RequestOf("GET", "/");
  std::string wrong;
  for (std::size_t i = 0; i < 2 * GuessGuard::kPerMinute; ++i) {
    wrong += std::string(kCookie) + "=guess" + std::to_string(i) + "; ";
  }
  request.cookies = wrong + kCookie + "=s3cret";
  EXPECT_EQ(router.Route(request).status, 200);
  Request other = RequestOf("GET", "/?token=mistyped");
  EXPECT_EQ(router.Route(other).status, 401) << "nothing was counted so far";
  request.cookies = wrong;
  EXPECT_EQ(router.Route(request).status, 429);
}

// A page of another site can make the browser of a user send any token.
TEST_F(RouterTest, CountsNoTokensThatAnotherSiteMakesABrowserSend) {
  const Router router(GuardedSite());
  for (std::size_t i = 0; i < 2 * GuessGuard::kPerMinute; ++i) {
    const std::string query = "?token=guess" + std::to_string(i);
    Request image = RequestOf("GET", "/api/v1/snapshot.png" + query);
    image.sec_fetch_site = "cross-site";
    EXPECT_EQ(router.Route(image).status, 403);
    Request script = RequestOf("GET", "/app.js" + query);
    script.sec_fetch_site = "same-site";
    EXPECT_EQ(router.Route(script).status, 401);
    Request socket = RequestOf("GET", "/api/v1/ws" + query);
    socket.origin = "http://evil.example";
    const auto refusal = router.RefuseWebSocket(socket);
    ASSERT_TRUE(refusal);
    EXPECT_EQ(refusal->status, 403);
    EXPECT_THAT(ErrorIn(*refusal), AllOf(HasSubstr("evil.example"), HasSubstr("localhost:8080")));
  }
  EXPECT_EQ(router.Route(RequestOf("GET", "/?token=mistyped")).status, 401);
}

TEST_F(RouterTest, RejectsCostlyRequestsOfOtherSites) {
  PublishPeople(1);
  for (const char* target : {"/api/v1/snapshot.png", "/api/v1/model", "/api/v1/mesh/0/7/0"}) {
    Request request = RequestOf("GET", target);
    for (const char* site : {"", "none", "same-origin"}) {
      request.sec_fetch_site = site;
      EXPECT_EQ(Send(request).status, 200) << target << " " << site;
    }
    for (const char* site : {"cross-site", "same-site"}) {
      request.sec_fetch_site = site;
      const Answer answer = Send(request);
      EXPECT_EQ(answer.status, 403) << target << " " << site;
      EXPECT_THAT(ErrorIn(answer), HasSubstr(site));
    }
  }
  Request link = RequestOf("GET", "/");
  link.sec_fetch_site = "cross-site";
  EXPECT_EQ(Send(link).status, 200) << "a link to the page";
  EXPECT_EQ(refusals_["another site"], 6);
}

TEST_F(RouterTest, RequiresMoreThanACookieForASnapshotWithoutSecFetchSite) {
  Router::Site site = SiteOf();
  site.tokens.of_operator = "s3cret";
  const Router router(site);
  Request request = RequestOf("GET", "/api/v1/snapshot.png");
  request.cookies = std::string(kCookie) + "=s3cret";
  EXPECT_EQ(router.Route(request).status, 403) << "an image in a page on another port";
  Request from_page = request, by_token = request, over_tls = request;
  from_page.page_header = "1";
  EXPECT_EQ(router.Route(from_page).status, 200);
  by_token.target += "?token=s3cret";
  EXPECT_EQ(router.Route(by_token).status, 200);
  over_tls.sec_fetch_site = "same-origin";
  EXPECT_EQ(router.Route(over_tls).status, 200);
  Request image = request, link = request;
  image.accept = "image/avif,image/webp,*/*;q=0.8";
  EXPECT_EQ(router.Route(image).status, 403);
  link.accept = "text/html,application/xhtml+xml,*/*;q=0.8";
  EXPECT_EQ(router.Route(link).status, 200) << "the link of the page without scripts";
}

TEST_F(RouterTest, ServesOnlyThisMachineWithoutAToken) {
  Request request = RequestOf("GET", "/api/v1/state");
  for (const char* host : {"", "example.org", "192.168.1.2:8080", "localhost.example.org"}) {
    request.host = host;
    EXPECT_EQ(Send(request).status, 403) << host;
  }
  for (const char* host : {"localhost", "127.0.0.1:8080", "127.1.2.3", "[::1]:8080"}) {
    request.host = host;
    EXPECT_EQ(Send(request).status, 200) << host;
  }
  EXPECT_EQ(refusals_["unknown host"], 4);
}

TEST_F(RouterTest, AppliesAHandLoadToTheGivenPerson) {
  PublishPeople(1);
  const Answer alone = Send(PostOf(kFiveInTheRightHand));
  EXPECT_EQ(alone.status, 200) << alone.body;
  EXPECT_EQ(nlohmann::json::parse(alone.body),
            (nlohmann::json{{"person", 0}, {"right_kg", 5}, {"left_kg", 0}, {"both_kg", 0}}));
  EXPECT_EQ(held_.at(0).mass_kg[urdf::kRight], 5);
  PublishPeople(2);
  EXPECT_EQ(Send(PostOf(kFiveInTheRightHand)).status, 400);
  const Answer second = Send(PostOf(R"({"person": 1, "both_kg": 3})"));
  EXPECT_EQ(second.status, 200) << second.body;
  EXPECT_EQ(held_.at(1).both_kg, 3);
  Request with_charset = PostOf(R"({"person": 1, "left_kg": 2})");
  with_charset.content_type = "application/json; charset=utf-8";
  with_charset.origin = "http://localhost:8080";
  EXPECT_EQ(Send(with_charset).status, 200);
}

TEST_F(RouterTest, RejectsAnInvalidHandLoadWithTheReason) {
  EXPECT_EQ(Send(PostOf(kFiveInTheRightHand)).status, 409) << "nobody is here yet";
  PublishPeople(1);
  const auto expect_refusal = [&](const Request& request, int status, const std::string& what) {
    const Answer answer = Send(request);
    EXPECT_EQ(answer.status, status) << answer.body;
    EXPECT_THAT(ErrorIn(answer), HasSubstr(what));
  };
  Request foreign = PostOf(kFiveInTheRightHand);
  foreign.origin = "http://evil.example";
  expect_refusal(foreign, 403, "page of this server");
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "application/jso",
                           "application/jsonx"}) {
    Request form = PostOf(kFiveInTheRightHand);
    form.content_type = type;
    expect_refusal(form, 415, "application/json");
  }
  expect_refusal(PostOf("{"), 400, "right_kg");
  expect_refusal(PostOf(R"({"right": 5})"), 400, "right_kg");
  expect_refusal(PostOf(R"({"right_kg": 101})"), 400, "nobody holds that");
  expect_refusal(PostOf(R"({"person": 3, "right_kg": 5})"), 404, "3");
  Router::Site site = SiteOf();
  site.set_hand_load = nullptr;
  EXPECT_EQ(Router(site).Route(PostOf(kFiveInTheRightHand)).status, 503);
  EXPECT_THAT(held_, IsEmpty());
  EXPECT_EQ(refusals_["bad hand load"], 3);
  EXPECT_EQ(refusals_["bad content type"], 5);
  EXPECT_EQ(refusals_["no person"], 2);
}

TEST(ErrorAnswer, IsOneJsonObjectForAnyReason) {
  const Answer answer = ErrorAnswer(418, "\"quotes\"\nand \xff bytes");
  EXPECT_EQ(answer.status, 418);
  EXPECT_EQ(answer.content_type, "application/json");
  EXPECT_THAT(ErrorIn(answer), HasSubstr("\"quotes\"\nand "));
}

}  // namespace
}  // namespace kinescope::http::testing
