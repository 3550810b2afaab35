#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

#include "server/http/connections.h"
#include "server/http/guess_guard.h"
#include "tests/folders.h"
#include "tests/server/http/test_server.h"
#include "tests/temp_folder.h"

namespace kinescope::http::testing {
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string FileText(const std::string& name) {
  std::ifstream file(kinescope::testing::InSourceTree(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(HttpServer, ServesThePageUnchangedFromItsFolder) {
  const TestServer site;
  const Response page = site.Get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, FileText("web/index.html"));
  EXPECT_EQ(page.headers.at("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(page.headers.at("cache-control"), "no-cache");
  EXPECT_EQ(site.Get("/app.js?v=2").body, FileText("web/app.js"));
  EXPECT_EQ(site.Get("/app.js").headers.at("content-type"), "text/javascript; charset=utf-8");
}

TEST(HttpServer, ForbidsThePageToLoadFromOtherSites) {
  const TestServer site;
  for (const char* target : {"/", "/app.js", "/api/v1/state", "/nothing"}) {
    const Response response = site.Get(target);
    EXPECT_THAT(response.headers.at("content-security-policy"), StartsWith("default-src 'none'"));
    EXPECT_THAT(response.headers.at("content-security-policy"), Not(HasSubstr("http")));
    EXPECT_EQ(response.headers.at("x-content-type-options"), "nosniff");
    EXPECT_EQ(response.headers.at("referrer-policy"), "no-referrer");
  }
}

TEST(HttpServer, SendsAFileAgainOnlyWhenItChanged) {
  const TestServer site;
  const std::string tag = site.Get("/app.js").headers.at("etag");
  const Response again = site.Get("/app.js", {{"If-None-Match", tag}});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.body, "");
  EXPECT_EQ(site.Get("/app.js", {{"If-None-Match", "\"other\""}}).status, 200);
}

TEST(HttpServer, AnswersHeadWithTheSizeOnly) {
  const TestServer site;
  const Response head = Fetch(site.server.port(), "/app.js", {}, "HEAD");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.headers.at("content-length"), std::to_string(FileText("web/app.js").size()));
  EXPECT_EQ(Fetch(site.server.port(), "/api/v1/state", {}, "HEAD").status, 200);
}

TEST(HttpServer, AnswersSeveralRequestsOnOneConnection) {
  const TestServer site;
  const std::string host = "Host: localhost\r\n";
  const std::string answer =
      Exchange(site.server.port(),
               "GET /api/v1/cameras HTTP/1.1\r\n" + host + "\r\nGET /api/v1/state HTTP/1.1\r\n" +
                   host + "Connection: close\r\n\r\n",
               1 << 20);
  EXPECT_THAT(answer, HasSubstr("three_quarter"));
  EXPECT_THAT(answer, HasSubstr("liveness"));
}

TEST(HttpServer, RejectsEveryPathOutOfTheFolder) {
  const TestServer site;
  for (const std::string& target : {"/../server/http/server.h"s,
                                    "/%2e%2e/server/http/server.h"s,
                                    "/..%2fserver/http/server.h"s,
                                    "/%2e%2e%2fserver%2fhttp%2fserver.h"s,
                                    "/lib/../../server/http/server.h"s,
                                    "/./app.js"s,
                                    "//app.js"s,
                                    "/..%5cserver"s,
                                    "/app.js%00"s,
                                    "/%00"s,
                                    "/etc/passwd"s,
                                    "//etc/passwd"s,
                                    "/%2fetc%2fpasswd"s,
                                    "/package.json"s,
                                    "/package-lock.json"s,
                                    "/.npmrc"s,
                                    "/CMakeLists.txt"s,
                                    "/node_modules/three/package.json"s,
                                    "/node_modules/three/build/three.module.js"s,
                                    "/lib/three/../three/three.module.js"s,
                                    "/lib/three/three.cjs"s,
                                    "/file:///etc/passwd"s,
                                    "/app.js/"s,
                                    "/APP.JS"s,
                                    "/api/v1/mesh/0/7/0"s,
                                    "/api/v1/mesh/0/7/../../../etc/passwd"s,
                                    "/api/v1/mesh/0/7/%2e%2e"s,
                                    "/api/v1/mesh/-1/7/0"s,
                                    "/api/v1/mesh/0/7"s,
                                    "/api/v1/mesh/0/7/0/0"s,
                                    "/api/v1/mesh/99999999999999999999/7/0"s,
                                    "/api/v1/mesh/0x0/7/0"s}) {
    const Response response = site.Get(target);
    EXPECT_TRUE(response.status == 400 || response.status == 404)
        << target << ": " << response.status;
    EXPECT_FALSE(response.json().at("error").get<std::string>().empty()) << target;
  }
}

TEST(HttpServer, AnswersInvalidRequestsAndContinues) {
  const TestServer site;
  const int port = site.server.port();
  EXPECT_THAT(Exchange(port, "hello\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(Exchange(port, "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(10000, 'a') +
                                 "\r\n\r\n"),
              StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(OpenConnection(port, "GET / HTTP/1.1\r\nX: " + std::string(8192, 'a')).ReadToEnd(),
              HasSubstr("more than 8192 bytes; send fewer cookies or shorter headers"));
  EXPECT_THAT(
      OpenConnection(port, "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4097\r\n\r\n")
          .ReadToEnd(),
      HasSubstr("body of 4097 bytes: at most 4096 are accepted; send a smaller one"));
  EXPECT_THAT(
      Exchange(port, "GET /" + std::string(3000, 'a') + " HTTP/1.1\r\nHost: localhost\r\n\r\n"),
      StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(
      Exchange(port, "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9999999\r\n\r\n"),
      StartsWith("HTTP/1.1 413"));
  EXPECT_EQ(Exchange(port, std::string("\0\0\0\0", 4) + "\r\n\r\n").substr(0, 12), "HTTP/1.1 400");
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "NONSENSE"}) {
    const Response response = Fetch(port, "/", {}, method);
    EXPECT_EQ(response.status, 405) << method;
    EXPECT_EQ(response.headers.at("allow"), "GET, HEAD");
  }
  EXPECT_EQ(site.Get("/").status, 200);
  EXPECT_GE(site.HttpCounters()["rejected"]["bad method"], 5);
}

TEST(HttpServer, ServesTheNewestState) {
  TestServer site;
  EXPECT_EQ(site.Get("/api/v1/state").json()["liveness"], "no data");
  site.PublishState(12);
  const Response state = site.Get("/api/v1/state");
  EXPECT_EQ(state.json()["state_number"], 12);
  EXPECT_EQ(state.headers.at("cache-control"), "no-store");
  EXPECT_EQ(site.Get("/api/v1/model").json()["people"][0]["revision"], 7);
  EXPECT_EQ(site.Get("/api/v1/cameras").json()["cameras"].size(), 7u);
}

TEST(HttpServer, ServesOnlyMeshesOfTheModel) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "kinescope_meshes";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "pelvis.stl") << "solid pelvis";
  TestServer site("", true, folder.string());
  EXPECT_EQ(site.Get("/api/v1/mesh/0/7/0").status, 404) << "no state yet";
  site.PublishState(1);
  const auto model = site.Get("/api/v1/model").json();
  const std::string url = model["people"][0]["links"][0]["visuals"][0]["mesh"];
  EXPECT_EQ(url, "/api/v1/mesh/0/7/0");
  const Response mesh = site.Get(url);
  EXPECT_EQ(mesh.status, 200);
  EXPECT_EQ(mesh.body, "solid pelvis");
  EXPECT_EQ(mesh.headers.at("content-type"), "model/stl");
  EXPECT_EQ(site.Get("/api/v1/mesh/0/7/1").status, 404) << "named, but not there";
  const Response earlier = site.Get("/api/v1/mesh/0/6/0");
  EXPECT_EQ(earlier.status, 307);
  EXPECT_EQ(earlier.headers.at("location"), "../7/0");
}

TEST(HttpServer, AddsItsOwnPartToTheDiagnostics) {
  const TestServer site;
  site.Get("/nothing");
  const auto diagnostics = site.Get("/api/v1/diagnostics").json();
  EXPECT_EQ(diagnostics["source"]["datagrams"], 5);
  EXPECT_EQ(diagnostics["http"]["rejected"]["unknown address"], 1);
  EXPECT_EQ(diagnostics["http"]["clients"].size(), 0u);
}

TEST(HttpServer, SurvivesDiagnosticsThatFail) {
  Latest<SceneState> states;
  Latest<Picture> pictures;
  const HttpServer broken(TestServer::MakeConfig(""), states, pictures, nullptr,
                          []() -> std::string { throw std::runtime_error("no diagnosis"); });
  EXPECT_EQ(Fetch(broken.port(), "/api/v1/diagnostics").status, 500);
  EXPECT_EQ(Fetch(broken.port(), "/api/v1/state").status, 200);
  Latest<SceneState> other_states;
  Latest<Picture> other_pictures;
  const HttpServer odd(TestServer::MakeConfig(""), other_states, other_pictures, nullptr,
                       [] { return std::string("no JSON"); });
  EXPECT_THAT(Fetch(odd.port(), "/api/v1/diagnostics").json()["error"].get<std::string>(),
              HasSubstr("not JSON"));
}

TEST(HttpServer, RequiresTheTokenForEveryRoute) {
  const TestServer site("s3cret-of-the-lab");
  EXPECT_THAT(site.server.url(), HasSubstr("/?token=s3cret-of-the-lab"));
  const std::string cookie =
      "kinescope_" + std::to_string(site.server.port()) + "=s3cret-of-the-lab";
  for (const char* target : {"/", "/app.js", "/api/v1/state", "/api/v1/model", "/api/v1/cameras",
                             "/api/v1/diagnostics", "/api/v1/snapshot.png", "/api/v1/mesh/0/7/0",
                             "/lib/three/three.module.js", "/nothing", "/api/v1/ws"}) {
    EXPECT_EQ(site.Get(target).status, 401) << target;
    EXPECT_EQ(site.Get(target + "?token=wrong"s).status, 401) << target;
    EXPECT_EQ(site.Get(target, {{"Cookie", "kinescope_1=s3cret-of-the-lab"}}).status, 401)
        << target;
    EXPECT_NE(site.Get(target, {{"Cookie", cookie}}).status, 401) << target;
    EXPECT_NE(site.Get(target + "?token=s3cret-of-the-lab"s).status, 401) << target;
  }
  const Response first = site.Get("/?token=s3cret-of-the-lab");
  EXPECT_EQ(first.headers.at("set-cookie"), cookie + "; Path=/; HttpOnly; SameSite=Strict");
  EXPECT_EQ(site.Get("/", {{"Cookie", cookie}}).headers.count("set-cookie"), 0u);
}

TEST(HttpServer, AcceptsAnyHostNameWithAToken) {
  const TestServer site("s3cret-of-the-lab");
  EXPECT_EQ(site.Get("/?token=s3cret-of-the-lab", {{"Host", "lab.example:8080"}}).status, 200);
}

TEST(HttpServer, AcceptsOnlyNamesOfThisMachineWithoutAToken) {
  const TestServer site;
  EXPECT_EQ(site.Get("/api/v1/state", {{"Host", "localhost:1234"}}).status, 200);
  EXPECT_EQ(site.Get("/api/v1/state", {{"Host", "evil.example"}}).status, 403);
  EXPECT_EQ(site.Get("/", {{"Host", "127.0.0.1.evil.example:80"}}).status, 403);
}

TEST(HttpServer, ReportsAPortInUseWithARemedy) {
  const TestServer site;
  HttpConfig config = TestServer::MakeConfig("");
  config.port = site.server.port();
  Latest<SceneState> states;
  Latest<Picture> pictures;
  try {
    const HttpServer second(config, states, pictures, nullptr, nullptr);
    FAIL() << "two servers on one port";
  } catch (const UsageError& error) {
    const std::string line = error.what();
    EXPECT_THAT(line, HasSubstr("127.0.0.1:" + std::to_string(config.port)));
    EXPECT_THAT(line, HasSubstr("choose another port"));
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

TEST(HttpServer, ReportsAnAddressThatThisMachineDoesNotHave) {
  HttpConfig config = TestServer::MakeConfig("0123456789abcdef");
  config.bind_ip = "192.0.2.1";  // for documents only: no machine has it
  try {
    const Listener listener(config);
    FAIL() << "an address of another machine";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), StartsWith("--bind_ip=192.0.2.1: "));
    EXPECT_THAT(error.what(), Not(HasSubstr("another port")));
  }
}

TEST(HttpServer, RejectsUnsafeAndInvalidConfigurations) {
  Latest<SceneState> states;
  Latest<Picture> pictures;
  const auto start = [&](const std::string& ip, const std::string& token, int port) {
    HttpConfig config = TestServer::MakeConfig(token);
    config.bind_ip = ip;
    config.port = port;
    const HttpServer server(config, states, pictures, nullptr, nullptr);
  };
  EXPECT_THROW(start("0.0.0.0", "", 0), UsageError);
  EXPECT_THROW(start("::", "", 0), UsageError);
  EXPECT_THROW(start("not.an.ip", "0123456789abcdef", 0), UsageError);
  EXPECT_THROW(start("127.0.0.1", "two words", 0), UsageError);
  EXPECT_THROW(start("127.0.0.1", "", 70000), UsageError);
  EXPECT_THROW(start("127.0.0.1", "", -1), UsageError);
  EXPECT_NO_THROW(start("0.0.0.0", "0123456789abcdef", 0));
}

TEST(HttpServer, RejectsAShortTokenAndOffersARandomOne) {
  HttpConfig config = TestServer::MakeConfig("0123456789abcde");
  config.token_origin = "--token_file=here";
  try {
    CheckConfig(config);
    FAIL() << "15 characters";
  } catch (const UsageError& error) {
    const std::string line = error.what();
    EXPECT_THAT(line, StartsWith("--token_file=here: "));
    EXPECT_EQ(line.find(config.token), std::string::npos) << "never the token itself";
    config.token = line.substr(line.rfind(' ') + 1);
    EXPECT_NO_THROW(CheckConfig(config)) << config.token;
  }
}

TEST(HttpServer, RejectsSeveralHosts) {
  const TestServer site;
  const int port = site.server.port();
  const std::string get = "GET /api/v1/state HTTP/1.1\r\n";
  EXPECT_THAT(Exchange(port, get + "Host: localhost\r\nHost: evil.example\r\n\r\n"),
              StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(Exchange(port, get + "\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(Exchange(port, get + "Host: localhost\r\n\r\n"), StartsWith("HTTP/1.1 200"));
}

TEST(HttpServer, AcceptsHeadersOfUpTo64Lines) {
  const TestServer site;
  const auto with_lines = [](int count) {
    std::string lines;
    for (int i = 1; i < count; ++i) lines += "X: " + std::to_string(i) + "\r\n";
    return "GET /api/v1/state HTTP/1.1\r\nHost: localhost\r\n" + lines + "\r\n";
  };
  EXPECT_THAT(Exchange(site.server.port(), with_lines(64)), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(Exchange(site.server.port(), with_lines(65)), StartsWith("HTTP/1.1 431"));
}

TEST(HttpServer, ServesOthersBesideConnectionsThatNeverFinishTheirRequest) {
  const TestServer site;
  std::vector<OpenConnection> slow;
  for (std::size_t i = 0; i < Connections::kMax + 44; ++i) {
    slow.emplace_back(site.server.port(), "GET / HTTP/1.1\r\nHost: localhost\r\n");
  }
  for (int i = 0; i < 20; ++i) EXPECT_EQ(site.Get("/api/v1/state").status, 200) << i;
  EXPECT_EQ(slow.front().ReadToEnd(), "") << "the oldest made room";
}

TEST(HttpServer, ServesOthersBesideConnectionsThatDoNotReadTheirAnswers) {
  const TestServer site;
  std::string requests;
  for (int i = 0; i < 200; ++i) requests += "GET /nothing HTTP/1.1\r\nHost: localhost\r\n\r\n";
  std::vector<OpenConnection> deaf;
  for (std::size_t i = 0; i < Connections::kMax; ++i) {
    const std::string from = "127.0.1." + std::to_string(1 + i / Connections::kMaxPerAddress);
    deaf.emplace_back(site.server.port(), requests, /*receive_buffer_bytes=*/2304, from);
  }
  for (int i = 0; i < 20; ++i) EXPECT_EQ(site.Get("/api/v1/state").status, 200) << i;
  EXPECT_EQ(Fetch(site.server.port(), "/api/v1/state", {}, "GET", "", "127.0.1.1").status, 200)
      << "one of an address that has used up its share";
}

TEST(HttpServer, ClosesFirstAConnectionWhoseLastTokenWasWrong) {
  const TestServer site("s3cret-of-the-lab");
  const std::string right = "/api/v1/diagnostics?token=s3cret-of-the-lab";
  const auto get = [](const std::string& target, const std::string& header = "") {
    return "GET " + target + " HTTP/1.1\r\nHost: localhost\r\n" + header + "\r\n";
  };
  std::vector<OpenConnection> all;
  for (std::size_t i = 0; i < Connections::kMaxPerAddress; ++i) {
    all.emplace_back(site.server.port(), get(right));
  }
  all.back().Send(get("/api/v1/diagnostics?token=wrong"));
  std::size_t asked = 0, requests = 0;
  while (requests < all.size() + 1 + asked) {
    ++asked;
    const Response answer = Fetch(site.server.port(), right, {}, "GET", "", "127.0.0.2");
    requests = answer.json()["http"]["requests"];
  }
  EXPECT_EQ(site.Get(right).status, 200);
  all.front().Send(get(right, "Connection: close\r\n"));
  EXPECT_THAT(all.front().ReadToEnd(), HasSubstr("Connection: close")) << "the oldest is open";
}

TEST(HttpServer, LimitsTheTimeOfAWholeResponse) {
  PatienceLimits impatient;
  impatient.response = std::chrono::milliseconds(20);
  impatient.write_window = std::chrono::hours(1);
  const kinescope::testing::TempFolder meshes;
  std::ofstream(meshes.path() / "pelvis.stl") << std::string(32u << 20, 'x');
  TestServer site("", true, meshes.path().string(), impatient);
  site.PublishState(1);
  OpenConnection deaf(site.server.port(),
                      "GET /api/v1/mesh/0/7/0 HTTP/1.1\r\nHost: localhost\r\n\r\n", 2304);
  while (site.HttpCounters()["rejected"].value("response not read", 0) < 1) {
  }
  EXPECT_LT(deaf.ReadToEnd().size(), 32u << 20);
}

TEST(HttpServer, DisconnectsClientsThatDoNotFinishTheirRequestInTime) {
  PatienceLimits impatient;
  impatient.header = impatient.body = impatient.next_request = std::chrono::milliseconds(20);
  const TestServer site("", true, "", impatient);
  const int port = site.server.port();
  EXPECT_EQ(OpenConnection(port, "").ReadToEnd(), "");
  EXPECT_EQ(OpenConnection(port, "GET / HTTP/1.1\r\nHost:").ReadToEnd(), "");
  EXPECT_EQ(OpenConnection(port,
                           "POST /api/v1/hand_load HTTP/1.1\r\nHost: localhost\r\n"
                           "Content-Type: application/json\r\nContent-Length: 20\r\n\r\n{")
                .ReadToEnd(),
            "");
  EXPECT_THAT(
      OpenConnection(port, "GET /api/v1/state HTTP/1.1\r\nHost: localhost\r\n\r\n").ReadToEnd(),
      StartsWith("HTTP/1.1 200"))
      << "and no second request";
}

TEST(HttpServer, AnswersRequestsThatArriveTogether) {
  const TestServer site;
  const std::string get = "GET /api/v1/state HTTP/1.1\r\nHost: localhost\r\n";
  OpenConnection client(site.server.port(), get + "\r\n" + get + "Connection: close\r\n\r\n");
  const std::string answers = client.ReadToEnd();
  EXPECT_NE(answers.find("HTTP/1.1 200", 1), std::string::npos) << answers;
}

TEST(HttpServer, SlowsDownAndReportsGuessesOfTheToken) {
  std::mutex mutex;
  std::vector<std::string> log;
  HttpConfig config = TestServer::MakeConfig("s3cret-of-the-lab");
  config.warn = [&](const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex);
    log.push_back(line);
  };
  Latest<SceneState> states;
  Latest<Picture> pictures;
  const HttpServer server(config, states, pictures, nullptr, nullptr);
  const std::int64_t before = MonotonicNanos();
  Response answer;
  for (std::size_t i = 0; i < GuessGuard::kPerMinute + 10 && answer.status != 429; ++i) {
    answer = Fetch(server.port(), "/?token=guess" + std::to_string(i));
  }
  EXPECT_EQ(answer.status, 429);
  const int wait_secs = std::stoi(answer.headers.at("retry-after"));
  EXPECT_GE(wait_secs, 59 - Secs(MonotonicNanos() - before)) << "a minute after the first guess";
  EXPECT_LE(wait_secs, 60);
  const std::lock_guard<std::mutex> lock(mutex);
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log.front(), "page: 1 wrong token from 127.0.0.1");
}

TEST(HttpServer, SlowsDownGuessesAlsoAfterTheRightTokenOnTheSameConnection) {
  const TestServer site("s3cret-of-the-lab");
  const auto get = [](const std::string& token, const std::string& header = "") {
    return "GET /api/v1/state?token=" + token + " HTTP/1.1\r\nHost: localhost\r\n" + header +
           "\r\n";
  };
  std::string requests = get("s3cret-of-the-lab");
  for (std::size_t i = 0; i < GuessGuard::kPerMinute + 10; ++i)
    requests += get("guess" + std::to_string(i));
  requests += get("s3cret-of-the-lab", "Connection: close\r\n");
  const std::string answers = OpenConnection(site.server.port(), requests).ReadToEnd();
  EXPECT_THAT(answers, HasSubstr("HTTP/1.1 429"));
  EXPECT_THAT(answers.substr(answers.rfind("HTTP/1.1")), StartsWith("HTTP/1.1 200"));
}

TEST(HttpServer, ReportsAUrlThatCanBeOpened) {
  Latest<SceneState> states;
  Latest<Picture> pictures;
  HttpConfig config = TestServer::MakeConfig("0123456789abcdef");
  config.bind_ip = "0.0.0.0";
  const HttpServer server(config, states, pictures, nullptr, nullptr);
  const std::string url = "http://localhost:" + std::to_string(server.port()) + "/?token=";
  EXPECT_EQ(server.url(), url + "0123456789abcdef");
  EXPECT_EQ(server.url_for_log(), url + "0123...");
}

}  // namespace
}  // namespace kinescope::http::testing
