// The thread that asks nodes for their time; the questions are those of the test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/ros/node_time.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::UnorderedElementsAre;

bool Wait(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::yield();  // for the thread that asks
  }
  return true;
}

TimeQuestion QuestionOfTest(const std::string& node) {
  if (node == "/refused") throw std::runtime_error("no question");
  return [node]() -> std::optional<RoundTrip> {
    if (node == "/broken") throw std::runtime_error("no time\nin it");
    if (node == "/silent") return std::nullopt;
    return RoundTrip{1, 3, 100};
  };
}

std::vector<std::string> NamesOfAnswers(NodeTimes& times, std::size_t count) {
  std::vector<std::string> names;
  EXPECT_TRUE(Wait([&] {
    for (const auto& [name, trip] : times.Take()) {
      EXPECT_EQ(trip.theirs, 100);
      names.push_back(name);
    }
    return names.size() >= count;
  }));
  return names;
}

TEST(NodeTimes, AsksTheNodesThatItIsTold) {
  NodeTimes times(QuestionOfTest);
  times.SetNodes({"/a", "/silent", "/b"});
  EXPECT_THAT(NamesOfAnswers(times, 2), UnorderedElementsAre("/a", "/b"));
  times.SetNodes({"/c"});  // at once
  EXPECT_THAT(NamesOfAnswers(times, 1), UnorderedElementsAre("/c"));
  EXPECT_EQ(times.failures(), 0U);
}

// It ended the process.
TEST(NodeTimes, CountsQuestionsThatFailAndGoesOn) {
  NodeTimes times(QuestionOfTest);
  times.SetNodes({"/broken", "/a", "/refused", "/b"});
  EXPECT_THAT(NamesOfAnswers(times, 2), UnorderedElementsAre("/a", "/b"));
  EXPECT_EQ(times.failures(), 2U);
  times.SetNodes({"/broken"});
  EXPECT_TRUE(Wait([&] { return times.failures() == 3; }));
}

TEST(NodeTimes, StopsAfterTheQuestionThatIsUnderWay) {
  std::atomic<int> asked{0};
  {
    NodeTimes times([&](const std::string&) {
      return [&]() -> std::optional<RoundTrip> {
        ++asked;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));  // a node that is cut off
        return std::nullopt;
      };
    });
    times.SetNodes(std::vector<std::string>(1000, "/a"));
    EXPECT_TRUE(Wait([&] { return asked > 0; }));
  }
  EXPECT_LT(asked, 1000);
}

}  // namespace
}  // namespace kinescope::ros_bridge
