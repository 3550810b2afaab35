// Updates replace cells of the map before them, as in RViz, and nothing else.
#include "server/ros/updated_maps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "server/ros/marker_decoder.h"
#include "server/ros/topic_markers.h"

namespace kinescope::ros_bridge {
namespace {

using map_msgs::OccupancyGridUpdate;
using nav_msgs::OccupancyGrid;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::uint32_t kMapWidth = 4, kMapHeight = 3;

OccupancyGrid FreeMap() {
  OccupancyGrid map;
  map.header.frame_id = "odom";
  map.header.stamp = ros::Time(5, 0);
  map.info.resolution = 0.5F;
  map.info.width = kMapWidth;
  map.info.height = kMapHeight;
  map.info.origin.orientation.w = 1;
  map.data.resize(kMapWidth * kMapHeight);
  return map;
}

// Two walls beside each other.
OccupancyGridUpdate WallsAt(std::int32_t x, std::int32_t y) {
  OccupancyGridUpdate update;
  update.header.frame_id = "elsewhere";
  update.header.stamp = ros::Time(7, 0);
  update.x = x;
  update.y = y;
  update.width = 2;
  update.height = 1;
  update.data = {100, 100};
  return update;
}

// Of markers as those of a map with these walls.
void ExpectWalls(const ShownMarkers& markers, const std::vector<std::size_t>& cells) {
  OccupancyGrid map = FreeMap();
  for (const std::size_t cell : cells) map.data.at(cell) = 100;
  const Taken<ShownMarkers> expected = ToMarkers(map);
  ASSERT_TRUE(expected);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].id, expected->front().id);
  EXPECT_EQ(markers[0].points, expected->front().points);
  EXPECT_EQ(markers[0].colors, expected->front().colors);
}

TEST(UpdatedMaps, HaveTheCellsOfTheirUpdates) {
  UpdatedMaps maps;
  const auto whole = maps.Put(0, FreeMap(), {});
  ASSERT_TRUE(whole);
  ExpectWalls(*whole, {});
  auto markers = maps.Update(0, WallsAt(1, 2), {});
  ASSERT_TRUE(markers);
  ExpectWalls(*markers, {9, 10});
  EXPECT_EQ(markers->front().header.frame_id, "odom");
  EXPECT_EQ(markers->front().header.stamp, ros::Time(7, 0));
  OccupancyGridUpdate column = WallsAt(0, 0);
  std::swap(column.width, column.height);
  markers = maps.Update(0, column, {});
  ASSERT_TRUE(markers);
  ExpectWalls(*markers, {0, 4, 9, 10});
}

TEST(UpdatedMaps, AreTheNewestOfEachTopic) {
  UpdatedMaps maps;
  ASSERT_TRUE(maps.Put(0, FreeMap(), {}));
  ASSERT_TRUE(maps.Put(1, FreeMap(), {}));
  ASSERT_TRUE(maps.Update(0, WallsAt(0, 0), {}));
  ExpectWalls(*maps.Update(1, WallsAt(2, 0), {}), {2, 3});
  ASSERT_TRUE(maps.Put(0, FreeMap(), {}));
  ExpectWalls(*maps.Update(0, WallsAt(2, 2), {}), {10, 11});
}

TEST(UpdatedMaps, StayAsTheyAreIfAnUpdateCannotBeApplied) {
  UpdatedMaps maps;
  const auto why = [&](const OccupancyGridUpdate& update) {
    const auto markers = maps.Update(0, update, {});
    return markers ? std::string() : markers.error().text;
  };
  EXPECT_EQ(why(WallsAt(1, 2)), "an update of 2 x 1 cells at (1, 2): no map yet");
  ASSERT_TRUE(maps.Put(0, FreeMap(), {}));
  EXPECT_EQ(why(WallsAt(3, 0)), "an update of 2 x 1 cells at (3, 0): the map has 4 x 3");
  EXPECT_EQ(why(WallsAt(0, 3)), "an update of 2 x 1 cells at (0, 3): the map has 4 x 3");
  EXPECT_THAT(why(WallsAt(-1, 0)), HasSubstr("at (-1, 0): the map has 4 x 3"));
  EXPECT_THAT(why(WallsAt(0, -1)), HasSubstr("at (0, -1): the map has 4 x 3"));
  OccupancyGridUpdate update = WallsAt(1, 0);
  update.width = 0xffffffff;  // one less than x in 32 bits
  EXPECT_THAT(why(update), HasSubstr("the map has 4 x 3"));
  update = WallsAt(1, 0);
  update.data.pop_back();
  EXPECT_EQ(why(update), "an update of 2 x 1 cells at (1, 0): it has 1 values, expected 2");
  update.data.resize(3);
  EXPECT_EQ(why(update), "an update of 2 x 1 cells at (1, 0): it has 3 values, expected 2");
  ExpectWalls(*maps.Update(0, WallsAt(1, 1), {}), {5, 6});
}

