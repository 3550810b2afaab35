// The parts of `serve` together, in this process and without ROS. What it does for hours is tested
// with the program, in tests/system.
#include "server/app/serve/server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/system/errors.h"
#include "tests/captured_log.h"
#include "tests/server/http/test_client.h"
#include "tests/server/options_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using http::testing::Fetch;
using ::testing::HasSubstr;
using ::testing::Not;

ServeConfig ServeConfigOf(testing::Settings settings) {
  settings.insert(settings.end(), {{"source", "demo:t_pose"}, {"ros", "off"}});
  return MakeServeConfig(testing::With<ServeOptions>(settings), true);
}

int PortIn(const testing::CapturedLog& log) {
  const std::string text = log.text();
  const std::size_t page = text.find("page at http://127.0.0.1:");
  EXPECT_NE(page, std::string::npos) << text;
  return std::stoi(text.substr(text.find(':', page + 14) + 1));
}

TEST(Server, AnswersBeforeItRunsAndReportsNullForPartsThatAreOff) {
  const testing::CapturedLog log;
  const Server server(ServeConfigOf({{"http_port", "0"}, {"pictures", "off"}}));
  const int port = PortIn(log);
  const auto diagnostics = Fetch(port, "/api/v1/diagnostics").json();
  EXPECT_EQ(diagnostics.at("source").at("liveness"), "no data");
  EXPECT_TRUE(diagnostics.at("ros").is_null());
  EXPECT_TRUE(diagnostics.at("pictures").is_null());
  EXPECT_TRUE(diagnostics.at("view").is_null());
  EXPECT_EQ(Fetch(port, "/api/v1/snapshot.png").status, 503);
}

TEST(Server, LogsTheTokenWholeOnlyOnATerminal) {
  const testing::TempFolder folder;
  const std::string file = (folder.path() / "token").string();
  ServeConfig config =
      ServeConfigOf({{"http_port", "0"}, {"pictures", "off"}, {"token_file", file}});
  const std::string token = config.page->token;
  {
    const testing::CapturedLog log;
    const Server server(config);
    EXPECT_THAT(log.text(), HasSubstr("/?token=" + token.substr(0, 4) +
                                      "... (the token is "
                                      "shortened; to see it: cat " +
                                      file + ")"));
    EXPECT_THAT(log.text(), Not(HasSubstr(token)));
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(Fetch(PortIn(log), "/?token=a-wrong-guess" + std::to_string(i)).status, 401);
    }
    EXPECT_THAT(log.text(), HasSubstr("page: 1 wrong token from 127.0.0.1"));
    EXPECT_THAT(log.text(), Not(HasSubstr("a-wrong-guess")));
  }
  const testing::CapturedLog log;
  config.shows_token = true;
  const Server server(config);
  EXPECT_THAT(log.text(), HasSubstr("/?token=" + token));
}

TEST(Server, HasATokenForViewersBesideThatOfTheOperator) {
  const testing::TempFolder folder;
  const std::string file = (folder.path() / "token").string();
  const std::string viewer_file = (folder.path() / "viewer").string();
  const ServeConfig config = ServeConfigOf({{"http_port", "0"},
                                            {"pictures", "off"},
                                            {"token_file", file},
                                            {"viewer_token_file", viewer_file}});
  const testing::CapturedLog log;
  const Server server(config);
  EXPECT_THAT(log.text(), HasSubstr("page for viewers at http://"));
  EXPECT_THAT(log.text(), HasSubstr("to see it: cat " + viewer_file + ")"));
  EXPECT_THAT(log.text(), Not(HasSubstr(config.page->viewer_token)));
  const auto role_of = [&](const std::string& token) {
    return Fetch(PortIn(log), "/api/v1/session?token=" + token).json().at("role");
  };
  EXPECT_EQ(role_of(config.page->viewer_token), "viewer");
  EXPECT_EQ(role_of(config.page->token), "operator");
}

TEST(Server, ExplainsATokenOfViewersThatCannotBeUsed) {
  const auto error_of = [](const testing::Settings& values) -> std::string {
    try {
      ServeConfigOf(values);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of({{"viewer_token", "0123456789abcdef"}}),
              HasSubstr("--viewer_token: viewers have a token only if the operator has one"));
  EXPECT_THAT(error_of({{"viewer_token", "0123456789abcdef"}, {"token", "0123456789abcdef"}}),
              HasSubstr("--viewer_token: the same token as that of --token"));
  const std::string shorter =
      error_of({{"viewer_token", "0123456789abcde"}, {"token", "0123456789abcdef"}});
  EXPECT_THAT(shorter, HasSubstr("--viewer_token: a token of 15 characters can be guessed"));
  EXPECT_THAT(shorter, Not(HasSubstr("0123456789abcde")));
}

TEST(Server, RejectsAPortInUseAndLeavesTheFirstServerRunning) {
  const testing::CapturedLog log;
  const Server first(ServeConfigOf({{"http_port", "0"}, {"picture_size", "64x48"}}));
  const int port = PortIn(log);
  EXPECT_THAT(log.text(), HasSubstr("rendered by llvmpipe"));
  try {
    const Server second(
        ServeConfigOf({{"http_port", std::to_string(port)}, {"picture_size", "64x48"}}));
    ADD_FAILURE() << "two servers on one port";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(port)));
  }
  EXPECT_EQ(Fetch(port, "/api/v1/snapshot.png?width=64&height=48").status, 200);
}

}  // namespace
}  // namespace kinescope::app
