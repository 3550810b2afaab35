#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "server/http/snapshot_worker.h"
#include "tests/server/http/test_server.h"

namespace kinescope::http::testing {
namespace {

using namespace std::string_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Snapshot, IsRenderedAsRequested) {
  const TestServer site;
  const Response picture = site.Get("/api/v1/snapshot.png?camera=front&width=640&height=360");
  EXPECT_EQ(picture.status, 200);
  EXPECT_EQ(picture.body, "front 640x360");
  EXPECT_EQ(picture.headers.at("content-type"), "image/png");
  EXPECT_EQ(picture.headers.at("cache-control"), "no-store");
  EXPECT_EQ(site.Get("/api/v1/snapshot.png").body, " 1280x720");
}

TEST(Snapshot, ShowsAFormerStateOrSaysWhyNot) {
  TestServer site;
  for (std::uint64_t number = 4; number <= 6; ++number) site.PublishState(number);
  EXPECT_EQ(site.Get("/api/v1/snapshot.png?state=5&camera=front").body, "front 1280x720 state 5");
  const auto expect = [&](const std::string& state, int status, const std::string& reason) {
    const Response response = site.Get("/api/v1/snapshot.png?state=" + state);
    EXPECT_EQ(response.status, status) << state;
    EXPECT_THAT(response.json().at("error").get<std::string>(), HasSubstr(reason)) << state;
  };
  expect("7", 409, "state 7 has not come yet; the newest one is 6");
  expect("3", 410, "state 3 is no longer kept");
  expect("-5", 400, "state=-5: expected a whole number");
  expect("", 400, "expected a whole number");
  const TestServer forgetful("", true, "", {},
                             [](HttpConfig& config) { config.history = nullptr; });
  EXPECT_EQ(forgetful.Get("/api/v1/snapshot.png?state=5").status, 503);
}

TEST(Surroundings, AreThoseOfAFormerStateOnceTheyAreMade) {
  std::atomic<int> asked{0};
  TestServer site("", true, "", {}, [&](HttpConfig& config) {
    config.surroundings = [] {
      return std::make_shared<const Surroundings>(Surroundings{9, "now"});
    };
    config.former_surroundings = [&](const std::shared_ptr<const SceneState>& former)
        -> std::shared_ptr<const Surroundings> {
      if (former->number == 6) return std::make_shared<const Surroundings>();
      if (++asked == 1) return nullptr;
      return std::make_shared<const Surroundings>(
          Surroundings{former->surroundings, "then " + std::to_string(former->number)});
    };
  });
  for (std::uint64_t number = 4; number <= 6; ++number) {
    site.PublishState(number, [&](SceneState& state) { state.surroundings = number - 4; });
  }
  EXPECT_EQ(site.Get("/api/v1/surroundings.glb?t=9").body, "now");
  const Response wait = site.Get("/api/v1/surroundings.glb?state=5");
  EXPECT_EQ(wait.status, 202);
  EXPECT_TRUE(wait.json().contains("wait"));
  EXPECT_EQ(wait.headers.at("cache-control"), "no-store");
  const Response then = site.Get("/api/v1/surroundings.glb?state=5");
  EXPECT_EQ(then.status, 200);
  EXPECT_EQ(then.body, "then 5");
  EXPECT_EQ(then.headers.at("content-type"), "model/gltf-binary");
  EXPECT_EQ(site.Get("/api/v1/surroundings.glb?state=4").status, 404) << "nothing was there";
  EXPECT_EQ(site.Get("/api/v1/surroundings.glb?state=6").status, 503) << "they cannot be made";
  EXPECT_EQ(site.Get("/api/v1/surroundings.glb?state=7").status, 409);
  EXPECT_EQ(site.Get("/api/v1/surroundings.glb?state=3").status, 410);
  EXPECT_EQ(site.Get("/api/v1/surroundings.glb?state=x").status, 400);
}

TEST(Snapshot, AcceptsSizesFrom16To4096) {
  const TestServer site;
  EXPECT_EQ(site.Get("/api/v1/snapshot.png?width=16&height=4096").status, 200);
  for (const char* query :
       {"width=15", "height=4097", "width=", "width=1e3", "width=-64", "width=64px",
        "width=99999999999", "colour=red", "camera=nowhere", "camera=../front"}) {
    const Response response = site.Get("/api/v1/snapshot.png?"s + query);
    EXPECT_EQ(response.status, 400) << query;
    EXPECT_THAT(response.json().at("error").get<std::string>(), HasSubstr("=")) << query;
  }
}

TEST(Snapshot, ReportsWhyItFailed) {
  const TestServer site;
  const Response refused = site.Get("/api/v1/snapshot.png?camera=iso");
  EXPECT_EQ(refused.status, 400);
  EXPECT_EQ(refused.json()["error"], "iso is out of order");
  const Response failed = site.Get("/api/v1/snapshot.png?camera=back");
  EXPECT_EQ(failed.status, 503);
  EXPECT_EQ(failed.json()["error"], "the driver failed");
  const TestServer blind("", /*with_feed=*/false);
  EXPECT_EQ(blind.Get("/api/v1/snapshot.png").status, 503);
}

TEST(Snapshot, DoesNotDelayOtherRequests) {
  TestServer site;
  site.feed.Hold(true);
  std::thread slow([&] { EXPECT_EQ(site.Get("/api/v1/snapshot.png?camera=front").status, 200); });
  EXPECT_TRUE(site.feed.WaitUntilDrawing());
  EXPECT_EQ(site.Get("/api/v1/state").status, 200);
  WsClient client(site.server.port());
  site.PublishState(3);
  while (client.ReceiveState().state_number() != 3) {
  }
  site.feed.Hold(false);
  slow.join();
}

TEST(Snapshot, IsRejectedIfTheShortQueueIsFull) {
  TestServer site;
  site.feed.Hold(true);
  std::atomic<int> drawn{0};
  std::vector<std::thread> waiting;
  const auto get = [&](const std::string& target, int client) {
    return Fetch(site.server.port(), target, {}, "GET", "", "127.0.2." + std::to_string(client));
  };
  const auto ask = [&](int client) {
    waiting.emplace_back(
        [&, client] { drawn += get("/api/v1/snapshot.png", client).status == 200 ? 1 : 0; });
  };
  ask(1);
  ASSERT_TRUE(site.feed.WaitUntilDrawing());
  constexpr int kMaxWaiting = static_cast<int>(SnapshotWorker::kMaxWaiting);
  for (int i = 0; i < kMaxWaiting; ++i) ask(1 + i / 2);
  while (site.HttpCounters()["snapshots"] < kMaxWaiting + 1) {
  }
  const std::string largest = "/api/v1/snapshot.png?width=4096&height=4096";
  const Response refused = get(largest, 9);
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.headers.at("retry-after"), "1");
  site.feed.Hold(false);
  for (std::thread& thread : waiting) thread.join();
  EXPECT_EQ(drawn, kMaxWaiting + 1);
  EXPECT_EQ(get(largest, 9).status, 200) << "the rejected one costs nothing";
}

