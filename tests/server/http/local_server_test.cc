// The server of a page that a person steers a command with: who gets an answer, and who does not.
#include "server/http/local_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/system/errors.h"
#include "tests/server/http/test_client.h"
#include "tests/taken_port.h"

namespace kinescope::http::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class LocalServerTest : public ::testing::Test {
 protected:
  LocalServerTest() {
    thread_ = std::thread([this] {
      server_.Serve(
          [this](const LocalRequest& request) {
            const std::lock_guard<std::mutex> lock(mutex_);
            handled_.push_back((request.is_post ? "POST " : "GET ") + request.path + request.body);
            if (request.path == "/end") is_over_ = true;
            if (request.path == "/fail") throw std::runtime_error("the disk is full");
            return JsonAnswer(request.path == "/large" ? std::string(4 << 20, 'x') : "{}");
          },
          [this] { return is_over_.load(); });
    });
  }
  ~LocalServerTest() override {
    is_over_ = true;
    thread_.join();
  }

  int port() const { return server_.port(); }
  std::string own(const std::string& name = "127.0.0.1") const {
    return name + ":" + std::to_string(port());
  }
  Headers WithToken(Headers headers = {}) const {
    headers.emplace("Authorization", "Bearer " + server_.token());
    return headers;
  }
  Response Get(const std::string& path, const Headers& headers) const {
    return Fetch(port(), path, headers);
  }
  Response Post(const std::string& path, const Headers& headers,
                const std::string& body = "{}") const {
    return Fetch(port(), path, headers, "POST", body);
  }
  std::vector<std::string> Handled() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return handled_;
  }

  LocalServer server_{0, "--port"};
  std::thread thread_;
  std::atomic<bool> is_over_{false};
  std::mutex mutex_;
  std::vector<std::string> handled_;  // guarded by mutex_
};

TEST_F(LocalServerTest, ServesThoseWhoHaveItsUrlOrItsToken) {
  const std::string base = "http://" + own();
  ASSERT_THAT(server_.url(), StartsWith(base + "/?token="));
  EXPECT_EQ(Get(server_.url().substr(base.size()), {}).status, 200);
  EXPECT_EQ(Get("/state", WithToken({{"Host", own("localhost")}})).status, 200);
  EXPECT_EQ(Post("/do", WithToken({{"Origin", base}, {"Sec-Fetch-Site", "same-origin"}})).status,
            200);
  EXPECT_THAT(Handled(), ElementsAre("GET /", "GET /state", "POST /do{}"));
}

TEST_F(LocalServerTest, RefusesWhoeverDoesNotHaveTheToken) {
  const std::string wrong(32, '0');
  for (const Response& response :
       {Get("/", {}), Get("/?token=" + wrong, {}), Get("/", {{"Authorization", "Bearer " + wrong}}),
        Post("/do", {}), Post("/do", {{"Authorization", "Bearer " + wrong}}),
        Post("/do?token=" + server_.token(), {}),
        Get("/", {{"Cookie", "token=" + server_.token()}})}) {
    EXPECT_EQ(response.status, 401);
    EXPECT_THAT(response.body, HasSubstr("open the URL that the command has printed"));
  }
  EXPECT_THAT(Handled(), IsEmpty());
}

TEST_F(LocalServerTest, RefusesOtherNamesOfThisMachineThoughTheTokenIsRight) {
  for (const std::string& host :
       {std::string("evil.example"), own("evil.example"), own("127.0.0.2"), own("[::1]"),
        own("127.0.0.1.evil.example"), std::string("127.0.0.1"), std::string("localhost:1"),
        own("LOCALHOST.evil"), own("user@127.0.0.1")}) {
    EXPECT_EQ(Get("/", WithToken({{"Host", host}})).status, 403) << host;
    EXPECT_EQ(Post("/do", WithToken({{"Host", host}})).status, 403) << host;
  }
  EXPECT_THAT(Handled(), IsEmpty());
}

TEST_F(LocalServerTest, RefusesPagesOfOtherSitesThoughTheTokenIsRight) {
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("null"), "https://" + own(),
        "http://" + own("localhost"), std::string("http://127.0.0.1:1")}) {
    EXPECT_EQ(Post("/do", WithToken({{"Origin", origin}})).status, 403) << origin;
    EXPECT_EQ(Get("/", WithToken({{"Origin", origin}})).status, 403) << origin;
  }
  EXPECT_EQ(Post("/do", WithToken({{"Sec-Fetch-Site", "cross-site"}})).status, 403);
  EXPECT_THAT(Handled(), IsEmpty());
}

TEST_F(LocalServerTest, RefusesOtherMethodsPathsAndLargeBodies) {
  EXPECT_EQ(Fetch(port(), "/do", WithToken(), "OPTIONS").status, 405);
  EXPECT_EQ(Fetch(port(), "/do", WithToken(), "PUT", "{}").status, 405);
  EXPECT_EQ(Get("/%2e%2e/secret", WithToken()).status, 400);
  EXPECT_EQ(Post("/do", WithToken(), std::string(5000, 'x')).status, 413);
  EXPECT_THAT(Handled(), IsEmpty());
}

TEST_F(LocalServerTest, ServesOthersBesideClientsThatAreSilentOrDoNotRead) {
  std::vector<OpenConnection> idle;
  const std::string begin = "GET /large HTTP/1.1\r\nHost: " + own() + "\r\nAuthorization: Bearer " +
                            server_.token() + "\r\n";
  for (int i = 0; i < 20; ++i) {
    idle.emplace_back(port(), "");
    idle.emplace_back(port(), begin);
    idle.emplace_back(port(), begin + "\r\n", 4096);
  }
  EXPECT_EQ(Get("/", WithToken()).status, 200);
  EXPECT_EQ(Post("/do", WithToken()).status, 200);
}

TEST_F(LocalServerTest, TellsWhyItFailedAndGoesOn) {
  const Response failed = Post("/fail", WithToken());
  EXPECT_EQ(failed.status, 500);
  EXPECT_EQ(failed.json().at("error"), "the disk is full");
  EXPECT_EQ(Get("/", WithToken()).status, 200);
}

TEST_F(LocalServerTest, AnswersTheRequestThatEndsIt) {
  EXPECT_EQ(Post("/end", WithToken()).status, 200);
  thread_.join();
  thread_ = std::thread([] {});
}

TEST(LocalServer, ListensOnTheLoopbackAlone) {
  const LocalServer server(0, "--port");
  char line[8];
  std::snprintf(line, sizeof line, ":%04X ", static_cast<unsigned>(server.port()));
  std::ifstream table("/proc/net/tcp");
  std::vector<std::string> addresses;
  for (std::string row; std::getline(table, row);) {
    const std::size_t at = row.find(line);
    const bool is_listening = row.find(" 00000000:0000 0A ") != std::string::npos;
    if (is_listening && at != std::string::npos) addresses.push_back(row.substr(at - 8, 8));
  }
  EXPECT_THAT(addresses, ElementsAre("0100007F"));
}

TEST(LocalServer, NamesTheOptionOfAPortThatIsTaken) {
  const kinescope::testing::TakenPort taken(SOCK_STREAM);
  try {
    const LocalServer server(std::stoi(taken.number()), "--port");
    FAIL() << "it shares the port";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("127.0.0.1:" + taken.number()));
    EXPECT_THAT(error.what(), HasSubstr("choose another port with --port"));
  }
}

}  // namespace
}  // namespace kinescope::http::testing
