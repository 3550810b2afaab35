#include "server/ros/earlier_messages.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

namespace kinescope::ros_bridge {
namespace {

using ::testing::ElementsAre;
using visualization_msgs::Marker;

// Two markers of a pose at x, turned by `turn` about z.
ShownMarkers MarkersAt(double x, double turn = 0) {
  ShownMarkers markers(2);
  for (int i = 0; i < 2; ++i) {
    markers[static_cast<std::size_t>(i)].id = i;
    markers[static_cast<std::size_t>(i)].pose.position.x = x;
    markers[static_cast<std::size_t>(i)].pose.orientation.z = std::sin(turn / 2);
    markers[static_cast<std::size_t>(i)].pose.orientation.w = std::cos(turn / 2);
  }
  return markers;
}

std::vector<int> IdsOf(const ShownMarkers& markers) {
  std::vector<int> ids;
  for (const Marker& marker : markers) ids.push_back(marker.id);
  return ids;
}

TEST(MessageShelf, HasPlaceForTheNewestMessageAlone) {
  MessageShelf shelf;
  for (int i = 0; i < 3; ++i) {
    ShownMarkers markers = MarkersAt(i);
    EXPECT_TRUE(shelf.Place(4, {}, markers));
    EXPECT_THAT(IdsOf(markers), ElementsAre(0, 1)) << "it replaces the one before";
    EXPECT_TRUE(markers[0].lifetime.isZero());
  }
}

TEST(MessageShelf, KeepsAsManyMessagesAsItShould) {
  MessageShelf shelf;
  EarlierMessages earlier;
  earlier.keep = 3;
  std::vector<int> first;
  for (int i = 0; i < 4; ++i) {
    ShownMarkers markers = MarkersAt(i);
    EXPECT_TRUE(shelf.Place(4, earlier, markers));
    first.push_back(markers[0].id);
    EXPECT_EQ(markers[1].id, markers[0].id + 1);
  }
  EXPECT_THAT(first, ElementsAre(0, 8, 16, 0)) << "the fourth replaces the first";
  ShownMarkers other = MarkersAt(0);
  EXPECT_TRUE(shelf.Place(5, earlier, other));
  EXPECT_EQ(other[0].id, 0) << "each topic has its own";
}

TEST(MessageShelf, LetsMessagesDecay) {
  MessageShelf shelf;
  EarlierMessages earlier;
  earlier.decay_secs = 2.5;
  for (int i = 0; i < 2; ++i) {
    ShownMarkers markers = MarkersAt(i);
    EXPECT_TRUE(shelf.Place(4, earlier, markers));
    EXPECT_EQ(markers[0].id, 8 * i);
    EXPECT_EQ(markers[1].lifetime.toSec(), 2.5);
  }
}

TEST(MessageShelf, LeavesOutPosesThatAreNearToTheOneBefore) {
  MessageShelf shelf;
  EarlierMessages earlier;
  earlier.keep = 100;
  earlier.step_m = 0.1;
  earlier.turn_rad = 0.2;
  const auto is_shown = [&](double x, double turn) {
    ShownMarkers markers = MarkersAt(x, turn);
    return shelf.Place(4, earlier, markers);
  };
  EXPECT_TRUE(is_shown(0, 0));
  EXPECT_FALSE(is_shown(0.09, 0.19));
  EXPECT_TRUE(is_shown(0.11, 0)) << "far from the last that is shown";
  EXPECT_FALSE(is_shown(0.19, 0));
  EXPECT_TRUE(is_shown(0.11, 0.3)) << "turned";
  ShownMarkers none;
  EXPECT_TRUE(shelf.Place(4, earlier, none));
}

// As every Odometry display that RViz has saved: it has tolerances.
TEST(MessageShelf, ShowsOdometryThatMovesAsAxesToo) {
  MessageShelf shelf;
  EarlierMessages earlier;
  earlier.step_m = earlier.turn_rad = 0.1;
  for (const bool has_axes : {false, true}) {
    ShownStyle style;
    style.has_axes = has_axes;
    for (int x = 0; x < 3; ++x) {
      nav_msgs::Odometry odometry;
      odometry.pose.pose.position.x = x;
      odometry.pose.pose.orientation.w = 1;
      ShownMarkers markers = *ToMarkers(odometry, style);
      EXPECT_TRUE(shelf.Place(has_axes ? 1 : 0, earlier, markers)) << has_axes << x;
    }
  }
}

}  // namespace
}  // namespace kinescope::ros_bridge