TEST(Snapshot, IsRejectedIfTwoOfItsAddressWait) {
  TestServer site;
  site.feed.Hold(true);
  const std::string request = "GET /api/v1/snapshot.png HTTP/1.1\r\nHost: localhost\r\n\r\n";
  const OpenConnection first(site.server.port(), request);
  ASSERT_TRUE(site.feed.WaitUntilDrawing());
  const OpenConnection second(site.server.port(), request), third(site.server.port(), request);
  while (site.HttpCounters()["snapshots"] < 3) {
  }
  const Response refused = site.Get("/api/v1/snapshot.png");
  EXPECT_EQ(refused.status, 429);
  EXPECT_EQ(refused.headers.at("retry-after"), "1");
  EXPECT_THAT(refused.json()["error"].get<std::string>(), HasSubstr("2 snapshots"));
  site.feed.Hold(false);
}

TEST(Snapshot, IsNotRenderedForAClientThatHasLeft) {
  TestServer site;
  site.feed.Hold(true);
  std::thread patient([&] { EXPECT_EQ(site.Get("/api/v1/snapshot.png").status, 200); });
  ASSERT_TRUE(site.feed.WaitUntilDrawing());
  {
    const OpenConnection impatient(site.server.port(),
                                   "GET /api/v1/snapshot.png HTTP/1.1\r\nHost: localhost\r\n\r\n");
    while (site.HttpCounters()["snapshots"] < 2) {
    }
  }
  while (site.HttpCounters()["rejected"].value("abandoned", 0) < 1) {
  }
  site.feed.Hold(false);
  patient.join();
  EXPECT_EQ(site.Get("/api/v1/snapshot.png").status, 200);
  EXPECT_EQ(site.feed.drawn(), 2) << "the first and the last";
}

// As "nc -N" and "socat" do.
TEST(Snapshot, IsSentToAClientThatHasOnlyFinishedSending) {
  TestServer site;
  site.feed.Hold(true);
  const std::string request = "GET /api/v1/snapshot.png HTTP/1.1\r\nHost: localhost\r\n";
  const OpenConnection first(site.server.port(), request + "\r\n");
  ASSERT_TRUE(site.feed.WaitUntilDrawing());
  OpenConnection half_closed(site.server.port(), request + "Connection: close\r\n\r\n");
  half_closed.FinishSending();
  while (site.HttpCounters()["snapshots"] < 2) {
  }
  EXPECT_EQ(site.HttpCounters()["rejected"].value("abandoned", 0), 0);
  site.feed.Hold(false);
  EXPECT_THAT(half_closed.ReadToEnd(), HasSubstr("HTTP/1.1 200"));
}

TEST(Snapshot, IsPostponedIfItsAddressHasUsedUpItsPixels) {
  const TestServer site;
  const std::string largest = "/api/v1/snapshot.png?width=4096&height=4096";
  EXPECT_EQ(site.Get(largest).status, 200);
  const Response refused = site.Get(largest);
  EXPECT_EQ(refused.status, 429);
  EXPECT_GE(std::stoi(refused.headers.at("retry-after")), 1);
  EXPECT_THAT(refused.json()["error"].get<std::string>(),
              AllOf(HasSubstr("4096x4096"), HasSubstr("try again in"), HasSubstr("1920x1080")));
  EXPECT_EQ(site.Get("/api/v1/snapshot.png?width=1920&height=1080").status, 200) << "as the page's";
}

TEST(Snapshot, InProgressDoesNotPreventTheServerFromStopping) {
  FakeFeed feed;
  std::thread client, release;
  {
    Latest<SceneState> states;
    Latest<Picture> pictures;
    const HttpServer server(TestServer::MakeConfig(""), states, pictures, &feed, nullptr);
    feed.Hold(true);
    client = std::thread([port = server.port()] {
      try {
        Fetch(port, "/api/v1/snapshot.png");
      } catch (const std::exception&) {
        // Whether the picture or the end comes first is open; that all threads end is the point.
      }
    });
    EXPECT_TRUE(feed.WaitUntilDrawing());
    release = std::thread([&feed] { feed.Hold(false); });
  }
  release.join();
  client.join();
}

}  // namespace
}  // namespace kinescope::http::testing
