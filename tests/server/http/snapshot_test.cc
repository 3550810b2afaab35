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
using ::testing::HasSubstr;

TEST(Snapshot, IsRenderedAsRequested) {
  const TestServer site;
  const Response picture = site.Get("/snapshot.png?camera=front&width=640&height=360");
  EXPECT_EQ(picture.status, 200);
  EXPECT_EQ(picture.body, "front 640x360");
  EXPECT_EQ(picture.headers.at("content-type"), "image/png");
  EXPECT_EQ(picture.headers.at("cache-control"), "no-store");
  EXPECT_EQ(site.Get("/snapshot.png").body, " 1280x720");
}

TEST(Snapshot, AcceptsSizesFrom16To4096) {
  const TestServer site;
  EXPECT_EQ(site.Get("/snapshot.png?width=16&height=4096").status, 200);
  for (const char* query :
       {"width=15", "height=4097", "width=", "width=1e3", "width=-64", "width=64px",
        "width=99999999999", "colour=red", "camera=nowhere", "camera=../front"}) {
    const Response response = site.Get("/snapshot.png?"s + query);
    EXPECT_EQ(response.status, 400) << query;
    EXPECT_THAT(response.json().at("error").get<std::string>(), HasSubstr("=")) << query;
  }
}

TEST(Snapshot, ReportsWhyItFailed) {
  const TestServer site;
  const Response refused = site.Get("/snapshot.png?camera=iso");
  EXPECT_EQ(refused.status, 400);
  EXPECT_EQ(refused.json()["error"], "iso is out of order");
  const Response failed = site.Get("/snapshot.png?camera=back");
  EXPECT_EQ(failed.status, 503);
  EXPECT_EQ(failed.json()["error"], "the driver failed");
  const TestServer blind("", /*with_feed=*/false);
  EXPECT_EQ(blind.Get("/snapshot.png").status, 503);
}

TEST(Snapshot, DoesNotDelayOtherRequests) {
  TestServer site;
  site.feed.Hold(true);
  std::thread slow([&] { EXPECT_EQ(site.Get("/snapshot.png?camera=front").status, 200); });
  EXPECT_TRUE(site.feed.WaitUntilDrawing());
  EXPECT_EQ(site.Get("/api/state").status, 200);
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
  const auto ask = [&] {
    waiting.emplace_back([&] { drawn += site.Get("/snapshot.png").status == 200 ? 1 : 0; });
  };
  ask();
  ASSERT_TRUE(site.feed.WaitUntilDrawing());
  for (std::size_t i = 0; i < SnapshotWorker::kMaxWaiting; ++i) ask();
  while (site.HttpCounters()["snapshots"] < SnapshotWorker::kMaxWaiting + 1) {
  }
  const Response refused = site.Get("/snapshot.png");
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.headers.at("retry-after"), "1");
  site.feed.Hold(false);
  for (std::thread& thread : waiting) thread.join();
  EXPECT_EQ(drawn, SnapshotWorker::kMaxWaiting + 1);
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
        Fetch(port, "/snapshot.png");
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
