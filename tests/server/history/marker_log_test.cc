#include "server/history/marker_log.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace kinescope::history {
namespace {

std::shared_ptr<const SceneMarker> MarkerWith(std::size_t points) {
  auto marker = std::make_shared<SceneMarker>();
  marker->points.resize(points);
  return marker;
}

void Add(MarkerLog& log, std::uint64_t number, MarkerList markers) {
  SceneState state;
  state.number = number;
  state.markers = std::move(markers);
  log.Add(state);
}

TEST(MarkerLog, HasTheMarkersOfEachState) {
  MarkerLog log(1 << 20);
  const auto wall = MarkerWith(0), path = MarkerWith(0), longer = MarkerWith(0);
  Add(log, 3, {});
  Add(log, 5, {wall});
  Add(log, 7, {wall, path});
  Add(log, 8, {wall, path});
  Add(log, 9, {wall, longer});
  EXPECT_TRUE(log.Of(4).empty());
  EXPECT_EQ(log.Of(5), MarkerList({wall}));
  EXPECT_EQ(log.Of(6), MarkerList({wall}));
  EXPECT_EQ(log.Of(8), MarkerList({wall, path}));
  EXPECT_EQ(log.Of(900), MarkerList({wall, longer}));
  Add(log, 901, {});
  EXPECT_EQ(log.Of(900), MarkerList({wall, longer}));
  EXPECT_TRUE(log.Of(901).empty());
}

TEST(MarkerLog, CountsAMarkerThatStaysOnce) {
  MarkerLog log(1 << 30);
  const auto cloud = MarkerWith(1000);
  Add(log, 1, {cloud});
  const std::size_t one = log.bytes();
  EXPECT_GT(one, 1000 * sizeof(Eigen::Vector3d));
  for (std::uint64_t number = 2; number <= 11; ++number) {
    Add(log, number, {cloud, MarkerWith(0)});
  }
  EXPECT_LT(log.bytes(), one + one / 2);
}

TEST(MarkerLog, ForgetsTheOldestAndWhatOnlyTheyHad) {
  const auto wall = MarkerWith(10);
  MarkerLog log(100'000);
  for (std::uint64_t number = 1; number <= 50; ++number) {
    Add(log, number, {wall, MarkerWith(1000)});
    EXPECT_LE(log.bytes(), 100'000u);
  }
  EXPECT_TRUE(log.Of(40).empty());
  EXPECT_EQ(log.Of(50).size(), 2u);
  const auto huge = MarkerWith(10'000);
  Add(log, 51, {wall, huge});
  EXPECT_EQ(log.Of(51), MarkerList({wall, huge})) << "the newest is kept, whatever its size";
  EXPECT_TRUE(log.Of(50).empty());
  Add(log, 52, {wall});
  Add(log, 53, {});
  log.ForgetBefore(53);
  EXPECT_LT(log.bytes(), 1000u) << "nothing of what is forgotten is counted";
  EXPECT_TRUE(log.Of(52).empty());
}

TEST(MarkerLog, ForgetsLargeMarkersFirstAndSaysSo) {
  MarkerLog log(500'000);
  const auto wall = MarkerWith(10), map = MarkerWith(5'000);
  std::vector<MarkerList> lists;
  for (std::uint64_t number = 1; number <= 50; ++number) {
    const auto cloud = number % 3 == 1 ? MarkerWith(2'000) : lists.back()[2];  // in three lists
    lists.push_back({wall, map, cloud, MarkerWith(1)});
    Add(log, number, lists.back());
    EXPECT_LE(log.bytes(), 500'000u);
  }
  EXPECT_EQ(log.Of(50), lists.back());
  const MarkerList& first = log.Of(1);
  ASSERT_EQ(first.size(), 4u);
  EXPECT_EQ(first[0], wall);
  EXPECT_EQ(first[1], map) << "it is still there, and takes no more room";
  EXPECT_EQ(first[3], lists[0][3]);
  ASSERT_TRUE(FindDefect(*first[2]));
  EXPECT_NE(FindDefect(*first[2])->text.find("no longer kept"), std::string::npos);
  EXPECT_EQ(first[2]->ns, lists[0][2]->ns);
  EXPECT_EQ(log.Of(2)[2], first[2]) << "one word for all lists that had it";
  Add(log, 51, {});
  log.ForgetBefore(51);
  EXPECT_LT(log.bytes(), 1000u);
}

TEST(MarkerLog, ForgetsListsOfStatesThatAreGone) {
  MarkerLog log(1 << 20);
  const auto a = MarkerWith(1), b = MarkerWith(1), c = MarkerWith(1);
  Add(log, 1, {a});
  Add(log, 5, {b});
  Add(log, 9, {c});
  log.ForgetBefore(7);
  EXPECT_TRUE(log.Of(4).empty());
  EXPECT_EQ(log.Of(7), MarkerList({b})) << "it still has this list";
}

}  // namespace
}  // namespace kinescope::history