TEST(UpdatedMaps, AreNoneAfterAMapThatCannotBeDrawn) {
  UpdatedMaps maps;
  ASSERT_TRUE(maps.Put(0, FreeMap(), {}));
  OccupancyGrid map = FreeMap();
  map.data.pop_back();
  EXPECT_FALSE(maps.Put(0, map, {}));
  const auto markers = maps.Update(0, WallsAt(0, 0), {});
  ASSERT_FALSE(markers);
  EXPECT_STREQ(markers.error().kind, "no map yet");
}

TEST(UpdatedMaps, MayHaveRowsWithoutCells) {
  UpdatedMaps maps;
  OccupancyGrid map = FreeMap();
  map.info.width = 0;
  map.info.height = 0xffffffff;
  ASSERT_TRUE(maps.Put(0, map, {}));
  OccupancyGridUpdate update = WallsAt(0, 0);
  update.width = 0;
  update.height = map.info.height;
  update.data.clear();
  EXPECT_TRUE(maps.Update(0, update, {}));
}

template <class Message>
std::vector<std::uint8_t> GridBytes(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  return bytes;
}

const std::string& GridType() {
  static const std::string kType = ros::message_traits::md5sum<OccupancyGrid>();
  return kType;
}

const std::string& GridUpdateType() {
  static const std::string kType = ros::message_traits::md5sum<OccupancyGridUpdate>();
  return kType;
}

TEST(TopicMarkers, HaveUpdatesOfAMapIfTold) {
  ShownStyle style;
  EXPECT_FALSE(TopicMarkers::IsShown(GridUpdateType(), style));
  style.has_updates = true;
  ASSERT_TRUE(TopicMarkers::IsShown(GridUpdateType(), style));
  ASSERT_TRUE(TopicMarkers::IsShown(GridType(), style));
  TopicMarkers topics;
  ShownMarkers markers;
  const auto take = [&](const std::string& type, const std::vector<std::uint8_t>& bytes) {
    markers.clear();
    const auto refusal = topics.Take(0, "/costs", style, type, bytes, markers);
    return refusal ? std::string(refusal->kind) : "";
  };
  const std::vector<std::uint8_t> update = GridBytes(WallsAt(1, 2));
  EXPECT_EQ(take(GridUpdateType(), update), "no map yet");
  EXPECT_THAT(markers, IsEmpty());
  EXPECT_EQ(take(GridType(), GridBytes(FreeMap())), "");
  ExpectWalls(markers, {});
  for (std::size_t size = 0; size < update.size(); ++size) {
    EXPECT_EQ(take(GridUpdateType(), {update.begin(), update.begin() + static_cast<long>(size)}),
              "unreadable");
  }
  EXPECT_EQ(take(GridUpdateType(), update), "");
  ExpectWalls(markers, {9, 10});
  EXPECT_EQ(markers.at(0).ns, "costs");
}

// As they come together, before anything of them is shown.
TEST(MarkerDecoder, LeavesOutNoUpdateOfAMap) {
  const auto event_of = [](const std::string& type, std::vector<std::uint8_t> bytes) {
    const auto raw = boost::make_shared<RawMessage>();
    raw->bytes = std::move(bytes);
    const auto header = boost::make_shared<ros::M_string>();
    (*header)["md5sum"] = type;
    return MarkerDecoder::Event(raw, header, ros::Time(9, 0));
  };
  ShownTopic topic{"/costs"};
  topic.style.has_updates = true;
  MarkerDecoder decoder({topic}, {});
  decoder.OnMessage(0, event_of(GridType(), GridBytes(FreeMap())), false, 1);
  decoder.OnMessage(0, event_of(GridUpdateType(), GridBytes(WallsAt(0, 0))), false, 2);
  decoder.OnMessage(0, event_of(GridUpdateType(), GridBytes(WallsAt(2, 2))), false, 3);
  decoder.DecodeKept(6);
  std::vector<DecodedMessage> decoded = decoder.Take();
  ASSERT_THAT(decoded, SizeIs(3));
  for (const DecodedMessage& message : decoded) EXPECT_FALSE(message.refusal);
  ExpectWalls(decoded[2].markers, {0, 1, 10, 11});
  decoder.OnMessage(0, event_of(GridUpdateType(), GridBytes(WallsAt(0, 2))), false, 4);
  decoder.OnMessage(0, event_of(GridType(), GridBytes(FreeMap())), false, 5);
  decoder.DecodeKept(6);
  decoded = decoder.Take();
  ASSERT_THAT(decoded, SizeIs(2));
  ExpectWalls(decoded[1].markers, {});
}

}  // namespace
}  // namespace kinescope::ros_bridge
