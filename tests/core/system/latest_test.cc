#include "core/system/latest.h"

#include <gtest/gtest.h>

#include <thread>

namespace kinescope {
namespace {

using std::chrono::milliseconds;

TEST(Latest, DeliversTheLatestValueAndDropsOlderOnes) {
  Latest<int> latest;
  std::uint64_t seen = 0;
  EXPECT_EQ(latest.Get(), nullptr);
  EXPECT_EQ(latest.WaitNewer(seen, milliseconds(0)), nullptr);
  latest.Publish(std::make_shared<const int>(1));
  latest.Publish(std::make_shared<const int>(2));
  EXPECT_EQ(*latest.WaitNewer(seen, milliseconds(0)), 2);
  EXPECT_EQ(latest.WaitNewer(seen, milliseconds(0)), nullptr) << "the same value twice";
  EXPECT_EQ(*latest.Get(), 2);
}

TEST(Latest, WakesAWaitingReader) {
  Latest<int> latest;
  std::thread writer([&] { latest.Publish(std::make_shared<const int>(7)); });
  std::uint64_t seen = 0;
  const auto value = latest.WaitNewer(seen, milliseconds(10000));
  writer.join();
  ASSERT_NE(value, nullptr);
  EXPECT_EQ(*value, 7);
}

TEST(Latest, ReleasesWaitingReadersWhenInterrupted) {
  Latest<int> latest;
  std::thread stopper([&] { latest.Interrupt(); });
  std::uint64_t seen = 0;
  EXPECT_EQ(latest.WaitNewer(seen, std::chrono::hours(1)), nullptr);
  stopper.join();
}

}  // namespace
}  // namespace kinescope
