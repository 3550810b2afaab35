#include "server/alarms/webhook.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/system/web_address.h"
#include "tests/patience.h"
#include "tests/web_listener.h"

namespace kinescope::alarms {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Answers each request with the next of its statuses, and the last one again and again.
class WebServer {
 public:
  explicit WebServer(std::vector<int> statuses) : statuses_(std::move(statuses)) {}

  const std::string& url() const { return url_; }
  std::vector<std::string> bodies() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return bodies_;
  }

 private:
  void Answer(int client, int status) {
    std::string request;
    char buffer[4096];
    while (request.find("\r\n\r\n") == std::string::npos || request.back() != '}') {
      const ssize_t count = read(client, buffer, sizeof buffer);
      if (count <= 0) return;
      request.append(buffer, static_cast<std::size_t>(count));
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      bodies_.push_back(request.substr(request.find("\r\n\r\n") + 4));
    }
    const std::string answer = "HTTP/1.1 " + std::to_string(status) +
                               " x\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    EXPECT_EQ(write(client, answer.data(), answer.size()), static_cast<ssize_t>(answer.size()));
  }

  const std::vector<int> statuses_;
  std::size_t next_ = 0;
  mutable std::mutex mutex_;
  std::vector<std::string> bodies_;  // guarded by mutex_
  testing::WebListener listener_{
      [this](int client) { Answer(client, statuses_[std::min(next_++, statuses_.size() - 1)]); }};
  const std::string url_ = listener_.url() + "/secret?key=1";
};

// Until it is true, or kPatience has passed.
bool WaitUntil(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + testing::kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

Webhook::Settings SettingsFor(const std::string& url) {
  Webhook::Settings settings;
  settings.url = url;
  settings.pause_secs = 0.01;
  return settings;
}

TEST(Webhook, PostsEachAlarmInOrder) {
  const WebServer server({200});
  Webhook webhook(SettingsFor(server.url()));
  webhook.Send("{\"n\": 1}");
  webhook.Send("{\"n\": 2}");
  ASSERT_TRUE(WaitUntil([&] { return webhook.counters().delivered == 2; }));
  EXPECT_THAT(server.bodies(), ElementsAre("{\"n\": 1}", "{\"n\": 2}"));
}

TEST(Webhook, TriesAgainAndSaysOnceWhatIsWrong) {
  const WebServer server({503, 503, 503, 503, 503, 503, 503, 200});
  std::mutex mutex;
  std::vector<std::string> lines;
  Webhook::Settings settings = SettingsFor(server.url());
  settings.warn = [&](const std::string& line) {
    const std::lock_guard<std::mutex> lock(mutex);
    lines.push_back(line);
  };
  {
    Webhook webhook(settings);
    for (int i = 0; i < 3; ++i) webhook.Send("{}");
    ASSERT_TRUE(WaitUntil([&] { return webhook.counters().delivered == 1; }));
    EXPECT_EQ(webhook.counters().failed, 2u);
    EXPECT_EQ(webhook.counters().last_error, "");
  }
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0], HasSubstr("could not be told: it answered with status 503"));
  EXPECT_THAT(lines[0], ::testing::Not(HasSubstr("secret")));
  EXPECT_THAT(lines[1], HasSubstr("hears of them again"));
}

// A server that accepts and never answers: what waits is bounded, and the end does not wait for it.
TEST(Webhook, AServerThatNeverAnswersDelaysNothing) {
  const int silent = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  ASSERT_EQ(bind(silent, any, size), 0);
  ASSERT_EQ(listen(silent, 8), 0);
  getsockname(silent, any, &size);
  Webhook::Settings settings =
      SettingsFor("http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/");
  settings.timeout_secs = 3600;
  {
    Webhook webhook(settings);
    for (std::size_t i = 0; i < Webhook::kMostWaiting + 10; ++i) webhook.Send("{}");
    EXPECT_GE(webhook.counters().dropped, 9u);  // one may be on its way
  }
  close(silent);
}

TEST(Webhook, NamesOfServersHaveNoSecrets) {
  EXPECT_EQ(ServerOf("https://me:word@chat.example:8443/hooks/abc?x=1"),
            "https://chat.example:8443");
  EXPECT_EQ(ServerOf("http://chat.example"), "http://chat.example");
}

}  // namespace
}  // namespace kinescope::alarms
